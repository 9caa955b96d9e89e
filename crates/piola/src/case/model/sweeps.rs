//! Sweeps: the same case with every value of one or two keys.

use super::{Level, Members, RunTraits, When};
use crate::case::source::Located;

/// The same case with every value of one key, or every pair of values of two.
#[derive(Clone, Debug, PartialEq)]
pub struct Sweep {
    /// Unique name, the first part of the names of its members.
    pub name: Located<String>,
    /// What it shows, in one line.
    pub title: Option<String>,
    /// The variant that the members start from, `None` for the case itself.
    pub variant: Option<Located<String>>,
    /// Overrides of all members, each `path.to.key=value`.
    pub set: Vec<String>,
    /// One or two keys with their values in the case as it stands.
    pub full: Vec<SweepKey>,
    /// The same keys at the coarse setting.
    pub coarse: Vec<SweepKey>,
    /// The settings at which the sweep exists.
    pub when: When,
    /// What is known of its runs in the case as it stands.
    pub traits: RunTraits,
}

/// A key of a sweep.
#[derive(Clone, Debug, PartialEq)]
pub struct SweepKey {
    /// Its path in the case file.
    pub path: Located<String>,
    /// The values, at least one.
    pub values: Vec<Located<SweepValue>>,
}

/// A value of a key of a sweep.
#[derive(Clone, Debug, PartialEq)]
pub struct SweepValue {
    /// As TOML, strings without quotes.
    pub text: String,
    /// Its value if it is a number, or an expression of the parameters of the case that was
    /// read: those of a member may differ from those of another.
    pub number: Option<f64>,
}

impl Sweep {
    /// The keys with their values at a setting.
    pub fn keys(&self, level: Level) -> &[SweepKey] {
        if level == Level::Coarse { &self.coarse } else { &self.full }
    }

    /// Whether the sweep exists at a setting.
    pub fn exists(&self, level: Level) -> bool {
        self.when.includes(level)
    }

    /// Number of members at a setting, 0 if the sweep does not exist.
    pub fn count(&self, level: Level) -> usize {
        if !self.exists(level) {
            return 0;
        }
        let counts = self.keys(level).iter().map(|key| key.values.len());
        counts.fold(1, usize::saturating_mul)
    }

    /// The name of member number `index`, from 0: `NAME.1` is that of the first.
    pub fn member(&self, index: usize) -> String {
        member_name(&self.name, index)
    }

    /// What distinguishes member number `index`: `time.cfl=0.1, scheme.kernel=lucy`.
    pub fn label(&self, index: usize, level: Level) -> String {
        let each = self.values(index, level);
        let each = each.iter().map(|(key, value)| format!("{}={}", key.path.value, value.text));
        each.collect::<Vec<_>>().join(", ")
    }

    /// The keys with the values that member number `index` has.
    pub fn values(&self, index: usize, level: Level) -> Vec<(&SweepKey, &SweepValue)> {
        let keys = self.keys(level);
        let each = keys.iter().zip(coordinates(keys, index));
        each.filter_map(|(key, number)| Some((key, &key.values.get(number)?.value))).collect()
    }
}

/// The numbers of the values that member number `index` has, the last key fastest.
pub fn coordinates(keys: &[SweepKey], index: usize) -> Vec<usize> {
    let mut rest = index;
    let mut numbers: Vec<usize> = keys
        .iter()
        .rev()
        .map(|key| {
            let count = key.values.len().max(1);
            let number = rest % count;
            rest /= count;
            number
        })
        .collect();
    numbers.reverse();
    numbers
}

/// The name of member number `index`, from 0, of the sweep called `sweep`.
pub(in crate::case) fn member_name(sweep: &str, index: usize) -> String {
    format!("{sweep}.{}", index + 1)
}

/// The sweep and the number from 0 that the name of a member means.
pub(in crate::case) fn member_of(name: &str) -> Option<(&str, usize)> {
    let (sweep, number) = name.split_once('.')?;
    Some((sweep, number.parse::<usize>().ok()?.checked_sub(1)?))
}

impl Members {
    /// Whether member number `index` of `sweep` is among them.
    pub fn includes(&self, sweep: &Sweep, index: usize, level: Level) -> bool {
        let numbers = coordinates(sweep.keys(level), index);
        index < sweep.count(level)
            && self
                .fixed
                .iter()
                .zip(numbers)
                .all(|(fixed, number)| fixed.is_none_or(|f| f == number))
    }

    /// The numbers of the members, in order.
    pub fn indices(&self, sweep: &Sweep, level: Level) -> Vec<usize> {
        (0..sweep.count(level)).filter(|index| self.includes(sweep, *index, level)).collect()
    }

    /// The members in lines along their key, one for each value of the other key; a line for each single member if
    /// there is no such key.
    pub fn lines(&self, sweep: &Sweep, level: Level) -> Vec<Vec<usize>> {
        let keys = sweep.keys(level);
        let mut lines: Vec<(Vec<usize>, Vec<usize>)> = Vec::new();
        for index in self.indices(sweep, level) {
            let mut others = coordinates(keys, index);
            if let Some(along) = self.along {
                others.remove(along);
            }
            match lines.iter_mut().find(|(known, _)| *known == others) {
                Some((_, line)) => line.push(index),
                None => lines.push((others, vec![index])),
            }
        }
        lines.into_iter().map(|(_, line)| line).collect()
    }
}
