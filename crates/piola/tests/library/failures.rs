//! Runs that really go wrong: that each ends at once, says what, where, when and why, and leaves
//! what it takes to understand it.
#![allow(clippy::unwrap_used, reason = "a test that cannot set itself up has failed")]

use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicBool, Ordering};

use piola::case::{self, Case, Finished, LoadOptions, Session};
use piola::observe::Series;
use piola::time::{Failure, Outcome, Progress};

use super::resume;

fn load(name: &str, set: &[&str]) -> Case {
    load_of("upwind", name, set)
}

fn load_of(scheme: &str, name: &str, set: &[&str]) -> Case {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../cases").join(scheme).join(name);
    let overrides = set.iter().map(|text| (*text).to_owned()).collect();
    let options = LoadOptions { overrides, ..LoadOptions::default() };
    case::load(&path.join("case.toml"), &options).unwrap_or_else(|problems| panic!("{problems}"))
}

fn run(case: &Case, folder: Option<&Path>) -> Finished {
    let mut session = Session::new(case).unwrap_or_else(|problems| panic!("{problems}"));
    folder.into_iter().for_each(|folder| session.write_to(folder).unwrap());
    session.run(&AtomicBool::new(false), &mut |_| {}).unwrap()
}

fn failure(finished: &Finished) -> &Failure {
    match &finished.summary.outcome {
        Outcome::Failed(failure) => failure,
        other => panic!("{other:?}"),
    }
}

/// A column of numbers of the trace.
fn column(finished: &Finished, name: &str) -> Vec<f64> {
    let trace = finished.summary.trace.as_ref().unwrap();
    let index = trace.columns.iter().position(|(known, _)| known == name).unwrap();
    trace.numbers.chunks_exact(trace.columns.len()).map(|row| row[index]).collect()
}

/// What an integrator takes by design is not put down to its steps being too large.
#[test]
fn energy_that_is_damped_is_said_to_be() {
    let warnings = |rule: &[&str]| {
        let steps =
            ["parameters.dx=0.5", "time.end=0.04", "time.step=0.002", "output.table_every=0.002"];
        let set = [&steps, rule].concat();
        run(&load_of("dual-support", "free-vibration", &set), None).warnings
    };
    let damped = warnings(&["time.integrator='generalised_alpha'", "time.spectral_radius=0"]);
    assert!(damped.iter().any(|text| text.contains("the integrator damps")), "{damped:?}");
    let undamped = warnings(&["time.integrator='newmark'"]);
    assert!(!undamped.iter().any(|text| text.contains("accounted for")), "{undamped:?}");
}

/// Five times the stable step without upwinding: the column breaks up.
#[test]
fn a_step_that_is_too_large() {
    let set = ["time.cfl=2.5", "scheme.tau_velocity=0", "time.integrator='tvd_rk2'"];
    let finished = run(&load("column-impact", &set), None);
    let Failure::Inverted { particle, ratio, step, time, advice, .. } = failure(&finished) else {
        panic!("{:?}", finished.summary.outcome)
    };
    assert!(*ratio <= 0.0 && advice.contains("`time.cfl`"), "{ratio}: {advice}");
    // It ends with the step that broke it, and what it leaves is the state before.
    assert_eq!(*step, finished.summary.steps + 1);
    assert!(*time > finished.summary.time && finished.summary.worst.smallest_ratio > 0.0);
    let rows = finished.tables.steps.values("smallest_ratio").unwrap();
    assert!(rows.iter().all(|ratio| *ratio > 0.0));
    // Most of the energy came from nowhere, and that is said too.
    assert!(finished.warnings.iter().any(|text| text.contains("is not accounted for")));

    // The trace shows the particle and those around it, up to the step that broke it.
    let (ids, bad) = (column(&finished, "particle"), column(&finished, "is_bad"));
    let steps = column(&finished, "step");
    let here: Vec<usize> = (0..ids.len()).filter(|&row| bad[row] == 1.0).collect();
    assert!(here.iter().all(|&row| ids[row] == f64::from(particle.id)));
    let last = (step + 1 - here.len() as u64..=*step).map(|step| step as f64);
    assert!(here.len() >= 10 && here.iter().map(|&row| steps[row]).eq(last), "{steps:?}");
    let around = ids.len() / here.len();
    assert!(around >= 3 && around * here.len() == ids.len());
    let ratios: Vec<f64> = here.iter().map(|&row| column(&finished, "volume_ratio")[row]).collect();
    let smallest = |row: usize| ratios[row].min(column(&finished, "determinant")[here[row]]);
    assert_eq!(smallest(here.len() - 1), *ratio);
    assert!((0..here.len() - 1).all(|row| smallest(row) > 0.0));
}

