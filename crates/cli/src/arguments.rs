//! The command line.

use std::path::PathBuf;

use clap::{Args, Parser, Subcommand, ValueHint};
use clap_complete::Shell;
use piola_device::Precision;

use crate::exit::Exit;

/// Version and commit, and what the program can use.
macro_rules! version {
    ($devices:literal, $ranks:literal) => {
        concat!(
            env!("CARGO_PKG_VERSION"),
            " (commit ",
            env!("PIOLA_COMMIT"),
            "; devices: ",
            $devices,
            "; ranks: ",
            $ranks,
            ")"
        )
    };
}

/// A static program loads no drivers of devices, and only one that is built with it knows MPI.
const VERSION: &str = match (cfg!(target_feature = "crt-static"), cfg!(feature = "mpi")) {
    (true, false) => version!("processor", "threads, without MPI"),
    (true, true) => version!("processor", "threads, and processes of MPI"),
    (false, false) => {
        version!("processor, and CUDA and OpenCL where there are drivers", "threads, without MPI")
    }
    (false, true) => version!(
        "processor, and CUDA and OpenCL where there are drivers",
        "threads, and processes of MPI"
    ),
};

/// Solid and fluid mechanics with smoothed particle hydrodynamics.
#[derive(Debug, Parser)]
#[command(name = "piola", version = VERSION, about, after_help = Exit::table())]
#[command(propagate_version = true, arg_required_else_help = true)]
pub struct Arguments {
    /// What to do.
    #[command(subcommand)]
    pub command: Command,
}

/// What to do.
#[derive(Debug, Subcommand)]
pub enum Command {
    /// Run a case and write its results
    Run(RunArguments),
    /// Read and build a case without running it, and report what a run will do
    Check(CheckArguments),
    /// Run a case with every value of one or two keys, and compare
    Sweep(SweepArguments),
    /// Run all cases below some folders and evaluate their checks
    Verify(VerifyArguments),
    /// Recreate the report of an earlier run from its results folder
    #[command(after_help = Exit::table())]
    Report {
        /// The results folder
        #[arg(value_name = "DIR", value_hint = ValueHint::DirPath)]
        folder: PathBuf,
    },
    /// Write a commented case to start from
    #[command(after_help = Exit::table())]
    New {
        /// Folder of the new case, which is created
        #[arg(value_name = "NAME")]
        name: PathBuf,
    },
    /// List the devices for `--device`, or show what a case runs on one
    #[command(after_help = Exit::table())]
    Devices {
        /// What to show instead.
        #[command(subcommand)]
        command: Option<DevicesCommand>,
    },
    /// Serve assistants that speak the Model Context Protocol over the standard input and output
    #[command(after_help = Exit::table())]
    Mcp {
        /// The folder with the cases, outside of which nothing is written
        #[arg(value_name = "DIR", default_value = ".", value_hint = ValueHint::DirPath)]
        folder: PathBuf,
    },
    /// Print the JSON schema of case files
    Schema,
    /// Print the reference of all keys of case files, as Markdown
    Reference,
    /// Write the manual pages, one for each command
    #[command(after_help = Exit::table())]
    Man {
        /// The folder to write them to, which is created
        #[arg(value_name = "DIR", value_hint = ValueHint::DirPath)]
        folder: PathBuf,
    },
    /// Print the completion script of a shell
    Completions {
        /// The shell
        shell: Shell,
    },
}

/// What to show of devices.
#[derive(Debug, Subcommand)]
pub enum DevicesCommand {
    /// Show the passes of a case on a device, stage by stage, or the text of one; no device is needed
    Show(ShowArguments),
    /// Show lower bounds of the time that the passes of a case take on some cards; no device is needed
    Bounds(BoundsArguments),
}

/// Arguments of `piola devices show`.
#[derive(Args, Debug)]
#[command(after_help = Exit::table())]
pub struct ShowArguments {
    /// The case.
    #[command(flatten)]
    pub file: CaseFile,
    /// The stage or the pass whose text is shown [default: a table of all of them]
    #[arg(value_name = "STAGE")]
    pub stage: Option<String>,
    /// The language of the text
    #[arg(long, value_name = "LANGUAGE", default_value = "cuda")]
    pub language: TextLanguage,
    /// The precision of what the device computes of pairs of particles [default: that of the case]
    #[arg(long, value_name = "PRECISION")]
    pub precision: Option<PairPrecision>,
}

