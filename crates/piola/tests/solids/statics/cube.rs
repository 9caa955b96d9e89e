//! The cube of Dual-support 6.6.

use piola::Vector;
use piola::boundaries::PrescribedDisplacement;
use piola::neighbors::Domain;
use piola::operators::DirectedSupport;
use piola::schemes::dual_support::{
    Discrete, Gradients, Material, Settings, StaticState, Statics, StaticsInput,
};
use piola::solve::{LinearMethod, LoadSteps};
use piola_formulas::hyperelastic::{HyperelasticLaw, LameConstants, Reduced};
use piola_formulas::kernels::Kernel;
use piola_formulas::volumetric::StressState;

use super::forces;
use crate::support::lattice;

/// A cube of the law (46) there, with half of its top under a dead pressure of 2 Pa: particles on
/// the nodes of a lattice, loads consistent, so that the line at the middle has half of them.
pub fn cube(intervals: usize, method: LinearMethod) -> Vec<StaticState<3>> {
    let mut particles = lattice([1.0; 3], [intervals; 3]);
    let side = intervals + 1;
    let cell = 1.0 / intervals as f64;
    let half = |index: usize| if index % intervals == 0 { 0.5 * cell } else { cell };
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
    let settings =
        Settings { gradients: Gradients::PatchConsistent { areas: areas.clone() }, hourglass: 0.1 };
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
        ..StaticsInput::default()
    };
    let mut statics = Statics::new(&body, input).unwrap();
    let mut states = Vec::new();
    let start = std::time::Instant::now();
    statics.solve_with(&LoadSteps::Given(vec![0.25, 0.5, 0.75, 1.0]), |state| {
        let lowest = state.displacement.iter().map(|u| u[2]).fold(0.0, f64::min);
        let corner = state.displacement[side * side * intervals];
        println!("{} lowest {lowest:.5} corner {:.5} its {} steps {:?} t {:?} E {:?} R {:?}", state.factor, corner[2], state.solved.iterations.len(), state.solved.iterations.iter().map(|i| (i.residual, i.length, i.linear_steps)).collect::<Vec<_>>(), start.elapsed(), state.energies, state.reactions[2].force[2]);
        states.push(state);
    }).unwrap();
    states
}

#[test]
fn measure() {
    let n = std::env::var("N").unwrap_or("6".into()).parse().unwrap();
    let method = if std::env::var("KRYLOV").is_ok() { LinearMethod::Krylov } else { LinearMethod::Direct };
    cube(n, method);
}
