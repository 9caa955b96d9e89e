//! A world as clock, observers and output see it: one formulation with the particles of all.

use std::ops::Range;

use piola_device::{Device, Language};

use super::description::CONTACT;
use super::flow::Way;
use super::{MOST_STEPS, World};
use crate::Vector;
use crate::fields::{ABSENT, FieldDescription};
use crate::parallel::Team;
use crate::schemes::momentum::MOST_COMPONENTS;
use crate::schemes::parts::{own_field, rename};
use crate::schemes::{
    Behind, CoupledScheme, DeviceMethod, DeviceRefusal, DeviceStage, DeviceSteps, Escape, Health,
    Part, Particle, Passage, Phase, RankRefusal, RankShare, Scheme, SchemeDescription, StepLimit,
};

/// The fields of walls of the fluid that solids have in it too: what the fluid does to them.
const BORNE: [&str; 4] = ["force", "pressure_force", "viscous_force", "barrier_force"];

/// What to change where a solid goes through what it touches.
const THROUGH_ADVICE: &str = "raise the wave speed of the fluid to ten times the speeds that occur, or \
    `contact_stiffness` of the system with a smaller `time.cfl`";

/// What to change where a solid comes apart.
const TORN_ADVICE: &str = "the fluid follows a hypoelastic solid through the initial neighbours \
of its particles, as long as the solid stays whole: make it stiffer or stronger, reduce its \
loads, set `shifting = \"none\"` in its scheme if shifting moves its particles past each other, \
or end the run earlier; solids of \
    `total_lagrangian` keep their neighbours";

impl<const D: usize> World<D> {
    /// Forces that the fluid exerts on the particles of a solid, by a field of its walls.
    fn borne(&self, solid: usize, field: &FieldDescription, state: &[f64]) -> Vec<Vector<D>> {
        let solid = &self.solids[solid];
        let mut borne = vec![Vector::zeros(); solid.mass.len()];
        let (walls, mut forces) = (solid.interface.walls(), Vec::new());
        if let Some(field) = own_field(&self.fluid, field) {
            self.fluid.derive(&state[self.parts.all[0].state.clone()], &field, walls, &mut forces);
        }
        for (row, force) in forces.chunks_exact(D).enumerate() {
            solid.interface.bear(row, &Vector::from_column_slice(force), &mut borne);
        }
        borne
    }
}

