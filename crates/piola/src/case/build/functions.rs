//! Expressions of a case file as functions of place and time.

use crate::boundaries::SpaceTime;
use crate::case::expression::{Expression, Variable};

impl SpaceTime for Expression {
    fn value(&self, x: [f64; 3], t: f64) -> f64 {
        self.eval(x, t)
    }

    fn rate(&self, x: [f64; 3], t: f64) -> f64 {
        Expression::rate(self, x, t)
    }

    fn is_steady(&self) -> bool {
        !self.depends_on(Variable::T)
    }
}
