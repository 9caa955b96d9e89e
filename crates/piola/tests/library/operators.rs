//! The operators: what they reproduce exactly, how fast they converge, and what they refuse.

use std::f64::consts::PI;

use crate::derivatives::{Derivatives as _, Interpolation};
use crate::support::{jittered, lattice, noise};
use piola::geometry::Particles;
use piola::neighbors::Domain;
use piola::operators::{Correction, GradientOperator, LeastSquares, OperatorError, Support};
use piola::{Tensor, Vector};
use piola_formulas::kernels::Kernel;

const CORRECTED: [Correction; 2] = [Correction::Gradient, Correction::KernelAndGradient];

fn supported<const D: usize>(particles: &Particles<D>, smoothing_ratio: f64) -> Support<D> {
    Support::new(particles, Kernel::CubicSpline, smoothing_ratio, Domain::open())
        .expect("the neighbours can be found")
}

fn gradient<const D: usize>(
    particles: &Particles<D>,
    support: &Support<D>,
    correction: Correction,
) -> GradientOperator<D> {
    GradientOperator::new(particles, support, correction).expect("the gradient exists")
}

/// Disordered particles with smoothing lengths that differ by up to a fifth from each other, and
/// weights and volumes that have nothing to do with each other.
fn disordered<const D: usize>(intervals: [usize; D]) -> Particles<D> {
    let mut particles = jittered(intervals.map(|n| n as f64 * 0.1), intervals, 0.2);
    for a in 0..particles.len() {
        particles.spacing[a] *= 1.0 + 0.2 * noise(7 * a);
        particles.weight[a] *= 1.0 + 0.3 * noise(11 * a);
        particles.volume[a] *= 1.0 + 0.3 * noise(13 * a);
    }
    particles
}

/// A matrix without any symmetry.
fn matrix<const D: usize>() -> Tensor<D> {
    Tensor::from_fn(|i, j| 2.0 * noise(100 + i * D + j))
}

fn linear_fields_are_exact<const D: usize>(intervals: [usize; D]) {
    let particles = disordered(intervals);
    let support = supported(&particles, 1.4);
    let (slope, shift) = (matrix::<D>(), Vector::<D>::from_fn(|i, _| noise(i)));
    let field: Vec<Vector<D>> = particles.position.iter().map(|x| slope * x + shift).collect();
    let first: Vec<f64> = field.iter().map(|u| u[0]).collect();
    for correction in CORRECTED {
        let operator = gradient(&particles, &support, correction);
        let whole = operator.vector_gradient(&support, &field);
        let scalar = operator.gradient(&support, &first);
        let divergence = operator.divergence(&support, &field);
        for a in 0..particles.len() {
            // Round-off of values of order one over a spacing of 0.1, times a condition of 10.
            assert!((whole[a] - slope).norm() < 1e-12, "{D}D {correction:?} {a}: {}", whole[a]);
            assert!((scalar[a] - slope.row(0).transpose()).norm() < 1e-12, "{D}D {correction:?}");
            assert!((divergence[a] - slope.trace()).abs() < 1e-12, "{D}D {correction:?}");
        }
    }
    // Without correction it is not: what the test would miss if the name chose nothing.
    let plain = gradient(&particles, &support, Correction::None);
    let found = plain.vector_gradient(&support, &field);
    let worst = found.iter().map(|found| (found - slope).norm()).fold(0.0, f64::max);
    assert!(worst > 0.1 * slope.norm(), "{D}D: {worst}");
}

#[test]
fn corrected_gradients_are_exact_for_linear_fields_on_disordered_particles() {
    linear_fields_are_exact([30]);
    linear_fields_are_exact([10, 12]);
    linear_fields_are_exact([6, 7, 5]);
}

/// To the bit: differences of equal numbers are zero.
#[test]
fn gradients_of_constants_vanish_for_all_corrections() {
    let particles = disordered([10, 12]);
    let support = supported(&particles, 1.4);
    for correction in Correction::ALL {
        let operator = gradient(&particles, &support, correction);
        let field = vec![1.0 / 3.0; particles.len()];
        for slope in operator.gradient(&support, &field) {
            assert_eq!(slope, Vector::<2>::zeros(), "{correction:?}");
        }
    }
}

