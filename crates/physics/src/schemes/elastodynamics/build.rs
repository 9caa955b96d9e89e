//! From particles and settings to a scheme that is ready to run.

use piola_formulas::kernels::Kernel;
use thiserror::Error;

use super::edges::{self, Edges};
use super::fields::{ColumnsMut, Made};
use super::holes::Hole;
use super::stages;
use super::tractions::Body;
use super::{
    Configuration, Elastodynamics, Form, LEDGER, Matrices, Mixture, Settings, stable_step::Bound,
};
use crate::boundaries::prescribed::PrescribedComponents;
use crate::boundaries::{BodyForce, PrescribedVelocity, Traction, traction::Loaded};
use crate::fields::width;
use crate::geometry::Particles;
use crate::neighbors::Domain;
use crate::operators::{Cover, Mirror, OperatorError, ReferenceGradient, images};
use crate::schemes::input::{
    check_conditions, check_index, check_lengths, check_particle, check_particles,
};
use crate::schemes::{InputError, StageFault};
use crate::{Tensor, Vector};

/// All that the formulation is bound to.
pub struct ElastodynamicsInput<const D: usize> {
    /// The particles, in the order in which they shall lie in memory.
    pub particles: Particles<D>,
    /// The cover function.
    pub kernel: Kernel,
    /// Support radius of each particle in m.
    pub radius: Vec<f64>,
    /// Number of the group of each particle: those of other groups are not seen.
    pub group: Vec<u32>,
    /// The box and its periodic axes.
    pub domain: Domain<D>,
    /// Numerical settings.
    pub settings: Settings,
    /// What particles are made of.
    pub mixtures: Vec<Mixture<D>>,
    /// Which mixture each particle is made of.
    pub mixture: Vec<u32>,
    /// Initial displacement of each particle in m.
    pub displacement: Vec<Vector<D>>,
    /// Initial velocity of each particle in m/s.
    pub velocity: Vec<Vector<D>>,
    /// Body forces, which add up.
    pub body_forces: Vec<BodyForce<D>>,
    /// Dead tractions, which add up.
    pub tractions: Vec<Traction<D>>,
    /// Prescribed velocity components.
    pub prescribed: Vec<PrescribedVelocity>,
    /// In the adjoint form symmetry planes and rollers, each with a particle on it whose velocity
    /// across is prescribed.
    pub mirrors: Vec<(Mirror, u32)>,
    /// In the strong form round holes in the box, whose edges are free of stress.
    pub holes: Vec<Hole<D>>,
}

