//! Regions turned into particles, and what boundaries do to them.

use std::sync::Arc;

use super::bodies::vector;
use super::joined::Joined;
use crate::Vector;
use crate::boundaries::{
    History, PrescribedDisplacement, PrescribedFaces, PrescribedVelocity, Push, Scaled, SpaceTime,
    Tie,
};
use crate::case::diagnostics::Problem;
use crate::case::expression::Expression;
use crate::case::model::{self, Case};
use crate::case::source::Located;
use crate::case::suggest::suggestion;
use crate::coordinates;
use crate::geometry::{CloudPoints, Particles, Region};
use crate::schemes::total_lagrangian::RigidBody;

/// What a region selects.
pub(super) struct Selection {
    /// Particles by index in memory.
    pub particles: Vec<u32>,
    /// Faces of the surface of bodies from meshes.
    pub faces: Vec<u32>,
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
pub(super) fn not_empty<const D: usize>(
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

/// What a region selects of `body`, all bodies if `None`; a problem if there is no such region.
pub(super) fn selection<const D: usize>(
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
    coordinates(corner.as_slice())
}

pub(super) fn function(expression: &Expression) -> Arc<dyn SpaceTime> {
    match expression.as_constant() {
        Some(value) => Arc::new(value),
        None => Arc::new(expression.clone()),
    }
}

/// An expression times what a table of its load or boundary gives over time.
pub(super) fn over_time(
    expression: &Expression,
    history: Option<&Arc<History>>,
) -> Arc<dyn SpaceTime> {
    scaled(function(expression), history)
}

/// A value times what a table gives over time.
fn scaled(value: Arc<dyn SpaceTime>, history: Option<&Arc<History>>) -> Arc<dyn SpaceTime> {
    match history {
        Some(history) => Arc::new(Scaled { value, history: history.clone() }),
        None => value,
    }
}

/// The prescribed velocity components of all boundaries.
pub(super) fn prescribed<const D: usize>(
    case: &Case,
    particles: &Particles<D>,
    problems: &mut Vec<Problem>,
) -> Vec<PrescribedVelocity> {
    let mut conditions = Vec::new();
    let moves_rigid = |boundary: &&model::Boundary| {
        boundary.body.as_ref().is_some_and(|body| is_rigid(case, body.value))
    };
    for boundary in case.boundaries.iter().filter(|boundary| !moves_rigid(boundary)) {
        let selected = select(case, particles, &boundary.region, boundary.body.as_ref(), problems);
        let history = boundary.history.as_ref();
        let mut prescribe = |component: usize, value: Arc<dyn SpaceTime>| {
            conditions.push(PrescribedVelocity {
                name: boundary.name.value.clone(),
                particles: selected.clone(),
                component,
                value,
            });
        };
        for (component, value) in boundary.velocity.iter().enumerate() {
            if let Some(value) = value {
                prescribe(component, over_time(value, history));
            }
        }
        if let Some((maker, direction)) = boundary.wave_maker.as_ref().map(|maker| &maker.value) {
            for (component, &share) in direction.iter().enumerate().filter(|(_, it)| **it != 0.0) {
                let push = Push { maker: maker.clone(), share };
                prescribe(component, scaled(Arc::new(push), history));
            }
        }
    }
    conditions
}

pub(super) fn is_rigid(case: &Case, body: usize) -> bool {
    matches!(case.bodies[body].material.value, model::Material::Rigid { .. })
}

/// The rigid bodies, with what boundaries prescribe of them.
pub(super) fn rigid<const D: usize>(
    case: &Case,
    particles: &Particles<D>,
    joined: &Joined,
) -> Vec<RigidBody<D>> {
    let mut all = Vec::new();
    for (number, body) in case.bodies.iter().enumerate().filter(|(k, _)| is_rigid(case, *k)) {
        let is_of = |a: &u32| {
            let (own, id) = (particles.body[*a as usize], particles.id[*a as usize]);
            own as usize == number || joined.has_part_of(id, number as u32)
        };
        let mut rigid = RigidBody {
            name: body.name.value.clone(),
            particles: (0..particles.len() as u32).filter(is_of).collect(),
            ..RigidBody::default()
        };
        let is_its =
            |it: &&model::Boundary| it.body.as_ref().map(|body| body.value) == Some(number);
        for boundary in case.boundaries.iter().filter(is_its) {
            let value = |value: &Expression| over_time(value, boundary.history.as_ref());
            let given = |values: &[Option<Expression>]| -> Vec<_> {
                let values = values.iter().enumerate();
                values.filter_map(|(axis, it)| Some((axis, value(it.as_ref()?)))).collect()
            };
            rigid.velocity.extend(given(&boundary.velocity));
            if let Some(turning) = &boundary.turning {
                rigid.angular_velocity.extend(given(&turning.angular_velocity));
                rigid.pivot = turning.pivot.as_deref().map(vector).or(rigid.pivot);
            }
        }
        all.push(rigid);
    }
    all
}

/// What holds a body in statics.
#[derive(Default)]
pub(super) struct Held<const D: usize> {
    pub particles: Vec<PrescribedDisplacement<D>>,
    pub faces: Vec<PrescribedFaces<D>>,
    pub ties: Vec<Tie>,
}

/// The prescribed displacements of all boundaries: of the faces that a region selects where particles
/// are centres of cells, as no particle lies there, of particles elsewhere. And what they tie.
pub(super) fn held<const D: usize>(
    case: &Case,
    particles: &Particles<D>,
    problems: &mut Vec<Problem>,
) -> Held<D> {
    let mut held = Held::default();
    for boundary in &case.boundaries {
        let Some(Selection { particles: selected, faces }) =
            held_parts(case, particles, boundary, problems)
        else {
            continue;
        };
        if faces.is_empty() {
            not_empty(case, particles, &boundary.region, &selected, problems);
        }
        let name = &boundary.name.value;
        let along_axes = boundary.displacement.iter().enumerate().filter_map(|(axis, value)| {
            let direction = Vector::<D>::from_fn(|i, _| f64::from(u8::from(i == axis)));
            value.as_ref().map(|value| (direction, value))
        });
        let rollers = boundary.roller.iter();
        let along_normal = rollers.map(|roller| (vector(&roller.normal), &roller.displacement));
        for (direction, value) in along_axes.chain(along_normal) {
            let (name, value) = (name.clone(), over_time(value, boundary.history.as_ref()));
            if !faces.is_empty() {
                let (name, value, faces) = (name.clone(), value.clone(), faces.clone());
                held.faces.push(PrescribedFaces { name, faces, direction, value });
            }
            if !selected.is_empty() {
                let particles = selected.clone();
                held.particles.push(PrescribedDisplacement { name, particles, direction, value });
            }
        }
        for tied in &boundary.tied {
            if !faces.is_empty() {
                let message = "centres of cells do not lie on the boundary, and cannot be tied";
                let help = "use `points = \"nodes\"` for this body".to_owned();
                let label = "no particle lies on these faces";
                problems.push(case.problem_at(tied.place, message, label, Some(help)));
            }
            let (particles, component) = (selected.clone(), tied.value);
            held.ties.push(Tie { name: name.clone(), particles, component });
        }
    }
    held
}

/// What of a boundary is held: particles, and by their numbers in a trace the faces of cells.
fn held_parts<const D: usize>(
    case: &Case,
    particles: &Particles<D>,
    boundary: &model::Boundary,
    problems: &mut Vec<Problem>,
) -> Option<Selection> {
    let (region, body) = (&boundary.region, boundary.body.as_ref());
    let mut found = selection(case, particles, region, body, problems)?;
    if region.value == model::Region::All {
        found.faces.clear();
        return Some(found);
    }
    let surface = &particles.surface;
    let owner = |&face: &u32| particles.body[surface.faces[face as usize].particles[0] as usize];
    let bodies: Vec<u32> = found.faces.iter().map(owner).collect();
    found.particles.retain(|&a| {
        let body = particles.body[a as usize];
        let is_of_cells = surface.bodies.get(&body) == Some(&CloudPoints::Cells);
        !(is_of_cells && bodies.contains(&body))
    });
    let numbers = trace_numbers(particles);
    found.faces = found.faces.iter().filter_map(|&face| numbers[face as usize]).collect();
    Some(found)
}

/// The numbers that faces of the surface have in a trace, which those of centres of cells have.
pub(super) fn trace_numbers<const D: usize>(particles: &Particles<D>) -> Vec<Option<u32>> {
    let mut next = 0;
    let number = |is_of_nodes: bool| {
        next += u32::from(!is_of_nodes);
        (!is_of_nodes).then(|| next - 1)
    };
    particles.surface.faces.iter().map(|face| face.is_of_nodes()).map(number).collect()
}
