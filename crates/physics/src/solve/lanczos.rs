//! The largest eigenvalue of a symmetric operator that is known by its products.

use nalgebra::{DMatrix, DVector};

use super::krylov::dot;
use crate::parallel::larger;

/// Most steps, after which the value is what it is.
const MOST_STEPS: usize = 300;

/// Steps between looks at the largest eigenvalue.
const LOOK: usize = 20;

/// The eigenvalue is found when it has grown by less than this share since the last look.
const CONVERGED: f64 = 1e-3;

/// An eigenvalue and its eigenvector of length one.
#[derive(Clone, Debug, PartialEq)]
pub struct Mode {
    /// The eigenvalue, from below.
    pub value: f64,
    /// The eigenvector.
    pub vector: Vec<f64>,
}

/// The largest eigenvalue of the symmetric operator of `size` unknowns whose product with its first
/// argument `product` writes to its second, by Lanczos' method from [`irregular`] numbers.
///
/// The value is found to about one part in a thousand, always from below. The power method would not
/// do: the largest eigenvalues of SPH operators belong to a few particles, of small volume or crowded,
/// which have next to no share in a start without pattern. Two products a step.
pub fn largest_mode(size: usize, mut product: impl FnMut(&[f64], &mut [f64])) -> Mode {
    let mut lanczos = Lanczos::new(size);
    let (mut diagonal, mut beside) = (Vec::new(), Vec::new());
    let (mut largest, mut weights) = (0.0_f64, DVector::zeros(0));
    while diagonal.len() < MOST_STEPS.min(size) {
        let (alpha, beta) = lanczos.advance(&mut product);
        diagonal.push(alpha);
        // All modes that the start has a share in are known.
        let is_last = !(beta > 1e-12 * alpha.abs()) || diagonal.len() == MOST_STEPS.min(size);
        if is_last || diagonal.len() % LOOK == 0 {
            let found;
            (found, weights) = largest_of_tridiagonal(&diagonal, &beside);
            let is_found = found <= largest * (1.0 + CONVERGED);
            largest = larger(largest, found);
            if is_last || is_found {
                break;
            }
        }
        beside.push(beta);
    }
    // The mode, summed up by going the same way once more.
    let mut vector = vec![0.0; size];
    let mut lanczos = Lanczos::new(size);
    for weight in weights.iter() {
        for (entry, direction) in vector.iter_mut().zip(&lanczos.direction) {
            *entry += direction * weight;
        }
        lanczos.advance(&mut product);
    }
    // Directions lose their right angles once a mode is found, and then its copies cancel in part.
    let length = dot(&vector, &vector).sqrt();
    if length > 0.0 {
        vector.iter_mut().for_each(|entry| *entry /= length);
    }
    Mode { value: largest, vector }
}

/// A number in (-1, 1) for each index, of no regular pattern, so that no mode is missed for its
/// symmetry; the same in every run.
pub fn irregular(index: usize) -> f64 {
    let turned = (index as f64 + 1.0) * 0.618_033_988_749_894_9;
    2.0 * turned.fract() - 1.0
}

/// Lanczos' recurrence.
struct Lanczos {
    /// The direction of this step, of length one, and that of the last.
    direction: Vec<f64>,
    before: Vec<f64>,
    next: Vec<f64>,
    beta: f64,
}

impl Lanczos {
    fn new(size: usize) -> Self {
        let mut direction: Vec<f64> = (0..size).map(irregular).collect();
        let norm = dot(&direction, &direction).sqrt();
        direction.iter_mut().for_each(|entry| *entry /= norm);
        Self { direction, before: vec![0.0; size], next: vec![0.0; size], beta: 0.0 }
    }

    /// Goes to the next direction; the diagonal entry of this step and the one beside it.
    fn advance(&mut self, product: &mut impl FnMut(&[f64], &mut [f64])) -> (f64, f64) {
        product(&self.direction, &mut self.next);
        let alpha = dot(&self.next, &self.direction);
        for (k, entry) in self.next.iter_mut().enumerate() {
            *entry -= self.direction[k] * alpha + self.before[k] * self.beta;
        }
        self.beta = dot(&self.next, &self.next).sqrt();
        if self.beta > 0.0 {
            self.next.iter_mut().for_each(|entry| *entry /= self.beta);
        }
        std::mem::swap(&mut self.before, &mut self.direction);
        std::mem::swap(&mut self.direction, &mut self.next);
        (alpha, self.beta)
    }
}

/// Largest eigenvalue of a tridiagonal matrix and its eigenvector.
fn largest_of_tridiagonal(diagonal: &[f64], beside: &[f64]) -> (f64, DVector<f64>) {
    let size = diagonal.len();
    let matrix = DMatrix::from_fn(size, size, |i, j| match i.abs_diff(j) {
        0 => diagonal[i],
        1 => beside[i.min(j)],
        _ => 0.0,
    });
    let Some(eigen) = matrix.try_symmetric_eigen(f64::EPSILON, 10_000) else {
        // Never below the true one: the sum of the entries of a row bounds all eigenvalues.
        let row = |i: usize| {
            let next = |k: usize| beside.get(k).map_or(0.0, |entry| entry.abs());
            diagonal[i] + next(i) + if i > 0 { next(i - 1) } else { 0.0 }
        };
        let bound = (0..size).map(row).fold(0.0, f64::max);
        return (bound, DVector::zeros(size));
    };
    let best = eigen.eigenvalues.imax();
    (eigen.eigenvalues[best], eigen.eigenvectors.column(best).into_owned())
}
