//! The report of a run in a real browser, driven over the DevTools protocol.
//!
//! Needs Chromium or Chrome in the path, or `PIOLA_BROWSER` with the path of one. Without one the
//! tests say that they were not run and pass, unless `PIOLA_BROWSER_REQUIRED` is `1`.

#![allow(clippy::unwrap_used, reason = "the helpers of tests may panic as tests do")]

mod browser;
mod report;
mod results;
