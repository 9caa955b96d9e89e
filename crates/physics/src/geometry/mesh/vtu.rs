//! Unstructured grids in VTK's XML format: text, base64 and raw data, plain or by zlib.

use std::io::Read;

use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use flate2::read::ZlibDecoder;
use roxmltree::{Document, Node};

use super::vtk::add_cells;
use super::{Fault, Mesh, MeshFault};

/// Longest stretch of packed data in bytes.
const MOST_BLOCK: usize = 1 << 28;

pub(super) fn parse(bytes: &[u8]) -> Result<Mesh, Fault> {
    // Raw data are no XML: the text ends where they start.
    let (text, raw) = match start_of_raw(bytes) {
        Some(start) => (&bytes[..start], Some(&bytes[start..])),
        None => (bytes, None),
    };
    let not_text = |_| (None, MeshFault::NotAMesh);
    let mut text = str::from_utf8(text).map_err(not_text)?.to_owned();
    if raw.is_some() {
        text.push_str("</AppendedData></VTKFile>");
    }
    let xml = Document::parse(&text).map_err(|error| {
        let line = Some(u64::from(error.pos().row));
        (line, MeshFault::Unsupported { what: format!("its XML ({error})"), help: "mend it" })
    })?;
    let root = xml.root_element();
    if root.tag_name().name() != "VTKFile" {
        return Err((None, MeshFault::NotAMesh));
    }
    let unsupported = |what: String, help| Err((None, MeshFault::Unsupported { what, help }));
    if root.attribute("type") != Some("UnstructuredGrid") {
        let kind = root.attribute("type").unwrap_or("no type");
        return unsupported(format!("a VTK file of {kind}"), "write an unstructured grid");
    }
    if root.attribute("byte_order") == Some("BigEndian") {
        return unsupported("a big-endian file".into(), "write LittleEndian");
    }
    let packing = match root.attribute("compressor") {
        None => false,
        Some("vtkZLibDataCompressor") => true,
        Some(other) => {
            let help = "write it with zlib or without compression";
            return unsupported(format!("data packed by {other}"), help);
        }
    };
    let grid = child(root, "UnstructuredGrid")?;
    let pieces = grid.children().filter(|node| node.has_tag_name("Piece")).count();
    if pieces > 1 {
        return unsupported(format!("a grid in {pieces} pieces"), "merge them into one");
    }
    let appended = root.children().find(|node| node.has_tag_name("AppendedData"));
    let appended = match (raw, appended) {
        (Some(raw), _) => Some(raw.to_vec()),
        (None, Some(node)) => {
            Some(node.text().unwrap_or_default().trim().trim_start_matches('_').into())
        }
        (None, None) => None,
    };
    let wide = root.attribute("header_type") == Some("UInt64");
    let is_raw = raw.is_some();
    let unpacker = Unpacker { wide, packing, is_raw, appended: appended.unwrap_or_default() };
    mesh(child(grid, "Piece")?, &unpacker)
}

/// The place after the underscore from which raw data stand.
fn start_of_raw(bytes: &[u8]) -> Option<usize> {
    let find = |from: usize, text: &[u8]| {
        let found = bytes[from..].windows(text.len()).position(|part| part == text);
        found.map(|place| from + place + text.len())
    };
    let section = find(0, b"<AppendedData")?;
    let end = find(section, b">")?;
    let is_raw = bytes[section..end].windows(3).any(|part| part == b"raw");
    if is_raw { find(end, b"_") } else { None }
}

fn mesh(piece: Node<'_, '_>, unpacker: &Unpacker) -> Result<Mesh, Fault> {
    let mut mesh = Mesh::default();
    let points = child(child(piece, "Points")?, "DataArray")?;
    let places = unpacker.values(points)?;
    if points.attribute("NumberOfComponents").unwrap_or("3") != "3" || places.len() % 3 != 0 {
        let what = "the array of points".to_owned();
        let fault = MeshFault::Count { what, got: places.len(), expected: places.len() / 3 * 3 };
        return Err((line(points), fault));
    }
    if let Some(x) = places.iter().find(|x| !x.is_finite()) {
        let expected = "a coordinate";
        return Err((line(points), MeshFault::Unexpected { got: x.to_string(), expected }));
    }
    mesh.nodes = places.as_chunks::<3>().0.to_vec();
    let cells = child(piece, "Cells")?;
    let named = |name: &str| {
        let is_it = |node: &Node<'_, '_>| node.attribute("Name") == Some(name);
        let found = cells.children().find(is_it);
        let missing = || (line(cells), MeshFault::Missing { what: format!("array `{name}`") });
        unpacker.values(found.ok_or_else(missing)?)
    };
    let ends: Vec<usize> = named("offsets")?.iter().map(|end| *end as usize).collect();
    let kinds: Vec<u64> = named("types")?.iter().map(|kind| *kind as u64).collect();
    add_cells(&mut mesh, &ends, &named("connectivity")?, &kinds, None)?;
    for (section, of_cells) in [("PointData", false), ("CellData", true)] {
        let arrays = child(piece, section).map(|node| node.children()).into_iter().flatten();
        for array in arrays.filter(|node| node.has_tag_name("DataArray")) {
            let is_text = array.attribute("type") == Some("String");
            if is_text || array.attribute("NumberOfComponents").unwrap_or("1") != "1" {
                continue;
            }
            let name = array.attribute("Name").unwrap_or_default();
            let values = unpacker.values(array)?;
            let expected = if of_cells { mesh.cells.len() } else { mesh.nodes.len() };
            if values.len() != expected {
                let (what, got) = (format!("the array `{name}`"), values.len());
                return Err((line(array), MeshFault::Count { what, got, expected }));
            }
            mesh.add_data(name, values, of_cells);
        }
    }
    Ok(mesh)
}

