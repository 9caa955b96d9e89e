//! From particles and settings to a scheme that is ready to run.

use std::sync::Arc;

use piola_formulas::fluid;
use piola_formulas::kernels::Kernel;
use thiserror::Error;

use super::walls::WallParticle;
use super::{
    AtRest, Common, Continuum, DensityRule, OpenBoundaries, Settings, Slip, TransportVelocity,
};
use crate::Vector;
use crate::boundaries::prescribed::PrescribedComponents;
use crate::boundaries::{BodyForce, PrescribedVelocity, SpaceTime, padded};
use crate::coordinates;
use crate::fields::width;
use crate::geometry::{Faces, Particles};
use crate::neighbors::{Domain, NeighborError};
use crate::operators::MovingSupport;
use crate::schemes::input::{check_index, check_lengths, check_materials, check_particles};
use crate::schemes::stages::{StageFault, Stages};
use crate::schemes::{Initial, InputError, SplitScheme};

/// A body that is a wall.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Wall {
    /// Its number.
    pub body: u32,
    /// What it does to the fluid along it.
    pub slip: Slip,
}

/// All that the formulation is bound to but the matter.
pub struct TransportVelocityInput<const D: usize> {
    /// The particles of matter and walls, all of the same spacing.
    pub particles: Particles<D>,
    /// The box and its periodic axes.
    pub domain: Domain<D>,
    /// The smoothing kernel.
    pub kernel: Kernel,
    /// Smoothing length h in m.
    pub smoothing_length: f64,
    /// Numerical settings.
    pub settings: Settings,
    /// Initial velocity and pressure.
    pub initial: Initial<D>,
    /// The bodies that are walls.
    pub walls: Vec<Wall>,
    /// The faces towards the fluid that each particle is behind; not used but of walls.
    pub faces: Vec<Faces<D>>,
    /// Velocity components with which particles of walls move; those of others are at rest.
    pub motion: Vec<PrescribedVelocity>,
    /// Velocity components with which the surface of walls slides where it is.
    pub sliding: Vec<PrescribedVelocity>,
    /// Body forces, which add up.
    pub body_forces: Vec<BodyForce<D>>,
    /// Open boundaries; only fluids have any.
    pub open: OpenBoundaries<D>,
    /// Rate in 1/s at which motion dies out, as a function of the current place; only that of fluids does.
    pub damping: Option<Arc<dyn SpaceTime>>,
}

/// Input that the formulation cannot work with.
#[derive(Clone, Debug, Error, PartialEq)]
#[non_exhaustive]
pub enum TransportVelocityError {
    /// The neighbours cannot be found.
    #[error(transparent)]
    Neighbors(#[from] NeighborError),
    /// There is no particle of fluid.
    #[error("there is no particle of fluid or solid: every body is a wall")]
    NoFluid,
    /// Particles of different sizes.
    #[error(
        "particle {id} has a spacing of {got} m, expected {expected} m: all particles of fluid and \
         walls share one spacing in this scheme, up to the 5 % by which lattices fit their shapes; change `spacing` of \
         its body, or its size"
    )]
    Spacing {
        /// Number of the particle in the order of creation.
        id: u32,
        /// The spacing of the first particle in m.
        expected: f64,
        /// Its own in m.
        got: f64,
    },
    /// Stages that do not fit together.
    #[error(transparent)]
    Stages(#[from] StageFault),
    /// Parts that do not fit together.
    #[error(transparent)]
    Input(#[from] InputError),
    /// A constant that must be positive.
    #[error("{what} is {got}, expected a positive number")]
    NotPositive {
        /// The constant.
        what: &'static str,
        /// Its value.
        got: f64,
    },
    /// Bodies that would touch themselves where they are whole.
    #[error(
        "particles that began {distance:.3e} m apart are to touch, but the kernel reaches {support:.3e} m: \
         particles that are neighbours at the start would be taken for two bodies"
    )]
    SelfContact {
        /// How far apart particles must have begun to touch, in m.
        distance: f64,
        /// Radius of the support in m.
        support: f64,
    },
    /// A velocity prescribed for the fluid.
    #[error(
        "`{name}` prescribes the velocity of particle {particle}, which is fluid; only walls move as \
         prescribed"
    )]
    PrescribedFluid {
        /// Name of the condition.
        name: String,
        /// Index of the particle in memory.
        particle: u32,
    },
    /// Damping that feeds motion, or is no number.
    #[error(
        "`damping` is {got} 1/s at particle {id} at {at}, expected a number that is not negative",
        at = coordinates(position)
    )]
    Damping {
        /// Number of the particle in the order of creation.
        id: u32,
        /// Its position in m.
        position: Vec<f64>,
        /// The rate there in 1/s.
        got: f64,
    },
    /// A start that is no number, or has no density.
    #[error(
        "the initial velocity or pressure of particle {id} at {at} is not usable",
        at = coordinates(position)
    )]
    Start {
        /// Number of the particle in the order of creation.
        id: u32,
        /// Its position in m.
        position: Vec<f64>,
    },
}

