//! Gradients on supports that differ, and their correction for constant stress.

use piola::Vector;
use piola::geometry::Particles;
use piola::neighbors::Domain;
use piola::operators::{DirectedSupport, DualGradient, OperatorError, nearest_radii};
use piola_formulas::kernels::Kernel;

use crate::clouds::{Cloud, some_gradient};

/// Largest error of the gradient of a linear field.
fn linear_error<const D: usize>(cloud: &Cloud<D>, gradient: &DualGradient<D>) -> f64 {
    let (support, slope) = (cloud.support(), some_gradient::<D>());
    let error = |a: usize| {
        let mut found = -slope;
        let row = support.list.row(a);
        for (&b, g) in row.iter().zip(gradient.coefficients(support.list.range(a))) {
            let separation = support.separation(&cloud.particles.position, a, b);
            found += slope * separation * Vector::from(*g).transpose();
        }
        found.amax()
    };
    (0..cloud.particles.len()).map(error).fold(0.0, f64::max)
}

fn area_error<const D: usize>(cloud: &Cloud<D>, gradient: &DualGradient<D>) -> f64 {
    let areas = gradient.areas(&cloud.support(), &cloud.particles.volume);
    let errors = areas.iter().zip(&cloud.areas).map(|(have, area)| (have - area).amax());
    let scale = cloud.areas.iter().map(Vector::amax).fold(0.0, f64::max);
    errors.fold(0.0, f64::max) / scale
}

fn check<const D: usize>(cloud: &Cloud<D>, least_plain_error: f64) {
    let support = cloud.support();
    let differ = (0..support.list.len()).any(|a| support.list.row(a) != support.dual.row(a));
    assert!(differ, "supports and dual supports are to differ");
    let plain = DualGradient::plain(&cloud.particles, &support).unwrap();
    assert!(linear_error(cloud, &plain) < 1e-13);
    let before = area_error(cloud, &plain);
    assert!(before > least_plain_error, "plain gradients are no better than {before}");
    let patch = plain.patch_consistent(&cloud.particles, &support, &cloud.areas).unwrap();
    let (linear, areas) = (linear_error(cloud, &patch), area_error(cloud, &patch));
    assert!(linear < 1e-12, "linear fields are {linear:e} off");
    assert!(areas < 1e-11, "areas are {areas:e} off");
}

#[test]
fn patch_consistent_gradients_have_the_areas_of_the_boundary() {
    check(&Cloud::simplices([2.0], [30], 0.3), 1e-2);
    check(&Cloud::simplices([2.0, 1.0], [16, 8], 0.25), 1e-1);
    check(&Cloud::simplices([1.0, 1.0, 1.2], [5, 5, 6], 0.2), 1e-1);
}

#[test]
fn every_entry_of_the_dual_list_is_the_right_one() {
    let cloud = Cloud::simplices([1.0, 1.0], [9, 9], 0.3);
    let support = cloud.support();
    assert_eq!(support.dual.pairs(), support.list.pairs());
    for a in 0..support.list.len() {
        let entries = &support.dual_entries[support.dual.range(a)];
        for (&b, &entry) in support.dual.row(a).iter().zip(entries) {
            assert!(support.list.range(b as usize).contains(&(entry as usize)));
            assert_eq!(support.list.indices()[entry as usize] as usize, a);
        }
    }
}

#[test]
fn radii_of_the_nearest_give_each_particle_as_many() {
    let mut cloud = Cloud::simplices([1.0, 1.0], [9, 9], 0.3);
    let count = cloud.particles.len();
    // A second body far away, of four particles: each has three others at most.
    let mut small = Cloud::simplices([1.0, 1.0], [1, 1], 0.1).particles;
    small.position.iter_mut().for_each(|x| x[0] += 9.0);
    cloud.particles.append(small, 1).unwrap();
    let radii =
        nearest_radii(&cloud.particles, &cloud.particles.body, 12, &Domain::open()).unwrap();
    // The last of them lies on the edge, inside or outside by rounding.
    for (factor, on_edge) in [(1.0 - 1e-12, 1), (1.0 + 1e-12, 0)] {
        let radii = radii.iter().map(|r| r * factor).collect();
        let support =
            DirectedSupport::new(&cloud.particles, Kernel::QuinticSpline, radii, Domain::open());
        let list = support.unwrap().list;
        assert!((0..count).all(|a| list.row(a).len() == 12 - on_edge));
        assert!((count..count + 4).all(|a| list.row(a).len() == 3 - on_edge));
    }
}

#[test]
fn what_has_no_gradient_is_named() {
    let cloud = Cloud::simplices([1.0, 1.0], [6, 6], 0.2);
    let narrow = vec![0.2; cloud.particles.len()];
    let narrow =
        DirectedSupport::new(&cloud.particles, Kernel::QuinticSpline, narrow, Domain::open());
    let error = DualGradient::plain(&cloud.particles, &narrow.unwrap()).unwrap_err();
    assert!(matches!(error, OperatorError::PoorSupport { dimension: 2, .. }), "{error}");

    let mut twice = cloud.clone();
    twice.particles.position[9] = twice.particles.position[8];
    let error = DualGradient::plain(&twice.particles, &twice.support()).unwrap_err();
    assert!(matches!(error, OperatorError::Coincident { first: 8, second: 9, .. }), "{error}");

    let plain = DualGradient::plain(&cloud.particles, &cloud.support()).unwrap();
    let mut open = cloud.clone();
    open.areas[0] *= 0.9;
    let error = plain.patch_consistent(&open.particles, &open.support(), &open.areas).unwrap_err();
    assert!(matches!(error, OperatorError::Areas { body: 0, .. }), "{error}");
    assert!(error.to_string().contains("do not enclose its volume"));
}

