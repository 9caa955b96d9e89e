//! Laws at many displacement gradients.

use nalgebra::SMatrix;
use piola_formulas::hyperelastic::{HyperelasticLaw, Reduced};
use piola_formulas::volumetric::StressState;

use super::all_samples;

/// Gradients of which one is zero, one of equal stretches, and one turned inside out.
fn gradients<const D: usize>() -> Vec<SMatrix<f64, D, D>> {
    let own = |k: usize| match k {
        3 => SMatrix::zeros(),
        4 => SMatrix::identity() * 0.2,
        6 => SMatrix::identity() * -1.5,
        _ => SMatrix::from_fn(|i, j| 0.3 * ((5 * k + 3 * i + 7 * j) as f64).sin()),
    };
    (0..11).map(own).collect()
}

fn check<const D: usize>(law: &HyperelasticLaw, state: StressState) {
    let law = Reduced::<D>::new(law.clone(), state).expect("the state fits");
    let (all, share) = (gradients::<D>(), 0.7);
    for count in [0, 1, 3, 4, 11] {
        let (mut stresses, mut moduli) =
            (vec![SMatrix::repeat(1.5); count], vec![[0.25; 2]; count]);
        law.add_stresses(share, &all[..count], &mut stresses);
        law.add_wave_moduli(share, &all[..count], &mut moduli);
        for ((gradient, stress), moduli) in all.iter().zip(&stresses).zip(&moduli) {
            let own = law.stress(gradient).map(|entry| 1.5 + entry * share);
            let own_moduli = law.wave_moduli(gradient).map(|modulus| 0.25 + modulus * share);
            let both = own.iter().zip(stress).chain(own_moduli.iter().zip(moduli));
            for (one, many) in both {
                let is_same = one.to_bits() == many.to_bits() || one.is_nan() && many.is_nan();
                assert!(is_same, "{one} and {many}: {law:?} at {gradient}");
            }
        }
    }
}

#[test]
fn many_are_to_the_bit_what_one_by_one_is() {
    for law in &all_samples() {
        for state in StressState::ALL {
            match state.dimension() {
                1 => check::<1>(law, state),
                2 => check::<2>(law, state),
                _ => check::<3>(law, state),
            }
        }
    }
}
