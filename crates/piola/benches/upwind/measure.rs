//! One measurement: a problem, its passes, and the bandwidth beside it.

use std::hint::black_box;

use piola::schemes::Scheme;
use piola::schemes::upwind::{PASSES, Upwind};
use piola::time::runge_kutta::{Blend, advance};

use crate::problem::{self, Switches};
use crate::{bandwidth, clock};

/// What a problem costs; times in seconds.
pub struct Measured {
    pub particles: usize,
    /// Mean number.
    pub neighbors: f64,
    /// Each pass of the fastest evaluation of the rates.
    pub passes: [f64; PASSES.len()],
    /// The look at a new state, once a step.
    pub inspect: f64,
    /// The two updates of the integrator, once a step.
    pub update: f64,
    /// Bytes that an evaluation has to move.
    pub bytes: usize,
    /// Bytes a second at which an array of as many bytes is read.
    pub read_rate: f64,
}

/// Runs `work` with that many threads for parallel loops.
pub fn on_threads<R: Send>(threads: usize, work: impl FnOnce() -> R + Send) -> R {
    let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build();
    pool.expect("a pool of threads can be started").install(work)
}

/// Measures a cloud of about `size` particles.
pub fn run<const D: usize>(size: usize, switches: Switches) -> Measured {
    let (mut scheme, neighbors) = problem::build::<D>(size, switches);
    let particles = scheme.particle_count();
    let bytes = scheme.streamed_bytes().iter().sum();
    let state = problem::disturbed(&scheme);
    let mut rate = vec![0.0; state.len()];
    let (_, passes) = clock::best(|| time_passes(&mut scheme, &state, &mut rate));
    let mut limits = Vec::new();
    let inspect = clock::best_time(|| {
        black_box(scheme.inspect(&state, &mut limits));
    });
    drop(scheme);
    let mut new = state.clone();
    let update = clock::best_time(|| {
        advance(Blend::Predict, 1e-9, &state, &rate, &mut new);
        advance(Blend::Halve, 1e-9, &state, &rate, black_box(&mut new));
    });
    let read_rate = bandwidth::read_rate(bytes);
    Measured { particles, neighbors, passes, inspect, update, bytes, read_rate }
}

fn time_passes<const D: usize>(
    scheme: &mut Upwind<D>,
    state: &[f64],
    rate: &mut [f64],
) -> (f64, [f64; PASSES.len()]) {
    let mut passes = [0.0; PASSES.len()];
    let mut next = passes.iter_mut();
    let start = clock::now();
    let mut last = start;
    scheme.rates_by_pass(0.0, state, black_box(rate), |_| {
        let now = clock::now();
        if let Some(pass) = next.next() {
            *pass = now - last;
        }
        last = now;
    });
    (last - start, passes)
}
