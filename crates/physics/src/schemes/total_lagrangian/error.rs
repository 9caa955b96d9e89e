//! Why there is no such body.

use std::fmt;

use thiserror::Error;

use super::StaticsError;
use crate::coordinates;
use crate::operators::OperatorError;
use crate::schemes::{InputError, StageFault};

/// Input that the formulation cannot work with.
#[derive(Clone, Debug, Error, PartialEq)]
#[non_exhaustive]
pub enum TotalLagrangianError {
    /// Stages that do not fit together.
    #[error(transparent)]
    Stages(#[from] StageFault),
    /// A matrix does not exist.
    #[error(transparent)]
    Operator(#[from] OperatorError),
    /// Parts that do not fit together.
    #[error(transparent)]
    Input(#[from] InputError),
    /// Statics that cannot be done.
    #[error(transparent)]
    Statics(#[from] StaticsError),
    /// Parts of which one does not serve the other.
    #[error("{part} cannot be combined with {with}: {why}")]
    Combination {
        /// The part that is asked for.
        part: Part,
        /// What it is asked for with.
        with: &'static str,
        /// Why not, and what to do.
        why: &'static str,
    },
    /// The strong form elsewhere than in one row or box of particles.
    #[error(
        "the strong form is for one row or box of particles in one or two dimensions: there are \
         {dimension} dimensions and {bodies} separate bodies; use `form = \"adjoint\"`"
    )]
    Strong {
        /// Dimensions of space.
        dimension: usize,
        /// Groups of particles.
        bodies: usize,
    },
    /// An edge in the strong form of which only a part is held.
    #[error(
        "the velocity along axis {component} is prescribed on a part of an edge only, and not of particle \
         {id} at {at}: in the strong form a component is held on all of an edge or nowhere on \
         it; use `form = \"adjoint\"`",
        at = coordinates(position)
    )]
    PartOfEdge {
        /// The component, from 0.
        component: usize,
        /// Number of the particle in the order of creation.
        id: u32,
        /// Its reference position in m.
        position: Vec<f64>,
    },
    /// A traction in the strong form that belongs to no edge.
    #[error(
        "the load `{name}` does not lie on one edge: in the strong form a traction acts on an edge of the \
         box; use `form = \"adjoint\"`"
    )]
    NoEdge {
        /// Name of the load.
        name: String,
    },
    /// A hole in the strong form around which there are too few particles.
    #[error(
        "the hole of {radius} m around {at} is too small for the particles around it, or has a site \
         of the lattice in its centre; make the spacing smaller, or use `form = \"adjoint\"`",
        at = coordinates(center)
    )]
    Hole {
        /// Its centre in m.
        center: Vec<f64>,
        /// Its radius in m.
        radius: f64,
    },
    /// Matrices of the moment in the adjoint form, or in two dimensions.
    #[error(
        "`configuration = \"updated\"` is for the strong form, in one dimension, to show the tensile \
         instability; use `configuration = \"total\"`"
    )]
    Updated,
    /// A plane or an end across an axis along which the box repeats itself.
    #[error(
        "the body is periodic along {axis}, so that it cannot end on a plane across it; remove \
         the plane, or the periodic axis"
    )]
    Periodic {
        /// The axis.
        axis: &'static str,
    },
    /// Two planes that mirror at one end of an axis.
    #[error(
        "two mirrors lie across {axis} at the same end of it: one serves all bodies; remove \
         `mirror` from one of them"
    )]
    TwoPlanes {
        /// The axis.
        axis: &'static str,
    },
    /// A mirror that does not end the bodies, or that is not one plane as it moves.
    #[error(
        "particle {id} at {at} {what}, the mirror across {axis}: all bodies end on it, \
         and particles on it move across it together; move the plane, hold all of it by one \
         condition, or remove `mirror`",
        at = coordinates(position)
    )]
    Plane {
        /// The axis that it lies across.
        axis: &'static str,
        /// What the particle does.
        what: &'static str,
        /// Number of the particle in the order of creation.
        id: u32,
        /// Its reference position in m.
        position: Vec<f64>,
    },
    /// A rigid body of which no motion is known.
    #[error("the rigid body `{name}` {fault}")]
    Rigid {
        /// Its name.
        name: String,
        /// What is wrong with it, and what to do.
        fault: &'static str,
    },
    /// A coefficient that is negative or no number.
    #[error("{what} must be at least 0 and finite, got {value}")]
    Coefficient {
        /// Which.
        what: &'static str,
        /// What was given.
        value: f64,
    },
}

/// A part that does not go with every other.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Part {
    /// States that are solved for.
    Implicit,
    /// Gradients that are made consistent.
    PatchConsistent,
    /// Images beyond planes.
    Mirrors,
    /// Pressures that follow a surface.
    Pressures,
    /// Initial displacements and velocities.
    Initial,
    /// Viscosity and damping.
    Dissipation,
    /// Bodies that are rigid.
    Rigid,
    /// Springs to points.
    Springs,
}

impl fmt::Display for Part {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Implicit => "implicit steps and statics",
            Self::PatchConsistent => "patch-consistent gradients",
            Self::Mirrors => "mirror images",
            Self::Pressures => "a follower pressure",
            Self::Initial => "initial values",
            Self::Dissipation => "viscosity and damping",
            Self::Rigid => "a rigid body",
            Self::Springs => "a spring",
        })
    }
}
