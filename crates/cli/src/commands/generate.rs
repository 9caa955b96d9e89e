//! Commands for what is generated: schema, reference of keys, shell completions, manual pages.

use std::path::Path;
use std::{fs, io};

use clap::{Command, CommandFactory};
use clap_complete::Shell;
use clap_mangen::Man;
use clap_mangen::roff::{Roff, bold, roman};
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
    let mut program = Arguments::command().version(env!("CARGO_PKG_VERSION"));
    program = program.disable_help_subcommand(true);
    program.build();
    fs::create_dir_all(folder).map_err(|error| fault(&error))?;
    pages(&program, folder).map_err(|error| fault(&error))?;
    Ok(Exit::Success)
}

/// Writes the page of a command, and those of all below it.
fn pages(command: &Command, folder: &Path) -> io::Result<()> {
    // Exit codes have a section of their own, where manual pages have it: before the version.
    let page = Man::new(command.clone().after_help(None::<&str>));
    let mut text = Vec::new();
    page.render(&mut text)?;
    let text = String::from_utf8_lossy(&text);
    let text = text.replacen(".SH VERSION", &(exit_status() + ".SH VERSION"), 1);
    fs::write(folder.join(page.get_filename()), text)?;
    command.get_subcommands().try_for_each(|below| pages(below, folder))
}

/// The section of a manual page on exit codes.
fn exit_status() -> String {
    let mut section = Roff::new();
    section.control("SH", ["EXIT STATUS"]);
    for (code, meaning) in Exit::ALL.map(Exit::describe) {
        section.control("TP", []).text([bold(code.to_string())]).text([roman(meaning)]);
    }
    section.to_roff()
}

/// Prints the completions of `shell`.
pub fn completions(shell: Shell) -> Result<Exit, Fault> {
    let mut text = Vec::new();
    clap_complete::generate(shell, &mut Arguments::command(), "piola", &mut text);
    terminal::print(&String::from_utf8_lossy(&text))?;
    Ok(Exit::Success)
}
