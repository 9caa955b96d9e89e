//! What a formulation offers to a device, and what whoever takes its steps elsewhere offers to a run.

mod listed;
mod memory;
mod numbers;
pub(crate) mod solid;
mod state;

use piola_device::{DeviceError, Dialect, Language, Layout, Pass, Precision};
use piola_ranks::RankError;
use thiserror::Error;

use super::split::KICK_DRIFT_KICK;
use super::{Health, Inaccurate, NoSolution, Phase, RankCosts, StepLimit};
use crate::solve::Costs;

pub(crate) use listed::{Acting, Listed};
pub(crate) use memory::{Room, fits};
pub(crate) use numbers::{
    Recorded, are_finite, by_kind, entries, one, sighted, square, take, tensor,
};
pub(crate) use state::{Gravity, StateColumn, StateColumns};

/// Why steps that are taken elsewhere cannot go on.
#[derive(Clone, Debug, Error, PartialEq)]
pub enum StepsError {
    /// The device refuses.
    #[error(transparent)]
    Device(#[from] DeviceError),
    /// A rank is lost.
    #[error(transparent)]
    Ranks(#[from] RankError),
    /// The equations of a step have no solution.
    #[error("{0}")]
    NoSolution(NoSolution),
    /// A step is less accurate than was asked for.
    #[error(transparent)]
    Inaccurate(#[from] Inaccurate),
}

/// The steps of a formulation on a device, by the kick-drift-kick method, or on several ranks, with a state that stays
/// there. What comes back is the state where somebody asks for it, and what the choice of a step takes.
pub trait DeviceSteps: Send {
    /// Takes a state over.
    ///
    /// # Errors
    /// When the device refuses, or a rank is lost.
    fn put(&mut self, state: &[f64]) -> Result<(), StepsError>;

    /// Takes a step from a time, both in s. The state before it is kept.
    ///
    /// # Errors
    /// When the device refuses, or a rank is lost; and where equations of the step have no solution, or it is less accurate
    /// than was asked for: then the state is what it was.
    fn step(&mut self, time: f64, step: f64) -> Result<(), StepsError>;

    /// Says what failures have multiplied steps by, which holds for steps within a step as well.
    fn shorten(&mut self, _factor: f64) {}

    /// What the next step should be over the one that was tried last, for its error to be what is allowed; `None` where no
    /// error is estimated.
    fn growth(&self) -> Option<f64> {
        None
    }

    /// Whether the last step was found quickly, so that the next may be longer where failures have made steps shorter.
    fn was_quick(&self) -> bool {
        false
    }

    /// What linear equations have taken so far, where the steps are taken.
    fn linear_costs(&self) -> Option<Costs> {
        None
    }

    /// What [`Scheme::warning`](super::Scheme::warning) says where the steps are taken, if nobody else knows it.
    fn warning(&self) -> Option<String> {
        None
    }

    /// Looks once over the state, as [`Scheme::inspect`](super::Scheme::inspect).
    ///
    /// # Errors
    /// When the device refuses, or a rank is lost.
    fn inspect(&mut self, limits: &mut Vec<StepLimit>) -> Result<Health, StepsError>;

    /// Gives the state.
    ///
    /// # Errors
    /// When the device refuses, or a rank is lost.
    fn fetch(&self, state: &mut [f64]) -> Result<(), StepsError>;

    /// Gives the state before the last step.
    ///
    /// # Errors
    /// When the device refuses, or a rank is lost.
    fn fetch_before(&self, state: &mut [f64]) -> Result<(), StepsError>;

    /// Whether [`Scheme::warning`](super::Scheme::warning) has something to say of the state that was looked at last.
    fn warns(&self) -> bool {
        false
    }

    /// Notes for the end that another run of the case goes on, with this many more particles in reserve than the case asks
    /// for.
    fn end_for_another(&mut self, _more: usize) {}

    /// How many steps each system took in the last one of the run; one each where there is nothing.
    fn steps_in_last(&self) -> &[u64] {
        &[]
    }

    /// How many particles could not be born, as [`Scheme::missing`](super::Scheme::missing).
    fn missing(&self) -> u64 {
        0
    }

    /// Whether a rank was asked to end the run.
    fn stops(&self) -> bool {
        false
    }

    /// What has taken the time of each rank, where there are several.
    ///
    /// # Errors
    /// A rank is lost.
    fn costs(&self) -> Result<Vec<RankCosts>, StepsError> {
        Ok(Vec::new())
    }

    /// The parts of a step as lists of stages. What a device does while nothing waits for it is counted
    /// where somebody does next.
    fn phases(&self) -> Vec<&Phase>;
}

/// How steps are taken on a device.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct DeviceMethod {
    /// The name of the integrator.
    pub integrator: &'static str,
    /// The precision of what is computed of pairs, and of what of them is kept between passes. States, what moves them,
    /// and sums over particles are in double precision.
    pub precision: Precision,
}

impl DeviceMethod {
    /// How columns are stored, of which those of this layout may be in single precision.
    pub(crate) fn layout(self, layout: Layout) -> Layout {
        match self.precision {
            Precision::Double => Layout { narrow: &[], ..layout },
            Precision::Single => layout,
        }
    }

    /// How passes are written then.
    pub(crate) fn dialect(self, language: Language, layout: Layout) -> Dialect {
        Dialect { language, layout: self.layout(layout) }
    }

    /// Refuses all integrators but kick-drift-kick.
    ///
    /// # Errors
    /// [`DeviceRefusal::Integrator`].
    pub(crate) fn unless_kicked(self) -> Result<Self, DeviceRefusal> {
        match self.integrator == KICK_DRIFT_KICK {
            true => Ok(self),
            false => Err(DeviceRefusal::Integrator {
                integrator: self.integrator,
                able: "`kick_drift_kick`",
            }),
        }
    }
}

/// A stage of a step, or what runs beside the stages, with its passes on a device.
#[derive(Clone, Debug)]
pub struct DeviceStage {
    /// Its name.
    pub name: &'static str,
    /// What is started on the device for it, in this order.
    pub passes: Vec<Pass>,
}

/// Stages with those of their passes that there are; without those that have none.
pub(crate) fn staged(
    passes: &[Pass],
    stages: &[(&'static str, &[&'static str])],
) -> Vec<DeviceStage> {
    let of = |&(name, started): &(&'static str, &[&str])| {
        let started = started.iter().flat_map(|name| passes.iter().find(|it| it.name == *name));
        DeviceStage { name, passes: started.cloned().collect() }
    };
    stages.iter().map(of).filter(|stage| !stage.passes.is_empty()).collect()
}

/// Why a run cannot be on a device.
#[derive(Clone, Debug, Error, PartialEq)]
#[non_exhaustive]
pub enum DeviceRefusal {
    /// The formulation has no steps on devices.
    #[error(
        "the formulation `{0}` does not run on devices: leave out `--device` and `compute.device`"
    )]
    Formulation(&'static str),
    /// There are several systems.
    #[error(
        "several systems in one case do not run on devices yet: leave out `--device` and `compute.device`"
    )]
    Systems,
    /// The integrator has no steps on devices.
    #[error(
        "the integrator `{integrator}` does not run on devices with this formulation: use {able}, or leave out \
         `--device` and `compute.device`"
    )]
    Integrator {
        /// Its name.
        integrator: &'static str,
        /// Those that do.
        able: &'static str,
    },
    /// Something of the case has no steps on devices.
    #[error(
        "{what} does not run on devices yet: {instead}, or leave out `--device` and `compute.device`"
    )]
    Stage {
        /// The stage, or the setting.
        what: String,
        /// What a case has to be like instead.
        instead: &'static str,
    },
    /// The memory of the device does not suffice.
    #[error(
        "the run takes at least {needed} of a device's memory, more than there is on {device}; the largest \
         columns are {largest}: take fewer particles, or another device"
    )]
    Memory {
        /// What is needed.
        needed: String,
        /// The device with its memory.
        device: String,
        /// The largest columns with their sizes.
        largest: String,
    },
    /// The device has single precision only.
    #[error(
        "runs need double precision, which this device does not support: {0}; choose another \
         device, or none"
    )]
    Single(String),
    /// Whoever takes the steps.
    #[error(transparent)]
    Steps(#[from] StepsError),
}

impl From<DeviceError> for DeviceRefusal {
    fn from(error: DeviceError) -> Self {
        Self::Steps(error.into())
    }
}
