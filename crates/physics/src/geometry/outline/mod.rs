//! Closed outlines of files.

use std::path::{Path, PathBuf};

use thiserror::Error;

use super::error::finite;
use super::{GeometryError, Shape, file, polygon};
use crate::Vector;
use crate::coordinates;

mod svg;

/// Most corners of an outline: each side is compared with each.
const MOST_CORNERS: usize = 20_000;

/// A file that is no outline.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum OutlineError {
    /// It cannot be read.
    #[error("`{}` cannot be read: {reason}", path.display())]
    Unreadable {
        /// The file.
        path: PathBuf,
        /// Why.
        reason: String,
    },
    /// The end of its name is of no kind that is known.
    #[error("`{}` is of an unknown kind, expected a file name that ends with `.svg` or `.csv`", path.display())]
    Kind {
        /// The file.
        path: PathBuf,
    },
    /// It is not what the end of its name says, or contains what is not supported.
    #[error("`{}`{}: {reason}", path.display(), line.map(|line| format!(", line {line}")).unwrap_or_default())]
    Broken {
        /// The file.
        path: PathBuf,
        /// The line, from 1, where it is known.
        line: Option<u64>,
        /// What is wrong.
        reason: String,
    },
    /// Two loops have a point in common.
    #[error(
        "`{}`: loops {first} and {second} cross or touch at {} m, expected separate loops", path.display(),
        coordinates(place)
    )]
    Crossing {
        /// The file.
        path: PathBuf,
        /// Number of a loop, from 1.
        first: usize,
        /// Number of another one.
        second: usize,
        /// Where they meet, in m.
        place: [f64; 2],
    },
    /// A loop is no polygon.
    #[error("`{}`: loop {number}: {reason}", path.display())]
    Loop {
        /// The file.
        path: PathBuf,
        /// Number of the loop, from 1.
        number: usize,
        /// What is wrong with it.
        reason: Box<GeometryError>,
    },
}

/// Closed loops of straight sides, which enclose what an odd number of them is around.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Outline {
    loops: Vec<Vec<Vector<2>>>,
}

/// What is wrong, and in which line.
type Fault = (Option<u64>, String);

impl Outline {
    /// Reads the paths and polygons of an SVG, whose y points down and is turned up, or a CSV file with the columns `x` and
    /// `y`, and `loop` where there are several. Lengths are multiplied by `scale`, and places then moved by `shift` in m.
    /// Curves become sides that are at most 1e-4 of the size of the outline away from them.
    ///
    /// # Errors
    /// [`OutlineError`] for a file that cannot be read or contains what is not supported, for loops that meet, and for what
    /// [`Shape::polygon`] refuses of a loop.
    pub fn read(path: &Path, scale: f64, shift: Vector<2>) -> Result<Self, GeometryError> {
        let of = || path.to_owned();
        let end = path.extension().map(|end| end.to_ascii_lowercase());
        let parse = match end.as_ref().and_then(|end| end.to_str()) {
            Some("svg") => svg::loops,
            Some("csv") => csv,
            _ => return Err(OutlineError::Kind { path: of() }.into()),
        };
        let bytes = file::read(path)
            .map_err(|fault| OutlineError::Unreadable { path: of(), reason: fault.to_string() })?;
        let broken = |(line, reason): Fault| OutlineError::Broken { path: of(), line, reason };
        let mut loops = parse(&bytes).map_err(broken)?;
        for corners in &mut loops {
            corners.iter_mut().for_each(|corner| *corner = *corner * scale + shift);
            // A loop that comes back to its start has that twice.
            corners.dedup();
            while corners.len() > 1 && corners.first() == corners.last() {
                corners.pop();
            }
        }
        let count: usize = loops.iter().map(Vec::len).sum();
        if count == 0 {
            return Err(broken((None, "there is no outline in it".to_owned())).into());
        }
        if count > MOST_CORNERS {
            let reason = format!("it has {count} corners, at most {MOST_CORNERS} can be checked");
            return Err(broken((None, reason)).into());
        }
        for (number, corners) in (1..).zip(&loops) {
            let finite = |x: &Vector<2>| finite("a corner of an outline", x.as_slice());
            let checked =
                corners.iter().try_for_each(finite).and_then(|()| polygon::check(corners));
            checked.map_err(|reason| OutlineError::Loop {
                path: of(),
                number,
                reason: Box::new(reason),
            })?;
        }
        for (second, other) in loops.iter().enumerate() {
            for (first, one) in loops[..second].iter().enumerate() {
                if let Some(place) = polygon::meet(one, other) {
                    let (first, second, place) = (first + 1, second + 1, place.into());
                    return Err(OutlineError::Crossing { path: of(), first, second, place }.into());
                }
            }
        }
        Ok(Self { loops })
    }

