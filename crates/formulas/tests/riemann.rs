//! The pair laws of the acoustic Riemann solver: symmetries, dissipation, and the exact solution.

use nalgebra::{Matrix2, SMatrix, SVector, Vector2};
use num_dual::Dual64;
use piola_formulas::riemann::{Interface, referential_wave_speed, stretched_wave_speed};
use piola_formulas::tensor::{
    cofactor, determinant, largest_eigenvalue, right_cauchy_green, smallest_eigenvalue,
};
use piola_formulas::volumetric::{VolumetricLaw, VolumetricResponse};
use proptest::prelude::*;

type Vector<const D: usize> = SVector<f64, D>;
type Matrix<const D: usize> = SMatrix<f64, D, D>;

fn vectors<const D: usize>(size: f64) -> impl Strategy<Value = Vector<D>> {
    prop::array::uniform(-size..size).prop_map(Vector::from)
}

/// Separations of 0.1 to 2 m in any direction.
fn separations<const D: usize>() -> impl Strategy<Value = Vector<D>> {
    vectors(1.0).prop_filter("particles apart", |d: &Vector<D>| d.norm() > 0.1)
}

/// Deformation gradients `I + A` with a small A: their determinant is positive.
fn deformations<const D: usize>() -> impl Strategy<Value = Matrix<D>> {
    prop::array::uniform(prop::array::uniform(-0.2..0.2_f64))
        .prop_map(|a: [[f64; D]; D]| Matrix::from_fn(|i, j| f64::from(i == j) + a[i][j]))
}

/// All that one particle of a pair sees of the pair.
#[derive(Clone, Copy, Debug)]
struct Pair<const D: usize> {
    current: Vector<D>,
    reference: Vector<D>,
    impedance: f64,
    velocity_jump: Vector<D>,
    pressure_jump: f64,
    /// H_a and H_b.
    cofactors: [Matrix<D>; 2],
    /// `V_a G_ab` and `V_b G_ba`.
    areas: [Vector<D>; 2],
}

impl<const D: usize> Pair<D> {
    /// The same pair seen from the other particle.
    fn exchanged(self) -> Self {
        Self {
            current: -self.current,
            reference: -self.reference,
            velocity_jump: -self.velocity_jump,
            pressure_jump: -self.pressure_jump,
            cofactors: [self.cofactors[1], self.cofactors[0]],
            areas: [self.areas[1], self.areas[0]],
            ..self
        }
    }

    /// `C_ab`.
    fn area(&self) -> Vector<D> {
        self.areas[0] - self.areas[1]
    }

    fn force(&self) -> Vector<D> {
        let interface = Interface::new(self.current, self.reference, self.impedance);
        interface.force(&self.velocity_jump, &self.area())
    }

    fn volume_rate(&self) -> f64 {
        let interface = Interface::new(self.current, self.reference, self.impedance);
        interface.volume_rate(self.pressure_jump, self.cofactors.each_ref(), self.areas.each_ref())
    }
}

fn pairs<const D: usize>() -> impl Strategy<Value = Pair<D>> {
    let geometry = (separations::<D>(), separations::<D>(), [deformations::<D>(), deformations()]);
    let areas = (vectors::<D>(3.0), vectors::<D>(3.0));
    (geometry, areas, vectors::<D>(10.0), -1e5..1e5, 1e2..1e6).prop_map(
        |((current, reference, f), (area, transposed), velocity_jump, pressure_jump, z)| Pair {
            current,
            reference,
            impedance: z,
            velocity_jump,
            pressure_jump,
            cofactors: f.map(|f| cofactor(&f)),
            areas: [area, transposed],
        },
    )
}

/// (3.37) to (3.40) with the matrices written out, and the density that (3.38) lacks.
fn check_definition<const D: usize>(pair: &Pair<D>) -> Result<(), TestCaseError> {
    let (n, normal) = (pair.current.normalize(), pair.reference.normalize());
    let projector = n * n.transpose();
    let s_v = projector * (0.5 * pair.impedance);
    let s_p = projector / (2.0 * pair.impedance);
    let stress = (s_v * pair.velocity_jump) * normal.transpose();
    // Projections may cancel: the rounding is relative to the sizes of what is projected.
    let sizes = pair.areas[0].norm() + pair.areas[1].norm();
    let size = pair.impedance * pair.velocity_jump.norm() * sizes;
    prop_assert!((pair.force() - stress * pair.area()).norm() <= 1e-13 * size);
    let [mine, theirs] = pair.cofactors;
    let stress_jump = (mine + theirs) * 0.5 * -pair.pressure_jump;
    let velocity = s_p * (stress_jump * normal);
    let mapped_area = mine * pair.areas[0] - theirs * pair.areas[1];
    let rate = velocity.dot(&mapped_area);
    let size = pair.pressure_jump.abs() / pair.impedance * sizes;
    prop_assert!((pair.volume_rate() - rate).abs() <= 1e-13 * size);
    Ok(())
}