#[test]
fn normalised_interpolation_is_exact_for_constants() {
    let particles = disordered([6, 7, 5]);
    let support = supported(&particles, 1.4);
    let field = vec![3.0; particles.len()];
    let normalised = Interpolation::new(&particles, &support, true);
    for value in normalised.apply(&support, &field) {
        assert!((value - 3.0).abs() < 1e-14, "{value}");
    }
    // The plain kernel misses what lies outside: a corner of a box keeps about an eighth.
    let plain = Interpolation::new(&particles, &support, false).apply(&support, &field);
    let least = plain.iter().copied().fold(f64::INFINITY, f64::min);
    assert!(least < 1.5, "{least}");
}

/// `[sum N (x) N]^-1 sum (u_b - u_a)/|d| N` of linear fields, with the sum taken here.
fn least_squares_are_exact<const D: usize>(intervals: [usize; D]) {
    let particles = disordered(intervals);
    let support = supported(&particles, 1.4);
    let operator = LeastSquares::new(&particles, &support).expect("the inverses exist");
    let slope: Vector<D> = matrix::<D>().column(0).into();
    for a in 0..particles.len() {
        let sum: Vector<D> = support
            .list
            .row(a)
            .iter()
            .map(|&b| {
                let d = particles.position[b as usize] - particles.position[a];
                d.normalize() * (slope.dot(&d) / d.norm())
            })
            .sum();
        let found = operator.inverse(a) * sum;
        assert!((found - slope).norm() < 1e-13, "{D}D {a}: {found}");
    }
}

#[test]
fn the_least_squares_gradient_is_exact_for_linear_fields() {
    least_squares_are_exact([30]);
    least_squares_are_exact([10, 12]);
    least_squares_are_exact([6, 7, 5]);
}

/// Forces `f_a = -sum_b V_b P_b G_ba` do the power `-sum V P : grad v`, and cancel in sum.
fn adjoint_is_exact<const D: usize>(intervals: [usize; D]) {
    let particles = disordered(intervals);
    let support = supported(&particles, 1.4);
    let stress: Vec<Tensor<D>> = (0..particles.len())
        .map(|a| Tensor::from_fn(|i, j| noise(5000 + (a * D + i) * D + j)))
        .collect();
    let velocity: Vec<Vector<D>> =
        (0..particles.len()).map(|a| Vector::from_fn(|i, _| noise(a * D + i))).collect();
    for correction in Correction::ALL {
        let operator = gradient(&particles, &support, correction);
        let forces: Vec<Vector<D>> = (0..particles.len())
            .map(|a| {
                let own = stress[a] * operator.diagonal(a) * particles.volume[a];
                let pairs = support.list.row(a).iter();
                let pairs = pairs.zip(operator.adjoint(support.list.range(a)));
                let others = pairs.map(|(&b, g)| {
                    stress[b as usize] * Vector::from(*g) * particles.volume[b as usize]
                });
                -(own + others.sum::<Vector<D>>())
            })
            .collect();
        let slopes = operator.vector_gradient(&support, &velocity);
        let internal = |a: usize| particles.volume[a] * stress[a].dot(&slopes[a]);
        let external = |a: usize| velocity[a].dot(&forces[a]);
        let indices = 0..particles.len();
        let balance: f64 = indices.clone().map(|a| internal(a) + external(a)).sum();
        let size: f64 = indices.clone().map(|a| internal(a).abs() + external(a).abs()).sum();
        assert!(balance.abs() < 1e-14 * size, "{D}D {correction:?}: {balance} of {size}");
        let total: Vector<D> = forces.iter().sum();
        let size: f64 = forces.iter().map(Vector::norm).sum();
        assert!(total.norm() < 1e-14 * size, "{D}D {correction:?}: {total}");
    }
}

#[test]
fn the_adjoint_does_the_power_of_the_gradient() {
    adjoint_is_exact([30]);
    adjoint_is_exact([10, 12]);
    adjoint_is_exact([6, 7, 5]);
}

