//! Laws at many displacement gradients, four at a time in vector registers.

use multiversion::multiversion;
use nalgebra::SMatrix;

use super::Reduced;
use crate::{Lanes as _, WIDTH, tensor};

impl<const D: usize> Reduced<D> {
    /// Adds a share of the [stress](Self::stress) of each displacement gradient, to the bit as one by one.
    pub fn add_stresses(
        &self,
        share: f64,
        gradients: &[SMatrix<f64, D, D>],
        stresses: &mut [SMatrix<f64, D, D>],
    ) {
        match self.is_held() {
            true => add_held_stresses(self, share, gradients, stresses),
            false => {
                let both = gradients.iter().zip(stresses);
                both.for_each(|(gradient, sum)| *sum += self.stress(gradient) * share);
            }
        }
    }

    /// Adds a share of the [wave moduli](Self::wave_moduli) at each displacement gradient, to the bit as one by one.
    pub fn add_wave_moduli(
        &self,
        share: f64,
        gradients: &[SMatrix<f64, D, D>],
        moduli: &mut [[f64; 2]],
    ) {
        match self.is_held() {
            true => add_held_wave_moduli(self, share, gradients, moduli),
            false => {
                for (gradient, sums) in gradients.iter().zip(moduli) {
                    let own = self.wave_moduli(gradient);
                    sums.iter_mut().zip(own).for_each(|(sum, own)| *sum += share * own);
                }
            }
        }
    }
}

#[multiversion(targets("x86_64+avx2"))]
fn add_held_stresses<const D: usize>(
    law: &Reduced<D>,
    share: f64,
    gradients: &[SMatrix<f64, D, D>],
    stresses: &mut [SMatrix<f64, D, D>],
) {
    for (gradients, sums) in gradients.chunks(WIDTH).zip(stresses.chunks_mut(WIDTH)) {
        let stress =
            law.held_stress(&tensor::lanes(gradients)).map(|entry| (entry * share).store());
        for (k, sum) in sums.iter_mut().enumerate() {
            *sum += stress.map(|entry| entry[k]);
        }
    }
}

#[multiversion(targets("x86_64+avx2"))]
fn add_held_wave_moduli<const D: usize>(
    law: &Reduced<D>,
    share: f64,
    gradients: &[SMatrix<f64, D, D>],
    moduli: &mut [[f64; 2]],
) {
    for (gradients, sums) in gradients.chunks(WIDTH).zip(moduli.chunks_mut(WIDTH)) {
        let own = law
            .held_wave_moduli(&tensor::lanes(gradients))
            .map(|modulus| (modulus * share).store());
        for (k, [least, most]) in sums.iter_mut().enumerate() {
            *least += own[0][k];
            *most += own[1][k];
        }
    }
}
