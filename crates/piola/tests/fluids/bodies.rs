//! Runs of solids as a whole: what they conserve, what they do not depend on, what they come to.

use piola::case::{self, Case, LoadOptions, Session};
use piola::time::{IntegratorKind, Outcome};

use super::escapes::{run, values};

/// Two discs that collide, of which one flows plastically and warms up.
const DISCS: &str = r#"
version = 1
title = "Two discs collide"
dimension = 2

[parameters]
dx = 0.1
gap = 0.1

[[body]]
name = "left"
shape = { kind = "ball", center = ["-0.5 - gap / 2", 0.0], radius = 0.5 }
spacing = "dx"
lattice = { on = "cells" }
material = { kind = "hypoelastic", density = 1000, bulk_modulus = 1e7, shear_modulus = 4e6, specific_heat = 1000, strength = { kind = "linear", yield_stress = 2e5, hardening = 1e5 }, pressure_law = { kind = "mie_grueneisen", slope = 1.3, gruneisen = 2.0 } }
initial = { velocity = ["2", "0"] }

[[body]]
name = "right"
shape = { kind = "ball", center = ["0.5 + gap / 2", 0.0], radius = 0.5 }
spacing = "dx"
lattice = { on = "cells" }
material = { kind = "hypoelastic", density = 2000, bulk_modulus = 2e7, shear_modulus = 8e6 }
initial = { velocity = ["-1", "0.1"] }

[scheme]
kind = "transport_velocity"
artificial_viscosity = 1.0

[time]
end = 0.1

[[probe]]
name = "left"
kind = "extremum"
of = "largest"
field = "position.x"
body = "left"

[[probe]]
name = "right"
kind = "extremum"
of = "smallest"
field = "position.x"
body = "right"

[[probe]]
name = "plastic"
kind = "extremum"
of = "largest"
field = "plastic_strain"

[[probe]]
name = "hot"
kind = "extremum"
of = "largest"
field = "temperature"

[output]
table_every = 0.001
"#;

fn read(text: &str, set: &[&str]) -> Case {
    let overrides = set.iter().map(|text| (*text).to_owned()).collect();
    let options = LoadOptions { overrides, ..LoadOptions::default() };
    case::parse(text, "test", &options).unwrap_or_else(|problems| panic!("{problems}"))
}

#[test]
fn bodies_that_collide_part_again_and_keep_momentum_and_the_balance_of_energy() {
    for contact in ["repulsive", "penalty"] {
        let finished = run(DISCS, &[&format!("scheme.contact='{contact}'")]);
        assert_eq!(finished.summary.outcome, Outcome::Completed, "{contact}");
        let ends = |name: &str| *values(&finished, name).last().expect("there are rows");
        let faces = ["right.position.x", "left.position.x"].map(|name| values(&finished, name));
        let gaps: Vec<f64> = faces[0].iter().zip(&faces[1]).map(|(one, two)| one - two).collect();
        let (closest, last) = (gaps.iter().copied().fold(f64::MAX, f64::min), gaps[gaps.len() - 1]);
        // By half a spacing and more.
        assert!(last - closest > 0.05, "{contact}: {closest} m, at last {last} m apart");
        assert_eq!(ends("step.pieces"), 2.0, "{contact}");
        for axis in ["x", "y"] {
            let momentum = values(&finished, &format!("momentum.linear.{axis}"));
            let change = momentum.last().unwrap() - momentum[0];
            assert!(change.abs() < 1e-9 * 1e4, "{contact}: {change} kg m/s");
        }
        let balance = values(&finished, "energy.balance");
        let start = values(&finished, "energy.kinetic")[0];
        assert!(balance.iter().all(|balance| balance.abs() < 1e-10 * start), "{contact}");
        assert!(ends("energy.plasticity") < -1e-3 * start, "the left one flows");
        assert!(ends("energy.artificial_viscosity") < 0.0);
        let (plastic, hot) = (ends("plastic.plastic_strain"), ends("hot.temperature"));
        assert!(plastic > 1e-3 && hot > 293.15, "{plastic} {hot}");
    }
}

