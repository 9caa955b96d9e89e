//! Fluid whose motion dies out, and walls that make waves.

use std::sync::atomic::AtomicBool;

use piola::case::Finished;

use super::support::{run, session, session_beside, values};

/// A uniform stream in a periodic box.
const STREAM: &str = "version = 1\ntitle = \"A stream\"\ndimension = 2\n\
    [parameters]\nrate = 3.0\ndt = 1e-3\n\
    [domain]\nperiodic = { x = [0.0, 0.5], y = [0.0, 0.5] }\n\
    [[body]]\nname = \"water\"\nshape = { kind = \"box\", min = [0, 0], max = [0.5, 0.5] }\n\
    spacing = 0.05\nlattice = { on = \"cells\" }\n\
    material = { kind = \"weakly_compressible\", density = 2.0, wave_speed = 10.0 }\n\
    initial = { velocity = [\"0.6\", \"0.8\"] }\n\
    [scheme]\nkind = \"transport_velocity\"\ndamping = \"rate\"\n\
    [time]\nend = 0.5\nstep = \"dt\"\n\
    [[probe]]\nname = \"mean\"\nkind = \"mean\"\nfield = \"velocity\"\n\
    [output]\nevery = 0.5\ntable_every = 0.05\n";

/// A tank whose left wall may push.
const TANK: &str = "version = 1\ntitle = \"A tank\"\ndimension = 2\n\
    [[body]]\nname = \"water\"\nshape = { kind = \"box\", min = [0, 0], max = [0.8, 0.4] }\n\
    spacing = 0.05\nlattice = { on = \"cells\" }\n\
    material = { kind = \"weakly_compressible\", density = 1000, wave_speed = 20.0 }\n\
    [[body]]\nname = \"tank\"\nshape = { kind = \"union\", of = [\
    { kind = \"box\", min = [-0.4, -0.2], max = [1.0, 0.0] }, \
    { kind = \"box\", min = [0.8, 0.0], max = [1.0, 0.7] }] }\n\
    spacing = 0.05\nlattice = { on = \"cells\" }\n\
    material = { kind = \"weakly_compressible\", density = 1000, wave_speed = 20.0 }\n\
    wall = { slip = \"free\" }\n\
    [[body]]\nname = \"paddle\"\nshape = { kind = \"box\", min = [-0.2, 0.0], max = [0.0, 0.7] }\n\
    spacing = 0.05\nlattice = { on = \"cells\" }\n\
    material = { kind = \"weakly_compressible\", density = 1000, wave_speed = 20.0 }\n\
    wall = { slip = \"free\" }\n\
    [scheme]\nkind = \"transport_velocity\"\nfree_surface = true\n\
    [[load]]\nkind = \"body_force\"\nacceleration = [\"0\", \"-9.81\"]\n\
    [[boundary]]\nname = \"waves\"\nbody = \"paddle\"\nwhere = { kind = \"all\" }\n\
    wave_maker = { kind = \"regular\", depth = 0.4, height = 0.05, period = 1.0, ramp = 0.4 }\n\
    [time]\nend = 0.4\n\
    [[probe]]\nname = \"paddle\"\nkind = \"particle\"\nbody = \"paddle\"\nat = [0.0, 0.2]\n\
    fields = [\"position\"]\n[output]\nevery = 0.4\ntable_every = 0.1\n";

fn refusal(text: &str, set: &[&str]) -> String {
    session(text, set).err().expect("it is refused")
}

fn last(finished: &Finished, name: &str) -> f64 {
    *values(finished, name).last().expect("a row")
}

/// The velocity half a step back is damped: kicks of a half step at both ends, of whole ones between them. Energy and
/// momentum that are gone are booked.
#[test]
fn a_stream_dies_out_at_the_rate_of_its_damping() {
    let finished = run(STREAM, &[]);
    assert_eq!(finished.summary.outcome.summary(), "completed");
    let (rate, step, steps) = (3.0_f64, 1e-3, 500);
    let factor = (1.0 - 0.5 * rate * step).powi(2) * (1.0 - rate * step).powi(steps - 1);
    assert!((factor / (-rate * 0.5).exp() - 1.0).abs() < rate * step);
    assert!((last(&finished, "mean.velocity.x") - 0.6 * factor).abs() < 1e-12);
    assert!((last(&finished, "mean.velocity.y") - 0.8 * factor).abs() < 1e-12);
    // A quarter of a square metre with a density of 2 at 1 m/s.
    let energy = 0.25 * (factor * factor - 1.0);
    assert!((last(&finished, "energy.damping") - energy).abs() < 1e-12);
    assert!((last(&finished, "momentum.damping.linear.y") - 0.4 * (factor - 1.0)).abs() < 1e-12);
    for name in ["energy.balance", "momentum.balance.linear.x", "momentum.balance.linear.y"] {
        assert!(last(&finished, name).abs() < 1e-12, "{name}");
    }
    assert!(last(&finished, "energy.body_force").abs() < 1e-12);
}

/// Where it dies out on one side only, the ledger balances all the same.
#[test]
fn damping_is_that_of_the_place() {
    let finished = run(STREAM, &["scheme.damping='4 * step(y - 0.25)'"]);
    let taken = last(&finished, "energy.damping");
    // The stream goes through both sides: more than nothing is gone, and less than damping everywhere would take.
    assert!(taken < -0.05 && taken > 0.25 * (-4.0_f64).exp_m1(), "{taken}");
    for name in ["energy.balance", "momentum.balance.linear.x", "momentum.balance.linear.y"] {
        assert!(last(&finished, name).abs() < 1e-12, "{name}");
    }
}

