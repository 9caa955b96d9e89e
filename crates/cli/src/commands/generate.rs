//! Commands for what is generated: schema, reference of keys, shell completions, manual pages.

use std::fs;
use std::path::Path;

use clap::CommandFactory;
use clap_complete::Shell;
use piola::case;

use crate::arguments::Arguments;
use crate::exit::{Exit, Fault};
use crate::terminal;

/// Prints the JSON schema of case files.
pub fn schema() -> Result<Exit, Fault> {
    terminal::print(&format!("{:#}\n", case::schema::json_schema()))?;
    Ok(Exit::Success)
}

/// Prints the reference of all keys as Markdown.
pub fn reference() -> Result<Exit, Fault> {
    terminal::print(&case::reference::markdown())?;
    Ok(Exit::Success)
}

/// Writes `piola.1`, and `piola-COMMAND.1` for each command, into `folder`.
pub fn man(folder: &Path) -> Result<Exit, Fault> {
    let fault = |error: &dyn std::fmt::Display| {
        let folder = folder.display();
        Fault::new(Exit::Io, format_args!("cannot write manual pages to {folder}: {error}"))
    };
    fs::create_dir_all(folder).map_err(|error| fault(&error))?;
    clap_mangen::generate_to(Arguments::command(), folder).map_err(|error| fault(&error))?;
    Ok(Exit::Success)
}

/// Prints the completions of `shell`.
pub fn completions(shell: Shell) -> Result<Exit, Fault> {
    let mut text = Vec::new();
    clap_complete::generate(shell, &mut Arguments::command(), "piola", &mut text);
    terminal::print(&String::from_utf8_lossy(&text))?;
    Ok(Exit::Success)
}
