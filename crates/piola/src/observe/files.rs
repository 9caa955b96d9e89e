//! The list of files that a run has written.

use std::path::{Path, PathBuf};
use std::sync::{Arc, Mutex, PoisonError};

/// Files in the order of writing, each once, shared by all writers.
#[derive(Clone, Debug, Default)]
pub struct WrittenFiles(Arc<Mutex<Vec<PathBuf>>>);

impl WrittenFiles {
    /// Records a file.
    pub fn push(&self, file: PathBuf) {
        let mut files = self.0.lock().unwrap_or_else(PoisonError::into_inner);
        if !files.contains(&file) {
            files.push(file);
        }
    }

    /// Removes a file of a part of the run that is repeated, here and from the disk. One that cannot be removed is
    /// overwritten or stays as it is.
    pub fn remove(&self, file: &Path) {
        let mut files = self.0.lock().unwrap_or_else(PoisonError::into_inner);
        files.retain(|known| known != file);
        let _ = std::fs::remove_file(file);
    }

    /// All files so far.
    pub fn list(&self) -> Vec<PathBuf> {
        self.0.lock().unwrap_or_else(PoisonError::into_inner).clone()
    }
}
