//! The SPH matrices: against sums, exact fields, their own adjoints; and boundary values.

use nalgebra::SMatrix;
use piola::geometry::{LatticeSpec, Particles, Shape, fill};
use piola::neighbors::Domain;
use piola::operators::{
    BoundaryValueError, Continuation, Cover, DirectedSupport, DualGradient, GradientForm, Mirror,
    ModifiedMatrix, ReferenceGradient, SparseOperator, SphMatrices, images, one_by_one,
    raise_ghosts,
};
use piola::{Tensor, Vector};
use piola_formulas::kernels::Kernel;

fn lattice<const D: usize>(cells: [usize; D], spacing: f64) -> Particles<D> {
    let high = Vector::from_fn(|i, _| cells[i] as f64 * spacing);
    let shape = Shape::cuboid(Vector::zeros(), high).expect("a box");
    fill(&shape, &LatticeSpec::square([spacing; D])).expect("particles").particles
}

fn cover<'a, const D: usize>(
    particles: &'a Particles<D>,
    radius: &'a [f64],
    images: &'a [piola::operators::Image<D>],
) -> Cover<'a, D> {
    let kernel = Kernel::ModifiedMollifier;
    Cover { particles, group: &[], images, kernel, radius, domain: Domain::default() }
}

/// The plain gradient of a cover with hourglass coefficients in J.
fn plain_gradient<const D: usize>(
    cover: &Cover<'_, D>,
    hourglass: Vec<f64>,
) -> ReferenceGradient<D> {
    let support = DirectedSupport::of(cover).expect("neighbours");
    let gradient = DualGradient::of(cover, &support).expect("a gradient");
    ReferenceGradient::new((cover.particles, cover.images), &support, &gradient, hourglass)
}

#[test]
fn matrices_are_the_sums_of_the_paper() {
    let particles = lattice([6, 5], 0.1);
    let radius = vec![0.25; particles.len()];
    let cover = cover(&particles, &radius, &[]);
    let matrices = SphMatrices::new(&cover, GradientForm::Plain).expect("matrices");
    let kernel = Kernel::ModifiedMollifier;
    for p in 0..particles.len() {
        for q in 0..particles.len() {
            let d: Vector<2> = particles.position[p] - particles.position[q];
            let value = particles.weight[q] * kernel.value(2, d.norm(), 0.25);
            assert!((matrices.value.entry(p, q as u32) - value).abs() < 1e-14);
            let slope = if p == q { 0.0 } else { kernel.derivative_over_r(2, d.norm(), 0.25) };
            for axis in 0..2 {
                let expected = particles.weight[q] * slope * d[axis];
                assert!((matrices.gradient[axis].entry(p, q as u32) - expected).abs() < 1e-12);
            }
        }
    }
}

#[test]
fn corrected_matrices_are_exact_for_linear_fields_in_every_dimension() {
    fn check<const D: usize>(cells: [usize; D]) {
        let particles = lattice(cells, 0.1);
        let radius = vec![0.25; particles.len()];
        let cover = cover(&particles, &radius, &[]);
        let matrices = SphMatrices::new(&cover, GradientForm::Corrected).expect("matrices");
        let slope = Vector::<D>::from_fn(|i, _| 1.5 - i as f64);
        let field: Vec<f64> = particles.position.iter().map(|x| 2.0 + slope.dot(x)).collect();
        for axis in 0..D {
            for value in matrices.gradient[axis].apply(&field) {
                assert!((value - slope[axis]).abs() < 1e-12);
            }
        }
    }
    check([9]);
    check([7, 5]);
    check([5, 4, 5]);
}

#[test]
fn a_matrix_can_be_turned_printed_and_exported() {
    let rows = [vec![(2, 3.0), (0, 1.0), (2, 0.5)], vec![(1, -2.0), (7, 9.0)]];
    let matrix = SparseOperator::from_rows(rows, 3);
    assert_eq!(matrix.apply(&[1.0, 10.0, 100.0]), [351.0, -20.0]);
    let turned = matrix.transposed();
    assert_eq!((turned.rows(), turned.columns(), turned.entries()), (3, 2, 3));
    assert_eq!(turned.apply(&[1.0, 1.0]), [1.0, -2.0, 3.5]);
    assert_eq!(turned.transposed(), matrix);
    let mut text = Vec::new();
    matrix.write_matrix_market(&mut text).expect("memory");
    let expected =
        "%%MatrixMarket matrix coordinate real general\n2 3 3\n1 1 1e0\n1 3 3.5e0\n2 2 -2e0\n";
    assert_eq!(String::from_utf8(text).expect("text"), expected);
    assert!(matrix.to_string().lines().next().expect("a row").contains("3.5000e0"));
    let large = SparseOperator::from_rows(vec![vec![(0, 1.0)]; 20], 20);
    assert_eq!(large.to_string(), "20 x 20 matrix with 20 entries");
}

