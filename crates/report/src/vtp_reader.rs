//! Particle files read back: those that [`vtp`](super::vtp) writes, and no others.
//!
//! Nothing in a file is believed. The description at its start is read up to a limit, an array has
//! to be as long as the number of particles asks for, and data are unpacked block by block through
//! a buffer of fixed size, of which only the wanted rows are kept. So a damaged or hostile file
//! costs no more memory than a sound one of its size, and ends in a [`ParticleFileError`].

use std::fs::File;
use std::io::{self, Read, Seek, SeekFrom};
use std::path::{Path, PathBuf};

use flate2::read::ZlibDecoder;
use roxmltree::{Document, Node};

/// Longest description in front of the data that is read, in bytes.
const MAX_HEADER: usize = 1 << 20;
/// Longest block of packed data in bytes.
const MAX_BLOCK: u64 = 1 << 24;
/// What zlib shortens data by at most, a little more than 1032.
const MAX_PACKING: u64 = 1100;

/// A particle file could not be read.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum ParticleFileError {
    /// The operating system refuses.
    #[error("cannot read {}: {source}", path.display())]
    Io {
        /// The file.
        path: PathBuf,
        /// What the operating system said.
        source: io::Error,
    },
    /// The file is not as piola writes it.
    #[error("{} is damaged: {what}", path.display())]
    Damaged {
        /// The file.
        path: PathBuf,
        /// What is wrong with it.
        what: String,
    },
}

/// One array of a particle file.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Array {
    /// Its name, for example `velocity`.
    pub name: String,
    /// Its SI unit, `1` for a pure number; empty if the file does not say.
    pub unit: String,
    /// Numbers a particle: 1, 3 or 9, whatever the dimension.
    pub components: usize,
    kind: NumberKind,
    offset: u64,
}

/// How a number is stored, least significant byte first.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum NumberKind {
    Float64,
    UInt32,
    UInt64,
}

impl NumberKind {
    fn from_name(name: &str) -> Option<Self> {
        match name {
            "Float64" => Some(Self::Float64),
            "UInt32" => Some(Self::UInt32),
            "UInt64" => Some(Self::UInt64),
            _ => None,
        }
    }

    fn bytes(self) -> usize {
        if self == Self::UInt32 { 4 } else { 8 }
    }

    /// The number in `bytes`, which are as many as [`bytes`](Self::bytes) says.
    fn read(self, bytes: &[u8]) -> f64 {
        let mut word = [0; 8];
        word[..bytes.len()].copy_from_slice(bytes);
        match self {
            Self::Float64 => f64::from_le_bytes(word),
            Self::UInt32 | Self::UInt64 => u64::from_le_bytes(word) as f64,
        }
    }
}

/// An open particle file.
#[derive(Debug)]
pub struct ParticleFile {
    path: PathBuf,
    file: File,
    length: u64,
    data: u64,
    packed: bool,
    /// Number of particles.
    pub count: usize,
    /// Simulated time in s, NaN if the file does not say.
    pub time: f64,
    /// The current positions, 3 components.
    pub points: Array,
    /// `id`, `body` and all fields.
    pub arrays: Vec<Array>,
}

impl ParticleFile {
    /// Opens the particle file `path` and reads what is in it.
    ///
    /// # Errors
    /// The file cannot be read, or is not as [`vtp::write`](super::vtp::write) makes it.
    pub fn open(path: &Path) -> Result<Self, ParticleFileError> {
        let fail = |source| ParticleFileError::Io { path: path.into(), source };
        let damaged = |what: String| ParticleFileError::Damaged { path: path.into(), what };
        let mut file = File::open(path).map_err(fail)?;
        let length = file.metadata().map_err(fail)?.len();
        let mut start = Vec::new();
        (&mut file).take(MAX_HEADER as u64).read_to_end(&mut start).map_err(fail)?;
        let data = start_of_data(&start)
            .ok_or_else(|| damaged("its description does not end before its data".into()))?;
        let text = std::str::from_utf8(&start[..data - 1])
            .map_err(|_| damaged("its description is not text".into()))?;
        let closed = format!("{text}</AppendedData></VTKFile>");
        let xml = Document::parse(&closed).map_err(|error| damaged(error.to_string()))?;
        let (description, time) = describe(&xml).map_err(damaged)?;
        let Description { packed, count, points, arrays } = description;
        // No sound file of this length holds more, so that nobody makes room for them.
        if (count as u64).saturating_mul(24) > length.saturating_mul(MAX_PACKING) {
            return Err(damaged(format!(
                "{length} bytes cannot hold the {count} particles it names"
            )));
        }
        let data = data as u64;
        let path = path.to_path_buf();
        let mut file =
            Self { path, file, length, data, packed, count, time: f64::NAN, points, arrays };
        if let Some(array) = time {
            let values = file.unpack(&array, 1, 1)?;
            file.time = values.first().copied().unwrap_or(f64::NAN);
        }
        Ok(file)
    }

