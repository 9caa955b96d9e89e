//! Elastic and elastic-plastic solids in the transport-velocity formulation, CTVF sections 3.2 and
//! 4.4 to 4.7.
//!
//! ```text
//! drho_a/dt = - rho_a tr L_a + sum V_b (rho_b - rho_a) d_b . grad W_ab
//!   ds_a/dt = 2 G dev sym L_a + Omega_a s_a - s_a Omega_a + sum V_b (s_b - s_a) d_b . grad W_ab
//!   du_a/dt = sum m_b [ sigma_a / rho_a^2 + sigma_b / rho_b^2 - Pi_ab ] . grad W_ab + g
//!      L_a  = - sum V_b u_ab (x) grad W_ab
//! ```
//!
//! with `sigma = s - p` and the pressure of an equation of state: theory (68) to (75), which say
//! where the paper departs. L is made of the momentum velocity; with [`Divergence::Transport`] of the transport
//! velocity, as GTVF has it.
//! Gradients, surfaces and shifting see only the particle's own body and walls; what other bodies
//! do is [`Contact`]. Beside its row, each particle has [`Matter`] at the end of the state.

mod advance;
mod continua;
mod correction;
mod forces;
mod fracture;
mod held;
mod load;
mod rates;

use piola_formulas::hypoelastic::{EquationOfState, Strength};
use piola_formulas::pairs::Record;
pub(super) use piola_formulas::pairs::solid::MATTER;
use piola_formulas::pairs::solid::SolidTension;
use piola_formulas::pairs::wall::{Around, Ghost, StressExtrapolation, Surroundings};

use super::fields::Made;
use super::ledger::{ACCELERATIONS, Drift};
use super::stages::{Pass, stage};
use super::walls::WallValues;
use super::{
    AtRest, Columns, Common, Continuum, Rates, Shown, Slip, TransportVelocity,
    TransportVelocityError,
};
use crate::boundaries::PrescribedVelocity;
use crate::boundaries::prescribed::PrescribedComponents;
use crate::fields::{FieldDescription, columns, width};
use crate::operators::{Among, NeighborBlock, Term, add_at};
use crate::schemes::input::{check_index, check_selected};
use crate::schemes::ledger::{Entry, Total, Totals};
use crate::schemes::stages::Stage;
use crate::schemes::{Accounts, Capability, SchemeDescription};
use crate::{Tensor, Vector};

pub(super) use continua::Continua;
pub use rates::SolidRates;

use fracture::{Bonds, piece_count};

columns! {
    enum Own;
    derived(0) cauchy_stress: Tensor, "Pa", "Cauchy stress, positive in tension";
    derived(0) von_mises: Scalar, "Pa",
        "equivalent stress of von Mises, with the stress across in plane strain";
    derived(0) plastic_strain: Scalar, "1", "equivalent plastic strain";
    derived(0) temperature: Scalar, "K", "temperature";
}

/// The fields of all matter, then those of solids.
const FIELDS: [FieldDescription; Made::FIELDS.len() + Own::FIELDS.len()] =
    FieldDescription::joined(Made::FIELDS, Own::FIELDS);

/// What solids are called and what they show.
pub const DESCRIPTION: SchemeDescription = SchemeDescription {
    name: super::NAME,
    matter: Some("solids"),
    offers: &[Capability::Kicks],
    fields: &FIELDS,
    energies: &["kinetic", "compression", "shear"],
    ledger: LEDGER,
    figures: &[("shifting_passes", "1"), ("removed", "1"), ("gap", "1"), ("pieces", "1")],
};

/// The ledger of solids.
///
/// `pressure` is all stress: what the exchange between kinetic and elastic energy fails to conserve, as the
/// discrete force and divergence are not exact adjoints. Corrections and what is removed are as in
/// fluids.
const LEDGER: Accounts = Accounts {
    mechanisms: &[
        "pressure",
        "artificial_viscosity",
        "transport",
        "walls",
        "body_force",
        "removed",
        "plasticity",
    ],
    impulses: &["walls", "body_force", "corrections", "removed"],
    is_kicked: true,
};
const PRESSURE: Entry = LEDGER.entry("pressure");
const TRANSPORT: Entry = LEDGER.entry_by("transport", "corrections");
const WALLS: Entry = LEDGER.entry("walls");

/// The material of one body.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Solid {
    /// Pressure, with the density in kg/m^3 and the bulk wave speed in m/s at rest.
    pub state: EquationOfState,
    /// Shear modulus in Pa.
    pub shear_modulus: f64,
    /// When it flows.
    pub strength: Strength,
    /// What plastic work does to the temperature.
    pub heat: Heat,
}

