//! The stages of an evaluation.

use super::DualSupport;
use super::fields::Columns;
use crate::Tensor;
use crate::schemes::ledger::{Found, Totals};
use crate::schemes::stages::{Stage, StageFault, Stages};

/// A pass over particles.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Pass {
    /// Gradients and stresses by the supports.
    Sides,
    /// Forces by supports and dual supports.
    Forces,
    /// What acts from outside, and the ledger.
    External,
}

const STATE: [&str; 3] = ["displacement", "velocity", "kick"];

impl Pass {
    fn stage(self) -> Stage {
        let stage =
            |name, reads, gathers, writes, shows| Stage { name, reads, gathers, writes, shows };
        match self {
            Self::Sides => {
                let shown = &["side.gradient", "side.tension", "side.pull"];
                stage("sides", &["displacement"], &["displacement"], &[], shown)
            }
            Self::Forces => {
                let own = &["displacement", "side.gradient", "side.tension", "side.pull"];
                let gathers = &["displacement", "side.gradient", "side.tension"];
                stage("forces", own, gathers, &["force"], &[])
            }
            Self::External => {
                let reads = &["displacement", "velocity", "force", "side.gradient"];
                stage("external", reads, &[], &["rate", "ledger"], &[])
            }
        }
    }
}

/// The stages of an evaluation.
///
/// # Errors
/// They do not fit together.
pub(super) fn plan() -> Result<Stages<Pass>, StageFault> {
    Stages::new("rates", &STATE, vec![Pass::Sides, Pass::Forces, Pass::External], Pass::stage)
}

impl<const D: usize> DualSupport<D> {
    /// Writes the rates of the columns of `state` at `time`.
    pub(super) fn evaluate(&mut self, time: f64, state: &[f64], rate: &mut [f64]) -> Totals {
        let at = self.columns(state);
        let mut stages = std::mem::take(&mut self.stages);
        let totals = stages.run(|pass, totals| self.run(pass, time, &at, (rate, totals)));
        self.stages = stages;
        totals
    }

    /// Runs one pass of the rates at a time and columns of a state.
    pub(super) fn run(&mut self, pass: Pass, time: f64, at: &Columns<'_, D>, found: Found<'_>) {
        match pass {
            Pass::Sides => {
                let discrete = &self.discrete;
                let stress =
                    |a: usize, gradient: &Tensor<D>| discrete.material(a).law.stress(gradient);
                discrete.fill_sides(at.displacement, &mut self.sides, stress);
            }
            Pass::Forces => {
                self.discrete.fill_forces(&self.sides, &mut self.force);
            }
            Pass::External => {
                self.external_pass(time, at, (&self.force, &self.sides), found);
            }
        }
    }
}
