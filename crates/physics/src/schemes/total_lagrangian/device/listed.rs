//! The rows of particles on which something acts, as they move on.
//!
//! They move here as those on the device do, with the same operations, so that nothing has to be fetched to prescribe
//! the motion of the next step.

use super::super::TotalLagrangian;
use super::super::fields::Columns;
use crate::Vector;
use crate::operators::{Mirror, PlaneData};
use crate::schemes::device::{Acting, Listed};

/// Rows of the particles on which something acts, or that planes are known by.
pub(super) struct Followed<const D: usize> {
    pub listed: Listed<D>,
    planes: Vec<(Mirror, usize)>,
    reference: Vec<Vector<D>>,
    pub displacement: Vec<Vector<D>>,
}

impl<const D: usize> Followed<D> {
    pub fn new(scheme: &TotalLagrangian<D>, planes: &[(Mirror, usize)]) -> Self {
        let TotalLagrangian { loads, prescribed, solid, .. } = scheme;
        let on_planes = planes.iter().map(|(_, particle)| *particle);
        let mass = |a: usize| solid.mass[a];
        let listed = Listed::new(&loads.loaded, &loads.pressed, prescribed, on_planes, mass);
        let row = |&(plane, on): &(Mirror, usize)| Some((plane, listed.row(on)?));
        let place = |&a: &u32| solid.particles.position[a as usize];
        Self {
            planes: planes.iter().filter_map(row).collect(),
            reference: listed.particles.iter().map(place).collect(),
            displacement: vec![Vector::zeros(); listed.len()],
            listed,
        }
    }

    /// Takes the rows of a state.
    pub fn put(&mut self, at: &Columns<'_, D>) {
        for (row, &a) in self.listed.particles.iter().enumerate() {
            let a = a as usize;
            self.displacement[row] = at.displacement[a];
            self.listed.velocity[row] = at.velocity[a];
            self.listed.acceleration[row] = at.kick[a];
        }
    }

    /// Changes velocities by the accelerations.
    pub fn kick(&mut self, duration: f64) {
        let Listed { velocity, acceleration, .. } = &mut self.listed;
        for (velocity, kick) in velocity.iter_mut().zip(acceleration) {
            *velocity += *kick * duration;
        }
    }

    /// Moves places on, and gives velocities that are prescribed their values at the end of the step.
    pub fn drift(&mut self, time: f64, step: f64) {
        let Listed { velocity, prescribed, .. } = &mut self.listed;
        for (displacement, velocity) in self.displacement.iter_mut().zip(&*velocity) {
            *displacement += velocity * step;
        }
        for entry in prescribed.iter() {
            let (a, component) = (entry.particle, entry.component);
            let middle = entry.at(time + 0.5 * step);
            self.displacement[a][component] += step * (middle - velocity[a][component]);
        }
        prescribed.impose(time + step, velocity);
    }

    /// Lets everything act on accelerations, which become those for the next kick.
    pub fn act(&mut self, time: f64) -> Acting {
        for (position, (place, displacement)) in
            self.listed.position.iter_mut().zip(self.reference.iter().zip(&self.displacement))
        {
            *position = place + displacement;
        }
        let mut acting = self.listed.act(time);
        let Listed { prescribed, acceleration, .. } = &mut self.listed;
        prescribed.iter().for_each(|entry| acceleration[entry.particle][entry.component] = 0.0);
        [acting.traction.growth, acting.pressure.growth] = self.listed.growth(time);
        acting
    }

    /// The components across planes of displacements, or of velocities.
    pub fn plane_data(&self, field: &[Vector<D>]) -> PlaneData<D> {
        let mut data = [[0.0; 2]; D];
        for (mirror, row) in &self.planes {
            data[mirror.axis][usize::from(mirror.is_upper)] = field[*row][mirror.axis];
        }
        data
    }
}
