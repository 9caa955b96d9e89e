//! Bodies that are partly in the same place.

use super::bodies::shape;
use crate::Vector;
use crate::case::diagnostics::Problem;
use crate::case::model::{Body, Case};
use crate::geometry::Particles;

/// The largest depth in spacings at which a particle may lie in another body. Where two bodies touch it is half a spacing
/// outside, or on the common face.
const DEPTH: f64 = 0.5;

/// The pairs of bodies that overlap, a problem each. Walls may overlap one another; those in the buffer of an opening are
/// told of with it. Of two bodies from files nothing is known but their particles: they are not compared.
pub(super) fn overlaps<const D: usize>(case: &Case, particles: &Particles<D>) -> Vec<Problem> {
    // Particles are stored body by body.
    let start = |body: usize| particles.body.partition_point(|&of| (of as usize) < body);
    let rows: Vec<_> = (0..case.bodies.len()).map(|body| start(body)..start(body + 1)).collect();
    let boxes: Vec<_> =
        rows.iter().map(|rows| corners(&particles.position[rows.clone()])).collect();
    let mut found: Vec<[usize; 2]> = Vec::new();
    let mut problems = Vec::new();
    for (number, body) in case.bodies.iter().enumerate() {
        // A shape that cannot be built has been refused.
        let inner = (!body.shape.is_from_file()).then(|| shape::<D>(case, body, &body.shape));
        let Some(Ok(inner)) = inner else { continue };
        let (min, max) = inner.bounding_box();
        let spacing = body.spacing.iter().copied().fold(f64::INFINITY, f64::min);
        for (other, outer) in case.bodies.iter().enumerate() {
            let (low, high) = &boxes[other];
            let is_near = (0..D).all(|axis| min[axis] <= high[axis] && low[axis] <= max[axis]);
            let is_exempt = |one: &Body, two: &Body| {
                one.wall.is_some() && (two.wall.is_some() || two.opening.is_some())
            };
            let may_overlap = is_exempt(body, outer) || is_exempt(outer, body);
            if other == number || !is_near || may_overlap || found.contains(&[other, number]) {
                continue;
            }
            let first = rows[other].start;
            let deeper = inner.first_deeper(rows[other].len(), |offset| {
                let a = first + offset;
                (particles.position[a], DEPTH * spacing.min(particles.spacing[a]))
            });
            if let Some(offset) = deeper {
                found.push([number, other]);
                problems.push(problem(case, [body, outer], particles, first + offset));
            }
        }
    }
    problems
}

/// The corners of the box around points.
fn corners<const D: usize>(points: &[Vector<D>]) -> (Vector<D>, Vector<D>) {
    let none = (Vector::repeat(f64::INFINITY), Vector::repeat(f64::NEG_INFINITY));
    points.iter().fold(none, |(low, high), x| (low.inf(x), high.sup(x)))
}

/// Particle `a` of the second body lies in the first.
fn problem<const D: usize>(
    case: &Case,
    [body, other]: [&Body; 2],
    particles: &Particles<D>,
    a: usize,
) -> Problem {
    let remedy = match other.shape.is_from_file() {
        true => "move one of the bodies",
        false => "move one of the bodies, or cut it out of the other with the shape `difference`",
    };
    let message = format!(
        "the bodies `{0}` and `{1}` overlap: particle {2} of `{1}`, at {3:?} m, lies inside `{0}`, where particles \
         would be twice as dense; {remedy}",
        *body.name,
        *other.name,
        particles.id[a],
        particles.position[a].as_slice(),
    );
    case.problem_at(body.shape.place, message, format!("body `{}`", *body.name), None)
}
