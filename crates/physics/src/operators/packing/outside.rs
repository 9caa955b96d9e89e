//! What completes the support of particles beyond the boundary of a shape.

use super::{KERNEL, PackingError, REACH, smoothing};
use crate::geometry::{MOST_SITES, Probe, Shape};
use crate::{Vector, parallel};

/// Cells of the grid along a spacing.
const FINER: f64 = 2.0;

/// How far outside of the shape sums are known, in spacings.
const BEYOND: f64 = 2.0;

/// The sum of the kernel over the particles that would fill the space outside of a shape, theory (101), at the centres of the cells of a grid, from which it is
/// interpolated.
pub(super) struct Outside<const D: usize> {
    /// Centre of the first cell in m.
    origin: Vector<D>,
    /// Edge of a cell in m.
    edge: f64,
    counts: [usize; D],
    sums: Vec<f64>,
    width: f64,
}

impl<const D: usize> Outside<D> {
    /// Outside of a shape, for particles `width` m apart.
    ///
    /// # Errors
    /// A shape that is so thin for its extent that the grid has too many cells.
    pub fn new(shape: &Shape<D>, width: f64) -> Result<Self, PackingError> {
        let (edge, reach) = (width / FINER, REACH * width);
        let margin = reach + BEYOND * width + edge;
        let (min, max) = shape.bounding_box();
        let origin = min.add_scalar(-margin);
        let extent = (max - min).add_scalar(2.0 * margin);
        let estimate: f64 = extent.iter().map(|extent| extent / edge + 2.0).product();
        if !(estimate <= MOST_SITES as f64) {
            let extent = (max - min).as_slice().to_vec();
            return Err(PackingError::TooThin { width, extent, estimate });
        }
        let counts = std::array::from_fn(|axis| (extent[axis] / edge).ceil() as usize + 1);
        let mut own = Self { origin, edge, counts, sums: Vec::new(), width };
        let known = reach + edge;
        let mut depths = vec![0.0; counts.iter().product()];
        parallel::for_each_chunk(&mut depths, |first, depths| {
            let mut shape = Probe::of(shape);
            for (offset, depth) in depths.iter_mut().enumerate() {
                *depth = shape.depth(&own.center(first + offset), known).clamp(-known, known);
            }
        });
        let part = |depth: f64| step(-depth / edge);
        let weights = own.weights();
        let mut sums = vec![0.0; depths.len()];
        parallel::for_each_chunk(&mut sums, |first, sums| {
            for (offset, sum) in sums.iter_mut().enumerate() {
                let cell = first + offset;
                let depth = depths[cell];
                *sum = if depth >= known {
                    0.0
                } else if depth < -BEYOND * width {
                    1.0
                } else {
                    let place = own.place(cell);
                    let term = |(way, weight): &([isize; D], f64)| {
                        weight * own.number(&place, way).map_or(1.0, |other| part(depths[other]))
                    };
                    weights.iter().map(term).sum()
                };
            }
        });
        own.sums = sums;
        Ok(own)
    }

    /// Distance of particles in m.
    pub fn width(&self) -> f64 {
        self.width
    }

    /// Support of the kernel in m.
    pub fn reach(&self) -> f64 {
        REACH * self.width
    }

    /// The sum at a place, and its gradient in 1/m, by cubic convolution.
    pub fn sum(&self, at: &Vector<D>) -> (f64, Vector<D>) {
        let scaled = (at - self.origin) / self.edge;
        let base = scaled.map(f64::floor);
        let rows: [[[f64; 2]; 4]; D] = std::array::from_fn(|axis| cubic(scaled[axis] - base[axis]));
        let place: [usize; D] = std::array::from_fn(|axis| base[axis].max(0.0) as usize);
        let (mut value, mut gradient) = (0.0, Vector::zeros());
        for number in 0..4usize.pow(D as u32) {
            let step: [usize; D] = std::array::from_fn(|axis| number >> (2 * axis) & 3);
            let way = step.map(|step| step as isize - 1);
            let sum = self.number(&place, &way).map_or(1.0, |cell| self.sums[cell]);
            let factor = |along: Option<usize>| -> f64 {
                let of = |axis: usize| rows[axis][step[axis]][usize::from(along == Some(axis))];
                (0..D).map(of).product()
            };
            value += sum * factor(None);
            gradient += Vector::from_fn(|axis, _| sum * factor(Some(axis)));
        }
        (value, gradient / self.edge)
    }

