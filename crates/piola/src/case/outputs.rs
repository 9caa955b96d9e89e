//! The files of a run.

use std::path::{Path, PathBuf};
use std::time::SystemTime;

use super::assembly::{Built, bodies::BodyReport};
use super::finished::{Finished, RUN_QUANTITIES};
use super::model::{self, Case};
use super::report::charts;
use super::resume::{Resumed, Store};
use super::session::RunError;
use crate::observe::{
    FrameWriter, PictureRequest, PictureWriter, Series, SpaceTime, Tables, WrittenFiles,
};
use crate::output::checkpoint::Identity;
use crate::output::{
    self, BodyRecord, Bounds, Column, Compression, Curve, FigureRecord, LinearRecord, Map,
    RankRecord, ReferenceRecord, ResultsFolder, RetryRecord, RunRecord, StageRecord, SystemRecord,
    Table, atomic, report, timestamp,
};
use crate::time::{Observer, Outcome, Schedule, Trace};

/// Points of a reference curve that are marked at most, so that the curve is seen between them.
const MARKS: usize = 40;

/// The results folder of a run and what is written into it.
pub(super) struct Outputs {
    folder: ResultsFolder,
    record: RunRecord,
    written: WrittenFiles,
}

impl Outputs {
    /// What goes into `folder`, which is not touched yet.
    pub fn new(case: &Case, built: &Built, device: Option<&String>, folder: &Path) -> Self {
        Self {
            folder: ResultsFolder::at(folder),
            record: Self::record(case, built, device),
            written: WrittenFiles::default(),
        }
    }

    /// Makes the folder ready, for a new run or for one that continues from a checkpoint that was found, and writes the
    /// first record.
    pub fn begin(&mut self, resumed: Option<&Resumed>) -> Result<(), RunError> {
        let Self { folder, record, written } = self;
        let Some(resumed) = resumed else {
            ResultsFolder::create(folder.path(), record)?;
            return Ok(());
        };
        if let Ok(before) = RunRecord::read(&folder.record()) {
            record.started = before.started;
            record.resumed_at = before.resumed_at;
        }
        record.resumed_at.push(resumed.time);
        record.warnings.extend(resumed.warnings.iter().cloned());
        folder.go_on(record, &resumed.files)?;
        resumed.files.iter().for_each(|file| written.push(folder.path().join(file)));
        Ok(())
    }

    /// The folder.
    pub fn folder(&self) -> &Path {
        self.folder.path()
    }

    /// Where the checkpoints of the run `identity` go.
    pub fn store(&self, case: &Case, identity: Identity) -> Store {
        let (folder, written) = self.for_tables();
        let (more_in_reserve, keep) = (case.more_in_reserve, case.checkpoint.keep);
        Store { folder, identity, written, more_in_reserve, keep }
    }

    fn record(case: &Case, built: &Built, device: Option<&String>) -> RunRecord {
        RunRecord {
            case_file: case.sources()[0].name.clone(),
            id: case.id.clone(),
            title: case.title.clone(),
            variant: case.variant.clone(),
            case_text: case.as_run.clone(),
            overrides: case.sources()[1..].iter().map(|flag| flag.text.clone()).collect(),
            seeds: case.bodies.iter().map(|body| body.lattice.seed).collect(),
            threads: rayon::current_num_threads(),
            device: device.cloned(),
            dimension: case.dimension,
            bodies: built
                .bodies
                .iter()
                .map(|body| BodyRecord {
                    name: body.name.clone(),
                    particles: body.particles,
                    spacing: body.spacing.clone(),
                })
                .collect(),
            started: timestamp(SystemTime::now()),
            end_time: *case.time.end,
            notes: built.notes.clone(),
            warnings: built.warnings.clone(),
            ..RunRecord::default()
        }
    }

    /// Where the tables go.
    pub fn for_tables(&self) -> (ResultsFolder, WrittenFiles) {
        (self.folder.clone(), self.written.clone())
    }

