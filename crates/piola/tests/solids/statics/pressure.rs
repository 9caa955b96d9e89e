//! Pressure that follows the surface.

use piola::Vector;
use piola::boundaries::FollowerPressure;
use piola::schemes::total_lagrangian::{Statics, StaticsInput};
use piola::solve::{LinearMethod, LoadSteps, Newton};
use piola_formulas::hyperelastic::HyperelasticLaw;
use piola_formulas::volumetric::StressState;

use super::{body, constants, growing, is_quadratic, moved, select};
use crate::clouds::Cloud;

/// A body under the same pressure all around shrinks alike in all directions, on any cloud, and
/// `-p = dpsi/dJ = kappa (J - 1)` in the law (39).
#[test]
fn a_body_under_pressure_all_around_shrinks_evenly() {
    let cloud = Cloud::simplices([1.0; 3], [4; 3], 0.15);
    let law = HyperelasticLaw::neo_hookean(constants());
    let body = body(&cloud, law, StressState::ThreeDimensional);
    let surface = select(&cloud, |_| true);
    let pressure = 0.4 * constants().bulk_modulus();
    let stretch = 0.6_f64.cbrt();
    let to = |a: usize, i: usize| (stretch - 1.0) * cloud.particles.position[a][i];
    let held = [(0, 0), (0, 1), (0, 2), (4, 1), (4, 2), (20, 2)];
    for method in [LinearMethod::Direct, LinearMethod::Krylov] {
        let input = StaticsInput {
            pressures: vec![FollowerPressure {
                name: "water".into(),
                particles: surface.clone(),
                areas: cloud.areas.clone(),
                places: vec![],
                value: growing(move |_| pressure),
            }],
            // Values that the solution has at full load.
            prescribed: held.iter().map(|&(a, i)| moved(a, i, to(a, i))).collect(),
            newton: Newton { tolerance: 1e-11, ..Newton::default() },
            method,
            ..StaticsInput::default()
        };
        let mut statics = Statics::new(body.clone().into(), input).unwrap();
        let state = statics.solve(&LoadSteps::Given(vec![1.0])).unwrap().remove(0);
        for (u, x) in state.displacement.iter().zip(&cloud.particles.position) {
            assert!((u - x * (stretch - 1.0)).amax() < 1e-8, "{u}");
        }
        let solved = &state.solved;
        assert!(is_quadratic(&solved.iterations, solved.residual, 100.0), "{method:?} {solved:?}");
        assert!(state.reactions.iter().all(|r| r.force.amax() < 1e-3), "{:?}", state.reactions);
    }
}

/// A cantilever under follower pressure on its top is not the one under dead loads, and its tangent
/// is not symmetric: convergence is quadratic all the same.
#[test]
fn the_tangent_of_an_open_pressure_is_exact() {
    let cloud = Cloud::block([2.0, 0.5], [24, 6], 0.2);
    let law = HyperelasticLaw::neo_hookean(constants());
    let body = body(&cloud, law, StressState::PlaneStrain);
    let top = select(&cloud, |x| x[1] == 0.5);
    let areas: Vec<Vector<2>> =
        top.iter().map(|&a| Vector::<2>::new(0.0, cloud.areas[a as usize][1])).collect();
    let clamp = select(&cloud, |x| x[0] == 0.0);
    let input = StaticsInput {
        pressures: vec![FollowerPressure {
            name: "wind".into(),
            particles: top,
            areas,
            places: vec![],
            value: growing(|_| 3e3),
        }],
        prescribed: piola::boundaries::PrescribedDisplacement::clamp("wall", &clamp).to_vec(),
        newton: Newton { tolerance: 1e-11, ..Newton::default() },
        ..StaticsInput::default()
    };
    let mut statics = Statics::new(body.clone().into(), input).unwrap();
    let states = statics.solve(&LoadSteps::Given(vec![0.5, 1.0])).unwrap();
    for state in &states {
        let solved = &state.solved;
        assert!(is_quadratic(&solved.iterations, solved.residual, 100.0), "{solved:?}");
    }
    // It turns with the surface, and so pushes the free end back towards the wall.
    let along: f64 = states[1].reactions.iter().map(|reaction| reaction.force[0]).sum();
    assert!(along > 3e2, "{along}");
}
