//! Whether the parts that a scheme is bound to fit together.

use thiserror::Error;

use crate::Vector;
use crate::boundaries::{FollowerPressure, PrescribedVelocity, Traction};
use crate::coordinates;
use crate::geometry::Particles;

/// Parts that do not fit together, or values that no particle can have.
#[derive(Clone, Debug, Error, PartialEq)]
#[non_exhaustive]
pub enum InputError {
    /// An array that does not have one entry for each particle.
    #[error("{what} has {got} entries, expected one for each of the {expected} particles")]
    Length {
        /// The array.
        what: String,
        /// Number of particles.
        expected: usize,
        /// Its length.
        got: usize,
    },
    /// The number of a particle, of a component or of a body that does not exist.
    #[error("{what} {got} does not exist, expected a number below {count}")]
    Index {
        /// What is numbered, and where.
        what: String,
        /// The number.
        got: usize,
        /// How many there are.
        count: usize,
    },
    /// A particle without mass.
    #[error(
        "particle {id} at {at} has a mass of {mass} kg; its volume and the density of its \
         material must be positive",
        at = coordinates(position)
    )]
    Mass {
        /// Number of the particle in the order of creation.
        id: u32,
        /// Its reference position in m.
        position: Vec<f64>,
        /// Its mass in kg.
        mass: f64,
    },
    /// An initial displacement that is no number.
    #[error(
        "the initial displacement of particle {id} at {at} is not finite",
        at = coordinates(position)
    )]
    Displacement {
        /// Number of the particle in the order of creation.
        id: u32,
        /// Its reference position in m.
        position: Vec<f64>,
    },
    /// An initial velocity that is no number.
    #[error(
        "the initial velocity of particle {id} at {at} is not finite",
        at = coordinates(position)
    )]
    Velocity {
        /// Number of the particle in the order of creation.
        id: u32,
        /// Its reference position in m.
        position: Vec<f64>,
    },
}

/// Refuses arrays that are not as long as there are particles.
pub(crate) fn check_lengths(
    expected: usize,
    arrays: &[(&'static str, usize)],
) -> Result<(), InputError> {
    let other = arrays.iter().find(|(_, got)| *got != expected);
    other.map_or(Ok(()), |&(what, got)| {
        Err(InputError::Length { what: what.to_owned(), expected, got })
    })
}

/// Refuses particles whose own arrays do not fit together.
pub(crate) fn check_particles<const D: usize>(particles: &Particles<D>) -> Result<(), InputError> {
    check_lengths(
        particles.len(),
        &[
            ("the list of volumes", particles.volume.len()),
            ("the list of weights", particles.weight.len()),
            ("the list of spacings", particles.spacing.len()),
            ("the list of bodies", particles.body.len()),
            ("the list of ids", particles.id.len()),
        ],
    )
}

/// Refuses bodies without one of `materials`.
pub(crate) fn check_materials<const D: usize>(
    particles: &Particles<D>,
    materials: usize,
) -> Result<(), InputError> {
    let what = || "the material of body".to_owned();
    particles.body.iter().try_for_each(|&body| check_index(what, body as usize, materials))
}

/// Refuses a number that is not below `count`.
pub(crate) fn check_index(
    what: impl Fn() -> String,
    got: usize,
    count: usize,
) -> Result<(), InputError> {
    if got < count { Ok(()) } else { Err(InputError::Index { what: what(), got, count }) }
}

/// Refuses particles that do not exist, in what is called `name`.
pub(crate) fn check_selected(
    name: &str,
    particles: &[u32],
    count: usize,
) -> Result<(), InputError> {
    let what = || format!("`{name}`: particle");
    particles.iter().try_for_each(|&particle| check_index(what, particle as usize, count))
}

/// Refuses a traction on what does not exist among `count` particles.
pub(crate) fn check_traction<const D: usize>(
    load: &Traction<D>,
    count: usize,
) -> Result<(), InputError> {
    check_load(&load.name, &load.particles, load.areas.len(), load.places.len(), count)
}

/// Refuses a pressure on what does not exist among `count` particles.
pub(crate) fn check_pressure<const D: usize>(
    load: &FollowerPressure<D>,
    count: usize,
) -> Result<(), InputError> {
    check_load(&load.name, &load.particles, load.areas.len(), load.places.len(), count)
}

/// Refuses a load called `name` on particles that do not exist, without one area for each, or with
/// places that are not one for each.
fn check_load(
    name: &str,
    particles: &[u32],
    areas: usize,
    places: usize,
    count: usize,
) -> Result<(), InputError> {
    let list = |what: &str| format!("the list of {what} of `{name}`");
    let expected = particles.len();
    if areas != expected {
        return Err(InputError::Length { what: list("areas"), expected, got: areas });
    }
    if !(places == 0 || places == expected) {
        return Err(InputError::Length { what: list("places"), expected, got: places });
    }
    check_selected(name, particles, count)
}

/// Refuses loads and prescribed components of what does not exist among `count` particles.
pub(crate) fn check_conditions<const D: usize>(
    count: usize,
    tractions: &[Traction<D>],
    prescribed: &[PrescribedVelocity],
) -> Result<(), InputError> {
    tractions.iter().try_for_each(|load| check_traction(load, count))?;
    for condition in prescribed {
        check_selected(&condition.name, &condition.particles, count)?;
        let what = || format!("`{}`: velocity component", condition.name);
        check_index(what, condition.component, D)?;
    }
    Ok(())
}

/// Refuses an initial displacement that is no number.
pub(crate) fn check_displacement<const D: usize>(
    particles: &Particles<D>,
    a: usize,
    displacement: &Vector<D>,
) -> Result<(), InputError> {
    let position = || particles.position[a].as_slice().to_vec();
    match displacement.iter().all(|u| u.is_finite()) {
        true => Ok(()),
        false => Err(InputError::Displacement { id: particles.id[a], position: position() }),
    }
}

/// Refuses a particle whose mass in kg is not positive, or whose initial velocity is no number.
pub(crate) fn check_particle<const D: usize>(
    particles: &Particles<D>,
    a: usize,
    mass: f64,
    velocity: &Vector<D>,
) -> Result<(), InputError> {
    let (id, position) = (particles.id[a], || particles.position[a].as_slice().to_vec());
    if velocity.iter().any(|v| !v.is_finite()) {
        return Err(InputError::Velocity { id, position: position() });
    }
    if !(mass > 0.0 && mass.is_finite()) {
        return Err(InputError::Mass { id, position: position(), mass });
    }
    Ok(())
}
