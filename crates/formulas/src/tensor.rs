//! Determinant, cofactor, inverse and extreme eigenvalues of 1 x 1, 2 x 2 and 3 x 3 matrices.
//!
//! Closed forms only: no iteration, no allocation, the same body for `f64` and dual numbers.

use std::f64::consts::FRAC_PI_3;

use nalgebra::{ArrayStorage, SMatrix};

use crate::{Lanes as _, Lanes4, Number, Scalar};

/// A matrix of these entries. In vector registers: what is not inlined is not compiled for the widest.
#[inline(always)]
pub(crate) fn of_entries<T: Number, const R: usize, const C: usize>(
    entry: impl Fn(usize, usize) -> T,
) -> SMatrix<T, R, C> {
    let mut all = [[T::zero(); R]; C];
    for (j, column) in all.iter_mut().enumerate() {
        for (i, own) in column.iter_mut().enumerate() {
            *own = entry(i, j);
        }
    }
    SMatrix::from_array_storage(ArrayStorage(all))
}

/// Up to four vectors or tensors, a lane each; the last of them fills up what is left.
#[inline(always)]
pub fn lanes<const R: usize, const C: usize>(all: &[SMatrix<f64, R, C>]) -> SMatrix<Lanes4, R, C> {
    let at = |k: usize| &all[k.min(all.len() - 1)];
    let (a, b, c, d) = (at(0), at(1), at(2), at(3));
    of_entries(|i, j| Lanes4::load([a[(i, j)], b[(i, j)], c[(i, j)], d[(i, j)]]))
}

/// `a b`, summed up in the order of nalgebra.
#[inline(always)]
pub(crate) fn product<T: Number, const D: usize>(
    a: &SMatrix<T, D, D>,
    b: &SMatrix<T, D, D>,
) -> SMatrix<T, D, D> {
    of_entries(|i, j| (1..D).fold(a[(i, 0)] * b[(0, j)], |sum, k| sum + a[(i, k)] * b[(k, j)]))
}

/// `a^T b`, likewise.
#[inline(always)]
pub(crate) fn transposed_product<T: Number, const D: usize>(
    a: &SMatrix<T, D, D>,
    b: &SMatrix<T, D, D>,
) -> SMatrix<T, D, D> {
    of_entries(|i, j| (1..D).fold(a[(0, i)] * b[(0, j)], |sum, k| sum + a[(k, i)] * b[(k, j)]))
}

