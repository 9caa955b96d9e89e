//! Gradients on supports that differ, and their correction for constant stress.

use piola::Vector;
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
