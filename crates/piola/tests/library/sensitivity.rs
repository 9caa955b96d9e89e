//! Rates of states in equilibrium by constants of materials.

use piola::case::{self, LoadOptions, SensitivityError, Session};
use piola::schemes::{NoRates, Rates};

/// A block that is pulled along x and held where it stands, of a material and with an hourglass coefficient.
fn text(dimension: usize, material: &str, hourglass: f64) -> String {
    let (corner, spacing) = (&["1.0", "0.6", "0.4"][..dimension].join(", "), 0.2);
    let zeros = vec!["0"; dimension].join(", ");
    let normal = |axis: usize, sign: i32| {
        let component = |k: usize| if k == axis { sign.to_string() } else { "0".to_owned() };
        (0..dimension).map(component).collect::<Vec<_>>().join(", ")
    };
    let held = |axis: usize, name: &str| {
        format!(
            "[[boundary]]\nname = \"{name}\"\nwhere = {{ kind = \"plane\", point = [{zeros}], normal = [{}] }}\n\
             displacement = {{ {name} = \"0\" }}\n",
            normal(axis, -1)
        )
    };
    let feet: String =
        ["x", "y", "z"][..dimension].iter().enumerate().map(|(k, n)| held(k, n)).collect();
    format!(
        "version = 1\ntitle = \"A block is pulled\"\ndimension = {dimension}\n\
         [[body]]\nname = \"block\"\nshape = {{ kind = \"box\", min = [{zeros}], max = [{corner}] }}\n\
         spacing = {spacing}\nmaterial = {{ density = 1000, {material} }}\n\
         [scheme]\nkind = \"dual_support\"\nhourglass = {hourglass:?}\n{feet}\
         [[boundary]]\nname = \"head\"\nwhere = {{ kind = \"plane\", point = [{corner}], normal = [{}] }}\n\
         displacement = {{ x = \"0.3 * t\" }}\n\
         [[load]]\nkind = \"body_force\"\nacceleration = [{}]\n\
         [time]\nintegrator = \"static\"\nend = 1.0\nstep = 0.25\ntolerance = 1e-12\n\
         [output]\nevery = 1.0\n",
        normal(0, 1),
        ["\"40 * y * t\"", "\"-30 * x * t\"", "\"20 * t\""][..dimension].join(", "),
    )
}

fn ended(text: &str, set: &[String]) -> Session {
    let options = LoadOptions { overrides: set.to_vec(), ..LoadOptions::default() };
    let case = case::parse(text, "block.toml", &options).unwrap_or_else(|error| panic!("{error}"));
    let mut session = Session::new(&case).unwrap_or_else(|error| panic!("{error}"));
    session.run_until(1.0).unwrap();
    session
}

/// The difference quotient of two runs: with a step of a ten thousandth what it leaves out of third derivatives is
/// below 1e-6 of it, and so is what iterations leave, 1e-12 of the forces over the step.
fn quotient(text: &str, key: &str, value: f64) -> [Vec<f64>; 2] {
    let step = 1e-4 * value.abs();
    let [last, next] = [value - step, value + step].map(|value| {
        let mut session = ended(text, &[format!("{key}={value:?}")]);
        ["displacement", "reaction"].map(|name| session.column(name).unwrap().values)
    });
    [0, 1].map(|k| last[k].iter().zip(&next[k]).map(|(a, b)| (b - a) / (2.0 * step)).collect())
}

fn assert_close(found: &[f64], expected: &[f64], what: &str) {
    let largest = expected.iter().fold(0.0_f64, |largest, x| largest.max(x.abs()));
    assert_eq!(found.len(), expected.len());
    for (found, expected) in found.iter().zip(expected) {
        let error = (found - expected).abs();
        assert!(error <= 2e-6 * largest, "{what}: {found:e} against {expected:e} of {largest:e}");
    }
}

/// All laws, with hourglass energy and without, in all dimensions, free and held across, under loads that
/// deform the block unevenly.
#[test]
fn rates_are_the_limits_of_differences() {
    let young = |kind: &str, plane: &str| {
        format!("kind = \"{kind}\", young_modulus = 1.7e5, poisson_ratio = 0.23{plane}")
    };
    let (stress, strain) = (", plane = \"stress\"", ", plane = \"strain\"");
    let both = ["young_modulus=1.7e5", "poisson_ratio=0.23"];
    let cases = [
        (2, young("saint_venant_kirchhoff", stress), 0.3, &both[..]),
        (2, young("linear_elastic", strain), 0.3, &both),
        (2, young("neo_hookean", stress), 0.0, &both),
        (3, young("neo_hookean_logarithmic", ""), 0.3, &both),
        (1, young("neo_hookean", stress), 0.0, &both),
        (
            2,
            format!("kind = \"neo_hookean\", bulk_modulus = 1.1e5, shear_modulus = 0.6e5{stress}"),
            0.3,
            &["bulk_modulus=1.1e5", "shear_modulus=0.6e5"],
        ),
        (
            2,
            format!("kind = \"neo_hookean\", lame_lambda = 1.1e5, shear_modulus = 0.6e5{stress}"),
            0.0,
            &["lame_lambda=1.1e5", "shear_modulus=0.6e5"],
        ),
        (
            2,
            format!(
                "kind = \"mooney_rivlin\", c10 = 2.1e4, c01 = 0.9e4, bulk_modulus = 1.3e5{stress}"
            ),
            0.3,
            &["c10=2.1e4", "c01=0.9e4", "bulk_modulus=1.3e5"],
        ),
    ];
    for (dimension, material, hourglass, constants) in cases {
        let text = text(dimension, &material, hourglass);
        let mut session = ended(&text, &[]);
        for constant in constants {
            let (key, value) = constant.split_once('=').unwrap();
            let key = format!("body.block.material.{key}");
            let what = format!("{key} of {material} in {dimension}D");
            let Rates { displacement, reaction } = session.sensitivity(&key).unwrap();
            let [moved, held] = quotient(&text, &key, value.parse().unwrap());
            assert_close(&displacement, &moved, &what);
            assert_close(&reaction, &held, &what);
        }
    }
}

