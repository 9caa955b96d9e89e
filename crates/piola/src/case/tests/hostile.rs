//! Files that are no case at all: never a panic, never an overflow of the stack.

use std::fs;

use proptest::prelude::*;

use super::*;
use crate::case::document::{MAX_BYTES, decode};

fn load_bytes(bytes: &[u8]) -> Result<Case, Problems> {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("case.toml");
    fs::write(&path, bytes).unwrap();
    load(&path, &LoadOptions::default())
}

#[test]
fn an_empty_file_lacks_everything() {
    let problems = load_bytes(b"").unwrap_err();
    assert!(!problems.is_io());
    let shown = problems.to_string();
    // Whether there has to be a clock the scheme tells.
    for key in
        ["key `version`", "key `title`", "key `dimension`", "table [[body]]", "table [scheme]"]
    {
        assert!(shown.contains(&format!("needs the {key}")), "{shown}");
    }
}

#[test]
fn a_huge_file_is_refused_unread() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("case.toml");
    fs::File::create(&path).unwrap().set_len(100_000_000).unwrap();
    let problems = load(&path, &LoadOptions::default()).unwrap_err();
    assert!(!problems.is_io());
    assert!(problems.to_string().contains("too large for a case file"), "{problems}");
    assert_eq!(MAX_BYTES, 16 << 20);
}

#[test]
fn files_that_cannot_be_read_are_told_apart() {
    let folder = tempfile::tempdir().unwrap();
    let missing = load(&folder.path().join("none.toml"), &LoadOptions::default()).unwrap_err();
    assert!(missing.is_io() && missing.to_string().contains("none.toml"));
    let directory = load(folder.path(), &LoadOptions::default()).unwrap_err();
    assert!(directory.is_io() && directory.to_string().contains("this is a folder"));
}

#[test]
fn bytes_that_are_no_text_are_shown() {
    let problems = load_bytes(b"version = 1\ntitle = \"\xff\xfe\"\n").unwrap_err();
    let shown = problems.to_string();
    assert!(shown.contains("it has the byte 0xff here"), "{shown}");
    assert!(shown.contains("case.toml:2:10"), "{shown}");
}

#[test]
fn a_missing_file_of_the_case_is_a_problem_at_its_name() {
    let problems = load_bytes(FULL.as_bytes()).unwrap_err();
    assert_eq!(problems.len(), 2);
    let shown = problems.to_string();
    assert!(shown.contains("cloud.csv") && shown.contains("curve.csv"), "{shown}");
    assert!(shown.contains("^^^^^^^^^^^ not found"), "{shown}");
}

#[test]
fn deep_nesting_is_refused() {
    let deep = 200_000;
    for text in [
        format!("a = {}", "[".repeat(deep)),
        format!("a = {}1{}", "[".repeat(deep), "]".repeat(deep)),
        format!("a = {}", "{b=".repeat(deep)),
        format!("{} = 1", vec!["a"; deep].join(".")),
        format!("[{}]", vec!["a"; deep].join(".")),
        format!("[[{}]]", vec!["a"; deep].join(".")),
        FULL.replace("\"x * y\"", &format!("\"{}\"", "(".repeat(deep))),
    ] {
        let problems = read_with(&text, &[]).unwrap_err();
        assert!(problems.to_string().len() < 20_000);
    }
    let path = format!("{}=1", vec!["a"; deep].join("."));
    assert!(read_with(FULL, &[&path]).is_err());
    let value = format!("a={}1{}", "[".repeat(deep), "]".repeat(deep));
    assert!(read_with(FULL, &[&value]).is_err());
}

#[test]
fn many_problems_are_counted_and_shown_in_part() {
    let text: String = (0..30_000).map(|number| format!("key{number} = {number}\n")).collect();
    let problems = read_with(&text, &[]).unwrap_err();
    assert!(problems.len() > 30_000);
    let shown = problems.to_string();
    assert_eq!(shown.matches("error:").count(), diagnostics::SHOWN);
    assert!(shown.contains("... and"), "{shown}");
}

/// The full case with a few bytes changed, which reaches deeper than random bytes do.
fn damaged() -> impl Strategy<Value = Vec<u8>> {
    let edit =
        (0..FULL.len(), prop_oneof![any::<u8>(), Just(b'"'), Just(b'['), Just(b'-'), Just(b'9')]);
    proptest::collection::vec(edit, 1..6).prop_map(|edits| {
        let mut bytes = FULL.as_bytes().to_vec();
        for (at, byte) in edits {
            bytes[at] = byte;
        }
        bytes
    })
}

fn read_bytes(bytes: Vec<u8>) {
    let result = decode("case.toml".to_owned(), bytes)
        .and_then(|source| parse(&source.text, "case.toml", &LoadOptions::default()));
    if let Err(problems) = result {
        assert!(!problems.is_empty());
        for problem in problems.iter() {
            let source = problems.source(problem).expect("a source");
            let end = problem.place.map_or(0, |place| place.span().end);
            assert!(end <= source.text.len(), "{problem:?}");
        }
        assert!(problems.to_string().starts_with("error: "));
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(128))]

    #[test]
    fn random_bytes_never_panic(bytes in proptest::collection::vec(any::<u8>(), 0..400)) {
        read_bytes(bytes);
    }

    #[test]
    fn random_text_never_panics(text in "[\\[\\]{}\"'=.,#a-c0-9 \n-]{0,120}") {
        read_bytes(text.into_bytes());
    }

    #[test]
    fn damaged_cases_never_panic(bytes in damaged()) {
        read_bytes(bytes);
    }

    #[test]
    fn random_overrides_never_panic(text in "[a-z.=\"'\\[\\]{}0-9 é-]{0,40}") {
        let _ = read_with(FULL, &[&text]).map_err(|problems| problems.to_string());
    }

    #[test]
    fn random_values_never_panic(number in 0..30usize, value in "[-a-z0-9\"'\\[\\]{}=., ]{0,20}") {
        let keys = ["time.end", "body", "body.0", "body.0.shape", "scheme", "load", "check.0.reduce",
            "probe.top.fields", "plot.0.curves", "variant.0.set", "coarse", "dimension", "parameters",
            "boundary.0.velocity", "picture.0.range", "output", "domain", "body.0.lattice"];
        let key = keys[number % keys.len()];
        let _ = read_with(FULL, &[&format!("{key}={value}")]).map_err(|problems| problems.to_string());
    }
}

#[test]
fn files_are_found_beside_the_case() {
    let folder = tempfile::tempdir().unwrap();
    for (name, text) in [("case.toml", FULL), ("cloud.csv", "x,y,volume\n"), ("curve.csv", "t,v\n")]
    {
        fs::write(folder.path().join(name), text).unwrap();
    }
    let case = load(&folder.path().join("case.toml"), &LoadOptions::default())
        .unwrap_or_else(|problems| panic!("{problems}"));
    assert_eq!(case.files()[0].value, folder.path().join("cloud.csv"));
}

#[test]
fn of_a_missing_file_it_is_said_once() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("case.toml");
    fs::write(folder.path().join("cloud.csv"), "x,y,volume\n").unwrap();
    let check = FULL.rsplit("[[check]]").find(|check| check.contains("curve.csv")).unwrap();
    let check = check.split("\n\n").next().unwrap();
    fs::write(&path, format!("{FULL}\n[[check]]{check}\n\n[[check]]{check}\n")).unwrap();
    let said = load(&path, &LoadOptions::default()).unwrap_err().to_string();
    assert_eq!(said.matches("error:").count(), 1, "{said}");
    assert!(said.contains("there is no file") && said.contains("curve.csv"), "{said}");
}
