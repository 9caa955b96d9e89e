//! From an upwind body to its passes and columns on a device, or what has none there.

use piola_device::{Device, Language, Layout, Machine, Precision};
use piola_formulas::pairs::Record as _;
use piola_formulas::pairs::upwind::{UpwindSide, UpwindSlope};

use super::super::fields::Made;
use super::super::{KEPT, LEDGER, Upwind};
use super::OnDevice;
use super::passes::{FIGURES, Method, PAIRS, Plan, shown, state, terms};
use crate::Vector;
use crate::boundaries::prescribed::Entry;
use crate::parallel::chunk;
use crate::schemes::blend;
use crate::schemes::device::{
    DeviceMethod, DeviceRefusal, DeviceStage, DeviceSteps, Gravity, Listed, Room, StateColumn,
    StateColumns, fits, solid, staged,
};
use crate::schemes::split::KICK_DRIFT_KICK;

/// Columns that may be in single precision: rows, and what is computed of them. Neighbours read sides and slopes.
const LAYOUT: Layout =
    Layout { narrow: &["areas", "side", "slope", "inverse"], planes: &["side", "slope"] };

/// What the stages of a step start on a device.
const STAGES: [(&str, &[&str]); 7] = [
    ("kick", &["kick_velocities"]),
    ("local", &["sides"]),
    ("slopes", &["slopes"]),
    ("pairs", &["exchange"]),
    ("boundary", &["show", "take", "impose"]),
    ("advance", &["drift", "predict", "halve", "blend_quarter", "blend_two_thirds"]),
    ("look", &["look"]),
];

/// The middle of the box around some places.
fn middle<const D: usize>(places: &[Vector<D>]) -> Vector<D> {
    let first = places.first().copied().unwrap_or_else(Vector::zeros);
    let corners =
        places.iter().fold([first; 2], |[low, high], place| [low.inf(place), high.sup(place)]);
    corners[0].lerp(&corners[1], 0.5)
}

impl<const D: usize> Upwind<D> {
    /// The steps of the body on a device.
    pub(in super::super) fn body_to_device(
        &self,
        device: Device,
        method: DeviceMethod,
    ) -> Result<Box<dyn DeviceSteps>, DeviceRefusal> {
        let count = self.particles.len();
        let mass = |a: usize| self.mass(a);
        let listed = Listed::new(&self.loaded, &[], &self.prescribed, [], mass);
        let plan = self.device_plan(method)?;
        let (pairs, of_pairs) = self.areas.pairs.columns(PAIRS);
        let names = state::<D>().map(|([name, before, _], _)| [name, before]);
        let columns = StateColumn::all(Made::FIELDS, [D, count], &names);
        let room = Room { scratch: self.scratch(&listed), filled: self.filled(&plan) };
        let layout = method.layout(LAYOUT);
        let all = StateColumns::bytes(&columns).chain(room.bytes());
        let of_rows = [(pairs.rows.numbers, of_pairs.bytes())];
        fits(&device, layout.narrow, all.chain(of_rows))?;
        let passes = |dialect| plan.passes(dialect, &pairs);
        let mut machine = Machine::new(device, None, layout, passes, chunk(count))?;
        let tail = LEDGER.length(D) + KEPT;
        let state = StateColumns::new(columns, tail);
        state.make(&mut machine, |_| 0)?;
        room.make(&mut machine)?;
        of_pairs.add(&mut machine, &pairs.rows)?;
        machine.add_indices("listed", &listed.particles)?;
        let component = |entry: &Entry| (entry.particle * D + entry.component) as u32;
        let components: Vec<u32> = self.prescribed.iter().map(component).collect();
        machine.add_indices("component", &components)?;
        machine.add_zeros("value", components.len())?;
        Ok(Box::new(OnDevice {
            machine,
            state,
            stages: self.stages.clone(),
            particles: self.particles.clone(),
            body_forces: self.body_forces.clone(),
            listed,
            prescribed: self.prescribed.clone(),
            limits: self.bounds(),
            rate: vec![0.0; tail],
            plan,
            gravity: Gravity::default(),
            is_rated: false,
        }))
    }

