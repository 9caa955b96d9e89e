//! From particles and settings to a scheme that is ready to run.

use piola_formulas::volumetric::{Prestressed, VolumetricResponse};
use thiserror::Error;

use super::check::check;
use super::inspect::ChunkFigures;
use super::local::Side;
use super::reconstruction::Slope;
use super::{Initial, Loaded, Material, Powers, Reference, Settings, Upwind};
use crate::boundaries::prescribed::PrescribedComponents;
use crate::boundaries::{BodyForce, PrescribedVelocity, Traction, padded};
use crate::geometry::Particles;
use crate::operators::{GradientOperator, LeastSquares, OperatorError, PairAreas, Support};
use crate::{Vector, parallel};

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
}

/// Input that the formulation cannot work with.
#[derive(Clone, Debug, Error, PartialEq)]
#[non_exhaustive]
pub enum UpwindError {
    /// A gradient does not exist.
    #[error(transparent)]
    Operator(#[from] OperatorError),
    /// No volume ratio of the material has the prestress asked for.
    #[error(
        "the initial pressure {pressure} Pa of particle {id} at {position:?} is beyond what its \
         material can carry; change `initial.pressure` or the bulk modulus"
    )]
    Prestress {
        /// Number of the particle in the order of creation.
        id: u32,
        /// Its reference position in m.
        position: Vec<f64>,
        /// The pressure in Pa.
        pressure: f64,
    },
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
}

impl<const D: usize> Upwind<D> {
    /// Builds operators and scratch; nothing is allocated afterwards.
    ///
    /// # Errors
    /// [`UpwindError`] for arrays that do not fit together, particles without mass or gradient,
    /// and impossible initial values.
    pub fn new(input: UpwindInput<D>) -> Result<Self, UpwindError> {
        check(&input)?;
        let UpwindInput { particles, support, settings, materials, initial, .. } = input;
        let nearest = nearest(&particles, &support)?;
        let gradient = GradientOperator::new(&particles, &support, settings.correction)?;
        let least_squares = match settings.reconstruction {
            true => Some(LeastSquares::new(&particles, &support)?),
            false => None,
        };
        let reference = references(&particles, &materials, &initial)?;
        let count = particles.len();
        let chunks = count.div_ceil(parallel::CHUNK);
        let positions = &particles.position;
        let loaded = input.tractions.iter().flat_map(|traction| {
            traction.particles.iter().zip(&traction.areas).map(|(&particle, &area)| Loaded {
                particle: particle as usize,
                area,
                place: padded(&positions[particle as usize]),
                value: traction.value.clone(),
            })
        });
        let mut scheme = Self {
            nearest,
            areas: PairAreas::new(&gradient, &support.list, &particles.volume),
            largest_exchange: largest_exchange(&particles, &support, &gradient),
            fastest_reference: reference.iter().map(|r| r.wave_speed).fold(0.0, f64::max),
            prescribed: PrescribedComponents::new(&input.prescribed, positions),
            steady_body_force: input.body_forces.iter().all(BodyForce::is_steady),
            body_acceleration: vec![Vector::zeros(); count],
            loaded: loaded.collect(),
            sides: vec![Side::default(); count],
            slopes: vec![Slope::ZERO; if settings.reconstruction { count } else { 0 }],
            chunk_powers: vec![Powers::default(); chunks],
            chunk_figures: vec![ChunkFigures::NEUTRAL; chunks],
            body_forces: input.body_forces,
            initial_velocity: initial.velocity,
            particles,
            support,
            least_squares,
            settings,
            materials,
            reference,
        };
        scheme.update_body_acceleration(0.0);
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
            let (id, position) = (particles.id[a], || particles.position[a].iter().copied());
            if initial.velocity[a].iter().any(|v| !v.is_finite()) {
                return Err(UpwindError::Velocity { id, position: position().collect() });
            }
            let Material { density, law } = materials[particles.body[a] as usize];
            let pressure = initial.pressure[a];
            let ratio = law.volume_ratio_at_pressure(pressure).ok_or_else(|| {
                UpwindError::Prestress { id, position: position().collect(), pressure }
            })?;
            let density = density / ratio;
            let mass = density * particles.volume[a];
            if !(mass > 0.0 && mass.is_finite()) {
                return Err(UpwindError::Mass { id, position: position().collect(), mass });
            }
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
