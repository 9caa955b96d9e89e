//! From a settled case to its passes and columns on a device, or what has none there.

use piola_device::lists::Lists;
use piola_device::{Device, Layout, Machine, Precision};

use super::super::{AtSurface, Continuum, DensityRule, Shifting, Slip, TransportVelocity};
use super::moving::Moving;
use super::passes::{FORCES, Plan, drift_terms, side_width};
use super::removal::Removal;
use super::{OfMatter, OnDevice, walls};
use crate::boundaries::BodyForce;
use crate::operators::MovingSupport;
use crate::parallel::chunk;
use crate::schemes::Scheme;
use crate::schemes::device::{
    DeviceMethod, DeviceRefusal, DeviceSteps, Gravity, Room, StateColumn, StateColumns, fits,
};

/// Columns that may be in single precision: what particles show to their neighbours, and sums over these. Most of what
/// they show is in planes.
#[rustfmt::skip]
pub(super) const LAYOUT: Layout = Layout {
    narrow: &[
        "side", "rate", "force", "summed", "shear", "hold", "sliding", "faces", "mark", "near",
        "alone", "surface", "close_by", "reach", "sharp", "normal", "crowd", "escaped",
        "half_force", "spot", "matter", "waves", "continuum", "tension", "correction", "filling",
        "gradients",
    ],
    planes: &[
        "place", "spot", "side", "half_force", "shear", "hold", "matter", "waves", "tension",
        "correction", "gradients",
    ],
};

/// Whole numbers up to this one are numbers in single precision: what holds a particle has its own.
const COUNTED: usize = 1 << f32::MANTISSA_DIGITS;

/// What of a settled case has no body for devices.
fn refusal(shifting: Shifting) -> Option<DeviceRefusal> {
    let instead = "use `scheme.shifting = \"spst\"`, \"background\" or \"none\"";
    matches!(shifting, Shifting::Iterative { .. })
        .then(|| DeviceRefusal::Stage { what: "the stage `iterate`".into(), instead })
}

impl<const D: usize, M: Continuum<D>> TransportVelocity<D, M> {
    /// What the passes of all matter depend on.
    ///
    /// # Errors
    /// What of the case has no steps on devices.
    pub(super) fn device_plan(&self) -> Result<Plan<D>, DeviceRefusal> {
        let common = &self.common;
        if let Some(refusal) = refusal(common.settings.shifting) {
            return Err(refusal);
        }
        let refuse = |what: &str, instead| Err(DeviceRefusal::Stage { what: what.into(), instead });
        let periodic = common.support.list().domain().periodic();
        if common.motion.iter().any(|entry| periodic[entry.component].is_some()) {
            return refuse("a wall that moves along a periodic axis", "let it slide");
        }
        if !common.sliding.iter().all(|entry| entry.is_steady()) {
            return refuse("a wall that slides by a function of time", "let it slide steadily");
        }
        if !common.body_forces.iter().all(BodyForce::is_uniform) {
            let instead = "use one that is the same everywhere";
            return refuse("a body force that depends on position", instead);
        }
        let by_crowding = matches!(common.settings.shifting, Shifting::Sun { .. });
        let smoothing_length = common.support.smoothing_length();
        let first = common.at_rest.first().copied();
        Ok(Plan {
            kernel: common.support.kernel(),
            smoothing_length,
            periods: *periodic,
            reach: (1.0 + MovingSupport::<D>::SKIN) * common.support.list().support(),
            at_rest: first.filter(|first| common.at_rest.iter().all(|other| other == first)),
            by_law: first.filter(|_| common.settings.is_algebraic() && !M::HAS_MATERIAL),
            background: match common.settings.shifting {
                Shifting::Background { most } => Some(most),
                _ => None,
            },
            sums_densities: common.settings.density == DensityRule::Summation,
            shifts: by_crowding,
            spares: common.settings.shifting != Shifting::None && common.unshifted.contains(&true),
            crowding: 1.0 / common.value_at_spacing(smoothing_length),
            seeks_surfaces: by_crowding && common.settings.free_surface,
            along_surfaces: common.settings.at_surface == AtSurface::Along,
            even_count: common.even_count() as f64,
            falls: !common.body_forces.is_empty(),
            normals: self.most_normals(),
            moves: !common.motion.is_empty(),
            spacing: common.particles.spacing[0],
            room: common.room(&self.start),
            removes: common.guard.as_ref().is_some_and(|(guard, _)| guard.removes),
            are_several: common.continua.are_several(),
            farthest: common.continua.farthest(),
            copied: Vec::new(),
            copies: Vec::new(),
        })
    }

