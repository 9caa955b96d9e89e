//! All tables that a description leads to, each once.

use super::spec::{KeySpec, Kind, TableSpec, TaggedSpec};

/// A description of a table of either sort.
#[derive(Clone, Copy, Debug)]
pub(super) enum Section {
    Table(&'static TableSpec),
    Tagged(&'static TaggedSpec),
}

impl Section {
    /// How messages call the table.
    pub(super) fn title(&self) -> &'static str {
        match self {
            Self::Table(spec) => spec.title,
            Self::Tagged(spec) => spec.title,
        }
    }

    /// The title without brackets.
    pub(super) fn name(&self) -> &'static str {
        self.title().trim_matches(['[', ']'])
    }

    fn keys(&self) -> Vec<&'static KeySpec> {
        match self {
            Self::Table(spec) => spec.keys.iter().collect(),
            Self::Tagged(spec) => {
                spec.common.iter().chain(spec.kinds.iter().flat_map(|kind| kind.keys)).collect()
            }
        }
    }
}

/// The table and all tables below it, parents first. Titles are unique.
pub(super) fn sections(root: &'static TableSpec) -> Vec<Section> {
    let mut found = vec![Section::Table(root)];
    let mut next = 0;
    while let Some(section) = found.get(next).copied() {
        for key in section.keys() {
            if let Some(below) = table_of(&key.kind)
                && found.iter().all(|known| known.title() != below.title())
            {
                found.push(below);
            }
        }
        next += 1;
    }
    found
}

/// The table that a value is made of, if any.
pub(super) fn table_of(kind: &Kind) -> Option<Section> {
    match kind {
        Kind::Table(spec) => Some(Section::Table(spec)),
        Kind::Tagged(spec) => Some(Section::Tagged(spec)),
        Kind::List(inner) | Kind::PerAxis(inner) => table_of(inner),
        _ => None,
    }
}
