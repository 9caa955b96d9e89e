//! The scheme `total_lagrangian` and the materials of elastic solids.

use piola_formulas::hyperelastic::{Constant, HyperelasticLaw, LameConstants};
use piola_formulas::volumetric::MaterialError;

use super::bodies::{number, plane};
use super::*;
use crate::case::model::{
    GradientKind, Material, PlaneState, Preset, SupportSize, TotalLagrangian,
};
use crate::schemes::total_lagrangian::{Configuration, Dissipation, Form, Tractions};

/// The keys that give the stiffness of an isotropic solid, of which two are needed.
const CONSTANTS: [&str; 5] =
    ["young_modulus", "poisson_ratio", "bulk_modulus", "shear_modulus", "lame_lambda"];

impl Reader<'_, '_> {
    /// Settings of the scheme `total_lagrangian` with a preset.
    pub(super) fn total_lagrangian(
        &mut self,
        record: &Record,
        preset: Preset,
    ) -> Option<TotalLagrangian> {
        let form = match record.text("form").as_deref().map(String::as_str) {
            Some("strong") => Form::Strong,
            Some(_) => Form::Adjoint,
            None => preset.form(self.dimension),
        };
        let configuration = match record.text("configuration")?.as_str() {
            "updated" => Configuration::Updated,
            _ => Configuration::Total,
        };
        self.suits_form(record, form, configuration)?;
        let gradients = record.text("gradients").map(|name| {
            name.map(|name| match name.as_str() {
                "plain" => GradientKind::Plain,
                _ => GradientKind::PatchConsistent,
            })
        });
        let tractions = record.text("tractions").map(|name| match name.as_str() {
            "layers" => Tractions::Layers,
            _ => Tractions::Surface,
        });
        Some(TotalLagrangian {
            preset,
            kernel: record.text("kernel")?,
            weights: super::physics::weights(record)?,
            support: self.support(record, preset.support(form, self.dimension)),
            joined: record.boolean("joined")?,
            form: Located::new(form, record.key_place("form").unwrap_or(record.place)),
            configuration,
            gradients,
            hourglass: number(record, "hourglass"),
            tractions,
            dissipation: Located::new(
                Dissipation {
                    viscosity: number(record, "viscosity").unwrap_or(0.0),
                    artificial_viscosity: self.artificial_viscosity(record)?,
                    damping: number(record, "damping")?,
                },
                first_place(record, &["viscosity", "artificial_viscosity", "damping"]),
            ),
            says_viscosity: ["viscosity", "artificial_viscosity"]
                .iter()
                .any(|key| record.key_place(key).is_some()),
        })
    }

    /// How large supports are, by one of two keys or by what is usual.
    fn support(&mut self, record: &Record, usual: f64) -> Located<SupportSize> {
        let radius = record.number("support").map(|radius| radius.map(SupportSize::Spacings));
        let count =
            record.whole::<usize>("neighbors").map(|count| count.map(SupportSize::Neighbors));
        if let (Some(_), Some(place)) = (record.key_place("support"), record.key_place("neighbors"))
        {
            let message = "`support` and `neighbors` both set the size of supports";
            self.report(
                Problem::new(place, message, "the second way to say it").help("remove one of them"),
            );
        }
        let usual = Located::new(SupportSize::Spacings(usual), record.place);
        count.or(radius).unwrap_or(usual)
    }

    /// Reports what a form of the divergence does not know.
    fn suits_form(
        &mut self,
        record: &Record,
        form: Form,
        configuration: Configuration,
    ) -> Option<()> {
        let place = |key: &str| record.key_place(key).unwrap_or(record.place);
        let fault = match (form, configuration) {
            (Form::Strong, _) if self.dimension > 2 => Some((
                "form",
                "the strong form is for one and two dimensions",
                "not in this dimension",
                "use `form = \"adjoint\"`",
            )),
            (Form::Adjoint, Configuration::Updated) => Some((
                "configuration",
                "matrices of the current configuration need the strong form",
                "not with `form = \"adjoint\"`",
                "use `configuration = \"total\"`",
            )),
            (_, Configuration::Updated) if self.dimension > 1 => Some((
                "configuration",
                "matrices of the current configuration are for one dimension",
                "not in this dimension",
                "use `configuration = \"total\"`",
            )),
            _ => None,
        };
        if let Some((key, message, label, help)) = fault {
            return self.refuse(Problem::new(place(key), message, label).help(help));
        }
        for key in ["hourglass", "gradients", "tractions", "neighbors"] {
            if form == Form::Strong {
                self.meaningless(record, key, "with `form = \"strong\"`");
            }
        }
        Some(())
    }

    /// Linear and quadratic coefficient of the artificial viscosity.
    fn artificial_viscosity(&mut self, record: &Record) -> Option<[f64; 2]> {
        let Some(given) = record.numbers("artificial_viscosity") else { return Some([0.0; 2]) };
        match given.value[..] {
            [linear, quadratic] => Some([linear, quadratic]),
            _ => {
                let message = format!("expected two coefficients, got {}", given.value.len());
                let problem = Problem::new(given.place, message, "not two");
                self.refuse(problem.help("for example `[0.1, 1.0]`"))
            }
        }
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
            "hyperelastic" => {
                let text = record.text("energy")?;
                match self.context.energy(&text, text.place)? {
                    Ok(energy) => Ok(HyperelasticLaw::Energy(energy)),
                    Err(error) => {
                        let message = format!("this cannot be an energy: {error}");
                        return self.refuse(Problem::new(text.place, message, "no energy"));
                    }
                }
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
                let constants = constants_of(record);
                let material = Material::Hyperelastic { density: density?, law, constants, plane };
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

/// The constants that a law is given by, with their keys.
fn constants_of(record: &Record) -> Vec<(String, Constant)> {
    let shear = match record.has("lame_lambda") {
        true => Constant::ShearModulusAtLambda,
        false => Constant::ShearModulus,
    };
    let single = [
        ("young_modulus", Constant::YoungModulus),
        ("poisson_ratio", Constant::PoissonRatio),
        ("bulk_modulus", Constant::BulkModulus),
        ("shear_modulus", shear),
        ("lame_lambda", Constant::Lambda),
        ("c10", Constant::C10),
        ("c01", Constant::C01),
    ];
    let single = single.into_iter().filter(|(key, _)| record.has(key));
    let moduli = record.numbers("moduli").map_or(0, |moduli| moduli.len());
    let terms = (0..moduli).map(|term| (format!("moduli.{term}"), Constant::Modulus(term)));
    single.map(|(key, constant)| (key.to_owned(), constant)).chain(terms).collect()
}
