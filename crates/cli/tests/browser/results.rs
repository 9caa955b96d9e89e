//! Results to look at, made by the program.

use std::path::{Path, PathBuf};
use std::process::Command;

use tempfile::TempDir;

/// A folder for results.
pub struct Results {
    folder: TempDir,
}

impl Results {
    pub fn new() -> Self {
        Self { folder: tempfile::tempdir().unwrap() }
    }

    /// Runs a case of the repository and returns the path of its report.
    pub fn of_repository(&self, case: &str, arguments: &[&str]) -> PathBuf {
        let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("../..");
        self.run(&root.join("cases").join(case).join("case.toml"), arguments, 0)
    }

    /// Runs a case given by its text.
    pub fn of_text(&self, text: &str, code: i32) -> PathBuf {
        let case = self.folder.path().join("case.toml");
        std::fs::write(&case, text).unwrap();
        self.run(&case, &[], code)
    }

    /// Replaces a text in the record of the run, and makes its report again.
    pub fn change_record(&self, from: &str, to: &str) {
        let folder = self.folder.path().join("results");
        let record = folder.join("run.json");
        let text = std::fs::read_to_string(&record).unwrap();
        assert!(text.contains(from), "{text}");
        std::fs::write(&record, text.replace(from, to)).unwrap();
        let mut command = Command::new(env!("CARGO_BIN_EXE_piola"));
        assert!(command.arg("report").arg(&folder).output().unwrap().status.success());
    }

    fn run(&self, case: &Path, arguments: &[&str], code: i32) -> PathBuf {
        let folder = self.folder.path().join("results");
        let output = Command::new(env!("CARGO_BIN_EXE_piola"))
            .arg("run")
            .arg(case)
            .args(arguments)
            .arg("--out")
            .arg(&folder)
            .output()
            .unwrap();
        let stderr = String::from_utf8_lossy(&output.stderr);
        assert_eq!(output.status.code(), Some(code), "{stderr}");
        folder.join("report.html")
    }
}
