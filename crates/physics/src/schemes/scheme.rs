//! What a formulation offers to integrators, clock, observers and output.

use std::ops::Range;

use piola_device::{Device, Language};
use serde::{Deserialize, Serialize};

use super::momentum::MOST_COMPONENTS;
use super::{
    CoupledScheme, DeviceMethod, DeviceRefusal, DeviceStage, DeviceSteps, NewmarkScheme, Part,
    PartitionedScheme, Phase, RankRefusal, RankShare, SchemeDescription, SplitScheme, StaticScheme,
    ThetaScheme,
};
use crate::fields::{self, FieldDescription};
use crate::geometry::Particles;
use crate::parallel::Team;
use crate::solve::Costs;

/// A formulation bound to its particles, materials and kernel.
///
/// The state is one flat slice: a column of `particle_count` rows for each of its
/// [`fields`](SchemeDescription::fields) that is evolved or kept, followed by the running integrals of the
/// [`Ledger`](super::Ledger): the work of each mechanism, then the impulse of each source of momentum. The
/// rate of an integral is a power or a force, so an integrator carries the bookkeeping to its own
/// order without knowing of it, theory (18), and a copy of the state is all there is to save.
pub trait Scheme: Send + Sync {
    /// What it is called and what it shows.
    fn description(&self) -> &'static SchemeDescription;

    /// 1, 2 or 3.
    fn dimension(&self) -> usize;

    /// Number of particles.
    fn particle_count(&self) -> usize;

    /// Numbers of state a particle: those of all columns.
    fn width(&self) -> usize {
        fields::width(self.description().fields, self.dimension())
    }

    /// Where the column of a field stands in a state; empty if it is not in it.
    fn column(&self, field: &FieldDescription) -> Range<usize> {
        let fields = self.description().fields;
        fields::column(fields, self.dimension(), self.particle_count(), field)
    }

    /// Where the values of a field of particles that follow each other in memory stand in a state, as in
    /// [`column`](Self::column), if they stand there in one stretch.
    fn stretch(&self, field: &FieldDescription, particles: &Range<usize>) -> Option<Range<usize>> {
        let column = self.column(field);
        let components = field.kind.components(self.dimension());
        let is_there = !column.is_empty() && particles.end <= self.particle_count();
        let [start, end] = [particles.start, particles.end].map(|a| column.start + a * components);
        is_there.then_some(start..end)
    }

    /// Where the ledger begins in a state.
    fn ledger_start(&self) -> usize {
        self.particle_count() * self.width()
    }

    /// The state at the start, with zero integrals.
    fn initial_state(&self) -> Vec<f64>;

    /// Writes the time derivative of `state` at `time` to `rate`, of the same layout.
    fn rates(&mut self, time: f64, state: &[f64], rate: &mut [f64]);

    /// Sets prescribed values of `time` in `state`.
    fn constrain(&self, time: f64, state: &mut [f64]);

    /// Looks once over `state`: the health figures, and the largest stable steps at a CFL number
    /// of one in `limits`, which is cleared first.
    fn inspect(&mut self, state: &[f64], limits: &mut Vec<StepLimit>) -> Health;

    /// Finds the neighbours at a state that somebody else has come to, for [`Scheme::figures`].
    fn find_neighbors(&mut self, _state: &[f64]) {}

    /// What the user should know of the state that [`Scheme::inspect`] has just looked at, though it is
    /// sound.
    fn warning(&self) -> Option<String> {
        None
    }

    /// What is known of a particle (index in memory) that [`Scheme::inspect`] has just found to have
    /// escaped in `state`.
    fn escape(&self, _index: usize, _state: &[f64]) -> Option<Escape> {
        None
    }

    /// Appends the values of its own [`figures`](SchemeDescription::figures) at `state`.
    fn figures(&self, _state: &[f64], _figures: &mut Vec<f64>) {}

    /// What has gone through the open boundary with the number of a body, if it is one.
    fn passed(&self, _state: &[f64], _body: u32) -> Option<Passage> {
        None
    }

    /// The energies of `state` in J, in the order of its description.
    fn energies(&self, state: &[f64], energies: &mut [f64]);

    /// The momentum of `state`, one number for each of
    /// [`momentum_components`](super::momentum_components).
    fn momentum(&self, state: &[f64], momentum: &mut [f64]);