#[test]
fn an_extremum_in_a_box_counts_what_is_in_it_at_the_time() {
    let probe = |name: &str, min: [f64; 2], max: [f64; 2]| {
        format!(
            "[[probe]]\nname = \"{name}\"\nkind = \"extremum\"\nof = \"largest\"\n\
             field = \"position.x\"\nbody = \"left\"\nmin = {min:?}\nmax = {max:?}\n\n[output]"
        )
    };
    let text = DISCS.replace("[output]", &probe("front", [-2.0, -0.5], [-0.95, 0.5]));
    let text = text.replace("[output]", &probe("nothing", [3.0, -0.5], [4.0, 0.5]));
    let finished = run(&text, &["parameters.gap=1", "time.end=0.05"]);
    let [all, front] =
        ["left", "front"].map(|name| values(&finished, &format!("{name}.position.x")));
    // The disc moves by a spacing, through the face of the box: others become the first inside.
    assert!((all[all.len() - 1] - all[0] - 0.1).abs() < 0.01, "{all:?}");
    assert!(front.iter().all(|x| (-1.06..=-0.95).contains(x)), "{front:?}");
    assert!(front.windows(2).any(|pair| pair[1] < pair[0] - 0.05), "{front:?}");
    assert!(values(&finished, "nothing.position.x").iter().all(|x| x.is_nan()));
}

fn bits(state: &[f64]) -> Vec<u64> {
    state.iter().map(|value| value.to_bits()).collect()
}

/// The state after this many steps, with a scheme made anew after each `every` of them.
fn advanced(set: &[&str], steps: usize, every: usize) -> Vec<u64> {
    let step = 1.5e-4;
    let fresh = || Session::new(&read(DISCS, set)).unwrap_or_else(|problems| panic!("{problems}"));
    let mut session = fresh();
    let mut state = session.scheme().initial_state();
    let mut new = state.clone();
    let mut integrator =
        IntegratorKind::KickDriftKick.build(session.scheme()).expect("it moves the scheme");
    for count in 0..steps {
        if count > 0 && count % every == 0 {
            session = fresh();
        }
        let scheme = session.scheme();
        integrator
            .step(scheme, count as f64 * step, step, &state, &mut new)
            .expect("it is explicit");
        std::mem::swap(&mut state, &mut new);
    }
    bits(&state)
}

#[test]
fn states_of_solids_are_all_that_steps_depend_on() {
    let corrected = "scheme.corrected_gradients=true";
    let gtvf = ["scheme.shifting='background'", "scheme.corrections='gtvf'"];
    for set in [&[][..], &[corrected], &["scheme.shifting='ipst'", corrected], &gtvf] {
        assert!(advanced(set, 40, 7) == advanced(set, 40, 40), "{set:?}");
    }
}

#[test]
fn results_of_solids_do_not_depend_on_the_number_of_threads() {
    let with = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build();
        // More than a chunk of particles.
        pool.expect("threads can be started")
            .install(|| advanced(&["parameters.dx=0.03", "parameters.gap=0"], 10, 10))
    };
    assert!(with(1) == with(3));
}

/// A soft block whose upper half has a velocity of its own.
const HALVES: &str = r#"
version = 1
title = "The halves of a block slide or part"
dimension = 2

[parameters]
along = 1.0
across = 0.0

[[body]]
name = "block"
shape = { kind = "box", min = [0.0, 0.0], max = [1.0, 0.4] }
spacing = 0.05
lattice = { on = "cells" }
material = { kind = "hypoelastic", density = 1000.0, bulk_modulus = 1e5, shear_modulus = 1.0 }
initial = { velocity = ["along * (y - 0.2) / abs(y - 0.2)", "across * (y - 0.2) / abs(y - 0.2)"] }

[scheme]
kind = "transport_velocity"

[time]
end = 0.1

[output]
table_every = 0.01
"#;

#[test]
fn a_gap_is_empty() {
    // Halves that slide by four spacings have others where their neighbours were.
    let gaps = values(&run(HALVES, &[]), "step.gap");
    assert!(gaps.iter().all(|gap| *gap < 2.0), "{gaps:?}");
    // Halves that part by 0.2 m leave nothing between them, but for what tension takes of their speed.
    let gaps = values(&run(HALVES, &["parameters.along=0", "parameters.across=8"]), "step.gap");
    assert!(gaps.last().is_some_and(|gap| *gap > 4.0), "{gaps:?}");
}
