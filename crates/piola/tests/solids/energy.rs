//! Forces and stiffness as exact derivatives of the discrete energy.

use nalgebra::SVector;
use num_dual::{Dual64, HyperDual64};
use piola::operators::DualGradient;
use piola::schemes::total_lagrangian::{Discrete, Gradients, Material, Settings, Stiffness};
use piola::solve::Tangent;
use piola::{Tensor, Vector};
use piola_formulas::Scalar;
use piola_formulas::hyperelastic::{HyperelasticLaw, LameConstants, Reduced};
use piola_formulas::volumetric::StressState;

use crate::clouds::{Cloud, disorder, some_gradient};
use crate::scalar::ScalarHourglass;
use crate::support::noise;

const DENSITY: f64 = 1000.0;

fn laws() -> [HyperelasticLaw; 5] {
    let constants = LameConstants::from_young(1e6, 0.3).expect("parameters in range");
    let (mu, kappa) = (constants.mu, constants.bulk_modulus());
    [
        HyperelasticLaw::linear_elastic(constants),
        HyperelasticLaw::saint_venant_kirchhoff(constants),
        HyperelasticLaw::neo_hookean(constants),
        HyperelasticLaw::neo_hookean_logarithmic(constants),
        HyperelasticLaw::ogden(&[(mu / 3.0, 3.0), (-mu, -1.0)], kappa).expect("in range"),
    ]
}

fn discrete<const D: usize>(
    cloud: &Cloud<D>,
    law: HyperelasticLaw,
    state: StressState,
    (patch, hourglass): (bool, f64),
) -> Discrete<D> {
    let gradients = match patch {
        true => Gradients::PatchConsistent { areas: cloud.areas.clone() },
        false => Gradients::Plain,
    };
    let law = Reduced::new(law, state).expect("the state fits");
    let settings = Settings { gradients, hourglass, ..Settings::default() };
    let materials = vec![Material { density: DENSITY, law }];
    Discrete::new(cloud.particles.clone(), cloud.support(), &settings, materials)
        .expect("the body exists")
}

fn forces<const D: usize>(body: &Discrete<D>, displacement: &[Vector<D>]) -> Vec<Vector<D>> {
    let mut strained = body.operator.strained();
    let mut force = vec![Vector::zeros(); body.len()];
    body.internal_forces(displacement, &mut strained, &mut force);
    force
}

/// Displacements as dual numbers of some type, `seed` being applied to each component.
fn seeded<T: Scalar, const D: usize>(
    displacement: &[Vector<D>],
    seed: impl Fn(usize, usize, T) -> T,
) -> Vec<SVector<T, D>> {
    let vector = |(a, u): (usize, &Vector<D>)| SVector::from_fn(|i, _| seed(a, i, T::from(u[i])));
    displacement.iter().enumerate().map(vector).collect()
}

fn sum<T: Scalar>([strain, hourglass]: [T; 2]) -> T {
    strain + hourglass
}

fn check_force<const D: usize>(cloud: &Cloud<D>, state: StressState) {
    for law in laws() {
        for choice in [(false, 0.0), (false, 1.0), (true, 0.1)] {
            let body = discrete(cloud, law.clone(), state, choice);
            let displacement = disorder(&cloud.particles, 0.05);
            let force = forces(&body, &displacement);
            let scale = force.iter().map(Vector::amax).fold(0.0, f64::max);
            for (a, force) in force.iter().enumerate() {
                for (i, force) in force.iter().enumerate() {
                    let along = |b, j, u: Dual64| if (b, j) == (a, i) { u.derivative() } else { u };
                    let energy = sum(body.total_energy(&seeded(&displacement, along)));
                    let error = (force + energy.eps).abs() / scale;
                    assert!(error < 1e-12, "{law:?} {choice:?} {a} {i}: {error:e}");
                }
            }
        }
    }
}

#[test]
fn forces_are_the_negative_gradient_of_the_energy() {
    check_force(&Cloud::simplices([1.0], [12], 0.3), StressState::UniaxialStress);
    check_force(&Cloud::simplices([1.0, 1.0], [5, 5], 0.25), StressState::PlaneStrain);
    check_force(&Cloud::simplices([1.0, 1.0], [4, 4], 0.25), StressState::PlaneStress);
    check_force(&Cloud::simplices([1.0; 3], [2; 3], 0.15), StressState::ThreeDimensional);
}

