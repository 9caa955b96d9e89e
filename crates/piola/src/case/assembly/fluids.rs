//! Particles turned into a weakly compressible fluid between walls.

use super::bodies::{self, BodyReport};
use super::start;
use super::{
    Built, kernel, levels, loads, openings, probes, row_sizes, row_statistics, selections, tanks,
    walls,
};
use crate::Vector;
use crate::boundaries::PrescribedVelocity;
use crate::case::diagnostics::Problem;
use crate::case::model::{self, Case};
use crate::case::plan::counted;
use crate::coordinates;
use crate::geometry::{Faces, Particles, ball_volume};
use crate::neighbors::{Domain, spatial_order};
use crate::observe::{Line, Probe};
use crate::schemes::transport_velocity::{
    Continuum, Fluid, Guard, Hypoelastic, Nesting, OpenBoundaries, Solid, SolidsInput,
    TransportVelocity, TransportVelocityError, TransportVelocityInput, Wall, WeaklyCompressible,
};
use crate::schemes::{Initial, Scheme, boxed};

/// Builds the scheme `transport_velocity`.
pub(super) fn build<const D: usize>(
    case: &Case,
    settings: &model::TransportVelocity,
    particles: Particles<D>,
    reports: Vec<BodyReport>,
    domain: Domain<D>,
) -> Result<(Box<dyn Scheme>, Built), Vec<Problem>> {
    if !settings.refine.is_empty() {
        return levels::build(case, settings, particles, reports, domain);
    }
    let alone = (Nesting::default(), 0);
    let prepared = prepare(case, settings, particles, reports, domain, alone)?;
    if let Some(materials) = materials(case) {
        let spacing = prepared.input.particles.spacing.first().copied().unwrap_or_default();
        let solids = SolidsInput {
            materials,
            contact: settings.contact,
            self_contact: settings.self_contact.as_ref().map(|distance| **distance * spacing),
            corrected: settings.corrected_gradients,
            held: prepared.held.clone(),
        };
        let (solids, built) = prepared.finish::<Hypoelastic<D>>(case, settings, solids)?;
        return Ok((boxed(solids), built));
    }
    let (fluid, built) = prepared.finish::<WeaklyCompressible<D>>(case, settings, fluid(case)?)?;
    Ok((boxed(fluid), built))
}

/// Builds a fluid of that scheme.
pub(super) fn build_fluid<const D: usize>(
    case: &Case,
    settings: &model::TransportVelocity,
    particles: Particles<D>,
    reports: Vec<BodyReport>,
    domain: Domain<D>,
) -> Result<(TransportVelocity<D>, Built), Vec<Problem>> {
    let alone = (Nesting::default(), 0);
    let prepared = prepare(case, settings, particles, reports, domain, alone)?;
    prepared.finish(case, settings, fluid(case)?)
}

/// What part of the largest spacing others may be below it: lattices fit their shapes, and their spacings become a
/// little different. All particles then count as spaced by the largest; masses are those of their own cells.
const ALIKE: f64 = 0.05;

/// All but the matter, with what is known of the rest.
pub(super) struct Prepared<const D: usize> {
    input: TransportVelocityInput<D>,
    held: Vec<PrescribedVelocity>,
    probes: Vec<Probe>,
    lines: Vec<Line>,
    reports: Vec<BodyReport>,
    warnings: Vec<String>,
    /// Whether some of them are of walls.
    has_poor_walls: bool,
}

