//! The stages of a step, which say what they read of a particle and of its neighbours.

use super::{DensityRule, REMOVED, Shifting, TransportVelocity, WALLS};
use crate::schemes::ledger::Totals;
use crate::schemes::stages::{Stage, StageFault, Stages};

/// A pass over particles.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Pass {
    /// Particles that have escaped are taken out.
    Remove,
    /// Prescribed velocities are set.
    Prescribe,
    /// IPST.
    Iterate,
    /// Sides are filled from the state.
    Load,
    /// The background pressure of GTVF.
    Push,
    /// Density and pressure that are functions of places or of each other.
    State,
    /// Corrections of gradients.
    Correct,
    /// Values of ghost particles of walls.
    Walls,
    /// Rates of density, pressure and stress.
    Rates,
    /// Particles move on with their rates.
    Move,
    /// Stresses that forces gather.
    Tension,
    /// Accelerations between particles.
    Forces,
    /// Body forces.
    BodyForces,
    /// Accelerations of what is prescribed.
    Hold,
    /// Sharp normals of free surfaces.
    Sharpen,
    /// Smooth normals, and who is on a surface.
    Surfaces,
    /// How far surfaces are.
    Reach,
    /// SPST.
    Shift,
    /// What walls do to fluid that touches them.
    HoldOff,
    /// What they get for it.
    Bear,
    /// Accelerations, densities and shifting go into the state, their powers into the ledger.
    Store,
}

/// The columns of the state. Neighbours are found by positions, which all may see.
const STATE: [&str; 7] = [
    "position",
    "velocity",
    "density",
    "pressure",
    "acceleration",
    "shifting_velocity",
    "material_state",
];

/// What neighbours see of a particle after [`Pass::Load`].
const SIDE: &[&str] =
    &["side.velocity", "side.shifting_velocity", "side.density", "side.pressure", "side.material"];

impl Pass {
    /// The name of its stage.
    pub fn name(self) -> &'static str {
        self.stage().name
    }

    /// What the pass reads and writes.
    fn stage(self) -> Stage {
        let stage =
            |name, reads, gathers, writes, shows| Stage { name, reads, gathers, writes, shows };
        match self {
            Self::Remove => {
                let all = &["position", "velocity", "density", "pressure"];
                stage("remove", all, &["position"], &[], all)
            }
            Self::Prescribe => stage("prescribe", &["position"], &[], &[], &["velocity"]),
            Self::Iterate => {
                let shifted = &["shifting_velocity"];
                stage("iterate", &["position", "velocity"], &["position"], &[], shifted)
            }
            Self::Load => stage("load", &STATE, &[], &[], SIDE),
            Self::Push => stage(
                "push",
                &["side.pressure", "side.density"],
                &["side.density"],
                &["shifting_velocity"],
                &["side.shifting_velocity"],
            ),
            Self::State => stage(
                "equation_of_state",
                &["side.density", "side.pressure", "side.material"],
                &["side.density"],
                &["fastest"],
                &["side.density", "side.pressure"],
            ),
            Self::Correct => stage("correct", &[], &["side.density"], &["correction"], &[]),
            Self::Walls => {
                let shown = &[
                    "side.velocity",
                    "side.shifting_velocity",
                    "side.density",
                    "side.pressure",
                    "side.material",
                    "shear",
                ];
                stage("walls", &["position"], SIDE, &["wall_motion"], shown)
            }
            Self::Rates => stage("rates", SIDE, SIDE, &["rates"], &[]),
            Self::Move => {
                let moved = &["position", "density", "pressure", "material_state"];
                stage("move", &["rates", "velocity", "shifting_velocity"], &[], &[], moved)
            }
            Self::Tension => {
                stage("tension", &["side.pressure", "side.material"], &[], &[], &["tension"])
            }
            Self::Forces => stage("forces", SIDE, SIDE, &["forces", "crowding", "opening"], &[]),
            Self::BodyForces => {
                stage("body_forces", &["position", "forces"], &[], &["forces"], &[])
            }
            Self::Hold => stage("hold", &["forces"], &[], &["forces"], &[]),
            Self::Sharpen => stage("sharpen", &["opening"], &[], &[], &["sharp_normal"]),
            Self::Surfaces => {
                let gathers = &["side.density", "sharp_normal"];
                stage("surfaces", &["sharp_normal"], gathers, &["normal"], &["on_surface"])
            }
            Self::Reach => stage("reach", &["on_surface"], &["on_surface"], &["reach"], &[]),
            Self::Shift => stage(
                "shift",
                &["crowding", "fastest"],
                &["side.density"],
                &[],
                &["side.shifting_velocity"],
            ),
            Self::HoldOff => stage(
                "hold_off",
                &["forces", "side.velocity", "side.shifting_velocity", "wall_motion"],
                &["position"],
                &[],
                &["barrier", "side.shifting_velocity"],
            ),
            Self::Bear => stage("bear", &["forces", "barrier"], &["barrier"], &["forces"], &[]),
            Self::Store => stage(
                "store",
                &["forces", "side.density", "side.pressure", "side.shifting_velocity", "velocity"],
                &[],
                &["acceleration", "density", "pressure", "shifting_velocity", "ledger"],
                &[],
            ),
        }
    }
}

