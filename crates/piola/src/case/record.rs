//! Checked values: what a table says once names, types and ranges are right.

use super::document::Node;
use super::expression::Expression;
use super::source::{Located, Place};

/// A checked value.
#[derive(Clone, Debug)]
pub(super) enum Datum {
    Text(String),
    Integer(i64),
    Number(f64),
    Boolean(bool),
    Expression(Expression),
    List(Vec<Located<Datum>>),
    /// One entry an axis of the case.
    Axes(Vec<Option<Located<Datum>>>),
    Record(Record),
    /// Paths of keys with one or more values, unchecked but for their number.
    Keys(Vec<(Located<String>, Vec<Node>)>),
    /// An entry of a list that was refused.
    Refused,
}

/// A checked table.
///
/// Its getters answer `None` where a key is absent without a default, and where its value was
/// refused: the problem is reported already, so that who reads the table need not care.
#[derive(Clone, Debug)]
pub(super) struct Record {
    /// Value of the key `kind` where the table has one.
    pub kind: &'static str,
    /// Place of the table.
    pub place: Place,
    /// The values that were accepted, defaults included.
    pub values: Vec<(&'static str, Located<Datum>)>,
    /// The keys that the file has, with their places, whether accepted or not.
    pub written: Vec<(&'static str, Place)>,
}

impl Record {
    fn get(&self, key: &str) -> Option<&Located<Datum>> {
        self.values.iter().find(|(name, _)| *name == key).map(|(_, value)| value)
    }

    fn read<'a, T>(
        &'a self,
        key: &str,
        convert: impl FnOnce(&'a Datum) -> Option<T>,
    ) -> Option<Located<T>> {
        let found = self.get(key)?;
        Some(Located::new(convert(&found.value)?, found.place))
    }

    /// The place of a key that the file has.
    pub(super) fn key_place(&self, key: &str) -> Option<Place> {
        self.written.iter().find(|(name, _)| *name == key).map(|(_, place)| *place)
    }

    /// Whether the file has the key, with a good value or not.
    pub(super) fn has(&self, key: &str) -> bool {
        self.key_place(key).is_some()
    }

    /// The place of a value, or of the table if the key is absent.
    pub(super) fn value_place(&self, key: &str) -> Place {
        self.get(key).map_or(self.place, |value| value.place)
    }

    pub(super) fn text(&self, key: &str) -> Option<Located<String>> {
        self.read(key, |datum| match datum {
            Datum::Text(text) => Some(text.clone()),
            _ => None,
        })
    }

    pub(super) fn number(&self, key: &str) -> Option<Located<f64>> {
        self.read(key, |datum| match datum {
            Datum::Number(number) => Some(*number),
            _ => None,
        })
    }

    pub(super) fn whole<T: TryFrom<i64>>(&self, key: &str) -> Option<Located<T>> {
        self.read(key, |datum| match datum {
            Datum::Integer(number) => T::try_from(*number).ok(),
            _ => None,
        })
    }

    pub(super) fn boolean(&self, key: &str) -> Option<bool> {
        let found = self.read(key, |datum| match datum {
            Datum::Boolean(value) => Some(*value),
            _ => None,
        });
        found.map(|located| located.value)
    }

    pub(super) fn expression(&self, key: &str) -> Option<Expression> {
        let found = self.read(key, |datum| match datum {
            Datum::Expression(expression) => Some(expression.clone()),
            _ => None,
        });
        found.map(|located| located.value)
    }

    pub(super) fn list(&self, key: &str) -> &[Located<Datum>] {
        match self.get(key).map(|found| &found.value) {
            Some(Datum::List(list)) => list,
            _ => &[],
        }
    }

    /// Whether no entry of a list was refused.
    pub(super) fn is_whole(&self, key: &str) -> bool {
        !self.list(key).iter().any(|item| matches!(item.value, Datum::Refused))
    }

    pub(super) fn numbers(&self, key: &str) -> Option<Located<Vec<f64>>> {
        self.read(key, |datum| datum.as_numbers())
    }

    pub(super) fn ends(&self, key: &str) -> Option<Located<[f64; 2]>> {
        self.read(key, Datum::as_pair)
    }

    pub(super) fn texts(&self, key: &str) -> Vec<Located<String>> {
        let texts = self.list(key).iter().filter_map(|item| match &item.value {
            Datum::Text(text) => Some(Located::new(text.clone(), item.place)),
            _ => None,
        });
        texts.collect()
    }

    pub(super) fn expressions(&self, key: &str) -> Option<Vec<Expression>> {
        let Datum::List(list) = &self.get(key)?.value else { return None };
        let each = list.iter().map(|item| match &item.value {
            Datum::Expression(expression) => Some(expression.clone()),
            _ => None,
        });
        each.collect()
    }

    pub(super) fn axes(&self, key: &str) -> &[Option<Located<Datum>>] {
        match self.get(key).map(|found| &found.value) {
            Some(Datum::Axes(axes)) => axes,
            _ => &[],
        }
    }

    pub(super) fn keys(&self, key: &str) -> &[(Located<String>, Vec<Node>)] {
        match self.get(key).map(|found| &found.value) {
            Some(Datum::Keys(keys)) => keys,
            _ => &[],
        }
    }

    pub(super) fn record(&self, key: &str) -> Option<&Record> {
        match &self.get(key)?.value {
            Datum::Record(record) => Some(record),
            _ => None,
        }
    }

    pub(super) fn records(&self, key: &str) -> impl Iterator<Item = &Record> {
        self.list(key).iter().filter_map(|item| match &item.value {
            Datum::Record(record) => Some(record),
            _ => None,
        })
    }
}

impl Datum {
    fn as_numbers(&self) -> Option<Vec<f64>> {
        let Self::List(list) = self else { return None };
        let each = list.iter().map(|item| match item.value {
            Self::Number(number) => Some(number),
            _ => None,
        });
        each.collect()
    }

    pub(super) fn as_pair(&self) -> Option<[f64; 2]> {
        self.as_numbers()?.try_into().ok()
    }
}
