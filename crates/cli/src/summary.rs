//! What `piola run` says at the end.

use std::collections::BTreeMap;
use std::fmt::Write;
use std::path::{MAIN_SEPARATOR, Path, PathBuf};

use piola::case::Finished;
use piola::observe::Series;
use piola::schemes::RankCosts;
use piola::time::Outcome;

use crate::text::{bytes, count, duration, large, significant};

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
    let stepping = summary.timings.iter().find(|timing| timing.stage == "step");
    let stepping = stepping.map_or(seconds, |timing| timing.seconds);
    let speed = if stepping > 0.0 {
        format!(
            ", {} particle evaluations per second",
            large(summary.evaluations as f64 / stepping)
        )
    } else {
        String::new()
    };
    let mut text =
        format!("{ended}\n{} particles, {}{speed}\n\n", finished.particles, duration(seconds));
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
    if !summary.ranks.is_empty() {
        line("ranks", &ranks(&summary.ranks));
    }
    if let Some(costs) = finished.linear {
        let how = match costs.direct {
            true => format!("direct, {} entries of factors", large(costs.factor_entries as f64)),
            false => "krylov".to_owned(),
        };
        let [assembly, factors, solution] = [costs.assembly, costs.factorisation, costs.solution]
            .map(|time| duration(time.as_secs_f64()));
        let steps = count(costs.steps, "iterative step");
        let text =
            format!("{how}, {steps}; matrices {assembly}, factors {factors}, solutions {solution}");
        line("equations", &text);
    }
    if !finished.own_steps.is_empty() {
        line("own steps", &own_steps(&finished.own_steps));
    }
    energies(finished, &mut line);
    momentum(finished, &mut line);
    // Of a run that fails at its first look there are no figures.
    if summary.worst.smallest_ratio.is_finite() {
        let text = format!(
            "volume ratio at least {}, J and det F differ by at most {}, speed at most {} m/s",
            significant(summary.worst.smallest_ratio, 4),
            significant(summary.worst.ratio_mismatch, 2),
            significant(summary.worst.largest_speed, 4),
        );
        line("health", &text);
    }
    if let Some((time, steps)) = summary.resumed {
        line("resumed", &format!("from t = {} s, {}", significant(time, 6), count(steps, "step")));
    }
    for retry in &summary.retries {
        let text = format!(
            "{} after step {}: went back to t = {} s and continued with steps of {} times their length",
            retry.kind,
            retry.step,
            significant(retry.back_to, 6),
            significant(retry.factor, 3),
        );
        line("retry", &text);
    }
    for note in &finished.notes {
        line("note", note);
    }
    for warning in &finished.warnings {
        line("warning", warning);
    }
    files(finished, folder, &mut text);
    text
}

/// How evenly ranks have computed, how long they have waited, and what they have told each other.
fn ranks(all: &[RankCosts]) -> String {
    let sum = |of: &dyn Fn(&RankCosts) -> f64| all.iter().map(of).sum::<f64>();
    let (mean, most) = (
        sum(&|rank| rank.computed) / all.len() as f64,
        all.iter().map(|rank| rank.computed).fold(f64::MIN_POSITIVE, f64::max),
    );
    let waited = sum(&|rank| rank.waited) / sum(&|rank| rank.computed + rank.waited);
    format!(
        "{}, the slowest computed {} times the mean; {:.1} % of the time was waiting and sending; {} messages, {} sent",
        all.len(),
        significant(most / mean, 3),
        100.0 * waited,
        large(sum(&|rank| rank.messages as f64)),
        bytes(sum(&|rank| rank.bytes as f64) as usize),
    )
}

/// How many steps of its own each system has taken.
pub fn own_steps(systems: &[(String, u64)]) -> String {
    let texts = systems.iter().map(|(name, steps)| format!("{name} {steps}"));
    texts.collect::<Vec<_>>().join(", ")
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

/// The last row of the momentum table, and what of it does not balance as a share of the largest
/// momentum or impulse of the run, in any direction.
fn momentum(finished: &Finished, line: &mut impl FnMut(&str, &str)) {
    let table = &finished.tables.momentum;
    let Some(row) = table.rows().next_back() else { return };
    let mut parts = Vec::new();
    for kind in ["linear", "angular"] {
        // A column is called KIND.AXIS, or PART.KIND.AXIS where it is part of the account.
        let of_kind = |name: &str| name.split('.').rev().nth(1) == Some(kind);
        let columns = || (0..).zip(table.columns()).filter(|(_, column)| of_kind(&column.name));
        let (mut largest, mut off, mut values, mut unit) = (0.0_f64, 0.0_f64, Vec::new(), "");
        for (index, column) in columns() {
            if column.name.starts_with("balance.") {
                off = off.max(row[index].abs());
                continue;
            }
            largest = table.column(index).fold(largest, |most, value| most.max(value.abs()));
            if column.name.starts_with(kind) {
                values.push(row[index]);
                unit = &column.unit;
            }
        }
        if largest > 0.0 {
            // What is round-off beside the largest is shown as nothing.
            let shown = |value: &f64| match value.abs() < 1e-10 * largest {
                true => "0".to_owned(),
                false => significant(*value, 4),
            };
            let values: Vec<String> = values.iter().map(shown).collect();
            let off = significant(off / largest, 2);
            parts.push(format!(
                "{kind} ({}) {unit}, off by {off} of its largest",
                values.join(", ")
            ));
        }
    }
    if !parts.is_empty() {
        line("momentum", &parts.join("; "));
    }
}

/// Where to look: the series for ParaView by its path, the rest below the folder of results, with
/// the files of each folder in it counted.
fn files(finished: &Finished, folder: &Path, text: &mut String) {
    let is_series = |path: &&PathBuf| path.extension().is_some_and(|end| end == "pvd");
    if let Some(series) = finished.files.iter().find(is_series) {
        let _ = writeln!(text, "\nopen {} in ParaView", series.display());
    }
    let is_page = |path: &&PathBuf| path.extension().is_some_and(|end| end == "html");
    if let Some(page) = finished.files.iter().find(is_page) {
        let _ = writeln!(text, "open {} in a browser", page.display());
    }
    let (mut single, mut folders) = (Vec::new(), BTreeMap::<PathBuf, u64>::new());
    for path in finished.files.iter().filter(|path| !is_series(path) && !is_page(path)) {
        let relative = path.strip_prefix(folder).unwrap_or(path);
        match relative.parent().filter(|parent| !parent.as_os_str().is_empty()) {
            Some(parent) => *folders.entry(parent.to_owned()).or_default() += 1,
            None => single.push(relative.display().to_string()),
        }
    }
    let folders = folders.iter().map(|(name, number)| {
        format!("{}{MAIN_SEPARATOR} ({})", name.display(), count(*number, "file"))
    });
    single.extend(folders);
    if !single.is_empty() {
        let _ = writeln!(text, "in {}: {}", folder.display(), single.join(", "));
    }
}
