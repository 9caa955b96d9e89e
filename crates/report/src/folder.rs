//! The folder of the results of one run, and what is where in it.
//!
//! ```text
//! run.json                      the record of the run
//! particles.pvd                 the time series for ParaView
//! particles/frame_000012.vtp    one instant
//! probes.csv energy.csv momentum.csv steps.csv
//! failure.csv                   where a run failed: the last steps of the first bad particle
//! checkpoints/step_000000000128 states from which the run can be resumed
//! pictures/NAME_000012.png      particles coloured by a field
//! profiles/NAME_000012.csv      fields along a line at one instant
//! plots/NAME.png                curves
//! references/0_NAME.csv         reference curves of the case's checks
//! report.html                   all of it in one page
//! ```

use std::collections::BTreeSet;
use std::fs;
use std::io;
use std::path::{Component, Path, PathBuf};

use super::{OutputError, RecordError, RunRecord, atomic};

const RECORD: &str = "run.json";
const SERIES: &str = "particles.pvd";
const TABLES: [&str; 5] = ["probes.csv", "energy.csv", "momentum.csv", "steps.csv", "failure.csv"];
const PARTICLES: &str = "particles";
const PICTURES: &str = "pictures";
const PROFILES: &str = "profiles";
const PLOTS: &str = "plots";
const REFERENCES: &str = "references";
const REPORT: &str = "report.html";
const CHECKPOINTS: &str = "checkpoints";
const CHECKPOINT_START: &str = "step_";

/// A folder that belongs to one run.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct ResultsFolder {
    path: PathBuf,
}

impl ResultsFolder {
    /// Makes the folder `path` ready for a run and writes `record` into it, so that the folder is
    /// known as piola's even if the run is killed.
    ///
    /// A folder that does not exist is created, with those above it. If it holds the record of an
    /// earlier run, the files of that run are removed: those that the record lists, and whatever
    /// has the name of an output file. Other files stay.
    ///
    /// # Errors
    /// The folder holds files but no record; a file has its name; it cannot be created, read or
    /// written.
    pub fn create(path: &Path, record: &RunRecord) -> Result<Self, OutputError> {
        let fail = |source| OutputError::from_io(path, source);
        let folder = Self::at(path);
        match fs::metadata(path) {
            Ok(metadata) if !metadata.is_dir() => {
                return Err(OutputError::NotAFolder { path: path.into() });
            }
            Ok(_) => folder.empty()?,
            Err(error) if error.kind() == io::ErrorKind::NotFound => create_folder(path)?,
            Err(error) if error.kind() == io::ErrorKind::NotADirectory => create_folder(path)?,
            Err(error) => return Err(fail(error)),
        }
        record.write(&folder.record())?;
        Ok(folder)
    }

    /// The folder `path` as it is, without looking at it.
    pub fn at(path: &Path) -> Self {
        Self { path: path.into() }
    }

    /// The folder `path` of an earlier run, with its record.
    ///
    /// # Errors
    /// The folder holds no record of a run of piola.
    pub fn of_run(path: &Path) -> Result<(Self, RunRecord), RecordError> {
        let folder = Self { path: path.into() };
        let record = RunRecord::read(&folder.record())?;
        Ok((folder, record))
    }

    /// Removes the files of the run that are not among `kept` (relative paths), except the record
    /// and the checkpoints: what was written after the checkpoint that the run continues from is
    /// written again.
    ///
    /// # Errors
    /// A file cannot be removed, or the record cannot be written.
    pub fn go_on(&self, record: &RunRecord, kept: &[String]) -> Result<(), OutputError> {
        for file in self.files_of_run()? {
            let name = self.relative(&file);
            let is_checkpoint = name.starts_with(CHECKPOINTS) && !atomic::is_temporary(&name);
            if !is_checkpoint && !kept.contains(&name) {
                fs::remove_file(&file).map_err(|error| OutputError::from_io(&file, error))?;
            }
        }
        record.write(&self.record())?;
        Ok(())
    }

    /// Whether `file` is a path that leads to a file of a run, in this folder or in one below it.
    pub fn may_hold(file: &str) -> bool {
        own(file).is_some()
    }

    /// The folder itself.
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// The record of the run.
    pub fn record(&self) -> PathBuf {
        self.path.join(RECORD)
    }

    /// The time series of the particle files.
    pub fn series(&self) -> PathBuf {
        self.path.join(SERIES)
    }

    /// The table of the probes.
    pub fn probes(&self) -> PathBuf {
        self.path.join(TABLES[0])
    }

    /// The table of energies.
    pub fn energy(&self) -> PathBuf {
        self.path.join(TABLES[1])
    }

    /// The table of momentum.
    pub fn momentum(&self) -> PathBuf {
        self.path.join(TABLES[2])
    }

    /// The table of the steps.
    pub fn steps(&self) -> PathBuf {
        self.path.join(TABLES[3])
    }

    /// The table of the last steps before a failure.
    pub fn failure(&self) -> PathBuf {
        self.path.join(TABLES[4])
    }

