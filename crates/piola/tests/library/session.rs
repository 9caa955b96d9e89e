//! The one way into a run: however its steps are taken, the bits are the same.

use std::path::Path;
use std::sync::atomic::AtomicBool;
use std::sync::{Arc, Mutex};

use piola::case::{
    self, Case, ColumnError, FieldView, Finished, Level, LoadOptions, RunError, Session,
};
use piola::fields::Life;
use piola::time::{Moment, ObserveError, Observer, Outcome, Schedule};

fn load(name: &str, set: &[&str]) -> Case {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../cases").join(name);
    let overrides = set.iter().map(|text| (*text).to_owned()).collect();
    let options = LoadOptions { overrides, level: Level::Coarse, ..LoadOptions::default() };
    case::load(&path.join("case.toml"), &options).unwrap_or_else(|problems| panic!("{problems}"))
}

/// Every formulation, and every kind of integrator; the last goes back.
fn cases() -> Vec<Case> {
    let failing = ["body.water.spacing=0.1", "time.cfl=2", "time.on_failure='retry'"];
    vec![
        load("upwind/piston", &["time.end=0.2"]),
        load("upwind/stiff-column", &["time.error=0.1", "time.end=0.4"]),
        load("ctvf/taylor-green", &["time.end=0.05"]),
        load("ctvf/compression", &["time.end=1e-5"]),
        load("dual-support/free-vibration", &["time.end=0.01"]),
        load("dual-support/tension", &["time.step=0.25"]),
        load("elastodynamics/pulse", &["time.end=4e-6"]),
        load("elastodynamics/interpolation", &[]),
        load("upwind/dam-break", &failing),
    ]
}

fn session(case: &Case) -> Session {
    Session::new(case).unwrap_or_else(|problems| panic!("{problems}"))
}

/// What a formulation declares is filled by its stages, by each of them once.
#[test]
fn ledgers_are_filled() {
    let mut with_stages = Vec::new();
    for case in cases() {
        let mut session = session(&case);
        session.step().expect("it starts");
        let scheme = session.scheme();
        let (description, phases) = (scheme.description(), scheme.phases());
        // Statics runs no stages.
        if phases.iter().any(|phase| phase.stages.iter().any(|(_, watch)| watch.calls > 0)) {
            assert_eq!(description.ledger.faults(&phases), [], "{}", description.name);
            with_stages.push(description.name);
        }
    }
    with_stages.dedup();
    let all = ["upwind", "transport_velocity", "dual_support", "elastodynamics", "upwind"];
    assert_eq!(with_stages, all);
}

/// What an observer from outside saw.
#[derive(Clone, Debug, Default, PartialEq)]
struct Seen {
    times: Vec<f64>,
    speeds: Vec<f64>,
    state: Vec<u64>,
}

#[derive(Clone)]
struct Witness(Schedule, Arc<Mutex<Seen>>);

impl Witness {
    fn new(schedule: Schedule) -> Self {
        Self(schedule, Arc::default())
    }

    fn seen(&self) -> Seen {
        self.1.lock().expect("no other thread").clone()
    }
}

impl Observer for Witness {
    fn schedule(&self) -> &Schedule {
        &self.0
    }

    fn observe(&mut self, moment: &mut Moment) -> Result<(), ObserveError> {
        let mut seen = self.1.lock().expect("no other thread");
        let time = moment.now.time();
        if seen.times.last() != Some(&time) {
            seen.times.push(time);
            seen.speeds.push(moment.health.largest_speed);
        }
        seen.state = moment.now.state().iter().map(|number| number.to_bits()).collect();
        Ok(())
    }

    fn rewind(&mut self, time: f64) -> Result<(), ObserveError> {
        let mut seen = self.1.lock().expect("no other thread");
        let kept = seen.times.partition_point(|known| *known <= time);
        seen.times.truncate(kept);
        seen.speeds.truncate(kept);
        Ok(())
    }
}

fn run(session: Session) -> Finished {
    session.run(&AtomicBool::new(false), &mut |_| {}).expect("nothing is written")
}

