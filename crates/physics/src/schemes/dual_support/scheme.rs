//! The dual-support formulation as integrators, clock and output see it.

use super::fields::{Columns, ColumnsMut, Made};
use super::{DualSupport, ENERGIES, LEDGER};
use crate::fields::FieldDescription;
use crate::schemes::ledger::Totals;
use crate::schemes::look::convexity_is_lost;
use crate::schemes::momentum::of_particles;
use crate::schemes::{
    Capability, Health, NEWTON_ITERATIONS, NewmarkScheme, Particle, Phase, Scheme,
    SchemeDescription, SplitScheme, StaticScheme, StepLimit,
};
use crate::solve::Costs;
use crate::{Tensor, Vector, parallel};

const FIGURE_COLUMNS: [(&str, &str); 2] = [(NEWTON_ITERATIONS, "1"), ("load_factor", "1")];

/// What to do about a body whose material has been seen to lose its convexity.
const CONVEXITY: &str = "the material had lost its convexity before, which smaller steps do not bring \
                         back: use another law, or a smaller load";

/// What the formulation is called and what it shows.
pub const DESCRIPTION: SchemeDescription = SchemeDescription {
    name: "dual_support",
    matter: None,
    offers: &[Capability::Rates, Capability::Kicks, Capability::Newmark, Capability::Statics],
    fields: Made::FIELDS,
    energies: &ENERGIES,
    ledger: LEDGER,
    figures: &FIGURE_COLUMNS,
};

impl<const D: usize> Scheme for DualSupport<D> {
    fn description(&self) -> &'static SchemeDescription {
        &DESCRIPTION
    }

    fn dimension(&self) -> usize {
        D
    }

    fn particle_count(&self) -> usize {
        self.mass.len()
    }

    fn initial_state(&self) -> Vec<f64> {
        let mut state = vec![0.0; self.rate.len()];
        let (own, _) = ColumnsMut::<D>::of(&mut state, self.mass.len());
        own.velocity.copy_from_slice(&self.initial_velocity);
        self.constrain(0.0, &mut state);
        // Nothing is strained yet, so that no force comes from inside.
        let mut rate = vec![0.0; state.len()];
        let count = self.mass.len();
        let gradient = vec![Tensor::zeros(); count];
        let (at, internal) = (self.columns(&state), (&*vec![Vector::zeros(); count], &*gradient));
        let mut totals = Totals::default();
        self.external_pass(0.0, &at, internal, (&mut rate, &mut totals));
        self.store((0.0, &rate), &gradient, totals, &mut state);
        state
    }

    fn rates(&mut self, time: f64, state: &[f64], rate: &mut [f64]) {
        let totals = self.evaluate(time, state, rate);
        LEDGER.write(D, &totals, ColumnsMut::<D>::of(rate, self.mass.len()).1);
    }

    fn constrain(&self, time: f64, state: &mut [f64]) {
        let (own, _) = ColumnsMut::<D>::of(state, self.mass.len());
        self.prescribed.impose(time, own.velocity);
    }

    fn inspect(&mut self, state: &[f64], limits: &mut Vec<StepLimit>) -> Health {
        self.look(state, limits)
    }

    fn figures(&self, state: &[f64], figures: &mut Vec<f64>) {
        let kept = LEDGER.behind(D, self.columns(state).tail);
        figures.extend_from_slice(&kept[..FIGURE_COLUMNS.len()]);
    }

    fn linear_costs(&self) -> Option<Costs> {
        self.statics.as_ref().map(|statics| statics.costs())
    }

    fn warning(&self) -> Option<String> {
        let soft = self.not_convex.as_ref().map(|(index, gradient)| {
            convexity_is_lost(&self.particle(*index), gradient, "use another law")
        });
        let jump = self.jumped.map(|[from, to]| {
            format!(
                "the equilibrium at a load factor of {to} may not belong to the path that led to {from}: the \
                 tangent was indefinite on the way, or the body moved much farther than it led, as where it \
                 snaps through; lower `time.step` and compare, or follow the path with \
                 `time.integrator = \"arc_length\"`"
            )
        });
        match (soft, jump) {
            (Some(soft), Some(jump)) => Some(format!("{soft}\n{jump}")),
            (soft, jump) => soft.or(jump),
        }
    }

    fn energies(&self, state: &[f64], energies: &mut [f64]) {
        let at = self.columns(state);
        let sums = parallel::sums::<[f64; 3]>(self.mass.len(), |a, sums| {
            if !self.is_static {
                sums[0] += 0.5 * self.mass[a] * at.velocity[a].norm_squared();
            }
            let [strain, hourglass] = self.discrete.energy_of(at.displacement, a);
            sums[1] += strain;
            sums[2] += hourglass;
        });
        energies.copy_from_slice(&sums);
    }

    fn momentum(&self, state: &[f64], momentum: &mut [f64]) {
        let at = self.columns(state);
        // Nothing moves in statics: the column holds another rate.
        let mass = |a: usize| if self.is_static { 0.0 } else { self.mass[a] };
        let of = |a: usize| [self.position(a, &at), at.velocity[a] * mass(a)];
        of_particles(self.mass.len(), of, momentum);
    }

    fn observe(&mut self, stage: usize, time: f64, state: &[f64]) {
        self.make_fields(stage, time, state);
    }

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
        &self.discrete.particles.body
    }

    fn ids(&self) -> &[u32] {
        &self.discrete.particles.id
    }

    fn mass(&self, index: usize) -> f64 {
        self.mass[index]
    }

    fn particle(&self, index: usize) -> Particle {
        Particle::of(&self.discrete.particles, index)
    }

    /// Those in its support and those in whose support it is.
    fn neighborhood(&self, index: usize) -> Vec<u32> {
        self.discrete.operator.neighborhood(index)
    }

    /// What is in equilibrium has no other state to be set to.
    fn settable(&self) -> &'static [&'static str] {
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

    fn stability_advice(&self) -> &'static str {
        match self.not_convex {
            Some(_) => CONVEXITY,
            None => "raise `scheme.hourglass`",
        }
    }

    fn collapse_advice(&self, index: usize) -> String {
        let law = self.discrete.material(index).law.law();
        match law.name() {
            _ if self.not_convex.is_some() => CONVEXITY.into(),
            "linear_elastic" | "saint_venant_kirchhoff" => format!(
                "`{}` does not resist being turned inside out: use a neo-Hookean law, or a \
                 smaller load",
                law.name()
            ),
            _ => "the law resists collapse, so the step or the stabilisation is at fault: lower \
                  `time.cfl`, or raise `scheme.hourglass`"
                .into(),
        }
    }

    fn memory(&self) -> usize {
        let discrete = &self.discrete;
        discrete.operator.memory()
            + discrete.particles.memory()
            + size_of_val(self.mass.as_slice())
            + size_of_val(self.initial_velocity.as_slice())
            + self.strained.memory()
            + self.statics.as_ref().map_or(0, |statics| statics.memory())
            + size_of_val(self.force.as_slice())
            + size_of_val(self.rate.as_slice())
    }
}

impl<const D: usize> DualSupport<D> {
    /// The columns of a state.
    pub(super) fn columns<'a>(&self, state: &'a [f64]) -> Columns<'a, D> {
        Columns::of(state, self.mass.len())
    }
}
