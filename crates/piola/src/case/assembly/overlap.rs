//! Bodies that are partly in the same place.

use super::bodies::shape;
use crate::case::diagnostics::Problem;
use crate::case::model::{Body, Case};
use crate::geometry::Particles;

/// The largest depth in spacings at which a particle may lie in another body. Where two bodies touch it is half a spacing
/// outside, or on the common face.
const DEPTH: f64 = 0.5;

/// The pairs of bodies that overlap, a problem each. Walls may overlap one another, and openings the fluid that they fill.
pub(super) fn overlaps<const D: usize>(case: &Case, particles: &Particles<D>) -> Vec<Problem> {
    let mut problems = Vec::new();
    for (number, body) in case.bodies.iter().enumerate() {
        // Bodies from files have no shape, and a shape that cannot be built has been refused.
        let Some(Ok(inner)) =
            (!body.shape.is_from_file()).then(|| shape::<D>(case, body, &body.shape))
        else {
            continue;
        };
        let spacing = body.spacing.iter().copied().fold(f64::INFINITY, f64::min);
        for (other, outer) in case.bodies.iter().enumerate().filter(|(other, _)| *other != number) {
            let both_found =
                other < number && problems.iter().any(|(pair, _)| *pair == [other, number]);
            if both_found || !excludes(body, outer) {
                continue;
            }
            // Particles stand body by body.
            let [first, end] = [other, other + 1]
                .map(|body| particles.body.partition_point(|&of| (of as usize) < body));
            let deeper = inner.first_deeper(end - first, |offset| {
                let a = first + offset;
                (particles.position[a], DEPTH * spacing.min(particles.spacing[a]))
            });
            if let Some(offset) = deeper {
                let problem = problem(case, [body, outer], particles, first + offset);
                problems.push(([number, other], problem));
            }
        }
    }
    problems.into_iter().map(|(_, problem)| problem).collect()
}

/// Whether two bodies may not be in the same place.
fn excludes(body: &Body, other: &Body) -> bool {
    let are_walls = body.wall.is_some() && other.wall.is_some();
    !are_walls && body.opening.is_none() && other.opening.is_none()
}

/// Particle `a` of the second body lies in the first.
fn problem<const D: usize>(
    case: &Case,
    [body, other]: [&Body; 2],
    particles: &Particles<D>,
    a: usize,
) -> Problem {
    let message = format!(
        "the bodies `{0}` and `{1}` overlap: particle {2} of `{1}`, at {3:?} m, lies inside `{0}`, where particles \
         would be twice as dense; move one of them, or cut it out of the other with the shape `difference`",
        *body.name,
        *other.name,
        particles.id[a],
        particles.position[a].as_slice(),
    );
    case.problem_at(body.shape.place, message, format!("body `{}`", *body.name), None)
}
