//! The particles on which something acts that the processor knows: tractions, pressures, prescribed motion, planes.
//!
//! They are few, and what acts on them is a function of place and time that may be anything. So their rows are kept here
//! as well, and move as those on the device do, with the same operations.

use super::super::fields::Columns;
use super::super::{Loads, TotalLagrangian};
use crate::boundaries::prescribed::PrescribedComponents;
use crate::operators::{Mirror, PlaneData};
use crate::parallel::{ExactSums, Reduce as _, Team};
use crate::schemes::ledger::Total;
use crate::schemes::outside::{Acted, prescribe, push};
use crate::{Tensor, Vector};

/// What tractions, pressures and prescribed motion do.
pub(super) struct Acting {
    pub traction: Total,
    pub pressure: Total,
    pub motion: Total,
}

/// Rows of the particles on which something acts.
pub(super) struct Listed<const D: usize> {
    /// The particles by index in memory, each once.
    pub particles: Vec<u32>,
    loads: Loads<D>,
    prescribed: PrescribedComponents,
    planes: Vec<(Mirror, usize)>,
    mass: Vec<f64>,
    reference: Vec<Vector<D>>,
    pub displacement: Vec<Vector<D>>,
    pub velocity: Vec<Vector<D>>,
    /// Accelerations, which become those for the next kick.
    pub kick: Vec<Vector<D>>,
    pub gradient: Vec<Tensor<D>>,
}

impl<const D: usize> Listed<D> {
    pub fn new(scheme: &TotalLagrangian<D>, planes: &[(Mirror, usize)]) -> Self {
        let TotalLagrangian { loads, prescribed, solid, .. } = scheme;
        let mut all: Vec<usize> = loads.loaded.iter().map(|load| load.particle).collect();
        all.extend(loads.pressed.iter().map(|part| part.particle));
        all.extend(prescribed.iter().map(|entry| entry.particle));
        all.extend(planes.iter().map(|(_, particle)| *particle));
        all.sort_unstable();
        all.dedup();
        let place = |a: usize| all.binary_search(&a).ok();
        let count = all.len();
        Self {
            loads: loads.part(place),
            prescribed: prescribed.part(place),
            planes: planes.iter().filter_map(|&(plane, on)| Some((plane, place(on)?))).collect(),
            mass: all.iter().map(|&a| solid.mass[a]).collect(),
            reference: all.iter().map(|&a| solid.particles.position[a]).collect(),
            displacement: vec![Vector::zeros(); count],
            velocity: vec![Vector::zeros(); count],
            kick: vec![Vector::zeros(); count],
            gradient: vec![Tensor::zeros(); count],
            particles: all.into_iter().map(|a| a as u32).collect(),
        }
    }

    /// Whether gradients are needed.
    pub fn is_pressed(&self) -> bool {
        !self.loads.pressed.is_empty()
    }

    /// Whether places and velocities are prescribed.
    pub fn is_moved(&self) -> bool {
        !self.prescribed.is_empty()
    }

    /// Takes the rows of a state.
    pub fn put(&mut self, at: &Columns<'_, D>) {
        for (row, &a) in self.particles.iter().enumerate() {
            let a = a as usize;
            self.displacement[row] = at.displacement[a];
            self.velocity[row] = at.velocity[a];
            self.kick[row] = at.kick[a];
        }
    }

    /// Changes velocities by the accelerations.
    pub fn kick(&mut self, duration: f64) {
        for (velocity, kick) in self.velocity.iter_mut().zip(&self.kick) {
            *velocity += kick * duration;
        }
    }

    /// Moves places on, and gives velocities that are prescribed their values at the end of the step.
    pub fn drift(&mut self, time: f64, step: f64) {
        for (displacement, velocity) in self.displacement.iter_mut().zip(&self.velocity) {
            *displacement += velocity * step;
        }
        for entry in self.prescribed.iter() {
            let (a, component) = (entry.particle, entry.component);
            let middle = entry.value.value(entry.place, time + 0.5 * step);
            self.displacement[a][component] += step * (middle - self.velocity[a][component]);
        }
        self.prescribed.impose(time + step, &mut self.velocity);
    }

    /// Lets everything act on accelerations, which become those for the next kick.
    pub fn act(&mut self, time: f64) -> Acting {
        let Self { loads, prescribed, mass, reference, displacement, velocity, kick, .. } = self;
        let particle = |a: usize| Acted {
            mass: mass[a],
            position: reference[a] + displacement[a],
            velocity: velocity[a],
        };
        let [mut traction, mut pressure, mut motion] = [const { ExactSums::NONE }; 3];
        push(loads.tractions(time), particle, kick, &mut traction);
        push(loads.pressures(time, &self.gradient), particle, kick, &mut pressure);
        prescribe(prescribed, time, particle, kick, &mut motion);
        prescribed.iter().for_each(|entry| kick[entry.particle][entry.component] = 0.0);
        let team = Team::default();
        let [mut traction, mut pressure, motion]: [Total; 3] =
            team.close_all([traction, pressure, motion]);
        let growth = |(a, force): (usize, Vector<D>)| force.dot(&kick[a]);
        let [mut of_tractions, mut of_pressures] = [const { ExactSums::NONE }; 2];
        loads.tractions(time).for_each(|load| of_tractions.add(&growth(load)));
        loads.pressures(time, &self.gradient).for_each(|load| of_pressures.add(&growth(load)));
        [traction.growth, pressure.growth] = team.close_all([of_tractions, of_pressures]);
        Acting { traction, pressure, motion }
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

impl Acting {
    /// Adds a force, with its moment, to that of prescribed motion.
    pub fn add_force(&mut self, force: &[f64]) {
        for (sum, force) in self.motion.force.iter_mut().zip(force) {
            sum.add(force);
        }
    }
}