    /// Runs one of the stages, counted from 1, that make derived fields of `state` at `time`, after
    /// all before it. See [`Observation`](super::Observation).
    fn observe(&mut self, _stage: usize, _time: f64, _state: &[f64]) {}

    /// Appends the components of a field that is no column of `state` for each of `particles` (indices
    /// in memory) to `values`. Its stages have been run.
    fn derive(
        &self,
        state: &[f64],
        field: &FieldDescription,
        particles: &[u32],
        values: &mut Vec<f64>,
    );

    /// The parts of a step as lists of stages, with the time that each has taken.
    fn phases(&self) -> Vec<&Phase> {
        Vec::new()
    }

    /// The systems that it is made of, one after another, each with its range in a state; none if it is one by itself.
    fn parts(&self) -> Vec<(&dyn Scheme, Range<usize>)> {
        Vec::new()
    }

    /// How many particles could not be born on the way to `state`, as none was left in reserve.
    fn missing(&self, _state: &[f64]) -> u64 {
        0
    }

    /// Translates a state of `fewer`, the same formulation with a smaller reserve, into one of this.
    fn taken_over(&self, fewer: &dyn Scheme, state: &[f64]) -> Vec<f64> {
        let (parts, before) = (self.parts(), fewer.parts());
        let behind = before.last().map_or(0, |(_, own)| own.end);
        let both = parts.into_iter().zip(before);
        let parts = both.flat_map(|((part, _), (fewer, own))| part.taken_over(fewer, &state[own]));
        parts.chain(state[behind..].iter().copied()).collect()
    }

    /// Number of the body of each particle.
    fn bodies(&self) -> &[u32];

    /// Number of each particle in the order of creation.
    fn ids(&self) -> &[u32];

    /// Whether all particles are there all the time, as parts of the same bodies.
    fn is_closed(&self) -> bool {
        true
    }

    /// The body that a particle (index in memory) belongs to in `state`; nothing if it is not there.
    fn body_of(&self, _state: &[f64], index: usize) -> Option<u32> {
        Some(self.bodies()[index])
    }

    /// How many particles had been born when a particle (index in memory) of `state` was; 0 if it was there at
    /// the start.
    fn birth_of(&self, _state: &[f64], _index: usize) -> u32 {
        0
    }

    /// Numbers of some particles (indices in memory) of `state` in the order of creation: those that were born have numbers
    /// behind all that there were at the start.
    fn ids_of(&self, state: &[f64], particles: &[u32]) -> Vec<u32> {
        let ids = self.ids();
        let last = ids.iter().copied().max().unwrap_or_default();
        let id = |&a: &u32| match self.birth_of(state, a as usize) {
            0 => ids[a as usize],
            birth => last.saturating_add(birth),
        };
        particles.iter().map(id).collect()
    }

    /// Mass in kg of a particle (index in memory), for 1 m in missing dimensions.
    fn mass(&self, index: usize) -> f64;

    /// How wide a particle (index in memory) is in units of the spacing of its body.
    fn width_of(&self, _index: usize) -> f64 {
        1.0
    }

    /// Reference position in m and number in the order of creation of each particle.
    fn particle(&self, index: usize) -> Particle;

    /// The particles (indices in memory) that particle `index` interacts with, in a fixed order.
    fn neighborhood(&self, index: usize) -> Vec<u32>;

    /// What to change so that a run is more robust, for example "raise `scheme.tau_velocity`".
    fn stability_advice(&self) -> &'static str;

    /// The likely cause of the collapse of a particle (index in memory), and what to change.
    fn collapse_advice(&self, index: usize) -> String;

    /// Bytes that the scheme holds, without states.
    fn memory(&self) -> usize;

    /// What its linear equations have taken so far, if it solves any.
    fn linear_costs(&self) -> Option<Costs> {
        None
    }

    /// The formulation as one that finds equilibria, if it is one and was built for that.
    fn equilibrium(&mut self) -> Option<&mut dyn StaticScheme> {
        None
    }

    /// The formulation as one that takes implicit steps of a system of second order in time, of masses
    /// and accelerations, if it is one and was built for that.
    fn newmark(&mut self) -> Option<&mut dyn NewmarkScheme> {
        None
    }