/// How plastic work heats a solid.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Heat {
    /// Temperature at the start in K.
    pub temperature: f64,
    /// Specific heat in J/(kg K).
    pub specific_heat: f64,
    /// Share of the plastic work that becomes heat.
    pub share: f64,
}

impl Heat {
    /// Room temperature and a solid that does not warm up.
    pub const NONE: Self = Self { temperature: 293.15, specific_heat: 1.0, share: 0.0 };
}

impl Solid {
    /// Bulk modulus at rest in Pa.
    pub fn bulk_modulus(&self) -> f64 {
        self.state.density * self.state.wave_speed * self.state.wave_speed
    }
}

/// What particles of different bodies do to each other.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Contact {
    /// They approach and part as matter would, so that density and pressure rise between them, and
    /// the pressure acts where it pushes. With it bodies come apart again.
    Repulsive,
    /// All that particles of one body do to each other, as the paper has it: bodies can weld.
    Full,
    /// A spring where they are closer than one spacing.
    Penalty {
        /// Its stiffness in units of the mean bulk modulus times `dx^(D-2)`.
        stiffness: f64,
    },
}

/// All that the formulation needs to know of solids.
pub struct SolidsInput {
    /// Material of each body, of walls too.
    pub materials: Vec<Solid>,
    /// What bodies do to each other.
    pub contact: Contact,
    /// How far apart in m particles of one body must have begun to touch as those of two bodies do; without
    /// it, and with [`Contact::Full`], bodies do not touch themselves.
    pub self_contact: Option<f64>,
    /// Whether velocity gradients are corrected to be exact for linear fields, with the momentum
    /// equation that is conjugate to that, theory (74).
    pub corrected: bool,
    /// Velocity components of particles of solids that are prescribed.
    pub held: Vec<PrescribedVelocity>,
}

/// The deviatoric stress in Pa as xx, yy, zz, yz, xz, xy, the plastic strain, the temperature in K and the
/// specific internal energy in J/kg.
pub(super) type Matter = [f64; MATTER];

const ZZ: usize = 2;
const PLASTIC: usize = 6;
const TEMPERATURE: usize = 7;
const ENERGY: usize = 8;

/// What forces gather of a particle of a solid beside its side.
type Tension<const D: usize> = piola_formulas::pairs::solid::Tension<f64, D>;

/// Solids bound to their particles, with scratch by place.
pub struct Hypoelastic<const D: usize> {
    materials: Vec<Solid>,
    contact: Contact,
    held: PrescribedComponents,
    bonds: Bonds,
    matter: Vec<Matter>,
    /// For which places, counted by lists of neighbours, constants stand in `tensions`.
    builds: Option<u64>,
    tensions: Vec<Tension<D>>,
    rates: Vec<SolidRates<D>>,
    /// Corrections of gradients, if they are corrected.
    corrections: Vec<Tensor<D>>,
}

/// Passes of solids alone.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Stress {
    /// Prescribed velocities are set.
    Prescribe,
    /// Corrections of gradients.
    Correct,
    /// Stresses that forces gather.
    Tension,
    /// Accelerations of what is prescribed.
    Hold,
}

impl<const D: usize> Hypoelastic<D> {
    /// Whether bulk waves are as fast in all solids.
    fn is_uniform(&self) -> bool {
        let speeds = || self.materials.iter().map(|solid| solid.state.wave_speed);
        speeds().all(|speed| speeds().next() == Some(speed))
    }

    /// Whether no solid flows or heats up.
    fn is_elastic(&self) -> bool {
        let is_elastic =
            |solid: &Solid| solid.strength == Strength::Elastic && !solid.state.is_caloric();
        self.materials.iter().all(is_elastic)
    }

    /// The solid that a particle (number) is of.
    fn solid(&self, common: &Common<D>, number: usize) -> &Solid {
        &self.materials[common.particles.body[number] as usize]
    }
}

impl<const D: usize> TransportVelocity<D, Hypoelastic<D>> {
    /// The velocity gradients and other rates of solids of the last pass, by number, for those who
    /// want to see them apart.
    pub fn solid_rates(&self) -> Vec<SolidRates<D>> {
        let places = self.common.support.list().places().iter();
        places.map(|&place| self.matter.rates[place as usize]).collect()
    }
}

impl<const D: usize> Continuum<D> for Hypoelastic<D> {
    type Input = SolidsInput;
    type Own = Stress;

    const DESCRIPTION: &'static SchemeDescription = &DESCRIPTION;
    const ACCELERATING: [Option<Entry>; ACCELERATIONS] = [
        Some(PRESSURE),
        None,
        Some(LEDGER.entry("artificial_viscosity")),
        Some(TRANSPORT),
        Some(WALLS),
        Some(LEDGER.entry("body_force")),
    ];
    const DRIFTING: [Entry; 3] = [PRESSURE, TRANSPORT, LEDGER.entry("plasticity")];
    const REMOVED: Entry = LEDGER.entry("removed");
    const WALLS: Entry = WALLS;
    const SHOWN: Shown = Shown {
        state: &[
            "position",
            "velocity",
            "density",
            "pressure",
            "acceleration",
            "shifting_velocity",
            "material_state",
        ],
        moved: &["position", "density", "pressure", "material_state"],
        side: SIDE,
        wall: SIDE,
    };

