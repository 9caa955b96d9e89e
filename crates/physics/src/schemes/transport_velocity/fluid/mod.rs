//! A weakly compressible fluid in the transport-velocity formulation, CTVF section 2.

mod damping;
mod density;
mod drift;
mod forces;
mod gradients;
mod open;
mod rates;
mod stages;

use std::sync::Arc;

use piola_device::{Device, Language};
use piola_formulas::pairs::Record as _;
use piola_formulas::pairs::corrected::{GradientSide, Gradients};
use piola_formulas::pairs::fluid::FluidSide;

use super::device::{self, FluidPlan};
use super::fields::Made;
use super::ledger::{ACCELERATIONS, DRIFTING, Drift};
use super::stages::{Instant, Pass};
use super::walls::WallValues;
use super::{
    AtRest, Columns, Common, Continuum, DensityRule, Fluid, Rates, TransportVelocity,
    TransportVelocityError,
};
use crate::Vector;
use crate::boundaries::SpaceTime;
use crate::fields::{FieldDescription, columns};
use crate::schemes::ledger::{Entry, Total, Totals};
use crate::schemes::stages::Stage;
use crate::schemes::{
    Accounts, Array, Capability, DeviceMethod, DeviceRefusal, DeviceStage, DeviceSteps, Passage,
    SchemeDescription,
};

use damping::Damping;
use density::summed_density;
use open::Open;
pub use open::{Flow, Nesting, OpenBoundaries, OpenBoundary, Refined};
pub use stages::Ends;

columns! {
    pub(super) struct Stored, StoredMut, enum Own;
    kept excess: Scalar, "kg/m3", "summation density less density, where the density relaxes to it";
    evolved opening: Scalar, "1", "number of the open boundary whose buffer contains the particle, from 1; 0 in the fluid";
    evolved birth: Scalar, "1", "number of particles that had entered when this one did; 0 if it was there at the start";
    evolved nesting: Scalar, "1", "role of the particle among levels of resolution: 2 where it follows those of another one, 1 where finer ones stand beside it";
    derived(1) summed_density: Scalar, "kg/m3", "summation density";
    derived(1) pressure_force: Vector, "N", "part of `force` on a wall due to the pressure";
    derived(1) viscous_force: Vector, "N", "part of `force` on a wall due to viscosity";
    derived(1) barrier_force: Vector, "N",
        "rest of `force` on a wall: the reaction to the repulsion of fluid that touches it";
}

/// The fields of all matter, then those of fluids.
const FIELDS: [FieldDescription; Made::FIELDS.len() + Own::FIELDS.len()] =
    FieldDescription::joined(Made::FIELDS, Own::FIELDS);

/// What a fluid is called and what it shows.
pub const DESCRIPTION: SchemeDescription = SchemeDescription {
    name: super::NAME,
    matter: Some("fluids"),
    offers: &[Capability::Kicks],
    fields: &FIELDS,
    energies: &["kinetic", "compression"],
    ledger: LEDGER,
    figures: &[
        ("shifting_passes", "1"),
        ("removed", "1"),
        ("behind", "1"),
        ("entered", "kg"),
        ("left", "kg"),
    ],
};

/// The ledger of a fluid.
///
/// `pressure` is what the exchange between kinetic energy and that of compression fails to
/// conserve: the discrete force and divergence are not exact adjoints.
///
/// Viscous forces, and what diffuses velocities, act along `u_ab` and turn the fluid, and what follows another level does
/// not feel them; the corrections neither come in pairs, nor do particles move along their velocity. What is removed takes
/// its momentum along. Pressures are in no account of the momentum, so that its balance tells whether they come in pairs; with
/// corrected gradients they turn the fluid, theory (110).
pub(super) const LEDGER: Accounts = Accounts {
    mechanisms: &[
        "pressure",
        "viscosity",
        "artificial_viscosity",
        "transport",
        "walls",
        "body_force",
        "pressure_diffusion",
        "density_relaxation",
        "removed",
        "openings",
        "damping",
    ],
    impulses: &[
        "walls",
        "body_force",
        "viscosity",
        "corrections",
        "removed",
        "openings",
        "damping",
    ],
    is_kicked: true,
};
const PRESSURE: Entry = LEDGER.entry("pressure");
const TRANSPORT: Entry = LEDGER.entry_by("transport", "corrections");
const WALLS: Entry = LEDGER.entry("walls");
const OPENINGS: Entry = LEDGER.entry("openings");
const DAMPING: Entry = LEDGER.entry("damping");
const BODY_FORCE: Entry = LEDGER.entry("body_force");

