//! Passes traced from the formulas, on a device (`cuda:0` unless named) and on the processor: bits, times,
//! bandwidth.
//!
//! `crates/device/benches/device.sh` runs it with 100 particles a side. Without a device only the
//! processor is measured.

mod cloud;
mod gpu;
mod lists;
mod processor;

use std::error::Error;

use piola_device::Device;

fn main() -> Result<(), Box<dyn Error>> {
    let mut sides = std::env::args().skip(1).filter_map(|argument| argument.parse().ok());
    let (large, small) = (sides.next().unwrap_or(24), sides.next().unwrap_or(16));
    println!("particles: {} to measure, {} for bits", large * large * large, small * small * small);
    let name = std::env::args().find(|argument| argument.contains(':'));
    match Device::open(name.as_deref().unwrap_or("cuda:0")) {
        Ok(device) => {
            lists::measure(&device, small)?;
            lists::measure(&device, large)?;
            gpu::measure(&device, small, large)?;
        }
        Err(reason) => println!("NOT RUN on a device: {reason}"),
    }
    processor::measure(large);
    Ok(())
}
