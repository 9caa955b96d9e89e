//! From particles and settings to a scheme that is ready to run.

use std::sync::Arc;

use piola_formulas::kernels::Kernel;

use super::fields::{ColumnsMut, Made};
use super::stable_step::Bound;
use super::strong::{self, Edges, Hole, Moving};
use super::tractions::Body;
use super::{
    Configuration, Discrete, FIGURES, Form, Gradients, LEDGER, Loads, Material, Matrices, Mixture,
    Motion, Part, Settings, Solid, Statics, StaticsInput, TOTAL_LAGRANGIAN, TotalLagrangian,
    TotalLagrangianError, Tractions, stages,
};
use crate::boundaries::prescribed::PrescribedComponents;
use crate::boundaries::{
    BodyForce, FollowerPressure, PrescribedDisplacement, PrescribedVelocity, SpaceTime, Traction,
    traction::Loaded,
};
use crate::fields::width;
use crate::geometry::Particles;
use crate::neighbors::Domain;
use crate::operators::{Cover, DirectedSupport, Mirror, OperatorError, images};
use crate::schemes::input::{
    check_conditions, check_displacement, check_index, check_lengths, check_particle,
    check_particles, check_pressure,
};
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
    /// Prescribed velocity components.
    pub prescribed: Vec<PrescribedVelocity>,
    /// In the adjoint form symmetry planes and rollers, each with a particle on it whose velocity
    /// across is prescribed.
    pub mirrors: Vec<(Mirror, u32)>,
    /// In the strong form round holes in the box, whose edges are free of stress.
    pub holes: Vec<Hole<D>>,
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
            prescribed: Vec::new(),
            mirrors: Vec::new(),
            holes: Vec::new(),
            motion: Motion::Explicit,
        }
    }
}

impl<const D: usize> TotalLagrangian<D> {
    /// Builds operators, scratch and the initial state; what is allocated in an explicit step
    /// afterwards is a number a chunk of particles for each sum of the ledger, unless matrices are made
    /// in each step.
    ///
    /// # Errors
    /// [`TotalLagrangianError`] for arrays that do not fit together, particles without mass or
    /// gradient, impossible values, loads on what does not exist, and parts that do not serve each
    /// other.
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
        let loads = Loads { body_forces: input.body_forces, loaded, pressed };
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
            loads,
            prescribed,
            statics: statics.map(Box::new),
            is_static,
            stable: Bound::default(),
            not_convex: None,
            jumped: None,
            is_evaluated: false,
            has_matrices: true,
            stages: stages::plan(is_strong, dissipation.is_viscous())?,
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

/// Refuses arrays that do not fit together, impossible values, and parts that do not serve each other.
fn check<const D: usize>(input: &TotalLagrangianInput<D>) -> Result<(), TotalLagrangianError> {
    check_particles(&input.particles)?;
    let (count, settings) = (input.particles.len(), &input.settings);
    let lists = [
        ("the list of supports", input.radius.len()),
        ("the list of groups", input.group.len()),
        ("the list of mixtures", input.mixture.len()),
        ("the initial displacement", input.displacement.len()),
        ("the initial velocity", input.velocity.len()),
    ];
    check_lengths(count, &lists)?;
    check_coefficients(settings)?;
    check_conditions(count, &input.tractions, &input.prescribed)?;
    input.pressures.iter().try_for_each(|load| check_pressure(load, count))?;
    for (mirror, particle) in &input.mirrors {
        check_index(|| "a mirror: particle".into(), *particle as usize, count)?;
        check_index(|| "a mirror: axis".into(), mirror.axis, D)?;
    }
    let planes = input.mirrors.iter().map(|(mirror, _)| mirror.axis);
    let edges = if settings.form == Form::Strong { 0..D } else { 0..0 };
    let mut ended = planes.chain(edges);
    if let Some(axis) = ended.find(|&axis| input.domain.periodic()[axis].is_some()) {
        return Err(TotalLagrangianError::Periodic { axis: AXES[axis] });
    }
    for (number, (mirror, particle)) in input.mirrors.iter().enumerate() {
        let same = |(other, _): &(Mirror, u32)| {
            (other.axis, other.is_upper) == (mirror.axis, mirror.is_upper)
        };
        if input.mirrors[..number].iter().any(same) {
            return Err(TotalLagrangianError::TwoPlanes { axis: AXES[mirror.axis] });
        }
        check_plane(input, mirror, *particle as usize)?;
    }
    if settings.configuration == Configuration::Updated && (D > 1 || settings.form == Form::Adjoint)
    {
        return Err(TotalLagrangianError::Updated);
    }
    combine(input)
}

/// Names of axes.
const AXES: [&str; 3] = ["x", "y", "z"];

/// How far from a plane particles are on it, and how far behind it none may be, in spacings.
const ON_PLANE: f64 = 1e-6;

/// Refuses a plane that does not end the bodies, and one on which the component across is not the same.
fn check_plane<const D: usize>(
    input: &TotalLagrangianInput<D>,
    mirror: &Mirror,
    on: usize,
) -> Result<(), TotalLagrangianError> {
    let (particles, axis) = (&input.particles, mirror.axis);
    let outwards = if mirror.is_upper { 1.0 } else { -1.0 };
    let beyond =
        |a: usize| outwards * (particles.position[a][axis] - mirror.place) / particles.spacing[a];
    let refuse = |a: usize, what: &'static str| TotalLagrangianError::Plane {
        axis: AXES[axis],
        what,
        id: particles.id[a],
        position: particles.position[a].iter().copied().collect(),
    };
    if let Some(a) = (0..particles.len()).find(|&a| beyond(a) > ON_PLANE) {
        return Err(refuse(a, "lies behind it"));
    }
    let held: Vec<Option<&Arc<dyn SpaceTime>>> = match &input.motion {
        Motion::Static(known) => {
            let is_across =
                |it: &&PrescribedDisplacement<D>| it.direction[axis] == it.direction.norm();
            let all = known.prescribed.iter().filter(is_across);
            last_of(particles.len(), all.map(|it| (&*it.particles, &it.value)))
        }
        _ => {
            let all = input.prescribed.iter().filter(|it| it.component == axis);
            last_of(particles.len(), all.map(|it| (&*it.particles, &it.value)))
        }
    };
    let is_same = |a: usize| match (held[a], held[on]) {
        (Some(own), Some(other)) => own.is_uniform() && Arc::ptr_eq(own, other),
        _ => false,
    };
    let mut ends = vec![false; input.group.iter().max().map_or(0, |&group| group as usize + 1)];
    let on_it = (0..particles.len()).filter(|&a| beyond(a) > -ON_PLANE);
    on_it.for_each(|a| ends[input.group[a] as usize] = true);
    let is_near = |a: usize| -beyond(a) * particles.spacing[a] < input.radius[a];
    let stray = (0..particles.len()).find(|&a| is_near(a) && !ends[input.group[a] as usize]);
    if let Some(a) = stray {
        return Err(refuse(a, "is near it, and is of a body that does not end on it, on"));
    }
    match (0..particles.len()).find(|&a| beyond(a) > -ON_PLANE && !is_same(a)) {
        Some(a) => Err(refuse(a, "is not moved across it as all of it is, the same at all places")),
        None if beyond(on) < -ON_PLANE => Err(refuse(on, "does not lie on it")),
        None => Ok(()),
    }
}