#[test]
fn the_stiffness_is_the_second_derivative_of_the_energy() {
    let cloud = Cloud::simplices([1.0, 1.0], [5, 5], 0.25);
    for law in laws() {
        let body = discrete(&cloud, law.clone(), StressState::PlaneStrain, (true, 0.1));
        let displacement = disorder(&cloud.particles, 0.05);
        let direction = |shift: usize| -> Vec<Vector<2>> {
            let vector = |a: usize| Vector::from_fn(|i, _| noise(shift + 2 * a + i));
            (0..body.len()).map(vector).collect()
        };
        let (first, second) = (direction(0), direction(5000));
        let dot = |a: &[Vector<2>], b: &[Vector<2>]| -> f64 {
            a.iter().zip(b).map(|(a, b)| a.dot(b)).sum()
        };
        let mut stiffness = Stiffness::new(body.clone().into());
        stiffness.load(&displacement, &[]);
        let mut between = |one: &[Vector<2>], other: &[Vector<2>]| {
            let mut product = vec![Vector::zeros(); body.len()];
            stiffness.apply(one, &mut product);
            dot(other, &product)
        };
        let (product, other) = (between(&first, &second), between(&second, &first));
        let along = |a: usize, i: usize, u: HyperDual64| {
            HyperDual64::new(u.re, first[a][i], second[a][i], 0.0)
        };
        let energy = sum(body.total_energy(&seeded(&displacement, along)));
        let bound = 1e-12 * between(&first, &first).abs();
        assert!((product - other).abs() < bound, "{law:?}: {product} {other}");
        assert!((product - energy.eps1eps2).abs() < bound, "{law:?}: {product} {energy}");
    }
}

/// Dual-support (21), last line: with plain gradients the sum of squares has a closed form.
#[test]
fn hourglass_energy_is_that_of_the_source_and_positive() {
    let cloud = Cloud::simplices([1.0, 1.0], [7, 7], 0.25);
    let law = laws()[3].clone();
    let body = discrete(&cloud, law.clone(), StressState::PlaneStrain, (false, 2.0));
    let support = cloud.support();
    let displacement = disorder(&cloud.particles, 0.2);
    let mu = law.small_strain().mu;
    for a in 0..body.len() {
        let mut moment = Tensor::<2>::zeros();
        let mut squares = 0.0;
        for &b in support.list.row(a) {
            let x = support.separation(&cloud.particles.position, a, b);
            let current = x + displacement[b as usize] - displacement[a];
            let h = support.smoothing_length(a);
            let slope = support.kernel.derivative_over_r(2, x.norm(), h);
            let weight = cloud.particles.weight[b as usize] * slope;
            moment += x * x.transpose() * weight;
            squares += weight * current.norm_squared();
        }
        let f = body.displacement_gradient(&displacement, a) + Tensor::<2>::identity();
        let closed = mu / moment.trace() * (squares - f.dot(&(f * moment)));
        let [_, energy] = body.energy_of(&displacement, a);
        let expected = 2.0 * closed * cloud.particles.volume[a];
        assert!(energy > 0.0 && (energy / expected - 1.0).abs() < 1e-10, "{energy} {expected}");
    }
}

/// The patch test: a constant stress is in equilibrium with its tractions on any cloud.
fn check_patch<const D: usize>(cloud: &Cloud<D>, state: StressState) {
    for law in laws() {
        for (patch, hourglass) in [(true, 0.0), (true, 0.1), (false, 0.1)] {
            let body = discrete(cloud, law.clone(), state, (patch, hourglass));
            let slope = some_gradient::<D>();
            let places = &cloud.particles.position;
            let displacement: Vec<Vector<D>> = places.iter().map(|x| slope * x).collect();
            let stress = Reduced::<D>::new(law.clone(), state).unwrap().stress(&slope);
            let tractions = || cloud.areas.iter().map(|area| stress * area);
            let force = forces(&body, &displacement);
            let scale = tractions().map(|t| t.amax()).fold(0.0, f64::max);
            let left = force.iter().zip(tractions()).map(|(f, t)| (f + t).amax());
            let left = left.fold(0.0, f64::max) / scale;
            assert_eq!(left < 1e-8, patch, "{law:?} {hourglass}: {left:e}");
            let [strain, deviating] = body.total_energy(&displacement);
            assert!(deviating.abs() < 1e-20 * strain, "{deviating} of {strain}");
        }
    }
}

#[test]
fn constant_stress_is_in_equilibrium_on_any_cloud() {
    check_patch(&Cloud::simplices([2.0], [24], 0.3), StressState::UniaxialStrain);
    check_patch(&Cloud::simplices([2.0, 1.0], [14, 7], 0.25), StressState::PlaneStrain);
    check_patch(&Cloud::simplices([2.0, 1.0], [14, 7], 0.25), StressState::PlaneStress);
    check_patch(&Cloud::simplices([1.0; 3], [5; 3], 0.2), StressState::ThreeDimensional);
}