/// All but the matter of a fluid or of solids, of a fluid at several resolutions as it is nested among the others, with how
/// many particles wait in it.
pub(super) fn prepare<const D: usize>(
    case: &Case,
    settings: &model::TransportVelocity,
    mut particles: Particles<D>,
    reports: Vec<BodyReport>,
    domain: Domain<D>,
    (nesting, reserve): (Nesting<D>, usize),
) -> Result<Prepared<D>, Vec<Problem>> {
    let kernel = kernel(case, &settings.kernel)?;
    let spacing = particles.spacing.iter().copied().fold(0.0, f64::max);
    if particles.spacing.iter().all(|own| *own >= (1.0 - ALIKE) * spacing) {
        particles.spacing.fill(spacing);
    }
    let smoothing_length = *settings.smoothing_length * spacing;
    let support = kernel.support_radius(smoothing_length);
    let first_twin = walls::double_thin(case, &mut particles, support)?;
    let order = spatial_order(&particles.position, support);
    let place = settings.smoothing_length.place;
    particles.reorder(&order.map_err(|error| {
        vec![case.problem_at(place, error.to_string(), "with this smoothing length", None)]
    })?);
    let (mut open, mut warnings) = openings::open::<D>(case, settings, &mut particles, support)?;
    let of_openings = warnings.len();
    let counts = nesting.clone();
    nest(case, (nesting, reserve), &mut open, &mut particles);
    let (faces, shape) = walls::faces(case, &particles, (first_twin, support))?;
    let mut problems = Vec::new();
    let probes = probes::probes(case, &particles, &mut problems);
    let lines = probes::lines(case, &particles);
    let motion = match counts.own {
        // What moves is none of the finer levels, and what selects nothing has been told of the coarsest.
        Some(_) => Vec::new(),
        None => selections::prescribed(case, &particles, &mut problems),
    };
    if !problems.is_empty() {
        return Err(problems);
    }
    let walls = walls::walls(case);
    let (motion, held) = match materials(case) {
        Some(_) => split(motion, &particles, &walls),
        None => (motion, Vec::new()),
    };
    let no_face = Faces::default();
    if faces
        .iter()
        .zip(&particles.body)
        .any(|(faces, &body)| walls.iter().any(|wall| wall.body == body) && *faces == no_face)
    {
        warnings.push(
            "some wall particles have no path to the fluid inside the bounding box of all bodies, and so no \
             normal: they do not hold fluid back"
                .into(),
        );
    }
    if let Some(shape) = &shape {
        let counts = |place: &Vector<D>| counts.counts(place);
        warnings.extend(tanks::warnings(case, shape, &particles, (&faces, counts), support));
        warnings.extend(walls::behind_layers(case, &particles, support)?);
    }
    let has_poor_walls = warnings.len() > of_openings;
    let initial = start::initial(case, &reports, &particles);
    if materials(case).is_none() {
        warnings.extend(compression(&fluid(case)?, &initial));
    }
    let sliding = walls::sliding(case, &particles);
    let input = TransportVelocityInput {
        domain,
        kernel,
        smoothing_length,
        settings: settings.settings,
        initial,
        walls,
        faces,
        motion,
        sliding,
        body_forces: loads::body_forces(case),
        open,
        damping: settings.damping.as_ref().map(|rate| selections::function(rate)),
        particles,
    };
    Ok(Prepared { input, held, probes, lines, reports, warnings, has_poor_walls })
}

/// Nests a fluid among others of another resolution, with particles in reserve behind all others, each of a whole cell.
fn nest<const D: usize>(
    case: &Case,
    (nesting, more): (Nesting<D>, usize),
    open: &mut OpenBoundaries<D>,
    particles: &mut Particles<D>,
) {
    if nesting == Nesting::default() {
        return;
    }
    let is_fluid = |&a: &usize| {
        let body = &case.bodies[particles.body[a] as usize];
        body.wall.is_none() && body.opening.is_none()
    };
    if let Some(model) = (0..particles.len()).find(is_fluid) {
        let (first, body) = (particles.len(), particles.body[model]);
        particles.reserve(model, body, more);
        let whole = particles.weight[model];
        particles.volume[first..].fill(whole);
        open.reserve += more;
    }
    open.nesting = Some(nesting);
}

impl<const D: usize> Prepared<D> {
    /// The particles.
    pub fn particles(&self) -> &Particles<D> {
        &self.input.particles
    }

    /// Binds it to matter.
    pub fn finish<M: Continuum<D>>(
        self,
        case: &Case,
        settings: &model::TransportVelocity,
        matter: M::Input,
    ) -> Result<(TransportVelocity<D, M>, Built), Vec<Problem>> {
        let Self { input, probes, lines, reports: bodies, mut warnings, has_poor_walls, .. } = self;
        let place = settings.smoothing_length.place;
        let support = input.kernel.support_radius(input.smoothing_length);
        let full =
            ball_volume(D, support / input.particles.spacing.first().copied().unwrap_or(1.0));
        // The band of a finer region ends where no particle is.
        let is_band = input.open.nesting.as_ref().is_some_and(|it| it.own.is_some());
        let refuse = |error: TransportVelocityError| {
            let (place, label) = match &error {
                TransportVelocityError::Start { .. } => {
                    (case.bodies[0].name.place, "initial values of a body")
                }
                TransportVelocityError::Damping { .. } => {
                    (settings.damping.as_ref().map_or(place, |it| it.place), "this rate")
                }
                TransportVelocityError::SelfContact { .. } => {
                    (settings.self_contact.as_ref().map_or(place, |it| it.place), "make it larger")
                }
                TransportVelocityError::Spacing { id, .. } => {
                    return vec![refuse_uneven(case, &bodies, *id, &error)];
                }
                _ => (place, "with this smoothing length"),
            };
            vec![case.problem_at(place, error.to_string(), label, None)]
        };
        let mut scheme = TransportVelocity::<D, M>::new(input, matter).map_err(refuse)?;
        scheme.guard(Guard {
            bodies: case.bodies.iter().map(|body| body.name.value.clone()).collect(),
            removes: settings.removes_escaped,
        });
        // Particles deep in a wall may be alone.
        let of_fluid = row_sizes(&scheme).filter(|(a, _)| !scheme.is_wall(*a));
        let (neighbors, poorly_supported) = row_statistics(D, of_fluid);
        // Walls that are too thin have a warning of their own.
        if materials(case).is_none()
            && !settings.settings.free_surface
            && !is_band
            && !has_poor_walls
        {
            warnings.extend(open_end(&scheme, full));
        }
        Ok((
            scheme,
            Built {
                probes,
                lines,
                bodies,
                neighbors,
                poorly_supported,
                warnings,
                notes: Vec::new(),
            },
        ))
    }
}

