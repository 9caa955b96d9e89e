//! Which passes the stages of a step start on a device.

use piola_device::{DeviceError, Language};

use super::super::stages::{Pass, stage_of};
use super::super::{TransportVelocity, WeaklyCompressible};
use super::build::LAYOUT;
use super::{Ends, OnDevice, Plan};
use crate::schemes::device::staged;
use crate::schemes::{DeviceMethod, DeviceRefusal, DeviceStage};

impl<const D: usize> Plan<D> {
    /// Names of the passes of a stage, in their order.
    fn passes_of(&self, stage: Pass<Ends>) -> &'static [&'static str] {
        match stage {
            Pass::Remove if self.removes => &["escape", "tell_escaped"],
            Pass::Load => &["load"],
            Pass::State if self.sums_densities => &["densities", "state"],
            Pass::State => &["state"],
            Pass::Walls => &["walls"],
            Pass::Rates if self.falls => &["fall", "rates"],
            Pass::Rates => &["rates"],
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

impl<const D: usize> OnDevice<D> {
    /// Starts the passes of a stage.
    pub(super) fn launch(
        &self,
        stage: Pass<Ends>,
        scalars: &[(&str, f64)],
    ) -> Result<(), DeviceError> {
        self.plan.passes_of(stage).iter().try_for_each(|pass| self.start(pass, scalars))
    }

    /// Starts those of a look over the state.
    pub(super) fn launch_look(&self) -> Result<(), DeviceError> {
        self.plan.passes_of_look().iter().try_for_each(|pass| self.start(pass, &[]))
    }
}

impl<const D: usize> TransportVelocity<D> {
    /// The stages of the fluid on a device, with kicks before them and the look over the state behind them.
    pub(in super::super) fn fluid_stages(
        &self,
        language: Language,
        method: DeviceMethod,
    ) -> Result<Vec<DeviceStage>, DeviceRefusal> {
        let plan = self.device_plan()?;
        let passes = plan.passes(method.dialect(language, LAYOUT));
        let mut all = vec![("kick", &["kick_velocities"][..])];
        for &stage in self.drift.passes().iter().chain(self.accelerate.passes()) {
            let name = stage_of::<D, WeaklyCompressible<D>>(stage).name;
            let started = plan.passes_of(stage);
            if all.iter().all(|(known, _)| *known != name) {
                all.push((name, started));
            }
        }
        all.push(("look", plan.passes_of_look()));
        Ok(staged(&passes, &all))
    }
}