/// The value of the last condition on each particle.
fn last_of<'a>(
    count: usize,
    conditions: impl Iterator<Item = (&'a [u32], &'a Arc<dyn SpaceTime>)>,
) -> Vec<Option<&'a Arc<dyn SpaceTime>>> {
    let mut last = vec![None; count];
    for (particles, value) in conditions {
        for &a in particles {
            if let Some(own) = last.get_mut(a as usize) {
                *own = Some(value);
            }
        }
    }
    last
}

/// Refuses parts of which one does not serve the other.
fn combine<const D: usize>(input: &TotalLagrangianInput<D>) -> Result<(), TotalLagrangianError> {
    let settings = &input.settings;
    let is_solved_for = !matches!(input.motion, Motion::Explicit);
    let is_static = matches!(input.motion, Motion::Static(_));
    let is_moved = |field: &[Vector<D>]| field.iter().any(|it| it.amax() > 0.0);
    let starts_moved = is_moved(&input.displacement) || is_moved(&input.velocity);
    let is_strong = settings.form == Form::Strong;
    let is_patched = matches!(settings.gradients, Gradients::PatchConsistent { .. });
    let has_faces = matches!(
        &input.motion,
        Motion::Static(known) if !known.prescribed_faces.is_empty()
    );
    let dissipates = settings.dissipation.is_viscous() || settings.dissipation.damping > 0.0;
    let (implicit, patched, mirrors) = (Part::Implicit, Part::PatchConsistent, Part::Mirrors);
    let strong = "the strong form";
    let no_energy = "it has no energy of which forces are derivatives; use `form = \"adjoint\"`";
    let faults = [
        (is_strong && is_solved_for, (implicit, strong, no_energy)),
        (
            is_strong && is_patched,
            (patched, strong, "its ghosts make constant stress consistent; leave them out"),
        ),
        (
            is_strong && !input.pressures.is_empty(),
            (
                Part::Pressures,
                strong,
                "its edges are loaded by tractions; use `form = \"adjoint\"`",
            ),
        ),
        (
            is_strong && !input.mirrors.is_empty(),
            (mirrors, strong, "it makes its ghosts by itself; leave them out"),
        ),
        (
            is_patched && !input.mirrors.is_empty(),
            (
                patched,
                "mirror images",
                "the plane of a mirror is no boundary with an area; use `gradients = \"plain\"`",
            ),
        ),
        (
            has_faces && !input.mirrors.is_empty(),
            (
                mirrors,
                "faces of cells that are held",
                "a value on a face is one of particles without images; hold particles instead",
            ),
        ),
        (
            is_static && starts_moved,
            (
                Part::Initial,
                "statics",
                "states in equilibrium start from rest; leave out `initial`",
            ),
        ),
        (
            is_solved_for && dissipates,
            (
                Part::Dissipation,
                "implicit steps and statics",
                "their residual has no rates; use explicit steps, or an integrator that damps short periods",
            ),
        ),
    ];
    let found = faults.into_iter().find(|(is_met, _)| *is_met);
    found.map_or(Ok(()), |(_, (part, with, why))| {
        Err(TotalLagrangianError::Combination { part, with, why })
    })
}

fn check_coefficients<const D: usize>(settings: &Settings<D>) -> Result<(), TotalLagrangianError> {
    let [linear, quadratic] = settings.dissipation.artificial_viscosity;
    check_hourglass(settings.hourglass)?;
    check_coefficient("the viscosity", settings.dissipation.viscosity)?;
    check_coefficient("the linear artificial viscosity", linear)?;
    check_coefficient("the quadratic artificial viscosity", quadratic)?;
    check_coefficient("the damping", settings.dissipation.damping)
}

/// Refuses a hourglass coefficient that takes stiffness away.
pub(super) fn check_hourglass(value: f64) -> Result<(), TotalLagrangianError> {
    check_coefficient("the hourglass coefficient", value)
}

fn check_coefficient(what: &'static str, value: f64) -> Result<(), TotalLagrangianError> {
    match value >= 0.0 && value.is_finite() {
        true => Ok(()),
        false => Err(TotalLagrangianError::Coefficient { what, value }),
    }
}
