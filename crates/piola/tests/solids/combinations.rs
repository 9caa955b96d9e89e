//! Every material with every gradient, boundary and integrator of a total Lagrangian solid, and every setting of `upwind`:
//! each combination runs and balances, or is refused with a reason. `docs/total-lagrangian.md` has the tables.

use std::sync::atomic::AtomicBool;

use piola::case::{self, Finished, LoadOptions, Session};
use piola::observe::Series;
use piola::time::Outcome;
use rayon::prelude::*;

/// Laws of total Lagrangian solids.
const LAWS: [&str; 7] = [
    "kind = 'linear_elastic', young_modulus = 1e6, poisson_ratio = 0.3",
    "kind = 'saint_venant_kirchhoff', young_modulus = 1e6, poisson_ratio = 0.3",
    "kind = 'neo_hookean', young_modulus = 1e6, poisson_ratio = 0.3",
    "kind = 'neo_hookean_logarithmic', young_modulus = 1e6, poisson_ratio = 0.3",
    "kind = 'mooney_rivlin', c10 = 1.5e5, c01 = 4e4, bulk_modulus = 8e5",
    "kind = 'ogden', moduli = [3e5, -5e4], exponents = [1.3, -2.0], bulk_modulus = 8e5",
    "kind = 'hyperelastic', energy = '-2.5e6 * ln(1 - (I1b - 3)/15) + 4e5 * (J - 1)^2'",
];

/// Those that run in 3D: a linear one, and one whose energy is a function of the stretches.
const LAWS_3D: [&str; 2] = [LAWS[0], LAWS[5]];

/// Laws of `upwind`.
const VOLUMETRIC_LAWS: [&str; 2] =
    ["kind = 'linear', bulk_modulus = 1e6", "kind = 'gamma_law', bulk_modulus = 1e6, gamma = 7.0"];

/// Steps of a motion that waves cross the block twice in, explicit and implicit ones.
const STEPS: [u32; 2] = [240, 6];

/// Implicit integrators of motion.
const IMPLICIT: [&str; 7] = [
    "newmark",
    "hht_alpha",
    "generalised_alpha",
    "backward_euler",
    "crank_nicolson",
    "theta",
    "implicit_midpoint",
];

/// Integrators of total Lagrangian solids.
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

/// Integrators of `upwind`.
const FIRST_ORDER: [&str; 7] = [
    "tvd_rk2",
    "ssp_rk3",
    "kick_drift_kick",
    "backward_euler",
    "crank_nicolson",
    "theta",
    "implicit_midpoint",
];

/// Name and keys of what computes gradients, all in two dimensions and more.
const GRADIENTS: [(&str, &str); 3] = [
    ("`patch_consistent`", "kind = 'total_lagrangian'\ngradients = 'patch_consistent'"),
    ("`plain`", "kind = 'total_lagrangian'\ngradients = 'plain'"),
    ("`strong`", "kind = 'total_lagrangian'\nform = 'strong'"),
];

/// Name and keys of the settings of `upwind`.
const UPWIND: [(&str, &str); 4] = [
    ("none", "kind = 'upwind'\nsmoothing_length = 0.7"),
    ("velocity", "kind = 'upwind'\nsmoothing_length = 0.7\ntau_velocity = 0.5"),
    (
        "velocity and pressure",
        "kind = 'upwind'\nsmoothing_length = 0.7\ntau_velocity = 0.5\ntau_pressure = 0.5",
    ),
    (
        "both, reconstructed",
        "kind = 'upwind'\nsmoothing_length = 0.7\ntau_velocity = 0.5\ntau_pressure = 0.5\n\
         reconstruction = true\nwave_speed = 'stretch'",
    ),
];

/// How the block is held and what acts on it, by the words of [`Table::boundary`].
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

/// What there is of these in 1D.
const BOUNDARIES_1D: [(&str, &str); 6] =
    [BOUNDARIES[0], BOUNDARIES[1], BOUNDARIES[2], BOUNDARIES[3], BOUNDARIES[5], BOUNDARIES[7]];

/// Those of all dimensions.
const BOUNDARIES_OF_ALL: [(&str, &str); 7] = [
    BOUNDARIES[0],
    BOUNDARIES[1],
    BOUNDARIES[2],
    BOUNDARIES[3],
    BOUNDARIES[4],
    BOUNDARIES[5],
    BOUNDARIES[7],
];

/// The last value of a quantity, if the scheme has it.
fn known(finished: &Finished, name: &str) -> Option<f64> {
    match finished.quantity(name) {
        Some(Series::Curve { values, .. }) => values.last().copied(),
        Some(Series::Number { value, .. }) => Some(value),
        _ => None,
    }
}

fn last(finished: &Finished, name: &str) -> f64 {
    known(finished, name).unwrap_or_else(|| panic!("there is no {name}"))
}

