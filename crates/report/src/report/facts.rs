//! The parts of the page that are lists and tables of numbers.

use maud::{Markup, html};

use super::{Report, files};
use crate::drawing::ticks::number;
use crate::{FigureRecord, RankRecord, RunRecord, StageRecord};

/// Longest case that is shown, in bytes.
const MAX_CASE: usize = 200_000;
/// Most lines of any list.
pub const MAX_LINES: usize = 500;

/// What ran, in the first lines of the page.
pub fn summary(report: &Report) -> Markup {
    let record = report.record;
    let particles: usize =
        record.bodies.iter().fold(0, |sum: usize, body| sum.saturating_add(body.particles));
    let seconds: f64 = record.stages.iter().map(|stage| stage.seconds).sum();
    html! {
        dl .facts {
            (fact("Dimension", &format!("{}D", record.dimension)))
            (fact("Particles", &particles.to_string()))
            (fact("Time reached", &format!("{} of {} s", number(record.time_reached), number(record.end_time))))
            (fact("Steps", &record.steps.to_string()))
            (fact("Wall time", &duration(seconds)))
            (fact("Threads", &record.threads.to_string()))
            @if !record.ranks.is_empty() {
                (fact("Ranks", &record.ranks.len().to_string()))
            }
            @if let Some(device) = &record.device {
                (fact("Device", device))
            }
            (fact("Started", &minute(&record.started)))
            (fact("Program", &format!("{} {}", record.program, record.version)))
            @for figure in record.figures.iter().filter(|figure| is_health(figure)) {
                (fact(label(&figure.name), &with_unit(figure.value, &figure.unit)))
            }
        }
    }
}

/// A time of the record to the minute: `2026-11-21 02:42 UTC`.
fn minute(timestamp: &str) -> String {
    match (timestamp.get(..10), timestamp.get(11..16)) {
        (Some(day), Some(time)) if timestamp.ends_with('Z') => format!("{day} {time} UTC"),
        _ => timestamp.to_owned(),
    }
}

fn fact(name: &str, value: &str) -> Markup {
    html! { div { dt { (name) } dd { (value) } } }
}

/// The figures that say how well the run went.
fn is_health(figure: &FigureRecord) -> bool {
    !label(&figure.name).is_empty()
}

fn label(figure: &str) -> &'static str {
    match figure {
        "smallest_step" => "Smallest step",
        "largest_step" => "Largest step",
        "smallest_ratio" => "Smallest volume ratio",
        "largest_speed" => "Largest speed",
        "ratio_mismatch" => "J against det F",
        _ => "",
    }
}

/// `value` with its unit.
fn with_unit(value: f64, unit: &str) -> String {
    // A figure of a run without steps is infinite or not a number.
    match (value.is_finite(), unit) {
        (false, _) => "none".into(),
        (true, "" | "1") => short(value),
        (true, unit) => format!("{} {unit}", short(value)),
    }
}

/// Four digits are enough to read.
fn short(value: f64) -> String {
    number(format!("{value:.3e}").parse().unwrap_or(value))
}

/// Wall time for people.
fn duration(seconds: f64) -> String {
    match seconds {
        s if !s.is_finite() => "unknown".into(),
        s if s < 60.0 => format!("{} s", number(format!("{s:.1e}").parse().unwrap_or(s))),
        s if s < 3600.0 => format!("{:.0} min {:02.0} s", (s / 60.0).floor(), (s % 60.0).floor()),
        s => format!("{:.0} h {:02.0} min", (s / 3600.0).floor(), (s % 3600.0 / 60.0).floor()),
    }
}

/// Bytes for people.
fn bytes(count: u64) -> String {
    let size = count as f64;
    match size {
        s if s >= 1e9 => format!("{:.1} GB", s / 1e9),
        s if s >= 1e6 => format!("{:.1} MB", s / 1e6),
        s if s >= 1e3 => format!("{:.1} kB", s / 1e3),
        _ => format!("{count} B"),
    }
}

