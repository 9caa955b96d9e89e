//! Walls that move as prescribed.

use piola_device::{DeviceError, Dialect, Machine, Pass, Traced, Use, local, own, through};
use piola_formulas::Number;

use super::super::escape::Room;
use super::super::extent::Extent;
use super::super::{Columns, Common};
use super::passes::Plan;
use crate::Vector;
use crate::boundaries::prescribed::PrescribedComponents;
use crate::schemes::device::{Recorded, take};

/// The ends of the boxes in which particles may be: that of walls and that around everything, low and high.
const ENDS: [[[&str; 3]; 2]; 2] = [
    [
        ["walls_low_x", "walls_low_y", "walls_low_z"],
        ["walls_high_x", "walls_high_y", "walls_high_z"],
    ],
    [
        ["bounds_low_x", "bounds_low_y", "bounds_low_z"],
        ["bounds_high_x", "bounds_high_y", "bounds_high_z"],
    ],
];

/// Their names in `D` dimensions.
pub(super) fn ends<const D: usize>() -> Vec<&'static str> {
    ENDS.iter().flatten().flat_map(|names| names[..D].iter().copied()).collect()
}

/// Walls of which some move, and where they are.
pub(super) struct Moving<const D: usize> {
    /// Velocities, by index of the wall particle.
    motion: PrescribedComponents,
    numbers: Vec<u32>,
    /// The particles that move, by number.
    driven: Vec<u32>,
    position: Vec<Vector<D>>,
    /// Half of a spacing, and how far from walls particles may be, both in m, if anybody asks.
    half: f64,
    margin: Option<f64>,
    /// Number of particles of the system.
    count: usize,
    /// The time in s of which the columns are.
    of: Option<f64>,
}

impl<const D: usize> Moving<D> {
    /// The walls of a system; nothing if none of them moves.
    pub fn of(common: &Common<D>) -> Option<Self> {
        if common.motion.is_empty() {
            return None;
        }
        let numbers: Vec<u32> = common.walls.iter().map(|wall| wall.number).collect();
        // Entries stand particle by particle.
        let mut driven: Vec<u32> =
            common.motion.iter().map(|entry| numbers[entry.particle]).collect();
        driven.dedup();
        Some(Self {
            motion: common.motion.clone(),
            numbers,
            driven,
            position: vec![Vector::zeros(); common.walls.len()],
            half: 0.5 * common.particles.spacing[0],
            margin: common.margin(),
            count: common.particles.len(),
            of: None,
        })
    }

    /// Takes the places of walls from a state.
    pub fn put(&mut self, state: &[f64]) {
        let at = Columns::<D>::of(state, self.count);
        for (position, number) in self.position.iter_mut().zip(&self.numbers) {
            *position = at.position[*number as usize];
        }
    }

    /// Which components of which particles move, by number: 1, or 0.
    pub fn driven(common: &Common<D>) -> Vec<f64> {
        let mut driven = vec![0.0; common.particles.len() * D];
        for entry in common.motion.iter() {
            driven[common.walls[entry.particle].number as usize * D + entry.component] = 1.0;
        }
        driven
    }

    /// Makes the columns of what is sent: the particles that move, and their velocities and accelerations.
    pub fn add(&self, machine: &mut Machine) -> Result<(), DeviceError> {
        machine.add_indices("moving", &self.driven)?;
        machine.add_zeros("given_motion", 2 * D * self.driven.len())
    }

    /// Sends velocities and accelerations of a time in s, where they are not there yet.
    pub fn write(&mut self, machine: &mut Machine, time: f64) -> Result<(), DeviceError> {
        let is_steady = self.motion.iter().all(|entry| entry.is_steady());
        if self.of.is_some_and(|of| is_steady || of == time) {
            return Ok(());
        }
        self.of = Some(time);
        let mut given = vec![0.0; 2 * D * self.driven.len()];
        let (mut row, mut last) = (0, None);
        for entry in self.motion.iter() {
            row += usize::from(last.is_some_and(|last| last != entry.particle));
            last = Some(entry.particle);
            let place = 2 * D * row + entry.component;
            (given[place], given[place + D]) = (entry.at(time), entry.rate(time));
        }
        machine.write("given_motion", &given)?;
        machine.start("drive", self.driven.len(), &[])
    }

    /// Moves walls as [`Common::move_walls`] does.
    pub fn drift(&mut self, step: f64, middle: f64) {
        for entry in self.motion.iter() {
            self.position[entry.particle][entry.component] += step * entry.at(middle);
        }
    }

    /// Where particles may be, for the pass that looks for those that have escaped.
    pub fn room(&self) -> Vec<(&'static str, f64)> {
        let walls = Extent::around(self.position.iter().copied());
        let Some((margin, walls)) = self.margin.zip(walls) else { return Vec::new() };
        let Room { bounds, walls } = Room::around(walls.widened(self.half), margin);
        let ends = [walls, bounds].into_iter().flat_map(|extent| [extent.low, extent.high]);
        let ends = ends.flat_map(|end| end.iter().copied().collect::<Vec<_>>());
        self::ends::<D>().into_iter().zip(ends).collect()
    }
}

impl<const D: usize> Plan<D> {
    /// The columns by number of what moves a wall particle.
    pub(super) fn of_motion(&self) -> Vec<Use> {
        if self.moves { vec![own("driven", D), own("motion", D)] } else { Vec::new() }
    }

    /// Where a wall particle is after a `step` in s, of numbers of these columns.
    pub(super) fn carried(
        &self,
        position: &Recorded<D>,
        step: Traced,
        x: &mut &[Traced],
    ) -> Recorded<D> {
        if !self.moves {
            return *position;
        }
        let (driven, motion): (Recorded<D>, Recorded<D>) = (take(x), take(x));
        Recorded::<D>::from_fn(|axis, _| {
            let next = position[axis] + step * motion[axis];
            Traced::select(driven[axis].above(0.5), next, position[axis])
        })
    }

    /// Velocities and accelerations that were sent go to the particles that move.
    pub(super) fn drive(&self, dialect: Dialect) -> Pass {
        let writes = ["motion", "motion_rate"].map(|column| through("moving", column, D));
        local(dialect, "drive", &[], &[own("given_motion", 2 * D)], &writes, |x| x.to_vec())
    }

    /// Velocities of walls are the prescribed ones.
    pub(super) fn impose(&self, dialect: Dialect) -> Pass {
        let reads = [&[own("velocity", D)], &*self.of_motion()].concat();
        local(dialect, "impose", &[], &reads, &[own("velocity", D)], |mut x| {
            let velocity: Recorded<D> = take(&mut x);
            let (driven, motion): (Recorded<D>, Recorded<D>) = (take(&mut x), take(&mut x));
            let of =
                |axis: usize| Traced::select(driven[axis].above(0.5), motion[axis], velocity[axis]);
            (0..D).map(of).collect()
        })
    }
}