impl<const D: usize, M: Continuum<D>> TransportVelocity<D, M> {
    /// Finds neighbours and the accelerations of the start. The matter is a [`Fluid`](super::Fluid), or
    /// solids with [`SolidsInput`](super::SolidsInput).
    ///
    /// # Errors
    /// [`TransportVelocityError`] for parts that do not fit together.
    #[inline(never)]
    pub fn new(
        input: TransportVelocityInput<D>,
        matter: M::Input,
    ) -> Result<Self, TransportVelocityError> {
        let bodies = input.particles.body.iter().max().map_or(0, |most| *most as usize + 1);
        let at_rest = M::at_rest(&matter, bodies);
        check(&input, &at_rest)?;
        let TransportVelocityInput { particles, settings, initial, .. } = input;
        let count = particles.len();
        let wall_of =
            |number: usize| input.walls.iter().find(|wall| wall.body == particles.body[number]);
        let is_wall: Vec<bool> = (0..count).map(|number| wall_of(number).is_some()).collect();
        if !is_wall.contains(&false) {
            return Err(TransportVelocityError::NoFluid);
        }
        let mut walls = Vec::new();
        let mut index = |number: usize| {
            let slip = wall_of(number)?.slip;
            let faces = input.faces[number].clone();
            walls.push(WallParticle { number: number as u32, faces, slip });
            Some(walls.len() as u32 - 1)
        };
        let wall_index: Vec<Option<u32>> = (0..count).map(&mut index).collect();
        let places = || walls.iter().map(|wall| particles.position[wall.number as usize]);
        // The surface that slides is the face, not where the particle is behind it.
        let surface = |(wall, place): (&WallParticle<D>, Vector<D>)| {
            place + wall.faces.between() * wall.faces.depth()
        };
        let surfaces: Vec<Vector<D>> = walls.iter().zip(places()).map(surface).collect();
        let motion = components(&input.motion, &wall_index, &places().collect::<Vec<_>>())?;
        let sliding = components(&input.sliding, &wall_index, &surfaces)?;
        let support = MovingSupport::new(
            &particles.position,
            is_wall.clone(),
            input.kernel,
            input.smoothing_length,
            input.domain,
        )?;
        let density = |(body, pressure): (&u32, &f64)| {
            start_density(settings.density, &at_rest[*body as usize], *pressure)
        };
        let densities = particles.body.iter().zip(&initial.pressure).map(density);
        let densities: Vec<f64> = densities.collect();
        let mass = |a: usize| if is_wall[a] { 1.0 } else { densities[a] } * particles.volume[a];
        let masses = (0..particles.len()).map(mass).collect();
        let (walls, masses) = ((is_wall, walls), (at_rest, masses));
        let mut common = Common::new(particles, support, settings, walls, masses);
        (common.motion, common.sliding) = (motion, sliding);
        common.body_forces = felt_by_walls(input.body_forces, &input.walls);
        let mut matter = M::bind(matter, &mut common)?;
        if !input.open.is_empty() {
            matter.open(input.open, &mut common);
        }
        if let Some(rate) = input.damping {
            check_damping(&common, &*rate)?;
            matter.damp_by(rate, &common);
        }
        let (drift, accelerate) = (Stages::default(), Stages::default());
        let mut scheme = Self { common, matter, start: Vec::new(), drift, accelerate };
        scheme.plan()?;
        scheme.begin(&initial, &densities)?;
        Ok(scheme)
    }

    /// Makes the state of the start, with its accelerations and deviations.
    fn begin(
        &mut self,
        initial: &Initial<D>,
        densities: &[f64],
    ) -> Result<(), TransportVelocityError> {
        let (common, ledger) = (&self.common, &M::DESCRIPTION.ledger);
        let columns = common.particles.len() * width(M::DESCRIPTION.fields, D);
        let mut state = vec![0.0; columns + ledger.length(D) + 1 + self.matter.kept()];
        let (own, _) = common.parts(&mut state);
        for (number, density) in densities.iter().enumerate() {
            let position = common.particles.position[number];
            let (velocity, pressure) = (initial.velocity[number], initial.pressure[number]);
            let usable = velocity.iter().all(|v| v.is_finite())
                && pressure.is_finite()
                && common.mass[number] > 0.0;
            if !usable {
                let position = position.iter().copied().collect();
                let id = common.particles.id[number];
                return Err(TransportVelocityError::Start { id, position });
            }
            if !common.is_wall[number] {
                own.velocity[number] = velocity;
                own.pressure[number] = pressure;
            }
            own.position[number] = common.support.list().domain().wrap(&position);
            own.density[number] = *density;
        }
        self.matter.begin(common, &mut state);
        self.matter.prescribe(common, 0.0, &mut state);
        self.load(&state);
        self.common.note_evenness();
        self.accelerate(0.0, &mut state);
        self.matter.settle(&self.common, &mut state);
        ledger.clear(D, self.tail(&mut state));
        self.start = state;
        Ok(())
    }
}

