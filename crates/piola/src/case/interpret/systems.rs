//! Systems beside the main one.

use super::*;
use crate::case::catalogue;
use crate::case::model::{Body, Preset, System};
use crate::case::suggest::one_of;
use crate::fields::FieldDescription;
use crate::schemes::total_lagrangian::Form;
use crate::schemes::transport_velocity::{self, Slip};
use crate::schemes::world::ContactLaw;
use crate::schemes::{Capability, SchemeDescription, upwind};
use crate::time::IntegratorKind;

/// What is known of a system before the rest of the case is read.
#[derive(Clone, Debug, Default)]
pub(super) struct Known {
    pub name: String,
    pub scheme: &'static str,
    /// Whether its bodies are hypoelastic solids, where the scheme has them and fluids.
    pub is_solid: bool,
    /// What the scheme does not offer with its settings.
    pub without: Option<Without>,
    /// Whether fields are those of all systems.
    pub is_of_all: bool,
    /// Whether it has regions of finer spacing.
    is_refined: bool,
}

/// What a scheme offers with other settings than those it has.
#[derive(Clone, Copy, Debug)]
pub(super) struct Without {
    pub capabilities: &'static [Capability],
    /// Why not.
    pub why: &'static str,
    /// What to do about it.
    pub remedy: &'static str,
}

impl Known {
    /// The preset of its total Lagrangian solid, if it is one.
    pub fn preset(&self) -> Option<Preset> {
        Preset::from_name(self.scheme)
    }

    /// The formulation, with its matter.
    pub fn described(&self) -> Option<&'static SchemeDescription> {
        if self.is_refined {
            return Some(transport_velocity::refined());
        }
        SchemeDescription::of(self.scheme, if self.is_solid { "solids" } else { "fluids" })
    }

    /// That of a scheme.
    pub fn of(
        name: &str,
        scheme: &'static str,
        is_solid: bool,
        settings: Option<&Located<Scheme>>,
    ) -> Self {
        let without = match settings.map(|settings| &settings.value) {
            Some(Scheme::Upwind(upwind))
                if upwind.tau_velocity > 0.0 || upwind.tau_pressure > 0.0 =>
            {
                Some(Without {
                    capabilities: &[Capability::Kicks],
                    why: " where it dissipates: its forces depend on velocities there",
                    remedy: "set `scheme.tau_velocity` and `scheme.tau_pressure` to 0",
                })
            }
            Some(Scheme::TotalLagrangian(solid)) if *solid.form == Form::Strong => Some(Without {
                capabilities: &[Capability::Rates, Capability::Newmark, Capability::Statics],
                why: " in the strong form, whose forces do not derive from an energy",
                remedy: "set `scheme.form` to \"adjoint\"",
            }),
            _ => None,
        };
        let is_refined = match settings.map(|settings| &settings.value) {
            Some(Scheme::TransportVelocity(settings)) => !settings.refine.is_empty(),
            _ => false,
        };
        let name = name.to_owned();
        Self { name, scheme, is_solid, without, is_of_all: false, is_refined }
    }
}

impl Reader<'_, '_> {
    /// Which system each body names, of those of the file.
    pub(super) fn systems_of_bodies(&mut self, record: &Record) {
        let names = self.unique_names(record, "system", &["fluid"]);
        for body in record.records("body") {
            let system = body.text("system");
            let index = system.as_ref().and_then(|it| names.iter().position(|name| *name == **it));
            if let (Some(system), None) = (system, index) {
                let message = format!("there is no system `{}`", system.value);
                let help = match names.is_empty() {
                    true => "the case has no `[[system]]` yet".to_owned(),
                    false => suggestion(&system.value, names.iter().map(String::as_str)),
                };
                self.report(Problem::new(system.place, message, "unknown system").help(help));
            }
            self.names.system_of.push(index);
        }
    }

