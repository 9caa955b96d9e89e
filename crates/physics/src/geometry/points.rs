//! Particles from a file of points.

use std::collections::HashMap;
use std::collections::hash_map::Entry;
use std::fmt;
use std::io;
use std::path::{Path, PathBuf};

use csv::{ByteRecord, ReaderBuilder, Trim};
use thiserror::Error;

use super::file::{FileFault, MOST_BYTES, read};
use super::{GeometryError, Particles};
use crate::Vector;
use crate::coordinates;

/// Why a file of points cannot be used, and where.
#[derive(Debug, Error)]
#[error("{}{}: {fault}", file.display(), Place(*line, *column))]
pub struct PointsError {
    /// The file.
    pub file: PathBuf,
    /// The line, counted from 1, where the fault is on one.
    pub line: Option<u64>,
    /// The column, where the fault is in one.
    pub column: Option<&'static str>,
    /// What is wrong.
    pub fault: PointsFault,
}

struct Place(Option<u64>, Option<&'static str>);

impl fmt::Display for Place {
    fn fmt(&self, text: &mut fmt::Formatter<'_>) -> fmt::Result {
        self.0.map_or(Ok(()), |line| write!(text, ", line {line}"))?;
        self.1.map_or(Ok(()), |column| write!(text, ", column {column}"))
    }
}

/// What can be wrong with a file of points.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum PointsFault {
    /// The system refuses to read it.
    #[error("cannot be read: {0}")]
    Unreadable(#[from] io::Error),
    /// It is a folder or a device.
    #[error("is not a file")]
    NotAFile,
    /// There is more than can be turned into particles.
    #[error("is larger than {} bytes, expected fewer points", MOST_BYTES)]
    TooLarge,
    /// There is nothing in it.
    #[error("holds no points, expected a header and one line per point")]
    Empty,
    /// The first line does not name the columns.
    #[error("the header is `{got}`, expected `{expected}`")]
    Header {
        /// The start of the line.
        got: String,
        /// The names of the columns.
        expected: String,
    },
    /// A line has too few or too many fields.
    #[error("{got} fields, expected {expected}")]
    Ragged {
        /// Number of fields.
        got: usize,
        /// Number of columns.
        expected: usize,
    },
    /// A field is not text.
    #[error("bytes that are not UTF-8, expected a number")]
    NotText,
    /// A field is not a number.
    #[error("`{got}` is not a number")]
    NotANumber {
        /// The start of the field.
        got: String,
    },
    /// A number is NaN or infinite.
    #[error("{got} is not finite")]
    NotFinite {
        /// The number.
        got: f64,
    },
    /// A volume is not positive.
    #[error("a volume of {got}, expected a number above 0")]
    NotPositive {
        /// The volume.
        got: f64,
    },
    /// A point occurs twice.
    #[error(
        "the point {at} is already on line {line}, expected each point once",
        at = coordinates(point)
    )]
    Duplicate {
        /// Its coordinates.
        point: Vec<f64>,
        /// The line on which it was first.
        line: u64,
    },
}

impl From<FileFault> for PointsFault {
    fn from(fault: FileFault) -> Self {
        match fault {
            FileFault::Unreadable(error) => Self::Unreadable(error),
            FileFault::NotAFile => Self::NotAFile,
            FileFault::TooLarge => Self::TooLarge,
        }
    }
}

/// Reads particles from a CSV file with a header and the columns `x`, `y`, `z` (as many as there
/// are dimensions) in m and `volume` in m^D.
///
/// The volume of a point is both quadrature volume and kernel weight, and its spacing the edge of
/// a cube of this volume. Blank lines are skipped.
///
/// # Errors
/// [`GeometryError::Points`] with the first fault of the file.
#[inline(never)]
pub fn from_points<const D: usize>(path: &Path) -> Result<Particles<D>, GeometryError> {
    let refuse = |fault| PointsError { file: path.into(), line: None, column: None, fault };
    let bytes = read(path).map_err(|fault| refuse(fault.into()))?;
    let particles = parse(&bytes).map_err(|(line, column, fault)| PointsError {
        file: path.into(),
        line: Some(line),
        column,
        fault,
    })?;
    if particles.is_empty() {
        return Err(refuse(PointsFault::Empty).into());
    }
    Ok(particles)
}

