//! The registry of kernels, and the one place that turns a kernel's name into its type.

use super::{
    CubicSpline, Gaussian, KernelShape, Linear, Lucy, ModifiedMollifier, Mollifier, Quadratic,
    QuinticSpline, ScaledKernel, WendlandC2, WendlandC4, WendlandC6,
};
use crate::Number;
use crate::power::integer_power;

/// A computation that is generic over the kernel's shape, for [`Kernel::visit`].
pub trait KernelVisitor {
    /// What the computation returns.
    type Output;

    /// Runs the computation with the kernel's shape.
    fn visit<K: KernelShape>(self, shape: K) -> Self::Output;
}

macro_rules! registry {
    ($($kernel:ident),* $(,)?) => {
        /// A kernel by name.
        ///
        /// Its functions choose the shape at each call; a loop chooses once, by
        /// [`Kernel::visit`], and is generic over [`KernelShape`] inside.
        ///
        /// ```
        /// use piola_formulas::kernels::Kernel;
        ///
        /// let kernel = Kernel::from_name("cubic_spline").unwrap();
        /// assert_eq!(kernel.support_radius(0.5), 1.0);
        /// assert_eq!(kernel.value(1, 0.0, 1.0), 2.0 / 3.0);
        /// ```
        #[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
        #[non_exhaustive]
        pub enum Kernel {
            $(#[doc = concat!("See [`", stringify!($kernel), "`].")] $kernel,)*
        }

        impl Kernel {
            /// All kernels.
            pub const ALL: &'static [Self] = &[$(Self::$kernel),*];

            /// Runs a computation with the type of this kernel's shape.
            pub fn visit<V: KernelVisitor>(self, visitor: V) -> V::Output {
                match self {
                    $(Self::$kernel => visitor.visit($kernel),)*
                }
            }

            /// The kernel's name in a case file.
            pub const fn name(self) -> &'static str {
                match self {
                    $(Self::$kernel => $kernel::NAME,)*
                }
            }

            /// Support radius over smoothing length.
            pub const fn support_over_h(self) -> f64 {
                match self {
                    $(Self::$kernel => $kernel::SUPPORT,)*
                }
            }
        }
    };
}

registry!(
    CubicSpline,
    QuinticSpline,
    Lucy,
    Gaussian,
    Mollifier,
    ModifiedMollifier,
    Linear,
    Quadratic,
    WendlandC2,
    WendlandC4,
    WendlandC6,
);

impl Kernel {
    /// The kernel of a name, or `None`.
    pub fn from_name(name: &str) -> Option<Self> {
        Self::ALL.iter().copied().find(|kernel| kernel.name() == name)
    }

    /// Support radius, beyond which the kernel is zero, of a smoothing length (both in m).
    pub const fn support_radius(self, smoothing_length: f64) -> f64 {
        self.support_over_h() * smoothing_length
    }

    /// `W(r)` in m^-dimension, for a distance `r` and a smoothing length `h` in m.
    ///
    /// NaN for a dimension other than 1, 2 or 3, here and in the functions below.
    pub fn value<T: Number>(self, dimension: usize, r: T, h: f64) -> T {
        self.evaluate(dimension, Quantity::Value, r, h)
    }

    /// `W'(r) / r`, finite at `r = 0`; see [`KernelShape::derivative_over_q`].
    pub fn derivative_over_r<T: Number>(self, dimension: usize, r: T, h: f64) -> T {
        self.evaluate(dimension, Quantity::DerivativeOverR, r, h)
    }

    /// [`Self::derivative_over_r`] of a smoothing length that is a number as `r` is.
    #[inline(always)]
    pub fn derivative_over_r_within<T: Number>(self, dimension: usize, r: T, h: T) -> T {
        self.visit(Within { dimension, r, h })
    }

    /// `W'(r)`; at the tip of a cusp the limit from above.
    pub fn derivative<T: Number>(self, dimension: usize, r: T, h: f64) -> T {
        self.evaluate(dimension, Quantity::Derivative, r, h)
    }

    /// `W''(r)`; where it jumps, the limit from above.
    pub fn second_derivative<T: Number>(self, dimension: usize, r: T, h: f64) -> T {
        self.evaluate(dimension, Quantity::SecondDerivative, r, h)
    }

    fn evaluate<T: Number>(self, dimension: usize, quantity: Quantity, r: T, h: f64) -> T {
        let evaluation = Evaluation { quantity, r, h };
        match dimension {
            1 => self.visit(InDimension::<T, 1>(evaluation)),
            2 => self.visit(InDimension::<T, 2>(evaluation)),
            3 => self.visit(InDimension::<T, 3>(evaluation)),
            _ => T::from(f64::NAN),
        }
    }
}

/// The slope of a kernel over the distance, with the operations of [`ScaledKernel`].
struct Within<T> {
    dimension: usize,
    r: T,
    h: T,
}

impl<T: Number> KernelVisitor for Within<T> {
    type Output = T;

    #[inline(always)]
    fn visit<K: KernelShape>(self, _shape: K) -> T {
        let inverse = self.h.recip();
        let power = integer_power(inverse, self.dimension as u32);
        let factor = power * K::normalisation(self.dimension) * inverse * inverse;
        K::derivative_over_q(self.dimension, self.r * inverse) * factor
    }
}

#[derive(Clone, Copy)]
enum Quantity {
    Value,
    DerivativeOverR,
    Derivative,
    SecondDerivative,
}

struct Evaluation<T> {
    quantity: Quantity,
    r: T,
    h: f64,
}

struct InDimension<T, const D: usize>(Evaluation<T>);

impl<T: Number, const D: usize> KernelVisitor for InDimension<T, D> {
    type Output = T;

    fn visit<K: KernelShape>(self, _shape: K) -> T {
        let Evaluation { quantity, r, h } = self.0;
        let kernel = ScaledKernel::<K, D>::new(h);
        match quantity {
            Quantity::Value => kernel.value(r),
            Quantity::DerivativeOverR => kernel.derivative_over_r(r),
            Quantity::Derivative => kernel.derivative(r),
            Quantity::SecondDerivative => kernel.second_derivative(r),
        }
    }
}
