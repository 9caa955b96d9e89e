//! From a case to a simulation: the one place where names become types.

pub(super) mod bodies;
mod fluids;
mod functions;
mod interpolation;
mod joined;
mod layers;
mod levels;
mod loads;
mod mirrors;
mod openings;
mod overlap;
mod printed;
mod probes;
mod selections;
mod solids;
mod start;
mod tanks;
mod walls;
mod world;

use std::time::Duration;

use piola_formulas::kernels::Kernel;
use piola_formulas::volumetric::VolumetricLaw;

use self::loads::LoadedSurface;
use super::diagnostics::{Problem, Problems};
use super::model::{self, Case};
use super::source::Located;
use crate::geometry::Particles;
use crate::neighbors::{Domain, NeighborError, NeighborStatistics, spatial_order};
use crate::observe::{Line, Probe};
use crate::operators::{GradientOperator, Support};
use crate::schemes::upwind::{
    ImplicitSettings, Material, Settings, Upwind, UpwindError, UpwindInput,
};
use crate::schemes::{InputError, Scheme, boxed};
use crate::time::{CheckpointPolicy, Integrator, IntegratorKind, StepControl};

use bodies::BodyReport;

/// Builds particles, lists, scheme and integrator of a case.
pub(super) fn build(case: &Case) -> Result<Parts, Problems> {
    match case.dimension {
        1 => build_in::<1>(case),
        2 => build_in::<2>(case),
        _ => build_in::<3>(case),
    }
    .map_err(|problems| case.refuse(with_surfaces(case, problems)))
}

/// Problems with what is wrong with surfaces from files, which may be their cause.
fn with_surfaces(case: &Case, mut problems: Vec<Problem>) -> Vec<Problem> {
    let told = bodies::surfaces(case).join("; ");
    if let (Some(first), false) = (problems.first_mut(), told.is_empty()) {
        let help = first.help.take().map(|help| format!("{help}; ")).unwrap_or_default();
        first.help = Some(format!("{help}this may be the cause: {told}"));
    }
    problems
}

/// A formulation with the integrator that was built for it, and what else was built.
pub(super) type Parts = (Box<dyn Scheme>, Box<dyn Integrator>, Built);

/// The built parts that do not depend on the dimension, beside the scheme.
pub(super) struct Built {
    pub probes: Vec<Probe>,
    pub lines: Vec<Line>,
    pub bodies: Vec<BodyReport>,
    pub neighbors: NeighborStatistics,
    /// Particles with fewer neighbours than dimensions, by index in memory.
    pub poorly_supported: Vec<u32>,
    pub warnings: Vec<String>,
    /// What has been chosen for the user.
    pub notes: Vec<String>,
}

/// The positions of the particles of a body in m, in the order of creation, one after the other.
pub(super) fn positions(case: &Case, body: usize) -> Result<Vec<f64>, Problems> {
    match case.dimension {
        1 => positions_in::<1>(case, body),
        2 => positions_in::<2>(case, body),
        _ => positions_in::<3>(case, body),
    }
    .map_err(|problems| case.refuse(with_surfaces(case, problems)))
}

fn positions_in<const D: usize>(case: &Case, body: usize) -> Result<Vec<f64>, Vec<Problem>> {
    let domain = domain::<D>(case)?;
    let Some(body) = case.bodies.get(body) else { return Ok(Vec::new()) };
    let (made, _) = bodies::made(case, body, &domain).map_err(|problem| vec![problem])?;
    Ok(made.particles.position.iter().flat_map(|x| x.iter().copied()).collect())
}

fn build_in<const D: usize>(case: &Case) -> Result<Parts, Vec<Problem>> {
    let (scheme, integrator, mut built) = match case.systems.is_empty() {
        true => {
            let (mut scheme, built) = system::<D>(case)?;
            let integrator = integrator(case, scheme.as_mut())?;
            (scheme, integrator, built)
        }
        false => world::build::<D>(case)?,
    };
    built.warnings.splice(0..0, case.remarks.iter().cloned().chain(bodies::surfaces(case)));
    built.warnings.extend(bodies::packings(&built.bodies));
    built.warnings.extend(uneven_steps(case));
    built.warnings.extend(beyond_stable(case));
    Ok((scheme, integrator, built))
}

