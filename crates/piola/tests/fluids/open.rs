//! Fluid that enters and leaves through open boundaries.

use std::collections::BTreeSet;
use std::f64::consts::PI;
use std::sync::atomic::AtomicBool;

use piola::case::{self, LoadOptions, Session};

use super::support::{run, session, values};

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

/// A stream that lies askew, a jet without pressure, is that stream turned.
#[test]
fn a_stream_goes_through_in_any_direction() {
    let body = |name: &str, [low, high]: [[f64; 2]; 2], rest: &str| {
        format!(
            "[[body]]\nname = \"{name}\"\nspacing = 0.05\nlattice = {{ on = \"cells\" }}\n\
             shape = {{ kind = \"turned\", about = [0.1, 0.2], angle = 0.5, of = {{ kind = \"box\", min = {low:?}, max = {high:?} }} }}\n\
             material = {{ kind = \"weakly_compressible\", density = 2.0, wave_speed = 20.0 }}\n{rest}\n"
        )
    };
    let along = "\"cos(0.5)\", \"sin(0.5)\"";
    let text = [
        "version = 1\ntitle = \"A stream\"\ndimension = 2\n".to_owned(),
        body("water", [[0.0, 0.0], [0.6, 0.4]], &format!("initial = {{ velocity = [{along}] }}")),
        body("inlet", [[-0.2, 0.0], [0.0, 0.4]], &format!("opening = {{ normal = [\"cos(0.5)\", \"sin(0.5)\"], velocity = [{along}] }}")),
        body("outlet", [[0.6, 0.0], [0.8, 0.4]], "opening = { normal = [\"-cos(0.5)\", \"-sin(0.5)\"], pressure = \"0\" }"),
        "[scheme]\nkind = \"transport_velocity\"\nshifting = \"none\"\n[time]\nend = 1.0\n[output]\nevery = 1.0\ntable_every = 0.05\n".to_owned(),
        "[[probe]]\nname = \"error\"\nkind = \"error\"\nbody = \"water\"\nfield = \"velocity\"\ncomponents = { x = \"cos(0.5)\", y = \"sin(0.5)\" }\n".to_owned(),
    ];
    let finished = run(&text.concat(), &[]);
    assert_eq!(finished.summary.outcome.summary(), "completed");
    let worst = values(&finished, "error.error").into_iter().fold(0.0, f64::max);
    assert!(worst < 1e-9, "{worst}");
    assert!(values(&finished, "step.entered").last().is_some_and(|mass| *mass > 0.7));
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

/// What comes in through one opening and goes out through the other is told apart by their names.
#[test]
fn each_opening_has_its_own_account() {
    let probe = |body: &str| {
        format!("[[probe]]\nname = \"{body}s\"\nkind = \"opening\"\nbody = \"{body}\"\n")
    };
    let check = |column: &str| {
        format!(
            "[[check]]\nquantity = \"inlets.{column}\"\nreduce = \"final\"\nat_least = 0.0\nsource = \"it enters\"\n"
        )
    };
    let checks = ["entered", "energy", "linear.x"].map(check).concat();
    let text = [stream(2), probe("inlet"), probe("outlet"), checks].concat();
    let finished = run(&text, &[]);
    for (own, all) in [("inlets.entered", "step.entered"), ("outlets.left", "step.left")] {
        assert!(values(&finished, own).last().is_some_and(|mass| *mass > 0.7));
        assert_eq!(values(&finished, own), values(&finished, all));
    }
    // A kilogram of a stream of 1 m/s without pressure has half a joule, and a momentum of 1 kg m/s.
    for (name, mass, sign) in [("inlets", "entered", 1.0), ("outlets", "left", -1.0)] {
        let [mass, energy, momentum] = [mass, "energy", "linear.x"]
            .map(|column| values(&finished, &format!("{name}.{column}")));
        for ((mass, energy), momentum) in mass.iter().zip(energy).zip(momentum) {
            assert!((energy - 0.5 * sign * mass).abs() < 1e-9, "{name}: {energy} J of {mass} kg");
            assert!((momentum - sign * mass).abs() < 1e-9, "{name}: {momentum} of {mass} kg");
        }
    }
    for name in ["inlets.left", "outlets.entered"] {
        assert!(values(&finished, name).iter().all(|mass| *mass == 0.0), "{name}");
    }
    let wrong = session(&[stream(2), probe("water")].concat(), &[]).err().expect("it is refused");
    assert!(wrong.contains("belongs to no opening"), "{wrong}");
}

/// A profile from a file over the height of a channel is what the same one as an expression is, a history over time too.
#[test]
fn profiles_and_histories_come_from_files() {
    let folder = tempfile::tempdir().expect("a folder");
    let write = |name: &str, text: &str| {
        std::fs::write(folder.path().join(name), text).expect("it is written")
    };
    write("profile.csv", "y,factor\n0,0\n0.1,1.5\n0.4,0.6\n");
    write("ramp.csv", "t,factor\n0,0.5\n0.4,1\n");
    let load = |set: &[&str]| {
        let overrides = set.iter().map(|text| (*text).to_owned()).collect();
        let path = folder.path().join("case.toml");
        std::fs::write(&path, stream(2)).expect("it is written");
        case::load(&path, &LoadOptions { overrides, ..LoadOptions::default() })
            .map_err(|error| error.to_string())
    };
    let run = |set: &[&str]| {
        let case =
            load(&[set, &["time.end=0.5"]].concat()).unwrap_or_else(|error| panic!("{error}"));
        let session = Session::new(&case).expect("it is built");
        session.run(&AtomicBool::new(false), &mut |_| {}).expect("it runs")
    };
    let from_files = run(&[
        "body.inlet.opening.velocity=['2', '0']",
        "body.inlet.opening.profile={ file = 'profile.csv', from = [7, 0] }",
        "body.inlet.opening.history='ramp.csv'",
    ]);
    let factor = "min(15 * y, 1.5 - 3 * (y - 0.1)) * min(0.5 + 1.25 * t, 1)";
    let from_text = run(&[&format!("body.inlet.opening.velocity=['2 * {factor}', '0']")]);
    let (one, other) =
        (values(&from_files, "energy.kinetic"), values(&from_text, "energy.kinetic"));
    // Later on which particle comes in first is a matter of round-off.
    let differs = one.iter().zip(&other).take(3).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
    assert!(differs < 1e-9 * other[0], "{differs}");
    assert!((other[0] - other[10]).abs() > 0.01 * other[0]);
    write("bad.csv", "y,factor\n0,0\n0.1,nan\n");
    for (set, text) in [
        ("body.inlet.opening.profile={ file = 'bad.csv', from = [0, 0] }", "line 3"),
        (
            "body.inlet.opening={ normal = [1, 0], flow_rate = '1', profile = { file = 'profile.csv', from = [0, 0] } }",
            "with a flow rate",
        ),
    ] {
        let error = load(&[set]).expect_err("it is refused");
        assert!(error.contains(text), "{error}");
    }
}

/// What the forces of buffers and what goes through them do is all that changes the energy and the momentum of a fluid.
#[test]
fn the_ledger_of_a_stream_that_comes_and_goes_balances() {
    books_what_comes_and_goes(&[]);
    books_what_comes_and_goes(&["scheme.corrected_gradients=true"]);
}

fn books_what_comes_and_goes(set: &[&str]) {
    let swing = ["parameters.inflow=0.0", "body.inlet.opening.velocity=['1.5 * sin(6 * t)', '0']"];
    let finished = run(&stream(2), &[&swing[..], set].concat());
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

/// A river half a metre deep over a smooth bed, let in with 1 m/s and out at the pressure of its depth.
fn river() -> String {
    let body = |name: &str, [low, high]: [[f64; 2]; 2], rest: &str| {
        format!(
            "[[body]]\nname = \"{name}\"\nshape = {{ kind = \"box\", min = {low:?}, max = {high:?} }}\nspacing = 0.05\n\
             lattice = {{ on = \"cells\" }}\n\
             material = {{ kind = \"weakly_compressible\", density = 2.0, wave_speed = 25.0 }}\n{rest}\n"
        )
    };
    let depth = "\"2 * 9.81 * (0.5 - y)\"";
    [
        "version = 1\ntitle = \"A river\"\ndimension = 2\n".to_owned(),
        body("water", [[0.0, 0.0], [1.0, 0.5]], &format!("initial = {{ velocity = [\"1\", \"0\"], pressure = {depth} }}")),
        body("source", [[-0.2, 0.0], [0.0, 0.5]], "opening = { normal = [1.0, 0.0], velocity = [\"1\", \"0\"] }"),
        body("mouth", [[1.0, 0.0], [1.2, 0.5]], &format!("opening = {{ normal = [-1.0, 0.0], pressure = {depth} }}")),
        body("bed", [[-0.2, -0.2], [1.2, 0.0]], "wall = { slip = \"free\" }"),
        "[[load]]\nkind = \"body_force\"\nacceleration = [\"0\", \"-9.81\"]\n".to_owned(),
        "[scheme]\nkind = \"transport_velocity\"\nfree_surface = true\n[time]\nend = 2.0\n".to_owned(),
        "[[probe]]\nname = \"level\"\nkind = \"gauge\"\nbody = \"water\"\nfrom = [0.5, 0.0]\nto = [0.5, 1.0]\n".to_owned(),
        "[output]\nevery = 1.0\ntable_every = 0.1\n".to_owned(),
    ]
    .concat()
}

/// The [`river`] is a uniform stream of its depth, of a Froude number of 0.45. Its level is known to half a spacing, and what
/// goes out in two ways through it is what comes in, to a layer of particles.
#[test]
fn a_river_keeps_its_level() {
    let finished = run(&river(), &[]);
    assert_eq!(finished.summary.outcome.summary(), "completed");
    for level in values(&finished, "level.elevation") {
        assert!((level - 0.5).abs() < 0.025, "{level}");
    }
    for name in ["step.entered", "step.left"] {
        let mass = values(&finished, name).pop().expect("a row");
        assert!((mass - 2.0 * 2.0 * 0.5).abs() < 2.0 * 0.5 * 0.05 * 1.25, "{name} {mass}");
    }
}

/// The bed has the mass of its density where the density relaxes, theory (108), and otherwise that of the fluid, which is as
/// heavy at any pressure, (31).
#[test]
fn a_bed_is_as_heavy_as_its_pressure_makes_it_where_the_density_relaxes() {
    for (set, fills) in [("scheme.free_surface=true", true), ("scheme.density_relaxation=0", false)]
    {
        let mut session = session(&river(), &[set]).unwrap_or_else(|error| panic!("{error}"));
        let mut column = |name| session.column(name).expect("it is there").values;
        let [walls, masses, densities] = ["wall", "mass", "density"].map(&mut column);
        let of_fluid = 2.0 * 0.05 * 0.05;
        let mut heaviest = 0.0_f64;
        for ((wall, mass), density) in walls.into_iter().zip(masses).zip(densities) {
            let expected = if wall == 1.0 && fills { density * 0.05 * 0.05 } else { of_fluid };
            assert!((mass / expected - 1.0).abs() < 1e-12, "{set}: {mass} for {expected} kg");
            heaviest = heaviest.max(density / 2.0);
        }
        // g H/c^2 at the bed, and more in it.
        assert!(heaviest > 1.0 + 9.81 * 0.5 / 625.0, "{heaviest}");
    }
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
    refused(&["body.inlet.opening.velocity=['1/(y - y)', '0']"], "not a number");
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
    let no_period = "domain={}";
    refused(&[no_period, "body.inlet.opening.normal=[1.0, 0.4]"], "does not extend straight");
    refused(
        &[no_period, "body.inlet.shape={ kind = 'ball', center = [-0.2, 0.2], radius = 0.2 }"],
        "does not extend straight",
    );
    refused(&["body.inlet.initial={ pressure = '1' }"], "in the buffer of an opening");
    refused(&["body.inlet.wall={}"], "a wall cannot be an opening");
    let closed = ["body.inlet.opening=", "body.outlet.opening=", "scheme.reserve=4"];
    refused(&closed, "where no body has the key `opening` and nothing is refined");
    let wall = "body+={ name = 'wall', shape = { kind = 'box', min = [-0.1, 0.1], max = [0.0, 0.2] }, spacing = 0.05, \
                lattice = { on = 'cells' }, wall = {}, \
                material = { kind = 'weakly_compressible', density = 2.0, wave_speed = 20.0 } }";
    refused(&[wall], "the wall `wall` is in the opening `inlet`");
    let across = "body+={ name = 'wall', shape = { kind = 'box', min = [0.3, 0.0], max = [0.35, 0.4] }, spacing = 0.05, \
                  lattice = { on = 'cells' }, wall = {}, \
                  material = { kind = 'weakly_compressible', density = 2.0, wave_speed = 20.0 } }";
    let apart = "body.water.shape={ kind = 'difference', \
                 from = { kind = 'box', min = [0.0, 0.0], max = [0.6, 0.4] }, \
                 remove = [{ kind = 'box', min = [0.3, -0.1], max = [0.35, 0.5] }] }";
    refused(&[across, apart], "no way through the fluid leads from `outlet` to another opening");
    // Fluid with a free surface may rise above the wall, and a wall may move out of the way.
    let told = "no way through the fluid leads from `outlet` to another opening at the start";
    let moves = "boundary+={ name = 'away', body = 'wall', where = { kind = 'all' }, velocity = { x = '0.1 * t', y = '0' } }";
    for opens in ["scheme.free_surface=true", moves] {
        let warnings =
            session(&stream(2), &[across, apart, opens]).expect("it is built").plan().warnings;
        assert!(warnings.iter().any(|warning| warning.contains(told)), "{warnings:?}");
    }
}

/// Where both ends are prescribed and do not agree there is a warning with the difference.
#[test]
fn flow_rates_that_do_not_balance_are_told() {
    let warned = |set: &[&str], what: &str| {
        let warnings = session(&stream(2), set).expect("it is built").plan().warnings;
        assert!(warnings.iter().any(|it| it.contains(what)), "{warnings:?}");
    };
    let out = "body.outlet.opening={ normal = [-1.0, 0.0], velocity = ['0.5', '0'] }";
    warned(&[out], "2.000e-1 m^D/s more flow in than out at t = 0 s");
    // Also where they agree at first: 0.4 m times a 32nd of 1 m/s.
    let same = out.replace("0.5", "1");
    let grows = "body.inlet.opening.velocity=['1 + t', '0']";
    warned(&[&same, grows], "1.250e-2 m^D/s more flow in than out at t = 0.03125 s");
}

/// Where the pressure is prescribed at several openings and follows slowly, fluid circulates through them in silence.
#[test]
fn pressures_that_follow_slowly_at_several_openings_are_told() {
    let body = |name: &str, min: &str, max: &str, rest: &str| {
        format!(
            "[[body]]\nname = \"{name}\"\nshape = {{ kind = \"box\", min = {min}, max = {max} }}\n\
             spacing = 0.1\nlattice = {{ on = \"cells\" }}\n\
             material = {{ kind = \"weakly_compressible\", density = 1.0, wave_speed = 12.0 }}\n{rest}\n"
        )
    };
    let end = |normal: &str| format!("opening = {{ normal = {normal}, pressure = \"1\" }}");
    let inlet = "opening = { normal = [1.0, 0.0], flow_rate = \"0.8 * min(t, 1)\" }";
    let tee = [
        "version = 1\ntitle = \"A tee\"\ndimension = 2\nscheme = { kind = \"transport_velocity\" }\n\
         time = { end = 8.0 }\n"
            .to_owned(),
        body("water", "[0.0, -1.5]", "[2.5, 1.5]", ""),
        body("inlet", "[-0.4, -0.5]", "[0.0, 0.5]", inlet),
        body("up", "[1.5, 1.5]", "[2.5, 1.9]", &end("[0.0, -1.0]")),
        body("down", "[1.5, -1.9]", "[2.5, -1.5]", &end("[0.0, 1.0]")),
    ];
    let warned = |set: &[&str]| {
        let warnings = session(&tee.concat(), set).expect("it is built").plan().warnings;
        warnings.iter().any(|it| it.contains("may circulate through them"))
    };
    assert!(warned(&[]));
    assert!(!warned(&["body.up.opening.relaxation=1.0", "body.down.opening.relaxation=1.0"]));
    assert!(!warned(&["body.up.opening={ normal = [0.0, -1.0], flow_rate = '-0.4' }"]));
}

/// A stream that swings, under pressure.
const SWING: [&str; 7] = [
    "body.inlet.opening.velocity=['cos(4 * t)', '0']",
    "body.inlet.opening.relaxation=0.015",
    "body.outlet.opening.relaxation=0.015",
    "body.outlet.opening.pressure='20'",
    "body.water.initial.pressure='20'",
    "time.end=2.0",
    "probe+={ name = 'mean', kind = 'mean', body = 'water', field = 'velocity' }",
];

/// A stream that slows down, turns back and comes again is the same all along, and comes out of buffers without gaps: nowhere
/// is a particle missing, which would leave a place a whole spacing from all others, and nowhere are two in one place. It
/// is under pressure, as particles in tension clump. The mean velocity lags by the relaxation time, 0.06 m/s at most, and
/// layers come in at once.
#[test]
fn a_stream_that_turns_back_has_no_gaps() {
    let finished = run(&stream(2), &SWING);
    let times = finished.tables.probes.values("time").expect("times").to_vec();
    let both = times.into_iter().zip(values(&finished, "mean.velocity.x"));
    for (time, speed) in both {
        assert!((speed - f64::cos(4.0 * time)).abs() < 0.15, "{speed} m/s at {time} s");
    }
    for end in [PI / 4.0, PI / 2.0] {
        let mut session = session(&stream(2), &SWING).expect("it is built");
        session.run_until(end).expect("it runs");
        let [density, x] =
            ["density", "position"].map(|name| session.column(name).expect("it is there").values);
        let places: Vec<[f64; 2]> = x.chunks_exact(2).map(|x| [x[0], x[1]]).collect();
        let there: Vec<[f64; 2]> = places
            .iter()
            .zip(&density)
            .filter(|(_, density)| **density > 0.0)
            .map(|(x, _)| *x)
            .collect();
        let distance = |a: &[f64; 2], b: &[f64; 2]| {
            let across = (a[1] - b[1]).abs() % 0.4;
            (a[0] - b[0]).hypot(across.min(0.4 - across)) / 0.05
        };
        let nearest = |a: &[f64; 2], but: Option<usize>| {
            let others =
                (0..there.len()).filter(|&b| Some(b) != but).map(|b| distance(a, &there[b]));
            others.fold(f64::INFINITY, f64::min)
        };
        for k in 0..190 * 4 {
            let place = [-0.175 + 0.005 * (k / 4) as f64, 0.1 * f64::from(k % 4) + 0.013];
            let gap = nearest(&place, None);
            assert!(gap < 1.0, "{gap} spacings about {place:?} at the end of {end}");
        }
        for (a, place) in there.iter().enumerate() {
            let distance = nearest(place, Some(a));
            assert!(distance > 0.5, "{distance} spacings at {place:?} at the end of {end}");
        }
    }
}

/// What buffers keep of the stream is in the state: a run that continues from a checkpoint while they are filled up and
/// thinned out has the bits of one that was not interrupted.
#[test]
fn a_stream_that_turns_back_resumes_to_the_bit() {
    let started = || session(&stream(2), &SWING).expect("it is built");
    let bits = |session: &mut Session| -> Vec<u64> {
        let columns = ["position", "velocity", "density", "pressure", "opening", "birth"];
        let all = columns.map(|name| session.column(name).expect("it is there").values);
        all.concat().iter().map(|value| value.to_bits()).collect()
    };
    let mut whole = started();
    whole.run_until(PI / 4.0).expect("it runs");
    let kept = whole.checkpoint();
    whole.run_until(1.3).expect("it runs");
    let mut resumed = started();
    resumed.resume(kept).expect("it is its own");
    resumed.run_until(1.3).expect("it runs");
    assert!(bits(&mut whole) == bits(&mut resumed));
}
