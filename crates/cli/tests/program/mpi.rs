//! Runs on processes of MPI, for which the program has to be built with `--features mpi`.

#[path = "../../../mpi/tests/mpirun/mod.rs"]
mod mpirun;

use std::process::Command;

use mpirun::mpirun;
use serde_json::Value;

use crate::running::{Program, send};
use crate::support::{Place, assert_contains};

/// A plate of 777 particles that is held, pulled, and falls.
const PLATE: &str = r#"
version = 1
title = "A plate"
dimension = 2

[[body]]
name = "plate"
shape = { kind = "box", min = [0.0, 0.0], max = [1.8, 1.0] }
spacing = 0.05
material = { kind = "neo_hookean", density = 800.0, young_modulus = 3e5, poisson_ratio = 0.23 }
initial = { velocity = ["0.3 * sin(3 * x)", "0.1 * x"] }

[scheme]
kind = "dual_support"
viscosity = 40.0

[[load]]
name = "gravity"
kind = "body_force"
acceleration = ["cos(9 * t)", "-2.0 * x"]

[[load]]
name = "pull"
kind = "traction"
where = { kind = "plane", point = [1.8, 0.0], normal = [1.0, 0.0] }
traction = ["2e3 * sin(9 * t) + 300.0 * y", "100.0"]

[[boundary]]
name = "wall"
where = { kind = "plane", point = [0.0, 0.0], normal = [-1.0, 0.0] }
velocity = { x = "0.2 * sin(20 * t)", y = "0" }

[[probe]]
name = "corner"
kind = "particle"
at = [1.8, 1.0]
fields = ["displacement", "velocity", "stress"]

[checkpoint]
every_steps = 5

[time]
end = 0.05

[output]
every = 0.01
table_every = 0.002
"#;

/// What makes some thousand steps of it.
const LONG: &str = "--set time.end=2.0 --set output.every=0.2 --set output.table_every=0.02 --set \
                    checkpoint.every_steps=100";

/// Cases of the repository that run on several ranks, made shorter: energies of hourglass modes, mirrors, neighbours that
/// move, new ones in a fluid between walls, a solid in a fluid, and particles that enter and leave, of which the reserve has
/// too few after some 150 steps. With each, after which steps it is broken off.
const CASES: [(&str, &str, [u64; 2]); 8] = [
    ("dual-support/free-vibration", "--set parameters.dx=0.5 --set time.end=0.05", [6, 13]),
    ("elastodynamics/wave-2d", "", [6, 13]),
    ("upwind/column-impact", "--set time.end=0.5", [6, 13]),
    ("ctvf/dam-break", "--set parameters.dx=0.1 --set time.end=0.2", [6, 13]),
    ("coupled/gate", "--set time.end=0.003", [6, 13]),
    (
        "open/channel",
        "--set parameters.across=10 --set time.end=0.2 --set scheme.reserve=1",
        [20, 180],
    ),
    (
        "dual-support/tension",
        "--set parameters.dx=0.5 --set time.step=0.05 --set time.linear_solver='krylov'",
        [6, 13],
    ),
    (
        "upwind/piston",
        "--variant implicit --set time.end=0.5 --set time.linear_solver='krylov'",
        [6, 13],
    ),
];

/// A folder with a case in `plate.toml`.
fn place_with(text: &str) -> Place {
    let place = Place::new();
    place.write("plate.toml", text);
    place
}

/// `mpirun` with processes of piola, which have these arguments.
fn processes(place: &Place, size: usize, arguments: &str) -> Command {
    let mut command = mpirun();
    let piola = env!("CARGO_BIN_EXE_piola");
    command.args(["-n", &size.to_string(), piola]).args(arguments.split_whitespace());
    command.current_dir(place.path(""));
    command
}

/// Runs processes, which must end with `code` within a minute; stdout and stderr.
#[track_caller]
fn ended(command: &mut Command, code: i32) -> (String, String) {
    let (ended, stdout, stderr) = Program::start(command).end();
    assert_eq!(ended, Some(code), "stdout:\n{stdout}\nstderr:\n{stderr}");
    assert!(!stderr.contains("panicked"), "{stderr}");
    (stdout, stderr)
}

/// Runs processes, which must refuse to with `code` and one sentence, of which these are parts, and write nothing.
#[track_caller]
fn refused(place: &Place, command: &mut Command, code: i32, parts: &[&str]) {
    let (stdout, stderr) = ended(command, code);
    assert_contains(&stderr, parts);
    for part in parts {
        assert_eq!(stderr.matches(part).count(), 1, "`{part}` comes once:\n{stderr}");
    }
    assert!(!stdout.contains("completed") && !place.path("results").exists(), "{stdout}");
}

