//! `piola devices`.

use std::fmt::Write;

use piola::schemes::DeviceStage;
use piola_device::{Found, Language, Pass, Use, devices as all, missing};

use super::{assemble, read_with};
use crate::arguments::{ShowArguments, TextLanguage};
use crate::exit::{Exit, Fault};
use crate::table::align;
use crate::terminal;

/// Lists the devices of the machine, and why there are none of a kind.
pub fn devices() -> Result<Exit, Fault> {
    let head = ["name", "device", "memory", "precision"].map(str::to_owned).to_vec();
    let row = |found: Found| {
        let memory = format!("{:.1} GiB", found.memory as f64 / f64::from(1 << 30));
        // Runs on devices are in double precision.
        let precision = if found.has_double { "double" } else { "single only: not supported" };
        vec![found.name, found.description, memory, precision.to_owned()]
    };
    let found = all();
    let mut text = String::new();
    if !found.is_empty() {
        let rows: Vec<Vec<String>> = [head].into_iter().chain(found.into_iter().map(row)).collect();
        align(&rows, None, &[]).iter().for_each(|line| text += &format!("{line}\n"));
    }
    for reason in missing() {
        let _ = writeln!(text, "{reason}");
    }
    terminal::print(&text)?;
    Ok(Exit::Success)
}

/// Prints the passes of a case on a device, or the text of those of a stage.
pub fn show(arguments: &ShowArguments) -> Result<Exit, Fault> {
    let mut case = read_with(&arguments.file, arguments.file.set.clone())?;
    // Nothing is computed.
    (case.device, case.ranks) = (None, None);
    if let Some(precision) = arguments.precision {
        case.precision = precision.of_pairs();
    }
    let mut session = assemble(&arguments.file.case, &case)?;
    let language = match arguments.language {
        TextLanguage::Cuda => Language::Cuda,
        TextLanguage::Opencl => Language::OpenCl,
        TextLanguage::C => Language::C,
    };
    let stages = session.device_stages(language);
    let stages = stages.map_err(|refusal| Fault::new(Exit::BadCase, refusal))?;
    let text = match &arguments.stage {
        None => table(&stages),
        Some(name) => text_of(&stages, name).ok_or_else(|| {
            let phases = session.scheme().phases();
            let mut known = phases.iter().flat_map(|phase| &phase.stages);
            let is_stage = known.any(|(stage, _)| stage.name == name);
            unknown(&stages, name, is_stage)
        })?,
    };
    terminal::print(&text)?;
    Ok(Exit::Success)
}

/// The text of a stage, or of a single pass.
fn text_of(stages: &[DeviceStage], name: &str) -> Option<String> {
    let stage = stages.iter().find(|stage| stage.name == name);
    let pass = || stages.iter().flat_map(|stage| &stage.passes).find(|pass| pass.name == name);
    match stage {
        Some(stage) => Some(stage.passes.iter().map(|pass| pass.text.as_str()).collect()),
        None => pass().map(|pass| pass.text.clone()),
    }
}

/// What is said of a name that has no text.
fn unknown(stages: &[DeviceStage], name: &str, is_stage: bool) -> Fault {
    let what = match is_stage {
        true => format!("the stage `{name}` has no pass of its own on a device"),
        false => format!("this case has neither a stage nor a pass `{name}` on a device"),
    };
    let names: Vec<&str> = stages.iter().map(|stage| stage.name).collect();
    let message = format!("{what}; choose one of the stages {}", names.join(", "));
    Fault::new(Exit::BadCase, message)
}

/// All passes with what they compute and move.
fn table(stages: &[DeviceStage]) -> String {
    let head = [
        "stage",
        "pass",
        "operations",
        "per neighbour",
        "bytes",
        "per neighbour",
        "reads",
        "gathers",
        "writes",
    ];
    let mut rows = vec![head.map(str::to_owned).to_vec()];
    for stage in stages {
        for (number, pass) in stage.passes.iter().enumerate() {
            let stage = if number == 0 { stage.name } else { "" };
            rows.push(
                [stage, pass.name].map(str::to_owned).into_iter().chain(cells(pass)).collect(),
            );
        }
    }
    align(&rows, terminal::stdout_width(), &[6, 7, 8]).join("\n") + "\n"
}

/// Operations and bytes, per particle and per neighbour, and columns.
fn cells(pass: &Pass) -> Vec<String> {
    let work = &pass.work;
    let by_neighbor: Vec<String> = work.by_neighbor.iter().map(usize::to_string).collect();
    let [bytes, of_neighbor] = work.bytes();
    let of_neighbor = if of_neighbor == 0 { String::new() } else { of_neighbor.to_string() };
    let columns = [&work.reads, &work.gathers, &work.writes].map(|columns| names(columns));
    let numbers =
        [work.operations.to_string(), by_neighbor.join(", "), bytes.to_string(), of_neighbor];
    numbers.into_iter().chain(columns).collect()
}

/// Names of columns, each once.
fn names(columns: &[Use]) -> String {
    let mut names: Vec<&str> = Vec::new();
    for column in columns {
        if !names.contains(&column.column) {
            names.push(column.column);
        }
    }
    names.join(" ")
}
