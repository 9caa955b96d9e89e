//! Files of facets.

use std::io::Cursor;
use std::path::{Path, PathBuf};

use ply_rs_bw::parser::{Parser, Reader};
use ply_rs_bw::ply::{DefaultElement, Property};
use thiserror::Error;

use super::super::file;
use super::Triangle;
use crate::Vector;
use crate::coordinates;

/// Bytes of a binary STL before its facets, and of each facet.
const STL_HEAD: usize = 84;
const STL_FACET: usize = 50;

/// Most characters of a line that are shown.
const MOST_SHOWN: usize = 60;

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
    #[error(
        "a corner of facet {facet} is at {at}, expected finite coordinates",
        at = coordinates(corner)
    )]
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

/// The triangles of a file, with the number of the facet, from 1, that each is of.
pub(super) fn triangles(path: &Path) -> Result<Vec<(Triangle, u32)>, SurfaceError> {
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
fn stl(mut bytes: Vec<u8>) -> Result<Vec<(Triangle, u32)>, String> {
    let count = bytes.get(STL_HEAD - 4..STL_HEAD).and_then(|it| it.try_into().ok());
    let count = count.map(u32::from_le_bytes).unwrap_or_default() as usize;
    if bytes.len() == STL_HEAD + STL_FACET * count {
        // The reader takes what begins with `solid` for text.
        bytes[..5].copy_from_slice(b"     ");
    } else if let Some(text) = plain(&bytes) {
        bytes = text?.into_bytes();
    } else {
        let length = bytes.len();
        return Err(match length.checked_sub(STL_HEAD) {
            None if length == 0 => "it is empty".into(),
            None => format!(
                "it has {length} bytes, fewer than the header of a binary STL, and it is not an ASCII STL either"
            ),
            Some(rest) if rest < STL_FACET * count => format!(
                "its header announces {count} facets, and it ends after {} of them",
                rest / STL_FACET
            ),
            Some(rest) => format!(
                "its header announces {count} facets, and it has {} bytes after the last",
                rest - STL_FACET * count
            ),
        });
    }
    let mut source = Cursor::new(bytes);
    let facets = stl_io::create_stl_reader(&mut source).map_err(|error| error.to_string())?;
    let corner = |vertex: stl_io::Vertex| Vector::<3>::from(vertex.0.map(f64::from));
    let facet = |(facet, number): (std::io::Result<stl_io::Triangle>, u32)| {
        let facet = facet.map_err(|error| format!("facet {number}: {error}"))?;
        Ok((facet.vertices.map(corner), number))
    };
    facets.zip(1..).map(facet).collect()
}

/// An STL in text as one solid, whose normals are no use, if it is one.
fn plain(bytes: &[u8]) -> Option<Result<String, String>> {
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
    if let Err(fault) = check_vertices(text, "vertex") {
        return Some(Err(fault));
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
    Some(Ok(plain))
}

/// Refuses lines that begin with a word and do not go on with three finite numbers.
fn check_vertices(text: &str, word: &str) -> Result<(), String> {
    let is_finite = |word: Option<&str>| {
        word.and_then(|word| word.parse::<f32>().ok()).is_some_and(f32::is_finite)
    };
    for (line, text) in (1..).zip(text.lines()) {
        let mut words = text.split_whitespace();
        let is_vertex = words.next().is_some_and(|first| first.eq_ignore_ascii_case(word));
        if is_vertex && !(0..3).all(|_| is_finite(words.next())) {
            let got: String = text.trim().chars().take(MOST_SHOWN).collect();
            return Err(format!(
                "line {line}: expected three finite coordinates after `{word}`, got `{got}`"
            ));
        }
    }
    Ok(())
}

/// Refuses faces of vertices that are not there. The reader does so, too, and does not say in which line.
fn check_faces(text: &str) -> Result<(), String> {
    let begins = |line: &str, word: &str| line.split_whitespace().next() == Some(word);
    let count = text.lines().filter(|line| begins(line, "v")).count();
    for (line, text) in (1..).zip(text.lines()).filter(|(_, line)| begins(line, "f")) {
        for corner in text.split_whitespace().skip(1) {
            let number = corner.split('/').next().and_then(|number| number.parse::<i64>().ok());
            if !number.is_some_and(|number| (1..=count as u64).contains(&number.unsigned_abs())) {
                let got: String = corner.chars().take(MOST_SHOWN).collect();
                return Err(format!(
                    "line {line}: a face refers to the vertex `{got}` (from 1) of {count}"
                ));
            }
        }
    }
    Ok(())
}

fn obj(bytes: Vec<u8>) -> Result<Vec<(Triangle, u32)>, String> {
    let text = String::from_utf8_lossy(&bytes);
    check_vertices(&text, "v")?;
    check_faces(&text)?;
    drop(text);
    // Points and lines have no area. Faces with more than three corners are taken apart here, so that they can be numbered.
    let options =
        tobj::LoadOptions { ignore_points: true, ignore_lines: true, ..Default::default() };
    // Colours and textures are no shapes.
    let materials = |_: &Path| Ok(Default::default());
    let read = tobj::load_obj_buf(&mut Cursor::new(bytes), &options, materials);
    let (models, _) = read.map_err(|error| error.to_string())?;
    let (mut all, mut number) = (Vec::new(), 0);
    for model in models {
        let places = model.mesh.positions;
        let corners: Vec<Vector<3>> =
            places.chunks_exact(3).map(Vector::from_column_slice).collect();
        // If all faces are triangles, it does not say so of each.
        let (mut rest, arities) = (model.mesh.indices.as_slice(), &model.mesh.face_arities);
        let mut arities = arities.iter();
        while !rest.is_empty() {
            let length = arities.next().map_or(3, |arity| *arity as usize).clamp(1, rest.len());
            let (face, others) = rest.split_at(length);
            number += 1;
            add(&corners, face, number, &mut all)?;
            rest = others;
        }
    }
    Ok(all)
}

fn ply(bytes: Vec<u8>) -> Result<Vec<(Triangle, u32)>, String> {
    let parser = Parser::<DefaultElement>::new();
    let most = bytes.len();
    let mut source = Reader::new(Cursor::new(bytes));
    let header = parser.read_header(&mut source).map_err(|error| ply_fault(&error.to_string()))?;
    for element in header.elements.values() {
        if element.properties.is_empty() {
            return Err(format!("the element `{}` has no properties", element.name));
        }
        // Each takes a byte and more.
        if element.count > most {
            return Err(format!(
                "the header announces {} elements `{}`, more than the file can hold",
                element.count, element.name
            ));
        }
    }
    let payload = parser.read_payload(&mut source, &header);
    let payload = payload.map_err(|error| ply_fault(&error.to_string()))?;
    let of = |name: &str| payload.get(name).map_or(&[][..], Vec::as_slice);
    let coordinate = |vertex: &DefaultElement, name: &str| {
        let value = vertex.get(name).and_then(number);
        value.ok_or_else(|| format!("a vertex has no number `{name}`"))
    };
    let place = |(index, vertex): (usize, &DefaultElement)| -> Result<Vector<3>, String> {
        let [x, y, z] = ["x", "y", "z"].map(|name| coordinate(vertex, name));
        let (x, y, z) = (x?, y?, z?);
        match [x, y, z].iter().all(|x| x.is_finite()) {
            true => Ok(Vector::<3>::new(x, y, z)),
            false => Err(format!(
                "the vertex {index} (from 0) is at ({x}, {y}, {z}), expected finite coordinates"
            )),
        }
    };
    let corners = of("vertex").iter().enumerate().map(place);
    let corners: Vec<Vector<3>> = corners.collect::<Result<_, _>>()?;
    let mut all = Vec::new();
    for (face, number) in of("face").iter().zip(1..) {
        let list = face.get("vertex_indices").or_else(|| face.get("vertex_index"));
        let list = list.and_then(indices);
        let list = list.ok_or("a face has no list `vertex_indices` of whole numbers from 0")?;
        add(&corners, &list, number, &mut all)?;
    }
    Ok(all)
}

/// What the reader says of a line, in one sentence.
fn ply_fault(said: &str) -> String {
    let found = said.strip_prefix("Line ").and_then(|rest| rest.split_once(':'));
    let text = said.split_once("String: '").and_then(|(_, rest)| rest.lines().next());
    match found.zip(text) {
        Some(((line, _), text)) => {
            let text: String =
                text.trim_end_matches('\'').trim().chars().take(MOST_SHOWN).collect();
            format!(
                "line {line}: expected finite numbers or what the header announces, got `{text}`"
            )
        }
        None => said.split_whitespace().collect::<Vec<_>>().join(" "),
    }
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

/// Adds the face of a number with these corners, from 0: the triangles of a fan.
fn add(
    corners: &[Vector<3>],
    face: &[u32],
    facet: u32,
    all: &mut Vec<(Triangle, u32)>,
) -> Result<(), String> {
    let corner = |&number: &u32| {
        let found = corners.get(number as usize).copied();
        let count = corners.len();
        found.ok_or_else(|| {
            format!("facet {facet} refers to the vertex {number} (from 0) of {count}")
        })
    };
    for pair in face.get(1..).unwrap_or_default().windows(2) {
        all.push(([corner(&face[0])?, corner(&pair[0])?, corner(&pair[1])?], facet));
    }
    Ok(())
}
