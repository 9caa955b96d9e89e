//! Functions from outside in place of expressions.

use std::fmt;
use std::sync::Arc;

use crate::boundaries::SpaceTime;

/// What stands before the name of a function where a case has an expression.
pub(super) const MARK: char = '@';

/// Functions of place and time by name. Where a case has an expression, `"@NAME"` is the one of that name. What a run
/// with functions does is not in its record: whoever resumes it has to give the same ones.
#[derive(Clone, Default)]
pub struct Functions(Vec<(String, Arc<dyn SpaceTime>)>);

impl Functions {
    /// Adds one, in place of what had its name.
    pub fn insert(&mut self, name: impl Into<String>, function: Arc<dyn SpaceTime>) {
        let name = name.into();
        self.0.retain(|(known, _)| *known != name);
        self.0.push((name, function));
    }

    /// The one of a name.
    pub fn get(&self, name: &str) -> Option<&Arc<dyn SpaceTime>> {
        self.0.iter().find(|(known, _)| known == name).map(|(_, function)| function)
    }

    /// All names.
    pub fn names(&self) -> impl Iterator<Item = &str> {
        self.0.iter().map(|(name, _)| name.as_str())
    }
}

impl fmt::Debug for Functions {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        formatter.debug_list().entries(self.names()).finish()
    }
}

/// The same functions, not such that do the same.
impl PartialEq for Functions {
    fn eq(&self, other: &Self) -> bool {
        let is_same = |(one, other): (&(String, Arc<dyn SpaceTime>), &(String, _))| {
            one.0 == other.0 && Arc::ptr_eq(&one.1, &other.1)
        };
        self.0.len() == other.0.len() && self.0.iter().zip(&other.0).all(is_same)
    }
}

impl Eq for Functions {}