/// A body with a particle, by its number in the order of creation, whose spacing differs from that of the others.
fn refuse_uneven(
    case: &Case,
    reports: &[BodyReport],
    id: u32,
    error: &TransportVelocityError,
) -> Problem {
    let mut end = 0;
    let number = reports.iter().position(|report| {
        end += report.particles;
        (id as usize) < end
    });
    let body = &case.bodies[number.unwrap_or(0)];
    let (name, lender) = (&body.name.value, bodies::lender(case, body));
    let message = format!("body `{name}`: {error}");
    let place = if lender.is_some() { body.shape.place } else { body.spacing.place };
    let help = lender.map(bodies::wall_of_solid);
    case.problem_at(place, message, format!("body `{name}`"), help)
}

/// What part of the particles within the support around one inside a particle of fluid has at least beside a wall; at a
/// free surface it is about 0.6.
const ENCLOSED: f64 = 0.75;

/// A warning of a fluid that borders on empty space while no free surface is looked for, where `full` particles fill a
/// support.
fn open_end<const D: usize, M: Continuum<D>>(
    scheme: &TransportVelocity<D, M>,
    full: f64,
) -> Option<String> {
    let is_open =
        |(a, size): &(u32, usize)| !scheme.is_wall(*a) && (*size as f64) < ENCLOSED * full;
    let open: Vec<u32> = row_sizes(scheme).filter(is_open).map(|(a, _)| a).collect();
    let place = coordinates(&scheme.particle(*open.first()? as usize).reference);
    Some(format!(
        "{} of the fluid, the first at {place} m, border on empty space, and `free_surface` is false: nothing holds \
         the fluid there; put a wall there, make the domain periodic, or set `free_surface = true`",
        counted(open.len() as u64, "particle", "particles")
    ))
}

/// What of its density a fluid may be compressed by at the start without a warning: that of speeds of a
/// tenth of the wave speed, the bound of what is called weakly compressible.
const COMPRESSION: f64 = 0.01;

/// A warning of a fluid that its wave speed is too low for.
fn compression<const D: usize>(fluid: &Fluid, initial: &Initial<D>) -> Option<String> {
    let pressure = initial.pressure.iter().map(|p| p.abs()).fold(0.0, f64::max);
    let stiffness = fluid.density * fluid.wave_speed.powi(2);
    (pressure > COMPRESSION * stiffness).then(|| {
        format!(
            "the pressure at the start, up to {pressure:.3e} Pa, compresses the fluid by {:.1} %, more than the \
             1 % of a weakly compressible one: pressure and level will differ by as much from \
             those of an incompressible fluid; raise its wave speed to {:.3e} m/s",
            100.0 * pressure / stiffness,
            (pressure / (COMPRESSION * fluid.density)).sqrt()
        )
    })
}

/// The one fluid of the case: its bodies and walls must agree on it.
pub(super) fn fluid(case: &Case) -> Result<Fluid, Vec<Problem>> {
    let mut found: Option<Fluid> = None;
    for body in &case.bodies {
        let model::Material::WeaklyCompressible { density, viscosity, .. } = body.material.value
        else {
            continue;
        };
        let wave_speed = (body.material.bulk_modulus(case.dimension) / density).sqrt();
        let fluid = Fluid { density, wave_speed, viscosity };
        if *found.get_or_insert(fluid) != fluid {
            let message = "fluid and walls must all have the same material in this scheme";
            let place = body.material.place;
            return Err(vec![case.problem_at(place, message, "another material", None)]);
        }
    }
    found.ok_or_else(|| vec![case.problem_at(case.scheme.place, "no fluid", "needs one", None)])
}

/// The solids of all bodies, if they are solids.
fn materials(case: &Case) -> Option<Vec<Solid>> {
    let solid = |body: &model::Body| match body.material.value {
        model::Material::Hypoelastic(solid) => Some(solid),
        _ => None,
    };
    case.bodies.iter().map(solid).collect()
}

/// The prescribed velocities of walls, and those of solids.
fn split<const D: usize>(
    conditions: Vec<PrescribedVelocity>,
    particles: &Particles<D>,
    walls: &[Wall],
) -> (Vec<PrescribedVelocity>, Vec<PrescribedVelocity>) {
    let is_wall = |a: &u32| walls.iter().any(|wall| wall.body == particles.body[*a as usize]);
    let (mut motion, mut held) = (Vec::new(), Vec::new());
    for condition in conditions {
        let (of_walls, others) = condition.particles.iter().copied().partition(is_wall);
        motion.push(PrescribedVelocity { particles: of_walls, ..condition.clone() });
        held.push(PrescribedVelocity { particles: others, ..condition });
    }
    (motion, held)
}
