//! Solids as a system of the formulation.

use piola_device::{Device, Language};
use piola_formulas::hypoelastic::von_mises;
use piola_formulas::pairs::Record;
use piola_formulas::pairs::solid::{MATTER, SolidTension};
use piola_formulas::pairs::wall::{Around, Ghost, StressExtrapolation, Surroundings};

use super::fracture::{Bonds, piece_count};
use super::{
    Contact, ENERGY, Hypoelastic, Matter, PLASTIC, Solid, SolidRates, SolidsInput, TEMPERATURE,
    Tension, cauchy_stress, full,
};
use crate::boundaries::prescribed::PrescribedComponents;
use crate::fields::{FieldDescription, columns};
use crate::operators::{Among, NeighborBlock, Term, add_at};
use crate::schemes::input::{check_index, check_selected};
use crate::schemes::ledger::{Entry, Total, Totals};
use crate::schemes::stages::Stage;
use crate::schemes::transport_velocity::device::{self, SolidPlan};
use crate::schemes::transport_velocity::fields::Made;
use crate::schemes::transport_velocity::ledger::{ACCELERATIONS, DRIFTING, Drift};
use crate::schemes::transport_velocity::stages::{Instant, Pass, stage};
use crate::schemes::transport_velocity::walls::WallValues;
use crate::schemes::transport_velocity::{
    AtRest, Columns, Common, Continua, Continuum, NAME, Rates, Slip, TransportVelocity,
    TransportVelocityError,
};
use crate::schemes::{
    Accounts, Array, Capability, DeviceMethod, DeviceRefusal, DeviceStage, DeviceSteps,
    SchemeDescription,
};
use crate::{Tensor, Vector};

columns! {
    pub(super) struct Stored, StoredMut, enum Own;
    derived(0) displacement: Vector, "m", "x - X; in a periodic box the shortest difference";
    kept deviatoric_stress: Symmetric, "Pa", "deviatoric stress";
    derived(0) cauchy_stress: Tensor, "Pa", "Cauchy stress, positive in tension";
    derived(0) von_mises: Scalar, "Pa",
        "von Mises equivalent stress, including the out-of-plane stress in plane strain";
    evolved plastic_strain: Scalar, "1", "equivalent plastic strain";
    evolved temperature: Scalar, "K", "temperature";
    kept internal_energy: Scalar, "J/kg", "specific internal energy";
}

/// The fields of all matter, then those of solids.
const FIELDS: [FieldDescription; Made::FIELDS.len() + Own::FIELDS.len()] =
    FieldDescription::joined(Made::FIELDS, Own::FIELDS);