    /// What the loops enclose; in 3D between two `ends` in m along z. A loop in another is a hole, and one in a hole an island.
    ///
    /// # Errors
    /// As [`Shape::polygon`].
    pub fn shape<const D: usize>(&self, ends: Option<[f64; 2]>) -> Result<Shape<D>, GeometryError> {
        let contains = |outer: usize, inner: usize| {
            outer != inner && polygon::depth(&self.loops[outer], &self.loops[inner][0]) > 0.0
        };
        let all = 0..self.loops.len();
        let depth: Vec<usize> = all
            .clone()
            .map(|inner| all.clone().filter(|&outer| contains(outer, inner)).count())
            .collect();
        let of = |index: usize| Shape::polygon(self.loops[index].clone(), ends);
        let islands = all.clone().filter(|&outer| depth[outer].is_multiple_of(2));
        let islands = islands.map(|outer| {
            let is_hole =
                |inner: &usize| depth[*inner] == depth[outer] + 1 && contains(outer, *inner);
            let holes: Vec<Shape<D>> =
                all.clone().filter(is_hole).map(of).collect::<Result<_, _>>()?;
            match holes.is_empty() {
                true => of(outer),
                false => Shape::difference(of(outer)?, holes),
            }
        });
        let mut islands: Vec<Shape<D>> = islands.collect::<Result<_, _>>()?;
        if islands.len() == 1 { Ok(islands.remove(0)) } else { Shape::union(islands) }
    }
}

