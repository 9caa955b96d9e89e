//! Numbers that record what is done to them.

use std::cell::RefCell;
use std::collections::HashMap;
use std::ops::{BitAnd, BitOr, Not};

use piola_formulas::Number;
use piola_formulas::functions::Bits;

use crate::operators::operators;

/// A function of one number.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub(crate) enum Unary {
    Negate,
    Abs,
    Sqrt,
    Exp,
    ExpM1,
    Ln,
    Ln1p,
    Sin,
    Cos,
    TwoTo,
    Exponent,
    Mantissa,
}

/// A function of two numbers.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub(crate) enum Binary {
    Add,
    Subtract,
    Multiply,
    Divide,
    Power,
    Atan2,
}

/// An operation on the results of earlier ones, which are given by their places.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub(crate) enum Operation {
    Input(u32),
    Constant(u64),
    Unary(Unary, u32),
    Binary(Binary, u32, u32),
    Less(u32, u32),
    AtMost(u32, u32),
    And(u32, u32),
    Or(u32, u32),
    Not(u32),
    Select(u32, u32, u32),
    /// A number of the state of a loop, inside.
    State(u32, u32),
    /// A number of the state of a loop, after its end.
    Final(u32, u32),
}

impl Operation {
    /// The places of what it acts on.
    pub fn operands(self) -> impl Iterator<Item = u32> {
        let all = match self {
            Self::Input(_) | Self::Constant(_) | Self::State(..) | Self::Final(..) => [None; 3],
            Self::Unary(_, a) | Self::Not(a) => [Some(a), None, None],
            Self::Binary(_, a, b)
            | Self::Less(a, b)
            | Self::AtMost(a, b)
            | Self::And(a, b)
            | Self::Or(a, b) => [Some(a), Some(b), None],
            Self::Select(a, b, c) => [Some(a), Some(b), Some(c)],
        };
        all.into_iter().flatten()
    }
}

/// A bounded loop on a state of several numbers.
#[derive(Clone, Debug)]
pub(crate) struct Loop {
    pub most: u32,
    pub start: Vec<u32>,
    pub until: u32,
    pub next: Vec<u32>,
}

/// All that was recorded.
#[derive(Clone, Debug, Default)]
pub(crate) struct Tape {
    pub operations: Vec<Operation>,
    pub loops: Vec<Loop>,
    known: HashMap<Operation, u32>,
}

impl Tape {
    /// The place of an operation, which is recorded once.
    fn push(&mut self, operation: Operation) -> u32 {
        let next = self.operations.len() as u32;
        let place = *self.known.entry(operation).or_insert(next);
        if place == next {
            self.operations.push(operation);
        }
        place
    }

    fn constant(&self, place: u32) -> Option<f64> {
        match self.operations[place as usize] {
            Operation::Constant(bits) => Some(f64::from_bits(bits)),
            _ => None,
        }
    }
}

thread_local!(static TAPE: RefCell<Option<Tape>> = RefCell::default());

/// Runs a function on a new tape.
pub(crate) fn recorded<R>(function: impl FnOnce() -> R) -> (R, Tape) {
    let before = TAPE.replace(Some(Tape::default()));
    let result = function();
    (result, TAPE.replace(before).unwrap_or_default())
}

/// Does something with the tape that runs.
fn on_tape<R>(act: impl FnOnce(&mut Tape) -> R) -> R {
    TAPE.with_borrow_mut(|tape| {
        act(tape.as_mut().expect("numbers are traced where a law is recorded"))
    })
}

fn push(operation: Operation) -> u32 {
    on_tape(|tape| tape.push(operation))
}

/// A number of which a law is recorded. It makes sense within its [`Law::record`](crate::Law::record) only: one that is
/// made where no law is recorded panics, and one of another law is another number.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Traced(pub(crate) u32);

/// The outcome of a comparison of such numbers.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Truth(u32);

impl Traced {
    pub(crate) fn input(number: usize) -> Self {
        Self(push(Operation::Input(number as u32)))
    }

    fn unary(self, function: Unary) -> Self {
        Self(push(Operation::Unary(function, self.0)))
    }

    /// Constants are computed at once, with the bits that a machine would find.
    fn binary(self, function: Binary, other: Self) -> Self {
        let constants = on_tape(|tape| [self, other].map(|number| tape.constant(number.0)));
        match (function, constants) {
            (Binary::Add, [Some(a), Some(b)]) => Self::from(a + b),
            (Binary::Subtract, [Some(a), Some(b)]) => Self::from(a - b),
            (Binary::Multiply, [Some(a), Some(b)]) => Self::from(a * b),
            (Binary::Divide, [Some(a), Some(b)]) => Self::from(a / b),
            (Binary::Multiply | Binary::Divide, [_, Some(1.0)]) => self,
            (Binary::Multiply, [Some(1.0), _]) => other,
            _ => Self(push(Operation::Binary(function, self.0, other.0))),
        }
    }

