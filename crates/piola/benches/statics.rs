//! What a statics of a soft cube costs, by size and linear method:
//! `cargo bench -p piola --bench statics`.
//!
//! The cube of Dual-support 6.6 with half of its top under a dead pressure, four load levels.
//! Arguments that are numbers replace the particles along an edge; `direct` and `krylov` leave the
//! other method out.

#[path = "../tests/support/mod.rs"]
mod support;

use std::sync::Arc;
use std::time::Instant;

use piola::Vector;
use piola::boundaries::{PrescribedDisplacement, Traction};
use piola::neighbors::Domain;
use piola::operators::DirectedSupport;
use piola::schemes::total_lagrangian::{
    Discrete, Gradients, Material, Settings, Statics, StaticsInput,
};
use piola::solve::{LinearMethod, LoadSteps, Newton};
use piola_formulas::hyperelastic::{HyperelasticLaw, LameConstants, Reduced};
use piola_formulas::kernels::Kernel;
use piola_formulas::volumetric::StressState;

fn cube(side: usize, method: LinearMethod) -> Statics<3> {
    let mut particles = support::lattice([1.0; 3], [side - 1; 3]);
    let cell = 1.0 / (side - 1) as f64;
    let count = particles.len();
    let outward = |x: f64| match x {
        0.0 => -1.0,
        1.0 => 1.0,
        _ => 0.0,
    };
    let areas: Vec<Vector<3>> = (0..count)
        .map(|a| {
            let x = particles.position[a].map(outward);
            // Half a cell across each face that a particle lies on.
            x * particles.volume[a] / cell * 2.0
        })
        .collect();
    let top = |a: usize| particles.position[a][2] == 1.0;
    let loaded: Vec<u32> = (0..count as u32).filter(|&a| top(a as usize)).collect();
    let share = |x: &Vector<3>| (0.5 + (0.5 - x[1]) / cell).clamp(0.0, 1.0);
    let traction = Traction {
        name: "press".into(),
        areas: loaded
            .iter()
            .map(|&a| areas[a as usize][2] * share(&particles.position[a as usize]))
            .collect(),
        particles: loaded,
        places: Vec::new(),
        value: [Arc::new(0.0), Arc::new(0.0), support::varying(|_, t| -2.0 * t)],
    };
    let bottom: Vec<u32> =
        (0..count as u32).filter(|&a| particles.position[a as usize][2] == 0.0).collect();
    particles.weight.clone_from(&particles.volume);
    let radius = vec![2.05 * cell; count];
    let support = DirectedSupport::new(&particles, Kernel::QuinticSpline, radius, Domain::open())
        .expect("spacings are positive");
    let law = HyperelasticLaw::neo_hookean(LameConstants::from_young(10.0, 0.3).expect("in range"));
    let law = Reduced::new(law, StressState::ThreeDimensional).expect("the state fits");
    let settings = Settings {
        gradients: Gradients::PatchConsistent { areas },
        hourglass: 0.1,
        ..Settings::default()
    };
    let materials = vec![Material { density: 1.0, law }];
    let body = Discrete::new(particles, support, &settings, materials).expect("gradients exist");
    let input = StaticsInput {
        tractions: vec![traction],
        prescribed: PrescribedDisplacement::clamp("bottom", &bottom).to_vec(),
        method,
        newton: Newton { tolerance: 1e-6, ..Newton::default() },
        ..StaticsInput::default()
    };
    Statics::new(body.into(), input).expect("the bottom holds it")
}

fn main() {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let asked = |name: &str| arguments.iter().any(|argument| argument == name);
    let sizes: Vec<usize> = arguments.iter().filter_map(|argument| argument.parse().ok()).collect();
    let sizes = if sizes.is_empty() { vec![9, 13, 17, 21] } else { sizes };
    println!(
        "  side unknowns non-zeros    factor  set up s iterations   Krylov assembly factor s  solve s  \
         total s  lowest m"
    );
    for (name, method) in [("direct", LinearMethod::Direct), ("krylov", LinearMethod::Krylov)] {
        if asked("direct") != asked("krylov") && !asked(name) {
            continue;
        }
        for &side in &sizes {
            let start = Instant::now();
            let mut statics = cube(side, method);
            let set_up = start.elapsed().as_secs_f64();
            let start = Instant::now();
            let levels = LoadSteps::Given(vec![0.25, 0.5, 0.75, 1.0]);
            let states = statics.solve(&levels).expect("equilibria");
            let total = start.elapsed().as_secs_f64();
            let iterations: Vec<String> =
                states.iter().map(|state| state.solved.iterations.len().to_string()).collect();
            let lowest = states
                .last()
                .map_or(f64::NAN, |s| s.displacement.iter().map(|u| u[2]).fold(0.0, f64::min));
            let costs = statics.costs();
            println!(
                "{side:>6} {:>8} {:>9} {:>9} {set_up:>9.2} {:>10} {:>8} {:>8.2} {:>8.2} {:>8.2} \
                 {total:>8.2}  {lowest:.4}",
                statics.unknowns(),
                costs.entries,
                costs.factor_entries,
                iterations.join(","),
                costs.steps,
                costs.assembly.as_secs_f64(),
                costs.factorisation.as_secs_f64(),
                costs.solution.as_secs_f64(),
            );
        }
    }
}
