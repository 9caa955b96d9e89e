//! From particles and settings to a scheme that is ready to run.

use piola_formulas::fluid;
use piola_formulas::kernels::Kernel;
use piola_formulas::pairs::Record;
use piola_formulas::pairs::fluid::FluidSide;
use thiserror::Error;

use super::shifting::Iteration;
use super::{
    Continua, DensityRule, Fluid, Forces, Hold, LEDGER, Opening, Rates, Settings, Slip, Solids,
    SolidsInput, TransportVelocity, WallParticle, WallValues,
};
use crate::Vector;
use crate::boundaries::prescribed::PrescribedComponents;
use crate::boundaries::{BodyForce, PrescribedVelocity};
use crate::geometry::{Faces, Particles};
use crate::neighbors::{Domain, NeighborError};
use crate::operators::MovingSupport;
use crate::schemes::input::{
    check_index, check_lengths, check_materials, check_particles, check_selected,
};
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

/// All that the formulation is bound to.
pub struct TransportVelocityInput<const D: usize> {
    /// The particles of fluid and walls, all of the same spacing.
    pub particles: Particles<D>,
    /// The box and its periodic axes.
    pub domain: Domain<D>,
    /// The smoothing kernel.
    pub kernel: Kernel,
    /// Smoothing length h in m.
    pub smoothing_length: f64,
    /// Numerical settings.
    pub settings: Settings,
    /// The fluid; of solids the numbers that stand for all of them, [`Fluid::of_solids`].
    pub fluid: Fluid,
    /// The solids, if there are some in place of the fluid.
    pub solids: Option<SolidsInput>,
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
         walls share one spacing in this scheme"
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
    /// A start that is no number, or has no density.
    #[error("the initial velocity or pressure of particle {id} at {position:?} is not usable")]
    Start {
        /// Number of the particle in the order of creation.
        id: u32,
        /// Its position in m.
        position: Vec<f64>,
    },
}

impl<const D: usize> TransportVelocity<D> {
    /// Finds neighbours and the accelerations of the start.
    ///
    /// # Errors
    /// [`TransportVelocityError`] for parts that do not fit together.
    pub fn new(input: TransportVelocityInput<D>) -> Result<Self, TransportVelocityError> {
        check(&input)?;
        let TransportVelocityInput { particles, settings, fluid, initial, .. } = input;
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
        let of_walls = |conditions: &[PrescribedVelocity]| {
            components(conditions, &wall_index, &walls, &particles)
        };
        let (motion, sliding) = (of_walls(&input.motion)?, of_walls(&input.sliding)?);
        let support = MovingSupport::new(
            &particles.position,
            is_wall.clone(),
            input.kernel,
            input.smoothing_length,
            input.domain,
        )?;
        let continua = Continua::new(input.solids.as_ref(), &particles, &is_wall, input.domain);
        let solids = match input.solids {
            Some(solids) => {
                Some(Box::new(Solids::new(solids, &particles, &is_wall, &input.domain)?))
            }
            None => None,
        };
        let densities: Vec<f64> = (0..count)
            .map(|number| match &solids {
                Some(solids) => solids.density(particles.body[number]),
                None => start_density(&settings, &fluid, initial.pressure[number]),
            })
            .collect();
        let mass = densities.iter().zip(&particles.volume).map(|(rho, volume)| rho * volume);
        let mut scheme = Self {
            mass: mass.collect(),
            sides: vec![FluidSide::zero(); count],
            densities,
            rates: vec![Rates::default(); count],
            forces: vec![Forces::default(); count],
            shear: vec![Vector::zeros(); if walls.is_empty() { 0 } else { count }],
            holds: vec![
                Hold::default();
                if walls.is_empty() || solids.is_some() { 0 } else { count }
            ],
            wall_values: vec![WallValues::default(); walls.len()],
            openings: vec![Opening::default(); if settings.free_surface { count } else { 0 }],
            found: vec![(Vector::zeros(), false); if settings.free_surface { count } else { 0 }],
            marks: vec![false; if settings.free_surface { count } else { 0 }],
            iteration: Iteration::default(),
            continua,
            solids,
            drift: Stages::default(),
            accelerate: Stages::default(),
            fastest: 0.0,
            guard: None,
            removed: Vec::new(),
            lost: None,
            start: Vec::new(),
            body_forces: input.body_forces,
            particles,
            support,
            settings,
            fluid,
            is_wall,
            walls,
            motion,
            sliding,
        };
        scheme.plan()?;
        scheme.begin(&initial)?;
        Ok(scheme)
    }

