//! The stages of an evaluation.

use super::DualSupport;
use super::fields::Columns;
use crate::schemes::ledger::{Found, Totals};
use crate::schemes::stages::{Stage, StageFault, Stages};

/// A pass over particles.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Pass {
    /// Gradients and stresses by the supports.
    Strains,
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
            Self::Strains => {
                let own = &["displacement"];
                stage("strains", own, own, &["gradient"], &["tension"])
            }
            Self::Forces => {
                let both = &["displacement", "tension"];
                stage("forces", both, both, &["force"], &[])
            }
            Self::External => {
                let reads = &["displacement", "velocity", "force", "gradient"];
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
    Stages::new("rates", &STATE, vec![Pass::Strains, Pass::Forces, Pass::External], Pass::stage)
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
            Pass::Strains => {
                self.discrete.fill_strains(at.displacement, &mut self.strained);
            }
            Pass::Forces => {
                self.discrete.operator.forces(
                    at.displacement,
                    &self.strained.tension,
                    &mut self.force,
                );
            }
            Pass::External => {
                self.external_pass(time, at, (&self.force, &self.strained.gradient), found);
            }
        }
    }
}