/// The steps of the trace are taken anew; they are those of the run to the bit.
#[test]
fn the_trace_is_what_happened() {
    let set = ["time.cfl=2.5", "scheme.tau_velocity=0", "time.integrator='tvd_rk2'"];
    let finished = run(&load("column-impact", &set), None);
    let place = match failure(&finished) {
        Failure::Inverted { particle, .. } => format!("{:?}", particle.reference),
        other => panic!("{other:?}"),
    };
    let [probe, fields] = [
        format!("probe.top.at={place}"),
        "probe.top.fields=['displacement', 'acceleration']".to_owned(),
    ];
    let seen = run(&load("column-impact", &[set[0], set[1], set[2], &probe, &fields]), None);
    let of_last = |name: &str| {
        let rows = column(&seen, "step").into_iter().zip(column(&seen, "is_bad"));
        let row = rows.into_iter().position(|row| row == (seen.summary.steps as f64, 1.0));
        column(&seen, name)[row.unwrap()]
    };
    for name in ["displacement.x", "displacement.y", "acceleration.x", "acceleration.y"] {
        let recorded = seen.tables.probes.values(&format!("top.{name}")).unwrap();
        assert_eq!(recorded.last().copied(), Some(of_last(name)), "{name}");
    }
}

/// Fewer neighbours than a gradient needs are noticed before the run, with the place in the file.
#[test]
fn a_kernel_that_is_too_narrow() {
    let case = load("column-impact", &["scheme.smoothing_length=0.3"]);
    let problems = Session::new(&case).err().unwrap().to_string();
    for part in ["has 0 neighbours", "enlarge the smoothing length", "with this smoothing length"] {
        assert!(problems.contains(part), "{problems}");
    }
}

/// Bodies that would touch themselves where they are whole are noticed, with the place of the key.
#[test]
fn a_self_contact_within_the_support() {
    let case =
        load_of("ctvf", "rings", &["scheme.self_contact=2.9", "scheme.smoothing_length=1.0"]);
    let problems = Session::new(&case).err().unwrap().to_string();
    for part in
        ["began 2.900e-3 m apart", "reaches 3.000e-3 m", "self_contact=2.9", "make it larger"]
    {
        assert!(problems.contains(part), "{problems}");
    }
}

/// The linear law costs finite energy to squeeze to nothing: at 8 m/s a column has it.
#[test]
fn the_linear_law_under_collapse() {
    let finished = run(&load("impact-linear", &["parameters.speed=8"]), None);
    let Failure::StepBelowFloor { ratio, advice, .. } = failure(&finished) else {
        panic!("{:?}", finished.summary.outcome)
    };
    assert!(*ratio < 1e-3 && advice.contains("Upwind (6.28)") && advice.contains("gamma_law"));
    assert!(finished.summary.trace.is_some());
}

/// A stiffness a thousand times too small: a piston that is faster than sound.
#[test]
fn a_parameter_that_is_wrong_by_a_thousand() {
    let case = load("piston", &["parameters.E=1e2"]);
    let plan = Session::new(&case).unwrap().plan();
    let is_told = |texts: &[String]| texts.iter().any(|text| text.contains("check the stiffness"));
    assert!(is_told(&plan.warnings), "{:?}", plan.warnings);
    let finished = run(&case, None);
    assert!(is_told(&finished.warnings));
    let text = failure(&finished).to_string();
    assert!(text.contains("is above the wave speed of the material, 2.673e-1 m/s"), "{text}");
    // At the right stiffness nothing of this is said.
    assert!(!is_told(&Session::new(&load("piston", &[])).unwrap().plan().warnings));
}

