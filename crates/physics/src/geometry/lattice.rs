//! Regular arrangements of particles.

use super::GeometryError;
use super::error::{finite, positive};
use super::fill::MOST_SITES;
use crate::Vector;

/// How particles are arranged.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum LatticeKind {
    /// On a grid of lines parallel to the axes: square in 2D, cubic in 3D.
    Square,
    /// Densest arrangement: triangles in 2D, hexagonal close packing in 3D; in 1D even.
    Hexagonal,
    /// In layers around the centre of a ball, or the axis of a cylinder, so that the outermost one follows the face: no
    /// lattice, and only for a shape that is one of these.
    Concentric,
}

/// Where the outermost particles lie.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Placement {
    /// On the faces of the bounding box.
    Boundary,
    /// Half a spacing inside of them, in the centres of cells.
    Cells,
}

/// Arrangement of the particles of a body.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LatticeSpec<const D: usize> {
    /// Wanted distance of neighbours along each axis in m.
    pub spacing: [f64; D],
    /// Arrangement.
    pub kind: LatticeKind,
    /// Where the outermost particles lie.
    pub placement: Placement,
    /// Axes along which the body goes round a periodic domain, whose bounds are those of its
    /// bounding box: there particles on the upper bound would be the same as on the lower one and
    /// are left out. Only for square lattices.
    pub periodic: [bool; D],
    /// Largest random displacement along each axis, in spacings.
    pub jitter: f64,
    /// Where the random displacements start.
    pub seed: u64,
}

impl<const D: usize> LatticeSpec<D> {
    /// A square lattice with particles on the faces, without jitter.
    pub fn square(spacing: [f64; D]) -> Self {
        Self {
            spacing,
            kind: LatticeKind::Square,
            placement: Placement::Boundary,
            periodic: [false; D],
            jitter: 0.0,
            seed: 0,
        }
    }
}

/// The sites of a lattice around a body. Each has a box around it for a cell, and these fill space
/// without overlap: rows and layers of a hexagonal lattice are shifted like those of a brick wall.
#[derive(Clone, Debug)]
pub(super) struct Lattice<const D: usize> {
    /// Number of sites along each axis.
    pub counts: [usize; D],
    /// Edges of a cell in m.
    pub edges: Vector<D>,
    /// Distance of neighbours in m, the largest one where they differ.
    pub spacing: f64,
    hexagonal: bool,
    placement: Placement,
    periodic: [bool; D],
    min: Vector<D>,
    max: Vector<D>,
}

impl<const D: usize> Lattice<D> {
    /// The sites whose cells cover the box from `min` to `max`.
    ///
    /// Spacings of a square lattice are changed so that whole numbers of them fit into the box.
    ///
    /// # Errors
    /// An impossible specification, and one with too many sites.
    pub(super) fn new(
        spec: &LatticeSpec<D>,
        min: Vector<D>,
        max: Vector<D>,
    ) -> Result<Self, GeometryError> {
        check(spec, &min, &max)?;
        let extent = max - min;
        let hexagonal = spec.kind == LatticeKind::Hexagonal && D > 1;
        let wanted = if hexagonal { brick(spec.spacing[0]) } else { Vector::from(spec.spacing) };
        let cells = extent.component_div(&wanted);
        let smallest = wanted.min();
        let estimate: f64 = cells.iter().map(|cells| cells + 1.0).product();
        if !(estimate <= MOST_SITES as f64) {
            let extent = extent.as_slice().to_vec();
            return Err(GeometryError::TooManySites { spacing: smallest, extent, estimate });
        }
        let whole = cells.map(|cells| cells.round().max(1.0));
        let edges = if hexagonal { wanted } else { extent.component_div(&whole) };
        let coordinate = min.abs().sup(&max.abs()).max();
        // Particles must lie apart by many times the distance of neighbouring numbers, or
        // gradients would be made of rounding errors.
        if edges.min() < 1e5 * f64::EPSILON * coordinate {
            return Err(GeometryError::TooFine { spacing: edges.min(), coordinate });
        }
        let counts = std::array::from_fn(|axis| {
            let further = match (hexagonal, spec.placement) {
                // One more on either side, as cells of shifted rows reach in from there.
                (true, _) => return cells[axis].ceil() as usize + 3,
                (false, Placement::Boundary) => usize::from(!spec.periodic[axis]),
                (false, Placement::Cells) => 0,
            };
            whole[axis] as usize + further
        });
        let spacing = if hexagonal { spec.spacing[0] } else { edges.max() };
        let (placement, periodic) = (spec.placement, spec.periodic);
        Ok(Self { counts, edges, spacing, hexagonal, placement, periodic, min, max })
    }

