//! The report of a run in a real browser, driven over the DevTools protocol.
//!
//! Needs Chromium or Chrome in the path, or `PIOLA_BROWSER` with the path of one. Without one the
//! tests are ignored, which the list of results says, unless `PIOLA_BROWSER_REQUIRED` is `1`. The
//! harness of the standard library cannot ignore a test once it is compiled, so that this one has its
//! own.

#![allow(clippy::unwrap_used, reason = "the helpers of tests may panic as tests do")]

use std::path::Path;
use std::sync::Arc;

use libtest_mimic::{Arguments, Trial, run};

mod browser;
mod report;
mod results;

/// A test in a browser of a path, with its name.
type Test = (&'static str, fn(&Path));

const TESTS: [Test; 5] = [
    (
        "a_2d_report_shows_its_particles_and_obeys",
        report::a_2d_report_shows_its_particles_and_obeys,
    ),
    ("a_3d_report_turns", report::a_3d_report_turns),
    (
        "a_1d_report_draws_a_curve_beside_its_reference",
        report::a_1d_report_draws_a_curve_beside_its_reference,
    ),
    (
        "without_webgl_the_page_says_so_and_shows_pictures",
        report::without_webgl_the_page_says_so_and_shows_pictures,
    ),
    (
        "a_hostile_case_stays_text_and_a_failure_comes_first",
        report::a_hostile_case_stays_text_and_a_failure_comes_first,
    ),
];

fn main() {
    let program = browser::find().map(Arc::from);
    let trials = TESTS.map(|(name, test)| {
        let program: Option<Arc<Path>> = program.clone();
        let is_ignored = program.is_none();
        let in_browser = move || {
            // Whoever asks for the tests that are ignored wants them to fail.
            test(&program.expect("no browser is found"));
            Ok(())
        };
        Trial::test(name, in_browser).with_ignored_flag(is_ignored)
    });
    run(&Arguments::from_args(), trials.into()).exit();
}
