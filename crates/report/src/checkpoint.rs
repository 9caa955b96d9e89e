//! The file of a checkpoint: some bytes with what tells whether they are whole and whose they are.
//!
//! ```text
//!  8 bytes  PIOLACKP
//!  4        version of this format, little endian
//! 16        version of the program, as text with zeros after it
//! 32        identity of the case: what was run
//!  8        length n of the payload, little endian
//!  n        payload
//! 32        SHA-256 of all bytes before
//! ```
//!
//! A file that is cut short, has a bit flipped anywhere, or is something else is refused before its
//! payload is looked at, and no more memory is asked for than the reader allows.

use std::fs::File;
use std::io::{self, Read};
use std::path::{Path, PathBuf};

use sha2::{Digest, Sha256};
use thiserror::Error;

use super::{OutputError, atomic};

const MAGIC: &[u8; 8] = b"PIOLACKP";
/// Version of the format.
const FORMAT: u32 = 9;
/// What a payload holds is that program's own affair.
const PROGRAM: [u8; 16] = program(env!("CARGO_PKG_VERSION"));
const HEAD: usize = MAGIC.len() + 4 + 16 + 32 + 8;
const SUM: usize = 32;

const fn program(version: &str) -> [u8; 16] {
    let (version, mut field, mut at) = (version.as_bytes(), [0; 16], 0);
    while at < version.len() && at < field.len() {
        field[at] = version[at];
        at += 1;
    }
    field
}

/// What was run: bytes that two runs share if and only if the one can go on where the other stopped.
pub type Identity = [u8; 32];

/// A checkpoint is refused.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum CheckpointError {
    /// The operating system refuses.
    #[error("the checkpoint {} cannot be read: {source}", path.display())]
    Io {
        /// The file.
        path: PathBuf,
        /// What the operating system said.
        source: io::Error,
    },
    /// The file is something else.
    #[error("{} is not a checkpoint of piola", path.display())]
    NotACheckpoint {
        /// The file.
        path: PathBuf,
    },
    /// The file is of another version of the program.
    #[error(
        "the checkpoint {} was written by {got}, and this is {expected}: go on with the version \
         that wrote it, or start anew without `--resume`",
        path.display()
    )]
    OtherVersion {
        /// The file.
        path: PathBuf,
        /// The version that wrote it.
        got: String,
        /// This version.
        expected: String,
    },
    /// The file is of another case.
    #[error(
        "the checkpoint {} belongs to another case, or to this one with other settings or in another precision: start \
         anew without `--resume`, choose another folder with `--out`, or take back what was \
         changed in the case",
        path.display()
    )]
    OtherCase {
        /// The file.
        path: PathBuf,
    },
    /// The file is not as it was written.
    #[error("the checkpoint {} is damaged: {what}", path.display())]
    Damaged {
        /// The file.
        path: PathBuf,
        /// In what way.
        what: String,
    },
    /// The file is larger than any checkpoint of this run.
    #[error(
        "the checkpoint {} has {got} bytes, more than the {most} that one of this case may have",
        path.display()
    )]
    TooLarge {
        /// The file.
        path: PathBuf,
        /// Its length in bytes.
        got: u64,
        /// Most bytes.
        most: u64,
    },
}

/// Writes `payload` to the file `path`, whole or not at all.
///
/// # Errors
/// The file cannot be written.
pub fn write(path: &Path, identity: &Identity, payload: &[u8]) -> Result<u64, OutputError> {
    let head = head(identity, payload.len() as u64);
    let sum = Sha256::new().chain_update(&head).chain_update(payload).finalize();
    atomic::write_file(path, |out| {
        out.write_all(&head)?;
        out.write_all(payload)?;
        out.write_all(&sum)
    })
}

fn head(identity: &Identity, length: u64) -> Vec<u8> {
    [MAGIC.as_slice(), &FORMAT.to_le_bytes(), &PROGRAM, identity, &length.to_le_bytes()].concat()
}

/// Reads the payload of the file `path`, which has to be of the run `identity` and hold at most
/// `most` bytes.
///
/// # Errors
/// It is not sound, or not of this run, or not of this version.
pub fn read(path: &Path, identity: &Identity, most: u64) -> Result<Vec<u8>, CheckpointError> {
    let fail = |source| CheckpointError::Io { path: path.into(), source };
    let damaged = |what: String| Err(CheckpointError::Damaged { path: path.into(), what });
    let file = File::open(path).map_err(fail)?;
    let got = file.metadata().map_err(fail)?.len();
    if got > most.saturating_add((HEAD + SUM) as u64) {
        return Err(CheckpointError::TooLarge { path: path.into(), got, most });
    }
    let mut bytes = Vec::new();
    file.take(got).read_to_end(&mut bytes).map_err(fail)?;
    if !bytes.starts_with(&MAGIC[..MAGIC.len().min(bytes.len())]) {
        return Err(CheckpointError::NotACheckpoint { path: path.into() });
    }
    let Some((head, rest)) = bytes.split_at_checked(HEAD).filter(|(_, rest)| rest.len() >= SUM)
    else {
        return damaged(format!("it ends after {} bytes", bytes.len()));
    };
    let (version, rest_of_head) = head[MAGIC.len()..].split_at(4 + PROGRAM.len());
    let expected = [FORMAT.to_le_bytes().as_slice(), &PROGRAM].concat();
    if version != expected {
        let [got, expected] = [version, &expected].map(version_text);
        return Err(CheckpointError::OtherVersion { path: path.into(), got, expected });
    }
    let (owner, length) = rest_of_head.split_at(identity.len());
    let length = length.iter().rev().fold(0_u64, |length, byte| (length << 8) | u64::from(*byte));
    let (payload, sum) = rest.split_at(rest.len() - SUM);
    if length != payload.len() as u64 {
        return damaged(format!("it holds {} bytes, and {length} were written", payload.len()));
    }
    if Sha256::digest(&bytes[..HEAD + payload.len()]).as_slice() != sum {
        return damaged("its checksum does not agree with what it holds".into());
    }
    if owner != identity {
        return Err(CheckpointError::OtherCase { path: path.into() });
    }
    bytes.truncate(bytes.len() - SUM);
    bytes.drain(..HEAD);
    Ok(bytes)
}

/// A version as a checkpoint names it, in words.
fn version_text(bytes: &[u8]) -> String {
    let (format, program) = bytes.split_at(4);
    let format = format.iter().rev().fold(0_u32, |format, byte| (format << 8) | u32::from(*byte));
    let program = String::from_utf8_lossy(program);
    let program = program.trim_end_matches('\0').escape_default();
    format!("piola {program} in format {format}")
}