/// Asserts that two folders have the same results, to the byte.
#[track_caller]
fn assert_same(place: &Place, folder: &str, expected: &str) {
    let (results, expected) = (place.results(folder), place.results(expected));
    assert!(results.keys().eq(expected.keys()), "{folder} has {:?}", results.keys());
    for end in ["energy.csv", "steps.csv", "particles.pvd", ".vtp"] {
        assert!(results.keys().any(|name| name.ends_with(end)), "{folder} has no {end}");
    }
    let differing = results.iter().filter(|(name, bytes)| expected[*name] != **bytes);
    let differing: Vec<_> = differing.map(|(name, _)| name).collect();
    assert!(differing.is_empty(), "{folder}: {differing:?} differ");
}

#[cfg_attr(not(feature = "mpi"), ignore = "needs --features mpi")]
#[test]
fn any_number_of_processes_writes_the_same() {
    let place = place_with(PLATE);
    place.run("run plate.toml --out alone", 0);
    for (size, threads) in [(1, 1), (2, 1), (4, 1), (1, 2), (2, 2), (4, 2)] {
        let folder = format!("on-{size}-with-{threads}");
        let arguments = format!("run plate.toml --threads {threads} --out {folder}");
        let (stdout, _) = ended(&mut processes(&place, size, &arguments), 0);
        assert_eq!(stdout.matches("completed").count(), 1, "{stdout}");
        assert_same(&place, &folder, "alone");
    }
}

#[cfg_attr(not(feature = "mpi"), ignore = "needs --features mpi")]
#[test]
fn cases_of_the_repository_write_the_same_on_any_number_of_processes() {
    let place = Place::new();
    for (case, shorter, stops) in CASES {
        let path = format!("{}/../../cases/{case}/case.toml", env!("CARGO_MANIFEST_DIR"));
        let run = format!("run {path} {shorter} --quiet --out {case}");
        place.run(&format!("{run}/alone"), 0);
        for (size, threads) in [(1, 1), (2, 1), (4, 1), (2, 2)] {
            let folder = format!("on-{size}-with-{threads}");
            let arguments = format!("{run}/{folder} --threads {threads}");
            ended(&mut processes(&place, size, &arguments), 0);
            assert_same(&place, &format!("{case}/{folder}"), &format!("{case}/alone"));
        }
        // Broken off on four of them and on two, with one thread each and with two, and continued on another number.
        let split = format!("{run}/split --resume --set checkpoint.every_steps=4");
        for ((size, threads), steps) in [(4, 1), (2, 2)].into_iter().zip(stops) {
            let arguments = format!("{split} --threads {threads} --set time.max_steps={steps}");
            let (_, stderr) = ended(&mut processes(&place, size, &arguments), 3);
            assert_contains(&stderr, &[&format!("maximum number of steps, {steps},")]);
        }
        ended(&mut processes(&place, 3, &format!("{split} --threads 1")), 0);
        let record: Value =
            serde_json::from_str(&place.read(&format!("{case}/split/run.json"))).unwrap();
        assert_eq!(record["resumed_at"].as_array().unwrap().len(), 2, "{record}");
        assert_same(&place, &format!("{case}/split"), &format!("{case}/alone"));
        let is_larger = record["notes"].to_string().contains("the reserve ran out");
        assert_eq!(is_larger, shorter.contains("reserve"), "{record}");
    }
}

/// A step that fails is told once, in the words of a run on one rank, and leaves the same state.
#[cfg_attr(not(feature = "mpi"), ignore = "needs --features mpi")]
#[test]
fn a_failing_step_is_told_once() {
    let place = place_with(PLATE);
    // The plate becomes faster than that after some steps.
    let limit = "--set time.max_speed=0.36";
    let (_, expected) = place.run(&format!("run plate.toml {limit} --out alone"), 3);
    for (size, threads) in [(2, 2), (3, 1)] {
        let folder = format!("on-{size}");
        let arguments = format!("run plate.toml {limit} --threads {threads} --out {folder}");
        let (stdout, stderr) = ended(&mut processes(&place, size, &arguments), 3);
        assert_contains(&stdout, &["failed: "]);
        let expected = expected.replace("alone", &folder);
        for line in expected.lines() {
            assert_eq!(stderr.matches(line).count(), 1, "`{line}` comes once:\n{stderr}");
        }
        assert_contains(&stderr, &["the last good state is in on-", "particle"]);
        assert!(place.newest_checkpoint(&folder).is_some());
        assert_same(&place, &folder, "alone");
        let tables = ["failure.csv", "probes.csv"].map(|name| place.path(&folder).join(name));
        assert!(tables.iter().all(|table| table.exists()), "{tables:?}");
    }
}

