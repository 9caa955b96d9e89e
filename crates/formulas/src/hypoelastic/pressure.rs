//! Equations of state of solids: the pressure as a function of density and energy.

use crate::Number;

/// How the pressure of a solid follows its density.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum PressureLaw {
    /// `c^2 (rho - rho0)`, CTVF (8).
    Linear,
    /// `rho0 c^2 / gamma ((rho / rho0)^gamma - 1)` with the exponent gamma, above 1.
    Tait {
        /// The exponent gamma.
        exponent: f64,
    },
    /// That of Mie and Grueneisen about the Hugoniot of shocks `U = c + S u`, with `Gamma rho`
    /// constant: `p = p_H (1 - Gamma eta / 2) + Gamma rho0 e`, `eta = 1 - rho0 / rho`,
    /// `p_H = rho0 c^2 eta / (1 - S eta)^2` in compression and `c^2 (rho - rho0)` for `p_H` and
    /// its factor in tension.
    MieGrueneisen {
        /// The slope S of shock over particle speed.
        slope: f64,
        /// Grueneisen's Gamma at rest.
        gruneisen: f64,
    },
}

/// An equation of state, theory (71).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct EquationOfState {
    /// Density rho0 without pressure in kg/m^3.
    pub density: f64,
    /// Bulk wave speed c without pressure in m/s, `sqrt(K / rho0)`.
    pub wave_speed: f64,
    /// The law.
    pub law: PressureLaw,
    /// Tension in Pa that the solid bears at most, infinite if it never tears, theory (71).
    pub spall_strength: f64,
}

/// Share of the largest compression `eta = 1 / S` that a shock can reach, beyond which the law of
/// Mie and Grueneisen is not followed: there it has a pole.
const MOST_COMPRESSION: f64 = 0.95;

impl EquationOfState {
    /// Pressure in Pa at a density in kg/m^3 and a specific internal energy in J/kg, which only the
    /// law of Mie and Grueneisen looks at: that of the law, and not below `-spall_strength`. What
    /// is torn opens at that tension, and bears pressure again only at the density at which it tore.
    #[inline]
    pub fn pressure<T: Number>(&self, density: T, energy: T) -> T {
        let pressure = self.pressure_of_law(density, energy);
        if self.spall_strength == f64::INFINITY {
            return pressure;
        }
        let least = T::from(-self.spall_strength);
        T::select(pressure.at_most(least), least, pressure)
    }

    #[inline]
    fn pressure_of_law<T: Number>(&self, density: T, energy: T) -> T {
        let square = self.wave_speed * self.wave_speed;
        let linear = (density - self.density) * square;
        match self.law {
            PressureLaw::Linear => linear,
            PressureLaw::Tait { exponent } => {
                let ratio = density / self.density;
                (ratio.powf(exponent) - 1.0) * (self.density * square / exponent)
            }
            PressureLaw::MieGrueneisen { slope, gruneisen } => {
                let thermal = energy * (gruneisen * self.density);
                let eta = self.compression(density, slope);
                let compressed = || {
                    let rest = -eta * slope + 1.0;
                    let hugoniot = eta * (self.density * square) / (rest * rest);
                    hugoniot * (-eta * (0.5 * gruneisen) + 1.0) + thermal
                };
                T::choose(eta.at_most(T::zero()), || linear + thermal, compressed)
            }
        }
    }

    /// `eta`, positive where a solid is compressed.
    fn compression<T: Number>(&self, density: T, slope: f64) -> T {
        let eta = -(density.recip() * self.density) + 1.0;
        let most = if slope > 0.0 { MOST_COMPRESSION / slope } else { MOST_COMPRESSION };
        T::select(eta.above(most), T::from(most), eta)
    }

    /// Square of the bulk wave speed in m^2/s^2, `dp/drho` of the law at constant entropy, torn or
    /// not; not below a hundredth of that at rest.
    pub fn wave_speed_squared<T: Number>(&self, density: T, energy: T) -> T {
        let at_rest = self.wave_speed * self.wave_speed;
        let square = match self.law {
            PressureLaw::Linear => T::from(at_rest),
            PressureLaw::Tait { exponent } => {
                (density / self.density).powf(exponent - 1.0) * at_rest
            }
            PressureLaw::MieGrueneisen { slope, gruneisen } => {
                let (pressure, square) = (self.pressure_of_law(density, energy), density * density);
                let thermal = pressure * (gruneisen * self.density) / square;
                let eta = self.compression(density, slope);
                let compressed = || {
                    let (modulus, rest) = (self.density * at_rest, -(eta * slope) + 1.0);
                    let hugoniot = eta * modulus / (rest * rest);
                    let growth = (eta * slope + 1.0) * modulus / (rest * rest * rest);
                    let half = 0.5 * gruneisen;
                    let slope = growth * (-(eta * half) + 1.0) - hugoniot * half;
                    slope * self.density / square
                };
                T::choose(eta.at_most(T::zero()), || T::from(at_rest), compressed) + thermal
            }
        };
        let least = T::from(0.01 * at_rest);
        T::select(least.at_most(square), square, least)
    }

    /// Specific energy of compression in J/kg: the integral of `p / rho^2 d rho`; with the law of
    /// Mie and Grueneisen the internal energy itself.
    pub fn compression_energy<T: Number>(&self, density: T, energy: T) -> T {
        let whole = || self.energy_of_law(density, energy);
        let Some(spall) = self.spall_density() else { return whole() };
        // At the constant tension at which the solid opens.
        let torn = || {
            let opened = density.recip() - spall.recip();
            self.energy_of_law(T::from(spall), energy) + opened * self.spall_strength
        };
        T::choose(density.below(spall), torn, whole)
    }

    fn energy_of_law<T: Number>(&self, density: T, energy: T) -> T {
        let square = self.wave_speed * self.wave_speed;
        let ratio = density / self.density;
        let growth = ratio - 1.0;
        match self.law {
            // ln x + 1/x - 1 with the digits of small x - 1.
            PressureLaw::Linear => (growth.ln_1p() - growth / ratio) * square,
            PressureLaw::Tait { exponent } => {
                let logarithm = ratio.ln() * (exponent - 1.0);
                let power = logarithm.exp_m1() / (exponent - 1.0);
                (power - growth / ratio) * (square / exponent)
            }
            PressureLaw::MieGrueneisen { .. } => energy,
        }
    }

    /// Density in kg/m^3 at which the solid tears, where that depends on nothing else and there is
    /// one above 0.
    fn spall_density(&self) -> Option<f64> {
        let strength = self.spall_strength / (self.density * self.wave_speed * self.wave_speed);
        let ratio = match self.law {
            PressureLaw::Linear => 1.0 - strength,
            PressureLaw::Tait { exponent } => {
                Number::powf((1.0 - exponent * strength).max(0.0), exponent.recip())
            }
            PressureLaw::MieGrueneisen { .. } => 0.0,
        };
        (ratio > 0.0).then_some(self.density * ratio)
    }

    /// Whether the pressure depends on the internal energy.
    pub fn is_caloric(&self) -> bool {
        matches!(self.law, PressureLaw::MieGrueneisen { .. })
    }
}
