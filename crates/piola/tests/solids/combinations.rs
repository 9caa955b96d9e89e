//! Every material with every gradient, boundary and integrator of a total Lagrangian solid: each
//! combination runs and balances, or is refused with a reason. `docs/total-lagrangian.md` has the table.

use std::sync::atomic::AtomicBool;

use piola::case::{self, Finished, LoadOptions, Session};
use piola::observe::Series;
use piola::time::Outcome;
use rayon::prelude::*;

/// A block of 17 by 9 particles, which is held at the left.
const BLOCK: &str = r#"
version = 1
title = "A block"
dimension = 2

[[body]]
name = "block"
shape = { kind = "box", min = [0.0, 0.0], max = [1.0, 0.5] }
spacing = 0.0625
lattice = { on = "boundary" }
"#;

const LAWS: [&str; 7] = [
    "kind = 'linear_elastic', young_modulus = 1e6, poisson_ratio = 0.3",
    "kind = 'saint_venant_kirchhoff', young_modulus = 1e6, poisson_ratio = 0.3",
    "kind = 'neo_hookean', young_modulus = 1e6, poisson_ratio = 0.3",
    "kind = 'neo_hookean_logarithmic', young_modulus = 1e6, poisson_ratio = 0.3",
    "kind = 'mooney_rivlin', c10 = 1.5e5, c01 = 4e4, bulk_modulus = 8e5",
    "kind = 'ogden', moduli = [3e5, -5e4], exponents = [1.3, -2.0], bulk_modulus = 8e5",
    "kind = 'hyperelastic', energy = '-2.5e6 * ln(1 - (I1b - 3)/15) + 4e5 * (J - 1)^2'",
];

/// Steps of a motion that waves cross the block twice in, explicit and implicit ones.
const STEPS: [u32; 2] = [240, 6];

fn is_implicit(integrator: &str) -> bool {
    matches!(integrator, "newmark" | "hht_alpha" | "generalised_alpha")
}

const GRADIENTS: [&str; 3] =
    ["gradients = 'patch_consistent'", "gradients = 'plain'", "form = 'strong'"];

const INTEGRATORS: [&str; 8] = [
    "tvd_rk2",
    "ssp_rk3",
    "kick_drift_kick",
    "newmark",
    "hht_alpha",
    "generalised_alpha",
    "static",
    "arc_length",
];

/// How the block is held and what acts on it; `MOTION` is a displacement in statics and a velocity elsewhere.
const BOUNDARIES: [(&str, &str); 8] = [
    ("held, traction", "HELD PULL"),
    ("held, follower pressure", "HELD PRESS"),
    ("held, body force", "HELD WEIGHT"),
    ("moved", "HELD MOVED"),
    ("rollers along axes, traction", "ROLLERS PULL"),
    ("mirrors, traction", "MIRRORS PULL"),
    ("inclined roller, traction", "SLIDES INCLINED PULL"),
    ("tied end, traction", "HELD TIED PULL"),
];

fn boundary(words: &str, motion: &str) -> String {
    let plane = |name: &str, point: [f64; 2], normal: [f64; 2], rest: &str| {
        format!(
            "[[boundary]]\nname = '{name}'\n\
             where = {{ kind = 'plane', point = {point:?}, normal = {normal:?} }}\n{rest}\n"
        )
    };
    let right = "where = { kind = 'plane', point = [1.0, 0.0], normal = [1.0, 0.0] }";
    let rollers = |mirror: &str| {
        plane("left", [0.0, 0.0], [-1.0, 0.0], &format!("{motion} = {{ x = '0' }}{mirror}"))
            + &plane("floor", [0.0, 0.0], [0.0, -1.0], &format!("{motion} = {{ y = '0' }}{mirror}"))
    };
    let word = |word: &str| match word {
        "HELD" => {
            plane("left", [0.0, 0.0], [-1.0, 0.0], &format!("{motion} = {{ x = '0', y = '0' }}"))
        }
        "SLIDES" => plane("left", [0.0, 0.0], [-1.0, 0.0], &format!("{motion} = {{ x = '0' }}")),
        "MOVED" => plane("right", [1.0, 0.0], [1.0, 0.0], &format!("{motion} = {{ x = 'R * t' }}")),
        "ROLLERS" => rollers(""),
        "MIRRORS" => rollers("\nmirror = true"),
        "INCLINED" => plane(
            "slope",
            [0.0, 0.5],
            [0.0, 1.0],
            "roller = { normal = [-0.6, 0.8], displacement = '0' }",
        ),
        "TIED" => plane("end", [1.0, 0.0], [1.0, 0.0], "tied = ['x']"),
        "PULL" => {
            format!(
                "[[load]]\nname = 'pull'\nkind = 'traction'\n{right}\ntraction = ['P * t', '0']\n"
            )
        }
        "PRESS" => {
            format!("[[load]]\nname = 'press'\nkind = 'pressure'\n{right}\npressure = 'P * t'\n")
        }
        _ => {
            "[[load]]\nname = 'weight'\nkind = 'body_force'\nacceleration = ['0', '-P * t / 500']\n"
                .to_owned()
        }
    };
    words.split(' ').map(word).collect()
}