/// `w_b L grad W~_b(X_a)` of one particle by its definition: Upwind (2.39) as a function of the
/// place, differentiated by differences, and (2.43).
fn coefficients_by_definition(
    particles: &Particles<2>,
    support: &Support<2>,
    correction: Correction,
    a: usize,
) -> Vec<Vector<2>> {
    let h = support.smoothing_length[a];
    let value = |x: &Vector<2>, b: usize| {
        Kernel::CubicSpline.value(2, (x - particles.position[b]).norm(), h)
    };
    let shape = |x: &Vector<2>, b: usize| {
        let all = (0..particles.len()).map(|c| particles.weight[c] * value(x, c));
        match correction {
            Correction::KernelAndGradient => value(x, b) / all.sum::<f64>(),
            _ => value(x, b),
        }
    };
    let slope = |b: usize| {
        Vector::<2>::from_fn(|k, _| {
            let (x, mut step) = (particles.position[a], Vector::<2>::zeros());
            step[k] = 1e-6;
            (shape(&(x + step), b) - shape(&(x - step), b)) / 2e-6
        })
    };
    let row: Vec<usize> = support.list.row(a).iter().map(|&b| b as usize).collect();
    let moment: Tensor<2> = row
        .iter()
        .map(|&b| {
            let separation = particles.position[b] - particles.position[a];
            slope(b) * separation.transpose() * particles.weight[b]
        })
        .sum();
    let correct = match correction {
        Correction::None => Tensor::identity(),
        _ => moment.try_inverse().expect("the moment can be inverted"),
    };
    row.iter().map(|&b| correct * slope(b) * particles.weight[b]).collect()
}

/// Exactness for linear fields holds for any kernel: it does not tell a wrong one.
#[test]
fn gradient_coefficients_are_those_of_the_definition() {
    let particles = disordered([10, 12]);
    let support = supported(&particles, 1.4);
    for correction in Correction::ALL {
        let operator = gradient(&particles, &support, correction);
        for a in [0, 5, 60, 77, 142] {
            let expected = coefficients_by_definition(&particles, &support, correction, a);
            let found = operator.forward(support.list.range(a));
            for (expected, found) in expected.iter().zip(found) {
                // Differences of 1e-6 of a spacing of 0.1 of numbers of order 10 are good to 1e-7.
                let error = (expected - Vector::from(*found)).norm();
                assert!(error < 1e-6, "{correction:?} {a}: {found:?} {expected}");
            }
        }
    }
}

/// On the narrow stencil each particle on a face has the face's share of its cell as area: with
/// dx = 1 that is 1 on faces in 2D and 0.5 per direction in corners; 1, 1/2 and 1/4 in 3D.
fn areas_are_those_of_the_cells<const D: usize>(
    intervals: [usize; D],
    spacing: [f64; D],
    smoothing_ratio: f64,
) {
    let lengths: [f64; D] = std::array::from_fn(|k| spacing[k] * intervals[k] as f64);
    let particles = lattice(lengths, intervals);
    let support = supported(&particles, smoothing_ratio);
    let operator = gradient(&particles, &support, Correction::Gradient);
    let areas = operator.boundary_areas(&support, &particles.volume);
    for (x, area) in particles.position.iter().zip(&areas) {
        let on = |k: usize| (x[k] < 1e-9, x[k] > lengths[k] - 1e-9);
        let expected = Vector::<D>::from_fn(|k, _| {
            let across: f64 = (0..D)
                .filter(|&other| other != k)
                .map(|other| spacing[other] * if on(other) == (false, false) { 1.0 } else { 0.5 })
                .product();
            match on(k) {
                (true, _) => -across,
                (_, true) => across,
                _ => 0.0,
            }
        });
        assert!((area - expected).norm() < 1e-13, "{x} has {area} instead of {expected}");
    }
    assert!(areas.iter().sum::<Vector<D>>().norm() < 1e-12);
}