/// Builds one system.
fn system<const D: usize>(case: &Case) -> Result<(Box<dyn Scheme>, Built), Vec<Problem>> {
    let domain = domain::<D>(case)?;
    let (particles, bodies) = bodies::particles::<D>(case, &domain)?;
    let far = probes::far(case, &particles);
    let (scheme, mut built) = match &case.scheme.value {
        model::Scheme::Upwind(settings) => build_upwind(case, settings, particles, bodies, domain)?,
        model::Scheme::TransportVelocity(settings) => {
            fluids::build(case, settings, particles, bodies, domain)?
        }
        model::Scheme::TotalLagrangian(settings) => {
            solids::build(case, settings, particles, bodies, domain)?
        }
        model::Scheme::Interpolation(settings) => {
            interpolation::build(case, settings, particles, bodies, domain)?
        }
    };
    built.warnings.extend(far);
    Ok((scheme, built))
}

/// Central differences whose steps are as long as is stable one by one may grow when long and short ones
/// take turns, which due times in no proportion make them do.
fn uneven_steps(case: &Case) -> Option<String> {
    let ratio = *case.output.every / *case.output.table_every;
    let fits = (ratio - ratio.round()).abs() < 1e-6 * ratio;
    let is_split = integrator_kind(case) == IntegratorKind::KickDriftKick;
    let follows = matches!(*case.time.step, model::StepControl::Cfl(number) if number > 0.5);
    (is_split && follows && !fits).then(|| {
        "`output.every` is not a multiple of `output.table_every`, so that longer and shorter \
         steps alternate, which lets short waves grow near the stable step: make it a multiple, \
         or lower `time.cfl` to 0.5"
            .to_owned()
    })
}

/// Steps beyond the bound of an explicit integrator.
fn beyond_stable(case: &Case) -> Option<String> {
    let model::StepControl::Cfl(number) = *case.time.step else { return None };
    let is_explicit = case.time.rule.is_none();
    (is_explicit && number > 1.0).then(|| {
        format!(
            "`time.cfl = {number}` allows steps {number} times as long as the stable step of the explicit \
             integrator, whose short waves then grow until the run breaks down: set it below 1"
        )
    })
}

/// How many neighbours particles of a number have, and which have fewer than there are dimensions.
fn row_statistics(
    dimension: usize,
    sizes: impl Iterator<Item = (u32, usize)>,
) -> (NeighborStatistics, Vec<u32>) {
    let sizes: Vec<(u32, usize)> = sizes.collect();
    let each = || sizes.iter().map(|(_, size)| *size);
    let statistics = NeighborStatistics {
        least: each().min().unwrap_or(0),
        mean: each().sum::<usize>() as f64 / sizes.len().max(1) as f64,
        most: each().max().unwrap_or(0),
    };
    let poor = sizes.iter().filter(|(_, size)| *size < dimension);
    (statistics, poor.map(|(a, _)| *a).collect())
}

/// The number of neighbours of each particle of a scheme.
fn row_sizes<S: Scheme>(scheme: &S) -> impl Iterator<Item = (u32, usize)> {
    (0..scheme.particle_count()).map(|a| (a as u32, scheme.neighborhood(a).len()))
}

/// The kernel of a name.
fn kernel(case: &Case, name: &Located<String>) -> Result<Kernel, Vec<Problem>> {
    Kernel::from_name(name)
        .ok_or_else(|| vec![case.problem_at(name.place, "unknown kernel", "not registered", None)])
}

