//! An evaluation as a list of stages, each with what it reads, gathers and writes.

use std::convert::Infallible;
use std::time::{Duration, Instant};

use serde::{Deserialize, Serialize};
use thiserror::Error;

use super::ledger::{Filled, Totals};
use super::traffic::{Array, Traffic};

/// One stage of an evaluation: a pass over all particles.
///
/// What a stage writes of a particle only that particle reads, unless the stage shows it: neighbours may
/// gather what has been shown. Where particles are spread over memories that do not see each other,
/// what is shown is what has to be sent.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Stage {
    /// Its name.
    pub name: &'static str,
    /// Columns that it reads of a particle itself.
    pub reads: &'static [&'static str],
    /// Columns that it reads of neighbours.
    pub gathers: &'static [&'static str],
    /// Columns that it writes.
    pub writes: &'static [&'static str],
    /// Columns that it writes and neighbours may read from then on.
    pub shows: &'static [&'static str],
}

/// A list of stages that cannot be run one after another.
#[derive(Clone, Debug, Error, PartialEq, Eq)]
pub enum StageFault {
    /// Something is used that is not there.
    #[error("the stage `{stage}` reads `{column}`, which no stage before it writes")]
    NotWritten {
        /// The stage.
        stage: &'static str,
        /// What it reads.
        column: &'static str,
    },
    /// Something is read of neighbours that they do not show.
    #[error("the stage `{stage}` gathers `{column}`, which is not shown since it was written")]
    NotShown {
        /// The stage.
        stage: &'static str,
        /// What it gathers.
        column: &'static str,
    },
    /// A column stands in no array of the formulation.
    #[error("the stage `{stage}` has the column `{column}`, which stands in no array")]
    NoArray {
        /// The stage.
        stage: &'static str,
        /// The column.
        column: &'static str,
    },
}

/// A stop watch.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Watch {
    /// Time so far.
    pub total: Duration,
    /// How often it ran.
    pub calls: u64,
}

impl Watch {
    /// One that has not run.
    pub const ZERO: Self = Self { total: Duration::ZERO, calls: 0 };

    /// Runs `body` and adds the time it takes.
    pub fn time<T>(&mut self, body: impl FnOnce() -> T) -> T {
        let start = Instant::now();
        let value = body();
        self.total += start.elapsed();
        self.calls += 1;
        value
    }
}

/// Part of a step, as a list of stages with the time that each has taken.
#[derive(Clone, Debug, PartialEq)]
pub struct Phase {
    /// What the part of the step is called, for example `drift`.
    pub name: &'static str,
    /// Its stages in their order.
    pub stages: Vec<(Stage, Watch)>,
    /// Bytes that each of them moves, with the neighbours of the start.
    pub traffic: Vec<Traffic>,
    /// The number of particles of the system.
    pub particles: usize,
    /// The mechanisms of the ledger that they have filled.
    pub filled: Filled,
}

impl Phase {
    /// Bytes that come from memory and go there in all of its stages, for all particles: see [`Traffic::least`].
    pub fn least_bytes(&self) -> f64 {
        Traffic::sum(&self.traffic).least * self.particles as f64
    }

