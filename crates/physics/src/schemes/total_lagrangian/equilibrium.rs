//! The formulation where there is no motion: states in equilibrium, with the work that led there.

use piola_formulas::hyperelastic::HyperelasticLaw;

use super::fields::ColumnsMut;
use super::statics::Known;
use super::{
    ARC_SCALE, BODY_FORCE, BOUNDARY_MOTION, ITERATIONS, LEDGER, LOAD_FACTOR, Matrices, Mixture,
    PRESSURE, StaticState, Statics, StaticsError, TRACTION, TotalLagrangian,
};
use crate::boundaries::{pressure::Pressed, traction::Loaded};
use crate::schemes::ledger::{Total, Totals};
use crate::schemes::{Missed, NoSensitivity, NoSolution, Sensitivity, StaticScheme};
use crate::solve::{LoadError, NewtonError};
use crate::{Vector, parallel};

impl<const D: usize> StaticScheme for TotalLagrangian<D> {
    /// Rows hold the rate of the displacement by the load factor in place of a velocity: with it a
    /// step starts where the last two states lead. Work is added up by the trapezoidal rule, exact
    /// where the material is linear, of second order in the steps elsewhere.
    #[inline(never)]
    fn equilibrate(
        &mut self,
        from: f64,
        to: f64,
        old: &[f64],
        new: &mut [f64],
    ) -> Result<(), NoSolution> {
        let remedy = self.remedy();
        self.settle([from, to], from, old, new, |statics, known| {
            statics.advance(known, to).map_err(|error| NoSolution {
                kind: kind(&error),
                time: to,
                reached: from,
                message: advised(&error, "a load step", remedy),
            })
        })
    }

    /// Rows hold the rate of the displacement by the arc length.
    #[inline(never)]
    fn follow(
        &mut self,
        from: f64,
        to: f64,
        old: &[f64],
        new: &mut [f64],
    ) -> Result<(), NoSolution> {
        let known = LEDGER.behind(D, self.columns(old).tail);
        let [factor, scale] = [known[LOAD_FACTOR], known[ARC_SCALE]];
        let remedy = self.remedy();
        let mut radius = (from > 0.0).then_some(scale * (to - from));
        self.settle([from, to], factor, old, new, |statics, known| {
            statics.advance_along(known, to - from, &mut radius).map_err(|error| NoSolution {
                kind: kind(&error),
                time: to,
                reached: from,
                message: advised(&error, "a step of arc length", remedy),
            })
        })?;
        if let Some(radius) = radius {
            let (_, tail) = ColumnsMut::<D>::of(new, self.solid.len());
            LEDGER.behind_mut(D, tail)[ARC_SCALE] =
                if from > 0.0 { scale } else { radius / (to - from) };
        }
        Ok(())
    }

    #[inline(never)]
    fn sensitivity(
        &mut self,
        state: &[f64],
        body: u32,
        law: &HyperelasticLaw,
    ) -> Result<Sensitivity, NoSensitivity> {
        let at = self.columns(state);
        let factor = LEDGER.behind(D, at.tail)[LOAD_FACTOR];
        let statics = self.statics.as_mut().ok_or(NoSensitivity::NotStatic)?;
        let derivatives = statics.sensitivity(factor, at.displacement, body, law)?;
        let [displacement, reaction] =
            derivatives.map(|rows| rows.iter().flat_map(|row| row.iter().copied()).collect());
        Ok(Sensitivity { displacement, reaction })
    }
}

impl<const D: usize> TotalLagrangian<D> {
    /// What helps where a material keeps its volume: particles in rows have pressures that alternate from row to row, theory
    /// (47), under which the body buckles in the same pattern.
    fn remedy(&self) -> &'static str {
        match self.solid.mixtures.iter().any(Mixture::is_nearly_incompressible) {
            true => {
                "; as the material is nearly incompressible, particles in rows may buckle against their neighbours: \
                 displace them (`lattice.jitter = 0.2`), use smaller spacings, or lower `scheme.hourglass`"
            }
            false => "",
        }
    }

    /// Writes the state that `find` finds after the one in `old`, which is in equilibrium with the
    /// loads of `factor`, in a step of time, or what takes its part.
    fn settle(
        &mut self,
        [from, to]: [f64; 2],
        factor: f64,
        old: &[f64],
        new: &mut [f64],
        find: impl FnOnce(&mut Statics<D>, &Known<D>) -> Result<StaticState<D>, NoSolution>,
    ) -> Result<(), NoSolution> {
        new.copy_from_slice(old);
        let at = self.columns(old);
        let known = Known {
            factor,
            displacement: at.displacement.to_vec(),
            rate: (from > 0.0).then(|| at.velocity.to_vec()),
        };
        let Some(statics) = &mut self.statics else { return Ok(()) };
        let held_before = statics.support_forces(factor, &known.displacement);
        let state = find(statics, &known)?;
        if state.jumped {
            self.jumped.get_or_insert([factor, state.factor]);
        }
        let moved: Vec<Vector<D>> =
            state.displacement.iter().zip(&known.displacement).map(|(u, last)| u - last).collect();
        let (own, tail) = ColumnsMut::<D>::of(new, self.solid.len());
        own.displacement.copy_from_slice(&state.displacement);
        own.velocity.iter_mut().zip(&moved).for_each(|(v, moved)| *v = moved / (to - from));
        let held = held_before.iter().zip(&state.support_force);
        let held: Vec<Vector<D>> = held.map(|(before, after)| 0.5 * (before + after)).collect();
        let ends = [&*known.displacement, &*state.displacement];
        LEDGER.add(D, &self.work([factor, state.factor], ends, &held), tail);
        let figures = LEDGER.behind_mut(D, tail);
        figures[ITERATIONS] = state.solved.iterations.len() as f64;
        figures[LOAD_FACTOR] = state.factor;
        Ok(())
    }
}

