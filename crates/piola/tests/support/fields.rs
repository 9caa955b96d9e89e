//! What every formulation owes those who look at its fields.

use std::sync::Arc;
use std::sync::atomic::{AtomicUsize, Ordering};

use piola::boundaries::{BodyForce, SpaceTime};
use piola::schemes::{Observation, Scheme};

/// A body force that counts how often it is asked.
#[derive(Clone, Default)]
pub struct Counted(Arc<AtomicUsize>);

impl SpaceTime for Counted {
    fn value(&self, x: [f64; 3], t: f64) -> f64 {
        self.0.fetch_add(1, Ordering::Relaxed);
        x[0] + t
    }

    fn rate(&self, _x: [f64; 3], _t: f64) -> f64 {
        f64::NAN
    }

    fn is_steady(&self) -> bool {
        false
    }
}

impl Counted {
    pub fn force<const D: usize>(&self) -> BodyForce<D> {
        BodyForce { body: None, acceleration: std::array::from_fn(|_| Arc::new(self.clone()) as _) }
    }

    fn take(&self) -> usize {
        self.0.swap(0, Ordering::Relaxed)
    }
}

/// Every described field has as many finite values as described, and those in the state are its columns, one
/// behind the other. All of them together take one evaluation at most, in whatever order they are read.
pub fn fields_are_complete(scheme: &mut dyn Scheme, state: &[f64], counted: &Counted) {
    let description = scheme.description();
    let (count, dimension) = (scheme.particle_count(), scheme.dimension());
    let particles: Vec<u32> = (0..count as u32).rev().collect();
    let mut end = 0;
    for (number, field) in description.fields.iter().enumerate() {
        let column = scheme.column(field);
        assert_eq!(field.number, number, "{}", field.name);
        assert!(column.is_empty() || column.start == end, "{}", field.name);
        end = if column.is_empty() { end } else { column.end };
    }
    assert!(end == 0 || end == count * scheme.width());
    counted.take();
    match scheme.split() {
        Some(split) => split.accelerate(0.5, &mut state.to_vec()),
        None => scheme.rates(0.5, state, &mut vec![0.0; state.len()]),
    }
    let evaluation = counted.take();
    for turn in 0..2 {
        let mut fields: Vec<_> = description.fields.iter().collect();
        if turn == 1 {
            fields.reverse();
        }
        let mut observation = Observation::new(scheme, 0.5, state);
        for field in fields {
            let mut values = Vec::new();
            observation.read(field, &particles, &mut values);
            assert_eq!(values.len(), count * field.kind.components(dimension), "{}", field.name);
            assert!(values.iter().all(|value| value.is_finite()), "{}", field.name);
        }
        let asked = counted.take();
        assert!(asked <= evaluation, "{}: {asked} for {evaluation}", description.name);
    }
}
