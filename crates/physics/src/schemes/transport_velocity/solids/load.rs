//! What solids take from a state and put into it: matter by place, pressures, stresses.

use piola_formulas::hypoelastic::shear_energy;
use piola_formulas::pairs::solid::SolidTension;

use super::{Common, ENERGY, Hypoelastic, Matter, Solid, Stored, entry, full};
use crate::parallel;
use crate::schemes::transport_velocity::Side;
use crate::{Tensor, Vector};

impl<const D: usize> Hypoelastic<D> {
    /// Fills what neighbours see of solids, by place, from a state whose neighbours are known.
    pub(super) fn load_matter(&mut self, common: &Common<D>, state: &[f64]) {
        let (list, own) = (common.support.list(), Stored::in_state(common, state));
        let begin = common.first();
        parallel::for_each_chunk(&mut self.matter[..list.owned()], |first, places| {
            for (matter, &number) in places.iter_mut().zip(&list.numbers()[first..]) {
                *matter = own.matter(number as usize - begin);
            }
        });
        self.show_matter(common);
        if self.builds != Some(list.builds()) {
            self.builds = Some(list.builds());
            self.load_constants(common);
        }
    }

    /// Shows what neighbours see of solids to the ranks that have copies.
    pub(super) fn show_matter(&mut self, common: &Common<D>) {
        common.team().refresh(&mut self.matter, common.count(), 1);
    }

    /// Fills what does not change but with the places: constants of the materials.
    fn load_constants(&mut self, common: &Common<D>) {
        let (list, bodies) = (common.support.list(), &common.particles.body);
        let materials = &self.materials;
        parallel::for_each_chunk(&mut self.tensions, |first, places| {
            for (tension, &number) in places.iter_mut().zip(&list.numbers()[first..]) {
                let material = &materials[bodies[number as usize] as usize];
                tension.wave_speed = material.state.wave_speed;
                tension.stiffness = material.bulk_modulus();
            }
        });
    }

    /// Gives solids the pressure of their density, if it is not integrated. Returns the largest
    /// speed of [`Solid::speed_squared`] in m/s.
    pub(super) fn update_pressure(&mut self, common: &mut Common<D>) -> f64 {
        let algebraic = common.settings.is_algebraic();
        let (list, bodies, materials) =
            (common.support.list(), &common.particles.body, &self.materials);
        let update = |first: usize, sides: &mut [Side<D>], matter: &mut [Matter]| {
            let mut fastest = 0.0;
            for (offset, (side, matter)) in sides.iter_mut().zip(matter).enumerate() {
                let place = first + offset;
                if list.is_passive(place) {
                    continue;
                }
                let solid = &materials[bodies[list.numbers()[place] as usize] as usize];
                if algebraic {
                    let pressure = solid.state.pressure(side.density, matter[ENERGY]);
                    side.set(side.mass(), side.density, pressure);
                }
                fastest = parallel::larger(fastest, solid.speed_squared(side, matter));
            }
            fastest
        };
        let owned = list.owned();
        let (sides, matter) = (&mut common.sides[..owned], &mut self.matter[..owned]);
        let own = parallel::maximum_of_chunks(sides, matter, 0.0, update);
        if algebraic {
            common.show_sides();
        }
        let [square] = common.team().largest([own]);
        square.sqrt()
    }

    /// Fills the stresses that forces gather, of solids and walls.
    pub(super) fn tension_pass(&mut self, common: &Common<D>) {
        let (sides, matter, corrections) = (&common.sides, &self.matter, &self.corrections);
        let owned = common.count();
        parallel::for_each_chunk(&mut self.tensions[..owned], |first, rows| {
            for (offset, row) in rows.iter_mut().enumerate() {
                let place = first + offset;
                let (side, matter) = (&sides[place], &matter[place]);
                let stress = Tensor::<D>::from_fn(|i, j| {
                    matter[entry(i, j)] - if i == j { side.pressure } else { 0.0 }
                });
                let (tensor, weight, share) = match corrections.get(place) {
                    Some(correction) => (stress * correction, side.volume, 1.0 / side.density),
                    None => (stress / (side.density * side.density), side.mass(), 1.0),
                };
                (row.tensor, row.weight, row.share) = (tensor, weight, share);
            }
        });
        common.team().refresh_records::<SolidTension<D>>(&mut self.tensions, owned);
    }

    /// Gives the wall particle at a place its deviatoric stress. Of a wall that lets slide it is the
    /// mirror image across the normal, so that there is no shear at its face.
    pub(super) fn set_deviator(
        &mut self,
        place: usize,
        deviator: &[f64; 6],
        mirror: Option<&Vector<D>>,
    ) {
        let stored = &mut self.matter[place][..6];
        match mirror {
            None => stored.copy_from_slice(deviator),
            Some(normal) => {
                let normal = super::padded(normal);
                let mirror = Tensor::<3>::identity() - normal * normal.transpose() * 2.0;
                super::store(&(mirror * full(deviator) * mirror), stored);
            }
        }
    }
}

impl Solid {
    /// Square of the speed in m^2/s^2 that a particle would have if all of its elastic energy were
    /// kinetic: `|u|^2 + (p / (rho0 c))^2 + s : s / (2 G rho0)`, theory (76). CTVF (35) has `|u|^2`, which
    /// vanishes where a body turns round and is pulled most.
    #[inline]
    pub(super) fn speed_squared<const D: usize>(&self, side: &Side<D>, matter: &Matter) -> f64 {
        let (density, wave_speed) = (self.state.density, self.state.wave_speed);
        let compression = side.pressure / (density * wave_speed);
        let shear = shear_energy(&full(matter), self.shear_modulus, density);
        side.velocity.norm_squared() + compression * compression + 2.0 * shear
    }
}
