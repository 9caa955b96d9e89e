//! Evaluation by `exmex`, once with plain numbers and once with dual numbers for the rate.

use std::cell::Cell;
use std::fmt::Debug;
use std::str::FromStr;
use std::sync::atomic::{AtomicU64, Ordering};

use exmex::{Express, FlatEx, MatchLiteral};

use super::functions::Operators;
use super::syntax::Tree;
use super::{ExpressionError, Variable};

/// What an expression computes with.
pub(super) trait Number: Copy + Debug + Default + FromStr<Err: Debug> {
    fn from_number(value: f64) -> Self;
    fn value(self) -> f64;
    fn negative(self) -> Self;
    fn add(self, other: Self) -> Self;
    fn sub(self, other: Self) -> Self;
    fn mul(self, other: Self) -> Self;
    fn div(self, other: Self) -> Self;
    fn pow(self, exponent: Self) -> Self;
    fn arc_tangent(y: Self, x: Self) -> Self;
    /// A function and its derivative.
    fn chain(self, function: fn(f64) -> f64, derivative: fn(f64) -> f64) -> Self;
}

impl Number for f64 {
    fn from_number(value: f64) -> Self {
        value
    }
    fn value(self) -> f64 {
        self
    }
    fn negative(self) -> Self {
        -self
    }
    fn add(self, other: Self) -> Self {
        self + other
    }
    fn sub(self, other: Self) -> Self {
        self - other
    }
    fn mul(self, other: Self) -> Self {
        self * other
    }
    fn div(self, other: Self) -> Self {
        self / other
    }
    fn pow(self, exponent: Self) -> Self {
        power(self, exponent)
    }
    fn arc_tangent(y: Self, x: Self) -> Self {
        y.atan2(x)
    }
    fn chain(self, function: fn(f64) -> f64, _: fn(f64) -> f64) -> Self {
        function(self)
    }
}

/// `base^exponent`, with squares as products: these are rounded correctly and the same on every
/// platform, while the power function of the system can be off in the last digit.
fn power(base: f64, exponent: f64) -> f64 {
    if exponent == 2.0 { base * base } else { base.powf(exponent) }
}

/// A number and its rate: `a + b eps` with `eps^2 = 0`.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Dual {
    value: f64,
    rate: f64,
}

impl FromStr for Dual {
    type Err = std::num::ParseFloatError;

    fn from_str(text: &str) -> Result<Self, Self::Err> {
        text.parse().map(Self::from_number)
    }
}

/// `factor * rate`, and 0 where the rate is 0: a constant under a root has rate 0 even at 0,
/// where the derivative of the root is infinite.
fn scaled(factor: f64, rate: f64) -> f64 {
    if rate == 0.0 { 0.0 } else { factor * rate }
}

impl Number for Dual {
    fn from_number(value: f64) -> Self {
        Self { value, rate: 0.0 }
    }
    fn value(self) -> f64 {
        self.value
    }
    fn negative(self) -> Self {
        Self { value: -self.value, rate: -self.rate }
    }
    fn add(self, other: Self) -> Self {
        Self { value: self.value + other.value, rate: self.rate + other.rate }
    }
    fn sub(self, other: Self) -> Self {
        Self { value: self.value - other.value, rate: self.rate - other.rate }
    }
    fn mul(self, other: Self) -> Self {
        let rate = scaled(other.value, self.rate) + scaled(self.value, other.rate);
        Self { value: self.value * other.value, rate }
    }
    fn div(self, other: Self) -> Self {
        let value = self.value / other.value;
        let rate = scaled(1.0 / other.value, self.rate) - scaled(value / other.value, other.rate);
        Self { value, rate }
    }
    fn pow(self, exponent: Self) -> Self {
        let value = power(self.value, exponent.value);
        let by_base = exponent.value * power(self.value, exponent.value - 1.0);
        let by_exponent = value * self.value.ln();
        Self { value, rate: scaled(by_base, self.rate) + scaled(by_exponent, exponent.rate) }
    }
    fn arc_tangent(y: Self, x: Self) -> Self {
        let square = x.value * x.value + y.value * y.value;
        let rate = scaled(x.value / square, y.rate) - scaled(y.value / square, x.rate);
        Self { value: y.value.atan2(x.value), rate }
    }
    fn chain(self, function: fn(f64) -> f64, derivative: fn(f64) -> f64) -> Self {
        Self { value: function(self.value), rate: scaled(derivative(self.value), self.rate) }
    }
}

/// Numbers as Rust prints them: `0.1`, `1e-7`, `2.5e300`.
#[derive(Clone, Debug)]
struct Literals;

