//! What becomes of a run whose device fails.

use piola_device::DeviceError;

use super::*;
use crate::case::{Finished, Session};
use crate::schemes::{DeviceSteps, Health, Phase, Scheme, StepLimit, StepsError};
use crate::time::{Failure, Integrator, KickDriftKick, Outcome};

/// A device that is the processor, and fails at some step.
struct Failing {
    scheme: Box<dyn Scheme>,
    state: Vec<f64>,
    before: Vec<f64>,
    left: usize,
}

impl Failing {
    fn check(&self) -> Result<(), DeviceError> {
        let (what, reason) = ("go on".into(), "it was pulled out".into());
        if self.left > 0 { Ok(()) } else { Err(DeviceError::Refused { what, reason }) }
    }
}

impl DeviceSteps for Failing {
    fn put(&mut self, state: &[f64]) -> Result<(), StepsError> {
        self.state = state.to_vec();
        Ok(self.check()?)
    }

    fn step(&mut self, time: f64, step: f64) -> Result<(), StepsError> {
        self.before.clone_from(&self.state);
        let (before, scheme) = (&self.before, self.scheme.as_mut());
        KickDriftKick::default().step(scheme, time, step, before, &mut self.state).expect("kicks");
        self.left -= 1;
        Ok(self.check()?)
    }

    fn inspect(&mut self, limits: &mut Vec<StepLimit>) -> Result<Health, StepsError> {
        Ok(self.scheme.inspect(&self.state, limits))
    }

    fn fetch(&self, state: &mut [f64]) -> Result<(), StepsError> {
        state.copy_from_slice(&self.state);
        Ok(self.check()?)
    }

    fn fetch_before(&self, state: &mut [f64]) -> Result<(), StepsError> {
        state.copy_from_slice(&self.before);
        Ok(self.check()?)
    }

    fn phases(&self) -> Vec<&Phase> {
        Vec::new()
    }
}

const WATER: &str = r#"
version = 1
title = "Water in a periodic box"
dimension = 2
[domain]
periodic = { x = [0.0, 1.0], y = [0.0, 1.0] }
[[body]]
name = "water"
shape = { kind = "box", min = [0.0, 0.0], max = [1.0, 1.0] }
spacing = 0.1
lattice = { on = "cells", jitter = 0.1, seed = 1 }
material = { kind = "weakly_compressible", density = 1.0, wave_speed = 10.0, viscosity = 0.01 }
initial = { velocity = ["sin(2 * pi * y)", "0"] }
[scheme]
kind = "transport_velocity"
[time]
end = 0.2
[output]
every = 0.1
table_every = 0.005
"#;

/// A run on a device that fails after this many steps.
fn session(steps: Option<usize>) -> Session {
    let case = parse(WATER, "water.toml", &LoadOptions::default());
    let case = case.unwrap_or_else(|problems| panic!("{problems}"));
    let [mut session, other] =
        [(), ()].map(|()| Session::new(&case).unwrap_or_else(|problems| panic!("{problems}")));
    if let Some(left) = steps {
        let (scheme, state) = (other.executor.scheme, Vec::new());
        let device = Failing { scheme, before: Vec::new(), state, left };
        session.executor.use_steps(Box::new(device)).expect("it takes the state");
    }
    session
}

/// The times and the numbers of the table of energies.
fn energies(finished: &Finished) -> Vec<Vec<f64>> {
    finished.tables.energy.rows().map(<[f64]>::to_vec).collect()
}

#[test]
fn a_device_that_fails_leaves_the_last_mark() {
    let run = |steps| {
        let stop = std::sync::atomic::AtomicBool::new(false);
        session(steps).run(&stop, &mut |_| {}).expect("no file is written")
    };
    let (whole, endless, broken) = (run(None), run(Some(usize::MAX)), run(Some(40)));
    assert!(whole.summary.steps > 48, "{} steps are too few for this test", whole.summary.steps);
    assert_eq!(energies(&whole), energies(&endless));
    let outcome = &broken.summary.outcome;
    assert!(matches!(outcome, Outcome::Failed(Failure::Device(_))), "{outcome:?}");
    // Marks are 16 steps apart: the last before step 40.
    assert_eq!(broken.summary.steps, 32);
    let (kept, all) = (energies(&broken), energies(&whole));
    assert!(kept.windows(2).all(|rows| rows[0][0] < rows[1][0]), "times go on");
    // The last row is that of the end, which no table had asked for.
    let due = kept.len() - 1;
    assert!(due > 2 && kept[..due] == all[..due]);
    assert!(broken.summary.time <= kept[due][0] && broken.summary.time < whole.summary.time);
}
