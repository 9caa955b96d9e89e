//! Particles turned into elastic solids of the dual-support formulation.

use piola_formulas::hyperelastic::Reduced;

use super::bodies::{self, BodyReport};
use super::loads::{self, LoadedSurface};
use super::selections::Held;
use super::{Built, initial, integrator_kind, kernel, probes, selections};
use crate::Vector;
use crate::case::diagnostics::Problem;
use crate::case::model::{self, Case, GradientKind, SupportSize};
use crate::geometry::Particles;
use crate::neighbors::{Domain, NeighborError, spatial_order};
use crate::operators::{DirectedSupport, DualGradient, Face, Trace, lattice_areas, nearest_radii};
use crate::schemes::dual_support::{
    DualSupport, DualSupportError, DualSupportInput, Gradients, Material, Motion, Settings,
    StaticsError, StaticsInput, free_to_move,
};
use crate::schemes::{InputError, Scheme};
use crate::solve::Newton;

/// Builds the scheme `dual_support`.
pub(super) fn build<const D: usize>(
    case: &Case,
    settings: &model::DualSupport,
    mut particles: Particles<D>,
    reports: Vec<BodyReport>,
    domain: Domain<D>,
) -> Result<(Box<dyn Scheme>, Built), Vec<Problem>> {
    let kernel = kernel(case, &settings.kernel)?;
    if settings.weights == model::Weights::Volume {
        particles.weight.clone_from(&particles.volume);
    }
    let mut areas = areas(case, &mut particles, &domain)?;
    let place = settings.support.place;
    let refuse = |error: NeighborError| {
        vec![case.problem_at(place, error.to_string(), "with these supports", None)]
    };
    let radii = |particles: &Particles<D>| match *settings.support {
        SupportSize::Spacings(ratio) => {
            Ok(particles.spacing.iter().map(|spacing| ratio * spacing).collect::<Vec<_>>())
        }
        SupportSize::Neighbors(count) => nearest_radii(particles, count, &domain),
    };
    let widest = radii(&particles).map_err(refuse)?.into_iter().fold(0.0, f64::max);
    let order = spatial_order(&particles.position, widest).map_err(refuse)?;
    particles.reorder(&order);
    if let Some(areas) = &mut areas {
        *areas = order.iter().map(|&number| areas[number as usize]).collect();
    }
    let radius = radii(&particles).map_err(refuse)?;
    let support = DirectedSupport::new(&particles, kernel, radius, domain).map_err(refuse)?;
    let rows = 0..particles.len();
    let poorly_supported =
        rows.filter(|&a| support.list.row(a).len() < D).map(|a| a as u32).collect();
    let neighbors = support.list.statistics();

    let trace = trace(case, &particles, &support)?;
    if let (Some(areas), Some(trace)) = (&mut areas, &trace) {
        let traced = trace.areas(particles.len());
        areas.iter_mut().zip(traced).for_each(|(area, more)| *area += more);
    }

    let mut problems = Vec::new();
    let probes = probes::probes(case, &particles, &mut problems);
    let lines = probes::lines(case, &particles);
    let usual = Newton::default();
    let newton = Newton { tolerance: case.time.tolerance.unwrap_or(usual.tolerance), ..usual };
    let (prescribed, motion) = match integrator_kind(case) {
        kind if kind.is_static() => {
            let Held { particles: prescribed, faces: prescribed_faces, ties } =
                selections::held(case, &particles, &mut problems);
            let input = StaticsInput {
                prescribed,
                prescribed_faces,
                ties,
                trace: trace.clone(),
                method: case.time.linear_solver,
                newton,
                ..StaticsInput::default()
            };
            (Vec::new(), Motion::Static(Box::new(input)))
        }
        _ => {
            let motion = match case.time.rule {
                Some(_) => Motion::Implicit(case.time.linear_solver, newton),
                None => Motion::Explicit,
            };
            (selections::prescribed(case, &particles, &mut problems), motion)
        }
    };
    let known = || {
        areas.clone().ok_or_else(|| {
            "a load on a surface needs the areas of the particles, which are not known of points from a file"
                .to_owned()
        })
    };
    let surface = LoadedSurface::new(case, &particles, &support.domain, trace.as_ref(), known);
    let tractions = surface.tractions(&mut problems);
    let pressures = surface.pressures(&mut problems);
    let materials = materials(case, &mut problems);
    let (gradients, warnings) = gradients(case, settings, areas.clone(), &mut problems);
    if !problems.is_empty() {
        return Err(problems);
    }
    let usual = if gradients == Gradients::Plain { 1.0 } else { 0.1 };
    let velocity = initial(case, &particles).velocity;
    let scheme = DualSupport::new(DualSupportInput {
        settings: Settings { gradients, hourglass: settings.hourglass.unwrap_or(usual) },
        body_forces: loads::body_forces(case),
        particles,
        support,
        materials,
        velocity,
        tractions,
        pressures,
        prescribed,
        motion,
    });
    let scheme = scheme.map_err(|error| {
        let (place, label) = match &error {
            DualSupportError::Input(InputError::Velocity { .. }) => {
                (case.bodies[0].name.place, "initial values of a body")
            }
            DualSupportError::Statics(StaticsError::Free { .. }) => {
                (case.time.integrator.place, "statics needs a body that is held")
            }
            DualSupportError::Statics(_) => (case.time.integrator.place, "with this integrator"),
            _ => (place, "with these supports"),
        };
        let message = match &error {
            DualSupportError::Statics(StaticsError::Free { body, part, motion }) => {
                let name = case.bodies[*body as usize].name.value.as_str();
                free_to_move(&format!("the body `{name}`"), part.as_ref(), motion)
            }
            error => error.to_string(),
        };
        vec![case.problem_at(place, message, label, None)]
    })?;
    Ok((
        Box::new(scheme),
        Built { probes, lines, bodies: reports, neighbors, poorly_supported, warnings },
    ))
}