/// What became of a combination: it balances, or why it was refused.
type Found = Result<(), String>;

/// A table of the page.
struct Table {
    dimension: usize,
    laws: &'static [&'static str],
    /// Name and keys of `[scheme]`.
    schemes: &'static [(&'static str, &'static str)],
    boundaries: &'static [(&'static str, &'static str)],
    integrators: &'static [&'static str],
}

impl Table {
    /// Lengths of the block, whose first side is held, and the area of that side in m^2.
    fn block(&self) -> (&'static [f64], f64) {
        [(&[1.0][..], 1.0), (&[1.0, 0.5], 0.5), (&[1.0, 0.5, 0.25], 0.125)][self.dimension - 1]
    }

    /// Numbers of as many components as there are dimensions.
    fn list(&self, components: [f64; 3]) -> String {
        format!("{:?}", &components[..self.dimension])
    }

    fn boundary(&self, words: &str, motion: &str) -> String {
        let plane = |name: &str, point: [f64; 3], normal: [f64; 3], rest: &str| {
            let [point, normal] = [point, normal].map(|components| self.list(components));
            format!(
                "[[boundary]]\nname = '{name}'\n\
                 where = {{ kind = 'plane', point = {point}, normal = {normal} }}\n{rest}\n"
            )
        };
        let left = |rest: &str| plane("left", [0.0; 3], [-1.0, 0.0, 0.0], rest);
        let axes = &["x", "y", "z"][..self.dimension];
        let all: Vec<String> = axes.iter().map(|axis| format!("{axis} = '0'")).collect();
        let rollers = |mirror: &str| {
            let faces = axes.iter().enumerate().map(|(axis, name)| {
                let normal = std::array::from_fn(|k| if k == axis { -1.0 } else { 0.0 });
                plane(name, [0.0; 3], normal, &format!("{motion} = {{ {name} = '0' }}{mirror}"))
            });
            faces.collect::<String>()
        };
        let [end, outwards] = [[1.0, 0.0, 0.0]; 2].map(|components| self.list(components));
        let right = format!("where = {{ kind = 'plane', point = {end}, normal = {outwards} }}");
        let vector = |along: usize, text: &str| {
            let parts = (0..self.dimension).map(|axis| if axis == along { text } else { "0" });
            format!("{:?}", parts.collect::<Vec<_>>())
        };
        let word = |word: &str| match word {
            "HELD" => left(&format!("{motion} = {{ {} }}", all.join(", "))),
            // What slides along the slope is held across it.
            "SLIDES" if self.dimension == 3 => left(&format!("{motion} = {{ x = '0', z = '0' }}")),
            "SLIDES" => left(&format!("{motion} = {{ x = '0' }}")),
            "MOVED" => {
                let rest = format!("{motion} = {{ x = 'R * t' }}");
                plane("right", [1.0, 0.0, 0.0], [1.0, 0.0, 0.0], &rest)
            }
            "ROLLERS" => rollers(""),
            "MIRRORS" => rollers("\nmirror = true"),
            "INCLINED" => {
                let normal = self.list([-0.6, 0.8, 0.0]);
                let rest = format!("roller = {{ normal = {normal}, displacement = '0' }}");
                plane("slope", [0.0, 0.5, 0.0], [0.0, 1.0, 0.0], &rest)
            }
            "TIED" => plane("end", [1.0, 0.0, 0.0], [1.0, 0.0, 0.0], "tied = ['x']"),
            "PULL" => format!(
                "[[load]]\nname = 'pull'\nkind = 'traction'\n{right}\ntraction = {}\n",
                vector(0, "P * t")
            ),
            "PRESS" => format!(
                "[[load]]\nname = 'press'\nkind = 'pressure'\n{right}\npressure = 'P * t'\n"
            ),
            _ => format!(
                "[[load]]\nname = 'weight'\nkind = 'body_force'\nacceleration = {}\n",
                vector(1.min(self.dimension - 1), "-P * t / 500")
            ),
        };
        words.split(' ').map(word).collect()
    }

