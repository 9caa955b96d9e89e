//! A quarter of a body between mirrors is a quarter of the body.

use std::sync::atomic::AtomicBool;

use piola::case::{self, LoadOptions, Session};
use piola::observe::Series;

/// A block that a suction on its ends draws out by about half of its length, in two dimensions.
const BLOCK: &str = r#"
version = 1
title = "A block"
dimension = 2

[[body]]
name = "block"
shape = { kind = "box", min = MIN, max = [1.0, 0.5] }
spacing = 0.1
lattice = { on = "boundary" }
material = { kind = "neo_hookean_logarithmic", density = 1.0, young_modulus = 1.0, poisson_ratio = 0.35 }

[scheme]
kind = "total_lagrangian"
gradients = "plain"
support = 2.6
hourglass = 0.2

[[boundary]]
name = "across"
where = { kind = "plane", point = [0.0, 0.0], normal = [-1.0, 0.0] }
displacement = { x = "0" }
mirror = MIRROR

[[boundary]]
name = "along"
where = { kind = "plane", point = [0.0, 0.0], normal = [0.0, -1.0] }
displacement = { y = "0" }
mirror = MIRROR

[[load]]
name = "right"
kind = "pressure"
where = { kind = "plane", point = [1.0, 0.0], normal = [1.0, 0.0] }
pressure = "-0.4 * t"
LEFT

[time]
integrator = "static"
end = 1.0
step = 0.25
tolerance = 1e-11

[[probe]]
name = "corner"
kind = "particle"
at = [1.0, 0.5]
fields = ["displacement", "stress"]

[[probe]]
name = "inside"
kind = "particle"
at = [0.3, 0.2]
fields = ["displacement", "stress"]

[[probe]]
name = "middle"
kind = "particle"
at = [0.0, 0.0]
fields = ["stress"]
"#;

const LEFT: &str = r#"
[[load]]
name = "left"
kind = "pressure"
where = { kind = "plane", point = [-1.0, 0.0], normal = [-1.0, 0.0] }
pressure = "-0.4 * t"
"#;

const COLUMNS: [&str; 12] = [
    "corner.displacement.x",
    "corner.displacement.y",
    "corner.stress.xx",
    "corner.stress.xy",
    "inside.displacement.x",
    "inside.displacement.y",
    "inside.stress.xx",
    "inside.stress.xy",
    "middle.stress.xx",
    "middle.stress.yy",
    "energy.strain",
    "energy.hourglass",
];

fn values(min: &str, mirror: &str, left: &str, names: &[&str]) -> Vec<f64> {
    let text = BLOCK.replace("MIN", min).replace("MIRROR", mirror).replace("LEFT", left);
    let case = case::parse(&text, "case.toml", &LoadOptions::default());
    let case = case.unwrap_or_else(|problems| panic!("{problems}"));
    let session = Session::new(&case).unwrap_or_else(|problems| panic!("{problems}"));
    let finished = session.run(&AtomicBool::new(false), &mut |_| {}).unwrap();
    let last = |name: &&str| match finished.quantity(name) {
        Some(Series::Curve { values, .. }) => *values.last().expect("a row at the end"),
        other => panic!("{name}: {other:?}"),
    };
    names.iter().map(last).collect()
}

#[test]
fn a_quarter_between_mirrors_is_a_quarter_of_the_body() {
    let whole = values("[-1.0, -0.5]", "false", LEFT, &COLUMNS);
    let quarter = values("[0.0, 0.0]", "true", "", &COLUMNS);
    assert!(whole[0] > 0.3, "it is drawn out by {} m", whole[0]);
    for ((name, whole), quarter) in COLUMNS.iter().zip(&whole).zip(&quarter) {
        let share = if name.starts_with("energy") { 0.25 } else { 1.0 };
        let off = (quarter - share * whole).abs();
        assert!(off < 1e-8 * (1.0 + whole.abs()), "{name}: {quarter} for {}", share * whole);
    }
}
