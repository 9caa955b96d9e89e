//! Probes bound to particles.

use super::bodies::vector;
use super::selections::select;
use crate::case::diagnostics::Problem;
use crate::case::model::{self, Case};
use crate::geometry::Particles;
use crate::observe::{Probe, ProbeKind};

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
