//! Filled shapes: volumes, places, jitter.

use crate::Vector;
use crate::geometry::{
    FillReport, GeometryError, LatticeKind, LatticeSpec, Particles, Placement, Shape, fill,
};
use crate::neighbors::{Domain, refuse_coincident, search};
use proptest::prelude::*;

fn cuboid<const D: usize>(extent: [f64; D]) -> Shape<D> {
    Shape::cuboid(Vector::from_element(-0.3), Vector::from(extent).add_scalar(-0.3)).unwrap()
}

fn assert_total<const D: usize>(report: &FillReport<D>, expected: f64, bound: f64) {
    let sum = report.particles.volume.iter().sum::<f64>();
    assert!((report.total_volume / sum - 1.0).abs() < 1e-12);
    let error = report.total_volume / expected - 1.0;
    assert!(error.abs() < bound, "{error:e} of {bound:e}");
}

fn specs<const D: usize>(spacing: f64) -> Vec<LatticeSpec<D>> {
    let square = LatticeSpec::square([spacing; D]);
    let hexagonal = LatticeSpec { kind: LatticeKind::Hexagonal, ..square };
    [square, hexagonal]
        .iter()
        .flat_map(|spec| {
            [Placement::Boundary, Placement::Cells]
                .map(|placement| LatticeSpec { placement, ..*spec })
        })
        .collect()
}

#[test]
fn a_box_has_particles_on_its_faces_with_parts_of_cells() {
    let shape = Shape::cuboid(Vector::<2>::new(0.0, 1.0), Vector::<2>::new(1.0, 3.0)).unwrap();
    let report = fill(&shape, &LatticeSpec::square([0.45, 1.0])).unwrap();
    assert_eq!(report.actual_spacing, [0.5, 1.0]);
    let particles = &report.particles;
    let x: Vec<(f64, f64)> = particles.position.iter().map(|x| (x.x, x.y)).collect();
    let rows = [1.0, 2.0, 3.0].map(|y| [0.0, 0.5, 1.0].map(|x| (x, y)));
    assert_eq!(x, rows.concat());
    let shares = [0.25, 0.5, 0.25, 0.5, 1.0, 0.5, 0.25, 0.5, 0.25];
    assert_eq!(particles.volume, shares.map(|share| 0.5 * share));
    assert_eq!(particles.weight, [0.5; 9]);
    assert_eq!(particles.spacing, [1.0; 9]);
    assert_eq!(particles.id, Vec::from_iter(0..9));
    let report = fill(
        &shape,
        &LatticeSpec { placement: Placement::Cells, ..LatticeSpec::square([0.45, 9.0]) },
    );
    let particles = report.unwrap().particles;
    assert_eq!(particles.position, [0.25, 0.75].map(|x| Vector::<2>::new(x, 2.0)));
    assert_eq!((particles.volume, particles.weight), (vec![1.0; 2], vec![1.0; 2]));
}

#[test]
fn an_end_of_a_bar_has_half_a_cell() {
    let bar = Shape::cuboid(Vector::<1>::new(0.0), Vector::<1>::new(1.0)).unwrap();
    let report = fill(&bar, &LatticeSpec::square([0.3])).unwrap();
    assert_eq!(report.particles.position.last().unwrap().x, 1.0);
    let cell = 1.0 / 3.0;
    assert_eq!(report.particles.volume, [0.5 * cell, cell, cell, 0.5 * cell]);
}

