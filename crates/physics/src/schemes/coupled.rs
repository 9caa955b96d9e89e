//! What a formulation of several systems offers to the integrator that moves them.

use std::ops::Range;

use super::Scheme;

/// A fluid with solids in it, which act on each other between their own steps: theory (82).
pub trait CoupledScheme: Scheme {
    /// Number of the solids.
    fn solid_count(&self) -> usize;

    /// A solid by its number, and its part of a state.
    fn solid(&mut self, number: usize) -> (&mut dyn Scheme, Range<usize>);

    /// How many steps of its own the fluid takes in a step of `step` s from the state that [`Scheme::inspect`] has
    /// looked at last; one before any look.
    fn fluid_steps(&self, step: f64) -> u64;

    /// The same of a solid.
    fn solid_steps(&self, number: usize, step: f64) -> u64;

    /// Begins a step from a time and of a length in s, of which `counts` of each system are one, the fluid first: finds the
    /// forces that the fluid in `state` has on the solids, and gives them the impulse in half of their first own step.
    fn push(&mut self, step: [f64; 2], counts: &[u64], state: &mut [f64]);

    /// Gives a solid by its number the same forces between two of its own steps: at a time and for a duration in s, to its
    /// part of a state; what it does is booked in `state`.
    fn push_on(&mut self, number: usize, push: [f64; 2], own: &mut [f64], state: &mut [f64]);

    /// Ends the step behind [`Self::flow`]: with what makes the impulse of the whole step that which the fluid has lost.
    fn repay(&mut self, step: [f64; 2], counts: &[u64], state: &mut [f64]);

    /// Brings what the solids keep of their forces into line with velocities that have changed.
    fn settle(&mut self, time: f64, state: &mut [f64]);

    /// Takes the fluid in `new` in its steps through one from a time and of a length in s, around solids that go from where
    /// they are in `old` to where they are in `new`, behind [`Self::push`] from `old`.
    fn flow(&mut self, step: [f64; 2], counts: &[u64], old: &[f64], new: &mut [f64]);

    /// Brings what `state` says of all systems together into line with the systems, which have taken this many steps of
    /// their own, the fluid first.
    fn add_up(&mut self, counts: &[u64], state: &mut [f64]);

    /// Forgets what is known of one state for the next: another one follows.
    fn forget(&mut self);

    /// Brings accelerations that systems hold, and the fluid around solids, into line with a state that has been changed
    /// from outside.
    fn refresh(&mut self, time: f64, state: &mut [f64]);
}
