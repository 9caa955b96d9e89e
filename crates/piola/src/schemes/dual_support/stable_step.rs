//! The largest step of central differences.

use nalgebra::{DMatrix, DVector};

use super::Discrete;
use crate::{Vector, parallel};

/// Most steps of Lanczos' method, after which the bound is what it is.
const MOST_STEPS: usize = 300;

/// Steps between looks at the largest eigenvalue.
const LOOK: usize = 20;

/// The eigenvalue is found when it has grown by less than this share since the last look.
const CONVERGED: f64 = 1e-3;

/// By how much the frequency that is found may be too small, as all of Lanczos' values are.
const SAFETY: f64 = 1.01;

/// Largest step of central differences at rest, `2/omega`, theory (50), and the particle that moves
/// most in the mode it belongs to.
///
/// The largest eigenvalue of `M^-1/2 K M^-1/2` by Lanczos' method with a fixed start. The power method
/// would miss it: the fastest modes are those of a few particles, of small volume or crowded, which
/// have next to no share in a start without pattern.
pub(super) fn stable_step<const D: usize>(discrete: &Discrete<D>, mass: &[f64]) -> (f64, usize) {
    let count = mass.len();
    let start: Vec<Vector<D>> =
        (0..count).map(|a| Vector::from_fn(|i, _| alternating(a * D + i))).collect();
    let mut lanczos = Lanczos::new(discrete, mass, start.clone());
    let (mut diagonal, mut beside) = (Vec::new(), Vec::new());
    let (mut largest, mut weights) = (0.0, DVector::zeros(0));
    while diagonal.len() < MOST_STEPS.min(count * D) {
        let (alpha, beta) = lanczos.advance();
        diagonal.push(alpha);
        // All modes that the start has a share in are known.
        let is_last = !(beta > 1e-12 * alpha.abs()) || diagonal.len() == MOST_STEPS.min(count * D);
        if is_last || diagonal.len() % LOOK == 0 {
            let found;
            (found, weights) = largest_mode(&diagonal, &beside);
            let is_found = found <= largest * (1.0 + CONVERGED);
            largest = found.max(largest);
            if is_last || is_found {
                break;
            }
        }
        beside.push(beta);
    }
    // The mode, summed up by going the same way once more.
    let mut mode = vec![Vector::<D>::zeros(); count];
    let mut lanczos = Lanczos::new(discrete, mass, start);
    for weight in weights.iter() {
        for (mode, direction) in mode.iter_mut().zip(&lanczos.direction) {
            *mode += direction * *weight;
        }
        lanczos.advance();
    }
    let speed = |a: usize| mode[a].norm_squared() / mass[a];
    let fastest = |best: usize, a: usize| if speed(a) > speed(best) { a } else { best };
    (2.0 / (SAFETY * largest.max(0.0).sqrt()), (0..count).fold(0, fastest))
}

/// Lanczos' recurrence.
struct Lanczos<'a, const D: usize> {
    discrete: &'a Discrete<D>,
    root: Vec<f64>,
    rest: Vec<Vector<D>>,
    /// The direction of this step, of length one, and that of the last.
    direction: Vec<Vector<D>>,
    before: Vec<Vector<D>>,
    beta: f64,
}

impl<'a, const D: usize> Lanczos<'a, D> {
    fn new(discrete: &'a Discrete<D>, mass: &[f64], mut start: Vec<Vector<D>>) -> Self {
        let zero = vec![Vector::zeros(); mass.len()];
        let norm = dot(&start, &start).sqrt();
        start.iter_mut().for_each(|direction| *direction /= norm);
        let root = mass.iter().map(|mass| mass.sqrt()).collect();
        Self { discrete, root, rest: zero.clone(), direction: start, before: zero, beta: 0.0 }
    }

    /// Goes to the next direction; the diagonal entry of this step and the one beside it.
    fn advance(&mut self) -> (f64, f64) {
        let scaled: Vec<_> =
            self.direction.iter().zip(&self.root).map(|(entry, root)| entry / *root).collect();
        let mut next = self.discrete.stiffness_product(&self.rest, &scaled);
        next.iter_mut().zip(&self.root).for_each(|(entry, root)| *entry /= *root);
        let alpha = dot(&next, &self.direction);
        for (a, entry) in next.iter_mut().enumerate() {
            *entry -= self.direction[a] * alpha + self.before[a] * self.beta;
        }
        self.beta = dot(&next, &next).sqrt();
        if self.beta > 0.0 {
            next.iter_mut().for_each(|entry| *entry /= self.beta);
        }
        self.before = std::mem::replace(&mut self.direction, next);
        (alpha, self.beta)
    }
}

fn dot<const D: usize>(a: &[Vector<D>], b: &[Vector<D>]) -> f64 {
    parallel::sum(a.len(), |k| a[k].dot(&b[k]))
}

/// Largest eigenvalue of a tridiagonal matrix and its eigenvector.
fn largest_mode(diagonal: &[f64], beside: &[f64]) -> (f64, DVector<f64>) {
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

/// A number in (-1, 1) for each index, of no regular pattern.
fn alternating(index: usize) -> f64 {
    let turned = (index as f64 + 1.0) * 0.618_033_988_749_894_9;
    2.0 * turned.fract() - 1.0
}
