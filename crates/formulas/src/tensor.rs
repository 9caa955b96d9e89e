//! Determinant, cofactor, inverse and extreme eigenvalues of 1 x 1, 2 x 2 and 3 x 3 matrices.
//!
//! Closed forms only: no iteration, no allocation, the same body for `f64` and dual numbers.

use nalgebra::SMatrix;

use crate::{Number, Scalar};

/// Determinant of `a`.
///
/// ```
/// use nalgebra::Matrix2;
/// assert_eq!(piola_formulas::tensor::determinant(&Matrix2::new(2.0, 1.0, 4.0, 3.0)), 2.0);
/// ```
#[inline]
pub fn determinant<T: Number, const D: usize>(a: &SMatrix<T, D, D>) -> T {
    const { assert!(D >= 1 && D <= 3, "piola works in 1, 2 or 3 dimensions") };
    match D {
        1 => a[(0, 0)],
        2 => a[(0, 0)] * a[(1, 1)] - a[(0, 1)] * a[(1, 0)],
        _ => {
            a[(0, 0)] * minor(a, 1, 2, 1, 2)
                + a[(0, 1)] * minor(a, 1, 2, 2, 0)
                + a[(0, 2)] * minor(a, 1, 2, 0, 1)
        }
    }
}

/// Cofactor `cof a`, which is `det(a) a^-T` where `a` has an inverse.
///
/// It is a polynomial of the entries and so defined for singular matrices too. Of a deformation
/// gradient it is `H` of Upwind (3.2), which maps reference to current areas.
#[inline]
pub fn cofactor<T: Number, const D: usize>(a: &SMatrix<T, D, D>) -> SMatrix<T, D, D> {
    const { assert!(D >= 1 && D <= 3, "piola works in 1, 2 or 3 dimensions") };
    SMatrix::from_fn(|i, j| match D {
        1 => T::one(),
        2 if i == j => a[(1 - i, 1 - j)],
        2 => -a[(1 - i, 1 - j)],
        _ => minor(a, (i + 1) % 3, (i + 2) % 3, (j + 1) % 3, (j + 2) % 3),
    })
}

/// Inverse of `a`, or `None` where `a` is singular or its entries or the inverse's not finite.
///
/// Only an exactly vanishing determinant counts as singular: how ill-conditioned a matrix may be
/// is for the caller to judge.
#[inline]
pub fn inverse<T: Scalar, const D: usize>(a: &SMatrix<T, D, D>) -> Option<SMatrix<T, D, D>> {
    let det = determinant(a);
    let inverse =
        if det.re().is_normal() { cofactor(a).transpose() / det } else { inverse_of_scaled(a)? };
    inverse.iter().all(|entry| entry.re().is_finite()).then_some(inverse)
}

/// Inverse of a matrix whose entries are too small or too large for their determinant.
#[cold]
fn inverse_of_scaled<T: Scalar, const D: usize>(a: &SMatrix<T, D, D>) -> Option<SMatrix<T, D, D>> {
    let scale = a.iter().fold(0.0_f64, |largest, entry| largest.max(entry.re().abs()));
    if !(scale > 0.0 && scale.is_finite()) {
        return None;
    }
    let scaled = a.map(|entry| entry / scale);
    let det = determinant(&scaled);
    (det.re() != 0.0).then(|| (cofactor(&scaled).transpose() / det).map(|entry| entry / scale))
}

/// Right Cauchy-Green tensor `C = F^T F`, Upwind (3.55).
#[inline]
pub fn right_cauchy_green<T: Number, const D: usize>(
    deformation_gradient: &SMatrix<T, D, D>,
) -> SMatrix<T, D, D> {
    deformation_gradient.tr_mul(deformation_gradient)
}

/// Smallest eigenvalue of the symmetric matrix `a`, Upwind (3.56).
///
/// Only the entries on and above the diagonal are read. The absolute error is a few roundings of
/// the largest entry, for equal eigenvalues too, and the result is never NaN for finite entries.
/// Dual numbers carry the exact derivative of a simple eigenvalue; where eigenvalues coincide,
/// and so have none, they carry the derivative of the mean of those that coincide.
#[inline]
pub fn smallest_eigenvalue<T: Number, const D: usize>(a: &SMatrix<T, D, D>) -> T {
    extreme_eigenvalue(a, Extreme::Smallest)
}

/// Largest eigenvalue of the symmetric matrix `a`; the remarks on [`smallest_eigenvalue`] hold.
#[inline]
pub fn largest_eigenvalue<T: Number, const D: usize>(a: &SMatrix<T, D, D>) -> T {
    extreme_eigenvalue(a, Extreme::Largest)
}

/// Determinant of the 2 x 2 block of rows `i`, `k` and columns `j`, `l`.
#[inline]
fn minor<T: Number, const D: usize>(
    a: &SMatrix<T, D, D>,
    i: usize,
    k: usize,
    j: usize,
    l: usize,
) -> T {
    a[(i, j)] * a[(k, l)] - a[(i, l)] * a[(k, j)]
}

#[derive(Clone, Copy)]
enum Extreme {
    Smallest,
    Largest,
}

/// Below this, the sine of three times the angle is rounding: two eigenvalues coincide.
const COINCIDENT: f64 = 16.0 * f64::EPSILON;

#[inline]
fn extreme_eigenvalue<T: Number, const D: usize>(a: &SMatrix<T, D, D>, extreme: Extreme) -> T {
    const { assert!(D >= 1 && D <= 3, "piola works in 1, 2 or 3 dimensions") };
    if D == 1 {
        return a[(0, 0)];
    }
    let parts = Parts::of(a);
    T::choose(parts.is_safe(), || parts.eigenvalue(extreme), || of_scaled(a, extreme))
}