type Fault = (u64, Option<&'static str>, PointsFault);

fn parse<const D: usize>(bytes: &[u8]) -> Result<Particles<D>, Fault> {
    let mut columns = ["x", "y", "z"][..D].to_vec();
    columns.push("volume");
    let mut reader =
        ReaderBuilder::new().has_headers(false).flexible(true).trim(Trim::All).from_reader(bytes);
    let mut lines = Lines { bytes, at: 0, line: 1 };
    let mut record = ByteRecord::new();
    let mut particles = Particles::default();
    let mut known = HashMap::new();
    let mut header = true;
    let mut read = |record: &mut ByteRecord| match reader.read_byte_record(record) {
        Ok(more) => Ok(more),
        Err(error) => Err((reader.position().line(), None, PointsFault::Unreadable(error.into()))),
    };
    while read(&mut record)? {
        if record.len() == 1 && record[0].is_empty() {
            continue;
        }
        let line = lines.of(record.position().map_or(0, |position| position.byte() as usize));
        if header {
            check_header(&record, &columns).map_err(|fault| (line, None, fault))?;
            header = false;
            continue;
        }
        if record.len() != columns.len() {
            let (got, expected) = (record.len(), columns.len());
            return Err((line, None, PointsFault::Ragged { got, expected }));
        }
        let mut position = Vector::<D>::zeros();
        let mut volume = 0.0;
        for (place, (field, column)) in record.iter().zip(&columns).enumerate() {
            let value = number(field).map_err(|fault| (line, Some(*column), fault))?;
            *position.get_mut(place).unwrap_or(&mut volume) = value;
        }
        if !(volume > 0.0) {
            return Err((line, Some("volume"), PointsFault::NotPositive { got: volume }));
        }
        match known.entry(position.map(place)) {
            Entry::Vacant(free) => free.insert(line),
            Entry::Occupied(first) => {
                let (point, first) = (position.as_slice().to_vec(), *first.get());
                return Err((line, None, PointsFault::Duplicate { point, line: first }));
            }
        };
        push(&mut particles, position, volume);
    }
    Ok(particles)
}

/// A coordinate as what tells places apart. Adding 0 turns -0 into 0, which is the same place.
pub(super) fn place(x: f64) -> u64 {
    (x + 0.0).to_bits()
}

/// Appends a particle with the volume of a point.
pub(super) fn push<const D: usize>(particles: &mut Particles<D>, position: Vector<D>, volume: f64) {
    particles.id.push(particles.len() as u32);
    particles.position.push(position);
    particles.volume.push(volume);
    particles.weight.push(volume);
    particles.spacing.push(match D {
        1 => volume,
        2 => volume.sqrt(),
        _ => volume.cbrt(),
    });
    particles.body.push(0);
}

fn check_header(record: &ByteRecord, columns: &[&str]) -> Result<(), PointsFault> {
    let same = |(field, column): (&[u8], &&str)| field.eq_ignore_ascii_case(column.as_bytes());
    if record.len() == columns.len() && record.iter().zip(columns).all(same) {
        return Ok(());
    }
    let fields: Vec<_> = record.iter().map(String::from_utf8_lossy).collect();
    Err(PointsFault::Header { got: start(&fields.join(",")), expected: columns.join(",") })
}

fn number(field: &[u8]) -> Result<f64, PointsFault> {
    let text = str::from_utf8(field).map_err(|_| PointsFault::NotText)?;
    let not_a_number = |_| PointsFault::NotANumber { got: start(text) };
    let got: f64 = text.parse().map_err(not_a_number)?;
    if got.is_finite() { Ok(got) } else { Err(PointsFault::NotFinite { got }) }
}

/// Enough of a text to recognise it by.
fn start(text: &str) -> String {
    text.chars().take(40).collect()
}

/// Counts lines up to ascending places in a file. The reader's own count is that of the end of
/// the record before, ahead of blank lines.
struct Lines<'a> {
    bytes: &'a [u8],
    at: usize,
    line: u64,
}

impl Lines<'_> {
    /// The line of the first record at or after byte `start`.
    fn of(&mut self, start: usize) -> u64 {
        while let Some(&byte) = self.bytes.get(self.at)
            && (self.at < start || byte.is_ascii_whitespace())
        {
            self.line += u64::from(byte == b'\n');
            self.at += 1;
        }
        self.line
    }
}