    /// The formulation as one that takes implicit steps of a system of first order in time, of its
    /// state and its rates, if it is one and was built for that.
    fn theta(&mut self) -> Option<&mut dyn ThetaScheme> {
        None
    }

    /// The formulation as one whose steps can be split, if it is one.
    fn split(&mut self) -> Option<&mut dyn SplitScheme> {
        None
    }

    /// The formulation as one whose accelerations depend on places alone, if it is one and nothing in
    /// it dissipates.
    fn partitioned(&mut self) -> Option<&mut dyn PartitionedScheme> {
        None
    }

    /// The formulation as one of several systems that act on each other, if it is one.
    fn coupled(&mut self) -> Option<&mut dyn CoupledScheme> {
        None
    }

    /// Its steps on a device by a method.
    ///
    /// # Errors
    /// Something of it has no body for devices, or the device refuses.
    fn on_device(
        &self,
        _device: Device,
        _method: DeviceMethod,
    ) -> Result<Box<dyn DeviceSteps>, DeviceRefusal> {
        Err(DeviceRefusal::Formulation(self.description().name))
    }

    /// The stages of its steps on a device with their passes in a language, each once, and what a device does beside
    /// them. No device is needed.
    ///
    /// # Errors
    /// Something of it has no body for devices.
    fn device_stages(
        &self,
        _language: Language,
        _method: DeviceMethod,
    ) -> Result<Vec<DeviceStage>, DeviceRefusal> {
        Err(DeviceRefusal::Formulation(self.description().name))
    }

    /// The part of a rank: a formulation of its particles, with copies of those of others, or one of all that
    /// [shares](Self::is_whole_on_ranks) what takes long. All ranks call this together.
    ///
    /// # Errors
    /// Something of it cannot be shared, or a rank is lost.
    fn share(&self, _part: &Part) -> Result<Box<dyn Scheme>, RankRefusal> {
        Err(RankRefusal::Formulation(self.description().name))
    }

    /// The system that ranks divide among them, of several that stand one after another in a state: the first one. Each
    /// rank has all of the others.
    fn divided(&self) -> Option<&dyn Scheme> {
        None
    }

    /// Whether each rank has the whole state, as where equations are solved for all particles: ranks share what that takes.
    fn is_whole_on_ranks(&self) -> bool {
        false
    }

    /// What some particles cost in a step, in units of one's own.
    fn cost(&self, particles: Range<usize>) -> f64 {
        particles.len() as f64
    }

    /// What a rank would have whose particles begin and end where `bounds` has it.
    ///
    /// # Errors
    /// Something of it cannot be shared.
    fn shares(&self, _bounds: &[usize]) -> Result<Vec<RankShare>, RankRefusal> {
        Err(RankRefusal::Formulation(self.description().name))
    }

    /// Who computes it together.
    fn team(&self) -> Option<&Team> {
        None
    }

    /// Whether [`Scheme::rates`] are all there is of its motion, as Runge-Kutta methods need it.
    fn has_rates(&self) -> bool {
        true
    }

    /// Whether particles interact with the same others all the time, and their places are those of the matter
    /// that they are of: what is said by reference positions then holds as long as the run.
    fn keeps_neighbors(&self) -> bool {
        true
    }

    /// How many steps of its own each of its systems has taken up to `state`, by name; nothing where there are none.
    fn own_steps(&self, _state: &[f64]) -> Vec<(String, u64)> {
        Vec::new()
    }

    /// The columns of its state that may be set from outside for a particle (index in memory): those that nothing else in
    /// the state has to follow but accelerations.
    fn settable(&self, _index: usize) -> &'static [&'static str] {
        &["velocity"]
    }

    /// The largest angular frequency of small oscillations about `state` in rad/s that nothing
    /// damps; `None` where all of them are damped, or it is not known.
    fn undamped_frequency(&mut self, _state: &[f64]) -> Option<f64> {
        None
    }
}

/// Where a particle is and what its number is.
#[derive(Clone, Debug, PartialEq)]
pub struct Particle {
    /// Number in the order of creation.
    pub id: u32,
    /// Reference position in m, `dimension` numbers.
    pub reference: Vec<f64>,
}