/// The time of a pass and the step that it belongs to, in s.
#[derive(Clone, Copy, Debug)]
pub(super) struct Instant {
    pub time: f64,
    pub step: f64,
}

impl<const D: usize> TransportVelocity<D> {
    /// Puts the stages of drifts and of accelerations together.
    ///
    /// # Errors
    /// They do not fit together.
    pub(super) fn plan(&mut self) -> Result<(), StageFault> {
        let (settings, solids) = (&self.settings, self.solids.as_deref());
        let (is_solid, has_walls) = (solids.is_some(), !self.walls.is_empty());
        let is_corrected = solids.is_some_and(|solids| solids.is_corrected());
        let is_fixed = solids.is_some_and(|solids| solids.is_fixed());
        let by_crowding = matches!(settings.shifting, Shifting::Sun { .. });
        let by_iteration = matches!(settings.shifting, Shifting::Iterative { .. });
        let by_background = matches!(settings.shifting, Shifting::Background { .. });
        let seeks_surfaces = by_crowding && settings.free_surface;
        let has_rates =
            is_solid || settings.density == DensityRule::Continuity || !settings.is_algebraic();
        let touches = !self.holds.is_empty();
        let keep = |all: &[(Pass, bool)]| -> Vec<Pass> {
            all.iter().filter(|(_, is_on)| *is_on).map(|(pass, _)| *pass).collect()
        };
        let drift = keep(&[
            (Pass::Prescribe, is_fixed),
            (Pass::Iterate, by_iteration),
            (Pass::Load, true),
            (Pass::Push, by_background),
            (Pass::Correct, is_corrected),
            (Pass::Walls, has_walls),
            (Pass::Rates, has_rates),
            (Pass::Move, true),
        ]);
        let accelerate = keep(&[
            (Pass::Remove, true),
            (Pass::Load, true),
            (Pass::State, true),
            (Pass::Correct, is_corrected),
            (Pass::Walls, has_walls),
            (Pass::Tension, is_solid),
            (Pass::Forces, true),
            (Pass::BodyForces, !self.body_forces.is_empty()),
            (Pass::Hold, is_fixed),
            (Pass::Sharpen, seeks_surfaces),
            (Pass::Surfaces, seeks_surfaces),
            (Pass::Reach, seeks_surfaces),
            (Pass::Shift, by_crowding),
            (Pass::HoldOff, touches),
            (Pass::Bear, touches),
            (Pass::Store, true),
        ]);
        // Without rates nothing is moved by them.
        let mut state = STATE.to_vec();
        state.extend((!has_rates).then_some("rates"));
        self.drift = Stages::new("drift", &state, drift, Pass::stage)?;
        self.accelerate = Stages::new("accelerate", &STATE, accelerate, Pass::stage)?;
        Ok(())
    }

    /// Runs one pass.
    pub(super) fn run(
        &mut self,
        pass: Pass,
        Instant { time, step }: Instant,
        state: &mut [f64],
        totals: &mut Totals,
    ) {
        match pass {
            Pass::Remove => totals.book(REMOVED, &self.remove_escaped(state)),
            Pass::Prescribe => totals.book(WALLS, &self.hold_velocities(time, state)),
            Pass::Iterate => self.iterate_positions(step, state),
            Pass::Load => self.load(state),
            Pass::Push => self.push_apart(step, state),
            Pass::State => self.fastest = self.update_density_and_pressure(),
            Pass::Correct => self.correct_gradients(),
            Pass::Walls => self.wall_pass(time),
            Pass::Rates => self.rate_pass(time),
            Pass::Move => self.move_particles(time, step, state, totals),
            Pass::Tension => self.tension_pass(),
            Pass::Forces => self.force_pass(),
            Pass::BodyForces => self.add_body_forces(time),
            Pass::Hold => self.hold_accelerations(),
            Pass::Sharpen => self.sharpen(),
            Pass::Surfaces => self.mark_surfaces(),
            Pass::Reach => self.reach_surfaces(),
            Pass::Shift => self.shift(),
            Pass::HoldOff => self.hold_off(),
            Pass::Bear => self.bear(),
            Pass::Store => self.store_all(state, totals),
        }
    }
}
