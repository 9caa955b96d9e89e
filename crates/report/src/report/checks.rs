//! The table of checks.

use maud::{Markup, html};

use super::facts::MAX_LINES;
use super::{Report, Verdict};

/// How many of the checks of this run passed: `5 of 6 checks passed`; empty if there is none.
pub fn tally(report: &Report) -> String {
    let passed = report.checks.iter().filter(|check| check.verdict == Verdict::Passed).count();
    match report.checks.len() {
        0 => String::new(),
        count => format!("{passed} of {count} checks passed"),
    }
}

/// The table of checks.
pub fn checks(report: &Report) -> Markup {
    html! {
        section #checks {
            h2 { "Checks" }
            @if !report.record.overrides.is_empty() && !report.checks.is_empty() {
                p .notice {
                    "This run had overrides (" code { (report.record.overrides.join(" ")) }
                    "). The checks were written for the case without them."
                }
            }
            @if report.checks.is_empty() {
                p { "The case has no checks of this run." }
            } @else {
                div .wide { table .checks {
                    thead { tr {
                        th {} th { "Quantity" } th { "Expected" } th { "Tolerance" } th { "Got" }
                        th { "Source of the expected value" }
                    } }
                    tbody { @for check in report.checks.iter().take(MAX_LINES) {
                        tr {
                            td { (verdict(check.verdict)) }
                            td { code { (check.quantity) } }
                            td { (check.expected) }
                            td { (check.tolerance) }
                            td { (check.got) }
                            td {
                                (check.source)
                                @if let Some(reason) = &check.reason { p .reason { (reason) } }
                            }
                        }
                    } }
                } }
            }
            @if !report.other_checks.is_empty() {
                details {
                    summary {
                        (report.other_checks.len()) " more checks need another run and are not "
                        "evaluated here: " code { "piola verify" } " runs them all"
                    }
                    div .wide { table {
                        thead { tr { th { "Quantity" } th { "Needs" } th { "Source" } } }
                        tbody { @for check in report.other_checks.iter().take(MAX_LINES) {
                            tr {
                                td { code { (check.quantity) } }
                                td { (check.needs) }
                                td { (check.source) }
                            }
                        } }
                    } }
                }
            }
        }
    }
}

fn verdict(verdict: Verdict) -> Markup {
    let (class, text) = match verdict {
        Verdict::Passed => ("badge good", "✓ pass"),
        Verdict::Failed => ("badge bad", "✗ FAIL"),
        Verdict::Unmet => ("badge open", "✗ not met"),
        Verdict::Open => ("badge open", "– open"),
    };
    html! { span class=(class) { (text) } }
}
