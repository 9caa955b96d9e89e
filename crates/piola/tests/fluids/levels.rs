//! Fluids at several resolutions.

use super::support::{run, session, values};

/// A fluid in a periodic box with regions of finer spacing.
fn fluid(dimension: usize, refine: &str, start: &str) -> String {
    let axes = &["x", "y", "z"][..dimension];
    let ends: Vec<String> = axes.iter().map(|axis| format!("{axis} = [0.0, \"length\"]")).collect();
    let (low, high) = (vec!["0.0"; dimension].join(", "), vec!["\"length\""; dimension].join(", "));
    format!(
        "version = 1\ntitle = \"Levels\"\ndimension = {dimension}\n[parameters]\ndx = 0.05\nlength = 1.0\nend = 0.2\nnu = 0.01\n\
         [domain]\nperiodic = {{ {} }}\n[[body]]\nname = \"water\"\nspacing = \"dx\"\nlattice = {{ on = \"cells\" }}\n\
         shape = {{ kind = \"box\", min = [{low}], max = [{high}] }}\n\
         material = {{ kind = \"weakly_compressible\", density = 2.0, wave_speed = 10.0, viscosity = \"nu\" }}\n\
         initial = {{ {start} }}\n[scheme]\nkind = \"transport_velocity\"\nrefine = [{refine}]\n\
         [time]\nend = \"end\"\n[output]\nevery = 0.1\ntable_every = 0.02\n",
        ends.join(", ")
    )
}

fn cube(dimension: usize, low: f64, high: f64) -> String {
    let (low, high) = (vec![low; dimension], vec![high; dimension]);
    format!("{{ kind = \"box\", min = {low:?}, max = {high:?} }}")
}

/// The largest of what is off in a balance, over the largest value of what is balanced.
fn off(finished: &piola::case::Finished, balance: &str, of: &str) -> f64 {
    let most = |name: &str| values(finished, name).into_iter().map(f64::abs).fold(0.0, f64::max);
    most(balance) / most(of)
}

/// A stream goes into a finer region and out of it, and again into one in that: no pressure rises, nothing is lost but
/// what is on its way, and what is booked is what happens.
#[test]
fn a_stream_goes_through_finer_regions() {
    let strip = |low: f64, high: f64| {
        format!("{{ kind = \"box\", min = [{low}, -9.0], max = [{high}, 9.0] }}")
    };
    let text =
        fluid(2, &[strip(0.7, 2.3), strip(1.3, 1.7)].join(", "), "velocity = [\"1\", \"0\"]");
    let text = text
        .replace("y = [0.0, \"length\"]", "y = [0.0, 0.6]")
        .replace("max = [\"length\", \"length\"]", "max = [\"length\", 0.6]");
    let probe = "[[probe]]\nname = \"error\"\nkind = \"error\"\nbody = \"water\"\nfield = \"velocity\"\ncomponents = { x = \"1\", y = \"0\" }\n";
    let text = format!("{text}{probe}");
    let finest = session(&text, &["parameters.length=3.0"]).unwrap().plan().bodies[0].finest;
    assert_eq!(finest, 4.0, "two regions halve the spacing twice");
    let finished = run(&text, &["parameters.length=3.0", "parameters.end=0.3"]);
    assert_eq!(finished.summary.outcome.summary(), "completed");
    let worst = values(&finished, "error.error").into_iter().fold(0.0, f64::max);
    // Finer particles are born in the cells of a lattice that goes on without end, and a uniform stream is met exactly.
    assert!(worst < 1e-9, "{worst}");
    let mass = values(&finished, "step.mass");
    // As many as fit into a quarter of a spacing of the coarser level on both sides of all four bounds.
    let on_the_way = 2.0 * 0.6 * 2.0 * (0.25 * 0.05 + 0.05 + 0.25 * 0.025 + 0.025);
    let worst = mass.iter().map(|mass| (mass - 2.0 * 3.0 * 0.6).abs()).fold(0.0, f64::max);
    assert!(worst < on_the_way, "{worst}");
    assert!(off(&finished, "energy.balance", "energy.total") < 1e-12);
}

