use std::cell::{Cell, RefCell};

use piola_device::{Law, Operations, Traced, filled, flat, laws};
use piola_formulas::Number;
use piola_formulas::hyperelastic::HyperelasticResponse;
use piola_formulas::kernels::Kernel;
use piola_formulas::pairs::corrected::{CorrectedRateSum, GradientSide, GradientSum};
use piola_formulas::pairs::fluid::RateSum;
use piola_formulas::pairs::{Components, Of, Record};
use piola_formulas::volumetric::VolumetricResponse;

use super::{assert_bits, random};

/// Compares a law with a function in plain numbers.
fn compare(law: &Law, inputs: &[f64], expected: &[f64]) {
    assert_bits(&law.name, &law.run(inputs), expected, inputs);
}

#[test]
fn kernels_have_the_bits_of_the_processor() {
    for kernel in Kernel::ALL.iter().copied() {
        for dimension in 1..=3 {
            let law = laws::kernel(kernel, dimension, 0.7);
            for k in 0..=4000 {
                let r = 0.7 * 3.2 * f64::from(k) / 4000.0;
                let value = kernel.value(dimension, r, 0.7);
                compare(&law, &[r], &[value, kernel.derivative_over_r(dimension, r, 0.7)]);
            }
        }
    }
}

#[test]
fn stresses_have_the_bits_of_the_processor() {
    let mut random = random(1);
    for solid in laws::solids() {
        let law = laws::stress(&solid);
        for size in [1e-9, 1e-3, 0.3] {
            for _ in 0..200 {
                let a: Vec<f64> = (0..9).map(|_| size * (2.0 * random() - 1.0)).collect();
                let stress = solid.stress(&laws::matrix(&a));
                let expected: Vec<f64> = (0..9).map(|k| stress[(k / 3, k % 3)]).collect();
                compare(&law, &a, &expected);
            }
        }
    }
}

#[test]
fn volumetric_materials_have_the_bits_of_the_processor() {
    for material in laws::materials() {
        let law = laws::volumetric(&material);
        for k in 0..=2000 {
            // With ratios near 1, where a series takes over.
            let ratio =
                if k % 2 == 0 { 0.2 + 1e-3 * f64::from(k) } else { 1.0 + 1e-5 * f64::from(k) };
            let expected = [
                VolumetricResponse::energy(&material, ratio),
                material.pressure(ratio),
                material.tangent(ratio),
            ];
            compare(&law, &[ratio], &expected);
        }
    }
}

#[test]
fn the_return_to_the_yield_surface_has_the_bits_of_the_processor() {
    let mut random = random(2);
    for (name, strength) in laws::strengths() {
        let law = laws::return_to_surface(name, &strength, laws::SHEAR_MODULUS);
        for _ in 0..2000 {
            let inputs = [2e9 * random(), random(), 250.0 + 1200.0 * random(), 1e-8];
            let expected = laws::returned(&strength, laws::SHEAR_MODULUS, &inputs);
            let expected: Vec<f64> = expected.into_iter().map(|(_, value)| value).collect();
            compare(&law, &inputs, &expected);
        }
    }
}

#[test]
fn equations_of_state_have_the_bits_of_the_processor() {
    let mut random = random(3);
    for (name, equation) in laws::equations_of_state() {
        let law = laws::equation_of_state(name, &equation);
        for _ in 0..2000 {
            let [density, energy] = [8930.0 * (0.9 + 2.0 * random()), 1e6 * random()];
            let expected = [
                equation.pressure(density, energy),
                equation.compression_energy(density, energy),
                equation.wave_speed_squared(density, energy),
            ];
            compare(&law, &[density, energy], &expected);
        }
    }
}

/// A record of plain numbers, and the numbers of one.
fn plain<R: Record>(numbers: &[f64]) -> Of<R, f64> {
    let next = Cell::new(0);
    R::map([&R::zero::<f64>()], &|[_]: [f64; 1]| numbers[next.replace(next.get() + 1)])
}
fn numbers<R: Record>(record: &Of<R, f64>) -> Vec<f64> {
    let all = RefCell::new(Vec::new());
    R::map([record], &|[number]: [f64; 1]| {
        all.borrow_mut().push(number);
        number
    });
    all.into_inner()
}

/// What corrected gradients make of sums, of moments that are inverted and of others.
fn corrected_gradients_have_bits<const D: usize>(random: &mut impl FnMut() -> f64) {
    let named = |name: &str, count: usize| (0..count).map(|k| format!("{name}{k}")).collect();
    let outputs = |all: Vec<Traced>| {
        all.into_iter().enumerate().map(|(k, number)| (format!("y{k}"), number)).collect()
    };
    let inputs: Vec<String> = named("x", GradientSum::<D>::NUMBERS);
    let gradients = Law::record("gradients", inputs, |x| {
        outputs(flat::<GradientSide<D>>(&filled::<GradientSum<D>>(x).gradients()))
    });
    type Rates<const D: usize> = (CorrectedRateSum<D>, Components<D>);
    let inputs: Vec<String> = named("x", Rates::<D>::NUMBERS);
    let rates = Law::record("rates", inputs, |x| {
        let (sums, deviation) = filled::<Rates<D>>(x);
        outputs(flat::<RateSum<D>>(&sums.rates(&deviation)))
    });
    let (of_gradients, of_rates) = (GradientSum::<D>::NUMBERS, Rates::<D>::NUMBERS);
    for size in [0.01, 1.0, 3.0] {
        for _ in 0..200 {
            let count = of_gradients.max(of_rates);
            let mut x: Vec<f64> = (0..count).map(|_| size * (2.0 * random() - 1.0)).collect();
            // Nearly the identity as often as not.
            if random() < 0.5 {
                (0..D).for_each(|i| x[i * D + i] = 1.0 + 0.1 * x[i * D + i]);
            }
            let sums = plain::<GradientSum<D>>(&x);
            let expected = numbers::<GradientSide<D>>(&sums.gradients());
            compare(&gradients, &x[..of_gradients], &expected);
            let (sums, deviation) = plain::<Rates<D>>(&x);
            let expected = numbers::<RateSum<D>>(&sums.rates(&deviation));
            compare(&rates, &x[..of_rates], &expected);
        }
    }
}

#[test]
fn corrected_gradients_have_the_bits_of_the_processor() {
    let mut random = random(4);
    corrected_gradients_have_bits::<1>(&mut random);
    corrected_gradients_have_bits::<2>(&mut random);
    corrected_gradients_have_bits::<3>(&mut random);
}

#[test]
fn what_is_done_twice_is_recorded_once() {
    let law = Law::record("twice", ["x"], |x| {
        let square = x[0] * x[0];
        vec![("y".into(), square + x[0] * x[0] * Number::sqrt(x[0] * x[0]))]
    });
    assert_eq!(law.operations(), 4);
    // x x, its root, their product, and the sum with x x.
    let count = Operations { sums: 1, products: 2, roots: 1, ..Operations::default() };
    assert_eq!(law.count(), count);
    assert_eq!(law.run(&[3.0]), [36.0]);
}
