//! Shapes filled with the particles of a lattice.

use super::concentric::concentric;
use super::cut::cut;
use super::jitter::jitter;
use super::lattice::Lattice;
use super::{GeometryError, LatticeKind, LatticeSpec, Particles, Placement, Shape, Surface};
use crate::parallel::sum;
use crate::{Tensor, Vector};

/// Most sites of the lattice around a body. A run needs a kilobyte a particle and more.
pub(crate) const MOST_SITES: usize = 100_000_000;

/// Points as near to a boundary as this, in spacings, lie on it.
pub(super) const ON_BOUNDARY: f64 = 1e-9;

/// The particles of a body, and how well they fill it.
#[derive(Clone, Debug, PartialEq)]
pub struct FillReport<const D: usize> {
    /// The particles, as body 0.
    pub particles: Particles<D>,
    /// Sum of the quadrature volumes in m^D.
    pub total_volume: f64,
    /// Volume of the shape in m^D, where it is known.
    pub exact_volume: Option<f64>,
    /// Edges of a particle's cell in m: the spacing along each axis of a square lattice; of a
    /// hexagonal one the distances within a row, of rows and of layers; the thickness of concentric layers.
    pub actual_spacing: [f64; D],
    /// How the lattice is turned: rows are along its columns.
    pub rotation: Tensor<D>,
}

/// Fills `shape` with particles at the sites of a lattice that lie in it.
///
/// A square lattice is fitted to the shape's bounding box: spacings become `L / n`, with the
/// extent `L` and `n = max(1, round(L / spacing))`. A hexagonal one keeps its spacing and starts
/// at the lower corner. Kernel weights are the whole cell for every particle. Quadrature volumes
/// in a box are the part of the cell inside, so that their sum is exact. In other shapes, each
/// part of the shape belongs to the cell it lies in or, where that has no particle, to the
/// nearest particle of the cells around. Parts are measured with midpoints of a fixed subdivision
/// of the cell; the error of their sum falls with the power 3/2 of the spacing or faster.
///
/// Concentric layers keep as near to the spacing as a whole number of them between the radii allows; an even share of its
/// layer is a particle's, so that the sum is exact.
///
/// With jitter, particles move at random by up to `jitter` spacings along each axis, but not off
/// the faces of the bounding box, nor out of the shape. The same seed gives the same particles.
///
/// The lattice of a shape that is turned as a whole is turned with it, about the same point.
///
/// # Errors
/// An impossible specification, too many sites, a shape without particles, concentric layers in one that is not round, and a turned one that reaches across
/// a periodic axis which is turned.
#[inline(never)]
pub fn fill<const D: usize>(
    shape: &Shape<D>,
    spec: &LatticeSpec<D>,
) -> Result<FillReport<D>, GeometryError> {
    if let Some((of, about, rotation)) = shape.as_turned() {
        let mut report = fill(of, unturned(spec, rotation)?)?;
        turn(&mut report.particles.position, about, rotation);
        report.rotation = rotation * report.rotation;
        return Ok(report);
    }
    let (min, max) = shape.bounding_box();
    let lattice = Lattice::new(spec, min, max)?;
    let square = spec.kind == LatticeKind::Square || D == 1;
    let mut edges = lattice.edges.into();
    let (position, volume, weight, spacing) = if spec.kind == LatticeKind::Concentric {
        let round = shape.as_round().ok_or(GeometryError::NotRound)?;
        let made = concentric(&round, spec.spacing[0], spec.placement);
        edges = [made.spacing; D];
        (made.position, made.volume, made.weight, made.spacing)
    } else {
        let (position, volume) = match shape.corners() {
            Some(_) if square => fill_box(&lattice, spec),
            _ => cut(shape, &lattice, spec.placement),
        };
        let weight = vec![lattice.cell_volume(); position.len()];
        (position, volume, weight, lattice.spacing)
    };
    if position.is_empty() {
        return Err(GeometryError::NoParticles);
    }
    let count = position.len();
    let mut particles = Particles {
        weight,
        spacing: vec![spacing; count],
        body: vec![0; count],
        id: (0..count as u32).collect(),
        position,
        volume,
        surface: Surface::default(),
    };
    if spec.jitter > 0.0 {
        jitter(&mut particles.position, shape, &lattice, spec);
    }
    Ok(FillReport {
        total_volume: sum(count, |a| particles.volume[a]),
        exact_volume: shape.exact_volume(),
        actual_spacing: edges,
        rotation: Tensor::identity(),
        particles,
    })
}

/// Whether a rotation changes the direction of an axis.
pub fn turns<const D: usize>(rotation: &Tensor<D>, axis: usize) -> bool {
    rotation[(axis, axis)] < 1.0 - 1e-14
}

/// The lattice of a shape before it was turned, which goes round a periodic domain along axes alone that are not turned.
pub(super) fn unturned<'a, const D: usize>(
    spec: &'a LatticeSpec<D>,
    rotation: &Tensor<D>,
) -> Result<&'a LatticeSpec<D>, GeometryError> {
    match (0..D).any(|axis| spec.periodic[axis] && turns(rotation, axis)) {
        true => Err(GeometryError::TurnedPeriodic),
        false => Ok(spec),
    }
}

/// Turns points about a point.
pub(super) fn turn<const D: usize>(
    points: &mut [Vector<D>],
    about: &Vector<D>,
    rotation: &Tensor<D>,
) {
    for point in points {
        *point = rotation * (*point - about) + about;
    }
}

/// All sites, with half a cell for each axis on whose end a particle lies.
fn fill_box<const D: usize>(
    lattice: &Lattice<D>,
    spec: &LatticeSpec<D>,
) -> (Vec<Vector<D>>, Vec<f64>) {
    let share = |place: [usize; D]| -> f64 {
        let halves = (0..D).filter(|&axis| {
            let is_end = place[axis] == 0 || place[axis] + 1 == lattice.counts[axis];
            is_end && spec.placement == Placement::Boundary && !spec.periodic[axis]
        });
        0.5f64.powi(halves.count() as i32)
    };
    let cell = lattice.cell_volume();
    let particle = |site| {
        let place = lattice.place(site);
        (lattice.position(place), cell * share(place))
    };
    (0..lattice.len()).map(particle).unzip()
}
