//! What acts on bodies: loads and boundaries.

use std::sync::Arc;

use super::Region;
use crate::boundaries::{History, WaveMaker};
use crate::case::expression::Expression;
use crate::case::source::Located;

/// A force on particles.
#[derive(Clone, Debug)]
pub struct Load {
    /// Name for overrides and messages.
    pub name: Option<Located<String>>,
    /// Number of the body that it acts on, `None` for all.
    pub body: Option<Located<usize>>,
    /// Factor over time of all its expressions.
    pub history: Option<Arc<History>>,
    /// What acts.
    pub kind: LoadKind,
}

/// The kinds of load.
#[derive(Clone, Debug)]
pub enum LoadKind {
    /// Acceleration in m/s^2, as expressions of the reference position and time.
    BodyForce {
        /// One expression per component.
        acceleration: Vec<Expression>,
    },
    /// Force per reference area in Pa that keeps its direction, on a part of a body's surface.
    Traction {
        /// The particles that carry it.
        region: Located<Region>,
        /// One expression of the reference position and time per component.
        traction: Vec<Expression>,
    },
    /// A spring with a damper to a point.
    Spring {
        /// The particles that it is tied to.
        region: Located<Region>,
        /// The point in m.
        to: Vec<f64>,
        /// N/m.
        stiffness: f64,
        /// N s/m.
        damping: f64,
        /// Its unstretched length in m; `None` for its initial length.
        length: Option<f64>,
    },
    /// Pressure that follows a part of a body's surface.
    Pressure {
        /// The particles or faces that it acts on.
        region: Located<Region>,
        /// Pa, of the reference position and time.
        pressure: Expression,
    },
}

impl LoadKind {
    /// The expressions of the load: one per component, or a single one.
    pub fn components(&self) -> &[Expression] {
        match self {
            Self::BodyForce { acceleration } => acceleration,
            Self::Traction { traction, .. } => traction,
            Self::Pressure { pressure, .. } => std::slice::from_ref(pressure),
            Self::Spring { .. } => &[],
        }
    }
}

/// Prescribed velocities or displacements on a selection of particles.
#[derive(Clone, Debug)]
pub struct Boundary {
    /// Unique name.
    pub name: Located<String>,
    /// Number of the body, `None` for all.
    pub body: Option<Located<usize>>,
    /// The particles.
    pub region: Located<Region>,
    /// Factor over time of all its expressions.
    pub history: Option<Arc<History>>,
    /// Per component, the velocity in m/s as an expression of the reference position and time, or
    /// `None` where the particle is free.
    pub velocity: Vec<Option<Expression>>,
    /// The waves that it makes, with the unit vector along which it pushes.
    pub wave_maker: Option<Located<(Arc<WaveMaker>, Vec<f64>)>>,
    /// What is prescribed of the rotation of a rigid body.
    pub turning: Option<Located<Turning>>,
    /// Whether the body is continued by mirror images beyond the plane of the region.
    pub mirror: Option<Located<bool>>,
    /// In statics, per component, the displacement in m as an expression of the reference position
    /// and the load factor, or `None` where the particle is free.
    pub displacement: Vec<Option<Expression>>,
    /// In statics, a plane that the particles can only move along.
    pub roller: Option<Roller>,
    /// In statics, the components, from 0, that all particles have in common.
    pub tied: Vec<Located<usize>>,
}

impl Boundary {
    /// Whether it prescribes how particles move.
    pub fn moves(&self) -> bool {
        self.wave_maker.is_some() || self.velocity.iter().any(Option::is_some)
    }
}

/// What is prescribed of the rotation of a rigid body, and the point that its velocity refers to.
#[derive(Clone, Debug, Default)]
pub struct Turning {
    /// The point that velocities refer to, in m; `None` for the centre of mass.
    pub pivot: Option<Vec<f64>>,
    /// Per axis in space, the angular velocity in rad/s as an expression of time, or `None` where the
    /// body is free.
    pub angular_velocity: [Option<Expression>; 3],
}

/// A roller on a plane of any inclination.
#[derive(Clone, Debug)]
pub struct Roller {
    /// The unit normal of the plane.
    pub normal: Vec<f64>,
    /// Displacement along it in m, as an expression of the reference position and the load factor.
    pub displacement: Expression,
}
