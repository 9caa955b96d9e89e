use std::fs;

use crate::support::{BAR, Place, assert_contains, ended};

/// The rows of a table, without its header.
fn rows(table: &str) -> Vec<Vec<f64>> {
    let lines = table.lines().skip(1);
    lines.map(|line| line.split(',').map(|cell| cell.parse().unwrap()).collect()).collect()
}

#[test]
fn a_run_writes_results_and_says_where() {
    let place = Place::with_bar();
    let (stdout, stderr) = place.run("run bar/case.toml", 0);
    assert_contains(
        &stdout,
        &[
            "completed: t = 0.02 s",
            "6 particles",
            "energy",
            "balance",
            "open results/bar/particles.pvd",
        ],
    );
    assert_eq!(stderr, "");
    let probes = place.read("results/bar/probes.csv");
    assert!(probes.starts_with("time [s],tip.displacement.x [m]"), "{probes}");
    // Rows at 0, 0.002, ... 0.02.
    let rows = rows(&probes);
    assert_eq!(rows.len(), 11);
    assert_eq!((rows[0][0], rows[10][0]), (0.0, 0.02));
    assert_eq!(place.read("results/bar/particles.pvd").matches("<DataSet").count(), 2);
}

#[test]
fn overrides_variant_and_folder_are_obeyed() {
    let place = Place::with_bar();
    place.run("run bar/case.toml --variant fast --set time.end=0.004 --threads 2", 0);
    let fast = rows(&place.read("results/bar-fast/probes.csv"));
    assert_eq!(fast.len(), 3);
    place.run("run bar/case.toml --set time.end=0.004 --out deep/er", 0);
    let plain = rows(&place.read("deep/er/probes.csv"));
    // The bar is linear in its start speed but for the convective terms that a strain of 1 % has.
    let ratio = fast[2][1] / plain[2][1];
    assert!((ratio - 2.0).abs() < 0.02, "{ratio}");
}

#[test]
fn threads_do_not_change_results() {
    let place = Place::with_bar();
    for threads in [1, 3] {
        place.run(&format!("run bar/case.toml --threads {threads} --out r{threads}"), 0);
    }
    assert_eq!(place.read("r1/probes.csv"), place.read("r3/probes.csv"));
    assert_eq!(place.read("r1/energy.csv"), place.read("r3/energy.csv"));
}

#[test]
fn quiet_is_quiet() {
    let place = Place::with_bar();
    assert_eq!(place.run("run bar/case.toml --quiet", 0), Default::default());
    assert!(place.path("results/bar/particles.pvd").exists());
}

#[test]
fn a_case_file_with_a_name_of_its_own_names_its_results() {
    let place = Place::new();
    place.write("study/soft.toml", BAR);
    place.run("run study/soft.toml -q", 0);
    assert!(place.path("results/soft/particles.pvd").exists());
}

#[test]
fn a_failed_run_is_told_from_other_faults() {
    let place = Place::with_bar();
    let (stdout, stderr) = place.run("run bar/case.toml --set time.max_steps=3", 3);
    assert_contains(
        &stderr,
        &[
            "the run failed: it took the maximum number of steps, 3,",
            "time.max_steps",
            "results/bar",
        ],
    );
    assert_contains(&stdout, &["failed: too_many_steps", "after 3 steps"]);
    assert!(place.path("results/bar/particles.pvd").exists());
    // A fixed step beyond the stable one fails before the first step.
    let text = BAR.replace("cfl = 0.2", "step = 0.1");
    place.write("stiff/case.toml", text);
    let (_, stderr) = place.run("run stiff/case.toml", 3);
    assert_contains(&stderr, &["the fixed step", "time.cfl"]);
}

#[test]
fn faults_of_the_results_folder() {
    let place = Place::with_bar();
    place.write("file", "");
    for out in ["file", "file/below"] {
        let (_, stderr) = place.run(&format!("run bar/case.toml --out {out}"), 4);
        assert_contains(&stderr, &["error:", "file"]);
    }
    assert_eq!(place.read("file"), "");
}

/// A limit on the length of files, which a write beyond it fails at as on a full disk.
#[cfg(unix)]
#[test]
fn a_full_disk_ends_all_ranks_with_one_sentence() {
    let place = Place::with_bar();
    for ranks in [1, 3] {
        let program = env!("CARGO_BIN_EXE_piola");
        let script = format!(
            "trap '' XFSZ; ulimit -f 16; exec '{program}' run bar/case.toml --set body.bar.spacing=0.0002 \
             --set time.end=1e-4 --set output.every=5e-5 --ranks {ranks} --out on-{ranks}"
        );
        let mut command = std::process::Command::new("sh");
        let output = command.args(["-c", &script]).current_dir(place.path("")).output().unwrap();
        let stderr = String::from_utf8_lossy(&output.stderr);
        assert_eq!(output.status.code(), Some(4), "{stderr}");
        assert_eq!(stderr.lines().count(), 1, "{stderr}");
        assert_contains(&stderr, &["error: ", &format!("on-{ranks}"), "too large"]);
    }
}

#[cfg(target_os = "linux")]
#[test]
fn a_full_standard_output_is_a_fault() {
    use std::process::{Command, Stdio};
    let place = Place::with_bar();
    let full = fs::OpenOptions::new().write(true).open("/dev/full").unwrap();
    let status = Command::new(env!("CARGO_BIN_EXE_piola"))
        .args(["run", "bar/case.toml"])
        .current_dir(place.path(""))
        .stdout(full)
        .stderr(Stdio::null())
        .status();
    assert_eq!(status.unwrap().code(), Some(4));
}

#[cfg(target_os = "linux")]
#[test]
fn names_that_are_not_utf8_are_fine() {
    use std::ffi::OsStr;
    use std::os::unix::ffi::OsStrExt;
    let place = Place::new();
    let name = OsStr::from_bytes(b"b\xe4r");
    fs::create_dir(place.path(name)).unwrap();
    fs::write(place.path(name).join("case.toml"), BAR).unwrap();
    let mut command = place.piola("run");
    ended(command.arg(std::path::Path::new(name).join("case.toml")), 0);
    assert!(place.path("results").join(name).join("particles.pvd").exists());
    let mut command = place.piola("verify");
    let (stdout, _) = ended(command.arg(name), 0);
    assert_contains(&stdout, &["1 passed"]);
}

/// Each of several processes would do the whole run, and write it to the same folder.
#[cfg(not(feature = "mpi"))]
#[test]
fn one_of_several_processes_needs_mpi() {
    let place = Place::with_bar();
    for (variable, value) in [
        ("OMPI_COMM_WORLD_SIZE", "3"),
        ("PMI_SIZE", "3"),
        ("SLURM_STEP_NUM_TASKS", "3"),
        ("PMIX_RANK", "2"),
    ] {
        let (_, stderr) = ended(place.piola("run bar/case.toml").env(variable, value), 2);
        assert_contains(&stderr, &["one of 3 processes", "--features mpi", "`--ranks 3`"]);
        assert!(!place.path("results").exists());
    }
    // A shell in an allocation of Slurm, and a command that needs no others.
    ended(place.piola("run bar/case.toml --out alone").env("SLURM_STEP_NUM_TASKS", "1"), 0);
    ended(place.piola("check bar/case.toml").env("PMI_SIZE", "3"), 0);
}
