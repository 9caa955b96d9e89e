//! Particles packed into a shape: all of one mass, even, and half a spacing below its boundary.

mod lower;
mod outside;
mod settle;

use piola_formulas::kernels::Kernel;
use thiserror::Error;

use crate::geometry::{
    FillReport, GeometryError, LatticeSpec, MOST_SITES, Particles, Placement, Probe, Shape,
    Surface, fill,
};
use crate::neighbors::{Domain, NeighborError, search};
use crate::{Tensor, Vector, parallel};
use outside::Outside;

/// The kernel by which densities are summed, one under which particles do not pair, and its support in spacings.
const KERNEL: Kernel = Kernel::WendlandC2;
const REACH: f64 = 3.0;

/// Sites whose depths differ by less than this part of a spacing are equally deep.
const TIE: f64 = 1e-9;

/// Why a shape cannot be packed.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum PackingError {
    /// No lattice fills it either.
    #[error(transparent)]
    Geometry(#[from] GeometryError),
    /// It is so thin for its extent, or its particles are so small, that the grid around it has too many cells.
    #[error(
        "particles {width:.1e} m apart in a body of {extent:.1?} m need a grid of about \
         {estimate:.0e} cells around it, expected at most {:.0e}: the body is too thin for its \
         extent, or the spacing too small, for packed particles; use a lattice", MOST_SITES as f64
    )]
    TooThin {
        /// Distance of particles in m.
        width: f64,
        /// Extent of the body in m.
        extent: Vec<f64>,
        /// Number of cells.
        estimate: f64,
    },
    /// Its particles have too many neighbours, or are too many.
    #[error(transparent)]
    Neighbors(#[from] NeighborError),
}

/// How well particles are packed.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Packing {
    /// Steps until they were settled, or all that may be taken.
    pub steps: usize,
    /// Whether no particle would move by more than [`Self::SETTLED`] spacings in a step.
    pub is_settled: bool,
    /// How far the particle that is furthest from rest would move in a step, in spacings.
    pub push: f64,
    /// The largest deviation of the summed density from 1 within a support of the boundary, theory (103).
    pub largest: f64,
    /// The root of its mean square there.
    pub rms: f64,
}

impl Packing {
    /// Particles at rest would move by no more spacings than this.
    pub const SETTLED: f64 = 1e-3;

    /// The least deviation of the density that users should know of.
    pub const UNEVEN: f64 = 0.02;
}

/// Fills `shape` with particles of equal volumes, whose sum is that of the shape, moved until they are even, theory (100) to (103).
///
/// They start from the deepest sites of a square lattice in the box around the shape, as many as there is room for; sites that
/// are equally deep are taken together. The same shape gives the same particles, whatever the threads.
///
/// # Errors
/// Those of [`fill`](crate::geometry::fill()) and of [`search`], and a shape that is far too thin for its extent.
#[inline(never)]
pub fn pack<const D: usize>(
    shape: &Shape<D>,
    spacing: f64,
) -> Result<(FillReport<D>, Packing), PackingError> {
    if let Some((of, about, rotation)) = shape.as_turned() {
        let (mut report, packing) = pack(of, spacing)?;
        for x in &mut report.particles.position {
            *x = rotation * (*x - about) + about;
        }
        report.rotation = rotation * report.rotation;
        return Ok((report, packing));
    }
    let spec = LatticeSpec { placement: Placement::Cells, ..LatticeSpec::square([spacing; D]) };
    let cut = fill(shape, &spec)?;
    let volume = cut.exact_volume.unwrap_or(cut.total_volume);
    let cell: f64 = cut.actual_spacing.iter().product();
    let mut position = deepest(shape, &cut.actual_spacing, volume / cell);
    let count = position.len();
    let own = volume / count as f64;
    let width = own.powf(1.0 / D as f64);
    let outside = Outside::new(shape, width)?;
    let (steps, push) = settle::settle(&mut position, shape, &outside, own)?;
    let (largest, rms) = deviation(&position, shape, &outside, own)?;
    let particles = Particles {
        volume: vec![own; count],
        weight: vec![own; count],
        spacing: vec![width; count],
        body: vec![0; count],
        id: (0..count as u32).collect(),
        position,
        surface: Surface::default(),
    };
    let report = FillReport {
        total_volume: parallel::sum(count, |a| particles.volume[a]),
        exact_volume: cut.exact_volume,
        actual_spacing: [width; D],
        rotation: Tensor::identity(),
        particles,
    };
    let is_settled = push <= Packing::SETTLED;
    Ok((report, Packing { steps, is_settled, push, largest, rms }))
}

