//! Probes and pictures of fluids and of what is in them, against what is known.

use std::sync::atomic::AtomicBool;

use piola::case::{self, LoadOptions, Session};

use crate::contact::columns;

/// What a gauge, a flux, a mean and a force show of water at rest and of a uniform stream.
#[test]
fn probes_of_fluids_show_what_is_known() {
    let still = r#"
version = 1
title = "A rigid box that is held under water"
dimension = 2
[parameters]
dx = 0.05
[[body]]
name = "water"
shape = { kind = "difference", from = { kind = "box", min = [0.0, 0.0], max = [2.0, 1.05] }, remove = [{ kind = "box", min = [0.8, 0.4], max = [1.2, 0.7] }] }
spacing = "dx"
lattice = { on = "cells" }
material = { kind = "weakly_compressible", density = 1000.0, wave_speed = 50.0 }
initial = { pressure = "1000 * 9.81 * (1.05 - y)" }
[[body]]
name = "tank"
shape = { kind = "difference", from = { kind = "box", min = ["-4*dx", "-4*dx"], max = ["2+4*dx", "1.5"] }, remove = [{ kind = "box", min = [0.0, 0.0], max = [2.0, 2.0] }] }
spacing = "dx"
lattice = { on = "cells" }
material = { kind = "weakly_compressible", density = 1000.0, wave_speed = 50.0 }
wall = { slip = "free" }
[[body]]
name = "box"
system = "box"
shape = { kind = "box", min = [0.8, 0.4], max = [1.2, 0.7] }
spacing = "dx"
lattice = { on = "cells" }
material = { kind = "rigid", density = 500.0 }
[scheme]
kind = "transport_velocity"
free_surface = true
[[system]]
name = "box"
scheme = { kind = "total_lagrangian" }
slip = "free"
[[load]]
kind = "body_force"
body = "water"
acceleration = ["0", "-9.81"]
[[boundary]]
name = "held"
body = "box"
where = { kind = "all" }
velocity = { x = "0", y = "0" }
angular_velocity = { z = "0" }
[[probe]]
name = "lift"
kind = "force"
body = "box"
about = [1.0, 0.0]
[[probe]]
name = "pressed"
kind = "force"
body = "box"
field = "pressure_force"
about = [0.0, 0.0]
[[probe]]
name = "viscous"
kind = "force"
body = "box"
field = "viscous_force"
[[probe]]
name = "level"
kind = "gauge"
body = "water"
from = [0.4, 0.2]
to = [0.4, 1.6]
[[probe]]
name = "dry"
kind = "gauge"
body = "water"
from = [0.4, 1.2]
to = [0.4, 1.6]
[[probe]]
name = "floor"
kind = "sensor"
body = "tank"
at = [0.43, 0.0]
normal = [0.0, 2.0]
radius = 0.11
[[probe]]
name = "side"
kind = "sensor"
body = "tank"
at = [2.0, 0.525]
normal = [-1.0, 0.0]
radius = 0.06
[[probe]]
name = "above"
kind = "sensor"
body = "tank"
at = [0.0, 1.35]
normal = [1.0, 0.0]
radius = 0.06
[[probe]]
name = "between"
kind = "point"
body = "water"
at = [0.43, 0.31]
relative_to = [1.71, 0.77]
fields = ["pressure"]
[[probe]]
name = "bare"
kind = "void"
body = "water"
[[plot]]
name = "both"
curves = ["level.elevation", "lift.force.y"]
[time]
end = 1e-5
"#;
    let names = [
        "lift.force.y",
        "lift.moment.z",
        "pressed.pressure_force.y",
        "pressed.moment.z",
        "viscous.viscous_force.y",
        "level.elevation",
        "dry.elevation",
        "floor.pressure",
        "side.pressure",
        "above.pressure",
        "between.pressure",
        "bare.volume",
    ];
    let found = columns(still, &[], names).map(|column| column[0]);
    // The box displaces 0.12 m2 of water.
    let weight = 0.12 * 9810.0;
    assert!((found[0] / weight - 1.0).abs() < 0.02, "{found:?}");
    assert!(found[1].abs() < 1e-9 * weight, "{found:?}");
    assert!((found[2] - found[0]).abs() < 1e-9 * weight, "{found:?}");
    assert!((found[3] - found[2]).abs() < 1e-9 * weight, "about the origin: {found:?}");
    assert!(found[4].abs() < 1e-9 * weight, "{found:?}");
    // A hundredth of the spacing is the ripple of a kernel sum.
    assert!((found[5] - 0.85).abs() < 0.01 * 0.05, "{found:?}");
    assert_eq!(found[6], 0.0);
    // Sensors 1.05 and 0.525 m under the surface: what a kernel's sum is off by on a lattice, as for the box.
    for (pressure, depth) in [(found[7], 1.05), (found[8], 0.525)] {
        assert!((pressure / (9810.0 * depth) - 1.0).abs() < 0.02, "{found:?}");
    }
    assert_eq!(found[9], 0.0);
    // Interpolation is exact for what is linear.
    assert!((found[10] - 9810.0 * 0.46).abs() < 1e-6, "{found:?}");
    // The hole of the box in the water, whose volume is known to a cell of a third of a spacing along its edge.
    assert!((found[11] - 0.12).abs() < 1.4 * 0.05 / 3.0, "{found:?}");
    let misplaced = [
        ("at = [0.43, 0.0]", "at = [0.43, 0.5]", "no particle of the wall is behind this place"),
        (
            "normal = [0.0, 2.0]",
            "normal = [0.0, -2.0]",
            "the wall continues in front of the sensor",
        ),
        ("body = \"tank\"\nat = [0.43", "body = \"water\"\nat = [0.43", "`floor` is in no wall"),
        ("body = \"tank\"\nat = [0.43", "body = \"box\"\nat = [0.43", "`floor` is in no wall"),
    ];
    for (from, to, said) in misplaced {
        assert!(still.contains(from), "{from}");
        let read = case::parse(&still.replacen(from, to, 1), "test", &LoadOptions::default());
        let refused = read.and_then(|case| Session::new(&case).map(|_| ()));
        let text = refused.expect_err(to).to_string();
        assert!(text.contains(said) && text.contains("test:"), "{text}");
    }

    let stream = r#"
version = 1
title = "A uniform stream"
dimension = 2
[domain]
periodic = { x = [0.0, 1.0], y = [0.0, 0.5] }
[[body]]
name = "water"
shape = { kind = "box", min = [0.0, 0.0], max = [1.0, 0.5] }
spacing = 0.05
lattice = { on = "cells" }
material = { kind = "weakly_compressible", density = 1000.0, wave_speed = 10.0 }
initial = { velocity = [0.7, 0.1], pressure = "7" }
[scheme]
kind = "transport_velocity"
[[probe]]
name = "through"
kind = "flux"
point = [0.52, 0.0]
normal = [2.0, 0.0]
[[probe]]
name = "part"
kind = "flux"
point = [0.52, 0.0]
normal = [-1.0, 0.0]
min = [0.0, 0.0]
max = [1.0, 0.25]
[[probe]]
name = "mean"
kind = "mean"
field = "pressure"
[[probe]]
name = "hole"
kind = "void"
[time]
end = 0.01
"#;
    let names = ["through.flux", "part.flux", "mean.pressure", "hole.volume"];
    let found = columns(stream, &[], names).map(|column| column[0]);
    // A hat over a lattice of half its width sums up exactly; 7 Pa make the water denser by 7e-5.
    assert!((found[0] - 350.0245).abs() < 1e-9, "{found:?}");
    assert!((found[1] + 175.01225).abs() < 1e-9, "{found:?}");
    assert!((found[2] - 7.0).abs() < 1e-9, "{found:?}");
    assert_eq!(found[3], 0.0);
}

