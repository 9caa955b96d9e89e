//! The boundary of a lattice.

use std::collections::HashSet;

use piola_formulas::kernels::Kernel;

use super::{Correction, GradientOperator, OperatorError, Support};
use crate::geometry::{Particles, Surface, turns};
use crate::neighbors::Domain;
use crate::{Tensor, Vector};

/// Smoothing length in spacings with which a particle of a lattice sees those beside it and no
/// diagonal ones, and one with which it sees these too, for corners that have none beside them along some axis.
const NARROW: [f64; 2] = [0.7, 0.9];

/// Areas below this share of a face of the cell are rounding errors.
const ROUNDING: f64 = 1e-9;

/// Outward boundary area vectors in m^(D-1) of the particles of a lattice with these edges of a cell
/// in m, along the columns of a rotation: those of its narrow gradient operator, theory (14), which on a box are the shares of its
/// faces. They sum to zero, and times the places to the volume, whatever the shape. Where a corner of a shape has no
/// neighbour along some axis, all are those of a wider operator.
///
/// # Errors
/// When a particle has no neighbour that is not on one line with it and the others, or the box repeats itself too soon.
#[inline(never)]
pub fn lattice_areas<const D: usize>(
    particles: &Particles<D>,
    edges: &[f64; D],
    rotation: &Tensor<D>,
    domain: &Domain<D>,
) -> Result<Vec<Vector<D>>, OperatorError> {
    let edges = Vector::<D>::from(*edges);
    let cell = edges.product();
    let count = particles.len();
    let domain = along_rows(domain, rotation)?;
    // In units of the edges the lattice is one of cubes.
    let scaled = Particles {
        position: particles
            .position
            .iter()
            .map(|x| rotation.tr_mul(x).component_div(&edges))
            .collect(),
        volume: particles.volume.iter().map(|volume| volume / cell).collect(),
        weight: vec![1.0; count],
        spacing: vec![1.0; count],
        body: particles.body.clone(),
        id: particles.id.clone(),
        surface: Surface::default(),
    };
    let periodic = std::array::from_fn(|axis| {
        domain.periodic()[axis].map(|ends| ends.map(|end| end / edges[axis]))
    });
    let domain = Domain::new(periodic)?;
    let of = |smoothing| {
        let support = Support::new(&scaled, Kernel::CubicSpline, smoothing, domain)?;
        let operator = GradientOperator::new(&scaled, &support, Correction::Gradient);
        let operator = operator.map_err(|error| in_metres(error, particles))?;
        Ok(operator.boundary_areas(&support, &scaled.volume))
    };
    let [narrow, wider] = NARROW;
    let areas = of(narrow).or_else(|_: OperatorError| of(wider))?;
    let clean = |area: Vector<D>| match area.norm() < ROUNDING {
        true => Vector::zeros(),
        false => rotation * area.component_div(&edges) * cell,
    };
    Ok(areas.into_iter().map(clean).collect())
}

/// The domain for rows along the columns of a rotation: periodic along axes that are not turned, as [`fill`] makes turned
/// bodies that go round these alone.
///
/// [`fill`]: crate::geometry::fill()
fn along_rows<const D: usize>(
    domain: &Domain<D>,
    rotation: &Tensor<D>,
) -> Result<Domain<D>, OperatorError> {
    let periodic =
        std::array::from_fn(|axis| domain.periodic()[axis].filter(|_| !turns(rotation, axis)));
    Ok(Domain::new(periodic)?)
}

/// Outward areas in m^(D-1) of the faces of cells that no other cell shares, for cells with these
/// edges in m along the columns of a rotation around the `positions` of a lattice: what a load on the surface acts on. The areas of
/// [`lattice_areas`] are there to be summed over all particles; where particles are centres of cells,
/// those of the outermost layer alone are half as large again as its faces.
#[inline(never)]
pub fn exposed_areas<const D: usize>(
    positions: &[Vector<D>],
    edges: &[f64; D],
    rotation: &Tensor<D>,
    domain: &Domain<D>,
) -> Vec<Vector<D>> {
    let Some(&origin) = positions.first() else { return Vec::new() };
    let edges = Vector::<D>::from(*edges);
    let around: [Option<i64>; D] = std::array::from_fn(|axis| {
        let own = domain.periodic()[axis].filter(|_| !turns(rotation, axis));
        own.map(|[low, high]| ((high - low) / edges[axis]).round() as i64)
    });
    let wrapped = |mut site: [i64; D]| {
        for (index, count) in site.iter_mut().zip(around) {
            *index = count.map_or(*index, |count| index.rem_euclid(count.max(1)));
        }
        site
    };
    let site = |x: &Vector<D>| -> [i64; D] {
        let way = rotation.tr_mul(&(x - origin));
        std::array::from_fn(|axis| (way[axis] / edges[axis]).round() as i64)
    };
    let taken: HashSet<[i64; D]> = positions.iter().map(|x| wrapped(site(x))).collect();
    let cell = edges.product();
    let exposed = |x: &Vector<D>| {
        let mut area = Vector::zeros();
        for axis in 0..D {
            for side in [-1, 1] {
                let mut beside = site(x);
                beside[axis] += side;
                if !taken.contains(&wrapped(beside)) {
                    area[axis] += side as f64 * cell / edges[axis];
                }
            }
        }
        rotation * area
    };
    positions.iter().map(exposed).collect()
}