/// First and last row of the energy table.
pub fn energy(report: &Report) -> Markup {
    let table = &report.energy;
    let mut rows = table.rows();
    let (Some(first), Some(last)) = (rows.next(), table.rows().next_back()) else {
        return html! {};
    };
    html! {
        section #energy {
            h2 { "Energy" }
            p .remark {
                "Energies, then the work of each mechanism since the start (negative: taken away), "
                "and the balance: what the work does not account for."
            }
            div .wide { table .numbers {
                thead { tr { th { "" } th { "Start" } th { "End" } th { "Change" } } }
                tbody { @for (column, (first, last)) in table.columns().iter().zip(first.iter().zip(last)).skip(1) {
                    @if *first != 0.0 || *last != 0.0 || column.name == "balance" {
                        tr {
                            th { (column.name.replace('_', " ")) }
                            td { (with_unit(*first, &column.unit)) }
                            td { (with_unit(*last, &column.unit)) }
                            td { (with_unit(last - first, &column.unit)) }
                        }
                    }
                } }
            } }
        }
    }
}

/// Where the wall time went.
pub fn timings(record: &RunRecord) -> Markup {
    html! {
        section #timings {
            h2 { "Wall time" }
            @if record.stages.is_empty() {
                p { "The record has no timings: the run is still going on, or it was killed before it ended." }
            } @else {
                (stages("Stage", &record.stages))
                @if !record.passes.is_empty() {
                    (stages("Pass of a step", &record.passes))
                }
                @if !record.ranks.is_empty() {
                    (ranks(&record.ranks))
                }
            }
            @if let Some(linear) = &record.linear {
                p {
                    (format!(
                        "Linear equations: {}, {} entries of factors, {} iterative steps; matrices {}, \
                         factors {}, solutions {}.",
                        linear.method,
                        linear.factor_entries,
                        linear.steps,
                        duration(linear.assembly),
                        duration(linear.factorisation),
                        duration(linear.solution)
                    ))
                }
            }
        }
    }
}

/// A table of times with their shares of all of them together.
fn stages(title: &str, stages: &[StageRecord]) -> Markup {
    let total: f64 = stages.iter().map(|stage| stage.seconds).sum();
    let is_counted = stages.iter().any(|stage| stage.bytes.is_some());
    html! {
        div .wide { table .numbers {
            thead { tr {
                th { (title) } th { "Time" } th { "Share" } th {} th { "Calls" } th { "Each" }
                @if is_counted { th { "GB/s, at least" } }
            } }
            tbody { @for stage in stages.iter().take(MAX_LINES) {
                @let share = if total > 0.0 { stage.seconds / total } else { 0.0 };
                tr {
                    th { (stage.name) }
                    td { (duration(stage.seconds)) }
                    td { (format!("{:.1} %", 100.0 * share)) }
                    td { svg .share viewBox="0 0 100 8" preserveAspectRatio="none" aria-hidden="true" {
                        rect width=(format!("{:.2}", 100.0 * share)) height="8" {}
                    } }
                    td { (stage.calls) }
                    td { (each(stage.seconds, stage.calls)) }
                    @if is_counted { td { (rate(stage)) } }
                }
            } }
        } }
    }
}

/// Billions of bytes a second that memory has carried, if they are counted.
fn rate(stage: &StageRecord) -> String {
    let bytes = stage.bytes.unwrap_or(f64::NAN) * stage.calls as f64;
    let rate = 1e-9 * bytes / stage.seconds;
    if rate.is_finite() { format!("{rate:.1}") } else { String::new() }
}

