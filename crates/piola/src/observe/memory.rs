//! What observers remember, as bytes of a checkpoint.

use serde::Serialize;
use serde::de::DeserializeOwned;

use crate::output::ResultsFolder;
use crate::time::Misfit;

/// The bytes of `value`.
pub(super) fn encode(value: &impl Serialize) -> Vec<u8> {
    postcard::to_stdvec(value).expect("numbers, texts and lists of them have an encoding")
}

/// The value behind `saved`, which is of `what`.
pub(super) fn decode<T: DeserializeOwned>(saved: &[u8], what: &str) -> Result<T, Misfit> {
    match postcard::take_from_bytes(saved) {
        Ok((value, [])) => Ok(value),
        _ => Err(Misfit(format!("what it remembers of {what} cannot be read"))),
    }
}

/// Refuses files that would lead out of the folder of the results: they may be removed later.
pub(super) fn inside<'a>(files: impl IntoIterator<Item = &'a String>) -> Result<(), Misfit> {
    match files.into_iter().find(|file| !ResultsFolder::may_hold(file)) {
        Some(file) => Err(Misfit(format!("{file:?} is not a file of a run"))),
        None => Ok(()),
    }
}