/// The mechanisms that accelerate.
pub(super) const ACCELERATING: [Entry; ACCELERATIONS] = [
    PRESSURE,
    LEDGER.entry("viscosity"),
    LEDGER.entry_by("artificial_viscosity", "viscosity"),
    TRANSPORT,
    WALLS,
    BODY_FORCE,
];

/// A fluid bound to its particles, with scratch by place.
pub struct WeaklyCompressible<const D: usize> {
    fluid: Fluid,
    /// What the kernel sums to over a lattice, [`Common::lattice_sum`].
    lattice_sum: f64,
    densities: Vec<f64>,
    rates: Vec<Rates>,
    /// Velocity of each wall particle that viscous forces see.
    shear: Vec<Vector<D>>,
    /// What corrected forces gather besides sides; empty where gradients are not corrected.
    gradients: Vec<Gradients<f64, D>>,
    open: Open<D>,
    damping: Damping<D>,
}

impl<const D: usize> WeaklyCompressible<D> {
    /// A fluid without open boundaries and damping.
    fn new(fluid: Fluid, common: &Common<D>) -> Self {
        let count = common.count();
        let touched = if common.walls.is_empty() { 0 } else { count };
        let corrected = if common.settings.corrects_gradients() { count } else { 0 };
        Self {
            fluid,
            lattice_sum: common.lattice_sum(),
            densities: vec![0.0; count],
            rates: vec![Rates::default(); count],
            shear: vec![Vector::zeros(); touched],
            gradients: vec![Gradients::none(); corrected],
            open: Open::none(),
            damping: Damping::default(),
        }
    }

    /// What it is made of.
    pub(super) fn fluid(&self) -> &Fluid {
        &self.fluid
    }

    /// What the kernel sums to over a lattice.
    pub(super) fn lattice_sum(&self) -> f64 {
        self.lattice_sum
    }

    /// Whether its motion dies out somewhere.
    pub(super) fn is_damped(&self) -> bool {
        !self.damping.is_empty()
    }

    /// `1 / (rho0 c)^2`.
    pub(super) fn compliance(&self) -> f64 {
        let Fluid { density, wave_speed, .. } = self.fluid;
        AtRest { density, wave_speed }.compliance()
    }
}

impl<const D: usize> Continuum<D> for WeaklyCompressible<D> {
    type Input = Fluid;
    type Own = Ends;

    const DESCRIPTION: &'static SchemeDescription = &DESCRIPTION;
    const ACCELERATING: [Option<Entry>; ACCELERATIONS] = {
        let [a, b, c, d, e, f] = ACCELERATING;
        [Some(a), Some(b), Some(c), Some(d), Some(e), Some(f)]
    };
    const DRIFTING: [Option<Entry>; DRIFTING] = [
        Some(PRESSURE),
        Some(TRANSPORT),
        Some(LEDGER.entry("pressure_diffusion")),
        Some(LEDGER.entry("density_relaxation")),
    ];
    const REMOVED: Entry = LEDGER.entry("removed");
    const WALLS: Entry = WALLS;
    const HAS_MATERIAL: bool = false;

    fn at_rest(fluid: &Fluid, bodies: usize) -> Vec<AtRest> {
        vec![AtRest { density: fluid.density, wave_speed: fluid.wave_speed }; bodies]
    }

    fn bind(fluid: Fluid, common: &mut Common<D>) -> Result<Self, TransportVelocityError> {
        Ok(Self::new(fluid, common))
    }