/// Forces neither push nor turn a body as a whole, whatever the supports.
#[test]
fn forces_have_no_sum_and_no_moment() {
    let cloud = Cloud::simplices([1.0; 3], [4; 3], 0.2);
    for law in laws() {
        for choice in [(false, 1.0), (true, 0.1)] {
            let body = discrete(&cloud, law.clone(), StressState::ThreeDimensional, choice);
            let displacement = disorder(&cloud.particles, 0.05);
            let force = forces(&body, &displacement);
            let total: f64 = force.iter().map(Vector::norm).sum();
            let sum: Vector<3> = force.iter().sum();
            assert!(sum.norm() < 1e-14 * total, "{law:?}: {sum}");
            let places = cloud.particles.position.iter().zip(&displacement).map(|(x, u)| x + u);
            let moment: Vector<3> = places.zip(&force).map(|(x, f)| x.cross(f)).sum();
            assert_eq!(moment.norm() < 1e-13 * total, law.is_objective(), "{law:?}: {moment}");
        }
    }
}

fn check_scalar<const D: usize>(cloud: &Cloud<D>) {
    let (particles, support) = (&cloud.particles, cloud.support());
    let plain = DualGradient::plain(particles, &support).expect("a gradient");
    let patch = plain.clone().patch_consistent(particles, &support, &cloud.areas);
    let count = particles.len();
    let coefficients: Vec<f64> = particles.volume.iter().map(|volume| 3.0 * volume).collect();
    for gradient in [plain, patch.expect("a correction")] {
        let operator = ScalarHourglass {
            particles,
            support: &support,
            gradient: &gradient,
            coefficients: &coefficients,
        };
        let field = |seed: usize| -> Vec<f64> { (0..count).map(|a| noise(seed + a)).collect() };
        let (one, way) = (field(7), field(9000));
        let force = operator.force(&one);
        let along: f64 = force.iter().zip(&way).map(|(force, way)| force * way).sum();
        let moved = |sign: f64| -> Vec<f64> {
            one.iter().zip(&way).map(|(one, way)| one + sign * way).collect()
        };
        // The energy is quadratic, so that this difference is its slope however far apart.
        let slope = 0.5 * (operator.energy(&moved(1.0)) - operator.energy(&moved(-1.0)));
        assert!((along + slope).abs() < 1e-12 * operator.energy(&one), "{along} {slope}");
        let sum: f64 = force.iter().sum();
        let size = force.iter().fold(0.0_f64, |size, force| size.max(force.abs()));
        assert!(sum.abs() < 1e-12 * size, "{sum}");
        let linear: Vec<f64> =
            particles.position.iter().map(|x| 2.0 + x.iter().sum::<f64>()).collect();
        assert!(
            operator.energy(&linear) < 1e-24
                && operator.force(&linear).iter().all(|f| f.abs() < 1e-12)
        );
    }
}

#[test]
fn the_hourglass_force_of_a_scalar_is_the_slope_of_its_energy() {
    check_scalar(&Cloud::simplices([1.0, 0.5], [8, 4], 0.2));
    check_scalar(&Cloud::simplices([1.0; 3], [4; 3], 0.15));
}

/// Component by component it is the hourglass energy of a displacement.
#[test]
fn the_hourglass_energy_of_a_vector_is_that_of_its_components() {
    let cloud = Cloud::simplices([1.0; 3], [4; 3], 0.15);
    let law = laws()[0].clone();
    let body = discrete(&cloud, law.clone(), StressState::ThreeDimensional, (false, 0.3));
    let displacement = disorder(&cloud.particles, 0.05);
    let support = cloud.support();
    let gradient = DualGradient::plain(&cloud.particles, &support).expect("a gradient");
    let mu = law.small_strain().mu;
    let coefficients: Vec<f64> =
        cloud.particles.volume.iter().map(|volume| 0.3 * mu * volume).collect();
    let operator = ScalarHourglass {
        particles: &cloud.particles,
        support: &support,
        gradient: &gradient,
        coefficients: &coefficients,
    };
    let component = |i: usize| -> Vec<f64> { displacement.iter().map(|u| u[i]).collect() };
    let parts: f64 = (0..3).map(|i| operator.energy(&component(i))).sum();
    let [_, whole] = body.total_energy(&displacement);
    assert!((parts / whole - 1.0).abs() < 1e-12, "{parts} {whole}");
}
