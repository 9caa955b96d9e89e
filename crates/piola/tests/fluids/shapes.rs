//! Walls and bodies of fluid around shapes from files.
#![allow(clippy::unwrap_used, reason = "a panic is how a test fails, in its helpers too")]

use std::f64::consts::PI;

use piola::case::{Finished, Session};

use super::escapes::values;
use super::support::session_beside;

/// A ring of 0.5 m and 0.2 m held under water that is at rest and surrounds it.
const RING: &str = r#"
version = 1
title = "A ring under water"
dimension = 3
[parameters]
dx = 0.08
[domain]
periodic = { x = [-0.96, 0.96], y = [-0.96, 0.96], z = [-0.48, 0.48] }
[[body]]
name = "water"
shape = { kind = "difference", from = { kind = "box", min = [-0.96, -0.96, -0.48], max = [0.96, 0.96, 0.48] }, remove = [{ kind = "surface", file = "ring.obj", scale = 0.5 }] }
spacing = "dx"
lattice = { on = "cells" }
material = { kind = "weakly_compressible", density = 1000.0, wave_speed = 50.0 }
initial = { pressure = "1000 * 9.81 * (0.48 - z)" }
[[body]]
name = "ring"
shape = { kind = "surface", file = "ring.obj", scale = 0.5 }
spacing = "dx"
lattice = { on = "cells" }
material = { kind = "weakly_compressible", density = 1000.0, wave_speed = 50.0 }
wall = {}
[scheme]
kind = "transport_velocity"
[[load]]
kind = "body_force"
body = "water"
acceleration = ["0", "0", "-9.81"]
[[probe]]
name = "ring"
kind = "force"
body = "ring"
[time]
end = 1e-6
"#;

/// A torus of radii 1 and 0.4 with quadrilaterals, without the first `missing` of them.
fn torus(missing: usize) -> String {
    let (around, along) = (64, 24);
    let mut text = String::new();
    for i in 0..around {
        for j in 0..along {
            let [a, b] = [(i, around), (j, along)].map(|(k, n)| 2.0 * PI * k as f64 / n as f64);
            let radius = 1.0 + 0.4 * b.cos();
            let [x, y, z] = [radius * a.cos(), radius * a.sin(), 0.4 * b.sin()];
            text += &format!("v {x} {y} {z}\n");
        }
    }
    for number in missing..around * along {
        let (i, j) = (number / along, number % along);
        let corner = |i: usize, j: usize| i % around * along + j % along + 1;
        let corners = [corner(i, j), corner(i + 1, j), corner(i + 1, j + 1), corner(i, j + 1)];
        text += &format!("f {} {} {} {}\n", corners[0], corners[1], corners[2], corners[3]);
    }
    text
}

/// The same faces, by so much higher up and with numbers that follow.
fn above(surface: &str, height: f64) -> String {
    let of = |word: &'static str| {
        surface.lines().filter_map(move |line| line.strip_prefix(word)).map(str::to_owned)
    };
    let numbers =
        |line: &str| line.split(' ').map(|it| it.parse::<f64>().unwrap()).collect::<Vec<_>>();
    let count = of("v ").count();
    let vertex = |line: String| {
        let place = numbers(&line);
        format!("v {} {} {}\n", place[0], place[1], place[2] + height)
    };
    let face = |line: String| {
        let corners = numbers(&line);
        let corners: Vec<String> =
            corners.iter().map(|corner| (*corner as usize + count).to_string()).collect();
        format!("f {}\n", corners.join(" "))
    };
    of("v ").map(vertex).chain(of("f ").map(face)).collect()
}

fn session(text: &str, surface: &str) -> Result<Session, String> {
    session_beside(&[("ring.obj", surface)], text)
}

fn finished(text: &str, surface: &str) -> Finished {
    let session = session(text, surface).unwrap();
    session.run(&std::sync::atomic::AtomicBool::new(false), &mut |_| {}).unwrap()
}

