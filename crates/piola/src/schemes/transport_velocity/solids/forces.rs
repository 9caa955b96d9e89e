//! Accelerations of solids.

use piola_formulas::fluid;
use piola_formulas::pairs::One;
use piola_formulas::pairs::solid::{
    ForceConstants, ForceSums, Forces as Law, ONE, PUSH, SPRINGS, Wall, WallForces,
};

use super::{Contact, Solids};
use crate::Vector;
use crate::operators::{Among, Same, Source, Term, gather};
use crate::schemes::transport_velocity::{Forces, Shifting, TransportVelocity};

impl<const D: usize> TransportVelocity<D> {
    /// Fills the accelerations of solids, without body forces: theory (73) to (75).
    pub(in super::super) fn solid_force_pass(&mut self) {
        let mut forces = std::mem::take(&mut self.forces);
        let Some(solids) = self.solids.as_deref() else { return };
        let h = self.support.smoothing_length();
        let spacing = self.particles.spacing[0];
        let artificial = self.settings.artificial_viscosity * h;
        let crowding = match self.settings.shifting {
            Shifting::Sun { .. } => 1.0 / self.value_at_spacing(h),
            _ => 0.0,
        };
        let constants = ForceConstants {
            softening: fluid::softening(h),
            artificial,
            artificial_apart: match solids.contact {
                Contact::Penalty { .. } => 0.0,
                _ => artificial,
            },
            penalty: match solids.contact {
                Contact::Penalty { stiffness } => stiffness * spacing.powi(D as i32 - 2),
                _ => 0.0,
            },
            spacing,
            crowding,
        };
        let contact = match (self.continua.are_several(), solids.contact) {
            (true, Contact::Repulsive) => PUSH,
            (true, Contact::Penalty { .. }) => SPRINGS,
            _ => ONE,
        };
        let is_plain = solids.corrections.is_empty() && solids.is_uniform();
        let own = &self.continua;
        match (is_plain, contact) {
            (true, ONE) => self.stress::<true, ONE>(solids, constants, Same(1.0), &mut forces),
            (true, PUSH) => self.stress::<true, PUSH>(solids, constants, own, &mut forces),
            (true, _) => self.stress::<true, SPRINGS>(solids, constants, own, &mut forces),
            (false, ONE) => self.stress::<false, ONE>(solids, constants, Same(1.0), &mut forces),
            (false, PUSH) => self.stress::<false, PUSH>(solids, constants, own, &mut forces),
            (false, _) => self.stress::<false, SPRINGS>(solids, constants, own, &mut forces),
        }
        self.forces = forces;
    }

    fn stress<const PLAIN: bool, const CONTACT: u8>(
        &self,
        solids: &Solids<D>,
        constants: ForceConstants,
        own: impl Source<One> + Copy,
        forces: &mut [Forces<D>],
    ) {
        let law = Law::<D, PLAIN, CONTACT>(constants);
        let sides = (self.sides.as_slice(), solids.tensions.as_slice());
        let bodies = Term { law, source: (sides, own), among: Among::Active };
        let source = (sides, Same(1.0));
        let walls = Term { law: WallForces(law), source, among: Among::Passive };
        let close = |place: usize, sums: &ForceSums<f64, D>, row: &mut _| {
            let (side, share) = (&self.sides[place], solids.tensions[place].share);
            let contact = if constants.penalty > 0.0 { 1.0 / side.mass() } else { 1.0 };
            *row = Forces {
                pressure: sums.stress * share + sums.contact * contact,
                artificial_viscosity: sums.artificial,
                walls: sums.walls * share,
                crowding: sums.crowding,
                opening: -sums.volume,
                ..Forces::default()
            };
        };
        gather(&self.support, &(bodies, walls), forces, |place| self.active(place), close);
        if self.walls.is_empty() {
            return;
        }
        // The force of solids on wall particles, over their mass.
        let wall = Term { law: Wall::<D>, source: sides, among: Among::Active };
        let close = |place: usize, pull: &Vector<D>, row: &mut _| {
            let walls = pull * solids.tensions[place].share;
            *row = Forces { walls, ..Forces::default() };
        };
        gather(&self.support, &wall, forces, |place| self.passive(place), close);
    }
}