impl MatchLiteral for Literals {
    fn is_literal(text: &str) -> Option<&str> {
        let bytes = text.as_bytes();
        if !bytes.first()?.is_ascii_digit() {
            return None;
        }
        let part = |c: u8, before: u8| {
            c.is_ascii_digit() || c == b'.' || c == b'e' || (c == b'-' && before == b'e')
        };
        let length = (1..bytes.len()).find(|i| !part(bytes[*i], bytes[*i - 1]));
        Some(&text[..length.unwrap_or(bytes.len())])
    }
}

type Evaluator<T> = FlatEx<T, Operators, Literals>;

/// An expression, ready to be evaluated.
#[derive(Clone, Debug)]
pub(super) struct Program {
    plain: Evaluator<f64>,
    dual: Evaluator<Dual>,
    /// The variables that occur, in the order in which `exmex` wants them.
    variables: Vec<Variable>,
    /// Its number, if time is the only one.
    of_time: Option<u64>,
}

impl Program {
    /// Makes a program of the tree of the expression `text`.
    pub(super) fn new(text: &str, tree: &Tree) -> Result<Self, ExpressionError> {
        let bracketed = tree.bracketed();
        let refused = || {
            let message = format!("`{text}` cannot be evaluated");
            ExpressionError::new(0..text.len(), message, "cannot be evaluated")
        };
        let plain = Evaluator::<f64>::parse(&bracketed).map_err(|_| refused())?;
        let dual = Evaluator::<Dual>::parse(&bracketed).map_err(|_| refused())?;
        let variables: Option<Vec<Variable>> = (plain.var_names().iter())
            .map(|name| match name.as_str() {
                "x" => Some(Variable::X),
                "y" => Some(Variable::Y),
                "z" => Some(Variable::Z),
                "t" => Some(Variable::T),
                _ => None,
            })
            .collect();
        let variables = variables.ok_or_else(refused)?;
        let of_time = (variables == [Variable::T]).then(|| NEXT.fetch_add(1, Ordering::Relaxed));
        Ok(Self { plain, dual, variables, of_time })
    }

    /// The value where there are no variables.
    pub(super) fn constant(&self) -> Option<f64> {
        self.variables.is_empty().then(|| self.plain.eval(&[]).unwrap_or(f64::NAN))
    }

    pub(super) fn depends_on(&self, variable: Variable) -> bool {
        self.variables.contains(&variable)
    }

    pub(super) fn eval(&self, position: [f64; 3], time: f64) -> f64 {
        match self.of_time {
            Some(number) => recent(2 * number, time, || self.found(position, time)),
            None => self.found(position, time),
        }
    }

    fn found(&self, position: [f64; 3], time: f64) -> f64 {
        let [x, y, z] = position;
        let all = [x, y, z, time];
        let mut values = [0.0; 4];
        for (value, variable) in values.iter_mut().zip(&self.variables) {
            *value = all[*variable as usize];
        }
        self.plain.eval(&values[..self.variables.len()]).unwrap_or(f64::NAN)
    }

    /// The derivative by one of the variables.
    pub(super) fn derivative(&self, by: Variable, position: [f64; 3], time: f64) -> f64 {
        match self.of_time {
            Some(number) if by == Variable::T => {
                recent(2 * number + 1, time, || self.found_derivative(by, position, time))
            }
            _ => self.found_derivative(by, position, time),
        }
    }

    fn found_derivative(&self, by: Variable, position: [f64; 3], time: f64) -> f64 {
        let [x, y, z] = position;
        let mut all = [x, y, z, time].map(Dual::from_number);
        all[by as usize].rate = 1.0;
        let mut values = [Dual::default(); 4];
        for (value, variable) in values.iter_mut().zip(&self.variables) {
            *value = all[*variable as usize];
        }
        self.dual.eval(&values[..self.variables.len()]).map_or(f64::NAN, |result| result.rate)
    }
}

/// The number of the next function of time.
static NEXT: AtomicU64 = AtomicU64::new(0);

/// Values that a thread keeps.
const KEPT: usize = 16;

/// A value of a function of time: which one, the bits of the time, and the value.
type Kept = (u64, u64, f64);

thread_local! {
    /// The last values of functions of time alone, each of which is asked for by all particles that it acts on.
    static RECENT: [Cell<Kept>; KEPT] = const { [const { Cell::new((u64::MAX, 0, 0.0)) }; KEPT] };
}

/// The value of a function of time at a time, which `find` finds if it is not the last one that was.
fn recent(function: u64, time: f64, find: impl FnOnce() -> f64) -> f64 {
    RECENT.with(|all| {
        let kept = &all[function as usize % KEPT];
        let (of, at, value) = kept.get();
        if (of, at) == (function, time.to_bits()) {
            return value;
        }
        let value = find();
        kept.set((function, time.to_bits(), value));
        value
    })
}
