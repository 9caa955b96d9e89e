//! The frame of the page and the order of its parts.

use maud::{DOCTYPE, Markup, PreEscaped, html};

use super::{Report, Verdict, charts, checks, facts, pictures, policy, viewer};
use crate::drawing::ticks::number;

const STYLE: &str = include_str!("assets/style.css");
/// The program that tells values under the pointer, and enlarges pictures.
const SCRIPT: &str = include_str!("assets/page.js");
/// Most charts; more would make the page slow to open.
const MAX_CHARTS: usize = 40;

/// The whole page.
pub fn page(report: &Report) -> String {
    let record = report.record;
    let policy = policy::policy(STYLE, &[viewer::SCRIPT, SCRIPT]);
    let name = match &record.variant {
        Some(variant) => format!("{} ({variant})", record.title),
        None => record.title.clone(),
    };
    let markup = html! {
        (DOCTYPE)
        html lang="en" {
            head {
                meta charset="utf-8";
                meta http-equiv="Content-Security-Policy" content=(policy);
                meta name="viewport" content="width=device-width, initial-scale=1";
                meta name="color-scheme" content="light dark";
                meta name="generator" content=(format!("piola {}", record.version));
                title { (name) " · report of a run" }
                style { (PreEscaped(STYLE)) }
            }
            body {
                header { (head(report)) }
                main {
                    (failure(report))
                    (warnings(report))
                    (facts::summary(report))
                    nav aria-label="contents" {
                        a href="#particles" { "Particles" }
                        a href="#checks" { "Checks" }
                        a href="#plots" { "Plots" }
                        a href="#pictures" { "Pictures" }
                        a href="#energy" { "Energy" }
                        a href="#timings" { "Wall time" }
                        a href="#case" { "Case" }
                        a href="#files" { "Files" }
                    }
                    (viewer::section(report))
                    (checks::checks(report))
                    (plots(report))
                    (images(report))
                    (facts::energy(report))
                    (facts::timings(record))
                    (facts::case(record))
                    (facts::files(report))
                }
                footer {
                    "Made by piola " (env!("CARGO_PKG_VERSION"))
                    " from the results folder; one file that needs no network. "
                    code { "piola report DIR" } " makes it again."
                }
                script type="module" { (PreEscaped(SCRIPT)) }
            }
        }
    };
    markup.into_string()
}

fn head(report: &Report) -> Markup {
    let record = report.record;
    let class = match record.outcome.as_str() {
        "completed" => "badge good",
        outcome if outcome.starts_with("failed") => "badge bad",
        _ => "badge open",
    };
    let failed = report.checks.iter().any(|check| check.verdict == Verdict::Failed);
    let open =
        report.checks.iter().any(|check| matches!(check.verdict, Verdict::Open | Verdict::Unmet));
    let checked = match (failed, open) {
        (true, _) => "badge bad",
        (_, true) => "badge open",
        _ => "badge good",
    };
    let tally = checks::tally(report);
    html! {
        p .kicker {
            "Report of a run"
            @if let Some(id) = &record.id { " · " (id) }
            @if let Some(variant) = &record.variant { " · variant " (variant) }
            @if !record.overrides.is_empty() { " · with overrides" }
        }
        h1 { (record.title) }
        p {
            span #outcome class=(class) { (record.outcome) }
            @if !tally.is_empty() { " " a href="#checks" class=(checked) { (tally) } }
        }
    }
}

/// The first thing to read of a run that failed or did not reach its end.
fn failure(report: &Report) -> Markup {
    let record = report.record;
    html! {
        @if let Some(message) = &record.message {
            section #failure .failure {
                h2 { "The run failed" }
                p { (message) }
                p { "Everything below shows what there is up to the last good state." }
            }
        } @else if record.outcome == "running" {
            section #failure .failure {
                h2 { "The run has not ended" }
                p { "Its record says that it is running: it still is, or it was killed." }
            }
        }
    }
}

fn warnings(report: &Report) -> Markup {
    const MOST: usize = 50;
    let warnings = report.record.warnings.iter().chain(&report.notes);
    html! {
        @for retry in report.record.retries.iter().take(MOST) {
            p .notice {
                strong { "Retry: " } (retry.failure) " It went back to t = "
                (number(retry.back_to)) " s, with steps of " (number(retry.factor)) " times their usual length."
            }
        }
        @for warning in warnings.take(MOST) {
            p .notice { strong { "Warning: " } (warning) }
        }
    }
}

fn plots(report: &Report) -> Markup {
    let all: usize = report.charts.iter().map(|group| group.charts.len()).sum();
    let groups = report.charts.iter().scan(MAX_CHARTS, |left, group| {
        let shown = &group.charts[..group.charts.len().min(*left)];
        *left -= shown.len();
        Some((&group.title, shown))
    });
    html! {
        section #plots {
            h2 { "Plots" }
            @if all == 0 { p { "The tables hold nothing to plot." } }
            @if all > MAX_CHARTS {
                p .notice { "Shown: " (MAX_CHARTS) " of " (all) " charts. The tables hold all." }
            }
            @for (title, charts) in groups.filter(|(_, charts)| !charts.is_empty()) {
                h3 { (title) }
                div .charts { @for chart in charts { (charts::chart(chart)) } }
            }
        }
    }
}

fn images(report: &Report) -> Markup {
    let pictures = pictures::read(report.folder);
    let shown = pictures.shown.len();
    html! {
        section #pictures {
            h2 { "Pictures over time" }
            @for fault in &pictures.faults { p .notice { (fault) } }
            @if pictures.found == 0 { p { "The case asks for no pictures." } }
            @else if shown < pictures.found {
                p .notice { "Shown: " (shown) " of " (pictures.found) " pictures." }
            }
            div .pictures {
                @for picture in &pictures.shown {
                    figure {
                        img loading="lazy" src=(picture.address) alt=(format!("particles coloured by {}", picture.name));
                        figcaption { (picture.file) }
                    }
                }
            }
        }
    }
}
