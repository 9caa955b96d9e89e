//! The names that a case file can use: kernels, integrators, fields and columns of tables.
//!
//! They come from the registries themselves, so that a new entry there is known here.

use piola_formulas::kernels::Kernel;

use super::finished;
use super::spec::Choice;
use crate::fields::FieldDescription;
use crate::observe;
use crate::observe::reduce::{REDUCTIONS, ReductionEntry};
use crate::schemes::{SchemeDescription, momentum_components};
use crate::time::IntegratorKind;

/// The kernels.
pub fn kernels() -> Vec<Choice> {
    let meaning = |kernel: &Kernel| match kernel.support_over_h() {
        1.0 => "support radius h",
        2.0 => "support radius 2 h",
        3.0 => "support radius 3 h",
        _ => "support radius of its own",
    };
    Kernel::ALL
        .iter()
        .map(|kernel| Choice { name: kernel.name(), meaning: meaning(kernel) })
        .collect()
}

/// The time integrators.
pub fn integrators() -> Vec<Choice> {
    let meaning = |kind: IntegratorKind| match kind {
        IntegratorKind::TvdRk2 => "explicit two-stage TVD Runge-Kutta, Upwind (4.1)",
        IntegratorKind::SspRk3 => {
            "explicit three-stage strong-stability-preserving Runge-Kutta, of third order, which damps modes that nothing else damps; `upwind` and `total_lagrangian` only"
        }
        IntegratorKind::KickDriftKick => {
            "kick-drift-kick, CTVF (54) to (60); with `upwind` only where `tau_velocity` and `tau_pressure` are 0"
        }
        IntegratorKind::Newmark => {
            "Newmark's method, implicit, with `beta` and `gamma`; `total_lagrangian` only"
        }
        IntegratorKind::HhtAlpha => {
            "method of Hilber, Hughes and Taylor, implicit, which damps short periods by `alpha`; `total_lagrangian` only"
        }
        IntegratorKind::GeneralisedAlpha => {
            "generalised-alpha, implicit, which damps short periods by `spectral_radius` and long ones least; `total_lagrangian` only"
        }
        IntegratorKind::Static => {
            "no motion: equilibrium under loads that grow with time, which is the load factor; `total_lagrangian` only"
        }
        IntegratorKind::ArcLength => {
            "no motion, and loads may fall: steps along the path of stable or unstable equilibria, with its length as time. In the first step the time is the load factor, which is `step.load_factor` from then on, and `t` in loads and boundaries; `total_lagrangian` only"
        }
        IntegratorKind::BackwardEuler => {
            "backward Euler, implicit, of first order, which strongly damps short periods, Upwind (4.4); `upwind` only"
        }
        IntegratorKind::CrankNicolson => {
            "Crank-Nicolson, implicit, of second order and without damping, Upwind (4.5); `upwind` only"
        }
        IntegratorKind::Theta => "between these two, implicit, with `theta`; `upwind` only",
        IntegratorKind::ImplicitMidpoint => {
            "the implicit midpoint rule, of second order and without damping; `upwind` only"
        }
    };
    IntegratorKind::ALL.map(|kind| Choice { name: kind.name(), meaning: meaning(kind) }).to_vec()
}

/// The reductions of a history to one number.
pub fn reductions() -> Vec<Choice> {
    let choice = |entry: &ReductionEntry| Choice { name: entry.name, meaning: entry.meaning };
    REDUCTIONS.iter().map(choice).collect()
}

/// A formulation, if there is one of the name that the case has.
pub type Described = Option<&'static SchemeDescription>;

/// The fields of a scheme.
pub fn fields(scheme: Described) -> Vec<FieldDescription> {
    scheme.map_or_else(Vec::new, |scheme| scheme.shown().copied().collect())
}

/// Columns of the energy table, after `energy.`.
pub fn energy_columns(scheme: Described) -> Vec<&'static str> {
    scheme.map_or_else(Vec::new, |s| observe::energy_columns(s.energies, s.ledger.mechanisms))
}

/// Columns of the momentum table in `dimension` dimensions, after `momentum.`.
pub fn momentum_columns(scheme: Described, dimension: usize) -> Vec<String> {
    let columns = scheme.map(|scheme| {
        observe::momentum_columns(momentum_components(dimension), scheme.ledger.impulses)
    });
    columns.into_iter().flatten().map(|(name, _)| name).collect()
}

/// Columns of the table of steps, after `step.`.
pub fn step_columns(scheme: Described) -> Vec<&'static str> {
    let figures = scheme.map_or(&[][..], |scheme| scheme.figures);
    observe::STEP_COLUMNS.iter().chain(figures).map(|(name, _)| *name).collect()
}

/// Numbers of the run as a whole, after `run.`.
pub const RUN_COLUMNS: &[&str] = &finished::RUN_QUANTITIES;