/// Water lifts what it surrounds by the weight of what this displaces: `2 pi^2 R r^2`. Facets cut 1 % off, and what a sum over
/// a kernel is off by on a lattice is 2 %, as for boxes. On its sides it bears the pressure of the depth of its middle, which
/// such sums leave 2 % of.
#[test]
fn water_lifts_a_ring_from_a_file() {
    let finished = finished(RING, &torus(0));
    let lift = values(&finished, "ring.force.z")[0];
    let exact = 1000.0 * 9.81 * 2.0 * PI * PI * 0.5 * 0.04;
    assert!((lift / exact - 1.0).abs() < 0.03, "{lift} of {exact}");
    for axis in ["x", "y"] {
        let aside = values(&finished, &format!("ring.force.{axis}"))[0];
        let side = 1000.0 * 9.81 * 0.48 * (0.4 * 1.4);
        assert!(aside.abs() < 0.02 * side, "{aside} of {side} along {axis}");
    }
}

/// A wall of packed particles has the volume of its surface and an even density, and what does not go with them is said.
#[test]
fn a_ring_is_packed() {
    let (head, ring) = RING.split_once("name = \"ring\"").unwrap();
    let ring = ring.replacen("on = \"cells\"", "kind = \"packed\"", 1);
    let text = format!("{head}name = \"ring\"{ring}").replace("dx = 0.08", "dx = 0.06");
    let mut planned = session(&text, &torus(0)).unwrap();
    let body = &planned.plan().bodies[1];
    let packing = body.packing.expect("it is packed");
    assert!(packing.is_settled && packing.largest < 0.02, "{packing:?}");
    assert!((body.volume / body.exact_volume.unwrap() - 1.0).abs() < 1e-12);
    for (from, to, said) in [
        ("kind = \"packed\"", "kind = \"packed\", jitter = 0.1", "`jitter` has no meaning"),
        ("on = \"cells\"", "kind = \"packed\"", "cannot cross a periodic boundary"),
    ] {
        let error = session(&text.replacen(from, to, 1), &torus(0)).err().expect(to);
        assert!(error.contains(said) && error.contains("case.toml:"), "{error}");
    }
}

#[test]
fn what_is_wrong_with_a_surface_is_told() {
    let warnings = |surface: &str| session(RING, surface).unwrap().plan().warnings.join("\n");
    let sound = warnings(&torus(0));
    assert!(!sound.contains("ring.obj"), "{sound}");
    let holed = warnings(&torus(1));
    // Of the faces that are left, the first is beside the missing one: the middle of the edge that they had in common.
    let radius = 0.5 * (1.0 + 0.4 * (2.0 * PI / 24.0).cos());
    let x = 0.5 * radius * (1.0 + (2.0 * PI / 64.0).cos());
    let x = format!("{x:.5e}").parse::<f64>().unwrap();
    let said =
        "it has holes: 4 edges have no facet on their other side, first an edge of facet 1 at";
    assert!(holed.contains(&format!("{said} ({x}, ")), "{holed}");
    let thin =
        session(&RING.replace("scale = 0.5", "scale = 0.25"), &torus(0)).unwrap().plan().warnings;
    let thin = thin.join("\n");
    let said = "the body `ring` is 2.5 spacings thick where it is thinnest, behind facet ";
    assert!(thin.contains(said) && thin.contains(") m, less than 3: make"), "{thin}");
    // Another ring, half as high again, goes through the first one.
    let crossing = warnings(&(torus(0) + &above(&torus(0), 0.4)));
    let said = "pairs of facets intersect, first facet ";
    assert!(
        crossing.contains(said) && crossing.contains(" and facet ") && crossing.contains(") m"),
        "{crossing}"
    );
    for (from, to, said) in [
        ("ring.obj", "none.obj", "none.obj"),
        ("ring.obj", "ring.step", "ring.step"),
        ("scale = 0.5", "scale = 0.0", "above 0"),
        ("scale = 0.5", "axis = [0, 0, 0]", "must have a direction"),
        ("dimension = 3", "dimension = 2", "surface"),
    ] {
        let error = session(&RING.replace(from, to), &torus(0)).err().expect(to);
        assert!(error.contains(said) && error.contains("case.toml:"), "{error}");
    }
    let broken = session(RING, "v 0 0 0\nf 1 2 3\n").err().unwrap();
    assert!(broken.contains("ring.obj` is broken") && broken.contains("case.toml:"), "{broken}");
}

