//! The scheme, loads and boundaries.

use super::*;
use crate::case::expression::Expression;
use crate::case::model::{
    Boundary, Correction, Load, LoadKind, ReferenceWaveSpeed, Upwind, Weights,
};

/// Settings of the scheme `upwind`.
pub(super) fn upwind(record: &Record) -> Option<Upwind> {
    let correction = record.text("correction")?.map(|name| match name.as_str() {
        "none" => Correction::None,
        "kernel_and_gradient" => Correction::KernelAndGradient,
        _ => Correction::Gradient,
    });
    Some(Upwind {
        kernel: record.text("kernel")?,
        smoothing_length: record.number("smoothing_length")?,
        correction,
        weights: weights(record)?,
        tau_velocity: record.number("tau_velocity")?.value,
        tau_pressure: record.number("tau_pressure")?.value,
        reconstruction: record.boolean("reconstruction")?,
        wave_speed: match record.text("wave_speed")?.as_str() {
            "stretch" => ReferenceWaveSpeed::Stretch,
            _ => ReferenceWaveSpeed::Constant,
        },
    })
}

/// What is summed under a kernel.
pub(super) fn weights(record: &Record) -> Option<Weights> {
    Some(match record.text("weights")?.as_str() {
        "volume" => Weights::Volume,
        _ => Weights::Lattice,
    })
}

/// The expressions of a table with one key an axis, `None` for axes without.
pub(super) fn expressions_per_axis(record: &Record, key: &str) -> Vec<Option<Expression>> {
    let expression = |item: &Option<Located<Datum>>| match &item.as_ref()?.value {
        Datum::Expression(expression) => Some(expression.clone()),
        _ => None,
    };
    record.axes(key).iter().map(expression).collect()
}

impl Reader<'_, '_> {
    pub(super) fn load(&mut self, record: &Record) -> Option<Load> {
        let body = self.body_of(record);
        let kind = match record.kind {
            "body_force" => {
                LoadKind::BodyForce { acceleration: record.expressions("acceleration")? }
            }
            "traction" => {
                if !record.has("body") && self.names.bodies.len() > 1 {
                    let message = "a traction needs the key `body` where there are several bodies";
                    let names = self.names.bodies.iter().map(String::as_str);
                    let help = format!("expected {}", crate::case::suggest::one_of(names));
                    let problem = Problem::new(record.place, message, "`body` is missing");
                    self.report(problem.help(help));
                }
                let region = record.record("where").and_then(|region| self.region(region));
                LoadKind::Traction { region: region?, traction: record.expressions("traction")? }
            }
            _ => return None,
        };
        Some(Load { name: record.text("name"), body, kind })
    }

    pub(super) fn boundary(&mut self, record: &Record) -> Option<Boundary> {
        let body = self.body_of(record);
        let region = record.record("where").and_then(|region| self.region(region));
        let (known, other, why) = match self.names.is_static {
            true => {
                ("displacement", "velocity", "with the integrator `static`, where nothing moves")
            }
            false => ("velocity", "displacement", "without the integrator `static`"),
        };
        self.meaningless(record, other, why);
        if !record.has(known) && !record.has(other) {
            let message = format!("the boundary needs the key `{known}`");
            let problem = Problem::new(record.place, message, "prescribes nothing");
            self.report(problem.help(format!("add `{known} = {{ x = \"0\" }}`")));
        }
        Some(Boundary {
            name: record.text("name")?,
            body,
            region: region?,
            velocity: expressions_per_axis(record, "velocity"),
            displacement: expressions_per_axis(record, "displacement"),
        })
    }
}