/// Asked to end, a rank that is not the first one ends the run of all, which goes on on another number.
#[cfg_attr(not(feature = "mpi"), ignore = "needs --features mpi")]
#[test]
fn any_process_can_be_asked_to_end() {
    let place = place_with(PLATE);
    let run = |folder: &str, end: f64| {
        format!("run plate.toml {LONG} --threads 1 --out {folder} --set time.end={end}")
    };
    let mut program = Program::start(&mut processes(&place, 3, &run("split", 1e3)));
    let series = place.path("split/particles.pvd");
    program.wait_for(&series, |text| text.matches("<DataSet").count() > 2);
    let ids = ranks_of(&program);
    assert_eq!(ids.len(), 3, "{ids:?}");
    send("TERM", ids[2]);
    let (code, stdout, stderr) = program.end();
    assert_eq!(code, Some(130), "{stdout}{stderr}");
    assert_eq!(stdout.matches("interrupted: t = ").count(), 1, "{stdout}");
    assert!(!stderr.contains("panicked") && !ids.into_iter().any(is_running), "{stderr}");
    let told = stdout.split("t = ").nth(1).unwrap().split(' ').next().unwrap();
    let end = told.parse::<f64>().unwrap() + 0.1;
    let (stdout, _) =
        ended(&mut processes(&place, 2, &format!("{} --resume", run("split", end))), 0);
    assert_contains(&stdout, &["completed", "resumed     from t = "]);
    place.run(&run("whole", end), 0);
    assert_same(&place, "split", "whole");
}

/// Interrupted on two processes, and continued on four.
#[cfg_attr(not(feature = "mpi"), ignore = "needs --features mpi")]
#[test]
fn an_interrupted_run_goes_on_on_another_number_of_processes() {
    let place = place_with(PLATE);
    let run = |folder: &str, end: f64| {
        format!("run plate.toml {LONG} --threads 1 --out {folder} --set time.end={end}")
    };
    // `mpirun` asks its processes to end when this time has passed, and ends them when it has passed again.
    let mut first = processes(&place, 2, &run("split", 1e3));
    let mut program = Program::start(first.env("OMPI_MCA_odls_base_sigkill_timeout", "3"));
    let series = place.path("split/particles.pvd");
    program.wait_for(&series, |text| text.matches("<DataSet").count() > 2);
    let (code, stdout, stderr) = program.stop("INT");
    assert_ne!(code, Some(0), "{stdout}{stderr}");
    assert_contains(&stdout, &["interrupted: t = "]);
    assert_eq!(stderr.matches("stopping after this step").count(), 1, "{stderr}");
    let told = stdout.split("t = ").nth(1).unwrap().split(' ').next().unwrap();
    let end = told.parse::<f64>().unwrap() + 0.3;
    let (stdout, _) =
        ended(&mut processes(&place, 4, &format!("{} --resume", run("split", end))), 0);
    assert_contains(&stdout, &["completed", "resumed     from t = "]);
    place.run(&run("whole", end), 0);
    assert_same(&place, "split", "whole");
    let record: Value = serde_json::from_str(&place.read("split/run.json")).unwrap();
    assert_eq!(record["resumed_at"].as_array().unwrap().len(), 1);
}

/// Stopped after a number of steps on four processes, and continued on two, and then by one without MPI.
#[cfg_attr(not(feature = "mpi"), ignore = "needs --features mpi")]
#[test]
fn a_run_goes_on_without_mpi() {
    let place = place_with(PLATE);
    place.run("run plate.toml --out whole", 0);
    for (size, steps) in [(4, 8), (2, 16)] {
        let arguments =
            format!("run plate.toml --threads 1 --out split --resume --set time.max_steps={steps}");
        let (_, stderr) = ended(&mut processes(&place, size, &arguments), 3);
        assert_contains(&stderr, &["steps"]);
    }
    let (stdout, _) = place.run("run plate.toml --out split --resume", 0);
    assert_contains(&stdout, &["completed", "resumed     from t = "]);
    assert_same(&place, "split", "whole");
}

/// The processes of piola that `mpirun` has started, by rank.
fn ranks_of(program: &Program) -> Vec<u32> {
    let id = program.0.id().to_string();
    let output = Command::new("pgrep").args(["-P", &id]).output().unwrap();
    let mut ids: Vec<u32> =
        String::from_utf8_lossy(&output.stdout).lines().map(|id| id.parse().unwrap()).collect();
    ids.sort_unstable();
    ids
}

/// Whether a process is there, and not only its exit code.
fn is_running(id: u32) -> bool {
    let output = Command::new("ps").args(["-o", "stat=", "-p", &id.to_string()]).output().unwrap();
    let state = String::from_utf8_lossy(&output.stdout).trim().to_owned();
    !state.is_empty() && !state.starts_with('Z')
}

/// Killed without a word, a process takes the others with it. The run goes on from its last checkpoint.
#[cfg_attr(not(feature = "mpi"), ignore = "needs --features mpi")]
#[test]
fn a_killed_process_ends_all() {
    a_killed_process_ends(LONG);
}

