use std::fmt::Write;

use piola_device::{Argument, Language, Law, Precision};
use piola_formulas::Number;

use super::compiled::{driver, run};
use super::devices::{device, kernel};
use super::{assert_bits, random};

/// All functions of two numbers.
fn all<T: Number>(x: T, y: T) -> Vec<(String, T)> {
    let results = [
        ("exp", x.exp()),
        ("exp_m1", x.exp_m1()),
        ("ln", x.ln()),
        ("ln_1p", x.ln_1p()),
        ("root", x.powf(0.31)),
        ("cube", x.powf(-3.0)),
        ("sine", x.sin()),
        ("cosine", x.cos()),
        ("angle", y.atan2(x)),
    ];
    results.map(|(name, value)| (name.to_owned(), value)).to_vec()
}

/// The law takes the way of all numbers everywhere, a processor a shorter one mostly.
#[test]
fn functions_have_the_bits_of_the_processor() {
    let law = Law::record("functions", ["x", "y"], |x| all(x[0], x[1]));
    let mut random = random(5);
    let mut number =
        || 2.0 * (random() - 0.4) * 10.0_f64.powf(8.0 * random() * random() - 8.0 * random());
    let infinity = f64::INFINITY;
    let ends = [0.0, -0.0, 1.0, infinity, -infinity, f64::NAN, f64::MAX, 5e-324, 709.8, -745.2];
    let rows: Vec<[f64; 2]> = ends
        .iter()
        .flat_map(|x| ends.map(|y| [*x, y]))
        .chain((0..20_000).map(|_| [number(), number()]))
        .collect();
    let expected: Vec<f64> =
        rows.iter().flat_map(|[x, y]| all(*x, *y)).map(|(_, value)| value).collect();
    let count = law.outputs.len();
    let check = |got: &[f64]| {
        assert_eq!(got.len(), expected.len());
        for ((row, got), expected) in rows.iter().zip(got.chunks(count)).zip(expected.chunks(count))
        {
            assert_bits("functions", got, expected, row);
        }
    };
    let mut lines = String::new();
    for [x, y] in &rows {
        writeln!(lines, "0 {:x} {:x}", x.to_bits(), y.to_bits()).unwrap();
    }
    let text = Language::C.prologue(Precision::Double)
        + &law.text(Language::C, Precision::Double)
        + &driver(std::slice::from_ref(&law));
    if let Some(output) = run(&text, &lines) {
        let got: Vec<f64> = output
            .split_whitespace()
            .map(|word| f64::from_bits(u64::from_str_radix(word, 16).unwrap()))
            .collect();
        check(&got);
    }
    let Some(device) = device() else { return };
    let text = device.language().prologue(Precision::Double) + &kernel(&law, device.language());
    let program = device.compile(&text, Precision::Double).unwrap();
    let inputs = device.upload(rows.as_flattened()).unwrap();
    let outputs = device.zeros(expected.len()).unwrap();
    let arguments = [
        Argument::Count(rows.len() as i32),
        Argument::Doubles(&inputs),
        Argument::Doubles(&outputs),
    ];
    program.kernel("run_functions").unwrap().start(rows.len(), 64, &arguments).unwrap();
    check(&device.download(&outputs).unwrap());
}
