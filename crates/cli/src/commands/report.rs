//! `piola report`.

use std::path::Path;

use piola::case::report::{ReportError, write};
use piola::output::RecordError;

use crate::exit::{Exit, Fault};
use crate::terminal;

/// Makes the report of the run in `folder` again, and says where it is.
pub fn report(folder: &Path) -> Result<Exit, Fault> {
    let path = write(folder).map_err(|error| {
        let exit = match error {
            ReportError::NoRun { source: RecordError::Io { .. } } | ReportError::Output(_) => {
                Exit::Io
            }
            _ => Exit::BadCase,
        };
        Fault::new(exit, error)
    })?;
    terminal::print(&format!("{}\n", path.display()))?;
    Ok(Exit::Success)
}