    /// The text of a case, with the load at the end of some steps, or of so many times as many; what moves has a displacement in statics and a
    /// velocity elsewhere.
    fn text(&self, law: &str, scheme: &str, words: &str, integrator: &str, finer: u32) -> String {
        let [explicit, implicit] =
            STEPS.map(|steps| format!("end = 0.06\nstep = {}", 0.06 / f64::from(finer * steps)));
        let is_implicit = IMPLICIT.contains(&integrator);
        let (motion, clock, load, rate) = match integrator {
            "static" => ("displacement", "end = 1.0\nstep = 1.0", 4e3, 4e-3),
            "arc_length" => ("displacement", "end = 1.0\nstep = 0.5", 4e3, 4e-3),
            _ => {
                // What does not resist shear is pulled less far.
                let load = if scheme.contains("upwind") { 1e4 } else { 1e5 };
                ("velocity", if is_implicit { &*implicit } else { &*explicit }, load, 0.3)
            }
        };
        let (lengths, _) = self.block();
        let spacing = if self.dimension == 3 { 0.125 } else { 0.0625 };
        let [zero, normal] = [[0.0; 3], [-1.0, 0.0, 0.0]].map(|components| self.list(components));
        let probe = match integrator {
            "static" => format!(
                "[[probe]]\nname = 'wall'\nkind = 'sum'\nfield = 'reaction'\n\
                 where = {{ kind = 'plane', point = {zero}, normal = {normal} }}\n\n"
            ),
            _ => String::new(),
        };
        format!(
            "version = 1\ntitle = 'A block'\ndimension = {}\n\n\
             [[body]]\nname = 'block'\nshape = {{ kind = 'box', min = {zero}, max = {lengths:?} }}\n\
             spacing = {spacing}\nlattice = {{ on = 'boundary' }}\n\
             material = {{ density = 1000.0, {law} }}\n\n[parameters]\nP = {load:?}\nR = {rate:?}\n\n\
             [scheme]\n{scheme}\n\n{}\n[time]\nintegrator = '{integrator}'\n{clock}\n\n\
             {probe}[output]\nevery = 1.0\ntable_every = 0.01\n",
            self.dimension,
            self.boundary(words, motion)
        )
    }

    /// Runs a case, with so many times its steps.
    fn finished(
        &self,
        [law, scheme, words, integrator]: [&str; 4],
        finer: u32,
    ) -> Result<Finished, String> {
        let text = self.text(law, scheme, words, integrator, finer);
        let case = case::parse(&text, "case.toml", &LoadOptions::default());
        let session = case.and_then(|case| Session::new(&case));
        let session = session.map_err(|problems| problems.to_string())?;
        let finished =
            session.run(&AtomicBool::new(false), &mut |_| {}).expect("nothing is written");
        assert_eq!(finished.summary.outcome, Outcome::Completed, "{text}");
        Ok(finished)
    }

    /// Runs a case and sees whether energy and momentum are accounted for, and in statics whether the wall bears the load.
    fn run(&self, law: &str, scheme: &str, (name, words): (&str, &str), integrator: &str) -> Found {
        let what = format!("{law}, {scheme}, {name}, {integrator}");
        let pulls = words.contains("PULL") && !words.contains("INCLINED");
        let is_static = matches!(integrator, "static" | "arc_length");
        // Through the edges of the strong form loads and walls act as one.
        let has_impulse = !is_static && pulls && !scheme.contains("strong");
        let impulse =
            |finished: &Finished, name: &str| last(finished, &format!("momentum.{name}.linear.x"));
        // The shares of the work and of the impulse that are not accounted for.
        let lost = |finished: &Finished| {
            let works = ["body_force", "traction", "pressure", "boundary_motion"];
            let done = works.iter().filter_map(|name| known(finished, &format!("energy.{name}")));
            let done: f64 = done.map(f64::abs).sum();
            assert!(done > 1e-6, "{what}: nothing happens, {done:e} J");
            let impulse = match has_impulse {
                true => impulse(finished, "balance") / impulse(finished, "traction"),
                false => 0.0,
            };
            [last(finished, "energy.balance") / done, impulse].map(f64::abs)
        };
        let finished = self.finished([law, scheme, words, integrator], 1)?;
        let rest = lost(&finished);
        if IMPLICIT.contains(&integrator) {
            // Of a load that grows from nothing in N steps a sum of the second order has an error of some tenths of 1/N^2.
            // With `upwind`, what is more falls with the order of the method.
            let most = 0.5 / f64::from(STEPS[1] * STEPS[1]);
            let is_little = |rest: f64| rest <= most;
            if scheme.contains("upwind") && !rest.iter().all(|rest| is_little(*rest)) {
                let finer = lost(&self.finished([law, scheme, words, integrator], 2)?);
                let order =
                    if ["backward_euler", "theta"].contains(&integrator) { 1.0 } else { 2.0 };
                // A method of the first order is off by some 1/N.
                let cap = 1.0 / f64::from(STEPS[1]);
                let falls = |k: usize| (rest[k] / finer[k]).log2() > order - 0.25 && finer[k] < cap;
                let is_right = (0..2).all(|k| is_little(rest[k]) || falls(k));
                assert!(is_right, "{what}: {rest:?} and {finer:?} with half the step");
            } else {
                assert!(
                    rest.iter().all(|rest| is_little(*rest)),
                    "{what}: {rest:?} is not accounted for"
                );
            }
        } else {
            // The share of the work beyond which a run warns.
            assert!(rest[0] < 0.01 && rest[1] < 1e-9, "{what}: {rest:?} is not accounted for");
        }
        if integrator == "static" && pulls {
            let wall = last(&finished, "wall.reaction.x") / (4e3 * self.block().1) + 1.0;
            assert!(wall.abs() < 1e-6, "{what}: the wall lacks {wall:.1e} of the load");
        }
        // Without resistance to shear nearly all of a pressure leaves through the free sides.
        if has_impulse && (self.dimension == 1 || !scheme.contains("upwind")) {
            let [pull, wall] = ["traction", "boundary_motion"].map(|name| impulse(&finished, name));
            assert!(wall < -0.1 * pull, "{what}: the wall holds {wall:.1e} of {pull:.1e} N s");
        }
        Ok(())
    }