    /// The checkpoint after `step` steps; its folder is created if it is missing.
    ///
    /// # Errors
    /// The folder cannot be created.
    pub fn checkpoint(&self, step: u64) -> Result<PathBuf, OutputError> {
        Ok(self.below(CHECKPOINTS)?.join(format!("{CHECKPOINT_START}{step:012}")))
    }

    /// The checkpoints, the newest first.
    ///
    /// # Errors
    /// Their folder cannot be read.
    pub fn checkpoints(&self) -> Result<Vec<PathBuf>, OutputError> {
        let folder = self.path.join(CHECKPOINTS);
        if !fs::symlink_metadata(&folder).is_ok_and(|metadata| metadata.is_dir()) {
            return Ok(Vec::new());
        }
        let known = names(&folder)?.into_iter().rev().filter(|name| is_checkpoint(name));
        Ok(known.map(|name| folder.join(name)).collect())
    }

    /// The particle file number `frame`; its folder is created if it is missing.
    ///
    /// # Errors
    /// The folder cannot be created.
    pub fn particles(&self, frame: u64) -> Result<PathBuf, OutputError> {
        Ok(self.below(PARTICLES)?.join(format!("frame_{frame:06}.vtp")))
    }

    /// The picture called `name` of instant `frame`; its folder is created if it is missing.
    /// Letters of `name` that do not suit a file name become `_`.
    ///
    /// # Errors
    /// The folder cannot be created.
    pub fn picture(&self, name: &str, frame: u64) -> Result<PathBuf, OutputError> {
        Ok(self.below(PICTURES)?.join(format!("{}_{frame:06}.png", file_name(name))))
    }

    /// The profile number `frame` along the line called `name`; its folder is created if it is missing.
    ///
    /// # Errors
    /// The folder cannot be created.
    pub fn profile(&self, name: &str, frame: u64) -> Result<PathBuf, OutputError> {
        Ok(self.below(PROFILES)?.join(format!("{}_{frame:06}.csv", file_name(name))))
    }

    /// The chart called `name`; its folder is created if it is missing. Letters of `name` that do
    /// not suit a file name become `_`.
    ///
    /// # Errors
    /// The folder cannot be created.
    pub fn plot(&self, name: &str) -> Result<PathBuf, OutputError> {
        Ok(self.below(PLOTS)?.join(format!("{}.png", file_name(name))))
    }

    /// The copy of reference curve `number` of the case, which came from a file called `name`; its
    /// folder is created if it is missing.
    ///
    /// # Errors
    /// The folder cannot be created.
    pub fn reference(&self, number: usize, name: &str) -> Result<PathBuf, OutputError> {
        Ok(self.below(REFERENCES)?.join(format!("{number}_{}", file_name(name))))
    }

    /// The page that shows the run.
    pub fn report(&self) -> PathBuf {
        self.path.join(REPORT)
    }

    /// The particle files that are there, in the order of their numbers.
    pub fn all_particles(&self) -> Vec<PathBuf> {
        self.numbered(PARTICLES, "vtp")
    }

    /// The profiles that are there, by name and number.
    pub fn all_profiles(&self) -> Vec<PathBuf> {
        self.numbered(PROFILES, "csv")
    }

    /// The newest profile of the line called `name`, if there is one.
    pub fn last_profile(&self, name: &str) -> Option<PathBuf> {
        let of_line = |path: &PathBuf| {
            let stem = path.file_stem().and_then(|stem| stem.to_str());
            stem.and_then(|stem| stem.rsplit_once('_')).is_some_and(|(start, _)| start == name)
        };
        self.all_profiles().into_iter().rfind(of_line)
    }

    /// The pictures that are there, by name and number.
    pub fn all_pictures(&self) -> Vec<PathBuf> {
        self.numbered(PICTURES, "png")
    }

    /// The plain files `NAME_NUMBER.ending` of a folder, sorted by name and number. A folder that
    /// cannot be read holds none.
    fn numbered(&self, folder: &str, ending: &str) -> Vec<PathBuf> {
        let path = self.path.join(folder);
        let mut found: Vec<(String, u64)> = names(&path)
            .unwrap_or_default()
            .iter()
            .filter(|name| is_known(folder, name))
            .filter_map(|name| {
                let (start, number) =
                    name.strip_suffix(ending)?.strip_suffix('.')?.rsplit_once('_')?;
                Some((start.to_owned(), number.parse().ok()?))
            })
            .collect();
        found.sort();
        let paths =
            found.iter().map(|(name, number)| path.join(format!("{name}_{number:06}.{ending}")));
        paths.filter(|path| fs::symlink_metadata(path).is_ok_and(|data| data.is_file())).collect()
    }

    /// The path of `file` of the record, relative to this folder; nothing if it would lead out.
    pub fn inside(&self, file: &str) -> Option<PathBuf> {
        Some(self.path.join(own(file)?))
    }

    /// `file` relative to this folder with `/` between its parts, as series and records name it.
    pub fn relative(&self, file: &Path) -> String {
        let inside = file.strip_prefix(&self.path).unwrap_or(file);
        let parts = inside.components().map(|part| part.as_os_str().to_string_lossy());
        parts.collect::<Vec<_>>().join("/")
    }