    /// What the passes depend on.
    fn device_plan(&self, method: DeviceMethod) -> Result<Plan<D>, DeviceRefusal> {
        let DeviceMethod { integrator, precision } = method;
        let (kicks, able) = match self.is_conservative() {
            true => (Some(Method::Kicks), "`kick_drift_kick`, `tvd_rk2` or `ssp_rk3`"),
            false => (None, "`tvd_rk2` or `ssp_rk3`"),
        };
        let of_steps = blend::stages(integrator)
            .map(Method::RungeKutta)
            .or_else(|| kicks.filter(|_| integrator == KICK_DRIFT_KICK))
            .ok_or(DeviceRefusal::Integrator { integrator, able })?;
        Ok(Plan {
            settings: self.settings,
            periods: self.periods(),
            laws: self.materials.iter().map(|material| material.law).collect(),
            is_pulled: !self.body_forces.is_empty(),
            method: of_steps,
            origin: (precision == Precision::Single).then(|| middle(&self.particles.position)),
        })
    }

    /// The stages of its steps on a device.
    pub(in super::super) fn body_stages(
        &self,
        language: Language,
        method: DeviceMethod,
    ) -> Result<Vec<DeviceStage>, DeviceRefusal> {
        let (pairs, _) = self.areas.pairs.columns(PAIRS);
        let passes = self.device_plan(method)?.passes(method.dialect(language, LAYOUT), &pairs);
        Ok(staged(&passes, &STAGES))
    }

    /// Columns of work with their lengths.
    fn scratch(&self, listed: &Listed<D>) -> Vec<(&'static str, usize)> {
        let (count, rows) = (self.particles.len(), listed.len());
        let mut all = vec![
            ("side", count * UpwindSide::<D>::NUMBERS),
            ("terms", count * terms(D).max(FIGURES)),
            ("gravity", count * D),
            ("shown", rows * solid::width(&shown::<D>())),
            ("given", rows * D),
        ];
        all.extend(state::<D>().map(|([_, _, rate], width)| (rate, count * width)));
        if self.settings.reconstruction {
            all.push(("slope", count * UpwindSlope::<D>::NUMBERS));
        }
        all
    }

    /// Columns that do not change.
    fn filled(&self, plan: &Plan<D>) -> Vec<(&'static str, Vec<f64>)> {
        let (count, particles) = (self.particles.len(), &self.particles);
        let each = |of: &dyn Fn(usize) -> f64| (0..count).map(of).collect::<Vec<f64>>();
        let place = particles.position.iter().flat_map(|place| place.iter().copied());
        let diagonal = |a: usize| (0..D).map(move |i| self.areas.diagonal(a)[i]);
        let mut all: Vec<(&'static str, Vec<f64>)> = vec![
            ("volume", particles.volume.clone()),
            ("mass", each(&|a| self.mass(a))),
            ("density", each(&|a| self.reference[a].density)),
            ("wave_speed", each(&|a| self.reference[a].wave_speed)),
            ("prestress", each(&|a| self.reference[a].ratio)),
            ("nearest", self.nearest.clone()),
            ("reference", place.collect()),
            ("diagonal", (0..count).flat_map(diagonal).collect()),
        ];
        if plan.laws.len() > 1 {
            all.push(("body", each(&|a| f64::from(particles.body[a]))));
        }
        if let Some(least_squares) = &self.least_squares {
            let inverse = |a: usize| {
                let inverse = least_squares.inverse(a);
                (0..D * D).map(move |k| inverse[(k / D, k % D)])
            };
            all.push(("inverse", (0..count).flat_map(inverse).collect()));
        }
        all
    }
}
