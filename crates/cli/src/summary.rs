//! What `piola run` says at the end.

use std::fmt::Write;
use std::path::{Path, PathBuf};

use piola::case::Finished;
use piola::observe::Series;
use piola::time::Outcome;

use crate::text::{count, duration, large, significant};

/// Outcome, time steps, wall time, energies, health and files of a run of `seconds` of wall time.
pub fn summary(finished: &Finished, end: f64, folder: &Path, seconds: f64) -> String {
    let summary = &finished.summary;
    let steps = count(summary.steps, "step");
    let time = significant(summary.time, 6);
    let ended = match &summary.outcome {
        Outcome::Completed => format!("completed: t = {time} s after {steps}"),
        outcome => format!(
            "{}: t = {time} of {} s ({:.1} %) after {steps}",
            outcome.summary(),
            significant(end, 6),
            100.0 * summary.time / end,
        ),
    };
    let speed = large(summary.evaluations as f64 / seconds);
    let mut text = format!(
        "{ended}\n{} particles, {}, {speed} particle evaluations a second\n\n",
        finished.particles,
        duration(seconds)
    );
    let mut line = |name: &str, content: &str| {
        // Writing to a string does not fail.
        let _ = writeln!(text, "{name:<12}{content}");
    };
    if summary.steps > 0 {
        let [smallest, largest] = summary.step_range.map(|step| significant(step, 3));
        line("time step", &format!("{smallest} to {largest} s"));
    }
    let stages: Vec<String> = summary
        .timings
        .iter()
        .map(|timing| format!("{} {}", timing.stage, duration(timing.seconds)))
        .collect();
    line("wall time", &stages.join(", "));
    energies(finished, &mut line);
    line(
        "health",
        &format!(
            "volume ratio at least {}, J and det F differ by at most {}, speed at most {} m/s",
            significant(summary.smallest_ratio, 4),
            significant(summary.ratio_mismatch, 2),
            significant(summary.largest_speed, 4),
        ),
    );
    for warning in &finished.warnings {
        line("warning", warning);
    }
    files(finished, folder, &mut text);
    text
}

/// The last row of the energy table: energies, work, and what of it does not balance.
fn energies(finished: &Finished, line: &mut impl FnMut(&str, &str)) {
    let table = &finished.tables.energy;
    let Some(row) = table.rows().next_back() else { return };
    let value = |name: &str| table.index(name).map(|column| row[column]);
    let names = table.columns().iter().skip(1).map(|column| column.name.as_str());
    // Up to the total stand energies, after it the work of each mechanism.
    let (mut stored, mut work, mut after_total) = (Vec::new(), Vec::new(), false);
    for name in names.filter(|name| *name != "balance") {
        if let Some(value) = value(name).filter(|value| *value != 0.0) {
            let text = format!("{} {} J", name.replace('_', " "), significant(value, 5));
            if after_total { work.push(text) } else { stored.push(text) }
        }
        after_total |= name == "total";
    }
    for (label, parts) in [("energy", stored), ("work", work)] {
        if !parts.is_empty() {
            line(label, &parts.join(", "));
        }
    }
    if let Some(balance) = value("balance") {
        let largest = match finished.quantity("energy.total") {
            Some(Series::Curve { values, .. }) => {
                values.iter().fold(0.0_f64, |largest, value| largest.max(value.abs()))
            }
            _ => 0.0,
        };
        let share = if largest > 0.0 {
            format!(", {} of the largest total", significant(balance.abs() / largest, 2))
        } else {
            String::new()
        };
        line("balance", &format!("{} J{share}", significant(balance, 3)));
    }
}

/// Where to look.
fn files(finished: &Finished, folder: &Path, text: &mut String) {
    let is_series = |path: &&PathBuf| path.extension().is_some_and(|end| end == "pvd");
    if let Some(series) = finished.files.iter().find(is_series) {
        let _ = writeln!(text, "\nopen {} in ParaView", series.display());
    }
    let others: Vec<String> = finished
        .files
        .iter()
        .filter(|path| {
            path.extension().is_none_or(|extension| extension != "vtp" && extension != "pvd")
        })
        .map(|path| path.strip_prefix(folder).unwrap_or(path).display().to_string())
        .collect();
    if !others.is_empty() {
        let _ = writeln!(text, "also in {}: {}", folder.display(), others.join(", "));
    }
}
