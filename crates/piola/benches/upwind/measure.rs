//! One measurement: a problem, its passes, and the bandwidth beside it.

use std::hint::black_box;

use piola::schemes::Scheme;
use piola::schemes::blend::{Blend, advance};
use piola::schemes::upwind::Upwind;

use crate::problem::{self, Switches};
use crate::{bandwidth, clock};

/// What a problem costs; times in seconds.
pub struct Measured {
    pub particles: usize,
    /// Mean number.
    pub neighbors: f64,
    /// Each pass of the fastest evaluation of the rates.
    pub passes: Vec<(&'static str, f64)>,
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
    let bytes = scheme.phases().iter().map(|phase| phase.least_bytes()).sum::<f64>() as usize;
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
) -> (f64, Vec<(&'static str, f64)>) {
    let totals = |scheme: &Upwind<D>| -> Vec<(&'static str, f64)> {
        let phases = scheme.phases();
        let stages = phases.iter().flat_map(|phase| &phase.stages);
        stages.map(|(stage, watch)| (stage.name, watch.total.as_secs_f64())).collect()
    };
    let (before, start) = (totals(scheme), clock::now());
    scheme.rates(0.0, state, black_box(rate));
    let seconds = clock::now() - start;
    let passes = totals(scheme).into_iter().zip(before);
    (seconds, passes.map(|((name, after), (_, before))| (name, after - before)).collect())
}
