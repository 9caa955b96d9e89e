//! The tangent stiffness in products, in blocks and in a matrix.

use nalgebra::{DMatrix, DVector, SVector};
use num_dual::HyperDual64;
use piola::schemes::total_lagrangian::Stiffness;
use piola::solve::{Factor, Local, Reduction, SparseMatrix, Tangent, dissect, gmres, largest_mode};
use piola::{Tensor, Vector};
use piola_formulas::hyperelastic::HyperelasticLaw;
use piola_formulas::tensor;
use piola_formulas::volumetric::StressState;

use super::{body, constants};
use crate::clouds::{Cloud, disorder};
use crate::support::noise;

fn check_blocks<const D: usize>(cloud: &Cloud<D>, law: HyperelasticLaw, state: StressState) {
    let body = body(cloud, law, state);
    let displacement = disorder(&cloud.particles, 0.05);
    let mut stiffness = Stiffness::new(body.clone().into());
    stiffness.load(&displacement, &[]);
    let diagonal = stiffness.diagonal();
    let mut product = vec![Vector::zeros(); body.len()];
    for (a, component) in [(0, 0), (body.len() / 3, D - 1), (body.len() - 2, 0)] {
        let mut unit = vec![Vector::zeros(); body.len()];
        unit[a][component] = 1.0;
        stiffness.apply(&unit, &mut product);
        // Second derivatives of the energy along this component and some direction.
        for seed in [0, 5000, 9000] {
            let way = |b: usize, i: usize| noise(seed + D * b + i);
            let seeded: Vec<SVector<HyperDual64, D>> = (displacement.iter().zip(&unit).enumerate())
                .map(|(b, (u, unit))| {
                    SVector::from_fn(|i, _| HyperDual64::new(u[i], unit[i], way(b, i), 0.0))
                })
                .collect();
            let [strain, hourglass] = body.total_energy(&seeded);
            let exact = (strain + hourglass).eps1eps2;
            let along = (product.iter().enumerate())
                .map(|(b, row)| (0..D).map(|i| row[i] * way(b, i)).sum::<f64>());
            let scale = product.iter().map(|row| row.abs().sum()).sum::<f64>();
            assert!((along.sum::<f64>() - exact).abs() < 1e-12 * scale, "{a} {exact}");
        }
        let scale = product[a].amax();
        let mut row = vec![Vector::<D>::zeros(); body.len()];
        stiffness.add_row(a, &mut |b, block: &Tensor<D>| {
            row[b as usize] += block.row(component).transpose();
        });
        for (b, product) in product.iter().enumerate() {
            // A row of a symmetric matrix is a column.
            assert!((row[b] - product).amax() < 1e-12 * scale, "{b}: {} {product}", row[b]);
        }
        assert!((diagonal[a].column(component) - product[a]).amax() < 1e-12 * scale);
        let coupled = stiffness.coupled(a);
        let is_coupled = |b: usize| coupled.contains(&(b as u32));
        assert!((0..body.len()).all(|b| product[b].amax() == 0.0 || is_coupled(b)));
    }
}

#[test]
fn products_and_blocks_are_the_exact_second_derivative() {
    let law = HyperelasticLaw::neo_hookean_logarithmic(constants());
    check_blocks(&Cloud::simplices([1.0], [9], 0.3), law.clone(), StressState::UniaxialStress);
    check_blocks(&Cloud::simplices([1.0, 1.0], [5, 5], 0.25), law, StressState::PlaneStress);
    let law = HyperelasticLaw::neo_hookean(constants());
    check_blocks(&Cloud::simplices([1.0; 3], [3; 3], 0.2), law, StressState::ThreeDimensional);
}

/// The derivative of `cof(F) w` by central differences, for which two digits less than half of all
/// are left.
#[test]
fn pressure_adds_the_slope_of_the_pressing_force() {
    let cloud = Cloud::simplices([1.0; 3], [3; 3], 0.2);
    let law = HyperelasticLaw::neo_hookean(constants());
    let body = body(&cloud, law, StressState::ThreeDimensional);
    let displacement = disorder(&cloud.particles, 0.05);
    let pressing: Vec<Vector<3>> = cloud.areas.iter().map(|area| area * 3e5).collect();
    let direction: Vec<Vector<3>> =
        (0..body.len()).map(|a| Vector::from_fn(|i, _| noise(3 * a + i))).collect();
    let product = |pressing: &[Vector<3>]| {
        let mut stiffness = Stiffness::new(body.clone().into());
        stiffness.load(&displacement, pressing);
        let mut product = vec![Vector::zeros(); body.len()];
        stiffness.apply(&direction, &mut product);
        product
    };
    let (with, without) = (product(&pressing), product(&[]));
    let force = |step: f64, a: usize| {
        let moved: Vec<Vector<3>> =
            displacement.iter().zip(&direction).map(|(u, d)| u + d * step).collect();
        let f = body.displacement_gradient(&moved, a) + Tensor::<3>::identity();
        tensor::cofactor(&f) * pressing[a]
    };
    let step = 1e-5;
    let slopes: Vec<Vector<3>> =
        (0..body.len()).map(|a| (force(step, a) - force(-step, a)) / (2.0 * step)).collect();
    let scale = slopes.iter().map(Vector::amax).fold(0.0, f64::max);
    for (a, slope) in slopes.iter().enumerate() {
        assert!((with[a] - without[a] - slope).amax() < 1e-8 * scale, "{a}");
    }
}