    /// Whether every stage finds what it needs: `state` are the columns that are there before the
    /// first, and that neighbours may gather.
    ///
    /// # Errors
    /// The first column that is used before it is there.
    pub fn check(&self, state: &[&'static str]) -> Result<(), StageFault> {
        let (mut written, mut shown) = (state.to_vec(), state.to_vec());
        for (stage, _) in &self.stages {
            let Stage { name: stage, reads, gathers, writes, shows } = *stage;
            let lacks = |there: &[&str], column: &&&str| !there.contains(*column);
            if let Some(column) = reads.iter().find(|column| lacks(&written, column)) {
                return Err(StageFault::NotWritten { stage, column });
            }
            if let Some(column) = gathers.iter().find(|column| lacks(&shown, column)) {
                return Err(StageFault::NotShown { stage, column });
            }
            shown.retain(|column| !writes.contains(column));
            shown.extend(shows);
            written.extend(writes.iter().chain(shows));
        }
        Ok(())
    }

    /// Text of the drawing in the language DOT: stages from top to bottom, and who hands which column
    /// to whom, with a bold line where neighbours gather it.
    pub fn dot(&self) -> String {
        let mut text = format!("digraph {} {{\n  node [shape=box];\n", self.name);
        let mut makers: Vec<(&str, &str)> = Vec::new();
        for (stage, _) in &self.stages {
            text += &format!("  \"{}\";\n", stage.name);
            for (columns, style) in [(stage.reads, ""), (stage.gathers, ", style=bold")] {
                let mut from: Vec<(&str, Vec<&str>)> = Vec::new();
                for column in columns {
                    let maker = makers.iter().rev().find(|(made, _)| made == column);
                    let maker = maker.map_or("state", |(_, maker)| maker);
                    match from.iter_mut().find(|(known, _)| *known == maker) {
                        Some((_, columns)) => columns.push(column),
                        None => from.push((maker, vec![column])),
                    }
                }
                for (maker, columns) in from {
                    let label = columns.join("\\n");
                    text += &format!(
                        "  \"{maker}\" -> \"{}\" [label=\"{label}\"{style}];\n",
                        stage.name
                    );
                }
            }
            let made = stage.writes.iter().chain(stage.shows);
            makers.extend(made.map(|column| (*column, stage.name)));
        }
        text + "}\n"
    }
}

/// The stages of a phase with the passes of a formulation that run them.
#[derive(Clone, Debug)]
pub(crate) struct Stages<P> {
    passes: Vec<P>,
    phase: Phase,
}

/// No stages, of a formulation that is being built or has lent them out.
impl<P> Default for Stages<P> {
    fn default() -> Self {
        Self {
            passes: Vec::new(),
            phase: Phase {
                name: "",
                stages: Vec::new(),
                traffic: Vec::new(),
                particles: 0,
                filled: Filled::default(),
            },
        }
    }
}

impl<P: Copy> Stages<P> {
    /// The stages of some passes over particles, whose columns stand in some arrays.
    ///
    /// # Errors
    /// See [`Phase::check`]; and a column that stands in no array.
    pub fn new(
        name: &'static str,
        state: &[&'static str],
        passes: Vec<P>,
        stage: impl Fn(P) -> Stage,
        (particles, arrays): (usize, &[Array]),
    ) -> Result<Self, StageFault> {
        let stages: Vec<(Stage, Watch)> =
            passes.iter().map(|&pass| (stage(pass), Watch::ZERO)).collect();
        let traffic = stages.iter().map(|(stage, _)| Traffic::of(stage, arrays));
        let traffic = traffic.collect::<Result<_, _>>()?;
        let phase = Phase { name, stages, traffic, particles, filled: Filled::default() };
        phase.check(state)?;
        Ok(Self { passes, phase })
    }

    /// Runs all passes and takes their times; adds up the totals that they fill.
    pub fn run(&mut self, mut body: impl FnMut(P, &mut Totals)) -> Totals {
        let done: Result<Totals, Infallible> = self.attempt(|pass, totals| {
            body(pass, totals);
            Ok(())
        });
        let Ok(totals) = done;
        totals
    }

    /// As [`Self::run`], up to the first pass that fails.
    ///
    /// # Errors
    /// That of the pass.
    pub fn attempt<E>(
        &mut self,
        body: impl FnMut(P, &mut Totals) -> Result<(), E>,
    ) -> Result<Totals, E> {
        self.attempt_from(0, body)
    }

    /// As [`Self::run`], of the last pass alone.
    pub fn run_last(&mut self, mut body: impl FnMut(P, &mut Totals)) -> Totals {
        let done: Result<Totals, Infallible> =
            self.attempt_from(self.passes.len().saturating_sub(1), |pass, totals| {
                body(pass, totals);
                Ok(())
            });
        let Ok(totals) = done;
        totals
    }

    fn attempt_from<E>(
        &mut self,
        first: usize,
        mut body: impl FnMut(P, &mut Totals) -> Result<(), E>,
    ) -> Result<Totals, E> {
        let (mut all, mut last) = (Totals::default(), Instant::now());
        let passes = self.passes.iter().zip(&mut self.phase.stages);
        for (&pass, (_, watch)) in passes.skip(first) {
            // What a stage has filled is its own, so that it is seen if it fills that again.
            self.phase.filled.join(std::mem::take(&mut all.filled));
            body(pass, &mut all)?;
            let now = Instant::now();
            watch.total += now - last;
            watch.calls += 1;
            last = now;
        }
        self.phase.filled.join(all.filled);
        Ok(all)
    }

    /// The passes in their order.
    pub fn passes(&self) -> &[P] {
        &self.passes
    }

    /// The stages with their times.
    pub fn phase(&self) -> &Phase {
        &self.phase
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const MAKE: Stage =
        Stage { name: "make", reads: &["x"], gathers: &[], writes: &["own"], shows: &["side"] };
    const TAKE: Stage =
        Stage { name: "take", reads: &["own"], gathers: &["side"], writes: &["y"], shows: &[] };

    const ARRAYS: [Array; 4] = [
        Array::of::<f64>("x"),
        Array::of::<f64>("own"),
        Array::of::<f64>("side"),
        Array::of::<f64>("y"),
    ];

    fn check(stages: &[Stage]) -> Result<(), StageFault> {
        let stages = stages.iter().map(|stage| (*stage, Watch::ZERO)).collect();
        Phase { stages, ..Stages::<u8>::default().phase }.check(&["x"])
    }

    #[test]
    fn nothing_is_used_before_it_is_there() {
        assert_eq!(check(&[MAKE, TAKE]), Ok(()));
        let error = check(&[TAKE]).expect_err("nobody writes it");
        assert_eq!(error, StageFault::NotWritten { stage: "take", column: "own" });
        let hidden = Stage { writes: &["own", "side"], shows: &[], ..MAKE };
        let error = check(&[hidden, TAKE]).expect_err("it is not shown");
        assert_eq!(
            error.to_string(),
            "the stage `take` gathers `side`, which is not shown since it was written"
        );
        // What was shown and is written again is out of date.
        let again = Stage { name: "again", writes: &["side"], shows: &[], ..MAKE };
        assert!(check(&[MAKE, again, TAKE]).is_err());
    }

    #[test]
    fn stages_are_run_in_their_order_and_timed() {
        let mut stages = Stages::new("test", &["x"], vec![0, 1], |k| [MAKE, TAKE][k], (1, &ARRAYS))
            .expect("good");
        let mut seen = Vec::new();
        stages.run(|pass, _| seen.push(pass));
        stages.run(|pass, _| seen.push(pass));
        assert_eq!(seen, [0, 1, 0, 1]);
        assert!(stages.phase().stages.iter().all(|(_, watch)| watch.calls == 2));
        let dot = stages.phase().dot();
        assert!(dot.contains("\"make\" -> \"take\" [label=\"side\", style=bold];"), "{dot}");
        assert!(dot.contains("\"state\" -> \"make\" [label=\"x\"];"), "{dot}");
    }
}
