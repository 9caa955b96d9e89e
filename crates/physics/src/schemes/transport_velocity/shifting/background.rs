//! GTVF: a velocity deviation by a background pressure that each particle has of its own.

use piola_formulas::pairs::sums::Background;

use crate::operators::{Among, NeighborBlock, Term, add_at};
use crate::schemes::transport_velocity::{AtRest, Common, Shifting};
use crate::{Vector, parallel};

impl<const D: usize> Common<D> {
    /// Puts the deviations of GTVF into the sides, which have been loaded, and into the `state` that they
    /// were loaded from: what a background pressure does in half of a step of `step` s,
    /// `d_a = dt/2 (du_a/dt)_c`, `(du_a/dt)_c = -p0_a sum_b m_b / rho_a^2 grad W(r_ab, h/2)`,
    /// `p0_a = min(10 |p_a|, f rho_0 c^2)`, theory (79).
    ///
    /// A free surface is not looked for: there the pressure vanishes, and the push with it. Sums run over
    /// the own body and walls. What moves as prescribed is not pushed.
    pub(in super::super) fn push_apart(&mut self, step: f64, state: &mut [f64]) {
        let Shifting::Background { most } = self.settings.shifting else { return };
        let (own, _) = self.parts(state);
        let (scheme, begin) = (&*self, self.first());
        parallel::for_each_chunk(own.deviation, |first, deviation| {
            for (row, deviation) in (first..).zip(deviation) {
                *deviation = scheme.background_push(row, most) * (0.5 * step);
            }
        });
        let (list, deviation) = (self.support.list(), &*own.deviation);
        parallel::for_each_chunk(&mut self.sides[..list.owned()], |first, sides| {
            for (side, &number) in sides.iter_mut().zip(&list.numbers()[first..]) {
                side.deviation = deviation[number as usize - begin];
            }
        });
        self.show_sides();
    }

    /// The acceleration by the background pressure of a particle (row), in m/s^2, which is at most
    /// `most` times `rho_0 c^2`.
    fn background_push(&self, row: usize, most: f64) -> Vector<D> {
        let (support, list) = (&self.support, self.support.list());
        let (number, place) = (self.first() + row, list.places()[row] as usize);
        let me = &self.sides[place];
        if list.is_passive(place) || me.pressure == 0.0 || self.is_unshifted(number) {
            return Vector::zeros();
        }
        let law = Background::<D>::of(support.kernel(), support.smoothing_length());
        let source = (self.sides.as_slice(), &self.continua);
        let (mut sum, block) = (Vector::zeros(), &mut NeighborBlock::default());
        add_at(support, &Term { law, source, among: Among::All }, place, block, &mut sum);
        let AtRest { density, wave_speed } = *self.at_rest(number);
        sum * Background::scale(me, most, [density, wave_speed])
    }
}
