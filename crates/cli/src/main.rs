//! The program `piola`: command line, progress, reports and exit codes. It holds no physics.

use std::process::ExitCode;

use clap::Parser;

use arguments::{Arguments, Command};
use exit::{Exit, Fault};

mod arguments;
mod commands;
mod events;
mod exit;
mod interrupt;
mod progress;
mod summary;
mod table;
mod terminal;
mod text;

fn main() -> ExitCode {
    match dispatch(Arguments::parse().command) {
        Ok(exit) => exit.into(),
        Err(fault) => {
            terminal::report(&terminal::coloured(&fault.report));
            fault.exit.into()
        }
    }
}

fn dispatch(command: Command) -> Result<Exit, Fault> {
    match command {
        Command::Run(arguments) => commands::run::run(&arguments),
        Command::Check(arguments) => commands::check::check(&arguments),
        Command::Sweep(arguments) => commands::sweep::sweep(&arguments),
        Command::Verify(arguments) => commands::verify::verify(&arguments),
        Command::Report { folder } => commands::report::report(&folder),
        Command::New { name } => commands::new::new(&name),
        Command::Devices => commands::devices::devices(),
        Command::Schema => commands::generate::schema(),
        Command::Reference => commands::generate::reference(),
        Command::Completions { shell } => commands::generate::completions(shell),
    }
}
