//! Packed shapes against what is known of even particles.

use std::f64::consts::PI;
use std::sync::Arc;

use nalgebra::Vector3;
use proptest::prelude::*;

use super::*;
use crate::geometry::Facets;

/// What holds of every packed shape: settled, the volume that of the shape, nothing higher than half a spacing below the surface,
/// and a density within the 2 % that are asked for.
fn packed<const D: usize>(shape: &Shape<D>, spacing: f64) -> FillReport<D> {
    let (report, packing) = pack(shape, spacing).unwrap();
    assert!(packing.is_settled && packing.push <= Packing::SETTLED, "{packing:?}");
    assert!(packing.largest < 0.02 && packing.rms <= packing.largest, "{packing:?}");
    let (total, width) = (report.total_volume, report.actual_spacing[0]);
    let own = report.particles.volume[0];
    assert!(report.particles.volume.iter().all(|volume| *volume == own));
    if let Some(exact) = report.exact_volume {
        assert!((total / exact - 1.0).abs() < 1e-12, "{total} for {exact}");
    }
    for x in &report.particles.position {
        assert!(shape.depth(x) > 0.5 * width * (1.0 - 1e-6), "{} at {x}", shape.depth(x));
    }
    report
}

/// The means of positions and of their squares along each axis.
fn moments<const D: usize>(report: &FillReport<D>) -> [Vector<D>; 2] {
    let all = &report.particles.position;
    let mean = |of: &dyn Fn(&Vector<D>) -> Vector<D>| {
        all.iter().map(of).sum::<Vector<D>>() / all.len() as f64
    };
    [mean(&|x| *x), mean(&|x| x.map(|x| x * x))]
}

fn torus() -> Shape<3> {
    let (around, along) = (48, 24);
    let place = |i: usize, j: usize| {
        let [a, b] =
            [i as f64 / f64::from(around), j as f64 / f64::from(along)].map(|x| 2.0 * PI * x);
        let radius = 1.0 + 0.45 * b.cos();
        Vector::<3>::new(radius * a.cos(), radius * a.sin(), 0.45 * b.sin())
    };
    let mut all = Vec::new();
    for (i, j) in (0..around as usize).flat_map(|i| (0..along as usize).map(move |j| (i, j))) {
        let corners = [place(i, j), place(i + 1, j), place(i + 1, j + 1), place(i, j + 1)];
        all.push([corners[0], corners[1], corners[2]]);
        all.push([corners[0], corners[2], corners[3]]);
    }
    // Angles that are a turn apart are one place up to round-off.
    let same = |x: Vector<3>| x.map(|x| (x * 1e9).round() / 1e9);
    let facets = Facets::new(all.into_iter().map(|facet| facet.map(same)).collect()).unwrap();
    assert!(facets.soundness().is_sound());
    Shape::surface(Arc::new(facets)).unwrap()
}

/// A density that is off by 2 % at most near the surface moves moments by 2 % at most of what they are. A particle is in the middle of
/// what is its own, whose second moment about that is a twelfth of the square of its width.
#[test]
fn discs_and_balls_have_their_moments() {
    for spacing in [0.2, 0.1, 0.05] {
        let disc = packed(&Shape::ball(Vector::<2>::zeros(), 1.0).unwrap(), spacing);
        let [first, second] = moments(&disc);
        let expected = 0.25 - disc.actual_spacing[0].powi(2) / 12.0;
        assert!(first.norm() < 0.02 && second.iter().all(|it| (it / expected - 1.0).abs() < 0.02));
    }
    for spacing in [0.15, 0.12] {
        let ball = packed(&Shape::ball(Vector::<3>::zeros(), 1.0).unwrap(), spacing);
        let [first, second] = moments(&ball);
        let expected = 0.2 - ball.actual_spacing[0].powi(2) / 12.0;
        assert!(first.norm() < 0.02 && second.iter().all(|it| (it / expected - 1.0).abs() < 0.02));
    }
}

#[test]
fn rings_outlines_and_what_is_left_of_boxes_are_packed() {
    packed(&Shape::annulus(Vector::<2>::new(0.3, 0.1), 0.5, 1.0).unwrap(), 0.07);
    let around = |count: usize, radius: &dyn Fn(f64) -> f64| -> Vec<Vector<2>> {
        let angle = |k: usize| 2.0 * PI * k as f64 / count as f64;
        let corner = |a: f64| Vector::<2>::new(a.cos(), a.sin()) * radius(a);
        (0..count).map(|k| corner(angle(k))).collect()
    };
    let wavy = around(100, &|a| 1.0 + 0.15 * (5.0 * a).cos());
    packed(&Shape::<2>::polygon(wavy, None).unwrap(), 0.08);
    let block = Shape::cuboid(Vector::<2>::repeat(-1.0), Vector::<2>::repeat(1.0)).unwrap();
    let hole = Shape::ball(Vector::<2>::zeros(), 0.43).unwrap();
    packed(&Shape::difference(block, vec![hole]).unwrap(), 0.07);
}

