//! The stages of a step, which say what they read of a particle and of its neighbours.

use super::{Common, Continuum, Shifting, TransportVelocity};
use crate::schemes::ledger::Totals;
use crate::schemes::stages::{Stage, StageFault, Stages};

/// A pass over particles, or one that a kind of matter alone has.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Pass<O> {
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
    /// Values of ghost particles of walls.
    Walls,
    /// Rates of density, pressure and stress.
    Rates,
    /// Particles move on with their rates.
    Move,
    /// Accelerations between particles.
    Forces,
    /// Body forces.
    BodyForces,
    /// Sharp normals of free surfaces.
    Sharpen,
    /// Smooth normals, and who is on a surface.
    Surfaces,
    /// How far surfaces are.
    Reach,
    /// SPST.
    Shift,
    /// What walls do to what touches them.
    HoldOff,
    /// What they get for it.
    Bear,
    /// Accelerations, densities and shifting go into the state, their powers into the ledger.
    Store,
    /// One of the matter.
    Own(O),
}

/// The columns of the state, the last of matter that has columns of its own. Neighbours are found by positions,
/// which all may see.
const STATE: [&str; 7] = [
    "position",
    "velocity",
    "density",
    "pressure",
    "acceleration",
    "shifting_velocity",
    "material_state",
];

/// What a drift changes of them.
const MOVED: [&str; 5] = ["position", "velocity", "density", "pressure", "material_state"];

/// What neighbours see of a particle after [`Pass::Load`].
const SIDE: [&str; 5] =
    ["side.velocity", "side.shifting_velocity", "side.density", "side.pressure", "side.material"];

/// What they see of walls of matter that has no columns of its own.
const WALL: [&str; 5] =
    ["side.velocity", "side.shifting_velocity", "side.density", "side.pressure", "shear"];

/// The columns, without the last where matter has no columns of its own.
fn of<const D: usize, M: Continuum<D>>(all: &'static [&'static str]) -> &'static [&'static str] {
    if M::HAS_MATERIAL { all } else { &all[..all.len() - 1] }
}

/// A stage with what it reads, gathers, writes and shows.
pub(super) const fn stage(
    name: &'static str,
    [reads, gathers, writes, shows]: [&'static [&'static str]; 4],
) -> Stage {
    Stage { name, reads, gathers, writes, shows }
}

/// What the pass of a kind of matter reads and writes.
pub(super) fn stage_of<const D: usize, M: Continuum<D>>(pass: Pass<M::Own>) -> Stage {
    let side = of::<D, M>(&SIDE);
    let wall: &[&str] = if M::HAS_MATERIAL { side } else { &WALL };
    let (name, columns): (_, [&[&str]; 4]) = match pass {
        Pass::Remove => {
            let all = &["position", "velocity", "density", "pressure"];
            ("remove", [all, &["position"], &[], all])
        }
        Pass::Prescribe => ("prescribe", [&["position"], &[], &[], &["velocity"]]),
        Pass::Iterate => {
            let shows = &["shifting_velocity"];
            ("iterate", [&["position", "velocity"], &["position"], &[], shows])
        }
        Pass::Load => ("load", [of::<D, M>(&STATE), &[], &[], side]),
        Pass::Push => {
            let reads = &["side.pressure", "side.density"];
            let (writes, shows) = (&["shifting_velocity"], &["side.shifting_velocity"]);
            ("push", [reads, &["side.density"], writes, shows])
        }
        Pass::State => {
            let shows = &["side.density", "side.pressure"];
            ("equation_of_state", [side, &["side.density"], &["fastest"], shows])
        }
        Pass::Walls => ("walls", [&["position"], side, &["wall_motion"], wall]),
        Pass::Rates => ("rates", [side, side, &["rates"], &[]]),
        Pass::Move => {
            ("move", [&["rates", "velocity", "shifting_velocity"], &[], &[], of::<D, M>(&MOVED)])
        }
        Pass::Forces => {
            let writes = &["forces", "crowding", "opening"];
            ("forces", [side, side, writes, &[]])
        }
        Pass::BodyForces => ("body_forces", [&["position", "forces"], &[], &["forces"], &[]]),
        Pass::Sharpen => ("sharpen", [&["opening"], &[], &[], &["sharp_normal"]]),
        Pass::Surfaces => {
            let gathers = &["side.density", "sharp_normal"];
            ("surfaces", [&["sharp_normal"], gathers, &["normal"], &["on_surface"]])
        }
        Pass::Reach => ("reach", [&["on_surface"], &["on_surface"], &["reach"], &[]]),
        Pass::Shift => {
            let reads = &["crowding", "fastest"];
            ("shift", [reads, &["side.density"], &["side.shifting_velocity"], &[]])
        }
        Pass::HoldOff => {
            let reads = &["forces", "side.velocity", "side.shifting_velocity", "wall_motion"];
            ("hold_off", [reads, &["position"], &["side.shifting_velocity"], &["barrier"]])
        }
        Pass::Bear => ("bear", [&["forces", "barrier"], &["barrier"], &["forces"], &[]]),
        Pass::Store => {
            let reads =
                &["forces", "side.density", "side.pressure", "side.shifting_velocity", "velocity"];
            let writes = &["acceleration", "density", "pressure", "shifting_velocity", "ledger"];
            ("store", [reads, &[], writes, &[]])
        }
        Pass::Own(pass) => return M::stage(pass),
    };
    stage(name, columns)
}

