//! Layers around a centre or an axis.

use std::f64::consts::PI;

use crate::Vector;
use crate::geometry::{
    FillReport, GeometryError, LatticeKind, LatticeSpec, Placement, Shape, fill,
};

fn layers<const D: usize>(
    shape: &Shape<D>,
    spacing: f64,
    placement: Placement,
) -> Result<FillReport<D>, GeometryError> {
    let square = LatticeSpec::square([spacing; D]);
    fill(shape, &LatticeSpec { kind: LatticeKind::Concentric, placement, ..square })
}

/// Fills a shape in layers on and half a layer inside of its faces: volumes sum up to that of the shape, the outermost
/// layer lies where it has to, and nobody is too near to another or too far from all others.
fn check<const D: usize>(shape: &Shape<D>, spacing: f64, faces: impl Fn(&Vector<D>) -> f64) {
    let exact = shape.exact_volume().unwrap();
    for placement in [Placement::Boundary, Placement::Cells] {
        let report = layers(shape, spacing, placement).unwrap();
        assert!((report.total_volume / exact - 1.0).abs() < 1e-12, "{placement:?}");
        let (all, width) = (&report.particles, report.actual_spacing[0]);
        let depth: Vec<f64> = all.position.iter().map(&faces).collect();
        let least = depth.iter().copied().fold(f64::INFINITY, f64::min);
        let expected = if placement == Placement::Cells { 0.5 * width } else { 0.0 };
        assert!((least - expected).abs() < 1e-12, "{placement:?}: {least}");
        // Everybody stands in a layer.
        for depth in &depth {
            let layer = (depth - expected) / width;
            assert!((layer - layer.round()).abs() < 1e-9, "{placement:?}: {layer}");
        }
        for (a, x) in all.position.iter().enumerate() {
            let others = all.position.iter().enumerate().filter(|(b, _)| *b != a);
            let near = others.map(|(_, y)| (x - y).norm()).fold(f64::INFINITY, f64::min);
            assert!((0.45..1.3).contains(&(near / width)), "{placement:?}: {near} at {x}");
            assert!(all.weight[a] > 0.999 * all.volume[a]);
            let cell = all.weight[a] / width.powi(D as i32);
            // The innermost layer of a ball has room for 1 of 0.5 cells, or for 3 of 1.4.
            assert!((0.5..1.4).contains(&cell), "{placement:?}: {cell} at {x}");
        }
    }
}

#[test]
fn rings_fill_a_disc_and_an_annulus() {
    let center = Vector::<2>::new(0.2, -0.1);
    let disc = Shape::ball(center, 0.05).unwrap();
    check(&disc, 0.0101, |x| 0.05 - (x - center).norm());
    let ring = Shape::annulus(center, 0.02, 0.05).unwrap();
    check(&ring, 0.0049, |x| (0.05 - (x - center).norm()).min((x - center).norm() - 0.02));
}

#[test]
fn shells_fill_a_ball_and_rings_a_cylinder_askew() {
    let center = Vector::<3>::new(0.2, -0.1, 3.0);
    check(&Shape::ball(center, 1.0).unwrap(), 0.17, |x| 1.0 - (x - center).norm());
    let axis = Vector::<3>::new(1.0, 2.0, -1.0).normalize();
    let cylinder = Shape::cylinder(center, center + axis * 2.0, 0.6).unwrap();
    check(&cylinder, 0.1, |x| {
        let along = (x - center).dot(&axis);
        let round = 0.6 - (x - center - axis * along).norm();
        round.min(along).min(2.0 - along)
    });
    let bar = Shape::ball(Vector::<1>::new(0.5), 0.3).unwrap();
    check(&bar, 0.1, |x| 0.3 - (x[0] - 0.5).abs());
}

/// What a wall does to a fluid that flows past it along x has no part across.
#[test]
fn rings_are_even_and_mirror_images_of_themselves() {
    let disc = Shape::ball(Vector::<2>::zeros(), 0.05).unwrap();
    let report = layers(&disc, 0.01, Placement::Cells).unwrap();
    let all = &report.particles.position;
    let counts: Vec<usize> = (0..5)
        .map(|ring| {
            let radius = 0.01 * (f64::from(ring) + 0.5);
            all.iter().filter(|x| (x.norm() - radius).abs() < 1e-12).count()
        })
        .collect();
    let room = |ring: usize| (2.0 * PI * (ring as f64 + 0.5)).round() as usize;
    assert_eq!(counts, (0..5).map(room).collect::<Vec<_>>());
    for x in all {
        let mirrored = Vector::<2>::new(x[0], -x[1]);
        assert!(all.iter().any(|y| (y - mirrored).norm() < 1e-12), "{x}");
    }
}

#[test]
fn what_has_no_centre_is_refused() {
    let corner = |x: f64| Vector::<2>::repeat(x);
    let cuboid = Shape::cuboid(corner(0.0), corner(1.0)).unwrap();
    assert!(matches!(layers(&cuboid, 0.1, Placement::Cells), Err(GeometryError::NotRound)));
    let disc = Shape::ball(corner(0.0), 1.0).unwrap();
    let spec = LatticeSpec { kind: LatticeKind::Concentric, ..LatticeSpec::square([0.1, 0.2]) };
    assert!(matches!(fill(&disc, &spec), Err(GeometryError::Uneven { .. })));
    let tiny = layers(&disc, 1e-6, Placement::Cells);
    assert!(matches!(tiny, Err(GeometryError::TooManySites { .. })));
}
