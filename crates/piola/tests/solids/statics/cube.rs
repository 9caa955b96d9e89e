//! The cube of Dual-support 6.6.

use piola::Vector;
use piola::boundaries::PrescribedDisplacement;
use piola::neighbors::Domain;
use piola::operators::DirectedSupport;
use piola::schemes::total_lagrangian::{
    Discrete, Gradients, Material, Settings, StaticState, Statics, StaticsInput,
};
use piola::solve::{LinearMethod, LoadSteps, Newton};
use piola_formulas::hyperelastic::{HyperelasticLaw, LameConstants, Reduced};
use piola_formulas::kernels::Kernel;
use piola_formulas::volumetric::StressState;

use super::forces;
use crate::support::lattice;

/// What is asserted of a load level.
#[derive(Debug)]
struct Level {
    lowest: f64,
    corner: f64,
    iterations: usize,
}

/// A cube of the law (46) there, with half of its top under a dead pressure of 2 Pa: particles on
/// the nodes of a lattice, loads consistent, so that the line at the middle has half of them.
fn cube(intervals: usize, method: LinearMethod) -> Vec<Level> {
    let mut particles = lattice([1.0; 3], [intervals; 3]);
    let side = intervals + 1;
    let cell = 1.0 / intervals as f64;
    let half = |index: usize| if index.is_multiple_of(intervals) { 0.5 * cell } else { cell };
    let index = |a: usize| [a % side, a / side % side, a / side / side];
    let outward = |index: usize| match index {
        0 => -1.0,
        i if i == intervals => 1.0,
        _ => 0.0,
    };
    let count = particles.len();
    let areas: Vec<Vector<3>> = (0..count)
        .map(|a| {
            let at = index(a);
            Vector::from_fn(|k, _| outward(at[k]) * half(at[(k + 1) % 3]) * half(at[(k + 2) % 3]))
        })
        .collect();
    let radius = vec![2.05 * cell; count];
    particles.weight.clone_from(&particles.volume);
    let support =
        DirectedSupport::new(&particles, Kernel::QuinticSpline, radius, Domain::open()).unwrap();
    let law = HyperelasticLaw::neo_hookean(LameConstants::from_young(10.0, 0.3).unwrap());
    let law = Reduced::new(law, StressState::ThreeDimensional).unwrap();
    let settings = Settings {
        gradients: Gradients::PatchConsistent { areas: areas.clone() },
        hourglass: 0.1,
        ..Settings::default()
    };
    let materials = vec![Material { density: 1.0, law }];
    let body = Discrete::new(particles, support, &settings, materials).unwrap();
    let load = |a: usize| {
        let at = index(a);
        let share = match (2 * at[1]).cmp(&intervals) {
            std::cmp::Ordering::Less => 1.0,
            std::cmp::Ordering::Equal => 0.5,
            std::cmp::Ordering::Greater => 0.0,
        };
        let area = if at[2] == intervals { areas[a][2] } else { 0.0 };
        Vector::from([0.0, 0.0, -2.0 * area * share])
    };
    let loads: Vec<Vector<3>> = (0..count).map(load).collect();
    let bottom: Vec<u32> = (0..count as u32).filter(|&a| index(a as usize)[2] == 0).collect();
    let input = StaticsInput {
        tractions: forces(&loads),
        prescribed: PrescribedDisplacement::clamp("bottom", &bottom).to_vec(),
        method,
        // As there.
        newton: Newton { tolerance: 1e-6, ..Newton::default() },
        ..StaticsInput::default()
    };
    let mut statics = Statics::new(body.clone().into(), input).unwrap();
    let states = statics.solve(&LoadSteps::Given(vec![0.25, 0.5, 0.75, 1.0])).unwrap();
    let level = |state: StaticState<3>| {
        let top = state.reactions[2].force[2];
        assert!((top - state.factor).abs() < 1e-5, "{top} N carry a load of {} N", state.factor);
        Level {
            lowest: state.displacement.iter().map(|u| u[2]).fold(0.0, f64::min),
            corner: state.displacement[side * side * intervals][2],
            iterations: state.solved.iterations.len(),
        }
    };
    states.into_iter().map(level).collect()
}

/// What converged finite elements give at the four levels: the largest displacement downwards, and
/// that of the corner (0, 0, 1), which is another one.
const LOWEST: [f64; 4] = [-0.0617, -0.1387, -0.267, -0.5756];
const CORNER: [f64; 4] = [-0.0615, -0.1368, -0.2578, -0.5429];

fn check(levels: &[Level], most: [f64; 4]) {
    for (k, level) in levels.iter().enumerate() {
        let error = |found: f64, expected: f64| (found / expected - 1.0).abs();
        assert!(error(level.lowest, LOWEST[k]) < most[k], "{k}: {level:?}");
        assert!(error(level.corner, CORNER[k]) < most[k], "{k}: {level:?}");
    }
}

/// Half the spacing of the source: a few percent too stiff, most where the response is steep.
#[test]
fn a_coarse_cube_bends_nearly_as_finite_elements_do() {
    check(&cube(10, LinearMethod::Krylov), [0.01, 0.02, 0.04, 0.04]);
}

#[test]
fn the_cube_of_the_source_bends_as_finite_elements_do() {
    let levels = cube(20, LinearMethod::Automatic);
    check(&levels, [0.015; 4]);
    // The numbers of the source.
    let iterations: Vec<usize> = levels.iter().map(|level| level.iterations).collect();
    assert!(
        iterations.iter().zip([4, 4, 5, 7]).all(|(taken, most)| *taken <= most),
        "{iterations:?}"
    );
}
