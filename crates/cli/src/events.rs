//! What `--json-progress` writes to stdout: one JSON object a line, told apart by `event`.

use std::path::Path;

use piola::case::Finished;
use piola::output::Table;
use piola::time::{Outcome, Progress};
use serde_json::{Map, Value, json};

use crate::exit::Fault;
use crate::progress::Estimate;
use crate::terminal;

/// A closed pipe is no reason to stop a run.
fn emit(event: &Value) {
    let _ = terminal::print(&format!("{event}\n"));
}

/// `start`: what runs and where its results go.
pub fn start(case: &Path, folder: &Path, end: f64) {
    emit(&json!({
        "event": "start",
        "version": env!("CARGO_PKG_VERSION"),
        "case": case.display().to_string(),
        "folder": folder.display().to_string(),
        "end": end,
    }));
}

/// `progress`: where the run stands. What is not known yet is `null`.
pub fn progress(progress: &Progress, estimate: &Estimate) {
    emit(&json!({
        "event": "progress",
        "time": progress.time,
        "end": progress.end,
        "share": estimate.share,
        "step": progress.step,
        "step_size": progress.step_size,
        "limiter": progress.limiter,
        "evaluations_per_second": estimate.evaluations_per_second,
        "seconds_left": estimate.seconds_left,
        "retries": progress.retries,
    }));
}

/// `end`: how the run ended, with what the summary says.
pub fn end(finished: &Finished, folder: &Path, seconds: f64) {
    let summary = &finished.summary;
    let message = match &summary.outcome {
        Outcome::Failed(failure) => Some(failure.to_string()),
        _ => None,
    };
    let stages =
        summary.timings.iter().map(|timing| (timing.stage.to_owned(), json!(timing.seconds)));
    let retries = summary.retries.iter().map(|retry| {
        json!({
            "failure": retry.failure,
            "step": retry.step,
            "back_to": retry.back_to,
            "factor": retry.factor,
        })
    });
    let files = finished.files.iter().map(|file| file.strip_prefix(folder).unwrap_or(file));
    emit(&json!({
        "event": "end",
        "outcome": summary.outcome.summary(),
        "message": message,
        "time": summary.time,
        "steps": summary.steps,
        "particles": finished.particles,
        "evaluations": summary.evaluations,
        "seconds": seconds,
        "stages": stages.collect::<Map<_, _>>(),
        "step_range": summary.step_range,
        "resumed_at": summary.resumed.map(|(time, _)| time),
        "retries": retries.collect::<Vec<_>>(),
        "energy": last_row(&finished.tables.energy),
        "momentum": last_row(&finished.tables.momentum),
        "smallest_ratio": summary.worst.smallest_ratio,
        "ratio_mismatch": summary.worst.ratio_mismatch,
        "largest_speed": summary.worst.largest_speed,
        "notes": finished.notes,
        "warnings": finished.warnings,
        "files": files.map(|file| file.display().to_string()).collect::<Vec<_>>(),
    }));
}

/// `error`: why nothing, or nothing more, was run.
pub fn error(fault: &Fault) {
    emit(&json!({
        "event": "error",
        "exit_code": fault.exit.code(),
        "message": fault.report,
    }));
}

fn last_row(table: &Table) -> Map<String, Value> {
    let row = table.rows().next_back().unwrap_or_default();
    let named = table.columns().iter().zip(row);
    named.map(|(column, value)| (column.name.clone(), json!(value))).collect()
}
