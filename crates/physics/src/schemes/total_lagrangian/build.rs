//! From particles and settings to a scheme that is ready to run.

use std::sync::Arc;

use piola_formulas::kernels::Kernel;

use super::check::check;
use super::fields::{ColumnsMut, Made};
use super::rigid::RigidBodies;
use super::stable_step::Bound;
use super::strong::{self, Edges, Hole, Moving};
use super::tractions::Body;
use super::{
    Configuration, Discrete, FIGURES, Form, LEDGER, Loads, Material, Matrices, Mixture, Motion,
    RigidBody, Settings, Solid, Statics, StaticsInput, TOTAL_LAGRANGIAN, TotalLagrangian,
    TotalLagrangianError, Tractions, stages,
};
use crate::boundaries::prescribed::PrescribedComponents;
use crate::boundaries::{
    BodyForce, FollowerPressure, PrescribedDisplacement, PrescribedVelocity, Spring, Traction,
    traction::Loaded,
};
use crate::fields::width;
use crate::geometry::Particles;
use crate::neighbors::Domain;
use crate::operators::{Cover, DirectedSupport, Mirror, OperatorError, images};
use crate::parallel::Team;
use crate::schemes::input::{check_displacement, check_particle};
use crate::schemes::{Scheme as _, SchemeDescription, SplitScheme as _};
use crate::{Tensor, Vector};

/// All that the formulation is bound to.
pub struct TotalLagrangianInput<const D: usize> {
    /// What it is called: the description of the formulation, or of one of its presets.
    pub description: &'static SchemeDescription,
    /// The particles, in the order in which they shall lie in memory.
    pub particles: Particles<D>,
    /// The kernel.
    pub kernel: Kernel,
    /// Support radius of each particle in m.
    pub radius: Vec<f64>,
    /// Number of the group of each particle: those of other groups are not seen.
    pub group: Vec<u32>,
    /// The box and its periodic axes.
    pub domain: Domain<D>,
    /// Numerical settings.
    pub settings: Settings<D>,
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
    /// Pressures that follow the surface, which add up.
    pub pressures: Vec<FollowerPressure<D>>,
    /// Springs and dampers to points.
    pub springs: Vec<Spring<D>>,
    /// Prescribed velocity components.
    pub prescribed: Vec<PrescribedVelocity>,
    /// In the adjoint form symmetry planes and rollers, each with a particle on it whose velocity
    /// across is prescribed.
    pub mirrors: Vec<(Mirror, u32)>,
    /// In the strong form round holes in the box, whose edges are free of stress.
    pub holes: Vec<Hole<D>>,
    /// Particles that move as one.
    pub rigid: Vec<RigidBody<D>>,
    /// How states follow each other.
    pub motion: Motion<D>,
}

impl<const D: usize> TotalLagrangianInput<D> {
    /// Bodies of one material each, at rest, on supports of the given radii in m, with nothing that acts
    /// on them, in explicit steps.
    pub fn of_bodies(
        particles: Particles<D>,
        materials: &[Material<D>],
        (kernel, radius): (Kernel, Vec<f64>),
    ) -> Self {
        let (count, body) = (particles.len(), particles.body.clone());
        Self {
            description: &TOTAL_LAGRANGIAN,
            particles,
            kernel,
            radius,
            group: body.clone(),
            domain: Domain::default(),
            settings: Settings::default(),
            mixtures: Mixture::of_each(materials),
            mixture: body,
            displacement: vec![Vector::zeros(); count],
            velocity: vec![Vector::zeros(); count],
            body_forces: Vec::new(),
            tractions: Vec::new(),
            pressures: Vec::new(),
            springs: Vec::new(),
            prescribed: Vec::new(),
            mirrors: Vec::new(),
            holes: Vec::new(),
            rigid: Vec::new(),
            motion: Motion::Explicit,
        }
    }
}

