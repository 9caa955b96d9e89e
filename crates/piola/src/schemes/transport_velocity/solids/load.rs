//! What solids take from a state and put into it: matter by place, pressures, stresses.

use piola_formulas::hypoelastic::{shear_energy, von_mises};

use super::{ENERGY, MATTER, Matter, Solid, TEMPERATURE, entry, full};
use crate::parallel;
use crate::schemes::transport_velocity::fields::Made;
use crate::schemes::transport_velocity::{Columns, Side, TransportVelocity};
use crate::{Tensor, Vector};

impl<const D: usize> TransportVelocity<D> {
    /// Fills what neighbours see of solids, by place, from a state whose neighbours are known.
    pub(in super::super) fn load_matter(&mut self, state: &[f64]) {
        let start = self.matter_start();
        let Some(solids) = &mut self.solids else { return };
        let (list, rows) = (self.support.list(), &state[start..]);
        parallel::for_each_chunk(&mut solids.matter, |first, places| {
            for (matter, &number) in places.iter_mut().zip(&list.numbers()[first..]) {
                matter.copy_from_slice(&rows[number as usize * MATTER..][..MATTER]);
            }
        });
        if solids.builds != Some(list.builds()) {
            solids.builds = Some(list.builds());
            self.load_constants();
        }
    }

    /// Fills what does not change but with the places: constants of the materials and continua.
    fn load_constants(&mut self) {
        let Some(solids) = &mut self.solids else { return };
        let list = self.support.list();
        let (materials, bodies) = (&solids.materials, &self.particles.body);
        parallel::for_each_chunk(&mut solids.tensions, |first, places| {
            for (tension, &number) in places.iter_mut().zip(&list.numbers()[first..]) {
                let material = &materials[bodies[number as usize] as usize];
                tension.wave_speed = material.state.wave_speed;
                tension.stiffness = material.bulk_modulus();
            }
        });
        self.continua.load(list.numbers(), &self.particles, &self.is_wall);
    }

    /// Fills the matter of the start.
    pub(in super::super) fn begin_matter(&self, rows: &mut [f64]) {
        let Some(solids) = &self.solids else { return };
        for (number, row) in rows.chunks_exact_mut(MATTER).enumerate() {
            row.fill(0.0);
            let material = &solids.materials[self.particles.body[number] as usize];
            row[TEMPERATURE] = material.heat.temperature;
        }
    }

    /// Gives solids the pressure of their density, if it is not integrated. Returns the largest
    /// speed of [`Solid::speed_squared`] in m/s.
    pub(in super::super) fn update_pressure_of_solids(&mut self) -> f64 {
        let Some(solids) = &mut self.solids else { return 0.0 };
        let algebraic = self.settings.is_algebraic();
        let (list, bodies, materials) =
            (self.support.list(), &self.particles.body, &solids.materials);
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
        parallel::maximum_of_chunks(&mut self.sides, &mut solids.matter, 0.0, update).sqrt()
    }

    /// Fills the stresses that forces gather, of solids and walls.
    pub(in super::super) fn tension_pass(&mut self) {
        let Some(solids) = &mut self.solids else { return };
        let (sides, matter) = (&self.sides, &solids.matter);
        let corrections = &solids.corrections;
        parallel::for_each_chunk(&mut solids.tensions, |first, rows| {
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
    }

    /// Gives the wall particle at a place its deviatoric stress. Of a wall that lets slide it is the
    /// mirror image across the normal, so that there is no shear at its face.
    pub(in super::super) fn set_deviator(
        &mut self,
        place: usize,
        deviator: &[f64; 6],
        mirror: Option<&Vector<D>>,
    ) {
        let Some(solids) = &mut self.solids else { return };
        let stored = &mut solids.matter[place][..6];
        match mirror {
            None => stored.copy_from_slice(deviator),
            Some(normal) => {
                let normal = super::padded(normal);
                let mirror = Tensor::<3>::identity() - normal * normal.transpose() * 2.0;
                super::store(&(mirror * full(deviator) * mirror), stored);
            }
        }
    }

    /// The matter of a particle (number) in a state of solids.
    pub(in super::super) fn matter_of<'a>(&self, number: usize, state: &'a [f64]) -> &'a [f64] {
        &state[self.matter_start() + number * MATTER..][..MATTER]
    }

    /// Speed of longitudinal waves in a solid (number) in m/s.
    pub(in super::super) fn signal_speed(&self, number: usize, state: &[f64]) -> Option<f64> {
        let solid = self.solid(number)?;
        let density = self.columns(state).density[number];
        let energy = self.matter_of(number, state)[ENERGY];
        let bulk = solid.state.wave_speed_squared(density, energy);
        Some((bulk + 4.0 / 3.0 * solid.shear_modulus / density).sqrt())
    }

    /// Appends a field of solids; fluids have zeros.
    pub(in super::super) fn push_solid_field(
        &self,
        field: Made,
        number: usize,
        (at, state): (&Columns<'_, D>, &[f64]),
        values: &mut Vec<f64>,
    ) {
        let pressure = at.pressure[number];
        if self.solids.is_none() {
            let count = if field == Made::cauchy_stress { D * D } else { 1 };
            values.extend(std::iter::repeat_n(0.0, count));
            return;
        }
        let matter = self.matter_of(number, state);
        match field {
            Made::cauchy_stress => values.extend((0..D * D).map(|k| {
                let (i, j) = (k / D, k % D);
                matter[entry(i, j)] - if i == j { pressure } else { 0.0 }
            })),
            Made::von_mises => values.push(von_mises(&full(matter))),
            Made::plastic_strain => values.push(matter[super::PLASTIC]),
            _ => values.push(matter[TEMPERATURE]),
        }
    }
}

impl<const D: usize> TransportVelocity<D> {
    /// Square of the speed in m^2/s^2 that shifting takes for that of a particle, at a place: of a
    /// solid [`Solid::speed_squared`], of a fluid `|u|^2`.
    pub(in super::super) fn shifting_speed_squared(&self, place: usize) -> f64 {
        let (side, number) = (&self.sides[place], self.support.list().numbers()[place]);
        match (&self.solids, self.solid(number as usize)) {
            (Some(solids), Some(solid)) => solid.speed_squared(side, &solids.matter[place]),
            _ => side.velocity.norm_squared(),
        }
    }
}

impl Solid {
    /// Square of the speed in m^2/s^2 that a particle would have if all of its elastic energy were
    /// kinetic: `|u|^2 + (p / (rho0 c))^2 + s : s / (2 G rho0)`, theory (76). CTVF (35) has `|u|^2`, which
    /// vanishes where a body turns round and is pulled most.
    #[inline]
    fn speed_squared<const D: usize>(&self, side: &Side<D>, matter: &Matter) -> f64 {
        let (density, wave_speed) = (self.state.density, self.state.wave_speed);
        let compression = side.pressure / (density * wave_speed);
        let shear = shear_energy(&full(matter), self.shear_modulus, density);
        side.velocity.norm_squared() + compression * compression + 2.0 * shear
    }
}
