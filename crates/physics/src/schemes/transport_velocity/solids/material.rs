//! The material of a solid, and the laws of one particle of it: for plain numbers, and for those that record what is done
//! to them.

use nalgebra::SMatrix;
use piola_formulas::Number;
use piola_formulas::hypoelastic::{EquationOfState, Strength, advance, shear_energy, von_mises};
use piola_formulas::pairs::fluid::Side;
use piola_formulas::pairs::solid::MATTER;

use super::{ENERGY, PLASTIC, SolidRates, TEMPERATURE, full, store};

/// The material of one body.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Solid {
    /// Pressure, with the density in kg/m^3 and the bulk wave speed in m/s at rest.
    pub state: EquationOfState,
    /// Shear modulus in Pa.
    pub shear_modulus: f64,
    /// When it flows.
    pub strength: Strength,
    /// What plastic work does to the temperature.
    pub heat: Heat,
}

/// How plastic work heats a solid.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Heat {
    /// Temperature at the start in K.
    pub temperature: f64,
    /// Specific heat in J/(kg K).
    pub specific_heat: f64,
    /// Share of the plastic work that becomes heat.
    pub share: f64,
}

impl Heat {
    /// Room temperature and a solid that does not warm up.
    pub const NONE: Self = Self { temperature: 293.15, specific_heat: 1.0, share: 0.0 };
}

/// A particle of a solid that a drift moves on: density in kg/m^3, pressure in Pa and the material state.
pub(in super::super) struct Moved<T> {
    pub density: T,
    pub pressure: T,
    pub matter: [T; MATTER],
}

/// A step of a drift.
pub(in super::super) struct Step<T> {
    /// Its length in s.
    pub duration: T,
    /// Mass of the particle in kg.
    pub mass: T,
    /// Whether the pressure is integrated.
    pub evolves: bool,
}

impl Solid {
    /// Bulk modulus at rest in Pa.
    pub fn bulk_modulus(&self) -> f64 {
        self.state.density * self.state.wave_speed * self.state.wave_speed
    }

    /// Square of the speed in m^2/s^2 that a particle would have if all of its elastic energy were
    /// kinetic: `|u|^2 + (p / (rho0 c))^2 + s : s / (2 G rho0)`, theory (76). CTVF (35) has `|u|^2`, which
    /// vanishes where a body turns round and is pulled most.
    #[inline]
    pub(in super::super) fn speed_squared<T: Number, const D: usize>(
        &self,
        side: &Side<T, D>,
        matter: &[T; MATTER],
    ) -> T {
        let (density, wave_speed) = (self.state.density, self.state.wave_speed);
        let compression = side.pressure / (density * wave_speed);
        let shear = shear_energy(&full(matter), T::from(self.shear_modulus), T::from(density));
        side.velocity.dot(&side.velocity) + compression * compression + shear * 2.0
    }

    /// Speed of longitudinal waves in m/s at a density in kg/m^3 and a specific internal energy in J/kg.
    #[inline]
    pub(in super::super) fn longitudinal_speed<T: Number>(&self, density: T, energy: T) -> T {
        let bulk = self.state.wave_speed_squared(density, energy);
        (bulk + T::from(4.0 / 3.0 * self.shear_modulus) / density).sqrt()
    }

    /// The specific energies of compression and shear in J/kg at a density in kg/m^3.
    pub(in super::super) fn energies<T: Number>(&self, density: T, matter: &[T; MATTER]) -> [T; 2] {
        let shear = shear_energy(&full(matter), T::from(self.shear_modulus), density);
        [self.state.compression_energy(density, matter[ENERGY]), shear]
    }

    /// Moves a particle on with its rates at a side, CTVF (56) to (59), theory (33), (69) to (71), and returns the work
    /// in J by which its elastic energy has grown, with that of plastic flow, and the work of plastic flow.
    #[inline]
    pub(in super::super) fn drift<T: Number, const D: usize>(
        &self,
        rates: &SolidRates<D, T>,
        side: &Side<T, D>,
        step: &Step<T>,
        moved: &mut Moved<T>,
    ) -> [T; 2] {
        let energy = |moved: &Moved<T>| {
            let [compression, shear] = self.energies(moved.density, &moved.matter);
            step.mass * (compression + shear)
        };
        let before = energy(moved);
        let work = side.volume * self.advance(rates, side, step.duration, &mut moved.matter);
        let of_all = &rates.common;
        moved.density +=
            step.duration * (rates.density_transport - side.density * of_all.divergence);
        if step.evolves {
            let stiffness = self.state.wave_speed.powi(2);
            let compression = -side.density * stiffness * of_all.divergence;
            let rate = compression + of_all.pressure_transport + of_all.pressure_diffusion;
            let (next, least) =
                (moved.pressure + step.duration * rate, T::from(-self.state.spall_strength));
            moved.pressure = T::select(least.at_most(next), next, least);
        }
        [energy(moved) - before + work, work]
    }

    /// Advances the matter of a particle, and returns the plastic work in J/m^3.
    fn advance<T: Number, const D: usize>(
        &self,
        rates: &SolidRates<D, T>,
        side: &Side<T, D>,
        step: T,
        matter: &mut [T; MATTER],
    ) -> T {
        let gradient = in_three(&rates.gradient);
        let old = full(matter);
        let stress =
            advance(self.shear_modulus, &old, &gradient, step) + full(&rates.transport) * step;
        for (value, rate) in matter.iter_mut().zip(&rates.transport).skip(PLASTIC) {
            *value += step * *rate;
        }
        if self.state.is_caloric() {
            // Where bodies touch, the pressure works on what comes from the other one, too.
            let shear = old.dot(&gradient);
            let power = shear - side.pressure * rates.common.divergence;
            matter[ENERGY] += step * (power / side.density + rates.heating);
        }
        if self.strength == Strength::Elastic {
            store(&stress, matter);
            return T::zero();
        }
        let returned = self.strength.return_to_surface(
            von_mises(&stress),
            self.shear_modulus,
            matter[PLASTIC],
            matter[TEMPERATURE],
            step,
        );
        store(&(stress * returned.scale), matter);
        let work = returned.stress * returned.increment;
        matter[PLASTIC] += returned.increment;
        matter[TEMPERATURE] += work * self.heat.share / (side.density * self.heat.specific_heat);
        work
    }
}

/// A velocity gradient in three dimensions: plane strain in 2D, uniaxial strain in 1D.
fn in_three<T: Number, const D: usize>(gradient: &SMatrix<T, D, D>) -> SMatrix<T, 3, 3> {
    SMatrix::from_fn(|i, j| if i < D && j < D { gradient[(i, j)] } else { T::zero() })
}
