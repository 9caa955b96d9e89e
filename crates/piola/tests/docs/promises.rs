//! Every test that the page of promises names exists.

use std::fs;

use super::pages::{page, root};

#[test]
fn promised_tests_exist() {
    let page = page("docs/reliability.md");
    let (mut source, mut count) = (String::new(), 0);
    for row in page.text.lines().filter(|line| line.starts_with("| ")) {
        let tests = row.trim_end_matches('|').rsplit_once('|').map_or("", |(_, tests)| tests);
        for name in tests.split('`').skip(1).step_by(2) {
            if name.contains('/') {
                source = fs::read_to_string(root().join(name)).expect(name);
            } else {
                let test = format!("#[test]\nfn {name}()");
                // With arguments where they are drawn at random.
                let inside = format!("#[test]\n    fn {name}(");
                let python = format!("\ndef {name}(");
                // A test with a harness of its own is listed by name beside the function.
                let listed = format!("\"{name}\"");
                assert!(
                    [test, inside, python, listed].iter().any(|form| source.contains(form)),
                    "{name} is no test: {row}"
                );
                count += 1;
            }
        }
    }
    assert!(count > 20, "{count}");
}