fn line(node: Node<'_, '_>) -> Option<u64> {
    Some(u64::from(node.document().text_pos_at(node.range().start).row))
}

fn child<'a, 'i>(parent: Node<'a, 'i>, name: &str) -> Result<Node<'a, 'i>, Fault> {
    let found = parent.children().find(|node| node.has_tag_name(name));
    found.ok_or_else(|| (line(parent), MeshFault::Missing { what: format!("element <{name}>") }))
}

/// How data stand in the file.
struct Unpacker {
    /// Whether lengths have 8 bytes, not 4.
    wide: bool,
    packing: bool,
    is_raw: bool,
    /// Data behind the description.
    appended: Vec<u8>,
}

impl Unpacker {
    /// The numbers of an array.
    fn values(&self, array: Node<'_, '_>) -> Result<Vec<f64>, Fault> {
        let name = array.attribute("Name").unwrap_or("points");
        let what = || format!("the array `{name}`");
        let fault = |why: String| (line(array), MeshFault::Packed { what: what(), why });
        let kind = array.attribute("type").unwrap_or_default();
        let text = array.text().unwrap_or_default();
        let bytes = match array.attribute("format") {
            Some("ascii") | None => {
                let read = |word: &str| {
                    word.parse::<f64>().map_err(|_| {
                        let got = word.chars().take(40).collect();
                        (line(array), MeshFault::Unexpected { got, expected: "a number" })
                    })
                };
                return text.split_ascii_whitespace().map(read).collect();
            }
            Some("binary") => self.unpack(&unbase64(text.as_bytes()).map_err(fault)?),
            Some("appended") => {
                let offset = array.attribute("offset").and_then(|text| text.parse().ok());
                let rest = offset.and_then(|offset: usize| self.appended.get(offset..));
                let rest = rest.ok_or_else(|| fault("its offset is beyond the data".into()))?;
                match self.is_raw {
                    true => self.unpack(rest),
                    false => self.unpack(&unbase64(rest).map_err(fault)?),
                }
            }
            Some(other) => Err(format!("its format `{other}` is not known")),
        };
        let bytes = bytes.map_err(fault)?;
        numbers(kind, &bytes).ok_or_else(|| fault(format!("numbers of type `{kind}`")))
    }

    /// The bytes of an array behind their lengths.
    fn unpack(&self, bytes: &[u8]) -> Result<Vec<u8>, String> {
        let size = if self.wide { 8 } else { 4 };
        let word = |number: usize| -> Result<usize, String> {
            let own = bytes.get(number.saturating_mul(size)..).and_then(|rest| rest.get(..size));
            let own = own.ok_or("it ends within its lengths")?;
            let mut wide = [0; 8];
            wide[..size].copy_from_slice(own);
            usize::try_from(u64::from_le_bytes(wide)).map_err(|_| "it is too long".to_owned())
        };
        let short = || "it is shorter than it says".to_owned();
        if !self.packing {
            let rest = &bytes[size.min(bytes.len())..];
            return Ok(rest.get(..word(0)?).ok_or_else(short)?.to_vec());
        }
        let (count, block, last) = (word(0)?, word(1)?, word(2)?);
        if count > bytes.len() || block > MOST_BLOCK || last > block {
            return Err("its lengths contradict each other".into());
        }
        let mut at = (3 + count) * size;
        let mut all = Vec::new();
        for number in 0..count {
            let length = word(3 + number)?;
            let own = bytes.get(at..).and_then(|rest| rest.get(..length)).ok_or_else(short)?;
            let wanted = if number + 1 == count && last > 0 { last } else { block };
            let before = all.len();
            let mut unpacked = ZlibDecoder::new(own).take(wanted as u64);
            unpacked.read_to_end(&mut all).map_err(|error| error.to_string())?;
            if all.len() - before != wanted {
                return Err(short());
            }
            at += length;
        }
        Ok(all)
    }
}

/// Bytes in base64, in which lengths may have been closed by themselves.
fn unbase64(text: &[u8]) -> Result<Vec<u8>, String> {
    let letters: Vec<u8> =
        text.iter().copied().filter(|byte| !byte.is_ascii_whitespace()).collect();
    let mut bytes = Vec::new();
    let mut start = 0;
    while start < letters.len() {
        let closing = letters[start..].iter().position(|byte| *byte == b'=');
        let end = closing.map_or(letters.len(), |place| start + place / 4 * 4 + 4);
        let end = end.min(letters.len());
        STANDARD.decode_vec(&letters[start..end], &mut bytes).map_err(|error| error.to_string())?;
        start = end;
    }
    Ok(bytes)
}

/// Numbers of a type of VTK, least significant byte first.
fn numbers(kind: &str, bytes: &[u8]) -> Option<Vec<f64>> {
    macro_rules! read {
        ($number:ty) => {{
            let (numbers, rest) = bytes.as_chunks::<{ size_of::<$number>() }>();
            rest.is_empty().then(|| {
                numbers.iter().map(|bytes| <$number>::from_le_bytes(*bytes) as f64).collect()
            })
        }};
    }
    match kind {
        "Float64" => read!(f64),
        "Float32" => read!(f32),
        "Int8" => read!(i8),
        "UInt8" => read!(u8),
        "Int16" => read!(i16),
        "UInt16" => read!(u16),
        "Int32" => read!(i32),
        "UInt32" => read!(u32),
        "Int64" => read!(i64),
        "UInt64" => read!(u64),
        _ => None,
    }
}
