//! A fluid at several resolutions as integrators, clock and output see it.

use std::ops::Range;

use piola_device::{Device, Language};

use super::{Levels, refined};
use crate::fields::FieldDescription;
use crate::schemes::momentum::MOST_COMPONENTS;
use crate::schemes::parts::{own_field, rename};
use crate::schemes::{
    DeviceMethod, DeviceRefusal, DeviceStage, DeviceSteps, Escape, Health, Part, Particle, Passage,
    Phase, RankRefusal, RankShare, Scheme, SchemeDescription, SplitScheme, StepLimit,
};

/// Why it is on no device.
fn refusal() -> DeviceRefusal {
    let (what, instead) = ("a fluid with regions of finer spacing", "leave out `scheme.refine`");
    DeviceRefusal::Stage { what: what.into(), instead }
}

/// Why several ranks have no part of it.
const UNSHARED: RankRefusal = RankRefusal::Feature {
    what: "regions of finer spacing do not run",
    instead: "leave out `scheme.refine`",
};

impl<const D: usize> Scheme for Levels<D> {
    fn description(&self) -> &'static SchemeDescription {
        refined()
    }

    fn dimension(&self) -> usize {
        D
    }

    fn particle_count(&self) -> usize {
        self.parts.bodies.len()
    }

    /// The fields are columns of its levels, and of no state of all.
    fn width(&self) -> usize {
        0
    }

    fn column(&self, _field: &FieldDescription) -> Range<usize> {
        0..0
    }

    fn ledger_start(&self) -> usize {
        self.parts.end()
    }

    fn share(&self, _part: &Part) -> Result<Box<dyn Scheme>, RankRefusal> {
        Err(UNSHARED)
    }

    fn shares(&self, _bounds: &[usize]) -> Result<Vec<RankShare>, RankRefusal> {
        Err(UNSHARED)
    }

    #[inline(never)]
    fn initial_state(&self) -> Vec<f64> {
        self.start.clone()
    }

    /// None: it is moved by kicks and drifts alone.
    #[inline(never)]
    fn rates(&mut self, _time: f64, _state: &[f64], rate: &mut [f64]) {
        rate.fill(0.0);
    }

    #[inline(never)]
    fn constrain(&self, time: f64, state: &mut [f64]) {
        for (level, part) in self.levels.iter().zip(&self.parts.all) {
            level.constrain(time, &mut state[part.state.clone()]);
        }
    }

    /// The bounds on the step are the smallest of all levels.
    #[inline(never)]
    fn inspect(&mut self, state: &[f64], limits: &mut Vec<StepLimit>) -> Health {
        limits.clear();
        let (mut all, mut own) = (Health::NEUTRAL, Vec::new());
        for (k, level) in self.levels.iter_mut().enumerate() {
            let named = |particle: usize| self.parts.named(k, particle);
            let health = level.inspect(&state[self.parts.all[k].state.clone()], &mut own);
            all = all.worse(rename(health, &named));
            for limit in &own {
                let limit = StepLimit { particle: named(limit.particle), ..*limit };
                match limits.iter_mut().find(|known| known.name == limit.name) {
                    Some(known) if known.step <= limit.step => {}
                    Some(known) => *known = limit,
                    None => limits.push(limit),
                }
            }
        }
        all
    }

    #[inline(never)]
    fn escape(&self, index: usize, state: &[f64]) -> Option<Escape> {
        let (k, own) = self.parts.local(index);
        self.levels[k].escape(own, &state[self.parts.all[k].state.clone()])
    }

    #[inline(never)]
    fn figures(&self, state: &[f64], figures: &mut Vec<f64>) {
        let first = figures.len();
        let (mut mass, mut present, mut own) = (0.0, 0.0, Vec::new());
        for (level, part) in self.each(state) {
            own.clear();
            level.figures(part, &mut own);
            figures.resize(first + own.len(), 0.0);
            figures[first..].iter_mut().zip(&own).for_each(|(sum, own)| *sum += own);
            let [of_level, count] = level.matter.counted(&level.common, part);
            (mass, present) = (mass + of_level, present + count);
        }
        figures.extend([mass, present]);
    }

    #[inline(never)]
    fn passed(&self, state: &[f64], body: u32) -> Option<Passage> {
        // The coarsest level alone has open boundaries.
        self.each(state).find_map(|(level, part)| level.passed(part, body))
    }

    #[inline(never)]
    fn energies(&self, state: &[f64], energies: &mut [f64]) {
        energies.fill(0.0);
        let mut own = vec![0.0; energies.len()];
        for (level, part) in self.each(state) {
            level.energies(part, &mut own);
            energies.iter_mut().zip(&own).for_each(|(sum, own)| *sum += own);
        }
    }

    #[inline(never)]
    fn momentum(&self, state: &[f64], momentum: &mut [f64]) {
        momentum.fill(0.0);
        for (level, part) in self.each(state) {
            let mut own = [0.0; MOST_COMPONENTS];
            let own = &mut own[..momentum.len()];
            level.momentum(part, own);
            momentum.iter_mut().zip(own).for_each(|(sum, own)| *sum += *own);
        }
    }

    #[inline(never)]
    fn observe(&mut self, stage: usize, time: f64, state: &[f64]) {
        for (level, part) in self.levels.iter_mut().zip(&self.parts.all) {
            level.observe(stage, time, &state[part.state.clone()]);
        }
    }

    #[inline(never)]
    fn derive(
        &self,
        state: &[f64],
        field: &FieldDescription,
        particles: &[u32],
        values: &mut Vec<f64>,
    ) {
        let Some(own) = own_field(&self.levels[0], field) else { return };
        // Neighbours in the row of all are of one level, for the most part.
        for run in particles
            .chunk_by(|a, b| self.parts.local(*a as usize).0 == self.parts.local(*b as usize).0)
        {
            let k = self.parts.local(run[0] as usize).0;
            let local: Vec<u32> =
                run.iter().map(|&a| self.parts.local(a as usize).1 as u32).collect();
            let (level, part) = (&self.levels[k], &state[self.parts.all[k].state.clone()]);
            match own.is_stored() {
                true => own.read(&part[level.column(&own)], D, &local, values),
                false => level.derive(part, &own, &local, values),
            }
        }
    }

    fn phases(&self) -> Vec<&Phase> {
        self.levels.iter().flat_map(|level| level.phases()).collect()
    }

    #[inline(never)]
    fn parts(&self) -> Vec<(&dyn Scheme, Range<usize>)> {
        let levels = self.levels.iter().map(|level| level as &dyn Scheme);
        levels.zip(self.parts.all.iter().map(|part| part.state.clone())).collect()
    }

    fn missing(&self, state: &[f64]) -> u64 {
        self.each(state).map(|(level, own)| level.missing(own)).sum()
    }

    fn bodies(&self) -> &[u32] {
        &self.parts.bodies
    }

    fn ids(&self) -> &[u32] {
        &self.parts.ids
    }

    fn is_closed(&self) -> bool {
        false
    }

    #[inline(never)]
    fn body_of(&self, state: &[f64], index: usize) -> Option<u32> {
        let (k, own) = self.parts.local(index);
        self.levels[k].body_of(&state[self.parts.all[k].state.clone()], own)
    }

    /// Those of all levels take turns, so that no two are the same.
    #[inline(never)]
    fn birth_of(&self, state: &[f64], index: usize) -> u32 {
        let (k, own) = self.parts.local(index);
        let birth = self.levels[k].birth_of(&state[self.parts.all[k].state.clone()], own);
        let before =
            birth.checked_sub(1).map(|before| before.saturating_mul(self.levels.len() as u32));
        before.map_or(0, |before| before.saturating_add(k as u32 + 1))
    }

    #[inline(never)]
    fn mass(&self, index: usize) -> f64 {
        let (k, own) = self.parts.local(index);
        self.levels[k].mass(own)
    }

    fn width_of(&self, index: usize) -> f64 {
        0.5_f64.powi(self.parts.local(index).0 as i32)
    }

    #[inline(never)]
    fn particle(&self, index: usize) -> Particle {
        let (k, own) = self.parts.local(index);
        Particle { id: self.parts.ids[index], ..self.levels[k].particle(own) }
    }

    #[inline(never)]
    fn neighborhood(&self, index: usize) -> Vec<u32> {
        let (k, own) = self.parts.local(index);
        let near = self.levels[k].neighborhood(own);
        near.into_iter().map(|particle| self.parts.all[k].index[particle as usize]).collect()
    }

    fn stability_advice(&self) -> &'static str {
        self.levels[0].stability_advice()
    }

    #[inline(never)]
    fn collapse_advice(&self, index: usize) -> String {
        let (k, own) = self.parts.local(index);
        self.levels[k].collapse_advice(own)
    }

    #[inline(never)]
    fn memory(&self) -> usize {
        let levels: usize = self.levels.iter().map(|level| level.memory()).sum();
        let transfers = self.transfers.iter().flatten();
        let transfers: usize = transfers.map(|transfer| transfer.memory()).sum();
        levels + transfers + size_of_val(self.start.as_slice())
    }

    /// Accelerations are kept in the state, for kicks.
    fn has_rates(&self) -> bool {
        false
    }

    fn keeps_neighbors(&self) -> bool {
        false
    }

    #[inline(never)]
    fn on_device(
        &self,
        _device: Device,
        _method: DeviceMethod,
    ) -> Result<Box<dyn DeviceSteps>, DeviceRefusal> {
        Err(refusal())
    }

    fn device_stages(
        &self,
        _language: Language,
        _method: DeviceMethod,
    ) -> Result<Vec<DeviceStage>, DeviceRefusal> {
        Err(refusal())
    }

    fn settable(&self, _index: usize) -> &'static [&'static str] {
        &[]
    }

    fn split(&mut self) -> Option<&mut dyn SplitScheme> {
        Some(self)
    }
}

impl<const D: usize> SplitScheme for Levels<D> {
    #[inline(never)]
    fn kick(&mut self, duration: f64, state: &mut [f64]) {
        for (level, part) in self.levels.iter_mut().zip(&self.parts.all) {
            level.kick(duration, &mut state[part.state.clone()]);
        }
        self.sum_up(state);
    }

    #[inline(never)]
    fn drift(&mut self, time: f64, step: f64, state: &mut [f64]) {
        self.exchange(state);
        for (level, part) in self.levels.iter_mut().zip(&self.parts.all) {
            level.drift(time, step, &mut state[part.state.clone()]);
        }
        self.sum_up(state);
    }

    #[inline(never)]
    fn accelerate(&mut self, time: f64, state: &mut [f64]) {
        self.regroup(state);
        self.exchange(state);
        for (level, part) in self.levels.iter_mut().zip(&self.parts.all) {
            level.accelerate(time, &mut state[part.state.clone()]);
        }
        self.sum_up(state);
    }
}
