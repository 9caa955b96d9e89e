//! Which passes the stages of a step start on a device.

use piola_device::{DeviceError, Language};

use super::super::TransportVelocity;
use super::super::stages::{Pass, stage_of};
use super::build::LAYOUT;
use super::passes::Plan;
use super::{OfMatter, OnDevice, Own};
use crate::schemes::device::staged;
use crate::schemes::{DeviceMethod, DeviceRefusal, DeviceStage};

impl<const D: usize> Plan<D> {
    /// Names of the passes of a stage that all matter has, in their order.
    pub(super) fn passes_of<O>(&self, stage: Pass<O>) -> &'static [&'static str] {
        match stage {
            Pass::Remove if self.removes => &["escape", "tell_escaped"],
            Pass::Load => &["load"],
            Pass::Push => &["push", "push_sides", "push_on"],
            Pass::State => &["state"],
            // What moves walls is started where it changes, and what imposes it after the drift.
            Pass::Walls if self.moves => &["drive", "walls"],
            Pass::Walls => &["walls"],
            Pass::Rates => &["rates"],
            Pass::Move if self.moves => &["advance", "impose"],
            Pass::Move => &["advance"],
            Pass::Forces if self.normals > 0 => &["forces", "reactions"],
            Pass::Forces => &["forces"],
            Pass::Sharpen => &["sharpen"],
            Pass::Surfaces => &["see", "normals", "cover"],
            Pass::Reach => &["see_surfaces", "reach_surfaces"],
            Pass::Shift if self.seeks_surfaces => &["crowd", "shift"],
            Pass::Shift => &["shift"],
            Pass::HoldOff => &["hold_off"],
            Pass::Bear => &["add_holds", "bear"],
            Pass::Store => &["store"],
            // Body forces come with the forces; all others are refused.
            _ => &[],
        }
    }

    /// Names of the passes of a look over the state.
    fn passes_of_look(&self) -> &'static [&'static str] {
        match &self.room {
            Some(_) if !self.removes => &["escape", "look"],
            _ => &["look"],
        }
    }
}

impl<const D: usize, P: OfMatter<D>> OnDevice<D, P> {
    /// Starts the passes of a stage.
    pub(super) fn launch(
        &self,
        stage: Pass<Own<D, P>>,
        scalars: &[(&str, f64)],
    ) -> Result<(), DeviceError> {
        self.matter.passes_of(stage).iter().try_for_each(|pass| self.start(pass, scalars))
    }

    /// Starts those of a look over the state.
    pub(super) fn launch_look(&self) -> Result<(), DeviceError> {
        let (passes, room) = (self.matter.plan().passes_of_look(), self.room());
        passes.iter().try_for_each(|pass| self.start(pass, &room))
    }
}

/// The stages of a system on a device, with kicks before them and the look over the state behind them.
pub(in super::super) fn stages<const D: usize, P: OfMatter<D>>(
    system: &TransportVelocity<D, P::Kind>,
    language: Language,
    method: DeviceMethod,
) -> Result<Vec<DeviceStage>, DeviceRefusal> {
    let matter = P::of(system)?;
    let passes = matter.passes(method.dialect(language, LAYOUT));
    let mut all = vec![("kick", &["kick_velocities"][..])];
    for &stage in system.drift.passes().iter().chain(system.accelerate.passes()) {
        let name = stage_of::<D, P::Kind>(stage).name;
        let started = matter.passes_of(stage);
        if all.iter().all(|(known, _)| *known != name) {
            all.push((name, started));
        }
    }
    all.push(("look", matter.plan().passes_of_look()));
    Ok(staged(&passes, &all))
}
