//! The accelerations.

use piola_formulas::fluid;
use piola_formulas::pairs::Components;
use piola_formulas::pairs::corrected::{CorrectedForces, CorrectedWall, CorrectedWallForces};
use piola_formulas::pairs::fluid::{
    FULL, ForceConstants, ForceSum, ForceSums, Forces as Law, NONE, STRESS, Wall, WallForces,
};

use super::{Common, WeaklyCompressible};
use crate::Vector;
use crate::operators::{Among, MovingSupport, NeighborBlock, Sum, Term, add_at, gather};
use crate::schemes::transport_velocity::{Forces, Gradients, Momentum, Shifting};

impl<const D: usize> WeaklyCompressible<D> {
    /// Fills `forces` from the sides, without body forces. On wall particles it is the reaction
    /// of the fluid.
    pub(super) fn force_pass(&self, common: &mut Common<D>) {
        let mut forces = std::mem::take(&mut common.forces);
        let (constants, kind) = self.force_law(common);
        let corrected = common.settings.corrects_gradients();
        let fill = match kind {
            (_, false, false) if corrected => Self::gather_corrected::<false, false>,
            (_, false, true) if corrected => Self::gather_corrected::<false, true>,
            (_, true, false) if corrected => Self::gather_corrected::<true, false>,
            (_, true, true) if corrected => Self::gather_corrected::<true, true>,
            (NONE, false, false) => Self::gather_forces::<NONE, false, false>,
            (NONE, false, true) => Self::gather_forces::<NONE, false, true>,
            (NONE, true, false) => Self::gather_forces::<NONE, true, false>,
            (NONE, true, true) => Self::gather_forces::<NONE, true, true>,
            (FULL, false, false) => Self::gather_forces::<FULL, false, false>,
            (FULL, false, true) => Self::gather_forces::<FULL, false, true>,
            (FULL, true, false) => Self::gather_forces::<FULL, true, false>,
            (FULL, true, true) => Self::gather_forces::<FULL, true, true>,
            (_, false, false) => Self::gather_forces::<STRESS, false, false>,
            (_, false, true) => Self::gather_forces::<STRESS, false, true>,
            (_, true, false) => Self::gather_forces::<STRESS, true, false>,
            (_, true, true) => Self::gather_forces::<STRESS, true, true>,
        };
        fill(self, common, constants, &mut forces);
        if !common.walls.is_empty() {
            self.react(common, &constants, &mut forces);
        }
        common.forces = forces;
    }

    /// The constants of the law between particles of a fluid, and which one it is: its corrections,
    /// whether there is artificial viscosity, whether particles are shifted by SPST.
    pub(in super::super) fn force_law(
        &self,
        common: &Common<D>,
    ) -> (ForceConstants, (u8, bool, bool)) {
        let h = common.support.smoothing_length();
        let corrections = &common.settings.corrections;
        let crowding = match common.settings.shifting {
            Shifting::Sun { .. } => Some(1.0 / common.value_at_spacing(h)),
            _ => None,
        };
        let constants = ForceConstants {
            softening: fluid::softening(h),
            viscosity: self.fluid.viscosity,
            viscous: common.settings.viscous,
            artificial: common.settings.artificial_viscosity * h * self.fluid.wave_speed,
            dilatation: f64::from(u8::from(corrections.momentum == Momentum::Paper)),
            crowding: crowding.unwrap_or(0.0),
        };
        let kind = match corrections.momentum {
            Momentum::None => NONE,
            Momentum::Transport => FULL,
            Momentum::Stress | Momentum::Paper => STRESS,
        };
        (constants, (kind, constants.artificial > 0.0, crowding.is_some()))
    }

    /// nu_v of theory (111) in m^2/s, where gradients are corrected.
    pub(in super::super) fn velocity_diffusivity(&self, common: &Common<D>) -> Option<f64> {
        let (h, c) = (common.support.smoothing_length(), self.fluid.wave_speed);
        match common.settings.gradients {
            Gradients::Plain => None,
            Gradients::Corrected { velocity_diffusion } => {
                Some(fluid::pressure_diffusivity(velocity_diffusion, h, c))
            }
        }
    }

