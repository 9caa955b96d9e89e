//! Ranks that are processes of MPI: every call, and how they end if one of them fails.

mod mpirun;

use std::path::PathBuf;
use std::process::{Command, Output};

use mpirun::mpirun;

/// The example, which cargo builds beside the tests.
fn ring() -> PathBuf {
    let test = std::env::current_exe().expect("this program has a path");
    let built = test.ancestors().nth(2).expect("tests are in a folder of what was built");
    let ring = built.join("examples/ring");
    assert!(ring.exists(), "there is no {}: test the whole package", ring.display());
    ring
}

/// A command that starts ranks.
fn of(size: usize) -> Command {
    let mut command = mpirun();
    command.args(["-n", &size.to_string()]).arg(ring());
    command
}

/// What ranks say.
fn run(command: &mut Command) -> Output {
    command.output().expect("mpirun starts (Debian: openmpi-bin)")
}

#[cfg_attr(not(feature = "mpi"), ignore = "needs --features mpi")]
#[test]
fn processes_agree_on_every_call() {
    for size in [1, 2, 4] {
        let output = run(&mut of(size));
        let said = String::from_utf8_lossy(&output.stdout);
        assert_eq!(said, format!("{size} processes agree on every call\n"), "{output:?}");
        assert!(output.status.success(), "{output:?}");
    }
}

/// Ranks that wait for one that fails do not wait for ever.
#[cfg_attr(not(feature = "mpi"), ignore = "needs --features mpi")]
#[test]
fn a_rank_that_fails_ends_all() {
    let cases = [
        ("abort", 3, ""),
        ("panic", 1, "on purpose"),
        ("length", 1, "rank 0 has sent 3 numbers where 2 were expected"),
        ("thread", 1, "call it from that one"),
    ];
    for (failure, code, expected) in cases {
        let output = run(of(3).arg(failure));
        let said = String::from_utf8_lossy(&output.stderr);
        assert_eq!(output.status.code(), Some(code), "{failure}: {output:?}");
        assert!(said.contains(expected), "{failure}: {said}");
    }
}

#[cfg_attr(not(feature = "mpi"), ignore = "needs --features mpi")]
#[test]
fn what_mpirun_has_not_started_is_no_process_of_it() {
    let output = Command::new(ring()).arg("3").output().unwrap();
    assert_eq!(String::from_utf8_lossy(&output.stdout), "3 threads agree on every call\n");
}

/// Ranks started by another MPI, which speaks PMI, would all be the only one.
#[cfg_attr(not(feature = "mpi"), ignore = "needs --features mpi")]
#[test]
fn another_mpi_is_refused() {
    let output = run(of(1).env("PMI_SIZE", "4"));
    let said = String::from_utf8_lossy(&output.stderr);
    assert!(!output.status.success() && said.contains("do not find each other"), "{output:?}");
}