/// The decay of vortices, with a finer region about the middle of which particles go round in and out.
fn vortices() -> String {
    let decay = "exp(-8*pi^2*nu*t)";
    let text = fluid(
        2,
        &cube(2, 0.25, 0.75),
        "velocity = [\"-cos(2*pi*x)*sin(2*pi*y)\", \"sin(2*pi*x)*cos(2*pi*y)\"], pressure = \"-(cos(4*pi*x) + cos(4*pi*y))/2\"",
    );
    let probe = format!(
        "[[probe]]\nname = \"error\"\nkind = \"error\"\nbody = \"water\"\nfield = \"velocity\"\n\
         components = {{ x = \"-cos(2*pi*x)*sin(2*pi*y)*{decay}\", y = \"sin(2*pi*x)*cos(2*pi*y)*{decay}\" }}\n"
    );
    format!("{text}{probe}")
}

/// What is booked is all that changes energy and momentum, and what counts is what there is up to what is on its way.
#[test]
fn the_ledger_of_vortices_through_levels_balances() {
    let of = [
        "scheme.artificial_viscosity=0.0",
        "scheme.artificial_viscosity=0.2",
        "scheme.corrected_gradients=true",
    ];
    of.into_iter().for_each(|set| balances_through_levels(&["parameters.end=0.3", set]));
}

fn balances_through_levels(set: &[&str]) {
    let finished = run(&vortices(), set);
    assert_eq!(finished.summary.outcome.summary(), "completed");
    assert!(off(&finished, "energy.balance", "energy.total") < 1e-12);
    // The momentum of the whole is near to nothing; that of one vortex is its mass times a third of the largest speed.
    let balance = values(&finished, "momentum.balance.linear.x");
    let worst = balance.into_iter().map(f64::abs).fold(0.0, f64::max);
    assert!(worst < 1e-12 * 2.0 / 4.0 / 3.0, "{worst}");
    // A layer of coarse particles around the region is more than what is on its way.
    let layer = 2.0 * 4.0 * 0.5 * 0.05;
    let mass = values(&finished, "step.mass");
    let worst = mass.iter().map(|mass| (mass - 2.0).abs()).fold(0.0, f64::max);
    assert!(worst < layer, "{worst}");
}

/// Regions of finer spacing do not make a flow worse than it is without them, where the spacing is the coarse one everywhere.
#[test]
fn finer_regions_make_no_errors_of_their_own() {
    let error = |set: &[&str]| {
        let finished = run(&vortices(), set);
        *values(&finished, "error.error").last().expect("a row")
    };
    let with = error(&["parameters.end=0.3"]);
    let without = error(&["parameters.end=0.3", "scheme.refine="]);
    assert!(with < without, "{with} {without}");
}

/// Water at rest under gravity stays at rest: the pressure of depth is linear, which levels hand on exactly, so that a finer
/// region leaves no more of it over than the coarse spacing everywhere.
#[test]
fn still_water_stays_still_across_levels() {
    let box_of = |name: &str, low: [f64; 2], high: [f64; 2], rest: &str| {
        format!(
            "[[body]]\nname = \"{name}\"\nspacing = 0.05\nlattice = {{ on = \"cells\" }}\n\
             shape = {{ kind = \"box\", min = {low:?}, max = {high:?} }}\n\
             material = {{ kind = \"weakly_compressible\", density = 2.0, wave_speed = 20.0, viscosity = 0.01 }}\n{rest}\n"
        )
    };
    let start = "initial = { pressure = \"-2*(y - 0.5)\" }";
    let text = |refine: &str| {
        [
            "version = 1\ntitle = \"Still\"\ndimension = 2\n[domain]\nperiodic = { x = [0.0, 1.0] }\n",
            &box_of("water", [0.0, 0.0], [1.0, 1.0], start),
            &box_of("floor", [0.0, -0.2], [1.0, 0.0], "wall = {}"),
            &box_of("lid", [0.0, 1.0], [1.0, 1.2], "wall = {}"),
            "[[load]]\nkind = \"body_force\"\nacceleration = [\"0\", \"-1\"]\n",
            "[scheme]\nkind = \"transport_velocity\"\n",
            refine,
            "[time]\nend = 1.0\n[output]\nevery = 1.0\ntable_every = 0.05\n",
            "[[probe]]\nname = \"pressure\"\nkind = \"error\"\nbody = \"water\"\nfield = \"pressure\"\nexact = \"-2*(y - 0.5)\"\nwithout_mean = true\n",
        ]
        .concat()
    };
    let error = |refine: &str| {
        let finished = run(&text(refine), &[]);
        assert_eq!(finished.summary.outcome.summary(), "completed");
        values(&finished, "pressure.error").into_iter().fold(0.0, f64::max)
    };
    // From the floor up, so that walls of both spacings meet.
    let refine = "refine = [{ kind = \"box\", min = [0.3, -1.0], max = [0.7, 0.5] }]\n";
    let [with, without] = [error(refine), error("")];
    assert!(with <= without, "{with} {without}");
}

