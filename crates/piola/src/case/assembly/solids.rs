//! Particles turned into total Lagrangian solids.

use piola_formulas::hyperelastic::Reduced;

use super::bodies::{self, BodyReport};
use super::joined::Joined;
use super::loads::{self, LoadedSurface};
use super::mirrors::{holes, mirrors, whole_weights};
use super::overlap::touching;
use super::selections::Held;
use super::start::at_start;
use super::{Built, integrator_kind, kernel, probes, row_statistics, selections};
use crate::Vector;
use crate::boundaries::PrescribedVelocity;
use crate::case::diagnostics::Problem;
use crate::case::model::{self, Case, GradientKind, SupportSize};
use crate::case::source::Place;
use crate::geometry::Particles;
use crate::neighbors::{Domain, NeighborError, spatial_order};
use crate::operators::{
    Cover, DirectedSupport, DualGradient, Face, Mirror, OperatorError, Trace, lattice_areas,
    nearest_radii,
};
use crate::schemes::total_lagrangian::{
    Form, Gradients, Material, Motion, Part, Settings, StaticsError, StaticsInput, TotalLagrangian,
    TotalLagrangianError, TotalLagrangianInput, free_to_move,
};
use crate::schemes::{InputError, Scheme, boxed};
use crate::solve::Newton;

