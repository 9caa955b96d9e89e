//! From particles and settings to a scheme that is ready to run.

use std::sync::Arc;

use thiserror::Error;

use super::external::Loaded;
use super::inspect::largest_wave_modulus;
use super::stable_step::stable_step;
use super::{
    Discrete, DualSupport, Gradients, Material, Row, Settings, Side, Statics, StaticsError,
    StaticsInput,
};
use crate::boundaries::prescribed::PrescribedComponents;
use crate::boundaries::{BodyForce, PrescribedVelocity, Traction, padded};
use crate::geometry::Particles;
use crate::operators::{DirectedSupport, DualGradient, OperatorError};
use crate::{Tensor, Vector};

/// All that the formulation is bound to.
pub struct DualSupportInput<const D: usize> {
    /// The particles, in the order in which they shall lie in memory.
    pub particles: Particles<D>,
    /// Kernel, support radii and neighbours of these particles.
    pub support: DirectedSupport<D>,
    /// Numerical settings.
    pub settings: Settings<D>,
    /// Materials by number of the body.
    pub materials: Vec<Material<D>>,
    /// Initial velocity of each particle in m/s.
    pub velocity: Vec<Vector<D>>,
    /// Body forces, which add up.
    pub body_forces: Vec<BodyForce<D>>,
    /// Dead tractions, which add up.
    pub tractions: Vec<Traction<D>>,
    /// Prescribed velocity components.
    pub prescribed: Vec<PrescribedVelocity>,
    /// In statics, what holds the body and how equilibrium is found; body forces and tractions are
    /// those above.
    pub statics: Option<StaticsInput<D>>,
}

