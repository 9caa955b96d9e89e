//! Files of facets.

use std::io::Cursor;
use std::path::{Path, PathBuf};

use ply_rs_bw::parser::{Parser, Reader};
use ply_rs_bw::ply::{DefaultElement, Property};
use thiserror::Error;

use super::super::file;
use super::Triangle;
use crate::Vector;

/// Bytes of a binary STL before its facets, and of each facet.
const STL_HEAD: usize = 84;
const STL_FACET: usize = 50;

/// A file that is no surface.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum SurfaceError {
    /// It cannot be read.
    #[error("`{}` cannot be read: {reason}", path.display())]
    Unreadable {
        /// The file.
        path: PathBuf,
        /// Why.
        reason: String,
    },
    /// The end of its name is of no kind that is known.
    #[error("`{}` is of an unknown kind, expected a file name that ends with `.stl`, `.obj` or `.ply`", path.display())]
    Kind {
        /// The file.
        path: PathBuf,
    },
    /// It is not what the end of its name says.
    #[error("`{}` is broken: {reason}; export it again, as triangles", path.display())]
    Broken {
        /// The file.
        path: PathBuf,
        /// What is wrong.
        reason: String,
    },
    /// A corner is no place.
    #[error("a corner of facet {facet} is at {corner:?}, expected finite coordinates")]
    NotFinite {
        /// Number of the facet, from 1.
        facet: usize,
        /// The corner.
        corner: [f64; 3],
    },
    /// Nothing is left.
    #[error("there are no facets with an area")]
    NoFacets,
}

/// The triangles of a file.
pub(super) fn triangles(path: &Path) -> Result<Vec<Triangle>, SurfaceError> {
    let path_of = || path.to_owned();
    let end = path.extension().map(|end| end.to_ascii_lowercase());
    let parse = match end.as_ref().and_then(|end| end.to_str()) {
        Some("stl") => stl,
        Some("obj") => obj,
        Some("ply") => ply,
        _ => return Err(SurfaceError::Kind { path: path_of() }),
    };
    let bytes = file::read(path)
        .map_err(|fault| SurfaceError::Unreadable { path: path_of(), reason: fault.to_string() })?;
    parse(bytes).map_err(|reason| SurfaceError::Broken { path: path_of(), reason })
}

/// A file of the length that its number of facets says is binary, whatever it begins with; one whose first word is `solid`, and
/// whose second line has a facet, is text.
fn stl(mut bytes: Vec<u8>) -> Result<Vec<Triangle>, String> {
    let count = bytes.get(STL_HEAD - 4..STL_HEAD).and_then(|it| it.try_into().ok());
    let count = count.map(u32::from_le_bytes).unwrap_or_default() as usize;
    if bytes.len() == STL_HEAD + STL_FACET * count {
        // The reader takes what begins with `solid` for text.
        bytes[..5].copy_from_slice(b"     ");
    } else if let Some(text) = plain(&bytes) {
        bytes = text.into_bytes();
    } else {
        let facets = bytes.len().saturating_sub(STL_HEAD) as f64 / STL_FACET as f64;
        return Err(format!(
            "it is not text that begins with `solid` and a facet, and has room for {facets} facets \
             where a binary file would have {count}"
        ));
    }
    let mut source = Cursor::new(bytes);
    let facets = stl_io::create_stl_reader(&mut source).map_err(|error| error.to_string())?;
    let corner = |vertex: stl_io::Vertex| Vector::<3>::from(vertex.0.map(f64::from));
    let facet = |(number, facet): (usize, std::io::Result<stl_io::Triangle>)| {
        let facet = facet.map_err(|error| format!("facet {}: {error}", number + 1))?;
        Ok(facet.vertices.map(corner))
    };
    facets.enumerate().map(facet).collect()
}

/// An STL in text as one solid, whose normals are no use, if it is one.
fn plain(bytes: &[u8]) -> Option<String> {
    let text = std::str::from_utf8(bytes).ok()?.trim_start_matches('\u{feff}');
    let begins = |line: &str, word: &str| {
        line.split_whitespace().next().is_some_and(|first| first.eq_ignore_ascii_case(word))
    };
    let mut lines = text.lines().filter(|line| !line.trim().is_empty());
    let is_text = begins(lines.next()?, "solid")
        && lines.next().is_some_and(|line| begins(line, "facet") || begins(line, "endsolid"));
    if !is_text {
        return None;
    }
    let mut plain = String::with_capacity(bytes.len());
    plain.push_str("solid it\n");
    for line in text.lines() {
        if begins(line, "facet") {
            plain.push_str("facet normal 0 0 0\n");
        } else if !begins(line, "solid") && !begins(line, "endsolid") {
            plain.push_str(line);
            plain.push('\n');
        }
    }
    plain.push_str("endsolid it\n");
    Some(plain)
}