/// Builds a total Lagrangian solid.
pub(super) fn build<const D: usize>(
    case: &Case,
    settings: &model::TotalLagrangian,
    mut particles: Particles<D>,
    reports: Vec<BodyReport>,
    domain: Domain<D>,
) -> Result<(Box<dyn Scheme>, Built), Vec<Problem>> {
    let kernel = kernel(case, &settings.kernel)?;
    if settings.weights == model::Weights::Volume {
        particles.weight.clone_from(&particles.volume);
    }
    let mut problems = Vec::new();
    let materials = materials::<D>(case, &mut problems);
    if !problems.is_empty() {
        return Err(problems);
    }
    let mut areas = areas(case, &mut particles, &domain)?;
    let place = settings.support.place;
    let refuse = |error: NeighborError| {
        vec![case.problem_at(place, error.to_string(), "with these supports", None)]
    };
    let are_rigid = (0..case.bodies.len()).map(|body| selections::is_rigid(case, body)).collect();
    let joined = match settings.joined {
        true => Joined::find(&particles, &domain, are_rigid).map_err(refuse)?,
        false => Joined::none(are_rigid),
    };
    joined.merge(&mut particles, areas.as_mut());
    let radii = |particles: &Particles<D>| match *settings.support {
        SupportSize::Spacings(ratio) => {
            Ok(particles.spacing.iter().map(|spacing| ratio * spacing).collect::<Vec<_>>())
        }
        SupportSize::Neighbors(count) => {
            nearest_radii(particles, &joined.groups(particles), count, &domain)
        }
    };
    let widest = radii(&particles).map_err(refuse)?.into_iter().fold(0.0, f64::max);
    let order = spatial_order(&particles.position, widest).map_err(refuse)?;
    particles.reorder(&order);
    if let Some(areas) = &mut areas {
        *areas = order.iter().map(|&number| areas[number as usize]).collect();
    }
    let radius = radii(&particles).map_err(refuse)?;
    let (mixtures, mixture) = joined.mixtures(&particles, &materials);
    let group = joined.groups(&particles);
    let (images, radii) = (&[], &*radius);
    let cover =
        Cover { particles: &particles, group: &group, images, kernel, radius: radii, domain };
    let trace = trace(case, &cover)?;
    if let (Some(areas), Some(trace)) = (&mut areas, &trace) {
        let traced = trace.areas(particles.len());
        areas.iter_mut().zip(traced).for_each(|(area, more)| *area += more);
    }

    let probes = probes::probes(case, &particles, &mut problems);
    let lines = probes::lines(case, &particles);
    let (prescribed, motion) = motion(case, &particles, trace.as_ref(), &mut problems);
    let mirrors = mirrors(case, *settings.form, &particles, &mut problems);
    let known = || {
        areas.clone().ok_or_else(|| {
            "a load on a surface needs the areas of the particles, which are known for lattices and meshes only"
                .to_owned()
        })
    };
    if let (SupportSize::Neighbors(_), false) = (*settings.support, mirrors.is_empty()) {
        let message = "`neighbors` counts none beyond a mirror";
        let help = Some("use `support`".to_owned());
        problems.push(case.problem_at(place, message, "not with a mirror", help));
    }
    let rigid = selections::rigid(case, &particles, &joined);
    let surface = LoadedSurface::new(case, &particles, &domain, trace.as_ref(), known);
    let tractions = surface.tractions(&mut problems);
    let pressures = surface.pressures(&mut problems);
    let springs = surface.springs(&mut problems);
    let gradients = gradients(case, settings, &mirrors, areas.clone(), &mut problems);
    if !problems.is_empty() {
        return Err(problems);
    }
    let (gradients, mut warnings) = gradients;
    let remedy = "join them with `joined = true` and particles at the same positions, or by the shape `union`";
    let share = |one, other| joined.share(one, other);
    warnings.extend(touching(case, &domain, &particles, &group, (share, remedy)));
    if settings.weights == model::Weights::Volume {
        whole_weights(&mut particles, &mirrors);
    }
    // On lattices plain gradients need no more than others.
    let is_rough = !particles.surface.faces.is_empty()
        || case.bodies.iter().any(|body| body.shape.is_points());
    let is_plain = gradients == Gradients::Plain;
    let scheme = TotalLagrangian::new(TotalLagrangianInput {
        description: settings.preset.description(),
        settings: Settings {
            form: *settings.form,
            configuration: settings.configuration,
            hourglass: settings.hourglass.unwrap_or(settings.preset.hourglass(is_plain, is_rough)),
            tractions: settings.tractions.unwrap_or(settings.preset.tractions(is_plain)),
            dissipation: *settings.dissipation,
            gradients,
        },
        displacement: at_start(case, &reports, &particles, |initial| &initial.displacement),
        velocity: at_start(case, &reports, &particles, |initial| &initial.velocity),
        body_forces: loads::body_forces(case),
        holes: holes(case),
        kernel,
        radius,
        group,
        domain,
        mixtures,
        mixture,
        particles,
        tractions,
        pressures,
        springs,
        prescribed,
        mirrors,
        rigid,
        motion,
    });
    let scheme = scheme.map_err(|error| vec![refused(case, settings, &error)])?;
    let sizes = (0..scheme.particle_count()).map(|a| (a as u32, scheme.neighbors(a)));
    let (neighbors, poorly_supported) = row_statistics(D, sizes);
    Ok((
        boxed(scheme),
        Built {
            probes,
            lines,
            bodies: reports,
            neighbors,
            poorly_supported,
            warnings,
            notes: Vec::new(),
        },
    ))
}

/// How states follow each other, with the velocities that are prescribed where something moves.
fn motion<const D: usize>(
    case: &Case,
    particles: &Particles<D>,
    trace: Option<&Trace<D>>,
    problems: &mut Vec<Problem>,
) -> (Vec<PrescribedVelocity>, Motion<D>) {
    let usual = Newton::default();
    let newton = Newton { tolerance: case.time.tolerance.unwrap_or(usual.tolerance), ..usual };
    let method = case.time.linear_solver;
    if integrator_kind(case).is_static() {
        let Held { particles: prescribed, faces: prescribed_faces, ties } =
            selections::held(case, particles, problems);
        let trace = trace.cloned();
        let input = StaticsInput {
            prescribed,
            prescribed_faces,
            ties,
            trace,
            method,
            newton,
            ..StaticsInput::default()
        };
        return (Vec::new(), Motion::Static(Box::new(input)));
    }
    let motion = match case.time.rule {
        Some(_) => Motion::Implicit(method, newton),
        None => Motion::Explicit,
    };
    (selections::prescribed(case, particles, problems), motion)
}

