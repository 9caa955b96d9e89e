//! Corrections that make velocity gradients exact for linear fields.

use piola_formulas::pairs::solid::{Moments, correction};

use super::{Common, Hypoelastic};
use crate::Tensor;
use crate::operators::{Among, Term, gather};

impl<const D: usize> Hypoelastic<D> {
    /// Fills the corrections `L_a = [ sum V_b (r_b - r_a) (x) grad W_ab ]^-1`, theory (74), over the own
    /// body and walls, where gradients are corrected. They are symmetric, as the sum is.
    pub(super) fn correct_gradients(&mut self, common: &Common<D>) {
        self.corrections.fill(Tensor::identity());
        let source = (common.sides.as_slice(), &common.continua);
        let sum = Term { law: Moments::<D>, source, among: Among::All };
        let close = |_: usize, sums: &Tensor<D>, row: &mut _| *row = correction(sums);
        gather(&common.support, &sum, &mut self.corrections, |place| common.active(place), close);
    }
}