proptest! {
    #[test]
    fn boxes_are_filled_exactly(
        extent in prop::array::uniform3(0.1..3.0f64), spacing in prop::array::uniform3(0.2..1.5f64),
        cells: bool,
    ) {
        let placement = if cells { Placement::Cells } else { Placement::Boundary };
        let [[x, y, z], [dx, dy, dz]] = [extent, spacing];
        let spec = |spacing| LatticeSpec { placement, ..LatticeSpec::square(spacing) };
        let spec2 = LatticeSpec { placement, ..LatticeSpec::square([dx, dy]) };
        let spec1 = LatticeSpec { placement, ..LatticeSpec::square([dx]) };
        // Sums of up to 4000 numbers, each with an error of 1e-16 of the sum.
        assert_total(&fill(&cuboid([x]), &spec1).unwrap(), x, 1e-12);
        assert_total(&fill(&cuboid([x, y]), &spec2).unwrap(), x * y, 1e-12);
        let report = fill(&cuboid(extent), &spec([dx, dy, dz])).unwrap();
        assert_total(&report, x * y * z, 1e-12);
        for axis in 0..3 {
            let count = (extent[axis] / spacing[axis]).round().max(1.0);
            prop_assert!((report.actual_spacing[axis] * count / extent[axis] - 1.0).abs() < 1e-12);
        }
        let inside = |x: &Vector<3>| cuboid(extent).contains(x);
        prop_assert!(report.particles.position.iter().all(inside));
    }

    #[test]
    fn cutting_gives_a_box_what_counting_does(
        extent in prop::array::uniform3(0.5..2.0f64), cells: bool,
    ) {
        let placement = if cells { Placement::Cells } else { Placement::Boundary };
        let spec = LatticeSpec { placement, ..LatticeSpec::square([0.4; 3]) };
        let whole = fill(&cuboid(extent), &spec).unwrap();
        let cut = fill(&Shape::union(vec![cuboid(extent)]).unwrap(), &spec).unwrap();
        prop_assert_eq!(&whole.particles.position, &cut.particles.position);
        for (a, b) in whole.particles.volume.iter().zip(&cut.particles.volume) {
            prop_assert!((a / b - 1.0).abs() < 1e-12);
        }
    }

    #[test]
    fn jitter_keeps_particles_inside_and_on_faces(
        seed: u64, jitter in 0.0..0.49f64, kind in 0usize..4, hole: bool,
    ) {
        let sheet = cuboid([2.0, 1.0]);
        let shape = match hole {
            true => {
                let hole = Shape::ball(Vector::<2>::new(0.6, 0.1), 0.25).unwrap();
                Shape::difference(sheet, vec![hole]).unwrap()
            }
            false => sheet,
        };
        let still = specs([0.1; 1][0])[kind];
        let before = fill(&shape, &still).unwrap();
        let spec = LatticeSpec { jitter, seed, ..still };
        let after = fill(&shape, &spec).unwrap();
        prop_assert_eq!(&fill(&shape, &spec).unwrap(), &after);
        prop_assert_eq!(&before.particles.volume, &after.particles.volume);
        let (min, max) = shape.bounding_box();
        let mut moved = 0;
        for (x, y) in before.particles.position.iter().zip(&after.particles.position) {
            prop_assert!(shape.contains(y) || x == y);
            moved += usize::from(x != y);
            for axis in 0..2 {
                let reach = jitter * after.actual_spacing[axis] * (1.0 + 1e-12);
                prop_assert!((y[axis] - x[axis]).abs() <= reach);
                if (x[axis] - min[axis]).abs() < 1e-12 || (x[axis] - max[axis]).abs() < 1e-12 {
                    prop_assert_eq!(x[axis], y[axis]);
                }
            }
        }
        prop_assert!(jitter < 1e-9 || moved * 10 > 9 * (before.particles.len() - 4));
        refuse_coincident(&after.particles.position, 1e-4, &Domain::open()).unwrap();
    }
}