    fn at_rest(input: &SolidsInput, _bodies: usize) -> Vec<AtRest> {
        let of = |solid: &Solid| AtRest {
            density: solid.state.density,
            wave_speed: solid.state.wave_speed,
        };
        input.materials.iter().map(of).collect()
    }

    fn bind(input: SolidsInput, common: &mut Common<D>) -> Result<Self, TransportVelocityError> {
        let (count, support) = (common.particles.len(), common.support.list().support());
        if let Some(distance) = input.self_contact.filter(|&distance| !(distance > support)) {
            return Err(TransportVelocityError::SelfContact { distance, support });
        }
        for condition in &input.held {
            check_selected(&condition.name, &condition.particles, count)?;
            let what = || format!("`{}`: velocity component", condition.name);
            check_index(what, condition.component, D)?;
        }
        common.continua = Continua::of(&input, common);
        let held = PrescribedComponents::new(&input.held, &common.particles.position);
        common.unshifted = vec![false; count];
        held.iter().for_each(|entry| common.unshifted[entry.particle] = true);
        Ok(Self {
            materials: input.materials,
            contact: input.contact,
            held,
            bonds: Bonds::new(common)?,
            matter: vec![[0.0; MATTER]; count],
            builds: None,
            tensions: vec![SolidTension::zero(); count],
            rates: vec![SolidRates::default(); count],
            corrections: vec![Tensor::identity(); if input.corrected { count } else { 0 }],
        })
    }

    fn begin(&self, common: &Common<D>, state: &mut [f64]) {
        self.begin_matter(&common.particles.body, &mut state[matter_start(common)..]);
    }

    fn passes(&self, common: &Common<D>) -> [Vec<Pass<Stress>>; 2] {
        let only = |is_on: bool, pass| if is_on { vec![Pass::Own(pass)] } else { Vec::new() };
        let [walls, body_forces, shift] = common.passes();
        let is_held = self.held.iter().next().is_some();
        let correct = only(!self.corrections.is_empty(), Stress::Correct);
        let (prescribe, hold) = (only(is_held, Stress::Prescribe), only(is_held, Stress::Hold));
        let moving = vec![Pass::Rates, Pass::Move];
        let drift = [prescribe, common.spread(), correct.clone(), walls.clone(), moving];
        let (found, stored) = (vec![Pass::Remove, Pass::Load, Pass::State], vec![Pass::Store]);
        let forces = vec![Pass::Own(Stress::Tension), Pass::Forces];
        let accelerate = [found, correct, walls, forces, body_forces, hold, shift, stored];
        [drift.concat(), accelerate.concat()]
    }

    fn stage(pass: Stress) -> Stage {
        match pass {
            Stress::Prescribe => stage("prescribe", [&["position"], &[], &[], &["velocity"]]),
            Stress::Correct => stage("correct", [&[], &["side.density"], &["correction"], &[]]),
            Stress::Tension => {
                stage("tension", [&["side.pressure", "side.material"], &[], &[], &["tension"]])
            }
            Stress::Hold => stage("hold", [&["forces"], &[], &["forces"], &[]]),
        }
    }

    fn run(
        &mut self,
        pass: Stress,
        common: &mut Common<D>,
        time: f64,
        state: &mut [f64],
        totals: &mut Totals,
    ) {
        match pass {
            Stress::Prescribe => totals.book(WALLS, &self.prescribe(common, time, state)),
            Stress::Correct => self.correct_gradients(common),
            Stress::Tension => self.tension_pass(common),
            Stress::Hold => self.hold_accelerations(common),
        }
    }

    fn load(&mut self, common: &Common<D>, state: &[f64]) {
        self.load_matter(common, state);
    }

    fn prescribe(&self, common: &Common<D>, time: f64, state: &mut [f64]) -> Total {
        self.hold_velocities(common, time, state)
    }

    fn update(&mut self, common: &mut Common<D>) -> f64 {
        self.update_pressure(common)
    }

    fn find_rates(&mut self, common: &Common<D>, _time: f64) {
        self.rate_pass(common);
    }

    fn advance(&self, common: &Common<D>, step: f64, state: &mut [f64]) -> Drift {
        self.drift(common, step, state)
    }

    fn find_forces(&mut self, common: &mut Common<D>) {
        self.force_pass(common);
    }

