//! Lattices cut to shape.

use rayon::prelude::*;

use super::fill::ON_BOUNDARY;
use super::lattice::Lattice;
use super::probe::Probe;
use super::{Placement, Shape};
use crate::Vector;
use crate::parallel::for_each_chunk;

/// Where the cell of a site lies.
#[derive(Clone, Copy, PartialEq)]
enum Cell {
    Outside,
    /// Cut by the boundary, with the site outside.
    Corner,
    /// Cut by the boundary, with the site inside.
    Cut,
    Inside,
}

/// Depths are found as far as they are compared, and a little further.
const FURTHER: f64 = 1.1;

/// No particle.
const NONE: u32 = u32::MAX;

/// Shares of a midpoint, which particles that are equally near to it have in equal parts: as many as one to sixteen divide.
const SHARES: u64 = 720_720;

/// The sites of `lattice` in `shape`, and the volume of the shape that belongs to each, see
/// [`super::fill`]. Sites to which nothing belongs are left out.
pub(super) fn cut<const D: usize>(
    shape: &Shape<D>,
    lattice: &Lattice<D>,
    placement: Placement,
) -> (Vec<Vector<D>>, Vec<f64>) {
    let cells = classify(shape, lattice, placement);
    let mut particle = vec![NONE; cells.len()];
    let mut sites = Vec::new();
    for (site, cell) in cells.iter().enumerate() {
        if matches!(cell, Cell::Inside | Cell::Cut) {
            particle[site] = sites.len() as u32;
            sites.push(site);
        }
    }
    let boundary: Vec<usize> =
        (0..cells.len()).filter(|&i| matches!(cells[i], Cell::Cut | Cell::Corner)).collect();
    let found: Vec<Vec<(u32, u64)>> =
        boundary.par_iter().map(|&site| owners(shape, lattice, &particle, site)).collect();

    // Whole numbers of shares: their sum does not depend on any order.
    let whole = SHARES * divisions::<D>().pow(D as u32) as u64;
    let inside = |&site: &usize| if cells[site] == Cell::Inside { whole } else { 0 };
    let mut shares: Vec<u64> = sites.iter().map(inside).collect();
    for (owner, count) in found.into_iter().flatten() {
        shares[owner as usize] += count;
    }
    // Exact for whole cells, halves and quarters.
    let part = |shares: u64| shares as f64 / whole as f64;
    let kept = sites.iter().zip(shares).filter(|&(_, shares)| shares > 0);
    kept.map(|(&site, shares)| {
        (lattice.position(lattice.place(site)), lattice.cell_volume() * part(shares))
    })
    .unzip()
}

fn classify<const D: usize>(
    shape: &Shape<D>,
    lattice: &Lattice<D>,
    placement: Placement,
) -> Vec<Cell> {
    // Any point of a cell is as near to its site, so that the depth tells cells wholly on one side.
    let radius = 0.5 * lattice.edges.norm();
    let tolerance = ON_BOUNDARY * lattice.edges.min();
    let least = match placement {
        Placement::Boundary => -tolerance,
        Placement::Cells => tolerance,
    };
    let mut cells = vec![Cell::Outside; lattice.len()];
    for_each_chunk(&mut cells, |first, cells| {
        let mut shape = Probe::of(shape);
        for (i, cell) in cells.iter_mut().enumerate() {
            let site = lattice.fold(&lattice.position(lattice.place(first + i)));
            let depth = shape.depth(&site, FURTHER * radius);
            *cell = if depth >= radius {
                Cell::Inside
            } else if depth >= least {
                Cell::Cut
            } else if depth > -radius {
                Cell::Corner
            } else {
                Cell::Outside
            };
        }
    });
    cells
}