#[test]
fn jitter_is_uniform_and_differs_with_the_seed() {
    let spec = LatticeSpec { jitter: 0.2, seed: 1, ..LatticeSpec::square([0.01; 2]) };
    let place = |spec| fill(&cuboid([1.0, 1.0]), &spec).unwrap().particles.position;
    let (still, moved) = (place(LatticeSpec { jitter: 0.0, ..spec }), place(spec));
    assert_ne!(moved, place(LatticeSpec { seed: 2, ..spec }));
    let inner = |x: &&(Vector<2>, Vector<2>)| x.0.add_scalar(0.3 - 0.5).amax() < 0.499;
    let pairs: Vec<_> = still.into_iter().zip(moved).collect();
    let steps: Vec<f64> = pairs.iter().filter(inner).map(|(x, y)| (y - x).x / 0.01).collect();
    assert_eq!(steps.len(), 99 * 99);
    // Uniform in +-0.2: variance 0.04 / 3, with an error of its estimate of about 1 %.
    let variance = steps.iter().map(|step| step * step).sum::<f64>() / steps.len() as f64;
    assert!((variance * 75.0 - 1.0).abs() < 0.04, "{variance}");
}

/// Root of the mean square of relative volume errors, over all kinds of lattices and several
/// spacings of about `spacing`.
fn mean_error<const D: usize>(shape: &Shape<D>, spacing: f64) -> f64 {
    // In the plane errors have a larger scatter, and a measure of them is cheap.
    let count = if D == 2 { 16 } else { 6 };
    let spacings = (0..count).map(|i| spacing * (1.0 + 0.5 * f64::from(i) / f64::from(count)));
    let error = |spec| {
        let report = fill(shape, &spec).unwrap();
        report.total_volume / report.exact_volume.unwrap() - 1.0
    };
    let errors: Vec<f64> = spacings.flat_map(specs).map(error).collect();
    (errors.iter().map(|error| error * error).sum::<f64>() / errors.len() as f64).sqrt()
}

/// The points of a lattice in a round shape differ from its volume by the power 3/2 of the
/// lattice's width or a little less: by 8 for a quarter of the width, of which 5 are asked for.
fn assert_converges<const D: usize>(shape: &Shape<D>, spacing: f64, bound: f64) {
    let (coarse, fine) = (mean_error(shape, spacing), mean_error(shape, 0.25 * spacing));
    assert!(coarse < bound, "{coarse:e}");
    assert!(fine < coarse / 5.0, "{coarse:e} {fine:e}");
}

#[test]
fn volumes_of_round_shapes_converge() {
    let v = Vector::<3>::new;
    let disc = Shape::ball(Vector::<2>::new(0.1, 0.2), 1.0).unwrap();
    assert_converges(&disc, 0.2, 1e-3);
    assert_converges(&Shape::annulus(Vector::<2>::zeros(), 0.4, 1.0).unwrap(), 0.2, 2e-3);
    assert_converges(&Shape::ball(v(0.1, 0.2, 0.3), 1.0).unwrap(), 0.4, 5e-3);
    assert_converges(&Shape::annulus(v(0.1, 0.2, 0.3), 0.5, 1.0).unwrap(), 0.4, 5e-3);
    let cylinder = Shape::cylinder(v(0.0, 0.0, 0.0), v(0.0, 0.3, 1.0), 0.6).unwrap();
    assert_converges(&cylinder, 0.4, 1e-2);
}

fn assert_mirrored<const D: usize>(spacing: f64, placement: Placement) {
    let shape = Shape::ball(Vector::zeros(), 1.0).unwrap();
    let spec = LatticeSpec { placement, ..LatticeSpec::square([spacing; D]) };
    let particles = fill(&shape, &spec).unwrap().particles;
    let near = |at: &Vector<D>, other: &Vector<D>| (at - other).norm() < 1e-9;
    let images = |at: &Vector<D>| {
        let mut swapped = *at;
        swapped.swap_rows(0, D - 1);
        [-at, swapped]
    };
    for (at, volume) in particles.position.iter().zip(&particles.volume) {
        for image in images(at) {
            let found = particles.position.iter().position(|other| near(other, &image)).unwrap();
            let twin = particles.volume[found];
            assert!((volume - twin).abs() < 1e-12 * particles.weight[0], "{at} {volume} {twin}");
        }
    }
}

