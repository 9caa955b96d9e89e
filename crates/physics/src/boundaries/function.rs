//! A value that depends on place and time.

/// A number as a function of reference position and time. Case files make it from expressions;
/// Rust code from anything.
pub trait SpaceTime: Send + Sync {
    /// Value at reference position `x` in m (padded with zeros to three) and time `t` in s.
    fn value(&self, x: [f64; 3], t: f64) -> f64;

    /// Derivative of the value with respect to time.
    fn rate(&self, x: [f64; 3], t: f64) -> f64;

    /// Whether the value is the same at all times.
    fn is_steady(&self) -> bool;

    /// Whether it is known to be the same at all places.
    fn is_uniform(&self) -> bool {
        false
    }
}

impl SpaceTime for f64 {
    fn value(&self, _x: [f64; 3], _t: f64) -> f64 {
        *self
    }

    fn rate(&self, _x: [f64; 3], _t: f64) -> f64 {
        0.0
    }

    fn is_steady(&self) -> bool {
        true
    }

    fn is_uniform(&self) -> bool {
        true
    }
}

/// A position padded with zeros to three components, as expressions see it.
pub fn padded<const D: usize>(x: &crate::Vector<D>) -> [f64; 3] {
    let mut place = [0.0; 3];
    place[..D].copy_from_slice(x.as_slice());
    place
}
