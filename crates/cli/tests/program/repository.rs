//! The cases of the repository at their coarse setting: what `piola verify cases` shows a user.

use std::fs;
use std::path::Path;
use std::thread;

use assert_cmd::Command;

/// Small cases keep one thread busy: this many are verified at a time.
const AT_A_TIME: usize = 2;

#[test]
fn every_case_of_the_repository_passes_its_checks() {
    let cases = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../cases");
    let folders = |above: &Path| {
        let entries = fs::read_dir(above).unwrap().map(|entry| entry.unwrap().path());
        let mut found: Vec<_> = entries.filter(|path| path.is_dir()).collect();
        found.sort();
        found
    };
    let all: Vec<_> = folders(&cases).iter().flat_map(|above| folders(above)).collect();
    let all: Vec<_> = all.into_iter().filter(|folder| folder.join("case.toml").is_file()).collect();
    assert!(all.len() >= 60, "{}", all.len());
    thread::scope(|scope| {
        for first in 0..AT_A_TIME {
            let some = all.iter().skip(first).step_by(AT_A_TIME);
            scope.spawn(|| {
                let mut command = Command::cargo_bin("piola").unwrap();
                let output =
                    command.args(["verify", "--threads", "1"]).args(some).output().unwrap();
                let text = String::from_utf8_lossy(&output.stdout);
                let errors = String::from_utf8_lossy(&output.stderr);
                assert_eq!(output.status.code(), Some(0), "{text}\n{errors}");
                assert!(text.contains(" 0 failed"), "{text}");
            });
        }
    });
}