/// Upwinding bounds the column's ratios while it is torn apart: what shows is the speed.
#[test]
fn a_particle_that_is_far_too_fast() {
    let set = ["time.cfl=3", "scheme.tau_velocity=0.05"];
    let finished = run(&load("column-impact", &set), None);
    let Failure::TooFast { speed, limit, .. } = failure(&finished) else {
        panic!("{:?}", finished.summary.outcome)
    };
    // Ten times the speed of 1 m/s and the wave speed of 10 m/s together.
    assert!((limit - 110.0).abs() < 1e-9 && speed > limit, "{speed} {limit}");
    assert!(finished.summary.worst.largest_speed <= *limit);
    let finished = run(&load("column-impact", &[set[0], set[1], "time.max_speed=20"]), None);
    let Failure::TooFast { limit, time, .. } = failure(&finished) else {
        panic!("{:?}", finished.summary.outcome)
    };
    assert!(*limit == 20.0 && *time < 1.33, "{limit} {time}");
}

#[test]
fn a_load_that_is_no_number() {
    let load = "load=[{ kind = 'body_force', acceleration = [0, 'sqrt(0.05 - t)'] }]";
    let finished = run(&self::load("column-impact", &[load]), None);
    let Failure::NotFinite { particle, time, .. } = failure(&finished) else {
        panic!("{:?}", finished.summary.outcome)
    };
    assert!(particle.id < 225 && *time > 0.05 && *time < 0.07, "{time}");
    assert!(finished.summary.time <= 0.05 + 1e-9);
    let trace = finished.summary.trace.as_ref().unwrap();
    assert!(trace.numbers.iter().any(|number| number.is_nan()));
}

/// What to change is a key of the scheme that runs, not of another.
#[test]
fn the_advice_is_that_of_the_scheme() {
    for (case, end, keys) in [
        ("column-impact", 0.01, &["tau_velocity"][..]),
        ("../ctvf/couette", 0.01, &["artificial_viscosity"]),
        ("../elastodynamics/wave-2d", 1e-5, &["viscosity", "hourglass"]),
    ] {
        let force = format!("{{ kind = 'body_force', acceleration = [0, 'sqrt({end} - t)'] }}");
        let load = format!("load=[{force}]");
        let text = failure(&run(&self::load(case, &[&load]), None)).to_string();
        assert!(text.contains("not finite"), "{text}");
        assert_eq!(text.matches("`scheme.").count(), keys.len(), "{text}");
        // Nothing is advised twice.
        assert_eq!(text.matches("`time.cfl`").count(), 1, "{text}");
        for key in keys {
            assert_eq!(text.matches(&format!("`scheme.{key}`")).count(), 1, "{text}");
        }
    }
}

const RETRIED: [&str; 4] = [
    "body.water.spacing=0.1",
    "time.cfl=2",
    "time.on_failure='retry'",
    "output.compression='none'",
];

/// A run that goes back leaves the results of the steps that it kept, and says how often it did.
#[test]
fn a_retried_run_gets_to_its_end() {
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().join("out");
    let finished = run(&load("dam-break", &RETRIED), Some(&out));
    assert_eq!(finished.summary.outcome, Outcome::Completed);
    let retries = &finished.summary.retries;
    assert!((1..=5).contains(&retries.len()), "{retries:?}");
    for (count, retry) in (1..).zip(retries) {
        assert!(retry.back_to < retry.time && retry.factor == 0.5_f64.powi(count));
    }
    // No row and no file is left of what was given up.
    for table in finished.tables.all() {
        let times: Vec<f64> = table.column(0).collect();
        assert_eq!(times.len(), 101);
        assert!(times.windows(2).all(|pair| pair[0] < pair[1]));
    }
    let files = |end: &str| {
        let is_such = |path: &&PathBuf| path.extension().is_some_and(|found| found == end);
        finished.files.iter().filter(is_such).count()
    };
    let frames = std::fs::read_dir(out.join("particles")).unwrap().count();
    assert_eq!((files("vtp"), frames), (21, 21));
    let record = std::fs::read_to_string(out.join("run.json")).unwrap();
    assert!(record.contains("\"retries\": [\n    {\n      \"failure\": \"particle"), "{record}");
    let Some(Series::Number { value, .. }) = finished.quantity("run.retries") else {
        panic!("a number of the run")
    };
    assert_eq!(value, retries.len() as f64);
}

