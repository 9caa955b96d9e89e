//! Whether the parts that a scheme is bound to fit together.

use super::{UpwindError, UpwindInput};

/// Refuses arrays that do not have one entry a particle, and numbers of particles, components and
/// bodies that do not exist.
pub(super) fn check<const D: usize>(input: &UpwindInput<D>) -> Result<(), UpwindError> {
    let (particles, initial) = (&input.particles, &input.initial);
    let count = particles.len();
    for (what, length) in [
        ("the list of volumes", particles.volume.len()),
        ("the list of weights", particles.weight.len()),
        ("the list of spacings", particles.spacing.len()),
        ("the list of bodies", particles.body.len()),
        ("the list of ids", particles.id.len()),
        ("the neighbour list", input.support.list.len()),
        ("the initial velocity", initial.velocity.len()),
        ("the initial pressure", initial.pressure.len()),
    ] {
        if length != count {
            return Err(UpwindError::Length { what, expected: count, got: length });
        }
    }
    let bodies = input.materials.len();
    if let Some(&body) = particles.body.iter().find(|&&body| body as usize >= bodies) {
        return Err(index("the material of body", body as usize, bodies));
    }
    for traction in &input.tractions {
        let (expected, got) = (traction.particles.len(), traction.areas.len());
        if expected != got {
            return Err(UpwindError::Length { what: "the areas of a traction", expected, got });
        }
        selected(&traction.name, &traction.particles, count)?;
    }
    for condition in &input.prescribed {
        selected(&condition.name, &condition.particles, count)?;
        if condition.component >= D {
            let what = format!("`{}`: velocity component", condition.name);
            return Err(index(what, condition.component, D));
        }
    }
    Ok(())
}

fn selected(name: &str, particles: &[u32], count: usize) -> Result<(), UpwindError> {
    match particles.iter().find(|&&particle| particle as usize >= count) {
        Some(&particle) => Err(index(format!("`{name}`: particle"), particle as usize, count)),
        None => Ok(()),
    }
}

fn index(what: impl Into<String>, got: usize, count: usize) -> UpwindError {
    UpwindError::Index { what: what.into(), got, count }
}
