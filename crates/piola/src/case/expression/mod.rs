//! Expressions of position, time and named parameters.
//!
//! The text is read here, with positions for every message, and evaluated by the crate `exmex`.
//! That crate gets a rewritten, fully bracketed text, because three of its habits would surprise
//! an engineer: it reads `-2^2` as 4, knows no `1e3`, and refuses `min(1, max(2, 3))`.
//!
//! Grammar, from weakest to strongest: `+ -`, then `* /`, then a sign, then `^` (from the right),
//! then numbers, names, brackets and calls `f(a)`, `f(a, b)`. So `-2^2` is -4 and `2^-1` is 0.5.

mod energy;
mod engine;
mod functions;
mod outside;
mod syntax;
mod token;

use std::ops::Range;
use std::sync::Arc;

use piola_formulas::hyperelastic::Invariant;

use crate::boundaries::SpaceTime;

pub use energy::energy;
pub use functions::{Function, constants, functions};

use engine::Program;
use outside::Outside;

/// The longest expression in bytes.
pub const MAX_LENGTH: usize = 4096;
/// How deep brackets and calls, or signs, may be nested.
pub const MAX_NESTING: usize = 64;

/// What an expression may use besides numbers, constants and functions.
#[derive(Clone, Copy, Debug)]
pub struct Scope<'a> {
    /// How many of x, y and z are known: the dimension of the case, 0 for none.
    pub axes: usize,
    /// Whether t is known.
    pub time: bool,
    /// Named numbers, without a value where it was refused.
    pub parameters: &'a [(String, Option<f64>)],
    /// Whether the invariants of a strain are known, see [`energy`].
    pub invariants: bool,
}

impl<'a> Scope<'a> {
    /// Parameters alone.
    pub fn of_parameters(parameters: &'a [(String, Option<f64>)]) -> Self {
        Self { axes: 0, time: false, parameters, invariants: false }
    }

    /// The name of an invariant, if they are known.
    fn invariant(&self, name: &str) -> Option<&'static str> {
        let named = Invariant::ALL.into_iter().find(|(known, _)| *known == name);
        named.filter(|_| self.invariants).map(|(name, _)| name)
    }

    fn variable(&self, name: &str) -> Option<Variable> {
        let variable = match name {
            "x" => Variable::X,
            "y" => Variable::Y,
            "z" => Variable::Z,
            "t" => Variable::T,
            _ => return None,
        };
        let known = match variable {
            Variable::T => self.time,
            axis => (axis as usize) < self.axes,
        };
        known.then_some(variable)
    }

    /// The value of a parameter; the inner `None` where it was refused.
    fn parameter(&self, name: &str) -> Option<Option<f64>> {
        self.parameters.iter().find(|(known, _)| known == name).map(|(_, value)| *value)
    }

    /// Every name that may be written, for suggestions.
    fn names(&self) -> Vec<&str> {
        let axes = ["x", "y", "z"].into_iter().take(self.axes);
        let time = self.time.then_some("t");
        let parameters = self.parameters.iter().map(|(name, _)| name.as_str());
        let known = functions().iter().map(|function| function.name);
        let constants = constants().iter().map(|(name, _)| *name);
        let invariants = Invariant::ALL.iter().map(|(name, _)| *name);
        let invariants = invariants.filter(|_| self.invariants);
        axes.chain(time).chain(invariants).chain(parameters).chain(constants).chain(known).collect()
    }
}

/// A variable of an expression.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Variable {
    /// First coordinate in m.
    X = 0,
    /// Second coordinate in m.
    Y = 1,
    /// Third coordinate in m.
    Z = 2,
    /// Time in s.
    T = 3,
}

/// What is wrong with the text of an expression.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("{message}")]
pub struct ExpressionError {
    /// A sentence about it.
    pub message: String,
    /// A few words for the underlined text.
    pub label: String,
    /// The bytes of the expression that are concerned.
    pub span: Range<usize>,
    /// What the user can do.
    pub help: Option<String>,
    /// Whether the only fault is a parameter that has already been refused and reported.
    pub is_consequence: bool,
}

impl ExpressionError {
    fn new(span: Range<usize>, message: impl Into<String>, label: impl Into<String>) -> Self {
        Self {
            message: message.into(),
            label: label.into(),
            span,
            help: None,
            is_consequence: false,
        }
    }

    fn help(mut self, help: impl Into<String>) -> Self {
        self.help = Some(help.into());
        self
    }
}