/// The eigenvalue of a matrix whose deviator is too large or small to be squared, or zero. Scaling by
/// a power of two is exact.
#[cold]
fn of_scaled<T: Number, const D: usize>(a: &SMatrix<T, D, D>, extreme: Extreme) -> T {
    let two_to_700 = f64::from_bits((1023 + 700) << 52);
    let mut largest = T::zero();
    for column in 0..D {
        for row in 0..=column {
            let size = a[(row, column)].abs();
            largest = T::select(largest.less(size), size, largest);
        }
    }
    let small = largest.below(1e-120) & largest.above(0.0);
    let large = largest.above(1e120) & largest.at_most(T::from(f64::MAX));
    let of = |small_factor: f64, large_factor: f64| {
        let other = T::select(large, T::from(large_factor), T::one());
        T::select(small, T::from(small_factor), other)
    };
    let (to, back) = (of(two_to_700, 1.0 / two_to_700), of(1.0 / two_to_700, two_to_700));
    let parts = Parts::of(&a.map(|entry| entry * to));
    let coincide = parts.square.abs().at_most(T::zero());
    T::choose(coincide, || parts.mean, || parts.eigenvalue(extreme)) * back
}

/// A symmetric matrix by its mean and its deviator.
struct Parts<T, const D: usize> {
    /// Mean of the eigenvalues.
    mean: T,
    /// (xx, yy, zz, yz, xz, xy) in 3D, (xx, xy) in 2D.
    deviator: [T; 6],
    /// The square of half the difference of eigenvalues in 2D, of p in 3D.
    square: T,
}

impl<T: Number, const D: usize> Parts<T, D> {
    #[inline]
    fn of(a: &SMatrix<T, D, D>) -> Self {
        let zero = T::zero();
        if D == 2 {
            let mean = (a[(0, 0)] + a[(1, 1)]) * 0.5;
            let half_difference = (a[(0, 0)] - a[(1, 1)]) * 0.5;
            let square = half_difference * half_difference + a[(0, 1)] * a[(0, 1)];
            return Self { mean, deviator: [zero; 6], square };
        }
        let mean = (a[(0, 0)] + a[(1, 1)] + a[(2, 2)]) * (1.0 / 3.0);
        let deviator =
            [a[(0, 0)] - mean, a[(1, 1)] - mean, a[(2, 2)] - mean, a[(1, 2)], a[(0, 2)], a[(0, 1)]];
        Self { mean, deviator, square: contract(&deviator, &deviator) * (1.0 / 6.0) }
    }

    /// Whether the square is the sum of squares that have not overflowed or lost digits.
    #[inline]
    fn is_safe(&self) -> T::Mask {
        T::from(1e-240).at_most(self.square) & self.square.at_most(T::from(1e240))
    }

    /// The eigenvalue where the square is not zero.
    #[inline]
    fn eigenvalue(&self, extreme: Extreme) -> T {
        match (D, extreme) {
            (2, Extreme::Smallest) => self.mean - self.square.sqrt(),
            (2, Extreme::Largest) => self.mean + self.square.sqrt(),
            _ => self.by_angle(extreme),
        }
    }

    /// The trigonometric form: `mean + 2 p cos phi` is the largest eigenvalue and
    /// `mean - 2 p cos(pi/3 - phi)` the smallest, with `0 <= phi <= pi/3`.
    ///
    /// With `B = (a - mean I) / p` scaled to `B : B = 6`, and `Q = B^2 - 2 I` its deviatoric square,
    /// `cos 3 phi = B : Q / 6` and `sin 3 phi = |Q - cos(3 phi) B| / sqrt 6`. Taking the angle from
    /// both keeps full accuracy where eigenvalues meet; the arc cosine alone loses half the digits.
    #[inline]
    fn by_angle(&self, extreme: Extreme) -> T {
        let p = self.square.sqrt();
        let p_inverse = p.recip();
        let b = self.deviator.map(|entry| entry * p_inverse);
        let [xx, yy, zz, yz, xz, xy] = b;
        let q = [
            xx * xx + xy * xy + xz * xz - 2.0,
            xy * xy + yy * yy + yz * yz - 2.0,
            xz * xz + yz * yz + zz * zz - 2.0,
            xy * xz + yy * yz + yz * zz,
            xx * xz + xy * yz + xz * zz,
            xx * xy + xy * yy + xz * yz,
        ];
        let cosine = contract(&b, &q) * (1.0 / 6.0);
        let normal: [T; 6] = std::array::from_fn(|k| q[k] - cosine * b[k]);
        let sine_squared = contract(&normal, &normal) * (1.0 / 6.0);
        let distinct = sine_squared.above(COINCIDENT * COINCIDENT);
        let sine = T::choose(distinct, || sine_squared.sqrt(), T::zero);
        let phi = sine.atan2(cosine) * (1.0 / 3.0);
        let cosine_of_extreme = match extreme {
            Extreme::Smallest => -(-phi + std::f64::consts::FRAC_PI_3).cos(),
            Extreme::Largest => phi.cos(),
        };
        self.mean + p * cosine_of_extreme * 2.0
    }
}

/// Double contraction of symmetric tensors stored as (xx, yy, zz, yz, xz, xy).
#[inline]
fn contract<T: Number>(a: &[T; 6], b: &[T; 6]) -> T {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2] + (a[3] * b[3] + a[4] * b[4] + a[5] * b[5]) * 2.0
}