/// Arguments of `piola devices bounds`.
#[derive(Args, Debug)]
#[command(after_help = Exit::table())]
pub struct BoundsArguments {
    /// The case.
    #[command(flatten)]
    pub file: CaseFile,
    /// The precision of what the device computes of pairs of particles [default: that of the case]
    #[arg(long, value_name = "PRECISION")]
    pub precision: Option<PairPrecision>,
}

/// A language of passes.
#[derive(Clone, Copy, Debug, PartialEq, Eq, clap::ValueEnum)]
pub enum TextLanguage {
    /// CUDA C++.
    Cuda,
    /// OpenCL C.
    Opencl,
    /// C99.
    C,
}

/// A precision of pairs.
#[derive(Clone, Copy, Debug, PartialEq, Eq, clap::ValueEnum)]
pub enum PairPrecision {
    /// That of the processor.
    Double,
    /// Less memory and time.
    Single,
}

impl PairPrecision {
    /// What it is for devices.
    pub fn of_pairs(self) -> Precision {
        match self {
            Self::Double => Precision::Double,
            Self::Single => Precision::Single,
        }
    }

    /// Its name in a case file.
    pub fn name(self) -> &'static str {
        match self {
            Self::Double => "double",
            Self::Single => "single",
        }
    }
}

/// A case file, with its changes.
#[derive(Args, Debug)]
pub struct CaseFile {
    /// The case file
    #[arg(value_name = "CASE", value_hint = ValueHint::FilePath)]
    pub case: PathBuf,
    /// Set a key of the case file: a path and a TOML value, for example body.column.spacing=0.1; or
    /// append to a list: 'load+={ kind = "body_force", acceleration = ["0", "-9.81"] }'
    #[arg(long = "set", value_name = "PATH=VALUE")]
    pub set: Vec<String>,
    /// Apply this variant of the case, or this member of a sweep (NAME.1, NAME.2, ...)
    #[arg(long, value_name = "NAME")]
    pub variant: Option<String>,
}

/// The case, and who computes it.
#[derive(Args, Debug)]
pub struct CaseArguments {
    /// The case.
    #[command(flatten)]
    pub file: CaseFile,
    /// Number of threads [default: one per processor]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..=1024))]
    pub threads: Option<u16>,
    /// Compute on this device, as listed by `piola devices`, for example cuda:0
    #[arg(long, value_name = "NAME")]
    pub device: Option<String>,
    /// The precision of what the device computes of pairs of particles [default: double]
    #[arg(long, value_name = "PRECISION")]
    pub precision: Option<PairPrecision>,
    /// Share the particles among this many ranks, each with a part of the threads [default: 1]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..))]
    pub ranks: Option<u32>,
}

/// Arguments of `piola run`.
#[derive(Args, Debug)]
#[command(after_help = Exit::table())]
pub struct RunArguments {
    /// The case.
    #[command(flatten)]
    pub case: CaseArguments,
    /// Results folder [default: results/ and the name of the case's folder and variant]
    #[arg(long, value_name = "DIR", value_hint = ValueHint::DirPath)]
    pub out: Option<PathBuf>,
    /// Continue from the newest sound checkpoint in the results folder
    #[arg(long)]
    pub resume: bool,
    /// Show neither progress nor summary
    #[arg(long, short)]
    pub quiet: bool,
    /// Write progress and summary to stdout for programs, one JSON object per line
    #[arg(long, conflicts_with = "quiet")]
    pub json_progress: bool,
}

/// Arguments of `piola check`.
#[derive(Args, Debug)]
#[command(after_help = Exit::table())]
pub struct CheckArguments {
    /// The case.
    #[command(flatten)]
    pub case: CaseArguments,
    /// Show the stages of a step instead, with what each reads, gathers from neighbours, writes and
    /// exposes: as a table with the bytes of it, or as a graph in DOT
    #[arg(long, value_name = "FORM", num_args = 0..=1, require_equals = true,
          default_missing_value = "table")]
    pub stages: Option<StageForm>,
}

/// How stages are shown.
#[derive(Clone, Copy, Debug, PartialEq, Eq, clap::ValueEnum)]
pub enum StageForm {
    /// One line per stage.
    Table,
    /// Text for `dot -Tsvg`.
    Dot,
}

