//! What faulty case files are told, word by word.

use super::*;

/// A small good case that the tests break.
const GOOD: &str = "\
version = 1
title = \"A column\"
dimension = 2

[parameters]
speed = 1.0

[[body]]
name = \"column\"
shape = { kind = \"box\", min = [0.0, 0.0], max = [3.0, 5.0] }
spacing = 0.25
material = { kind = \"linear\", density = 1000.0, bulk_modulus = 1e5 }
initial = { velocity = [\"0\", \"-speed\"] }

[scheme]
kind = \"upwind\"
smoothing_length = 0.7

[time]
end = 3.0
";

/// What is said of the good case with `from` replaced by `to`.
fn broken(from: &str, to: &str) -> String {
    assert!(GOOD.contains(from), "{from}");
    read_with(&GOOD.replacen(from, to, 1), &[]).expect_err(to).to_string()
}

#[test]
fn the_good_case_is_good() {
    let case = read_with(GOOD, &[]).unwrap_or_else(|problems| panic!("{problems}"));
    assert_eq!(case.output.every.value, 0.03);
    assert_eq!(case.output.fields.len(), catalogue::fields("upwind").len());
}

#[test]
fn show() {
    for (from, to) in CASES {
        println!("{}", broken(from, to));
    }
}

const CASES: &[(&str, &str)] = &[
    ("spacing = 0.25", "spacng = 0.25"),
    ("spacing = 0.25", "spacing = -0.25"),
    ("spacing = 0.25", "spacing = true"),
    ("end = 3.0", "end = nan"),
    ("end = 3.0", "end = 3,0"),
    ("end = 3.0", "end = "),
    ("end = 3.0", "end = 3.0\nend = 4"),
    ("end = 3.0", "end = 3.0\ncfl = 0.3\nstep = 1e-3"),
    ("[0.0, 0.0]", "[0.0, 0.0, 0.0]"),
    ("[3.0, 5.0]", "[3.0, 0.0]"),
    ("\"box\"", "\"bxo\""),
    (
        "{ kind = \"box\", min = [0.0, 0.0], max = [3.0, 5.0] }",
        "{ kind = \"cylinder\", start = [0, 0, 0] }",
    ),
    (
        "{ kind = \"box\", min = [0.0, 0.0], max = [3.0, 5.0] }",
        "{ kind = \"ball\", min = [0, 0], radius = 0 }",
    ),
    ("bulk_modulus = 1e5", "young_modulus = 1e5, poisson_ratio = 0.5, plane = \"strain\""),
    ("bulk_modulus = 1e5", "young_modulus = 1e5, poisson_ratio = 0.6"),
    ("bulk_modulus = 1e5", "wave_speed = 1, bulk_modulus = 1e5"),
    (", bulk_modulus = 1e5", ""),
    ("\"linear\"", "\"gamma_law\", gamma = 0.5"),
    ("\"-speed\"", "\"-sped * (1 + x)\""),
    ("\"-speed\"", "\"t\""),
    ("[[body]]", "[body]"),
    ("[time]", "[[time]]"),
    ("speed = 1.0", "speed = \"2 * other\"\nother = 1"),
    ("speed = 1.0", "speed = 1.0\nx = 2\nsin = 3\n\"a b\" = 4"),
    ("dimension = 2", "dimension = 4"),
    ("version = 1", "version = 2"),
    ("kind = \"upwind\"", "kind = \"upwind\"\nkernel = \"cubic\"\ncorrection = 1"),
    (
        "end = 3.0",
        "end = 3.0\n\n[output]\nevery = 1e-9\nfields = [\"presure\"]\n\n[[picture]]\nfield = \"velocity\"\ntimes = [1, 4]\n",
    ),
    (
        "end = 3.0",
        "end = 3.0\n\n[[check]]\nquantity = \"top.pressure\"\nexpected = 0\ntolerance = 0.1\nsource = \"s\"\nvariant = \"fast\"\n",
    ),
    (
        "end = 3.0",
        "end = 3.0\n\n[[load]]\nkind = \"body_force\"\nbody = \"colum\"\nacceleration = [\"0\"]\n",
    ),
];
