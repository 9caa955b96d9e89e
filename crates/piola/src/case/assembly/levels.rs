//! A fluid at several resolutions: one fluid for each, nested in each other.

use std::collections::BTreeSet;

use super::bodies::{self, BodyReport};
use super::fluids;
use super::{Built, kernel, probes};
use crate::case::diagnostics::Problem;
use crate::case::model::{self, Case};
use crate::case::source::Located;
use crate::coordinates;
use crate::geometry::{Particles, Shape};
use crate::neighbors::Domain;
use crate::schemes::transport_velocity::{
    DensityRule, Levels, Nesting, Refined, Shifting, WeaklyCompressible,
};
use crate::schemes::{Scheme, boxed};

/// How far beyond the support of the finer level, in spacings of the coarser one, particles of that are split, and how far
/// the finer ones go, so that one that is split twice is further out than the last one that is needed.
const BAND: [f64; 2] = [1.5, 3.0];

/// Which part of the particles of a finer level waits, beyond those of the start and those that its band has room for.
const RESERVE: f64 = 0.1;

/// What of the volume of the fluid may be told twice or not at all where levels meet without a warning.
const VOLUME: f64 = 1e-3;

/// Builds a fluid with regions of finer spacing out of the particles at the spacing of its bodies.
pub(super) fn build<const D: usize>(
    case: &Case,
    settings: &model::TransportVelocity,
    particles: Particles<D>,
    reports: Vec<BodyReport>,
    domain: Domain<D>,
) -> Result<(Box<dyn Scheme>, Built), Vec<Problem>> {
    check(case, settings)?;
    let spacing = particles.spacing.iter().copied().fold(0.0, f64::max);
    let regions = regions(case, settings, spacing)?;
    clear_of_openings(case, &particles, (settings, spacing), &regions[0])?;
    let (mut levels, mut all) = (Vec::new(), Vec::new());
    let (mut built, mut spacings) = (None::<Built>, None::<Vec<Vec<f64>>>);
    for level in 0..=regions.len() {
        let own = level.checked_sub(1).map(|before| &regions[before]);
        let of_level = at(case, level);
        // Of the coarsest none wait but for openings.
        let (particles, reports, reserve) = match own {
            None => (particles.clone(), reports.clone(), 0),
            Some(own) => of_region(&of_level, (settings, level), &domain, own)?,
        };
        match &spacings {
            None => spacings = Some(reports.iter().map(|it| it.spacing.clone()).collect()),
            Some(coarsest) => halved(case, coarsest, &reports, level)?,
        }
        if let (Some(own), Some(before)) = (own, level.checked_sub(2)) {
            within(case, settings, (&particles, own), &regions[before], level)?;
        }
        let nesting = Nesting { own: own.cloned(), finer: regions.get(level).cloned() };
        let nested = (nesting, reserve);
        let prepared = fluids::prepare(&of_level, settings, particles, reports, domain, nested)?;
        all.push(prepared.particles().clone());
        let material = fluids::fluid(case)?;
        let (fluid, of_fluid) =
            prepared.finish::<WeaklyCompressible<D>>(&of_level, settings, material)?;
        levels.push(fluid);
        match &mut built {
            None => built = Some(of_fluid),
            Some(built) => built.warnings.extend(of_fluid.warnings),
        }
    }
    let levels = Levels::new(levels).map_err(|error| {
        let place = settings.smoothing_length.place;
        vec![case.problem_at(place, error.to_string(), "with this smoothing length", None)]
    })?;
    let mut built = built.expect("there is a coarsest level");
    let mut told = BTreeSet::new();
    built.warnings.retain(|warning| told.insert(warning.clone()));
    let mut shown = Particles::default();
    for (level, particles) in all.iter().enumerate() {
        let own = (0..particles.len() as u32).filter(|&a| levels.index_of(level, a).is_some());
        shown.extend(particles, &own.collect::<Vec<_>>());
    }
    let alone: f64 = fluid_volume(case, &built.bodies);
    let coarsest = all[0].spacing.iter().copied().fold(0.0, f64::max);
    for report in &mut built.bodies {
        (report.particles, report.volume) = (0, 0.0);
    }
    let start = levels.initial_state();
    for (a, volume) in shown.volume.iter().enumerate() {
        if let Some(body) = levels.body_of(&start, a) {
            let report = &mut built.bodies[body as usize];
            (report.particles, report.volume) = (report.particles + 1, report.volume + volume);
            report.finest = report.finest.max((coarsest / shown.spacing[a]).round());
        }
    }
    let off = fluid_volume(case, &built.bodies) - alone;
    if off.abs() > VOLUME * alone {
        built.warnings.push(format!(
            "the volume of the particles is {:+.2} % off that of the fluid, as regions of \
             `refine` cut particles of the coarser spacing: place their bounds halfway between \
             those, on cells of the coarser lattice",
            100.0 * off / alone
        ));
    }
    let mut problems = Vec::new();
    let probes = probes::probes(case, &shown, &mut problems);
    let lines = probes::lines(case, &shown);
    let index = |a: u32| levels.index_of(0, a);
    let poorly_supported = built.poorly_supported.into_iter().filter_map(index).collect();
    match problems.is_empty() {
        true => Ok((boxed(levels), Built { probes, lines, poorly_supported, ..built })),
        false => Err(problems),
    }
}

