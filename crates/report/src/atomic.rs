//! Files that are written whole or not at all.
//!
//! A file is written under a temporary name in its own folder, brought to the disk, and only then
//! given its name, which replaces an older file of that name in one step. A reader, a crash or a
//! full disk never meets half a file; what is left after a crash is the older file and perhaps a
//! temporary one ([`is_temporary`]).

use std::fs;
use std::io::{self, BufWriter, Write};
use std::path::Path;

use super::OutputError;

const TEMPORARY_START: &str = ".piola-";
const TEMPORARY_END: &str = ".partial";

/// Writes the file `path` with what `write` puts into the writer it is given, and returns the
/// file's length in bytes. An older file of this name is replaced.
///
/// # Errors
/// The file cannot be created, written or named, or `write` fails: nothing is left of it then, and
/// an older file of this name is untouched.
pub fn write_file(
    path: &Path,
    write: impl FnOnce(&mut dyn Write) -> io::Result<()>,
) -> Result<u64, OutputError> {
    let parent = usable_parent(path)?;
    let fail = |source| OutputError::from_io(path, source);
    let mut builder = tempfile::Builder::new();
    builder.prefix(TEMPORARY_START).suffix(TEMPORARY_END);
    // Temporary files are private by default, but results are for whom the user's mask lets in.
    #[cfg(unix)]
    builder.permissions(std::os::unix::fs::PermissionsExt::from_mode(0o666));
    let mut file = builder.tempfile_in(parent).map_err(fail)?;

    let mut writer = BufWriter::with_capacity(1 << 16, file.as_file_mut());
    write(&mut writer).and_then(|()| writer.flush()).map_err(fail)?;
    drop(writer);
    file.as_file().sync_all().map_err(fail)?;
    let length = file.as_file().metadata().map_err(fail)?.len();
    file.persist(path).map_err(|error| fail(error.error))?;
    sync_folder(parent);
    Ok(length)
}

/// Whether `name` is that of a temporary file of [`write_file`], left by a process that was killed.
pub fn is_temporary(name: &str) -> bool {
    name.starts_with(TEMPORARY_START) && name.ends_with(TEMPORARY_END)
}

/// The folder of `path`, after the faults that deserve a sentence of their own are ruled out.
fn usable_parent(path: &Path) -> Result<&Path, OutputError> {
    let parent = match path.parent() {
        Some(parent) if parent.as_os_str().is_empty() => Path::new("."),
        Some(parent) => parent,
        None => return Err(OutputError::NotAFile { path: path.into(), kind: "a folder" }),
    };
    match fs::metadata(parent) {
        Ok(metadata) if metadata.is_dir() => {}
        Ok(_) => return Err(OutputError::NotAFolder { path: parent.into() }),
        Err(error) if error.kind() == io::ErrorKind::NotFound => {
            return Err(OutputError::ParentMissing { path: path.into(), parent: parent.into() });
        }
        Err(error) if error.kind() == io::ErrorKind::NotADirectory => {
            // Some folder further up is a file: name the one that is.
            let file = parent.ancestors().find(|folder| folder.is_file()).unwrap_or(parent);
            return Err(OutputError::NotAFolder { path: file.into() });
        }
        Err(error) => return Err(OutputError::from_io(path, error)),
    }
    // A rename would replace a device such as /dev/null as readily as a plain file.
    match fs::metadata(path) {
        Ok(metadata) if metadata.is_dir() => {
            Err(OutputError::NotAFile { path: path.into(), kind: "a folder" })
        }
        Ok(metadata) if !metadata.is_file() => Err(OutputError::NotAFile {
            path: path.into(),
            kind: "something that is not a plain file",
        }),
        _ => Ok(parent),
    }
}

