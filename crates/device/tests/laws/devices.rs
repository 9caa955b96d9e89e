//! Laws and passes on OpenCL devices, and what devices say when they are used wrongly.

use std::fmt::Write;

use piola_device::{Argument, Device, DeviceError, Language, Law, Precision, devices, laws};

use super::compiled::sample;
use super::{assert_bits, random};

/// The device that `PIOLA_TEST_DEVICE` names, or else an OpenCL device with double precision, or `None` where
/// there is none.
pub fn device() -> Option<Device> {
    if let Ok(name) = std::env::var("PIOLA_TEST_DEVICE") {
        return Some(Device::open(&name).unwrap());
    }
    let found = devices();
    let found = found.iter().find(|found| found.name.starts_with("opencl") && found.has_double);
    if found.is_none() {
        let missing = "there is no OpenCL device with double precision (Debian: pocl-opencl-icd and ocl-icd-libopencl1)";
        assert!(std::env::var_os("PIOLA_OPENCL_REQUIRED").is_none(), "{missing}");
        eprintln!("NOT RUN: {missing}");
    }
    found.map(|found| Device::open(&found.name).unwrap())
}

/// A kernel that calls a law for each row of numbers.
pub fn kernel(law: &Law, language: Language) -> String {
    let (takes, gives) = (law.inputs.len(), law.outputs.len());
    let list = |count: usize, of: &dyn Fn(usize) -> String| {
        (0..count).map(of).collect::<Vec<_>>().join(", ")
    };
    let mut text = law.text(language, Precision::Double);
    writeln!(
        text,
        "KERNEL void run_{name}(const int n, GLOBAL const real *x, GLOBAL real *y)\n{{\n    \
         EACH(a, n) {{\n        real {};\n        {name}({}, {});\n{}    }}\n}}",
        list(gives, &|i| format!("y{i}")),
        list(takes, &|i| format!("x[a * {takes} + {i}]")),
        list(gives, &|i| format!("&y{i}")),
        (0..gives).map(|i| format!("        y[a * {gives} + {i}] = y{i};\n")).collect::<String>(),
        name = law.name,
    )
    .unwrap();
    text
}

#[test]
fn every_law_has_the_bits_of_the_processor_on_a_device() {
    let Some(device) = device() else { return };
    let (laws, mut random) = (laws::all(), random(6));
    let mut text = device.language().prologue(Precision::Double);
    laws.iter().for_each(|law| text += &kernel(law, device.language()));
    let program = device.compile(&text, Precision::Double).unwrap();
    for law in &laws {
        let rows: Vec<Vec<f64>> = (0..300).map(|_| sample(law, &mut random)).collect();
        let inputs = device.upload(&rows.concat()).unwrap();
        let outputs = device.zeros(rows.len() * law.outputs.len()).unwrap();
        let arguments = [
            Argument::Count(rows.len() as i32),
            Argument::Doubles(&inputs),
            Argument::Doubles(&outputs),
        ];
        let kernel = program.kernel(&format!("run_{}", law.name)).unwrap();
        kernel.start(rows.len(), 64, &arguments).unwrap();
        let got = device.download(&outputs).unwrap();
        for (row, got) in rows.iter().zip(got.chunks(law.outputs.len())) {
            assert_bits(&law.name, got, &law.run(row), row);
        }
    }
}

#[test]
fn single_precision_compiles_on_a_device() {
    let Some(device) = device() else { return };
    let mut text = device.language().prologue(Precision::Single);
    laws::all().iter().for_each(|law| text += &law.text(device.language(), Precision::Single));
    device.compile(&text, Precision::Single).unwrap_or_else(|error| panic!("{error}"));
}

#[test]
fn numbers_come_back_as_they_were() {
    let Some(device) = device() else { return };
    let numbers: Vec<f64> = (0..1000).map(|k| f64::from(k).sqrt()).collect();
    let mut column = device.upload(&numbers).unwrap();
    assert_eq!(device.download(&column).unwrap(), numbers);
    device.write(&mut column, &[7.0, 8.0]).unwrap();
    let mut copy = device.zeros(1000).unwrap();
    device.copy(&column, &mut copy).unwrap();
    let mut front = [0.0; 3];
    device.read(&copy, &mut front).unwrap();
    assert_eq!(front, [7.0, 8.0, numbers[2]]);
    let empty = device.upload::<u32>(&[]).unwrap();
    assert!(empty.is_empty() && device.download(&empty).unwrap().is_empty());
    let refused = device.write(&mut copy, &[0.0; 1001]).unwrap_err();
    assert_eq!(refused, DeviceError::Length { length: 1000, count: 1001 });
    assert!(device.time(|| device.copy(&column, &mut copy)).unwrap() >= 0.0);
}

#[test]
fn a_device_says_what_is_wrong() {
    // That there is none is an error, too.
    let unknown = Device::open("vulkan:3").unwrap_err();
    assert!(matches!(unknown, DeviceError::Unknown { .. }));
    assert!(unknown.to_string().starts_with("there is no device `vulkan:3`: there is "));
    let Some(device) = device() else { return };
    assert!(unknown.to_string().contains(&device.found().to_string()), "{unknown}");
    let log = device.compile("nonsense", Precision::Double).unwrap_err();
    assert!(matches!(&log, DeviceError::Compile { log } if log.contains("nonsense")), "{log}");
    let text = device.language().prologue(Precision::Double)
        + "KERNEL void twice(const int n, const double x, const float y, GLOBAL double *z)\n\
           { EACH(a, n) { z[a] = a < 2 ? x : y; } }";
    let program = device.compile(&text, Precision::Double).unwrap();
    let missing = program.kernel("other").unwrap_err();
    assert!(missing.to_string().contains("find the kernel `other`"), "{missing}");
    let z = device.zeros(5).unwrap();
    let numbers = [Argument::Number(0.1), Argument::Single(0.5), Argument::Doubles(&z)];
    let arguments = [&[Argument::Count(4)], numbers.as_slice()].concat();
    program.kernel("twice").unwrap().start(4, 1024, &arguments).unwrap();
    assert_eq!(device.download(&z).unwrap(), [0.1, 0.1, 0.5, 0.5, 0.0]);
    let bytes = 1 << 59;
    assert_eq!(device.zeros::<f64>(bytes / 8).unwrap_err(), DeviceError::Memory { bytes });
}
