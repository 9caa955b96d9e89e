//! Clock and integrator.

use super::systems::Without;
use super::*;
use crate::case::suggest::one_of;
use crate::schemes::{Capability, ImplicitRule, Newmark, SchemeDescription, Theta};
use crate::solve::LinearMethod;

/// Whether steps are found without solving equations.
pub(super) fn is_explicit(needs: Capability) -> bool {
    matches!(needs, Capability::Rates | Capability::Kicks)
}

/// How linear equations are solved, if the file says it.
pub(super) fn linear_solver(record: &Record) -> Option<LinearMethod> {
    Some(match record.text("linear_solver")?.as_str() {
        "direct" => LinearMethod::Direct,
        "krylov" => LinearMethod::Krylov,
        _ => LinearMethod::Automatic,
    })
}

impl Reader<'_, '_> {
    pub(super) fn time(&mut self, record: &Record) -> Option<Time> {
        let natural = self.natural_integrator();
        let integrator = match record.text("integrator") {
            Some(name) => name,
            None => Located::new(natural.name().to_owned(), record.place),
        };
        let kind = IntegratorKind::from_name(&integrator);
        let needs = kind.unwrap_or(natural).needs();
        self.suits_scheme(&integrator, needs);
        let step = self.step(record, needs);
        let rule = self.rule(record, kind);
        if !matches!(needs, Capability::Newmark | Capability::Theta) {
            self.meaningless(record, "error", "without implicit steps in time");
        }
        let is_explicit = is_explicit(needs);
        self.solves_equations(record, needs);
        Some(Time {
            end: record.number("end")?,
            integrator,
            rule: rule?,
            error: record.number("error").map(|it| it.value),
            tolerance: record.number("tolerance").map(|it| it.value),
            linear_solver: linear_solver(record).unwrap_or(LinearMethod::Automatic),
            step: step?,
            max_steps: record.whole("max_steps").map(|steps| steps.value),
            min_step: record.number("min_step").map(|step| step.value),
            max_speed: record.number("max_speed").map(|speed| speed.value),
            retries: self.retries(record, is_explicit)?,
        })
    }

    /// Reports an integrator that the scheme does not work with, with those that do.
    pub(super) fn suits_scheme(&mut self, integrator: &Located<String>, needs: Capability) {
        let (name, scheme, without) =
            (&integrator.value, self.names.current.scheme, self.names.current.without);
        let Some(offers) = self.names.described().map(|scheme| scheme.offers) else {
            return;
        };
        let is_offered = |needs: Capability| {
            let lacks = |without: &Without| without.capabilities.contains(&needs);
            offers.contains(&needs) && !without.as_ref().is_some_and(lacks)
        };
        if is_offered(needs) {
            return;
        }
        let all = IntegratorKind::ALL.into_iter();
        let able = one_of(all.filter(|kind| is_offered(kind.needs())).map(IntegratorKind::name));
        let (why, other) = match without.filter(|_| offers.contains(&needs)) {
            Some(Without { why, remedy, .. }) => (why, remedy.to_owned()),
            None => {
                let others = SchemeDescription::ALL.into_iter();
                let others = others.filter(|other| other.offers.contains(&needs));
                let mut others: Vec<&str> = others.map(|scheme| scheme.name).collect();
                others.dedup();
                let others = one_of(others);
                ("", format!("for `{name}` a scheme that it moves: {others}"))
            }
        };
        let message = format!("the integrator `{name}` cannot move the scheme `{scheme}`{why}");
        let help = format!("use one of those that can: {able}; or {other}");
        self.report(Problem::new(integrator.place, message, "of another scheme").help(help));
    }

    /// The integrator, unless the file has one.
    pub(super) fn natural_integrator(&self) -> IntegratorKind {
        let lacks = |without: &Without| without.capabilities.contains(&Capability::Kicks);
        match self.names.current.without.as_ref().is_some_and(lacks) {
            true => IntegratorKind::TvdRk2,
            false => IntegratorKind::KickDriftKick,
        }
    }

    /// Reports what says how equations are solved where there are none.
    pub(super) fn solves_equations(&mut self, record: &Record, needs: Capability) {
        for key in ["tolerance", "linear_solver"].into_iter().filter(|_| is_explicit(needs)) {
            self.meaningless(record, key, "with this integrator, which solves no equations");
        }
    }

    /// The CFL number of explicit steps, unless the file has one.
    pub(super) fn natural_cfl(&self, needs: Capability) -> f64 {
        let known = &self.names.current;
        match known.scheme {
            "transport_velocity" => 0.25,
            // Stages of rates feed undamped modes, the less the shorter steps are.
            _ if known.preset().is_some() && needs == Capability::Kicks => 0.9,
            _ => 0.3,
        }
    }