    /// Makes the state of the start, with its accelerations and deviations.
    fn begin(&mut self, initial: &Initial<D>) -> Result<(), TransportVelocityError> {
        let count = self.particles.len();
        let mut state = vec![0.0; self.matter_start() + self.matter_length()];
        let matter = self.matter_start();
        self.begin_matter(&mut state[matter..]);
        let (own, _) = self.parts(&mut state);
        for number in 0..count {
            let position = self.particles.position[number];
            let (velocity, pressure) = (initial.velocity[number], initial.pressure[number]);
            let usable = velocity.iter().all(|v| v.is_finite())
                && pressure.is_finite()
                && self.mass[number] > 0.0;
            if !usable {
                let position = position.iter().copied().collect();
                let id = self.particles.id[number];
                return Err(TransportVelocityError::Start { id, position });
            }
            if !self.is_wall[number] {
                own.velocity[number] = velocity;
                own.pressure[number] = pressure;
            }
            own.position[number] = self.support.list().domain().wrap(&position);
            own.density[number] = self.densities[number];
        }
        self.hold_velocities(0.0, &mut state);
        self.load(&state);
        self.note_evenness();
        self.accelerate(0.0, &mut state);
        LEDGER.clear(D, self.parts(&mut state).1);
        self.start = state;
        Ok(())
    }

    /// The state of the start.
    pub(super) fn start(&self) -> &[f64] {
        &self.start
    }
}

/// The density that the law of state gives for a pressure, or rho0 where sums over masses follow.
fn start_density(settings: &Settings, fluid: &Fluid, pressure: f64) -> f64 {
    match settings.density {
        DensityRule::Continuity => fluid::density(pressure, fluid.density, fluid.wave_speed),
        DensityRule::Summation => fluid.density,
    }
}

fn check<const D: usize>(input: &TransportVelocityInput<D>) -> Result<(), TransportVelocityError> {
    let (particles, initial) = (&input.particles, &input.initial);
    check_particles(particles)?;
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
    if let Some(solids) = &input.solids {
        check_materials(particles, solids.materials.len())?;
        let support = input.kernel.support_radius(input.smoothing_length);
        if let Some(distance) = solids.self_contact.filter(|&distance| !(distance > support)) {
            return Err(TransportVelocityError::SelfContact { distance, support });
        }
        for condition in &solids.held {
            check_selected(&condition.name, &condition.particles, particles.len())?;
            let what = || format!("`{}`: velocity component", condition.name);
            check_index(what, condition.component, D)?;
        }
    }
    let positive = [
        ("the smoothing length", input.smoothing_length),
        ("the density of the fluid", input.fluid.density),
        ("the wave speed of the fluid", input.fluid.wave_speed),
    ];
    for (what, got) in positive {
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

/// Prescribed components of wall particles, numbered among these.
fn components<const D: usize>(
    conditions: &[PrescribedVelocity],
    wall_index: &[Option<u32>],
    walls: &[WallParticle<D>],
    particles: &Particles<D>,
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
    let positions: Vec<Vector<D>> =
        walls.iter().map(|wall| particles.position[wall.number as usize]).collect();
    Ok(PrescribedComponents::new(&renumbered, &positions))
}