    /// The systems beside the main one, but for their time.
    pub(super) fn systems<'a>(
        &mut self,
        record: &'a Record,
    ) -> Vec<(&'a Record, Option<Located<Scheme>>)> {
        let main = self.names.current.clone();
        let mut systems = Vec::new();
        for (number, system) in record.records("system").enumerate() {
            if main.scheme != transport_velocity::NAME || main.is_solid {
                let message = "systems are solids in a fluid, and the main one is no fluid";
                let problem = Problem::new(system.place, message, "needs a fluid around it");
                let help = "give the fluid in `[scheme]`, with `kind = \"transport_velocity\"` and bodies \
                            of the material `weakly_compressible`";
                self.report(problem.help(help));
            }
            if !self.names.system_of.contains(&Some(number)) {
                let message = "no body belongs to this system";
                let problem = Problem::new(system.place, message, "empty");
                self.report(problem.help("name it in a `[[body]]` with `system`"));
            }
            let described = system.record("scheme");
            let kind = described.map_or("", |scheme| scheme.kind);
            if let Some(place) = described.map(|scheme| scheme.place)
                && kind == interpolation::NAME
            {
                let message =
                    format!("the scheme `{kind}` has no surface that a fluid could follow");
                let problem = Problem::new(place, message, "nothing moves in it");
                let presets = Preset::ALL.map(|preset| preset.description().name);
                let others = [upwind::DESCRIPTION.name, transport_velocity::NAME];
                let able = one_of(presets.into_iter().chain(others));
                self.report(problem.help(format!("expected {able}")));
            }
            self.names.current.is_solid = kind == transport_velocity::NAME;
            let scheme = described.and_then(|scheme| self.scheme(scheme));
            if let Some(described) = described.filter(|_| self.names.current.is_solid) {
                self.meaningless(
                    described,
                    "escaped",
                    "for a solid in a fluid, which has no walls",
                );
            }
            let name = system.text("name").map(|name| name.value).unwrap_or_default();
            let is_solid = self.names.current.is_solid;
            self.names.systems.push(Known::of(&name, kind, is_solid, scheme.as_ref()));
            systems.push((system, scheme));
        }
        self.names.current = main.clone();
        self.names.main = main;
        systems
    }

    /// Reads what follows as of a system, or of the main one.
    pub(super) fn enter(&mut self, system: Option<usize>) {
        let known = system.and_then(|system| self.names.systems.get(system));
        self.names.current = known.unwrap_or(&self.names.main).clone();
    }

    /// The system of the body that a table names; the main one where it names none.
    pub(super) fn enter_system_of(&mut self, record: &Record) {
        let name = record.text("body");
        let body = name.and_then(|name| self.names.bodies.iter().position(|it| *it == *name));
        let system = body.and_then(|body| self.names.system_of.get(body).copied().flatten());
        self.enter(system);
    }

    /// A boundary or a probe says of which body, where there are several systems.
    pub(super) fn names_its_body(&mut self, record: &Record, what: &str) {
        if !self.names.systems.is_empty() && !record.has("body") {
            let message = format!("where there are several systems a {what} needs the key `body`");
            let names = self.names.bodies.iter().map(String::as_str);
            let help = format!("expected {}", one_of(names));
            self.report(Problem::new(record.place, message, "`body` is missing").help(help));
        }
    }

    /// A system whose scheme is known.
    pub(super) fn system(
        &mut self,
        record: &Record,
        scheme: Option<Located<Scheme>>,
        main: Option<&Time>,
    ) -> Option<System> {
        let time = record.record("time");
        let natural = self.natural_integrator();
        let place = time.map_or(record.place, |time| time.place);
        let integrator = time.and_then(|time| time.text("integrator"));
        let integrator =
            integrator.unwrap_or_else(|| Located::new(natural.name().to_owned(), place));
        let kind = IntegratorKind::from_name(&integrator).unwrap_or(natural);
        if kind.is_static() {
            let message = "nothing moves with this integrator, but a fluid does";
            let problem = Problem::new(integrator.place, message, "no motion");
            return self.refuse(problem.help("use `kick_drift_kick`, or an implicit integrator"));
        }
        self.suits_scheme(&integrator, kind.needs());
        let cfl = time.and_then(|time| time.number("cfl"));
        let step = match (time::is_explicit(kind.needs()), cfl) {
            (true, Some(cfl)) => cfl.map(StepControl::Cfl),
            (true, None) => Located::new(StepControl::Cfl(self.natural_cfl(kind.needs())), place),
            (false, _) => {
                if let Some(time) = time {
                    self.meaningless(time, "cfl", "with an implicit integrator");
                }
                Located::new(StepControl::AtMost(f64::MAX), place)
            }
        };
        let rule = match time {
            Some(time) => {
                self.solves_equations(time, kind.needs());
                self.rule(time, Some(kind))?
            }
            None => None,
        };
        let number = |key: &str| time.and_then(|time| time.number(key)).map(|it| it.value);
        let main = main?;
        let linear_solver = time.and_then(time::linear_solver);
        Some(System {
            name: record.text("name")?,
            scheme: scheme?,
            time: Time {
                integrator,
                rule,
                step,
                error: None,
                tolerance: number("tolerance"),
                linear_solver: linear_solver.unwrap_or(main.linear_solver),
                ..main.clone()
            },
            slip: match record.text("slip")?.as_str() {
                "free" => Slip::Free,
                _ => Slip::No,
            },
            contact: ContactLaw {
                stiffness: record.number("contact_stiffness")?.value,
                damping: record.number("contact_damping")?.value,
                friction: record.number("friction")?.value,
            },
        })
    }

    /// Bodies of a system are what they are to the fluid by that alone.
    pub(super) fn fits_system(&mut self, bodies: &[Body]) {
        for body in bodies.iter().filter(|body| body.system.is_some()) {
            if let Some(wall) = &body.wall {
                let message =
                    format!("the body `{}` belongs to a system, and is no wall", *body.name);
                let problem = Problem::new(wall.place, message, "no meaning here");
                self.report(
                    problem.help("remove it: `slip` of the system says how fluid moves along it"),
                );
            }
        }
    }

    /// Lets fields be of all systems from here on.
    pub(super) fn enter_all(&mut self) {
        self.enter(None);
        self.names.current.is_of_all = true;
    }

    /// The fields of the system that is being read, or of all.
    pub(super) fn fields(&self) -> Vec<FieldDescription> {
        let shown = match self.names.current.is_of_all {
            true => self.shown_by_all(),
            false => self.names.described(),
        };
        catalogue::fields(shown)
    }

    /// What all systems show together.
    pub(super) fn shown_by_all(&self) -> Option<&'static SchemeDescription> {
        if self.names.systems.is_empty() {
            return self.names.described();
        }
        let main = self.names.main.described()?;
        let described = |known: &Known| Some((known.name.clone(), known.described()?));
        let solids: Vec<_> = self.names.systems.iter().filter_map(described).collect();
        Some(main.with_solids(&solids))
    }
}