#[test]
fn a_torus_of_facets_is_packed() {
    let ring = packed(&torus(), 0.12);
    let [first, _] = moments(&ring);
    assert!(first.norm() < 0.02 * 1.45, "{first}");
}

/// To the sum over an infinite lattice: the next term of Euler and Maclaurin is 7/5760 of the third derivative of the kernel across
/// the face, which is below 2 in spacings, and the grid, twice as fine, adds less than that.
#[test]
fn the_outside_of_a_face_is_what_a_lattice_would_be() {
    fn off<const D: usize>(spacing: f64, [end, across]: [f64; 2]) {
        let end = Vector::from_fn(|axis, _| if axis == 0 { end } else { across });
        let shape = Shape::<D>::cuboid(Vector::zeros(), end).unwrap();
        let spec = LatticeSpec { placement: Placement::Cells, ..LatticeSpec::square([spacing; D]) };
        let sites = fill(&shape, &spec).unwrap().particles;
        let outside = Outside::new(&shape, spacing).unwrap();
        let density = |near: &Vector<D>| {
            let distance = |x: &&Vector<D>| (*x - near).norm();
            let at = sites.position.iter().min_by(|a, b| distance(a).total_cmp(&distance(b)));
            let at = at.unwrap();
            let term = |x: &Vector<D>| KERNEL.value(D, (x - at).norm(), smoothing(spacing));
            let sum: f64 = sites.position.iter().map(term).sum();
            sum * spacing.powi(D as i32) + outside.sum(at).0
        };
        let middle = density(&(0.5 * end));
        for layer in [0.5, 1.5, 2.5] {
            let mut near = 0.5 * end;
            near[0] = layer * spacing;
            let found = density(&near);
            assert!((found - middle).abs() < 2.0 * 2.0 * 7.0 / 5760.0, "{found} for {middle}");
        }
    }
    off::<2>(0.1, [1.5, 0.9]);
    off::<3>(0.1, [0.9, 0.7]);
}

#[test]
fn threads_and_turns_change_nothing() {
    let shape = Shape::annulus(Vector::<2>::new(0.3, 0.1), 0.4, 1.0).unwrap();
    let all: Vec<_> = [1, 3]
        .map(|count| rayon::ThreadPoolBuilder::new().num_threads(count).build().unwrap())
        .map(|pool| pool.install(|| pack(&shape, 0.015).unwrap()))
        .into();
    assert!(all[0].0.particles.len() > 2 * parallel::CHUNK);
    assert_eq!(all[0], all[1]);
    let drop = Shape::ball(Vector::<2>::new(1.0, 0.0), 0.5).unwrap();
    let turned = drop.clone().turned(0.4, Vector::zeros(), Vector3::z()).unwrap();
    let [(still, _), (turned, _)] = [&drop, &turned].map(|shape| pack(shape, 0.1).unwrap());
    let turn = nalgebra::Rotation2::new(0.4);
    for (x, y) in still.particles.position.iter().zip(&turned.particles.position) {
        assert!((turn * x - y).norm() < 1e-14);
    }
}

/// Before memory is taken for it.
#[test]
fn a_grid_of_too_many_cells_is_refused() {
    let square = Shape::cuboid(Vector::<2>::zeros(), Vector::<2>::repeat(1.0)).unwrap();
    let error = Outside::new(&square, 1e-5).err().unwrap();
    assert!(matches!(error, PackingError::TooThin { .. }), "{error}");
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(48))]
    /// Slivers, spikes, and shapes smaller than a particle: whatever becomes of them, it is finite, and has their volume.
    #[test]
    fn any_triangle_has_its_volume(
        corners in prop::array::uniform3(prop::array::uniform2(-1.0..1.0f64)),
        spacing in 0.05..2.0f64,
    ) {
        let corners = corners.map(Vector::<2>::from).to_vec();
        let Ok(shape) = Shape::<2>::polygon(corners, None) else { return Ok(()) };
        let Ok((report, packing)) = pack(&shape, spacing) else { return Ok(()) };
        let exact = shape.exact_volume().unwrap();
        prop_assert!((report.total_volume / exact - 1.0).abs() < 1e-12);
        prop_assert!(report.particles.position.iter().flatten().all(|x| x.is_finite()));
        prop_assert!(packing.push.is_finite() && packing.largest.is_finite());
    }
}
