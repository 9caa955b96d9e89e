//! Time integration of a state that it knows only as numbers.

use std::ops::RangeInclusive;

use thiserror::Error;

use super::failure::Failure;
use super::implicit::ImplicitStepping;
use super::kick_drift_kick::KickDriftKick;
use super::load_steps::LoadStepping;
use super::runge_kutta::RungeKutta;
use crate::schemes::{Capability, ImplicitRule, NEWTON_ITERATIONS, Newmark, Scheme, Theta};

/// A method that takes a state one step further.
pub trait Integrator: Send + Sync {
    /// Name in a case file.
    fn name(&self) -> &'static str;

    /// Evaluations of the rates of `scheme` a step.
    fn evaluations(&self, scheme: &mut dyn Scheme) -> u64;

    /// Evaluations of single particles in one of the steps of each system, of which a step of the run may be several.
    fn evaluations_by_system(&self, scheme: &mut dyn Scheme) -> Vec<u64> {
        vec![self.evaluations(scheme) * scheme.particle_count() as u64]
    }

    /// How many steps each system took in the last one of the run; one each where there is nothing.
    fn steps_in_last(&self) -> &[u64] {
        &[]
    }

    /// Whether one step is quick enough to be taken for an estimate of the run. Where it solves equations for all
    /// particles, the estimate is by [`Self::evaluations`].
    fn is_timed_by_steps(&self) -> bool {
        true
    }

    /// What a step multiplies the energy of an undamped mode by that turns by `phase`, its angular
    /// frequency times the step; `None` where that is not known.
    fn energy_factor(&self, _phase: f64) -> Option<f64> {
        None
    }

    /// Writes the state at `time + step` to `new`, from `old` at `time`. Both have the layout of
    /// the scheme's state; `old` satisfies the constraints at `time`. Of several systems it is the state that
    /// [`Scheme::inspect`] has looked at last, by which the numbers of their own steps go: one each without a look.
    ///
    /// # Errors
    /// There is no such state, as far as was looked, or the scheme is not the one that the integrator
    /// was built for and does not offer what it needs. Explicit methods always find one.
    fn step(
        &mut self,
        scheme: &mut dyn Scheme,
        time: f64,
        step: f64,
        old: &[f64],
        new: &mut [f64],
    ) -> Result<(), Failure>;

    /// Says what failures have multiplied steps by, which holds for steps within a step as well.
    fn shorten(&mut self, _factor: f64) {}

    /// One that takes the same steps of `scheme`, which is a part of what this one moves or all of it, and remembers
    /// nothing; `None` where it has no parts.
    fn renewed(&self, _scheme: &mut dyn Scheme) -> Option<Box<dyn Integrator>> {
        None
    }

    /// What the next step should be over the one that was tried last, for its error to be what is
    /// allowed; `None` where no error is estimated.
    fn growth(&self) -> Option<f64> {
        None
    }

    /// Whether the step that led to `state` was found so quickly that the next may be longer, where
    /// failures have made steps shorter: with few iterations, which a scheme that solves for its
    /// states has among its figures. Those of explicit steps are none.
    fn was_quick(&self, scheme: &dyn Scheme, state: &[f64]) -> bool {
        let mut names = scheme.description().figures.iter();
        let Some(index) = names.position(|(name, _)| *name == NEWTON_ITERATIONS) else {
            return false;
        };
        let mut figures = Vec::new();
        scheme.figures(state, &mut figures);
        figures.get(index).is_some_and(|&iterations| QUICK.contains(&iterations))
    }
}

/// Iterations of Newton's method in a step that counts as quick.
const QUICK: RangeInclusive<f64> = 1.0..=5.0;

/// An integrator that cannot move a scheme.
#[derive(Clone, Debug, Error, PartialEq)]
#[error(
    "the integrator `{integrator}` cannot move the scheme `{scheme}` as it is built; those that can: \
     {}",
    match able.as_slice() {
        [] => "none".to_owned(),
        able => able.iter().map(|name| format!("`{name}`")).collect::<Vec<_>>().join(", "),
    }
)]
pub struct Unserved {
    /// Name of the integrator.
    pub integrator: &'static str,
    /// Name of the scheme.
    pub scheme: &'static str,
    /// Names of the integrators that can.
    pub able: Vec<&'static str>,
}

impl Unserved {
    /// That of an integrator of this name.
    pub fn new(integrator: &'static str, scheme: &mut dyn Scheme) -> Self {
        let all = IntegratorKind::ALL.into_iter();
        let able = all.filter(|kind| kind.needs().is_offered_by(scheme));
        let able = able.map(IntegratorKind::name).collect();
        Self { integrator, able, scheme: scheme.description().name }
    }
}

/// The integrators by name.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum IntegratorKind {
    /// Two-stage TVD Runge-Kutta, Upwind (4.1).
    TvdRk2,
    /// Three-stage strong-stability-preserving Runge-Kutta, which damps what nothing else does.
    SspRk3,
    /// Kick-drift-kick, CTVF (54) to (60), for schemes that can be split and those in which nothing
    /// dissipates.
    KickDriftKick,
    /// Newmark's method, theory (53), for schemes that solve for displacements.
    Newmark,
    /// The method of Hilber, Hughes and Taylor.
    HhtAlpha,
    /// The generalised-alpha method of Chung and Hulbert.
    GeneralisedAlpha,
    /// Equilibrium under loads that grow, for schemes that know it.
    Static,
    /// Equilibrium along a path on which loads may fall, for the same.
    ArcLength,
    /// Backward Euler, Upwind (4.4), for schemes that solve for their rates.
    BackwardEuler,
    /// Crank-Nicolson, Upwind (4.5), for the same.
    CrankNicolson,
    /// What is between them, theory (55).
    Theta,
    /// The implicit midpoint rule, for the same.
    ImplicitMidpoint,
}