#[test]
fn the_number_of_retries_is_bounded() {
    // What is as soft as this collapses with any step.
    let set = ["parameters.E=1e2", "time.on_failure='retry'", "time.retries=3"];
    let finished = run(&load("piston", &set), None);
    assert!(matches!(finished.summary.outcome, Outcome::Failed(_)));
    assert_eq!(finished.summary.retries.len(), 3);
}

/// What a run goes back to is in its checkpoints: interrupted between that and the failure, it goes
/// the same way.
#[test]
fn a_retried_run_resumes_to_the_bit() {
    let folder = tempfile::tempdir().unwrap();
    let case = load("dam-break", &RETRIED);
    let whole = run(&case, None);
    let retry = whole.summary.retries.first().unwrap();
    let out = folder.path().join("out");
    let stop = AtomicBool::new(false);
    let mut until = |progress: &Progress| {
        stop.store(progress.step + 2 >= retry.step, Ordering::Relaxed);
    };
    let mut session = Session::new(&case).unwrap();
    session.write_to(&out).unwrap();
    let first = session.run(&stop, &mut until).unwrap();
    assert_eq!(first.summary.outcome, Outcome::Interrupted);
    assert!(first.summary.retries.is_empty() && first.summary.time > retry.back_to);
    stop.store(false, Ordering::Relaxed);
    let mut session = Session::new(&case).unwrap();
    session.resume_from(&out).unwrap();
    let last = session.run(&stop, &mut |_| {}).unwrap();
    assert_eq!(last.tables, whole.tables);
    assert_eq!(last.summary.retries, whole.summary.retries);
}

/// A sheet of rubber is pressed together: a slender one buckles, and steps that are far too large
/// turn it inside out or lead nowhere.
#[test]
fn what_statics_misses_is_named() {
    let missed = |set: &[&str]| {
        let coarse = ["parameters.dx='side / 10'", "time.on_failure='stop'"];
        let finished = run(&load_of("dual-support", "rubber", &[&coarse, set].concat()), None);
        let failure = failure(&finished);
        let kind = failure.kind();
        (kind, failure.to_string(), finished.summary.time)
    };
    let slender = "body.sheet.shape.max=['side / 5', 'side']";
    let (kind, message, reached) = missed(&[slender, "parameters.pull='-0.3 * side'"]);
    assert_eq!(kind, "unstable");
    // Clamped at both ends, Euler's strain is 4 pi^2 / (12 * 25) = 0.1316, at a load factor of 0.439.
    let named = ["buckles", "load factor of 0.45", "stable at 0.4", "one direction"];
    assert!(named.iter().all(|text| message.contains(text)), "{message}");
    assert!((reached - 0.4).abs() < 1e-12, "it is left where it was sound: {reached}");

    let at_once = ["time.step=1", "output.every=1", "output.table_every=1"];
    let (kind, message, reached) =
        missed(&[&at_once[..], &["parameters.pull='-2 * side'"]].concat());
    assert_eq!((kind, reached), ("inverted", 0.0));
    assert!(message.contains("is inverted") && message.contains("`time.step`"), "{message}");
    let (kind, message, reached) =
        missed(&[&at_once[..], &["parameters.pull='500 * side'"]].concat());
    assert_eq!((kind, reached), ("no_convergence", 0.0));
    // Which particle it is follows from the rounding: the iteration goes nowhere.
    let named = ["the residual went 1.0e0", "is at particle ", "`time.step`", "halves it"];
    assert!(named.iter().all(|text| message.contains(text)), "{message}");
}