#[test]
fn boundary_areas_of_the_narrow_stencil_are_those_of_the_faces() {
    areas_are_those_of_the_cells([12], [1.0], 0.7);
    areas_are_those_of_the_cells([6, 8], [1.0, 1.0], 0.7);
    areas_are_those_of_the_cells([4, 5, 6], [1.0, 1.0, 1.0], 0.7);
    // 2 h = 1.2 lies between the larger spacing and the diagonal 1.28.
    areas_are_those_of_the_cells([6, 8], [0.8, 1.0], 0.6);
}

/// In a periodic box a wave is an eigenfunction: the narrow stencil turns `sin(k x)` into
/// `cos(k x) sin(k dx)/dx` everywhere, across the bounds as well.
#[test]
fn periodic_waves_are_differentiated_by_the_symbol_of_the_stencil() {
    let n = 16;
    let mut particles = lattice([1.0, 1.0], [n - 1, n - 1]);
    let spacing = 1.0 / n as f64;
    particles.position.iter_mut().for_each(|x| *x *= (n - 1) as f64 / n as f64);
    particles.weight.fill(spacing * spacing);
    particles.spacing.fill(spacing);
    let domain = Domain::new([Some([0.0, 1.0]), Some([0.0, 1.0])]).expect("a sound box");
    let support = Support::new(&particles, Kernel::CubicSpline, 0.7, domain)
        .expect("the neighbours can be found");
    let operator = gradient(&particles, &support, Correction::Gradient);
    let (kx, ky) = (2.0 * PI, 6.0 * PI);
    let field: Vec<Vector<2>> = particles
        .position
        .iter()
        .map(|x| Vector::<2>::new((kx * x[0]).sin(), (ky * x[1] + 0.4).sin()))
        .collect();
    let divergence = operator.divergence(&support, &field);
    for (x, divergence) in particles.position.iter().zip(&divergence) {
        let expected = (kx * x[0]).cos() * (kx * spacing).sin() / spacing
            + (ky * x[1] + 0.4).cos() * (ky * spacing).sin() / spacing;
        assert!((divergence - expected).abs() < 1e-12, "{x}: {divergence}, {expected}");
    }
}

/// Root mean square error of the corrected gradient of a wave on the unit square with n
/// intervals, over particles `margin` or further from the boundary.
fn gradient_error(n: usize, jitter: f64, margin: f64, correction: Correction) -> f64 {
    let particles = jittered([1.0, 1.0], [n, n], jitter);
    let support = supported(&particles, 1.2);
    let operator = gradient(&particles, &support, correction);
    let wave = |x: &Vector<2>| (3.0 * x[0] + 2.0 * x[1]).sin();
    let exact = |x: &Vector<2>| Vector::<2>::new(3.0, 2.0) * (3.0 * x[0] + 2.0 * x[1]).cos();
    let field: Vec<f64> = particles.position.iter().map(wave).collect();
    let found = operator.gradient(&support, &field);
    let inside = |x: &Vector<2>| x.iter().all(|x| *x >= margin && *x <= 1.0 - margin);
    let errors: Vec<f64> = particles
        .position
        .iter()
        .zip(&found)
        .filter(|(x, _)| inside(x))
        .map(|(x, g)| (g - exact(x)).norm_squared())
        .collect();
    (errors.iter().sum::<f64>() / errors.len() as f64).sqrt()
}

/// Second order where particles lie symmetrically, first where they do not: inside a disordered
/// cloud, and on the boundary, whose share of all particles is of order dx (so 1.5 in the mean
/// square over a lattice).
#[test]
fn corrected_gradients_converge_at_their_order() {
    for correction in CORRECTED {
        for (jitter, margin, least, most) in
            [(0.0, 0.2, 1.95, 2.05), (0.2, 0.2, 0.9, 1.1), (0.0, 0.0, 1.4, 1.6)]
        {
            let [coarse, fine] = [40, 160].map(|n| gradient_error(n, jitter, margin, correction));
            let order = (coarse / fine).log2() / 2.0;
            assert!(
                (least..most).contains(&order),
                "{correction:?} jitter {jitter} margin {margin}: {order}, {coarse} {fine}"
            );
        }
    }
}

