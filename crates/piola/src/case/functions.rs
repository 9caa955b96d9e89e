//! What a program gives to a case under a name: functions and arrays in place of expressions, points in place of files.

use std::fmt;
use std::sync::Arc;

use sha2::{Digest, Sha256};

use crate::boundaries::SpaceTime;
use crate::geometry::PointCloud;

/// What stands before the name of a function where a case has an expression, and of points where it has a file.
pub(super) const MARK: char = '@';

/// Functions of place and time by name. Where a case has an expression, `"@NAME"` is the one of that name. What a run
/// with functions does is not in its record: to resume it, the same ones have to be given.
pub type Functions = Named<dyn SpaceTime>;

/// Clouds of points by name. Where a shape of the kind `points` has a file, `"@NAME"` is the cloud of that name.
/// To resume a run with clouds, the same ones have to be given; others are refused.
pub type Clouds = Named<PointCloud>;

/// Arrays by name, with a value for each particle of a body in the order of creation. Where the initial state of a body has an
/// expression, `"@NAME"` is the array of that name. To resume a run with arrays, the same ones have to be given; others
/// are refused.
pub type Arrays = Named<[f64]>;

/// Objects by name.
pub struct Named<T: ?Sized>(Vec<Entry<T>>);

type Entry<T> = (String, Arc<T>);

impl<T: ?Sized> Named<T> {
    /// Adds one, replacing any with the same name.
    pub fn insert(&mut self, name: impl Into<String>, one: Arc<T>) {
        let name = name.into();
        self.0.retain(|(known, _)| *known != name);
        self.0.push((name, one));
    }

    /// The one with this name.
    pub fn get(&self, name: &str) -> Option<&Arc<T>> {
        self.0.iter().find(|(known, _)| known == name).map(|(_, one)| one)
    }

    /// Drops those whose name is not in use.
    pub fn keep(&mut self, is_used: impl Fn(&str) -> bool) {
        self.0.retain(|(name, _)| is_used(name));
    }

    /// All names.
    pub fn names(&self) -> impl Iterator<Item = &str> {
        self.0.iter().map(|(name, _)| name.as_str())
    }
}

impl Clouds {
    /// Adds a cloud under a name derived from its numbers, and returns the name.
    pub fn add(&mut self, cloud: &Arc<PointCloud>) -> String {
        self.insert_by(numbers_of(cloud, Sha256::new()), "cloud", cloud)
    }
}

impl Arrays {
    /// Adds an array under a name derived from its numbers, and returns the name.
    pub fn add(&mut self, values: &Arc<[f64]>) -> String {
        self.insert_by(with_numbers(Sha256::new(), values.iter()), "array", values)
    }
}

impl<T: ?Sized> Named<T> {
    /// Adds something under a name derived from a sum of its numbers.
    fn insert_by(&mut self, sum: Sha256, kind: &str, one: &Arc<T>) -> String {
        let digits = sum.finalize();
        let digits: String = digits.iter().take(6).map(|byte| format!("{byte:02x}")).collect();
        let name = format!("{kind}_{digits}");
        self.insert(name.as_str(), Arc::clone(one));
        name
    }
}

/// A sum that knows of the positions and volumes of a cloud.
pub(super) fn numbers_of(cloud: &PointCloud, sum: Sha256) -> Sha256 {
    with_numbers(sum, cloud.positions().iter().chain(cloud.volumes()))
}

fn with_numbers<'a>(sum: Sha256, mut numbers: impl Iterator<Item = &'a f64>) -> Sha256 {
    numbers.by_ref().fold(sum, |sum, number| sum.chain_update(number.to_le_bytes()))
}

impl<T: ?Sized> Clone for Named<T> {
    fn clone(&self) -> Self {
        Self(self.0.clone())
    }
}

impl<T: ?Sized> Default for Named<T> {
    fn default() -> Self {
        Self(Vec::new())
    }
}

impl<T: ?Sized> fmt::Debug for Named<T> {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        formatter.debug_list().entries(self.names()).finish()
    }
}

/// The same things, not such that are alike.
impl<T: ?Sized> PartialEq for Named<T> {
    fn eq(&self, other: &Self) -> bool {
        let is_same = |(one, other): (&Entry<T>, &Entry<T>)| {
            one.0 == other.0 && Arc::ptr_eq(&one.1, &other.1)
        };
        self.0.len() == other.0.len() && self.0.iter().zip(&other.0).all(is_same)
    }
}

impl<T: ?Sized> Eq for Named<T> {}