/// What no fluid at several resolutions can have.
fn check(case: &Case, settings: &model::TransportVelocity) -> Result<(), Vec<Problem>> {
    let place = settings.refine[0].place;
    let refuse = |message: &str, help: &str| {
        Err(vec![case.problem_at(place, message, "no meaning here", Some(help.to_owned()))])
    };
    if settings.settings.free_surface {
        return refuse(
            "a fluid with free surfaces has one spacing",
            "remove `refine` or `free_surface`",
        );
    }
    if settings.settings.density == DensityRule::Summation {
        return refuse(
            "where spacings meet no level contains all masses, so that the density cannot be their sum",
            "use `density = \"continuity\"`",
        );
    }
    if !matches!(settings.settings.shifting, Shifting::Sun { .. } | Shifting::None) {
        return refuse(
            "a fluid with regions of finer spacing is shifted by `spst`, or not at all",
            "remove `shifting`",
        );
    }
    let is_array = |body: &&model::Body| body.initial.expressions().any(|it| it.array().is_some());
    if let Some(body) = case.bodies.iter().find(is_array) {
        let message = format!(
            "the initial state of the body `{}` is an array, which has no values for particles of other spacings",
            *body.name
        );
        return refuse(&message, "use expressions or functions, or remove `refine`");
    }
    if let Some(boundary) = case.boundaries.iter().find(|boundary| boundary.moves()) {
        let message = format!(
            "walls stand still in a fluid with regions of finer spacing, and `{}` moves some",
            *boundary.name
        );
        return refuse(
            &message,
            "use `sliding` of the wall to move its surface in place, or remove `refine`",
        );
    }
    let follows = |probe: &&model::Probe| {
        let is_wall = |body: &Located<usize>| case.bodies[body.value].wall.is_some();
        matches!(probe.kind, model::ProbeKind::Particle { .. })
            && !probe.body.as_ref().is_some_and(is_wall)
    };
    if let Some(probe) = case.probes.iter().find(follows) {
        let message = format!(
            "the probe `{}` follows a particle of the fluid, which is replaced by others in finer regions",
            *probe.name
        );
        return refuse(&message, "use the kind `point`, or name the wall that it is of as `body`");
    }
    if let Some(body) = case.bodies.iter().find(|body| body.shape.value.is_from_file()) {
        let message =
            format!("points from a file, as of the body `{}`, have one spacing", *body.name);
        return refuse(&message, "describe the body by shapes, or remove `refine`");
    }
    Ok(())
}