    fn around(
        &self,
        common: &Common<D>,
        place: usize,
        values: &mut WallValues<D>,
        block: &mut NeighborBlock<D>,
    ) -> Around<f64, D> {
        let mut both = (Surroundings::zero(), values.deviator);
        let source = (common.sides.as_slice(), self.matter.as_slice());
        let sum = Term { law: StressExtrapolation::<D>, source, among: Among::Active };
        add_at(&common.support, &sum, place, block, &mut both);
        values.deviator = both.1;
        both.0
    }

    fn reflect(
        &self,
        slip: Slip,
        normal: &Vector<D>,
        ghost: &Ghost<f64, D>,
        values: &mut WallValues<D>,
    ) {
        match slip {
            // What is clamped does not slide in its gradients either.
            Slip::No => (values.velocity, values.deviation) = (values.shear, -ghost.carried),
            Slip::Free => values.mirror = Some(*normal),
        }
    }

    fn set_wall(&mut self, place: usize, values: &WallValues<D>) {
        self.set_deviator(place, &values.deviator, values.mirror.as_ref());
    }

    fn speed_squared(&self, common: &Common<D>, place: usize) -> f64 {
        let number = common.support.list().numbers()[place] as usize;
        self.solid(common, number).speed_squared(&common.sides[place], &self.matter[place])
    }

    fn rates_at(&self, common: &Common<D>, place: usize) -> (Rates, f64, [f64; 3]) {
        let (rates, density) = (&self.rates[place], common.sides[place].density);
        let solid = self.solid(common, common.support.list().numbers()[place] as usize);
        (rates.common, rates.density_rate(density), rates.pressure_rates(density, solid))
    }

    /// That of longitudinal waves.
    fn wave_speed_of(&self, common: &Common<D>, number: usize, state: &[f64]) -> Option<f64> {
        let matter = matter_of(common, number, state);
        if !matter.iter().all(|value| value.is_finite()) {
            return None;
        }
        let (solid, density) = (self.solid(common, number), common.columns(state).density[number]);
        let bulk = solid.state.wave_speed_squared(density, matter[ENERGY]);
        Some((bulk + 4.0 / 3.0 * solid.shear_modulus / density).sqrt())
    }

    fn energies(&self, common: &Common<D>, state: &[f64], energies: &mut [f64]) {
        energies.copy_from_slice(&self.elastic_energies(common, state));
    }

    fn figures(&self, common: &Common<D>, state: &[f64], figures: &mut Vec<f64>) {
        figures.extend([self.largest_gap(common, state), piece_count(common, state)]);
    }

    fn push_field(
        &self,
        common: &Common<D>,
        field: &FieldDescription,
        number: usize,
        (at, state): (&Columns<'_, D>, &[f64]),
        values: &mut Vec<f64>,
    ) {
        let Some(field) = Own::of(field) else { return };
        self.push_own(field, at.pressure[number], matter_of(common, number, state), values);
    }

    fn length(&self, common: &Common<D>) -> usize {
        MATTER * common.particles.len()
    }

    fn memory() -> usize {
        size_of::<SolidRates<D>>() + size_of::<Tension<D>>() + size_of::<Matter>()
    }
}

/// Where the matter of solids begins in a state.
fn matter_start<const D: usize>(common: &Common<D>) -> usize {
    common.particles.len() * width(&FIELDS, D) + LEDGER.length(D) + 1
}

/// The matter of a particle (number) in a state.
fn matter_of<'a, const D: usize>(common: &Common<D>, number: usize, state: &'a [f64]) -> &'a [f64] {
    &state[matter_start(common) + number * MATTER..][..MATTER]
}

/// What neighbours see of a solid, and of its walls.
const SIDE: &[&str] =
    &["side.velocity", "side.shifting_velocity", "side.density", "side.pressure", "side.material"];

/// The entry of a symmetric 3 x 3 tensor that is stored as xx, yy, zz, yz, xz, xy.
#[inline]
fn entry(i: usize, j: usize) -> usize {
    if i == j { i } else { 6 - i - j }
}

/// A stored tensor as a matrix.
#[inline]
fn full(stored: &[f64]) -> Tensor<3> {
    Tensor::<3>::from_fn(|i, j| stored[entry(i, j)])
}

/// Stores a symmetric matrix.
#[inline]
fn store(tensor: &Tensor<3>, stored: &mut [f64]) {
    for (i, j) in [(0, 0), (1, 1), (2, 2), (1, 2), (0, 2), (0, 1)] {
        stored[entry(i, j)] = tensor[(i, j)];
    }
}

/// The normal of a plane in three dimensions.
fn padded<const D: usize>(vector: &Vector<D>) -> Vector<3> {
    Vector::<3>::from_fn(|i, _| if i < D { vector[i] } else { 0.0 })
}
