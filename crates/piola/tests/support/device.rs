//! The device of the tests.

use piola_device::Device;

/// The device that `PIOLA_TEST_DEVICE` names, or the first of OpenCL; without one tests say that they were not
/// run.
pub fn device() -> Option<String> {
    let name = std::env::var("PIOLA_TEST_DEVICE").unwrap_or_else(|_| "opencl:0".into());
    match Device::open(&name) {
        Ok(_) => Some(name),
        Err(error) if std::env::var_os("PIOLA_OPENCL_REQUIRED").is_some() => panic!("{error}"),
        Err(error) => {
            eprintln!("NOT RUN: {error}");
            None
        }
    }
}