/// Brings the new name to the disk. Not every file system can, and the file is whole without it,
/// so a refusal is no failure.
fn sync_folder(folder: &Path) {
    if cfg!(unix) {
        let _ = fs::File::open(folder).and_then(|folder| folder.sync_all());
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn names(folder: &Path) -> Vec<String> {
        let entries = fs::read_dir(folder).unwrap();
        entries.map(|entry| entry.unwrap().file_name().into_string().unwrap()).collect()
    }

    #[test]
    fn replaces_the_older_file_and_leaves_nothing_beside_it() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a.txt");
        for text in ["a longer first text", "second"] {
            let length = write_file(&path, |out| out.write_all(text.as_bytes())).unwrap();
            assert_eq!(length, text.len() as u64);
            assert_eq!(fs::read_to_string(&path).unwrap(), text);
        }
        assert_eq!(names(folder.path()), ["a.txt"]);
    }

    #[test]
    fn a_failing_writer_leaves_the_older_file_and_no_trace() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a.txt");
        fs::write(&path, "older").unwrap();
        let error = write_file(&path, |out| {
            out.write_all(&vec![0; 1 << 20])?;
            Err(io::Error::other("the writer gave up"))
        })
        .unwrap_err();
        assert!(error.to_string().contains("the writer gave up"), "{error}");
        assert_eq!(fs::read_to_string(&path).unwrap(), "older");
        assert_eq!(names(folder.path()), ["a.txt"]);
    }

    #[cfg(target_os = "linux")]
    #[test]
    fn a_full_disk_is_called_so() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a.txt");
        // The kernel's own "no space left on device", from the device that is always full.
        let error = write_file(&path, |_| {
            fs::OpenOptions::new().write(true).open("/dev/full")?.write_all(b"text")
        })
        .unwrap_err();
        assert!(matches!(error, OutputError::DiskFull { .. }), "{error:?}");
        assert!(error.to_string().contains("a.txt") && error.to_string().contains("disk is full"));
        assert!(names(folder.path()).is_empty());
    }

    #[test]
    fn faults_of_the_path_are_told_apart() {
        let folder = tempfile::tempdir().unwrap();
        let write = |path: &Path| write_file(path, |out| out.write_all(b"text")).unwrap_err();
        let error = write(folder.path());
        assert!(matches!(error, OutputError::NotAFile { .. }), "{error:?}");
        let error = write(&folder.path().join("missing/a.txt"));
        assert!(matches!(error, OutputError::ParentMissing { .. }), "{error:?}");
        fs::write(folder.path().join("file"), "").unwrap();
        for below in ["file/a.txt", "file/deeper/a.txt"] {
            let error = write(&folder.path().join(below));
            let OutputError::NotAFolder { path } = &error else { panic!("{error:?}") };
            assert!(path.ends_with("file"), "{error}");
        }
        let error = write(Path::new("/"));
        assert!(matches!(error, OutputError::NotAFile { .. }), "{error:?}");
        assert_eq!(names(folder.path()), ["file"]);
    }

    #[cfg(unix)]
    #[test]
    fn a_device_is_not_replaced() {
        let error = write_file(Path::new("/dev/null"), |_| Ok(())).unwrap_err();
        assert!(matches!(error, OutputError::NotAFile { .. }), "{error:?}");
    }

    #[cfg(unix)]
    #[test]
    fn a_refused_permission_is_called_so() {
        use std::os::unix::fs::PermissionsExt;
        let folder = tempfile::tempdir().unwrap();
        fs::set_permissions(folder.path(), fs::Permissions::from_mode(0o555)).unwrap();
        // Root may write anywhere; the rest of us are refused.
        if let Err(error) = write_file(&folder.path().join("a.txt"), |_| Ok(())) {
            assert!(matches!(error, OutputError::NotWritable { .. }), "{error:?}");
        }
        let refused = io::Error::from(io::ErrorKind::PermissionDenied);
        let error = OutputError::from_io(Path::new("a.txt"), refused);
        assert!(matches!(error, OutputError::NotWritable { .. }), "{error:?}");
    }
}
