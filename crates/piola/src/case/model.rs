//! The case as types: what a case file says once every name is known and every number checked.
//!
//! Vectors have as many components as the case has dimensions. Lengths are in m, SI throughout.
//! Values that only the builder can judge (a selection that may select nothing, a body that may
//! be empty) are [`Located`], so that it can point at them with [`Case::problem_at`].

use std::path::PathBuf;
use std::sync::Arc;

use piola_device::Precision;

use super::diagnostics::{Problem, Problems};
use super::expression::{Expression, Scope};
use super::source::{Located, Place, SourceText};

mod checks;
mod geometry;
mod loads;
mod materials;
mod observers;
mod schemes;
mod sweeps;
mod systems;
mod time;

pub use checks::{Against, Check, Expectation, Level, Members, Quantity, Reduction, Trend, When};
pub use geometry::{
    Body, Domain, Initial, Lattice, LatticeKind, LatticeOrigin, Region, Shape, Surface,
};
pub use loads::{Boundary, Load, LoadKind, Roller, Turning};
pub use materials::{Material, OpenFlow, Opening, PlaneState, Profile, Stiffness, Wall};
pub use observers::{Compression, Extremum, Output, Picture, Plot, Probe, ProbeKind};
pub use schemes::{
    Dissipation, GradientKind, Interpolation, Preset, Scheme, SupportSize, TotalLagrangian,
    TransportVelocity, Upwind, Weights,
};
pub use sweeps::{Sweep, SweepKey, SweepValue, coordinates};
pub(super) use sweeps::{member_name, member_of};
pub use systems::System;
pub use time::{Checkpoint, StepControl, Time};

/// One case: everything that a run needs to know.
#[derive(Clone, Debug)]
pub struct Case {
    /// Row of the reproduction list, for example `U10`.
    pub id: Option<String>,
    /// What the case shows, in one line.
    pub title: String,
    /// Whether the case as it stands, without a variant, runs with `--long` only.
    pub is_long: bool,
    /// 1, 2 or 3.
    pub dimension: usize,
    /// Named numbers in the order of the file.
    pub parameters: Vec<Parameter>,
    /// The space that the particles live in.
    pub domain: Domain,
    /// At least one.
    pub bodies: Vec<Body>,
    /// The formulation with its settings.
    pub scheme: Located<Scheme>,
    /// Formulations of other bodies than those of the main one.
    pub systems: Vec<System>,
    /// Clock and integrator.
    pub time: Time,
    /// When checkpoints are written.
    pub checkpoint: Checkpoint,
    /// The device that computes, if it is not the processor.
    pub device: Option<Located<String>>,
    /// The precision of what it computes of pairs.
    pub precision: Precision,
    /// How many ranks share the particles, if there are several.
    pub ranks: Option<Located<u64>>,
    /// Body forces and tractions.
    pub loads: Vec<Load>,
    /// Prescribed velocities.
    pub boundaries: Vec<Boundary>,
    /// Quantities that are recorded against time.
    pub probes: Vec<Probe>,
    /// What is written and when.
    pub output: Output,
    /// Pictures of the particles.
    pub pictures: Vec<Picture>,
    /// Curves against time.
    pub plots: Vec<Plot>,
    /// Overrides of the coarse setting.
    pub coarse: Vec<String>,
    /// The settings in which the publication differs from the case as it stands.
    pub paper: Option<PaperSetting>,
    /// The same case with other settings.
    pub variants: Vec<Variant>,
    /// The same case with every value of some keys.
    pub sweeps: Vec<Sweep>,
    /// What `piola verify` evaluates.
    pub checks: Vec<Check>,
    /// The variant or member of a sweep that this is, `None` for the base case.
    pub variant: Option<String>,
    /// The setting whose overrides are applied.
    pub level: Level,
    /// Whether overrides of the command line are applied.
    pub is_changed: bool,
    /// How many more particles wait to be born than the scheme asks for: a run has needed them.
    pub more_in_reserve: usize,
    /// Remarks on the parts of the case that are left out of this run.
    pub remarks: Vec<String>,
    /// The case after all overrides, as TOML without comments, for the record of the run.
    pub as_run: String,
    /// The case file first, then one text for each override of the command line.
    pub(super) sources: Arc<[SourceText]>,
}

/// A named number, usable in every expression.
#[derive(Clone, Debug, PartialEq)]
pub struct Parameter {
    /// Its name.
    pub name: String,
    /// Its value.
    pub value: f64,
}

/// The same case with other values of some keys.
#[derive(Clone, Debug, PartialEq)]
pub struct Variant {
    /// Name on the command line and in checks. Members of sweeps are not in this list.
    pub name: Located<String>,
    /// What it shows, in one line.
    pub title: Option<String>,
    /// Overrides, each `path.to.key=value`.
    pub set: Vec<String>,
    /// Overrides that come on top in the coarse setting.
    pub coarse: Vec<String>,
    /// What is known of the run in the case as it stands.
    pub traits: RunTraits,
}

/// The overrides that give the publication's particle numbers, steps and parameters.
#[derive(Clone, Debug, PartialEq)]
pub struct PaperSetting {
    /// Overrides, each `path.to.key=value`; none where the case as it stands has them already.
    pub set: Vec<String>,
    /// Whether it runs with `--long` only.
    pub is_long: bool,
}

/// What is known of the runs of a variant or a sweep in the case as it stands.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct RunTraits {
    /// They have the publication's particle numbers, steps and parameters.
    pub is_paper: bool,
    /// They run with `--long` only.
    pub is_long: bool,
}

impl Case {
    /// The case file and the overrides of the command line, as [`Place::source`] numbers them.
    pub fn sources(&self) -> &[SourceText] {
        &self.sources
    }

