//! `piola devices`.

use std::fmt::Write;

use piola::case::Session;
use piola::schemes::DeviceStage;
use piola_device::{CARDS, Found, Language, Operations, Pass, Use, devices as all, missing};

use super::{assemble, read_with};
use crate::arguments::{BoundsArguments, CaseFile, PairPrecision, ShowArguments, TextLanguage};
use crate::exit::{Exit, Fault};
use crate::table::align;
use crate::terminal;
use crate::text::significant;

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
    let language = match arguments.language {
        TextLanguage::Cuda => Language::Cuda,
        TextLanguage::Opencl => Language::OpenCl,
        TextLanguage::C => Language::C,
    };
    let (mut session, stages) = staged(&arguments.file, arguments.precision, language)?;
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

/// Prints lower bounds of the time that the passes of a case take on some cards.
pub fn bounds(arguments: &BoundsArguments) -> Result<Exit, Fault> {
    let (session, stages) = staged(&arguments.file, arguments.precision, Language::Cuda)?;
    let neighbors = session.neighbors().mean;
    let head = ["stage", "pass", "sums", "products", "quotients", "roots", "functions", "bytes"];
    let head = head.into_iter().chain(CARDS.iter().map(|card| card.name));
    let mut rows = vec![head.map(str::to_owned).collect::<Vec<_>>()];
    let mut all = [0.0; CARDS.len()];
    for stage in &stages {
        for (number, pass) in stage.passes.iter().enumerate() {
            let work = &pass.work;
            let name = if number == 0 { stage.name } else { "" };
            let operations = |kind: fn(&Operations) -> usize| {
                let of_pairs = work.by_neighbor.iter().min_by_key(|it| it.flops()).map_or(0, kind);
                (kind(&work.operations) as f64 + neighbors * of_pairs as f64).round()
            };
            let counts = [
                operations(|it| it.sums),
                operations(|it| it.products),
                operations(|it| it.quotients),
                operations(|it| it.roots),
                operations(|it| it.functions),
                work.least_bytes(neighbors).round(),
            ];
            // Milliseconds for a million particles.
            let times = CARDS.map(|card| 1e9 * card.bound(work, neighbors));
            all.iter_mut().zip(times).for_each(|(all, time)| *all += time);
            let names = [name, pass.name].map(str::to_owned).into_iter();
            let counts = counts.iter().map(f64::to_string);
            rows.push(names.chain(counts).chain(times.map(milliseconds)).collect());
        }
    }
    let empty = vec![String::new(); rows[0].len() - CARDS.len() - 1];
    rows.push([vec!["all".to_owned()], empty, all.map(milliseconds).to_vec()].concat());
    let mut text = format!(
        "{} neighbours per particle. Operations and bytes are those of a particle; times are lower bounds in ms for a \
         million particles, from data sheets of the cards: nothing is measured. The building of neighbour lists is not \
         among them, and passes that go over few particles are counted as over all, so that theirs, and `all` with \
         them, may be more than a bound.\n\n",
        significant(neighbors, 3)
    );
    align(&rows, None, &[]).iter().for_each(|line| text += &format!("{line}\n"));
    terminal::print(&text)?;
    Ok(Exit::Success)
}

/// A time of the table.
fn milliseconds(time: f64) -> String {
    format!("{time:.3}")
}

/// A case as it would run on a device, with the passes of its stages.
fn staged(
    file: &CaseFile,
    precision: Option<PairPrecision>,
    language: Language,
) -> Result<(Session, Vec<DeviceStage>), Fault> {
    let mut case = read_with(file, file.set.clone())?;
    // Nothing is computed.
    (case.device, case.ranks) = (None, None);
    if let Some(precision) = precision {
        case.precision = precision.of_pairs();
    }
    let session = assemble(&file.case, &case)?;
    let stages = session.device_stages(language);
    let stages = stages.map_err(|refusal| Fault::new(Exit::BadCase, refusal))?;
    Ok((session, stages))
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
    let by_neighbor = work.by_neighbor.iter().map(|operations| operations.all().to_string());
    let by_neighbor: Vec<String> = by_neighbor.collect();
    let [bytes, of_neighbor] = work.bytes();
    let of_neighbor = if of_neighbor == 0 { String::new() } else { of_neighbor.to_string() };
    let gathers = work.of_pairs.iter().chain(&work.gathers);
    let columns = [names(&work.reads), names(gathers), names(&work.writes)];
    let numbers =
        [work.operations.all().to_string(), by_neighbor.join(", "), bytes.to_string(), of_neighbor];
    numbers.into_iter().chain(columns).collect()
}

/// Names of columns, each once.
fn names<'a>(columns: impl IntoIterator<Item = &'a Use>) -> String {
    let mut names: Vec<&str> = Vec::new();
    for column in columns {
        if !names.contains(&column.column) {
            names.push(column.column);
        }
    }
    names.join(" ")
}
