//! Which bodies may be partly in the same place.

use super::*;
use crate::case::Session;

/// Two bodies in a box that is 2 m long and periodic along x.
const TWO: &str = "\
version = 1
title = \"Two bodies\"
dimension = 2

[domain]
periodic = { x = [0.0, 2.0] }

[[body]]
name = \"one\"
shape = { kind = \"box\", min = [0.0, 0.0], max = [1.0, 0.5] }
spacing = 0.1
lattice = { on = \"cells\" }
material = { kind = \"weakly_compressible\", density = 1000.0, wave_speed = 10.0 }

[[body]]
name = \"two\"
shape = { kind = \"box\", min = [0.0, 0.5], max = [1.0, 1.0] }
spacing = 0.1
lattice = { on = \"cells\" }
material = { kind = \"weakly_compressible\", density = 1000.0, wave_speed = 10.0 }

[scheme]
kind = \"transport_velocity\"

[time]
end = 0.01
";

/// What is said of overlaps.
fn overlaps(overrides: &[&str]) -> Option<String> {
    let case = read_with(TWO, overrides).unwrap_or_else(|problems| panic!("{problems}"));
    let said = Session::new(&case).map(|_| ()).err()?.to_string();
    assert!(said.contains("the bodies `one` and `two` overlap: particle"), "{overrides:?}: {said}");
    assert!(
        said.contains("cut one out of the other with a shape of the kind `difference`"),
        "{said}"
    );
    Some(said)
}

#[test]
fn walls_may_overlap_walls_alone() {
    assert_eq!(overlaps(&[]), None, "they touch");
    let deep = "body.two.shape.min=[0.0, 0.2]";
    assert!(overlaps(&[deep]).is_some());
    assert!(overlaps(&[deep, "body.two.wall={}"]).is_some());
    // Water for the walls to be around.
    let water = "body+={ name = 'water', shape = { kind = 'box', min = [1.0, 0.0], max = [2.0, 0.5] }, spacing = 0.1, \
                 lattice = { on = 'cells' }, \
                 material = { kind = 'weakly_compressible', density = 1000.0, wave_speed = 10.0 } }";
    assert_eq!(overlaps(&[deep, "body.one.wall={}", "body.two.wall={}", water]), None);
}

/// Nothing in them lies deeper than half a spacing.
#[test]
fn bodies_of_one_layer_may_not_be_in_each_other() {
    let thin = |y: f64| {
        let shape = |min: f64| {
            let max = min + 0.1;
            format!("shape={{ kind = 'box', min = [0.0, {min}], max = [1.0, {max}] }}")
        };
        let (one, two) = (shape(0.0), shape(y));
        overlaps(&[&format!("body.one.{one}"), &format!("body.two.{two}")])
    };
    assert!(thin(0.0).is_some(), "they are in the same place");
    assert!(thin(0.02).is_some());
    assert_eq!(thin(0.1), None, "they touch");
    assert_eq!(thin(0.09), None, "but for a tenth of a spacing");
}

#[test]
fn bodies_meet_through_periodic_ends() {
    let second = |min: f64, max: f64| {
        let shape = format!("{{ kind = 'box', min = [{min}, 0.0], max = [{max}, 0.5] }}");
        overlaps(&[&format!("body.two.shape={shape}")])
    };
    assert_eq!(second(1.0, 2.0), None, "they touch at both ends");
    assert!(second(1.2, 2.2).is_some());
    assert!(second(-0.8, 0.2).is_some());
    assert_eq!(second(-1.0, 0.0), None);
}
