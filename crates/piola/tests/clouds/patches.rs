//! Patch tests from the case file on: one stress everywhere, on clouds of nodes and of centroids.

use std::sync::atomic::AtomicBool;

use piola::case::{self, LoadOptions, Session};

use crate::data;

/// A block of 2 m along x, 1 m across, pulled along x by 0.01 of its Young's modulus.
fn block(dimension: usize, mesh: &str, points: &str, rest: &str) -> String {
    let file = data(mesh);
    let (plane, neighbors) = if dimension == 2 { (", plane = \"stress\"", 12) } else { ("", 24) };
    let zero = if dimension == 2 { "" } else { ", \"0\"" };
    let mut text = format!(
        r#"
version = 1
title = "a block is pulled"
dimension = {dimension}
[[body]]
name = "block"
shape = {{ kind = "mesh", file = {file:?}, points = "{points}" }}
material = {{ kind = "linear_elastic", density = 1.0, young_modulus = 1.0, poisson_ratio = 0.3{plane} }}
[scheme]
kind = "dual_support"
neighbors = {neighbors}
[[load]]
kind = "traction"
where = {{ kind = "set", name = "right" }}
traction = ["0.01 * t", "0"{zero}]
[[boundary]]
name = "left"
where = {{ kind = "set", name = "left" }}
displacement = {{ x = "0" }}
[[boundary]]
name = "lower"
where = {{ kind = "set", name = "lower" }}
displacement = {{ y = "0" }}
[time]
integrator = "static"
end = 1.0
step = 1.0
[output]
every = 1.0
{rest}
"#
    );
    // Expressions of probes see the current place.
    let mut probe =
        |name: &str, lines: &str| text += &format!("[[probe]]\nname = \"{name}\"\n{lines}");
    probe("high", "kind = \"extremum\"\nof = \"largest\"\nfield = \"stress.xx\"\n");
    probe("low", "kind = \"extremum\"\nof = \"smallest\"\nfield = \"stress.xx\"\n");
    probe("x", "kind = \"error\"\nfield = \"displacement.x\"\nexact = \"0.01 * x / 1.01\"\n");
    probe("y", "kind = \"error\"\nfield = \"displacement.y\"\nexact = \"-0.003 * y / 0.997\"\n");
    text
}

const SIDE: &str = "[[boundary]]\nname = \"side\"\ndisplacement = { z = \"0\" }\n\
                    where = { kind = \"plane\", point = [0, 0, 0], normal = [0, 0, -1] }\n";

/// The last number of a column.
fn run(text: &str) -> impl Fn(&str) -> f64 + use<> {
    let case = case::parse(text, "case.toml", &LoadOptions::default()).unwrap();
    let session = Session::new(&case).unwrap_or_else(|problems| panic!("{problems}"));
    let finished = session.run(&AtomicBool::new(false), &mut |_| {}).unwrap();
    move |name: &str| *finished.tables.probes.values(name).unwrap().last().unwrap()
}

#[test]
fn a_constant_stress_is_exact_on_clouds_from_meshes() {
    for (dimension, mesh, rest) in [
        (2, "triangles-41.msh", ""),
        (2, "triangles-22.msh", ""),
        (2, "quads.msh", ""),
        (3, "tets-41.msh", SIDE),
    ] {
        for points in ["nodes", "cells"] {
            let last = run(&block(dimension, mesh, points, rest));
            for stress in ["high.stress.xx", "low.stress.xx"] {
                assert!((last(stress) / 0.01 - 1.0).abs() < 1e-8, "{mesh} {points}");
            }
            assert!(last("x.error") < 1e-8 && last("y.error") < 1e-8, "{mesh} {points}");
        }
    }
}

/// What the volumes of nodes are does not matter to the patch test.
#[test]
fn a_constant_stress_is_exact_with_other_volumes() {
    let text = block(3, "tets-41.msh", "nodes", SIDE);
    let text = text.replace("points = \"nodes\"", "points = \"nodes\", volumes = \"nearest\"");
    let last = run(&text);
    assert!((last("high.stress.xx") / 0.01 - 1.0).abs() < 1e-8);
    assert!((last("low.stress.xx") / 0.01 - 1.0).abs() < 1e-8);
}

/// Faces that are held have reactions, and faces that are moved do work.
#[test]
fn faces_of_cells_react_and_work() {
    let probe = "[[probe]]\nname = \"wall\"\nkind = \"sum\"\nfield = \"reaction\"\n";
    let text = block(2, "triangles-41.msh", "cells", probe);
    let last = run(&text);
    assert!((last("wall.reaction.x") + 0.01).abs() < 1e-10, "{}", last("wall.reaction.x"));

    let load = text.find("[[load]]").unwrap();
    let bounds = load..text.find("[[boundary]]").unwrap();
    let moved = "[[boundary]]\nname = \"right\"\nwhere = { kind = \"set\", name = \"right\" }\n\
                 displacement = { x = \"0.02 * t\" }\n";
    let mut text = text;
    text.replace_range(bounds, moved);
    let case = case::parse(&text, "case.toml", &LoadOptions::default()).unwrap();
    let session = Session::new(&case).unwrap_or_else(|problems| panic!("{problems}"));
    let finished = session.run(&AtomicBool::new(false), &mut |_| {}).unwrap();
    let last = |name: &str| *finished.tables.energy.values(name).unwrap().last().unwrap();
    assert!((last("boundary_motion") / 1e-4 - 1.0).abs() < 1e-8, "{}", last("boundary_motion"));
    assert!(last("balance").abs() < 1e-12, "{}", last("balance"));
}

#[test]
fn sets_that_are_not_there_are_named() {
    let text = block(2, "triangles-41.msh", "nodes", "");
    let wrong = |from: &str, to: &str| {
        let text = text.replacen(from, to, 1);
        let problems = match case::parse(&text, "case.toml", &LoadOptions::default()) {
            Ok(case) => Session::new(&case).err().unwrap(),
            Err(problems) => problems,
        };
        format!("{problems}")
    };
    let message = wrong("name = \"right\"", "name = \"rigth\"");
    assert!(message.contains("there is no set `rigth`") && message.contains("right"), "{message}");
    let message = wrong("set\", name = \"right\"", "set\", name = \"block\"");
    assert!(message.contains("no face of the boundary"), "{message}");
    let message = wrong("points = \"nodes\"", "points = \"nodes\", volumes = \"array\"");
    assert!(message.contains("needs the key `array`"), "{message}");
}

/// What holds faces of cells is found by multipliers, of which derivatives are not known.
#[test]
fn held_faces_of_cells_have_no_sensitivity() {
    let text = block(2, "triangles-41.msh", "cells", "");
    let case = case::parse(&text, "case.toml", &LoadOptions::default()).unwrap();
    let mut session = Session::new(&case).unwrap();
    let refused = session.sensitivity("body.block.material.young_modulus").unwrap_err();
    assert!(refused.to_string().contains("where faces of cells are held"), "{refused}");
}
