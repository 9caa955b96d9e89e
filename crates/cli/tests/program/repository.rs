//! The cases of the repository at their coarse setting: what `piola verify cases` shows a user.

use std::path::Path;

use assert_cmd::Command;

#[test]
fn every_case_of_the_repository_passes_its_checks() {
    let cases = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../cases");
    let output = Command::cargo_bin("piola").unwrap().arg("verify").arg(cases).output().unwrap();
    let text = String::from_utf8_lossy(&output.stdout);
    let errors = String::from_utf8_lossy(&output.stderr);
    assert_eq!(output.status.code(), Some(0), "{text}\n{errors}");
    assert!(text.contains(" 0 failed"), "{text}");
}
