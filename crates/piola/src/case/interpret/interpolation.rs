//! The scheme `interpolation`, in which nothing moves.

use super::*;
use crate::case::model::{Body, Interpolation, Material};
use crate::operators::GradientForm;
use crate::schemes::interpolation::Boundary;

/// Its name.
pub(super) const NAME: &str = "interpolation";

/// Settings of the scheme `interpolation`.
pub(super) fn settings(record: &Record) -> Option<Interpolation> {
    let function = Located::new(record.expression("function")?, record.key_place("function")?);
    Some(Interpolation {
        function,
        kernel: record.text("kernel")?,
        support: record.number("support")?,
        weights: physics::weights(record)?,
        form: GradientForm::from_name(&record.text("gradient")?)?,
        boundary: Boundary::from_name(&record.text("boundary")?)?,
    })
}

impl Reader<'_, '_> {
    /// The material of a body: of one that is only a cloud, a placeholder.
    pub(super) fn body_material(&mut self, record: &Record) -> Option<Located<Material>> {
        if self.names.current.scheme == NAME {
            for key in ["material", "initial", "wall"] {
                self.meaningless(record, key, "with the scheme `interpolation`");
            }
            return Some(Located::new(Material::PLACEHOLDER, record.place));
        }
        match record.record("material") {
            Some(material) => self.material(material),
            None if record.has("material") => None,
            None => {
                let what = "the key `material`: what it is made of";
                self.needed(record.place, "[[body]]", what, "material")
            }
        }
    }

    /// Clock and integrator, which a case in which nothing moves does without.
    pub(super) fn clock(&mut self, record: &Record) -> Option<Time> {
        if self.names.current.scheme == NAME {
            for key in ["time", "checkpoint", "load", "boundary"] {
                self.meaningless(record, key, "with the scheme `interpolation`");
            }
            return Some(Time::none(record.place));
        }
        match record.record("time") {
            Some(time) => self.time(time),
            None if record.has("time") => None,
            None => {
                let what = "the table [time]: clock and integrator";
                self.needed(record.place, "the case file", what, "time")
            }
        }
    }

    /// Reports what another scheme could do without, unless a misspelt key was meant.
    fn needed<T>(&mut self, place: Place, title: &str, what: &str, key: &str) -> Option<T> {
        let meant = format!("did you mean `{key}`?");
        let is_meant = |problem: &Problem| problem.help.as_deref() == Some(meant.as_str());
        if self.context.problems.iter().any(is_meant) {
            return None;
        }
        let mut problem =
            Problem::new(place, format!("{title} needs {what}"), format!("`{key}` is missing"));
        // The file as a whole has no text to underline.
        if place.span() == (0..0) {
            problem.place = None;
        }
        self.refuse(problem)
    }

    /// Reports bodies that cannot be interpolated on.
    pub(super) fn one_cloud(&mut self, bodies: &[Body], settings: &Located<Scheme>) {
        let Scheme::Interpolation(Interpolation { boundary, .. }) = &settings.value else { return };
        if let [_, second, ..] = bodies {
            let message = "a function is interpolated on one body";
            let problem = Problem::new(second.name.place, message, "the second one");
            self.report(problem.help("make one body of them with `kind = \"union\"`"));
        }
        for body in bodies.iter().filter(|_| boundary.reach() > 0.0) {
            if body.shape.value.is_from_file() {
                let message = "ghosts continue a lattice, and particles from a file have none";
                let problem = Problem::new(body.shape.place, message, "no lattice");
                self.report(problem.help("set `scheme.boundary = \"none\"`"));
            }
        }
    }
}
