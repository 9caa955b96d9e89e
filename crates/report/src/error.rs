//! Why a file or a folder of results could not be written.

use std::io;
use std::path::{Path, PathBuf};

/// A file or folder of results could not be written. Nothing half-written is left behind.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum OutputError {
    /// The folder, the file or the whole file system refuses to be written.
    #[error(
        "cannot write {}: {source}. Choose another folder, or ask for permission to write there",
        path.display()
    )]
    NotWritable {
        /// The file or folder to be written.
        path: PathBuf,
        /// What the operating system said.
        source: io::Error,
    },
    /// The disk or the user's share of it is full.
    #[error(
        "cannot write {}: {source}. The disk is full: free some space or choose a folder on \
         another disk. Files written before are complete, and nothing is left of this one",
        path.display()
    )]
    DiskFull {
        /// The file or folder to be written.
        path: PathBuf,
        /// What the operating system said.
        source: io::Error,
    },
    /// A folder, a device or something else that is no plain file has the name of the file.
    #[error(
        "cannot write the file {}: {kind} has this name. Remove it or choose another name",
        path.display()
    )]
    NotAFile {
        /// The file to be written.
        path: PathBuf,
        /// What is there: `a folder` or `something that is not a plain file`.
        kind: &'static str,
    },
    /// The folder of the file does not exist.
    #[error(
        "cannot write {}: its folder {} does not exist. Create it first, or look for a misspelt \
         name",
        path.display(), parent.display()
    )]
    ParentMissing {
        /// The file to be written.
        path: PathBuf,
        /// The folder that is missing.
        parent: PathBuf,
    },
    /// A file has the name of a folder that is needed.
    #[error(
        "cannot use {} as a folder: a file has this name. Remove it or choose another folder",
        path.display()
    )]
    NotAFolder {
        /// The folder that is needed.
        path: PathBuf,
    },
    /// A folder for results holds files but no record of a run of piola's, so that they are
    /// somebody else's.
    #[error(
        "will not write results into {}: it holds {entry} and no record of an earlier run. Choose \
         another folder with --out, or empty this one",
        path.display()
    )]
    ForeignFolder {
        /// The folder.
        path: PathBuf,
        /// Name of something in it.
        entry: String,
    },
    /// Anything else that the operating system refuses.
    #[error("cannot write {}: {source}", path.display())]
    Io {
        /// The file or folder to be written.
        path: PathBuf,
        /// What the operating system said.
        source: io::Error,
    },
    /// The data to be written contradict themselves.
    #[error(
        "cannot write {}: {what} has {got} values where {expected} are expected. The values must \
         be as many as the particles times the components of one",
        path.display()
    )]
    WrongLength {
        /// The file to be written.
        path: PathBuf,
        /// The array that does not fit, for example `the field velocity`.
        what: String,
        /// Length that would fit.
        expected: usize,
        /// Length found.
        got: usize,
    },
    /// Particles live in one, two or three dimensions.
    #[error("cannot write {}: the dimension is {got} where 1, 2 or 3 is expected", path.display())]
    WrongDimension {
        /// The file to be written.
        path: PathBuf,
        /// Dimension found.
        got: usize,
    },
}

impl OutputError {
    /// The variant that helps most with `source`, met while writing `path`.
    pub(crate) fn from_io(path: &Path, source: io::Error) -> Self {
        use io::ErrorKind;
        let path = path.to_path_buf();
        match source.kind() {
            ErrorKind::PermissionDenied | ErrorKind::ReadOnlyFilesystem => {
                Self::NotWritable { path, source }
            }
            ErrorKind::StorageFull | ErrorKind::QuotaExceeded => Self::DiskFull { path, source },
            ErrorKind::IsADirectory => Self::NotAFile { path, kind: "a folder" },
            _ => Self::Io { path, source },
        }
    }
}
