//! Runs whose steps somebody else takes, on a device or on several ranks.
//!
//! Their state is there, and brought here where it is looked at. The formulation here knows a state once
//! it has looked at that.

use std::sync::Arc;

use piola_device::{Device, Language, Precision};

use super::Executor;
use crate::schemes::{DeviceMethod, DeviceRefusal, DeviceStage, DeviceSteps, Health, StepsError};
use crate::time::failure::Failure;
use crate::time::run::Run;
use crate::time::summary::Outcome;

impl Executor {
    /// How a device takes the steps, with this precision of pairs.
    fn method(&self, precision: Precision) -> DeviceMethod {
        DeviceMethod { integrator: self.integrator.name(), precision }
    }

    /// Lets a device take the steps from now on, with this precision of pairs.
    ///
    /// # Errors
    /// The formulation or the integrator has no steps there, or the device refuses.
    pub fn use_device(
        &mut self,
        device: Device,
        precision: Precision,
    ) -> Result<(), DeviceRefusal> {
        let steps = self.scheme.on_device(device, self.method(precision))?;
        Ok(self.use_steps(steps)?)
    }

    /// The stages of its steps on a device with their passes in a language, see
    /// [`Scheme::device_stages`](crate::schemes::Scheme::device_stages). No device is needed.
    ///
    /// # Errors
    /// The formulation or the integrator has no steps there.
    pub fn device_stages(
        &self,
        language: Language,
        precision: Precision,
    ) -> Result<Vec<DeviceStage>, DeviceRefusal> {
        self.scheme.device_stages(language, self.method(precision))
    }

    /// Lets somebody else take the steps from now on.
    ///
    /// # Errors
    /// They cannot take the state over.
    pub fn use_steps(&mut self, mut steps: Box<dyn DeviceSteps>) -> Result<(), StepsError> {
        self.bring();
        steps.put(&self.run.state)?;
        self.device = Some(steps);
        Ok(())
    }

    /// Brings the state of the moment here, if a device is ahead.
    pub(super) fn bring(&mut self) {
        if let (false, Some(device)) = (self.is_here, &self.device) {
            let fetched = device.fetch(Arc::make_mut(&mut self.run.state).as_mut_slice());
            self.is_here = true;
            if let Err(error) = fetched {
                self.lose(error.into());
            }
        }
    }

    /// Gives the state to the device, if there is one.
    pub(super) fn hand_over(&mut self) {
        if let Some(Err(error)) = self.device.as_mut().map(|it| it.put(&self.run.state)) {
            self.lose(error.into());
        }
    }

    /// Looks once over the state, wherever that is.
    pub(super) fn inspect(&mut self) -> Result<Health, Failure> {
        let (scheme, limits) = (self.scheme.as_mut(), &mut self.limits);
        let Run { tally, state, .. } = &mut self.run;
        let Some(device) = &mut self.device else {
            return Ok(tally.watches.inspect.time(|| scheme.inspect(state, limits)));
        };
        let health = tally.watches.inspect.time(|| device.inspect(limits))?;
        if health.first_escaped.is_none() {
            return Ok(health);
        }
        // Where it has gone is asked of the formulation.
        self.bring();
        Ok(self.scheme.inspect(&self.run.state, &mut self.limits))
    }

    /// Lets the formulation here look at the state, which a device or ranks have looked at: for what it has to say of that,
    /// and as figures are of neighbours at this state.
    pub(super) fn ask(&mut self) {
        if self.device.is_some() {
            self.bring();
            self.scheme.find_neighbors(&self.run.state);
            self.scheme.inspect(&self.run.state, &mut Vec::new());
        }
    }

    /// Goes back to the state before the last step, which led to a failure. What the device says if it
    /// cannot: then the run is at the last mark.
    pub(super) fn step_back(&mut self) -> Option<Failure> {
        let fetched = match &self.device {
            Some(device) => device.fetch_before(Arc::make_mut(&mut self.run.state).as_mut_slice()),
            None => {
                self.run.state = Arc::clone(&self.previous.state);
                Ok(())
            }
        };
        self.run.clock = self.previous.clock;
        let failure = Failure::from(fetched.err()?);
        self.lose(failure.clone());
        Some(failure)
    }

    /// Ends the run without its device, at the last mark.
    pub(super) fn lose(&mut self, failure: Failure) {
        let Run { clock, tally, state, due, history, .. } = &mut self.run;
        history.last().restore(clock, tally, due, Arc::make_mut(state).as_mut_slice());
        for observer in &mut self.observers {
            // What cannot be taken back is too much, and the rest is sound.
            tally.warnings.extend(observer.rewind(clock.time).err().map(|error| error.to_string()));
        }
        (self.device, self.is_here) = (None, true);
        self.outcome = Some(Outcome::Failed(failure));
    }
}
