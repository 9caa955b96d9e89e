//! Small tensors against nalgebra's own algorithms, and where those do not reach.

use nalgebra::{Matrix2, Matrix3, Rotation3, SMatrix, Unit, Vector3};
use num_dual::Dual64;
use piola_formulas::tensor::{
    cofactor, determinant, inverse, largest_eigenvalue, right_cauchy_green, smallest_eigenvalue,
};
use proptest::prelude::*;

fn matrix<const D: usize>() -> impl Strategy<Value = SMatrix<f64, D, D>> {
    prop::collection::vec(-2.0..2.0, D * D).prop_map(|entries| SMatrix::from_row_slice(&entries))
}

fn rotation() -> impl Strategy<Value = Matrix3<f64>> {
    (prop::array::uniform3(-1.0..1.0_f64), 0.0..6.3).prop_map(|(axis, angle)| {
        let axis = Unit::new_normalize(Vector3::from(axis) + Vector3::new(1e-3, 0.0, 0.0));
        Rotation3::from_axis_angle(&axis, angle).into_inner()
    })
}

/// `a` with the derivative 1 in one entry.
fn seeded<const D: usize>(
    a: &SMatrix<f64, D, D>,
    direction: &SMatrix<f64, D, D>,
) -> SMatrix<Dual64, D, D> {
    a.zip_map(direction, Dual64::new)
}

fn unit<const D: usize>(row: usize, column: usize) -> SMatrix<f64, D, D> {
    let mut unit = SMatrix::zeros();
    unit[(row, column)] = 1.0;
    unit
}

fn symmetric<const D: usize>(a: SMatrix<f64, D, D>) -> SMatrix<f64, D, D> {
    (a + a.transpose()) * 0.5
}

/// Properties of determinant, cofactor and inverse.
fn check_cofactor<const D: usize>(a: &SMatrix<f64, D, D>) -> Result<(), TestCaseError> {
    let (det, cof) = (determinant(a), cofactor(a));
    // Entries are at most 2: sums of 6 products of 3.
    prop_assert!((a * cof.transpose() - SMatrix::identity() * det).norm() < 1e-13);
    for row in 0..D {
        for column in 0..D {
            let derivative = determinant(&seeded(a, &unit(row, column))).eps;
            prop_assert!((derivative - cof[(row, column)]).abs() < 1e-14);
        }
    }
    if det.abs() > 1e-3 {
        let inverse = inverse(a).expect("not singular");
        prop_assert!((a * inverse - SMatrix::identity()).norm() < 1e-10);
        prop_assert!((cof / det - inverse.transpose()).norm() < 1e-12 * inverse.norm());
    }
    Ok(())
}

/// The derivative of the inverse is `-A^-1 dA A^-1`.
fn check_derivative_of_inverse<const D: usize>(
    a: &SMatrix<f64, D, D>,
    direction: &SMatrix<f64, D, D>,
) -> Result<(), TestCaseError> {
    prop_assume!(determinant(a).abs() > 1e-2);
    let value = inverse(a).expect("not singular");
    let derivative = inverse(&seeded(a, direction)).expect("not singular").map(|entry| entry.eps);
    let expected = -(value * direction * value);
    prop_assert!((derivative - expected).norm() < 1e-11 * (1.0 + expected.norm()));
    Ok(())
}