/// The rate of damping must have a meaning where the fluid is at the start.
fn check_damping<const D: usize>(
    common: &Common<D>,
    rate: &dyn SpaceTime,
) -> Result<(), TransportVelocityError> {
    let Particles { position, id, .. } = &common.particles;
    for number in (0..position.len()).filter(|number| !common.is_wall[*number]) {
        let got = rate.value(padded(&position[number]), 0.0);
        if !(got >= 0.0 && got.is_finite()) {
            let position = position[number].iter().copied().collect();
            return Err(TransportVelocityError::Damping { id: id[number], position, got });
        }
    }
    Ok(())
}

/// The density that the law of state gives for a pressure, or rho0 where sums over masses follow.
fn start_density(rule: DensityRule, matter: &AtRest, pressure: f64) -> f64 {
    match rule {
        DensityRule::Continuity => fluid::density(pressure, matter.density, matter.wave_speed),
        DensityRule::Summation => matter.density,
    }
}

fn check<const D: usize>(
    input: &TransportVelocityInput<D>,
    at_rest: &[AtRest],
) -> Result<(), TransportVelocityError> {
    let (particles, initial) = (&input.particles, &input.initial);
    check_particles(particles)?;
    check_materials(particles, at_rest.len())?;
    check_lengths(
        particles.len(),
        &[
            ("the list of faces", input.faces.len()),
            ("the initial velocity", initial.velocity.len()),
            ("the initial pressure", initial.pressure.len()),
        ],
    )?;
    for condition in input.motion.iter().chain(&input.sliding) {
        let what = || format!("`{}`: velocity component", condition.name);
        check_index(what, condition.component, D)?;
    }
    let of_matter = |matter: &AtRest| {
        [("the density at rest", matter.density), ("the wave speed at rest", matter.wave_speed)]
    };
    let positive = [("the smoothing length", input.smoothing_length)];
    for (what, got) in positive.into_iter().chain(at_rest.iter().flat_map(of_matter)) {
        if !(got > 0.0 && got.is_finite()) {
            return Err(TransportVelocityError::NotPositive { what, got });
        }
    }
    let spacing = particles.spacing.first().copied().unwrap_or_default();
    let other = |got: &f64| !((got - spacing).abs() <= 1e-9 * spacing);
    if let Some(number) = particles.spacing.iter().position(other) {
        let (id, got) = (particles.id[number], particles.spacing[number]);
        return Err(TransportVelocityError::Spacing { id, expected: spacing, got });
    }
    Ok(())
}

/// Prescribed components of wall particles, numbered among these, at their places.
fn components<const D: usize>(
    conditions: &[PrescribedVelocity],
    wall_index: &[Option<u32>],
    places: &[Vector<D>],
) -> Result<PrescribedComponents, TransportVelocityError> {
    let mut renumbered = Vec::new();
    for condition in conditions {
        let index = |&particle: &u32| {
            let (name, found) = (&condition.name, wall_index.get(particle as usize));
            found.copied().flatten().ok_or_else(|| TransportVelocityError::PrescribedFluid {
                name: name.clone(),
                particle,
            })
        };
        let particles = condition.particles.iter().map(index).collect::<Result<_, _>>()?;
        renumbered.push(PrescribedVelocity { particles, ..condition.clone() });
    }
    Ok(PrescribedComponents::new(&renumbered, places))
}

/// Body forces of which walls feel those of the matter beside them, too, as their ghost values need them, CTVF (47): those
/// of the first body that is no wall and has some of its own.
fn felt_by_walls<const D: usize>(
    mut forces: Vec<BodyForce<D>>,
    walls: &[Wall],
) -> Vec<BodyForce<D>> {
    let is_wall = |body: u32| walls.iter().any(|wall| wall.body == body);
    let first = forces.iter().filter_map(|force| force.body).filter(|body| !is_wall(*body)).min();
    let own = forces.iter().filter(|force| force.body.is_some() && force.body == first);
    let felt = own.flat_map(|force| {
        walls.iter().map(|wall| BodyForce { body: Some(wall.body), ..force.clone() })
    });
    let felt: Vec<_> = felt.collect();
    forces.extend(felt);
    forces
}