    /// The observers that write particle files and pictures.
    pub fn observers(&self, case: &Case, bodies: &[BodyReport]) -> Vec<Box<dyn Observer>> {
        let frames = FrameWriter::new(
            self.folder.clone(),
            Schedule::Every(*case.output.every),
            case.output.fields.iter().map(|field| field.name).collect(),
            match case.output.compression {
                model::Compression::None => Compression::None,
                model::Compression::Zlib => Compression::Zlib,
            },
            self.written.clone(),
        );
        let mut observers: Vec<Box<dyn Observer>> = vec![Box::new(frames)];
        let spacings = bodies.iter().flat_map(|body| &body.spacing);
        let spacing = spacings.copied().fold(f64::INFINITY, f64::min);
        // In 3D walls would hide what is between them.
        let is_wall = |body: &model::Body| case.dimension == 3 && body.wall.is_some();
        let walls = (0..).zip(&case.bodies).filter(|(_, body)| is_wall(body));
        let hidden: Vec<u32> = walls.map(|(number, _)| number).collect();
        for picture in &case.pictures {
            let times = picture.times.iter().map(|time| time.value).collect();
            observers.push(Box::new(PictureWriter::new(
                self.folder.clone(),
                Schedule::at(times),
                PictureRequest {
                    title: case.title.clone(),
                    field: picture.field.value,
                    range: picture.range,
                    part: picture.part.as_ref().map(corners),
                    spacing,
                    hidden: hidden.clone(),
                },
                self.written.clone(),
            )));
        }
        observers
    }

    /// Draws the charts, completes the record, and lists all files.
    pub fn finish(
        mut self,
        case: &Case,
        finished: &Finished,
        build_seconds: f64,
    ) -> Result<Vec<PathBuf>, RunError> {
        for plot in &case.plots {
            let path = self.folder.plot(&plot.name)?;
            match plot.over_time {
                false => chart(case, plot, &finished.tables).write_png(&path)?,
                true => match map(case, plot, &finished.tables) {
                    Some(map) => map.write_png(&path)?,
                    // The run ended before the line was looked at.
                    None => continue,
                },
            };
            self.written.push(path);
        }
        self.copy_references(case)?;
        if let Some(trace) = &finished.summary.trace {
            let path = self.folder.failure();
            failure_table(trace).write_csv(&path)?;
            self.written.push(path);
        }
        let mut files = self.written.list();
        let summary = &finished.summary;
        let record = &mut self.record;
        record.notes.clone_from(&finished.notes);
        record.finished = Some(timestamp(SystemTime::now()));
        record.outcome = summary.outcome.summary();
        if let Outcome::Failed(failure) = &summary.outcome {
            record.message = Some(failure.to_string());
        }
        record.warnings.clone_from(&finished.warnings);
        let retries = summary.retries.iter().map(|retry| RetryRecord {
            failure: retry.failure.clone(),
            step: retry.step,
            back_to: retry.back_to,
            factor: retry.factor,
        });
        record.retries = retries.collect();
        record.steps = summary.steps;
        record.time_reached = summary.time;
        let build =
            StageRecord { name: "build".into(), seconds: build_seconds, calls: 1, bytes: None };
        let stages = summary.timings.iter().map(|timing| StageRecord {
            name: timing.stage.into(),
            seconds: timing.seconds,
            calls: timing.calls,
            bytes: None,
        });
        record.stages = std::iter::once(build).chain(stages).collect();
        let phases = summary.phases.iter();
        // Of one of several ranks, and on a device, other bytes are moved than by the stages of all particles.
        let is_counted = summary.ranks.is_empty() && record.device.is_none();
        let passes = phases.flat_map(|phase| {
            phase.stages.iter().zip(&phase.traffic).map(|((stage, watch), traffic)| StageRecord {
                name: format!("{}: {}", phase.name, stage.name),
                seconds: watch.total.as_secs_f64(),
                calls: watch.calls,
                bytes: is_counted.then(|| (traffic.least * phase.particles as f64).round()),
            })
        });
        record.passes = passes.collect();
        let ranks = summary.ranks.iter().map(|rank| RankRecord {
            particles: rank.particles,
            computed: rank.computed,
            waited: rank.waited,
            messages: rank.messages,
            bytes: rank.bytes,
        });
        record.ranks = ranks.collect();
        record.linear = finished.linear.map(|costs| LinearRecord {
            method: if costs.direct { "direct" } else { "krylov" }.into(),
            factor_entries: costs.factor_entries,
            steps: costs.steps,
            assembly: costs.assembly.as_secs_f64(),
            factorisation: costs.factorisation.as_secs_f64(),
            solution: costs.solution.as_secs_f64(),
        });
        let own_steps = finished.own_steps.iter();
        let own_steps =
            own_steps.map(|(name, steps)| SystemRecord { name: name.clone(), steps: *steps });
        record.own_steps = own_steps.collect();
        record.figures = RUN_QUANTITIES
            .iter()
            .filter_map(|name| match finished.quantity(&format!("run.{name}")) {
                Some(Series::Number { value, unit }) => {
                    Some(FigureRecord { name: (*name).into(), value, unit: unit.into() })
                }
                _ => None,
            })
            .collect();
        record.files = files.iter().map(|file| self.folder.relative(file)).collect();
        record.write(&self.folder.record())?;
        files.push(self.folder.record());
        Ok(files)
    }