/// A modulus of Ogden's law is one of several in a list.
#[test]
fn moduli_of_a_list_have_rates() {
    let with = |first: f64| {
        let material = format!(
            "kind = \"ogden\", moduli = [{first:?}, -1.1e4], exponents = [1.7, -2.2], \
             bulk_modulus = 1.5e5, plane = \"stress\""
        );
        text(2, &material, 0.3)
    };
    let rates = ended(&with(3e4), &[]).sensitivity("body.block.material.moduli.0").unwrap();
    let [last, next] = [3e4 - 3.0, 3e4 + 3.0]
        .map(|value| ended(&with(value), &[]).column("displacement").unwrap().values);
    let moved: Vec<f64> = last.iter().zip(&next).map(|(a, b)| (b - a) / 6.0).collect();
    assert_close(&rates.displacement, &moved, "moduli.0");
}

/// A bar in uniaxial stress: force `A E l e` with `e = (l^2 - 1)/2` at the stretch l, and `sqrt(1 - 2 nu e)` across.
#[test]
fn rates_of_a_bar_are_those_of_its_formula() {
    let material = "kind = \"saint_venant_kirchhoff\", young_modulus = 1.7e5, poisson_ratio = 0.23, \
                    plane = \"stress\"";
    let text = text(2, material, 0.0);
    let unloaded = text.split("[[load]]").next().unwrap().to_owned()
        + "[time]"
        + text.split("[time]").nth(1).unwrap();
    let mut session = ended(&unloaded, &[]);
    let position = session.column("position").unwrap().values;
    let displacement = session.column("displacement").unwrap().values;
    let reference: Vec<f64> = position.iter().zip(&displacement).map(|(x, u)| x - u).collect();
    let (stretch, nu, width) = (1.3_f64, 0.23, 0.6);
    let strain = (stretch * stretch - 1.0) / 2.0;
    let across = (1.0 - 2.0 * nu * strain).sqrt();
    let by_young = session.sensitivity("body.block.material.young_modulus").unwrap();
    let by_poisson = session.sensitivity("body.block.material.poisson_ratio").unwrap();
    let head = |rates: &Rates| -> f64 {
        let at_head = |a: &usize| reference[2 * a] > 0.99;
        (0..reference.len() / 2).filter(at_head).map(|a| rates.reaction[2 * a]).sum()
    };
    // Bounds: the tolerance of the residual, 1e-12 of forces of 1e5 N, and round-off of the solution.
    let force = width * stretch * strain;
    assert!((head(&by_young) - force).abs() < 1e-8 * force, "{} {force}", head(&by_young));
    assert!(head(&by_poisson).abs() < 1e-8 * 1.7e5 * force, "{}", head(&by_poisson));
    for (a, x) in reference.chunks_exact(2).enumerate() {
        assert!(by_young.displacement[2 * a..][..2].iter().all(|rate| rate.abs() < 1e-8 / 1.7e5));
        let narrower = -strain / across * x[1];
        assert!((by_poisson.displacement[2 * a + 1] - narrower).abs() < 1e-8, "{a}");
        assert!(by_poisson.displacement[2 * a].abs() < 1e-8);
    }
}

#[test]
fn rates_that_there_are_not_are_refused() {
    let material = "kind = \"neo_hookean\", young_modulus = 1.7e5, poisson_ratio = 0.23";
    let text = text(2, material, 0.0);
    let mut session = ended(&text, &[]);
    for key in ["body.block.material.density", "body.block.material.c10", "young_modulus", ""] {
        let refused = session.sensitivity(key).unwrap_err();
        assert!(matches!(refused, SensitivityError::Unknown { .. }), "{key}: {refused}");
        assert!(refused.to_string().contains("`body.block.material.young_modulus`"), "{refused}");
    }
    let moving = text.split("[time]").next().unwrap().to_owned()
        + "[time]\nend = 1e-3\ncfl = 0.3\n[output]\nevery = 1.0\n";
    let refused = ended(&moving, &[]).sensitivity("body.block.material.young_modulus").unwrap_err();
    assert_eq!(refused, SensitivityError::NoRates(NoRates::NotStatic));
}