/// The text of a case, with the load at the end of some steps.
fn text(law: &str, gradients: &str, words: &str, integrator: &str) -> String {
    let [explicit, implicit] =
        STEPS.map(|steps| format!("end = 0.06\nstep = {}", 0.06 / f64::from(steps)));
    let (motion, clock, load, rate) = match integrator {
        "static" => ("displacement", "end = 1.0\nstep = 1.0", 4e3, 4e-3),
        "arc_length" => ("displacement", "end = 1.0\nstep = 0.5", 4e3, 4e-3),
        name => ("velocity", if is_implicit(name) { &*implicit } else { &*explicit }, 1e5, 0.3),
    };
    let kind = "kind = 'total_lagrangian'";
    format!(
        "{BLOCK}material = {{ density = 1000.0, {law} }}\n\n[parameters]\nP = {load:?}\nR = {rate:?}\n\n\
         [scheme]\n{kind}\n{gradients}\n\n{}\n[time]\nintegrator = '{integrator}'\n{clock}\n\n\
         [[probe]]\nname = 'wall'\nkind = 'sum'\nfield = 'reaction'\n\
         where = {{ kind = 'plane', point = [0.0, 0.0], normal = [-1.0, 0.0] }}\n\n\
         [output]\nevery = 1.0\ntable_every = 0.01\n",
        boundary(words, motion)
    )
}

fn last(finished: &Finished, name: &str) -> f64 {
    match finished.quantity(name) {
        Some(Series::Curve { values, .. }) => *values.last().expect("a row at the end"),
        Some(Series::Number { value, .. }) => value,
        other => panic!("{name}: {other:?}"),
    }
}

/// What became of a combination: it balances, or why it was refused.
type Found = Result<(), String>;

/// Runs a case and sees whether energy is accounted for, and in statics whether the wall bears the load.
fn run(law: &str, gradients: &str, (name, words): (&str, &str), integrator: &str) -> Found {
    let text = text(law, gradients, words, integrator);
    let case = case::parse(&text, "case.toml", &LoadOptions::default());
    let session = case.and_then(|case| Session::new(&case));
    let session = session.map_err(|problems| problems.to_string())?;
    let finished = session.run(&AtomicBool::new(false), &mut |_| {}).expect("nothing is written");
    let what = format!("{law}, {gradients}, {name}, {integrator}");
    assert_eq!(finished.summary.outcome, Outcome::Completed, "{what}");
    let works = ["body_force", "traction", "pressure", "boundary_motion"];
    let done: f64 = works.iter().map(|name| last(&finished, &format!("energy.{name}")).abs()).sum();
    assert!(done > 1e-6, "{what}: nothing happens, {done:e} J");
    let rest = last(&finished, "energy.balance").abs() / done;
    // Of a load that grows from nothing in N steps a sum of the second order has an error of some tenths of
    // 1/N^2. Elsewhere it is the share beyond which a run warns.
    let most = match is_implicit(integrator) {
        true => 0.5 / f64::from(STEPS[1] * STEPS[1]),
        false => 0.01,
    };
    assert!(rest < most, "{what}: {rest:.1e} of the work is not accounted for");
    let pulls = words.contains("PULL") && !words.contains("INCLINED");
    if integrator == "static" && pulls {
        let wall = last(&finished, "wall.reaction.x") / (4e3 * 0.5) + 1.0;
        assert!(wall.abs() < 1e-6, "{what}: the wall lacks {wall:.1e} of the load");
    }
    let is_static = matches!(integrator, "static" | "arc_length");
    // Through the edges of the strong form loads and walls act as one.
    if !is_static && pulls && !gradients.contains("strong") {
        // What came in is there, and the wall has its part of it.
        let impulse = |name: &str| last(&finished, &format!("momentum.{name}.linear.x"));
        let (pull, wall) = (impulse("traction"), impulse("boundary_motion"));
        let lost = (impulse("balance") / pull).abs();
        assert!(lost < if is_implicit(integrator) { most } else { 1e-9 }, "{what}: {lost:.1e}");
        assert!(wall < -0.1 * pull, "{what}: the wall holds {wall:.1e} of {pull:.1e} N s");
    }
    Ok(())
}

/// The rows of the table of the page, as the runs and the refusals say it.
#[test]
fn every_combination_runs_and_balances_or_is_refused_with_a_reason() {
    let cells: Vec<(&str, (&str, &str))> = GRADIENTS
        .iter()
        .flat_map(|gradients| BOUNDARIES.iter().map(|boundary| (*gradients, *boundary)))
        .collect();
    let cell = |gradients: &str, boundary: (&str, &str), integrator: &str| {
        let all = LAWS.map(|law| {
            let found = std::panic::catch_unwind(|| run(law, gradients, boundary, integrator));
            match found {
                Ok(Ok(())) => "runs",
                Ok(Err(refusal)) => reason(&refusal),
                Err(_) => "fails",
            }
        });
        match all.iter().all(|found| *found == all[0]) {
            true => all[0].to_owned(),
            false => all.join(", "),
        }
    };
    let rows: Vec<String> = cells
        .par_iter()
        .map(|&(gradients, boundary)| {
            let entries: Vec<String> = INTEGRATORS
                .iter()
                .map(|integrator| cell(gradients, boundary, integrator))
                .collect();
            let gradients = gradients.split('\'').nth(1).unwrap_or_default();
            format!("| `{gradients}` | {} | {} |", boundary.0, entries.join(" | "))
        })
        .collect();
    let page = include_str!("../../../../docs/total-lagrangian.md");
    let is_there = rows.iter().all(|row| page.contains(row));
    assert!(is_there, "the table of docs/total-lagrangian.md should have\n{}", rows.join("\n"));
}

/// The letter that the page gives to a reason.
fn reason(refusal: &str) -> &'static str {
    const REASONS: [(&str, &str); 5] = [
        ("in the strong form, whose forces do not derive from an energy", "a"),
        ("a follower pressure cannot be combined with the strong form", "b"),
        ("patch-consistent gradients cannot be combined with mirror images", "c"),
        ("has no meaning without the integrator `static`", "d"),
        ("only, and not of particle", "e"),
    ];
    let found = REASONS.iter().find(|(words, _)| refusal.contains(words));
    found.map_or_else(|| panic!("no known reason: {refusal}"), |(_, letter)| letter)
}
