//! Ranks that are processes of MPI: every call, and how they end if one of them fails.

use std::path::PathBuf;
use std::process::{Command, Output};

/// The example, which cargo builds beside the tests.
fn ring() -> PathBuf {
    let test = std::env::current_exe().expect("this program has a path");
    let built = test.ancestors().nth(2).expect("tests are in a folder of what was built");
    let ring = built.join("examples/ring");
    assert!(ring.exists(), "there is no {}: test the whole package", ring.display());
    ring
}

/// As root, on fewer cores than there are ranks, which otherwise wait busily, and for a minute at most.
const SETTINGS: [(&str, &str); 5] = [
    ("OMPI_ALLOW_RUN_AS_ROOT", "1"),
    ("OMPI_ALLOW_RUN_AS_ROOT_CONFIRM", "1"),
    ("OMPI_MCA_rmaps_base_oversubscribe", "1"),
    ("OMPI_MCA_mpi_yield_when_idle", "1"),
    ("MPIEXEC_TIMEOUT", "60"),
];

/// A command that starts ranks.
fn mpirun(size: usize) -> Command {
    let mut command = Command::new("mpirun");
    command.envs(SETTINGS).args(["-n", &size.to_string()]).arg(ring());
    command
}

/// What ranks say, unless there is no `mpirun`.
fn run(command: &mut Command) -> Option<Output> {
    match command.output() {
        Ok(output) => Some(output),
        Err(error) => {
            let missing = format!("there is no mpirun (Debian: openmpi-bin): {error}");
            assert!(std::env::var_os("PIOLA_MPI_REQUIRED").is_none(), "{missing}");
            eprintln!("NOT RUN: {missing}");
            None
        }
    }
}

#[test]
fn processes_agree_on_every_call() {
    for size in [1, 2, 4] {
        let Some(output) = run(&mut mpirun(size)) else { return };
        let said = String::from_utf8_lossy(&output.stdout);
        assert_eq!(said, format!("{size} processes agree on every call\n"), "{output:?}");
        assert!(output.status.success(), "{output:?}");
    }
}

/// Ranks that wait for one that fails do not wait for ever.
#[test]
fn a_rank_that_fails_ends_all() {
    let cases = [
        ("abort", 3, ""),
        ("panic", 1, "on purpose"),
        ("length", 1, "rank 0 has sent 3 numbers where 2 were expected"),
        ("thread", 1, "call it from that one"),
    ];
    for (failure, code, expected) in cases {
        let Some(output) = run(mpirun(3).arg(failure)) else { return };
        let said = String::from_utf8_lossy(&output.stderr);
        assert_eq!(output.status.code(), Some(code), "{failure}: {output:?}");
        assert!(said.contains(expected), "{failure}: {said}");
    }
}

#[test]
fn what_mpirun_has_not_started_is_no_process_of_it() {
    let output = Command::new(ring()).arg("3").output().unwrap();
    assert_eq!(String::from_utf8_lossy(&output.stdout), "3 threads agree on every call\n");
}

/// Ranks started by another MPI, which speaks PMI, would all be the only one.
#[test]
fn another_mpi_is_refused() {
    let Some(output) = run(mpirun(1).env("PMI_SIZE", "4")) else { return };
    let said = String::from_utf8_lossy(&output.stderr);
    assert!(!output.status.success() && said.contains("do not find each other"), "{output:?}");
}
