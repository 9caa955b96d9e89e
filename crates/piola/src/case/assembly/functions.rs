//! Expressions of a case file as functions of place and time.

use crate::Vector;
use crate::boundaries::SpaceTime;
use crate::case::expression::{Expression, Variable};
use crate::schemes::interpolation::Field;

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

    fn is_uniform(&self) -> bool {
        ![Variable::X, Variable::Y, Variable::Z].into_iter().any(|axis| self.depends_on(axis))
    }
}

impl<const D: usize> Field<D> for Expression {
    fn value(&self, x: [f64; 3]) -> f64 {
        self.eval(x, 0.0)
    }

    fn gradient(&self, x: [f64; 3]) -> Vector<D> {
        const AXES: [Variable; 3] = [Variable::X, Variable::Y, Variable::Z];
        Vector::from_fn(|axis, _| self.derivative(AXES[axis], x, 0.0))
    }
}
