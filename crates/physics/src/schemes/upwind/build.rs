//! From particles and settings to a scheme that is ready to run.

use piola_formulas::pairs::Record;
use piola_formulas::pairs::upwind::{UpwindSide, UpwindSlope};
use piola_formulas::volumetric::{Prestressed, VolumetricResponse};
use thiserror::Error;

use super::implicit::{Implicit, ImplicitSettings};
use super::{Initial, Material, Reference, Settings, Upwind};
use crate::Vector;
use crate::boundaries::prescribed::PrescribedComponents;
use crate::boundaries::{BodyForce, PrescribedVelocity, Traction};
use crate::coordinates;
use crate::geometry::Particles;
use crate::operators::{GradientOperator, LeastSquares, OperatorError, PairAreas, Support};
use crate::parallel::{self, Team};
use crate::schemes::InputError;
use crate::schemes::input::{
    check_conditions, check_lengths, check_materials, check_particle, check_particles,
};
use crate::schemes::stages::{StageFault, Stages};
use crate::solve::LinearError;

/// All that the formulation is bound to.
pub struct UpwindInput<const D: usize> {
    /// The particles, in the order in which they shall lie in memory.
    pub particles: Particles<D>,
    /// Kernel, smoothing lengths and neighbours of these particles.
    pub support: Support<D>,
    /// Numerical settings.
    pub settings: Settings,
    /// Materials by number of the body.
    pub materials: Vec<Material>,
    /// Initial velocity and pressure.
    pub initial: Initial<D>,
    /// Body forces, which add up.
    pub body_forces: Vec<BodyForce<D>>,
    /// Tractions, which add up.
    pub tractions: Vec<Traction<D>>,
    /// Prescribed velocity components.
    pub prescribed: Vec<PrescribedVelocity>,
    /// How the equations of implicit steps are solved, if such steps are to be taken.
    pub implicit: Option<ImplicitSettings>,
}