/// The loops of a table.
fn csv(bytes: &[u8]) -> Result<Vec<Vec<Vector<2>>>, Fault> {
    let mut reader = csv::ReaderBuilder::new().trim(csv::Trim::All).from_reader(bytes);
    let fault = |error: csv::Error| (error.position().map(csv::Position::line), error.to_string());
    let header = reader.headers().map_err(fault)?.clone();
    let column = |name: &str| header.iter().position(|known| known == name);
    let (Some(x), Some(y)) = (column("x"), column("y")) else {
        return Err((Some(1), "expected a header with the columns `x` and `y`".to_owned()));
    };
    let name = column("loop");
    let mut loops: Vec<(String, Vec<Vector<2>>)> = Vec::new();
    for record in reader.records() {
        let record = record.map_err(fault)?;
        let line = record.position().map(csv::Position::line);
        let number = |index: usize| {
            let text = record.get(index).unwrap_or_default();
            let value = text.parse::<f64>().ok().filter(|value| value.is_finite());
            value.ok_or_else(|| (line, format!("`{text}` is not a finite number")))
        };
        let corner = Vector::<2>::new(number(x)?, number(y)?);
        let own = name.and_then(|name| record.get(name)).unwrap_or_default();
        match loops.last_mut().filter(|(last, _)| last == own) {
            Some((_, corners)) => corners.push(corner),
            None => loops.push((own.to_owned(), vec![corner])),
        }
    }
    Ok(loops.into_iter().map(|(_, corners)| corners).collect())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn read(name: &str, text: &str) -> Result<Outline, String> {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join(name);
        std::fs::write(&path, text).unwrap();
        let shift = Vector::<2>::new(0.1, 0.2);
        let read = Outline::read(&path, 0.001, shift).map_err(|error| error.to_string());
        read.map_err(|text| text.replace(&folder.path().display().to_string(), ""))
    }

    fn drawn(content: &str) -> Result<Outline, String> {
        read("plate.svg", &format!("<svg xmlns=\"http://www.w3.org/2000/svg\">\n{content}\n</svg>"))
    }

    #[test]
    fn paths_of_a_drawing_enclose_what_they_draw() {
        // A plate of 100 mm x 50 mm with a round hole of radius 10 mm, in which an island of 4 mm x 4 mm is.
        let hole = "M60 25 a10 10 0 1 0 -20 0 a10 10 0 1 0 20 0 z";
        let content = format!(
            "<g><path d=\"M0 0 H100 V50 H0 Z {hole}\"/><polygon points=\"48,23 52,23 52,27 48,27\"/></g>"
        );
        let outline = drawn(&content).unwrap();
        let areas: Vec<f64> = outline.loops.iter().map(|own| polygon::area(own).abs()).collect();
        let circle = 1e-4 * std::f64::consts::PI;
        assert!((areas[0] - 5e-3).abs() < 1e-15 && (areas[2] - 16e-6).abs() < 1e-15, "{areas:?}");
        // Its sides are at most 0.01 mm away from the circle.
        assert!((areas[1] - circle).abs() < 2.0 * circle * 1e-3, "{areas:?}");
        // Whatever the unit is in which it is drawn.
        let small = "<path d=\"M.6.25A.1.1 0 1 0 .4.25.1.1 0 1 0 .6.25Z\"/>";
        let small = drawn(small).unwrap();
        // The size is the diameter of 0.2, so that its sides are at most 2e-5 away; the unit is 1 mm.
        let (area, circle) = (polygon::area(&small.loops[0]).abs(), 1e-8 * std::f64::consts::PI);
        assert!((area - circle).abs() < 2.0 * circle * 2e-4, "{area} {circle}");
        let shape: Shape<2> = outline.shape(None).unwrap();
        // y points up, and the origin is moved.
        for (x, y, is_inside) in
            [(5.0, -5.0, true), (5.0, 5.0, false), (55.0, -25.0, false), (50.0, -25.0, true)]
        {
            let place = Vector::<2>::new(0.1 + 1e-3 * x, 0.2 + 1e-3 * y);
            assert_eq!(shape.contains(&place), is_inside, "{x} {y}");
        }
        let thick: Shape<3> = outline.shape(Some([0.0, 0.5])).unwrap();
        let at = |z: f64| thick.contains(&Vector::<3>::new(0.105, 0.195, z));
        assert!(at(0.4) && !at(0.6) && outline.shape::<3>(None).is_err());
    }

    #[test]
    fn a_path_can_be_written_in_several_ways() {
        let loops = |data: &str| svg::loops(format!("<svg><path d='{data}'/></svg>").as_bytes());
        for (one, other) in [
            ("M0 0C0 1 1 1 1 0S2-1 2 0z", "m0 0c0 1 1 1 1 0c0-1 1-1 1 0z"),
            ("M0 0S1 1 1 0z", "M0 0C0 0 1 1 1 0z"),
            ("M0 0Q1 1 2 0T4 0V-3H1z", "m0 0q1 1 2 0t2 0v-3h-3z"),
            ("M0 0Q1 1 2 0T4 0z", "M0 0Q1 1 2 0Q3-1 4 0z"),
            ("M0 0A2 2 0 0 1 2 2z", "m0 0a2 2 0 0 1 2 2z"),
        ] {
            assert_eq!(loops(one), loops(other), "{one}");
        }
        // What goes on after an end begins at its start.
        let two = loops("M1 1h2v2h-2zl-1-1h-1z").unwrap();
        let second = [(1.0, -1.0), (0.0, 0.0), (-1.0, 0.0)].map(|(x, y)| Vector::<2>::new(x, y));
        assert_eq!((two.len(), &two[1][..3]), (2, &second[..]));
    }

    #[test]
    fn tables_have_one_loop_or_several() {
        let one = read("a.csv", "x, y\n0, 0\n10, 0\n10, 10\n0, 0\n").unwrap();
        assert_eq!(one.loops.len(), 1);
        assert_eq!(one.loops[0].len(), 3, "the corner that closes it is left out");
        let two = "loop,x,y\na,0,0\na,10,0\na,10,10\na,0,10\nb,4,4\nb,6,4\nb,6,6\n";
        let two = read("b.csv", two).unwrap();
        let areas: Vec<f64> = two.loops.iter().map(|own| polygon::area(own).abs()).collect();
        assert!((areas[0] - 1e-4).abs() < 1e-15 && (areas[1] - 2e-6).abs() < 1e-15, "{areas:?}");
    }

    #[test]
    fn what_is_no_outline_is_refused_where_it_stands() {
        for (name, text, part) in [
            ("a.dxf", "", "expected a file name that ends with `.svg` or `.csv`"),
            ("a.csv", "x,z\n1,2\n", "line 1: expected a header with the columns `x` and `y`"),
            ("a.csv", "x,y\n0,0\n1,nan\n", "line 3: `nan` is not a finite number"),
            ("a.csv", "x,y\n0,0\n1\n", "line"),
            ("a.csv", "x,y\n", "there is no outline in it"),
            ("a.csv", "x,y\n0,0\n1,1\n", "a.csv`: loop 1: a polygon has 2 corners"),
            // It is drawn in mm and moved.
            (
                "a.csv",
                "x,y\n0,0\n1,1\n1,0\n0,1\n",
                "a.csv`: loop 1: sides 1 and 3 of a polygon cross or touch at (0.1005, 0.2005) m",
            ),
            (
                "a.csv",
                "loop,x,y\na,0,0\na,9,0\na,0,9\nb,5,8\nb,9,8\nb,7,8\nb,7,9\n",
                "loop 2: sides",
            ),
            (
                "a.csv",
                "loop,x,y\n1,0,0\n1,9,0\n1,0,9\n2,1,1\n2,9,9\n2,1,8\n",
                "loops 1 and 2 cross or touch at (0.10",
            ),
            ("a.svg", "<svg>\n<path d='M0 0 L", "unexpected end"),
            ("a.svg", "<svg>\n<path d='M0 0 LL'/></svg>", "line 2: the path cannot be read"),
            ("a.svg", "<svg>\n<path d='M0 0 C1e300 0 0 1 1 1z'/></svg>", "line 2: the path goes"),
            ("a.svg", "<svg><path d='M0 0'/></svg>", "there is no outline in it"),
            ("a.svg", "<svg>\n<g transform='scale(2)'/></svg>", "line 2: `transform` of <g>"),
            ("a.svg", "<svg>\n<circle r='3'/></svg>", "line 2: <circle> is not supported"),
            ("a.svg", "<svg/>", "there is no outline in it"),
        ] {
            let error = read(name, text).unwrap_err();
            assert!(error.contains(part), "{error}");
        }
        let most: String = (0..=MOST_CORNERS).map(|k| format!("{k},{}\n", k % 2)).collect();
        assert!(read("a.csv", &format!("x,y\n{most}")).unwrap_err().contains("at most 20000"));
    }
}
