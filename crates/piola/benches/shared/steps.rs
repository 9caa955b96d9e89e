//! Whole steps of the transport-velocity formulation: what the benches of fluids and solids share.

use piola::Vector;
use piola::geometry::Particles;
use piola::schemes::Scheme;
use piola::schemes::transport_velocity::TransportVelocity;
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

/// About `count` particles in the unit box, each coordinate displaced by a share of the spacing.
pub fn lattice<const D: usize>(count: usize, mut share: impl FnMut() -> f64) -> Particles<D> {
    let side = (count as f64).powf(1.0 / D as f64).round() as usize;
    let spacing = 1.0 / side as f64;
    let mut particles = Particles::default();
    for number in 0..side.pow(D as u32) {
        particles.position.push(Vector::from_fn(|axis, _| {
            let index = number / side.pow(axis as u32) % side;
            (index as f64 + 0.5 + share()) * spacing
        }));
        particles.volume.push(spacing.powi(D as i32));
        particles.weight.push(spacing.powi(D as i32));
        particles.spacing.push(spacing);
        particles.body.push(0);
        particles.id.push(number as u32);
    }
    particles
}

/// Prints the row of a scheme whose steps take `step` s.
pub fn measure<const D: usize>(
    mut scheme: TransportVelocity<D>,
    step: f64,
    kernel: Kernel,
    name: &str,
) {
    let mut state = scheme.initial_state();
    let mut new = state.clone();
    let mut integrator = IntegratorKind::KickDriftKick.build(state.len());
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
    let mut neighbors = Vec::new();
    let all: Vec<u32> = (0..particles as u32).collect();
    scheme.sample(0.0, &state, "neighbors", &all, &mut neighbors);
    let speed = particles as f64 / least;
    println!(
        "| {D} | {threads} | {particles} | {mean:.1} | {kernel} | {name} | {millions:.2} | {ns:.0} |",
        threads = rayon::current_num_threads(),
        mean = neighbors.iter().sum::<f64>() / particles as f64,
        kernel = kernel.name(),
        millions = speed / 1e6,
        ns = 1e9 / speed,
    );
}
