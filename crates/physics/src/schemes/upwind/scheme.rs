//! The upwind formulation as integrators, clock and output see it.

use std::ops::Range;

use piola_device::{Device, Language};
use piola_formulas::volumetric::VolumetricResponse;

use super::fields::{ColumnsMut, Made};
use super::{ENERGIES, FIGURES, KEPT, LEDGER, Upwind};
use crate::Tensor;
use crate::fields::FieldDescription;
use crate::parallel::{self, Team};
use crate::schemes::momentum::of_particles;
use crate::schemes::{
    Capability, DeviceMethod, DeviceRefusal, DeviceStage, DeviceSteps, Health, Part, Particle,
    PartitionedScheme, Phase, RankRefusal, RankShare, Scheme, SchemeDescription, StepLimit,
    ThetaScheme,
};
use crate::solve::Costs;

/// What the formulation is called and what it shows.
pub const DESCRIPTION: SchemeDescription = SchemeDescription {
    name: "upwind",
    matter: None,
    offers: &[Capability::Rates, Capability::Kicks, Capability::Theta],
    fields: Made::FIELDS,
    energies: &ENERGIES,
    ledger: LEDGER,
    figures: &FIGURES,
};

impl<const D: usize> Scheme for Upwind<D> {
    fn description(&self) -> &'static SchemeDescription {
        &DESCRIPTION
    }

    fn dimension(&self) -> usize {
        D
    }

    fn particle_count(&self) -> usize {
        self.particles.len()
    }

    #[inline(never)]
    fn initial_state(&self) -> Vec<f64> {
        let length = self.particles.len() * self.width() + LEDGER.length(D) + KEPT;
        let mut state = vec![0.0; length];
        let (own, _) = ColumnsMut::<D>::of(&mut state, self.particles.len());
        own.position.copy_from_slice(&self.particles.position);
        own.velocity.copy_from_slice(&self.initial_velocity);
        own.volume_ratio.fill(1.0);
        own.deformation_gradient.fill(Tensor::identity());
        state
    }

    #[inline(never)]
    fn rates(&mut self, time: f64, state: &[f64], rate: &mut [f64]) {
        let mut stages = std::mem::take(&mut self.stages);
        let totals = stages.run(|pass, totals| self.run(pass, time, state, (rate, totals)));
        self.stages = stages;
        LEDGER.write(D, &totals, ColumnsMut::<D>::of(rate, self.particles.len()).1);
    }

    #[inline(never)]
    fn constrain(&self, time: f64, state: &mut [f64]) {
        let (own, _) = ColumnsMut::<D>::of(state, self.particles.len());
        self.prescribed.impose(time, own.velocity);
    }

    #[inline(never)]
    fn inspect(&mut self, state: &[f64], limits: &mut Vec<StepLimit>) -> Health {
        self.look(state, limits)
    }

    #[inline(never)]
    fn figures(&self, state: &[f64], figures: &mut Vec<f64>) {
        figures.extend_from_slice(LEDGER.behind(D, self.columns(state).tail));
        figures.push(self.least_corner(state));
    }

    #[inline(never)]
    fn share(&self, part: &Part) -> Result<Box<dyn Scheme>, RankRefusal> {
        Ok(Box::new(self.shared(part)?))
    }

    #[inline(never)]
    fn on_device(
        &self,
        device: Device,
        method: DeviceMethod,
    ) -> Result<Box<dyn DeviceSteps>, DeviceRefusal> {
        self.body_to_device(device, method)
    }

    #[inline(never)]
    fn device_stages(
        &self,
        language: Language,
        method: DeviceMethod,
    ) -> Result<Vec<DeviceStage>, DeviceRefusal> {
        self.body_stages(language, method)
    }

    fn cost(&self, particles: Range<usize>) -> f64 {
        particles.map(|a| self.support.list.row(a).len() as f64).sum()
    }

    fn shares(&self, bounds: &[usize]) -> Result<Vec<RankShare>, RankRefusal> {
        self.planned(bounds)
    }

    fn is_whole_on_ranks(&self) -> bool {
        self.implicit.is_some()
    }

    fn team(&self) -> Option<&Team> {
        Some(self.implicit.as_ref().map_or(&self.team, |implicit| implicit.team()))
    }

    fn linear_costs(&self) -> Option<Costs> {
        self.implicit.as_ref().map(|parts| parts.costs())
    }

    #[inline(never)]
    fn energies(&self, state: &[f64], energies: &mut [f64]) {
        let at = self.columns(state);
        energies[0] = parallel::sum(self.particles.len(), |a| {
            0.5 * self.mass(a) * at.velocity[a].iter().map(|v| v * v).sum::<f64>()
        });
        energies[1] = parallel::sum(self.particles.len(), |a| {
            self.particles.volume[a] * self.law(a).energy(at.volume_ratio[a])
        });
    }

    #[inline(never)]
    fn momentum(&self, state: &[f64], momentum: &mut [f64]) {
        let at = self.columns(state);
        let of = |a: usize| [at.position[a], at.velocity[a] * self.mass(a)];
        of_particles(self.particles.len(), of, momentum);
    }

    #[inline(never)]
    fn observe(&mut self, _stage: usize, time: f64, state: &[f64]) {
        self.make_fields(time, state);
    }

    #[inline(never)]
    fn derive(
        &self,
        state: &[f64],
        field: &FieldDescription,
        particles: &[u32],
        values: &mut Vec<f64>,
    ) {
        let (Some(made), at) = (Made::of(field), self.columns(state)) else { return };
        particles.iter().for_each(|&a| self.push_field(made, &at, a as usize, values));
    }

    fn phases(&self) -> Vec<&Phase> {
        vec![self.stages.phase()]
    }

    fn bodies(&self) -> &[u32] {
        &self.particles.body
    }

    fn ids(&self) -> &[u32] {
        &self.particles.id
    }

    fn mass(&self, index: usize) -> f64 {
        Upwind::mass(self, index)
    }

    fn particle(&self, index: usize) -> Particle {
        Particle::of(&self.particles, index)
    }

    #[inline(never)]
    fn neighborhood(&self, index: usize) -> Vec<u32> {
        self.support.list.row(index).to_vec()
    }

    fn stability_advice(&self) -> &'static str {
        "raise `scheme.tau_velocity`"
    }

    #[inline(never)]
    fn collapse_advice(&self, index: usize) -> String {
        let law = self.law(index).law;
        let name = law.name().trim_end_matches("_law");
        match law.resists_collapse() {
            false => format!(
                "the {name} law lets a volume vanish at finite energy, Upwind (6.28): use the \
                 `gamma_law`, a lower speed or a stiffer material"
            ),
            true => format!(
                "the {name} law resists collapse, so the step or the stabilisation is at fault: \
                 lower `time.cfl`, or raise `scheme.tau_velocity`"
            ),
        }
    }

    #[inline(never)]
    fn memory(&self) -> usize {
        let (particles, support) = (&self.particles, &self.support);
        let inverse = self.least_squares.as_ref().map_or(0, |_| size_of::<crate::Tensor<D>>());
        particles.memory()
            + size_of_val(support.smoothing_length.as_slice())
            + size_of_val(support.list.offsets())
            + size_of_val(support.list.indices())
            + size_of_val(support.reverse.as_slice())
            + size_of_val(self.reference.as_slice())
            + size_of_val(self.initial_velocity.as_slice())
            + size_of_val(self.nearest.as_slice())
            + size_of_val(self.body_acceleration.as_slice())
            + size_of_val(self.sides.as_slice())
            + size_of_val(self.slopes.as_slice())
            + inverse * particles.len()
            + self.areas.memory()
            + self.implicit.as_ref().map_or(0, |implicit| implicit.memory())
    }

    fn theta(&mut self) -> Option<&mut dyn ThetaScheme> {
        self.implicit.is_some().then_some(self as &mut dyn ThetaScheme)
    }

    fn partitioned(&mut self) -> Option<&mut dyn PartitionedScheme> {
        self.is_conservative().then_some(self as &mut dyn PartitionedScheme)
    }

    #[inline(never)]
    fn undamped_frequency(&mut self, state: &[f64]) -> Option<f64> {
        self.is_conservative().then(|| self.largest_frequency(state))
    }
}
