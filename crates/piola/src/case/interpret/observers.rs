//! Probes, output, pictures and plots.

use super::*;
use crate::case::model::{
    Body, Compression, Extremum, Output, Picture, Plot, Probe, ProbeKind, Quantity,
};
use crate::case::suggest::one_of;

use crate::case::expression::Expression;
use crate::fields::{Component, FieldDescription, FieldKind, FieldSelector};
use crate::observe::Norm;
use crate::schemes::ImplicitRule;

/// Particle files that a run may write at most.
const MAX_FILES: f64 = 1e5;
/// Rows that a table may have at most.
const MAX_ROWS: f64 = 1e8;

impl Reader<'_, '_> {
    pub(super) fn probe(&mut self, record: &Record) -> Option<Probe> {
        let body = self.body_of(record);
        let kind = match record.kind {
            "particle" => ProbeKind::Particle {
                fields: self.whole_fields(record)?,
                at: record.numbers("at")?,
                relative_to: record.numbers("relative_to"),
            },
            "point" => ProbeKind::Point {
                fields: self.whole_fields(record)?,
                at: record.numbers("at")?,
                relative_to: record.numbers("relative_to"),
            },
            "line" => self.line(record)?,
            "sum" | "mean" => {
                let name = record.text("field")?;
                let field = Located::new(self.field(&name, name.place)?, name.place);
                let region = record.record("where").and_then(|region| self.region(region))?;
                match record.kind {
                    "sum" => ProbeKind::Sum { field, region },
                    _ => ProbeKind::Mean { field, region },
                }
            }
            "force" => {
                self.is_of_one_body(record);
                // A solid in a fluid has the forces that the fluid shows of its walls.
                let current = self.names.current.clone();
                if !self.names.systems.is_empty() {
                    self.enter_all();
                }
                let force = self.force(record);
                self.names.current = current;
                force?
            }
            "sensor" => {
                self.is_of_one_body(record);
                let normal = self.unit(record, "normal");
                let (at, radius) = (record.numbers("at")?, record.number("radius")?.value);
                ProbeKind::Sensor { at, normal: normal?, radius }
            }
            "gauge" => {
                self.is_of_one_body(record);
                let (from, to) = (record.numbers("from")?, record.numbers("to")?);
                self.has_direction(record, ProbeKind::Gauge { from, to })?
            }
            "flux" => {
                self.is_of_one_body(record);
                let normal = self.unit(record, "normal");
                let point = record.numbers("point")?.value;
                let inside = self.box_of(record);
                ProbeKind::Flux { point, normal: normal?, inside: inside? }
            }
            "opening" => {
                self.is_of_one_body(record);
                ProbeKind::Opening
            }
            "void" => ProbeKind::Void,
            "tangent" => ProbeKind::Tangent { step: record.number("step")?.value },
            "error" => {
                let parts = self.deviations(record);
                let norm = self.norm(record);
                let region = record.record("where").and_then(|region| self.region(region));
                ProbeKind::Error {
                    parts: parts?,
                    without_mean: record.boolean("without_mean")?,
                    norm: norm?,
                    region: region?,
                }
            }
            "extremum" => {
                let field = record.text("field").and_then(|field| self.selector(&field));
                let region = record.record("where").and_then(|region| self.region(region));
                let of = match record.text("of")?.as_str() {
                    "smallest" => Extremum::Smallest,
                    _ => Extremum::Largest,
                };
                let inside = self.box_of(record);
                ProbeKind::Extremum { field: field?, of, region: region?, inside: inside? }
            }
            _ => return None,
        };
        Some(Probe { name: record.text("name")?, body, kind })
    }