/// To the bit, so that sums over all particles cancel; and the force has no moment.
fn check_exchange<const D: usize>(pair: &Pair<D>) -> Result<(), TestCaseError> {
    let other = pair.exchanged();
    prop_assert_eq!(pair.force(), -other.force());
    prop_assert_eq!(pair.volume_rate(), -other.volume_rate());
    let (force, n) = (pair.force(), pair.current.normalize());
    prop_assert!((force - n * n.dot(&force)).norm() <= 1e-14 * force.norm());
    Ok(())
}

/// In a homogeneous deformation with `C = s N`, s > 0, both dissipations take energy: the power
/// of a pair is `-f . dv` and `dp r`.
fn check_dissipation<const D: usize>(
    pair: &Pair<D>,
    f: &Matrix<D>,
    size: f64,
) -> Result<(), TestCaseError> {
    let h = cofactor(f);
    let area = pair.reference.normalize() * (0.5 * size);
    let (cofactors, areas) = ([h, h], [area, -area]);
    let pair = Pair { current: f * pair.reference, cofactors, areas, ..*pair };
    prop_assert!(-pair.force().dot(&pair.velocity_jump) <= 0.0);
    prop_assert!(pair.pressure_jump * pair.volume_rate() <= 0.0);
    // They are zero only for a zero jump: n . H N = det F / |F N| does not vanish.
    let stretch = pair.current.norm() / pair.reference.norm();
    let expected = pair.pressure_jump.powi(2) / (2.0 * pair.impedance)
        * size
        * (determinant(f) / stretch).powi(2);
    let power = -pair.pressure_jump * pair.volume_rate();
    prop_assert!((power - expected).abs() <= 1e-12 * expected, "{} {}", power, expected);
    Ok(())
}

/// Derivatives with respect to everything that moves, by dual numbers and by differences.
fn check_derivatives<const D: usize>(
    pair: &Pair<D>,
    direction: &Vector<D>,
) -> Result<(), TestCaseError> {
    let moved = |step: f64| {
        let mut moved = *pair;
        moved.current += direction * step;
        moved.velocity_jump += direction * step;
        moved.impedance *= 1.0 + step;
        moved.pressure_jump *= 1.0 + 2.0 * step;
        moved.cofactors[0] += direction * direction.transpose() * step;
        moved.cofactors[1] -= direction * direction.transpose() * step;
        moved
    };
    let along =
        |x: &Vector<D>| SVector::<Dual64, D>::from_fn(|i, _| Dual64::new(x[i], direction[i]));
    let fixed = |x: &Vector<D>| x.map(Dual64::from);
    let along_square = |h: &Matrix<D>, sign: f64| {
        SMatrix::<Dual64, D, D>::from_fn(|i, j| {
            Dual64::new(h[(i, j)], sign * direction[i] * direction[j])
        })
    };
    let impedance = Dual64::new(pair.impedance, pair.impedance);
    let interface = Interface::new(along(&pair.current), fixed(&pair.reference), impedance);
    let force = interface.force(&along(&pair.velocity_jump), &fixed(&pair.area()));
    let areas = pair.areas.each_ref().map(fixed);
    let rate = interface.volume_rate(
        Dual64::new(pair.pressure_jump, 2.0 * pair.pressure_jump),
        [&along_square(&pair.cofactors[0], 1.0), &along_square(&pair.cofactors[1], -1.0)],
        areas.each_ref(),
    );
    // Separations of 0.1 m and more: third derivatives are below 1e4 times the sizes, so that
    // central differences of 1e-5 are good to 1e-6 of them; rounding is below that.
    let step = 1e-5;
    let sizes = pair.areas[0].norm() + pair.areas[1].norm();
    let size = pair.impedance * (pair.velocity_jump.norm() + 1.0) * sizes;
    let slope = (moved(step).force() - moved(-step).force()) / (2.0 * step);
    prop_assert!((force.map(|f| f.re) - pair.force()).norm() <= 1e-14 * size);
    prop_assert!((force.map(|f| f.eps) - slope).norm() <= 1e-5 * size);
    let size = pair.pressure_jump.abs() / pair.impedance * (sizes + 1.0);
    let slope = (moved(step).volume_rate() - moved(-step).volume_rate()) / (2.0 * step);
    prop_assert!((rate.re - pair.volume_rate()).abs() <= 1e-14 * size);
    prop_assert!((rate.eps - slope).abs() <= 1e-5 * size);
    Ok(())
}