/// Input that the formulation cannot work with.
#[derive(Clone, Debug, Error, PartialEq)]
#[non_exhaustive]
pub enum ElastodynamicsError {
    /// Stages that do not fit together.
    #[error(transparent)]
    Stages(#[from] StageFault),
    /// A matrix does not exist.
    #[error(transparent)]
    Operator(#[from] OperatorError),
    /// Parts that do not fit together.
    #[error(transparent)]
    Input(#[from] InputError),
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
         {id} at {position:?}: in the strong form a component is held on all of an edge or nowhere on \
         it; use `form = \"adjoint\"`"
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
        "the hole of {radius} m around {center:?} is too small for the particles around it, or has a site \
         of the lattice in its centre; make the spacing smaller, or use `form = \"adjoint\"`"
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
        "the body repeats itself along axis {axis}, so that it cannot end on a plane across it; remove \
         the plane, or the periodic axis"
    )]
    Periodic {
        /// The axis, from 0.
        axis: usize,
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

impl<const D: usize> Elastodynamics<D> {
    /// Builds matrices, scratch and the initial state; what is allocated in a step afterwards is a
    /// number a chunk of particles for each sum of the ledger, unless matrices are made in each step.
    ///
    /// # Errors
    /// [`ElastodynamicsError`] for arrays that do not fit together, particles without mass or
    /// gradient, impossible values, and forms that are for other bodies.
    pub fn new(input: ElastodynamicsInput<D>) -> Result<Self, ElastodynamicsError> {
        let ElastodynamicsInput { particles, kernel, radius, group, domain, settings, .. } = input;
        let count = particles.len();
        check_particles(&particles)?;
        let lists = [
            ("the list of supports", radius.len()),
            ("the list of groups", group.len()),
            ("the list of mixtures", input.mixture.len()),
            ("the initial displacement", input.displacement.len()),
            ("the initial velocity", input.velocity.len()),
        ];
        check_lengths(count, &lists)?;
        check_settings(&settings)?;
        check_conditions(count, &input.tractions, &input.prescribed)?;
        for &mixture in &input.mixture {
            check_index(|| "the mixture".into(), mixture as usize, input.mixtures.len())?;
        }
        for (mirror, particle) in &input.mirrors {
            check_index(|| "a mirror: particle".into(), *particle as usize, count)?;
            check_index(|| "a mirror: axis".into(), mirror.axis, D)?;
        }
        let planes = input.mirrors.iter().map(|(mirror, _)| mirror.axis);
        let edges = if settings.form == Form::Strong { 0..D } else { 0..0 };
        let mut ended = planes.chain(edges);
        if let Some(axis) = ended.find(|&axis| domain.periodic()[axis].is_some()) {
            return Err(ElastodynamicsError::Periodic { axis });
        }
        let mut mass = Vec::with_capacity(count);
        for (a, velocity) in input.velocity.iter().enumerate() {
            let own = input.mixtures[input.mixture[a] as usize].density() * particles.volume[a];
            check_particle(&particles, a, own, velocity)?;
            check_particle(&particles, a, own, &input.displacement[a])?;
            mass.push(own);
        }
        let positions = &particles.position;
        let prescribed = PrescribedComponents::new(&input.prescribed, positions);
        let mirrors: Vec<Mirror> = input.mirrors.iter().map(|(mirror, _)| *mirror).collect();
        let reach = radius.iter().copied().fold(0.0, f64::max);
        let made = match settings.form {
            Form::Adjoint => images(positions, &particles.spacing, &mirrors, reach),
            Form::Strong => Vec::new(),
        };
        let cover = Cover {
            particles: &particles,
            group: &group,
            images: &made,
            kernel,
            radius: &radius,
            domain,
        };
        let loaded: Vec<Loaded<D>>;
        let matrices = match settings.form {
            _ if settings.configuration == Configuration::Updated
                && (D > 1 || settings.form == Form::Adjoint) =>
            {
                return Err(ElastodynamicsError::Updated);
            }
            Form::Strong => {
                let known = edges::find(&particles, &group, &prescribed, &input.holes, reach)?;
                let made = edges::matrices(&cover, &known.edges, &known.inside)?;
                let of = |a: usize| input.mixtures[input.mixture[a] as usize].clone();
                let (own, elsewhere) = Edges::new(known, made, &input.tractions, positions, of)?;
                loaded = elsewhere;
                Matrices::Strong(own)
            }
            Form::Adjoint => {
                let coefficient = |a: usize| {
                    let shear = input.mixtures[input.mixture[a] as usize].shear_modulus();
                    settings.hourglass * shear * particles.volume[a]
                };
                let operator =
                    ReferenceGradient::plain(&cover, (0..count).map(coefficient).collect())?;
                let body = Body {
                    particles: &particles,
                    operator: &operator,
                    group: &group,
                    radius: &radius,
                };
                loaded = input.tractions.iter().flat_map(|load| body.loads(load)).collect();
                Matrices::Adjoint(operator)
            }
        };
        let (behind, edges) = (matrices.behind(), matrices.edges().map_or(0, Edges::data));
        let at_rest = |mixture: &Mixture<D>| mixture.wave_moduli(&Tensor::zeros());
        let moduli: Vec<[f64; 2]> = input.mixtures.iter().map(at_rest).collect();
        let length = count * width(Made::FIELDS, D) + LEDGER.length(D) + D * edges;
        let rate_length = if settings.is_viscous() { count } else { 0 };
        let with_edges = if edges > 0 { count + edges } else { 0 };
        let is_continued = edges > 0 || behind > 0 && settings.is_viscous();
        let (with_all, with_images) = (count + behind, count + behind - edges);
        let mut scheme = Self {
            mirrors: input.mirrors.iter().map(|&(mirror, on)| (mirror, on as usize)).collect(),
            loaded,
            prescribed,
            matrices,
            stable: Bound::default(),
            moduli_at_rest: moduli,
            not_convex: None,
            body_forces: input.body_forces,
            is_evaluated: false,
            has_matrices: true,
            stages: stages::plan()?,
            displacement: vec![Vector::zeros(); with_all],
            velocity: vec![Vector::zeros(); if is_continued { with_all } else { 0 }],
            acceleration: vec![Vector::zeros(); with_edges],
            gradient: vec![Tensor::zeros(); count],
            gradient_rate: vec![Tensor::zeros(); rate_length],
            stress: vec![Tensor::zeros(); count],
            tension: vec![Tensor::zeros(); with_images],
            force: vec![Vector::zeros(); with_images],
            rate: vec![0.0; length],
            initial: Vec::new(),
            mixtures: input.mixtures,
            mixture: input.mixture,
            mass,
            particles,
            kernel,
            radius,
            group,
            domain,
            settings,
        };
        scheme.stable = scheme.bound();
        scheme.initial = scheme.first_state(&input.displacement, &input.velocity);
        Ok(scheme)
    }

    /// The state at the start, with the accelerations that belong to it.
    fn first_state(&mut self, displacement: &[Vector<D>], velocity: &[Vector<D>]) -> Vec<f64> {
        let mut state = vec![0.0; self.rate.len()];
        let (own, _) = ColumnsMut::<D>::of(&mut state, self.mass.len());
        own.velocity.copy_from_slice(velocity);
        own.displacement.copy_from_slice(displacement);
        crate::schemes::Scheme::constrain(self, 0.0, &mut state);
        crate::schemes::SplitScheme::accelerate(self, 0.0, &mut state);
        state
    }
}

fn check_settings(settings: &Settings) -> Result<(), ElastodynamicsError> {
    let [linear, quadratic] = settings.artificial_viscosity;
    let all = [
        ("the hourglass coefficient", settings.hourglass),
        ("the viscosity", settings.viscosity),
        ("the linear artificial viscosity", linear),
        ("the quadratic artificial viscosity", quadratic),
        ("the damping", settings.damping),
    ];
    let wrong = all.into_iter().find(|(_, value)| !(*value >= 0.0 && value.is_finite()));
    wrong.map_or(Ok(()), |(what, value)| Err(ElastodynamicsError::Coefficient { what, value }))
}