/// Between a symmetry plane and a moving roller the gradient is that of the whole.
#[test]
fn gradients_are_exact_up_to_the_planes() {
    let particles = lattice([4, 6], 0.1);
    let radius = vec![0.27; particles.len()];
    let mirrors = [
        Mirror { axis: 0, place: 0.0, is_upper: false, continuation: Continuation::Odd },
        Mirror { axis: 1, place: 0.6, is_upper: true, continuation: Continuation::Odd },
    ];
    let made = images(&particles.position, &particles.spacing, &mirrors, 0.27);
    let cover = cover(&particles, &radius, &made);
    let operator = plain_gradient(&cover, vec![0.0; particles.len()]);
    // Even across the planes along them, odd along their axes about 0 and 0.03.
    let truth = |x: &Vector<2>| Vector::from([0.2 * x[0], 0.03 - 0.5 * (0.6 - x[1])]);
    let mut field: Vec<Vector<2>> = particles.position.iter().map(truth).collect();
    field.resize(particles.len() + made.len(), Vector::zeros());
    operator.continue_field(&[[0.0, 0.0], [0.0, 0.03]], &mut field);
    let mut gradient = vec![Tensor::<2>::zeros(); particles.len()];
    operator.gradients(&field, &mut gradient);
    for (a, gradient) in gradient.iter().enumerate() {
        let expected = SMatrix::<f64, 2, 2>::new(0.2, 0.0, 0.0, 0.5);
        assert!((gradient - expected).amax() < 1e-12, "{gradient}");
        assert!((operator.gradient_at(&field, a) - expected).amax() < 1e-12);
        assert!(operator.hourglass_energy(&field, gradient, a).abs() < 1e-24);
    }
}

#[test]
fn forces_with_images_are_the_derivatives_of_the_energy() {
    let particles = lattice([4, 3], 0.1);
    let count = particles.len();
    let radius = vec![0.27; count];
    let mirrors =
        [Mirror { axis: 0, place: 0.0, is_upper: false, continuation: Continuation::Odd }];
    let made = images(&particles.position, &particles.spacing, &mirrors, 0.27);
    let cover = cover(&particles, &radius, &made);
    let coefficients: Vec<f64> = (0..count).map(|a| 1.0 + 0.1 * a as f64).collect();
    let operator = plain_gradient(&cover, coefficients);
    let continued = |field: &[Vector<2>], data: &[[f64; 2]; 2]| {
        let mut field = field.to_vec();
        field.resize(count + made.len(), Vector::zeros());
        operator.continue_field(data, &mut field);
        field
    };
    // 3/2 |A|^2 and the hourglass energy.
    let energy = |u: &[Vector<2>], data: &[[f64; 2]; 2]| -> f64 {
        let u = continued(u, data);
        let of = |a: usize| {
            let gradient = operator.gradient_at(&u, a);
            1.5 * gradient.norm_squared() + operator.hourglass_energy(&u, &gradient, a)
        };
        (0..count).map(of).sum()
    };
    let field = |seed: f64| -> Vec<Vector<2>> {
        (0..count)
            .map(|a| Vector::from([(seed + a as f64).sin(), (2.0 * seed - 1.7 * a as f64).cos()]))
            .collect()
    };
    let (u, direction, data) = (field(0.3), field(5.1), [[0.04, 0.0], [0.0; 2]]);
    let at = continued(&u, &data);
    let mut strained = operator.strained();
    operator.strain(&at, &mut strained, one_by_one(|_, gradient| gradient * 3.0));
    let mut forces = vec![Vector::zeros(); at.len()];
    operator.forces(&at, &strained.tension, &mut forces);
    // What matrices are made of is what the cover gives, entry by entry.
    let support = DirectedSupport::of(&cover).expect("a support");
    let expected = DualGradient::of(&cover, &support).expect("a gradient");
    let (list, gradient) = operator.lists();
    for a in 0..count {
        let entries = support.list.range(a);
        assert_eq!(list.list.row(a), support.list.row(a));
        let pairs = gradient.coefficients(entries.clone()).iter().flatten();
        for (g, e) in pairs.zip(expected.coefficients(entries.clone()).iter().flatten()) {
            assert!((g - e).abs() < 1e-12 / 0.1, "{g} for {e}");
        }
        let pairs = gradient.weights(entries.clone()).iter();
        for (w, e) in pairs.zip(expected.weights(entries)) {
            assert!((w - e).abs() < 1e-12 * e, "{w} for {e}");
        }
    }
    let rates = [[0.7, 0.0], [0.0; 2]];
    let plane_power = operator.plane_power(&piola::parallel::Team::default(), &forces, &rates);
    operator.fold(&mut forces);
    let power: f64 = forces.iter().zip(&direction).map(|(f, d)| -f.dot(d)).sum();
    // The energy is quadratic, so that a central difference is exact.
    let moved = |step: f64| -> Vec<Vector<2>> {
        u.iter().zip(&direction).map(|(u, d)| u + d * step).collect()
    };
    let slope = 0.5 * (energy(&moved(1.0), &data) - energy(&moved(-1.0), &data));
    assert!((power - slope).abs() < 1e-10 * power.abs(), "{power} {slope}");
    // And with the plane.
    let shifted = |step: f64| [[0.04 + 0.7 * step, 0.0], [0.0; 2]];
    let slope = 0.5 * (energy(&u, &shifted(1.0)) - energy(&u, &shifted(-1.0)));
    assert!((plane_power - slope).abs() < 1e-10 * slope.abs(), "{plane_power} {slope}");
}

