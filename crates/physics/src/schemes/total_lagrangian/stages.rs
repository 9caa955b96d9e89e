//! The stages of an evaluation.

use super::fields::{Columns, Made};
use super::{Matrices, TotalLagrangian};
use crate::operators::ReferenceGradient;
use crate::schemes::Array;
use crate::schemes::ledger::{Found, Totals};
use crate::schemes::stages::{Stage, StageFault, Stages};
use crate::{Tensor, Vector};

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

/// The columns of the state, constants, and lists of neighbours.
const STATE: [&str; 10] = [
    "displacement",
    "velocity",
    "kick",
    "mass",
    "volume",
    "mixture",
    "center",
    "hourglass",
    "coefficients",
    "dual_coefficients",
];

impl Pass {
    fn stage(self) -> Stage {
        let stage =
            |name, reads, gathers, writes, shows| Stage { name, reads, gathers, writes, shows };
        match self {
            Self::Load => {
                let shows = &["displacement", "continued"];
                stage("load", &["displacement", "velocity"], &["displacement"], &[], shows)
            }
            Self::Rates => {
                let gathers = &["velocity", "continued"];
                stage("rates_of_strain", &["coefficients"], gathers, &["gradient_rate"], &[])
            }
            Self::Strains => {
                let gathers = &["displacement", "continued"];
                let reads = &[
                    "displacement",
                    "gradient_rate",
                    "coefficients",
                    "center",
                    "hourglass",
                    "volume",
                    "mixture",
                ];
                stage("strains", reads, gathers, &["gradient"], &["tension"])
            }
            Self::Gradients => {
                let gathers = &["displacement", "velocity", "continued"];
                let writes = &["gradient", "gradient_rate"];
                stage("gradients", &["coefficients"], gathers, writes, &[])
            }
            Self::Stresses => stage("stresses", &["gradient", "mixture"], &[], &["stress"], &[]),
            Self::Tensions => {
                stage("tensions", &["gradient", "gradient_rate", "stress"], &[], &[], &["tension"])
            }
            Self::Forces => {
                let gathers = &["tension", "displacement", "continued"];
                let reads = &["tension", "displacement", "dual_coefficients", "center"];
                stage("forces", reads, gathers, &["force"], &[])
            }
            Self::External => {
                let reads = &["displacement", "velocity", "force", "gradient", "mass"];
                stage("external", reads, &[], &["rate", "ledger"], &[])
            }
        }
    }
}

/// The stages of an evaluation in the adjoint or the strong form.
///
/// # Errors
/// They do not fit together.
pub(super) fn plan<const D: usize>(
    matrices: &Matrices<D>,
    count: usize,
    is_viscous: bool,
) -> Result<Stages<Pass>, StageFault> {
    let is_strong = matrices.edges().is_some();
    let mut state = STATE.to_vec();
    if !is_viscous {
        // Nobody fills or reads it.
        state.push("gradient_rate");
    }
    let strains = match (is_strong, is_viscous) {
        (true, _) => vec![Pass::Gradients, Pass::Stresses, Pass::Tensions],
        (false, true) => vec![Pass::Rates, Pass::Strains],
        (false, false) => vec![Pass::Strains],
    };
    let passes = [&[Pass::Load], &*strains, &[Pass::Forces, Pass::External]].concat();
    Stages::new("rates", &state, passes, Pass::stage, (count, &arrays(matrices, count, is_viscous)))
}

/// What the columns of stages stand in.
fn arrays<const D: usize>(matrices: &Matrices<D>, count: usize, is_viscous: bool) -> Vec<Array> {
    let tensor = size_of::<Tensor<D>>();
    let tensions = match matrices {
        Matrices::Adjoint(discrete) => discrete.operator.tensions(),
        Matrices::Strong(_) => 1,
    };
    let [center, hourglass] = match matrices {
        Matrices::Adjoint(_) => ReferenceGradient::<D>::OWN,
        Matrices::Strong(_) => [0; 2],
    };
    let [gradients, forces] = matrices.sizes();
    let own = [
        Array::spread("continued", matrices.behind() * size_of::<Vector<D>>(), count),
        Array::of::<Tensor<D>>("gradient"),
        Array::with("gradient_rate", if is_viscous { tensor } else { 0 }),
        Array::of::<Tensor<D>>("stress"),
        Array::with("tension", tensions * tensor),
        Array::of::<Vector<D>>("force"),
        Array::of::<Vector<D>>("rate"),
        Array::with("ledger", 0),
        Array::of::<f64>("mass"),
        Array::of::<f64>("volume"),
        Array::of::<u32>("mixture"),
        Array::with("center", center),
        Array::with("hourglass", hourglass),
        Array::rows("coefficients", gradients, gradients.rows),
        Array::rows("dual_coefficients", forces, forces.rows),
    ];
    Array::columns(Made::FIELDS, D).chain(own).collect()
}

impl<const D: usize> TotalLagrangian<D> {
    /// Writes the rates of the velocities of `state` at `time`.
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
