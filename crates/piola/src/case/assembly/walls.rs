//! Walls of fluids: where they are, how they move, and the faces that hold the fluid.

use super::{bodies, selections};
use crate::Vector;
use crate::boundaries::PrescribedVelocity;
use crate::case::diagnostics::Problem;
use crate::case::model::{self, Case};
use crate::coordinates;
use crate::geometry::{Faces, Particles, Shape};
use crate::schemes::transport_velocity::Wall;

/// The bodies that are walls.
pub(super) fn walls(case: &Case) -> Vec<Wall> {
    let bodies = (0u32..).zip(&case.bodies);
    let wall = |(number, body): (u32, &model::Body)| {
        body.wall.as_ref().map(|wall| Wall { body: number, slip: wall.slip })
    };
    bodies.filter_map(wall).collect()
}

/// How deep behind a face in spacings particles are its first layer: where that is on the face, the next is a spacing behind it.
const FIRST: f64 = 0.99;

/// The shape of all walls together, and the faces that their particles are behind: the shortest ways
/// out of all walls together, inside the box around all bodies, so that the outer faces of a tank do
/// not count. In a periodic box the box itself is no wall either. Walls at rest have the faces that they have without those
/// that move: a floor under a piston is free when that is drawn back. Those that move have the faces that they have at the
/// start, so that the end on which one stands has none. Bodies of other systems come away from the walls:
/// their faces are their own, and where they are thin those of one side, by the number of the first
/// particle that stands for a second side and the support of the kernel in m.
pub(super) fn faces<const D: usize>(
    case: &Case,
    particles: &Particles<D>,
    (first_twin, support): (u32, f64),
) -> Result<(Vec<Faces<D>>, Option<Shape<D>>), Vec<Problem>> {
    let mut faces = vec![Faces::default(); particles.len()];
    let is_wall: Vec<bool> = case.bodies.iter().map(|body| body.wall.is_some()).collect();
    if !is_wall.contains(&true) {
        return Ok((faces, None));
    }
    // The walls that are no bodies of other systems, with their numbers.
    let (mut fixed, moving) = (Vec::new(), moving(case)?);
    let mut bounds = None::<(Vector<D>, Vector<D>)>;
    for (number, (body, is_wall)) in case.bodies.iter().zip(&is_wall).enumerate() {
        let (low, high) = match (&body.shape.value, is_wall) {
            (shape, false) if shape.is_from_file() => {
                let all = particles.position.iter().zip(&particles.body);
                let own = all.filter(|(_, body)| **body as usize == number);
                bodies::box_around(own.map(|(x, _)| x))
            }
            (shape, true) if shape.is_from_file() => {
                let message = match body.system {
                    Some(_) => "points from a file have no faces, which a solid in a fluid needs",
                    None => "points from a file have no faces, which a wall needs",
                };
                let help = Some("describe it by shapes".to_owned());
                return Err(vec![case.problem_at(body.shape.place, message, "of a wall", help)]);
            }
            _ => {
                let shape: Shape<D> =
                    bodies::shape(case, body, &body.shape).map_err(|problem| vec![problem])?;
                let ends = shape.bounding_box();
                if *is_wall && body.system.is_none() {
                    fixed.push((number as u32, shape));
                }
                ends
            }
        };
        let (least, most) = bounds.unwrap_or((low, high));
        bounds = Some((least.inf(&low), most.sup(&high)));
    }
    let Some(bounds) = bounds else { return Ok((faces, None)) };
    let shapes = fixed.iter().map(|(_, shape)| shape.clone());
    let walls = Shape::union(shapes.collect()).ok();
    // A layer holds what is in front of the boundary that it follows, and reaches out of the bounds behind that.
    let extent = (bounds.1 - bounds.0).norm();
    let moves: Vec<bool> = fixed.iter().map(|(number, _)| moves(case, *number)).collect();
    let seen = fixed.iter().enumerate().filter_map(|(index, (number, _))| {
        let others = fixed.iter().enumerate().filter(|(other, _)| moves[index] || !moves[*other]);
        let shapes = others.map(|(other, (_, shape))| match other == index {
            true => shape.thickened(extent),
            false => shape.clone(),
        });
        Some((*number, Shape::union(shapes.collect()).ok()?))
    });
    let seen: Vec<(u32, Shape<D>)> = seen.collect();
    crate::parallel::for_each_chunk(&mut faces, |first, rows| {
        for (offset, row) in rows.iter_mut().enumerate() {
            let (x, body) = (&particles.position[first + offset], particles.body[first + offset]);
            let layer = FIRST * particles.spacing[first + offset];
            if let Some((_, shape)) = moving.iter().find(|(number, _)| *number == body) {
                let bounds = everywhere(case, shape);
                let is_first = particles.id[first + offset] < first_twin;
                *row = match shape.sides(x, [support, layer], &bounds) {
                    Some([front, back]) => {
                        if is_first {
                            front
                        } else {
                            back
                        }
                    }
                    None => shape.ways_out(x, layer, &bounds),
                };
            } else if let Some((_, shape)) = seen.iter().find(|(number, _)| *number == body) {
                *row = shape.ways_out(x, layer, &bounds);
            }
        }
    });
    Ok((faces, walls))
}

