//! The list of files that a run has written.

use std::path::PathBuf;
use std::sync::{Arc, Mutex, PoisonError};

/// Files in the order of writing, each once, shared by all that write.
#[derive(Clone, Debug, Default)]
pub struct WrittenFiles(Arc<Mutex<Vec<PathBuf>>>);

impl WrittenFiles {
    /// Notes a file.
    pub fn push(&self, file: PathBuf) {
        let mut files = self.0.lock().unwrap_or_else(PoisonError::into_inner);
        if !files.contains(&file) {
            files.push(file);
        }
    }

    /// All files so far.
    pub fn list(&self) -> Vec<PathBuf> {
        self.0.lock().unwrap_or_else(PoisonError::into_inner).clone()
    }
}
