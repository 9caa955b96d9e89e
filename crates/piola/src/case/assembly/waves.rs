//! Particles turned into elastic solids of the elastodynamics formulation.

use super::bodies::{self, BodyReport};
use super::loads::{self, LoadedSurface};
use super::solids::{areas, materials};
use super::{Built, at_start, kernel, probes, row_statistics, selections};
use crate::Vector;
use crate::case::diagnostics::Problem;
use crate::case::model::{self, Case};
use crate::geometry::Particles;
use crate::neighbors::{Domain, NeighborError, search, spatial_order};
use crate::operators::{Continuation, Mirror};
use crate::schemes::elastodynamics::{
    Elastodynamics, ElastodynamicsError, ElastodynamicsInput, Form, Hole, Mixture,
};
use crate::schemes::{InputError, Scheme};

/// Particles of two bodies that are closer than this share of their spacing are one.
const JOINED: f64 = 1e-6;

/// Builds the scheme `elastodynamics`.
pub(super) fn build<const D: usize>(
    case: &Case,
    settings: &model::Elastodynamics,
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
        vec![case.problem_at(place, error.to_string(), "with this support", None)]
    };
    let joined = Joined::find(&particles, &domain).map_err(refuse)?;
    joined.merge(&mut particles, areas.as_mut());
    let radii = |particles: &Particles<D>| -> Vec<f64> {
        particles.spacing.iter().map(|spacing| *settings.support * spacing).collect()
    };
    let widest = radii(&particles).into_iter().fold(0.0, f64::max);
    let order = spatial_order(&particles.position, widest).map_err(refuse)?;
    particles.reorder(&order);
    if let Some(areas) = &mut areas {
        *areas = order.iter().map(|&number| areas[number as usize]).collect();
    }
    let (mixtures, mixture) = joined.mixtures(&particles, &materials);
    let group = particles.body.iter().map(|&body| joined.group[body as usize]).collect();

    let probes = probes::probes(case, &particles, &mut problems);
    let lines = probes::lines(case, &particles);
    let prescribed = selections::prescribed(case, &particles, &mut problems);
    let mirrors = mirrors(case, settings, &particles, &mut problems);
    let known = || {
        areas.clone().ok_or_else(|| {
            "a load on a surface needs the areas of the particles, which are not known of points from a file"
                .to_owned()
        })
    };
    let tractions =
        LoadedSurface::new(case, &particles, &domain, None, known).tractions(&mut problems);
    if !problems.is_empty() {
        return Err(problems);
    }
    if settings.weights == model::Weights::Volume {
        whole_weights(&mut particles, &mirrors);
    }
    let radius = radii(&particles);
    let scheme = Elastodynamics::new(ElastodynamicsInput {
        kernel,
        group,
        domain,
        settings: settings.settings.value,
        mixtures,
        mixture,
        displacement: at_start(case, &particles, |initial| &initial.displacement),
        velocity: at_start(case, &particles, |initial| &initial.velocity),
        body_forces: loads::body_forces(case),
        particles,
        radius,
        tractions,
        prescribed,
        mirrors,
        holes: holes(case),
    });
    let scheme = scheme.map_err(|error| {
        let (place, label) = match &error {
            ElastodynamicsError::Input(InputError::Velocity { .. }) => {
                (case.bodies[0].name.place, "initial values of a body")
            }
            ElastodynamicsError::Operator(_) => (place, "with this support"),
            _ => (settings.settings.place, "with these settings"),
        };
        vec![case.problem_at(place, error.to_string(), label, None)]
    })?;
    let (neighbors, poorly_supported) = row_statistics(&scheme, |_| true);
    Ok((
        Box::new(scheme),
        Built { poorly_supported, probes, lines, bodies: reports, neighbors, warnings: Vec::new() },
    ))
}

/// The discs that are cut out of bodies.
fn holes<const D: usize>(case: &Case) -> Vec<Hole<D>> {
    let mut holes = Vec::new();
    for body in &case.bodies {
        let model::Shape::Difference { remove, .. } = &body.shape.value else { continue };
        for shape in remove {
            if let model::Shape::Ball { center, radius } = &shape.value {
                holes.push(Hole { center: bodies::vector::<D>(center), radius: *radius });
            }
        }
    }
    holes
}

/// Which particles of different bodies lie at one place, where the bodies are joined.
struct Joined {
    /// Index of a particle that stays, and of one that goes into it, before they are ordered.
    pairs: Vec<(u32, u32)>,
    /// By id of the particle that stays: bodies with their volumes.
    parts: Vec<(u32, Vec<(u32, f64)>)>,
    /// Number of the group of joined bodies of each body.
    group: Vec<u32>,
}

