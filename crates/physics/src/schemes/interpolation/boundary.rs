//! What ghosts carry, so that sums are right at the boundary.

use crate::boundaries::padded;
use crate::geometry::Particles;
use crate::operators::{BoundaryValueError, ModifiedMatrix, SphMatrices, raise_ghosts};

use super::Field;

/// Particles with a ghost nearer than this many spacings along each axis lie on the boundary: next to it
/// on the lattice, diagonals included.
const NEXT: f64 = 1.01;

/// What ghosts do.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Boundary {
    /// There are none: sums are cut off.
    Cut,
    /// There are none, and sums are divided by what they would be of one, the share of the cover that lies within the
    /// body: the "numerical factor" of 2.8.1, of which the paper says no more.
    Scaled,
    /// They carry the function on.
    Continued,
    /// They are such that the sum of the function on the boundary is its value there: in one dimension
    /// by (2.42), in more by the modified matrix of (2.46).
    Value,
    /// They are such that the sum of the gradient on the boundary is the slope there: in one dimension
    /// by (2.45). In more it is not the first sum, whose own weight is zero, but the secondary
    /// approximation, `<<grad f>> = W <grad f>`, with the modified matrix for each component.
    Slope,
}

impl Boundary {
    /// All of them.
    pub const ALL: [Self; 5] = [Self::Cut, Self::Scaled, Self::Continued, Self::Value, Self::Slope];

    /// Name in a case file.
    pub fn name(self) -> &'static str {
        match self {
            Self::Cut => "none",
            Self::Scaled => "scaled",
            Self::Continued => "continued",
            Self::Value => "value",
            Self::Slope => "slope",
        }
    }

    /// The one of that name.
    pub fn from_name(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|boundary| boundary.name() == name)
    }

    /// How far ghosts lie around a body, in support radii. A gradient of gradients sees twice as far.
    pub fn reach(self) -> f64 {
        match self {
            Self::Cut | Self::Scaled => 0.0,
            Self::Continued => 2.0,
            Self::Value | Self::Slope => 1.0,
        }
    }
}

/// How well boundary values are met, and with what.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct Outcome {
    /// Number of ghosts.
    pub count: f64,
    /// Smallest and largest value on boundary and ghosts that sums are taken of.
    pub ghosts: [f64; 2],
    /// Condition number of the modified matrix; 0 without one.
    pub condition: f64,
    /// Largest difference of a sum on the boundary from what it should be, over the largest of those.
    pub error: f64,
}

/// Particles, behind them ghosts, and the sums over both.
pub(super) struct Cloud<'a, const D: usize> {
    all: &'a Particles<D>,
    /// Number of particles that are no ghosts.
    count: usize,
    matrices: &'a SphMatrices<D>,
    function: &'a [f64],
    /// The slope along the first axis.
    slope: &'a [f64],
    /// Particles on the boundary, ascending.
    edge: Vec<u32>,
}

