//! Regions turned into particles: boundaries, loads and tractions.

use std::sync::Arc;

use super::bodies::vector;
use crate::Vector;
use crate::boundaries::{
    BodyForce, PrescribedDisplacement, PrescribedFaces, PrescribedVelocity, SpaceTime, Traction,
};
use crate::case::diagnostics::Problem;
use crate::case::expression::Expression;
use crate::case::model::{self, Case, LoadKind};
use crate::case::source::Located;
use crate::case::suggest::suggestion;
use crate::geometry::{CloudPoints, Particles, Region};
use crate::operators::Trace;

/// What a region selects.
struct Selection {
    /// Particles by index in memory.
    particles: Vec<u32>,
    /// Faces of the surface of bodies from meshes.
    faces: Vec<u32>,
}

/// The particles of `body` (all bodies if `None`) in a region, by index in memory; a problem if
/// there is none.
pub(super) fn select<const D: usize>(
    case: &Case,
    particles: &Particles<D>,
    region: &Located<model::Region>,
    body: Option<&Located<usize>>,
    problems: &mut Vec<Problem>,
) -> Vec<u32> {
    let Some(selection) = selection(case, particles, region, body, problems) else {
        return Vec::new();
    };
    not_empty(case, particles, region, &selection.particles, problems);
    selection.particles
}

/// Reports a region that selects nothing.
fn not_empty<const D: usize>(
    case: &Case,
    particles: &Particles<D>,
    region: &Located<model::Region>,
    selected: &[u32],
    problems: &mut Vec<Problem>,
) {
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
}

fn selection<const D: usize>(
    case: &Case,
    particles: &Particles<D>,
    region: &Located<model::Region>,
    body: Option<&Located<usize>>,
    problems: &mut Vec<Problem>,
) -> Option<Selection> {
    let surface = &particles.surface;
    let built = match &region.value {
        model::Region::All => Ok(Region::All),
        model::Region::Plane { point, normal } => Region::plane(vector(point), vector(normal)),
        model::Region::Box { min, max } => Region::cuboid(vector(min), vector(max)),
        model::Region::Ball { center, radius } => Region::ball(vector(center), *radius),
        model::Region::HalfSpace { point, normal } => {
            Region::half_space(vector(point), vector(normal))
        }
        model::Region::Set { name } => {
            let Some(set) = surface.sets.get(name) else {
                problems.push(no_set(case, particles, region, name));
                return None;
            };
            let (particles_of, faces) = (set.particles.clone(), set.faces.clone());
            return Some(of_body(particles, Selection { particles: particles_of, faces }, body));
        }
    };
    let built = match built {
        Ok(built) => built,
        Err(error) => {
            problems.push(case.problem_at(region.place, error.to_string(), "this region", None));
            return None;
        }
    };
    let faces = built.faces(particles);
    let mut selected = built.select(particles);
    if let (Region::Plane { .. }, false) = (&built, faces.is_empty()) {
        // Of bodies with faces in the plane what belongs to them, not a layer.
        let own = |face: &u32| surface.faces[*face as usize].particles.iter().copied();
        let on_faces: Vec<u32> = faces.iter().flat_map(own).collect();
        let mut bodies: Vec<u32> = on_faces.iter().map(|&a| particles.body[a as usize]).collect();
        bodies.sort_unstable();
        bodies.dedup();
        selected.retain(|&a| bodies.binary_search(&particles.body[a as usize]).is_err());
        selected.extend(on_faces);
        selected.sort_unstable();
        selected.dedup();
    }
    Some(of_body(particles, Selection { particles: selected, faces }, body))
}

/// What of a selection belongs to a body, or to any.
fn of_body<const D: usize>(
    particles: &Particles<D>,
    mut selection: Selection,
    body: Option<&Located<usize>>,
) -> Selection {
    if let Some(body) = body {
        let is_of = |a: u32| particles.body[a as usize] as usize == body.value;
        selection.particles.retain(|&a| is_of(a));
        let faces = &particles.surface.faces;
        selection.faces.retain(|&face| is_of(faces[face as usize].particles[0]));
    }
    selection
}

