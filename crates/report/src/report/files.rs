//! The files of a run, with their number and size.

use std::collections::BTreeMap;
use std::fs;

use super::Report;

/// Files of one folder, or one file.
pub struct Entry {
    /// Name of the file, or of the folder with `/` behind it.
    pub name: String,
    /// Number of files.
    pub count: usize,
    /// Bytes of all together.
    pub bytes: u64,
    /// Files that the record lists and that are gone.
    pub missing: usize,
    /// What is in them.
    pub meaning: &'static str,
}

/// The files that the record lists, those in a folder together.
pub fn entries(report: &Report) -> Vec<Entry> {
    let mut entries: BTreeMap<(bool, String), Entry> = BTreeMap::new();
    let files = report.record.files.iter().map(String::as_str).chain(["run.json"]);
    for file in files {
        // What would lead out of the folder is none of its files.
        let path = match file {
            "run.json" => report.folder.record(),
            _ => match report.folder.inside(file) {
                Some(path) => path,
                None => continue,
            },
        };
        let folder = file.split_once('/').map(|(folder, _)| format!("{folder}/"));
        let name = folder.clone().unwrap_or_else(|| file.to_owned());
        let meaning = meaning(&name);
        let entry = entries.entry((folder.is_some(), name.clone())).or_insert(Entry {
            name,
            count: 0,
            bytes: 0,
            missing: 0,
            meaning,
        });
        match fs::metadata(path) {
            Ok(data) => {
                entry.count += 1;
                entry.bytes += data.len();
            }
            Err(_) => entry.missing += 1,
        }
    }
    entries.into_values().collect()
}

fn meaning(name: &str) -> &'static str {
    match name {
        "particles.pvd" => "the time series: open this one in ParaView",
        "particles/" => "the particles at one instant each, all fields",
        "probes.csv" => "what the case asked to be recorded",
        "energy.csv" => "energies, and the work of every mechanism so far",
        "momentum.csv" => "momentum, and the impulse of every load and boundary so far",
        "failure.csv" => "the last steps around the particle that failed first",
        "checkpoints/" => "states from which the run can be resumed",
        "steps.csv" => "steps and the health of the run",
        "pictures/" => "particles coloured by a field",
        "profiles/" => "fields along the lines of the case, at one instant each",
        "plots/" => "curves against time or along lines",
        "references/" => "the reference curves of the case's checks",
        "run.json" => "the record of the run",
        _ => "",
    }
}
