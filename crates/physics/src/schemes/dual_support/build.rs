//! From particles and settings to a scheme that is ready to run.

use std::sync::Arc;

use thiserror::Error;

use super::fields::Made;
use super::stable_step::stable_step;
use super::stages;
use super::{
    Discrete, DualSupport, FIGURES, Gradients, LEDGER, Material, Motion, Settings, Statics,
    StaticsError, StaticsInput,
};
use crate::boundaries::prescribed::PrescribedComponents;
use crate::boundaries::{
    BodyForce, FollowerPressure, PrescribedDisplacement, PrescribedVelocity, Traction,
};
use crate::fields::width;
use crate::geometry::Particles;
use crate::operators::{DirectedSupport, DualGradient, OperatorError, ReferenceGradient};
use crate::schemes::input::{
    check_conditions, check_lengths, check_materials, check_particle, check_particles,
    check_pressure,
};
use crate::schemes::solid::wave_moduli;
use crate::schemes::{InputError, StageFault};
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
    /// Pressures that follow the surface, which add up.
    pub pressures: Vec<FollowerPressure<D>>,
    /// Prescribed velocity components.
    pub prescribed: Vec<PrescribedVelocity>,
    /// How states follow each other.
    pub motion: Motion<D>,
}

/// Input that the formulation cannot work with.
#[derive(Clone, Debug, Error, PartialEq)]
#[non_exhaustive]
pub enum DualSupportError {
    /// Stages that do not fit together.
    #[error(transparent)]
    Stages(#[from] StageFault),
    /// A gradient does not exist.
    #[error(transparent)]
    Operator(#[from] OperatorError),
    /// Statics that cannot be done.
    #[error(transparent)]
    Statics(#[from] StaticsError),
    /// Parts that do not fit together.
    #[error(transparent)]
    Input(#[from] InputError),
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
        check_particles(&particles)?;
        check_materials(&particles, materials.len())?;
        let areas = match &settings.gradients {
            Gradients::PatchConsistent { areas } => areas.len(),
            Gradients::Plain => count,
        };
        let lists =
            [("the neighbour list", support.list.len()), ("the list of boundary areas", areas)];
        check_lengths(count, &lists)?;
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
        let operator = ReferenceGradient::new((&particles, &[]), &support, &gradient, hourglass);
        Ok(Self { particles, operator, materials })
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
        check_lengths(count, &[("the initial velocity", velocity.len())])?;
        check_conditions(count, &input.tractions, &input.prescribed)?;
        input.pressures.iter().try_for_each(|load| check_pressure(load, count))?;
        let discrete = Arc::new(Discrete::new(particles, support, &settings, materials)?);
        let particles = &discrete.particles;
        let mut mass = Vec::with_capacity(count);
        for (a, velocity) in velocity.iter().enumerate() {
            let own = discrete.mass(a);
            check_particle(particles, a, own, velocity)?;
            mass.push(own);
        }
        let positions = &particles.position;
        let at_rest = |material: &Material<D>| wave_moduli(&material.law, &Tensor::zeros());
        let is_static = matches!(input.motion, Motion::Static(_));
        let (stable_step, stiffest) = match is_static {
            true => (f64::INFINITY, 0),
            false => stable_step(&discrete, &mass),
        };
        let loads = StaticsInput {
            body_forces: input.body_forces.clone(),
            tractions: input.tractions.clone(),
            pressures: input.pressures.clone(),
            ..Default::default()
        };
        let statics = match input.motion {
            Motion::Explicit => None,
            Motion::Implicit(method, newton) => {
                let prescribed = input.prescribed.iter().map(held).collect();
                let known = StaticsInput { prescribed, method, newton, ..loads };
                Some(Statics::moving(discrete.clone(), known)?)
            }
            Motion::Static(statics) => {
                let StaticsInput { body_forces, tractions, pressures, .. } = loads;
                let known = StaticsInput { body_forces, tractions, pressures, ..*statics };
                Some(Statics::new(discrete.clone(), known)?)
            }
        };
        Ok(Self {
            stages: stages::plan()?,
            loaded: input.tractions.iter().flat_map(|load| load.loaded(positions)).collect(),
            pressed: input.pressures.iter().flat_map(|load| load.pressed(positions)).collect(),
            prescribed: PrescribedComponents::new(&input.prescribed, positions),
            moduli_at_rest: discrete.materials.iter().map(at_rest).collect(),
            not_convex: None,
            jumped: None,
            statics: statics.map(Box::new),
            is_static,
            stable_step,
            stiffest,
            body_forces: input.body_forces,
            initial_velocity: velocity,
            strained: discrete.operator.strained(),
            force: vec![Vector::zeros(); count],
            rate: vec![0.0; count * width(Made::FIELDS, D) + LEDGER.length(D) + FIGURES],
            reaction: Vec::new(),
            mass,
            discrete,
        })
    }
}

/// The components that a prescribed velocity holds; their displacements are found step by step.
fn held<const D: usize>(condition: &PrescribedVelocity) -> PrescribedDisplacement<D> {
    let PrescribedVelocity { name, particles, component, .. } = condition.clone();
    PrescribedDisplacement::component(name, particles, component, Arc::new(0.0))
}
