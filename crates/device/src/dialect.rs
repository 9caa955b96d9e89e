//! How columns are stored, and how passes read and write them in text.

use std::fmt::Write;

use crate::text::{Language, Precision};

/// How columns are stored, by their names.
#[derive(Clone, Copy, Debug, Default)]
pub struct Layout {
    /// Those in single precision.
    pub narrow: &'static [&'static str],
    /// Those of which rows are cut into pieces of 16 bytes, and smaller ones at the end; the first pieces of all rows stand side
    /// by side, then the second ones. Neighbours that are close in memory then share lines of the cache.
    pub planes: &'static [&'static str],
}

impl Layout {
    /// Whether a column is in single precision.
    pub fn is_narrow(self, column: &str) -> bool {
        self.narrow.contains(&column)
    }

    /// The precision of what is computed of pairs.
    pub fn of_pairs(self) -> Precision {
        if self.narrow.is_empty() { Precision::Double } else { Precision::Single }
    }
}

/// How passes are written: in a language, with some columns, and what is computed of pairs, in single precision.
#[derive(Clone, Copy, Debug)]
pub struct Dialect {
    /// The language.
    pub language: Language,
    /// How columns are stored. Where some are in single precision, pairs are computed in it, and all else in double.
    pub layout: Layout,
}

/// A stretch of the numbers of a row that stand side by side: where it begins, and how many they are.
pub(crate) type Piece = [usize; 2];

impl Dialect {
    /// Whether a column is in single precision.
    pub(crate) fn is_narrow(&self, column: &str) -> bool {
        self.layout.is_narrow(column)
    }

    /// Whether a column is stored in planes.
    pub(crate) fn is_in_planes(&self, column: &str) -> bool {
        self.layout.planes.contains(&column)
    }

    /// The pieces that a row of a column is read in.
    pub(crate) fn pieces(&self, column: &str, width: usize) -> Vec<Piece> {
        let most = if self.is_narrow(column) { 4 } else { 2 };
        let (mut pieces, mut from, mut size) = (Vec::new(), 0, most);
        while from < width {
            // Row by row pieces are aligned if rows are made of whole ones.
            let fits =
                from + size <= width && (self.is_in_planes(column) || width.is_multiple_of(size));
            if fits {
                pieces.push([from, size]);
                from += size;
            } else {
                size /= 2;
            }
        }
        pieces
    }

    /// Where a piece of a row stands, in pieces of its size.
    fn place(&self, column: &str, width: usize, row: &str, [from, size]: Piece) -> String {
        match (self.is_in_planes(column), from / size) {
            (true, 0) => row.to_string(),
            (true, planes) => format!("{row} + {planes} * {column}_rows"),
            (false, _) if width == size => row.to_string(),
            (false, at) => format!("(size_t){row} * {} + {at}", width / size),
        }
    }

    /// Number i of a row.
    pub(crate) fn element(&self, column: &str, width: usize, row: &str, i: usize) -> String {
        let pieces = match self.is_in_planes(column) {
            true => self.pieces(column, width),
            false => vec![[i, 1]],
        };
        let last = pieces.into_iter().rfind(|[from, _]| *from <= i);
        let [from, size] = last.unwrap_or([0, 1]);
        let place = self.place(column, width, row, [from, size]);
        match size {
            1 => format!("{column}[{place}]"),
            _ => format!("{column}[(size_t)({place}) * {size} + {}]", i - from),
        }
    }

    /// Statements that read a row, piece by piece, into constants of these names.
    pub(crate) fn load(&self, column: &str, row: &str, names: &[String], indent: &str) -> String {
        let (width, real) = (names.len(), self.token(column));
        let mut text = String::new();
        for [from, size] in self.pieces(column, width) {
            let (names, place) =
                (&names[from..from + size], self.place(column, width, row, [from, size]));
            let kind = match (self.is_narrow(column), size) {
                (_, 1) => {
                    let _ =
                        writeln!(text, "{indent}const {real} {} = {column}[{place}];", names[0]);
                    continue;
                }
                (false, _) => "Pair",
                (true, 2) => "WorkPair",
                (true, _) => "WorkQuad",
            };
            let piece = format!("{}_piece", names[0]);
            let each = |(name, part): (&String, &str)| format!("{name} = {piece}.{part}");
            let parts: Vec<String> = names.iter().zip(["x", "y", "z", "w"]).map(each).collect();
            let _ = writeln!(
                text,
                "{indent}const {kind} {piece} = ((GLOBAL const {kind} *){column})[{place}];\n\
                 {indent}const {real} {};",
                parts.join(", ")
            );
        }
        text
    }

    /// The precision of pairs.
    pub fn of_pairs(&self) -> Precision {
        self.layout.of_pairs()
    }

    /// The name of the numbers of a column.
    pub(crate) fn token(&self, column: &str) -> &'static str {
        if self.is_narrow(column) { Precision::Single.token() } else { Precision::Double.token() }
    }
}

impl From<Language> for Dialect {
    /// All in double precision.
    fn from(language: Language) -> Self {
        Self { language, layout: Layout::default() }
    }
}
