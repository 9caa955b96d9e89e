//! Walls that are layers around what they hold, from the same file.
#![allow(clippy::unwrap_used, reason = "a panic is how a test fails, in its helpers too")]

use std::f64::consts::PI;

use piola::case::Session;
use piola::time::Outcome;

use super::escapes::values;
use super::support::session_beside;

/// A vessel full of water, from one file.
const VESSEL: &str = r#"
version = 1
title = "Water in a vessel"
dimension = 3
[parameters]
dx = 0.1
[[body]]
name = "water"
shape = { kind = "surface", file = "vessel.obj" }
spacing = "dx"
lattice = { kind = "packed" }
material = { kind = "weakly_compressible", density = 1000.0, wave_speed = 40.0 }
initial = { pressure = "9810 * (0.5 - z)" }
[[body]]
name = "vessel"
shape = { kind = "layer", of = { kind = "surface", file = "vessel.obj" }, thickness = "3 * dx" }
spacing = "dx"
lattice = { kind = "packed" }
material = { kind = "weakly_compressible", density = 1000.0, wave_speed = 40.0 }
wall = { slip = "no" }
[scheme]
kind = "transport_velocity"
artificial_viscosity = 0.1
[[load]]
kind = "body_force"
acceleration = ["0", "0", "-9.81"]
[[probe]]
name = "vessel"
kind = "force"
body = "vessel"
[time]
end = 0.3
"#;

/// A ball of radius 0.5 with quadrilaterals between circles of latitude.
fn ball() -> String {
    let (around, along) = (32, 16);
    let mut text = String::new();
    for j in 0..=along {
        for i in 0..around {
            let [turn, up] = [2.0 * PI * f64::from(i) / 32.0, PI * f64::from(j) / 16.0];
            let (r, z) = (0.5 * up.sin(), -0.5 * up.cos());
            text += &format!("v {:.9} {:.9} {z:.9}\n", r * turn.cos(), r * turn.sin());
        }
    }
    for j in 0..along {
        for i in 0..around {
            let corner = |i: i32, j: i32| i % around + j * around + 1;
            let corners = [corner(i, j), corner(i + 1, j), corner(i + 1, j + 1), corner(i, j + 1)];
            text += &format!("f {} {} {} {}\n", corners[0], corners[1], corners[2], corners[3]);
        }
    }
    text
}

/// A session of a case with these changes, in which `vessel.obj` is the ball.
fn session(changes: &[(&str, &str)]) -> Result<Session, String> {
    let text = changes.iter().fold(VESSEL.to_owned(), |text, (from, to)| {
        assert!(text.contains(from), "{from}");
        text.replacen(from, to, 1)
    });
    let square = "x,y\n0,0\n1,0\n1,1\n0,1\n";
    session_beside(&[("vessel.obj", &ball()), ("vessel.csv", square)], &text)
}

/// The pressure of water at rest grows by `rho g` with the depth, and the vessel bears its weight, to the 3 % that sums over a
/// kernel are off by with ten particles across. The pressure on the whole is free where there is no surface.
#[test]
fn water_rests_in_a_vessel_from_one_file() {
    let mut session = session(&[]).unwrap();
    let plan = session.plan();
    let volume = plan.bodies[0].volume;
    assert!(!plan.warnings.iter().any(|text| text.contains("wall")), "{:?}", plan.warnings);
    session.run_until(0.3).unwrap();
    let [position, pressure] = ["position", "pressure"]
        .map(|name| session.view(name, Some(0)).unwrap().numbers().to_vec());
    let heights: Vec<f64> = position.chunks(3).map(|x| x[2]).collect();
    let mean = |values: &[f64]| values.iter().sum::<f64>() / values.len() as f64;
    let [height, level] = [&heights, &pressure].map(|values| mean(values));
    let (mut both, mut square) = (0.0, 0.0);
    for (z, p) in heights.iter().zip(&pressure) {
        both += (z - height) * (p - level);
        square += (z - height) * (z - height);
    }
    let slope = both / square;
    assert!((slope / -9810.0 - 1.0).abs() < 0.03, "{slope} Pa/m");
    let finished = session.finish().unwrap();
    assert_eq!(finished.summary.outcome, Outcome::Completed);
    let force = *values(&finished, "vessel.force.z").last().unwrap();
    assert!((force / (-9810.0 * volume) - 1.0).abs() < 0.03, "{force} N on {volume} m^3");
}