/// Where and what of the case an error is about.
fn refused(
    case: &Case,
    settings: &model::TotalLagrangian,
    error: &TotalLagrangianError,
) -> Problem {
    let (scheme, integrator) = (case.scheme.place, case.time.integrator.place);
    let mirror = || {
        let found = case.boundaries.iter().find_map(|it| it.mirror.as_ref());
        found.map_or(scheme, |mirror| mirror.place)
    };
    let is_spring = |load: &&model::Load| matches!(load.kind, model::LoadKind::Spring { .. });
    let spring = case.loads.iter().find(is_spring).and_then(|load| load.name.as_ref());
    let spring = spring.map_or(integrator, |name| name.place);
    let of_part = |part: Part| match part {
        Part::Implicit => (integrator, "this integrator"),
        Part::PatchConsistent => {
            (settings.gradients.as_ref().map_or(scheme, |it| it.place), "these gradients")
        }
        Part::Mirrors => (mirror(), "this mirror"),
        Part::Pressures => (settings.form.place, "this form"),
        Part::Initial => (case.bodies[0].name.place, "initial values of a body"),
        Part::Dissipation => (settings.dissipation.place, "with this integrator"),
        Part::Springs => (spring, "this spring"),
        Part::Rigid => (rigid_body(case, None), "this body"),
    };
    let (place, label) = match error {
        TotalLagrangianError::Combination { part, .. } => of_part(*part),
        TotalLagrangianError::Plane { .. } | TotalLagrangianError::TwoPlanes { .. } => {
            (mirror(), "this mirror")
        }
        TotalLagrangianError::Input(InputError::Displacement { .. }) => {
            (case.bodies[0].name.place, "initial values of a body")
        }
        TotalLagrangianError::Input(InputError::Velocity { .. }) => {
            (case.bodies[0].name.place, "initial values of a body")
        }
        TotalLagrangianError::Rigid { name, .. } => (rigid_body(case, Some(name)), "this body"),
        TotalLagrangianError::Statics(StaticsError::Free { .. }) => {
            (integrator, "statics needs a body that is held")
        }
        TotalLagrangianError::Statics(_) => (integrator, "with this integrator"),
        TotalLagrangianError::Operator(_) => (settings.support.place, "with these supports"),
        _ => (scheme, "with these settings"),
    };
    let message = match error {
        TotalLagrangianError::Statics(StaticsError::Free { body, part, motion }) => {
            let name = case.bodies[*body as usize].name.value.as_str();
            free_to_move(&format!("the body `{name}`"), part.as_ref(), motion)
        }
        error => error.to_string(),
    };
    case.problem_at(place, message, label, None)
}

/// Where a rigid body is described: that of a name, or the first.
fn rigid_body(case: &Case, name: Option<&String>) -> Place {
    let is_it = |body: &&model::Body| match name {
        Some(name) => *body.name == *name,
        None => matches!(body.material.value, model::Material::Rigid { .. }),
    };
    case.bodies.iter().find(is_it).map_or(case.scheme.place, |body| body.material.place)
}

/// The boundary as centres of cells see it, where a body has such particles.
fn trace<const D: usize>(
    case: &Case,
    cover: &Cover<'_, D>,
) -> Result<Option<Trace<D>>, Vec<Problem>> {
    let particles = cover.particles;
    let of_cells = particles.surface.faces.iter().filter(|face| !face.is_of_nodes());
    let faces: Vec<Face<D>> = of_cells
        .map(|face| Face { owner: face.particles[0], place: face.place, area: face.area })
        .collect();
    if faces.is_empty() {
        return Ok(None);
    }
    let refuse = |error: OperatorError| {
        vec![case.problem_at(case.scheme.place, error.to_string(), "with these supports", None)]
    };
    let support = DirectedSupport::of(cover).map_err(|error| refuse(error.into()))?;
    let plain = DualGradient::of(cover, &support).map_err(refuse)?;
    Ok(Some(Trace::new(faces, particles, &support, &plain)))
}

