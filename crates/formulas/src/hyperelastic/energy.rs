//! A law by an energy of its user.

use std::ops::{Add, Div, Mul, Neg, Sub};
use std::sync::Arc;

use nalgebra::Matrix3;

use super::kinematics::{Kinematics, scaled, square, trace};
use super::{HyperelasticResponse, LameConstants};
use crate::{Number, tensor};

/// What an energy may depend on: invariants of `C = F^T F`, as they are and without the volume.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Invariant {
    /// `I1 = tr C`.
    First,
    /// `I2 = ((tr C)^2 - C : C)/2`.
    Second,
    /// `J = det F`.
    Volume,
    /// `J^(-2/3) I1`.
    FirstIsochoric,
    /// `J^(-4/3) I2`.
    SecondIsochoric,
}

impl Invariant {
    /// All of them, with the names by which expressions call them.
    pub const ALL: [(&'static str, Self); 5] = [
        ("I1", Self::First),
        ("I2", Self::Second),
        ("J", Self::Volume),
        ("I1b", Self::FirstIsochoric),
        ("I2b", Self::SecondIsochoric),
    ];
}

/// One instruction of an [`EnergyFunction`], which works on a stack.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Instruction {
    /// Puts a number there.
    Number(f64),
    /// Puts an invariant there.
    Of(Invariant),
    /// Adds the last two.
    Add,
    /// Subtracts the last from the one before.
    Subtract,
    /// Multiplies the last two.
    Multiply,
    /// Divides the one before by the last.
    Divide,
    /// The last with the other sign.
    Negate,
    /// A power of the last.
    Power(f64),
    /// The exponential of the last.
    Exponential,
    /// The natural logarithm of the last.
    Logarithm,
    /// The square root of the last.
    Root,
}

/// An energy `psi(I1, I2, J, I1b, I2b)` per reference volume in J/m^3 that is not one of the laws by name: theory (99).
///
/// The stress `P = sum_k d psi/d I_k d I_k/dF` is exact: derivatives by the invariants go with each instruction.
/// Digits of small strains are those of the instructions, which see invariants near 3.
///
/// ```
/// use piola_formulas::hyperelastic::{EnergyFunction, Instruction, Invariant};
///
/// // 1000 (I1b - 3) + 5e5 (J - 1)^2
/// let square = [Instruction::Of(Invariant::Volume), Instruction::Number(1.0), Instruction::Subtract];
/// let energy = [
///     &[Instruction::Number(1000.0), Instruction::Of(Invariant::FirstIsochoric)][..],
///     &[Instruction::Number(3.0), Instruction::Subtract, Instruction::Multiply],
///     &[Instruction::Number(5e5)],
///     &square,
///     &[Instruction::Power(2.0), Instruction::Multiply, Instruction::Add],
/// ];
/// let energy = EnergyFunction::new(energy.concat())?;
/// assert!((energy.small_strain().mu - 2000.0).abs() < 1e-6);
/// # Ok::<(), piola_formulas::hyperelastic::EnergyError>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct EnergyFunction {
    instructions: Arc<[Instruction]>,
    /// Energy at rest in J/m^3, which is taken away.
    at_rest: f64,
    small_strain: LameConstants,
}

/// Why an energy is none.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("{0}")]
pub struct EnergyError(String);

/// Most numbers on the stack.
const DEPTH: usize = 24;
/// A base of powers that is as good as zero: what round-off leaves of a difference of invariants.
const NOTHING: f64 = 1e-14;
/// Stress at rest that is round-off, as a part of the stiffness.
const STRESS_AT_REST: f64 = 1e-10;

