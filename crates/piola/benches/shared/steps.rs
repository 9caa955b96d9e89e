//! Whole steps of the transport-velocity formulation: what the benches of fluids and solids share.

use piola::Vector;
use piola::geometry::{LatticeSpec, Particles, Placement, Shape, fill};
use piola::schemes::{Observation, Scheme};
use piola::time::IntegratorKind;
use piola_formulas::kernels::Kernel;

use super::clock;

/// Steps a stretch.
const STEPS: u32 = 30;

/// The arguments of a bench.
pub struct Arguments(Vec<String>);

impl Arguments {
    pub fn new() -> Self {
        Self(std::env::args().skip(1).collect())
    }

    pub fn has(&self, word: &str) -> bool {
        self.0.iter().any(|argument| argument == word)
    }

    /// The sizes that are given, or these.
    pub fn sizes(&self, usual: &[usize]) -> Vec<usize> {
        let numbers = self.0.iter().filter_map(|argument| argument.parse::<f64>().ok());
        let given: Vec<usize> = numbers.map(|size| size as usize).collect();
        if given.is_empty() { usual.to_vec() } else { given }
    }

    /// Calls `body(2 or 3, size, name)` for all that is not left out, on one thread and on two, under
    /// the head of the table.
    pub fn for_each(
        &self,
        sizes: &[usize],
        names: &[&str],
        body: impl Fn(usize, usize, &str) + Sync,
    ) {
        println!(
            "| D | threads | particles | neighbours | kernel | setting | M steps/s | ns/particle |"
        );
        println!("|--:|--:|--:|--:|:--|:--|--:|--:|");
        let chosen = names.iter().any(|name| self.has(name));
        let threads: &[usize] = if self.has("serial") { &[1] } else { &[1, 2] };
        for &threads in threads {
            let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build();
            pool.expect("threads can be started").install(|| {
                for &size in sizes {
                    for name in names.iter().filter(|name| !chosen || self.has(name)) {
                        for dimension in [2, 3] {
                            // `2d` leaves 3D out, and the other way round.
                            if !self.has(if dimension == 2 { "3d" } else { "2d" }) {
                                body(dimension, size, name);
                            }
                        }
                    }
                }
            });
        }
    }
}

/// About `count` particles in the unit box, each displaced along each axis by up to `jitter` spacings.
pub fn lattice<const D: usize>(count: usize, jitter: f64) -> Particles<D> {
    let side = (count as f64).powf(1.0 / D as f64).round();
    let unit_box = Shape::cuboid(Vector::zeros(), Vector::repeat(1.0));
    let spec = LatticeSpec {
        placement: Placement::Cells,
        jitter,
        seed: 1,
        ..LatticeSpec::square([1.0 / side; D])
    };
    let filled = unit_box.and_then(|unit_box| fill(&unit_box, &spec));
    filled.expect("the box can be filled").particles
}

/// Prints the row of a scheme whose steps take `step` s.
pub fn measure(mut scheme: impl Scheme, step: f64, kernel: Kernel, name: &str) {
    let mut state = scheme.initial_state();
    let mut new = state.clone();
    let mut integrator = IntegratorKind::KickDriftKick.build(&mut scheme).expect("it has kicks");
    let mut limits = Vec::new();
    let least = clock::best_time(|| {
        for _ in 0..STEPS {
            scheme.inspect(&state, &mut limits);
            integrator
                .step(&mut scheme, 0.0, step, &state, &mut new)
                .expect("explicit methods always find a state");
            std::mem::swap(&mut state, &mut new);
        }
    }) / f64::from(STEPS);
    let particles = scheme.particle_count();
    let all: Vec<u32> = (0..particles as u32).collect();
    let neighbors = Observation::new(&mut scheme, 0.0, &state).values("neighbors", &all);
    let speed = particles as f64 / least;
    println!(
        "| {dimension} | {threads} | {particles} | {mean:.1} | {kernel} | {name} | {millions:.2} | {ns:.0} |",
        dimension = scheme.dimension(),
        threads = rayon::current_num_threads(),
        mean = neighbors.iter().sum::<f64>() / particles as f64,
        kernel = kernel.name(),
        millions = speed / 1e6,
        ns = 1e9 / speed,
    );
}
