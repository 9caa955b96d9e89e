//! Walls of ghost particles, CTVF (46) to (53), theory (31), (32), (72).

use piola_formulas::fluid;
use piola_formulas::pairs::Record;
use piola_formulas::pairs::wall::{Extrapolation, StressExtrapolation, Surroundings};

use super::{Slip, TransportVelocity};
use crate::geometry::Faces;
use crate::operators::{Among, NeighborBlock, Term, add_at};
use crate::{Vector, parallel};

/// A particle of a wall.
#[derive(Clone, Debug)]
pub(super) struct WallParticle<const D: usize> {
    pub number: u32,
    /// The faces towards the fluid that it is behind.
    pub faces: Faces<D>,
    pub slip: Slip,
}

/// What a wall particle takes from the fluid.
#[derive(Clone, Copy, Debug)]
pub(super) struct WallValues<const D: usize> {
    /// Velocity with which the wall moves in m/s.
    pub motion: Vector<D>,
    /// Velocity with which its surface slides besides, in m/s.
    sliding: Vector<D>,
    /// Acceleration of the wall in m/s^2.
    acceleration: Vector<D>,
    velocity: Vector<D>,
    deviation: Vector<D>,
    shear: Vector<D>,
    pressure: f64,
    /// Deviatoric stress of solids in Pa, as xx, yy, zz, yz, xz, xy.
    deviator: [f64; 6],
    /// The normal towards what is around, if that slides.
    mirror: Option<Vector<D>>,
}

impl<const D: usize> Default for WallValues<D> {
    fn default() -> Self {
        let zero = Vector::zeros();
        Self {
            motion: zero,
            sliding: zero,
            acceleration: zero,
            velocity: zero,
            deviation: zero,
            shear: zero,
            pressure: 0.0,
            deviator: [0.0; 6],
            mirror: None,
        }
    }
}

impl<const D: usize> TransportVelocity<D> {
    /// Completes the sides of wall particles from those of the fluid around them.
    pub(super) fn wall_pass(&mut self, time: f64) {
        if self.walls.is_empty() {
            return;
        }
        let mut values = std::mem::take(&mut self.wall_values);
        self.move_surfaces(time, &mut values);
        parallel::for_each_chunk(&mut values, |first, rows| {
            let mut block = NeighborBlock::default();
            for (offset, row) in rows.iter_mut().enumerate() {
                self.extrapolate(&self.walls[first + offset], time, row, &mut block);
            }
        });
        for (wall, values) in self.walls.iter().zip(&values) {
            let number = wall.number as usize;
            let place = self.support.list().places()[number] as usize;
            let (density, wave_speed) =
                (self.reference_density(number), self.reference_wave_speed(number));
            let side = &mut self.sides[place];
            side.velocity = values.velocity;
            side.deviation = values.deviation;
            let pressure = values.pressure;
            side.set(self.mass[number], fluid::density(pressure, density, wave_speed), pressure);
            self.shear[place] = values.shear;
        }
        if self.solids.is_some() {
            self.stress_walls(&values);
        }
        self.wall_values = values;
    }

    /// Gives walls of solids their deviatoric stress.
    fn stress_walls(&mut self, values: &[WallValues<D>]) {
        for (index, values) in values.iter().enumerate() {
            let number = self.walls[index].number as usize;
            let place = self.support.list().places()[number] as usize;
            self.set_deviator(place, &values.deviator, values.mirror.as_ref());
        }
    }

    /// Sets velocity and acceleration of the walls themselves.
    fn move_surfaces(&self, time: f64, values: &mut [WallValues<D>]) {
        values.fill(WallValues::default());
        for entry in self.motion.iter() {
            let wall = &mut values[entry.particle];
            wall.motion[entry.component] = entry.value.value(entry.place, time);
            wall.acceleration[entry.component] = entry.value.rate(entry.place, time);
        }
        for entry in self.sliding.iter() {
            let wall = &mut values[entry.particle];
            wall.sliding[entry.component] = entry.value.value(entry.place, time);
        }
    }

    /// Interpolates the fluid at a wall particle, CTVF (46), (47), (52), and reflects its velocities,
    /// CTVF (48) to (51). Without fluid around it moves with the wall and bears no pressure.
    fn extrapolate(
        &self,
        wall: &WallParticle<D>,
        time: f64,
        values: &mut WallValues<D>,
        block: &mut NeighborBlock<D>,
    ) {
        let place = self.support.list().places()[wall.number as usize] as usize;
        let (support, sides) = (&self.support, self.sides.as_slice());
        let among = Among::Active;
        let around = match self.matter() {
            None => {
                let mut around = Surroundings::zero();
                let sum = Term { law: Extrapolation::<D>, source: sides, among };
                add_at(support, &sum, place, block, &mut around);
                around
            }
            Some(matter) => {
                let mut both = (Surroundings::zero(), values.deviator);
                let law = StressExtrapolation::<D>;
                let sum = Term { law, source: (sides, matter), among };
                add_at(support, &sum, place, block, &mut both);
                values.deviator = both.1;
                both.0
            }
        };
        let surface = values.motion + values.sliding;
        if !(around.weight > 0.0) {
            values.velocity = values.motion;
            values.shear = surface;
            return;
        }
        values.deviator.iter_mut().for_each(|stress| *stress /= around.weight);
        let gravity = self.body_force_at(wall.number as usize, place, time);
        // An edge faces the fluid that is there: what hits one of its sides must not be turned along it.
        let normal = &wall.faces.towards(&-around.arm);
        let lift = gravity - values.acceleration;
        let ghost = around.ghost([&values.motion, &values.sliding], &lift, normal);
        (values.velocity, values.deviation) = (ghost.velocity, ghost.deviation);
        values.pressure = ghost.pressure;
        values.shear = match wall.slip {
            Slip::No => ghost.dragged,
            Slip::Free => ghost.velocity,
        };
        if self.solids.is_some() {
            match wall.slip {
                // What is clamped does not slide in its gradients either.
                Slip::No => {
                    (values.velocity, values.deviation) = (values.shear, -ghost.carried);
                }
                Slip::Free => values.mirror = Some(*normal),
            }
        }
    }
}