/// How evenly ranks have computed, and what they have told each other.
fn ranks(ranks: &[RankRecord]) -> Markup {
    let sum = |of: fn(&RankRecord) -> f64| ranks.iter().map(of).sum::<f64>();
    let mean = sum(|rank| rank.computed) / ranks.len() as f64;
    let most = ranks.iter().map(|rank| rank.computed).fold(0.0, f64::max);
    let share = |part: f64, whole: f64| if whole > 0.0 { part / whole } else { 0.0 };
    let percent = |share: f64| format!("{:.1} %", 100.0 * share);
    let waited = share(sum(|rank| rank.waited), sum(|rank| rank.computed + rank.waited));
    html! {
        div .wide { table .numbers #ranks {
            thead { tr {
                th { "Rank" } th { "Particles" } th { "Computing" } th { "Over the mean" }
                th { "Waiting and sending" } th { "Share" } th { "Messages sent" } th { "Sent" }
            } }
            tbody { @for (number, rank) in ranks.iter().enumerate().take(MAX_LINES) { tr {
                th { (number) }
                td { (rank.particles) }
                td { (duration(rank.computed)) }
                td { (format!("{:.3}", share(rank.computed, mean))) }
                td { (duration(rank.waited)) }
                td { (percent(share(rank.waited, rank.computed + rank.waited))) }
                td { (rank.messages) }
                td { (bytes(rank.bytes)) }
            } } }
        } }
        @if ranks.len() > MAX_LINES { p .notice { "The other ranks are in run.json." } }
        p {
            (format!(
                "{} ranks, in the steps since the run started or was resumed: the slowest computed {:.3} times as long \
                 as the mean, and {} of the time of all was waiting and sending.",
                ranks.len(),
                share(most, mean),
                percent(waited)
            ))
        }
    }
}

fn each(seconds: f64, calls: u64) -> String {
    if calls == 0 {
        return String::new();
    }
    let one = seconds / calls as f64;
    match one {
        s if s >= 1.0 => format!("{} s", short(s)),
        s if s >= 1e-3 => format!("{} ms", short(1e3 * s)),
        s => format!("{} µs", short(1e6 * s)),
    }
}

/// The case as run.
pub fn case(record: &RunRecord) -> Markup {
    let mut end = record.case_text.len().min(MAX_CASE);
    while !record.case_text.is_char_boundary(end) {
        end -= 1;
    }
    html! {
        section #case {
            h2 { "Case" }
            dl .facts {
                (fact("File", &record.case_file))
                (fact("Variant", record.variant.as_deref().unwrap_or("none")))
                (fact("Seeds", &record.seeds.iter().map(u64::to_string).collect::<Vec<_>>().join(", ")))
            }
            @if !record.overrides.is_empty() {
                p { "Overrides, in their order:" }
                ul { @for text in record.overrides.iter().take(MAX_LINES) { li { code { (text) } } } }
            }
            div .wide { table .numbers {
                thead { tr { th { "Body" } th { "Particles" } th { "Spacing" } } }
                tbody { @for body in record.bodies.iter().take(MAX_LINES) { tr {
                    th { (body.name) }
                    td { (body.particles) }
                    td { (spacing(&body.spacing)) }
                } } }
            } }
            details {
                summary { "The case file as it was run, with all overrides" }
                pre { (record.case_text[..end]) }
                @if end < record.case_text.len() { p .notice { "The rest is in run.json." } }
            }
        }
    }
}

fn spacing(spacing: &[f64]) -> String {
    let mut each: Vec<String> = spacing.iter().map(|value| short(*value)).collect();
    each.dedup();
    match each.len() {
        0 => "unknown".into(),
        _ => format!("{} m", each.join(" × ")),
    }
}

/// The files of the run.
pub fn files(report: &Report) -> Markup {
    html! {
        section #files {
            h2 { "Files" }
            div .wide { table .files {
                thead { tr { th { "In the results folder" } th { "Files" } th { "Size" } th { "What is in it" } } }
                tbody { @for entry in files::entries(report).iter().take(MAX_LINES) { tr {
                    td { code { (entry.name) } }
                    td { (entry.count) @if entry.missing > 0 { " (" (entry.missing) " missing)" } }
                    td { (bytes(entry.bytes)) }
                    td { (entry.meaning) }
                } } }
            } }
        }
    }
}
