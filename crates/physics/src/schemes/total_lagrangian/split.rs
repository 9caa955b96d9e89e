//! The formulation as kick-drift-kick integrators see it: central differences.

use super::fields::ColumnsMut;
use super::{BOUNDARY_MOTION, LEDGER, TotalLagrangian};
use crate::schemes::SplitScheme;
use crate::schemes::ledger::{Total, Totals};
use crate::schemes::split::advance;

impl<const D: usize> SplitScheme for TotalLagrangian<D> {
    /// Two halves with the drift between are Elastodynamics (4.4), whose velocities are half way.
    #[inline(never)]
    fn kick(&mut self, duration: f64, state: &mut [f64]) {
        let (own, tail) = ColumnsMut::<D>::of(state, self.solid.len());
        advance(own.velocity, own.kick, duration);
        LEDGER.kick(D, duration, tail);
    }

    #[inline(never)]
    fn drift(&mut self, time: f64, step: f64, state: &mut [f64]) {
        let (own, tail) = ColumnsMut::<D>::of(state, self.solid.len());
        self.rigid.advance((self.team.first(), step), own.displacement, own.velocity);
        if !self.rigid.is_empty() {
            let (mut totals, mut boundary) = (Totals::default(), Total::default());
            let moved = [&mut *own.displacement, &mut *own.velocity];
            self.with_group([], moved, |solid, [], moved| {
                self.rigid.drift([time, step], solid, moved, &mut boundary);
            });
            totals.book(BOUNDARY_MOTION, &boundary);
            LEDGER.add(D, &totals, tail);
        }
        // Kicks leave a prescribed velocity alone; it moves its particle by its value half way.
        for entry in self.prescribed.iter() {
            let (a, component) = (entry.particle, entry.component);
            let middle = entry.at(time + 0.5 * step);
            own.displacement[a][component] += step * (middle - own.velocity[a][component]);
        }
    }

    #[inline(never)]
    fn accelerate(&mut self, time: f64, state: &mut [f64]) {
        let mut rate = std::mem::take(&mut self.rate);
        let totals = self.evaluate(time, state, &mut rate);
        self.store((time, &rate), totals, state);
        self.rate = rate;
    }

    /// Without viscosity the forces between particles are those of the displacements, and at hand; damping, springs,
    /// rigid bodies and the powers of loads take velocities where they act from outside.
    #[inline(never)]
    fn settle(&mut self, time: f64, state: &mut [f64]) {
        let is_at_hand = self.velocity.is_empty() && !self.dissipation.is_viscous();
        self.settle_with(is_at_hand, time, state);
    }

    /// Forces of viscosity take the velocities of the middle of the step before, and keep them.
    fn settle_between(&mut self, time: f64, state: &mut [f64]) {
        self.settle_with(self.velocity.is_empty(), time, state);
    }
}

impl<const D: usize> TotalLagrangian<D> {
    /// Finds the accelerations of a state again, from forces between particles that are at hand if those are of its
    /// displacements.
    fn settle_with(&mut self, is_at_hand: bool, time: f64, state: &mut [f64]) {
        let at = self.columns(state);
        if !(is_at_hand && self.is_evaluated_at(&at)) {
            return self.accelerate(time, state);
        }
        let mut rate = std::mem::take(&mut self.rate);
        let totals = self.evaluate_from_outside(time, state, &mut rate);
        self.store((time, &rate), totals, state);
        self.rate = rate;
    }
}