    /// What a combination comes to with each law: one word where it is the same with all.
    fn cell(&self, scheme: &str, boundary: (&str, &str), integrator: &str) -> String {
        let all = self.laws.iter().map(|law| {
            let found = std::panic::catch_unwind(|| self.run(law, scheme, boundary, integrator));
            match found {
                Ok(Ok(())) => "runs".to_owned(),
                Ok(Err(refusal)) => reason(&refusal).to_owned(),
                Err(_) => "fails".to_owned(),
            }
        });
        let all: Vec<String> = all.collect();
        let is_same = all.iter().all(|found| *found == all[0]);
        if is_same { all[0].clone() } else { all.join(", ") }
    }

    /// Its rows, as the runs and the refusals say it, are those of the page.
    fn is_on_the_page(&self) {
        let lines = self
            .schemes
            .iter()
            .flat_map(|scheme| self.boundaries.iter().map(move |boundary| (*scheme, *boundary)));
        let rows = lines.collect::<Vec<_>>().into_par_iter().map(|((name, scheme), boundary)| {
            let entries =
                self.integrators.iter().map(|integrator| self.cell(scheme, boundary, integrator));
            let entries: Vec<String> = entries.collect();
            format!("| {name} | {} | {} |", boundary.0, entries.join(" | "))
        });
        let rows: Vec<String> = rows.collect();
        let page = include_str!("../../../../docs/total-lagrangian.md");
        let wanted = rows.join("\n");
        assert!(page.contains(&wanted), "docs/total-lagrangian.md should have the table\n{wanted}");
    }
}

#[test]
fn every_combination_runs_and_balances_or_is_refused_with_a_reason_in_1d() {
    Table {
        dimension: 1,
        laws: &LAWS,
        schemes: &GRADIENTS,
        boundaries: &BOUNDARIES_1D,
        integrators: &INTEGRATORS,
    }
    .is_on_the_page();
}

#[test]
fn every_combination_runs_and_balances_or_is_refused_with_a_reason_in_2d() {
    Table {
        dimension: 2,
        laws: &LAWS,
        schemes: &GRADIENTS,
        boundaries: &BOUNDARIES,
        integrators: &INTEGRATORS,
    }
    .is_on_the_page();
}

/// But for the strong form, which is refused whatever else is chosen.
#[test]
fn every_combination_runs_and_balances_or_is_refused_with_a_reason_in_3d() {
    Table {
        dimension: 3,
        laws: &LAWS_3D,
        schemes: &GRADIENTS[..2],
        boundaries: &BOUNDARIES,
        integrators: &INTEGRATORS,
    }
    .is_on_the_page();
}

/// In all dimensions alike, with the boundaries that there are in all.
#[test]
fn every_setting_of_upwind_runs_and_balances_or_is_refused_with_a_reason() {
    for dimension in 1..=3 {
        Table {
            dimension,
            laws: &VOLUMETRIC_LAWS,
            schemes: &UPWIND,
            boundaries: &BOUNDARIES_OF_ALL,
            integrators: &FIRST_ORDER,
        }
        .is_on_the_page();
    }
}

/// The letter that the page gives to a reason, or what is said that has none.
fn reason(refusal: &str) -> &str {
    const REASONS: [(&str, &str); 8] = [
        ("in the strong form, whose forces do not derive from an energy", "a"),
        ("a follower pressure cannot be combined with the strong form", "b"),
        ("patch-consistent gradients cannot be combined with mirror images", "c"),
        ("has no meaning without the integrator `static`", "d"),
        ("the strong form creates its own ghosts", "e"),
        ("has no load of the kind `pressure`", "f"),
        ("`mirror` has no meaning in this scheme", "g"),
        ("its forces depend on velocities there", "h"),
    ];
    let found = REASONS.iter().find(|(words, _)| refusal.contains(words));
    found.map_or_else(|| refusal.lines().next().unwrap_or_default(), |(_, letter)| letter)
}
