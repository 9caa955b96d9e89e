//! From a settled fluid to its passes and columns on a device, or what has none there.

use piola_device::lists::Lists;
use piola_device::{Device, Layout, Machine, Precision};

use super::super::{AtSurface, Continuum, DensityRule, Shifting, Slip, TransportVelocity};
use super::passes::{FIGURES, FORCES, drift_terms, kick_terms, side_width};
use super::removal::Removal;
use super::{OnDevice, Plan, walls};
use crate::boundaries::BodyForce;
use crate::operators::MovingSupport;
use crate::parallel::chunk;
use crate::schemes::Scheme;
use crate::schemes::device::{
    DeviceMethod, DeviceRefusal, DeviceSteps, Gravity, StateColumn, StateColumns, fits,
};

/// Columns that may be in single precision: what neighbours see, and what is summed over them; and what neighbours read
/// most of.
pub(super) const LAYOUT: Layout = Layout {
    narrow: &[
        "side",
        "rate",
        "force",
        "summed",
        "shear",
        "hold",
        "sliding",
        "faces",
        "mark",
        "near",
        "alone",
        "surface",
        "close_by",
        "reach",
        "sharp",
        "normal",
        "crowd",
        "escaped",
        "half_force",
        "spot",
    ],
    planes: &["place", "spot", "side", "half_force", "shear", "hold"],
};

/// Whole numbers up to this one are numbers in single precision: what holds a particle has its own.
const COUNTED: usize = 1 << f32::MANTISSA_DIGITS;

/// Columns of the state with the names of their copies.
const STATE: [[&str; 2]; 6] = [
    ["position", "position_before"],
    ["velocity", "velocity_before"],
    ["deviation", "deviation_before"],
    ["kick", "kick_before"],
    ["pressure", "pressure_before"],
    ["density", "density_before"],
];

impl<const D: usize> Plan<D> {
    /// Columns beside those of the state, with their numbers a particle.
    fn scratch(&self, of_pairs: Precision) -> Vec<(&'static str, usize)> {
        let mut all = vec![
            ("place", D),
            ("side", side_width(D)),
            ("rate", 4),
            ("force", FORCES * D),
            ("escaped", 1),
            ("terms", kick_terms(D).max(drift_terms(D)).max(FIGURES)),
            // Read by the pass of rates, and of walls.
            ("half_force", D),
            ("gravity", D),
        ];
        if of_pairs == Precision::Single {
            let (counts, _) = self.space().counts(&[]);
            all.push((counts.column, counts.width));
        }
        if self.sums_densities {
            all.push(("summed", 1));
        }
        if self.normals > 0 {
            all.extend([("shear", D), ("hold", 2 * D + 1)]);
        }
        if self.seeks_surfaces {
            let marks = ["mark", "near", "alone", "surface", "close_by", "reach"];
            all.extend(marks.map(|name| (name, 1)));
            all.extend(["sharp", "normal", "crowd"].map(|name| (name, D)));
        }
        all
    }
}

/// What of a settled case has no body for devices.
fn refusal(shifting: Shifting) -> Option<DeviceRefusal> {
    let stage = match shifting {
        Shifting::Iterative { .. } => "iterate",
        Shifting::Background { .. } => "push",
        Shifting::None | Shifting::Sun { .. } => return None,
    };
    let instead = "use `scheme.shifting = \"spst\"` or \"none\"";
    Some(DeviceRefusal::Stage { what: format!("the stage `{stage}`"), instead })
}