/// A hole that is the cause of another fault is told with it.
#[test]
fn what_is_wrong_with_a_surface_is_told_with_other_faults() {
    let case = "version = 1\ntitle = \"A ring\"\ndimension = 3\n[[body]]\nname = \"ring\"\nspacing = 0.1\n\
                shape = { kind = \"surface\", file = \"ring.obj\" }\nlattice = { on = \"cells\" }\n\
                material = { kind = \"linear_elastic\", density = 1.0, young_modulus = 1.0, poisson_ratio = 0.3 }\n\
                [scheme]\nkind = \"dual_support\"\n[time]\nend = 1.0\n[output]\nevery = 1.0\n";
    // Every other face is missing.
    let whole = torus(0);
    let (vertices, faces): (Vec<&str>, Vec<&str>) =
        whole.lines().partition(|line| line.starts_with('v'));
    let half: Vec<&str> = vertices.into_iter().chain(faces.into_iter().step_by(2)).collect();
    let error = session(case, &half.join("\n")).err().unwrap();
    let help = error.split("help: ").nth(1).unwrap();
    assert!(help.contains("neighbours in all directions; this may be the cause: `"), "{error}");
    let said =
        "it has holes: 1536 edges have no facet on their other side, first an edge of facet 1 at (";
    assert!(help.contains(said) && error.contains("case.toml:"), "{error}");
}

/// A plate with a round window, drawn, is filled with its own mass; what is wrong with a drawing is said with the case's line.
#[test]
fn a_body_is_cut_to_a_drawing() {
    let case = |shape: &str| {
        format!(
            "version = 1\ntitle = \"A plate\"\ndimension = 2\n[[body]]\nname = \"plate\"\nspacing = 0.05\n\
             shape = {{ kind = \"outline\", file = \"plate.svg\", {shape} }}\n\
             material = {{ kind = \"linear_elastic\", density = 1.0, young_modulus = 1.0, poisson_ratio = 0.3 }}\n\
             [scheme]\nkind = \"dual_support\"\n[time]\nend = 1.0\n[output]\nevery = 1.0\n"
        )
    };
    let built = |shape: &str, drawing| session_beside(&[("plate.svg", drawing)], &case(shape));
    let drawing = "<svg><path d=\"M0 0h2000v1000h-2000z M1300 500a300 300 0 1 0 -600 0a300 300 0 1 0 600 0z\"/></svg>";
    let body = &built("scale = 0.001", drawing).unwrap().plan().bodies[0];
    let exact = 2.0 - PI * 0.09;
    // Squares of a sixteenth of a spacing that a circle cuts count as inside or outside, about half of them each.
    assert!((body.volume / exact - 1.0).abs() < 1e-3, "{} of {exact}", body.volume);
    let crossing = "<svg><path d=\"M0 0L1000 1000L1000 0L0 1000z\"/></svg>";
    for (shape, drawing, said) in [
        (
            "scale = 0.001",
            crossing,
            "plate.svg`: loop 1: sides 1 and 3 of a polygon cross or touch at (0.5, -0.5) m",
        ),
        ("scale = 0.001", "<svg><rect width=\"3\"/></svg>", "<rect> is not supported"),
        ("scale = 0.0", drawing, "above 0"),
        ("z = [0, 1]", drawing, "no meaning in 2D"),
        ("move = [1]", drawing, "2 entries"),
    ] {
        let error = built(shape, drawing).err().expect(shape);
        assert!(error.contains(said) && error.contains("case.toml:"), "{error}");
    }
}
