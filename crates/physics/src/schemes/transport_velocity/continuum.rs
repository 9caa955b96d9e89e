//! What a kind of matter brings to the particles that all kinds share.

use std::sync::Arc;

use piola_device::{Device, Language};
use piola_formulas::pairs::Record;
use piola_formulas::pairs::wall::{Around, Extrapolation, Ghost, Surroundings};

use super::ledger::{ACCELERATIONS, DRIFTING, Drift};
use super::stages::{Instant, Pass};
use super::walls::WallValues;
use super::{
    AtRest, Columns, Common, OpenBoundaries, Rates, Slip, TransportVelocity, TransportVelocityError,
};
use crate::Vector;
use crate::boundaries::SpaceTime;
use crate::fields::FieldDescription;
use crate::operators::{Among, NeighborBlock, Term, add_at};
use crate::schemes::ledger::{Entry, Total, Totals};
use crate::schemes::stages::Stage;
use crate::schemes::{
    Array, DeviceMethod, DeviceRefusal, DeviceStage, DeviceSteps, Passage, SchemeDescription,
};

/// Matter bound to the particles that all kinds of it share.
pub trait Continuum<const D: usize>: Sized + Send + Sync + 'static {
    /// What it is made of.
    type Input;
    /// Passes that it alone has.
    type Own: Copy + PartialEq + Send + Sync;

    /// Its fields, energies and ledger.
    const DESCRIPTION: &'static SchemeDescription;
    /// Its mechanisms that accelerate, in the order of [`Forces::terms`](super::Forces).
    const ACCELERATING: [Option<Entry>; ACCELERATIONS];
    /// Its mechanisms of a drift: pressure, transport and its own.
    const DRIFTING: [Option<Entry>; DRIFTING];
    /// What particles that are removed take along.
    const REMOVED: Entry;
    /// What walls do, and what holds particles as prescribed.
    const WALLS: Entry;
    /// Whether it has columns of its own that evolve and that neighbours see.
    const HAS_MATERIAL: bool;

    /// Density and wave speed at rest of this many bodies.
    fn at_rest(input: &Self::Input, bodies: usize) -> Vec<AtRest>;

    /// Binds it to particles.
    ///
    /// # Errors
    /// Parts that do not fit together.
    fn bind(input: Self::Input, common: &mut Common<D>) -> Result<Self, TransportVelocityError>;

    /// That of a rank with these particles.
    fn part(&self, common: &Common<D>) -> Self;

    /// How many numbers of its own a pass shows of a particle to ranks that have a copy.
    fn shows(pass: Pass<Self::Own>) -> usize;

    /// Fills what a state of the start has besides the columns of all matter.
    fn begin(&self, _common: &Common<D>, _state: &mut [f64]) {}

    /// The passes of a drift, and those that find accelerations.
    fn passes(&self, common: &Common<D>) -> [Vec<Pass<Self::Own>>; 2];

    /// What a pass of its own reads and writes.
    fn stage(pass: Self::Own) -> Stage;

    /// Runs a pass of its own.
    fn run(
        &mut self,
        pass: Self::Own,
        common: &mut Common<D>,
        at: Instant,
        state: &mut [f64],
        totals: &mut Totals,
    );

    /// Gives it open boundaries.
    fn open(&mut self, _open: OpenBoundaries<D>, _common: &mut Common<D>) {}

    /// Gives it a rate in 1/s at which its motion dies out, as a function of place.
    fn damp_by(&mut self, _rate: Arc<dyn SpaceTime>, _common: &Common<D>) {}

    /// That rate at a place; no number if it is less than zero.
    fn damping_at(&self, _place: &Vector<D>) -> f64 {
        0.0
    }

    /// Takes from a state which particles take part, before it is loaded.
    fn follow(&mut self, _common: &mut Common<D>, _state: &[f64]) {}

    /// Numbers that a state keeps of it behind the ledger and those of all matter.
    fn kept(&self) -> usize {
        0
    }

    /// Moves its particles that do not move by themselves, for a step in s with the velocities half way.
    fn lead(&self, _common: &Common<D>, _step: f64, _middle: f64, _state: &mut [f64]) {}

    /// The body that a particle (number) belongs to in a state; nothing if it is not there.
    fn body_of(&self, common: &Common<D>, number: usize, state: &[f64]) -> Option<u32> {
        let is_removed = Common::<D>::is_removed(common.columns(state).density[number]);
        (!is_removed).then(|| common.particles.body[number])
    }

    /// Keeps what the passes of the start have found.
    fn settle(&self, _common: &Common<D>, _state: &mut [f64]) {}

    /// How many particles have been born before a particle (number) and with it; 0 if it was there at the start.
    fn birth_of(&self, _common: &Common<D>, _number: usize, _state: &[f64]) -> u32 {
        0
    }

    /// Whether particles enter.
    fn is_open(&self) -> bool {
        false
    }

    /// How many of the particles that are not there have not escaped.
    fn waiting(&self, _common: &Common<D>, _state: &[f64]) -> f64 {
        0.0
    }

    /// How many particles could not be born on the way to a state, as none was left in reserve.
    fn missing(&self, _common: &Common<D>, _state: &[f64]) -> u64 {
        0
    }

    /// Takes note that as many `more` particles wait in a state.
    fn add_waiting(&self, _common: &Common<D>, _more: usize, _state: &mut [f64]) {}

    /// Fills what neighbours see besides their sides, which have been loaded.
    fn load(&mut self, _common: &Common<D>, _state: &[f64]) {}

    /// Sets what is prescribed of its particles in a state at a time in s; the work and the impulse
    /// are of walls.
    fn prescribe(&self, _common: &Common<D>, _time: f64, _state: &mut [f64]) -> Total {
        Total::default()
    }

    /// Gives sides the density and pressure that are functions of places or of each other, and returns
    /// the largest speed for shifting in m/s.
    fn update(&mut self, common: &mut Common<D>) -> f64;

    /// Fills its rates from the sides.
    fn find_rates(&mut self, common: &Common<D>, time: f64);

    /// Moves its particles with these rates by a step in s.
    fn advance(&self, common: &Common<D>, step: f64, state: &mut [f64]) -> Drift;

    /// Fills the forces of `common` from the sides, without body forces.
    fn find_forces(&mut self, common: &mut Common<D>);

    /// Writes what the passes have found to a state.
    fn store(&self, common: &Common<D>, state: &mut [f64], totals: &mut Totals) {
        common.store::<Self>(state, totals);
    }

    /// What is around the wall particle at `place`.
    fn around(
        &self,
        common: &Common<D>,
        place: usize,
        _values: &mut WallValues<D>,
        block: &mut NeighborBlock<D>,
    ) -> Around<f64, D> {
        common.surroundings(place, block)
    }

    /// Changes the values of a wall particle with a normal, beside which the matter is a ghost.
    fn reflect(
        &self,
        _slip: Slip,
        _normal: &Vector<D>,
        _ghost: &Ghost<f64, D>,
        _values: &mut WallValues<D>,
    ) {
    }

    /// Makes room for what neighbours see of places, of which a new list may have more.
    fn make_room(&mut self, _common: &Common<D>) {}

    /// Finds what its own fields need besides sides.
    fn prepare_fields(&mut self, _common: &Common<D>) {}

    /// Takes the values of the wall particle at `place`.
    fn set_wall(&mut self, place: usize, values: &WallValues<D>);

    /// Shows those of all walls of this rank to ranks that have copies of them.
    fn show_walls(&mut self, common: &Common<D>);

    /// Square of the speed in m^2/s^2 of the particle at `place` that shifting takes for its own.
    fn speed_squared(&self, common: &Common<D>, place: usize) -> f64 {
        common.sides[place].velocity.norm_squared()
    }

    /// The rates of the last pass at a place that all matter has.
    fn rates_at(&self, place: usize) -> &Rates;

    /// Speed of the fastest waves in m/s, if it is the same everywhere.
    fn wave_speed(&self) -> Option<f64> {
        None
    }

    /// That of a particle (row), if what it has besides the columns of all matter is finite.
    fn wave_speed_of(&self, _common: &Common<D>, _row: usize, _state: &[f64]) -> Option<f64> {
        Some(0.0)
    }

    /// Kinematic viscosity in m^2/s.
    fn viscosity(&self) -> f64 {
        0.0
    }

    /// Energies in J behind the kinetic one.
    fn energies(&self, common: &Common<D>, state: &[f64], energies: &mut [f64]);

    /// Appends its own figures.
    fn figures(&self, common: &Common<D>, state: &[f64], figures: &mut Vec<f64>);

    /// What has gone through the open boundary with the number of a body, if it is one.
    fn passed(&self, _common: &Common<D>, _state: &[f64], _body: u32) -> Option<Passage> {
        None
    }

    /// Appends a field of its own table, numbered there, of a particle (number).
    fn push_field(
        &self,
        common: &Common<D>,
        field: &FieldDescription,
        number: usize,
        state: (&Columns<'_, D>, &[f64]),
        values: &mut Vec<f64>,
    );

    /// Its arrays by particle, in which its columns stand.
    fn arrays(&self) -> Vec<Array>;

    /// Its steps on a device.
    ///
    /// # Errors
    /// It has none, or the device refuses.
    fn to_device(
        system: &TransportVelocity<D, Self>,
        device: Device,
        method: DeviceMethod,
    ) -> Result<Box<dyn DeviceSteps>, DeviceRefusal>;

    /// The stages of its steps on a device in a language.
    ///
    /// # Errors
    /// It has none.
    fn device_stages(
        system: &TransportVelocity<D, Self>,
        language: Language,
        method: DeviceMethod,
    ) -> Result<Vec<DeviceStage>, DeviceRefusal>;
}

impl<const D: usize> Common<D> {
    /// The matter around the passive particle at `place`.
    pub(super) fn surroundings(
        &self,
        place: usize,
        block: &mut NeighborBlock<D>,
    ) -> Around<f64, D> {
        let mut around = Surroundings::zero();
        let source = self.sides.as_slice();
        let sum = Term { law: Extrapolation::<D>, source, among: Among::Active };
        add_at(&self.support, &sum, place, block, &mut around);
        around
    }
}