/// The normals of a vessel lead to its middle, those of the outermost layer of particles too.
#[test]
fn all_particles_of_a_vessel_face_what_it_holds() {
    let mut session = session(&[]).unwrap();
    let [position, normal] =
        ["position", "normal"].map(|name| session.view(name, Some(1)).unwrap().numbers().to_vec());
    let mut furthest = 0.0_f64;
    for (x, normal) in position.chunks(3).zip(normal.chunks(3)) {
        let radius = x.iter().map(|x| x * x).sum::<f64>().sqrt();
        furthest = furthest.max(radius);
        let inwards = -x.iter().zip(normal).map(|(x, n)| x * n).sum::<f64>() / radius;
        // A facet is a 32nd of a turn, and its middle half of that from its ends.
        assert!(inwards > (PI / 16.0).cos(), "{inwards} at {x:?}");
    }
    assert!(furthest > 0.7);
}

/// A plate of 1 m x 1 m in the plane, with what is within 0.2 m of it.
const PLATE: &str = r#"
version = 1
title = "A plate and its rim"
dimension = 2
[[body]]
name = "rim"
shape = { kind = "layer", of = { kind = "outline", file = "vessel.csv" }, thickness = 0.2 }
spacing = 0.05
material = { kind = "linear", density = 1000.0, bulk_modulus = 1e5 }
[scheme]
kind = "upwind"
smoothing_length = 0.7
[time]
end = 1.0
"#;

#[test]
fn outlines_have_layers_on_both_sides() {
    let volume = |side: &str| {
        let side = format!("thickness = 0.2, side = \"{side}\"");
        let mut session = session(&[(VESSEL, PLATE), ("thickness = 0.2", &side)]).unwrap();
        session.plan().bodies[0].volume
    };
    // Quarters of circles at the corners; midpoints are a sixteenth of a cell apart.
    let outside = 4.0 * 0.2 + PI * 0.04;
    assert!((volume("outside") / outside - 1.0).abs() < 1e-3, "{}", volume("outside"));
    let inside = 1.0 - 0.6 * 0.6;
    assert!((volume("inside") - inside).abs() < 1e-12, "{}", volume("inside"));
}

#[test]
fn what_is_wrong_with_a_layer_is_told() {
    let layer = "of = { kind = \"surface\", file = \"vessel.obj\" }, thickness = \"3 * dx\"";
    let ball = "{ kind = \"ball\", center = [0, 0, 0], radius = 0.5 }";
    for (to, said) in [
        ("of = BALL, thickness = 0.0", "`thickness` must be above 0, got 0"),
        ("of = BALL, thickness = \"-dx\"", "`thickness` must be above 0, got -0.1"),
        ("of = BALL", "needs the key `thickness`"),
        ("thickness = 0.3", "needs the key `of`"),
        ("of = BALL, thickness = 0.3, side = \"outsde\"", "did you mean `outside`?"),
        ("of = { kind = \"union\", of = [BALL] }, thickness = 0.3", "make a layer of each shape"),
        (
            "of = { kind = \"layer\", of = BALL, thickness = 0.1 }, thickness = 0.3",
            "the boundary of one shape, not of several or of another layer",
        ),
        (
            "of = { kind = \"points\", file = \"vessel.csv\" }, thickness = 0.3",
            "points cannot be combined with other shapes",
        ),
        ("of = { kind = \"surface\", file = \"vesel.obj\" }, thickness = 0.3", "there is no file"),
    ] {
        let error = session(&[(layer, &to.replace("BALL", ball))]).err().expect(to);
        assert!(error.contains(said) && error.contains("case.toml:"), "{error}");
    }
}

#[test]
fn layers_that_do_not_hold_are_warned_of() {
    let warnings = |changes: &[(&str, &str)]| session(changes).unwrap().plan().warnings.join("\n");
    let thin = warnings(&[("thickness = \"3 * dx\"", "thickness = \"1.5 * dx\"")]);
    assert!(thin.contains("the wall `vessel` is about"), "{thin}");
    let around = "[[body]]\nname = \"bath\"\nshape = { kind = \"annulus\", center = [0, 0, 0], inner = 0.85, outer = 1.05 }\n\
         spacing = \"dx\"\nlattice = { on = \"cells\" }\n\
         material = { kind = \"weakly_compressible\", density = 1000.0, wave_speed = 40.0 }\n[scheme]";
    let behind = warnings(&[("[scheme]", around)]);
    assert!(
        behind
            .contains("the wall `vessel` is a layer, which holds back fluid only at the boundary"),
        "{behind}"
    );
    let skin = warnings(&[(VESSEL, PLATE), ("thickness = 0.2", "thickness = 0.1")]);
    assert!(skin.contains("the body `rim` is 2.0 spacings thick, less than 3"), "{skin}");
}