proptest! {
    #[test]
    fn the_pair_laws_are_those_of_the_paper(a in pairs::<1>(), b in pairs::<2>(), c in pairs::<3>()) {
        check_definition(&a)?;
        check_definition(&b)?;
        check_definition(&c)?;
    }

    #[test]
    fn what_one_particle_receives_the_other_loses(
        a in pairs::<1>(), b in pairs::<2>(), c in pairs::<3>(),
    ) {
        check_exchange(&a)?;
        check_exchange(&b)?;
        check_exchange(&c)?;
    }

    #[test]
    fn both_dissipations_take_energy(
        (a, f) in (pairs::<1>(), deformations::<1>()),
        (b, g) in (pairs::<2>(), deformations::<2>()),
        (c, h) in (pairs::<3>(), deformations::<3>()),
        size in 0.01..10.0,
    ) {
        check_dissipation(&a, &f, size)?;
        check_dissipation(&b, &g, size)?;
        check_dissipation(&c, &h, size)?;
    }

    #[test]
    fn dual_numbers_give_the_derivatives(
        (a, u) in (pairs::<1>(), vectors::<1>(1.0)),
        (b, v) in (pairs::<2>(), vectors::<2>(1.0)),
        (c, w) in (pairs::<3>(), vectors::<3>(1.0)),
    ) {
        check_derivatives(&a, &u)?;
        check_derivatives(&b, &v)?;
        check_derivatives(&c, &w)?;
    }

    /// Averages plus dissipation are the star state between two waves: `p + z v` is carried from
    /// the left, `p - z v` from the right. In D dimensions it is that of the normal velocity.
    #[test]
    fn the_fluxes_are_those_of_the_exact_riemann_solution(
        (left, right) in ((-5.0..5.0, -1e5..1e5), (-5.0..5.0, -1e5..1e5)),
        z in 1e3..1e5, n in separations::<3>(), slide in vectors::<3>(10.0),
    ) {
        let ((v_left, p_left), (v_right, p_right)): ((f64, f64), (f64, f64)) = (left, right);
        let invariants = Matrix2::new(1.0, z, 1.0, -z);
        let carried = Vector2::new(p_left + z * v_left, p_right - z * v_right);
        let star = invariants.try_inverse().unwrap() * carried;
        let normal = n.normalize();
        let slide = slide - normal * normal.dot(&slide);
        let pair = Pair {
            current: n,
            reference: n,
            impedance: z,
            velocity_jump: normal * (v_right - v_left) + slide,
            pressure_jump: p_right - p_left,
            cofactors: [Matrix::identity(); 2],
            areas: [normal * 0.5, normal * -0.5],
        };
        // The left particle is pushed back by the pressure of the face, and grows with its speed.
        let pressure = 0.5 * (p_left + p_right) - normal.dot(&pair.force());
        let velocity = 0.5 * (v_left + v_right) + pair.volume_rate();
        let sizes = p_left.abs() + p_right.abs() + z * (v_left.abs() + v_right.abs());
        prop_assert!((pressure - star[0]).abs() < 1e-13 * sizes, "{} {}", pressure, star[0]);
        prop_assert!((velocity - star[1]).abs() * z < 1e-13 * sizes, "{} {}", velocity, star[1]);
        prop_assert!(pair.force().cross(&normal).norm() < 1e-13 * (sizes + z * slide.norm()));
    }

    /// No wave is faster than the bound of the time step, and one is as fast: eigenvalues of the
    /// acoustic tensor `d(P N)/dF : (a (x) N)`, whose derivative dual numbers take.
    #[test]
    fn the_referential_wave_speed_is_the_largest_of_all_directions(
        f in deformations::<3>(), directions in prop::collection::vec(separations::<3>(), 8),
    ) {
        let law = VolumetricLaw::gamma_law_from_wave_speed(10.0, 1000.0, 7.0).unwrap();
        let (j, smallest) = (determinant(&f), smallest_eigenvalue(&right_cauchy_green(&f)));
        let acoustic = law.wave_speed(j, 1000.0);
        let bound = referential_wave_speed(acoustic, j, smallest);
        for direction in &directions {
            let speed = wave_speed(&law, &f, &direction.normalize());
            prop_assert!(speed <= bound * (1.0 + 1e-9), "{} above {}", speed, bound);
        }
        let decomposition = nalgebra::SymmetricEigen::new(right_cauchy_green(&f));
        let slowest = decomposition.eigenvalues.imin();
        let worst = decomposition.eigenvectors.column(slowest).into_owned();
        let speed = wave_speed(&law, &f, &worst);
        prop_assert!((speed - bound).abs() < 1e-7 * bound, "{} instead of {}", speed, bound);
        // Without the factor J it is the speed of Upwind (3.57).
        let stretched = stretched_wave_speed(acoustic, smallest);
        prop_assert!((stretched * j - bound).abs() < 1e-13 * bound);
    }
}

/// Fastest wave along `normal` through a body of density 1000 with deformation gradient `f`.
fn wave_speed(law: &VolumetricLaw, f: &Matrix<3>, normal: &Vector<3>) -> f64 {
    let column = |k: usize| {
        let moved = SMatrix::<Dual64, 3, 3>::from_fn(|i, j| {
            Dual64::new(f[(i, j)], if i == k { normal[j] } else { 0.0 })
        });
        let pressure = law.pressure(determinant(&moved));
        let stress = cofactor(&moved).map(|h| -pressure * h);
        Vector::<3>::from_fn(|i, _| (0..3).map(|j| stress[(i, j)].eps * normal[j]).sum())
    };
    let acoustic = Matrix::from_columns(&[column(0), column(1), column(2)]);
    (largest_eigenvalue(&acoustic) / 1000.0).sqrt()
}
