//! The density as a sum over masses.

use piola_formulas::fluid;
use piola_formulas::pairs::sums::Density;

use super::{Common, DensityRule, StoredMut, WeaklyCompressible};
use crate::operators::{Among, NeighborBlock, Term, add_at};
use crate::parallel;
use crate::schemes::transport_velocity::Side;

impl<const D: usize> WeaklyCompressible<D> {
    /// Fills `densities` with `rho_a = sum_b m_b W_ab`, walls and a itself included.
    fn sum_densities(&mut self, common: &Common<D>) {
        let (support, sides) = (&common.support, common.sides.as_slice());
        let sum = Term { law: Density::<D>, source: sides, among: Among::All };
        let centre = support.centre();
        parallel::for_each_chunk(&mut self.densities, |first, rows| {
            let mut block = NeighborBlock::default();
            for (offset, density) in rows.iter_mut().enumerate() {
                let place = first + offset;
                *density = sides[place].mass() * centre;
                add_at(support, &sum, place, &mut block, density);
            }
        });
    }

    /// Fills by how much the summation density is above the density, theory (108): zero on and near free surfaces, where the
    /// sum is no density, unless gradients are corrected and it is above all the same, theory (113); and in the buffers of open
    /// boundaries, whose state is prescribed.
    pub(super) fn find_excess(&self, common: &Common<D>, state: &mut [f64]) {
        let (scale, centre) = (self.lattice_sum.recip(), common.support.centre());
        let (places, h) = (common.support.list().places(), common.support.smoothing_length());
        let (_, tail) = common.parts(state);
        let (StoredMut { excess, opening, .. }, _) = StoredMut::<D>::of(tail, common.count());
        let (opening, corrected) = (&*opening, common.settings.corrects_gradients());
        parallel::for_each_chunk(excess, |first, rows| {
            for (row, excess) in (first..).zip(rows) {
                let place = places[row] as usize;
                if common.active(place).is_none() || opening[row] != 0.0 {
                    *excess = 0.0;
                    continue;
                }
                let side = &common.sides[place];
                let summed = side.mass() * centre + common.forces[place].filling;
                let above = summed * scale - side.density;
                *excess = match common.openings[place].reach >= h {
                    true => above,
                    false if corrected => above.max(0.0),
                    false => 0.0,
                };
            }
        });
    }

    /// Gives the fluid the density and pressure that are functions of where particles are, or of
    /// each other. Returns the largest speed of the fluid in m/s, as it passes over all particles
    /// anyhow.
    pub(super) fn update_density_and_pressure(&mut self, common: &mut Common<D>) -> f64 {
        let sums = common.settings.density == DensityRule::Summation;
        let algebraic = common.settings.is_algebraic();
        if sums {
            self.sum_densities(common);
        }
        let (densities, list, fluid) = (&self.densities, common.support.list(), self.fluid);
        let owned = list.owned();
        let nothing = &mut vec![(); owned];
        let update = |first: usize, sides: &mut [Side<D>], _: &mut [()]| {
            let mut fastest = 0.0;
            for (offset, side) in sides.iter_mut().enumerate() {
                let place = first + offset;
                if list.is_passive(place) {
                    continue;
                }
                let density = if sums { densities[place] } else { side.density };
                let pressure = match algebraic {
                    true => fluid::pressure(density, fluid.density, fluid.wave_speed),
                    false => side.pressure,
                };
                if (density, pressure) != (side.density, side.pressure) {
                    side.set(side.mass(), density, pressure);
                }
                fastest = parallel::larger(fastest, side.velocity.norm_squared());
            }
            fastest
        };
        let own = &mut common.sides[..owned];
        let own = parallel::maximum_of_chunks(own, nothing, 0.0, update);
        if common.settings.sets_state() {
            common.show_sides();
        }
        let [square] = common.team().largest([own]);
        square.sqrt()
    }
}

/// The sum of masses, theory (26).
pub(super) fn summed_density<const D: usize>(common: &Common<D>, number: usize) -> f64 {
    let place = common.support.list().places()[number] as usize;
    let mut sum = common.sides[place].mass() * common.support.centre();
    common.add_all(Density, place, &mut sum);
    sum
}