    fn plus(self, other: Self) -> Self {
        self.binary(Binary::Add, other)
    }

    fn minus(self, other: Self) -> Self {
        self.binary(Binary::Subtract, other)
    }

    fn times(self, other: Self) -> Self {
        self.binary(Binary::Multiply, other)
    }

    fn over(self, other: Self) -> Self {
        self.binary(Binary::Divide, other)
    }

    fn negated(self) -> Self {
        self.unary(Unary::Negate)
    }

    fn is_zero_constant(self) -> bool {
        on_tape(|tape| tape.constant(self.0)) == Some(0.0)
    }
}

operators!(Traced);

impl From<f64> for Traced {
    fn from(value: f64) -> Self {
        Self(push(Operation::Constant(value.to_bits())))
    }
}

impl BitAnd for Truth {
    type Output = Self;
    fn bitand(self, other: Self) -> Self {
        Self(push(Operation::And(self.0, other.0)))
    }
}

impl BitOr for Truth {
    type Output = Self;
    fn bitor(self, other: Self) -> Self {
        Self(push(Operation::Or(self.0, other.0)))
    }
}

impl Not for Truth {
    type Output = Self;
    fn not(self) -> Self {
        Self(push(Operation::Not(self.0)))
    }
}

impl Number for Traced {
    type Mask = Truth;
    type Real = Self;

    fn re(self) -> Self {
        self
    }

    fn lift(real: Self) -> Self {
        real
    }

    fn less(self, other: Self) -> Truth {
        Truth(push(Operation::Less(self.0, other.0)))
    }

    fn at_most(self, other: Self) -> Truth {
        Truth(push(Operation::AtMost(self.0, other.0)))
    }

    fn select(mask: Truth, yes: Self, no: Self) -> Self {
        if yes == no { yes } else { Self(push(Operation::Select(mask.0, yes.0, no.0))) }
    }

    /// The body is recorded once, as a loop.
    fn repeat<const N: usize>(
        most: u32,
        state: [Self; N],
        until: impl Fn(&[Self; N]) -> Truth,
        step: impl Fn([Self; N]) -> [Self; N],
    ) -> [Self; N] {
        let number = on_tape(|tape| {
            let start = state.iter().map(|number| number.0).collect();
            tape.loops.push(Loop { most, start, until: 0, next: Vec::new() });
            tape.loops.len() as u32 - 1
        });
        let inside = std::array::from_fn(|i| Self(push(Operation::State(number, i as u32))));
        let until = until(&inside).0;
        let next = step(inside).map(|number| number.0).to_vec();
        on_tape(|tape| {
            let recorded = &mut tape.loops[number as usize];
            (recorded.until, recorded.next) = (until, next);
        });
        std::array::from_fn(|i| Self(push(Operation::Final(number, i as u32))))
    }

    fn recip(self) -> Self {
        Self::from(1.0).over(self)
    }

    fn abs(self) -> Self {
        self.unary(Unary::Abs)
    }

    fn sqrt(self) -> Self {
        self.unary(Unary::Sqrt)
    }

    fn exp(self) -> Self {
        self.unary(Unary::Exp)
    }

    fn exp_m1(self) -> Self {
        self.unary(Unary::ExpM1)
    }

    fn ln(self) -> Self {
        self.unary(Unary::Ln)
    }

    fn ln_1p(self) -> Self {
        self.unary(Unary::Ln1p)
    }

    fn powf(self, exponent: f64) -> Self {
        self.binary(Binary::Power, Self::from(exponent))
    }

    fn sin(self) -> Self {
        self.unary(Unary::Sin)
    }

    fn cos(self) -> Self {
        self.unary(Unary::Cos)
    }

    fn atan2(self, x: Self) -> Self {
        self.binary(Binary::Atan2, x)
    }
}

impl Bits for Traced {
    fn two_to(self) -> Self {
        self.unary(Unary::TwoTo)
    }

    fn exponent(self) -> Self {
        self.unary(Unary::Exponent)
    }

    fn mantissa(self) -> Self {
        self.unary(Unary::Mantissa)
    }

    fn surely(_mask: Truth) -> bool {
        false
    }
}