/// Determinant of `a`.
///
/// ```
/// use nalgebra::Matrix2;
/// assert_eq!(piola_formulas::tensor::determinant(&Matrix2::new(2.0, 1.0, 4.0, 3.0)), 2.0);
/// ```
#[inline(always)]
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
#[inline(always)]
pub fn cofactor<T: Number, const D: usize>(a: &SMatrix<T, D, D>) -> SMatrix<T, D, D> {
    const { assert!(D >= 1 && D <= 3, "piola works in 1, 2 or 3 dimensions") };
    of_entries(|i, j| match D {
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
#[inline(always)]
pub fn right_cauchy_green<T: Number, const D: usize>(
    deformation_gradient: &SMatrix<T, D, D>,
) -> SMatrix<T, D, D> {
    transposed_product(deformation_gradient, deformation_gradient)
}

/// Smallest eigenvalue of the symmetric matrix `a`, Upwind (3.56).
///
/// Only the entries on and above the diagonal are read. The absolute error is a few roundings of
/// the largest entry, for equal eigenvalues too, and the result is never NaN for finite entries.
/// Dual numbers carry the exact derivative of a simple eigenvalue; where eigenvalues coincide,
/// and so have none, they carry the derivative of the mean of those that coincide.
#[inline(always)]
pub fn smallest_eigenvalue<T: Number, const D: usize>(a: &SMatrix<T, D, D>) -> T {
    extreme_eigenvalue(a, Extreme::Smallest)
}

/// Largest eigenvalue of the symmetric matrix `a`; the remarks on [`smallest_eigenvalue`] hold.
#[inline(always)]
pub fn largest_eigenvalue<T: Number, const D: usize>(a: &SMatrix<T, D, D>) -> T {
    extreme_eigenvalue(a, Extreme::Largest)
}

/// Both at once: the smallest eigenvalue and the largest.
#[inline(always)]
pub fn extreme_eigenvalues<T: Number, const D: usize>(a: &SMatrix<T, D, D>) -> [T; 2] {
    const { assert!(D >= 1 && D <= 3, "piola works in 1, 2 or 3 dimensions") };
    if D == 1 {
        return [a[(0, 0)]; 2];
    }
    let parts = Parts::of(a);
    let polar = parts.polar();
    let least = parts.eigenvalue(polar, Extreme::Smallest);
    let most = parts.eigenvalue(polar, Extreme::Largest);
    [
        parts.or_with_care(a, || least, Extreme::Smallest),
        parts.or_with_care(a, || most, Extreme::Largest),
    ]
}

/// Determinant of the 2 x 2 block of rows `i`, `k` and columns `j`, `l`.
#[inline(always)]
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

#[inline(always)]
fn extreme_eigenvalue<T: Number, const D: usize>(a: &SMatrix<T, D, D>, extreme: Extreme) -> T {
    const { assert!(D >= 1 && D <= 3, "piola works in 1, 2 or 3 dimensions") };
    if D == 1 {
        return a[(0, 0)];
    }
    let parts = Parts::of(a);
    parts.or_with_care(a, || parts.eigenvalue(parts.polar(), extreme), extreme)
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
    T::choose(coincide, || parts.mean, || parts.eigenvalue(parts.polar(), extreme)) * back
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
    #[inline(always)]
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
    #[inline(always)]
    fn is_safe(&self) -> T::Mask {
        T::from(1e-240).at_most(self.square) & self.square.at_most(T::from(1e240))
    }

    /// The eigenvalue of `a`, of which these are the parts: `ordinary` where the square is safe, and the mean where it is zero
    /// beside a mean of ordinary size, as at rest.
    #[inline(always)]
    fn or_with_care(
        &self,
        a: &SMatrix<T, D, D>,
        ordinary: impl FnOnce() -> T,
        extreme: Extreme,
    ) -> T {
        let (is_safe, size) = (self.is_safe(), self.mean.abs());
        let is_round = self.square.at_most(T::zero()) & size.above(1e-100) & size.below(1e100);
        T::choose(is_safe, ordinary, || {
            T::choose(is_safe | is_round, || self.mean, || of_scaled(a, extreme))
        })
    }

    /// An eigenvalue where the square is not zero, of what [`Self::polar`] gives.
    #[inline(always)]
    fn eigenvalue(&self, [p, phi]: [T; 2], extreme: Extreme) -> T {
        match (D, extreme) {
            (2, Extreme::Smallest) => self.mean - p,
            (2, Extreme::Largest) => self.mean + p,
            (_, Extreme::Smallest) => self.mean + p * -(-phi + FRAC_PI_3).cos() * 2.0,
            (_, Extreme::Largest) => self.mean + p * phi.cos() * 2.0,
        }
    }

    /// The root of the square, and in 3D the angle of the trigonometric form:
    /// `mean + 2 p cos phi` is the largest eigenvalue and
    /// `mean - 2 p cos(pi/3 - phi)` the smallest, with `0 <= phi <= pi/3`.
    ///
    /// With `B = (a - mean I) / p` scaled to `B : B = 6`, and `Q = B^2 - 2 I` its deviatoric square,
    /// `cos 3 phi = B : Q / 6` and `sin 3 phi = |Q - cos(3 phi) B| / sqrt 6`. Taking the angle from
    /// both keeps full accuracy where eigenvalues meet; the arc cosine alone loses half the digits.
    #[inline(always)]
    fn polar(&self) -> [T; 2] {
        let p = self.square.sqrt();
        if D == 2 {
            return [p, T::zero()];
        }
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
        [p, sine.atan2(cosine) * (1.0 / 3.0)]
    }
}

/// Double contraction of symmetric tensors stored as (xx, yy, zz, yz, xz, xy).
#[inline(always)]
fn contract<T: Number>(a: &[T; 6], b: &[T; 6]) -> T {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2] + (a[3] * b[3] + a[4] * b[4] + a[5] * b[5]) * 2.0
}