    fn part(&self, common: &Common<D>) -> Self {
        let is_sheared = !self.shear.is_empty();
        Self {
            damping: self.damping.part(common.count()),
            open: self.open.part(common),
            shear: vec![Vector::zeros(); if is_sheared { common.count() } else { 0 }],
            ..Self::new(self.fluid, common)
        }
    }

    fn shows(pass: Pass<Ends>) -> usize {
        match pass {
            Pass::Walls => D,
            Pass::Own(Ends::Buffers) => FluidSide::<D>::NUMBERS + D,
            Pass::Own(Ends::Gradients) => GradientSide::<D>::NUMBERS,
            _ => 0,
        }
    }

    fn begin(&self, common: &Common<D>, state: &mut [f64]) {
        self.begin_open(common, state);
    }

    fn open(&mut self, open: OpenBoundaries<D>, common: &mut Common<D>) {
        self.open_up(open, common);
    }

    fn damp_by(&mut self, rate: Arc<dyn SpaceTime>, common: &Common<D>) {
        self.damping = Damping::new(rate, common.count());
    }

    fn damping_at(&self, place: &Vector<D>) -> f64 {
        self.damping.rate(place)
    }

    fn follow(&mut self, common: &mut Common<D>, state: &[f64]) {
        self.follow_roles(common, state);
    }

    fn kept(&self) -> usize {
        self.open.kept()
    }

    fn lead(&self, common: &Common<D>, step: f64, middle: f64, state: &mut [f64]) {
        self.move_buffers(common, step, middle, state);
    }

    fn settle(&self, common: &Common<D>, state: &mut [f64]) {
        self.keep_means(common, state);
    }

    fn body_of(&self, common: &Common<D>, number: usize, state: &[f64]) -> Option<u32> {
        let at = common.columns(state);
        if Common::<D>::is_removed(at.density[number]) {
            return None;
        }
        let stored = Stored::<D>::of(at.tail, common.count());
        if self.open.hides(stored.nesting[number]) {
            return None;
        }
        Some(self.open.body(stored.opening[number]).unwrap_or(common.particles.body[number]))
    }

    fn birth_of(&self, common: &Common<D>, number: usize, state: &[f64]) -> u32 {
        let tail = common.columns(state).tail;
        Stored::<D>::of(tail, common.count()).birth[number] as u32
    }

    fn is_open(&self) -> bool {
        !self.open.is_empty()
    }

    fn waiting(&self, common: &Common<D>, state: &[f64]) -> f64 {
        Self::waiting(self, common, state)
    }

    fn missing(&self, common: &Common<D>, state: &[f64]) -> u64 {
        Self::missing(self, common, state)
    }

    fn add_waiting(&self, common: &Common<D>, more: usize, state: &mut [f64]) {
        Self::add_waiting(self, common, more, state);
    }

    fn passes(&self, common: &Common<D>) -> [Vec<Pass<Ends>>; 2] {
        self.order(common)
    }

    fn stage(pass: Ends) -> Stage {
        stages::stage_of_fluid::<D>(pass)
    }

    fn run(
        &mut self,
        pass: Ends,
        common: &mut Common<D>,
        at: Instant,
        state: &mut [f64],
        totals: &mut Totals,
    ) {
        match pass {
            Ends::Exchange => totals.book(OPENINGS, &self.exchange(common, at.time, state)),
            Ends::Buffers => self.fill_buffers(common, at.time),
            Ends::Gradients => self.find_gradients(common),
            Ends::Forces => self.force_pass(common),
            Ends::Part | Ends::CorrectedPart => self.part_forces(common),
            Ends::Damp => self.damp(common),
            Ends::Excess => self.find_excess(common, state),
        }
    }

    fn update(&mut self, common: &mut Common<D>) -> f64 {
        self.update_density_and_pressure(common)
    }

    fn find_rates(&mut self, common: &Common<D>, time: f64) {
        self.rate_pass(common, time);
    }

    fn advance(&self, common: &Common<D>, step: f64, state: &mut [f64]) -> Drift {
        self.drift(common, step, state)
    }

    fn find_forces(&mut self, common: &mut Common<D>) {
        self.force_pass(common);
    }