impl EnergyFunction {
    /// The energy of some instructions, the last of which leaves one number.
    ///
    /// # Errors
    /// Where they do not, or need more than 24 numbers at once; where energy, stress or
    /// stiffness at rest is not finite, where there is stress at rest, and where the stiffness of small strains is not
    /// positive.
    pub fn new(instructions: Vec<Instruction>) -> Result<Self, EnergyError> {
        let refused = |reason: String| Err(EnergyError(reason));
        let mut depth = 0_usize;
        for instruction in &instructions {
            let (needs, leaves) = match instruction {
                Instruction::Number(_) | Instruction::Of(_) => (0, 1),
                Instruction::Add
                | Instruction::Subtract
                | Instruction::Multiply
                | Instruction::Divide => (2, 1),
                _ => (1, 1),
            };
            if depth < needs {
                return refused("an instruction has nothing to work on".to_owned());
            }
            depth = depth - needs + leaves;
            if depth > DEPTH {
                return refused(format!("it needs more than {DEPTH} numbers at once"));
            }
        }
        if depth != 1 {
            return refused(format!("it leaves {depth} numbers instead of one"));
        }
        let unknown = LameConstants { lambda: 0.0, mu: 0.0 };
        let mut energy =
            Self { instructions: instructions.into(), at_rest: 0.0, small_strain: unknown };
        let rest = Matrix3::zeros();
        energy.at_rest = energy.energy(&rest);
        // dP11/dF11, dP22/dF11 and dP12/dF12 of small strains.
        let slope = |i: usize, j: usize| {
            let mut gradient = rest.map(num_dual::Dual64::from_re);
            gradient[(i, j)] = gradient[(i, j)].derivative();
            energy.stress(&gradient).map(|stress| stress.eps)
        };
        let (along, mu) = (slope(0, 0), slope(0, 1)[(0, 1)]);
        let lambda = along[(1, 1)];
        let stress = energy.stress(&rest)[(0, 0)];
        if ![energy.at_rest, stress, lambda, mu].iter().all(|value: &f64| value.is_finite()) {
            return refused(format!(
                "at rest (I1 = I2 = 3, J = 1) the energy is {} J/m^3, the stress {stress} Pa and the shear modulus {mu} Pa",
                energy.at_rest
            ));
        }
        if stress.abs() > STRESS_AT_REST * along[(0, 0)].abs().max(mu.abs()) {
            return refused(format!(
                "there is a stress of {stress} Pa at rest, where there must be none; a term in \
                 ln(J) or (J - 1) removes it"
            ));
        }
        let kappa = lambda + 2.0 / 3.0 * mu;
        let scale = STRESS_AT_REST * (kappa.abs() + mu.abs());
        for (modulus, name, cause) in
            [(mu, "shear modulus", "change of shape"), (kappa, "bulk modulus", "change of volume")]
        {
            if modulus <= scale {
                return refused(format!(
                    "the {name} of small strains is {modulus} Pa: nothing resists a {cause}; add a term \
                     that grows with it"
                ));
            }
        }
        energy.small_strain = LameConstants { lambda, mu };
        Ok(energy)
    }

    /// Lame's constants of small strains.
    pub fn small_strain(&self) -> LameConstants {
        self.small_strain
    }

    fn evaluate<N: Value>(&self, invariants: &[N; 5]) -> N {
        let mut stack = [N::from(0.0); DEPTH];
        let mut top = 0;
        for instruction in self.instructions.iter() {
            let two = |stack: &[N; DEPTH]| (stack[top - 2], stack[top - 1]);
            let (place, value) = match *instruction {
                Instruction::Number(value) => (top, N::from(value)),
                Instruction::Of(which) => (top, invariants[which as usize]),
                Instruction::Negate => (top - 1, -stack[top - 1]),
                Instruction::Power(exponent) => (top - 1, stack[top - 1].power(exponent)),
                Instruction::Exponential => (top - 1, stack[top - 1].exponential()),
                Instruction::Logarithm => (top - 1, stack[top - 1].logarithm()),
                Instruction::Root => (top - 1, stack[top - 1].root()),
                binary => {
                    let (left, right) = two(&stack);
                    let value = match binary {
                        Instruction::Add => left + right,
                        Instruction::Subtract => left - right,
                        Instruction::Multiply => left * right,
                        _ => left / right,
                    };
                    (top - 2, value)
                }
            };
            stack[place] = value;
            top = place + 1;
        }
        stack[0]
    }
}

impl HyperelasticResponse for EnergyFunction {
    fn energy<T: Number>(&self, a: &Matrix3<T>) -> T {
        let kinematics = Kinematics::new(a);
        let values = Invariants::new(&kinematics).all();
        self.evaluate(&values.map(Plain)).0 - self.at_rest
    }

    fn stress<T: Number>(&self, a: &Matrix3<T>) -> Matrix3<T> {
        let kinematics = Kinematics::new(a);
        let invariants = Invariants::new(&kinematics);
        let values = invariants.all();
        let seeded = std::array::from_fn(|k| {
            let by = std::array::from_fn(|other| if other == k { T::one() } else { T::zero() });
            Sloped { value: values[k], by }
        });
        let [first, second, volume, first_isochoric, second_isochoric] = self.evaluate(&seeded).by;
        let [first_power, second_power] = invariants.powers;
        let gradient = &kinematics.gradient;
        let (first_sum, second_sum) =
            (first + first_power * first_isochoric, second + second_power * second_isochoric);
        let along = (first_sum + invariants.first * second_sum) * 2.0;
        let outwards = volume
            - (first_power * invariants.first * first_isochoric * (2.0 / 3.0)
                + second_power * invariants.second * second_isochoric * (4.0 / 3.0))
                / (kinematics.volume_strain + 1.0);
        let right = tensor::right_cauchy_green(gradient);
        scaled(gradient, along) - scaled(&(gradient * right), second_sum * 2.0)
            + scaled(&tensor::cofactor(gradient), outwards)
    }
}

/// Invariants of a deformation.
struct Invariants<T> {
    first: T,
    second: T,
    volume: T,
    /// `J^(-2/3)` and `J^(-4/3)`.
    powers: [T; 2],
}

