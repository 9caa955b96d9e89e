//! The stages of an evaluation.

use super::TotalLagrangian;
use super::fields::Columns;
use crate::Vector;
use crate::schemes::ledger::{Found, Totals};
use crate::schemes::stages::{Stage, StageFault, Stages};

/// A pass over particles.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Pass {
    /// Displacements with what stands beyond planes and edges, and matrices of places that move.
    Load,
    /// Rates of the displacement gradients, where something depends on them.
    Rates,
    /// Displacement gradients with the stresses of the materials, and what forces gather of them.
    Strains,
    /// Displacement gradients of the strong form, and their rates.
    Gradients,
    /// Stresses of the materials in the strong form.
    Stresses,
    /// What forces gather in the strong form.
    Tensions,
    /// Forces.
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
            Self::Load => {
                stage("load", &["displacement", "velocity"], &["displacement"], &[], &["continued"])
            }
            Self::Rates => {
                stage("rates_of_strain", &[], &["velocity", "continued"], &["gradient_rate"], &[])
            }
            Self::Strains => {
                let gathers = &["displacement", "continued"];
                stage("strains", &["displacement"], gathers, &["gradient"], &["tension"])
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
                let reads = &["displacement", "velocity", "force", "gradient"];
                stage("external", reads, &[], &["rate", "ledger"], &[])
            }
        }
    }
}

/// The stages of an evaluation in the adjoint or the strong form.
///
/// # Errors
/// They do not fit together.
pub(super) fn plan(is_strong: bool, is_viscous: bool) -> Result<Stages<Pass>, StageFault> {
    let strains = match (is_strong, is_viscous) {
        (true, _) => vec![Pass::Gradients, Pass::Stresses, Pass::Tensions],
        (false, true) => vec![Pass::Rates, Pass::Strains],
        (false, false) => vec![Pass::Strains],
    };
    let passes = [&[Pass::Load], &*strains, &[Pass::Forces, Pass::External]].concat();
    Stages::new("rates", &STATE, passes, Pass::stage)
}

impl<const D: usize> TotalLagrangian<D> {
    /// Writes the rates of the columns of `state` at `time`.
    pub(super) fn evaluate(&mut self, time: f64, state: &[f64], rate: &mut [f64]) -> Totals {
        let at = self.columns(state);
        let mut stages = std::mem::take(&mut self.stages);
        let totals = stages.run(|pass, totals| self.run(pass, time, &at, (rate, totals)));
        self.stages = stages;
        totals
    }

    /// The same, where the forces between particles are those at hand.
    pub(super) fn evaluate_from_outside(
        &mut self,
        time: f64,
        state: &[f64],
        rate: &mut [f64],
    ) -> Totals {
        let at = self.columns(state);
        let mut stages = std::mem::take(&mut self.stages);
        let totals = stages.run_last(|pass, totals| self.run(pass, time, &at, (rate, totals)));
        self.stages = stages;
        totals
    }

    /// Runs the passes that lead to forces.
    pub(super) fn evaluate_forces(&mut self, time: f64, at: &Columns<'_, D>) {
        let passes = self.stages.passes().to_vec();
        for pass in passes.into_iter().filter(|pass| *pass != Pass::External) {
            self.run(pass, time, at, (&mut [], &mut Totals::default()));
        }
    }

    /// Runs one pass at a time and columns of a state.
    fn run(&mut self, pass: Pass, time: f64, at: &Columns<'_, D>, found: Found<'_>) {
        match pass {
            Pass::Load => {
                self.load(at);
                self.has_matrices = self.rebuild();
            }
            Pass::External => self.external_pass(time, at, found),
            // No matrices: two particles meet. The state that follows is refused as not finite.
            Pass::Forces if !self.has_matrices => {
                self.force.fill(Vector::from_element(f64::NAN));
            }
            _ if !self.has_matrices => {}
            Pass::Rates => self.fill_rates(at),
            Pass::Strains => self.fill_strains(),
            Pass::Gradients => self.fill_gradients(time, at),
            Pass::Stresses => self.fill_stresses(),
            Pass::Tensions => self.fill_tensions(),
            Pass::Forces => self.fill_forces(),
        }
    }
}