/// The cubic spline with h = dx in one dimension is a B-spline: `(f_-1 + 4 f_0 + f_1) / 6`, so
/// that the error is `dx^2 f'' / 6`.
#[test]
fn plain_interpolation_is_of_second_order_inside() {
    let error = |n: usize| {
        let particles = lattice([1.0], [n]);
        let support = supported(&particles, 1.0);
        let wave: Vec<f64> = particles.position.iter().map(|x| (4.0 * x[0]).sin()).collect();
        let found = Interpolation::new(&particles, &support, false).apply(&support, &wave);
        let range = n / 4..=3 * n / 4;
        range.map(|a| (found[a] - wave[a]).abs()).fold(0.0, f64::max)
    };
    let (coarse, fine) = (error(20), error(80));
    let order = (coarse / fine).log2() / 2.0;
    assert!((1.98..2.02).contains(&order), "{order}");
    let largest = (4.0_f64 * 0.39).sin(); // near the crest, which lies at 0.393
    assert!((fine / (16.0 * largest / 6.0 / 6400.0) - 1.0).abs() < 0.01, "{fine}");
}

/// Three rows of particles, of which one has gone astray, numbered backwards so that number and
/// place in memory differ.
fn with_a_hermit() -> Particles<2> {
    let mut particles = lattice([1.0, 0.2], [10, 2]);
    particles.position[15] = Vector::<2>::new(9.0, 9.0);
    particles.id.reverse();
    particles
}

#[test]
fn a_particle_on_its_own_is_named() {
    let particles = with_a_hermit();
    let support = supported(&particles, 1.2);
    for correction in CORRECTED {
        let refused = GradientOperator::new(&particles, &support, correction);
        let error = refused.expect_err("a particle without neighbours has no gradient");
        let text = error.to_string();
        let OperatorError::PoorSupport { id, position, neighbors, dimension, .. } = error else {
            panic!("{error}")
        };
        assert_eq!((id, position, neighbors, dimension), (17, vec![9.0, 9.0], 0, 2));
        assert!(text.contains(correction.name()) && text.contains("particle 17 "), "{text}");
    }
    assert!(GradientOperator::new(&particles, &support, Correction::None).is_ok());
    let error = LeastSquares::new(&particles, &support).expect_err("nor a least-squares one");
    assert!(matches!(error, OperatorError::PoorSupport { id: 17, .. }), "{error}");
}

/// Particles on a line in 2D and on a plane in 3D, both oblique, so that rounding makes the
/// moments almost singular instead of singular.
#[test]
fn neighbours_that_do_not_span_the_space_are_refused() {
    let mut line = lattice([1.0, 1.0], [10, 1]);
    line.reorder(&(0..11).collect::<Vec<u32>>());
    line.position.iter_mut().for_each(|x| *x = Vector::<2>::new(0.6 * x[0], 0.8 * x[0]));
    line.spacing.fill(0.1);
    let support = supported(&line, 1.4);
    let error = GradientOperator::new(&line, &support, Correction::Gradient);
    let error = error.expect_err("a line does not span the plane");
    assert!(matches!(error, OperatorError::PoorSupport { id: 0, neighbors: 2, .. }), "{error}");
    assert!(LeastSquares::new(&line, &support).is_err());

    let mut plane = lattice([0.5, 0.5, 0.1], [5, 5, 1]);
    plane.reorder(&(0..36).collect::<Vec<u32>>());
    let turn = nalgebra::Rotation3::from_euler_angles(0.4, 0.3, 0.2);
    plane.position.iter_mut().for_each(|x| *x = turn * *x);
    let support = supported(&plane, 1.4);
    assert!(GradientOperator::new(&plane, &support, Correction::KernelAndGradient).is_err());
    assert!(LeastSquares::new(&plane, &support).is_err());
}

#[test]
fn coincident_particles_are_named() {
    let mut particles = lattice([1.0, 0.2], [10, 2]);
    particles.position[7] = particles.position[20];
    particles.id.reverse();
    let support = supported(&particles, 1.2);
    let error = LeastSquares::new(&particles, &support).expect_err("no direction between them");
    let position = vec![particles.position[7][0], particles.position[7][1]];
    assert_eq!(error, OperatorError::Coincident { first: 25, second: 12, position });
}