impl IntegratorKind {
    /// All integrators.
    pub const ALL: [Self; 12] = [
        Self::TvdRk2,
        Self::SspRk3,
        Self::KickDriftKick,
        Self::Newmark,
        Self::HhtAlpha,
        Self::GeneralisedAlpha,
        Self::Static,
        Self::ArcLength,
        Self::BackwardEuler,
        Self::CrankNicolson,
        Self::Theta,
        Self::ImplicitMidpoint,
    ];

    /// Share of the forces at the start of a step of [`Self::HhtAlpha`], unless another is asked for.
    pub const ALPHA: f64 = 0.05;

    /// What a step of [`Self::GeneralisedAlpha`] multiplies the shortest periods by, unless something
    /// else is asked for.
    pub const SPECTRAL_RADIUS: f64 = 0.8;

    /// Name in a case file.
    pub fn name(self) -> &'static str {
        match self {
            Self::TvdRk2 => "tvd_rk2",
            Self::SspRk3 => "ssp_rk3",
            Self::KickDriftKick => "kick_drift_kick",
            Self::Newmark => "newmark",
            Self::HhtAlpha => "hht_alpha",
            Self::GeneralisedAlpha => "generalised_alpha",
            Self::Static => "static",
            Self::ArcLength => "arc_length",
            Self::BackwardEuler => "backward_euler",
            Self::CrankNicolson => "crank_nicolson",
            Self::Theta => "theta",
            Self::ImplicitMidpoint => "implicit_midpoint",
        }
    }

    /// Whether nothing moves, and states are in equilibrium.
    pub fn is_static(self) -> bool {
        matches!(self, Self::Static | Self::ArcLength)
    }

    /// The integrator of that name.
    pub fn from_name(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|kind| kind.name() == name)
    }

    /// What it needs of a scheme.
    pub fn needs(self) -> Capability {
        match self {
            Self::TvdRk2 | Self::SspRk3 => Capability::Rates,
            Self::KickDriftKick => Capability::Kicks,
            Self::Newmark | Self::HhtAlpha | Self::GeneralisedAlpha => Capability::Newmark,
            Self::Static | Self::ArcLength => Capability::Statics,
            Self::BackwardEuler | Self::CrankNicolson | Self::Theta | Self::ImplicitMidpoint => {
                Capability::Theta
            }
        }
    }

    /// An integrator for `scheme`, with its usual weights.
    ///
    /// # Errors
    /// The scheme, as it is built, does not offer what the integrator needs.
    pub fn build(self, scheme: &mut dyn Scheme) -> Result<Box<dyn Integrator>, Unserved> {
        if !self.needs().is_offered_by(scheme) {
            return Err(Unserved::new(self.name(), scheme));
        }
        let length = scheme.initial_state().len();
        let theta = |rule| self.implicit(ImplicitRule::Theta(rule));
        let newmark = |rule| self.implicit(ImplicitRule::Newmark(rule));
        Ok(match self {
            Self::TvdRk2 => Box::new(RungeKutta::tvd_rk2(length)),
            Self::SspRk3 => Box::new(RungeKutta::ssp_rk3(length)),
            Self::KickDriftKick => Box::new(KickDriftKick::default()),
            Self::Static => Box::new(LoadStepping { by_arc_length: false }),
            Self::ArcLength => Box::new(LoadStepping { by_arc_length: true }),
            Self::Newmark => newmark(Newmark::AVERAGE_ACCELERATION),
            Self::HhtAlpha => newmark(Newmark::hilber_hughes_taylor(Self::ALPHA)),
            Self::GeneralisedAlpha => newmark(Newmark::generalised_alpha(Self::SPECTRAL_RADIUS)),
            Self::BackwardEuler => theta(Theta::BACKWARD_EULER),
            Self::CrankNicolson => theta(Theta::CRANK_NICOLSON),
            Self::Theta => theta(Theta::DAMPED),
            Self::ImplicitMidpoint => theta(Theta::MIDPOINT),
        })
    }

    /// An integrator for `scheme` that takes implicit steps with a rule of one's own, and keeps their
    /// errors below `error` if there is one.
    ///
    /// # Errors
    /// As [`Self::build`].
    pub fn build_with(
        self,
        rule: ImplicitRule,
        error: Option<f64>,
        scheme: &mut dyn Scheme,
    ) -> Result<Box<dyn Integrator>, Unserved> {
        if !rule.needs().is_offered_by(scheme) {
            return Err(Unserved::new(self.name(), scheme));
        }
        let plain = ImplicitStepping::new(self.name(), rule);
        let length = scheme.initial_state().len();
        Ok(Box::new(match error {
            Some(largest) => plain.with_error(largest, length),
            None => plain,
        }))
    }

    fn implicit(self, rule: ImplicitRule) -> Box<dyn Integrator> {
        Box::new(ImplicitStepping::new(self.name(), rule))
    }
}