/// A whole run, steps taken by hand, pieces, and a run that goes on in another session.
#[test]
fn however_steps_are_taken_the_bits_are_the_same() {
    for case in cases() {
        let every = Schedule::Every(*case.output.table_every);
        let watched = || {
            let (mut session, witness) = (session(&case), Witness::new(every.clone()));
            session.observe(Box::new(witness.clone()));
            (session, witness)
        };
        let end = *case.time.end;
        let (whole, witness) = watched();
        let whole = run(whole);
        assert_eq!(whole.summary.outcome, Outcome::Completed, "{}", case.title);
        let seen = witness.seen();
        // What it saw is what the tables have.
        let times = whole.tables.steps.values("time").unwrap();
        assert_eq!(seen.times, times, "{}", case.title);
        assert_eq!(seen.speeds, whole.tables.steps.values("largest_speed").unwrap());

        let same = |mut session: Session, witness: &Witness| {
            let finished = session.finish().unwrap();
            assert_eq!(finished.tables, whole.tables, "{}", case.title);
            let [one, other] = [&finished, &whole].map(|it| (it.summary.steps, it.summary.time));
            assert_eq!(one, other, "{}", case.title);
            assert_eq!(finished.summary.retries, whole.summary.retries, "{}", case.title);
            assert!(witness.seen() == seen, "{}", case.title);
        };
        let (mut by_hand, witness) = watched();
        while by_hand.step().unwrap() {}
        assert_eq!(by_hand.progress().step, whole.summary.steps);
        assert!(!by_hand.step().unwrap(), "there is nothing after the end");
        same(by_hand, &witness);

        let (mut pieces, witness) = watched();
        for share in [0.1, 0.37, 0.9] {
            pieces.run_until(share * end).unwrap();
            assert!(pieces.time() >= share * end * (1.0 - 1e-9));
        }
        assert!(!pieces.run_until(2.0 * end + 1.0).unwrap());
        same(pieces, &witness);

        let (mut first, witness) = watched();
        first.run_until(0.37 * end).unwrap();
        let checkpoint = first.checkpoint();
        assert_eq!(checkpoint.time(), first.time());
        drop(first);
        let mut last = session(&case);
        last.observe(Box::new(witness.clone()));
        last.resume(checkpoint).unwrap();
        while last.step().unwrap() {}
        same(last, &witness);
    }
    assert!(
        !run(session(cases().last().unwrap())).summary.retries.is_empty(),
        "the last goes back"
    );
}

/// Columns are those of the files, and setting them to what they are changes nothing.
#[test]
fn columns_are_read_and_set() {
    for case in cases() {
        let whole = run(session(&case));
        let mut again = session(&case);
        for column in again.columns() {
            let found = again.column(column.name).unwrap();
            let components = column.kind.components(case.dimension);
            assert_eq!(found.values.len(), again.ids().len() * components, "{}", column.name);
            match again.set(column.name, &found.values) {
                Ok(()) | Err(ColumnError::NotSettable { .. }) => {}
                Err(error) => panic!("{error}"),
            }
        }
        assert!(run(again).tables == whole.tables, "{}", case.title);
    }
}

#[test]
fn what_is_set_is_where_the_run_goes_on() {
    let case = load("elastodynamics/pulse", &["time.end=4e-6"]);
    let mut session = session(&case);
    session.run_until(2e-6).unwrap();
    let still = vec![0.0; session.column("velocity").unwrap().values.len()];
    session.set("velocity", &still).unwrap();
    session.set("displacement", &still).unwrap();
    assert!(session.column("velocity").unwrap().values.iter().all(|v| *v == 0.0));
    let witness = Witness::new(Schedule::Every(1e-7));
    session.observe(Box::new(witness.clone()));
    while session.step().unwrap() {}
    let before = session.finish().unwrap();
    let seen = witness.seen();
    assert!(seen.times[0] > 2e-6 && *seen.times.last().unwrap() == before.summary.time);

    let mut fluid = self::session(&load("upwind/dam-break", &["time.end=0.05"]));
    let speed = |fluid: &mut Session| {
        let values = fluid.column("velocity").unwrap().values;
        values.iter().fold(0.0_f64, |most, v| most.max(v.abs()))
    };
    fluid.run_until(0.02).unwrap();
    let first = speed(&mut fluid);
    let mut doubled = fluid.column("velocity").unwrap().values;
    doubled.iter_mut().for_each(|v| *v *= 2.0);
    fluid.set("velocity", &doubled).unwrap();
    assert_eq!(speed(&mut fluid), 2.0 * first);
    assert!(fluid.step().unwrap() && speed(&mut fluid) > 1.9 * first);
}