/// The same in the middle of a solution of equations.
#[cfg_attr(not(feature = "mpi"), ignore = "needs --features mpi")]
#[test]
fn a_process_that_is_killed_while_equations_are_solved_ends_all() {
    let steps = "--set scheme.viscosity=0 --set time.integrator='newmark' --set time.linear_solver='krylov'";
    a_killed_process_ends(&format!("{steps} --set time.step=0.0005 --set time.end=0.1"));
}

#[track_caller]
fn a_killed_process_ends(set: &str) {
    let place = place_with(PLATE);
    place.run(&format!("run plate.toml --out whole {set}"), 0);
    let arguments = format!("run plate.toml --threads 1 --out split --resume {set}");
    for lost in [1, 0] {
        let newest = place.newest_checkpoint("split");
        let mut program = Program::start(&mut processes(&place, 2, &arguments));
        program.wait_until("there is a checkpoint", || place.newest_checkpoint("split") > newest);
        let ids = ranks_of(&program);
        assert_eq!(ids.len(), 2, "{ids:?}");
        send("KILL", ids[lost]);
        let (code, stdout, stderr) = program.end();
        assert!(code != Some(0) && !stdout.contains("completed"), "{stdout}{stderr}");
        assert!(!stderr.contains("panicked"), "{stderr}");
        // The other one has ended, too.
        assert!(!ids.into_iter().any(is_running), "{stdout}{stderr}");
    }
    let (stdout, _) = ended(&mut processes(&place, 4, &arguments), 0);
    assert_contains(&stdout, &["completed", "resumed     from t = "]);
    assert_same(&place, "split", "whole");
}

#[cfg_attr(not(feature = "mpi"), ignore = "needs --features mpi")]
#[test]
fn a_bad_case_is_refused_once() {
    let place = place_with(&PLATE.replace("spacing = 0.05", "spacin = 0.05"));
    let mut command = processes(&place, 3, "run plate.toml");
    refused(&place, &mut command, 2, &["did you mean `spacing`?", "1 problem in plate.toml"]);

    let place = place_with(&PLATE.replace("point = [1.8, 0.0]", "point = [7.0, 0.0]"));
    refused(&place, &mut processes(&place, 3, "run plate.toml"), 2, &["selects no"]);

    let place = Place::new();
    refused(&place, &mut processes(&place, 2, "run plate.toml"), 4, &["No such file"]);
}

#[cfg_attr(not(feature = "mpi"), ignore = "needs --features mpi")]
#[test]
fn what_several_processes_cannot_run_is_refused_once() {
    let place = Place::with_bar();
    let mut command = processes(&place, 2, "run bar/case.toml");
    refused(&place, &mut command, 2, &["2 ranks are too many for 6 particles"]);

    let place = place_with(PLATE);
    let implicit = "run plate.toml --set scheme.viscosity=0 --set time.integrator='newmark' --set time.step=0.001";
    let parts = ["the direct linear solver does not run on several ranks yet"];
    refused(&place, &mut processes(&place, 2, implicit), 2, &parts);

    let mut command = processes(&place, 2, "run plate.toml --ranks 2");
    refused(&place, &mut command, 2, &["the ranks are processes of MPI: leave out `--ranks`"]);
}

#[cfg_attr(not(feature = "mpi"), ignore = "needs --features mpi")]
#[test]
fn processes_with_different_cases_are_refused_once() {
    let place = place_with(PLATE);
    place.write("other.toml", PLATE.replace("300.0", "301.0"));
    let mut command = processes(&place, 1, "run plate.toml --out results");
    command.args([":", "-n", "1", env!("CARGO_BIN_EXE_piola"), "run", "other.toml"]);
    refused(&place, &mut command, 2, &["rank 1 has another case"]);

    // One of them has none.
    let mut command = processes(&place, 1, "run plate.toml --out results");
    command.args([":", "-n", "1", env!("CARGO_BIN_EXE_piola"), "run", "none.toml"]);
    let (code, stdout, stderr) = Program::start(&mut command).end();
    // Whichever ends first.
    assert!(matches!(code, Some(2 | 4)), "{code:?}\n{stdout}\n{stderr}");
    assert_contains(&stderr, &["none.toml"]);
    assert_eq!(stderr.matches("rank 1 cannot begin").count(), 1, "{stderr}");
}

#[cfg_attr(not(feature = "mpi"), ignore = "needs --features mpi")]
#[test]
fn a_folder_that_cannot_be_made_is_told_once() {
    let place = place_with(PLATE);
    let mut command = processes(&place, 2, "run plate.toml --out plate.toml/results");
    refused(&place, &mut command, 4, &["cannot use plate.toml as a folder"]);
}
