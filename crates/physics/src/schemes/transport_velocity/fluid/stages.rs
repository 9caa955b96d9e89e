//! The passes of a fluid that are its own, and the order of all.

use super::{Common, DensityRule, WeaklyCompressible};
use crate::schemes::stages::Stage;
use crate::schemes::transport_velocity::stages::{Pass, stage, stage_of};

/// What corrected forces read of a particle, and what they gather of its neighbours.
const CORRECTED_READ: [&str; 6] = [
    "side.velocity",
    "side.shifting_velocity",
    "side.density",
    "side.pressure",
    "gradients",
    "neighbors",
];
const CORRECTED_SEEN: [&str; 6] = [
    "place",
    "side.velocity",
    "side.shifting_velocity",
    "side.density",
    "side.pressure",
    "gradients",
];

/// Passes of fluids alone.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Ends {
    /// Particles go through open boundaries.
    Exchange,
    /// Values of the particles in their buffers.
    Buffers,
    /// Corrections of gradients, and gradients of velocities.
    Gradients,
    /// Accelerations between particles that are conjugate to corrected gradients.
    Forces,
    /// What of the forces of walls is that of buffers.
    Part,
    /// The same of forces that are conjugate to corrected gradients.
    CorrectedPart,
    /// Motion dies out.
    Damp,
    /// By how much summation densities are above densities.
    Excess,
}

impl<const D: usize> WeaklyCompressible<D> {
    /// The passes of a drift and of an acceleration, in the order in which they run.
    pub(super) fn order(&self, common: &Common<D>) -> [Vec<Pass<Ends>>; 2] {
        let settings = &common.settings;
        let has_rates = settings.density == DensityRule::Continuity || !settings.is_algebraic();
        let [walls, body_forces, shift, barrier] = common.passes();
        let rates = if has_rates { vec![Pass::Rates] } else { Vec::new() };
        let only = |pass| if self.open.is_empty() { Vec::new() } else { vec![Pass::Own(pass)] };
        let buffers = only(Ends::Buffers);
        let drift = [common.spread(), walls.clone(), buffers.clone(), rates, vec![Pass::Move]];
        let (found, stored) = (vec![Pass::Remove, Pass::Load, Pass::State], vec![Pass::Store]);
        let forces = match settings.corrects_gradients() {
            true => vec![Pass::Own(Ends::Gradients), Pass::Own(Ends::Forces)],
            false => vec![Pass::Forces],
        };
        let part = match settings.corrects_gradients() {
            true => only(Ends::CorrectedPart),
            false => only(Ends::Part),
        };
        let exchange = only(Ends::Exchange);
        let damp = match self.damping.is_empty() {
            true => Vec::new(),
            false => vec![Pass::Own(Ends::Damp)],
        };
        let excess = match settings.relaxes() {
            true => vec![Pass::Own(Ends::Excess)],
            false => Vec::new(),
        };
        let pushed = [forces, part, body_forces, damp].concat();
        let accelerate = [exchange, found, walls, buffers, pushed, shift, excess, barrier, stored];
        [drift.concat(), accelerate.concat()]
    }
}

/// What a pass reads of a particle and gathers of its neighbours, and what it writes and shows to them.
pub(super) fn stage_of_fluid<const D: usize>(pass: Ends) -> Stage {
    match pass {
        Ends::Exchange => {
            let all = &["position", "velocity", "density", "pressure"];
            stage("exchange", [all, &[], &[], all])
        }
        Ends::Buffers => {
            let shows = &["side.velocity", "side.density", "side.pressure"];
            stage("buffers", [&["position"], shows, &["buffers"], shows])
        }
        Ends::Gradients => {
            let gathers = &["place", "side.velocity", "side.density"];
            stage("gradients", [&["neighbors", "side.velocity"], gathers, &[], &["gradients"]])
        }
        Ends::Forces => {
            let writes = stage_of::<D, WeaklyCompressible<D>>(Pass::Forces).writes;
            stage("forces", [&CORRECTED_READ, &CORRECTED_SEEN, writes, &[]])
        }
        Ends::Damp => {
            let reads = &["position", "side.velocity", "forces"];
            stage("damp", [reads, &[], &["forces", "damping"], &[]])
        }
        Ends::Excess => {
            let reads = &["forces.filling", "side.density", "surface.reach", "material_state"];
            stage("excess", [reads, &[], &["excess"], &[]])
        }
        Ends::Part => {
            let gathers = &["side.velocity", "side.density", "side.pressure"];
            stage("part", [&["forces", "buffers"], gathers, &["openings"], &[]])
        }
        Ends::CorrectedPart => {
            let reads = &["forces", "buffers", "gradients"];
            let gathers = &["side.velocity", "side.density", "side.pressure", "gradients"];
            stage("part", [reads, gathers, &["openings"], &[]])
        }
    }
}
