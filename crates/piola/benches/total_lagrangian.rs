//! Explicit steps of total Lagrangian solids: `cargo bench -p piola --bench total_lagrangian`.
//!
//! A square of neo-Hookean material in plane strain, modified mollifier of 2.5 spacings, plain gradients,
//! hourglass 0.05, without and with viscosity: one kick, drift and kick at a time, without looks at the
//! state, on one thread. Arguments are numbers of particles.

#[allow(dead_code, reason = "shared with another bench, which uses more of it")]
#[path = "upwind/clock.rs"]
mod clock;

#[allow(dead_code, reason = "shared with another bench")]
#[path = "upwind/bandwidth.rs"]
mod bandwidth;

use piola::Vector;
use piola::geometry::{LatticeSpec, Particles, Shape, fill};
use piola::schemes::Scheme;
use piola::schemes::total_lagrangian::{
    Dissipation, Material, Settings, TotalLagrangian, TotalLagrangianInput,
};
use piola::time::IntegratorKind;
use piola_formulas::hyperelastic::{HyperelasticLaw, LameConstants, Reduced};
use piola_formulas::kernels::Kernel;
use piola_formulas::volumetric::StressState;

const KERNEL: Kernel = Kernel::ModifiedMollifier;

/// Cover in spacings.
const COVER: f64 = 2.5;

fn particles(count: usize) -> Particles<2> {
    let spacing = 1.0 / ((count as f64).sqrt().round() - 1.0);
    let shape = Shape::cuboid(Vector::from([0.0; 2]), Vector::from([1.0; 2])).expect("a square");
    fill(&shape, &LatticeSpec::square([spacing; 2])).expect("particles").particles
}

fn material() -> Material<2> {
    let constants = LameConstants::from_young(1e6, 0.3).expect("in range");
    let law = HyperelasticLaw::neo_hookean_logarithmic(constants);
    let law = Reduced::new(law, StressState::PlaneStrain).expect("the state fits");
    Material { density: 1000.0, law }
}

fn velocity(particles: &Particles<2>) -> Vec<Vector<2>> {
    particles.position.iter().map(|x| Vector::from([(3.0 * x[1]).sin(), 0.0])).collect()
}

fn solid(particles: Particles<2>, viscosity: f64) -> TotalLagrangian<2> {
    let radius = particles.spacing.iter().map(|spacing| COVER * spacing).collect();
    let velocity = velocity(&particles);
    let dissipation = Dissipation { viscosity, ..Dissipation::default() };
    let settings = Settings { hourglass: 0.05, dissipation, ..Settings::default() };
    let bodies = TotalLagrangianInput::of_bodies(particles, &[material()], (KERNEL, radius));
    TotalLagrangian::new(TotalLagrangianInput { settings, velocity, ..bodies })
        .expect("the scheme can be built")
}

fn measure(name: &str, scheme: &mut dyn Scheme) {
    let mut state = scheme.initial_state();
    let mut new = state.clone();
    let mut integrator = IntegratorKind::KickDriftKick.build(scheme).expect("it has kicks");
    let particles = scheme.particle_count();
    let step = 0.01 / (particles as f64).sqrt() / 40.0;
    let seconds = clock::best_time(|| {
        integrator
            .step(scheme, 0.0, step, &state, &mut new)
            .expect("explicit methods always find a state");
        std::mem::swap(&mut state, &mut new);
    });
    let memory = scheme.memory();
    let rate = memory as f64 / seconds;
    println!(
        "| {particles} | {name} | {megabytes:.1} | {bytes:.0} | {ns:.0} | {rate:.1} | {read:.1} |",
        megabytes = memory as f64 / 1e6,
        bytes = memory as f64 / particles as f64,
        ns = 1e9 * seconds / particles as f64,
        rate = rate / 1e9,
        read = bandwidth::read_rate(memory) / 1e9,
    );
}

fn main() {
    let given: Vec<usize> = std::env::args()
        .skip(1)
        .filter_map(|argument| argument.parse::<f64>().ok())
        .map(|size| size as usize)
        .collect();
    let sizes = if given.is_empty() { vec![1000, 10_000, 100_000, 1_000_000] } else { given };
    println!("| particles | material | MB | B/particle | ns/particle | GB/s | read GB/s |");
    println!("|--:|:--|--:|--:|--:|--:|--:|");
    let pool = rayon::ThreadPoolBuilder::new().num_threads(1).build();
    pool.expect("a thread can be started").install(|| {
        for size in sizes {
            measure("elastic", &mut solid(particles(size), 0.0));
            measure("viscous", &mut solid(particles(size), 1.0));
        }
    });
}