proptest! {
    #[test]
    fn cofactors_in_1d(a in matrix::<1>()) {
        check_cofactor(&a)?;
        prop_assert_eq!(determinant(&a), a.determinant());
    }

    #[test]
    fn cofactors_in_2d(a in matrix::<2>()) {
        check_cofactor(&a)?;
        prop_assert!((determinant(&a) - a.determinant()).abs() < 1e-14);
    }

    #[test]
    fn cofactors_in_3d(a in matrix::<3>()) {
        check_cofactor(&a)?;
        prop_assert!((determinant(&a) - a.determinant()).abs() < 1e-13);
        let relative = (inverse(&a).unwrap() - a.try_inverse().unwrap()).norm();
        prop_assert!(relative < 1e-12 * a.try_inverse().unwrap().norm().powi(2));
    }

    #[test]
    fn inverses_differentiate(a in matrix::<3>(), da in matrix::<3>(), b in matrix::<2>(), db in matrix::<2>()) {
        check_derivative_of_inverse(&a, &da)?;
        check_derivative_of_inverse(&b, &db)?;
    }

    /// `cof (u v^T)` is zero in 3D, and that of a rank of two is not, though neither has an inverse.
    #[test]
    fn cofactors_of_singular_matrices(
        [u, v, w, z] in prop::array::uniform4(prop::array::uniform3(-2.0..2.0_f64).prop_map(Vector3::from)),
    ) {
        prop_assert!(cofactor(&(u * v.transpose())).norm() < 1e-13);
        let rank_two = u * v.transpose() + w * z.transpose();
        let expected = u.cross(&w) * v.cross(&z).transpose();
        prop_assert!((cofactor(&rank_two) - expected).norm() < 1e-12);
    }

    #[test]
    fn right_cauchy_green_measures_lengths(f in matrix::<3>(), x in prop::array::uniform3(-1.0..1.0_f64)) {
        let (c, x) = (right_cauchy_green(&f), Vector3::from(x));
        prop_assert!((x.dot(&(c * x)) - (f * x).norm_squared()).abs() < 1e-13);
        prop_assert_eq!(c, c.transpose());
        prop_assert!(smallest_eigenvalue(&c) > -1e-14);
    }

    #[test]
    fn eigenvalues_in_2d(a in matrix::<2>()) {
        let a = symmetric(a);
        let reference = a.symmetric_eigenvalues();
        prop_assert!((smallest_eigenvalue(&a) - reference.min()).abs() < 1e-14);
        prop_assert!((largest_eigenvalue(&a) - reference.max()).abs() < 1e-14);
    }

    #[test]
    fn eigenvalues_in_3d(a in matrix::<3>()) {
        let a = symmetric(a);
        let reference = a.symmetric_eigenvalues();
        prop_assert!((smallest_eigenvalue(&a) - reference.min()).abs() < 1e-14);
        prop_assert!((largest_eigenvalue(&a) - reference.max()).abs() < 1e-14);
    }

    /// Two eigenvalues apart by anything from 1 to nothing, and the third anywhere.
    #[test]
    fn eigenvalues_that_nearly_meet(
        q in rotation(),
        first in 0.1..2.0,
        third in 0.1..2.0,
        exponent in -20.0..0.0,
    ) {
        let second = first + 10.0_f64.powf(exponent);
        let eigenvalues = Vector3::new(first, second, third);
        let a = symmetric(q * Matrix3::from_diagonal(&eigenvalues) * q.transpose());
        // The rotation and the products above have roundings of their own.
        prop_assert!((smallest_eigenvalue(&a) - eigenvalues.min()).abs() < 1e-14);
        prop_assert!((largest_eigenvalue(&a) - eigenvalues.max()).abs() < 1e-14);
    }

    /// A simple eigenvalue changes by `u . dA u`.
    #[test]
    fn simple_eigenvalues_differentiate(a in matrix::<3>(), direction in matrix::<3>()) {
        let (a, direction) = (symmetric(a), symmetric(direction));
        let reference = a.symmetric_eigen();
        let (gap_below, gap_above) = {
            let mut sorted: Vec<f64> = reference.eigenvalues.iter().copied().collect();
            sorted.sort_by(f64::total_cmp);
            (sorted[1] - sorted[0], sorted[2] - sorted[1])
        };
        let change = |k: usize| {
            let u = reference.eigenvectors.column(k);
            u.dot(&(direction * u))
        };
        let a = seeded(&a, &direction);
        if gap_below > 0.01 {
            let derivative = smallest_eigenvalue(&a).eps;
            prop_assert!((derivative - change(reference.eigenvalues.imin())).abs() < 1e-11);
        }
        if gap_above > 0.01 {
            let derivative = largest_eigenvalue(&a).eps;
            prop_assert!((derivative - change(reference.eigenvalues.imax())).abs() < 1e-11);
        }
    }

    /// Where eigenvalues coincide, the derivative is that of their mean.
    #[test]
    fn coincident_eigenvalues_have_the_derivative_of_their_mean(
        direction in matrix::<3>(),
        pair in 0.5..2.0_f64,
        apart in 0.1..2.0,
    ) {
        let direction = symmetric(direction);
        let triple = seeded(&(Matrix3::identity() * pair), &direction);
        for eigenvalue in [smallest_eigenvalue(&triple), largest_eigenvalue(&triple)] {
            prop_assert!((eigenvalue.re - pair).abs() < 1e-15 * pair);
            prop_assert!((eigenvalue.eps - direction.trace() / 3.0).abs() < 1e-14);
        }
        let in_pair = 0.5 * (direction[(0, 0)] + direction[(1, 1)]);
        let diagonal = |third| Matrix3::from_diagonal(&Vector3::new(pair, pair, third));
        let smallest = smallest_eigenvalue(&seeded(&diagonal(pair + apart), &direction));
        prop_assert!((smallest.eps - in_pair).abs() < 1e-13, "{}", smallest);
        let largest = largest_eigenvalue(&seeded(&diagonal(pair - apart), &direction));
        prop_assert!((largest.eps - in_pair).abs() < 1e-13, "{}", largest);
        let planar = direction.fixed_view::<2, 2>(0, 0).into_owned();
        let circle = seeded(&(Matrix2::identity() * pair), &planar);
        prop_assert_eq!(smallest_eigenvalue(&circle).eps, largest_eigenvalue(&circle).eps);
        prop_assert!((smallest_eigenvalue(&circle).eps - in_pair).abs() < 1e-15);
    }

    /// Scaling by a power of two is exact, over the whole range of numbers.
    #[test]
    fn eigenvalues_scale(a in matrix::<3>(), exponent in -900..900_i32) {
        let (a, scale) = (symmetric(a), 2.0_f64.powi(exponent));
        let scaled = a * scale;
        let close = |got: f64, unit: f64| (got / scale - unit).abs() < 4e-15;
        prop_assert!(close(smallest_eigenvalue(&scaled), smallest_eigenvalue(&a)));
        prop_assert!(close(largest_eigenvalue(&scaled), largest_eigenvalue(&a)));
        let planar = scaled.fixed_view::<2, 2>(0, 0).into_owned();
        let unit_planar = a.fixed_view::<2, 2>(0, 0).into_owned();
        prop_assert!(close(smallest_eigenvalue(&planar), smallest_eigenvalue(&unit_planar)));
    }

    #[test]
    fn finite_entries_never_give_nan(
        entries in prop::array::uniform9(prop_oneof![
            any::<f64>().prop_filter("finite", |x| x.is_finite()),
            prop::sample::select(&[0.0, -0.0, 1.0, 5e-324, f64::MAX, f64::MIN, 1e-170, 1e160][..]),
        ]),
    ) {
        let a = Matrix3::from_row_slice(&entries);
        prop_assert!(!smallest_eigenvalue(&a).is_nan() && !largest_eigenvalue(&a).is_nan());
        let planar = a.fixed_view::<2, 2>(0, 0).into_owned();
        prop_assert!(!smallest_eigenvalue(&planar).is_nan());
        prop_assert!(!largest_eigenvalue(&planar).is_nan());
        for found in inverse(&a).iter().flat_map(|inverse| inverse.iter()) {
            prop_assert!(found.is_finite());
        }
    }

    /// Entries too small or large for their determinant still have an inverse.
    #[test]
    fn inverses_scale(a in matrix::<3>(), exponent in -900..900_i32) {
        prop_assume!(determinant(&a).abs() > 1e-3);
        let scale = 2.0_f64.powi(exponent);
        let unscaled = inverse(&(a * scale)).unwrap() * scale;
        // A rounding of an entry changes the inverse by its square.
        let inverse = inverse(&a).unwrap();
        prop_assert!((unscaled - inverse).norm() < 1e-13 * inverse.norm_squared());
    }
}