/// The deviations of a linear field are nothing, and there is no force on it.
#[test]
fn linear_fields_have_no_hourglass_energy() {
    let particles = lattice([5, 4], 0.1);
    let radius = vec![0.27; particles.len()];
    let cover = cover(&particles, &radius, &[]);
    let operator = plain_gradient(&cover, vec![1.0; particles.len()]);
    let slope = SMatrix::<f64, 2, 2>::new(0.3, -0.2, 0.5, 0.1);
    let u: Vec<Vector<2>> =
        particles.position.iter().map(|x| Vector::from([0.7, -0.3]) + slope * x).collect();
    let mut strained = operator.strained();
    operator.strain(&u, &mut strained, one_by_one(|_, _| Tensor::zeros()));
    let mut forces = vec![Vector::zeros(); particles.len()];
    operator.forces(&u, &strained.tension, &mut forces);
    assert!(forces.iter().all(|force| force.amax() < 1e-12));
    for (a, gradient) in strained.gradient.iter().enumerate() {
        assert!(operator.hourglass_energy(&u, gradient, a) < 1e-24);
    }
}

/// A row of particles with real ghosts, of which particle 10 is the left end.
fn row() -> (SphMatrices<1>, Vec<f64>) {
    let positions: Vec<f64> = (0..40).map(|k| f64::from(k - 10) * 0.05).collect();
    let count = positions.len();
    let particles = Particles {
        position: positions.iter().map(|x| Vector::from([*x])).collect(),
        volume: vec![0.05; count],
        weight: vec![0.05; count],
        spacing: vec![0.05; count],
        body: vec![0; count],
        id: (0..count as u32).collect(),
        ..Particles::default()
    };
    let radius = vec![5.5 * 0.05; count];
    let cover = cover(&particles, &radius, &[]);
    (SphMatrices::new(&cover, GradientForm::Plain).expect("matrices"), positions)
}

#[test]
fn raised_ghosts_meet_values_and_slopes_on_the_end_of_a_row() {
    let (matrices, positions) = row();
    let ghosts: Vec<u32> = (0..10).collect();
    let mut field: Vec<f64> = positions.iter().map(|x| x.sin()).collect();
    raise_ghosts(&matrices.value, &matrices.value, 10, &ghosts, 0.3, &mut field).expect("ghosts");
    assert!((matrices.value.apply(&field)[10] - 0.3).abs() < 1e-12);
    raise_ghosts(&matrices.gradient[0], &matrices.value, 10, &ghosts, -2.0, &mut field)
        .expect("ghosts");
    assert!((matrices.gradient[0].apply(&field)[10] + 2.0).abs() < 1e-12);
    // Over all neighbours, as it is printed, the sum is zero.
    let all: Vec<u32> = (0..40).collect();
    let refused = raise_ghosts(&matrices.gradient[0], &matrices.value, 10, &all, 1.0, &mut field);
    assert_eq!(refused, Err(BoundaryValueError::NoGhost { particle: 10 }));
}

/// The modified matrix meets values in two and three dimensions, and knows where it is poor.
#[test]
fn the_modified_matrix_meets_boundary_values_to_rounding() {
    fn check<const D: usize>(cells: [usize; D], cover_size: f64) -> f64 {
        let particles = lattice(cells, 1.0);
        let inside =
            |x: &Vector<D>| (0..D).all(|axis| x[axis] > 2.5 && x[axis] < cells[axis] as f64 - 2.5);
        let radius = vec![cover_size; particles.len()];
        let cover = cover(&particles, &radius, &[]);
        let matrices = SphMatrices::new(&cover, GradientForm::Plain).expect("matrices");
        let selected: Vec<u32> = (0..particles.len() as u32)
            .filter(|&a| !inside(&particles.position[a as usize]))
            .collect();
        let mut modified =
            ModifiedMatrix::new(&matrices.value, &selected, &particles.weight).expect("factors");
        let wanted: Vec<f64> = selected
            .iter()
            .map(|&a| particles.position[a as usize].iter().sum::<f64>().cos())
            .collect();
        let mut field: Vec<f64> = particles.position.iter().map(|x| (0.3 * x[0]).sin()).collect();
        modified.impose(&wanted, &mut field).expect("a solution");
        let sums = matrices.value.apply(&field);
        for (&a, wanted) in selected.iter().zip(&wanted) {
            assert!((sums[a as usize] - wanted).abs() < 1e-12);
        }
        modified.condition()
    }
    let narrow = check([12, 10], 2.5);
    assert!((3.0..20.0).contains(&narrow), "{narrow}");
    assert!(check([8, 8, 8], 2.5) < 200.0);
    let wide = check([24, 20], 5.5);
    assert!(wide > 1e3, "{wide}");
}
