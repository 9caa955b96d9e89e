//! Particles and ghosts turned into a study of interpolation.

use super::bodies::{self, BodyReport};
use super::{Built, kernel, probes, row_sizes, row_statistics};
use crate::case::diagnostics::Problem;
use crate::case::model::{self, Case};
use crate::geometry::Particles;
use crate::neighbors::{Domain, NeighborError, spatial_order};
use crate::operators::POOR_CONDITION;
use crate::schemes::interpolation::{
    Boundary, Interpolation, InterpolationError, InterpolationInput,
};
use crate::schemes::{Scheme, boxed};

/// Builds the scheme `interpolation`.
pub(super) fn build<const D: usize>(
    case: &Case,
    settings: &model::Interpolation,
    mut particles: Particles<D>,
    reports: Vec<BodyReport>,
    domain: Domain<D>,
) -> Result<(Box<dyn Scheme>, Built), Vec<Problem>> {
    let kernel = kernel(case, &settings.kernel)?;
    if settings.weights == model::Weights::Volume {
        particles.weight.clone_from(&particles.volume);
    }
    let place = settings.support.place;
    let radius = *settings.support * particles.spacing.iter().copied().fold(0.0, f64::max);
    let ghosts = match settings.boundary {
        Boundary::Cut | Boundary::Scaled => Particles::default(),
        boundary => bodies::around(case, &case.bodies[0], &domain, boundary.reach() * radius)
            .map_err(|problem| vec![problem])?,
    };
    let order = spatial_order(&particles.position, radius).map_err(|error: NeighborError| {
        vec![case.problem_at(place, error.to_string(), "with this support", None)]
    })?;
    particles.reorder(&order);

    let mut problems = Vec::new();
    let probes = probes::probes(case, &particles, &mut problems);
    let lines = probes::lines(case, &particles);
    if !problems.is_empty() {
        return Err(problems);
    }
    let study = Interpolation::new(InterpolationInput {
        particles,
        ghosts,
        kernel,
        radius,
        form: settings.form,
        domain,
        boundary: settings.boundary,
        function: &settings.function.value,
    });
    let scheme = study.map_err(|error| {
        let (place, label) = match &error {
            InterpolationError::NotFinite { .. } => (settings.function.place, "this function"),
            _ => (place, "with this support"),
        };
        vec![case.problem_at(place, error.to_string(), label, None)]
    })?;
    let poor = scheme.condition().filter(|(condition, _)| *condition > POOR_CONDITION);
    let warnings = poor.map(|(condition, [least, most])| {
        format!(
            "the modified SPH matrix has a condition number of {condition:.1e}, so that ghost \
             values range from {least:.3} to {most:.3}: use a narrower cover, in 2D at most 2.5 \
             spacings"
        )
    });
    let (neighbors, poorly_supported) = row_statistics(D, row_sizes(&scheme));
    Ok((
        boxed(scheme),
        Built {
            poorly_supported,
            probes,
            lines,
            bodies: reports,
            neighbors,
            warnings: warnings.into_iter().collect(),
            notes: Vec::new(),
        },
    ))
}
