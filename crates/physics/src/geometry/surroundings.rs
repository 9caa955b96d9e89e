//! The sites of a lattice around a body: where ghosts continue it.

use super::fill::{ON_BOUNDARY, turn, unturned};
use super::lattice::Lattice;
use super::probe::Probe;
use super::{GeometryError, LatticeKind, LatticeSpec, Particles, Placement, Shape, Surface};
use crate::Vector;
use crate::parallel::for_each_chunk;

/// Particles at the sites of the lattice of [`fill`](super::fill()) that lie out of `shape`, less than
/// `reach` m away from it: on all sides and inside of holes, but not beyond periodic axes that the
/// shape spans. All have whole cells. There is no jitter.
///
/// # Errors
/// An impossible specification, too many sites, and concentric layers, which end at their face.
#[inline(never)]
pub fn surroundings<const D: usize>(
    shape: &Shape<D>,
    spec: &LatticeSpec<D>,
    reach: f64,
) -> Result<Particles<D>, GeometryError> {
    if let Some((of, about, rotation)) = shape.as_turned() {
        let mut around = surroundings(of, unturned(spec, rotation)?, reach)?;
        turn(&mut around.position, about, rotation);
        return Ok(around);
    }
    let (min, max) = shape.bounding_box();
    let edges = Lattice::new(spec, min, max)?.edges;
    // An even number of rows and layers, so that those of a hexagonal lattice go on as they are.
    let margin = Vector::<D>::from_fn(|axis, _| match spec.periodic[axis] {
        true => 0.0,
        false => 2.0 * (0.5 * reach / edges[axis]).ceil() * edges[axis],
    });
    let spacing = match spec.kind {
        LatticeKind::Square => edges.into(),
        LatticeKind::Hexagonal => spec.spacing,
        LatticeKind::Concentric => return Err(GeometryError::NoSurroundings),
    };
    let lattice = Lattice::new(&LatticeSpec { spacing, ..*spec }, min - margin, max + margin)?;
    let tolerance = ON_BOUNDARY * edges.min();
    let least = match spec.placement {
        Placement::Boundary => -tolerance,
        Placement::Cells => tolerance,
    };
    let mut is_ghost = vec![false; lattice.len()];
    for_each_chunk(&mut is_ghost, |first, sites| {
        let mut shape = Probe::of(shape);
        for (offset, is_ghost) in sites.iter_mut().enumerate() {
            let site = lattice.position(lattice.place(first + offset));
            let depth = shape.depth(&lattice.fold(&site), 1.1 * reach);
            *is_ghost = depth < least && depth > tolerance - reach;
        }
    });
    let position: Vec<Vector<D>> = (0..lattice.len())
        .filter(|&site| is_ghost[site])
        .map(|site| lattice.position(lattice.place(site)))
        .collect();
    let count = position.len();
    Ok(Particles {
        volume: vec![lattice.cell_volume(); count],
        weight: vec![lattice.cell_volume(); count],
        spacing: vec![lattice.spacing; count],
        body: vec![0; count],
        id: (0..count as u32).collect(),
        position,
        surface: Surface::default(),
    })
}
