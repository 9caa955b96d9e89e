//! The boundary of a lattice.

use piola_formulas::kernels::Kernel;

use super::{Correction, GradientOperator, OperatorError, Support};
use crate::Vector;
use crate::geometry::{Particles, Surface};
use crate::neighbors::Domain;

/// Smoothing length in spacings with which a particle of a lattice sees those beside it and no
/// diagonal ones.
const NARROW: f64 = 0.7;

/// Areas below this share of a face of the cell are rounding errors.
const ROUNDING: f64 = 1e-9;

/// Outward boundary area vectors in m^(D-1) of the particles of a lattice with these edges of a cell
/// in m: those of its narrow gradient operator, theory (14), which on a box are the shares of its
/// faces. They sum to zero, and times the places to the volume, whatever the shape.
///
/// # Errors
/// When a particle has no neighbour along some axis, or the box repeats itself too soon.
pub fn lattice_areas<const D: usize>(
    particles: &Particles<D>,
    edges: &[f64; D],
    domain: &Domain<D>,
) -> Result<Vec<Vector<D>>, OperatorError> {
    let edges = Vector::<D>::from(*edges);
    let cell = edges.product();
    let count = particles.len();
    // In units of the edges the lattice is one of cubes.
    let scaled = Particles {
        position: particles.position.iter().map(|x| x.component_div(&edges)).collect(),
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
    let support = Support::new(&scaled, Kernel::CubicSpline, NARROW, domain)?;
    let operator = GradientOperator::new(&scaled, &support, Correction::Gradient);
    let operator = operator.map_err(|error| in_metres(error, particles))?;
    let areas = operator.boundary_areas(&support, &scaled.volume);
    let clean = |area: Vector<D>| match area.norm() < ROUNDING {
        true => Vector::zeros(),
        false => area.component_div(&edges) * cell,
    };
    Ok(areas.into_iter().map(clean).collect())
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
        let areas = lattice_areas(particles, edges, &domain).expect("areas");
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
        let error = lattice_areas(&particles, &[0.1, 0.1], &domain).expect_err("one row");
        let OperatorError::PoorSupport { position, .. } = error else { panic!("{error:?}") };
        assert!((3.0..=4.0).contains(&position[0]), "in metres: {position:?}");
    }
}
