//! Files that geometry is read from.

use std::fs::File;
use std::io::{self, Read};
use std::path::Path;

/// Largest file in bytes: some thirty million points.
pub(super) const MOST_BYTES: u64 = 1 << 31;

/// Why the bytes of a file cannot be had.
pub(super) enum FileFault {
    Unreadable(io::Error),
    NotAFile,
    TooLarge,
}

impl std::fmt::Display for FileFault {
    fn fmt(&self, out: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Self::Unreadable(error) => error.fmt(out),
            Self::NotAFile => out.write_str("it is not a file"),
            Self::TooLarge => write!(out, "it is larger than {MOST_BYTES} bytes"),
        }
    }
}

impl From<io::Error> for FileFault {
    fn from(error: io::Error) -> Self {
        Self::Unreadable(error)
    }
}

/// The bytes of a file of at most [`MOST_BYTES`].
pub(super) fn read(path: &Path) -> Result<Vec<u8>, FileFault> {
    // Asked before opening, as opening a pipe waits for its writer.
    let known = path.metadata()?;
    if !known.is_file() {
        return Err(FileFault::NotAFile);
    }
    if known.len() > MOST_BYTES {
        return Err(FileFault::TooLarge);
    }
    let mut bytes = Vec::new();
    File::open(path)?.take(MOST_BYTES + 1).read_to_end(&mut bytes)?;
    if bytes.len() as u64 > MOST_BYTES {
        return Err(FileFault::TooLarge);
    }
    Ok(bytes)
}
