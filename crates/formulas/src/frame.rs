//! Principal axes of symmetric matrices without a branch on a value.

use nalgebra::Matrix3;

use crate::Number;

/// Rounds over all three planes after which nothing is left off the diagonal; three to four do, as
/// convergence is of third order.
const ROUNDS: u32 = 6;

/// What entries off the diagonal amount to, over those on it, where nothing is left of them: below all
/// digits.
const NOTHING: f64 = 1e-17;

/// Eigenvectors, in columns, of a symmetric matrix by Jacobi's rotations. Where an entry off the
/// diagonal vanishes its rotation is the identity.
pub(crate) fn by_rotations<T: Number>(symmetric: &Matrix3<T>) -> Matrix3<T> {
    // The diagonal, the entries opposite of each axis, and the frame, column by column.
    let mut start = [T::zero(); 15];
    for k in 0..3 {
        start[k] = symmetric[(k, k)];
        start[3 + k] = symmetric[((k + 1) % 3, (k + 2) % 3)];
        start[6 + 4 * k] = T::one();
    }
    let size = |x: &[T]| x[0].abs() + x[1].abs() + x[2].abs();
    let until = |state: &[T; 15]| size(&state[3..]).at_most(size(state) * NOTHING);
    let state = T::repeat(ROUNDS, start, until, |mut state| {
        (0..3).for_each(|axis| rotate(&mut state, axis));
        state
    });
    Matrix3::from_column_slice(&state[6..])
}

/// Rotates around an axis, after which the entry opposite of it is zero.
#[inline(always)]
fn rotate<T: Number>(state: &mut [T; 15], axis: usize) {
    let (p, q) = ((axis + 1) % 3, (axis + 2) % 3);
    let zero = T::zero();
    let (difference, twice) = (state[q] - state[p], state[3 + axis] * 2.0);
    let root = (difference * difference + twice * twice).sqrt();
    // The smaller root t of `twice t^2 + 2 difference t = twice`.
    let sum = difference + T::select(difference.less(zero), -root, root);
    let vanishes = sum.abs().at_most(zero);
    let tangent = T::select(vanishes, zero, twice / T::select(vanishes, T::one(), sum));
    let cosine = (tangent * tangent + 1.0).sqrt().recip();
    let sine = tangent * cosine;
    let moved = tangent * state[3 + axis];
    state[p] -= moved;
    state[q] += moved;
    state[3 + axis] = zero;
    let mut turn = |a: usize, b: usize| {
        let (first, second) = (state[a], state[b]);
        state[a] = cosine * first - sine * second;
        state[b] = sine * first + cosine * second;
    };
    // The entry of p and the axis is opposite of q.
    turn(3 + q, 3 + p);
    (0..3).for_each(|row| turn(6 + 3 * p + row, 6 + 3 * q + row));
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
