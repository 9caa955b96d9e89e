//! What formulations of elastic solids have in common: central differences, fields and wave speeds of a
//! deformation.

use nalgebra::Matrix3;
use piola_formulas::hyperelastic::{HyperelasticLaw, HyperelasticResponse, Reduced};
use piola_formulas::tensor;

use crate::boundaries::prescribed::PrescribedComponents;
use crate::solve::largest_mode;
use crate::{Tensor, Vector, parallel};

/// The material of one body.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Material<const D: usize> {
    /// Density in kg/m^3. In 1D and 2D masses, forces and energies are those of a body of 1 m in
    /// each of the missing dimensions.
    pub density: f64,
    /// Strain energy, with what holds the missing dimensions.
    pub law: Reduced<D>,
}

/// Half a step of velocities with the accelerations of `kick`.
pub(crate) fn kick<const D: usize>(velocity: &mut [Vector<D>], kick: &[Vector<D>], duration: f64) {
    parallel::for_each_chunk(velocity, |first, velocity| {
        for (velocity, kick) in velocity.iter_mut().zip(&kick[first..]) {
            *velocity += kick * duration;
        }
    });
}

/// Keeps accelerations for kicks, those of prescribed components zero.
pub(crate) fn keep_accelerations<const D: usize>(
    kick: &mut [Vector<D>],
    acceleration: &[Vector<D>],
    prescribed: &PrescribedComponents,
) {
    parallel::copy(kick, acceleration);
    prescribed.iter().for_each(|entry| kick[entry.particle][entry.component] = 0.0);
}

/// A step of displacements with velocities half way.
pub(crate) fn drift<const D: usize>(
    displacement: &mut [Vector<D>],
    velocity: &[Vector<D>],
    prescribed: &PrescribedComponents,
    time: f64,
    step: f64,
) {
    parallel::for_each_chunk(displacement, |first, displacement| {
        for (displacement, velocity) in displacement.iter_mut().zip(&velocity[first..]) {
            *displacement += velocity * step;
        }
    });
    // Kicks leave a prescribed velocity alone; it moves its particle by its value half way.
    for entry in prescribed.iter() {
        let (a, component) = (entry.particle, entry.component);
        let middle = entry.value.value(entry.place, time + 0.5 * step);
        displacement[a][component] += step * (middle - velocity[a][component]);
    }
}

/// The largest eigenvalue of `M^-1/2 K M^-1/2` on the components that are free, in 1/s^2, and the particle
/// that moves most in its mode: `apply` writes `-K u` of a field u.
pub(crate) fn fastest_mode<const D: usize>(
    mass: &[f64],
    is_free: impl Fn(usize, usize) -> bool,
    mut apply: impl FnMut(&[Vector<D>], &mut [Vector<D>]),
) -> (f64, usize) {
    let mut field = vec![Vector::zeros(); mass.len()];
    let mut force = field.clone();
    let mode = largest_mode(mass.len() * D, |direction, product| {
        for (a, (field, mass)) in field.iter_mut().zip(mass).enumerate() {
            let of = |i: usize| direction[a * D + i] / mass.sqrt();
            *field = Vector::from_fn(|i, _| if is_free(a, i) { of(i) } else { 0.0 });
        }
        apply(&field, &mut force);
        for (a, (product, mass)) in product.chunks_exact_mut(D).zip(mass).enumerate() {
            for (i, product) in product.iter_mut().enumerate() {
                *product = if is_free(a, i) { -force[a][i] / mass.sqrt() } else { 0.0 };
            }
        }
    });
    let speed = |a: usize| {
        mode.vector[a * D..][..D].iter().map(|entry| entry * entry).sum::<f64>() / mass[a]
    };
    let fastest = |best: usize, a: usize| if speed(a) > speed(best) { a } else { best };
    (parallel::larger(0.0, mode.value), (0..mass.len()).fold(0, fastest))
}