/// Builds the scheme `upwind`.
fn build_upwind<const D: usize>(
    case: &Case,
    settings: &model::Upwind,
    mut particles: Particles<D>,
    bodies: Vec<BodyReport>,
    domain: Domain<D>,
) -> Result<(Box<dyn Scheme>, Built), Vec<Problem>> {
    let kernel = kernel(case, &settings.kernel)?;
    let ratio = *settings.smoothing_length;
    if settings.weights == model::Weights::Volume {
        particles.weight.clone_from(&particles.volume);
    }
    let widest = particles.spacing.iter().copied().fold(0.0, f64::max);
    let refuse = |error: NeighborError| {
        let place = settings.smoothing_length.place;
        vec![case.problem_at(place, error.to_string(), "with this smoothing length", None)]
    };
    let cell = kernel.support_radius(ratio * widest);
    particles.reorder(&spatial_order(&particles.position, cell).map_err(refuse)?);
    let support = Support::new(&particles, kernel, ratio, domain).map_err(refuse)?;
    let rows = 0..particles.len();
    let poorly_supported =
        rows.filter(|&a| support.list.row(a).len() < D).map(|a| a as u32).collect();
    let neighbors = support.list.statistics();
    let mut warnings = stencil_warning::<D>(settings, &bodies, kernel, &neighbors);
    warnings.extend(printed::warning(settings));
    let (share, remedy) = (|_, _| false, "make one body of them with the shape `union`");
    let group = &particles.body;
    warnings.extend(overlap::touching(case, &domain, &particles, group, (share, remedy)));

    let mut problems = Vec::new();
    let probes = probes::probes(case, &particles, &mut problems);
    let lines = probes::lines(case, &particles);
    let scheme = upwind(case, settings, (particles, &bodies), support, &mut problems);
    match scheme {
        Some(scheme) if problems.is_empty() => Ok((
            boxed(scheme),
            Built {
                probes,
                lines,
                bodies,
                neighbors,
                poorly_supported,
                warnings,
                notes: Vec::new(),
            },
        )),
        _ => Err(problems),
    }
}

fn domain<const D: usize>(case: &Case) -> Result<Domain<D>, Vec<Problem>> {
    let axes = std::array::from_fn(|axis| {
        case.domain.periodic.get(axis).and_then(|ends| ends.as_ref().map(|ends| ends.value))
    });
    Domain::new(axes).map_err(|error| {
        let place = case.domain.periodic.iter().flatten().next().map(|ends| ends.place);
        let place = place.unwrap_or(case.scheme.place);
        vec![case.problem_at(place, error.to_string(), "this box", None)]
    })
}

fn upwind<const D: usize>(
    case: &Case,
    settings: &model::Upwind,
    (particles, reports): (Particles<D>, &[BodyReport]),
    support: Support<D>,
    problems: &mut Vec<Problem>,
) -> Option<Upwind<D>> {
    let materials = materials(case);
    let [tau_velocity, tau_pressure] = printed::strengths(case, settings).unwrap_or_else(|found| {
        problems.extend(found);
        [0.0; 2]
    });
    let initial = start::initial(case, reports, &particles);
    let prescribed = selections::prescribed(case, &particles, problems);
    let body_forces = loads::body_forces(case);
    let correction = *settings.correction;
    // The areas of theory (14).
    let areas = || {
        let operator = GradientOperator::new(&particles, &support, correction);
        operator
            .map(|operator| operator.boundary_areas(&support, &particles.volume))
            .map_err(|error| error.to_string())
    };
    let tractions =
        LoadedSurface::new(case, &particles, &support.domain, None, areas).tractions(problems);
    if !problems.is_empty() {
        return None;
    }
    let built = Upwind::new(UpwindInput {
        particles,
        support,
        settings: Settings {
            correction,
            tau_velocity,
            tau_pressure,
            reconstruction: settings.reconstruction,
            wave_speed: settings.wave_speed,
        },
        materials,
        initial,
        body_forces,
        tractions,
        prescribed,
        implicit: case.time.rule.map(|_| implicit_settings(case)),
    });
    built
        .map_err(|error| {
            let (place, label) = match &error {
                UpwindError::Prestress { .. } | UpwindError::Input(InputError::Velocity { .. }) => {
                    (case.bodies[0].name.place, "initial values of a body")
                }
                UpwindError::Linear(_) => (case.time.integrator.place, "this integrator"),
                _ => (settings.smoothing_length.place, "with this smoothing length"),
            };
            problems.push(case.problem_at(place, error.to_string(), label, None));
        })
        .ok()
}