    /// The array called `name`.
    pub fn array(&self, name: &str) -> Option<&Array> {
        self.arrays.iter().find(|array| array.name == name)
    }

    /// The numbers of the particles 0, `stride`, 2 `stride`, ..., all components of each.
    ///
    /// # Errors
    /// The file cannot be read, or the array is not as long as it should be.
    pub fn rows(&mut self, array: &Array, stride: usize) -> Result<Vec<f64>, ParticleFileError> {
        self.unpack(array, self.count, stride)
    }

    fn unpack(
        &mut self,
        array: &Array,
        count: usize,
        stride: usize,
    ) -> Result<Vec<f64>, ParticleFileError> {
        let mut rows = Rows::new(array, stride);
        let bytes = (count as u64).saturating_mul(rows.row as u64);
        let result = self.blocks(array.offset, bytes, &mut |block| rows.take(block));
        result.map_err(|error| match error.kind() {
            io::ErrorKind::InvalidData | io::ErrorKind::UnexpectedEof => {
                let what = format!("the array `{}`: {error}", array.name);
                ParticleFileError::Damaged { path: self.path.clone(), what }
            }
            _ => ParticleFileError::Io { path: self.path.clone(), source: error },
        })?;
        Ok(rows.values)
    }

    /// Gives the `expected` bytes at `offset` of the data to `sink`, in pieces.
    fn blocks(
        &mut self,
        offset: u64,
        expected: u64,
        sink: &mut dyn FnMut(&[u8]),
    ) -> io::Result<()> {
        let at = self.data.saturating_add(offset);
        let left = self.length.saturating_sub(at);
        self.file.seek(SeekFrom::Start(at.min(self.length)))?;
        if !self.packed {
            let length = self.word()?;
            if length != expected || length > left {
                return Err(invalid(format!("{length} bytes where {expected} are expected")));
            }
            return pieces(&mut (&mut self.file).take(expected), expected, sink);
        }
        let [count, block, last] = [self.word()?, self.word()?, self.word()?];
        let whole = expected.checked_div(block).unwrap_or(0);
        let rest = expected.checked_rem(block).unwrap_or(0);
        let fits = (1..=MAX_BLOCK).contains(&block)
            && count == whole + u64::from(rest > 0)
            && last == rest
            && count.saturating_mul(8) <= left
            && expected <= left.saturating_mul(MAX_PACKING);
        if !fits {
            let text = format!(
                "{count} blocks of {block} bytes in {left} bytes of file, where {expected} bytes \
                 are expected"
            );
            return Err(invalid(text));
        }
        // No more than the file holds: `count` was compared with it.
        let lengths = (0..count).map(|_| self.word()).collect::<io::Result<Vec<u64>>>()?;
        for (number, length) in (0_u64..).zip(lengths) {
            let size = if number == whole { rest } else { block };
            let next = self.file.stream_position()?.saturating_add(length);
            let mut unpacked = ZlibDecoder::new((&mut self.file).take(length));
            pieces(&mut unpacked, size, sink)?;
            self.file.seek(SeekFrom::Start(next))?;
        }
        Ok(())
    }

    fn word(&mut self) -> io::Result<u64> {
        let mut word = [0; 8];
        self.file.read_exact(&mut word)?;
        Ok(u64::from_le_bytes(word))
    }
}

/// Reads `length` bytes piece by piece.
fn pieces(from: &mut dyn Read, length: u64, sink: &mut dyn FnMut(&[u8])) -> io::Result<()> {
    let mut buffer = vec![0; 1 << 16];
    let mut left = length;
    while left > 0 {
        let size = left.min(buffer.len() as u64) as usize;
        from.read_exact(&mut buffer[..size])?;
        sink(&buffer[..size]);
        left -= size as u64;
    }
    Ok(())
}

fn invalid(text: String) -> io::Error {
    io::Error::new(io::ErrorKind::InvalidData, text)
}

/// Rows of an array that arrives in pieces, every `stride`-th kept.
struct Rows {
    kind: NumberKind,
    /// Bytes of a row.
    row: usize,
    stride: usize,
    /// Number of the next row.
    number: usize,
    /// The start of a row whose end is in the next piece.
    started: Vec<u8>,
    values: Vec<f64>,
}

