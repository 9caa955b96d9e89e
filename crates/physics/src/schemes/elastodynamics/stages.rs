//! The stages of an evaluation.

use super::fields::Columns;
use super::{Configuration, Elastodynamics};
use crate::schemes::ledger::{Found, Totals};
use crate::schemes::stages::{Stage, StageFault, Stages};

/// A pass over particles.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Pass {
    /// Displacements with what stands beyond edges, and matrices of places that move.
    Load,
    /// Displacement gradients, and their rates where something dissipates.
    Gradients,
    /// Stresses of the materials.
    Stresses,
    /// What forces gather: stress times volume, with viscosity and hourglass terms.
    Tensions,
    /// Forces.
    Forces,
    /// What acts from outside, and the ledger.
    External,
}

const STATE: [&str; 3] = ["displacement", "velocity", "kick"];

impl Pass {
    /// Those that lead to forces.
    pub const INTERNAL: [Self; 5] =
        [Self::Load, Self::Gradients, Self::Stresses, Self::Tensions, Self::Forces];

    fn stage(self) -> Stage {
        let stage =
            |name, reads, gathers, writes, shows| Stage { name, reads, gathers, writes, shows };
        match self {
            Self::Load => {
                stage("load", &["displacement", "velocity"], &["displacement"], &[], &["continued"])
            }
            Self::Gradients => {
                let gathers = &["displacement", "velocity", "continued"];
                stage("gradients", &[], gathers, &["gradient", "gradient_rate"], &[])
            }
            Self::Stresses => stage("stresses", &["gradient"], &[], &["stress"], &[]),
            Self::Tensions => {
                stage("tensions", &["gradient", "gradient_rate", "stress"], &[], &[], &["tension"])
            }
            Self::Forces => {
                let gathers = &["tension", "displacement", "continued"];
                stage("forces", &["tension"], gathers, &["force"], &[])
            }
            Self::External => {
                let reads = &["displacement", "velocity", "force", "stress", "gradient_rate"];
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
    let passes = Pass::INTERNAL.into_iter().chain([Pass::External]).collect();
    Stages::new("rates", &STATE, passes, Pass::stage)
}

impl<const D: usize> Elastodynamics<D> {
    /// Writes the rates of the columns of `state` at `time`.
    pub(super) fn evaluate(&mut self, time: f64, state: &[f64], rate: &mut [f64]) -> Totals {
        let at = self.columns(state);
        let mut stages = std::mem::take(&mut self.stages);
        let totals = stages.run(|pass, totals| self.run(pass, time, &at, (rate, totals)));
        self.stages = stages;
        totals
    }

    /// Runs one pass that leads to forces at a time and columns of a state.
    pub(super) fn run(&mut self, pass: Pass, time: f64, at: &Columns<'_, D>, found: Found<'_>) {
        match pass {
            Pass::Load => {
                self.load(at);
                let moves = self.settings.configuration == Configuration::Updated;
                self.has_matrices = !moves || self.rebuild();
            }
            // No matrices: two particles meet. The state that follows is refused as not finite.
            Pass::Forces if !self.has_matrices => {
                self.force.fill(crate::Vector::from_element(f64::NAN));
            }
            Pass::Gradients if self.has_matrices => self.fill_gradients(time, at),
            Pass::Stresses if self.has_matrices => self.fill_stresses(),
            Pass::Tensions if self.has_matrices => self.fill_tensions(),
            Pass::Forces => self.fill_forces(),
            Pass::External => self.external_pass(time, at, found),
            Pass::Gradients | Pass::Stresses | Pass::Tensions => {}
        }
    }
}
