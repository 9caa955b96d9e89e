//! The largest step of central differences.

use super::Discrete;
use crate::Vector;
use crate::solve::largest_mode;

/// By how much the frequency that is found may be too small, as all of Lanczos' values are.
const SAFETY: f64 = 1.01;

/// Largest step of central differences at rest, `2/omega`, theory (50), and the particle that moves
/// most in the mode it belongs to: that of the largest eigenvalue of `M^-1/2 K M^-1/2`.
pub(super) fn stable_step<const D: usize>(discrete: &Discrete<D>, mass: &[f64]) -> (f64, usize) {
    let count = mass.len();
    let rest = vec![Vector::zeros(); count];
    let root: Vec<f64> = mass.iter().map(|mass| mass.sqrt()).collect();
    let mode = largest_mode(count * D, |direction, product| {
        let scaled: Vec<Vector<D>> = (direction.chunks_exact(D).zip(&root))
            .map(|(entry, root)| Vector::from_column_slice(entry) / *root)
            .collect();
        let image = discrete.stiffness_product(&rest, &scaled);
        for ((product, image), root) in product.chunks_exact_mut(D).zip(&image).zip(&root) {
            product.copy_from_slice((image / *root).as_slice());
        }
    });
    let speed = |a: usize| {
        mode.vector[a * D..][..D].iter().map(|entry| entry * entry).sum::<f64>() / mass[a]
    };
    let fastest = |best: usize, a: usize| if speed(a) > speed(best) { a } else { best };
    (2.0 / (SAFETY * mode.value.max(0.0).sqrt()), (0..count).fold(0, fastest))
}
