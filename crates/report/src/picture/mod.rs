//! Pictures of the particles coloured by a number each, as PNG.
//!
//! 1D: the number against x. 2D: the particles as discs as wide as their spacing, x and y to the
//! same scale. 3D: spheres in parallel projection ([`space`]). A bar tells the numbers of the
//! colours.

mod line;
mod plane;
mod space;

use std::path::Path;

use super::drawing::canvas::{GREY, MAGENTA};
use super::drawing::colour_bar::ColourBar;
use super::drawing::ticks;
use super::head::Head;
use super::{OutputError, atomic};
use piola_physics::fields::is_absent;

/// Length of the longer side of a picture in pixels, about.
const LONG: f32 = 1200.0;

/// What to draw. All slices go particle by particle.
#[derive(Clone, Copy, Debug)]
pub struct Picture<'a> {
    /// Stands above; long ones are wrapped and at last cut.
    pub title: &'a str,
    /// What is written below the title.
    pub when: Option<When>,
    /// What the numbers are, for example `pressure` or `velocity.x`.
    pub label: &'a str,
    /// Their SI unit, `1` for a pure number.
    pub unit: &'a str,
    /// 1, 2 or 3.
    pub dimension: usize,
    /// Positions in m, `particles * dimension` numbers.
    pub positions: &'a [f64],
    /// One number a particle. Those that are not finite are drawn in magenta, and a note says so; those
    /// that are [absent](piola_physics::fields::ABSENT) in grey.
    pub values: &'a [f64],
    /// Spacing of the particles in m: the diameter of a dot.
    pub spacing: f64,
    /// The diameter of each dot in spacings; empty where all are one.
    pub widths: &'a [f64],
    /// Numbers of the first and the last colour; by default those of the smallest and the largest
    /// finite value. A range as wide below 0 as above is drawn from blue over grey to red.
    pub range: Option<[f64; 2]>,
    /// Region to be shown, by default that of the particles. Pictures of one region and range
    /// make a film.
    pub bounds: Option<Bounds>,
}

/// Where a run is.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum When {
    /// Simulated time in s.
    Time(f64),
    /// In statics, the factor of the loads.
    LoadFactor(f64),
}

/// A box that holds particles.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Bounds {
    /// Smallest coordinates in m, 0 beyond the dimension.
    pub min: [f64; 3],
    /// Largest coordinates in m, 0 beyond the dimension.
    pub max: [f64; 3],
}

impl Bounds {
    /// Whether a place is in it.
    pub fn contains(&self, place: &[f64]) -> bool {
        let mut all = place.iter().zip(self.min.iter().zip(&self.max));
        all.all(|(at, (min, max))| (min..=max).contains(&at))
    }

    /// The bounds of the particles at `positions` (`particles * dimension` numbers), without those
    /// that are not finite or beyond any measure; `None` if there is no other.
    pub fn of(dimension: usize, positions: &[f64]) -> Option<Self> {
        let mut bounds: Option<Self> = None;
        for at in positions.chunks_exact(dimension.clamp(1, 3)).filter(|at| drawable(at)) {
            let mut point = [0.0; 3];
            point[..at.len()].copy_from_slice(at);
            let own = Self { min: point, max: point };
            bounds = Some(bounds.map_or(own, |bounds| bounds.union(own)));
        }
        bounds
    }

    /// The smallest bounds that hold both.
    pub fn union(self, other: Self) -> Self {
        let pick = |choose: fn(f64, f64) -> f64, one: [f64; 3], two: [f64; 3]| {
            [0, 1, 2].map(|axis| choose(one[axis], two[axis]))
        };
        Self { min: pick(f64::min, self.min, other.min), max: pick(f64::max, self.max, other.max) }
    }
}

/// Whether a particle has a place that a picture can show.
fn drawable(position: &[f64]) -> bool {
    position.iter().all(|coordinate| coordinate.abs() < 1e100)
}

