//! Files that a run leaves: particles for ParaView, tables, pictures, charts and the record.
//!
//! Everything here takes plain data (a [`Snapshot`](crate::fields::Snapshot), a [`Table`], a
//! [`RunRecord`]); nothing knows a scheme or the case file. Every file appears whole or not at all
//! ([`atomic`]).

pub mod atomic;
mod csv_reader;
mod error;
pub mod pvd;
mod table;
pub mod vtp;

pub use csv_reader::{Curve, TableError};
pub use error::OutputError;
pub use table::{Column, Table};
pub use vtp::Compression;