/// Smallest and largest eigenvalue of the acoustic tensors `N . dP/dF . N` in the principal directions
/// N of the deformation, Pa. Where the smallest is negative the law has lost its convexity there, and
/// no wave travels.
pub(crate) fn wave_moduli<const D: usize>(
    law: &Reduced<D>,
    displacement_gradient: &Tensor<D>,
) -> [f64; 2] {
    if let (HyperelasticLaw::NeoHookeanLogarithmic(own), false) =
        (law.law(), law.state().is_free_across())
    {
        return own.wave_moduli(displacement_gradient);
    }
    let tangent = law.tangent(displacement_gradient);
    let strain = tensor::right_cauchy_green(&(displacement_gradient + Tensor::identity()));
    let mut moduli = [f64::INFINITY, 0.0_f64];
    for n in principal_directions(&strain) {
        let acoustic = Tensor::<D>::from_fn(|i, k| {
            (0..D * D)
                .map(|m| (m / D, m % D))
                .map(|(j, l)| n[j] * n[l] * tangent[k][l][(i, j)])
                .sum()
        });
        moduli[0] = moduli[0].min(tensor::smallest_eigenvalue(&acoustic));
        moduli[1] = moduli[1].max(tensor::largest_eigenvalue(&acoustic));
    }
    moduli
}

/// Principal directions of a symmetric tensor; the axes where they cannot be found.
fn principal_directions<const D: usize>(tensor: &Tensor<D>) -> [Vector<D>; D] {
    // The directions that are not resolved get an eigenvalue apart from all others.
    let apart = 2.0 * (tensor.trace() + 1.0);
    let mut padded = Matrix3::<f64>::identity() * apart;
    padded.view_mut((0, 0), (D, D)).copy_from(tensor);
    let Some(eigen) = nalgebra::SymmetricEigen::try_new(padded, f64::EPSILON, 1000) else {
        return std::array::from_fn(|axis| Vector::from_fn(|i, _| f64::from(u8::from(i == axis))));
    };
    let mut all = [Vector::zeros(); D];
    let mut found = 0;
    for column in eigen.eigenvectors.column_iter() {
        let resolved = Vector::<D>::from_fn(|i, _| column[i]);
        if resolved.norm() > 0.5 && found < D {
            all[found] = resolved;
            found += 1;
        }
    }
    all
}

/// Appends a tensor as fields have it, row by row.
pub(crate) fn append_rows<const D: usize>(tensor: &Tensor<D>, values: &mut Vec<f64>) {
    // nalgebra stores columns.
    values.extend((0..D * D).map(|k| tensor[(k / D, k % D)]));
}

/// What a law makes of a displacement gradient.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Measure {
    DeformationGradient,
    Determinant,
    Stress,
    CauchyStress,
    VonMises,
}

/// Appends what a law makes of a displacement gradient.
pub(crate) fn append_measure<const D: usize>(
    law: &Reduced<D>,
    gradient: &Tensor<D>,
    measure: Measure,
    values: &mut Vec<f64>,
) {
    let deformation = gradient + Tensor::identity();
    let cauchy = || {
        let all = law.in_three(gradient);
        let (stress, f): (Matrix3<f64>, _) = (law.law().stress(&all), all + Matrix3::identity());
        stress * f.transpose() / tensor::determinant(&f)
    };
    match measure {
        Measure::DeformationGradient => append_rows(&deformation, values),
        Measure::Stress => append_rows(&law.stress(gradient), values),
        Measure::CauchyStress => {
            let cauchy = cauchy();
            append_rows(&Tensor::<D>::from_fn(|i, j| cauchy[(i, j)]), values);
        }
        Measure::Determinant => values.push(tensor::determinant(&deformation)),
        Measure::VonMises => {
            let cauchy = cauchy();
            let deviator = cauchy - Matrix3::identity() * (cauchy.trace() / 3.0);
            values.push((1.5 * deviator.norm_squared()).sqrt());
        }
    }
}