/// An even pressure is seen in any number of dimensions and over a periodic bound, next to which the sensors are. What a
/// kernel's sum is off by on a lattice is under 2 %, as for a floor under water.
#[test]
fn a_sensor_sees_an_even_pressure_in_any_dimension() {
    let cut = |all: [&str; 3], dimension: usize| format!("[{}]", all[..dimension].join(", "));
    for dimension in 1..=3 {
        let shape = |from: &str, to: &str| {
            let corners = [[from, "0.0", "0.0"], [to, "0.4", "0.4"]].map(|it| cut(it, dimension));
            format!("{{ kind = 'box', min = {}, max = {} }}", corners[0], corners[1])
        };
        let periodic = ["y = [0.0, 0.4]", "z = [0.0, 0.4]"][..dimension - 1].join(", ");
        let domain = match dimension {
            1 => String::new(),
            _ => format!("[domain]\nperiodic = {{ {periodic} }}\n"),
        };
        let matter = "spacing = 0.05\nlattice = { on = 'cells' }\n\
                      material = { kind = 'weakly_compressible', density = 1000.0, wave_speed = 10.0 }";
        let text = format!(
            "version = 1\ntitle = 'Pressed water'\ndimension = {dimension}\n{domain}\
             [[body]]\nname = 'water'\nshape = {}\n{matter}\ninitial = {{ pressure = '7' }}\n\
             [[body]]\nname = 'ends'\nshape = {{ kind = 'union', of = [{}, {}] }}\n{matter}\nwall = {{ slip = 'free' }}\n\
             [scheme]\nkind = 'transport_velocity'\n\
             [[probe]]\nname = 'left'\nkind = 'sensor'\nbody = 'ends'\nat = {}\nnormal = {}\nradius = 0.07\n\
             [[probe]]\nname = 'right'\nkind = 'sensor'\nbody = 'ends'\nat = {}\nnormal = {}\nradius = 0.11\n\
             [time]\nend = 1e-6\n",
            shape("0.0", "1.0"),
            shape("-0.2", "0.0"),
            shape("1.0", "1.2"),
            cut(["0.0", "0.01", "0.38"], dimension),
            cut(["1.0", "0.0", "0.0"], dimension),
            cut(["1.0", "0.39", "0.0"], dimension),
            cut(["-2.0", "0.0", "0.0"], dimension),
        );
        for pressure in columns(&text, &[], ["left.pressure", "right.pressure"]) {
            assert!((pressure[0] / 7.0 - 1.0).abs() < 0.02, "{dimension}D: {pressure:?}");
        }
    }
}