impl Particle {
    /// One of these, by its index in memory.
    pub(crate) fn of<const D: usize>(particles: &Particles<D>, index: usize) -> Self {
        let reference = particles.position[index].iter().copied().collect();
        Self { id: particles.id[index], reference }
    }
}

/// A particle that is where no particle may be.
#[derive(Clone, Debug, PartialEq)]
pub struct Escape {
    /// Where it is now, in m.
    pub position: Vec<f64>,
    /// Its speed in m/s.
    pub speed: f64,
    /// What it has left behind.
    pub behind: Behind,
    /// What to change.
    pub advice: &'static str,
}

/// What a particle that escapes leaves behind.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Behind {
    /// The wall of this name, which it has gone through.
    Wall(String),
    /// The end of the wall of this name, which has no face there, and which it has come over.
    End(String),
    /// The box around everything.
    Box,
    /// The surface of a wall or a solid that it touches.
    Surface,
    /// Those that were its neighbours at the start, of a solid in a fluid.
    Neighbors,
}

/// Figures that tell whether a state is sound.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Health {
    /// Largest speed in m/s.
    pub largest_speed: f64,
    /// Particle (index in memory) of the largest speed.
    pub largest_speed_particle: usize,
    /// Largest wave speed in m/s.
    pub largest_wave_speed: f64,
    /// Smallest volume ratio J, evolved or from the deformation gradient, whichever is smaller.
    pub smallest_ratio: f64,
    /// Particle (index in memory) of the smallest ratio.
    pub smallest_ratio_particle: usize,
    /// Largest difference between the evolved J and det F.
    pub ratio_mismatch: f64,
    /// First particle (index in memory) with a value that is not finite.
    pub first_not_finite: Option<usize>,
    /// First particle (index in memory) that is where it must not be.
    pub first_escaped: Option<usize>,
}

impl Health {
    /// The figures of no particle, from which a reduction starts.
    pub const NEUTRAL: Self = Self {
        largest_speed: 0.0,
        largest_speed_particle: 0,
        largest_wave_speed: 0.0,
        smallest_ratio: f64::INFINITY,
        smallest_ratio_particle: 0,
        ratio_mismatch: 0.0,
        first_not_finite: None,
        first_escaped: None,
    };

    /// The worse of two, figure by figure; `self` wins ties, so that reductions in index order
    /// name the first particle.
    #[must_use]
    pub fn worse(self, other: Self) -> Self {
        let faster = if other.largest_speed > self.largest_speed { other } else { self };
        let smaller = if other.smallest_ratio < self.smallest_ratio { other } else { self };
        Self {
            largest_speed: faster.largest_speed,
            largest_speed_particle: faster.largest_speed_particle,
            largest_wave_speed: self.largest_wave_speed.max(other.largest_wave_speed),
            smallest_ratio: smaller.smallest_ratio,
            smallest_ratio_particle: smaller.smallest_ratio_particle,
            ratio_mismatch: self.ratio_mismatch.max(other.ratio_mismatch),
            first_not_finite: self.first_not_finite.or(other.first_not_finite),
            first_escaped: self.first_escaped.or(other.first_escaped),
        }
    }
}

/// What has gone through an open boundary since the start.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Passage {
    /// Mass in kg that has entered.
    pub entered: f64,
    /// Mass in kg that has left.
    pub left: f64,
    /// Energy in J of the particles that have entered, less that of those that have left.
    pub energy: f64,
    /// The same of their momentum, as [`momentum_components`](super::momentum_components) orders it.
    pub momentum: [f64; MOST_COMPONENTS],
}

/// A bound on the time step.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct StepLimit {
    /// What limits the step, for example `acoustic`.
    pub name: &'static str,
    /// Largest step in s at a CFL number of one.
    pub step: f64,
    /// The particle (index in memory) that sets it.
    pub particle: usize,
    /// Whether the CFL number scales this bound, or it is a bound by itself.
    pub scaled: bool,
    /// The largest ratio of a step to the one before while this bound grows: infinite where it follows
    /// the flow and not the phase of a vibration.
    pub growth: f64,
}

impl StepLimit {
    /// A bound that the CFL number scales and that follows the flow.
    pub fn scaled(name: &'static str, step: f64, particle: usize) -> Self {
        Self { name, step, particle, scaled: true, growth: f64::INFINITY }
    }
}