/// The particles that own parts of the cell of `site`, with the number of shares each: those next to a midpoint, by equal
/// parts where there are several, so that a shape with a symmetry of the lattice has masses with it.
fn owners<const D: usize>(
    shape: &Shape<D>,
    lattice: &Lattice<D>,
    particle: &[u32],
    site: usize,
) -> Vec<(u32, u64)> {
    let place = lattice.place(site);
    let center = lattice.position(place);
    let own = particle[site];
    let around = match own {
        NONE => particles_around(lattice, particle, place),
        own => vec![(own, center)],
    };
    let equal = ON_BOUNDARY * lattice.edges.norm_squared();
    let mut owners: Vec<(u32, u64)> = Vec::new();
    let midpoint = |steps: &[usize; D]| {
        Vector::from_fn(|axis, _| {
            let fraction = (steps[axis] as f64 + 0.5) / divisions::<D>() as f64 - 0.5;
            center[axis] + fraction * lattice.edges[axis]
        })
    };
    let (reach, corner) = (0.5 * lattice.edges.norm(), 0.5 * lattice.edges);
    // Across a periodic bound what is beside each other is not.
    let is_whole = [center - corner, center + corner].iter().all(|end| lattice.fold(end) == *end);
    let mut probe = match is_whole {
        true => Probe::around(shape, &center, reach),
        false => Probe::of(shape),
    };
    within(&mut probe, lattice, &midpoint, ([0; D], divisions::<D>()), &mut |point| {
        let distances = around.iter().map(|(owner, at)| (*owner, (at - point).norm_squared()));
        let least = distances.clone().map(|(_, distance)| distance).fold(f64::INFINITY, f64::min);
        let nearest = distances.filter(|(_, distance)| *distance <= least + equal);
        let share = SHARES / (nearest.clone().count() as u64).max(1);
        for (owner, _) in nearest {
            match owners.iter_mut().find(|(known, _)| *known == owner) {
                Some((_, count)) => *count += share,
                None => owners.push((owner, share)),
            }
        }
    });
    owners
}

/// Visits the midpoints of a block, this many along each edge, that lie in the shape. A block that is further from the
/// boundary than it is large lies on one side of it as a whole.
fn within<const D: usize>(
    shape: &mut Probe<'_, D>,
    lattice: &Lattice<D>,
    midpoint: &impl Fn(&[usize; D]) -> Vector<D>,
    (first, count): ([usize; D], usize),
    see: &mut impl FnMut(Vector<D>),
) {
    let ends = [midpoint(&first), midpoint(&first.map(|step| step + count - 1))];
    let (middle, radius) = (0.5 * (ends[0] + ends[1]), 0.5 * (ends[1] - ends[0]).norm());
    // Across a periodic bound what is beside each other is not.
    let is_whole = ends.iter().all(|end| lattice.fold(end) == *end);
    if count == 1 {
        if shape.contains(&lattice.fold(&middle)) {
            see(middle);
        }
        return;
    }
    let depth = if is_whole { shape.depth(&middle, FURTHER * radius) } else { 0.0 };
    if depth < -radius {
        return;
    }
    if depth > radius {
        for number in 0..count.pow(D as u32) {
            see(midpoint(&std::array::from_fn(|axis| {
                first[axis] + number / count.pow(axis as u32) % count
            })));
        }
        return;
    }
    let half = count / 2;
    for part in 0..1 << D {
        let begin = std::array::from_fn(|axis| first[axis] + (part >> axis & 1) * half);
        within(shape, lattice, midpoint, (begin, half), see);
    }
}

/// The particles next to `place`, or two sites away where there is none next to it.
fn particles_around<const D: usize>(
    lattice: &Lattice<D>,
    particle: &[u32],
    place: [usize; D],
) -> Vec<(u32, Vector<D>)> {
    let mut found = Vec::new();
    for reach in [1usize, 2] {
        let width = 2 * reach + 1;
        for number in 0..width.pow(D as u32) {
            let other: [usize; D] = std::array::from_fn(|axis| {
                // Below the first place this wraps round to above the last one.
                (place[axis] + number / width.pow(axis as u32) % width).wrapping_sub(reach)
            });
            if (0..D).all(|axis| other[axis] < lattice.counts[axis]) {
                let owner = particle[lattice.number(other)];
                if owner != NONE {
                    found.push((owner, lattice.position(other)));
                }
            }
        }
        if !found.is_empty() {
            break;
        }
    }
    found
}

/// Midpoints along each edge of a cell. Even, so that none lies on a plane through the site.
const fn divisions<const D: usize>() -> usize {
    match D {
        1 => 256,
        2 => 16,
        _ => 8,
    }
}