/// How the equations of implicit steps are solved, where the case says it.
fn implicit_settings(case: &Case) -> ImplicitSettings {
    let mut settings =
        ImplicitSettings { method: case.time.linear_solver, ..ImplicitSettings::default() };
    if let Some(tolerance) = case.time.tolerance {
        settings.newton.tolerance = tolerance;
    }
    settings
}

fn materials(case: &Case) -> Vec<Material> {
    let law = |material: &model::Material| match *material {
        model::Material::Volumetric { law, .. } => law,
        // The reader of cases has refused others for this scheme.
        _ => VolumetricLaw::Linear { bulk_modulus: material.bulk_modulus(case.dimension) },
    };
    let of =
        |material: &model::Material| Material { density: material.density(), law: law(material) };
    case.bodies.iter().map(|body| of(&body.material)).collect()
}

/// A support that is neither the narrow one nor wide enough to be smooth is worth a word.
fn stencil_warning<const D: usize>(
    settings: &model::Upwind,
    bodies: &[BodyReport],
    kernel: Kernel,
    neighbors: &NeighborStatistics,
) -> Vec<String> {
    let mut warnings = Vec::new();
    // Smoothing lengths in spacings at which supports reach the next particles along all axes, and the
    // nearest ones across.
    let least = 1.0 / kernel.support_over_h();
    let most = bodies.iter().map(|body| {
        let widest = body.spacing.iter().copied().fold(0.0, f64::max);
        let mut edges = body.spacing.clone();
        edges.sort_by(f64::total_cmp);
        let diagonal = edges.iter().take(2).map(|edge| edge * edge).sum::<f64>().sqrt();
        least * diagonal / widest
    });
    let most = most.fold(f64::INFINITY, f64::min);
    if D > 1 && *settings.smoothing_length > most {
        // Rounded down, so that it is one that does.
        let most = (100.0 * most).floor() / 100.0;
        warnings.push(format!(
            "the support reaches diagonal neighbours ({:.0} neighbours on average): gradients stay \
             exact for linear fields, but nodal forces near walls and edges are no longer; a \
             smoothing length above {least:.2} and up to {most:.2} spacings keeps them exact on this \
             lattice",
            neighbors.mean
        ));
    }
    warnings
}

/// How the steps of a case are chosen.
pub(super) fn step_control(case: &Case) -> StepControl {
    match case.time.step.value {
        model::StepControl::Cfl(number) => StepControl::Cfl(number),
        model::StepControl::Fixed(step) => StepControl::Fixed(step),
        model::StepControl::AtMost(step) => StepControl::AtMost(step),
    }
}

/// When checkpoints of a case are taken.
pub(super) fn checkpoint_policy(case: &Case) -> CheckpointPolicy {
    let model::Checkpoint { every_steps, every, every_wall, at_end, .. } = case.checkpoint;
    // A number of seconds beyond what a clock holds is never reached.
    let wall = every_wall.and_then(|wall| Duration::try_from_secs_f64(wall).ok());
    CheckpointPolicy { steps: every_steps, time: every, wall, at_end }
}

/// The kind of integrator of a case. The reader has checked its name against the same registry.
fn integrator_kind(case: &Case) -> IntegratorKind {
    IntegratorKind::from_name(&case.time.integrator).unwrap_or(IntegratorKind::TvdRk2)
}

/// The integrator of a case for its scheme, or a problem at its name.
fn integrator(case: &Case, scheme: &mut dyn Scheme) -> Result<Box<dyn Integrator>, Vec<Problem>> {
    let (kind, time) = (integrator_kind(case), &case.time);
    let built = match time.rule {
        Some(rule) => kind.build_with(rule, time.error, scheme),
        None => kind.build(scheme),
    };
    built.map_err(|unserved| {
        let place = time.integrator.place;
        vec![case.problem_at(place, unserved.to_string(), "this integrator", None)]
    })
}