/// Whether something prescribes how the body of this number moves.
fn moves(case: &Case, number: u32) -> bool {
    let is_its =
        |it: &&model::Boundary| it.body.as_ref().is_none_or(|it| it.value == number as usize);
    case.boundaries.iter().filter(is_its).any(model::Boundary::moves)
}

/// A warning of fluid behind the far face of a layer that is a wall, closer than the support of the kernel in m.
pub(super) fn behind_layers<const D: usize>(
    case: &Case,
    particles: &Particles<D>,
    support: f64,
) -> Result<Vec<String>, Vec<Problem>> {
    let mut warnings = Vec::new();
    let is_wall = |a: usize| case.bodies[particles.body[a] as usize].wall.is_some();
    let fluid: Vec<usize> = (0..particles.len()).filter(|&a| !is_wall(a)).collect();
    for body in case.bodies.iter().filter(|body| body.wall.is_some() && body.system.is_none()) {
        let own: Shape<D> =
            bodies::shape(case, body, &body.shape).map_err(|problem| vec![problem])?;
        let thick = own.thickened(support);
        if thick == own {
            continue;
        }
        let place = |a: usize| (particles.position[a], 0.25 * particles.spacing[a]);
        // In the layer itself is no fluid: bodies that overlap have been refused.
        if let Some(found) = thick.first_deeper(fluid.len(), |index| place(fluid[index])) {
            warnings.push(format!(
                "the wall `{}` is a layer, which holds back fluid only at the boundary that it follows, and there is fluid \
                 behind its far face, at {} m: describe it by two shapes and their `difference`",
                *body.name,
                coordinates(particles.position[fluid[found]].as_slice())
            ));
        }
    }
    Ok(warnings)
}

/// Doubles the wall particles of thin bodies of other systems, so that each side has its own: fluid on one
/// side, within the support of the kernel in m, would be seen from the other. Returns the number in the order of
/// creation of the first that was added.
pub(super) fn double_thin<const D: usize>(
    case: &Case,
    particles: &mut Particles<D>,
    support: f64,
) -> Result<u32, Vec<Problem>> {
    let first = particles.len();
    for (number, shape) in moving(case)? {
        let bounds = everywhere(case, &shape);
        let own = (0..first).filter(|&a| particles.body[a] == number);
        let reach = |a: usize| [support, FIRST * particles.spacing[a]];
        let is_thin =
            |a: &usize| shape.sides(&particles.position[*a], reach(*a), &bounds).is_some();
        let thin: Vec<usize> = own.filter(is_thin).collect();
        thin.into_iter().for_each(|a| particles.repeat(a, number));
    }
    Ok(first as u32)
}

/// The shapes of bodies of other systems, by the number of the body.
fn moving<const D: usize>(case: &Case) -> Result<Vec<(u32, Shape<D>)>, Vec<Problem>> {
    let bodies = (0u32..).zip(&case.bodies).filter(|(_, body)| body.system.is_some());
    let shapes = bodies.filter(|(_, body)| !body.shape.value.is_from_file());
    let shape = |(number, body): (u32, &model::Body)| {
        let shape = bodies::shape(case, body, &body.shape).map_err(|problem| vec![problem])?;
        Ok((number, shape))
    };
    shapes.map(shape).collect()
}

/// A box that all ways out of a shape end inside of; a bound of a periodic axis is no way out.
fn everywhere<const D: usize>(case: &Case, shape: &Shape<D>) -> (Vector<D>, Vector<D>) {
    let (low, high) = shape.bounding_box();
    let margin = (high - low).norm();
    let ends = |axis: usize| case.domain.periodic[axis].as_ref().map(|ends| ends.value);
    (
        Vector::from_fn(|axis, _| ends(axis).map_or(low[axis] - margin, |[low, _]| low)),
        Vector::from_fn(|axis, _| ends(axis).map_or(high[axis] + margin, |[_, high]| high)),
    )
}

/// The velocities of surfaces that slide.
pub(super) fn sliding<const D: usize>(
    case: &Case,
    particles: &Particles<D>,
) -> Vec<PrescribedVelocity> {
    let mut conditions = Vec::new();
    for (number, body) in case.bodies.iter().enumerate() {
        let Some(wall) = &body.wall else { continue };
        for (component, value) in wall.sliding.iter().enumerate() {
            let Some(value) = value else { continue };
            let of_body = |&a: &u32| particles.body[a as usize] as usize == number;
            conditions.push(PrescribedVelocity {
                name: body.name.value.clone(),
                particles: (0..particles.len() as u32).filter(of_body).collect(),
                component,
                value: selections::function(value),
            });
        }
    }
    conditions
}
