//! The choices of the transport-velocity formulation.

use piola_formulas::fluid;
pub use piola_formulas::pairs::fluid::Viscous;

/// How the density of a fluid is found, theory (20) and (26).
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum DensityRule {
    /// By the continuity equation, CTVF (25) corrected: integrated or, in a fluid with an integrated
    /// pressure, from that by the law of state.
    Continuity,
    /// As the sum of the kernel over all masses.
    Summation,
}

/// How the pressure is found, theory (21) and (25).
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum PressureRule {
    /// By integration of CTVF (26) corrected, with the diffusivity of (24).
    Edac {
        /// The factor of (24).
        alpha: f64,
    },
    /// From the density, CTVF (8).
    StateEquation,
}

/// The velocity in the divergences of continuity and pressure, and in the velocity gradients of solids.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Divergence {
    /// The momentum velocity u.
    Momentum,
    /// The transport velocity uhat.
    Transport,
}

/// What the momentum equation has of the deviation `d = uhat - u`.
///
/// The two terms of CTVF (27) leave `2 u_a d_a . sum V_b grad W_ab` of a uniform velocity, where the density is
/// uniform, too. As d goes against that sum, this is a drag, theory (22). The pairs of the first alone conserve momentum.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Momentum {
    /// Nothing.
    None,
    /// `(d . grad) u`, of differences of velocities.
    Transport,
    /// `div(rho u (x) d) / rho` of CTVF (27), which conserves momentum.
    Stress,
    /// The same with `- u div uhat`, as CTVF (27) is printed but for the softening of its viscosity.
    Paper,
}

/// What makes up for particles that do not move with their velocity.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Corrections {
    /// The velocity in the divergences; with their corrections it must be that of momentum.
    pub divergence: Divergence,
    /// `(uhat - u) . grad` of what is integrated: of the pressure, and of the density of solids.
    pub transport: bool,
    /// That of the velocity of fluids.
    pub momentum: Momentum,
}

impl Corrections {
    /// `d . grad` of pressure and velocity, as derived from CTVF (12), (18) and (23).
    pub const FULL: Self =
        Self { divergence: Divergence::Momentum, transport: true, momentum: Momentum::Transport };
    /// All terms, with the momentum equation as CTVF (27) is printed.
    pub const PAPER: Self = Self { momentum: Momentum::Paper, ..Self::FULL };
    /// No term, u in the divergences.
    pub const NONE: Self =
        Self { divergence: Divergence::Momentum, transport: false, momentum: Momentum::None };
    /// No term, uhat in the divergences: the baseline against which the paper's gain shows.
    pub const TRANSPORT_DIVERGENCE: Self = Self { divergence: Divergence::Transport, ..Self::NONE };
    /// The velocity uhat in the divergences, and the stress: GTVF. Solids have no such stress.
    pub const GENERALISED: Self = Self { momentum: Momentum::Stress, ..Self::TRANSPORT_DIVERGENCE };
    /// The stress alone, which is what earlier transport-velocity formulations have.
    pub const STRESS: Self = Self { momentum: Momentum::Stress, ..Self::NONE };

    /// The sets of corrections by their names in a case file.
    pub const ALL: [(&'static str, Self); 6] = [
        ("full", Self::FULL),
        ("paper", Self::PAPER),
        ("none", Self::NONE),
        ("transport_divergence", Self::TRANSPORT_DIVERGENCE),
        ("stress", Self::STRESS),
        ("gtvf", Self::GENERALISED),
    ];

    /// The corrections of a name.
    pub fn from_name(name: &str) -> Option<Self> {
        Self::ALL.iter().find(|(known, _)| *known == name).map(|(_, corrections)| *corrections)
    }
}

/// How particles are kept evenly spread.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Shifting {
    /// Not at all: particles move with their velocity.
    None,
    /// SPST: a velocity deviation, CTVF (35).
    Sun {
        /// Its factor; 1 is the whole of (35), 0.5 what (36) and (55) make of it.
        factor: f64,
    },
    /// IPST: an iterated displacement, CTVF (37) to (41).
    Iterative {
        /// Iteration stops where (39) falls below.
        tolerance: f64,
        /// Most passes a step.
        most_passes: u32,
    },
    /// GTVF: the push of a background pressure that goes with the size of a particle's own,
    /// theory (79).
    Background {
        /// The largest one, in units of `rho_0 c^2`.
        most: f64,
    },
}

