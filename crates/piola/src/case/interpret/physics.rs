//! The scheme, loads and boundaries.

use std::sync::Arc;

use super::*;
use crate::boundaries::History;
use crate::case::expression::Expression;
use crate::case::model::{
    Boundary, Dissipation, Load, LoadKind, Region, Roller, Turning, Upwind, Weights,
};
use crate::operators::Correction;
use crate::output::Curve;
use crate::schemes::upwind::WaveSpeed;

/// Settings of the scheme `upwind`.
pub(super) fn upwind(record: &Record) -> Option<Upwind> {
    let correction = record.text("correction")?;
    let known = Correction::from_name(&correction)?;
    Some(Upwind {
        kernel: record.text("kernel")?,
        smoothing_length: record.number("smoothing_length")?,
        correction: correction.map(|_| known),
        weights: weights(record)?,
        tau_velocity: record.number("tau_velocity")?.value,
        tau_pressure: record.number("tau_pressure")?.value,
        dissipation: record.text("dissipation")?.map(|name| match name.as_str() {
            "printed_3_38" => Dissipation::WithoutDensity,
            "printed_3_42" => Dissipation::TurnedArea,
            "as_printed" => Dissipation::AsPrinted,
            _ => Dissipation::Corrected,
        }),
        reconstruction: record.boolean("reconstruction")?,
        wave_speed: match record.text("wave_speed")?.as_str() {
            "stretch" => WaveSpeed::Stretch,
            _ => WaveSpeed::Constant,
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
            "traction" => LoadKind::Traction {
                region: self.loaded_region(record)?,
                traction: record.expressions("traction")?,
            },
            "spring" => {
                self.meaningless(record, "history", "with a spring");
                LoadKind::Spring {
                    region: self.loaded_region(record)?,
                    to: record.numbers("to")?.value,
                    stiffness: record.number("stiffness")?.value,
                    damping: record.number("damping")?.value,
                    length: record.number("length").map(|length| length.value),
                }
            }
            "pressure" => LoadKind::Pressure {
                region: self.loaded_region(record)?,
                pressure: record.expression("pressure")?,
            },
            _ => return None,
        };
        let history = self.history(record)?;
        Some(Load { name: record.text("name"), body, history, kind })
    }

    /// The factor over time that the file `history` of a load, a boundary or an opening gives, if there is one.
    pub(super) fn history(&mut self, record: &Record) -> Option<Option<Arc<History>>> {
        match record.has("history") {
            true => self.factor(record, "history"),
            false => Some(None),
        }
    }

    /// The factor that a file gives.
    pub(super) fn factor(&mut self, record: &Record, key: &str) -> Option<Option<Arc<History>>> {
        let file = self.file(record, key)?;
        // Where the text of a case is from elsewhere, files are not looked for.
        let Some(_) = self.setting.folder else { return Some(None) };
        let refuse = |message: String| Problem::new(file.place, message, "this file");
        let curve = match Curve::read_csv(&file) {
            Ok(curve) => curve,
            Err(error) => return self.refuse(refuse(error.to_string())),
        };
        match History::new(curve.abscissa, curve.ordinate) {
            Some(history) => Some(Some(Arc::new(history))),
            None => self.refuse(refuse("the file gives no factor".to_owned())),
        }
    }

    /// The part of the surface that a load acts on.
    fn loaded_region(&mut self, record: &Record) -> Option<Located<Region>> {
        let kind = record.kind;
        let scheme = self.names.current.scheme;
        let knows = match kind {
            "pressure" | "spring" => self.names.current.preset().is_some(),
            _ => scheme != "transport_velocity",
        };
        if !knows {
            let message = format!("the scheme `{scheme}` has no load of the kind `{kind}`");
            let help = match scheme {
                "transport_velocity" => "fluids are moved by body forces and by walls",
                _ => "use `traction`, or the scheme `total_lagrangian`",
            };
            let problem = Problem::new(record.place, message, "of another scheme");
            self.report(problem.help(help));
        }
        if !record.has("body") && self.names.bodies.len() > 1 {
            let message = format!("a {kind} needs the key `body` where there are several bodies");
            let names = self.names.bodies.iter().map(String::as_str);
            let help = format!("expected {}", crate::case::suggest::one_of(names));
            let problem = Problem::new(record.place, message, "`body` is missing");
            self.report(problem.help(help));
        }
        record.record("where").and_then(|region| self.region(region))
    }

    pub(super) fn boundary(&mut self, record: &Record) -> Option<Boundary> {
        let body = self.body_of(record);
        let region = record.record("where").and_then(|region| self.region(region));
        if self.names.is_static {
            let why = "with the integrator `static`, where nothing moves";
            self.meaningless(record, "velocity", why);
        } else {
            for key in ["displacement", "roller", "tied"] {
                self.meaningless(record, key, "without the integrator `static`");
            }
        }
        let wave_maker = record.record("wave_maker").map(|maker| self.wave_maker(maker));
        if record.has("velocity") && wave_maker.is_some() {
            self.meaningless(record, "velocity", "beside `wave_maker`");
        }
        let keys = ["velocity", "wave_maker", "angular_velocity", "displacement", "roller", "tied"];
        if !keys.iter().any(|key| record.has(key)) {
            let (known, others) = match self.names.is_static {
                true => ("displacement", ", or `roller`, or `tied`"),
                false => ("velocity", ""),
            };
            let message = format!("the boundary needs the key `{known}`{others}");
            let problem = Problem::new(record.place, message, "prescribes nothing");
            self.report(problem.help(format!("add `{known} = {{ x = \"0\" }}`")));
        }
        let mirror = record
            .boolean("mirror")
            .map(|on| Located::new(on, record.key_place("mirror").unwrap_or(record.place)));
        if self.names.current.preset().is_none() {
            self.meaningless(record, "mirror", "in this scheme");
        }
        let roller = record.record("roller").map(|roller| self.roller(roller));
        let has_all = region.as_ref().is_some_and(|region| region.value == Region::All);
        let is_between = has_all && body.is_none() && self.names.bodies.len() > 1;
        if let Some(place) = record.key_place("tied").filter(|_| is_between) {
            let message = "this ties bodies to each other";
            let problem = Problem::new(place, message, "all particles of all bodies");
            self.report(problem.help("name one with the key `body`, or select a part"));
        }
        Some(Boundary {
            name: record.text("name")?,
            body,
            region: region?,
            history: self.history(record)?,
            velocity: expressions_per_axis(record, "velocity"),
            wave_maker: match wave_maker {
                Some(maker) => Some(maker?),
                None => None,
            },
            turning: self.turning(record),
            mirror: mirror.filter(|mirror| mirror.value),
            displacement: expressions_per_axis(record, "displacement"),
            roller: match roller {
                Some(roller) => Some(roller?),
                None => None,
            },
            tied: self.tied(record)?,
        })
    }

    /// What a boundary of a rigid body says of its turning.
    fn turning(&mut self, record: &Record) -> Option<Located<Turning>> {
        let keys = ["angular_velocity", "pivot"];
        if !keys.iter().any(|key| record.has(key)) {
            return None;
        }
        let mut turning = Turning {
            pivot: record.numbers("pivot").map(|point| point.value),
            ..Turning::default()
        };
        if let Some(turn) = record.record("angular_velocity") {
            turning.angular_velocity = AXES.map(|axis| turn.expression(axis));
            for axis in AXES {
                if self.dimension < if axis == "z" { 2 } else { 3 } {
                    self.meaningless(turn, axis, &format!("in {}D", self.dimension));
                }
            }
        }
        Some(Located::new(turning, first_place(record, &keys)))
    }

    fn roller(&mut self, record: &Record) -> Option<Roller> {
        let (normal, displacement) =
            (self.unit(record, "normal"), record.expression("displacement"));
        Some(Roller { normal: normal?, displacement: displacement? })
    }

    /// The components that are tied, each once.
    fn tied(&mut self, record: &Record) -> Option<Vec<Located<usize>>> {
        let mut tied: Vec<Located<usize>> = Vec::new();
        for name in record.texts("tied") {
            let component = AXES.iter().position(|axis| *axis == name.value)?;
            let problem = if component >= self.dimension {
                let message = format!("there is no component `{}` in {}D", *name, self.dimension);
                Problem::new(name.place, message, "unknown component")
            } else if tied.iter().any(|known| known.value == component) {
                let message = format!("`{}` is tied twice", *name);
                Problem::new(name.place, message, "the second time").help("remove it")
            } else {
                tied.push(Located::new(component, name.place));
                continue;
            };
            return self.refuse(problem);
        }
        Some(tied)
    }
}
