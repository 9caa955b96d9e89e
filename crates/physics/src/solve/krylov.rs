//! Linear solvers that need products only.

use crate::parallel;

/// What a Krylov method has found.
#[derive(Clone, Debug)]
pub struct Outcome {
    /// The solution, or as much of it as was found.
    pub solution: Vec<f64>,
    /// Steps taken.
    pub steps: usize,
    /// Norm of the residual left over that of the right-hand side.
    pub residual: f64,
    /// A direction d with `d . K d <= 0`, where one was met.
    pub negative_curvature: bool,
}

/// Preconditioned conjugate gradients for a symmetric positive definite matrix, down to a residual
/// of `tolerance` of the right-hand side. Where the matrix is not positive along a direction the
/// solution so far is given back, or that direction if it is the first.
pub fn conjugate_gradients(
    mut product: impl FnMut(&[f64], &mut [f64]),
    mut precondition: impl FnMut(&[f64], &mut [f64]),
    right: &[f64],
    tolerance: f64,
    most_steps: usize,
) -> Outcome {
    let count = right.len();
    let mut solution = vec![0.0; count];
    let mut residual = right.to_vec();
    let mut scaled = vec![0.0; count];
    precondition(&residual, &mut scaled);
    let mut direction = scaled.clone();
    let mut image = vec![0.0; count];
    let mut energy = dot(&residual, &scaled);
    let size = norm(right);
    let mut steps = 0;
    let relative = |residual: &[f64]| if size > 0.0 { norm(residual) / size } else { 0.0 };
    while relative(&residual) > tolerance && steps < most_steps {
        product(&direction, &mut image);
        let curvature = dot(&direction, &image);
        if !(curvature > 0.0) {
            let solution = if steps == 0 { direction } else { solution };
            let residual = relative(&residual);
            return Outcome { solution, steps, residual, negative_curvature: true };
        }
        let length = energy / curvature;
        advance(&mut solution, length, &direction);
        advance(&mut residual, -length, &image);
        precondition(&residual, &mut scaled);
        let next = dot(&residual, &scaled);
        let turn = next / energy;
        energy = next;
        direction.iter_mut().zip(&scaled).for_each(|(d, s)| *d = s + turn * *d);
        steps += 1;
    }
    let residual = relative(&residual);
    Outcome { solution, steps, residual, negative_curvature: false }
}

/// Directions that GMRES keeps before it starts again.
const RESTART: usize = 60;

/// Restarted GMRES, preconditioned from the right, for any matrix, down to a residual of
/// `tolerance` of the right-hand side.
pub fn gmres(
    mut product: impl FnMut(&[f64], &mut [f64]),
    mut precondition: impl FnMut(&[f64], &mut [f64]),
    right: &[f64],
    tolerance: f64,
    most_steps: usize,
) -> Outcome {
    let count = right.len();
    let mut solution = vec![0.0; count];
    let (mut scaled, mut image) = (vec![0.0; count], vec![0.0; count]);
    let size = norm(right);
    let goal = tolerance * size;
    let (mut steps, mut left) = (0, size);
    while left > goal && steps < most_steps {
        product(&solution, &mut image);
        let start: Vec<f64> = right.iter().zip(&image).map(|(r, p)| r - p).collect();
        left = norm(&start);
        if left <= goal {
            break;
        }
        let mut basis = vec![start.iter().map(|r| r / left).collect::<Vec<f64>>()];
        // Columns of the triangular factor, and the right-hand side turned with it.
        let mut columns: Vec<Vec<f64>> = Vec::new();
        let mut turns: Vec<(f64, f64)> = Vec::new();
        let mut turned = vec![left];
        while columns.len() < RESTART && left > goal && steps < most_steps {
            let k = columns.len();
            precondition(&basis[k], &mut scaled);
            product(&scaled, &mut image);
            // Twice, so that the basis stays orthogonal to rounding.
            let mut column = vec![0.0; k + 2];
            for _ in 0..2 {
                for (i, other) in basis.iter().enumerate() {
                    let along = dot(&image, other);
                    advance(&mut image, -along, other);
                    column[i] += along;
                }
            }
            column[k + 1] = norm(&image);
            let grown = column[k + 1];
            for (i, &(cosine, sine)) in turns.iter().enumerate() {
                let (upper, lower) = (column[i], column[i + 1]);
                column[i] = cosine * upper + sine * lower;
                column[i + 1] = cosine * lower - sine * upper;
            }
            let (upper, lower) = (column[k], column[k + 1]);
            let length = upper.hypot(lower);
            steps += 1;
            if !(length > 0.0 && length.is_finite()) {
                break;
            }
            let (cosine, sine) = (upper / length, lower / length);
            turns.push((cosine, sine));
            column[k] = length;
            column.truncate(k + 1);
            columns.push(column);
            turned.push(-sine * turned[k]);
            turned[k] *= cosine;
            left = turned[k + 1].abs();
            if !(grown > 0.0) {
                break;
            }
            basis.push(image.iter().map(|w| w / grown).collect());
        }
        if columns.is_empty() {
            break;
        }
        let mut weights = turned;
        for k in (0..columns.len()).rev() {
            weights[k] /= columns[k][k];
            for i in 0..k {
                weights[i] -= columns[k][i] * weights[k];
            }
        }
        let mut sum = vec![0.0; count];
        for (weight, direction) in weights[..columns.len()].iter().zip(&basis) {
            advance(&mut sum, *weight, direction);
        }
        precondition(&sum, &mut scaled);
        advance(&mut solution, 1.0, &scaled);
    }
    let residual = if size > 0.0 { left / size } else { 0.0 };
    Outcome { solution, steps, residual, negative_curvature: false }
}

pub(super) fn dot(a: &[f64], b: &[f64]) -> f64 {
    parallel::sum(a.len(), |k| a[k] * b[k])
}

pub(super) fn norm(a: &[f64]) -> f64 {
    dot(a, a).sqrt()
}

/// `sum += factor vector`.
pub(super) fn advance(sum: &mut [f64], factor: f64, vector: &[f64]) {
    sum.iter_mut().zip(vector).for_each(|(sum, v)| *sum += factor * v);
}