/// What solids are called and what they show.
pub const DESCRIPTION: SchemeDescription = SchemeDescription {
    name: NAME,
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

/// Passes of solids alone.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Stress {
    /// Corrections of gradients.
    Correct,
    /// Stresses that forces gather.
    Tension,
    /// Accelerations of what is prescribed.
    Hold,
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
    const DRIFTING: [Option<Entry>; DRIFTING] =
        [Some(PRESSURE), Some(TRANSPORT), Some(LEDGER.entry("plasticity")), None];
    const REMOVED: Entry = LEDGER.entry("removed");
    const WALLS: Entry = WALLS;
    const HAS_MATERIAL: bool = true;

    fn at_rest(input: &SolidsInput, _bodies: usize) -> Vec<AtRest> {
        let of = |solid: &Solid| AtRest {
            density: solid.state.density,
            wave_speed: solid.state.wave_speed,
        };
        input.materials.iter().map(of).collect()
    }

    fn bind(input: SolidsInput, common: &mut Common<D>) -> Result<Self, TransportVelocityError> {
        let (count, support) = (common.count(), common.support.list().support());
        if let Some(distance) = input.self_contact.filter(|&distance| !(distance > support)) {
            return Err(TransportVelocityError::SelfContact { distance, support });
        }
        for condition in &input.held {
            check_selected(&condition.name, &condition.particles, count)?;
            let what = || format!("`{}`: velocity component", condition.name);
            check_index(what, condition.component, D)?;
        }
        if input.contact != Contact::Full {
            common.continua = Continua::of_bodies(common, input.self_contact);
        }
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

    fn part(&self, common: &Common<D>) -> Self {
        let (count, all) = (common.count(), common.support.list().len());
        Self {
            materials: self.materials.clone(),
            contact: self.contact,
            held: self.held.clone(),
            // Figures are those of all particles.
            bonds: Bonds::default(),
            matter: vec![[0.0; MATTER]; all],
            builds: None,
            tensions: vec![SolidTension::zero(); all],
            rates: vec![SolidRates::default(); count],
            corrections: vec![
                Tensor::identity();
                if self.corrections.is_empty() { 0 } else { count }
            ],
        }
    }

    fn shows(pass: Pass<Stress>) -> usize {
        match pass {
            Pass::Load | Pass::Walls => MATTER,
            Pass::Own(Stress::Tension) => SolidTension::<D>::NUMBERS,
            _ => 0,
        }
    }

    fn begin(&self, common: &Common<D>, state: &mut [f64]) {
        let (own, _) = StoredMut::<D>::of(common.parts(state).1, common.count());
        for (temperature, &body) in own.temperature.iter_mut().zip(&common.particles.body) {
            *temperature = self.materials[body as usize].heat.temperature;
        }
    }

    fn passes(&self, common: &Common<D>) -> [Vec<Pass<Stress>>; 2] {
        let only = |is_on: bool, pass| if is_on { vec![Pass::Own(pass)] } else { Vec::new() };
        let [walls, body_forces, shift, barrier] = common.passes();
        let is_held = self.held.iter().next().is_some();
        let correct = only(!self.corrections.is_empty(), Stress::Correct);
        let prescribe = if is_held { vec![Pass::Prescribe] } else { Vec::new() };
        let moving = vec![Pass::Rates, Pass::Move];
        let drift = [prescribe, common.spread(), correct.clone(), walls.clone(), moving];
        let (found, stored) = (vec![Pass::Remove, Pass::Load, Pass::State], vec![Pass::Store]);
        let forces = vec![Pass::Own(Stress::Tension), Pass::Forces];
        let accelerate = [
            found,
            correct,
            walls,
            forces,
            body_forces,
            shift,
            barrier,
            only(is_held, Stress::Hold),
            stored,
        ];
        [drift.concat(), accelerate.concat()]
    }

    fn stage(pass: Stress) -> Stage {
        match pass {
            Stress::Correct => {
                let gathers = &["place", "side.density"];
                stage("correct", [&["neighbors.active"], gathers, &["correction"], &[]])
            }
            Stress::Tension => {
                let reads = &["side.pressure", "side.material", "correction"];
                stage("tension", [reads, &[], &[], &["tension"]])
            }
            Stress::Hold => stage("hold", [&["forces"], &[], &["forces"], &[]]),
        }
    }

    fn run(
        &mut self,
        pass: Stress,
        common: &mut Common<D>,
        _at: Instant,
        _state: &mut [f64],
        _totals: &mut Totals,
    ) {
        match pass {
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

    fn make_room(&mut self, common: &Common<D>) {
        let all = common.support.list().len();
        self.matter.resize(all, [0.0; MATTER]);
        self.tensions.resize(all, SolidTension::zero());
    }

    fn set_wall(&mut self, place: usize, values: &WallValues<D>) {
        self.set_deviator(place, &values.deviator, values.mirror.as_ref());
    }

    fn show_walls(&mut self, common: &Common<D>) {
        self.show_matter(common);
    }

    fn speed_squared(&self, common: &Common<D>, place: usize) -> f64 {
        let number = common.support.list().numbers()[place] as usize;
        self.solid(common, number).speed_squared(&common.sides[place], &self.matter[place])
    }

    fn rates_at(&self, place: usize) -> &Rates {
        &self.rates[place].common
    }

    /// That of longitudinal waves.
    fn wave_speed_of(&self, common: &Common<D>, row: usize, state: &[f64]) -> Option<f64> {
        let matter = matter_of(common, row, state);
        if !matter.iter().all(|value| value.is_finite()) {
            return None;
        }
        let solid = self.solid(common, common.first() + row);
        let density = common.columns(state).density[row];
        Some(solid.longitudinal_speed(density, matter[ENERGY]))
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
        let (pressure, matter) = (at.pressure[number], matter_of(common, number, state));
        match Own::of(field) {
            Some(Own::displacement) => {
                let (start, end) = (&common.particles.position[number], &at.position[number]);
                let way = common.support.list().domain().separation(start, end);
                values.extend_from_slice(way.as_slice());
            }
            Some(Own::cauchy_stress) => {
                values.extend_from_slice(cauchy_stress::<_, D>(pressure, &matter).as_slice());
            }
            Some(Own::von_mises) => values.push(von_mises(&full(&matter))),
            None => {}
        }
    }

    fn arrays(&self) -> Vec<Array> {
        let correction = if self.corrections.is_empty() { 0 } else { size_of::<Tensor<D>>() };
        vec![
            Array::of::<SolidRates<D>>("rates"),
            Array::of::<Tension<D>>("tension"),
            Array::of::<Matter>("side.material"),
            Array::with("correction", correction),
        ]
    }

    fn to_device(
        system: &TransportVelocity<D, Self>,
        device: Device,
        method: DeviceMethod,
    ) -> Result<Box<dyn DeviceSteps>, DeviceRefusal> {
        device::steps::<D, SolidPlan<D>>(system, device, method)
    }

    fn device_stages(
        system: &TransportVelocity<D, Self>,
        language: Language,
        method: DeviceMethod,
    ) -> Result<Vec<DeviceStage>, DeviceRefusal> {
        device::stages::<D, SolidPlan<D>>(system, language, method)
    }
}

impl<const D: usize> Stored<'_, D> {
    /// The columns of a state.
    pub fn in_state<'a>(common: &Common<D>, state: &'a [f64]) -> Stored<'a, D> {
        Stored::of(common.columns(state).tail, common.count())
    }

    /// What a particle (row) has.
    #[inline]
    pub fn matter(&self, a: usize) -> Matter {
        let scalars = [self.plastic_strain[a], self.temperature[a], self.internal_energy[a]];
        row(&self.deviatoric_stress[a], scalars)
    }
}

impl<const D: usize> StoredMut<'_, D> {
    /// What the particle of entry k has.
    #[inline]
    pub fn matter(&self, k: usize) -> Matter {
        let scalars = [self.plastic_strain[k], self.temperature[k], self.internal_energy[k]];
        row(&self.deviatoric_stress[k], scalars)
    }

    /// Gives it to the particle of entry k.
    #[inline]
    pub fn set(&mut self, k: usize, matter: &Matter) {
        self.deviatoric_stress[k].copy_from_slice(&matter[..PLASTIC]);
        (self.plastic_strain[k], self.temperature[k]) = (matter[PLASTIC], matter[TEMPERATURE]);
        self.internal_energy[k] = matter[ENERGY];
    }
}

/// A deviatoric stress, the plastic strain, the temperature and the energy together.
#[inline]
fn row(&[a, b, c, d, e, f]: &[f64; 6], [plastic, temperature, energy]: [f64; 3]) -> Matter {
    [a, b, c, d, e, f, plastic, temperature, energy]
}

/// The matter of a particle (row) in a state.
#[inline]
pub(super) fn matter_of<const D: usize>(common: &Common<D>, row: usize, state: &[f64]) -> Matter {
    Stored::in_state(common, state).matter(row)
}
