//! What solids take from a state and put into it: matter by place, pressures, stresses.

use piola_formulas::pairs::solid::SolidTension;

use super::{Common, ENERGY, Hypoelastic, Matter, Stored, cauchy_stress, mirrored};
use crate::schemes::transport_velocity::Side;
use crate::{Vector, parallel};

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
                let stress = cauchy_stress(side.pressure, matter);
                row.set(&stress, side, corrections.get(place));
            }
        });
        common.team().refresh_records::<SolidTension<D>>(&mut self.tensions, owned);
    }

    /// Gives the wall particle at a place its deviatoric stress, that of a wall that lets slide [`mirrored`].
    pub(super) fn set_deviator(
        &mut self,
        place: usize,
        deviator: &[f64; 6],
        mirror: Option<&Vector<D>>,
    ) {
        let deviator = mirror.map_or(*deviator, |normal| mirrored(deviator, normal));
        self.matter[place][..6].copy_from_slice(&deviator);
    }
}
