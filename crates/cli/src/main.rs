//! The program `piola`.

use std::process::ExitCode;

fn main() -> ExitCode {
    piola_cli::main(std::env::args_os()).into()
}
