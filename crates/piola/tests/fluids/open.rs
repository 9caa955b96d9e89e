//! Fluid that comes in and goes out through open boundaries.

use std::collections::BTreeSet;
use std::sync::atomic::AtomicBool;

use piola::case::{self, Finished, LoadOptions, Session};
use piola::time::Outcome;

/// A stream of 1 m/s without walls: it repeats itself across.
fn stream(dimension: usize) -> String {
    let bounds = |low: &str, high: &str| {
        let all = |first: &str, other: &str| {
            let rest = std::iter::repeat_n(other, dimension - 1);
            let ends: Vec<&str> = std::iter::once(first).chain(rest).collect();
            format!("[{}]", ends.join(", "))
        };
        format!("min = {}, max = {}", all(low, "0.0"), all(high, "0.4"))
    };
    let along = |sign: &str| {
        let rest = vec!["0.0"; dimension - 1];
        let all: Vec<&str> = std::iter::once(sign).chain(rest).collect();
        format!("[{}]", all.join(", "))
    };
    let speed = along("\"speed\"").replace("0.0", "\"0\"");
    let inflow = along("\"inflow\"").replace("0.0", "\"0\"");
    let domain = match dimension {
        1 => "",
        2 => "[domain]\nperiodic = { y = [0.0, 0.4] }\n",
        _ => "[domain]\nperiodic = { y = [0.0, 0.4], z = [0.0, 0.4] }\n",
    };
    let body = |name: &str, bounds: String, rest: &str| {
        format!(
            "[[body]]\nname = \"{name}\"\nshape = {{ kind = \"box\", {bounds} }}\nspacing = \"dx\"\n\
             lattice = {{ on = \"cells\" }}\n\
             material = {{ kind = \"weakly_compressible\", density = 2.0, wave_speed = 20.0 }}\n{rest}\n"
        )
    };
    let bodies = [
        body("water", bounds("0.0", "0.6"), &format!("initial = {{ velocity = {speed} }}")),
        body(
            "inlet",
            bounds("-0.2", "0.0"),
            &format!("opening = {{ normal = {}, velocity = {inflow} }}", along("3.0")),
        ),
        body(
            "outlet",
            bounds("0.6", "0.8"),
            &format!("opening = {{ normal = {}, pressure = \"0\" }}", along("-1.0")),
        ),
    ];
    format!(
        "version = 1\ntitle = \"A stream\"\ndimension = {dimension}\n[parameters]\ndx = 0.05\n\
         speed = 1.0\ninflow = 1.0\n{domain}{}[scheme]\nkind = \"transport_velocity\"\n\
         [time]\nend = 1.0\n[[probe]]\nname = \"error\"\nkind = \"error\"\nbody = \"water\"\n\
         field = \"velocity.x\"\nexact = \"speed\"\n[output]\nevery = 1.0\ntable_every = 0.05\n",
        bodies.concat()
    )
}

fn session(text: &str, set: &[&str]) -> Result<Session, String> {
    let overrides = set.iter().map(|text| (*text).to_owned()).collect();
    let options = LoadOptions { overrides, ..LoadOptions::default() };
    let case = case::parse(text, "case.toml", &options).map_err(|error| error.to_string())?;
    Session::new(&case).map_err(|error| error.to_string())
}

fn run(text: &str, set: &[&str]) -> Finished {
    let session = session(text, set).unwrap_or_else(|error| panic!("{error}"));
    session.run(&AtomicBool::new(false), &mut |_| {}).expect("it runs")
}

fn values(finished: &Finished, name: &str) -> Vec<f64> {
    let tables = &finished.tables;
    let (table, column) = name.split_once('.').expect("a table and a column");
    let values = match table {
        "step" => tables.steps.values(column),
        "energy" => tables.energy.values(column),
        "momentum" => tables.momentum.values(column),
        _ => tables.probes.values(name),
    };
    values.unwrap_or_else(|| panic!("no `{name}`")).to_vec()
}

/// A stream of 1 m/s that is let in and out stays what it is: a lattice that goes on without end moves as one. In the
/// time of the run all of the fluid is another.
#[test]
fn a_uniform_stream_goes_through_unchanged() {
    for dimension in [1, 2, 3] {
        let finished = run(&stream(dimension), &[]);
        assert_eq!(finished.summary.outcome.summary(), "completed", "in {dimension}D");
        let worst = values(&finished, "error.error").into_iter().fold(0.0, f64::max);
        assert!(worst < 1e-9, "{worst} in {dimension}D");
        // 1 m of the stream with a density of 2, in whole layers that have gone through.
        let area = 0.4_f64.powi(dimension as i32 - 1);
        for name in ["step.entered", "step.left"] {
            let mass = values(&finished, name).pop().expect("a row");
            assert!(
                (mass - 2.0 * area).abs() < 2.0 * area * 0.05 * 1.3,
                "{name} {mass} in {dimension}D"
            );
        }
    }
}

