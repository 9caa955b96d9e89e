//! Commands that print what is generated: schema, reference of keys, shell completions.

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

/// Prints the completions of `shell`.
pub fn completions(shell: Shell) -> Result<Exit, Fault> {
    let mut text = Vec::new();
    clap_complete::generate(shell, &mut Arguments::command(), "piola", &mut text);
    terminal::print(&String::from_utf8_lossy(&text))?;
    Ok(Exit::Success)
}
