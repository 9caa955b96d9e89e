//! Corrections that make gradients exact for linear fields, and the velocity gradients found with them.

use piola_formulas::pairs::corrected::{
    GradientSide, GradientSums, Gradients, VelocityGradient, WallMoment,
};

use super::{Common, WeaklyCompressible};
use crate::operators::{Among, Term, gather};

impl<const D: usize> WeaklyCompressible<D> {
    /// Fills what corrected forces gather besides sides, theory (109) and (111): of the fluid; walls have no correction.
    pub(super) fn find_gradients(&mut self, common: &Common<D>) {
        let mut gradients = std::mem::take(&mut self.gradients);
        gradients.fill(Gradients::none());
        let source = common.sides.as_slice();
        let fluid = Term { law: VelocityGradient::<D>, source, among: Among::Active };
        let walls = Term { law: WallMoment::<D>, source, among: Among::Passive };
        let close = |_: usize, sums: &GradientSums<f64, D>, row: &mut _| *row = sums.gradients();
        let owned = &mut gradients[..common.support.list().owned()];
        gather(&common.support, &(fluid, walls), owned, |place| common.active(place), close);
        common.team().refresh_records::<GradientSide<D>>(&mut gradients, common.count());
        self.gradients = gradients;
    }
}
