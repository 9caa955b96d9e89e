//! The record of a run: all that is needed to say what was run, how it went, and to run it again.

use std::fs::File;
use std::io::{self, Read};
use std::path::{Path, PathBuf};
use std::time::{Duration, SystemTime, UNIX_EPOCH};

use serde::{Deserialize, Deserializer, Serialize};

use super::{OutputError, atomic};

/// What was run and how it went, written as `run.json`.
///
/// Keys that a file lacks take their defaults, and unknown ones are passed over, so that records
/// of other versions can be read.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(default)]
pub struct RunRecord {
    /// `piola`, by which its records are known.
    pub program: String,
    /// Version of the program.
    pub version: String,
    /// Path of the case file as it was given.
    pub case_file: String,
    /// The row of the reproduction list, if the case names one.
    pub id: Option<String>,
    /// Title of the case.
    pub title: String,
    /// Name of the variant that was run; none for the case itself.
    pub variant: Option<String>,
    /// Text of the case as it was run, with all overrides applied.
    pub case_text: String,
    /// Overrides in the order in which they were applied, as `path.to.key=value`.
    pub overrides: Vec<String>,
    /// All seeds of random numbers, in the order of the case file.
    pub seeds: Vec<u64>,
    /// Number of threads.
    pub threads: usize,
    /// The device that took the steps, by both of its names; none for the processor.
    pub device: Option<String>,
    /// 1, 2 or 3.
    pub dimension: usize,
    /// The bodies, in the order of their numbers.
    pub bodies: Vec<BodyRecord>,
    /// When the run started ([`timestamp`]).
    pub started: String,
    /// When it ended; none while it runs.
    pub finished: Option<String>,
    /// `running`, `completed`, `interrupted`, or `failed: ` and the cause in a word.
    pub outcome: String,
    /// The whole message of a failure, for a reader.
    pub message: Option<String>,
    /// Simulated times in s of the checkpoints from which the run was continued after an interruption.
    pub resumed_at: Vec<f64>,
    /// Failures after which the run went back and on with smaller steps.
    pub retries: Vec<RetryRecord>,
    /// Steps taken.
    pub steps: u64,
    /// Simulated time that was to be reached, in s.
    #[serde(deserialize_with = "number_or_nan")]
    pub end_time: f64,
    /// Simulated time that was reached, in s.
    #[serde(deserialize_with = "number_or_nan")]
    pub time_reached: f64,
    /// Where the time went.
    pub stages: Vec<StageRecord>,
    /// Where the time of steps went, pass by pass, if the scheme knows it.
    #[serde(default)]
    pub passes: Vec<StageRecord>,
    /// What has taken the time of each rank, by number, where there are several.
    #[serde(default)]
    pub ranks: Vec<RankRecord>,
    /// What linear equations took; none where there were none.
    pub linear: Option<LinearRecord>,
    /// Steps of its own that each system has taken, where there are several.
    #[serde(default)]
    pub own_steps: Vec<SystemRecord>,
    /// Figures of the run as a whole, by the names that checks use after `run.`.
    pub figures: Vec<FigureRecord>,
    /// The reference curves of the case's checks.
    pub references: Vec<ReferenceRecord>,
    /// Files written, relative to the folder of the record, with `/` between their parts.
    pub files: Vec<String>,
    /// What the program has chosen for the user.
    pub notes: Vec<String>,
    /// What the user was warned of.
    pub warnings: Vec<String>,
}

/// One body of a run.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(default)]
pub struct BodyRecord {
    /// Name of the body.
    pub name: String,
    /// Number of its particles.
    pub particles: usize,
    /// Spacing of its particles along each axis in m.
    pub spacing: Vec<f64>,
}

/// One of several systems of a run.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(default)]
pub struct SystemRecord {
    /// Name of the system, `fluid` for the main one.
    pub name: String,
    /// Steps of its own that it has taken.
    pub steps: u64,
}

/// One figure of a run.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(default)]
pub struct FigureRecord {
    /// Name, for example `first_step`.
    pub name: String,
    /// Its value.
    #[serde(deserialize_with = "number_or_nan")]
    pub value: f64,
    /// Its SI unit, `1` for a pure number.
    pub unit: String,
}

/// A reference curve, copied so that the folder explains itself.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(default)]
pub struct ReferenceRecord {
    /// The file as the case names it.
    pub path: String,
    /// The copy, relative to the folder of the record.
    pub file: String,
}

/// One failure after which a run went on with smaller steps.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(default)]
pub struct RetryRecord {
    /// What had gone wrong, as a sentence.
    pub failure: String,
    /// Steps taken when it did.
    pub step: u64,
    /// Simulated time in s of the state that the run went back to.
    pub back_to: f64,
    /// What every step has been multiplied by since.
    pub factor: f64,
}

/// One stage of a run and the time it took.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(default)]
pub struct StageRecord {
    /// Name, for example `rates` or `output`.
    pub name: String,
    /// Wall time of all calls together, in s.
    #[serde(deserialize_with = "number_or_nan")]
    pub seconds: f64,
    /// Number of calls.
    pub calls: u64,
    /// Bytes that come from memory and go there in a call even if caches serve all that is read again, if counted.
    pub bytes: Option<f64>,
}