/// What is there is what there was and what has come in less what has gone out, and no two particles are the same one.
#[test]
fn numbers_of_particles_are_unique_and_their_mass_is_kept() {
    let mut session = session(&stream(2), &["parameters.inflow=1.5"]).expect("it is built");
    let known = |session: &mut Session| -> (f64, usize) {
        let [density, opening, birth] = ["density", "opening", "birth"]
            .map(|name| session.column(name).expect("it is there").values);
        let is_there = |a: &usize| density[*a] > 0.0;
        let born: Vec<u64> = (0..density.len())
            .filter(is_there)
            .map(|a| birth[a] as u64)
            .filter(|b| *b > 0)
            .collect();
        let all: BTreeSet<u64> = born.iter().copied().collect();
        assert_eq!(all.len(), born.len(), "two particles of one number");
        let inside = (0..density.len()).filter(is_there).filter(|&a| opening[a] == 0.0).count();
        (inside as f64, born.len())
    };
    let (before, born) = known(&mut session);
    assert_eq!(born, 0);
    session.run_until(0.7).expect("it runs");
    let (after, born) = known(&mut session);
    assert!(born > 50, "{born}");
    let finished = session.run(&AtomicBool::new(false), &mut |_| {}).expect("it runs");
    let [entered, left] = ["step.entered", "step.left"].map(|name| {
        let all = values(&finished, name);
        all[14]
    });
    let mass = 2.0 * 0.05 * 0.05;
    assert!(((after - before) * mass - (entered - left)).abs() < 1e-12);
}

/// What the forces of buffers and what goes through them do is all that changes the energy and the momentum of a fluid.
#[test]
fn the_ledger_of_a_stream_that_comes_and_goes_balances() {
    let swing = ["parameters.inflow=0.0", "body.inlet.opening.velocity=['1.5 * sin(6 * t)', '0']"];
    let finished = run(&stream(2), &swing);
    assert_eq!(finished.summary.outcome.summary(), "completed");
    for name in ["energy.balance", "momentum.balance.linear.x"] {
        let worst = values(&finished, name).into_iter().fold(0.0, |most: f64, x| most.max(x.abs()));
        assert!(worst < 1e-12, "{name} {worst}");
    }
    // There are no walls, and what buffers do is told apart from what walls do.
    let most = |name: &str| {
        values(&finished, name).into_iter().fold(0.0, |most: f64, x| most.max(x.abs()))
    };
    assert!(most("energy.walls") < 1e-12 && most("momentum.walls.linear.x") < 1e-12);
    assert!(most("energy.openings") > 0.1);
    // It comes in at both ends and goes out at both.
    let left = values(&finished, "step.left").pop().expect("a row");
    assert!(left > 2.0 * 0.4 * 0.2, "{left}");
}

/// A flow rate is that of the whole opening.
#[test]
fn a_flow_rate_is_shared_by_all_that_comes_in() {
    let rate = "body.inlet.opening={ normal = [1.0, 0.0], flow_rate = '0.4 * speed' }";
    let worst = values(&run(&stream(2), &[rate]), "error.error").into_iter().fold(0.0, f64::max);
    assert!(worst < 1e-9, "{worst}");
}

/// A closed end, against which fluid is pressed: when no particle is left to come in the run ends, and tells what to do.
#[test]
fn a_reserve_that_is_used_up_is_named() {
    let set = [
        "scheme.reserve=4",
        "body.inlet.opening.relaxation=0.01",
        "body.outlet.opening={ normal = [-1.0, 0.0], velocity = ['0', '0'] }",
    ];
    let finished = run(&stream(2), &set);
    let Outcome::Failed(failure) = &finished.summary.outcome else { panic!("it goes on") };
    let told = failure.to_string();
    assert!(told.contains("through the open boundary `inlet`"), "{told}");
    assert!(told.contains("raise `scheme.reserve`"), "{told}");
}

#[test]
fn openings_that_cannot_work_are_refused() {
    let refused = |set: &[&str], what: &str| {
        let told = match session(&stream(2), set) {
            Ok(_) => panic!("accepted: {what}"),
            Err(told) => told,
        };
        assert!(told.contains(what), "{told}");
    };
    refused(&["body.inlet.shape.min=[-0.1, 0.0]"], "the fluid would see its end");
    refused(
        &["body.inlet.opening.normal=[-1.0, 0.0]"],
        "no fluid is in front of the opening `inlet`",
    );
    refused(&["body.inlet.opening.velocity=['1/(y - y)', '0']"], "no number");
    refused(
        &["body.inlet.opening.pressure='0'"],
        "`velocity` and `pressure` cannot both be prescribed",
    );
    refused(&["body.outlet.opening={ normal = [-1.0, 0.0] }"], "needs one of `velocity`");
    refused(
        &["body.inlet.opening={ normal = [1.0, 0.0], flow_rate = 'y' }"],
        "depends on the time alone",
    );
    refused(&["body.inlet.opening.normal=[1.0, 0.1]"], "points along a periodic axis");
    refused(&["body.inlet.initial={ pressure = '1' }"], "in the buffer of an opening");
    refused(&["body.inlet.wall={}"], "a wall is no opening");
    let wall = "body+={ name = 'wall', shape = { kind = 'box', min = [-0.1, 0.1], max = [0.0, 0.2] }, spacing = 0.05, \
                lattice = { on = 'cells' }, wall = {}, \
                material = { kind = 'weakly_compressible', density = 2.0, wave_speed = 20.0 } }";
    refused(&[wall], "the wall `wall` is in the opening `inlet`");
}

/// Where both ends are prescribed and do not agree there is a warning with the difference.
#[test]
fn flow_rates_that_do_not_balance_are_told() {
    let set = ["body.outlet.opening={ normal = [-1.0, 0.0], velocity = ['0.5', '0'] }"];
    let mut session = session(&stream(2), &set).expect("it is built");
    let warnings = session.plan().warnings;
    assert!(warnings.iter().any(|it| it.contains("2.000e-1 m^D/s more come in")), "{warnings:?}");
}