    /// What is compared by a probe of errors, with what it should be.
    fn deviations(&mut self, record: &Record) -> Option<Vec<(FieldSelector, Expression)>> {
        let name = record.text("field")?;
        match (record.has("exact"), record.has("components")) {
            (true, false) => {
                let field = self.selector(&name);
                Some(vec![(field?.value, record.expression("exact")?)])
            }
            (false, true) => {
                let field = self.field(&name, name.place)?;
                if field.kind != FieldKind::Vector {
                    let message =
                        format!("`{}` is not a vector and has no components x, y, z", name.value);
                    let problem = Problem::new(name.place, message, "no vector");
                    return self.refuse(problem.help("give `exact` instead of `components`"));
                }
                let entry =
                    |component| FieldSelector { field, component: Component::Entry(component) };
                let expressions = super::physics::expressions_per_axis(record, "components");
                let parts = expressions.into_iter().enumerate();
                Some(parts.filter_map(|(axis, exact)| Some((entry(axis), exact?))).collect())
            }
            (both, _) => {
                let message = match both {
                    true => "`exact` and `components` cannot both be given",
                    false => "the probe needs the key `exact`, or `components` of a vector",
                };
                self.refuse(Problem::new(record.place, message, "what should it be?"))
            }
        }
    }

    /// What a probe of errors sums.
    fn norm(&mut self, record: &Record) -> Option<Norm> {
        let name = record.text("norm")?;
        match name.as_str() {
            "square" => Some(Norm::Square),
            "volume" => {
                // Refused where particles have no such field.
                self.field("volume", name.place)?;
                Some(Norm::Volume)
            }
            _ => Some(Norm::Absolute),
        }
    }

    /// The box that a probe may have.
    fn box_of(&mut self, record: &Record) -> Option<Option<[Vec<f64>; 2]>> {
        match (record.has("min"), record.has("max")) {
            (false, false) => Some(None),
            (true, true) => self.corners(record).map(|(min, max)| Some([min, max])),
            (has_lower, _) => {
                let (given, missing) = if has_lower { ("min", "max") } else { ("max", "min") };
                let message = format!("a box has two corners, and `{missing}` is not given");
                let problem = Problem::new(record.value_place(given), message, "one corner only");
                self.refuse(problem.help(format!("give `{missing}`, or leave out both")))
            }
        }
    }

    /// Reports probes of forces that look at no wall and no solid, sensors that are in no wall, and probes of what
    /// goes through openings that are of other bodies.
    pub(super) fn probes_suit(&mut self, probes: &[Probe], bodies: &[Body]) {
        for probe in probes {
            let is_sensor = matches!(probe.kind, ProbeKind::Sensor { .. });
            let is_of_one = is_sensor || matches!(probe.kind, ProbeKind::Opening);
            // Where there is one body only it is that one; where there are several it has to be named.
            let (its, place) = match &probe.body {
                Some(body) => (bodies.get(body.value), body.place),
                None if is_of_one && bodies.len() == 1 => (bodies.first(), probe.name.place),
                None => continue,
            };
            let is_wall = its.is_none_or(|body| body.wall.is_some());
            let is_solid = its.is_some_and(|body| body.system.is_some());
            let is_open = its.is_none_or(|body| body.opening.is_some());
            let (what, help) = match probe.kind {
                ProbeKind::Opening if !is_open => {
                    ("belongs to no opening", "name a body that has the key `opening`")
                }
                ProbeKind::Force { .. } if !is_wall && !is_solid => (
                    "observes neither a wall nor a solid",
                    "name a wall or the body of a system, or use the kind `sum`",
                ),
                ProbeKind::Sensor { .. } if !is_wall => {
                    ("is in no wall", "name a wall; the kind `force` serves solids in the fluid")
                }
                _ => continue,
            };
            let message = format!("the probe `{}` {what}", *probe.name);
            let label = match () {
                () if is_solid => "a solid",
                () if is_sensor => "no wall",
                () if is_of_one => "no opening",
                () => "the fluid itself",
            };
            self.report(Problem::new(place, message, label).help(help));
        }
    }

    /// Reports tests of tangents where no step has one.
    pub(super) fn tangents_exist(&mut self, probes: &[Probe], time: &Time) {
        let has_one = matches!(time.rule, Some(ImplicitRule::Theta(_)));
        for probe in probes.iter().filter(|_| !has_one) {
            if matches!(probe.kind, ProbeKind::Tangent { .. }) {
                let message = format!(
                    "the probe `{}` tests the tangent of a step, which the integrator `{}` does not \
                     have",
                    *probe.name, *time.integrator
                );
                let problem = Problem::new(probe.name.place, message, "no tangent to test");
                self.report(problem.help("use `crank_nicolson`, with the scheme `upwind`"));
            }
        }
    }

