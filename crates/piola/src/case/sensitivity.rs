//! The derivatives of a run of statics by constants of materials.

use piola_formulas::hyperelastic::HyperelasticLaw;
use thiserror::Error;

use super::model::{Body, Material};
use super::session::Session;
use super::suggest::suggestion;
use crate::observe::Probe;
use crate::schemes::{NoSensitivity, Sensitivity};

/// A derivative that is not known.
#[derive(Clone, Debug, Error, PartialEq)]
#[non_exhaustive]
pub enum SensitivityError {
    /// The key is of no constant.
    #[error("there is no derivative with respect to `{key}`: {advice}")]
    Unknown {
        /// What was asked for.
        key: String,
        /// What can be.
        advice: String,
    },
    /// The state has none.
    #[error("there is no derivative with respect to `{key}`: {source}")]
    None {
        /// What was asked for.
        key: String,
        /// Why.
        source: NoSensitivity,
    },
}

impl Session {
    /// The derivatives of displacements and reactions by a constant of a material, exact, of the state in
    /// equilibrium at the moment, at the same loads: theory (104) to (107). `key` is a key that the case
    /// has, as `body.bar.material.young_modulus`, or `body.bar.material.moduli.0` of several. All other
    /// constants stay fixed, even if they are computed from the same parameter of the case.
    ///
    /// # Errors
    /// [`SensitivityError`]; nothing is changed.
    pub fn sensitivity(&mut self, key: &str) -> Result<Sensitivity, SensitivityError> {
        let Some((body, law)) = self.constant(key) else {
            return Err(SensitivityError::Unknown {
                key: key.to_owned(),
                advice: self.advice(key),
            });
        };
        let state = self.executor.shared_state();
        let found = match self.executor.scheme.equilibrium() {
            Some(scheme) => scheme.sensitivity(&state, body as u32, &law),
            None => Err(NoSensitivity::NotStatic),
        };
        self.executor.look_anew();
        found.map_err(|source| SensitivityError::None { key: key.to_owned(), source })
    }

    /// The derivatives of the columns of probes that are linear in displacements and reactions, by name:
    /// fields of particles, sums and means.
    pub fn probe_sensitivities(&self, sensitivity: &Sensitivity) -> Vec<(String, f64)> {
        let of = |probe: &Probe| probe.sensitivities(sensitivity, self.case.dimension);
        self.built.probes.iter().flat_map(of).collect()
    }

    /// The body that a key is of, with the derivative of its law by the constant.
    fn constant(&self, key: &str) -> Option<(usize, HyperelasticLaw)> {
        let (name, constant) = key.strip_prefix("body.")?.split_once(".material.")?;
        let bodies = &self.case.bodies;
        let by_name = bodies.iter().position(|body| *body.name == name);
        let by_number = || name.parse().ok().filter(|number| *number < bodies.len());
        let body = by_name.or_else(by_number)?;
        let Material::Hyperelastic { law, constants, .. } = &bodies[body].material.value else {
            return None;
        };
        let (_, constant) = constants.iter().find(|(known, _)| known == constant)?;
        Some((body, law.derivative(*constant)?))
    }

    /// What to ask for instead of a key.
    fn advice(&self, key: &str) -> String {
        let of = |body: &Body| match &body.material.value {
            Material::Hyperelastic { constants, .. } => {
                let key = |(key, _): &(String, _)| format!("body.{}.material.{key}", *body.name);
                constants.iter().map(key).collect()
            }
            _ => Vec::new(),
        };
        let known: Vec<String> = self.case.bodies.iter().flat_map(of).collect();
        match known.is_empty() {
            true => {
                "only the elastic constants of named laws have derivatives, and this case has none"
                    .to_owned()
            }
            false => suggestion(key, known.iter().map(String::as_str)),
        }
    }
}