/// Pictures in 3D show what is between walls: with them and without them they are the same to the byte at the start. In
/// 2D walls hide nothing, and are shown.
#[test]
fn pictures_in_3d_leave_out_walls() {
    for dimension in [2, 3] {
        let cut = |all: [&str; 3]| format!("[{}]", all[..dimension].join(", "));
        let (low, high) = (cut(["0.0"; 3]), cut(["0.4"; 3]));
        let (under, over) = (cut(["-0.2"; 3]), cut(["0.6"; 3]));
        let matter = "spacing = 0.05\nlattice = { on = 'cells' }\n\
                      material = { kind = 'weakly_compressible', density = 1000.0, wave_speed = 10.0 }\n";
        let water = format!(
            "version = 1\ntitle = 'Water'\ndimension = {dimension}\n\
             [[body]]\nname = 'water'\nshape = {{ kind = 'box', min = {low}, max = {high} }}\n{matter}\
             initial = {{ pressure = '7 + x' }}\n"
        );
        let tank = format!(
            "[[body]]\nname = 'tank'\nshape = {{ kind = 'difference', from = {{ kind = 'box', min = {under}, \
             max = {over} }}, remove = [{{ kind = 'box', min = {low}, max = {high} }}] }}\n{matter}\
             wall = {{ slip = 'free' }}\n"
        );
        let rest = "[scheme]\nkind = 'transport_velocity'\nfree_surface = true\n[time]\nend = 1e-5\n\
                    [[picture]]\nfield = 'pressure'\ntimes = [0.0]\nrange = [0.0, 10.0]\n";
        let drawn = |tank: &str| {
            let case =
                case::parse(&format!("{water}{tank}{rest}"), "case.toml", &LoadOptions::default());
            let case = case.unwrap_or_else(|problems| panic!("{problems}"));
            let mut session = Session::new(&case).unwrap_or_else(|problems| panic!("{problems}"));
            let folder = tempfile::tempdir().expect("there is room");
            session.write_to(folder.path()).expect("it is empty");
            session.run(&AtomicBool::new(false), &mut |_| {}).expect("it runs");
            std::fs::read(folder.path().join("pictures/pressure_000000.png")).expect("it is drawn")
        };
        assert_eq!(drawn(&tank) == drawn(""), dimension == 3, "{dimension}D");
    }
}