fn obj(bytes: Vec<u8>) -> Result<Vec<Triangle>, String> {
    let options = tobj::LoadOptions { triangulate: true, ..Default::default() };
    // Colours and textures are no shapes.
    let materials = |_: &Path| Ok(Default::default());
    let read = tobj::load_obj_buf(&mut Cursor::new(bytes), &options, materials);
    let (models, _) = read.map_err(|error| error.to_string())?;
    let mut all = Vec::new();
    for model in models {
        let places = model.mesh.positions;
        let corners: Vec<Vector<3>> =
            places.chunks_exact(3).map(Vector::from_column_slice).collect();
        add(&corners, &model.mesh.indices, &mut all)?;
    }
    Ok(all)
}

fn ply(bytes: Vec<u8>) -> Result<Vec<Triangle>, String> {
    let parser = Parser::<DefaultElement>::new();
    let most = bytes.len();
    let mut source = Reader::new(Cursor::new(bytes));
    let header = parser.read_header(&mut source).map_err(|error| error.to_string())?;
    for element in header.elements.values() {
        // Each takes a byte and more.
        if element.count > most || element.properties.is_empty() {
            return Err(format!(
                "{} of the element `{}` with {} properties are more than it can hold",
                element.count,
                element.name,
                element.properties.len()
            ));
        }
    }
    let payload = parser.read_payload(&mut source, &header).map_err(|error| error.to_string())?;
    let of = |name: &str| payload.get(name).map_or(&[][..], Vec::as_slice);
    let coordinate = |vertex: &DefaultElement, name: &str| {
        let value = vertex.get(name).and_then(number);
        value.ok_or_else(|| format!("a vertex has no number `{name}`"))
    };
    let place = |vertex: &DefaultElement| -> Result<Vector<3>, String> {
        let [x, y, z] = ["x", "y", "z"].map(|name| coordinate(vertex, name));
        Ok(Vector::<3>::new(x?, y?, z?))
    };
    let corners: Vec<Vector<3>> = of("vertex").iter().map(place).collect::<Result<_, _>>()?;
    let mut all = Vec::new();
    for face in of("face") {
        let list = face.get("vertex_indices").or_else(|| face.get("vertex_index"));
        let list = list.and_then(indices);
        let list = list.ok_or("a face has no list `vertex_indices` of whole numbers from 0")?;
        // A face with more than three corners is a fan.
        for pair in list.get(1..).unwrap_or_default().windows(2) {
            add(&corners, &[list[0], pair[0], pair[1]], &mut all)?;
        }
    }
    Ok(all)
}

fn number(property: &Property) -> Option<f64> {
    Some(match *property {
        Property::Char(value) => value.into(),
        Property::UChar(value) => value.into(),
        Property::Short(value) => value.into(),
        Property::UShort(value) => value.into(),
        Property::Int(value) => value.into(),
        Property::UInt(value) => value.into(),
        Property::Float(value) => value.into(),
        Property::Double(value) => value,
        _ => return None,
    })
}

fn indices(property: &Property) -> Option<Vec<u32>> {
    fn all<T: Copy + TryInto<u32>>(list: &[T]) -> Option<Vec<u32>> {
        list.iter().map(|&index| index.try_into().ok()).collect()
    }
    match property {
        Property::ListChar(list) => all(list),
        Property::ListUChar(list) => all(list),
        Property::ListShort(list) => all(list),
        Property::ListUShort(list) => all(list),
        Property::ListInt(list) => all(list),
        Property::ListUInt(list) => all(list),
        _ => None,
    }
}

/// Adds the triangles of corners by their numbers, from 0.
fn add(corners: &[Vector<3>], numbers: &[u32], all: &mut Vec<Triangle>) -> Result<(), String> {
    let corner = |&number: &u32| {
        let found = corners.get(number as usize).copied();
        let count = corners.len();
        found.ok_or_else(|| format!("a facet refers to the vertex {number} (from 0) of {count}"))
    };
    for facet in numbers.chunks_exact(3) {
        all.push([corner(&facet[0])?, corner(&facet[1])?, corner(&facet[2])?]);
    }
    Ok(())
}
