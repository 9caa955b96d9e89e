//! Problems of a case: what is wrong, where, and what the user can do.

use std::fmt;
use std::sync::Arc;

use super::render;
use super::source::{Place, SourceText};

/// How many problems are shown at most; the rest is counted.
pub const SHOWN: usize = 50;

/// One thing that is wrong with a case.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Problem {
    /// A sentence: what is wrong, what was expected, what was found.
    pub message: String,
    /// A few words for the underlined text. May be empty.
    pub label: String,
    /// The text to underline. `None` if the whole file is concerned.
    pub place: Option<Place>,
    /// What the user can do, often a suggestion.
    pub help: Option<String>,
}

impl Problem {
    /// A problem at a place, without help.
    pub fn new(place: Place, message: impl Into<String>, label: impl Into<String>) -> Self {
        Self { message: message.into(), label: label.into(), place: Some(place), help: None }
    }

    /// A problem with a file or text as a whole.
    pub fn whole(message: impl Into<String>) -> Self {
        Self { message: message.into(), label: String::new(), place: None, help: None }
    }

    /// Adds what the user can do.
    pub fn help(mut self, help: impl Into<String>) -> Self {
        self.help = Some(help.into());
        self
    }
}

/// All problems of a case, in the order of the text, together with the text itself.
///
/// Its `Display` shows each with file, line, column, the line, and the offending part underlined.
#[derive(Clone, Debug)]
pub struct Problems {
    sources: Arc<[SourceText]>,
    list: Vec<Problem>,
    is_io: bool,
}

impl Problems {
    /// Problems in `sources`, as numbered by [`Place::source`], sorted by position and without duplicates.
    pub fn new(sources: Arc<[SourceText]>, mut list: Vec<Problem>) -> Self {
        list.sort_by_key(|problem| problem.place);
        list.dedup();
        Self { sources, list, is_io: false }
    }

    /// The file called `name` cannot be read at all.
    pub fn io(name: String, problem: Problem) -> Self {
        let sources = Arc::from([SourceText { name, text: String::new() }]);
        Self { sources, list: vec![problem], is_io: true }
    }

    /// Whether a file could not be read, as opposed to having wrong content.
    pub fn is_io(&self) -> bool {
        self.is_io
    }

    /// The problems in the order of the text, those of the case file first.
    pub fn iter(&self) -> impl ExactSizeIterator<Item = &Problem> {
        self.list.iter()
    }

    /// How many there are.
    pub fn len(&self) -> usize {
        self.list.len()
    }

    /// Whether there is none.
    pub fn is_empty(&self) -> bool {
        self.list.is_empty()
    }

    /// The texts that places refer to: the case file first.
    pub fn sources(&self) -> &[SourceText] {
        &self.sources
    }

    /// The text that `problem` is about: the case file if it has no place.
    pub fn source(&self, problem: &Problem) -> Option<&SourceText> {
        let number = problem.place.map_or(0, |place| place.source as usize);
        self.sources.get(number).or_else(|| self.sources.first())
    }

    /// Line and column of a problem, counted from 1. `None` if it has no place.
    pub fn line_column(&self, problem: &Problem) -> Option<(usize, usize)> {
        let place = problem.place?;
        Some(self.source(problem)?.line_column(place.start as usize))
    }
}

impl fmt::Display for Problems {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        for (number, problem) in self.iter().take(SHOWN).enumerate() {
            if number > 0 {
                writeln!(formatter)?;
            }
            render::write_problem(formatter, problem, self.source(problem))?;
        }
        if self.len() > SHOWN {
            writeln!(formatter, "\n... and {} more", self.len() - SHOWN)?;
        }
        Ok(())
    }
}

impl std::error::Error for Problems {}
