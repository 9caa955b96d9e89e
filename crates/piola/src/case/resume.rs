//! Checkpoints of a case: which of them belong to it, and where they are.

use std::error::Error;

use serde::{Deserialize, Serialize};
use sha2::{Digest, Sha256};

use super::document::{self, Entry, Node, Table, Value};
use super::functions::numbers_of;
use super::model::{Case, Shape};
use super::session::RunError;
use crate::observe::{Tables, WrittenFiles};
use crate::output::ResultsFolder;
use crate::output::checkpoint::{self, CheckpointError, Identity};
use crate::schemes::Scheme;
use crate::time::{Checkpoint, CheckpointStore};

/// What a file holds beside the checkpoint itself.
#[derive(Serialize, Deserialize)]
struct Payload<C> {
    /// Files written before, relative to the folder of the results.
    files: Vec<String>,
    /// How many more particles were in reserve than the case asks for.
    more_in_reserve: usize,
    checkpoint: C,
}

/// What is known of a run that continues from a checkpoint.
pub(super) struct Resumed {
    /// Simulated time of the checkpoint in s.
    pub time: f64,
    /// Files written before it, relative to the folder of the results.
    pub files: Vec<String>,
    /// How many more particles were in reserve than the case asks for.
    pub more_in_reserve: usize,
    /// Newer ones that had to be passed over.
    pub warnings: Vec<String>,
}

/// Tables and keys that the course of a run does not depend on before it ends.
const FREE: [&str; 10] =
    ["id", "title", "long", "checkpoint", "plot", "coarse", "paper", "variant", "sweep", "check"];
/// Those of `[time]`, and of `[compute]`.
const FREE_TIME: [&str; 2] = ["end", "max_steps"];
const FREE_COMPUTE: [&str; 2] = ["device", "ranks"];

/// What tells runs apart that cannot continue each other: the case with all overrides, but for what
/// may change in between, and the initial state, which knows of the files that the case reads.
pub(super) fn identity(case: &Case, scheme: &dyn Scheme) -> Identity {
    // The text is our own: that it cannot be read again is as impossible as that it is empty.
    let tree = document::parse(&case.as_run).unwrap_or_default();
    let outputs = [*case.output.every, *case.output.table_every];
    let mut sum = Sha256::new().chain_update(document::write(&without_free(tree)));
    // Their defaults depend on the end.
    outputs.iter().for_each(|interval| sum.update(interval.to_le_bytes()));
    for body in &case.bodies {
        if let Shape::Cloud { cloud: Some(cloud), .. } = &body.shape.value {
            sum = numbers_of(cloud, sum);
        }
    }
    scheme.ids().iter().for_each(|id| sum.update(id.to_le_bytes()));
    scheme.initial_state().iter().for_each(|number| sum.update(number.to_le_bytes()));
    sum.finalize().into()
}

impl Case {
    /// Distinguishes cases that give different results: some digits of a checksum of the case with all overrides,
    /// without the keys that the course of a run does not depend on.
    pub fn fingerprint(&self) -> String {
        // The text is our own: that it cannot be read again is impossible.
        let mut tree = document::parse(&self.as_run).unwrap_or_default();
        tree.entries.retain(|entry| !FREE.contains(&entry.key.as_str()));
        let sum = Sha256::digest(document::write(&tree));
        sum.iter().take(6).map(|byte| format!("{byte:02x}")).collect()
    }
}

fn without_free(mut tree: Table) -> Table {
    tree.entries.retain(|entry| !FREE.contains(&entry.key.as_str()));
    for entry in &mut tree.entries {
        let free = match entry.key.as_str() {
            "time" => FREE_TIME,
            "compute" => FREE_COMPUTE,
            _ => continue,
        };
        if let Node { value: Value::Table(table), .. } = &mut entry.node {
            table.entries.retain(|entry| !free.contains(&entry.key.as_str()) && !is_double(entry));
        }
    }
    // A table that says who computes, and nothing else, is as good as none.
    let is_empty = |node: &Node| matches!(&node.value, Value::Table(it) if it.entries.is_empty());
    tree.entries.retain(|entry| entry.key != "compute" || !is_empty(&entry.node));
    tree
}

/// Whether it says that pairs are in double precision, as without it.
fn is_double(entry: &Entry) -> bool {
    entry.key == "precision" && matches!(&entry.node.value, Value::Text(name) if name == "double")
}

/// Most bytes that a checkpoint of a run may have: its states, the tables with as many rows as the
/// output asks for, twice over, the numbers of `lines`, and some room for names.
pub(super) fn most_bytes(case: &Case, tables: &Tables, lines: usize, state_length: usize) -> u64 {
    const ROOM: f64 = (64 << 20) as f64;
    const STATES: f64 = 3.0;
    let columns: usize = tables.all().iter().map(|table| table.columns().len()).sum();
    let rows = rows(*case.time.end, *case.output.table_every);
    (ROOM + 8.0 * ((rows * columns) as f64 + lines as f64 + STATES * state_length as f64)) as u64
}

/// Most rows that something has which is recorded every so often up to `end`, twice over.
pub(super) fn rows(end: f64, every: f64) -> usize {
    let intervals = end / every;
    // Where there is no time, there are none.
    (2.0 * (if intervals.is_finite() { intervals } else { 0.0 } + 16.0)) as usize
}

/// The newest sound checkpoint in `folder`; none if there are no checkpoints at all.
pub(super) fn find(
    folder: &ResultsFolder,
    identity: &Identity,
    most: u64,
) -> Result<Option<(Checkpoint, Resumed)>, RunError> {
    let mut refused: Vec<CheckpointError> = Vec::new();
    for path in folder.checkpoints()? {
        match checkpoint::read(&path, identity, most) {
            Ok(bytes) => match postcard::take_from_bytes::<Payload<Checkpoint>>(&bytes) {
                Ok((Payload { files, more_in_reserve, checkpoint }, []))
                    if files.iter().all(|file| ResultsFolder::may_hold(file)) =>
                {
                    let warnings = refused.iter().map(|error| format!("skipped: {error}"));
                    let (time, warnings) = (checkpoint.time(), warnings.collect());
                    return Ok(Some((
                        checkpoint,
                        Resumed { time, files, more_in_reserve, warnings },
                    )));
                }
                _ => {
                    let what = "what it holds cannot be read".into();
                    refused.push(CheckpointError::Damaged { path, what });
                }
            },
            Err(error) => refused.push(error),
        }
    }
    match refused.into_iter().next() {
        None => Ok(None),
        Some(newest) => Err(RunError::NoCheckpoint { newest }),
    }
}

/// Writes checkpoints into the folder of a run and removes the oldest.
pub(super) struct Store {
    pub folder: ResultsFolder,
    pub identity: Identity,
    pub written: WrittenFiles,
    pub more_in_reserve: usize,
    pub keep: u64,
}

impl CheckpointStore for Store {
    fn store(&mut self, checkpoint: &Checkpoint) -> Result<(), Box<dyn Error + Send + Sync>> {
        let files = self.written.list().iter().map(|file| self.folder.relative(file)).collect();
        let more_in_reserve = self.more_in_reserve;
        let payload = postcard::to_stdvec(&Payload { files, more_in_reserve, checkpoint })?;
        let path = self.folder.checkpoint(checkpoint.step())?;
        checkpoint::write(&path, &self.identity, &payload)?;
        // The new one is on the disk before an old one goes.
        for old in self.folder.checkpoints()?.into_iter().skip(self.keep.max(1) as usize) {
            std::fs::remove_file(old)?;
        }
        Ok(())
    }
}
