//! The program `piola`: command line, progress, reports and exit codes. It holds no physics.
//!
//! It is a library so that the command of the Python package is the same program.

use std::ffi::OsString;

use clap::Parser;

use arguments::{Arguments, Command, DevicesCommand};
use exit::{Exit, Fault};

pub use commands::check::{plan_rows, plan_text};
pub use progress::Pace;
pub use text::count;

mod arguments;
mod commands;
mod events;
mod exit;
mod interrupt;
mod mcp;
mod progress;
mod ranks;
mod summary;
mod table;
mod terminal;
mod text;

/// Runs the program with its name and its arguments, and returns its exit code.
pub fn main(arguments: impl IntoIterator<Item = OsString>) -> u8 {
    let command = match Arguments::try_parse_from(arguments) {
        Ok(arguments) => arguments.command,
        Err(error) => {
            // Nobody can be told that a terminal is closed.
            let _ = error.print();
            return u8::try_from(error.exit_code()).unwrap_or(Exit::BadCase.code());
        }
    };
    let exit = dispatch(command).unwrap_or_else(|fault| {
        terminal::report(&terminal::coloured(&fault.report));
        fault.exit
    });
    exit.code()
}

fn dispatch(command: Command) -> Result<Exit, Fault> {
    match command {
        Command::Run(arguments) => commands::run::run(&arguments),
        Command::Check(arguments) => commands::check::check(&arguments),
        Command::Sweep(arguments) => commands::sweep::sweep(&arguments),
        Command::Verify(arguments) => commands::verify::verify(&arguments),
        Command::Report { folder } => commands::report::report(&folder),
        Command::New { name } => commands::new::new(&name),
        Command::Devices { command: None } => commands::devices::devices(),
        Command::Devices { command: Some(DevicesCommand::Show(arguments)) } => {
            commands::devices::show(&arguments)
        }
        Command::Devices { command: Some(DevicesCommand::Bounds(arguments)) } => {
            commands::devices::bounds(&arguments)
        }
        Command::Mcp { folder } => mcp::serve(&folder),
        Command::Schema => commands::generate::schema(),
        Command::Reference => commands::generate::reference(),
        Command::Man { folder } => commands::generate::man(&folder),
        Command::Completions { shell } => commands::generate::completions(shell),
    }
}
