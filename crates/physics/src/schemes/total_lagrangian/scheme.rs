//! The formulation as integrators, clock and output see it.

use std::ops::Range;

use piola_device::{Device, Language};

use super::fields::{ColumnsMut, Made};
use super::inspect::convexity_is_lost;
use super::{ENERGIES, LEDGER, LOAD_FACTOR, Matrices, TotalLagrangian};
use crate::Vector;
use crate::fields::FieldDescription;
use crate::parallel::{self, Team};
use crate::schemes::momentum::of_particles;
use crate::schemes::{
    Capability, DeviceMethod, DeviceRefusal, DeviceStage, DeviceSteps, Health, NEWTON_ITERATIONS,
    NewmarkScheme, Part, Particle, Phase, RankRefusal, RankShare, Scheme, SchemeDescription,
    SplitScheme, StaticScheme, StepLimit,
};
use crate::solve::Costs;

const FIGURE_COLUMNS: [(&str, &str); 2] = [(NEWTON_ITERATIONS, "1"), ("load_factor", "1")];

/// What the formulation is called and what it shows.
pub const TOTAL_LAGRANGIAN: SchemeDescription = SchemeDescription {
    name: "total_lagrangian",
    matter: None,
    offers: &[Capability::Rates, Capability::Kicks, Capability::Newmark, Capability::Statics],
    fields: Made::FIELDS,
    energies: &ENERGIES,
    ledger: LEDGER,
    figures: &FIGURE_COLUMNS,
};

/// The preset of Dual-support.
pub const DUAL_SUPPORT: SchemeDescription =
    SchemeDescription { name: "dual_support", ..TOTAL_LAGRANGIAN };

/// The preset of Elastodynamics.
pub const ELASTODYNAMICS: SchemeDescription =
    SchemeDescription { name: "elastodynamics", ..TOTAL_LAGRANGIAN };