/// The regions with how far their particles go, for the spacing of the coarsest level in m.
fn regions<const D: usize>(
    case: &Case,
    settings: &model::TransportVelocity,
    spacing: f64,
) -> Result<Vec<Refined<D>>, Vec<Problem>> {
    let kernel = kernel(case, &settings.kernel)?;
    let mut regions = Vec::new();
    let mut coarse = spacing;
    for region in &settings.refine {
        let shape = bodies::shape::<D>(case, &case.bodies[0], region).map_err(|it| vec![it])?;
        let support = kernel.support_radius(0.5 * coarse * *settings.smoothing_length);
        let reach = BAND.map(|band| support + band * coarse);
        let (low, high) = shape.bounding_box();
        for (axis, ends) in case.domain.periodic.iter().enumerate().take(D) {
            let Some([begin, end]) = ends.as_ref().map(|ends| ends.value) else { continue };
            let is_across = low[axis] <= begin - reach[1] && high[axis] >= end + reach[1];
            let is_inside = low[axis] >= begin + reach[1] && high[axis] <= end - reach[1];
            if !is_across && !is_inside {
                let message = format!(
                    "the region ends within {:.3e} m of a bound of a periodic axis, where its \
                     finer particles would wrap around",
                    reach[1]
                );
                let help =
                    "end it further inside, or let it go beyond both bounds by more than that";
                return Err(vec![case.problem_at(
                    region.place,
                    message,
                    "too near",
                    Some(help.into()),
                )]);
            }
        }
        regions.push(Refined { shape, reach });
        coarse *= 0.5;
    }
    Ok(regions)
}

/// Refuses a region that the buffer of an opening is in or too near to.
fn clear_of_openings<const D: usize>(
    case: &Case,
    particles: &Particles<D>,
    (settings, spacing): (&model::TransportVelocity, f64),
    region: &Refined<D>,
) -> Result<(), Vec<Problem>> {
    let kernel = kernel(case, &settings.kernel)?;
    let distance = region.reach[1] + kernel.support_radius(spacing * *settings.smoothing_length);
    let both = particles.position.iter().zip(&particles.body);
    let near = both.filter(|(x, body)| {
        case.bodies[**body as usize].opening.is_some() && region.shape.depth(x) > -distance
    });
    match near.map(|(_, body)| &case.bodies[*body as usize].name).next() {
        None => Ok(()),
        Some(name) => {
            let message = format!(
                "the region is less than {distance:.3e} m away from the opening `{}`, whose particles have the spacing of its body",
                **name
            );
            let help = Some("end the region further inside".to_owned());
            Err(vec![case.problem_at(settings.refine[0].place, message, "too near", help)])
        }
    }
}

/// Refuses a region whose finer particles go out of the region before, or so near to its bounds that spacings would be
/// divided by four within a support.
fn within<const D: usize>(
    case: &Case,
    settings: &model::TransportVelocity,
    (particles, own): (&Particles<D>, &Refined<D>),
    before: &Refined<D>,
    level: usize,
) -> Result<(), Vec<Problem>> {
    let needed = before.reach[1];
    let is_fluid = |a: &usize| case.bodies[particles.body[*a] as usize].wall.is_none();
    let all = (0..particles.len()).filter(is_fluid);
    let Some(out) = all.into_iter().find(|&a| before.shape.depth(&particles.position[a]) < needed)
    else {
        return Ok(());
    };
    let message = format!(
        "the spacing would be divided by four near {} m: the particles of this region, which \
         extend {:.3e} m beyond it, have to stay {needed:.3e} m inside the next coarser region",
        coordinates(particles.position[out].as_slice()),
        own.reach[1],
    );
    let help = Some("make this region smaller, or the coarser one larger".to_owned());
    Err(vec![case.problem_at(settings.refine[level - 1].place, message, "too near", help)])
}

/// The case at the spacings of a level, without what looks at all of them.
fn at(case: &Case, level: usize) -> Case {
    let mut own = case.clone();
    own.probes.clear();
    for body in own.bodies.iter_mut().filter(|_| level > 0) {
        body.opening = None;
        body.spacing.value.iter_mut().for_each(|spacing| *spacing *= 0.5_f64.powi(level as i32));
    }
    own
}

/// The volume of the fluid in m^D, with that in buffers.
fn fluid_volume(case: &Case, bodies: &[BodyReport]) -> f64 {
    let both = case.bodies.iter().zip(bodies).filter(|(body, _)| body.wall.is_none());
    both.map(|(_, report)| report.volume).sum()
}