    fn below(&self, name: &str) -> Result<PathBuf, OutputError> {
        let folder = self.path.join(name);
        create_folder(&folder)?;
        Ok(folder)
    }

    /// Removes the files of an earlier run, but not its record, which the next one replaces.
    fn empty(&self) -> Result<(), OutputError> {
        if RunRecord::read(&self.record()).is_err() {
            // Temporary files are ours, whatever became of the record.
            let foreign = names(&self.path)?.into_iter().find(|name| !atomic::is_temporary(name));
            return foreign.map_or(Ok(()), |entry| {
                Err(OutputError::ForeignFolder { path: self.path.clone(), entry })
            });
        }
        for file in self.files_of_run()? {
            fs::remove_file(&file).map_err(|error| OutputError::from_io(&file, error))?;
        }
        Ok(())
    }

    /// The files that exist of those that the record lists and of those that have the name of an
    /// output file, without the record.
    fn files_of_run(&self) -> Result<Vec<PathBuf>, OutputError> {
        let record = RunRecord::read(&self.record()).unwrap_or_default();
        let mut files: BTreeSet<PathBuf> =
            record.files.iter().filter_map(|file| own(file)).collect();
        for folder in ["", PARTICLES, PICTURES, PROFILES, PLOTS, REFERENCES, CHECKPOINTS] {
            let path = self.path.join(folder);
            // A link could lead anywhere.
            if fs::symlink_metadata(&path).is_ok_and(|metadata| metadata.is_dir()) {
                let known = names(&path)?.into_iter().filter(|name| is_known(folder, name));
                files.extend(known.map(|name| Path::new(folder).join(name)));
            }
        }
        let is_plain = |path: &Path, wanted: fn(&fs::Metadata) -> bool| {
            fs::symlink_metadata(path).is_ok_and(|metadata| wanted(&metadata))
        };
        let exists = |path: &PathBuf| {
            let parent = path.parent().unwrap_or(&self.path);
            let reached = parent == self.path || is_plain(parent, fs::Metadata::is_dir);
            reached && is_plain(path, fs::Metadata::is_file)
        };
        Ok(files.into_iter().map(|file| self.path.join(file)).filter(exists).collect())
    }
}

/// Creates `path` and the folders above it.
fn create_folder(path: &Path) -> Result<(), OutputError> {
    fs::create_dir_all(path).map_err(|error| {
        let file = path.ancestors().find(|folder| folder.is_file());
        match file {
            Some(file) => OutputError::NotAFolder { path: file.into() },
            None => OutputError::from_io(path, error),
        }
    })
}

/// The names of what is in `folder`, in order.
fn names(folder: &Path) -> Result<Vec<String>, OutputError> {
    let fail = |error| OutputError::from_io(folder, error);
    let entries = fs::read_dir(folder).map_err(fail)?;
    let mut names = entries
        .map(|entry| Ok(entry?.file_name().to_string_lossy().into_owned()))
        .collect::<io::Result<Vec<String>>>()
        .map_err(fail)?;
    names.sort();
    Ok(names)
}

/// Whether a file of this name in this part of a results folder is one of ours.
fn is_known(folder: &str, name: &str) -> bool {
    let numbered = |end: &str| {
        let number = name.strip_suffix(end).and_then(|start| start.rsplit_once('_'));
        number.is_some_and(|(_, number)| {
            number.len() >= 6 && number.bytes().all(|digit| digit.is_ascii_digit())
        })
    };
    let by_name = match folder {
        "" => name == SERIES || name == REPORT || TABLES.contains(&name),
        PARTICLES => name.starts_with("frame_") && numbered(".vtp"),
        PICTURES => numbered(".png"),
        PROFILES => numbered(".csv"),
        CHECKPOINTS => is_checkpoint(name),
        _ => false,
    };
    by_name || atomic::is_temporary(name)
}

/// Whether this is the name of a checkpoint: with twelve digits they sort as their numbers do.
fn is_checkpoint(name: &str) -> bool {
    let number = name.strip_prefix(CHECKPOINT_START);
    number.is_some_and(|digits| {
        digits.len() == 12 && digits.bytes().all(|digit| digit.is_ascii_digit())
    })
}

/// A file of a record as a path inside the folder; nothing if it would lead out of it, or is the
/// record.
fn own(file: &str) -> Option<PathBuf> {
    let path = Path::new(file);
    let parts: Vec<Component> = path.components().collect();
    let inside = parts.iter().all(|part| matches!(part, Component::Normal(_)));
    ((1..=2).contains(&parts.len()) && inside && file != RECORD).then(|| path.into())
}

/// `name` as part of a file name on any system.
fn file_name(name: &str) -> String {
    const LONGEST: usize = 100;
    let suits = |letter: char| letter.is_ascii_alphanumeric() || "-_.".contains(letter);
    let mut text: String =
        name.chars().take(LONGEST).map(|letter| if suits(letter) { letter } else { '_' }).collect();
    if text.is_empty() || text.starts_with('.') {
        text.insert(0, '_');
    }
    text
}
