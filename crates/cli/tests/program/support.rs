//! What the tests share: a tiny case, and the program in a folder of its own.

use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};

use assert_cmd::Command;
use tempfile::TempDir;

/// A bar of 6 particles that swings; some ten steps take a few microseconds.
pub const BAR: &str = r#"
version = 1
id = "T1"
title = "A tiny bar"
dimension = 1

[parameters]
speed = 1.0

[[body]]
name = "bar"
shape = { kind = "box", min = [0.0], max = [1.0] }
spacing = 0.2
material = { kind = "linear", density = 1000.0, bulk_modulus = 1e5 }
initial = { velocity = ["speed * x"] }

[scheme]
kind = "upwind"
smoothing_length = 1.0

[time]
end = 0.02
cfl = 0.2

[[boundary]]
name = "clamp"
where = { kind = "plane", point = [0.0], normal = [-1.0] }
velocity = { x = 0.0 }

[[probe]]
name = "tip"
kind = "particle"
at = [1.0]
fields = ["displacement"]

[output]
every = 0.02
table_every = 0.002

[coarse]
set = ["time.end=0.01"]

[[variant]]
name = "fast"
set = ["parameters.speed=2.0"]

[[check]]
quantity = "tip.displacement.x"
reduce = "initial"
expected = 0.0
tolerance = 1e-15
absolute = true
against = "exact"
source = "it starts at rest"
"#;

/// A folder with the program in it.
pub struct Place {
    folder: TempDir,
}

impl Place {
    /// An empty folder.
    pub fn new() -> Self {
        Self { folder: tempfile::tempdir().unwrap() }
    }

    /// A folder with the tiny case in `bar/case.toml`.
    pub fn with_bar() -> Self {
        let place = Self::new();
        place.write("bar/case.toml", BAR);
        place
    }

    /// The path of something in the folder.
    pub fn path(&self, name: impl AsRef<Path>) -> PathBuf {
        self.folder.path().join(name)
    }

    /// Writes a file, with the folders above it.
    pub fn write(&self, name: &str, content: impl AsRef<[u8]>) {
        let path = self.path(name);
        fs::create_dir_all(path.parent().unwrap()).unwrap();
        fs::write(path, content).unwrap();
    }

    /// Reads a file.
    pub fn read(&self, name: &str) -> String {
        let path = self.path(name);
        fs::read_to_string(&path).unwrap_or_else(|error| panic!("{}: {error}", path.display()))
    }

    /// The bytes of all results in a folder that do not tell the time of day, by name.
    pub fn results(&self, folder: &str) -> BTreeMap<String, Vec<u8>> {
        let folder = self.path(folder);
        let entries = ["", "particles", "plots"].map(|part| fs::read_dir(folder.join(part)));
        let paths = entries.into_iter().flatten().flatten().map(|entry| entry.unwrap().path());
        let files = paths.filter(|path| path.is_file()).map(|path| {
            let name = path.strip_prefix(&folder).unwrap().display().to_string();
            (name, fs::read(path).unwrap())
        });
        files.filter(|(name, _)| name != "run.json" && name != "report.html").collect()
    }

    /// The steps before the newest checkpoint in a folder of results, if there is one.
    pub fn newest_checkpoint(&self, folder: &str) -> Option<u64> {
        let folder = fs::read_dir(self.path(folder).join("checkpoints")).ok()?;
        let name = |path: PathBuf| path.file_name()?.to_str()?.strip_prefix("step_")?.parse().ok();
        folder.filter_map(|entry| name(entry.ok()?.path())).max()
    }

    /// The program with these arguments, separated by blanks.
    pub fn piola(&self, arguments: &str) -> Command {
        let mut command = Command::cargo_bin("piola").unwrap();
        command.current_dir(self.folder.path()).args(arguments.split_whitespace());
        command
    }

    /// Runs the program, which must end with `code` and never panic; stdout and stderr.
    #[track_caller]
    pub fn run(&self, arguments: &str, code: i32) -> (String, String) {
        ended(&mut self.piola(arguments), code)
    }
}

/// Runs `command`, which must end with `code` and never panic; stdout and stderr.
#[track_caller]
pub fn ended(command: &mut Command, code: i32) -> (String, String) {
    let output = command.output().unwrap();
    let stdout = String::from_utf8_lossy(&output.stdout).into_owned();
    let stderr = String::from_utf8_lossy(&output.stderr).into_owned();
    assert_eq!(output.status.code(), Some(code), "stdout:\n{stdout}\nstderr:\n{stderr}");
    assert!(!stderr.contains("panicked"), "{stderr}");
    (stdout, stderr)
}

/// Asserts that `text` contains all `parts`.
#[track_caller]
pub fn assert_contains(text: &str, parts: &[&str]) {
    for part in parts {
        assert!(text.contains(part), "`{part}` is missing in:\n{text}");
    }
}