#[test]
fn one_dimension_is_the_number_itself() {
    let a = SMatrix::<f64, 1, 1>::new(-3.0);
    assert_eq!(determinant(&a), -3.0);
    assert_eq!(cofactor(&a)[0], 1.0);
    assert_eq!(inverse(&a).unwrap()[0], -1.0 / 3.0);
    assert_eq!((smallest_eigenvalue(&a), largest_eigenvalue(&a)), (-3.0, -3.0));
    assert_eq!(right_cauchy_green(&a)[0], 9.0);
}

#[test]
fn singular_and_infinite_matrices_have_no_inverse() {
    assert_eq!(inverse(&Matrix3::<f64>::zeros()), None);
    assert_eq!(inverse(&SMatrix::<f64, 1, 1>::zeros()), None);
    assert_eq!(inverse(&Matrix2::new(1.0, 2.0, 2.0, 4.0)), None);
    assert_eq!(inverse(&Matrix2::new(f64::INFINITY, 0.0, 0.0, 1.0)), None);
    assert_eq!(inverse(&Matrix2::new(f64::NAN, 0.0, 0.0, 1.0)), None);
}

#[test]
fn exact_eigenvalues_of_special_matrices() {
    let ones = Matrix3::repeat(1.0_f64);
    assert!(smallest_eigenvalue(&ones).abs() < 1e-15);
    assert!((largest_eigenvalue(&ones) - 3.0).abs() < 1e-15);
    assert_eq!(smallest_eigenvalue(&Matrix3::<f64>::zeros()), 0.0);
    assert_eq!(smallest_eigenvalue(&Matrix3::<f64>::identity()), 1.0);
    assert_eq!(largest_eigenvalue(&Matrix2::<f64>::identity()), 1.0);
    // Only the upper triangle is read.
    let upper = Matrix2::new(2.0, 1.0, f64::NAN, 2.0);
    assert_eq!((smallest_eigenvalue(&upper), largest_eigenvalue(&upper)), (1.0, 3.0));
}