fn no_set<const D: usize>(
    case: &Case,
    particles: &Particles<D>,
    region: &Located<model::Region>,
    name: &str,
) -> Problem {
    let message = format!("there is no set `{name}`");
    let known = particles.surface.sets.keys().map(String::as_str);
    let help = match (particles.surface.bodies.is_empty(), known.len()) {
        (true, _) => "no body comes from a mesh: use a region by place".to_owned(),
        (false, 0) => {
            "the mesh names nothing: give its parts physical groups, or use a region by place"
                .into()
        }
        (false, _) => suggestion(name, known),
    };
    case.problem_at(region.place, message, "unknown set", Some(help))
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

/// What holds a body in statics.
#[derive(Default)]
pub(super) struct Held<const D: usize> {
    pub particles: Vec<PrescribedDisplacement<D>>,
    pub faces: Vec<PrescribedFaces<D>>,
}

/// The prescribed displacements of all boundaries: of the faces that a region selects where particles
/// are centres of cells, as no particle lies there, of particles elsewhere.
pub(super) fn held<const D: usize>(
    case: &Case,
    particles: &Particles<D>,
    problems: &mut Vec<Problem>,
) -> Held<D> {
    let surface = &particles.surface;
    let numbers = trace_numbers(particles);
    let mut held = Held { particles: Vec::new(), faces: Vec::new() };
    for boundary in &case.boundaries {
        let (region, body) = (&boundary.region, boundary.body.as_ref());
        let Some(found) = selection(case, particles, region, body, problems) else { continue };
        let mut selected = found.particles;
        let mut faces = Vec::new();
        if region.value != model::Region::All {
            faces.extend(found.faces.iter().filter_map(|&face| numbers[face as usize]));
            let owner =
                |&face: &u32| particles.body[surface.faces[face as usize].particles[0] as usize];
            let bodies: Vec<u32> = found.faces.iter().map(owner).collect();
            selected.retain(|&a| {
                let body = particles.body[a as usize];
                let is_of_cells = surface.bodies.get(&body) == Some(&CloudPoints::Cells);
                !(is_of_cells && bodies.contains(&body))
            });
        }
        if faces.is_empty() {
            not_empty(case, particles, region, &selected, problems);
        }
        for (component, value) in boundary.displacement.iter().enumerate() {
            let Some(value) = value else { continue };
            let (name, value) = (boundary.name.value.clone(), function(value));
            if !selected.is_empty() {
                let (name, value, selected) = (name.clone(), value.clone(), selected.clone());
                let condition = PrescribedDisplacement::component(name, selected, component, value);
                held.particles.push(condition);
            }
            if !faces.is_empty() {
                let direction = Vector::from_fn(|i, _| f64::from(u8::from(i == component)));
                let faces = faces.clone();
                held.faces.push(PrescribedFaces { name, faces, direction, value });
            }
        }
    }
    held
}

/// The numbers that faces of the surface have in a [`Trace`], which those of centres of cells have.
pub(super) fn trace_numbers<const D: usize>(particles: &Particles<D>) -> Vec<Option<u32>> {
    let mut next = 0;
    let number = |is_of_nodes: bool| {
        next += u32::from(!is_of_nodes);
        (!is_of_nodes).then(|| next - 1)
    };
    particles.surface.faces.iter().map(|face| face.is_of_nodes()).map(number).collect()
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

/// The tractions. On particles of a lattice or of points the part of each outward area that points
/// along the normal of the region, as values at the particles; the areas are asked for where there is
/// such a traction, and a word why there are none is a problem of its region. On bodies from meshes
/// sums over the selected faces, which nodes share, and centres of cells by their trace.
pub(super) fn tractions<const D: usize>(
    case: &Case,
    particles: &Particles<D>,
    trace: Option<&Trace<D>>,
    find_areas: impl Fn() -> Result<Vec<Vector<D>>, String>,
    problems: &mut Vec<Problem>,
) -> Vec<Traction<D>> {
    let mut areas = None;
    let mut tractions = Vec::new();
    let is_of_mesh = |a: u32| particles.surface.bodies.contains_key(&particles.body[a as usize]);
    for load in &case.loads {
        let LoadKind::Traction { region, traction } = &load.kind else { continue };
        let Some(found) = selection(case, particles, region, load.body.as_ref(), problems) else {
            continue;
        };
        let name = load.name.as_ref().map_or("traction".into(), |name| name.value.clone());
        let value: [Arc<dyn SpaceTime>; D] = std::array::from_fn(|k| function(&traction[k]));
        let others: Vec<u32> =
            found.particles.iter().copied().filter(|&a| !is_of_mesh(a)).collect();
        if !found.faces.is_empty() {
            tractions.push(on_faces(particles, trace, &found.faces, name.clone(), value.clone()));
        } else if others.is_empty() {
            let of_mesh = !found.particles.is_empty();
            match of_mesh {
                true => problems.push(case.problem_at(
                    region.place,
                    "this region selects particles, but no face of the boundary",
                    "nothing to load",
                    Some("select faces: a plane, a set of faces, or a box around them".into()),
                )),
                false => not_empty(case, particles, region, &found.particles, problems),
            }
            continue;
        }
        if others.is_empty() {
            continue;
        }
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
            name,
            areas: others.iter().map(along).map(|area| area.max(0.0)).collect(),
            particles: others,
            places: Vec::new(),
            value,
        });
    }
    tractions
}

/// A traction summed over faces.
fn on_faces<const D: usize>(
    particles: &Particles<D>,
    trace: Option<&Trace<D>>,
    faces: &[u32],
    name: String,
    value: [Arc<dyn SpaceTime>; D],
) -> Traction<D> {
    let numbers = trace_numbers(particles);
    let mut traction =
        Traction { name, particles: Vec::new(), areas: Vec::new(), places: Vec::new(), value };
    for &face in faces {
        // Where there is a trace, a load on a face acts by it on the support of its cell.
        let traced = trace.zip(numbers[face as usize]).map(|(trace, f)| trace.row(f as usize));
        for sample in particles.surface.faces[face as usize].samples() {
            let area = sample.area.norm();
            for &(a, share) in traced.as_ref().unwrap_or(&sample.shares) {
                traction.particles.push(a);
                traction.areas.push(area * share);
                traction.places.push(sample.place);
            }
        }
    }
    traction
}