/// Input that the formulation cannot work with.
#[derive(Clone, Debug, Error, PartialEq)]
#[non_exhaustive]
pub enum DualSupportError {
    /// A gradient does not exist.
    #[error(transparent)]
    Operator(#[from] OperatorError),
    /// Statics that cannot be done.
    #[error(transparent)]
    Statics(#[from] StaticsError),
    /// An array that does not have one entry for each particle.
    #[error("{what} has {got} entries, expected one for each of the {expected} particles")]
    Length {
        /// The array.
        what: &'static str,
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
        "particle {id} at {position:?} has a mass of {mass} kg; its volume and the density of its \
         material must be positive"
    )]
    Mass {
        /// Number of the particle in the order of creation.
        id: u32,
        /// Its reference position in m.
        position: Vec<f64>,
        /// Its mass in kg.
        mass: f64,
    },
    /// An initial velocity that is no number.
    #[error("the initial velocity of particle {id} at {position:?} is not finite")]
    Velocity {
        /// Number of the particle in the order of creation.
        id: u32,
        /// Its reference position in m.
        position: Vec<f64>,
    },
    /// A hourglass coefficient that takes stiffness away.
    #[error("the hourglass coefficient must be at least 0 and finite, got {value}")]
    Hourglass {
        /// What was given.
        value: f64,
    },
}

impl<const D: usize> Discrete<D> {
    /// Builds coefficients for particles on their supports.
    ///
    /// # Errors
    /// [`DualSupportError`] for arrays that do not fit together, particles without a gradient, and
    /// areas that do not fit.
    pub fn new(
        particles: Particles<D>,
        support: DirectedSupport<D>,
        settings: &Settings<D>,
        materials: Vec<Material<D>>,
    ) -> Result<Self, DualSupportError> {
        let count = particles.len();
        check_lengths(&particles, &support, settings)?;
        let bodies = materials.len();
        if let Some(&body) = particles.body.iter().find(|&&body| body as usize >= bodies) {
            return Err(index("the material of body", body as usize, bodies));
        }
        if !(settings.hourglass >= 0.0 && settings.hourglass.is_finite()) {
            return Err(DualSupportError::Hourglass { value: settings.hourglass });
        }
        let mut gradient = DualGradient::plain(&particles, &support)?;
        if let Gradients::PatchConsistent { areas } = &settings.gradients {
            gradient = gradient.patch_consistent(&particles, &support, areas)?;
        }
        let hourglass = |a: usize| {
            let shear = materials[particles.body[a] as usize].law.law().small_strain().mu;
            settings.hourglass * shear * particles.volume[a]
        };
        let hourglass = (0..count).map(hourglass).collect();
        Ok(Self { particles, support, gradient, materials, hourglass })
    }
}

impl<const D: usize> DualSupport<D> {
    /// Builds operators and scratch; nothing is allocated afterwards.
    ///
    /// # Errors
    /// As [`Discrete::new`], and for particles without mass, impossible initial values, and loads
    /// on what does not exist.
    pub fn new(input: DualSupportInput<D>) -> Result<Self, DualSupportError> {
        let DualSupportInput { particles, support, settings, materials, velocity, .. } = input;
        let count = particles.len();
        if velocity.len() != count {
            let what = "the initial velocity";
            return Err(DualSupportError::Length { what, expected: count, got: velocity.len() });
        }
        check_conditions(count, D, &input.tractions, &input.prescribed)?;
        let discrete = Arc::new(Discrete::new(particles, support, &settings, materials)?);
        let particles = &discrete.particles;
        let mut mass = Vec::with_capacity(count);
        for (a, velocity) in velocity.iter().enumerate() {
            let (id, position) = (particles.id[a], || particles.position[a].as_slice().to_vec());
            let own = discrete.material(a).density * particles.volume[a];
            if !(own > 0.0 && own.is_finite()) {
                return Err(DualSupportError::Mass { id, position: position(), mass: own });
            }
            if velocity.iter().any(|v| !v.is_finite()) {
                return Err(DualSupportError::Velocity { id, position: position() });
            }
            mass.push(own);
        }
        let positions = &particles.position;
        let loaded = input.tractions.iter().flat_map(|traction| {
            traction.particles.iter().zip(&traction.areas).map(|(&particle, &area)| Loaded {
                particle: particle as usize,
                area,
                place: padded(&positions[particle as usize]),
                value: traction.value.clone(),
            })
        });
        let at_rest =
            |material: &Material<D>| largest_wave_modulus(&material.law, &Tensor::zeros());
        let (stable_step, stiffest) = match &input.statics {
            Some(_) => (f64::INFINITY, 0),
            None => stable_step(&discrete, &mass),
        };
        let statics = input.statics.map(|statics| {
            let (body_forces, tractions) = (input.body_forces.clone(), input.tractions.clone());
            Statics::new(discrete.clone(), StaticsInput { body_forces, tractions, ..statics })
        });
        Ok(Self {
            loaded: loaded.collect(),
            prescribed: PrescribedComponents::new(&input.prescribed, positions),
            modulus_at_rest: discrete.materials.iter().map(at_rest).collect(),
            statics: statics.transpose()?.map(Box::new),
            stable_step,
            stiffest,
            body_forces: input.body_forces,
            initial_velocity: velocity,
            displacement: vec![Vector::zeros(); count],
            sides: vec![Side::zero(); count],
            force: vec![Vector::zeros(); count],
            rate: vec![0.0; count * Row::<D>::LENGTH + Self::tail_length()],
            mass,
            discrete,
        })
    }
}

fn check_lengths<const D: usize>(
    particles: &Particles<D>,
    support: &DirectedSupport<D>,
    settings: &Settings<D>,
) -> Result<(), DualSupportError> {
    let expected = particles.len();
    let areas = match &settings.gradients {
        Gradients::PatchConsistent { areas } => areas.len(),
        Gradients::Plain => expected,
    };
    for (what, got) in [
        ("the list of volumes", particles.volume.len()),
        ("the list of weights", particles.weight.len()),
        ("the list of bodies", particles.body.len()),
        ("the list of ids", particles.id.len()),
        ("the neighbour list", support.list.len()),
        ("the list of boundary areas", areas),
    ] {
        if got != expected {
            return Err(DualSupportError::Length { what, expected, got });
        }
    }
    Ok(())
}

fn check_conditions<const D: usize>(
    count: usize,
    dimension: usize,
    tractions: &[Traction<D>],
    prescribed: &[PrescribedVelocity],
) -> Result<(), DualSupportError> {
    let selected = |name: &str, particles: &[u32]| {
        let missing = particles.iter().find(|&&particle| particle as usize >= count);
        missing.map_or(Ok(()), |&particle| {
            Err(index(format!("`{name}`: particle"), particle as usize, count))
        })
    };
    for traction in tractions {
        let (expected, got) = (traction.particles.len(), traction.areas.len());
        if expected != got {
            return Err(DualSupportError::Length {
                what: "the areas of a traction",
                expected,
                got,
            });
        }
        selected(&traction.name, &traction.particles)?;
    }
    for condition in prescribed {
        selected(&condition.name, &condition.particles)?;
        if condition.component >= dimension {
            let what = format!("`{}`: velocity component", condition.name);
            return Err(index(what, condition.component, dimension));
        }
    }
    Ok(())
}

fn index(what: impl Into<String>, got: usize, count: usize) -> DualSupportError {
    DualSupportError::Index { what: what.into(), got, count }
}