/// The bar of E11 at nu 0.49 loses its convexity at a stretch of 3.63; at nu 0.3 it never does.
#[test]
fn a_material_that_loses_its_convexity_is_named_once() {
    let warnings = |ratio: &str| {
        let set = ["parameters.homogeneous=0", "parameters.cells=30", ratio];
        let finished = run(&load_of("elastodynamics", "stretch", &set), None);
        let lost = |text: &&String| text.contains("has lost its convexity");
        finished.warnings.iter().filter(lost).cloned().collect::<Vec<_>>()
    };
    let [warning] = &warnings("parameters.nu=0.49")[..] else { panic!("one warning") };
    let stretch = warning.split("at principal stretches from ").nth(1).unwrap();
    let stretch: f64 = stretch.split(' ').next().unwrap().parse().unwrap();
    assert!((3.63..4.0).contains(&stretch), "{warning}");
    assert!(warning.contains("`scheme.viscosity`") && warning.contains("first seen at t = "));
    assert_eq!(warnings("parameters.nu=0.3").len(), 0);
}

/// Beyond the bound of an explicit integrator, and a probe 7 m beside the column: both are said before the
/// run, and nothing is of the case as it stands.
#[test]
fn steps_and_probes_that_are_far_off_are_told() {
    let told = |set: &[&str]| Session::new(&load("piston", set)).unwrap().plan().warnings;
    let step = told(&["time.cfl=5"]);
    assert!(step.iter().any(|text| text.contains("steps 5 times as long")), "{step:?}");
    let probe = told(&["probe.0.at=[10.0, 2.5]"]);
    let named = "`top` follows a particle that is 7.0000 m away from its point, 21.0 spacings";
    assert!(probe.iter().any(|text| text.contains(named)), "{probe:?}");
    assert_eq!(told(&[]), Vec::<String>::new());
    assert_eq!(told(&["time.integrator='crank_nicolson'", "time.cfl=5"]), Vec::<String>::new());
}

/// A shallow arch under twice the load that it snaps at, in one step: a state is found, and that it may not
/// belong to the path is said. Half of that load is borne.
#[test]
fn a_load_step_over_a_limit_is_told() {
    let warnings = |load: &str| {
        let steps = [format!("time.end={load}"), format!("time.step={load}")];
        let every = [format!("output.every={load}"), format!("output.table_every={load}")];
        let mut set =
            vec!["body.arch.shape.file='arch-909.msh'", "time.integrator='static'", "picture=[]"];
        set.extend(steps.iter().chain(&every).map(String::as_str));
        run(&load_of("dual-support", "arch", &set), None).warnings
    };
    let told = |texts: &[String]| texts.iter().any(|text| text.contains("may not lie on the path"));
    let over = warnings("2.0");
    assert!(told(&over), "{over:?}");
    let under = warnings("0.5");
    assert!(!told(&under), "{under:?}");
}

/// A run that something outside of it ends, at its state or because that is already affected, says so, and goes on as one
/// that was never ended.
#[test]
fn a_run_that_is_given_up_goes_on() {
    let case = load("piston", &["parameters.n=10", "time.end=0.5", "picture=", "plot="]);
    let folder = tempfile::tempdir().unwrap();
    let whole = folder.path().join("whole");
    let steps = resume::run(&case, &whole, false, 1, u64::MAX).summary.steps;
    assert!(steps > 60, "{steps}");
    for is_affected in [false, true] {
        let broken = folder.path().join(format!("affected-{is_affected}"));
        let mut session = Session::new(&case).unwrap_or_else(|problems| panic!("{problems}"));
        session.write_to(&broken).unwrap();
        (0..40).for_each(|_| assert!(session.step().unwrap()));
        session.give_up("the sky has fallen".into(), is_affected);
        let summary = session.finish().unwrap().summary;
        assert_eq!(summary.outcome.summary(), "failed: outside");
        let Outcome::Failed(failure) = &summary.outcome else { panic!("it goes on") };
        assert!(failure.to_string().starts_with("the sky has fallen; "), "{failure}");
        // The last mark is at a multiple of 16 steps.
        assert_eq!(summary.steps, if is_affected { 32 } else { 40 });
        let last = resume::run(&case, &broken, true, 1, u64::MAX);
        assert_eq!(last.summary.resumed.map(|(_, step)| step), Some(summary.steps));
        resume::assert_same(&whole, &broken, "a run that was given up");
    }
}