    /// A pressure that follows from the density changes at once.
    fn store(&self, common: &Common<D>, state: &mut [f64], totals: &mut Totals) {
        let [of_walls, of_fluid] = self.store_open(common, state);
        totals.part(&[(WALLS, of_walls), (PRESSURE, of_fluid)], OPENINGS);
        totals.part(&[(BODY_FORCE, self.store_damping(common, state))], DAMPING);
        if !common.settings.is_algebraic() {
            return common.store::<Self>(state, totals);
        }
        let before = self.compression_energy(common, state);
        common.store::<Self>(state, totals);
        let gained = self.compression_energy(common, state) - before;
        totals.book(PRESSURE, &Total::of(gained));
    }

    fn make_room(&mut self, common: &Common<D>) {
        let all = common.support.list().len();
        if !self.shear.is_empty() {
            self.shear.resize(all, Vector::zeros());
        }
        if !self.gradients.is_empty() {
            self.gradients.resize(all, Gradients::none());
        }
    }

    fn prepare_fields(&mut self, common: &Common<D>) {
        if common.settings.corrects_gradients() {
            self.find_gradients(common);
        }
    }

    fn set_wall(&mut self, place: usize, values: &WallValues<D>) {
        self.shear[place] = values.shear;
    }

    fn show_walls(&mut self, common: &Common<D>) {
        common.team().refresh(&mut self.shear, common.count(), 1);
    }

    fn rates_at(&self, place: usize) -> &Rates {
        &self.rates[place]
    }

    fn wave_speed(&self) -> Option<f64> {
        Some(self.fluid.wave_speed)
    }

    fn viscosity(&self) -> f64 {
        self.fluid.viscosity
    }

    fn energies(&self, common: &Common<D>, state: &[f64], energies: &mut [f64]) {
        energies[0] = self.compression_energy(common, state);
    }

    fn passed(&self, common: &Common<D>, state: &[f64], body: u32) -> Option<Passage> {
        self.passed_through(common, state, body)
    }

    fn figures(&self, common: &Common<D>, state: &[f64], figures: &mut Vec<f64>) {
        figures.push(common.behind_count(state));
        figures.extend(self.exchanged(common, state));
    }

    fn push_field(
        &self,
        common: &Common<D>,
        field: &FieldDescription,
        number: usize,
        (at, _): (&Columns<'_, D>, &[f64]),
        values: &mut Vec<f64>,
    ) {
        let Some(field) = Own::of(field) else { return };
        let mass = common.mass_at(number, at.density[number]);
        // Of a wall, those of pressure, of viscosity, and the rest.
        let mut push_force = |part: usize| {
            let force = match (self.wall_forces(common, number), part) {
                (None, _) => Vector::zeros(),
                (Some([pressure, _]), 0) => pressure * mass,
                (Some([_, viscosity]), 1) => viscosity * mass,
                (Some([pressure, viscosity]), _) => {
                    at.kick[number] * mass - pressure * mass - viscosity * mass
                }
            };
            values.extend_from_slice(force.as_slice());
        };
        match field {
            Own::summed_density => values.push(summed_density(common, number)),
            Own::pressure_force => push_force(0),
            Own::viscous_force => push_force(1),
            Own::barrier_force => push_force(2),
        }
    }

    fn arrays(&self) -> Vec<Array> {
        vec![
            Array::of::<Rates>("rates"),
            Array::of::<Vector<D>>("shear"),
            Array::with(
                "gradients",
                if self.gradients.is_empty() { 0 } else { size_of::<Gradients<f64, D>>() },
            ),
            Array::of::<f64>("summed"),
            Array::of::<f64>("excess"),
        ]
    }

    fn to_device(
        system: &TransportVelocity<D, Self>,
        device: Device,
        method: DeviceMethod,
    ) -> Result<Box<dyn DeviceSteps>, DeviceRefusal> {
        device::steps::<D, FluidPlan<D>>(system, device, method)
    }

    fn device_stages(
        system: &TransportVelocity<D, Self>,
        language: Language,
        method: DeviceMethod,
    ) -> Result<Vec<DeviceStage>, DeviceRefusal> {
        device::stages::<D, FluidPlan<D>>(system, language, method)
    }
}