/// A run through births is the same to the bit on any number of threads, and after a stop.
#[test]
fn levels_resume_and_run_on_threads_to_the_bit() {
    let bits = |threads: usize, broken: bool| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build();
        pool.expect("threads start").install(|| {
            let mut run = session(&vortices(), &[]).expect("it is built");
            run.run_until(0.1).expect("it runs");
            if broken {
                let checkpoint = run.checkpoint();
                run = session(&vortices(), &[]).expect("it is built");
                run.resume(checkpoint).expect("it fits");
            }
            run.run_until(0.2).expect("it runs");
            let [density, nesting, birth] =
                ["density", "nesting", "birth"].map(|name| run.column(name).expect(name).values);
            let born = (0..density.len()).filter(|&a| density[a] > 0.0 && birth[a] > 0.0).count();
            let follow = nesting.iter().filter(|nesting| **nesting == 2.0).count();
            let mut all = Vec::new();
            for field in ["position", "velocity", "pressure", "density", "nesting", "birth"] {
                all.extend(run.column(field).expect(field).values.iter().map(|it| it.to_bits()));
            }
            (all, born, follow)
        })
    };
    let whole = bits(1, false);
    assert!(whole.1 > 20 && whole.2 > 500, "{} {}", whole.1, whole.2);
    assert!(whole == bits(2, false), "on two threads");
    assert!(whole == bits(2, true), "resumed");
}

/// Three dimensions: eight particles for one.
#[test]
fn a_stream_goes_through_a_finer_cube() {
    let text = fluid(3, &cube(3, 0.3, 0.7), "velocity = [\"1\", \"0.5\", \"0\"]");
    let probe = "[[probe]]\nname = \"error\"\nkind = \"error\"\nbody = \"water\"\nfield = \"velocity\"\ncomponents = { x = \"1\", y = \"0.5\", z = \"0\" }\n";
    let set = ["parameters.end=0.05"];
    let finished = run(&format!("{text}{probe}"), &set);
    assert_eq!(finished.summary.outcome.summary(), "completed");
    let worst = values(&finished, "error.error").into_iter().fold(0.0, f64::max);
    assert!(worst < 1e-9, "{worst}");
    let present = values(&finished, "step.present");
    assert_eq!(present[0], 8000.0 + 7.0 * 512.0);
}

#[test]
fn regions_that_cannot_work_are_refused() {
    let refused = |refine: &str, set: &[&str], what: &str| {
        let told = match session(&fluid(2, refine, "velocity = [\"1\", \"0\"]"), set) {
            Ok(_) => panic!("accepted: {what}"),
            Err(told) => told,
        };
        assert!(told.contains(what), "{told}");
    };
    let good = cube(2, 0.3, 0.7);
    refused(&cube(2, 0.0, 0.5), &[], "ends within");
    refused(
        &[cube(2, 0.25, 0.75), cube(2, 0.4, 0.6)].concat().replace("}{", "}, {"),
        &[],
        "divided by four",
    );
    refused(&cube(2, 2.0, 3.0), &["domain={}"], "no fluid is in this region");
    refused(&good, &["scheme.free_surface=true"], "free surfaces has one spacing");
    refused(&good, &["scheme.density='summation'"], "use `density = \"continuity\"`");
}

/// A stream into finer regions whose reserve is too small for all that are born there: the run makes more particles, and
/// these are where they would have been.
#[test]
fn a_reserve_that_is_used_up_is_extended() {
    let text = fluid(2, &cube(2, 0.3, 0.7), "velocity = [\"1\", \"0\"]");
    let ends = [3, 4000].map(|reserve| {
        let set = [&format!("scheme.reserve={reserve}"), "parameters.end=0.5"];
        let mut session = session(&text, &set).unwrap();
        let before = session.ids().len();
        while session.step().unwrap() {}
        let present = |values: Vec<f64>| values.into_iter().filter(|value| *value != 0.0);
        let pressure: Vec<f64> = present(session.column("pressure").unwrap().values).collect();
        (session.ids().len() - before, pressure)
    });
    let [(more, few), (none, many)] = ends;
    assert!(more > 3 && none == 0, "{more} and {none}");
    assert_eq!(few, many);
}
