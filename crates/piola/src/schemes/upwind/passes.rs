//! One evaluation of the rates as a row of passes, and what they move through memory.

use super::{Side, Slope, Upwind};
use crate::schemes::Scheme;
use crate::{Tensor, Vector};

/// The passes of one evaluation, in their order.
pub const PASSES: [&str; 4] = ["local", "slopes", "pairs", "boundary"];

impl<const D: usize> Upwind<D> {
    /// [`Scheme::rates`] that calls `done` with the name of each pass when it has ended, for those
    /// who want to know where time goes.
    pub fn rates_by_pass(
        &mut self,
        time: f64,
        state: &[f64],
        rate: &mut [f64],
        mut done: impl FnMut(&'static str),
    ) {
        if !self.steady_body_force {
            self.update_body_acceleration(time);
        }
        self.local_pass(state);
        done(PASSES[0]);
        self.slope_pass();
        done(PASSES[1]);
        self.pair_pass(rate);
        done(PASSES[2]);
        self.boundary_pass(time, rate);
        done(PASSES[3]);
    }

    /// Bytes that each pass of one evaluation reads or writes, every array counted once: what is
    /// left to move when the neighbours of a particle are all found in cache. The boundary pass
    /// touches few particles and counts as nothing.
    pub fn streamed_bytes(&self) -> [usize; PASSES.len()] {
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
            true => [local, slopes, pairwise + count * slope, 0],
            false => [local, 0, pairwise, 0],
        }
    }
}