    fn line(&mut self, record: &Record) -> Option<ProbeKind> {
        let times = record.list("times").iter().filter_map(|item| match item.value {
            Datum::Number(time) => Some(time),
            _ => None,
        });
        if let (Some(place), false) = (record.key_place("mean_over"), record.has("times")) {
            let message = "`mean_over` needs the times of the profiles";
            self.report(
                Problem::new(place, message, "means up to which times").help("add `times`"),
            );
        }
        let line = ProbeKind::Line {
            fields: self.whole_fields(record)?,
            from: record.numbers("from")?,
            to: record.numbers("to")?,
            points: record.whole::<usize>("points")?.value,
            times: record.has("times").then(|| times.collect()),
            mean_over: record.number("mean_over").map(|span| span.value),
        };
        self.has_direction(record, line)
    }

    /// The resultant of a field of forces.
    fn force(&mut self, record: &Record) -> Option<ProbeKind> {
        let name = record.text("field")?;
        let field = Located::new(self.field(&name, name.place)?, name.place);
        let region = record.record("where").and_then(|region| self.region(region))?;
        if (field.kind, field.unit) != (FieldKind::Vector, "N") {
            let message =
                format!("`{}` is not a force: it has the unit {}", field.name, field.unit);
            let known = self.fields();
            let forces = known.iter().filter(|it| (it.kind, it.unit) == (FieldKind::Vector, "N"));
            let help = format!("expected {}", one_of(forces.map(|field| field.name)));
            return self.refuse(Problem::new(field.place, message, "no force").help(help));
        }
        let about = record.numbers("about").map(|about| about.value);
        let about = about.unwrap_or_else(|| vec![0.0; self.dimension]);
        Some(ProbeKind::Force { field, about, region })
    }

    /// Reports a probe that looks at fluid and walls together.
    fn is_of_one_body(&mut self, record: &Record) {
        if !record.has("body") && self.names.bodies.len() > 1 {
            let message =
                format!("a {} needs the key `body` where there are several bodies", record.kind);
            let names = self.names.bodies.iter().map(String::as_str);
            let problem = Problem::new(record.place, message, "`body` is missing");
            let what = match record.kind {
                "force" => "a wall or a solid",
                "sensor" => "a wall",
                "opening" => "an opening",
                _ => "the fluid",
            };
            self.report(problem.help(format!("name {what}, one of {}", one_of(names))));
        }
    }

    /// A probe along a line, unless it is a point.
    fn has_direction(&mut self, record: &Record, line: ProbeKind) -> Option<ProbeKind> {
        let length = line.length().unwrap_or_default();
        if length.is_normal() {
            return Some(line);
        }
        let place = record.value_place("to");
        let message = format!("a line of {length} m has no direction");
        let problem = Problem::new(place, message, "where it starts");
        self.refuse(problem.help("`from` and `to` are two places"))
    }

    /// The fields that the key `fields` names.
    fn whole_fields(&mut self, record: &Record) -> Option<Vec<Located<FieldDescription>>> {
        let names = record.texts("fields");
        let fields: Vec<_> = names
            .iter()
            .map(|name| Some(Located::new(self.field(name, name.place)?, name.place)))
            .collect();
        fields.into_iter().collect()
    }

    /// `end` is the time at which the run ends, as far as it is known.
    pub(super) fn output(&mut self, case: &Record, end: Option<f64>) -> Option<Output> {
        let record = case.record("output");
        let number = |key| record.and_then(|record| record.number(key));
        let place = record.map_or(case.value_place("time"), |record| record.place);
        let end = end?;
        let every = number("every").unwrap_or(Located::new(end / 100.0, place));
        let table_every = number("table_every").unwrap_or(every.clone());
        self.not_too_often(&every, end, MAX_FILES, "particle files");
        if table_every != every {
            self.not_too_often(&table_every, end, MAX_ROWS, "rows");
        }
        let fields = match record.filter(|record| record.has("fields")) {
            None => self.fields(),
            Some(record) => {
                let names = record.texts("fields");
                let fields: Vec<_> =
                    names.iter().map(|name| self.field(name, name.place)).collect();
                fields.into_iter().collect::<Option<_>>()?
            }
        };
        let compression = record.and_then(|record| record.text("compression"));
        let compression = match compression.as_deref().map(String::as_str) {
            Some("none") => Compression::None,
            _ => Compression::Zlib,
        };
        let report = record.and_then(|record| record.boolean("report")).unwrap_or(true);
        Some(Output { every, table_every, fields, compression, report })
    }