impl<const D: usize> TotalLagrangian<D> {
    /// Work of each mechanism in a step in J, by the mean of the forces at both of its ends: that of
    /// what holds the particles is given in N, and their displacements there in m.
    pub(super) fn work(
        &self,
        [from, to]: [f64; 2],
        [before, after]: [&[Vector<D>]; 2],
        held: &[Vector<D>],
    ) -> Totals {
        let moved = |a: usize| after[a] - before[a];
        let body = parallel::sum(held.len(), |a| {
            let both = self.body_acceleration(a, from) + self.body_acceleration(a, to);
            0.5 * self.solid.mass[a] * both.dot(&moved(a))
        });
        let of =
            |load: &Loaded<D>| 0.5 * (load.force(from) + load.force(to)).dot(&moved(load.particle));
        let [first, last] = [before, after].map(|ends| match self.loads.pressed.is_empty() {
            true => Vec::new(),
            false => self.continued(ends, &[]),
        });
        let pressing = |part: &Pressed<D>| {
            let a = part.particle;
            let force = |time: f64, displacement: &[Vector<D>]| {
                part.force(time, &self.matrices.gradient_at(displacement, a))
            };
            0.5 * (force(from, &first) + force(to, &last)).dot(&moved(a))
        };
        let mut totals = Totals::default();
        totals.book(BODY_FORCE, &Total::of(body));
        totals.book(TRACTION, &Total::of(self.loads.loaded.iter().map(of).sum()));
        totals.book(PRESSURE, &Total::of(self.loads.pressed.iter().map(pressing).sum()));
        let boundary = parallel::sum(held.len(), |a| held[a].dot(&moved(a)));
        totals.book(BOUNDARY_MOTION, &Total::of(boundary));
        totals
    }

    /// What supports and prescribed motions hold each particle with, N, where the rates of `state` have just
    /// been found.
    pub(super) fn reactions_to(&mut self, time: f64, state: &[f64]) -> Vec<Vector<D>> {
        let at = self.columns(state);
        if let (true, Some(statics)) = (self.is_static, &mut self.statics) {
            return statics.support_forces(LEDGER.behind(D, at.tail)[LOAD_FACTOR], at.displacement);
        }
        let rate = self.columns(&self.rate);
        let mut loads = vec![Vector::zeros(); self.solid.len()];
        for load in &self.loads.loaded {
            loads[load.particle] += load.force(time);
        }
        for part in &self.loads.pressed {
            loads[part.particle] += part.force(time, &self.strained.gradient[part.particle]);
        }
        let mut reactions = vec![Vector::zeros(); self.solid.len()];
        for entry in self.prescribed.iter() {
            let (a, component) = (entry.particle, entry.component);
            let drag = self.dissipation.damping * at.velocity[a][component];
            let inertia = self.solid.mass[a] * (rate.velocity[a][component] + drag);
            let body = self.solid.mass[a] * self.body_acceleration(a, time)[component];
            reactions[a][component] =
                inertia - self.force[a][component] - loads[a][component] - body;
        }
        if let Matrices::Adjoint(discrete) = &self.matrices {
            for (mirror, particle) in &discrete.planes {
                reactions[*particle][mirror.axis] -= discrete.plane_force(mirror, &self.force);
            }
        }
        reactions
    }
}

pub(super) fn kind(error: &StaticsError) -> Missed {
    match error {
        StaticsError::Inverted { .. } | StaticsError::Collapsed { .. } => Missed::Inverted,
        StaticsError::Load(LoadError::Unstable { .. }) => Missed::Unstable,
        StaticsError::Load(LoadError::Newton { source: NewtonError::Broken { .. }, .. }) => {
            Missed::Inverted
        }
        _ => Missed::NoConvergence,
    }
}

/// An error with what may help: a shorter step, as it is called here, and a remedy of the material where no equilibrium is
/// found.
fn advised(error: &StaticsError, step: &str, remedy: &str) -> String {
    let halved = match kind(error) {
        Missed::Unstable => String::new(),
        _ => format!(" ({step} is `time.step`; `time.on_failure = \"retry\"` halves it)"),
    };
    let is_lost = matches!(error, StaticsError::Load(_)) && kind(error) != Missed::Inverted;
    format!("{error}{halved}{}", if is_lost { remedy } else { "" })
}
