//! A body that is turned, with all that acts on it, does what it does where it is not.

use piola::case::{self, LoadOptions, Session};

use crate::statics::mirrors::values;

/// The angle, and the axis in 3D.
const ANGLE: f64 = 0.6;
const AXIS: [f64; 3] = [2.0, -1.0, 2.0];
/// A point that stays.
const ABOUT: [f64; 3] = [0.3, -0.2, 0.5];

/// A vector turned, by the formula of Rodrigues.
fn turned(x: [f64; 3], dimension: usize) -> [f64; 3] {
    let axis = if dimension == 2 { [0.0, 0.0, 1.0] } else { AXIS.map(|a| a / 3.0) };
    let cross: [f64; 3] = std::array::from_fn(|i| {
        let (j, k) = ((i + 1) % 3, (i + 2) % 3);
        axis[j] * x[k] - axis[k] * x[j]
    });
    let along: f64 = axis.iter().zip(x).map(|(a, x)| a * x).sum();
    std::array::from_fn(|i| {
        x[i] * ANGLE.cos() + cross[i] * ANGLE.sin() + axis[i] * along * (1.0 - ANGLE.cos())
    })
}

/// A bar that is held at one end, under its weight, a traction on its end and a pressure on its top, as it is or
/// turned.
fn bar(dimension: usize, scheme: &str, on: &str, is_turned: bool) -> String {
    let vector = |x: [f64; 3]| format!("{:?}", &x[..dimension]);
    let way = |x: [f64; 3]| if is_turned { turned(x, dimension) } else { x };
    let place = |x: [f64; 3]| {
        let arm = way(std::array::from_fn(|i| x[i] - ABOUT[i]));
        vector(std::array::from_fn(|i| if is_turned { ABOUT[i] + arm[i] } else { x[i] }))
    };
    let texts = |x: [f64; 3]| {
        format!("{:?}", way(x)[..dimension].iter().map(f64::to_string).collect::<Vec<_>>())
    };
    let block = format!(
        "{{ kind = 'box', min = {}, max = {} }}",
        vector([0.0; 3]),
        vector([1.0, 0.25, 0.25])
    );
    let axis = if dimension == 3 { format!(", axis = {AXIS:?}") } else { String::new() };
    let shape = match is_turned {
        true => format!(
            "{{ kind = 'turned', of = {block}, angle = {ANGLE}, about = {}{axis} }}",
            vector(ABOUT)
        ),
        false => block,
    };
    let spacing = vector([0.1, 0.0625, 0.125]);
    let held = ["x = '0'", "y = '0'", "z = '0'"][..dimension].join(", ");
    let edge = if on == "cells" { 0.5 } else { 0.0 };
    let tip = [1.0 - 0.1 * edge, 0.0625 * edge, 0.125 * edge];
    format!(
        "version = 1\ntitle = 'A bar'\ndimension = {dimension}\n\n\
         [[body]]\nname = 'bar'\nshape = {shape}\nspacing = {spacing}\nlattice = {{ on = '{on}' }}\n\
         material = {{ kind = 'neo_hookean_logarithmic', density = 1.0, young_modulus = 100.0, poisson_ratio = 0.3 }}\n\n\
         [scheme]\nkind = '{scheme}'\n\n[time]\nend = 0.05\n\n\
         [[boundary]]\nname = 'held'\nwhere = {{ kind = 'half_space', point = {}, normal = {} }}\n\
         velocity = {{ {held} }}\n\n\
         [[load]]\nname = 'weight'\nkind = 'body_force'\nacceleration = {}\n\n\
         [[load]]\nname = 'end'\nkind = 'traction'\nwhere = {{ kind = 'plane', point = {}, normal = {} }}\n\
         traction = {}\n\n\
         [[load]]\nname = 'top'\nkind = 'traction'\nwhere = {{ kind = 'plane', point = {}, normal = {} }}\n\
         traction = {}\n\n\
         [[probe]]\nname = 'tip'\nkind = 'particle'\nat = {}\nfields = ['displacement', 'velocity']\n",
        place([0.1 * edge + 0.01, 0.0, 0.0]),
        vector(way([-1.0, 0.0, 0.0])),
        texts([0.0, -10.0, 3.0]),
        place([1.0 - 0.1 * edge, 0.0, 0.0]),
        vector(way([1.0, 0.0, 0.0])),
        texts([1.0, 0.5, -0.2]),
        place([0.0, 0.25 - 0.0625 * edge, 0.0]),
        vector(way([0.0, 1.0, 0.0])),
        texts([0.0, -2.0, 0.0]),
        place(tip),
    )
}