impl<const D: usize> Scheme for World<D> {
    fn description(&self) -> &'static SchemeDescription {
        self.description
    }

    fn dimension(&self) -> usize {
        D
    }

    fn on_device(
        &self,
        _device: Device,
        _method: DeviceMethod,
    ) -> Result<Box<dyn DeviceSteps>, DeviceRefusal> {
        Err(DeviceRefusal::Systems)
    }

    fn device_stages(
        &self,
        _language: Language,
        _method: DeviceMethod,
    ) -> Result<Vec<DeviceStage>, DeviceRefusal> {
        Err(DeviceRefusal::Systems)
    }

    fn share(&self, part: &Part) -> Result<Box<dyn Scheme>, RankRefusal> {
        Ok(Box::new(self.shared(part)?))
    }

    fn divided(&self) -> Option<&dyn Scheme> {
        Some(&self.fluid)
    }

    fn shares(&self, bounds: &[usize]) -> Result<Vec<RankShare>, RankRefusal> {
        self.planned(bounds)
    }

    fn team(&self) -> Option<&Team> {
        self.fluid.team()
    }

    fn particle_count(&self) -> usize {
        self.count_with(&self.fluid.own())
    }

    /// The fields are columns of its systems, and of no state of all.
    fn width(&self) -> usize {
        0
    }

    fn column(&self, _field: &FieldDescription) -> Range<usize> {
        0..0
    }

    /// One of a system, unless the field is of what others do to it.
    #[inline(never)]
    fn stretch(&self, field: &FieldDescription, particles: &Range<usize>) -> Option<Range<usize>> {
        let (k, particles) = self.parts.run_of(particles)?;
        if k > 0 && BORNE.contains(&field.name) {
            return None;
        }
        let own = own_field(self.system(k), field)?;
        let (start, own) =
            (self.parts.all[k].state.start, self.system(k).stretch(&own, &particles)?);
        Some(start + own.start..start + own.end)
    }

    fn ledger_start(&self) -> usize {
        self.ledger_at()
    }

    #[inline(never)]
    fn initial_state(&self) -> Vec<f64> {
        self.start.clone()
    }

    /// The rates of each system alone.
    #[inline(never)]
    fn rates(&mut self, time: f64, state: &[f64], rate: &mut [f64]) {
        rate.fill(0.0);
        let own = |k: usize| self.parts.all[k].state.clone();
        self.fluid.rates(time, &state[own(0)], &mut rate[own(0)]);
        for (k, solid) in (1..).zip(&mut self.solids) {
            let own = self.parts.all[k].state.clone();
            solid.scheme.rates(time, &state[own.clone()], &mut rate[own]);
        }
    }

    #[inline(never)]
    fn constrain(&self, time: f64, state: &mut [f64]) {
        for (k, part) in self.parts.all.iter().enumerate() {
            self.system(k).constrain(time, &mut state[part.state.clone()]);
        }
    }

    #[inline(never)]
    fn find_neighbors(&mut self, state: &[f64]) {
        self.follow(state);
        self.fluid.find_neighbors(&state[self.parts.all[0].state.clone()]);
        for (solid, part) in self.solids.iter_mut().zip(&self.parts.all[1..]) {
            solid.scheme.find_neighbors(&state[part.state.clone()]);
        }
    }

    /// The bounds on the step are those of the fluid, of as many of its steps as are one of all, and of each solid that
    /// of so many of its own steps that no run would end.
    #[inline(never)]
    fn inspect(&mut self, state: &[f64], limits: &mut Vec<StepLimit>) -> Health {
        // After a retry the last pass was of a state that has failed.
        self.follow(state);
        let mut all = self.fluid.inspect(&state[self.parts.all[0].state.clone()], limits);
        let parts = &self.parts;
        let named = |of: usize, particle: usize| parts.named(of, particle);
        all = rename(all, &|particle| named(0, particle));
        limits.iter_mut().for_each(|limit| limit.particle = named(0, limit.particle));
        let of_fluid = limits.len();
        self.limits.clone_from(limits);
        for (k, solid) in (1..).zip(&mut self.solids) {
            let mut own = std::mem::take(&mut solid.limits);
            let health = solid.scheme.inspect(&state[self.parts.all[k].state.clone()], &mut own);
            all = all.worse(rename(health, &|particle| named(k, particle)));
            // What moves as one has no waves.
            let bounds = own.iter().filter(|it| solid.cfl.is_some() && it.step < f64::INFINITY);
            limits.extend(bounds.map(|limit| StepLimit {
                step: limit.step
                    * MOST_STEPS as f64
                    * solid.cfl.filter(|_| limit.scaled).unwrap_or(1.0),
                name: "most steps of a solid",
                particle: named(k, limit.particle),
                scaled: false,
                growth: f64::INFINITY,
            }));
            solid.limits = own;
        }
        if let Some((solid, row)) = self.contact.through(self.fluid.spacing()) {
            let carrier = self.solids[solid].interface.carrier(row) as usize;
            all.first_escaped = all.first_escaped.or(Some(named(solid + 1, carrier)));
        }
        for (k, solid) in (1..).zip(&self.solids) {
            let torn = solid.torn(&state[self.parts.all[k].state.clone()]);
            all.first_escaped = all.first_escaped.or(torn.map(|particle| named(k, particle)));
        }
        let count = self.fluid_steps_of(&limits[..of_fluid]);
        limits[..of_fluid].iter_mut().for_each(|limit| limit.step *= count as f64);
        all
    }

    fn warning(&self) -> Option<String> {
        (0..self.parts.all.len()).find_map(|k| self.system(k).warning())
    }

    #[inline(never)]
    fn escape(&self, index: usize, state: &[f64]) -> Option<Escape> {
        let (k, own) = self.local(index);
        let part = &state[self.parts.all[k].state.clone()];
        let Some(solid) = k.checked_sub(1).map(|solid| &self.solids[solid]) else {
            return self.fluid.escape(own, part);
        };
        let is_torn = solid.torn(part) == Some(own);
        Some(Escape {
            position: solid.place(part, own).iter().copied().collect(),
            speed: solid.velocity(part, own).norm(),
            behind: if is_torn { Behind::Neighbors } else { Behind::Surface },
            advice: if is_torn { TORN_ADVICE } else { THROUGH_ADVICE },
        })
    }

    #[inline(never)]
    fn figures(&self, state: &[f64], figures: &mut Vec<f64>) {
        let counts = state[self.counts_at()..].chunks_exact(2);
        for ((k, part), count) in self.parts.all.iter().enumerate().zip(counts) {
            self.system(k).figures(&state[part.state.clone()], figures);
            figures.push(count[0]);
        }
    }

    #[inline(never)]
    fn passed(&self, state: &[f64], body: u32) -> Option<Passage> {
        let part = &self.parts.all[0];
        self.system(0).passed(&state[part.state.clone()], body)
    }

    #[inline(never)]
    fn energies(&self, state: &[f64], mut energies: &mut [f64]) {
        for (k, part) in self.parts.all.iter().enumerate() {
            let system = self.system(k);
            let (own, rest) = energies.split_at_mut(system.description().energies.len());
            system.energies(&state[part.state.clone()], own);
            energies = rest;
        }
    }

    #[inline(never)]
    fn momentum(&self, state: &[f64], momentum: &mut [f64]) {
        momentum.fill(0.0);
        for (k, part) in self.parts.all.iter().enumerate() {
            let mut own = [0.0; MOST_COMPONENTS];
            let own = &mut own[..momentum.len()];
            self.system(k).momentum(&state[part.state.clone()], own);
            momentum.iter_mut().zip(own).for_each(|(sum, own)| *sum += *own);
        }
    }

    #[inline(never)]
    fn observe(&mut self, stage: usize, time: f64, state: &[f64]) {
        self.guide(state);
        self.meet(state);
        self.touch(time, state);
        self.fluid.observe(stage, time, &state[self.parts.all[0].state.clone()]);
        for (solid, part) in self.solids.iter_mut().zip(&self.parts.all[1..]) {
            solid.scheme.observe(stage, time, &state[part.state.clone()]);
        }
    }

    /// Of a field that a system does not have its particles show [`ABSENT`].
    #[inline(never)]
    fn derive(
        &self,
        state: &[f64],
        field: &FieldDescription,
        particles: &[u32],
        values: &mut Vec<f64>,
    ) {
        let own: Vec<Option<FieldDescription>> =
            (0..self.parts.all.len()).map(|k| own_field(self.system(k), field)).collect();
        let mut borne: Vec<Option<Vec<Vector<D>>>> = vec![None; self.parts.all.len()];
        for &particle in particles {
            let (k, local) = self.local(particle as usize);
            let (system, part) = (self.system(k), &state[self.parts.all[k].state.clone()]);
            match &own[k] {
                _ if k > 0 && BORNE.contains(&field.name) => {
                    let all = borne[k].get_or_insert_with(|| self.borne(k - 1, field, state));
                    values.extend_from_slice(all[local].as_slice());
                }
                None if k > 0 && field.name == CONTACT.name => {
                    values.extend_from_slice(self.touches[k - 1][local].as_slice());
                }
                None => {
                    let components = field.kind.components(D);
                    values.extend(std::iter::repeat_n(ABSENT, components));
                }
                Some(own) if own.is_stored() => {
                    own.read(&part[system.column(own)], D, &[local as u32], values);
                }
                Some(own) => system.derive(part, own, &[local as u32], values),
            }
        }
    }

    fn phases(&self) -> Vec<&Phase> {
        (0..self.parts.all.len()).flat_map(|k| self.system(k).phases()).collect()
    }

    #[inline(never)]
    fn parts(&self) -> Vec<(&dyn Scheme, Range<usize>)> {
        let all = self.parts.all.iter().enumerate();
        all.map(|(k, part)| (self.system(k), part.state.clone())).collect()
    }

    #[inline(never)]
    fn missing(&self, state: &[f64]) -> u64 {
        let all = self.parts.all.iter().enumerate();
        all.map(|(k, part)| self.system(k).missing(&state[part.state.clone()])).sum()
    }

    fn bodies(&self) -> &[u32] {
        &self.parts.bodies
    }

    fn ids(&self) -> &[u32] {
        &self.parts.ids
    }

    fn is_closed(&self) -> bool {
        self.fluid.is_closed()
    }

    #[inline(never)]
    fn birth_of(&self, state: &[f64], index: usize) -> u32 {
        let (k, own) = self.local(index);
        self.system(k).birth_of(&state[self.parts.all[k].state.clone()], own)
    }

    #[inline(never)]
    fn body_of(&self, state: &[f64], index: usize) -> Option<u32> {
        let (k, own) = self.local(index);
        let part = &state[self.parts.all[k].state.clone()];
        let is_own = |body: u32| body == self.system(k).bodies()[own];
        let body = self.system(k).body_of(part, own)?;
        Some(if is_own(body) { self.parts.bodies[index] } else { body })
    }

    #[inline(never)]
    fn mass(&self, index: usize) -> f64 {
        let (k, own) = self.local(index);
        self.system(k).mass(own)
    }

    #[inline(never)]
    fn particle(&self, index: usize) -> Particle {
        let (k, own) = self.local(index);
        Particle { id: self.parts.ids[index], ..self.system(k).particle(own) }
    }

    #[inline(never)]
    fn neighborhood(&self, index: usize) -> Vec<u32> {
        let (k, own) = self.local(index);
        let near = self.system(k).neighborhood(own);
        near.into_iter().map(|particle| self.parts.all[k].index[particle as usize]).collect()
    }

    fn stability_advice(&self) -> &'static str {
        self.fluid.stability_advice()
    }

    #[inline(never)]
    fn collapse_advice(&self, index: usize) -> String {
        let (k, own) = self.local(index);
        self.system(k).collapse_advice(own)
    }

    #[inline(never)]
    fn memory(&self) -> usize {
        let systems: usize = (0..self.parts.all.len()).map(|k| self.system(k).memory()).sum();
        let interfaces: usize = self.solids.iter().map(|solid| solid.interface.memory()).sum();
        // Ways and forces are found in the first step.
        let a_wall = size_of::<Way<D>>() + size_of::<[Vector<D>; 4]>();
        let a_particle = size_of::<[Vector<D>; 6]>();
        let particles: usize = self.solids.iter().map(|solid| solid.mass.len()).sum();
        let passing = self.carried.len() * a_wall + particles * a_particle;
        let fixed = self.contact.walls().len() * size_of::<[Vector<D>; 2]>();
        systems
            + interfaces
            + self.contact.memory()
            + passing
            + fixed
            + self.guided.memory()
            + size_of_val(self.start.as_slice())
    }

    /// Its systems are moved by integrators of their own.
    fn has_rates(&self) -> bool {
        false
    }

    #[inline(never)]
    fn own_steps(&self, state: &[f64]) -> Vec<(String, u64)> {
        let names = self.solids.iter().map(|solid| solid.name.clone());
        let names = std::iter::once("fluid".to_owned()).chain(names);
        let counts = state[self.counts_at()..].chunks_exact(2);
        names.zip(counts).map(|(name, count)| (name, count[1] as u64)).collect()
    }

    #[inline(never)]
    fn settable(&self, index: usize) -> &'static [&'static str] {
        let (k, own) = self.local(index);
        self.system(k).settable(own)
    }

    fn coupled(&mut self) -> Option<&mut dyn CoupledScheme> {
        Some(self)
    }
}