#[test]
fn damping_that_feeds_motion_is_refused() {
    let told = refusal(STREAM, &["scheme.damping='x - 1'"]);
    assert!(told.contains("`damping` is -0.") && told.contains("this rate"), "{told}");
    let told = refusal(STREAM, &["scheme.damping='1 / (x - x)'"]);
    assert!(told.contains("`damping` is inf"), "{told}");
    let told = refusal(STREAM, &["scheme.damping='t'"]);
    assert!(told.contains('t'), "{told}");
    // A step must not be longer than the inverse of the rate.
    let told = run(STREAM, &["parameters.rate=3000.0"]);
    assert!(told.summary.outcome.summary() != "completed");
}

#[test]
fn waves_that_there_are_none_of_are_refused() {
    let regular = |rest: &str| {
        format!(
            "boundary.waves.wave_maker={{ kind = 'regular', depth = 0.4, gravity = 9.81, {rest} }}"
        )
    };
    for (rest, what) in [
        ("height = 0.2, period = 20", "too long for waves of second order"),
        ("height = 0.2, period = 0.4", "so steep that they break"),
        ("height = 0.4, period = 1", "break on 0.4 m of water"),
        ("height = 1e-300, period = 1e-200", "is not a number"),
    ] {
        let told = refusal(TANK, &[&regular(rest)]);
        assert!(told.contains(what), "{told}");
    }
}

/// The paddle is where the first quarter of its motion, a sine that grows, has brought it.
#[test]
fn a_paddle_moves_as_the_waves_ask_for() {
    let finished = run(TANK, &[]);
    let moved = last(&finished, "paddle.position.x") + 0.025;
    let kd = 1.7170_f64;
    assert!((kd * kd.tanh() - (2.0 * std::f64::consts::PI).powi(2) * 0.4 / 9.81).abs() < 3e-4);
    let ratio = 4.0 * kd.sinh().powi(2) / ((2.0 * kd).sinh() + 2.0 * kd);
    let second =
        0.05_f64.powi(2) / (32.0 * 0.4) * (3.0 * kd.cosh() / kd.sinh().powi(3) - 2.0 / ratio);
    let angle = 2.0 * std::f64::consts::PI * 0.4;
    let expected = 0.025 / ratio * angle.sin() + second * (2.0 * angle).sin();
    assert!((moved - expected).abs() < 2e-5, "{moved}, not {expected}");
    assert!(last(&finished, "energy.walls").abs() > 1e-3);
    let turned = "boundary.waves.wave_maker.direction=[-2, 0]";
    let other = last(&run(TANK, &[turned]), "paddle.position.x") + 0.025;
    assert!((other + expected).abs() < 2e-5, "{other}");
}

#[test]
fn waves_that_nobody_can_make_are_refused() {
    let told = refusal(TANK, &["boundary.waves.wave_maker.height=0.35"]);
    assert!(told.contains("waves of 0.35 m break on 0.4 m of water"), "{told}");
    let told = refusal(TANK, &["boundary.waves.velocity={ x = \"0\" }"]);
    assert!(told.contains("beside `wave_maker`"), "{told}");
    let told = refusal(TANK, &["boundary.waves.body=\"water\""]);
    assert!(told.contains("only walls move as prescribed"), "{told}");
    let told = refusal(TANK, &["boundary.waves.wave_maker.direction=[0, 0]"]);
    assert!(told.contains("must have a direction"), "{told}");
}

/// Water under waves may sink by the 1 % by which densities of a weakly compressible fluid vary, the centre of mass by half of
/// that. Without theory (108) it sinks by more while they travel two wavelengths.
#[test]
fn water_under_waves_keeps_its_volume() {
    let waves = include_str!("../../../../cases/open/waves/case.toml");
    let points = include_str!("../../../../cases/open/waves/points-16.csv");
    let sunk = |relaxation: &str| {
        let of_scheme = format!("[scheme]\n{relaxation}");
        let fewer = [
            ("n = 32 ", "n = 16 "),
            ("points-32", "points-16"),
            ("waves = 10.0", "waves = 2.0"),
            ("[scheme]\n", of_scheme.as_str()),
        ];
        let text = fewer.iter().fold(waves.to_owned(), |text, (from, to)| {
            assert!(text.contains(from), "{from}");
            text.replacen(from, to, 1)
        });
        let session = session_beside(&[("points-16.csv", points)], &text);
        let session = session.unwrap_or_else(|error| panic!("{error}"));
        let finished = session.run(&AtomicBool::new(false), &mut |_| {}).expect("it runs");
        // A wavelength of 4 m of water, 1 m deep.
        last(&finished, "energy.body_force") / (1000.0 * 9.81 * 4.0)
    };
    let [with, without] = [sunk(""), sunk("density_relaxation = 0\n")];
    assert!(with.abs() < 0.005, "the centre of mass has sunk by {with} m");
    assert!(without > 0.005, "by {without} m without");
}

/// What does not go with corrected gradients is said.
#[test]
fn what_does_not_go_with_corrected_gradients_is_refused() {
    let corrected = "scheme.corrected_gradients=true";
    for (set, what) in [
        (
            &[corrected, "scheme.corrections='stress'"][..],
            "need `corrections = \"full\"`, not `stress`",
        ),
        (
            &[corrected, "scheme.density='summation'", "scheme.pressure='state_equation'"],
            "nothing uses a divergence",
        ),
        (&["scheme.velocity_diffusion=0.1"], "without `corrected_gradients = true`"),
    ] {
        let text = refusal(TANK, set);
        assert!(text.contains(what), "{text}");
    }
}