/// Rotations change sums by round-off, some 1e-16 of numbers up to 1e3 times as large as their sum, in some hundred
/// steps.
#[test]
fn a_turned_bar_bends_as_it_does_where_it_is_not() {
    for (dimension, scheme, on) in [
        (2, "total_lagrangian", "boundary"),
        (2, "total_lagrangian", "cells"),
        (2, "dual_support", "boundary"),
        (2, "elastodynamics", "boundary"),
        (3, "total_lagrangian", "boundary"),
        (3, "elastodynamics", "cells"),
    ] {
        let of = |is_turned| -> Vec<[f64; 3]> {
            let text = bar(dimension, scheme, on, is_turned);
            let vector = |field: &str| -> [f64; 3] {
                let names = ["x", "y", "z"].map(|axis| format!("tip.{field}.{axis}"));
                let names: Vec<&str> = names[..dimension].iter().map(String::as_str).collect();
                let mut whole = values(&text, &names);
                whole.resize(3, 0.0);
                [whole[0], whole[1], whole[2]]
            };
            vec![vector("displacement"), vector("velocity")]
        };
        for (straight, found) in of(false).into_iter().zip(of(true)) {
            let expected = turned(straight, dimension);
            let size = straight.iter().map(|x| x.abs()).fold(0.0, f64::max);
            let axis_by_axis = (0..dimension).map(|i| (found[i] - expected[i]).abs());
            let off = axis_by_axis.fold(0.0, f64::max) / size;
            assert!(size > 1e-4, "{scheme}: nothing moves");
            assert!(
                off < 1e-9,
                "{scheme} in {dimension}D on {on}: {off:e}, {found:?} for {expected:?}"
            );
        }
    }
}

/// As in the deflection of a part whose supports move.
#[test]
fn a_probe_shows_what_one_particle_has_more_than_another() {
    let probe = |name: &str, more: &str| {
        format!(
            "\n[[probe]]\nname = '{name}'\nkind = 'particle'\nat = [0.5, 0.125]\nfields = ['velocity']\n{more}"
        )
    };
    let text = bar(2, "total_lagrangian", "boundary", false)
        + &probe("middle", "")
        + &probe("relative", "relative_to = [1.0, 0.0]\n");
    for axis in ["x", "y"] {
        let names = ["middle", "tip", "relative"].map(|name| format!("{name}.velocity.{axis}"));
        let [middle, tip, relative] = values(&text, &names.each_ref().map(String::as_str))[..]
        else {
            panic!("three values")
        };
        assert!(tip.abs() > 1e-3 && relative == middle - tip, "{middle} {tip} {relative}");
    }
}

/// What is wrong with a shape is told with its place.
#[test]
fn shapes_that_are_none_are_refused() {
    let refused = |shape: &str| {
        let text = bar(2, "total_lagrangian", "boundary", false)
            .replace("{ kind = 'box', min = [0.0, 0.0], max = [1.0, 0.25] }", shape);
        let case = case::parse(&text, "case.toml", &LoadOptions::default());
        let problems = case.and_then(|case| Session::new(&case).map(|_| ()));
        problems.err().map_or_else(String::new, |problems| problems.to_string())
    };
    for (shape, expected) in [
        ("{ kind = 'polygon', corners = [[0, 0], [1, 1], [1, 0], [0, 1]] }", "sides 1 and 3"),
        ("{ kind = 'polygon', corners = [[0, 0], [1, 0]] }", "2 corners, expected at least 3"),
        ("{ kind = 'polygon', corners = [[0, 0], [1, 0, 0], [1, 1]] }", "2 entries: x and y"),
        ("{ kind = 'polygon', corners = [[0, 0], [1, 0], [1, 1]], z = [0, 1] }", "in 2D"),
        (
            "{ kind = 'turned', angle = 0.1, axis = [0, 1], of = { kind = 'ball', center = [0, 0], radius = 1 } }",
            "where it is z",
        ),
        ("{ kind = 'turned', of = { kind = 'ball', center = [0, 0], radius = 1 } }", "`angle`"),
    ] {
        let told = refused(shape);
        assert!(told.contains(expected) && told.contains("case.toml:7"), "{shape}: {told}");
    }
}

/// A bar across a domain that repeats itself: at an angle its lattice does not, and it has its ends where it is.
#[test]
fn a_turned_bar_in_a_periodic_domain_has_ends() {
    let alone = bar(2, "total_lagrangian", "cells", true);
    let domain = "[domain]\nperiodic = { x = [-2.0, 1.5] }\n\n[scheme]";
    let names = ["tip.displacement.x", "tip.displacement.y"];
    let around = alone.replace("[scheme]", domain);
    assert_eq!(values(&alone, &names), values(&around, &names));
    let long = around.replace("min = [0.0, 0.0], max = [1.0", "min = [-5.0, 0.0], max = [5.0");
    let case = case::parse(&long, "case.toml", &LoadOptions::default()).unwrap();
    let told = Session::new(&case).err().map_or_else(String::new, |problems| problems.to_string());
    assert!(told.contains("turned body") && told.contains("case.toml:7"), "{told}");
    // About z, along which the domain repeats itself, nothing is turned.
    let strip = bar(3, "total_lagrangian", "cells", true)
        .replace("axis = [2.0, -1.0, 2.0]", "axis = [0.0, 0.0, 1.0]")
        .replace("[scheme]", "[domain]\nperiodic = { z = [0.0, 0.25] }\n\n[scheme]");
    let case = case::parse(&strip, "case.toml", &LoadOptions::default()).unwrap();
    let told = Session::new(&case).err().map_or_else(String::new, |problems| problems.to_string());
    assert!(!told.contains("turned body"), "{told}");
}