    /// Number of all sites.
    pub(super) fn len(&self) -> usize {
        self.counts.iter().product()
    }

    /// Volume of a cell in m^D.
    pub(super) fn cell_volume(&self) -> f64 {
        self.edges.product()
    }

    /// Places of site `number` along each axis; x runs fastest.
    pub(super) fn place(&self, mut number: usize) -> [usize; D] {
        self.counts.map(|count| {
            let place = number % count;
            number /= count;
            place
        })
    }

    /// Number of the site at `place`.
    pub(super) fn number(&self, place: [usize; D]) -> usize {
        place
            .iter()
            .zip(&self.counts)
            .rev()
            .fold(0, |number, (place, count)| number * count + place)
    }

    /// Position in m of the site at `place`.
    pub(super) fn position(&self, place: [usize; D]) -> Vector<D> {
        let shift = match self.placement {
            Placement::Boundary => 0.0,
            Placement::Cells => 0.5,
        };
        if self.hexagonal {
            // The first site lies outside, see `counts`.
            let step = |axis: usize| if axis < D { place[axis] as f64 - 1.0 } else { 0.0 };
            let odd = |steps: f64| steps.rem_euclid(2.0);
            let stagger = [0.5 * odd(step(1) + step(2)), odd(step(2)) / 3.0, 0.0];
            return Vector::from_fn(|axis, _| {
                self.min[axis] + (step(axis) + stagger[axis] + shift) * self.edges[axis]
            });
        }
        Vector::from_fn(|axis, _| {
            let last = place[axis] + 1 == self.counts[axis];
            if last && self.placement == Placement::Boundary && !self.periodic[axis] {
                // Rounding must not move the last site off the face.
                return self.max[axis];
            }
            self.min[axis] + (place[axis] as f64 + shift) * self.edges[axis]
        })
    }

    /// The image of a point at most one period outside that lies inside the bounds of the
    /// periodic axes.
    pub(super) fn fold(&self, point: &Vector<D>) -> Vector<D> {
        Vector::from_fn(|axis, _| {
            let (x, min, max) = (point[axis], self.min[axis], self.max[axis]);
            let period = if self.periodic[axis] { max - min } else { 0.0 };
            if x < min {
                x + period
            } else if x > max {
                x - period
            } else {
                x
            }
        })
    }
}

/// Edges of the cell of a hexagonal lattice whose neighbours are `spacing` m apart.
fn brick<const D: usize>(spacing: f64) -> Vector<D> {
    let edges = [1.0, 3f64.sqrt() / 2.0, (2.0 / 3.0f64).sqrt()];
    Vector::from_fn(|axis, _| edges[axis] * spacing)
}

fn check<const D: usize>(
    spec: &LatticeSpec<D>,
    min: &Vector<D>,
    max: &Vector<D>,
) -> Result<(), GeometryError> {
    spec.spacing.iter().try_for_each(|&spacing| positive("the spacing of particles", spacing))?;
    if !(spec.jitter >= 0.0 && spec.jitter < 0.5) {
        return Err(GeometryError::Jitter { value: spec.jitter });
    }
    let even = spec.spacing.iter().all(|spacing| *spacing == spec.spacing[0]);
    let what = match spec.kind {
        LatticeKind::Square => None,
        LatticeKind::Hexagonal => Some("a hexagonal lattice has"),
        LatticeKind::Concentric => Some("concentric layers have"),
    };
    if let Some(what) = what.filter(|_| !even) {
        return Err(GeometryError::Uneven { what, value: spec.spacing.to_vec() });
    }
    let on_faces = spec.kind == LatticeKind::Concentric && spec.placement == Placement::Boundary;
    if on_faces && spec.periodic.contains(&true) {
        let what = "layers on the ends of a body that spans a periodic domain";
        return Err(GeometryError::Dimension { what, got: D, expected: "layers on cells" });
    }
    if spec.kind == LatticeKind::Hexagonal && D > 1 && spec.periodic.contains(&true) {
        let (what, expected) = ("a hexagonal lattice around a periodic domain", "a square one");
        return Err(GeometryError::Dimension { what, got: D, expected });
    }
    finite("the extent of the body", (max - min).as_slice())?;
    // The corners of an intersection of shapes that touch or are apart.
    if (0..D).any(|axis| min[axis] >= max[axis]) {
        return Err(GeometryError::NoParticles);
    }
    Ok(())
}
