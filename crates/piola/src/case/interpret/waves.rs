//! The scheme `elastodynamics`.

use super::*;
use crate::case::interpret::bodies::number;
use crate::case::model::Elastodynamics;
use crate::schemes::elastodynamics::{Configuration, Form, Settings};

impl Reader<'_, '_> {
    /// Settings of the scheme `elastodynamics`.
    pub(super) fn elastodynamics(&mut self, record: &Record) -> Option<Elastodynamics> {
        let form = match record.text("form").as_deref().map(String::as_str) {
            Some("strong") => Form::Strong,
            Some(_) => Form::Adjoint,
            None if self.dimension == 1 => Form::Strong,
            None => Form::Adjoint,
        };
        if form == Form::Strong {
            if self.dimension > 2 {
                let place = record.key_place("form").unwrap_or(record.place);
                let message = "the strong form is for one and two dimensions";
                let problem = Problem::new(place, message, "not in this dimension");
                return self.refuse(problem.help("use `form = \"adjoint\"`"));
            }
            self.meaningless(record, "hourglass", "with `form = \"strong\"`");
        }
        let configuration = match record.text("configuration")?.as_str() {
            "updated" => Configuration::Updated,
            _ => Configuration::Total,
        };
        if let (Configuration::Updated, Form::Adjoint) = (configuration, form) {
            let place = record.key_place("configuration").unwrap_or(record.place);
            let message = "matrices of the moment need the strong form";
            let problem = Problem::new(place, message, "not with `form = \"adjoint\"`");
            return self.refuse(problem.help("use `configuration = \"total\"`"));
        }
        if configuration == Configuration::Updated && self.dimension > 1 {
            let place = record.key_place("configuration").unwrap_or(record.place);
            let message = "matrices of the moment are for one dimension";
            let problem = Problem::new(place, message, "not in this dimension");
            return self.refuse(problem.help("use `configuration = \"total\"`"));
        }
        let artificial = match record.numbers("artificial_viscosity") {
            None => [0.0; 2],
            Some(given) => match given.value[..] {
                [linear, quadratic] => [linear, quadratic],
                _ => {
                    let message = format!("expected two coefficients, got {}", given.value.len());
                    let problem = Problem::new(given.place, message, "not two");
                    return self.refuse(problem.help("for example `[0.1, 1.0]`"));
                }
            },
        };
        let (support, hourglass) = match form {
            Form::Strong if self.dimension == 1 => (5.5, 0.0),
            Form::Strong => (2.5, 0.0),
            Form::Adjoint => (2.5, 0.05),
        };
        let settings = Settings {
            form,
            configuration,
            hourglass: number(record, "hourglass").unwrap_or(hourglass),
            viscosity: number(record, "viscosity")?,
            artificial_viscosity: artificial,
            damping: number(record, "damping")?,
        };
        Some(Elastodynamics {
            kernel: record.text("kernel")?,
            support: record.number("support").unwrap_or(Located::new(support, record.place)),
            weights: super::physics::weights(record)?,
            settings: Located::new(settings, record.place),
        })
    }
}