    /// The positions at the start of the particles of the body with this number in m, in the order of creation, one after the
    /// other: that of clouds of points, and of arrays of initial values. There is none of a body that the case does not have.
    ///
    /// # Errors
    /// What is wrong with the body or the domain.
    pub fn positions(&self, body: usize) -> Result<Vec<f64>, Problems> {
        super::assembly::positions(self, body)
    }

    /// A problem with the value at `place`: a sentence, a few words for the underlined text, and
    /// what the user can do about it.
    pub fn problem_at(
        &self,
        place: Place,
        message: impl Into<String>,
        label: impl Into<String>,
        help: Option<String>,
    ) -> Problem {
        Problem { message: message.into(), label: label.into(), place: Some(place), help }
    }

    /// Problems that were found after reading, as an error that shows them in the case file.
    pub fn refuse(&self, problems: Vec<Problem>) -> Problems {
        Problems::new(self.sources.clone(), problems)
    }

    /// The number of the body called `name`.
    pub fn body_index(&self, name: &str) -> Option<usize> {
        self.bodies.iter().position(|body| *body.name == name)
    }

    /// The value of the parameter called `name`.
    pub fn parameter(&self, name: &str) -> Option<f64> {
        self.parameters.iter().find(|parameter| parameter.name == name).map(|found| found.value)
    }

    /// The value of an expression of the parameters, `None` if `text` is not one.
    pub fn evaluate(&self, text: &str) -> Option<f64> {
        let parameters: Vec<_> =
            self.parameters.iter().map(|known| (known.name.clone(), Some(known.value))).collect();
        let scope = Scope::of_parameters(&parameters);
        Expression::parse(text, &scope).ok()?.as_constant()
    }

    /// Everything that can be run: the case itself, its variants, and the members of its sweeps.
    pub fn settings(&self) -> Vec<Option<String>> {
        let variants = self.variants.iter().map(|variant| variant.name.value.clone());
        let members = self.sweeps.iter().flat_map(|sweep| {
            let count = Level::ALL.map(|level| sweep.count(level)).into_iter().max().unwrap_or(0);
            (0..count).map(|index| sweep.member(index))
        });
        std::iter::once(None).chain(variants.chain(members).map(Some)).collect()
    }

    /// Whether the sweep member called `name` exists at a setting. Variants exist at all settings.
    pub fn is_at(&self, name: &str, level: Level) -> bool {
        member_of(name).is_none_or(|(sweep, index)| {
            let sweep = self.sweeps.iter().find(|known| *known.name == sweep);
            sweep.is_some_and(|sweep| index < sweep.count(level))
        })
    }

    /// The sweep whose member is called `name`, with the member's number from 0. `None` for names of
    /// variants.
    pub fn member(&self, name: &str) -> Option<(&Sweep, usize)> {
        let (sweep, index) = member_of(name)?;
        let sweep = self.sweeps.iter().find(|known| *known.name == sweep)?;
        (index < sweep.count(self.level)).then_some((sweep, index))
    }

    /// What distinguishes the sweep member called `name`: `time.cfl=0.1`. `None` for names of variants.
    pub fn member_label(&self, name: &str) -> Option<String> {
        let (sweep, index) = self.member(name)?;
        Some(sweep.label(index, self.level))
    }

    /// What is known of the run of the case itself (`None`), or of the variant or member of this name,
    /// at the setting that was read.
    pub fn traits_of(&self, name: Option<&str>) -> RunTraits {
        let of_case = match self.level {
            Level::Coarse => return RunTraits::default(),
            Level::Paper => {
                let is_long = self.paper.as_ref().is_some_and(|paper| paper.is_long);
                RunTraits { is_paper: true, is_long }
            }
            Level::Case => RunTraits::default(),
        };
        let own = match name {
            None => {
                let is_paper = self.paper.as_ref().is_some_and(|paper| paper.set.is_empty());
                RunTraits { is_paper, is_long: self.is_long }
            }
            Some(name) => match self.member(name) {
                Some((sweep, _)) => sweep.traits,
                None => {
                    let variant = self.variants.iter().find(|known| *known.name == name);
                    variant.map_or(RunTraits::default(), |variant| variant.traits)
                }
            },
        };
        RunTraits {
            is_paper: of_case.is_paper || own.is_paper,
            is_long: of_case.is_long || own.is_long,
        }
    }

    /// All files that the case reads besides itself: point clouds and reference curves.
    pub fn files(&self) -> Vec<Located<PathBuf>> {
        let shapes = self.bodies.iter().flat_map(|body| body.shape.files());
        let curves = self.checks.iter().filter_map(Check::file);
        shapes.chain(curves).cloned().collect()
    }

    /// All expressions of initial fields, loads and boundaries, for checks over the whole case.
    pub fn expressions(&self) -> impl Iterator<Item = &Expression> {
        let initial = self.bodies.iter().flat_map(|body| body.initial.expressions());
        let loads = self.loads.iter().flat_map(|load| load.kind.components());
        let boundaries = self.boundaries.iter();
        let boundaries = boundaries.flat_map(|wall| {
            let components = wall.velocity.iter().chain(&wall.displacement).flatten();
            components.chain(wall.roller.iter().map(|roller| &roller.displacement))
        });
        let walls = self.bodies.iter().filter_map(|body| body.wall.as_ref());
        let sliding = walls.flat_map(|wall| wall.sliding.iter().flatten());
        let openings = self.bodies.iter().filter_map(|body| body.opening.as_ref());
        let openings = openings.flat_map(|opening| opening.flow.expressions());
        initial.chain(loads).chain(boundaries).chain(sliding).chain(openings)
    }
}
