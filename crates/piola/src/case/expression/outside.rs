//! External functions as expressions.

use std::fmt;
use std::sync::Arc;

use super::Variable;
use crate::boundaries::SpaceTime;

/// The step of difference quotients, as a share of the coordinate or of 1 m.
const STEP: f64 = 1e-6;

/// A function of place and time.
#[derive(Clone)]
pub(super) struct Outside(pub Arc<dyn SpaceTime>);

impl fmt::Debug for Outside {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        formatter.write_str("a function")
    }
}

impl Outside {
    /// Whether it may.
    pub fn depends_on(&self, variable: Variable) -> bool {
        match variable {
            Variable::T => !self.0.is_steady(),
            _ => !self.0.is_uniform(),
        }
    }

    /// The rate that it provides, or a central difference along an axis.
    pub fn derivative(&self, by: Variable, position: [f64; 3], time: f64) -> f64 {
        if by == Variable::T {
            return self.0.rate(position, time);
        }
        let step = STEP * position[by as usize].abs().max(1.0);
        let at = |shift: f64| {
            let mut place = position;
            place[by as usize] += shift;
            self.0.value(place, time)
        };
        (at(step) - at(-step)) / (2.0 * step)
    }
}
