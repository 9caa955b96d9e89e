//! Ghosts around bodies.

use crate::Vector;
use crate::geometry::{LatticeKind, LatticeSpec, Particles, Placement, Shape, fill, surroundings};

/// A body and its surroundings.
fn both<const D: usize>(shape: &Shape<D>, spec: &LatticeSpec<D>, reach: f64) -> [Particles<D>; 2] {
    [fill(shape, spec).unwrap().particles, surroundings(shape, spec, reach).unwrap()]
}

/// Every particle has all the neighbours that it has in an endless lattice, each once: `next` of them
/// at one spacing.
fn assert_endless<const D: usize>(shape: &Shape<D>, spec: &LatticeSpec<D>, next: usize) {
    let spacing = spec.spacing[0];
    let [body, ghosts] = both(shape, spec, 1.5 * spacing);
    let all: Vec<&Vector<D>> = body.position.iter().chain(&ghosts.position).collect();
    for x in &body.position {
        let near = all.iter().filter(|other| (**other - x).norm() < 1.01 * spacing).count();
        assert_eq!(near, next + 1, "{spec:?} at {x}");
    }
    assert!(ghosts.position.iter().all(|x| !shape.contains(x)));
    for [of_body, of_ghosts] in
        [[body.weight[0], ghosts.weight[0]], [body.spacing[0], ghosts.spacing[0]]]
    {
        assert!((of_body / of_ghosts - 1.0).abs() < 1e-12, "{of_body} {of_ghosts}");
    }
}

#[test]
fn ghosts_continue_lattices_on_all_sides_and_in_holes() {
    let ring = Shape::annulus(Vector::<2>::new(0.3, -0.2), 1.0, 2.2).unwrap();
    let hollow = Shape::annulus(Vector::<3>::new(0.3, -0.2, 0.1), 0.5, 1.1).unwrap();
    let (square, cubic) = (LatticeSpec::square([0.2; 2]), LatticeSpec::square([0.2; 3]));
    for placement in [Placement::Boundary, Placement::Cells] {
        assert_endless(&ring, &LatticeSpec { placement, ..square }, 4);
        assert_endless(&hollow, &LatticeSpec { placement, ..cubic }, 6);
        let kind = LatticeKind::Hexagonal;
        assert_endless(&ring, &LatticeSpec { placement, kind, ..square }, 6);
        assert_endless(&hollow, &LatticeSpec { placement, kind, ..cubic }, 12);
    }
}

#[test]
fn a_bar_has_as_many_ghosts_as_fit_into_the_reach() {
    let bar = Shape::cuboid(Vector::<1>::new(0.0), Vector::<1>::new(1.0)).unwrap();
    let spec = LatticeSpec::square([0.26]);
    let [_, ghosts] = both(&bar, &spec, 0.7);
    let places: Vec<f64> = ghosts.position.iter().map(|x| x[0]).collect();
    assert_eq!(places, [-0.5, -0.25, 1.25, 1.5]);
    // Where space repeats itself there is nothing beyond.
    let ghosts = surroundings(&bar, &LatticeSpec { periodic: [true], ..spec }, 0.7).unwrap();
    assert!(ghosts.is_empty());
}
