//! One evaluation of the rates as a row of passes, and what they move through memory.

use super::fields::Made;
use super::{Reference, Side, Slope, Upwind};
use crate::fields::width;
use crate::schemes::Array;
use crate::schemes::ledger::Found;
use crate::schemes::stages::{Stage, StageFault, Stages};
use crate::{Tensor, Vector};

/// A pass over particles.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Pass {
    /// Body forces, where they change in time.
    BodyForces,
    /// What each particle shows its neighbours.
    Local,
    /// Slopes for the reconstruction.
    Slopes,
    /// Forces, rates of the deformation and dissipation.
    Pairs,
    /// Tractions and prescribed motion.
    Boundary,
}

const STATE: [&str; 4] = ["velocity", "volume_ratio", "position", "deformation_gradient"];
/// What the local pass reads: the state, and constants.
const LOCAL: [&str; 7] = [
    "velocity",
    "volume_ratio",
    "position",
    "deformation_gradient",
    "reference_position",
    "reference",
    "body",
];
/// Constants of other passes, and lists of neighbours.
const CONSTANTS: [&str; 9] = [
    "reference_position",
    "reference",
    "body",
    "volume",
    "areas",
    "neighbors",
    "diagonal",
    "least_squares",
    "acted_on",
];
const SIDE: &[&str] = &["side.position", "side.velocity", "side.cofactor", "side.pressure"];

impl Pass {
    fn stage(self) -> Stage {
        let stage =
            |name, reads, gathers, writes, shows| Stage { name, reads, gathers, writes, shows };
        match self {
            Self::BodyForces => stage("body_forces", &[], &[], &["body_acceleration"], &[]),
            Self::Local => stage("local", &LOCAL, &[], &[], SIDE),
            Self::Slopes => {
                let reads = &[
                    "side.position",
                    "side.velocity",
                    "side.pressure",
                    "neighbors",
                    "least_squares",
                ];
                stage("slopes", reads, SIDE, &[], &["slopes"])
            }
            Self::Pairs => {
                let reads = &[
                    "side.position",
                    "side.velocity",
                    "side.cofactor",
                    "side.pressure",
                    "areas",
                    "diagonal",
                    "reference",
                    "volume",
                    "body_acceleration",
                ];
                let gathers = &["side.velocity", "side.cofactor", "side.pressure", "slopes"];
                stage("pairs", reads, gathers, &["rate", "ledger"], &[])
            }
            Self::Boundary => {
                let reads = &["rate", "ledger", "acted_on"];
                stage("boundary", reads, &[], &["rate", "ledger"], &[])
            }
        }
    }
}

impl<const D: usize> Upwind<D> {
    /// Puts the stages of an evaluation together.
    ///
    /// # Errors
    /// They do not fit together.
    pub(super) fn plan(&mut self) -> Result<(), StageFault> {
        let mut passes = vec![Pass::Local, Pass::Pairs, Pass::Boundary];
        let mut state = [&STATE[..], &CONSTANTS].concat();
        match self.settings.reconstruction {
            true => passes.insert(1, Pass::Slopes),
            // Without reconstruction slopes are zero, and nobody reads them.
            false => state.push("slopes"),
        }
        match self.steady_body_force {
            true => state.push("body_acceleration"),
            false => passes.insert(0, Pass::BodyForces),
        }
        let arrays = (self.particles.len(), &*self.arrays());
        self.stages = Stages::new("rates", &state, passes, Pass::stage, arrays)?;
        Ok(())
    }

    /// What the columns of its stages stand in.
    fn arrays(&self) -> Vec<Array> {
        let count = self.particles.len();
        let acted_on = self.loaded.len() + self.prescribed.iter().count();
        let slope = if self.settings.reconstruction { size_of::<Slope<f64, D>>() } else { 0 };
        let own = [
            Array::of::<Side<f64, D>>("side"),
            Array::with("slopes", slope),
            Array::with("rate", width(Made::FIELDS, D) * size_of::<f64>()),
            Array::with("ledger", 0),
            Array::of::<Vector<D>>("reference_position"),
            Array::of::<Reference>("reference"),
            Array::of::<u32>("body"),
            Array::of::<f64>("volume"),
            Array::of::<Vector<D>>("body_acceleration"),
            Array::of::<Vector<D>>("diagonal"),
            Array::of::<Tensor<D>>("least_squares"),
            Array::rows("areas", self.areas.pairs.sizes(), count),
            Array::rows("neighbors", self.areas.pairs.index_sizes(), count),
            Array::of_few("acted_on", acted_on, count),
        ];
        Array::columns(Made::FIELDS, D).chain(own).collect()
    }

    /// Runs one pass of the rates of `state` at `time`.
    pub(super) fn run(&mut self, pass: Pass, time: f64, state: &[f64], (rate, totals): Found<'_>) {
        match pass {
            Pass::BodyForces => self.update_body_acceleration(time),
            Pass::Local => self.local_pass(state),
            Pass::Slopes => self.slope_pass(),
            Pass::Pairs => self.pair_pass(rate, totals),
            Pass::Boundary => self.boundary_pass(time, rate, totals),
        }
    }
}
