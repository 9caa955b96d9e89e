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

/// The columns of the state, the last two those of fluids or solids alone. Neighbours are found by positions,
/// which all may see.
const STATE: [&str; 8] = [
    "position",
    "velocity",
    "density",
    "pressure",
    "acceleration",
    "shifting_velocity",
    "excess",
    "material_state",
];

/// What does not change but with the list of neighbours, and that list; the last of matter that has columns of its own.
const CONSTANTS: [&str; 10] = [
    "place",
    "mass",
    "body",
    "order",
    "candidates",
    "neighbors.active",
    "neighbors.passive",
    "neighbors.summed",
    "correction",
    "tension.constants",
];

/// What a load reads.
const LOADED: [&str; 9] = [
    "mass",
    "order",
    "candidates",
    "position",
    "velocity",
    "density",
    "pressure",
    "shifting_velocity",
    "material_state",
];

/// What a drift changes of them.
const MOVED: [&str; 5] = ["position", "velocity", "density", "pressure", "material_state"];

/// What a drift reads, the last of solids, for which fluids have an excess of the summation density.
const MOVING: [&str; 10] = [
    "rates",
    "side.density",
    "mass",
    "order",
    "position",
    "velocity",
    "shifting_velocity",
    "density",
    "pressure",
    "material_state",
];

/// The same of fluids.
const FLOWING: [&str; 10] = {
    let mut all = MOVING;
    all[MOVING.len() - 1] = "excess";
    all
};

/// What they see of walls of matter that has no columns of its own.
const WALL: [&str; 5] =
    ["side.velocity", "side.shifting_velocity", "side.density", "side.pressure", "shear"];

/// What neighbours see of all matter, with columns before and columns that only some matter has.
macro_rules! sides {
    ($($before:literal),*; $($own:literal),*) => {
        &[
            $($before,)*
            "side.velocity",
            "side.shifting_velocity",
            "side.density",
            "side.pressure",
            $($own,)*
        ]
    };
}

/// The columns, without the last ones where matter has no columns of its own.
fn of<const D: usize, M: Continuum<D>>(
    all: &'static [&'static str],
    own: usize,
) -> &'static [&'static str] {
    if M::HAS_MATERIAL { all } else { &all[..all.len() - own] }
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
    let side = of::<D, M>(sides![; "side.material"], 1);
    let wall: &[&str] = if M::HAS_MATERIAL { side } else { &WALL };
    let (name, columns): (_, [&[&str]; 4]) = match pass {
        Pass::Remove => {
            let all = &["position", "velocity", "density", "pressure"];
            ("remove", [all, &["position"], &[], all])
        }
        Pass::Prescribe => ("prescribe", [&["position"], &[], &[], &["velocity"]]),
        Pass::Iterate => {
            let (reads, shows) =
                (&["position", "velocity", "neighbors.active"], &["shifting_velocity"]);
            ("iterate", [reads, &["place"], &[], shows])
        }
        Pass::Load => {
            let shows = of::<D, M>(sides!["place"; "side.material"], 1);
            ("load", [of::<D, M>(&LOADED, 1), &["place"], &["neighbors"], shows])
        }
        Pass::Push => {
            let reads = &["side.pressure", "side.density", "neighbors.active"];
            let (writes, shows) = (&["shifting_velocity"], &["side.shifting_velocity"]);
            ("push", [reads, &["place", "side.density"], writes, shows])
        }
        Pass::State => {
            let reads = of::<D, M>(sides!["neighbors.summed"; "side.material"], 1);
            let shows = &["side.density", "side.pressure"];
            ("equation_of_state", [reads, &["place", "side.density"], &["fastest"], shows])
        }
        Pass::Walls => {
            let reads = &["place", "neighbors.passive"];
            ("walls", [reads, side, &["wall_motion"], wall])
        }
        Pass::Rates => {
            let reads = of::<D, M>(sides!["neighbors.active"; "side.material"], 1);
            let gathers = sides!["place"; "side.material", "tension.constants"];
            ("rates", [reads, of::<D, M>(gathers, 2), &["rates"], &[]])
        }
        Pass::Move => {
            let reads = if M::HAS_MATERIAL { &MOVING } else { &FLOWING };
            ("move", [reads, &[], &[], of::<D, M>(&MOVED, 1)])
        }
        Pass::Forces => {
            let reads = of::<D, M>(sides!["neighbors"; "tension"], 1);
            let gathers = of::<D, M>(sides!["place"; "tension"], 1);
            let writes: &[&str] = match M::HAS_MATERIAL {
                true => &["forces", "forces.crowding", "forces.opening"],
                false => &["forces", "forces.crowding", "forces.opening", "forces.filling"],
            };
            ("forces", [reads, gathers, writes, &[]])
        }
        Pass::BodyForces => {
            ("body_forces", [&["place", "forces", "order", "body"], &[], &["forces"], &[]])
        }
        Pass::Sharpen => ("sharpen", [&["forces.opening"], &[], &[], &["surface.sharp_normal"]]),
        Pass::Surfaces => {
            let reads = &["surface.sharp_normal", "neighbors.active"];
            let gathers = &["place", "side.density", "surface.sharp_normal"];
            ("surfaces", [reads, gathers, &["surface.normal"], &["on_surface"]])
        }
        Pass::Reach => {
            let reads = &["on_surface", "neighbors.active"];
            ("reach", [reads, &["on_surface"], &["surface.reach"], &[]])
        }
        Pass::Shift => {
            let reads = &["forces.crowding", "fastest"];
            ("shift", [reads, &["side.density"], &["side.shifting_velocity"], &[]])
        }
        Pass::HoldOff => {
            let reads = &["forces", "side.velocity", "side.shifting_velocity", "wall_motion"];
            ("hold_off", [reads, &["place"], &["side.shifting_velocity"], &["barrier"]])
        }
        Pass::Bear => ("bear", [&["forces", "barrier"], &["barrier"], &["forces"], &[]]),
        Pass::Store => {
            let reads = &[
                "forces",
                "side.density",
                "side.pressure",
                "side.shifting_velocity",
                "position",
                "velocity",
                "mass",
                "order",
            ];
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
        let all = [&STATE, of::<D, M>(&CONSTANTS, 1)].concat();
        let mut state = all.clone();
        state.extend((!drift.contains(&Pass::Rates)).then_some("rates"));
        let arrays = [self.common.arrays::<M>(), self.matter.arrays()].concat();
        let arrays = (self.common.count(), &*arrays);
        self.drift = Stages::new("drift", &state, drift, stage_of::<D, M>, arrays)?;
        self.accelerate = Stages::new("accelerate", &all, accelerate, stage_of::<D, M>, arrays)?;
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
                for (entry, sum) in M::DRIFTING.iter().zip(&sums) {
                    entry.iter().for_each(|entry| totals.book(*entry, sum));
                }
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
