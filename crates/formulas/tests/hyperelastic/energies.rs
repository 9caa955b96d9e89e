//! Strain energies that are written out.

use nalgebra::Matrix3;
use num_dual::Dual64;
use piola_formulas::hyperelastic::{
    EnergyFunction, HyperelasticLaw, HyperelasticResponse, Instruction, Invariant,
};
use proptest::prelude::*;

use super::{close, constants, gradients, modulus};

/// Energies with a shear and a bulk modulus of small strains in Pa.
pub fn samples(mu: f64, kappa: f64) -> Vec<HyperelasticLaw> {
    vec![
        energy(&rivlin(0.3 * mu, 0.2 * mu), kappa),
        energy(&gent(mu), kappa),
        energy(&compressible(mu), kappa - 2.0 / 3.0 * mu),
        energy(&powers(mu), kappa),
    ]
}

/// `of` and `factor/2 (J - 1)^2`.
fn energy(of: &[Instruction], factor: f64) -> HyperelasticLaw {
    use Instruction::*;
    let volume = [Of(Invariant::Volume), Number(1.0), Subtract, Power(2.0)];
    let all = [of, &volume, &[Number(0.5 * factor), Multiply, Add]].concat();
    HyperelasticLaw::Energy(EnergyFunction::new(all).expect("an energy with a minimum at rest"))
}

/// `c10 (I1b - 3) + c01 (I2b - 3)`, the constant left in.
fn rivlin(c10: f64, c01: f64) -> [Instruction; 7] {
    use Instruction::*;
    let first = [Number(c10), Of(Invariant::FirstIsochoric), Multiply];
    let second = [Number(c01), Of(Invariant::SecondIsochoric), Multiply];
    let [a, b, c] = first;
    let [d, e, f] = second;
    [a, b, c, d, e, f, Add]
}

/// Gent's rubber `-mu/2 J_m ln(1 - (I1b - 3)/J_m)`, whose chains end at `J_m = 90`.
fn gent(mu: f64) -> Vec<Instruction> {
    use Instruction::*;
    let stretch = [Of(Invariant::FirstIsochoric), Number(3.0), Subtract];
    let rest = [Number(90.0), Divide, Negate, Number(1.0), Add, Logarithm];
    [&stretch[..], &rest, &[Number(-45.0 * mu), Multiply]].concat()
}

/// `mu/2 (I1 - 3 - 2 ln J)`, as a product with roots and exponentials that leave it as it is.
fn compressible(mu: f64) -> Vec<Instruction> {
    use Instruction::*;
    let root = [Of(Invariant::First), Power(2.0), Root];
    let log = [Of(Invariant::Volume), Logarithm, Exponential, Logarithm];
    let both = [Number(2.0), Multiply, Subtract, Number(0.5 * mu), Multiply];
    [&root[..], &log, &both].concat()
}

/// `mu/2 (I1b - 3)` and what small strains do not see: powers of it, whole and not, and `(I1 I2/9 - 1)^2` over `J + 1`.
fn powers(mu: f64) -> Vec<Instruction> {
    use Instruction::*;
    let stretch = [Of(Invariant::FirstIsochoric), Number(3.0), Subtract];
    let mut all = [&stretch[..], &[Number(0.5 * mu), Multiply]].concat();
    for exponent in [0.0, 1.5, 2.5, 3.0, 4.0, 4.5] {
        all.extend(stretch);
        all.extend([Power(exponent), Number(0.01 * mu), Multiply, Add]);
    }
    let product = [Of(Invariant::First), Of(Invariant::Second), Multiply, Number(9.0), Divide];
    all.extend(product);
    let quotient = [Number(1.0), Subtract, Power(4.0), Of(Invariant::Volume), Number(1.0), Add];
    all.extend(quotient);
    all.extend([Divide, Number(0.01 * mu), Multiply, Add]);
    all
}

/// Round-off makes `I1b - 3` negative, of which there is no power that is not whole.
#[test]
fn powers_that_are_not_whole_are_finite_at_rest() {
    let law = energy(&powers(constants().mu), constants().bulk_modulus());
    for scale in [0.0, 1e-12, 1e-9, 1e-7, 1e-4] {
        for seed in 0..50 {
            let entry = |k: usize| scale * (f64::from(seed) * 1.7 + k as f64 * 2.3).sin();
            let a = Matrix3::from_fn(|i, j| Dual64::from_re(entry(3 * i + j)).derivative());
            let stress = law.stress(&a);
            assert!(stress.iter().all(|x| x.re.is_finite() && x.eps.is_finite()), "{a} {stress}");
        }
    }
}

/// What is negative by more than round-off has no such power: the run says so instead of going on without it.
#[test]
fn powers_of_what_is_negative_are_none() {
    use Instruction::*;
    let volume = [Of(Invariant::Volume), Number(1.0), Subtract, Power(2.5), Add];
    let law = [&rivlin(1e5, 1e5)[..], &volume].concat();
    let law = energy(&law, 1e6);
    let pressed: f64 = law.energy(&(Matrix3::identity() * -0.01));
    let pulled: f64 = law.energy(&(Matrix3::identity() * 0.01));
    assert!(pressed.is_nan() && pulled > 0.0, "{pressed} {pulled}");
}

#[test]
fn energies_that_are_none_are_refused() {
    use Instruction::*;
    let first = Of(Invariant::First);
    for (instructions, part) in [
        (vec![], "leaves 0 numbers"),
        (vec![first, first], "leaves 2 numbers"),
        (vec![first, Add], "nothing to work on"),
        (vec![first; 25], "more than 24"),
        (vec![Number(1.0), first, Multiply], "a stress of 2 Pa at rest"),
        (vec![Number(-1.0), first, Add, Number(4.0), Subtract, Logarithm], "NaN"),
        (vec![first, Number(3.0), Subtract, Power(2.0)], "shear"),
    ] {
        let error = EnergyFunction::new(instructions).unwrap_err().to_string();
        assert!(error.contains(part), "{error}");
    }
}

proptest! {
    #[test]
    fn an_energy_is_the_law_that_it_writes_out(a in gradients(), share in 0.1..0.9_f64) {
        let (mu, kappa) = (constants().mu, constants().bulk_modulus());
        let (c10, c01) = (0.5 * share * mu, 0.5 * (1.0 - share) * mu);
        let law = HyperelasticLaw::mooney_rivlin(c10, c01, kappa).unwrap();
        let written = energy(&rivlin(c10, c01), kappa);
        close(law.energy(&a), written.energy(&a), 1e-14 * modulus())?;
        let (p, q): (Matrix3<f64>, Matrix3<f64>) = (law.stress(&a), written.stress(&a));
        prop_assert!((p - q).amax() < 1e-13 * modulus(), "{p} {q}");
        let small = written.small_strain();
        close(small.mu, mu, 1e-12 * mu)?;
        close(small.bulk_modulus(), kappa, 1e-12 * kappa)?;
    }
}
