//! Neighbour lists, periodic boxes and the order of particles in memory.
//!
//! [`search`] lists who is in whose support; [`NeighborList::dual`] and
//! [`NeighborList::symmetric_closure`] turn such a list into that of who sees whom. [`SkinList`] is
//! for particles that move. All results are the same to the bit for any number of threads.

mod axis;
mod domain;
mod dual;
mod error;
mod grid;
mod list;
mod near;
mod order;
mod parts;
mod retain;
mod search;
mod skin;

pub use domain::Domain;
pub(crate) use domain::shorter_way;
pub use error::NeighborError;
pub use list::{NeighborList, NeighborStatistics};
pub use order::spatial_order;
pub use search::{refuse_coincident, search};
pub use skin::SkinList;

/// Least support radius in m: its square must be a normal number.
const LEAST_SUPPORT: f64 = 1e-150;
/// Largest support radius in m: its square must be finite.
const MOST_SUPPORT: f64 = 1e150;
/// Most entries of a list: they are numbered with 32 bits where they refer to each other.
const MOST_ENTRIES: usize = u32::MAX as usize;
/// Most cells along an axis.
const MOST_CELLS: f64 = 4e9;

#[cfg(test)]
mod tests;
