//! `piola new`: a commented case to start from.

use std::fs;
use std::path::Path;

use piola::case::template;
use piola::output::atomic;

use crate::exit::{Exit, Fault};
use crate::terminal;

/// Writes `folder/case.toml`, and refuses to replace one.
pub fn new(folder: &Path) -> Result<Exit, Fault> {
    let path = folder.join("case.toml");
    if fs::symlink_metadata(&path).is_ok() {
        let message = format!("{} exists already; choose another name", path.display());
        return Err(Fault::new(Exit::Io, message));
    }
    fs::create_dir_all(folder).map_err(|error| {
        let folder = folder.display();
        Fault::new(Exit::Io, format!("cannot create the folder {folder}: {error}"))
    })?;
    let text = template::new_case(&title(folder));
    atomic::write_file(&path, |out| out.write_all(text.as_bytes()))
        .map_err(|error| Fault::new(Exit::Io, error))?;
    let path = path.display();
    terminal::print(&format!(
        "wrote {path}\n\n\
         piola check {path}    says what will happen\n\
         piola run {path}      runs it\n"
    ))?;
    Ok(Exit::Success)
}

/// The last part of the folder's path, or of what it stands for (`.`).
fn title(folder: &Path) -> String {
    let resolved = folder.canonicalize();
    let name = folder.file_name().or_else(|| resolved.as_deref().ok()?.file_name());
    name.map_or_else(|| "case".to_owned(), |name| name.to_string_lossy().into_owned())
}
