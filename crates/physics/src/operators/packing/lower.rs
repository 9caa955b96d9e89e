//! Places moved down below the boundary of a shape.

use crate::Vector;
use crate::geometry::{Probe, Shape, slope};

/// A particle is low enough up to this part of a spacing.
const ENOUGH: f64 = 1e-9;

/// Most attempts to move a particle below the boundary.
const ATTEMPTS: usize = 12;

/// How deep it is looked for the boundary, and how far apart depths are of which slopes are made, in spacings.
const FAR: f64 = 4.0;
const OFF: f64 = 1e-3;

/// Depths in a shape whose particles are this many m apart.
pub(super) struct Depth<'a, const D: usize> {
    shape: Probe<'a, D>,
    width: f64,
}

impl<'a, const D: usize> Depth<'a, D> {
    /// Depths in a shape.
    pub fn of(shape: &'a Shape<D>, width: f64) -> Self {
        Self { shape: Probe::of(shape), width }
    }

    /// A place moved down to half a spacing below the boundary if it is higher, as far as the shape is thick enough, and by how
    /// much it is then lower than that, in m, as far as that is looked at.
    pub fn lower(&mut self, mut at: Vector<D>) -> (Vector<D>, f64) {
        let (wanted, reach) = (0.5 * self.width, FAR * self.width);
        let mut clear = self.shape.depth(&at, reach) - wanted;
        let mut part = 1.0;
        for _ in 0..ATTEMPTS {
            if clear >= -ENOUGH * self.width {
                break;
            }
            let off = OFF * self.width;
            let outwards = -slope(&at, off, |x| self.shape.depth(x, reach));
            let Some(normal) = outwards.try_normalize(0.1 * off) else { break };
            let tried = at + normal * (part * clear);
            let found = self.shape.depth(&tried, reach) - wanted;
            // Beyond the middle of what is thin it is higher again.
            match found > clear {
                true => (at, clear) = (tried, found),
                false => part *= 0.5,
            }
        }
        (at, clear)
    }
}