/// Arguments of `piola sweep`.
#[derive(Args, Debug)]
#[command(after_help = Exit::table())]
pub struct SweepArguments {
    /// The case.
    #[command(flatten)]
    pub case: CaseArguments,
    /// A key and its values, for example body.column.spacing=0.2,0.1; two keys give every pair
    #[arg(long, value_name = "PATH=V1,V2,...", required_unless_present = "sweep")]
    pub over: Vec<String>,
    /// Run the members of this sweep of the case file instead
    #[arg(long, value_name = "NAME", conflicts_with_all = ["over", "variant"])]
    pub sweep: Option<String>,
    /// Number of members that run at the same time and share the threads
    #[arg(long, value_name = "N", default_value_t = 1)]
    #[arg(value_parser = clap::value_parser!(u16).range(1..=1024))]
    pub jobs: u16,
    /// Results folder [default: results/ and the name of the case's folder with -sweep]
    #[arg(long, value_name = "DIR", value_hint = ValueHint::DirPath)]
    pub out: Option<PathBuf>,
    /// Show neither progress nor table
    #[arg(long, short)]
    pub quiet: bool,
}

/// Arguments of `piola verify`.
#[derive(Args, Debug)]
#[command(after_help = Exit::table())]
pub struct VerifyArguments {
    /// Case files, or folders in which all files called case.toml are found
    #[arg(value_name = "PATH", default_value = "cases", value_hint = ValueHint::AnyPath)]
    pub paths: Vec<PathBuf>,
    /// Run all settings: coarse, the case as it stands, and the paper's
    #[arg(long)]
    pub full: bool,
    /// Run only the paper's setting
    #[arg(long, conflicts_with = "full")]
    pub paper: bool,
    /// Also run long variants and sweeps, all or only those named (`base` is the case itself); may
    /// take hours
    #[arg(long, value_name = "NAMES", num_args = 0.., require_equals = true, value_delimiter = ',')]
    pub long: Option<Vec<String>>,
    /// Write a page with all checks, and its charts and results, for example docs/validation.md;
    /// existing results of other cases are kept
    #[arg(long, value_name = "FILE", value_hint = ValueHint::FilePath)]
    pub page: Option<PathBuf>,
    /// Keep the results of each run in a folder of its own below this one, and continue runs that were
    /// interrupted there
    #[arg(long, value_name = "DIR", value_hint = ValueHint::DirPath)]
    pub keep: Option<PathBuf>,
    /// Only the case with this id, or in a folder of this name
    #[arg(long, value_name = "ID")]
    pub only: Option<String>,
    /// Number of cases that run at the same time and share the threads
    #[arg(long, value_name = "N", default_value_t = 1)]
    #[arg(value_parser = clap::value_parser!(u16).range(1..=1024))]
    pub jobs: u16,
    /// Number of threads [default: one per processor]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..=1024))]
    pub threads: Option<u16>,
}

impl VerifyArguments {
    /// Whether to run a variant, or the case itself, that takes long. A sweep stands for its members.
    pub fn is_long_wanted(&self, variant: Option<&str>) -> bool {
        let is_named = |name: &String| {
            let rest = variant.unwrap_or("base").strip_prefix(name.as_str());
            rest.is_some_and(|rest| rest.is_empty() || rest.starts_with('.'))
        };
        self.long.as_ref().is_some_and(|names| names.is_empty() || names.iter().any(is_named))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use clap::CommandFactory;

    #[test]
    fn the_command_line_is_consistent() {
        Arguments::command().debug_assert();
    }

    #[test]
    fn what_takes_long_is_chosen_by_name() {
        let wanted = |options: &[&str], variant| {
            let line = ["piola", "verify"].iter().chain(options).copied();
            let Ok(Arguments { command: Command::Verify(arguments), .. }) =
                Arguments::try_parse_from(line)
            else {
                panic!("{options:?}")
            };
            arguments.is_long_wanted(variant)
        };
        assert!(!wanted(&[], Some("fine")) && wanted(&["--long"], Some("fine")));
        assert!(wanted(&["--long", "cases"], None));
        let some = &["--long=table1,base", "cases"];
        assert!(wanted(some, Some("table1.2")) && wanted(some, None));
        assert!(!wanted(some, Some("table1-held.2")) && !wanted(some, Some("fine")));
    }
}