#[test]
fn a_ball_has_the_same_masses_on_all_sides() {
    for placement in [Placement::Boundary, Placement::Cells] {
        for spacing in [0.2, 0.27] {
            assert_mirrored::<2>(spacing, placement);
            assert_mirrored::<3>(spacing, placement);
        }
    }
}

#[test]
fn combinations_have_the_volumes_of_their_parts() {
    let square =
        |x: f64| Shape::cuboid(Vector::<2>::new(x, 0.0), Vector::<2>::new(x + 1.0, 1.0)).unwrap();
    let volume =
        |shape: &Shape<2>| fill(shape, &LatticeSpec::square([0.1; 2])).unwrap().total_volume;
    let pair = || vec![square(0.0), square(0.5)];
    assert!((volume(&Shape::union(pair()).unwrap()) - 1.5).abs() < 1e-12);
    assert!((volume(&Shape::intersection(pair()).unwrap()) - 0.5).abs() < 1e-12);
    let rest = Shape::difference(square(0.0), vec![square(0.5)]).unwrap();
    // The boundary of the cut runs through the midpoints of subdivided cells' neighbours: each
    // lattice site on it keeps half a cell, so that this is exact, too.
    assert!((volume(&rest) - 0.5).abs() < 1e-12);
    let apart = Shape::intersection(vec![square(0.0), square(3.0)]).unwrap();
    let spec = LatticeSpec::square([0.1; 2]);
    assert!(matches!(fill(&apart, &spec), Err(GeometryError::NoParticles)));
    let touching = Shape::intersection(vec![square(0.0), square(1.0)]).unwrap();
    assert!(matches!(fill(&touching, &spec), Err(GeometryError::NoParticles)));
    let nothing = Shape::difference(square(0.0), vec![square(0.0)]).unwrap();
    assert!(matches!(fill(&nothing, &spec), Err(GeometryError::NoParticles)));
}

/// Number of neighbours within 1.1 spacings of the particles further than two from the outside.
fn inner_neighbors<const D: usize>(shape: &Shape<D>, spacing: f64) -> Vec<usize> {
    let spec = LatticeSpec { kind: LatticeKind::Hexagonal, ..LatticeSpec::square([spacing; D]) };
    let particles = fill(shape, &spec).unwrap().particles;
    let list = search(&particles.position, &vec![1.1 * spacing; particles.len()], &Domain::open())
        .unwrap();
    let inner = |&a: &usize| shape.depth(&particles.position[a]) > 2.0 * spacing;
    (0..particles.len()).filter(inner).map(|a| list.row(a).len()).collect()
}

#[test]
fn hexagonal_lattices_are_densest() {
    let disc = inner_neighbors(&Shape::ball(Vector::<2>::zeros(), 1.0).unwrap(), 0.1);
    assert!(disc.len() > 100 && disc.iter().all(|&count| count == 6), "{disc:?}");
    let ball = inner_neighbors(&Shape::ball(Vector::<3>::zeros(), 1.0).unwrap(), 0.2);
    assert!(ball.len() > 100 && ball.iter().all(|&count| count == 12), "{ball:?}");
    // All neighbours of the densest packing are one spacing away, and its cells are
    // spacing^3 / sqrt(2).
    let spec = LatticeSpec { kind: LatticeKind::Hexagonal, ..LatticeSpec::square([0.2; 3]) };
    let report = fill(&Shape::ball(Vector::<3>::zeros(), 1.0).unwrap(), &spec).unwrap();
    assert!((report.particles.weight[0] / (0.008 / 2f64.sqrt()) - 1.0).abs() < 1e-14);
    refuse_coincident(&report.particles.position, 0.2 * (1.0 - 1e-9), &Domain::open()).unwrap();
}

