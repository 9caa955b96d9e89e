//! Accelerations of self.

use piola_formulas::fluid;
use piola_formulas::pairs::One;
use piola_formulas::pairs::solid::{
    ForceConstants, ForceSums, Forces as Law, ONE, PUSH, SPRINGS, Wall, WallForces,
};

use super::{Common, Contact, Hypoelastic};
use crate::Vector;
use crate::operators::{Among, Same, Source, Term, gather};
use crate::schemes::transport_velocity::{Forces, Shifting};

impl<const D: usize> Hypoelastic<D> {
    /// The constants of the law of forces, and which law it is: whether it is plain, and what bodies do to each other.
    pub(in super::super) fn force_law(&self, common: &Common<D>) -> (ForceConstants, (bool, u8)) {
        let h = common.support.smoothing_length();
        let spacing = common.particles.spacing[0];
        let artificial = common.settings.artificial_viscosity * h;
        let crowding = match common.settings.shifting {
            Shifting::Sun { .. } => 1.0 / common.value_at_spacing(h),
            _ => 0.0,
        };
        let constants = ForceConstants {
            softening: fluid::softening(h),
            artificial,
            artificial_apart: match self.contact {
                Contact::Penalty { .. } => 0.0,
                _ => artificial,
            },
            penalty: match self.contact {
                Contact::Penalty { stiffness } => stiffness * spacing.powi(D as i32 - 2),
                _ => 0.0,
            },
            spacing,
            crowding,
        };
        let contact = match (common.continua.are_several(), self.contact) {
            (true, Contact::Repulsive) => PUSH,
            (true, Contact::Penalty { .. }) => SPRINGS,
            _ => ONE,
        };
        let is_plain = self.corrections.is_empty() && self.is_uniform();
        (constants, (is_plain, contact))
    }

    /// Fills the accelerations of solids, without body forces: theory (73) to (75).
    pub(super) fn force_pass(&self, common: &mut Common<D>) {
        let mut forces = std::mem::take(&mut common.forces);
        let (constants, (is_plain, contact)) = self.force_law(common);
        let own = &common.continua;
        match (is_plain, contact) {
            (true, ONE) => self.stress::<true, ONE>(common, constants, Same(1.0), &mut forces),
            (true, PUSH) => self.stress::<true, PUSH>(common, constants, own, &mut forces),
            (true, _) => self.stress::<true, SPRINGS>(common, constants, own, &mut forces),
            (false, ONE) => self.stress::<false, ONE>(common, constants, Same(1.0), &mut forces),
            (false, PUSH) => self.stress::<false, PUSH>(common, constants, own, &mut forces),
            (false, _) => self.stress::<false, SPRINGS>(common, constants, own, &mut forces),
        }
        common.forces = forces;
    }

    fn stress<const PLAIN: bool, const CONTACT: u8>(
        &self,
        common: &Common<D>,
        constants: ForceConstants,
        own: impl Source<One> + Copy,
        forces: &mut [Forces<D>],
    ) {
        let law = Law::<D, PLAIN, CONTACT>(constants);
        let sides = (common.sides.as_slice(), self.tensions.as_slice());
        let bodies = Term { law, source: (sides, own), among: Among::Active };
        let source = (sides, Same(1.0));
        let walls = Term { law: WallForces(law), source, among: Among::Passive };
        let close = |place: usize, sums: &ForceSums<f64, D>, row: &mut _| {
            let (side, share) = (&common.sides[place], self.tensions[place].share);
            let [pressure, walls] = sums.accelerations(share, side.mass(), &constants);
            *row = Forces {
                pressure,
                artificial_viscosity: sums.artificial,
                walls,
                crowding: sums.crowding,
                opening: -sums.volume,
                ..Forces::default()
            };
        };
        gather(&common.support, &(bodies, walls), forces, |place| common.active(place), close);
        if common.walls.is_empty() {
            return;
        }
        // The force of solids on wall particles, over their mass.
        let wall = Term { law: Wall::<D>, source: sides, among: Among::Active };
        let close = |place: usize, pull: &Vector<D>, row: &mut _| {
            let walls = pull * self.tensions[place].share;
            *row = Forces { walls, ..Forces::default() };
        };
        gather(&common.support, &wall, forces, |place| common.passive(place), close);
    }
}
