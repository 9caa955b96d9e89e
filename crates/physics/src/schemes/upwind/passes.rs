//! One evaluation of the rates as a row of passes, and what they move through memory.

use super::{Side, Slope, Upwind};
use crate::schemes::Scheme;
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
const SIDE: &[&str] = &["side.position", "side.velocity", "side.cofactor", "side.pressure"];

impl Pass {
    fn stage(self) -> Stage {
        let stage =
            |name, reads, gathers, writes, shows| Stage { name, reads, gathers, writes, shows };
        match self {
            Self::BodyForces => stage("body_forces", &[], &[], &["body_acceleration"], &[]),
            Self::Local => stage("local", &STATE, &[], &[], SIDE),
            Self::Slopes => stage("slopes", SIDE, SIDE, &[], &["slopes"]),
            Self::Pairs => {
                let gathers = &["side.velocity", "side.cofactor", "side.pressure", "slopes"];
                stage("pairs", SIDE, gathers, &["rate", "ledger"], &[])
            }
            Self::Boundary => stage("boundary", &["rate", "ledger"], &[], &["rate", "ledger"], &[]),
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
        let mut state = STATE.to_vec();
        match self.settings.reconstruction {
            true => passes.insert(1, Pass::Slopes),
            // Without reconstruction slopes are zero.
            false => state.push("slopes"),
        }
        if !self.steady_body_force {
            passes.insert(0, Pass::BodyForces);
        }
        self.stages = Stages::new("rates", &state, passes, Pass::stage)?;
        Ok(())
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

    /// Bytes that one evaluation reads or writes, every array counted once a pass: what is
    /// left to move when the neighbours of a particle are all found in cache. The boundary pass
    /// touches few particles and counts as nothing.
    pub fn streamed_bytes(&self) -> usize {
        let (count, pairs) = (self.particle_count(), self.support.list.pairs());
        let row = self.width() * size_of::<f64>();
        let vector = size_of::<Vector<D>>();
        let reference = size_of::<super::Reference>();
        let (side, slope) = (size_of::<Side<f64, D>>(), size_of::<Slope<f64, D>>());
        let entry = size_of::<u32>();
        let local = count * (row + vector + reference + entry + side);
        let list = count * size_of::<usize>() + pairs * entry;
        let slopes = list + count * (side + slope + size_of::<Tensor<D>>());
        let volume = size_of::<f64>();
        let pairwise = self.areas.memory() + count * (side + vector + reference + volume + row);
        match self.settings.reconstruction {
            true => local + slopes + pairwise + count * slope,
            false => local + pairwise,
        }
    }
}