/// Input that the formulation cannot work with.
#[derive(Clone, Debug, Error, PartialEq)]
#[non_exhaustive]
pub enum UpwindError {
    /// Stages that do not fit together.
    #[error(transparent)]
    Stages(#[from] StageFault),
    /// A gradient does not exist.
    #[error(transparent)]
    Operator(#[from] OperatorError),
    /// No volume ratio of the material has the prestress asked for.
    #[error(
        "the initial pressure {pressure} Pa of particle {id} at {at} is beyond what its \
         material can carry; change `initial.pressure` or the bulk modulus",
        at = coordinates(position)
    )]
    Prestress {
        /// Number of the particle in the order of creation.
        id: u32,
        /// Its reference position in m.
        position: Vec<f64>,
        /// The pressure in Pa.
        pressure: f64,
    },
    /// The equations of implicit steps do not fit into memory.
    #[error(transparent)]
    Linear(#[from] LinearError),
    /// Parts that do not fit together.
    #[error(transparent)]
    Input(#[from] InputError),
}

impl<const D: usize> Upwind<D> {
    /// Builds operators and scratch; nothing is allocated afterwards.
    ///
    /// # Errors
    /// [`UpwindError`] for arrays that do not fit together, particles without mass or gradient,
    /// and impossible initial values.
    #[inline(never)]
    pub fn new(input: UpwindInput<D>) -> Result<Self, UpwindError> {
        check_particles(&input.particles)?;
        check_materials(&input.particles, input.materials.len())?;
        let count = input.particles.len();
        check_lengths(
            count,
            &[
                ("the neighbour list", input.support.list.len()),
                ("the initial velocity", input.initial.velocity.len()),
                ("the initial pressure", input.initial.pressure.len()),
            ],
        )?;
        check_conditions(count, &input.tractions, &input.prescribed)?;
        let UpwindInput { particles, support, settings, materials, initial, .. } = input;
        let nearest = nearest(&particles, &support)?;
        let gradient = GradientOperator::new(&particles, &support, settings.correction)?;
        let least_squares = match settings.reconstruction {
            true => Some(LeastSquares::new(&particles, &support)?),
            false => None,
        };
        let reference = references(&particles, &materials, &initial)?;
        let positions = &particles.position;
        let mut scheme = Self {
            nearest,
            areas: PairAreas::new(&gradient, &support.list, &particles.volume),
            largest_exchange: largest_exchange(&particles, &support, &gradient),
            fastest_reference: reference.iter().map(|r| r.wave_speed).fold(0.0, f64::max),
            prescribed: PrescribedComponents::new(&input.prescribed, positions),
            is_driven: !input.tractions.is_empty() || !input.prescribed.is_empty(),
            team: Team::default(),
            steady_body_force: input.body_forces.iter().all(BodyForce::is_steady),
            body_acceleration: vec![Vector::zeros(); count],
            loaded: input.tractions.iter().flat_map(|load| load.loaded(positions)).collect(),
            sides: vec![UpwindSide::zero(); count],
            slopes: vec![UpwindSlope::zero(); if settings.reconstruction { count } else { 0 }],
            observed: Vec::new(),
            body_forces: input.body_forces,
            initial_velocity: initial.velocity,
            particles,
            support,
            least_squares,
            settings,
            materials,
            reference,
            stages: Stages::default(),
            implicit: None,
        };
        scheme.plan()?;
        scheme.update_body_acceleration(0.0);
        if let Some(settings) = input.implicit {
            scheme.implicit = Some(Box::new(Implicit::new(&scheme, settings)?));
        }
        Ok(scheme)
    }

    /// Sums the body forces at every particle.
    pub(super) fn update_body_acceleration(&mut self, time: f64) {
        let (forces, particles) = (&self.body_forces, &self.particles);
        parallel::for_each_chunk(&mut self.body_acceleration, |first, rows| {
            for (offset, acceleration) in rows.iter_mut().enumerate() {
                let (body, x) =
                    (particles.body[first + offset], &particles.position[first + offset]);
                *acceleration = BodyForce::sum(forces, body, x, time);
            }
        });
    }
}

fn references<const D: usize>(
    particles: &Particles<D>,
    materials: &[Material],
    initial: &Initial<D>,
) -> Result<Vec<Reference>, UpwindError> {
    (0..particles.len())
        .map(|a| {
            let Material { density, law } = materials[particles.body[a] as usize];
            let pressure = initial.pressure[a];
            let ratio = law.volume_ratio_at_pressure(pressure).ok_or_else(|| {
                let position = particles.position[a].as_slice().to_vec();
                UpwindError::Prestress { id: particles.id[a], position, pressure }
            })?;
            let density = density / ratio;
            check_particle(particles, a, density * particles.volume[a], &initial.velocity[a])?;
            let prestressed = Prestressed { law, reference_ratio: ratio };
            Ok(Reference { density, ratio, wave_speed: prestressed.wave_speed(1.0, density) })
        })
        .collect()
}

/// Distance from each particle to its nearest neighbour, at most its spacing.
fn nearest<const D: usize>(
    particles: &Particles<D>,
    support: &Support<D>,
) -> Result<Vec<f64>, OperatorError> {
    (0..particles.len())
        .map(|a| {
            let mut nearest = particles.spacing[a];
            for &b in support.list.row(a) {
                let distance = support.separation(&particles.position, a, b).norm();
                if !(distance > 0.0) {
                    return Err(OperatorError::Coincident {
                        first: particles.id[a],
                        second: particles.id[b as usize],
                        position: particles.position[a].iter().copied().collect(),
                    });
                }
                nearest = nearest.min(distance);
            }
            Ok(nearest)
        })
        .collect()
}

/// Largest `1/V_a sum_b 1/2 |N . C_ab|`: how fast a unit wave speed exchanges a particle's
/// momentum through the velocity dissipation.
fn largest_exchange<const D: usize>(
    particles: &Particles<D>,
    support: &Support<D>,
    gradient: &GradientOperator<D>,
) -> f64 {
    let exchange = |a: usize| {
        let entries = support.list.range(a);
        let (forward, adjoint) =
            (gradient.forward(entries.clone()), gradient.adjoint(entries.clone()));
        let sum: f64 = support
            .list
            .row(a)
            .iter()
            .zip(forward.iter().zip(adjoint))
            .map(|(&b, (g, transposed))| {
                let direction = support.separation(&particles.position, a, b).normalize();
                let area = Vector::from(*g) * particles.volume[a]
                    - Vector::from(*transposed) * particles.volume[b as usize];
                0.5 * direction.dot(&area).abs()
            })
            .sum();
        sum / particles.volume[a]
    };
    (0..particles.len()).map(exchange).fold(0.0, f64::max)
}