    /// Ways to the cells within the support, with the parts of the sum that they have where all are outside: 1 together.
    fn weights(&self) -> Vec<([isize; D], f64)> {
        let most = (REACH * FINER).ceil() as isize;
        let side = (2 * most + 1) as usize;
        let all = (0..side.pow(D as u32)).filter_map(|number| {
            let way: [isize; D] =
                std::array::from_fn(|axis| (number / side.pow(axis as u32) % side) as isize - most);
            let square: isize = way.iter().map(|step| step * step).sum();
            let r = (square as f64).sqrt() * self.edge;
            (r < self.reach()).then(|| (way, particles_for_space::<D>(r, self.width, self.edge)))
        });
        let mut all: Vec<_> = all.collect();
        let total: f64 = all.iter().map(|(_, weight)| weight).sum();
        all.iter_mut().for_each(|(_, weight)| *weight /= total);
        all
    }

    fn place(&self, mut cell: usize) -> [usize; D] {
        self.counts.map(|count| {
            let place = cell % count;
            cell /= count;
            place
        })
    }

    fn center(&self, cell: usize) -> Vector<D> {
        let place = self.place(cell);
        Vector::from_fn(|axis, _| self.origin[axis] + place[axis] as f64 * self.edge)
    }

    /// The number of the cell on some way from another, if it is on the grid.
    fn number(&self, place: &[usize; D], way: &[isize; D]) -> Option<usize> {
        let mut cell = 0;
        for axis in (0..D).rev() {
            let along = place[axis].checked_add_signed(way[axis])?;
            if along >= self.counts[axis] {
                return None;
            }
            cell = cell * self.counts[axis] + along;
        }
        Some(cell)
    }
}

/// From 0 inside to 1 outside, against the distance in cells: a step that is made smooth by the hat function, so that the sum of a
/// linear function over cells is its integral over the outside, wherever the boundary lies between them.
fn step(outwards: f64) -> f64 {
    match outwards {
        below if below <= -1.0 => 0.0,
        below if below <= 0.0 => 0.5 * (1.0 + below) * (1.0 + below),
        above if above < 1.0 => 1.0 - 0.5 * (1.0 - above) * (1.0 - above),
        _ => 1.0,
    }
}

/// The kernel that makes the sum over cells of [`step`] the sum over the particles that would fill the outside, to second order,
/// theory (101): these lie in the middle of what is theirs, which takes a 24th of the square of their width, and the hat function
/// has added half its variance, a twelfth of the square of the edge.
fn particles_for_space<const D: usize>(r: f64, width: f64, edge: f64) -> f64 {
    let (h, off) = (smoothing(width), 1e-4 * width);
    let over_r = |r: f64| KERNEL.derivative_over_r(D, r, h);
    let slope = |r: f64| over_r(r.abs()) * r;
    let bend = (slope(r + off) - slope(r - off)) / (2.0 * off);
    let laplacian = bend + (D - 1) as f64 * over_r(r);
    KERNEL.value(D, r, h) - (width * width / 24.0 + edge * edge / 12.0) * laplacian
}

/// The weights of four values beside each other in that at a part `t` of the way from the second to the third, and their
/// derivatives.
fn cubic(t: f64) -> [[f64; 2]; 4] {
    let (t2, t3) = (t * t, t * t * t);
    [
        [-0.5 * t + t2 - 0.5 * t3, -0.5 + 2.0 * t - 1.5 * t2],
        [1.0 - 2.5 * t2 + 1.5 * t3, -5.0 * t + 4.5 * t2],
        [0.5 * t + 2.0 * t2 - 1.5 * t3, 0.5 + 4.0 * t - 4.5 * t2],
        [-0.5 * t2 + 0.5 * t3, -t + 1.5 * t2],
    ]
}