/// An expression that can be evaluated from many threads at once.
#[derive(Clone, Debug)]
pub struct Expression {
    text: Arc<str>,
    form: Form,
}

#[derive(Clone, Debug)]
enum Form {
    Constant(f64),
    Variable(Arc<Program>),
    Outside(Outside),
    Array(Arc<[f64]>),
}

impl Expression {
    /// An expression without variables.
    pub fn constant(value: f64) -> Self {
        Self { text: value.to_string().into(), form: Form::Constant(value) }
    }

    /// Reads an expression.
    ///
    /// # Errors
    /// If the text is too long or too deeply nested, is not an expression, or uses a name that
    /// `scope` does not know; and if it has no variables and its value is not a finite number.
    pub fn parse(text: &str, scope: &Scope<'_>) -> Result<Self, ExpressionError> {
        let tree = syntax::parse(text, scope)?;
        let program = Program::new(text, &tree)?;
        let form = match program.constant() {
            None => Form::Variable(Arc::new(program)),
            Some(value) if value.is_finite() => Form::Constant(value),
            Some(value) => {
                let message =
                    format!("the value of `{text}` is {value}, which is not a finite number");
                return Err(ExpressionError::new(0..text.len(), message, "not finite"));
            }
        };
        Ok(Self { text: text.into(), form })
    }

    /// An external function, which `text` names.
    pub fn outside(text: &str, function: Arc<dyn SpaceTime>) -> Self {
        Self { text: text.into(), form: Form::Outside(Outside(function)) }
    }

    /// An array with a value for each particle of a body in the order of creation, which `text` names. It has no value at a
    /// position.
    pub fn of_particles(text: &str, values: Arc<[f64]>) -> Self {
        Self { text: text.into(), form: Form::Array(values) }
    }

    /// The array, if it is one.
    pub fn array(&self) -> Option<&Arc<[f64]>> {
        match &self.form {
            Form::Array(values) => Some(values),
            _ => None,
        }
    }

    /// The text as the user wrote it.
    pub fn text(&self) -> &str {
        &self.text
    }

    /// Its value if it depends neither on position nor on time.
    pub fn as_constant(&self) -> Option<f64> {
        match self.form {
            Form::Constant(value) => Some(value),
            Form::Variable(_) | Form::Outside(_) | Form::Array(_) => None,
        }
    }

    /// Whether the text uses `variable`.
    pub fn depends_on(&self, variable: Variable) -> bool {
        match &self.form {
            Form::Constant(_) => false,
            Form::Variable(program) => program.depends_on(variable),
            Form::Outside(function) => function.depends_on(variable),
            Form::Array(_) => variable != Variable::T,
        }
    }

    /// Whether the text uses any coordinate.
    pub fn depends_on_position(&self) -> bool {
        [Variable::X, Variable::Y, Variable::Z].into_iter().any(|axis| self.depends_on(axis))
    }

    /// Its value at a position in m and a time in s.
    ///
    /// NaN outside its domain, as for `sqrt(x)` at `x = -1`, and of an array: the caller has to check.
    pub fn eval(&self, position: [f64; 3], time: f64) -> f64 {
        match &self.form {
            Form::Constant(value) => *value,
            Form::Variable(program) => program.eval(position, time),
            Form::Outside(function) => function.0.value(position, time),
            Form::Array(_) => f64::NAN,
        }
    }

    /// Its rate, the [derivative](Self::derivative) with respect to time at a fixed position.
    pub fn rate(&self, position: [f64; 3], time: f64) -> f64 {
        self.derivative(Variable::T, position, time)
    }

    /// Its exact derivative with respect to a variable, the others being fixed, computed with dual numbers. For an
    /// external function the derivative with respect to time is the one it provides, and those with respect to
    /// coordinates are difference quotients.
    ///
    /// At a kink or jump (`abs`, `sign`, `min`, `max`, `floor`, `step`, `mod`) it is that of the
    /// branch that [`eval`](Self::eval) takes there; a jump contributes none.
    pub fn derivative(&self, by: Variable, position: [f64; 3], time: f64) -> f64 {
        match &self.form {
            Form::Constant(_) => 0.0,
            Form::Variable(program) => program.derivative(by, position, time),
            Form::Outside(function) => function.derivative(by, position, time),
            Form::Array(_) => f64::NAN,
        }
    }
}

impl PartialEq for Expression {
    fn eq(&self, other: &Self) -> bool {
        self.text == other.text && self.as_constant() == other.as_constant()
    }
}

#[cfg(test)]
mod tests;
