//! The arithmetic operators of a number type from one function of two operands.

/// Implements what [`Number`](piola_formulas::Number) asks of operators for `$type`, by its methods
/// `add`, `subtract`, `multiply`, `divide` and `negate`, its constants by `From<f64>`.
macro_rules! operators {
    ($type:ty) => {
        operators!($type, Add add AddAssign add_assign plus);
        operators!($type, Sub sub SubAssign sub_assign minus);
        operators!($type, Mul mul MulAssign mul_assign times);
        operators!($type, Div div DivAssign div_assign over);
        impl std::ops::Neg for $type {
            type Output = Self;
            #[inline(always)]
            fn neg(self) -> Self {
                self.negated()
            }
        }
        impl num_traits::Zero for $type {
            #[inline(always)]
            fn zero() -> Self {
                Self::from(0.0)
            }
            #[inline(always)]
            fn is_zero(&self) -> bool {
                self.is_zero_constant()
            }
        }
        impl num_traits::One for $type {
            #[inline(always)]
            fn one() -> Self {
                Self::from(1.0)
            }
        }
    };
    ($type:ty, $trait:ident $method:ident $assign:ident $assign_method:ident $by:ident) => {
        impl std::ops::$trait for $type {
            type Output = Self;
            #[inline(always)]
            fn $method(self, other: Self) -> Self {
                self.$by(other)
            }
        }
        impl std::ops::$trait<f64> for $type {
            type Output = Self;
            #[inline(always)]
            fn $method(self, other: f64) -> Self {
                self.$by(Self::from(other))
            }
        }
        impl std::ops::$assign for $type {
            #[inline(always)]
            fn $assign_method(&mut self, other: Self) {
                *self = self.$by(other);
            }
        }
    };
}
pub(crate) use operators;
