//! Regions turned into particles: boundaries, loads and tractions.

use std::sync::Arc;

use super::bodies::vector;
use crate::Vector;
use crate::boundaries::{
    BodyForce, PrescribedDisplacement, PrescribedVelocity, SpaceTime, Traction,
};
use crate::case::diagnostics::Problem;
use crate::case::expression::Expression;
use crate::case::model::{self, Case, LoadKind};
use crate::case::source::Located;
use crate::geometry::{Particles, Region};

/// The particles of `body` (all bodies if `None`) in a region, by index in memory; a problem if
/// there is none.
pub(super) fn select<const D: usize>(
    case: &Case,
    particles: &Particles<D>,
    region: &Located<model::Region>,
    body: Option<&Located<usize>>,
    problems: &mut Vec<Problem>,
) -> Vec<u32> {
    let built = match &region.value {
        model::Region::All => Ok(Region::All),
        model::Region::Plane { point, normal } => Region::plane(vector(point), vector(normal)),
        model::Region::Box { min, max } => Region::cuboid(vector(min), vector(max)),
        model::Region::Ball { center, radius } => Region::ball(vector(center), *radius),
        model::Region::HalfSpace { point, normal } => {
            Region::half_space(vector(point), vector(normal))
        }
    };
    let selected = match built {
        Ok(built) => built.select(particles),
        Err(error) => {
            problems.push(case.problem_at(region.place, error.to_string(), "this region", None));
            return Vec::new();
        }
    };
    let of_body =
        |a: &u32| body.is_none_or(|body| particles.body[*a as usize] as usize == body.value);
    let selected: Vec<u32> = selected.into_iter().filter(of_body).collect();
    if selected.is_empty() {
        let help = format!(
            "the particles lie between {} and {}",
            corner(particles, f64::min),
            corner(particles, f64::max)
        );
        problems.push(case.problem_at(
            region.place,
            "this region selects no particle",
            "no particle lies here",
            Some(help),
        ));
    }
    selected
}

fn corner<const D: usize>(particles: &Particles<D>, pick: fn(f64, f64) -> f64) -> String {
    let first = particles.position[0];
    let corner = particles.position.iter().fold(first, |corner, x| corner.zip_map(x, pick));
    format!("{:?}", corner.as_slice())
}

pub(super) fn function(expression: &Expression) -> Arc<dyn SpaceTime> {
    match expression.as_constant() {
        Some(value) => Arc::new(value),
        None => Arc::new(expression.clone()),
    }
}

/// The prescribed velocity components of all boundaries.
pub(super) fn prescribed<const D: usize>(
    case: &Case,
    particles: &Particles<D>,
    problems: &mut Vec<Problem>,
) -> Vec<PrescribedVelocity> {
    let mut conditions = Vec::new();
    for boundary in &case.boundaries {
        let selected = select(case, particles, &boundary.region, boundary.body.as_ref(), problems);
        for (component, value) in boundary.velocity.iter().enumerate() {
            if let Some(value) = value {
                conditions.push(PrescribedVelocity {
                    name: boundary.name.value.clone(),
                    particles: selected.clone(),
                    component,
                    value: function(value),
                });
            }
        }
    }
    conditions
}

/// The prescribed displacements of all boundaries.
pub(super) fn held<const D: usize>(
    case: &Case,
    particles: &Particles<D>,
    problems: &mut Vec<Problem>,
) -> Vec<PrescribedDisplacement<D>> {
    let mut conditions = Vec::new();
    for boundary in &case.boundaries {
        let selected = select(case, particles, &boundary.region, boundary.body.as_ref(), problems);
        for (component, value) in boundary.displacement.iter().enumerate() {
            if let Some(value) = value {
                let (name, value) = (boundary.name.value.clone(), function(value));
                let selected = selected.clone();
                conditions
                    .push(PrescribedDisplacement::component(name, selected, component, value));
            }
        }
    }
    conditions
}

/// The body forces.
pub(super) fn body_forces<const D: usize>(case: &Case) -> Vec<BodyForce<D>> {
    let mut forces = Vec::new();
    for load in &case.loads {
        if let LoadKind::BodyForce { acceleration } = &load.kind {
            forces.push(BodyForce {
                body: load.body.as_ref().map(|body| body.value as u32),
                acceleration: std::array::from_fn(|k| function(&acceleration[k])),
            });
        }
    }
    forces
}

/// The tractions, with the part of each particle's outward area that points along the normal of the
/// region. The areas are asked for where there is a traction, and a word why there are none is a
/// problem of its region.
pub(super) fn tractions<const D: usize>(
    case: &Case,
    particles: &Particles<D>,
    find_areas: impl Fn() -> Result<Vec<Vector<D>>, String>,
    problems: &mut Vec<Problem>,
) -> Vec<Traction<D>> {
    let mut areas = None;
    let mut tractions = Vec::new();
    for load in &case.loads {
        let LoadKind::Traction { region, traction } = &load.kind else { continue };
        let selected = select(case, particles, region, load.body.as_ref(), problems);
        let model::Region::Plane { normal, .. } = &region.value else {
            problems.push(case.problem_at(
                region.place,
                "a traction needs a plane, whose normal tells the loaded side",
                "not a plane",
                Some("use where = { kind = \"plane\", point = .., normal = .. }".into()),
            ));
            continue;
        };
        if areas.is_none() {
            match find_areas() {
                Ok(found) => areas = Some(found),
                Err(message) => {
                    problems.push(case.problem_at(region.place, message, "loaded here", None));
                    return tractions;
                }
            }
        }
        let normal = vector::<D>(normal).normalize();
        let along = |&a: &u32| areas.as_ref().map_or(0.0, |areas| areas[a as usize].dot(&normal));
        tractions.push(Traction {
            name: load.name.as_ref().map_or("traction".into(), |name| name.value.clone()),
            areas: selected.iter().map(along).map(|area| area.max(0.0)).collect(),
            particles: selected,
            value: std::array::from_fn(|k| function(&traction[k])),
        });
    }
    tractions
}
