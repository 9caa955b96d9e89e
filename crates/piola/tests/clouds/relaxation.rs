//! Disordered lattices that are moved apart again.

use piola::Vector;
use piola::geometry::{LatticeSpec, Particles, Shape, fill};
use piola::neighbors::{Domain, search};
use piola::operators::relax;

fn square(jitter: f64) -> Particles<2> {
    let shape = Shape::cuboid(Vector::<2>::zeros(), Vector::<2>::new(1.0, 1.0)).unwrap();
    let spec = LatticeSpec { jitter, seed: 7, ..LatticeSpec::square([0.05; 2]) };
    fill(&shape, &spec).unwrap().particles
}

/// The smallest distance of a free particle from another one in spacings.
fn closest(particles: &Particles<2>, free: &[bool]) -> f64 {
    let list = search(&particles.position, &vec![0.1; particles.len()], &Domain::open()).unwrap();
    let distance =
        |a: usize, b: u32| (particles.position[a] - particles.position[b as usize]).norm() / 0.05;
    let of = |a: usize| list.row(a).iter().map(move |&b| distance(a, b));
    (0..particles.len()).filter(|&a| free[a]).flat_map(of).fold(f64::INFINITY, f64::min)
}

#[test]
fn particles_move_apart_and_the_boundary_stays() {
    let (start, sites) = (square(0.4), square(0.0).position);
    let free: Vec<bool> =
        start.position.iter().map(|x| x.iter().all(|x| *x > 0.01 && *x < 0.99)).collect();
    let stays = |x: &Vector<2>| x.iter().all(|x| (0.0..=1.0).contains(x));
    let relaxed = |steps: u64| {
        let mut particles = start.clone();
        relax(&mut particles, &sites, &free, &stays, &Domain::open(), steps).unwrap();
        particles
    };
    let end = relaxed(40);
    assert_eq!(end, relaxed(40), "no chance is left");
    let (before, after) = (closest(&start, &free), closest(&end, &free));
    assert!(before < 0.45 && after > 0.6, "{before} {after}");
    for (a, x) in end.position.iter().enumerate() {
        assert!(x.iter().all(|x| (0.0..=1.0).contains(x)));
        assert!(free[a] || *x == start.position[a]);
    }
}

#[test]
fn a_lattice_stays_where_it_is() {
    let mut particles = square(0.0);
    let free: Vec<bool> =
        particles.position.iter().map(|x| x.iter().all(|x| *x > 0.01 && *x < 0.99)).collect();
    let sites = particles.position.clone();
    relax(&mut particles, &sites, &free, &|_| true, &Domain::open(), 5).unwrap();
    assert_eq!(particles.position, sites);
}