impl<T: Number> Invariants<T> {
    fn new(kinematics: &Kinematics<T>) -> Self {
        let strain = &kinematics.strain;
        let trace = trace(strain);
        Self {
            first: trace * 2.0 + 3.0,
            second: trace * 4.0 + (trace * trace - square(strain)) * 2.0 + 3.0,
            volume: kinematics.volume_strain + 1.0,
            powers: [-2.0 / 3.0, -4.0 / 3.0].map(|exponent| kinematics.volume_power(exponent)),
        }
    }

    /// In the order of [`Invariant`].
    fn all(&self) -> [T; 5] {
        let [first, second] = self.powers;
        [self.first, self.second, self.volume, first * self.first, second * self.second]
    }
}

/// What instructions work on.
trait Value:
    Copy
    + From<f64>
    + Add<Output = Self>
    + Sub<Output = Self>
    + Mul<Output = Self>
    + Div<Output = Self>
    + Neg<Output = Self>
{
    fn power(self, exponent: f64) -> Self;
    fn exponential(self) -> Self;
    fn logarithm(self) -> Self;
    fn root(self) -> Self;
}

/// A number.
#[derive(Clone, Copy)]
struct Plain<T>(T);

/// A number with its derivatives by the invariants.
#[derive(Clone, Copy)]
struct Sloped<T> {
    value: T,
    by: [T; 5],
}

/// Products where the exponent is small and whole: exact at a base of zero, and for negative ones. With other exponents
/// above zero a base within [`NOTHING`] of zero is zero, with derivatives that are zero too: `I1b - 3` is negative by
/// round-off at rest, and has no power there. Of other negative numbers the power is NaN.
fn power<T: Number>(base: T, exponent: f64) -> T {
    match exponent {
        0.0 => T::one(),
        _ if exponent > 0.0 && exponent.fract() != 0.0 => {
            T::choose(base.abs().below(NOTHING), T::zero, || base.powf(exponent))
        }
        1.0 => base,
        2.0 => base * base,
        3.0 => base * base * base,
        4.0 => (base * base) * (base * base),
        _ => base.powf(exponent),
    }
}

impl<T: Number> Sloped<T> {
    /// A function of it, with the value and the slope.
    fn chain(self, value: T, slope: T) -> Self {
        Self { value, by: self.by.map(|by| by * slope) }
    }
}

impl<T: Number> Value for Plain<T> {
    fn power(self, exponent: f64) -> Self {
        Self(power(self.0, exponent))
    }

    fn exponential(self) -> Self {
        Self(self.0.exp())
    }

    fn logarithm(self) -> Self {
        Self(self.0.ln())
    }

    fn root(self) -> Self {
        Self(self.0.sqrt())
    }
}

impl<T: Number> Value for Sloped<T> {
    fn power(self, exponent: f64) -> Self {
        if exponent == 0.0 {
            return Self::from(1.0);
        }
        let slope = power(self.value, exponent - 1.0) * exponent;
        self.chain(power(self.value, exponent), slope)
    }

    fn exponential(self) -> Self {
        let value = self.value.exp();
        self.chain(value, value)
    }

    fn logarithm(self) -> Self {
        self.chain(self.value.ln(), self.value.recip())
    }

    fn root(self) -> Self {
        let value = self.value.sqrt();
        self.chain(value, value.recip() * 0.5)
    }
}

impl<T: Number> From<f64> for Plain<T> {
    fn from(value: f64) -> Self {
        Self(T::from(value))
    }
}

impl<T: Number> From<f64> for Sloped<T> {
    fn from(value: f64) -> Self {
        Self { value: T::from(value), by: [T::zero(); 5] }
    }
}

/// The four operations: of numbers, and of what has slopes with the slope of the result by the k-th invariant.
macro_rules! operation {
    ($trait:ident, $method:ident, $operator:tt, $slope:expr) => {
        impl<T: Number> $trait for Plain<T> {
            type Output = Self;

            fn $method(self, other: Self) -> Self {
                Self(self.0 $operator other.0)
            }
        }

        #[allow(clippy::suspicious_arithmetic_impl, reason = "the rules of derivatives")]
        impl<T: Number> $trait for Sloped<T> {
            type Output = Self;

            fn $method(self, other: Self) -> Self {
                let value = self.value $operator other.value;
                let slope: fn(Self, Self, T, usize) -> T = $slope;
                Self { value, by: std::array::from_fn(|k| slope(self, other, value, k)) }
            }
        }
    };
}

operation!(Add, add, +, |a, b, _, k| a.by[k] + b.by[k]);
operation!(Sub, sub, -, |a, b, _, k| a.by[k] - b.by[k]);
operation!(Mul, mul, *, |a, b, _, k| a.by[k] * b.value + b.by[k] * a.value);
operation!(Div, div, /, |a, b, value, k| (a.by[k] - value * b.by[k]) / b.value);

impl<T: Number> Neg for Plain<T> {
    type Output = Self;

    fn neg(self) -> Self {
        Self(-self.0)
    }
}

impl<T: Number> Neg for Sloped<T> {
    type Output = Self;

    fn neg(self) -> Self {
        Self { value: -self.value, by: self.by.map(|by| -by) }
    }
}
