//! What a body cannot be built from: arrays that do not fit together, impossible values, planes that end nothing, and
//! parts of which one does not serve the other.

use std::sync::Arc;

use super::{
    Configuration, Form, Gradients, Motion, Part, Settings, TotalLagrangianError,
    TotalLagrangianInput, rigid,
};
use crate::Vector;
use crate::boundaries::{PrescribedDisplacement, SpaceTime};
use crate::operators::Mirror;
use crate::schemes::input::{
    check_conditions, check_index, check_lengths, check_particles, check_pressure, check_selected,
};

/// Refuses arrays that do not fit together, impossible values, and parts that do not serve each other.
pub(super) fn check<const D: usize>(
    input: &TotalLagrangianInput<D>,
) -> Result<(), TotalLagrangianError> {
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
    let springs = input.springs.iter();
    springs.clone().try_for_each(|it| check_selected(&it.name, &it.particles, count))?;
    for spring in springs {
        check_coefficient("the stiffness of a spring", spring.stiffness)?;
        check_coefficient("the damping of a spring", spring.damping)?;
        check_coefficient("the length of a spring", spring.length)?;
    }
    for (mirror, particle) in &input.mirrors {
        check_index(|| "a mirror: particle".into(), *particle as usize, count)?;
        check_index(|| "a mirror: axis".into(), mirror.axis, D)?;
    }
    rigid::check(&input.rigid, &input.particles, input.domain.periodic())?;
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
    let has_rigid = !input.rigid.is_empty();
    let own = |a: &u32| *a as usize;
    let all_rigid = || input.rigid.iter().flat_map(|body| body.particles.iter().map(own));
    let is_displaced = all_rigid().any(|a| input.displacement[a].amax() > 0.0);
    let is_held = has_rigid && {
        let mut is_rigid = vec![false; input.particles.len()];
        all_rigid().for_each(|a| is_rigid[a] = true);
        input.prescribed.iter().any(|it| it.particles.iter().any(|a| is_rigid[own(a)]))
    };
    let strong = "the strong form";
    let no_energy = "its forces do not derive from an energy; use `form = \"adjoint\"`";
    let faults = [
        (is_strong && is_solved_for, (implicit, strong, no_energy)),
        (
            !input.springs.is_empty() && is_solved_for,
            (
                Part::Springs,
                "implicit steps and statics",
                "their tangent has no springs; use explicit steps",
            ),
        ),
        (
            has_rigid && is_solved_for,
            (
                Part::Rigid,
                "implicit steps and statics",
                "it is moved by kicks; use `kick_drift_kick`",
            ),
        ),
        (
            has_rigid && is_strong,
            (Part::Rigid, strong, "it has an edge of its own there; use `form = \"adjoint\"`"),
        ),
        (
            has_rigid && !input.mirrors.is_empty(),
            (Part::Rigid, "mirror images", "half of it moves as half a body; model all of it"),
        ),
        (is_displaced, (Part::Rigid, "an initial displacement", "place it where it starts")),
        (
            is_held,
            (Part::Rigid, "a velocity of a part of it", "what is prescribed moves all of it"),
        ),
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
            (mirrors, strong, "it creates its own ghosts; leave them out"),
        ),
        (
            is_patched && !input.mirrors.is_empty(),
            (
                patched,
                "mirror images",
                "the plane of a mirror is not a boundary with an area; use `gradients = \"plain\"`",
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
    check_coefficient("the viscosity", settings.dissipation.viscosity)?;
    check_coefficient("the linear artificial viscosity", linear)?;
    check_coefficient("the quadratic artificial viscosity", quadratic)?;
    check_coefficient("the damping", settings.dissipation.damping)
}

/// Refuses a coefficient that is negative or no number.
pub(super) fn check_coefficient(
    what: &'static str,
    value: f64,
) -> Result<(), TotalLagrangianError> {
    match value >= 0.0 && value.is_finite() {
        true => Ok(()),
        false => Err(TotalLagrangianError::Coefficient { what, value }),
    }
}