    /// The columns of all matter beside those of the state.
    fn device_room<P: OfMatter<D, Kind = M>>(&self, plan: &Plan<D>, of_pairs: Precision) -> Room {
        let (common, count) = (&self.common, self.common.particles.len());
        let mut all = vec![
            ("place", D),
            ("side", side_width(D)),
            ("force", FORCES * D),
            ("escaped", 1),
            ("terms", plan.stored_terms::<M>().max(drift_terms(D)).max(P::FIGURES)),
            // Read by the pass of walls.
            ("gravity", D),
        ];
        if of_pairs == Precision::Single {
            let counts = plan.space().counts();
            all.push((counts.column, counts.width));
        }
        if plan.normals > 0 {
            all.push(("hold", 2 * D + 1));
        }
        if plan.background.is_some() {
            all.push(("push", D));
        }
        if plan.seeks_surfaces {
            let marks = ["mark", "near", "alone", "surface", "close_by", "reach"];
            all.extend(marks.map(|name| (name, 1)));
            all.extend(["sharp", "normal", "crowd"].map(|name| (name, D)));
        }
        if plan.are_several {
            all.push(("continuum", 1));
        }
        if plan.farthest.is_some() {
            all.push(("start", D));
        }
        let mut filled = vec![("mass", common.mass.clone())];
        if plan.moves {
            all.extend([("motion", D), ("motion_rate", D)]);
            filled.push(("driven", Moving::driven(common)));
        }
        if plan.at_rest.is_none() {
            let of = |number| {
                let at_rest = common.at_rest(number);
                [at_rest.density, at_rest.wave_speed]
            };
            filled.push(("at_rest", (0..count).flat_map(of).collect()));
        }
        if plan.spares {
            let spared = |number| f64::from(u8::from(common.is_unshifted(number)));
            filled.push(("unshifted", (0..count).map(spared).collect()));
        }
        if plan.normals > 0 {
            let width = walls::faces_width(D, plan.normals);
            filled.push(("faces", self.face_numbers(width, plan.normals)));
            filled.push(("sliding", self.sliding_numbers()));
        }
        Room {
            scratch: all.into_iter().map(|(name, width)| (name, width * count)).collect(),
            filled,
        }
    }

    /// Most normals of a wall particle.
    fn most_normals(&self) -> usize {
        let normals = self.common.walls.iter().map(|wall| wall.faces.normals().len());
        normals.max().map_or(0, |most| most.max(1))
    }

    /// The faces of wall particles as numbers, by number of the particle.
    fn face_numbers(&self, width: usize, most: usize) -> Vec<f64> {
        let mut all = vec![0.0; self.common.particles.len() * width];
        for wall in &self.common.walls {
            let (faces, row) = (&wall.faces, &mut all[wall.number as usize * width..][..width]);
            let normals = faces.normals();
            row[0] = normals.len() as f64;
            row[1] = f64::from(u8::from(wall.slip == Slip::Free));
            row[2..][..D].copy_from_slice(faces.between().as_slice());
            let own = normals.iter().zip(faces.depths()).take(most);
            for (to, (normal, depth)) in row[2 + D..].chunks_exact_mut(1 + D).zip(own) {
                to[0] = *depth;
                to[1..].copy_from_slice(normal.as_slice());
            }
        }
        all
    }

    /// Velocities with which walls slide, by number of the particle.
    fn sliding_numbers(&self) -> Vec<f64> {
        let mut all = vec![0.0; self.common.particles.len() * D];
        for entry in self.common.sliding.iter() {
            let number = self.common.walls[entry.particle].number as usize;
            all[number * D + entry.component] = entry.at(0.0);
        }
        all
    }
}

/// The steps of a system on a device.
///
/// # Errors
/// What of the case has no steps on devices, or the device refuses.
pub(in super::super) fn steps<const D: usize, P: OfMatter<D>>(
    system: &TransportVelocity<D, P::Kind>,
    device: Device,
    method: DeviceMethod,
) -> Result<Box<dyn DeviceSteps>, DeviceRefusal> {
    let (common, matter) = (&system.common, P::of(system)?);
    let (plan, count) = (matter.plan(), common.particles.len());
    if method.precision == Precision::Single && plan.normals > 0 && count > COUNTED {
        return Err(DeviceRefusal::Stage {
            what: "single precision with walls and more than 16777216 particles".into(),
            instead: "leave out `--precision`",
        });
    }
    let (list, periods, layout) = (common.support.list(), plan.periods, method.layout(LAYOUT));
    let rooms = [system.device_room::<P>(plan, method.precision), matter.room(system)];
    let columns = StateColumn::all(system.description().fields, [D, count], P::STATE);
    let neighbors = ("neighbours", 2 * list.entries() * size_of::<u32>());
    let all = StateColumns::bytes(&columns).chain(rooms.iter().flat_map(Room::bytes));
    fits(&device, layout.narrow, all.chain([neighbors]))?;
    let support = list.support();
    let skin = MovingSupport::<D>::SKIN * support;
    let removal = plan.removes.then(|| Removal::new(common));
    let is_wall = removal.as_ref().map_or(&common.is_wall, |removal| &removal.is_wall);
    let lists = Lists::new(&device, is_wall, support, skin, &periods)?;
    let passes = |dialect| matter.passes(dialect);
    let mut machine = Machine::new(device, Some(lists), layout, passes, chunk(count))?;
    let state = StateColumns::new(columns, system.start.len() - count * system.width());
    state.make(&mut machine, |_| 0)?;
    rooms.iter().try_for_each(|room| room.make(&mut machine))?;
    let wall = is_wall.iter().map(|&is_wall| f64::from(u8::from(is_wall)));
    machine.add("wall", &wall.collect::<Vec<_>>())?;
    if let Some((name, indices)) = matter.indices() {
        machine.add_indices(name, indices)?;
    }
    let moving = Moving::of(common);
    moving.iter().try_for_each(|moving| moving.add(&mut machine))?;
    Ok(Box::new(OnDevice {
        matter,
        machine,
        drift: system.drift.clone(),
        accelerate: system.accelerate.clone(),
        count,
        state,
        is_picked: false,
        is_listed: false,
        fastest: 0.0,
        speed: common.shifting_speed(),
        body_forces: common.body_forces.clone(),
        bodies: common.particles.body.clone(),
        gravity: Gravity::default(),
        removal,
        skin,
        moving,
    }))
}
