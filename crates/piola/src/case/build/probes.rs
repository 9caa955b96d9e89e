//! Probes bound to particles.

use piola_formulas::kernels::Kernel;

use super::bodies::vector;
use super::selections::{function, select};
use crate::case::diagnostics::Problem;
use crate::case::model::{self, Case};
use crate::case::source::Located;
use crate::geometry::Particles;
use crate::observe::{Deviation, Interpolated, Probe, ProbeKind};

/// The probes of a case.
pub(super) fn probes<const D: usize>(
    case: &Case,
    particles: &Particles<D>,
    problems: &mut Vec<Problem>,
) -> Vec<Probe> {
    let mut probes = Vec::new();
    for probe in &case.probes {
        let body = probe.body.as_ref();
        let kind = match &probe.kind {
            model::ProbeKind::Particle { at, fields } => {
                let at = vector::<D>(at);
                let of_body =
                    |a: &usize| body.is_none_or(|body| particles.body[*a] as usize == body.value);
                let distance = |a: usize| (particles.position[a] - at).norm_squared();
                let nearest = (0..particles.len())
                    .filter(of_body)
                    .min_by(|&a, &b| distance(a).total_cmp(&distance(b)));
                ProbeKind::Particle {
                    particle: nearest.unwrap_or(0) as u32,
                    fields: fields.iter().map(|field| field.value).collect(),
                }
            }
            model::ProbeKind::Sum { field, region } => ProbeKind::Sum {
                field: field.value,
                particles: select(case, particles, region, body, problems),
            },
            model::ProbeKind::Point { at, fields } => {
                let (kernel, ratio) = kernel_of(case);
                let spacing = particles.spacing.iter().copied().fold(0.0, f64::max);
                let of_body = |a: &u32| {
                    body.is_none_or(|body| particles.body[*a as usize] as usize == body.value)
                };
                let period = |ends: &Option<Located<[f64; 2]>>| {
                    ends.as_ref().map_or(f64::INFINITY, |ends| ends.value[1] - ends.value[0])
                };
                ProbeKind::Point(Interpolated {
                    at: at.value.clone(),
                    fields: fields.iter().map(|field| field.value).collect(),
                    kernel,
                    smoothing_length: ratio * spacing,
                    periods: case.domain.periodic.iter().map(period).collect(),
                    particles: (0..particles.len() as u32).filter(of_body).collect(),
                })
            }
            model::ProbeKind::Error { field, exact, without_mean, region } => {
                ProbeKind::Error(Deviation {
                    field: field.value,
                    exact: function(exact),
                    without_mean: *without_mean,
                    particles: select(case, particles, region, body, problems),
                })
            }
            model::ProbeKind::Extremum { field, of, region } => ProbeKind::Extremum {
                field: field.value,
                largest: *of == model::Extremum::Largest,
                particles: select(case, particles, region, body, problems),
            },
        };
        probes.push(Probe { name: probe.name.value.clone(), kind });
    }
    probes
}

/// The kernel of the scheme, and its smoothing length in spacings, for points between particles.
fn kernel_of(case: &Case) -> (Kernel, f64) {
    // The reader has checked the names against the same registry.
    let kernel = |name: &str| Kernel::from_name(name).unwrap_or(Kernel::QuinticSpline);
    match &case.scheme.value {
        model::Scheme::Upwind(settings) => (kernel(&settings.kernel), *settings.smoothing_length),
        model::Scheme::TransportVelocity(settings) => {
            (kernel(&settings.kernel), *settings.smoothing_length)
        }
        model::Scheme::DualSupport(settings) => {
            let kernel = kernel(&settings.kernel);
            let radius = match *settings.support {
                model::SupportSize::Spacings(radius) => radius,
                // As many as these are about so far away.
                model::SupportSize::Neighbors(_) => 2.0,
            };
            (kernel, radius / kernel.support_over_h())
        }
    }
}