/// An error of the scaled lattice, with the place in m.
fn in_metres<const D: usize>(mut error: OperatorError, particles: &Particles<D>) -> OperatorError {
    if let OperatorError::PoorSupport { id, position, .. } = &mut error
        && let Some(a) = particles.id.iter().position(|known| known == id)
    {
        position.clone_from_slice(particles.position[a].as_slice());
    }
    error
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::{LatticeSpec, Shape, fill};

    #[test]
    fn a_box_has_its_faces() {
        let (low, high) = (Vector::<2>::new(1.0, -1.0), Vector::<2>::new(2.0, 1.0));
        let shape = Shape::cuboid(low, high).expect("a box");
        let filled = fill(&shape, &LatticeSpec::square([0.1, 0.4])).expect("particles");
        let domain = Domain::new([None; 2]).expect("open");
        let (particles, edges) = (&filled.particles, &filled.actual_spacing);
        let areas = lattice_areas(particles, edges, &Tensor::identity(), &domain).expect("areas");
        for (x, area) in particles.position.iter().zip(&areas) {
            let share = |axis: usize| {
                let side =
                    |end: f64, sign: f64| if (x[axis] - end).abs() < 1e-9 { sign } else { 0.0 };
                let across = 1 - axis;
                let is_end = (x[across] - low[across]).abs() < 1e-9
                    || (x[across] - high[across]).abs() < 1e-9;
                let face = edges[across] * if is_end { 0.5 } else { 1.0 };
                (side(high[axis], 1.0) + side(low[axis], -1.0)) * face
            };
            let expected = Vector::<2>::new(share(0), share(1));
            assert!((area - expected).norm() < 1e-12, "{area} instead of {expected} at {x}");
        }
    }

    /// Centres of cells: beside the outermost layer, whose areas are too large, the next one has areas
    /// that point the other way, so that all of them times the places are the volume.
    #[test]
    fn centres_of_cells_have_areas_in_two_layers() {
        let place = |k: i32, edge: f64| edge * (f64::from(k) + 0.5);
        let (edges, counts) = ([0.5, 0.25], [6, 8]);
        let sites = (0..counts[0]).flat_map(|i| (0..counts[1]).map(move |j| (i, j)));
        let sites: Vec<(i32, i32)> = sites.collect();
        let position: Vec<Vector<2>> = sites
            .iter()
            .map(|&(i, j)| Vector::from([place(i, edges[0]), place(j, edges[1])]))
            .collect();
        let count = position.len();
        let particles = Particles {
            position,
            volume: vec![edges[0] * edges[1]; count],
            weight: vec![1.0; count],
            spacing: vec![0.5; count],
            body: vec![0; count],
            id: (0..count as u32).collect(),
            surface: Surface::default(),
        };
        let areas = lattice_areas(&particles, &edges, &Tensor::identity(), &Domain::default())
            .expect("areas");
        let layers = |k: i32, count: i32| match (k.min(count - 1 - k), 2 * k < count) {
            (0, low) => {
                if low {
                    -1.5
                } else {
                    1.5
                }
            }
            (1, low) => {
                if low {
                    0.5
                } else {
                    -0.5
                }
            }
            _ => 0.0,
        };
        for (&(i, j), area) in sites.iter().zip(&areas) {
            let share = [layers(i, counts[0]) * edges[1], layers(j, counts[1]) * edges[0]];
            assert!((area - Vector::from(share)).amax() < 1e-12, "{area} at {i}, {j}");
        }
    }

    /// Of both kinds, about a point that is no corner.
    #[test]
    fn areas_turn_with_the_lattice() {
        let (low, high) = (Vector::<3>::new(1.0, -1.0, 0.0), Vector::<3>::new(2.0, 1.0, 0.5));
        let block = Shape::cuboid(low, high).expect("a box");
        let about = Vector::<3>::new(0.3, 2.0, -1.0);
        let turned = block.clone().turned(0.7, about, Vector::<3>::new(1.0, 2.0, -2.0));
        let spec = LatticeSpec::square([0.25, 0.5, 0.125]);
        let domain = Domain::default();
        let [straight, turned] = [&block, &turned.expect("a turned box")].map(|shape| {
            let filled = fill(shape, &spec).expect("particles");
            let (particles, edges) = (&filled.particles, &filled.actual_spacing);
            let areas = lattice_areas(particles, edges, &filled.rotation, &domain).expect("areas");
            let exposed = exposed_areas(&particles.position, edges, &filled.rotation, &domain);
            (filled, areas, exposed)
        });
        let rotation = turned.0.rotation;
        assert!((rotation.determinant() - 1.0).abs() < 1e-14);
        assert_eq!(turned.0.total_volume, straight.0.total_volume);
        for a in 0..straight.1.len() {
            let place = rotation * (straight.0.particles.position[a] - about) + about;
            assert!((turned.0.particles.position[a] - place).norm() < 1e-14);
            assert!((turned.1[a] - rotation * straight.1[a]).norm() < 1e-12);
            assert!((turned.2[a] - rotation * straight.2[a]).norm() < 1e-12);
        }
    }

    /// The corner of a wedge has a neighbour beside it, and one that is diagonal.
    #[test]
    fn a_sharp_corner_has_areas_by_its_diagonal_neighbours() {
        let corners = [[0.0, 0.0], [4.0, 0.0], [4.0, 2.0], [0.9, 2.0]].map(Vector::<2>::from);
        let shape = Shape::<2>::polygon(corners.to_vec(), None).expect("a polygon");
        let filled = fill(&shape, &LatticeSpec::square([0.25; 2])).expect("particles");
        let particles = &filled.particles;
        let areas = lattice_areas(particles, &[0.25; 2], &filled.rotation, &Domain::default());
        let areas = areas.expect("areas");
        let sum: Vector<2> = areas.iter().sum();
        assert!(sum.amax() < 1e-12, "{sum}");
        let moment: Tensor<2> =
            areas.iter().zip(&particles.position).map(|(a, x)| a * x.transpose()).sum();
        let off = (moment - Tensor::identity() * filled.total_volume).amax();
        assert!(off < 1e-12, "{moment}");
    }

    #[test]
    fn a_single_row_has_no_areas_across_and_says_where() {
        let shape = Shape::cuboid(Vector::<2>::new(3.0, 0.0), Vector::<2>::new(4.0, 0.1));
        let mut particles = fill(&shape.expect("a box"), &LatticeSpec::square([0.1, 0.1]))
            .expect("particles")
            .particles;
        let row: Vec<u32> = (0..particles.len() as u32)
            .filter(|&a| particles.position[a as usize][1] < 0.05)
            .collect();
        particles.reorder(&row);
        let domain = Domain::new([None; 2]).expect("open");
        let error = lattice_areas(&particles, &[0.1, 0.1], &Tensor::identity(), &domain)
            .expect_err("one row");
        let OperatorError::PoorSupport { position, .. } = error else { panic!("{error:?}") };
        assert!((3.0..=4.0).contains(&position[0]), "in metres: {position:?}");
    }

    /// A block of cells with a notch, in a box that it fills along y.
    #[test]
    fn what_no_other_cell_shares_is_exposed() {
        let edges = [0.5, 0.25];
        let mut places = Vec::new();
        for i in 0..4 {
            for j in 0..5 {
                if (i, j) != (3, 2) {
                    places.push(Vector::from([0.5 * f64::from(i) + 0.25, 0.25 * f64::from(j)]));
                }
            }
        }
        let open = exposed_areas(&places, &edges, &Tensor::identity(), &Domain::default());
        let sum: Vector<2> = open.iter().sum();
        assert!(sum.amax() < 1e-15, "a closed surface, {sum}");
        let facing = |areas: &[Vector<2>], axis: usize| -> f64 {
            areas.iter().map(|area| area[axis].max(0.0)).sum()
        };
        // The top and the lower side of the notch; four cells to the right and the notch's end.
        assert_eq!((facing(&open, 0), facing(&open, 1)), (1.25, 2.5));
        let inside = places.iter().position(|x| *x == Vector::from([0.75, 0.25]));
        assert_eq!(inside.map(|a| open[a]), Some(Vector::zeros()));
        let around = Domain::new([None, Some([0.0, 1.25])]).expect("a box");
        let closed = exposed_areas(&places, &edges, &Tensor::identity(), &around);
        assert_eq!((facing(&closed, 0), facing(&closed, 1)), (1.25, 0.5));
    }
}
