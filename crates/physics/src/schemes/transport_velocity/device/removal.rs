//! Particles that have escaped and are taken out.
//!
//! In each step the device looks whether there are any. Only then the state comes here, and the code of the processor
//! takes them out of it.

use piola_device::{DeviceError, Dialect, local, own, spread, through};

use super::super::escape::take_out;
use super::super::stages::Pass;
use super::super::{Columns, ColumnsMut, Common};
use super::passes::{Plan, if_fluid};
use super::{OfMatter, OnDevice};
use crate::parallel::Team;
use crate::schemes::device::one;
use crate::schemes::ledger::Total;

/// What is known here of particles that may be taken out, by number.
pub(super) struct Removal {
    pub(super) is_wall: Vec<bool>,
    is_removed: Vec<bool>,
    /// Mass in kg and `1 / (rho0 c)^2`.
    matter: Vec<[f64; 2]>,
}

impl Removal {
    /// Of particles that are all there.
    pub(super) fn new<const D: usize>(common: &Common<D>) -> Self {
        let both = common.is_wall.iter().zip(&common.removed);
        Self {
            is_wall: both.map(|(is_wall, is_removed)| *is_wall && !is_removed).collect(),
            is_removed: vec![false; common.mass.len()],
            matter: (0..common.mass.len())
                .map(|a| [common.mass[a], common.compliance(a)])
                .collect(),
        }
    }
}

impl<const D: usize> Plan<D> {
    /// Which particles have escaped, by number, that are neither of walls nor gone.
    pub(super) fn tell_escaped(&self, dialect: Dialect) -> piola_device::Pass {
        let reads = [own("wall", 1), through("slots", "escaped", 1)];
        local(dialect, "tell_escaped", &[], &reads, &[spread("terms", 1)], |mut x| {
            let wall = one(&mut x);
            vec![if_fluid(wall, one(&mut x), 0.0.into())]
        })
    }
}

impl<const D: usize, P: OfMatter<D>> OnDevice<D, P> {
    /// Takes the columns of a state over, and who has been removed in it.
    pub(super) fn take_over(&mut self, state: &[f64]) -> Result<(), DeviceError> {
        self.state.put(&mut self.machine, state)?;
        self.moving.iter_mut().for_each(|moving| moving.put(state));
        self.is_picked = false;
        self.follow_removals(state)
    }

    /// As [`Common::follow_removals`].
    fn follow_removals(&mut self, state: &[f64]) -> Result<(), DeviceError> {
        let Some(removal) = &mut self.removal else { return Ok(()) };
        let density = Columns::<D>::of(state, self.count).density.iter();
        let is_removed: Vec<bool> = density.map(|rho| Common::<D>::is_removed(*rho)).collect();
        if is_removed == removal.is_removed {
            return Ok(());
        }
        let both = removal.is_wall.iter().zip(&is_removed);
        let passive: Vec<bool> = both.map(|(is_wall, is_out)| *is_wall || *is_out).collect();
        let numbers: Vec<f64> = passive.iter().map(|&it| f64::from(u8::from(it))).collect();
        self.machine.write("wall", &numbers)?;
        self.machine.exclude(&passive, &is_removed)?;
        removal.is_removed = is_removed;
        self.is_listed = false;
        Ok(())
    }

    /// As [`Common::remove_escaped`].
    pub(super) fn remove_escaped(&mut self) -> Result<Total, DeviceError> {
        if self.removal.is_none() {
            return Ok(Total::default());
        }
        self.load()?;
        self.launch(Pass::Remove, &self.room())?;
        let [(most, _)] = self.machine.largest(self.count)?;
        if most > 0.0 { self.take_out_escaped() } else { Ok(Total::default()) }
    }

    /// Takes out those of whom the device has told.
    fn take_out_escaped(&mut self) -> Result<Total, DeviceError> {
        let mut told = vec![0.0; self.count];
        self.machine.device().read(self.machine.column("terms"), &mut told)?;
        let mut state = vec![0.0; self.state.length()];
        self.state.give(&self.machine, &mut state)?;
        let Some(removal) = &self.removal else { return Ok(Total::default()) };
        let (mut own, _) = ColumnsMut::<D>::of(&mut state, self.count);
        if !own.position.iter().flatten().all(|x| x.is_finite()) {
            // The look over the state tells.
            return Ok(Total::default());
        }
        let escaped: Vec<usize> = (0..self.count).filter(|&number| told[number] > 0.0).collect();
        let matter = |number: usize| removal.matter[number];
        let total = Team::default().sum_in_order(take_out(&escaped, matter, &mut own));
        self.take_over(&state)?;
        Ok(total)
    }
}
