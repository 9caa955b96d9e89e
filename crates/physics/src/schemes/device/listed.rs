//! The particles on which something acts that the processor knows: tractions, pressures, prescribed motion.
//!
//! They are few, and what acts on them is a function of place and time that may be anything.

use piola_device::{DeviceError, Machine};

use crate::boundaries::prescribed::PrescribedComponents;
use crate::boundaries::pressure::Pressed;
use crate::boundaries::traction::Loaded;
use crate::parallel::{ExactSums, Team};
use crate::schemes::ledger::Total;
use crate::schemes::outside::{Acted, prescribe, push};
use crate::{Tensor, Vector};

/// What tractions, pressures and prescribed motion do.
pub(crate) struct Acting {
    pub traction: Total,
    pub pressure: Total,
    pub motion: Total,
}

/// Rows of the particles on which something acts.
pub(crate) struct Listed<const D: usize> {
    /// The particles by index in memory, each once.
    pub particles: Vec<u32>,
    loaded: Vec<Loaded<D>>,
    pressed: Vec<Pressed<D>>,
    pub prescribed: PrescribedComponents,
    pub mass: Vec<f64>,
    pub position: Vec<Vector<D>>,
    pub velocity: Vec<Vector<D>>,
    pub acceleration: Vec<Vector<D>>,
    /// Displacement gradients, where pressures act.
    pub gradient: Vec<Tensor<D>>,
}

impl<const D: usize> Listed<D> {
    /// Those that tractions, pressures and prescribed motion act on, and some more.
    pub fn new(
        loaded: &[Loaded<D>],
        pressed: &[Pressed<D>],
        prescribed: &PrescribedComponents,
        more: impl IntoIterator<Item = usize>,
        mass: impl Fn(usize) -> f64,
    ) -> Self {
        let mut all: Vec<usize> = loaded.iter().map(|load| load.particle).collect();
        all.extend(pressed.iter().map(|part| part.particle));
        all.extend(prescribed.iter().map(|entry| entry.particle));
        all.extend(more);
        all.sort_unstable();
        all.dedup();
        let place = |a: usize| all.binary_search(&a).ok();
        let on = |it: &Loaded<D>| Some(it.clone().on(place(it.particle)?));
        let under = |it: &Pressed<D>| Some(it.clone().on(place(it.particle)?));
        let zeros = vec![Vector::zeros(); all.len()];
        Self {
            loaded: loaded.iter().filter_map(on).collect(),
            pressed: pressed.iter().filter_map(under).collect(),
            prescribed: prescribed.part(place),
            mass: all.iter().map(|&a| mass(a)).collect(),
            position: zeros.clone(),
            velocity: zeros.clone(),
            acceleration: zeros,
            gradient: vec![Tensor::zeros(); if pressed.is_empty() { 0 } else { all.len() }],
            particles: all.into_iter().map(|a| a as u32).collect(),
        }
    }

    /// The row of a particle, if it is one of them.
    pub fn row(&self, particle: usize) -> Option<usize> {
        self.particles.binary_search(&(particle as u32)).ok()
    }

    /// Number of rows.
    pub fn len(&self) -> usize {
        self.particles.len()
    }

    /// Reads what a device shows of each row, as many numbers.
    pub fn shown(&self, machine: &Machine, width: usize) -> Result<Vec<f64>, DeviceError> {
        let mut shown = vec![0.0; self.len() * width];
        if !shown.is_empty() {
            machine.start("show", self.len(), &[])?;
            machine.device().read(machine.column("shown"), &mut shown)?;
        }
        Ok(shown)
    }

    /// Gives a device a vector of each row.
    pub fn give(&self, machine: &mut Machine, rows: &[Vector<D>]) -> Result<(), DeviceError> {
        if self.len() == 0 {
            return Ok(());
        }
        let given: Vec<f64> = rows.iter().flat_map(|row| row.iter().copied()).collect();
        machine.write("given", &given)?;
        machine.start("take", self.len(), &[])
    }

    /// Lets everything act on the accelerations at a time.
    pub fn act(&mut self, time: f64) -> Acting {
        let Self { mass, position, velocity, acceleration, .. } = self;
        let particle =
            |a: usize| Acted { mass: mass[a], position: position[a], velocity: velocity[a] };
        let [mut traction, mut pressure, mut motion] = [const { ExactSums::NONE }; 3];
        let tractions = self.loaded.iter().map(|load| (load.particle, load.force(time)));
        push(tractions, particle, acceleration, &mut traction);
        let gradient = &self.gradient;
        let force = |part: &Pressed<D>| part.force(time, &gradient[part.particle]);
        let pressures = self.pressed.iter().map(|part| (part.particle, force(part)));
        push(pressures, particle, acceleration, &mut pressure);
        prescribe(&self.prescribed, time, particle, acceleration, &mut motion);
        let [traction, pressure, motion] = Team::default().close_all([traction, pressure, motion]);
        Acting { traction, pressure, motion }
    }

    /// How fast the powers of tractions and of pressures grow as velocities change with these accelerations, W/s.
    pub fn growth(&self, time: f64) -> [f64; 2] {
        let [mut of_tractions, mut of_pressures] = [const { ExactSums::NONE }; 2];
        for load in &self.loaded {
            of_tractions.add(&load.force(time).dot(&self.acceleration[load.particle]));
        }
        for part in &self.pressed {
            let force = part.force(time, &self.gradient[part.particle]);
            of_pressures.add(&force.dot(&self.acceleration[part.particle]));
        }
        Team::default().close_all([of_tractions, of_pressures])
    }
}