/// Refuses a level whose lattices are not those of the coarsest one with this many times smaller cells.
fn halved(
    case: &Case,
    coarsest: &[Vec<f64>],
    reports: &[BodyReport],
    level: usize,
) -> Result<(), Vec<Problem>> {
    let share = 0.5_f64.powi(level as i32);
    let fits = |(own, all): (&Vec<f64>, &Vec<f64>)| {
        own.iter().zip(all).all(|(own, all)| (own - all * share).abs() < 1e-6 * own)
    };
    let bodies = case.bodies.iter().zip(reports.iter().zip(coarsest));
    let misfit = bodies.filter(|(body, _)| body.opening.is_none());
    match misfit.into_iter().find(|(_, (own, all))| !fits((&own.spacing, all))) {
        None => Ok(()),
        Some((body, (own, all))) => {
            let message = format!(
                "the lattice of the body `{}` fits its shape with spacings of {} m, and that of the finer level {level} \
                 with {} m, which is not 2^{level} times finer",
                *body.name,
                coordinates(all),
                coordinates(&own.spacing)
            );
            let help = Some("make the sides of the shape whole numbers of spacings".to_owned());
            Err(vec![case.problem_at(body.spacing.place, message, "does not halve", help)])
        }
    }
}

/// The particles of a finer level: its fluid within reach of its region, with the walls that this sees; and how many more
/// wait to be born in it.
fn of_region<const D: usize>(
    case: &Case,
    (settings, level): (&model::TransportVelocity, usize),
    domain: &Domain<D>,
    Refined { shape, reach: [begin, end] }: &Refined<D>,
) -> Result<(Particles<D>, Vec<BodyReport>, usize), Vec<Problem>> {
    let (mut particles, reports) = bodies::particles::<D>(case, domain)?;
    let kernel = kernel(case, &settings.kernel)?;
    let spacing = particles.spacing.iter().copied().fold(0.0, f64::max);
    let seen = end + kernel.support_radius(*settings.smoothing_length * spacing) + spacing;
    let is_kept = |&a: &u32| {
        let a = a as usize;
        let is_wall = case.bodies[particles.body[a] as usize].wall.is_some();
        shape.depth(&particles.position[a]) > if is_wall { -seen } else { -begin }
    };
    let kept: Vec<u32> = (0..particles.len() as u32).filter(is_kept).collect();
    let is_fluid = |a: &&u32| case.bodies[particles.body[**a as usize] as usize].wall.is_none();
    if !kept.iter().any(|a| is_fluid(&a)) {
        let place = settings.refine[level - 1].place;
        return Err(vec![case.problem_at(place, "no fluid is in this region", "empty", None)]);
    }
    // They are taken out a little late.
    let has_room = |a: &u32| {
        let depth = shape.depth(&particles.position[*a as usize]);
        depth <= -begin && depth > -end - spacing
    };
    let room = (0..particles.len() as u32).filter(|a| is_fluid(&a) && has_room(a)).count();
    particles.keep(&kept);
    let usual = room + (RESERVE * particles.len() as f64).ceil() as usize;
    let reserve = settings.reserve.map_or(usual, |reserve| reserve as usize) + case.more_in_reserve;
    Ok((particles, reports, reserve))
}

/// The spacing in m of the finest level at a place, for that of the coarsest.
pub(super) fn spacing_at(case: &Case, place: &[f64], coarsest: f64) -> f64 {
    let model::Scheme::TransportVelocity(settings) = &case.scheme.value else { return coarsest };
    let depth = |region: &Located<model::Shape>| match case.dimension {
        1 => depth_of::<1>(case, region, place),
        2 => depth_of::<2>(case, region, place),
        _ => depth_of::<3>(case, region, place),
    };
    let levels = settings.refine.iter().take_while(|region| depth(region) > 0.0).count();
    coarsest * 0.5_f64.powi(levels as i32)
}

/// How deep a place is in a shape in m.
fn depth_of<const D: usize>(case: &Case, region: &Located<model::Shape>, place: &[f64]) -> f64 {
    let shape: Result<Shape<D>, _> = bodies::shape(case, &case.bodies[0], region);
    shape.map_or(f64::NEG_INFINITY, |shape| shape.depth(&bodies::vector(place)))
}
