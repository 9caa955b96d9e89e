//! Texts that a case is read from, and places in them.

use std::ops::{Deref, Range};

/// A text with the name under which problems mention it: the case file, or one override.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct SourceText {
    /// Path of a file as the user gave it, or `--set path=value` for an override.
    pub name: String,
    /// The whole text. For an override, the text as the user typed it.
    pub text: String,
}

impl SourceText {
    /// Line and column of a byte offset, both counted from 1, columns in characters.
    ///
    /// Offsets beyond the end or inside a character are moved back to the nearest valid one.
    pub fn line_column(&self, offset: usize) -> (usize, usize) {
        let offset = floor_boundary(&self.text, offset);
        let before = &self.text[..offset];
        let line = before.bytes().filter(|byte| *byte == b'\n').count() + 1;
        let line_start = before.rfind('\n').map_or(0, |newline| newline + 1);
        (line, before[line_start..].chars().count() + 1)
    }
}

/// The nearest character boundary at or before `offset`, at most the text's length.
pub(super) fn floor_boundary(text: &str, offset: usize) -> usize {
    let mut offset = offset.min(text.len());
    while !text.is_char_boundary(offset) {
        offset -= 1;
    }
    offset
}

/// A range of bytes in one of the texts of a case.
///
/// Places are handles: a value that is refused later, for example because a selection selects nothing, is reported
/// with [`Case::problem_at`](super::model::Case::problem_at).
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct Place {
    /// Number of the text: 0 is the case file, the overrides of the command line follow.
    pub source: u32,
    /// First byte.
    pub start: u32,
    /// One past the last byte.
    pub end: u32,
}

impl Place {
    /// A place in text number `source`. Texts are far shorter than 4 GiB, which the reader checks.
    pub fn new(source: u32, span: Range<usize>) -> Self {
        let clip = |offset: usize| u32::try_from(offset).unwrap_or(u32::MAX);
        Self { source, start: clip(span.start), end: clip(span.end) }
    }

    /// The range of bytes.
    pub fn span(&self) -> Range<usize> {
        self.start as usize..self.end as usize
    }
}

/// A value together with the place that it was read from.
///
/// A default has the place of the table that lacks the key.
#[derive(Clone, Debug, PartialEq)]
pub struct Located<T> {
    /// The value.
    pub value: T,
    /// Where it is in the case file.
    pub place: Place,
}

impl<T> Located<T> {
    /// Binds `value` to `place`.
    pub fn new(value: T, place: Place) -> Self {
        Self { value, place }
    }

    /// Applies `change` to the value and keeps the place.
    pub fn map<U>(self, change: impl FnOnce(T) -> U) -> Located<U> {
        Located { value: change(self.value), place: self.place }
    }
}

impl<T> Deref for Located<T> {
    type Target = T;

    fn deref(&self) -> &T {
        &self.value
    }
}
