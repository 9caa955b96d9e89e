//! The files of a run.

use std::path::{Path, PathBuf};

use super::build::bodies::BodyReport;
use super::model::{self, Case};
use super::simulation::{Finished, RunError};
use crate::observe::FrameWriter;
use crate::output::Compression;
use crate::time::{Observer, Schedule};

/// The results folder of a run and what is written into it.
pub(super) struct Outputs {
    folder: PathBuf,
}

impl Outputs {
    pub fn new(_case: &Case, folder: &Path) -> Result<Self, RunError> {
        let _ = std::fs::create_dir_all(folder.join("particles"));
        Ok(Self { folder: folder.to_owned() })
    }
    pub fn tables(&self) -> [PathBuf; 3] {
        ["probes.csv", "energy.csv", "steps.csv"].map(|n| self.folder.join(n))
    }
    pub fn observers(&mut self, case: &Case, _bodies: &[BodyReport]) -> Vec<Box<dyn Observer>> {
        vec![Box::new(FrameWriter::new(
            self.folder.clone(),
            Schedule::Every(*case.output.every),
            case.output.fields.iter().map(|f| f.name).collect(),
            match case.output.compression {
                model::Compression::None => Compression::None,
                model::Compression::Zlib => Compression::Zlib,
            },
        ))]
    }
    pub fn finish(
        self,
        _case: &Case,
        _f: &Finished,
        _b: &[BodyReport],
        _s: f64,
    ) -> Result<Vec<PathBuf>, RunError> {
        Ok(vec![])
    }
}
