//! What a formulation of several systems offers to the integrator that moves them.

use std::ops::Range;

use super::Scheme;

/// A fluid with solids in it, which act on each other between their own steps: theory (82).
pub trait CoupledScheme: Scheme {
    /// Number of the solids.
    fn solid_count(&self) -> usize;

    /// A solid by its number, and its part of a state.
    fn solid(&mut self, number: usize) -> (&mut dyn Scheme, Range<usize>);

    /// How many steps of its own a solid takes from `state` in a step of `step` s.
    fn steps_of(&mut self, number: usize, step: f64, state: &[f64]) -> u64;

    /// Gives the solids the impulse of the forces that the fluid in `state` has on them at `time`, in
    /// `duration` s.
    fn push(&mut self, time: f64, duration: f64, state: &mut [f64]);

    /// Brings what the solids keep of their forces into line with velocities that have changed.
    fn settle(&mut self, time: f64, state: &mut [f64]);

    /// Takes the fluid in `new` from `time` to `time + step`, around solids that go from where they are in
    /// `old` to where they are in `new`.
    fn flow(&mut self, time: f64, step: f64, old: &[f64], new: &mut [f64]);

    /// Brings what `state` says of all systems together into line with the systems.
    fn add_up(&mut self, state: &mut [f64]);

    /// Brings the fluid into line with solids that have been changed from outside.
    fn refresh(&mut self, time: f64, state: &mut [f64]);
}