impl Joined {
    fn find<const D: usize>(
        particles: &Particles<D>,
        domain: &Domain<D>,
    ) -> Result<Self, NeighborError> {
        let bodies = particles.body.iter().max().map_or(0, |&body| body + 1);
        let mut joined =
            Self { pairs: Vec::new(), parts: Vec::new(), group: (0..bodies).collect() };
        if bodies < 2 {
            return Ok(joined);
        }
        let radii: Vec<f64> = particles.spacing.iter().map(|spacing| JOINED * spacing).collect();
        let list = search(&particles.position, &radii, domain)?;
        let mut is_gone = vec![false; particles.len()];
        for a in 0..particles.len() {
            if is_gone[a] {
                continue;
            }
            let mut parts = vec![(particles.body[a], particles.volume[a])];
            for &b in list.row(a) {
                let other = particles.body[b as usize];
                if b as usize > a && !is_gone[b as usize] && other != particles.body[a] {
                    is_gone[b as usize] = true;
                    joined.pairs.push((a as u32, b));
                    parts.push((other, particles.volume[b as usize]));
                    let groups = [particles.body[a], other].map(|body| joined.group[body as usize]);
                    let (low, high) = (groups[0].min(groups[1]), groups[0].max(groups[1]));
                    joined.group.iter_mut().filter(|it| **it == high).for_each(|it| *it = low);
                }
            }
            if parts.len() > 1 {
                joined.parts.push((particles.id[a], parts));
            }
        }
        Ok(joined)
    }

    /// Makes one particle of those at one place, with the sum of their volumes and areas.
    fn merge<const D: usize>(
        &self,
        particles: &mut Particles<D>,
        mut areas: Option<&mut Vec<Vector<D>>>,
    ) {
        if self.pairs.is_empty() {
            return;
        }
        if let Some(areas) = areas.as_deref_mut() {
            for &(a, b) in &self.pairs {
                let more = areas[b as usize];
                areas[a as usize] += more;
            }
        }
        let order = particles.join(&self.pairs);
        if let Some(areas) = areas {
            *areas = order.iter().map(|&a| areas[a as usize]).collect();
        }
    }

    /// What particles are made of: the material of their body, or shares of several.
    fn mixtures<const D: usize>(
        &self,
        particles: &Particles<D>,
        materials: &[crate::schemes::dual_support::Material<D>],
    ) -> (Vec<Mixture<D>>, Vec<u32>) {
        let mut mixtures: Vec<Mixture<D>> =
            materials.iter().map(|material| Mixture(vec![(*material, 1.0)])).collect();
        let mut mixture = particles.body.clone();
        for (id, parts) in &self.parts {
            let whole: f64 = parts.iter().map(|(_, volume)| volume).sum();
            let made = Mixture(
                parts
                    .iter()
                    .map(|&(body, volume)| (materials[body as usize], volume / whole))
                    .collect(),
            );
            let known = mixtures.iter().position(|known| *known == made);
            let number = known.unwrap_or_else(|| {
                mixtures.push(made);
                mixtures.len() - 1
            });
            if let Some(a) = particles.id.iter().position(|known| known == id) {
                mixture[a] = number as u32;
            }
        }
        (mixtures, mixture)
    }
}

/// The planes beyond which the body is mirrored, each with a particle on it.
fn mirrors<const D: usize>(
    case: &Case,
    settings: &model::Elastodynamics,
    particles: &Particles<D>,
    problems: &mut Vec<Problem>,
) -> Vec<(Mirror, u32)> {
    let mut mirrors = Vec::new();
    for boundary in &case.boundaries {
        let Some(mirror) = &boundary.mirror else { continue };
        let mut refuse = |message: &str, help: &str| {
            let help = Some(help.to_owned());
            problems.push(case.problem_at(mirror.place, message, "this mirror", help));
        };
        if settings.settings.form == Form::Strong {
            if D == 1 {
                refuse("the strong form makes its ghosts by itself", "remove `mirror`");
            }
            // What is prescribed on an edge makes it a mirror there.
            continue;
        }
        let model::Region::Plane { point, normal } = &boundary.region.value else {
            refuse(
                "a mirror is a plane",
                "use where = { kind = \"plane\", point = .., normal = .. }",
            );
            continue;
        };
        let (point, normal) = (bodies::vector::<D>(point), bodies::vector::<D>(normal).normalize());
        let Some(axis) = (0..D).find(|&axis| normal[axis].abs() > 1.0 - 1e-12) else {
            refuse("a mirror lies across an axis", "turn the case so that its normal is an axis");
            continue;
        };
        if boundary.velocity.get(axis).is_none_or(Option::is_none) {
            refuse(
                "a mirror needs the velocity across it",
                "for a symmetry plane set its component of `velocity` to \"0\"",
            );
            continue;
        }
        let on_plane = |&a: &usize| {
            (particles.position[a][axis] - point[axis]).abs() < JOINED * particles.spacing[a]
        };
        let Some(particle) = (0..particles.len()).find(on_plane) else {
            refuse(
                "no particle lies on the mirror",
                "lay the lattice on the boundary, and the plane on its face",
            );
            continue;
        };
        let (place, is_upper) = (particles.position[particle][axis], normal[axis] > 0.0);
        let continuation = Continuation::Odd;
        mirrors.push((Mirror { axis, place, is_upper, continuation }, particle as u32));
    }
    mirrors
}

/// Gives particles on a mirror, which are their own images, the weight of the whole cell.
fn whole_weights<const D: usize>(particles: &mut Particles<D>, mirrors: &[(Mirror, u32)]) {
    for a in 0..particles.len() {
        for (mirror, _) in mirrors {
            let distance = (particles.position[a][mirror.axis] - mirror.place).abs();
            if distance < JOINED * particles.spacing[a] {
                particles.weight[a] *= 2.0;
            }
        }
    }
}
