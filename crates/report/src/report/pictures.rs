//! The pictures of a run inside the page.

use std::fs::File;
use std::io::Read;
use std::path::{Path, PathBuf};

use base64::Engine;
use base64::engine::general_purpose::STANDARD;

use super::frames::evenly;
use crate::ResultsFolder;

/// Most bytes of all pictures together.
const MAX_BYTES: u64 = 6 << 20;
/// Most pictures.
const MAX_PICTURES: usize = 60;
const SIGNATURE: &[u8] = b"\x89PNG\r\n\x1a\n";

/// A picture as the page holds it.
pub struct Embedded {
    /// Its file, relative to the results folder.
    pub file: String,
    /// What it shows, for example `pressure`.
    pub name: String,
    /// Its address, with all its bytes.
    pub address: String,
}

/// The pictures that are shown, the number of those that are there, and a sentence for each that
/// could not be used.
pub struct Pictures {
    pub shown: Vec<Embedded>,
    pub found: usize,
    pub faults: Vec<String>,
}

/// Reads the pictures of a results folder. If they are too many or too large together, some are
/// left out evenly.
pub fn read(folder: &ResultsFolder) -> Pictures {
    let paths = folder.all_pictures();
    let size = |path: &PathBuf| path.metadata().map_or(0, |data| data.len());
    let total: u64 = paths.iter().map(size).sum();
    let mut wanted = paths.len().min(MAX_PICTURES);
    if total > MAX_BYTES {
        let mean = (total / paths.len().max(1) as u64).max(1);
        wanted = wanted.min((MAX_BYTES / mean) as usize);
    }
    let mut pictures = Pictures { shown: Vec::new(), found: paths.len(), faults: Vec::new() };
    let mut left = MAX_BYTES;
    for number in evenly(paths.len(), wanted) {
        let path = &paths[number];
        let file = folder.relative(path);
        match embed(path, left) {
            Ok(bytes) => {
                left -= bytes.len() as u64;
                let stem = path.file_stem().unwrap_or_default().to_string_lossy();
                let name = stem.rsplit_once('_').map_or(&*stem, |(name, _)| name).to_owned();
                let address = format!("data:image/png;base64,{}", STANDARD.encode(&bytes));
                pictures.shown.push(Embedded { file, name, address });
            }
            Err(Some(reason)) => pictures.faults.push(format!("{file} is left out: {reason}")),
            Err(None) => {}
        }
    }
    pictures
}

/// The bytes of the picture `path`; why it is left out, or nothing where `left` has no room for it.
fn embed(path: &Path, left: u64) -> Result<Vec<u8>, Option<String>> {
    let mut bytes = Vec::new();
    let file = File::open(path).map_err(|error| Some(error.to_string()))?;
    file.take(left + 1).read_to_end(&mut bytes).map_err(|error| Some(error.to_string()))?;
    if bytes.len() as u64 > left {
        return Err(None);
    }
    if !bytes.starts_with(SIGNATURE) {
        return Err(Some("it is not a PNG file".into()));
    }
    Ok(bytes)
}
