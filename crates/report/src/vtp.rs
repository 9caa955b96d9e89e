//! Particle files for ParaView: VTK XML PolyData (`.vtp`) with appended raw data.
//!
//! The format is that of the VTK XML file formats page,
//! <https://docs.vtk.org/en/latest/vtk_file_formats/vtkxml_file_format.html>. VTK knows three
//! dimensions only: positions and vectors of lower dimensions are padded with zeros to 3
//! components, tensors with zeros to 9 (also on the diagonal: a deformation gradient in 2D has no
//! 1 at zz). Each particle is a vertex, so that ParaView shows it and filters can pick it. Units
//! stand in VTK's own `UNITS_LABEL` key of each array, so that names stay plain.

use std::fmt::Write as _;
use std::io::{self, Write};
use std::path::Path;

use flate2::write::ZlibEncoder;
use rayon::prelude::*;

use super::{OutputError, atomic};
use piola_physics::fields::{FieldKind, Snapshot};

/// Bytes of one compressed block. Blocks are compressed side by side, and a reader inflates only
/// those it needs.
const BLOCK: usize = 1 << 17;

/// How the data of a particle file are packed.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Compression {
    /// As they are in memory: fastest to write, largest.
    None,
    /// Blocks packed by zlib at its fastest level, without loss.
    #[default]
    Zlib,
}

/// Writes `snapshot` to the file `path` and returns its length in bytes.
///
/// Arrays: the points; `id` (the number of the particle as geometry made it) and `body`; all
/// fields; `TimeValue` in s and `step` for the whole file.
///
/// # Errors
/// The file cannot be written, or the lengths in `snapshot` contradict each other.
pub fn write(
    path: &Path,
    snapshot: &Snapshot,
    compression: Compression,
) -> Result<u64, OutputError> {
    check(path, snapshot)?;
    let (header, blobs) = layout(snapshot, compression);
    atomic::write_file(path, |out| {
        out.write_all(header.as_bytes())?;
        for blob in &blobs {
            out.write_all(blob)?;
        }
        out.write_all(b"\n  </AppendedData>\n</VTKFile>\n")
    })
}

/// Refuses a snapshot whose lengths contradict each other.
fn check(path: &Path, snapshot: &Snapshot) -> Result<(), OutputError> {
    let (count, dimension) = (snapshot.len(), snapshot.dimension);
    if !(1..=3).contains(&dimension) {
        return Err(OutputError::WrongDimension { path: path.into(), got: dimension });
    }
    let fits = |what: String, expected: usize, got: usize| {
        if expected == got {
            return Ok(());
        }
        Err(OutputError::WrongLength { path: path.into(), what, expected, got })
    };
    fits("the array of positions".into(), count * dimension, snapshot.positions.len())?;
    fits("the array of bodies".into(), count, snapshot.bodies.len())?;
    snapshot.fields.iter().try_for_each(|field| {
        let expected = count * field.description.kind.components(dimension);
        fits(format!("the field {}", field.description.name), expected, field.values.len())
    })
}

/// The XML part up to the underscore that starts the appended data, and those data.
fn layout(snapshot: &Snapshot, compression: Compression) -> (String, Vec<Vec<u8>>) {
    let (count, dimension) = (snapshot.len(), snapshot.dimension);
    let mut arrays = Arrays { compression, offset: 0, blobs: Vec::new() };
    let compressor = match compression {
        Compression::None => "",
        Compression::Zlib => " compressor=\"vtkZLibDataCompressor\"",
    };
    let mut xml = format!(
        "<?xml version=\"1.0\"?>\n\
         <VTKFile type=\"PolyData\" version=\"1.0\" byte_order=\"LittleEndian\" \
         header_type=\"UInt64\"{compressor}>\n  <PolyData>\n    <FieldData>\n"
    );
    let one = " NumberOfTuples=\"1\"";
    xml += &arrays.add("Float64", "TimeValue", one, "s", snapshot.time.to_le_bytes().to_vec());
    xml += &arrays.add("UInt64", "step", one, "", snapshot.step.to_le_bytes().to_vec());
    // Writing into a String cannot fail.
    let _ = write!(
        xml,
        "    </FieldData>\n    <Piece NumberOfPoints=\"{count}\" NumberOfVerts=\"{count}\" \
         NumberOfLines=\"0\" NumberOfStrips=\"0\" NumberOfPolys=\"0\">\n      <PointData>\n"
    );
    xml += &arrays.add("UInt32", "id", "", "", bytes_of_integers(&snapshot.ids));
    xml += &arrays.add("UInt32", "body", "", "", bytes_of_integers(&snapshot.bodies));
    for field in &snapshot.fields {
        let components = match field.description.kind {
            FieldKind::Scalar => "",
            FieldKind::Vector => " NumberOfComponents=\"3\"",
            FieldKind::Tensor => " NumberOfComponents=\"9\"",
            FieldKind::Symmetric => " NumberOfComponents=\"6\"",
        };
        let data = padded_bytes(&field.values, field.description.kind, dimension);
        let (name, unit) = (field.description.name, field.description.unit);
        xml += &arrays.add("Float64", name, components, unit, data);
    }
    xml += "      </PointData>\n      <Points>\n";
    let points = padded_bytes(&snapshot.positions, FieldKind::Vector, dimension);
    xml += &arrays.add("Float64", "Points", " NumberOfComponents=\"3\"", "m", points);
    xml += "      </Points>\n      <Verts>\n";
    let numbers: Vec<u32> = (0..=count as u32).collect();
    xml += &arrays.add("UInt32", "connectivity", "", "", bytes_of_integers(&numbers[..count]));
    xml += &arrays.add("UInt32", "offsets", "", "", bytes_of_integers(&numbers[1..]));
    xml += "      </Verts>\n    </Piece>\n  </PolyData>\n  <AppendedData encoding=\"raw\">\n   _";
    (xml, arrays.blobs)
}