impl<const D: usize> Scheme for TotalLagrangian<D> {
    fn description(&self) -> &'static SchemeDescription {
        self.description
    }

    fn dimension(&self) -> usize {
        D
    }

    fn particle_count(&self) -> usize {
        self.solid.len()
    }

    #[inline(never)]
    fn initial_state(&self) -> Vec<f64> {
        self.initial.clone()
    }

    #[inline(never)]
    fn rates(&mut self, time: f64, state: &[f64], rate: &mut [f64]) {
        let totals = self.evaluate(time, state, rate);
        let (own, tail) = ColumnsMut::<D>::of(rate, self.solid.len());
        parallel::copy(own.displacement, self.columns(state).velocity);
        parallel::for_each_chunk(own.kick, |_, kick| kick.fill(Vector::zeros()));
        LEDGER.write(D, &totals, tail);
    }

    #[inline(never)]
    fn constrain(&self, time: f64, state: &mut [f64]) {
        let (own, _) = ColumnsMut::<D>::of(state, self.solid.len());
        self.prescribed.impose(time, own.velocity);
        if !self.rigid.is_empty() {
            let (read, written) = ([&*own.displacement], [own.velocity]);
            self.with_group(read, written, |solid, [displacement], [velocity]| {
                self.rigid.constrain(time, solid, displacement, velocity);
            });
        }
    }

    #[inline(never)]
    fn inspect(&mut self, state: &[f64], limits: &mut Vec<StepLimit>) -> Health {
        self.look(state, limits)
    }

    #[inline(never)]
    fn figures(&self, state: &[f64], figures: &mut Vec<f64>) {
        let kept = LEDGER.behind(D, self.columns(state).tail);
        figures.extend_from_slice(&kept[..=LOAD_FACTOR]);
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
        self.solid_to_device(device, method)
    }

    #[inline(never)]
    fn device_stages(
        &self,
        language: Language,
        method: DeviceMethod,
    ) -> Result<Vec<DeviceStage>, DeviceRefusal> {
        self.solid_stages(language, method)
    }

    #[inline(never)]
    fn cost(&self, particles: Range<usize>) -> f64 {
        match &self.matrices {
            Matrices::Adjoint(whole) => particles.map(|a| whole.operator.length(a) as f64).sum(),
            Matrices::Strong(_) => particles.len() as f64,
        }
    }

    fn shares(&self, bounds: &[usize]) -> Result<Vec<RankShare>, RankRefusal> {
        self.planned(bounds)
    }

    fn is_whole_on_ranks(&self) -> bool {
        self.statics.is_some()
    }

    fn team(&self) -> Option<&Team> {
        Some(self.statics.as_ref().map_or(&self.team, |statics| statics.team()))
    }

    fn linear_costs(&self) -> Option<Costs> {
        self.statics.as_ref().map(|statics| statics.costs())
    }

    #[inline(never)]
    fn warning(&self) -> Option<String> {
        let soft = self.not_convex.as_ref().map(|(index, gradient)| {
            convexity_is_lost(&self.particle(*index), gradient, self.softness_advice())
        });
        let jump = self.jumped.map(|[from, to]| {
            format!(
                "the equilibrium at a load factor of {to} may not lie on the path that led to \
                 {from}: the tangent was indefinite on the way, or the body moved much farther \
                 than extrapolated, as in a snap-through; lower `time.step` and compare, or \
                 follow the path with \
                 `time.integrator = \"arc_length\"`"
            )
        });
        match (soft, jump) {
            (Some(soft), Some(jump)) => Some(format!("{soft}\n{jump}")),
            (soft, jump) => soft.or(jump),
        }
    }

    #[inline(never)]
    fn energies(&self, state: &[f64], energies: &mut [f64]) {
        let (at, solid) = (self.columns(state), &*self.solid);
        let displacement = self.continued(at.displacement, at.tail);
        let sums = parallel::sums::<[f64; 3]>(solid.len(), |a, sums| {
            if !self.is_static {
                sums[0] += 0.5 * solid.mass[a] * at.velocity[a].norm_squared();
            }
            let gradient = self.matrices.gradient_at(&displacement, a);
            sums[1] += solid.mixture(a).energy(&gradient) * solid.particles.volume[a];
            if let Matrices::Adjoint(discrete) = &self.matrices {
                sums[2] += discrete.operator.hourglass_energy(&displacement, &gradient, a);
            }
        });
        energies.copy_from_slice(&sums);
    }

    #[inline(never)]
    fn momentum(&self, state: &[f64], momentum: &mut [f64]) {
        let at = self.columns(state);
        // Nothing moves in statics: the column holds another rate.
        let mass = |a: usize| if self.is_static { 0.0 } else { self.solid.mass[a] };
        let of = |a: usize| [self.position(a, &at), at.velocity[a] * mass(a)];
        of_particles(self.solid.len(), of, momentum);
    }

    #[inline(never)]
    fn observe(&mut self, stage: usize, time: f64, state: &[f64]) {
        self.make_fields(stage, time, state);
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
        &self.solid.particles.body
    }

    fn ids(&self) -> &[u32] {
        &self.solid.particles.id
    }

    fn mass(&self, index: usize) -> f64 {
        self.solid.mass[index]
    }

    fn particle(&self, index: usize) -> Particle {
        Particle::of(&self.solid.particles, index)
    }

    /// Those in its support and those in whose support it is.
    #[inline(never)]
    fn neighborhood(&self, index: usize) -> Vec<u32> {
        self.matrices.neighborhood(index)
    }

    /// The strong form keeps data of its edges in the state, which have no rates; rigid bodies turn.
    fn has_rates(&self) -> bool {
        self.matrices.edges().is_none() && self.rigid.is_empty()
    }

    /// What is in equilibrium has no other state to be set to.
    fn settable(&self, _index: usize) -> &'static [&'static str] {
        if self.is_static { &[] } else { &["velocity", "displacement"] }
    }

    fn equilibrium(&mut self) -> Option<&mut dyn StaticScheme> {
        if self.is_static { Some(self) } else { None }
    }

    fn newmark(&mut self) -> Option<&mut dyn NewmarkScheme> {
        if self.statics.is_some() && !self.is_static { Some(self) } else { None }
    }

    fn split(&mut self) -> Option<&mut dyn SplitScheme> {
        Some(self)
    }

    #[inline(never)]
    fn stability_advice(&self) -> &'static str {
        match (self.not_convex, &self.statics, self.matrices.edges()) {
            (Some(_), Some(_), _) => {
                "the material had lost its convexity before, which smaller steps do not bring back: \
                 use another law, or a smaller load"
            }
            (Some(_), None, _) => {
                "the material had lost its convexity before, which smaller steps do not bring back: \
                 add `scheme.viscosity`, or use another law"
            }
            (None, Some(_), _) => "raise `scheme.hourglass`",
            (None, None, Some(_)) => "raise `scheme.viscosity`",
            (None, None, None) => "raise `scheme.viscosity` or `scheme.hourglass`",
        }
    }

    #[inline(never)]
    fn collapse_advice(&self, index: usize) -> String {
        let mixture = self.solid.mixture(index);
        let [least, _] = mixture.wave_moduli(&self.strained.gradient[index]);
        let law = mixture.main_law().map_or("", |law| law.name());
        match law {
            _ if least < 0.0 || self.not_convex.is_some() => format!(
                "the material has lost its convexity at this deformation, which no numerical \
                 method can follow without a length scale: {}",
                self.softness_advice()
            ),
            "linear_elastic" | "saint_venant_kirchhoff" => format!(
                "`{law}` does not resist inversion: use a neo-Hookean law, or a \
                 smaller load"
            ),
            _ => {
                let step = match self.statics {
                    Some(_) => "`time.step`",
                    None => "`time.cfl`",
                };
                let other = match self.matrices.edges() {
                    Some(_) => "",
                    None => ", or raise `scheme.hourglass`",
                };
                format!(
                    "the law resists collapse, so the step or the stabilisation is at fault: lower \
                     {step}{other}"
                )
            }
        }
    }

    #[inline(never)]
    fn memory(&self) -> usize {
        let vectors =
            [&self.displacement, &self.velocity, &self.acceleration, &self.force, &self.reaction];
        self.matrices.memory()
            + self.solid.memory()
            + self.strained.memory()
            + self.rigid.memory()
            + self.statics.as_ref().map_or(0, |statics| statics.memory())
            + vectors.into_iter().map(|it| size_of_val(it.as_slice())).sum::<usize>()
            + size_of_val(self.gradient_rate.as_slice())
            + size_of_val(self.stress.as_slice())
            + 2 * size_of_val(self.rate.as_slice())
    }
}

impl<const D: usize> TotalLagrangian<D> {
    /// What to do about a material that loses its convexity.
    fn softness_advice(&self) -> &'static str {
        match self.statics {
            Some(_) => "use another law",
            None => "add `scheme.viscosity`, or use another law",
        }
    }

    /// How many particles a particle has in its support.
    pub fn neighbors(&self, index: usize) -> usize {
        self.matrices.neighbors(index)
    }
}