    fn not_too_often(&mut self, every: &Located<f64>, end: f64, most: f64, what: &str) {
        let count = end / every.value;
        if count > most {
            let message = format!("the run would write {count:.1e} {what}, at most {most:.0e}");
            self.report(
                Problem::new(every.place, message, "too often")
                    .help(format!("with `time.end` {end} s, at least {:e} s", end / most)),
            );
        }
    }

    pub(super) fn picture(&mut self, record: &Record, end: Option<f64>) -> Option<Picture> {
        let field = record.text("field").and_then(|field| self.selector(&field));
        let end = end?;
        let mut times = Vec::new();
        for item in record.list("times") {
            let Datum::Number(time) = item.value else { continue };
            if time <= end {
                times.push(Located::new(time, item.place));
            } else if self.setting.is_changed || self.setting.is_plain() {
                self.late.pictures.push(time);
            }
            // A variant or the coarse setting is meant to have fewer pictures then.
        }
        if !record.has("times") {
            times.push(Located::new(end, record.place));
        }
        let range = record.ends("range").map(|range| range.value);
        let part = self.part(record)?;
        Some(Picture { field: field?, times, range, part })
    }

    /// The part of space that a picture shows, `None` inside for all.
    fn part(&mut self, record: &Record) -> Option<Option<[Vec<f64>; 2]>> {
        let only = match [record.has("from"), record.has("to")] {
            [false, false] => return Some(None),
            [true, true] => None,
            [from, _] => record.key_place(if from { "from" } else { "to" }),
        };
        if let Some(place) = only {
            let message = "a part of space has two corners: `from` and `to`";
            return self.refuse(Problem::new(place, message, "without the other"));
        }
        let (from, to) = (record.numbers("from")?, record.numbers("to")?);
        if from.value.iter().zip(&to.value).all(|(from, to)| from < to) {
            return Some(Some([from.value, to.value]));
        }
        let message = "each coordinate of `to` must be larger than that of `from`";
        self.refuse(Problem::new(to.place, message, "not beyond `from`"))
    }

    pub(super) fn plot(&mut self, record: &Record, probes: Option<&[Probe]>) -> Option<Plot> {
        let names = record.texts("curves");
        let curves: Vec<_> = names.iter().map(|name| self.quantity(name, probes)).collect();
        let curves: Vec<Located<Quantity>> = curves.into_iter().collect::<Option<_>>()?;
        let is_along = |curve: &Quantity| line_of(curve, probes?).map(|_| ());
        if let Some(other) = curves.iter().find(|curve| is_along(curve) != is_along(&curves[0])) {
            let message = "a plot has curves against time or curves along lines, not both";
            let problem = Problem::new(other.place, message, "of the other kind");
            return self.refuse(problem.help("make two plots of it"));
        }
        let over_time = record.boolean("over_time")?;
        if over_time && (curves.len() != 1 || is_along(&curves[0]).is_none()) {
            let place = record.key_place("over_time").unwrap_or(record.place);
            let message = "a map over time is of one column of a line";
            let problem = Problem::new(place, message, "not of one column of a line");
            return self.refuse(problem.help("name one column of a probe of the kind `line`"));
        }
        Some(Plot { name: record.text("name")?, curves, over_time })
    }
}

/// The probe that a column belongs to, if that looks along a line.
pub(super) fn line_of<'a>(quantity: &Quantity, probes: &'a [Probe]) -> Option<&'a Probe> {
    let Quantity::Probe { probe: name, .. } = quantity else { return None };
    let is_line = |probe: &&Probe| matches!(probe.kind, ProbeKind::Line { .. });
    probes.iter().filter(is_line).find(|probe| *probe.name == *name)
}