    fn gather_forces<const CORRECTS: u8, const ARTIFICIAL: bool, const CROWDING: bool>(
        &self,
        common: &Common<D>,
        constants: ForceConstants,
        forces: &mut [Forces<D>],
    ) {
        let law = Law::<D, CORRECTS, ARTIFICIAL, CROWDING>(constants);
        let sides = common.sides.as_slice();
        let fluid = Term { law, source: sides, among: Among::Active };
        let source = (sides, self.shear.as_slice());
        let walls = Term { law: WallForces(law), source, among: Among::Passive };
        fill_forces(common, &(fluid, walls), forces);
    }

    /// The same with the forces that are conjugate to corrected gradients, theory (110) and (112).
    fn gather_corrected<const ARTIFICIAL: bool, const CROWDING: bool>(
        &self,
        common: &Common<D>,
        constants: ForceConstants,
        forces: &mut [Forces<D>],
    ) {
        let plain = Law::<D, FULL, ARTIFICIAL, CROWDING>(constants);
        let law = CorrectedForces(plain, self.velocity_diffusivity(common).unwrap_or(0.0));
        let (sides, gradients) = (common.sides.as_slice(), self.gradients.as_slice());
        let fluid = Term { law, source: (sides, gradients), among: Among::Active };
        let source = ((sides, self.shear.as_slice()), gradients);
        let walls = Term { law: CorrectedWallForces(law), source, among: Among::Passive };
        fill_forces(common, &(fluid, walls), forces);
    }

    /// What pressure and viscosity of the fluid do to a particle (number), over its mass, if it is one of a wall.
    pub(super) fn wall_forces(&self, common: &Common<D>, number: usize) -> Option<[Vector<D>; 2]> {
        common.wall_of(number as u32)?;
        let place = common.support.list().places()[number] as usize;
        let wall = Wall::<D>::of(&self.force_law(common).0);
        let of = |viscosity: f64| {
            let (law, mut sum) = (Wall { viscosity, ..wall }, Vector::zeros());
            let (sides, among) = ((common.sides.as_slice(), self.shear.as_slice()), Among::Active);
            let (support, block) = (&common.support, &mut NeighborBlock::default());
            match common.settings.corrects_gradients() {
                true => {
                    let source = (sides, self.gradients.as_slice());
                    let term = Term { law: CorrectedWall(law), source, among };
                    add_at(support, &term, place, block, &mut sum);
                }
                false => {
                    let term = Term { law, source: sides, among };
                    add_at(support, &term, place, block, &mut sum);
                }
            }
            sum
        };
        let pressure = of(0.0);
        Some([pressure, of(wall.viscosity) - pressure])
    }

    /// The forces of the fluid on wall particles, over their mass: what they do to the fluid, turned
    /// round.
    fn react(&self, common: &Common<D>, constants: &ForceConstants, forces: &mut [Forces<D>]) {
        let law = Wall::<D>::of(constants);
        let (sides, among) = ((common.sides.as_slice(), self.shear.as_slice()), Among::Active);
        match common.settings.corrects_gradients() {
            true => {
                let source = (sides, self.gradients.as_slice());
                fill_reactions(common, &Term { law: CorrectedWall(law), source, among }, forces);
            }
            false => fill_reactions(common, &Term { law, source: sides, among }, forces),
        }
    }
}

/// Fills the accelerations of the fluid.
fn fill_forces<const D: usize, M: Sum<MovingSupport<D>, Sums = ForceSum<D>>>(
    common: &Common<D>,
    sum: &M,
    forces: &mut [Forces<D>],
) {
    let close = |_: usize, sums: &_, row: &mut _| *row = accelerations(sums);
    gather(&common.support, sum, forces, |place| common.active(place), close);
}

/// Fills the accelerations of walls.
fn fill_reactions<const D: usize, M: Sum<MovingSupport<D>, Sums = Components<D>>>(
    common: &Common<D>,
    sum: &M,
    forces: &mut [Forces<D>],
) {
    let close = |_: usize, walls: &Vector<D>, row: &mut _| {
        *row = Forces { walls: *walls, ..Forces::default() };
    };
    gather(&common.support, sum, forces, |place| common.passive(place), close);
}

/// The accelerations of a particle with these sums, without body forces.
fn accelerations<const D: usize>(sums: &ForceSums<f64, D>) -> Forces<D> {
    Forces {
        pressure: sums.pressure,
        viscosity: sums.viscosity,
        artificial_viscosity: sums.artificial_viscosity,
        transport: sums.carried,
        walls: sums.walls,
        body_force: Vector::zeros(),
        crowding: sums.crowding,
        opening: -sums.volume,
        filling: sums.filling,
    }
}
