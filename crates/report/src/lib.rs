//! Files that a run leaves: particles for ParaView, tables, pictures, charts and the record.
//!
//! Everything here takes plain data (a [`Snapshot`](piola_physics::fields::Snapshot), a [`Table`], a
//! [`RunRecord`]); nothing knows a scheme or the case file. Every file appears whole or not at all
//! ([`atomic`]), and every refusal is an [`OutputError`] that tells what to do.
//!
//! | file | made by |
//! |---|---|
//! | particles of one instant for ParaView | [`vtp::write`] |
//! | their time series | [`pvd::write`] |
//! | tables of probes, energies and steps | [`Table::write_csv`] |
//! | reference curves, read | [`Curve::read_csv`] |
//! | particles coloured by a number | [`Picture::write_png`] |
//! | curves against time | [`Plot::write_png`] |
//! | values over place and time | [`Map::write_png`] |
//! | all of a run in one page | [`report::write`] |
//! | where a run can go on from | [`checkpoint::write`] |
//! | what was run and how it went | [`RunRecord::write`] |
//! | where all that lies | [`ResultsFolder`] |

pub mod atomic;
pub mod checkpoint;
mod csv_reader;
mod drawing;
mod error;
mod folder;
mod head;
mod map;
mod picture;
mod plot;
pub mod pvd;
mod record;
pub mod report;
mod table;
mod text;
pub mod vtp;
pub mod vtp_reader;

pub use checkpoint::CheckpointError;
pub use csv_reader::{Curve, TableError};
pub use error::OutputError;
pub use folder::ResultsFolder;
pub use map::Map;
pub use picture::{Bounds, Picture, When};
pub use plot::{Plot, Series, Style};
pub use record::{
    BodyRecord, FigureRecord, LinearRecord, RankRecord, RecordError, ReferenceRecord, RetryRecord,
    RunRecord, StageRecord, SystemRecord, timestamp,
};
pub use table::{Column, Table};
pub use text::{DIGITS, significant};
pub use vtp::Compression;