    /// Copies the reference curves of the checks, so that the folder can be read without the case.
    /// One that cannot be read is left to the check that uses it.
    fn copy_references(&mut self, case: &Case) -> Result<(), RunError> {
        let folder = Path::new(&case.sources()[0].name).parent().unwrap_or(Path::new(""));
        for file in case.checks.iter().filter_map(model::Check::file) {
            // The case as run names files as its author wrote them.
            let written = file.strip_prefix(folder).unwrap_or(file).to_string_lossy().into_owned();
            let known = self.record.references.iter().any(|one| one.path == written);
            if known || Curve::read_csv(file).is_err() {
                continue;
            }
            let Ok(bytes) = std::fs::read(&file.value) else { continue };
            let name = file.file_name().unwrap_or_default().to_string_lossy();
            let copy = self.folder.reference(self.record.references.len(), &name)?;
            atomic::write_file(&copy, |out| out.write_all(&bytes))?;
            let file = self.folder.relative(&copy);
            self.record.references.push(ReferenceRecord { path: written, file });
            self.written.push(copy);
        }
        Ok(())
    }
}

/// What happened around the first bad particle, as a table.
fn failure_table(trace: &Trace) -> Table {
    let columns = trace.columns.iter().map(|(name, unit)| Column::new(name, *unit));
    let mut table = Table::new(columns.collect());
    table.set_numbers(trace.numbers.clone()).expect("a trace has whole rows");
    table
}

/// The map of a column over place and time, if it was recorded at all.
fn map<'a>(case: &'a Case, plot: &model::Plot, tables: &'a Tables) -> Option<Map<'a>> {
    let name = plot.curves.first()?.name();
    let kept = tables.over_time.iter().find(|kept| kept.column.name == name)?;
    let SpaceTime { column, distances, times, values } = kept;
    let title = &case.title;
    (!times.is_empty()).then_some(Map { title, column, distances, times, values })
}

/// The chart of some columns, with the reference curves of checks.
fn chart(case: &Case, plot: &model::Plot, tables: &Tables) -> output::Plot {
    let names: Vec<String> = plot.curves.iter().map(|quantity| quantity.name()).collect();
    let report::Chart { across, mut series, .. } = charts::chart("", &names, Some(case), tables);
    for reference in series.iter_mut().filter(|series| series.style == output::Style::Marks) {
        let every = reference.points.len().div_ceil(MARKS).max(1);
        reference.points = reference.points.iter().copied().step_by(every).collect();
    }
    output::Plot { title: case.title.clone(), abscissa: across, series }
}

/// A part of space from one corner to the other.
fn corners([from, to]: &[Vec<f64>; 2]) -> Bounds {
    let padded =
        |corner: &[f64]| std::array::from_fn(|axis| corner.get(axis).copied().unwrap_or(0.0));
    Bounds { min: padded(from), max: padded(to) }
}
