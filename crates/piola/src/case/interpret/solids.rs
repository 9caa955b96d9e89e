//! The scheme `dual_support` and the materials of elastic solids.

use piola_formulas::hyperelastic::{HyperelasticLaw, LameConstants};
use piola_formulas::volumetric::MaterialError;

use super::bodies::{number, plane};
use super::*;
use crate::case::model::{DualSupport, GradientKind, Material, PlaneState, SupportSize};

/// The keys that give the stiffness of an isotropic solid, of which two are needed.
const CONSTANTS: [&str; 5] =
    ["young_modulus", "poisson_ratio", "bulk_modulus", "shear_modulus", "lame_lambda"];

impl Reader<'_, '_> {
    /// Settings of the scheme `dual_support`.
    pub(super) fn dual_support(&mut self, record: &Record) -> Option<DualSupport> {
        let radius = record.number("support").map(|radius| radius.map(SupportSize::Spacings));
        let count =
            record.whole::<usize>("neighbors").map(|count| count.map(SupportSize::Neighbors));
        if let (Some(_), Some(place)) = (record.key_place("support"), record.key_place("neighbors"))
        {
            let message = "`support` and `neighbors` both say how large supports are";
            self.report(
                Problem::new(place, message, "the second way to say it").help("remove one of them"),
            );
        }
        let usual = Located::new(SupportSize::Spacings(2.05), record.place);
        let gradients = record.text("gradients").map(|name| {
            name.map(|name| match name.as_str() {
                "plain" => GradientKind::Plain,
                _ => GradientKind::PatchConsistent,
            })
        });
        Some(DualSupport {
            kernel: record.text("kernel")?,
            weights: super::physics::weights(record)?,
            support: count.or(radius).unwrap_or(usual),
            gradients,
            hourglass: number(record, "hourglass"),
        })
    }

    /// A material with a strain energy.
    pub(super) fn elastic_solid(&mut self, record: &Record) -> Option<Located<Material>> {
        if self.dimension == 3 {
            self.meaningless(record, "plane", "in 3D");
        }
        let plane = plane(record).unwrap_or(PlaneState::Strain);
        let density = number(record, "density");
        let law = match record.kind {
            "mooney_rivlin" => HyperelasticLaw::mooney_rivlin(
                number(record, "c10")?,
                number(record, "c01")?,
                number(record, "bulk_modulus")?,
            ),
            "ogden" => {
                let (moduli, exponents) = (record.numbers("moduli")?, record.numbers("exponents")?);
                if moduli.len() != exponents.len() {
                    let message = format!(
                        "`moduli` and `exponents` belong together, but there are {} and {}",
                        moduli.len(),
                        exponents.len()
                    );
                    let problem = Problem::new(exponents.place, message, "one for each modulus");
                    return self.refuse(problem);
                }
                let terms: Vec<_> = moduli.iter().copied().zip(exponents.iter().copied()).collect();
                HyperelasticLaw::ogden(&terms, number(record, "bulk_modulus")?)
            }
            name => {
                let make = match name {
                    "saint_venant_kirchhoff" => HyperelasticLaw::saint_venant_kirchhoff,
                    "neo_hookean" => HyperelasticLaw::neo_hookean,
                    "neo_hookean_logarithmic" => HyperelasticLaw::neo_hookean_logarithmic,
                    _ => HyperelasticLaw::linear_elastic,
                };
                self.constants(record)?.map(make)
            }
        };
        match law {
            Ok(law) => {
                let material = Material::Hyperelastic { density: density?, law, plane };
                Some(Located::new(material, record.place))
            }
            Err(error) => {
                let place = first_place(record, &CONSTANTS);
                self.refuse(Problem::new(place, error.to_string(), "out of range"))
            }
        }
    }

    /// Lame's constants from the two keys that give them; `None` if these are not two that do.
    pub(super) fn constants(
        &mut self,
        record: &Record,
    ) -> Option<Result<LameConstants, MaterialError>> {
        let given: Vec<&str> = CONSTANTS.iter().copied().filter(|name| record.has(name)).collect();
        let value = |name: &str| number(record, name);
        match given[..] {
            ["young_modulus", "poisson_ratio"] => {
                let (modulus, ratio) = (value("young_modulus")?, value("poisson_ratio")?);
                Some(LameConstants::from_young(modulus, ratio))
            }
            ["bulk_modulus", "shear_modulus"] => {
                let (bulk, shear) = (value("bulk_modulus")?, value("shear_modulus")?);
                Some(LameConstants::from_bulk(bulk, shear))
            }
            ["shear_modulus", "lame_lambda"] => {
                let (shear, lambda) = (value("shear_modulus")?, value("lame_lambda")?);
                Some(LameConstants::new(lambda, shear))
            }
            _ => {
                let message = match given.len() {
                    0 => "the material needs a stiffness".to_owned(),
                    _ => format!(
                        "{} do not give the stiffness",
                        given.iter().map(|name| format!("`{name}`")).collect::<Vec<_>>().join(", ")
                    ),
                };
                let place = first_place(record, &CONSTANTS);
                let problem = Problem::new(place, message, "needs two constants that go together");
                self.refuse(problem.help(
                    "give `young_modulus` with `poisson_ratio`, `bulk_modulus` with \
                     `shear_modulus`, or `lame_lambda` with `shear_modulus`",
                ))
            }
        }
    }
}