/// How particles are shifted at free surfaces.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum AtSurface {
    /// Not on them, and near to them along them by supports that end there: CTVF (44), (45) with
    /// algorithm 1. The outermost layers then are hardly shifted.
    Held,
    /// Along them, on and near them, by whole supports. Without it the stretched face of a solid
    /// clusters and tears.
    Along,
}

/// How the gradients of fluids are taken.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Gradients {
    /// By plain sums, theory (20) to (22).
    Plain,
    /// Exactly for linear fields, with the forces that are conjugate to them, theory (109) to (112). The corrections for
    /// the transport velocity are then [`Corrections::FULL`], whatever is asked for.
    Corrected {
        /// The factor alpha of the diffusion of what velocities have beyond their linear part.
        velocity_diffusion: f64,
    },
}

/// Numerical settings of the formulation.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Settings {
    /// How the density is found.
    pub density: DensityRule,
    /// How the pressure is found.
    pub pressure: PressureRule,
    /// What makes up for the shifting.
    pub corrections: Corrections,
    /// How particles are kept evenly spread.
    pub shifting: Shifting,
    /// The form of the viscous forces of fluids.
    pub viscous: Viscous,
    /// The factor alpha of the artificial viscosity, CTVF (28).
    pub artificial_viscosity: f64,
    /// How fast the density of a fluid with free surfaces relaxes to the summation density, in units of
    /// `c/h`, theory (108).
    pub density_relaxation: f64,
    /// Whether free surfaces are looked for, CTVF (42) to (45).
    pub free_surface: bool,
    /// How particles are shifted there.
    pub at_surface: AtSurface,
    /// How the gradients of fluids are taken.
    pub gradients: Gradients,
}

impl Settings {
    /// Those of a fluid without free surfaces in a case that says nothing else.
    pub const FLUID: Self = Self {
        density: DensityRule::Continuity,
        pressure: PressureRule::Edac { alpha: 0.5 },
        corrections: Corrections::FULL,
        shifting: Shifting::Sun { factor: 1.0 },
        viscous: Viscous::Laplacian,
        artificial_viscosity: 0.0,
        density_relaxation: 0.002,
        free_surface: false,
        at_surface: AtSurface::Held,
        gradients: Gradients::Plain,
    };

    /// Those that differ with corrected gradients: particles are then so evenly distributed that their summation density
    /// may act sooner.
    pub const CORRECTED: Self = Self {
        density_relaxation: 0.01,
        gradients: Gradients::Corrected { velocity_diffusion: 0.5 },
        ..Self::FLUID
    };

    /// Whether gradients of fluids are corrected.
    pub(super) fn corrects_gradients(&self) -> bool {
        self.gradients != Gradients::Plain
    }

    /// Whether pressures follow from densities.
    pub(super) fn is_algebraic(&self) -> bool {
        self.pressure == PressureRule::StateEquation
    }

    /// Whether densities or pressures are functions of places or of each other.
    pub(super) fn sets_state(&self) -> bool {
        self.density == DensityRule::Summation || self.is_algebraic()
    }

    /// Whether densities of fluids relax to the summation density: where they are integrated, and free surfaces are
    /// found with the accelerations.
    pub(super) fn relaxes(&self) -> bool {
        let by_crowding = matches!(self.shifting, Shifting::Sun { .. });
        let is_integrated = self.density == DensityRule::Continuity;
        self.density_relaxation > 0.0 && self.free_surface && by_crowding && is_integrated
    }

    /// Diffusivity of the pressure in m^2/s, CTVF (24), for a smoothing length in m and a wave speed in
    /// m/s; zero where it does not diffuse.
    pub(super) fn diffusivity(&self, smoothing_length: f64, wave_speed: f64) -> f64 {
        match self.pressure {
            PressureRule::Edac { alpha } => {
                fluid::pressure_diffusivity(alpha, smoothing_length, wave_speed)
            }
            PressureRule::StateEquation => 0.0,
        }
    }
}

/// The one fluid of a run.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Fluid {
    /// Reference density rho0 in kg/m^3.
    pub density: f64,
    /// Artificial speed of sound c in m/s.
    pub wave_speed: f64,
    /// Kinematic viscosity in m^2/s.
    pub viscosity: f64,
}

/// What a wall does to the fluid that moves along it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Slip {
    /// Viscous forces see the velocity of CTVF (50).
    No,
    /// Viscous forces see the velocity of CTVF (48), whose tangential part is the fluid's own.
    Free,
}
