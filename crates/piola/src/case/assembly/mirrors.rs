//! What stands beyond the boundary of a solid: mirror images, and in the strong form holes.

use super::joined::SAME_PLACE;
use super::{bodies, integrator_kind};
use crate::case::diagnostics::Problem;
use crate::case::model::{self, Case};
use crate::geometry::Particles;
use crate::operators::{Continuation, Mirror};
use crate::schemes::total_lagrangian::{Form, Hole};

/// The discs that are cut out of bodies.
pub(super) fn holes<const D: usize>(case: &Case) -> Vec<Hole<D>> {
    let mut holes = Vec::new();
    for body in &case.bodies {
        let model::Shape::Difference { remove, .. } = &body.shape.value else { continue };
        for shape in remove {
            if let model::Shape::Ball { center, radius } = &shape.value {
                holes.push(Hole { center: bodies::vector::<D>(center), radius: *radius });
            }
        }
    }
    holes
}

/// The planes beyond which the body is mirrored, each with a particle on it.
pub(super) fn mirrors<const D: usize>(
    case: &Case,
    form: Form,
    particles: &Particles<D>,
    problems: &mut Vec<Problem>,
) -> Vec<(Mirror, u32)> {
    let mut mirrors = Vec::new();
    for boundary in &case.boundaries {
        let Some(mirror) = &boundary.mirror else { continue };
        let mut refuse = |message: &str, help: &str| {
            let help = Some(help.to_owned());
            problems.push(case.problem_at(mirror.place, message, "this mirror", help));
        };
        if form == Form::Strong && D == 1 {
            refuse("the strong form creates its own ghosts", "remove `mirror`");
            continue;
        }
        let model::Region::Plane { point, normal } = &boundary.region.value else {
            refuse(
                "a mirror is a plane",
                "use where = { kind = \"plane\", point = .., normal = .. }",
            );
            continue;
        };
        let (point, normal) = (bodies::vector::<D>(point), bodies::vector::<D>(normal).normalize());
        let Some(axis) = (0..D).find(|&axis| normal[axis].abs() > 1.0 - 1e-12) else {
            refuse("a mirror lies across an axis", "turn the case so that its normal is an axis");
            continue;
        };
        let (across, key) = match integrator_kind(case).is_static() {
            true => (&boundary.displacement, "displacement"),
            false => (&boundary.velocity, "velocity"),
        };
        if across.get(axis).is_none_or(Option::is_none) {
            refuse(
                &format!("a mirror needs the {key} across it"),
                &format!("for a symmetry plane set its component of `{key}` to \"0\""),
            );
            continue;
        }
        if form == Form::Strong {
            // What is prescribed on an edge makes it a mirror there.
            continue;
        }
        let body = boundary.body.as_ref().map(|body| body.value as u32);
        let on_plane = |&a: &usize| {
            body.is_none_or(|body| body == particles.body[a])
                && (particles.position[a][axis] - point[axis]).abs()
                    < SAME_PLACE * particles.spacing[a]
        };
        let Some(particle) = (0..particles.len()).find(on_plane) else {
            refuse(
                "no particle lies on the mirror",
                "lay the lattice on the boundary, and the plane on its face",
            );
            continue;
        };
        let (place, is_upper) = (particles.position[particle][axis], normal[axis] > 0.0);
        let continuation = Continuation::Odd;
        mirrors.push((Mirror { axis, place, is_upper, continuation }, particle as u32));
    }
    mirrors
}

/// Gives particles on a mirror, which are their own images, the weight of the whole cell.
pub(super) fn whole_weights<const D: usize>(
    particles: &mut Particles<D>,
    mirrors: &[(Mirror, u32)],
) {
    for a in 0..particles.len() {
        for (mirror, _) in mirrors {
            let distance = (particles.position[a][mirror.axis] - mirror.place).abs();
            if distance < SAME_PLACE * particles.spacing[a] {
                particles.weight[a] *= 2.0;
            }
        }
    }
}
