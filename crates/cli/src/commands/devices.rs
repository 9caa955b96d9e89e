//! `piola devices`.

use std::fmt::Write;

use piola_device::{Found, devices as all, missing};

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