/// Patch-consistent gradients in a domain, with the lists that they belong to.
fn corrected(
    particles: &Particles<2>,
    radius: &[f64],
    domain: Domain<2>,
    areas: &[Vector<2>],
) -> Result<(DirectedSupport<2>, DualGradient<2>), OperatorError> {
    let support =
        DirectedSupport::new(particles, Kernel::QuinticSpline, radius.to_vec(), domain).unwrap();
    let plain = DualGradient::plain(particles, &support).unwrap();
    let patch = plain.patch_consistent(particles, &support, areas)?;
    Ok((support, patch))
}

/// A body that lies across the ends of a period, with places on both sides of the domain, has the gradients that it has
/// elsewhere, and areas that do not close it are refused as they are there.
#[test]
fn a_body_across_the_ends_of_a_period_is_like_any_other() {
    let cloud = Cloud::simplices([2.0, 1.0], [16, 8], 0.25);
    let radius = cloud.support().radius;
    let domain = Domain::new([Some([0.0, 4.0]), None]).unwrap();
    let mut across = cloud.particles.clone();
    across.position.iter_mut().for_each(|x| *x = domain.wrap(&(*x + Vector::from([3.1, 0.0]))));
    assert!(across.position.iter().any(|x| x[0] < 1.1) && across.position[0][0] > 3.0);
    let (open, expected) =
        corrected(&cloud.particles, &radius, Domain::open(), &cloud.areas).unwrap();
    let (support, found) = corrected(&across, &radius, domain, &cloud.areas).unwrap();
    for a in 0..across.len() {
        let row = |support: &DirectedSupport<2>, gradient: &DualGradient<2>| {
            let coefficients = gradient.coefficients(support.list.range(a)).to_vec();
            let mut row: Vec<_> = support.list.row(a).iter().copied().zip(coefficients).collect();
            row.sort_by_key(|(b, _)| *b);
            row
        };
        let (expected, found) = (row(&open, &expected), row(&support, &found));
        let scale = expected.iter().flat_map(|(_, g)| g).fold(0.0_f64, |most, g| most.max(g.abs()));
        for ((b, expected), (other, found)) in expected.iter().zip(&found) {
            assert_eq!(b, other);
            let off = (Vector::from(*expected) - Vector::from(*found)).amax();
            assert!(off < 1e-9 * scale, "{a}, {b}: {off} of {scale}");
        }
    }
    for axis in 0..2 {
        let mut wide = cloud.areas.clone();
        wide.iter_mut().for_each(|area| area[axis] *= 1.01);
        let error = corrected(&across, &radius, domain, &wide).unwrap_err();
        assert!(matches!(error, OperatorError::Areas { .. }), "{error}");
    }
}

/// A strip that goes on for ever along x: its areas along y have to close it, and along x to add up to nothing.
#[test]
fn areas_that_do_not_close_an_endless_strip_are_refused() {
    let (count, dx) = (10, 0.1);
    let domain = Domain::new([Some([0.0, count as f64 * dx]), None]).unwrap();
    let strip = Cloud::block([count as f64 * dx, 0.5], [count, 5], 0.2);
    let is_kept = |x: &Vector<2>| x[0] < domain.periodic()[0].unwrap()[1];
    let kept: Vec<usize> =
        (0..strip.particles.len()).filter(|&a| is_kept(&strip.particles.position[a])).collect();
    let position: Vec<Vector<2>> = kept.iter().map(|&a| strip.particles.position[a]).collect();
    let share = |x: &Vector<2>| if x[1] == 0.0 || x[1] == 0.5 { 0.5 } else { 1.0 };
    let particles = Particles {
        volume: position.iter().map(|x| share(x) * dx * dx).collect(),
        weight: vec![dx * dx; kept.len()],
        spacing: vec![dx; kept.len()],
        body: vec![0; kept.len()],
        id: (0..kept.len() as u32).collect(),
        surface: strip.particles.surface.clone(),
        position: position.clone(),
    };
    let outwards = |x: &Vector<2>| f64::from(i8::from(x[1] == 0.5) - i8::from(x[1] == 0.0));
    let areas: Vec<_> = position.iter().map(|x| Vector::from([0.0, outwards(x) * dx])).collect();
    let radius = vec![2.5 * dx; position.len()];
    let (support, gradient) = corrected(&particles, &radius, domain, &areas).unwrap();
    let found = gradient.areas(&support, &particles.volume);
    let off = found.iter().zip(&areas).map(|(found, area)| (found - area).amax());
    assert!(off.fold(0.0, f64::max) < 1e-11 * dx);
    let stretched: Vec<_> = areas.iter().map(|area| area * 1.01).collect();
    let mut open = areas;
    open[0][0] = 0.1 * dx;
    for areas in [stretched, open] {
        let error = corrected(&particles, &radius, domain, &areas).unwrap_err();
        assert!(matches!(error, OperatorError::Areas { .. }), "{error}");
    }
}

/// A particle of negative volume has a negative weight in what is to be least: there is nothing to be found, and that is
/// told at the first direction of negative energy.
#[test]
fn conjugate_gradients_stop_where_there_is_no_least_change() {
    let mut cloud = Cloud::simplices([1.0, 1.0], [9, 9], 0.3);
    let volume = &mut cloud.particles.volume;
    volume[46] += 11.0 * volume[45];
    volume[45] *= -10.0;
    let (particles, support) = (&cloud.particles, cloud.support());
    let plain = DualGradient::plain(particles, &support).unwrap();
    let error = plain.patch_consistent(particles, &support, &cloud.areas).unwrap_err();
    let OperatorError::NoConvergence { steps, .. } = error else { panic!("{error}") };
    assert!(steps < 100, "{steps} steps");
}
