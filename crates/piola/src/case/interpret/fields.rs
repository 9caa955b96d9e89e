//! Names of fields, their components, and columns of tables.

use super::*;
use crate::case::catalogue;
use crate::case::model::{Probe, ProbeKind, Quantity};
use crate::case::suggest::one_of;
use crate::fields::{Component, FieldDescription, FieldKind, FieldSelector, component_name};
use crate::observe::{TANGENT_COLUMNS, moment_axes, opening_columns};

impl Reader<'_, '_> {
    /// The field called `name`, which stands at `place`.
    pub(super) fn field(&mut self, name: &str, place: Place) -> Option<FieldDescription> {
        let fields = self.fields();
        if let Some(field) = fields.iter().find(|field| field.name == name) {
            return Some(*field);
        }
        let scheme = self.names.current.scheme;
        let of = self.names.described().and_then(|scheme| scheme.matter);
        let of = of.map_or_else(String::new, |matter| format!(" for {matter}"));
        let message = format!("the scheme `{scheme}` has no field `{name}`{of}");
        let help = suggestion(name, fields.iter().map(|field| field.name));
        self.refuse(Problem::new(place, message, "unknown field").help(help))
    }

    /// A field with one number a particle, a component, or a magnitude.
    pub(super) fn selector(&mut self, text: &Located<String>) -> Option<Located<FieldSelector>> {
        let (name, component) = match text.split_once('.') {
            Some((name, component)) => (name, Some(component)),
            None => (text.as_str(), None),
        };
        let field = self.field(name, text.place)?;
        let component = match component {
            None if field.kind == FieldKind::Scalar => Component::Whole,
            Some("magnitude") if field.kind != FieldKind::Scalar => Component::Magnitude,
            _ => Component::Entry(self.entry(&field, component, true, text.place)?),
        };
        Some(Located::new(FieldSelector { field, component }, text.place))
    }

    /// The number of the component of a field.
    fn entry(
        &mut self,
        field: &FieldDescription,
        component: Option<&str>,
        has_magnitude: bool,
        place: Place,
    ) -> Option<usize> {
        let names = component_names(field.kind, self.dimension);
        if let Some(number) = names.iter().position(|name| Some(name.as_str()) == component) {
            return Some(number);
        }
        let FieldDescription { name, kind, .. } = *field;
        let (message, label) = match (component, kind) {
            (Some(component), FieldKind::Scalar) => {
                (format!("`{name}` is one number and has no component `{component}`"), "one number")
            }
            (Some(component), _) => {
                (format!("`{name}` has no component `{component}`"), "unknown component")
            }
            (None, _) => (format!("`{name}` has several components"), "which one?"),
        };
        let all = names.iter().map(String::as_str).chain(has_magnitude.then_some("magnitude"));
        let paths: Vec<String> = all.map(|component| format!("{name}.{component}")).collect();
        let help = match kind {
            FieldKind::Scalar => format!("write `{name}`"),
            _ => format!("expected {}", one_of(paths.iter().map(String::as_str))),
        };
        self.refuse(Problem::new(place, message, label).help(help))
    }

    /// A column of a table. Without `probes` the columns of probes are not looked up, because a
    /// probe was refused.
    pub(super) fn quantity(
        &mut self,
        text: &Located<String>,
        probes: Option<&[Probe]>,
    ) -> Option<Located<Quantity>> {
        let Some((table, column)) = text.split_once('.') else {
            let message = format!("`{}` is not a column of a table", text.value);
            let help = "expected PROBE.FIELD, PROBE.FIELD.COMPONENT, energy.NAME, momentum.NAME, step.NAME or run.NAME";
            return self.refuse(Problem::new(text.place, message, "no column").help(help));
        };
        let owned = column.to_owned();
        let quantity = match table {
            "energy" => {
                self.known_column(text, column, &catalogue::energy_columns(self.shown_by_all()))?;
                Quantity::Energy(owned)
            }
            "momentum" => {
                let known = catalogue::momentum_columns(self.shown_by_all(), self.dimension);
                let known: Vec<&str> = known.iter().map(String::as_str).collect();
                self.known_column(text, column, &known)?;
                Quantity::Momentum(owned)
            }
            "step" => {
                self.known_column(text, column, &catalogue::step_columns(self.shown_by_all()))?;
                Quantity::Step(owned)
            }
            "run" => {
                self.known_column(text, column, catalogue::RUN_COLUMNS)?;
                Quantity::Run(owned)
            }
            probe => {
                self.probe_column(text, probe, column, probes?)?;
                Quantity::Probe { probe: probe.to_owned(), column: owned }
            }
        };
        Some(Located::new(quantity, text.place))
    }

