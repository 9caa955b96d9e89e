//! The formulation in implicit steps.

use super::equilibrium::kind;
use super::fields::ColumnsMut;
use super::statics::InertialStep;
use super::{ITERATIONS, LEDGER, TotalLagrangian};
use crate::schemes::ledger::Totals;
use crate::schemes::momentum::kinetic_distance;
use crate::schemes::{Newmark, NewmarkScheme, NoSolution};
use crate::{Vector, parallel};

impl<const D: usize> NewmarkScheme for TotalLagrangian<D> {
    /// Prescribed components move as in central differences: by their velocity half way.
    ///
    /// Work is the mean of the forces at both ends times the displacement, and impulses are the mean
    /// times the step.
    #[inline(never)]
    fn advance(
        &mut self,
        rule: &Newmark,
        time: f64,
        step: f64,
        old: &[f64],
        new: &mut [f64],
    ) -> Result<(), NoSolution> {
        let (count, end, at) = (self.solid.len(), time + step, self.columns(old));
        new.copy_from_slice(old);
        let mut free = vec![Vector::zeros(); count];
        let (mut start, mut last) = (free.clone(), free.clone());
        for a in 0..count {
            let (v, acceleration) = (at.velocity[a], at.kick[a]);
            last[a] = at.displacement[a];
            free[a] = Vector::from_fn(|i, _| last[a][i] + rule.free(step, v[i], acceleration[i]));
            let predicted = v * step + acceleration * (0.5 * step * step);
            start[a] = last[a] + predicted * rule.reach();
        }
        for entry in self.prescribed.iter() {
            let (a, i) = (entry.particle, entry.component);
            let middle = entry.at(time + 0.5 * step);
            start[a][i] = last[a][i] + rule.reach() * step * middle;
        }
        if !self.prescribed.is_empty() {
            self.totals_of(time, old);
        }
        let held_before = self.held(time, old);
        let Some(statics) = &mut self.statics else { return Ok(()) };
        let (displacement, iterations) = statics
            .march(&InertialStep {
                time: time + rule.reach() * step,
                ends: [time, end],
                stiffening: rule.stiffening(step),
                free: &free,
                start: &start,
                last: &last,
            })
            .map_err(|error| NoSolution {
                kind: kind(&error),
                time: end,
                reached: time,
                message: format!(
                    "{error} (a step is `time.step`; `time.on_failure = \"retry\"` halves it)"
                ),
            })?;
        let moved: Vec<Vector<D>> =
            (0..count).map(|a| (displacement[a] - last[a]) / rule.reach()).collect();
        let (own, _) = ColumnsMut::<D>::of(new, count);
        parallel::for_each_part(count, own, |first, own| {
            for (k, moved) in moved[first..].iter().take(own.velocity.len()).enumerate() {
                let (v, before) = (own.velocity[k], own.kick[k]);
                let acceleration = |i: usize| rule.acceleration(step, moved[i], v[i], before[i]);
                let after = Vector::<D>::from_fn(|i, _| acceleration(i));
                own.velocity[k] =
                    Vector::from_fn(|i, _| rule.velocity(step, v[i], before[i], after[i]));
                own.displacement[k] += moved;
                own.kick[k] = after;
            }
        });
        let (own, _) = ColumnsMut::<D>::of(new, count);
        self.prescribed.impose(end, own.velocity);
        self.prescribed.iter().for_each(|entry| own.kick[entry.particle][entry.component] = 0.0);
        let rates = self.totals_of(end, new);
        let held = held_before.into_iter().zip(self.held(end, new));
        let held: Vec<Vector<D>> = held.map(|(before, after)| 0.5 * (before + after)).collect();
        let ends: Vec<Vector<D>> = last.iter().zip(&moved).map(|(u, moved)| u + moved).collect();
        let mut totals = self.work([time, end], [&last, &ends], &held);
        totals.join(&rates);
        let (_, tail) = ColumnsMut::<D>::of(new, count);
        LEDGER.finish(D, step, &totals, tail);
        LEDGER.behind_mut(D, tail)[ITERATIONS] = iterations as f64;
        Ok(())
    }

    #[inline(never)]
    fn kinetic_distance(&self, one: &[f64], other: &[f64]) -> f64 {
        let velocities = [one, other].map(|state| self.columns(state).velocity);
        kinetic_distance(velocities, |a| self.solid.mass[a])
    }
}

impl<const D: usize> TotalLagrangian<D> {
    /// What prescribed motions hold each particle with at a state whose rates have just been found, N;
    /// nothing without any.
    fn held(&mut self, time: f64, state: &[f64]) -> Vec<Vector<D>> {
        match self.prescribed.is_empty() {
            true => vec![Vector::zeros(); self.solid.len()],
            false => self.reactions_to(time, state),
        }
    }

    /// The totals of a state, whose rates are at hand from then on.
    fn totals_of(&mut self, time: f64, state: &[f64]) -> Totals {
        let mut rate = std::mem::take(&mut self.rate);
        let totals = self.evaluate(time, state, &mut rate);
        self.rate = rate;
        totals
    }
}
