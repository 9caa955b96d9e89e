//! All laws by name.

use nalgebra::Matrix3;
use piola_formulas::Number;
use piola_formulas::hyperelastic::{HyperelasticLaw, HyperelasticResponse, LameConstants};
use piola_formulas::hypoelastic::{EquationOfState, JohnsonCook, PressureLaw, Strength};
use piola_formulas::kernels::Kernel;
use piola_formulas::volumetric::{VolumetricLaw, VolumetricResponse};

use crate::law::{Law, Outputs};
use crate::record::Traced;

/// The nine entries of a 3 x 3 tensor, row by row.
pub const ENTRIES: [&str; 9] = ["xx", "xy", "xz", "yx", "yy", "yz", "zx", "zy", "zz"];

/// Value and slope over distance of a kernel, of the distance `r` in m.
pub fn kernel(kernel: Kernel, dimension: usize, smoothing_length: f64) -> Law {
    Law::record(format!("{}_kernel", kernel.name()), ["r"], |x| {
        vec![
            ("w".into(), kernel.value(dimension, x[0], smoothing_length)),
            ("slope".into(), kernel.derivative_over_r(dimension, x[0], smoothing_length)),
        ]
    })
}

/// The matrix of nine numbers, row by row.
pub fn matrix<T: Number>(entries: &[T]) -> Matrix3<T> {
    Matrix3::from_fn(|i, j| entries[3 * i + j])
}

/// The first Piola-Kirchhoff stress of an elastic solid, of the displacement gradient, in Pa.
pub fn stress(law: &HyperelasticLaw) -> Law {
    let inputs = ENTRIES.map(|entry| format!("a_{entry}"));
    Law::record(format!("{}_stress", law.name()), inputs, |x| {
        let stress = law.stress(&matrix(x));
        ENTRIES
            .iter()
            .enumerate()
            .map(|(k, e)| (format!("p_{e}"), stress[(k / 3, k % 3)]))
            .collect()
    })
}

/// Energy in J/m^3, pressure and tangent in Pa of a volumetric material, of the volume ratio.
pub fn volumetric(law: &VolumetricLaw) -> Law {
    Law::record(format!("{}_volume", law.name()), ["ratio"], |x| {
        vec![
            ("energy".into(), law.energy(x[0])),
            ("pressure".into(), law.pressure(x[0])),
            ("tangent".into(), law.tangent(x[0])),
        ]
    })
}

/// The return to the yield surface, of the equivalent stress in Pa, the plastic strain, the temperature
/// in K and the step in s.
pub fn return_to_surface(name: &str, strength: &Strength, shear_modulus: f64) -> Law {
    let inputs = ["von_mises", "plastic_strain", "temperature", "step"];
    Law::record(name, inputs, |x| returned(strength, shear_modulus, x))
}

/// What the return gives, with its names.
pub fn returned<T: Number>(strength: &Strength, shear_modulus: f64, x: &[T]) -> Outputs<T> {
    let returned = strength.return_to_surface(x[0], shear_modulus, x[1], x[2], x[3]);
    vec![
        ("scale".into(), returned.scale),
        ("increment".into(), returned.increment),
        ("stress".into(), returned.stress),
    ]
}

/// Pressure of a solid in Pa, its specific energy of compression in J/kg and the square of its bulk wave speed in
/// m^2/s^2, of its density in kg/m^3 and its specific energy in J/kg.
pub fn equation_of_state(name: &str, law: &EquationOfState) -> Law {
    Law::record(name, ["density", "energy"], |x: &[Traced]| {
        vec![
            ("pressure".into(), law.pressure(x[0], x[1])),
            ("compression_energy".into(), law.compression_energy(x[0], x[1])),
            ("wave_speed_squared".into(), law.wave_speed_squared(x[0], x[1])),
        ]
    })
}

/// Steel-like constants for the laws below.
const CONSTANTS: LameConstants = LameConstants { lambda: 1.2e11, mu: 8e10 };

/// One elastic solid of each name.
pub fn solids() -> Vec<HyperelasticLaw> {
    let laws = [
        Ok(HyperelasticLaw::linear_elastic(CONSTANTS)),
        Ok(HyperelasticLaw::saint_venant_kirchhoff(CONSTANTS)),
        Ok(HyperelasticLaw::neo_hookean(CONSTANTS)),
        Ok(HyperelasticLaw::neo_hookean_logarithmic(CONSTANTS)),
        HyperelasticLaw::mooney_rivlin(3e5, 1e5, 1e7),
        HyperelasticLaw::ogden(&[(6.3e5, 1.3), (1.2e3, 5.0), (-1e4, -2.0)], 1e7),
    ];
    laws.map(|law| law.expect("the constants are in range")).to_vec()
}

/// One volumetric material of each name, the gamma law with exponents that need a power, too.
pub fn materials() -> Vec<VolumetricLaw> {
    [
        VolumetricLaw::linear(2e6),
        VolumetricLaw::gamma_law(2e6, 7.0),
        VolumetricLaw::gamma_law(2e6, 1.4),
    ]
    .map(|law| law.expect("the constants are in range"))
    .to_vec()
}

/// One law of strength of each kind that yields.
pub fn strengths() -> [(&'static str, Strength); 2] {
    let johnson_cook = JohnsonCook {
        yield_stress: 9e7,
        hardening: 2.92e8,
        exponent: 0.31,
        rate_factor: 0.025,
        reference_rate: 1.0,
        softening: 1.09,
        reference_temperature: 300.0,
        melting_temperature: 1356.0,
    };
    let linear = Strength::Linear { yield_stress: 4e8, hardening: 1e8 };
    [("linear_hardening", linear), ("johnson_cook", Strength::JohnsonCook(johnson_cook))]
}

/// Shear modulus in Pa of the laws of strength.
pub const SHEAR_MODULUS: f64 = 4.4e10;

/// One equation of state of each kind.
pub fn equations_of_state() -> [(&'static str, EquationOfState); 3] {
    let of = |law, spall_strength| EquationOfState {
        density: 8930.0,
        wave_speed: 3900.0,
        law,
        spall_strength,
    };
    let mie_gruneisen = PressureLaw::MieGrueneisen { slope: 1.49, gruneisen: 2.0 };
    [
        ("linear_pressure", of(PressureLaw::Linear, f64::INFINITY)),
        ("tait", of(PressureLaw::Tait { exponent: 7.15 }, 1.2e9)),
        ("mie_gruneisen", of(mie_gruneisen, 1.2e9)),
    ]
}

/// All laws: kernels in 3D with a smoothing length of 1 m, the others with constants of some material.
pub fn all() -> Vec<Law> {
    let kernels = Kernel::ALL.iter().map(|shape| kernel(*shape, 3, 1.0));
    let strengths = strengths().map(|(name, law)| return_to_surface(name, &law, SHEAR_MODULUS));
    let materials = materials();
    kernels
        .chain(solids().iter().map(stress))
        .chain(materials[..2].iter().map(volumetric))
        .chain(strengths)
        .chain(equations_of_state().map(|(name, law)| equation_of_state(name, &law)))
        .collect()
}
