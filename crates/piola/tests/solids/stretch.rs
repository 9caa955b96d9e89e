//! Bars of rubber with Kelvin and Voigt's viscosity are pulled to six times their length at the default CFL number.

use nalgebra::Matrix2;
use piola_formulas::hyperelastic::{HyperelasticLaw, LameConstants, Reduced};
use piola_formulas::volumetric::StressState;
use rayon::prelude::*;

use crate::statics::mirrors::values;

/// Pulled in 30 times what a wave takes along it, from a motion that is even.
const BAR: &str = r#"
version = 1
title = "A bar is pulled to six times its length"
dimension = 2

[parameters]
end = 400.0

[[body]]
name = "bar"
shape = { kind = "box", min = [0.0, 0.0], max = [14.0, 6.0] }
spacing = 1.0
lattice = { on = "boundary" }
material = { density = 1.0, LAW }
initial = { velocity = ["x * 5 / end", "0"] }

[scheme]
kind = "PRESET"
viscosity = 0.7

[[boundary]]
name = "left"
where = { kind = "plane", point = [0.0, 0.0], normal = [-1.0, 0.0] }
velocity = { x = "0" }

[[boundary]]
name = "floor"
where = { kind = "plane", point = [0.0, 0.0], normal = [0.0, -1.0] }
velocity = { y = "0" }

[[boundary]]
name = "right"
where = { kind = "plane", point = [14.0, 0.0], normal = [1.0, 0.0] }
velocity = { x = "14 * 5 / end" }

[time]
end = "end"

[[probe]]
name = "middle"
kind = "particle"
at = [7.0, 3.0]
fields = ["deformation_gradient"]

[output]
every = "end"
table_every = "end / 10"
"#;

/// The stretch across at which the sides are free of stress, by bisection of the law's own formula.
fn across(law: HyperelasticLaw, along: f64) -> f64 {
    let law = Reduced::<2>::new(law, StressState::PlaneStrain).unwrap();
    let (mut low, mut high) = (0.01_f64, 1.0_f64);
    for _ in 0..100 {
        let middle = 0.5 * (low + high);
        let stress = law.stress(&Matrix2::new(along - 1.0, 0.0, 0.0, middle - 1.0));
        if stress[(1, 1)] > 0.0 { high = middle } else { low = middle }
    }
    0.5 * (low + high)
}

/// The bound is what viscosity may hold back: `eta d` is 0.1 % of the modulus of the wave, at a stress that is
/// a few tenths of it.
#[test]
fn viscous_rubber_is_pulled_to_six_by_every_law_and_preset() {
    let young = |nu: f64| LameConstants::from_young(1.0, nu).unwrap();
    let text =
        |kind: &str, nu: f64| format!("kind = '{kind}', young_modulus = 1.0, poisson_ratio = {nu}");
    let terms = [(0.3, 1.3), (-0.05, -2.0)];
    let laws = [
        (text("neo_hookean", 0.3), HyperelasticLaw::neo_hookean(young(0.3))),
        (text("neo_hookean", 0.45), HyperelasticLaw::neo_hookean(young(0.45))),
        (
            text("neo_hookean_logarithmic", 0.45),
            HyperelasticLaw::neo_hookean_logarithmic(young(0.45)),
        ),
        (
            "kind = 'mooney_rivlin', c10 = 0.15, c01 = 0.04, bulk_modulus = 0.8".to_owned(),
            HyperelasticLaw::mooney_rivlin(0.15, 0.04, 0.8).unwrap(),
        ),
        (
            "kind = 'ogden', moduli = [0.3, -0.05], exponents = [1.3, -2.0], bulk_modulus = 0.8"
                .to_owned(),
            HyperelasticLaw::ogden(&terms, 0.8).unwrap(),
        ),
    ];
    let presets = ["total_lagrangian", "elastodynamics"];
    let all: Vec<_> = laws.iter().flat_map(|law| presets.map(|preset| (law, preset))).collect();
    all.par_iter().for_each(|((text, law), preset)| {
        let case = BAR.replace("LAW", text).replace("PRESET", preset);
        let found =
            values(&case, &["middle.deformation_gradient.xx", "middle.deformation_gradient.yy"]);
        for (found, expected) in found.iter().zip([6.0, across(law.clone(), 6.0)]) {
            let off = (found / expected - 1.0).abs();
            assert!(off < 0.02, "{preset}, {text}: a stretch of {found}, not {expected}");
        }
    });
}