impl<const D: usize> TransportVelocity<D> {
    /// What the passes of the fluid depend on.
    pub(super) fn device_plan(&self) -> Result<Plan<D>, DeviceRefusal> {
        let (common, fluid) = (&self.common, self.matter.fluid());
        if let Some(refusal) = refusal(common.settings.shifting) {
            return Err(refusal);
        }
        let refuse = |what: &str, instead| Err(DeviceRefusal::Stage { what: what.into(), instead });
        if common.settings.is_algebraic() {
            let instead = "use `scheme.pressure = \"edac\"`";
            return refuse("a pressure by the law of state", instead);
        }
        if self.matter.is_open() {
            return refuse("an open boundary", "run it on the processor");
        }
        if self.matter.is_damped() {
            return refuse("damping", "run it on the processor");
        }
        if common.motion.iter().next().is_some() {
            return refuse("a wall that moves", "let it slide or rest");
        }
        if !common.sliding.iter().all(|entry| entry.is_steady()) {
            return refuse("a wall that slides by a function of time", "let it slide steadily");
        }
        if !common.body_forces.iter().all(BodyForce::is_uniform) {
            let instead = "use one that is the same everywhere";
            return refuse("a body force that depends on position", instead);
        }
        let periods = *common.support.list().domain().periodic();
        let corrections = common.settings.corrections;
        let evolves = common.settings.density == DensityRule::Continuity;
        let by_crowding = matches!(common.settings.shifting, Shifting::Sun { .. });
        let (rate_constants, rate_kind) = self.matter.rate_law(common);
        let (force_constants, force_kind) = self.matter.force_law(common);
        Ok(Plan {
            kernel: common.support.kernel(),
            smoothing_length: common.support.smoothing_length(),
            periods,
            reach: (1.0 + MovingSupport::<D>::SKIN) * common.support.list().support(),
            fluid: *fluid,
            sums_densities: common.settings.density == DensityRule::Summation,
            evolves,
            carries: [corrections.density && evolves, corrections.pressure],
            rate_constants,
            rate_kind,
            force_constants,
            force_kind,
            shifts: by_crowding,
            compliance: self.matter.compliance(),
            seeks_surfaces: by_crowding && common.settings.free_surface,
            along_surfaces: common.settings.at_surface == AtSurface::Along,
            even_count: common.even_count() as f64,
            falls: !common.body_forces.is_empty(),
            normals: self.most_normals(),
            spacing: common.particles.spacing[0],
            room: common.room(&self.start),
            removes: common.guard.as_ref().is_some_and(|(guard, _)| guard.removes),
        })
    }

    /// The steps of the fluid on a device.
    pub(in super::super) fn fluid_to_device(
        &self,
        device: Device,
        method: DeviceMethod,
    ) -> Result<Box<dyn DeviceSteps>, DeviceRefusal> {
        let (common, plan) = (&self.common, self.device_plan()?);
        if method.precision == Precision::Single
            && plan.normals > 0
            && common.particles.len() > COUNTED
        {
            return Err(DeviceRefusal::Stage {
                what: "single precision with walls and more than 16777216 particles".into(),
                instead: "leave out `--precision`",
            });
        }
        let (list, periods) = (common.support.list(), plan.periods);
        let count = common.particles.len();
        let (faces, normals) = (walls::faces_width(D, plan.normals), plan.normals);
        let (layout, scratch) = (method.layout(LAYOUT), plan.scratch(method.precision));
        let columns = StateColumn::all(self.description().fields, [D, count], &STATE);
        let bytes =
            |(name, width): &(&'static str, usize)| (*name, width * count * size_of::<f64>());
        let neighbors = ("neighbours", 2 * list.entries() * size_of::<u32>());
        let all = StateColumns::bytes(&columns).chain(scratch.iter().map(bytes));
        fits(&device, layout.narrow, all.chain([neighbors]))?;
        let support = list.support();
        let skin = MovingSupport::<D>::SKIN * support;
        let removal = plan.removes.then(|| Removal::new(common));
        let is_wall = removal.as_ref().map_or(&common.is_wall, |removal| &removal.is_wall);
        let lists = Lists::new(&device, is_wall, support, skin, &periods)?;
        let passes = |dialect| plan.passes(dialect);
        let mut machine = Machine::new(device, Some(lists), layout, passes, chunk(count))?;
        let state = StateColumns::new(columns, self.start.len() - count * self.width());
        state.make(&mut machine, |_| 0)?;
        for (name, width) in scratch {
            machine.add_zeros(name, count * width)?;
        }
        machine.add("mass", &common.mass)?;
        let wall = is_wall.iter().map(|&is_wall| f64::from(u8::from(is_wall)));
        machine.add("wall", &wall.collect::<Vec<_>>())?;
        if normals > 0 {
            machine.add("faces", &self.face_numbers(faces, normals))?;
            machine.add("sliding", &self.sliding_numbers())?;
        }
        Ok(Box::new(OnDevice {
            plan,
            machine,
            drift: self.drift.clone(),
            accelerate: self.accelerate.clone(),
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
        }))
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