/// What one of several ranks has done since the run started, or went on.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(default)]
pub struct RankRecord {
    /// Number of its particles.
    pub particles: usize,
    /// Wall time in s in which it computed steps.
    #[serde(deserialize_with = "number_or_nan")]
    pub computed: f64,
    /// Wall time in s in which it told others and waited for them.
    #[serde(deserialize_with = "number_or_nan")]
    pub waited: f64,
    /// Messages that it sent.
    pub messages: u64,
    /// Bytes that it sent.
    pub bytes: u64,
}

/// How the linear equations of a run were solved since it started, or went on.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(default)]
pub struct LinearRecord {
    /// `direct` or `krylov`.
    pub method: String,
    /// Entries of the factors, of those of the coarse space with a Krylov method.
    pub factor_entries: usize,
    /// Steps of Krylov methods.
    pub steps: u64,
    /// Wall time in s to make matrices.
    #[serde(deserialize_with = "number_or_nan")]
    pub assembly: f64,
    /// Wall time in s to factorise them.
    #[serde(deserialize_with = "number_or_nan")]
    pub factorisation: f64,
    /// Wall time in s to solve with them.
    #[serde(deserialize_with = "number_or_nan")]
    pub solution: f64,
}

/// A record could not be read.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum RecordError {
    /// The operating system refuses.
    #[error("cannot read {}: {source}", path.display())]
    Io {
        /// The file.
        path: PathBuf,
        /// What the operating system said.
        source: io::Error,
    },
    /// The file is no record of a run.
    #[error("{} is not a record of a run: {source}", path.display())]
    NotARecord {
        /// The file.
        path: PathBuf,
        /// What is wrong with it.
        source: serde_json::Error,
    },
    /// The file is JSON, but of another program.
    #[error("{} is not a record of a run of piola: its key `program` is {got:?}", path.display())]
    OtherProgram {
        /// The file.
        path: PathBuf,
        /// Value of `program`, empty if there is none.
        got: String,
    },
}

impl Default for RunRecord {
    fn default() -> Self {
        Self {
            program: Self::PROGRAM.into(),
            version: env!("CARGO_PKG_VERSION").into(),
            case_file: String::new(),
            id: None,
            title: String::new(),
            variant: None,
            case_text: String::new(),
            overrides: Vec::new(),
            seeds: Vec::new(),
            threads: 1,
            device: None,
            dimension: 0,
            bodies: Vec::new(),
            started: String::new(),
            finished: None,
            outcome: "running".into(),
            message: None,
            resumed_at: Vec::new(),
            retries: Vec::new(),
            steps: 0,
            end_time: 0.0,
            time_reached: 0.0,
            stages: Vec::new(),
            passes: Vec::new(),
            ranks: Vec::new(),
            linear: None,
            own_steps: Vec::new(),
            figures: Vec::new(),
            references: Vec::new(),
            files: Vec::new(),
            notes: Vec::new(),
            warnings: Vec::new(),
        }
    }
}

impl RunRecord {
    /// Value of `program` in every record.
    pub const PROGRAM: &'static str = "piola";
    /// Longest record that is read: 64 MiB.
    const MAX_BYTES: u64 = 64 << 20;

    /// Writes the record as JSON to the file `path`, and returns its length in bytes.
    ///
    /// # Errors
    /// The file cannot be written.
    pub fn write(&self, path: &Path) -> Result<u64, OutputError> {
        atomic::write_file(path, |out| {
            serde_json::to_writer_pretty(&mut *out, self)?;
            out.write_all(b"\n")
        })
    }

    /// Reads the record in the file `path`.
    ///
    /// # Errors
    /// The file cannot be read or is no record of a run of piola.
    pub fn read(path: &Path) -> Result<Self, RecordError> {
        /// The one key that tells a record from other JSON, without its default.
        #[derive(Deserialize)]
        struct Mark {
            #[serde(default)]
            program: String,
        }
        let fail = |source| RecordError::Io { path: path.into(), source };
        let mut bytes = Vec::new();
        File::open(path)
            .map_err(fail)?
            .take(Self::MAX_BYTES)
            .read_to_end(&mut bytes)
            .map_err(fail)?;
        let fail = |source| RecordError::NotARecord { path: path.into(), source };
        let Mark { program } = serde_json::from_slice(&bytes).map_err(fail)?;
        if program != Self::PROGRAM {
            return Err(RecordError::OtherProgram { path: path.into(), got: program });
        }
        serde_json::from_slice(&bytes).map_err(fail)
    }
}

/// `time` in UTC as in RFC 3339, to the second: `2026-11-21T02:42:00Z`. A clock that is set before
/// 1970 or after 9999 is taken as standing at that end.
pub fn timestamp(time: SystemTime) -> String {
    const LAST: u64 = 253_402_300_799;
    let seconds = time.duration_since(UNIX_EPOCH).map_or(0, |since| since.as_secs()).min(LAST);
    humantime::format_rfc3339_seconds(UNIX_EPOCH + Duration::from_secs(seconds)).to_string()
}

/// JSON has no NaN: what is not finite is written as `null`, and that is read as NaN.
fn number_or_nan<'de, D: Deserializer<'de>>(deserializer: D) -> Result<f64, D::Error> {
    Ok(Option::deserialize(deserializer)?.unwrap_or(f64::NAN))
}
