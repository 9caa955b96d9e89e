//! Hypoelastic and elastic-plastic materials.

use piola_formulas::hypoelastic::{EquationOfState, JohnsonCook, PressureLaw, Strength};

use super::bodies::number;
use super::*;
use crate::case::model::Material;
use crate::schemes::transport_velocity::{Heat, Solid};

/// The melting temperature of a solid that its temperature does not soften, in K.
const NEVER: f64 = 1e300;

impl Reader<'_, '_> {
    /// A solid of the scheme `transport_velocity`.
    pub(super) fn hypoelastic(&mut self, record: &Record) -> Option<Located<Material>> {
        let constants = match self.constants(record)? {
            Ok(constants) => constants,
            Err(error) => {
                let problem = Problem::new(record.place, error.to_string(), "out of range");
                return self.refuse(problem);
            }
        };
        let bulk_modulus = constants.bulk_modulus();
        if !(bulk_modulus > 0.0 && bulk_modulus.is_finite()) {
            let message = format!(
                "these values give a bulk modulus of {bulk_modulus} Pa, which is impossible"
            );
            return self.refuse(Problem::new(record.place, message, "out of range"));
        }
        let density = number(record, "density")?;
        let temperature = number(record, "temperature")?;
        let heat = match number(record, "specific_heat") {
            Some(specific_heat) => {
                Heat { temperature, specific_heat, share: number(record, "heat_share")? }
            }
            None => Heat { temperature, ..Heat::NONE },
        };
        let law = match record.record("pressure_law") {
            Some(law) => pressure_law(law)?,
            None => PressureLaw::Linear,
        };
        let strength = match record.record("strength") {
            Some(strength) => self.strength(strength, temperature)?,
            None => Strength::Elastic,
        };
        let spall_strength = number(record, "spall_strength").unwrap_or(f64::INFINITY);
        let wave_speed = (bulk_modulus / density).sqrt();
        let solid = Solid {
            state: EquationOfState { density, wave_speed, law, spall_strength },
            shear_modulus: constants.mu,
            strength,
            heat,
        };
        Some(Located::new(Material::Hypoelastic(solid), record.place))
    }

    fn strength(&mut self, record: &Record, temperature: f64) -> Option<Strength> {
        let yield_stress = match record.kind {
            "elastic" => return Some(Strength::Elastic),
            _ => number(record, "yield_stress")?,
        };
        let hardening = number(record, "hardening")?;
        if record.kind == "linear" {
            return Some(Strength::Linear { yield_stress, hardening });
        }
        let melting = number(record, "melting_temperature");
        if let (Some(place), Some(melting)) = (record.key_place("melting_temperature"), melting)
            && melting <= temperature
        {
            let message = format!("the solid melts at {melting} K and starts at {temperature} K");
            let problem = Problem::new(place, message, "must be above `temperature`");
            return self.refuse(problem);
        }
        Some(Strength::JohnsonCook(JohnsonCook {
            yield_stress,
            hardening,
            exponent: number(record, "exponent")?,
            rate_factor: number(record, "rate_factor")?,
            reference_rate: number(record, "reference_rate")?,
            softening: number(record, "softening")?,
            reference_temperature: temperature,
            melting_temperature: melting.unwrap_or(NEVER),
        }))
    }
}

fn pressure_law(record: &Record) -> Option<PressureLaw> {
    Some(match record.kind {
        "tait" => PressureLaw::Tait { exponent: number(record, "exponent")? },
        "mie_grueneisen" => PressureLaw::MieGrueneisen {
            slope: number(record, "slope")?,
            gruneisen: number(record, "gruneisen")?,
        },
        _ => PressureLaw::Linear,
    })
}