impl Rows {
    fn new(array: &Array, stride: usize) -> Self {
        let row = array.components * array.kind.bytes();
        let stride = stride.max(1);
        Self { kind: array.kind, row, stride, number: 0, started: Vec::new(), values: Vec::new() }
    }

    fn take(&mut self, mut piece: &[u8]) {
        if !self.started.is_empty() {
            let missing = (self.row - self.started.len()).min(piece.len());
            self.started.extend_from_slice(&piece[..missing]);
            piece = &piece[missing..];
            if self.started.len() < self.row {
                return;
            }
            let row = std::mem::take(&mut self.started);
            self.push(&row);
        }
        let rows = piece.chunks_exact(self.row);
        self.started.extend_from_slice(rows.remainder());
        rows.for_each(|row| self.push(row));
    }

    fn push(&mut self, row: &[u8]) {
        if self.number.is_multiple_of(self.stride) {
            let numbers = row.chunks_exact(self.kind.bytes());
            self.values.extend(numbers.map(|bytes| self.kind.read(bytes)));
        }
        self.number += 1;
    }
}

/// What the text in front of the data says.
struct Description {
    packed: bool,
    count: usize,
    points: Array,
    arrays: Vec<Array>,
}

/// The place after the underscore that starts the data.
fn start_of_data(start: &[u8]) -> Option<usize> {
    let find = |from: usize, text: &[u8]| {
        let found = start[from..].windows(text.len()).position(|part| part == text);
        found.map(|place| from + place + text.len())
    };
    find(find(0, b"<AppendedData encoding=\"raw\">")?, b"_")
}

/// The description, and the array of the time.
fn describe(xml: &Document) -> Result<(Description, Option<Array>), String> {
    let root = xml.root_element();
    let is = |name: &str, value: &str| root.attribute(name) == Some(value);
    let ours = is("type", "PolyData")
        && is("byte_order", "LittleEndian")
        && is("header_type", "UInt64")
        && [None, Some("vtkZLibDataCompressor")].contains(&root.attribute("compressor"));
    if !ours {
        return Err("it is not a particle file of piola".into());
    }
    let piece = child(root, "PolyData").and_then(|data| child(data, "Piece"));
    let piece = piece.ok_or("it holds no piece of particles")?;
    let count = piece.attribute("NumberOfPoints").and_then(|text| text.parse::<u32>().ok());
    let count = count.ok_or("it does not say how many particles it holds")?;
    let points = child(piece, "Points").map(arrays).transpose()?.unwrap_or_default();
    let [points] = <[Array; 1]>::try_from(points).map_err(|_| "it holds no positions")?;
    if points.components != 3 {
        return Err(format!("its positions have {} components instead of 3", points.components));
    }
    let data = child(piece, "PointData").map(arrays).transpose()?.unwrap_or_default();
    let whole = child(root, "PolyData").and_then(|data| child(data, "FieldData"));
    let whole = whole.map(arrays).transpose()?.unwrap_or_default();
    let time = whole.into_iter().find(|array| array.name == "TimeValue" && array.components == 1);
    let packed = root.attribute("compressor").is_some();
    Ok((Description { packed, count: count as usize, points, arrays: data }, time))
}

fn child<'a, 'input>(node: Node<'a, 'input>, name: &str) -> Option<Node<'a, 'input>> {
    node.children().find(|child| child.has_tag_name(name))
}

fn arrays(parent: Node) -> Result<Vec<Array>, String> {
    parent.children().filter(|node| node.has_tag_name("DataArray")).map(array).collect()
}

fn array(node: Node) -> Result<Array, String> {
    let name = node.attribute("Name").unwrap_or_default().to_owned();
    let wrong = |what: &str| format!("the array `{name}` has no {what} that piola writes");
    let kind = node.attribute("type").and_then(NumberKind::from_name);
    let kind = kind.ok_or_else(|| wrong("type of number"))?;
    let components = node.attribute("NumberOfComponents").unwrap_or("1").parse();
    let components = components.ok().filter(|number| [1, 3, 9].contains(number));
    let components = components.ok_or_else(|| wrong("number of components"))?;
    let offset = node.attribute("offset").and_then(|text| text.parse().ok());
    let offset = offset.ok_or_else(|| wrong("place"))?;
    let unit = child(node, "InformationKey").and_then(|key| key.text()).unwrap_or_default();
    Ok(Array { unit: unit.to_owned(), components, kind, offset, name })
}
