//! Time integration of a state that it knows only as numbers.

use super::failure::Failure;
use super::kick_drift_kick::KickDriftKick;
use super::load_steps::LoadStepping;
use super::newmark::NewmarkStepping;
use super::theta::ThetaStepping;
use super::tvd_rk2::TvdRk2;
use crate::schemes::{NEWTON_ITERATIONS, Newmark, Scheme, Theta};

/// A method that takes a state one step further.
pub trait Integrator: Send {
    /// Name in a case file.
    fn name(&self) -> &'static str;

    /// Evaluations of the rates a step.
    fn evaluations(&self) -> u64;

    /// Writes the state at `time + step` to `new`, from `old` at `time`. Both have the layout of
    /// the scheme's state; `old` satisfies the constraints at `time`.
    ///
    /// # Errors
    /// There is no such state, as far as was looked. Explicit methods always find one.
    fn step(
        &mut self,
        scheme: &mut dyn Scheme,
        time: f64,
        step: f64,
        old: &[f64],
        new: &mut [f64],
    ) -> Result<(), Failure>;

    /// Whether the step that led to `state` was found so quickly that the next may be longer, where
    /// failures have made steps shorter. Explicit methods do not know.
    fn was_quick(&self, _scheme: &dyn Scheme, _state: &[f64]) -> bool {
        false
    }
}

/// Most iterations of Newton's method in a step that counts as quick.
const QUICK: f64 = 5.0;

/// Whether a step that was solved for took few iterations, which a scheme has among its figures.
pub(super) fn took_few_iterations(scheme: &dyn Scheme, state: &[f64]) -> bool {
    let mut names = scheme.description().figures.iter();
    let Some(index) = names.position(|(name, _)| *name == NEWTON_ITERATIONS) else { return false };
    let mut figures = Vec::new();
    scheme.figures(state, &mut figures);
    figures.get(index).is_some_and(|&iterations| iterations <= QUICK)
}

/// The integrators by name.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum IntegratorKind {
    /// Two-stage TVD Runge-Kutta, Upwind (4.1).
    TvdRk2,
    /// Kick-drift-kick, CTVF (54) to (60), for schemes that can be split.
    KickDriftKick,
    /// Newmark's method, theory (53), for schemes that solve for displacements.
    Newmark,
    /// The method of Hilber, Hughes and Taylor.
    HhtAlpha,
    /// The generalised-alpha method of Chung and Hulbert.
    GeneralisedAlpha,
    /// Equilibrium under loads that grow, for schemes that know it.
    Static,
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
    pub const ALL: [Self; 10] = [
        Self::TvdRk2,
        Self::KickDriftKick,
        Self::Newmark,
        Self::HhtAlpha,
        Self::GeneralisedAlpha,
        Self::Static,
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
            Self::KickDriftKick => "kick_drift_kick",
            Self::Newmark => "newmark",
            Self::HhtAlpha => "hht_alpha",
            Self::GeneralisedAlpha => "generalised_alpha",
            Self::Static => "static",
            Self::BackwardEuler => "backward_euler",
            Self::CrankNicolson => "crank_nicolson",
            Self::Theta => "theta",
            Self::ImplicitMidpoint => "implicit_midpoint",
        }
    }

    /// The integrator of that name.
    pub fn from_name(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|kind| kind.name() == name)
    }

    /// An integrator for states of `length` numbers, with its usual weights.
    pub fn build(self, length: usize) -> Box<dyn Integrator> {
        match self {
            Self::TvdRk2 => Box::new(TvdRk2::new(length)),
            Self::KickDriftKick => Box::new(KickDriftKick),
            Self::Newmark => self.weighted(Newmark::AVERAGE_ACCELERATION),
            Self::HhtAlpha => self.weighted(Newmark::hilber_hughes_taylor(Self::ALPHA)),
            Self::GeneralisedAlpha => {
                self.weighted(Newmark::generalised_alpha(Self::SPECTRAL_RADIUS))
            }
            Self::Static => Box::new(LoadStepping),
            Self::BackwardEuler => self.shared(Theta::BACKWARD_EULER),
            Self::CrankNicolson => self.shared(Theta::CRANK_NICOLSON),
            Self::Theta => self.shared(Theta::DAMPED),
            Self::ImplicitMidpoint => self.shared(Theta::MIDPOINT),
        }
    }

    /// An integrator of implicit steps with a share of the end of one's own.
    pub fn shared(self, rule: Theta) -> Box<dyn Integrator> {
        Box::new(ThetaStepping { name: self.name(), rule })
    }

    /// An integrator of implicit steps with weights of one's own.
    pub fn weighted(self, rule: Newmark) -> Box<dyn Integrator> {
        Box::new(NewmarkStepping { name: self.name(), rule })
    }
}