/// About `wanted` of those sites of a lattice with cells of these edges in the box around a shape that are deepest in it.
fn deepest<const D: usize>(shape: &Shape<D>, edges: &[f64; D], wanted: f64) -> Vec<Vector<D>> {
    let edges = Vector::<D>::from(*edges);
    let (min, max) = shape.bounding_box();
    let counts: [usize; D] = std::array::from_fn(|axis| {
        ((max[axis] - min[axis]) / edges[axis]).round().max(1.0) as usize
    });
    let site = |mut number: usize| -> Vector<D> {
        Vector::from_fn(|axis, _| {
            let place = number % counts[axis];
            number /= counts[axis];
            min[axis] + (place as f64 + 0.5) * edges[axis]
        })
    };
    let reach = edges.max();
    let mut depths = vec![0.0; counts.iter().product()];
    parallel::for_each_chunk(&mut depths, |first, depths| {
        let mut shape = Probe::of(shape);
        for (offset, depth) in depths.iter_mut().enumerate() {
            *depth = shape.depth(&site(first + offset), reach).clamp(-reach, reach);
        }
    });
    let mut order: Vec<usize> = (0..depths.len()).filter(|&i| depths[i] > -reach).collect();
    order.sort_by(|&a, &b| depths[b].total_cmp(&depths[a]).then(a.cmp(&b)));
    let is_end = |count: &usize| {
        let [last, next] = [count - 1, *count].map(|place| order.get(place).map(|&i| depths[i]));
        last.zip(next).is_none_or(|(last, next)| last - next > TIE * reach)
    };
    let off = |count: &usize| (*count as f64 - wanted).abs();
    let best = (1..=order.len()).filter(is_end).min_by(|a, b| off(a).total_cmp(&off(b)));
    order.truncate(best.unwrap_or(order.len()));
    order.sort_unstable();
    order.into_iter().map(site).collect()
}

/// The smoothing length for a support of a number of spacings.
fn smoothing(width: f64) -> f64 {
    REACH * width / KERNEL.support_over_h()
}

/// The largest and the root mean square deviation from 1 of the density summed by the kernel, theory (103), within a support
/// of the boundary.
fn deviation<const D: usize>(
    position: &[Vector<D>],
    shape: &Shape<D>,
    outside: &Outside<D>,
    own: f64,
) -> Result<(f64, f64), NeighborError> {
    let (reach, h) = (outside.reach(), smoothing(outside.width()));
    let list = search(position, &vec![reach; position.len()], &Domain::open())?;
    let mut deviations = vec![None; position.len()];
    parallel::for_each_chunk(&mut deviations, |first, deviations| {
        let mut shape = Probe::of(shape);
        for (offset, deviation) in deviations.iter_mut().enumerate() {
            let a = first + offset;
            if shape.depth(&position[a], reach) >= reach {
                continue;
            }
            let value = |b: &u32| KERNEL.value(D, (position[a] - position[*b as usize]).norm(), h);
            let sum: f64 = list.row(a).iter().map(value).sum();
            let sum = own * (KERNEL.value(D, 0.0, h) + sum) + outside.sum(&position[a]).0;
            *deviation = Some((sum - 1.0).abs());
        }
    });
    let near: Vec<f64> = deviations.into_iter().flatten().collect();
    let largest = near.iter().copied().fold(0.0, parallel::larger);
    let squares: f64 = near.iter().map(|it| it * it).sum();
    Ok((largest, (squares / near.len().max(1) as f64).sqrt()))
}

#[cfg(test)]
mod tests;
