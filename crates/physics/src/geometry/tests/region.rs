//! Selections.

use crate::Vector;
use crate::geometry::{LatticeKind, LatticeSpec, Particles, Placement, Region, Shape, fill};

fn v(x: f64, y: f64) -> Vector<2> {
    Vector::<2>::new(x, y)
}

/// 11 x 6 particles.
fn sheet(spec: LatticeSpec<2>) -> Particles<2> {
    fill(&Shape::cuboid(v(0.0, 0.0), v(1.0, 0.5)).unwrap(), &spec).unwrap().particles
}

fn columns(region: Region<2>, particles: &Particles<2>) -> Vec<f64> {
    let selected = region.select(particles);
    assert!(selected.is_sorted());
    let mut x: Vec<f64> = selected.iter().map(|&a| particles.position[a as usize].x).collect();
    x.sort_by(f64::total_cmp);
    x.dedup();
    x
}

#[test]
fn regions_select_what_lies_in_them() {
    let particles = sheet(LatticeSpec::square([0.1; 2]));
    let count = |region: Region<2>| region.select(&particles).len();
    assert_eq!(count(Region::All), 66);
    assert_eq!(count(Region::cuboid(v(0.0, 0.0), v(0.3, 0.1)).unwrap()), 8);
    assert_eq!(count(Region::cuboid(v(0.0, 0.2), v(1.0, 0.2)).unwrap()), 11);
    // The five points of a cross, the outer ones on the circle but for rounding.
    assert_eq!(count(Region::ball(v(0.3, 0.3), 0.1).unwrap()), 5);
    assert_eq!(count(Region::half_space(v(0.8, 0.0), v(5.0, 0.0)).unwrap()), 18);
    assert_eq!(count(Region::half_space(v(0.8, 0.0), v(-1e300, 0.0)).unwrap()), 54);
    assert_eq!(count(Region::plane(v(0.0, 0.5), v(0.0, 1e-300)).unwrap()), 11);
    assert_eq!(count(Region::plane(v(0.0, 7.0), v(0.0, 1.0)).unwrap()), 0);
    // A diagonal through the lattice points (k, k); the others are 0.07 away or more.
    assert_eq!(count(Region::plane(v(0.0, 0.0), v(1.0, -1.0)).unwrap()), 6);
}

#[test]
fn a_plane_selects_one_layer_of_oblong_cells() {
    let wall = || Region::plane(v(0.0, 0.0), v(1.0, 0.0)).unwrap();
    assert_eq!(columns(wall(), &sheet(LatticeSpec::square([0.1, 0.5]))), [0.0]);
    let cells = LatticeSpec { placement: Placement::Cells, ..LatticeSpec::square([0.1; 2]) };
    let columns = columns(wall(), &sheet(cells));
    assert!(columns.len() == 1 && (columns[0] - 0.05).abs() < 1e-15, "{columns:?}");
    let hexagonal = LatticeSpec { kind: LatticeKind::Hexagonal, ..LatticeSpec::square([0.1; 2]) };
    let floor = Region::plane(v(0.0, 0.0), v(0.0, 1.0)).unwrap();
    assert_eq!(floor.select(&sheet(hexagonal)).len(), 11);
}

#[test]
fn impossible_regions_are_refused_and_lost_particles_selected_by_none() {
    let nan = v(f64::NAN, 0.0);
    let (o, x) = (v(0.0, 0.0), v(1.0, 0.0));
    for region in [
        Region::plane(nan, x),
        Region::plane(o, nan),
        Region::plane(o, o),
        Region::plane(o, v(f64::INFINITY, 0.0)),
        Region::half_space(nan, x),
        Region::half_space(o, o),
        Region::cuboid(nan, x),
        Region::cuboid(o, nan),
        Region::cuboid(x, o),
        Region::ball(nan, 1.0),
        Region::ball(o, 0.0),
        Region::ball(o, f64::NAN),
    ] {
        assert!(region.is_err(), "{region:?}");
    }
    let mut particles = sheet(LatticeSpec::square([0.1; 2]));
    particles.position.fill(v(f64::NAN, f64::NAN));
    for region in
        [Region::plane(o, x), Region::half_space(o, x), Region::cuboid(o, x), Region::ball(o, 1.0)]
    {
        assert!(region.unwrap().select(&particles).is_empty());
    }
}