impl<'a, const D: usize> Cloud<'a, D> {
    pub fn new(
        all: &'a Particles<D>,
        count: usize,
        matrices: &'a SphMatrices<D>,
        [function, slope]: [&'a [f64]; 2],
    ) -> Self {
        let is_next = |a: usize, ghost: usize| {
            let distance = (all.position[a] - all.position[ghost]).abs();
            distance.max() < NEXT * all.spacing[a]
        };
        let is_edge = |a: &u32| {
            let row = matrices.value.row(*a as usize);
            row.map(|(b, _)| b as usize).any(|b| b >= count && is_next(*a as usize, b))
        };
        let edge = (0..count as u32).filter(is_edge).collect();
        Self { all, count, matrices, function, slope, edge }
    }

    /// The values that sums are taken of.
    pub fn field(
        &self,
        boundary: Boundary,
        function: &dyn Field<D>,
        outcome: &mut Outcome,
    ) -> Result<Vec<f64>, BoundaryValueError> {
        let mut field = self.function.to_vec();
        match boundary {
            Boundary::Value | Boundary::Slope if D == 1 => {
                for &end in &self.edge {
                    self.raise(boundary, function, end, &mut field)?;
                }
            }
            Boundary::Value => {
                let (selected, mut modified) = self.modified(outcome)?;
                let wanted: Vec<f64> =
                    selected.iter().map(|&a| self.function[a as usize]).collect();
                modified.impose(&wanted, &mut field)?;
            }
            _ => {}
        }
        outcome.count = (self.all.len() - self.count) as f64;
        outcome.ghosts = range(&field[self.count..]);
        Ok(field)
    }

    /// Ghosts beyond the end of a row, made of what it mirrors there, and raised.
    fn raise(
        &self,
        boundary: Boundary,
        function: &dyn Field<D>,
        end: u32,
        field: &mut [f64],
    ) -> Result<(), BoundaryValueError> {
        let SphMatrices { value, gradient } = self.matrices;
        let (b, place) = (end as usize, self.all.position[end as usize]);
        let beyond = |ghost: u32| self.all.position[ghost as usize] - place;
        let mut ghosts: Vec<u32> =
            value.row(b).map(|(a, _)| a).filter(|&a| a as usize >= self.count).collect();
        // Those on the side of the nearest one.
        let size = |ghost: &&u32| beyond(**ghost)[0].abs();
        if let Some(&first) = ghosts.iter().min_by(|a, b| size(a).total_cmp(&size(b))) {
            let side = beyond(first)[0];
            ghosts.retain(|&ghost| beyond(ghost)[0] * side > 0.0);
        }
        for &ghost in &ghosts {
            let beyond = beyond(ghost);
            let mirrored = function.value(padded(&(place - beyond)));
            field[ghost as usize] = match boundary {
                Boundary::Slope => mirrored + 2.0 * beyond[0] * self.slope[b],
                _ => 2.0 * self.function[b] - mirrored,
            };
        }
        let (sum, wanted) = match boundary {
            Boundary::Slope => (&gradient[0], self.slope[b]),
            _ => (value, self.function[b]),
        };
        raise_ghosts(sum, value, end, &ghosts, wanted, field).map(|_| ())
    }

    /// Sets the components of a gradient on boundary and ghosts so that its secondary approximation is
    /// `slopes` there, and takes that.
    pub fn meet_gradients(
        &self,
        boundary: Boundary,
        slopes: &[Vec<f64>; D],
        gradient: &mut [Vec<f64>; D],
        outcome: &mut Outcome,
    ) -> Result<(), BoundaryValueError> {
        if D == 1 || boundary != Boundary::Slope {
            return Ok(());
        }
        let (selected, mut modified) = self.modified(outcome)?;
        let mut ends = [f64::INFINITY, f64::NEG_INFINITY];
        for (component, slope) in gradient.iter_mut().zip(slopes) {
            let wanted: Vec<f64> = selected.iter().map(|&a| slope[a as usize]).collect();
            modified.impose(&wanted, component)?;
            let [low, high] = range(&component[self.count..]);
            ends = [ends[0].min(low), ends[1].max(high)];
            *component = self.matrices.value.apply(component);
        }
        outcome.ghosts = ends;
        Ok(())
    }

    /// The modified matrix, with the particles on the boundary and the ghosts that it is of.
    fn modified(
        &self,
        outcome: &mut Outcome,
    ) -> Result<(Vec<u32>, ModifiedMatrix), BoundaryValueError> {
        let ghosts = self.count as u32..self.all.len() as u32;
        let selected: Vec<u32> = self.edge.iter().copied().chain(ghosts).collect();
        let modified = ModifiedMatrix::new(&self.matrices.value, &selected, &self.all.weight)?;
        outcome.condition = modified.condition();
        Ok((selected, modified))
    }

    /// Largest difference of fields on the boundary from what they should be, over the largest of
    /// these.
    pub fn error<F: AsRef<[f64]>, G: AsRef<[f64]>>(&self, exact: &[F], found: &[G]) -> f64 {
        let (mut error, mut largest) = (0.0_f64, 0.0_f64);
        for (exact, found) in exact.iter().zip(found) {
            for &a in &self.edge {
                let [exact, found] = [exact.as_ref(), found.as_ref()].map(|it| it[a as usize]);
                error = error.max((found - exact).abs());
                largest = largest.max(exact.abs());
            }
        }
        if largest > 0.0 { error / largest } else { error }
    }
}

/// Smallest and largest of some numbers, zeros of none.
fn range(values: &[f64]) -> [f64; 2] {
    let ends = |[low, high]: [f64; 2], value: &f64| [low.min(*value), high.max(*value)];
    match values {
        [] => [0.0; 2],
        _ => values.iter().fold([f64::INFINITY, f64::NEG_INFINITY], ends),
    }
}
