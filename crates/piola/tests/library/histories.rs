//! Loads and boundaries whose size a table gives over time.
#![allow(clippy::unwrap_used, reason = "a test that cannot set itself up has failed")]

use std::fs;
use std::sync::atomic::AtomicBool;

use piola::case::{self, LoadOptions, Session};

/// A free block under a body force.
const CASE: &str = r#"
version = 1
title = "A block"
dimension = 2

[[body]]
name = "block"
shape = { kind = "box", min = [0.0, 0.0], max = [1.0, 1.0] }
spacing = 0.25
material = { kind = "linear_elastic", density = 1000.0, young_modulus = 1e6, poisson_ratio = 0.3, plane = "strain" }

[scheme]
kind = "elastodynamics"

[time]
end = 1.0

[[probe]]
name = "corner"
kind = "particle"
at = [0.0, 0.0]
fields = ["velocity", "displacement"]
"#;

/// The corner's velocity and displacement at the end, by component.
fn end(more: &str, table: &str) -> [f64; 4] {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("case.toml");
    fs::write(&file, format!("{CASE}{more}")).unwrap();
    fs::write(folder.path().join("table.csv"), table).unwrap();
    let case = case::load(&file, &LoadOptions::default());
    let session = Session::new(&case.unwrap_or_else(|problems| panic!("{problems}"))).unwrap();
    let finished = session.run(&AtomicBool::new(false), &mut |_| {}).unwrap();
    let last = finished.tables.probes.rows().last().unwrap().to_vec();
    last[1..].try_into().unwrap()
}

/// The whole block falls with an acceleration of 2 t, then 2 - t, then 0.
#[test]
fn a_body_force_follows_its_table() {
    let load = r#"
[[load]]
kind = "body_force"
acceleration = ["0", "-2"]
history = "table.csv"
"#;
    let [u, v, x, y] = end(load, "time,factor\n0,0\n0.5,1\n1,0\n");
    // The integral of the triangle, and the integral of that.
    assert!((v + 1.0).abs() < 1e-4 && (y + 0.5).abs() < 1e-4, "{v} {y}");
    assert!(u.abs() < 1e-12 && x.abs() < 1e-12);
}

#[test]
fn a_prescribed_velocity_follows_its_table() {
    let boundary = r#"
[[boundary]]
name = "all"
where = { kind = "all" }
velocity = { x = "3", y = "0" }
history = "table.csv"
"#;
    let [u, v, x, y] = end(boundary, "0,0\n1,1\n");
    assert_eq!([u, v, y], [3.0, 0.0, 0.0]);
    assert!((x - 1.5).abs() < 1e-12, "{x}");
}
