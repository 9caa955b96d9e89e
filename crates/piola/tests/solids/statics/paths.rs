//! Instability, and paths that lead through it.

use piola::Vector;
use piola::boundaries::PrescribedDisplacement;
use piola::schemes::total_lagrangian::{Discrete, Statics, StaticsError, StaticsInput};
use piola::solve::{ArcLength, LoadError, LoadSteps, Newton, Stability};
use piola_formulas::hyperelastic::HyperelasticLaw;
use piola_formulas::volumetric::StressState;

use super::{body, constants, forces, growing, moved, select};
use crate::clouds::Cloud;

/// St. Venant and Kirchhoff's bar loses its stiffness at a stretch of `1/sqrt(3)`: shortened to a
/// half it is in equilibrium with itself, but not to stay.
#[test]
fn unstable_equilibrium_is_reported_as_what_it_is() {
    let cloud = Cloud::simplices([1.0], [16], 0.2);
    let law = HyperelasticLaw::saint_venant_kirchhoff(constants());
    let body = body(&cloud, law, StressState::UniaxialStrain);
    let length = cloud.particles.position[16][0] - cloud.particles.position[0][0];
    let input = || StaticsInput {
        prescribed: vec![moved(0, 0, 0.0), moved(16, 0, -0.5 * length)],
        ..StaticsInput::default()
    };
    let mut statics = Statics::new(body.clone().into(), input()).unwrap();
    let stable = statics.solve(&LoadSteps::Given(vec![0.5, 0.8])).unwrap();
    // P = (lambda + 2 mu) l (l^2 - 1)/2 at a stretch of 0.6.
    let expected = constants().pressure_wave_modulus() * 0.6 * (0.36 - 1.0) / 2.0;
    let reaction = stable[1].reactions[1].force[0];
    assert!((reaction / expected - 1.0).abs() < 1e-7, "{reaction} {expected}");
    let error = statics.solve(&LoadSteps::Given(vec![0.5, 0.8, 1.0])).unwrap_err();
    let StaticsError::Load(LoadError::Unstable { factor, reached, negative }) = error else {
        panic!("{error}")
    };
    assert_eq!((factor, reached), (1.0, 0.8));
    assert!(negative.is_some_and(|count| count > 0), "{negative:?}");
    // Steps that adapt find where: at a shortening of 1 - 1/sqrt(3), at a load factor of 0.845,
    // from which on the least disorder lets one part of the bar shorten alone.
    let steps = LoadSteps::Automatic { levels: vec![1.0], first: 0.25, least: 1e-3 };
    let error = Statics::new(body.clone().into(), input()).unwrap().solve(&steps).unwrap_err();
    let StaticsError::Load(LoadError::Unstable { reached, .. }) = error else { panic!("{error}") };
    let limit = 2.0 * (1.0 - 1.0 / 3.0_f64.sqrt());
    assert!((reached - limit).abs() < 0.01, "{reached} {limit}");
}

/// A shallow arch between two walls, one cell of disorder-free lattice bent to half a sine.
fn arch() -> (Cloud<2>, Discrete<2>, [usize; 3]) {
    let (columns, rows) = (48, 3);
    let mut cloud = Cloud::bent([2.0, 0.08], [columns, rows], |x| {
        let rise = 0.12 * (std::f64::consts::FRAC_PI_2 * x[0]).sin();
        Vector::<2>::new(x[0], x[1] + rise)
    });
    cloud.particles.spacing.fill(2.0 / columns as f64);
    let body = body(&cloud, HyperelasticLaw::neo_hookean(constants()), StressState::PlaneStress);
    let top = rows * (columns + 1) + columns / 2;
    (cloud, body, [top, columns, rows])
}

/// The load of a shallow arch rises to a limit, falls, and rises again. What arc length finds is
/// what prescribing the displacement under the load finds, which has no limit there.
#[test]
fn arc_length_follows_an_arch_through_its_limit() {
    let (cloud, body, [top, columns, _]) = arch();
    let is_end = |a: &u32| {
        (*a as usize).is_multiple_of(columns + 1) || (*a as usize + 1).is_multiple_of(columns + 1)
    };
    let ends: Vec<u32> = select(&cloud, |_| true).into_iter().filter(is_end).collect();
    let clamp = PrescribedDisplacement::clamp("walls", &ends).to_vec();
    let force = 60.0;
    let mut loads = vec![Vector::<2>::zeros(); body.len()];
    loads[top] = Vector::<2>::new(0.0, -force);
    let newton = Newton { tolerance: 1e-9, ..Newton::default() };
    let input = || StaticsInput {
        tractions: forces(&loads),
        prescribed: clamp.clone(),
        newton,
        ..StaticsInput::default()
    };
    let mut points = Vec::new();
    let arc = ArcLength { first: 0.1, ..ArcLength::default() };
    let mut statics = Statics::new(body.clone().into(), input()).unwrap();
    statics
        .follow_arc(&arc, |state| {
            let unstable = matches!(state.solved.stability, Stability::Unstable(_));
            points.push((-state.displacement[top][1], state.factor * force, unstable));
            state.displacement[top][1] > -0.25
        })
        .unwrap();
    let limit = points.windows(2).position(|pair| pair[1].1 < pair[0].1).expect("a limit");
    let valley = points[limit..].windows(2).position(|pair| pair[1].1 > pair[0].1);
    let valley = limit + valley.expect("the load rises again");
    assert!(points[valley].1 < 0.9 * points[limit].1, "{points:?}");
    assert!(points[limit + 1..valley].iter().all(|point| point.2), "{points:?}");
    assert!(!points[0].2 && !points[points.len() - 1].2, "{points:?}");
    // Under a dead load that grows the body is reported to be unstable there, and does not jump.
    let steps = LoadSteps::Automatic { levels: vec![2.0], first: 0.1, least: 1e-3 };
    let error = Statics::new(body.clone().into(), input()).unwrap().solve(&steps).unwrap_err();
    let StaticsError::Load(LoadError::Unstable { reached, .. }) = error else { panic!("{error}") };
    let highest = points.iter().take(valley).map(|point| point.1).fold(0.0, f64::max) / force;
    assert!(reached < 1.01 * highest && reached > 0.97 * highest, "{reached} {highest}");
    // With the displacement prescribed.
    let mut prescribed = clamp.clone();
    prescribed.push(PrescribedDisplacement::component(
        "tip",
        vec![top as u32],
        1,
        growing(|_| -1.0),
    ));
    let input = StaticsInput { prescribed, newton, ..StaticsInput::default() };
    let levels = points.iter().map(|point| point.0).collect();
    let states =
        Statics::new(body.clone().into(), input).unwrap().solve(&LoadSteps::Given(levels)).unwrap();
    let scale = points[limit].1;
    for (state, point) in states.iter().zip(&points) {
        let load = -state.reactions[2].force[1];
        assert!((load - point.1).abs() < 1e-6 * scale, "{load} {point:?}");
    }
}