/// The boundary as centres of cells see it, where a body has such particles.
fn trace<const D: usize>(
    case: &Case,
    particles: &Particles<D>,
    support: &DirectedSupport<D>,
) -> Result<Option<Trace<D>>, Vec<Problem>> {
    let of_cells = particles.surface.faces.iter().filter(|face| !face.is_of_nodes());
    let faces: Vec<Face<D>> = of_cells
        .map(|face| Face { owner: face.particles[0], place: face.place, area: face.area })
        .collect();
    if faces.is_empty() {
        return Ok(None);
    }
    let plain = DualGradient::plain(particles, support).map_err(|error| {
        vec![case.problem_at(case.scheme.place, error.to_string(), "with these supports", None)]
    })?;
    Ok(Some(Trace::new(faces, particles, support, &plain)))
}

/// The boundary area vectors of all particles in m^(D-1), of the lattices before they are displaced;
/// particles that have one go back to their site. Of meshes those of nodes, and zero of cells, which
/// get theirs from the trace. `None` if there is a body of points.
pub(super) fn areas<const D: usize>(
    case: &Case,
    particles: &mut Particles<D>,
    domain: &Domain<D>,
) -> Result<Option<Vec<Vector<D>>>, Vec<Problem>> {
    let mut all = Vec::with_capacity(particles.len());
    let of_meshes = particles.surface.areas(particles.len());
    for (number, body) in (0u32..).zip(&case.bodies) {
        match body.shape.value {
            model::Shape::Points { .. } => return Ok(None),
            model::Shape::Mesh { .. } => {
                let own = particles.body.iter().filter(|&&other| other == number).count();
                all.extend(&of_meshes[all.len()..][..own]);
                continue;
            }
            _ => (),
        }
        let still = bodies::lattice(case, body, domain, 0.0).map_err(|problem| vec![problem])?;
        let found = lattice_areas(&still.particles, &still.actual_spacing, domain);
        let areas = found.map_err(|error| {
            let label = format!("body `{}`", *body.name);
            vec![case.problem_at(body.shape.place, error.to_string(), label, None)]
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
    settings: &model::DualSupport,
    areas: Option<Vec<Vector<D>>>,
    problems: &mut Vec<Problem>,
) -> (Gradients<D>, Vec<String>) {
    let wanted = settings.gradients.as_ref();
    match (wanted.map(|kind| kind.value), areas) {
        (Some(GradientKind::Plain), _) => (Gradients::Plain, Vec::new()),
        (_, Some(areas)) => (Gradients::PatchConsistent { areas }, Vec::new()),
        (None, None) => {
            let warning = "gradients are plain, as the boundary areas of points from a file are not \
                           known: a constant stress is not in equilibrium there";
            (Gradients::Plain, vec![warning.to_owned()])
        }
        (Some(GradientKind::PatchConsistent), None) => {
            let place = wanted.map_or(case.scheme.place, |kind| kind.place);
            let message = "the boundary areas of points from a file are not known";
            let help = "use `gradients = \"plain\"`, or shapes that a lattice fills".to_owned();
            problems.push(case.problem_at(place, message, "needs boundary areas", Some(help)));
            (Gradients::Plain, Vec::new())
        }
    }
}

pub(super) fn materials<const D: usize>(
    case: &Case,
    problems: &mut Vec<Problem>,
) -> Vec<Material<D>> {
    let mut materials = Vec::new();
    for body in &case.bodies {
        // The reader of cases has refused others for this scheme.
        let model::Material::Hyperelastic { density, law, plane } = body.material.value else {
            continue;
        };
        match Reduced::new(law, plane.stress_state(case.dimension)) {
            Ok(law) => materials.push(Material { density, law }),
            Err(error) => {
                let place = body.material.place;
                problems.push(case.problem_at(place, error.to_string(), "this material", None));
            }
        }
    }
    materials
}