    fn known_column(&mut self, text: &Located<String>, column: &str, known: &[&str]) -> Option<()> {
        if known.is_empty() || known.contains(&column) {
            return Some(());
        }
        let message = format!("there is no column `{}`", text.value);
        let table = text.strip_suffix(column).unwrap_or_default();
        let names: Vec<String> = known.iter().map(|name| format!("{table}{name}")).collect();
        let help = suggestion(&text.value, names.iter().map(String::as_str));
        self.refuse(Problem::new(text.place, message, "unknown column").help(help))
    }

    fn probe_column(
        &mut self,
        text: &Located<String>,
        name: &str,
        column: &str,
        probes: &[Probe],
    ) -> Option<()> {
        let Some(probe) = probes.iter().find(|probe| *probe.name == name) else {
            let message = format!("there is no probe `{name}`");
            let names = probes.iter().map(|probe| probe.name.as_str());
            let help = suggestion(name, names.chain(["energy", "momentum", "step", "run"]));
            return self.refuse(Problem::new(text.place, message, "unknown probe").help(help));
        };
        let names = match &probe.kind {
            ProbeKind::Particle { fields, .. }
            | ProbeKind::Point { fields, .. }
            | ProbeKind::Line { fields, .. } => {
                return self.whole_column(text, name, column, fields);
            }
            ProbeKind::Force { .. } if column.starts_with("moment") => {
                moment_axes(self.dimension).iter().map(|axis| format!("moment.{axis}")).collect()
            }
            ProbeKind::Sum { field, .. }
            | ProbeKind::Mean { field, .. }
            | ProbeKind::Force { field, .. } => {
                return self.whole_column(text, name, column, std::slice::from_ref(field));
            }
            ProbeKind::Extremum { field, .. } => vec![field.name(self.dimension)],
            ProbeKind::Error { .. } => vec!["error".to_owned()],
            ProbeKind::Sensor { .. } => vec!["pressure".to_owned()],
            ProbeKind::Gauge { .. } => vec!["elevation".to_owned()],
            ProbeKind::Flux { .. } => vec!["flux".to_owned()],
            ProbeKind::Void => vec!["volume".to_owned()],
            ProbeKind::Opening => {
                opening_columns(self.dimension).map(|(own, _)| own.to_owned()).collect()
            }
            ProbeKind::Tangent { .. } => TANGENT_COLUMNS.map(|(own, _)| own.to_owned()).to_vec(),
        };
        if names.iter().any(|own| own == column) {
            return Some(());
        }
        let message = format!("the probe `{name}` does not record `{column}`");
        let problem = Problem::new(text.place, message, "not recorded");
        self.refuse(problem.help(match &names[..] {
            [own] => format!("its column is `{name}.{own}`"),
            _ => suggestion(column, names.iter().map(String::as_str)),
        }))
    }

    /// Checks a column of a probe that records whole fields.
    fn whole_column(
        &mut self,
        text: &Located<String>,
        name: &str,
        column: &str,
        fields: &[Located<FieldDescription>],
    ) -> Option<()> {
        let (field, component) = match column.split_once('.') {
            Some((field, component)) => (field, Some(component)),
            None => (column, None),
        };
        let Some(found) = fields.iter().find(|known| known.name == field) else {
            let message = format!("the probe `{name}` does not record `{field}`");
            let help = suggestion(field, fields.iter().map(|field| field.name));
            let problem = Problem::new(text.place, message, "not recorded");
            return self.refuse(problem.help(help));
        };
        if found.kind == FieldKind::Scalar && component.is_none() {
            return Some(());
        }
        self.entry(&found.value.clone(), component, false, text.place).map(|_| ())
    }
}

/// The names of the components of a field: `x` to `z`, or `xx` to `zz`, none of a scalar.
fn component_names(kind: FieldKind, dimension: usize) -> Vec<String> {
    match kind {
        FieldKind::Scalar => Vec::new(),
        _ => (0..kind.components(dimension))
            .map(|number| component_name(kind, number, dimension))
            .collect(),
    }
}