/// Assembled with tilted frames, held and shared components, factorised in the order of nested
/// dissection: against dense matrices that know nothing of any of it.
#[test]
fn the_matrix_in_reduced_unknowns_is_solved() {
    let cloud = Cloud::simplices([1.0, 1.0], [9, 9], 0.2);
    let law = HyperelasticLaw::neo_hookean(constants());
    let body = body(&cloud, law, StressState::PlaneStrain);
    let count = body.len();
    let mut stiffness = Stiffness::new(body.clone().into());
    stiffness.load(&disorder(&cloud.particles, 0.05), &[]);
    let coupled: Vec<Vec<u32>> = (0..count).map(|a| stiffness.coupled(a)).collect();
    let order = dissect(&cloud.particles.position, &coupled);
    let mut sorted = order.clone();
    sorted.sort_unstable();
    assert!(sorted.into_iter().eq(0..count as u32), "the order names each particle once");
    let mut frames = vec![Tensor::<2>::identity(); count];
    frames[14] = Tensor::<2>::new(0.6, -0.8, 0.8, 0.6);
    let mut held = vec![[false; 2]; count];
    (0..10).for_each(|a| held[a] = [true; 2]);
    held[14][0] = true;
    let ties = [(1, (90..100).collect::<Vec<u32>>())];
    let reduction = Reduction::new(frames, &held, &ties, &order);
    let unknowns = 2 * count - 21 - 9;
    assert_eq!(reduction.unknowns(), unknowns);
    assert_eq!(reduction.locals(14)[0], Local::Held);
    let mut matrix = SparseMatrix::new(&reduction, &coupled);
    matrix.assemble(&reduction, &stiffness);
    // Dense: `T^T K T`, column by column.
    let (mut full, mut image) = (vec![Vector::zeros(); count], vec![Vector::zeros(); count]);
    let mut column = vec![0.0; unknowns];
    let mut dense = DMatrix::<f64>::zeros(unknowns, unknowns);
    for k in 0..unknowns {
        let mut unit = vec![0.0; unknowns];
        unit[k] = 1.0;
        reduction.expand_free(&unit, &mut full);
        stiffness.apply(&full, &mut image);
        reduction.restrict(&image, &mut column);
        dense.set_column(k, &DVector::from_column_slice(&column));
        matrix.apply(&unit, &mut column);
        let error = (dense.column(k) - DVector::from_column_slice(&column)).amax();
        assert!(error < 1e-12 * dense.column(k).amax(), "column {k}: {error:e}");
    }
    let right: Vec<f64> = (0..unknowns).map(noise).collect();
    let mut factor = Factor::new(&matrix).unwrap();
    assert_eq!(factor.factorise(&matrix), Ok(0));
    let residual = |solution: &[f64], matrix: &DMatrix<f64>| {
        let right = DVector::from_column_slice(&right);
        (matrix * DVector::from_column_slice(solution) - &right).norm() / right.norm()
    };
    let mut solution = right.clone();
    factor.solve(&mut solution);
    assert!(residual(&solution, &dense) < 1e-11);
    // Shifted into the middle of its eigenvalues the matrix is as indefinite as they say.
    let eigenvalues = dense.clone().symmetric_eigenvalues();
    let mut ascending: Vec<f64> = eigenvalues.iter().copied().collect();
    ascending.sort_by(f64::total_cmp);
    let middle = 0.5 * (ascending[6] + ascending[7]);
    matrix.add_to_diagonal(-middle);
    assert_eq!(factor.factorise(&matrix), Ok(7));
    // With a part that is not symmetric, by GMRES with the factors of the part that is.
    matrix.add_to_diagonal(middle);
    factor.factorise(&matrix).unwrap();
    let scale = 0.05 * ascending[unknowns / 2];
    let turned = DMatrix::from_fn(unknowns, unknowns, |i, j| match i.abs_diff(j) {
        1 => dense[(i, j)] + scale * if i > j { 1.0 } else { -1.0 },
        _ => dense[(i, j)],
    });
    let product = |x: &[f64], y: &mut [f64]| {
        y.copy_from_slice((&turned * DVector::from_column_slice(x)).as_slice());
    };
    let precondition = |x: &[f64], y: &mut [f64]| {
        y.copy_from_slice(x);
        factor.solve(y);
    };
    let outcome = gmres(product, precondition, &right, 1e-10, 500);
    assert!(residual(&outcome.solution, &turned) < 1e-9, "{} steps", outcome.steps);
    assert!(outcome.steps > 2, "the part that is not symmetric matters");
}

/// A chain of 400 springs, one of which is a thousand times as stiff: its mode is known from the two
/// ends of that spring, and no start without pattern has more than a small share in it.
#[test]
fn the_largest_mode_is_found_where_it_is_local() {
    let (size, stiff) = (400, 123);
    let spring = |k: usize| if k == stiff { 1000.0 } else { 1.0 };
    let mode = largest_mode(size, |x, y| {
        y.fill(0.0);
        for k in 0..size - 1 {
            let force = spring(k) * (x[k + 1] - x[k]);
            y[k] -= force;
            y[k + 1] += force;
        }
    });
    // 2 k + 1 up to terms of 1 / k.
    assert!((mode.value / 2001.0 - 1.0).abs() < 1e-3 && mode.value < 2001.01, "{}", mode.value);
    let length: f64 = mode.vector.iter().map(|entry| entry * entry).sum();
    let ends = mode.vector[stiff] * mode.vector[stiff + 1];
    assert!((length - 1.0).abs() < 1e-6 && (ends + 0.5).abs() < 1e-3, "{length} {ends}");
}
