//! Bodies turned into particles.

use crate::Vector;
use crate::case::diagnostics::Problem;
use crate::case::model::{Case, Shape};
use crate::geometry::Particles;
use crate::neighbors::Domain;

/// What became of one body.
#[derive(Clone, Debug, PartialEq)]
pub struct BodyReport {
    /// Its name.
    pub name: String,
    /// Its particles.
    pub particles: usize,
    /// Sum of their quadrature volumes in m^D.
    pub volume: f64,
    /// The volume of its shape in m^D where that is known.
    pub exact_volume: Option<f64>,
    /// The particle spacing along each axis in m.
    pub spacing: Vec<f64>,
}

/// A vector of a case as one of `D` components; the reader has checked its length.
pub(super) fn vector<const D: usize>(components: &[f64]) -> Vector<D> {
    Vector::from_column_slice(components)
}

pub(super) fn particles<const D: usize>(
    case: &Case,
    _d: &Domain<D>,
) -> Result<(Particles<D>, Vec<BodyReport>), Vec<Problem>> {
    let body = &case.bodies[0];
    let Shape::Box { min, max } = &body.shape.value else { return Err(vec![]) };
    let p = crate::geometry::lattice(vector::<D>(min), vector(max), vector(&body.spacing));
    let r = BodyReport {
        name: body.name.value.clone(),
        particles: p.len(),
        volume: p.volume.iter().sum(),
        exact_volume: None,
        spacing: body.spacing.value.clone(),
    };
    Ok((p, vec![r]))
}
