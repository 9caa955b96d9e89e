//! Principal axes of symmetric matrices without a branch on a value.

use nalgebra::Matrix3;

use crate::Number;

/// Rounds over all three planes after which nothing is left off the diagonal; three to four do, as
/// convergence is of third order.
const ROUNDS: usize = 6;

/// Eigenvectors, in columns, of a symmetric matrix by Jacobi's rotations. Where an entry off the
/// diagonal vanishes its rotation is the identity.
pub(crate) fn by_rotations<T: Number>(symmetric: &Matrix3<T>) -> Matrix3<T> {
    let mut matrix = *symmetric;
    let mut frame = Matrix3::identity();
    for _ in 0..ROUNDS {
        for (p, q) in [(0, 1), (0, 2), (1, 2)] {
            let rotation = rotation(&matrix, p, q);
            matrix = rotation.tr_mul(&(matrix * rotation));
            frame *= rotation;
        }
    }
    frame
}

/// The rotation in the plane of two axes after which their entry is zero.
fn rotation<T: Number>(matrix: &Matrix3<T>, p: usize, q: usize) -> Matrix3<T> {
    let (zero, one) = (T::zero(), T::one());
    let off = matrix[(p, q)];
    let vanishes = off.abs().at_most(zero);
    let theta = (matrix[(q, q)] - matrix[(p, p)]) / (T::select(vanishes, one, off) * 2.0);
    // The smaller root t of t^2 + 2 theta t = 1.
    let size = (theta.abs() + (theta * theta + 1.0).sqrt()).recip();
    let tangent = T::select(theta.less(zero), -size, size);
    let tangent = T::select(vanishes, zero, tangent);
    let cosine = (tangent * tangent + 1.0).sqrt().recip();
    let sine = tangent * cosine;
    Matrix3::from_fn(|i, j| match (i, j) {
        _ if i == j => {
            if i == p || i == q {
                cosine
            } else {
                one
            }
        }
        _ if (i, j) == (p, q) => sine,
        _ if (i, j) == (q, p) => -sine,
        _ => zero,
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_frame_is_orthogonal_and_makes_the_matrix_diagonal() {
        for matrix in [
            Matrix3::new(2.0, -1.0, 0.5, -1.0, 3.0, 0.25, 0.5, 0.25, -1.0),
            Matrix3::new(1.0, 1e-9, 0.0, 1e-9, 1.0, 0.0, 0.0, 0.0, 1.0),
            Matrix3::identity() * 3.0,
            Matrix3::zeros(),
            Matrix3::new(0.0, 1.0, 1.0, 1.0, 0.0, 1.0, 1.0, 1.0, 0.0),
        ] {
            let frame = by_rotations::<f64>(&matrix);
            let rounding = 32.0 * f64::EPSILON;
            assert!((frame.tr_mul(&frame) - Matrix3::identity()).amax() < rounding);
            let diagonal = frame.tr_mul(&(matrix * frame));
            for (i, j) in [(0, 1), (0, 2), (1, 2)] {
                assert!(diagonal[(i, j)].abs() <= rounding * matrix.amax());
            }
        }
    }
}