/// The arrays laid out so far.
struct Arrays {
    compression: Compression,
    offset: usize,
    blobs: Vec<Vec<u8>>,
}

impl Arrays {
    /// Packs `data` and returns the element that describes them.
    fn add(&mut self, kind: &str, name: &str, shape: &str, unit: &str, data: Vec<u8>) -> String {
        let element = format!(
            "        <DataArray type=\"{kind}\" Name=\"{}\"{shape} format=\"appended\" \
             offset=\"{}\"",
            escape(name),
            self.offset
        );
        let blob = match self.compression {
            Compression::None => with_length(&data),
            Compression::Zlib => zlib_blocks(&data),
        };
        self.offset += blob.len();
        self.blobs.push(blob);
        if unit.is_empty() {
            return element + "/>\n";
        }
        format!(
            "{element}>\n          <InformationKey name=\"UNITS_LABEL\" \
             location=\"vtkDataArray\">{}</InformationKey>\n        </DataArray>\n",
            escape(unit)
        )
    }
}

/// Uncompressed data as VTK expects them: their length in bytes, then they.
fn with_length(data: &[u8]) -> Vec<u8> {
    [&(data.len() as u64).to_le_bytes(), data].concat()
}

/// Compressed data as VTK expects them: number of blocks, length of a block, length of the last
/// one if it is shorter (else 0), packed length of each, then the packed blocks.
fn zlib_blocks(data: &[u8]) -> Vec<u8> {
    let pack = |block: &[u8]| -> io::Result<Vec<u8>> {
        let mut encoder = ZlibEncoder::new(Vec::new(), flate2::Compression::new(1));
        encoder.write_all(block)?;
        encoder.finish()
    };
    let packed: Vec<Vec<u8>> = data
        .par_chunks(BLOCK)
        .map(|block| pack(block).expect("writing into memory cannot fail"))
        .collect();
    let lengths = [packed.len(), BLOCK, data.len() % BLOCK];
    let mut blob = Vec::new();
    for length in lengths.into_iter().chain(packed.iter().map(Vec::len)) {
        blob.extend_from_slice(&(length as u64).to_le_bytes());
    }
    blob.extend(packed.concat());
    blob
}

fn bytes_of_integers(values: &[u32]) -> Vec<u8> {
    values.iter().flat_map(|value| value.to_le_bytes()).collect()
}

/// Values with the components of three dimensions, the missing ones zero.
fn padded_bytes(values: &[f64], kind: FieldKind, dimension: usize) -> Vec<u8> {
    if matches!(kind, FieldKind::Scalar | FieldKind::Symmetric) || dimension == 3 {
        return values.iter().flat_map(|value| value.to_le_bytes()).collect();
    }
    let rows_of_one = if kind == FieldKind::Tensor { 3 } else { 1 };
    let components = kind.components(dimension);
    let mut bytes = vec![0; values.len() / components * 3 * rows_of_one * 8];
    for (from, to) in values.chunks(components).zip(bytes.chunks_mut(3 * rows_of_one * 8)) {
        for (from, to) in from.chunks(dimension).zip(to.chunks_mut(3 * 8)) {
            for (value, place) in from.iter().zip(to.chunks_mut(8)) {
                place.copy_from_slice(&value.to_le_bytes());
            }
        }
    }
    bytes
}

/// `text` with the characters replaced that mean something else in XML.
pub(super) fn escape(text: &str) -> String {
    text.replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;").replace('"', "&quot;")
}