#[test]
fn bodies_around_a_periodic_domain_have_no_ends() {
    let sheet = cuboid([1.0, 1.0]);
    let hole = Shape::ball(Vector::<2>::new(0.2, 0.2), 0.25).unwrap();
    let holed = Shape::difference(sheet.clone(), vec![hole]).unwrap();
    for shape in [sheet, holed] {
        let spec = LatticeSpec { periodic: [true, false], ..LatticeSpec::square([0.1; 2]) };
        let report = fill(&shape, &spec).unwrap();
        let column = |x: f64| {
            let at = |y: &&(Vector<2>, f64)| (y.0.x - x).abs() < 1e-12;
            let all: Vec<_> = report
                .particles
                .position
                .iter()
                .copied()
                .zip(report.particles.volume.clone())
                .collect();
            all.iter().filter(at).map(|pair| pair.1).sum::<f64>()
        };
        // Ten cells of 0.01 a column, as the ends in y have half cells.
        assert!((column(-0.3) - 0.1).abs() < 1e-12);
        assert_eq!(column(0.7), 0.0);
        assert_total(&report, report.exact_volume.unwrap(), 2e-3);
        let domain = Domain::new([Some([-0.3, 0.7]), None]).unwrap();
        refuse_coincident(&report.particles.position, 0.09, &domain).unwrap();
    }
}

#[test]
fn impossible_lattices_are_refused() {
    let shape = cuboid([1.0, 1.0]);
    let square = |dx, dy| LatticeSpec::square([dx, dy]);
    let spec = square(0.1, 0.1);
    let hexagonal = LatticeSpec { kind: LatticeKind::Hexagonal, ..spec };
    let refused = [
        (square(0.0, 0.1), "the spacing of particles is 0 m"),
        (square(0.1, -1.0), "the spacing of particles is -1 m"),
        (square(f64::NAN, 0.1), "the spacing of particles is NaN m"),
        (square(0.1, f64::INFINITY), "the spacing of particles is inf m"),
        (square(1e-9, 1e-9), "about 1.0e18 lattice sites, expected at most 1e8"),
        (square(1e-300, 1e-300), "lattice sites"),
        (LatticeSpec { jitter: 0.5, ..spec }, "the jitter is 0.5 spacings"),
        (LatticeSpec { jitter: -0.1, ..spec }, "the jitter is -0.1 spacings"),
        (LatticeSpec { jitter: f64::NAN, ..spec }, "the jitter is NaN spacings"),
        (LatticeSpec { spacing: [0.1, 0.2], ..hexagonal }, "the spacings [0.1, 0.2] m"),
        (LatticeSpec { periodic: [true, false], ..hexagonal }, "around a periodic domain"),
    ];
    for (spec, message) in refused {
        let error = fill(&shape, &spec).expect_err(message).to_string();
        assert!(error.contains(message), "{error}");
    }
    let far = Shape::cuboid(Vector::<1>::new(1e12), Vector::<1>::new(1e12 + 1.0)).unwrap();
    let error = fill(&far, &LatticeSpec::square([0.1])).unwrap_err();
    assert!(matches!(error, GeometryError::TooFine { .. }), "{error}");
}

#[test]
fn bodies_are_appended_with_ids_going_on() {
    let bar = cuboid([1.0]);
    let body = || fill(&bar, &LatticeSpec::square([0.5])).unwrap().particles;
    let mut all = Particles::default();
    all.append(body(), 0).unwrap();
    all.append(body(), 1).unwrap();
    assert_eq!(all.id, Vec::from_iter(0..6));
    assert_eq!(all.body, [0, 0, 0, 1, 1, 1]);
    assert_eq!(all.position[3..], body().position);
    assert_eq!((all.volume.len(), all.weight.len(), all.spacing.len()), (6, 6, 6));
    let error = all.append(Particles::default(), 2).unwrap_err();
    assert!(matches!(error, GeometryError::NoParticles));
}

#[test]
fn threads_do_not_change_a_bit() {
    let shape = Shape::ball(Vector::<3>::zeros(), 1.0).unwrap();
    let spec = LatticeSpec { jitter: 0.1, seed: 7, ..LatticeSpec::square([0.1; 3]) };
    let run = |threads| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        pool.install(|| fill(&shape, &spec).unwrap())
    };
    assert_eq!(run(1), run(3));
}