/// A slab on water, with expressions as initial velocities or at rest, in steps that do not follow its state; and nothing
/// shifts particles by what it remembers of the velocities before.
fn slab(initial: bool, kind: &[&str]) -> Case {
    let common = [
        "parameters.n=8",
        "scheme.shifting='none'",
        "time.step=1e-3",
        "time.end=0.02",
        "output.table_every=0.01",
    ];
    let mut set = [&common[..], kind].concat();
    if !initial {
        set.extend(["body.water.initial.velocity=", "body.slab.initial="]);
    }
    load("coupled/slab", &set)
}

/// Fields that are set at the start are those that a case begins with, of each system of a coupled run: to the bit. And a run
/// goes on from a checkpoint behind a change as it does without.
#[test]
fn systems_are_set_one_by_one() {
    let viscous = ["system.slab.scheme={ kind = 'dual_support', viscosity = 0.5 }"];
    let implicit = [
        "system.slab.scheme={ kind = 'dual_support' }",
        "system.slab.time={ integrator = 'newmark' }",
    ];
    let flowing = [
        "system.slab.scheme={ kind = 'transport_velocity', shifting = 'none' }",
        "body.slab.material={ kind = 'hypoelastic', density = 'rho', young_modulus = 'E', poisson_ratio = 0.0 }",
    ];
    for kind in [&[][..], &viscous, &implicit, &flowing] {
        let expressed = slab(true, kind);
        let mut given = session(&expressed);
        let mut set = session(&slab(false, kind));
        for (body, name) in ["water", "floor", "slab"].into_iter().enumerate() {
            let fields: &[&str] = match (name, kind.contains(&flowing[0])) {
                ("slab", false) => &["velocity", "displacement"],
                _ => &["velocity"],
            };
            for field in ["velocity", "displacement", "pressure"] {
                let Ok(values) = given.view(field, Some(body)) else { continue };
                match set.set_of(field, Some(body), values.numbers()) {
                    Ok(()) => assert!(fields.contains(&field), "{name}: {field}"),
                    Err(ColumnError::NotSettable { settable, .. }) => {
                        assert!(!fields.contains(&field), "{name}: {field}");
                        assert_eq!(settable, fields, "{name}");
                    }
                    Err(error) => panic!("{name}: {field}: {error}"),
                }
            }
        }
        let witness = || Witness::new(Schedule::Every(1e-3));
        let finish = |mut session: Session, witness: &Witness| {
            session.observe(Box::new(witness.clone()));
            run(session);
            witness.seen().state
        };
        let (one, other) = (witness(), witness());
        let expected = finish(given, &one);
        assert!(finish(set, &other) == expected, "{kind:?}");

        let mut whole = session(&expressed);
        whole.run_until(5e-3).unwrap();
        let mut faster = whole.view("velocity", Some(2)).unwrap().numbers().to_vec();
        faster.iter_mut().for_each(|v| *v *= 3.0);
        whole.set_of("velocity", Some(2), &faster).unwrap();
        let mut resumed = session(&expressed);
        resumed.resume(whole.checkpoint()).unwrap();
        let (one, other) = (witness(), witness());
        let changed = finish(whole, &one);
        assert!(finish(resumed, &other) == changed && changed != expected, "{kind:?}");
    }
}

#[test]
fn what_cannot_be_is_refused_with_its_reason() {
    let mut piston = session(&load("upwind/piston", &[]));
    let error = piston.set("velocty", &[]).unwrap_err();
    assert!(matches!(error, ColumnError::Unknown { .. }));
    assert!(error.to_string().contains("expected `position`, `displacement`"), "{error}");
    let error = piston.set("pressure", &[]).unwrap_err();
    assert!(matches!(error, ColumnError::NotSettable { name: "pressure", .. }));
    let expected = "the field `pressure` cannot be set; only `velocity` can be set";
    assert_eq!(error.to_string(), expected);
    let count = piston.ids().len();
    let error = piston.set("velocity", &[0.0]).unwrap_err();
    assert_eq!(error, ColumnError::Length { name: "velocity", expected: 2 * count, got: 1 });
    let mut values = vec![0.0; 2 * count];
    values[3] = f64::NAN;
    let error = piston.set("velocity", &values).unwrap_err();
    assert!(matches!(error, ColumnError::NotFinite { particle: 1, .. }));
    let mut beam = session(&load("dual-support/tension", &[]));
    let error = beam.set("displacement", &[]).unwrap_err();
    let expected = "the field `displacement` cannot be set; no field of this scheme can be set";
    assert_eq!(error.to_string(), expected);

    let scratch = tempfile::tempdir().unwrap();
    let folder = scratch.path().join("out");
    piston.write_to(&folder).unwrap();
    assert!(!folder.exists(), "nothing is written before the first step");
    piston.step().unwrap();
    assert!(folder.join("run.json").exists());
    assert!(matches!(piston.write_to(&folder), Err(RunError::Begun)));
    let checkpoint = piston.checkpoint();
    let mut other = session(&load("upwind/bar-sine", &[]));
    assert!(other.resume(checkpoint).is_err());
    let finished = piston.finish().unwrap();
    assert_eq!((finished.summary.outcome, finished.summary.steps), (Outcome::Interrupted, 1));
}