/// The time of a pass and the step that it belongs to, in s.
#[derive(Clone, Copy, Debug)]
pub struct Instant {
    /// The time in s.
    pub time: f64,
    /// The step in s.
    pub step: f64,
}

impl<const D: usize> Common<D> {
    /// The passes before rates are found: shifting by IPST, sides, shifting by GTVF.
    pub(super) fn spread<O>(&self) -> Vec<Pass<O>> {
        match self.settings.shifting {
            Shifting::Iterative { .. } => vec![Pass::Iterate, Pass::Load],
            Shifting::Background { .. } => vec![Pass::Load, Pass::Push],
            _ => vec![Pass::Load],
        }
    }

    /// The passes of walls, of body forces, of shifting by SPST, and of what touches walls, where there are such.
    pub(super) fn passes<O>(&self) -> [Vec<Pass<O>>; 4] {
        let shift = match (self.settings.shifting, self.settings.free_surface) {
            (Shifting::Sun { .. }, true) => {
                vec![Pass::Sharpen, Pass::Surfaces, Pass::Reach, Pass::Shift]
            }
            (Shifting::Sun { .. }, false) => vec![Pass::Shift],
            _ => Vec::new(),
        };
        let (walls, barrier) = match self.walls.is_empty() {
            true => (Vec::new(), Vec::new()),
            false => (vec![Pass::Walls], vec![Pass::HoldOff, Pass::Bear]),
        };
        let body_forces = match self.body_forces.is_empty() {
            true => Vec::new(),
            false => vec![Pass::BodyForces],
        };
        [walls, body_forces, shift, barrier]
    }
}

impl<const D: usize, M: Continuum<D>> TransportVelocity<D, M> {
    /// Puts the stages of drifts and of accelerations together.
    ///
    /// # Errors
    /// They do not fit together.
    pub(super) fn plan(&mut self) -> Result<(), StageFault> {
        let [drift, accelerate] = self.matter.passes(&self.common);
        // Without rates nothing is moved by them.
        let all = of::<D, M>(&STATE);
        let mut state = all.to_vec();
        state.extend((!drift.contains(&Pass::Rates)).then_some("rates"));
        self.drift = Stages::new("drift", &state, drift, stage_of::<D, M>)?;
        self.accelerate = Stages::new("accelerate", all, accelerate, stage_of::<D, M>)?;
        Ok(())
    }

    /// Finds the neighbours at the positions of `state` and fills what they see of each other.
    pub(super) fn load(&mut self, state: &[f64]) {
        self.matter.follow(&mut self.common, state);
        self.common.load(state);
        self.matter.make_room(&self.common);
        self.matter.load(&self.common, state);
    }

    /// Runs one pass.
    pub(super) fn run(
        &mut self,
        pass: Pass<M::Own>,
        Instant { time, step }: Instant,
        state: &mut [f64],
        totals: &mut Totals,
    ) {
        let Self { common, matter, .. } = self;
        match pass {
            Pass::Remove => {
                matter.follow(common, state);
                totals.book(M::REMOVED, &common.remove_escaped(state));
            }
            Pass::Prescribe => totals.book(M::WALLS, &matter.prescribe(common, time, state)),
            Pass::Iterate => {
                self.load(state);
                self.iterate(step, state);
            }
            Pass::Load => self.load(state),
            Pass::Push => common.push_apart(step, state),
            Pass::State => common.fastest = matter.update(common),
            Pass::Walls => common.wall_pass(matter, time),
            Pass::Rates => matter.find_rates(common, time),
            Pass::Move => {
                let sums = matter.advance(common, step, state);
                M::DRIFTING.iter().zip(&sums).for_each(|(entry, sum)| totals.book(*entry, sum));
                common.move_walls(step, time, state);
                matter.lead(common, step, time, state);
            }
            Pass::Forces => matter.find_forces(common),
            Pass::BodyForces => common.add_body_forces(time),
            Pass::Sharpen => common.sharpen(),
            Pass::Surfaces => common.mark_surfaces(),
            Pass::Reach => common.reach_surfaces(),
            Pass::Shift => common.shift(),
            Pass::HoldOff => common.hold_off(),
            Pass::Bear => common.bear(),
            Pass::Store => matter.store(common, state, totals),
            Pass::Own(pass) => matter.run(pass, common, Instant { time, step }, state, totals),
        }
    }
}