impl<const D: usize> TotalLagrangian<D> {
    /// Builds operators, scratch and the initial state; nothing is allocated in an explicit step afterwards, unless
    /// matrices are made in each step.
    ///
    /// # Errors
    /// [`TotalLagrangianError`] for arrays that do not fit together, particles without mass or
    /// gradient, impossible values, loads on what does not exist, and parts that do not serve each
    /// other.
    #[inline(never)]
    pub fn new(input: TotalLagrangianInput<D>) -> Result<Self, TotalLagrangianError> {
        check(&input)?;
        let TotalLagrangianInput { kernel, radius, group, domain, settings, .. } = input;
        let solid = Arc::new(Solid::new(input.particles, input.mixtures, input.mixture)?);
        for (a, (velocity, displacement)) in
            input.velocity.iter().zip(&input.displacement).enumerate()
        {
            check_particle(&solid.particles, a, solid.mass[a], velocity)?;
            check_displacement(&solid.particles, a, displacement)?;
        }
        let (count, particles) = (solid.len(), &solid.particles);
        let positions = &particles.position;
        let prescribed = PrescribedComponents::new(&input.prescribed, positions);
        let mirrors: Vec<Mirror> = input.mirrors.iter().map(|(mirror, _)| *mirror).collect();
        let reach = radius.iter().copied().fold(0.0, f64::max);
        let made = images(positions, &particles.spacing, &mirrors, reach);
        let (group_of, images) = (&*group, &*made);
        let cover = Cover { particles, group: group_of, images, kernel, radius: &radius, domain };
        let loaded: Vec<Loaded<D>>;
        let matrices = match settings.form {
            Form::Strong => {
                let known = strong::find(particles, &group, &prescribed, &input.holes, reach)?;
                let made = strong::matrices(&cover, &known.edges, &known.inside)?;
                let of = |a: usize| solid.mixture(a).clone();
                let (own, elsewhere) = Edges::new(known, made, &input.tractions, positions, of)?;
                loaded = elsewhere;
                Matrices::Strong(Box::new(own))
            }
            Form::Adjoint => {
                let support = DirectedSupport::of(&cover).map_err(OperatorError::from)?;
                let on = input.mirrors.iter().map(|&(mirror, on)| (mirror, on as usize)).collect();
                let discrete = Discrete::on(solid.clone(), (images, on), &support, &settings)?;
                let operator = &*discrete.operator;
                let body = Body { particles, operator, group: &group, radius: &radius };
                let of = |load: &Traction<D>| match settings.tractions {
                    Tractions::Surface => load.loaded(positions).collect(),
                    Tractions::Layers => body.loads(load),
                };
                loaded = input.tractions.iter().flat_map(of).collect();
                Matrices::Adjoint(discrete)
            }
        };
        let pressed = input.pressures.iter().flat_map(|load| load.pressed(positions)).collect();
        let (body_forces, springs) = (input.body_forces, input.springs);
        let loads = Loads { body_forces, loaded, pressed, springs };
        let is_static = matches!(input.motion, Motion::Static(_));
        let statics = match (input.motion, &matrices) {
            (Motion::Explicit, _) | (_, Matrices::Strong(_)) => None,
            (Motion::Implicit(method, newton), Matrices::Adjoint(discrete)) => {
                let prescribed = input.prescribed.iter().map(held).collect();
                let known = StaticsInput { prescribed, method, newton, ..Default::default() };
                Some(Statics::moving(Arc::new(discrete.clone()), known, loads.clone())?)
            }
            (Motion::Static(known), Matrices::Adjoint(discrete)) => {
                Some(Statics::resting(Arc::new(discrete.clone()), *known, loads.clone())?)
            }
        };
        let (behind, edges) = (matrices.behind(), matrices.edges().map_or(0, Edges::data));
        let dissipation = settings.dissipation;
        let length = count * width(Made::FIELDS, D) + LEDGER.length(D) + FIGURES + D * edges;
        let rate_length = if dissipation.is_viscous() { count } else { 0 };
        let with_edges = if edges > 0 { count + edges } else { 0 };
        let is_continued = edges > 0 || behind > 0 && dissipation.is_viscous();
        let (with_all, with_images) = (count + behind, count + behind - edges);
        let is_updated = settings.configuration == Configuration::Updated;
        let is_strong = settings.form == Form::Strong;
        let mut scheme = Self {
            description: input.description,
            updated: is_updated.then_some(Moving { kernel, radius, group, domain }),
            is_driven: !loads.is_empty() || !prescribed.is_empty(),
            loads,
            has_images: !made.is_empty(),
            team: Team::default(),
            prescribed,
            rigid: RigidBodies::new(input.rigid, &solid),
            group: None,
            statics: statics.map(Box::new),
            is_static,
            stable: Bound::default(),
            not_convex: None,
            jumped: None,
            is_evaluated: false,
            has_matrices: true,
            stages: stages::plan(&matrices, count, dissipation.is_viscous())?,
            displacement: vec![Vector::zeros(); with_all],
            velocity: vec![Vector::zeros(); if is_continued { with_all } else { 0 }],
            acceleration: vec![Vector::zeros(); with_edges],
            strained: matrices.strained(count),
            gradient_rate: vec![Tensor::zeros(); rate_length],
            stress: vec![Tensor::zeros(); if is_strong { count } else { 0 }],
            force: vec![Vector::zeros(); with_images],
            rate: vec![0.0; length],
            reaction: Vec::new(),
            initial: Vec::new(),
            matrices,
            dissipation,
            solid,
        };
        if !is_static {
            scheme.stable = scheme.bound();
        }
        scheme.initial = scheme.first_state(&input.displacement, &input.velocity);
        Ok(scheme)
    }

    /// The state at the start, with the accelerations that belong to it.
    fn first_state(&mut self, displacement: &[Vector<D>], velocity: &[Vector<D>]) -> Vec<f64> {
        let mut state = vec![0.0; self.rate.len()];
        let (own, _) = ColumnsMut::<D>::of(&mut state, self.solid.len());
        own.velocity.copy_from_slice(velocity);
        own.displacement.copy_from_slice(displacement);
        self.constrain(0.0, &mut state);
        self.accelerate(0.0, &mut state);
        state
    }
}

/// The components that a prescribed velocity holds; their displacements are found step by step.
fn held<const D: usize>(condition: &PrescribedVelocity) -> PrescribedDisplacement<D> {
    let PrescribedVelocity { name, particles, component, .. } = condition.clone();
    PrescribedDisplacement::component(name, particles, component, Arc::new(0.0))
}