/// What a session says of a moment is what tables, plan and files say of it, also when the run has ended.
#[test]
fn a_moment_is_what_the_tables_say() {
    let case = load("upwind/dam-break", &["time.end=0.05"]);
    let mut session = session(&case);
    let planned = session.plan().limits;
    assert!(!planned.is_empty() && session.limits() == planned);
    while session.step().unwrap() {}
    let before = session.column("velocity").unwrap();
    let finished = session.finish().unwrap();
    assert_eq!(session.column("velocity").unwrap(), before);
    assert!(!session.step().unwrap(), "there is nothing after the end");
    let energies = session.energies();
    assert_eq!(energies.last().map(|(name, _)| *name), Some("total"));
    for (name, joules) in energies {
        let values = finished.tables.energy.values(name).unwrap();
        assert_eq!(values.last(), Some(&joules), "{name}");
    }
    assert_eq!(*session.tables().lock(), finished.tables);
    let all: Vec<usize> = (0..session.ids().len()).collect();
    assert_eq!(session.particles_of(Some(0)), all);
    assert!(session.particles_of(Some(1)).is_empty());
}

/// The bits of a view, in the order of its shape.
fn bits(view: &FieldView) -> Vec<u64> {
    let mut places = vec![0];
    for (count, stride) in view.shape().into_iter().zip(view.strides()) {
        let along = |start: usize| (0..count).map(move |k| start + k * stride);
        places = places.into_iter().flat_map(along).collect();
    }
    places.into_iter().map(|place| view.numbers()[place].to_bits()).collect()
}

/// A view of a body has the rows of the column, and keeps them when the run continues: in all formulations, with
/// several systems, and where particles come and go.
#[test]
fn views_are_columns_and_stay_as_they_are() {
    let mut all = cases();
    all.push(load("coupled/floating-box", &[]));
    all.push(load("open/channel", &[]));
    for case in all {
        let mut session = session(&case);
        session.step().unwrap();
        let (dimension, mut held, mut looks) = (case.dimension, Vec::new(), Vec::new());
        let shown = session.columns().iter().filter(|field| field.life != Life::Kept);
        for field in shown.copied().collect::<Vec<_>>() {
            let (column, components) =
                (session.column(field.name).unwrap().values, field.kind.components(dimension));
            for body in (0..case.bodies.len()).map(Some).chain([None]) {
                let particles = session.particles_of(body);
                let view = session.view(field.name, body).unwrap();
                let rows = particles.iter().flat_map(|a| &column[a * components..][..components]);
                let rows: Vec<u64> = rows.map(|number| number.to_bits()).collect();
                assert_eq!(bits(&view), rows, "{} of {body:?}", field.name);
                assert_eq!(view.particles(), particles.len());
                looks.push(view.is_copy());
                held.push((view, rows));
            }
        }
        session.step().unwrap();
        session.step().unwrap();
        assert!(held.iter().all(|(view, rows)| bits(view) == *rows), "{}", case.title);
        // Particles that enter are scattered over memory.
        let scheme = session.scheme();
        if scheme.is_closed() && !scheme.initial_state().is_empty() {
            assert!(looks.contains(&false), "{}", case.title);
        }
        assert!(matches!(session.view("none", None), Err(ColumnError::Unknown { .. })));
        assert_eq!(session.view("position", Some(99)).unwrap().particles(), 0);
    }
}
