//! The cases of the repository at their coarse setting: what `piola verify cases` shows a user.

use std::path::Path;

use assert_cmd::Command;

/// Two at a time, as small cases keep one thread busy.
#[test]
fn every_case_of_the_repository_passes_its_checks() {
    let cases = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../cases");
    let mut command = Command::cargo_bin("piola").unwrap();
    let at_a_time = ["verify", "--jobs", "2", "--threads", "2"];
    let output = command.args(at_a_time).arg(&cases).output().unwrap();
    let text = String::from_utf8_lossy(&output.stdout);
    let errors = String::from_utf8_lossy(&output.stderr);
    assert_eq!(output.status.code(), Some(0), "{text}\n{errors}");
    assert!(text.contains(" 0 failed"), "{text}");
    let cases = text.split(" checks of ").nth(1).and_then(|rest| rest.split(' ').next());
    assert!(cases.is_some_and(|count| count.parse::<usize>().unwrap() >= 90), "{text}");
}