/// The boundary area vectors of all particles in m^(D-1), of the lattices before they are displaced;
/// particles that have one go back to their site. Of meshes those of nodes, and zero of cells, which
/// get theirs from the trace. `None` if there is a body of points, of concentric layers or of packed particles.
fn areas<const D: usize>(
    case: &Case,
    particles: &mut Particles<D>,
    domain: &Domain<D>,
) -> Result<Option<Vec<Vector<D>>>, Vec<Problem>> {
    let mut all = Vec::with_capacity(particles.len());
    let of_meshes = particles.surface.areas(particles.len());
    for (number, body) in (0u32..).zip(&case.bodies) {
        match body.shape.value {
            model::Shape::Points { .. } | model::Shape::Cloud { .. } => return Ok(None),
            model::Shape::Mesh { .. } => {
                let own = particles.body.iter().filter(|&&other| other == number).count();
                all.extend(&of_meshes[all.len()..][..own]);
                continue;
            }
            _ if matches!(
                body.lattice.kind,
                model::LatticeKind::Concentric | model::LatticeKind::Packed
            ) =>
            {
                return Ok(None);
            }
            _ => (),
        }
        let still = bodies::lattice(case, body, domain, 0.0).map_err(|problem| vec![problem])?;
        let found = lattice_areas(&still.particles, &still.actual_spacing, &still.rotation, domain);
        let areas = found.map_err(|error| {
            let label = format!("body `{}`", *body.name);
            let help =
                "cut sharp corners off: the particle there needs neighbours in all directions";
            vec![case.problem_at(body.shape.place, error.to_string(), label, Some(help.into()))]
        })?;
        for (area, site) in areas.iter().zip(&still.particles.position) {
            if area.norm_squared() > 0.0 {
                particles.position[all.len()] = *site;
            }
            all.push(*area);
        }
    }
    Ok(Some(all))
}

/// The coefficients that the case asks for, or the better ones that there are.
fn gradients<const D: usize>(
    case: &Case,
    settings: &model::TotalLagrangian,
    mirrors: &[(Mirror, u32)],
    areas: Option<Vec<Vector<D>>>,
    problems: &mut Vec<Problem>,
) -> (Gradients<D>, Vec<String>) {
    let wanted = settings.gradients.as_ref();
    let is_plain =
        settings.preset.is_plain() || *settings.form == Form::Strong || !mirrors.is_empty();
    match (wanted.map(|kind| kind.value), areas) {
        (Some(GradientKind::Plain), _) => (Gradients::Plain, Vec::new()),
        (None, _) if is_plain => (Gradients::Plain, Vec::new()),
        (_, Some(areas)) => (Gradients::PatchConsistent { areas }, Vec::new()),
        (None, None) => {
            let warning = "gradients are plain, as boundary areas are known for lattices and meshes only: a constant stress is not in equilibrium there";
            (Gradients::Plain, vec![warning.to_owned()])
        }
        (Some(GradientKind::PatchConsistent), None) => {
            let place = wanted.map_or(case.scheme.place, |kind| kind.place);
            let message = "boundary areas are known of bodies on lattices and from meshes alone";
            let help = "use `gradients = \"plain\"`, or shapes that a lattice fills".to_owned();
            problems.push(case.problem_at(place, message, "needs boundary areas", Some(help)));
            (Gradients::Plain, Vec::new())
        }
    }
}

fn materials<const D: usize>(case: &Case, problems: &mut Vec<Problem>) -> Vec<Material<D>> {
    let mut materials = Vec::new();
    for body in &case.bodies {
        // The reader of cases has refused others for this scheme.
        let (density, law, plane) = match &body.material.value {
            model::Material::Hyperelastic { density, law, plane, .. } => (*density, law, *plane),
            model::Material::Rigid { density } => {
                materials.push(Material::rigid(*density));
                continue;
            }
            _ => continue,
        };
        match Reduced::new(law.clone(), plane.stress_state(case.dimension)) {
            Ok(law) => materials.push(Material { density, law }),
            Err(error) => {
                let place = body.material.place;
                problems.push(case.problem_at(place, error.to_string(), "this material", None));
            }
        }
    }
    materials
}
