//! What can be wrong with loads and supports, and why there is no equilibrium.

use thiserror::Error;

use super::Statics;
use crate::coordinates;
use crate::schemes::InputError;
use crate::solve::{LinearError, LoadError, NewtonError};

/// Statics that cannot be done.
#[derive(Clone, Debug, Error, PartialEq)]
#[non_exhaustive]
pub enum StaticsError {
    /// Parts that do not fit together.
    #[error(transparent)]
    Input(#[from] InputError),
    /// A direction without length, or a component that does not exist.
    #[error("`{name}` prescribes a component or direction that does not exist")]
    Direction {
        /// Name of the condition.
        name: String,
    },
    /// Directions of one particle that depend on each other.
    #[error(
        "particle {id} at {at} is held in linearly dependent directions; remove \
         `{name}` there",
        at = coordinates(position)
    )]
    Overconstrained {
        /// Number of the particle in the order of creation.
        id: u32,
        /// Its reference position in m.
        position: Vec<f64>,
        /// The condition that is too many.
        name: String,
    },
    /// A tie of a component that is not free.
    #[error(
        "`{name}` ties component {} of particle {id} at {at}, which is tied already, \
         prescribed, or on an inclined roller: leave the particle out of one of them",
        ["x", "y", "z"][*component],
        at = coordinates(position)
    )]
    Tie {
        /// Name of the tie.
        name: String,
        /// Number of the particle in the order of creation.
        id: u32,
        /// Its reference position in m.
        position: Vec<f64>,
        /// The component, below 3.
        component: usize,
    },
    /// A body that can move as a whole.
    #[error("{}", free_to_move(&format!("body {body}"), part.as_ref(), motion))]
    Free {
        /// Number of the body.
        body: u32,
        /// A particle of the part of it that is free, where that does not hang together with the
        /// rest: its number in the order of creation and its reference position in m.
        part: Option<(u32, Vec<f64>)>,
        /// The motion, for example `turn about z`.
        motion: String,
    },
    /// The linear solver cannot be set up.
    #[error(transparent)]
    Linear(#[from] LinearError),
    /// A particle is turned inside out at a load.
    #[error(
        "particle {id} at {at} is inverted at a load factor of {factor}; an \
         equilibrium was found up to {reached}: take smaller load steps, or a law that resists \
         compression",
        at = coordinates(position)
    )]
    Inverted {
        /// Number of the particle in the order of creation.
        id: u32,
        /// Its reference position in m.
        position: Vec<f64>,
        /// The load factor.
        factor: f64,
        /// The last one with an equilibrium.
        reached: f64,
    },
    /// Newton's method has not arrived.
    #[error(
        "{source}; the largest residual force, {force:.1e} N, is at particle {id} at {at}",
        at = coordinates(position)
    )]
    Residual {
        /// Number of the particle in the order of creation.
        id: u32,
        /// Its reference position in m.
        position: Vec<f64>,
        /// The force in N.
        force: f64,
        /// How it failed.
        source: LoadError,
    },
    /// An implicit step of a body in motion without an end.
    #[error(
        "no state was found at t = {time:.6} s, after {reached:.6} s: {source}; the largest \
         residual force, {force:.1e} N, is at particle {id} at {at}",
        at = coordinates(position)
    )]
    Step {
        /// Number of the particle in the order of creation.
        id: u32,
        /// Its reference position in m.
        position: Vec<f64>,
        /// End of the step in s.
        time: f64,
        /// Its start.
        reached: f64,
        /// The force in N.
        force: f64,
        /// How it failed.
        source: NewtonError,
    },
    /// A particle is turned inside out in an implicit step of a body in motion.
    #[error(
        "particle {id} at {at} is inverted at t = {time:.6} s; a state was found up \
         to {reached:.6} s: take smaller steps, or a law that resists compression",
        at = coordinates(position)
    )]
    Collapsed {
        /// Number of the particle in the order of creation.
        id: u32,
        /// Its reference position in m.
        position: Vec<f64>,
        /// End of the step in s.
        time: f64,
        /// Its start.
        reached: f64,
    },
    /// There is no further equilibrium.
    #[error(transparent)]
    Load(LoadError),
}

impl<const D: usize> Statics<D> {
    /// An error of the load steps with the particle that it is about.
    pub(super) fn named(&self, error: LoadError) -> StaticsError {
        match error {
            LoadError::Newton { factor, reached, source: NewtonError::Broken { particle, .. } } => {
                let particles = &self.discrete.solid.particles;
                StaticsError::Inverted {
                    id: particles.id[particle],
                    position: particles.position[particle].iter().copied().collect(),
                    factor,
                    reached,
                }
            }
            error => StaticsError::Load(error),
        }
    }
}

/// That a body can move as a whole, with the name of it.
pub fn free_to_move(body: &str, part: Option<&(u32, Vec<f64>)>, motion: &str) -> String {
    let part = part.map(|(id, position)| {
        let at = coordinates(position);
        format!("nothing connects particle {id} at {at} with the rest: this part of ")
    });
    format!(
        "{}{body} is free to {motion}: prescribe displacements that hold it",
        part.unwrap_or_default()
    )
}