    /// How the step is chosen.
    fn step(&mut self, record: &Record, needs: Capability) -> Option<Located<StepControl>> {
        let (cfl, step) = (record.number("cfl"), record.number("step"));
        if let (Some(_), Some(place)) = (record.key_place("cfl"), record.key_place("step")) {
            let message = "`cfl` and `step` cannot be given both";
            self.report(
                Problem::new(place, message, "the second way to choose the step")
                    .help("`cfl` follows the stable step, `step` is fixed: remove one of them"),
            );
        }
        match (needs, cfl, step) {
            (needs, _, Some(step)) if is_explicit(needs) => Some(step.map(StepControl::Fixed)),
            (_, _, Some(step)) => Some(step.map(StepControl::AtMost)),
            (Capability::Statics, _, None) => {
                self.meaningless(record, "cfl", "in statics");
                let end = record.number("end")?;
                Some(Located::new(StepControl::AtMost(0.1 * *end), record.place))
            }
            (_, Some(cfl), None) => Some(cfl.map(StepControl::Cfl)),
            (needs @ (Capability::Rates | Capability::Kicks), None, None) => {
                let cfl = self.natural_cfl(needs);
                Some(Located::new(StepControl::Cfl(cfl), record.place))
            }
            (Capability::Newmark | Capability::Theta, None, None) => {
                let message = "an implicit integrator needs the key `step`";
                let problem = Problem::new(record.place, message, "`step` is missing").help(
                    "any size is stable, so that accuracy decides: about a twentieth of the shortest \
                     period of interest, or give `cfl` in multiples of the stable explicit step",
                );
                self.refuse(problem)
            }
        }
    }

    /// The rule of an implicit step: `Some(None)` for integrators that have none.
    pub(super) fn rule(
        &mut self,
        record: &Record,
        kind: Option<IntegratorKind>,
    ) -> Option<Option<ImplicitRule>> {
        let own: &[&str] = match kind {
            Some(IntegratorKind::Newmark) => &["beta", "gamma"],
            Some(IntegratorKind::HhtAlpha) => &["alpha"],
            Some(IntegratorKind::GeneralisedAlpha) => &["spectral_radius"],
            Some(IntegratorKind::Theta) => &["theta"],
            _ => &[],
        };
        for key in ["beta", "gamma", "alpha", "spectral_radius", "theta"] {
            if !own.contains(&key) {
                self.meaningless(record, key, "with this integrator");
            }
        }
        let number = |key: &str, usual: f64| record.number(key).map_or(usual, |it| it.value);
        let newmark = match kind {
            Some(IntegratorKind::Newmark) => {
                let gamma = number("gamma", 0.5);
                match Newmark::new(number("beta", 0.25), gamma) {
                    Ok(rule) => rule,
                    Err(error) => {
                        let place = first_place(record, own);
                        let problem = Problem::new(place, error.to_string(), "not stable");
                        let help = format!("set `beta = {}` or larger", 0.5 * gamma);
                        return self.refuse(problem.help(help));
                    }
                }
            }
            Some(IntegratorKind::HhtAlpha) => {
                Newmark::hilber_hughes_taylor(number("alpha", IntegratorKind::ALPHA))
            }
            Some(IntegratorKind::GeneralisedAlpha) => {
                let radius = number("spectral_radius", IntegratorKind::SPECTRAL_RADIUS);
                Newmark::generalised_alpha(radius)
            }
            _ => return Some(self.theta(record, kind).map(ImplicitRule::Theta)),
        };
        Some(Some(ImplicitRule::Newmark(newmark)))
    }

    /// Which step of a first-order system, if steps are of that kind.
    fn theta(&self, record: &Record, kind: Option<IntegratorKind>) -> Option<Theta> {
        match kind? {
            IntegratorKind::BackwardEuler => Some(Theta::BACKWARD_EULER),
            IntegratorKind::CrankNicolson => Some(Theta::CRANK_NICOLSON),
            IntegratorKind::ImplicitMidpoint => Some(Theta::MIDPOINT),
            IntegratorKind::Theta => match record.number("theta") {
                // The table of keys has refused others.
                Some(theta) => Theta::new(*theta).ok(),
                None => Some(Theta::DAMPED),
            },
            _ => None,
        }
    }

    fn retries(&mut self, record: &Record, is_explicit: bool) -> Option<u64> {
        let number = record.whole("retries").map(|number| number.value);
        if record.text("on_failure")?.value != "retry" {
            self.meaningless(record, "retries", "without `on_failure = \"retry\"`");
            return Some(0);
        }
        if let Some(place) = record.key_place("step").filter(|_| is_explicit) {
            let problem =
                Problem::new(place, "a fixed step cannot be retried with a smaller one", "fixed");
            self.report(problem.help("set `cfl` instead, or `on_failure = \"stop\"`"));
        }
        Some(number.unwrap_or(5))
    }
}