impl Picture<'_> {
    /// Draws the picture and writes it to the file `path`, and returns its length in bytes.
    ///
    /// # Errors
    /// The file cannot be written, the lengths of the slices contradict each other, or the
    /// dimension is none.
    pub fn write_png(&self, path: &Path) -> Result<u64, OutputError> {
        let got = self.dimension;
        if !(1..=3).contains(&got) {
            return Err(OutputError::WrongDimension { path: path.into(), got });
        }
        let (expected, got) = (self.values.len() * self.dimension, self.positions.len());
        if expected != got {
            let what = "the array of positions".into();
            return Err(OutputError::WrongLength { path: path.into(), what, expected, got });
        }
        let canvas = match self.dimension {
            1 => line::draw(self),
            2 => plane::draw(self),
            _ => space::draw(self),
        };
        atomic::write_file(path, |out| canvas.write_png(out))
    }

    /// The particles that have a place, with their values.
    fn particles(&self) -> impl Iterator<Item = (&[f64], f64)> {
        let positions = self.positions.chunks_exact(self.dimension);
        positions.zip(self.values.iter().copied()).filter(|(at, _)| drawable(at))
    }

    /// The same with the diameter of their dots in spacings.
    fn dots(&self) -> impl Iterator<Item = (&[f64], f64, f64)> {
        let positions = self.positions.chunks_exact(self.dimension);
        let widths = self.widths.iter().copied().chain(std::iter::repeat(1.0));
        let all = positions.zip(self.values.iter().copied()).zip(widths);
        all.map(|((at, value), width)| (at, value, width)).filter(|(at, ..)| drawable(at))
    }

    /// Numbers of the first and the last colour.
    fn value_range(&self) -> [f64; 2] {
        let own = || ticks::range_of(self.particles().map(|(_, value)| value));
        ticks::usable_range(self.range.unwrap_or_else(own))
    }

    /// The spacing, or where it is unknown one with which the particles would fill `bounds`.
    fn usable_spacing(&self, bounds: Bounds) -> f64 {
        if self.spacing > 1e-100 && self.spacing < 1e100 {
            return self.spacing;
        }
        let widest = widest(bounds);
        let count = self.values.len().max(1) as f64;
        let spacing = widest / count.powf(1.0 / self.dimension as f64);
        if spacing > 1e-100 { spacing } else { 1.0 }
    }

    /// The region to be shown: the bounds with half a spacing and a little more around them.
    fn region(&self) -> (Bounds, f64) {
        let origin = Bounds { min: [0.0; 3], max: [0.0; 3] };
        let usable = |bounds: &Bounds| {
            let in_order = (0..3).all(|axis| bounds.min[axis] <= bounds.max[axis]);
            in_order && drawable(&bounds.min) && drawable(&bounds.max)
        };
        let given = self.bounds.filter(usable);
        let bounds = given.or_else(|| Bounds::of(self.dimension, self.positions)).unwrap_or(origin);
        let spacing = self.usable_spacing(bounds);
        // The floor keeps the width above the rounding of coordinates far from the origin.
        let farthest =
            bounds.min.into_iter().chain(bounds.max).fold(0.0, |a: f64, b| a.max(b.abs()));
        let around = (0.5 * spacing + 0.015 * widest(bounds)).max(1e-9 * farthest);
        let grown = Bounds {
            min: bounds.min.map(|coordinate| coordinate - around),
            max: bounds.max.map(|coordinate| coordinate + around),
        };
        (grown, spacing)
    }

    /// Title, time and what a reader has to know of particles that cannot be drawn well.
    /// `outside` counts those beyond the frame.
    fn head(&self, outside: usize) -> Head {
        let mut notes = Vec::new();
        match self.when {
            Some(When::Time(time)) => notes.push(format!("t = {} s", ticks::number(time))),
            Some(When::LoadFactor(factor)) => {
                notes.push(format!("load factor {}", ticks::number(factor)));
            }
            None => {}
        }
        let is_broken = |value: f64| !value.is_finite() && !is_absent(value);
        let magenta = self.particles().filter(|(_, value)| is_broken(*value)).count();
        let placeless = self.values.len() - self.particles().count();
        if self.values.is_empty() {
            notes.push("no particles".into());
        }
        if magenta > 0 {
            notes.push(format!("{magenta} without a finite value (magenta)"));
        }
        if placeless > 0 {
            notes.push(format!("{placeless} without a finite position (not drawn)"));
        }
        if outside > 0 {
            notes.push(format!("{outside} outside the frame"));
        }
        Head::new(self.title, notes)
    }
}

fn widest(bounds: Bounds) -> f64 {
    (0..3).map(|axis| bounds.max[axis] - bounds.min[axis]).fold(0.0, f64::max)
}

/// The colour of `value` on `bar`.
fn colour(bar: &ColourBar, value: f64) -> super::drawing::canvas::Colour {
    match value {
        _ if value.is_finite() => bar.colour(value),
        _ if is_absent(value) => GREY,
        _ => MAGENTA,
    }
}

/// Radius in pixels of a dot for particles that are `spacing` pixels apart: they touch. Where they
/// are a few pixels wide only, the white between discs would wash their colour out, so they grow
/// until they cover it.
fn dot_radius(spacing: f32) -> f32 {
    const FINE: f32 = 2.0;
    const COARSE: f32 = 8.0;
    let fine = ((COARSE - spacing) / (COARSE - FINE)).clamp(0.0, 1.0);
    (0.5 * spacing * (1.0 + 0.6 * fine)).clamp(0.7, 60.0)
}
