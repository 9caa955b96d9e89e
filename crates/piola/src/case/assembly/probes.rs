//! Probes bound to particles.

use piola_formulas::kernels::Kernel;

use super::bodies::vector;
use super::selections::{function, select};
use crate::Vector;
use crate::boundaries::padded;
use crate::case::diagnostics::Problem;
use crate::case::model::{self, Case};
use crate::case::source::Located;
use crate::fields::FieldDescription;
use crate::geometry::Particles;
use crate::observe::{Deviation, Flux, Gauge, Interpolated, Line, Probe, ProbeKind, Sensor, Void};
use crate::schemes::ImplicitRule;
use crate::time::Schedule;

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
            model::ProbeKind::Particle { at, relative_to, fields } => {
                let nearest = |at: &Located<Vec<f64>>| {
                    nearest(particles, body, &vector::<D>(at)).unwrap_or(0) as u32
                };
                ProbeKind::Particle {
                    particle: nearest(at),
                    relative_to: relative_to.as_ref().map(nearest),
                    fields: fields.iter().map(|field| field.value).collect(),
                }
            }
            model::ProbeKind::Sum { field, region } => ProbeKind::Sum {
                field: field.value,
                particles: select(case, particles, region, body, problems),
            },
            model::ProbeKind::Mean { field, region } => ProbeKind::Mean {
                field: field.value,
                particles: select(case, particles, region, body, problems),
            },
            model::ProbeKind::Force { field, about, region } => ProbeKind::Force {
                field: field.value,
                about: padded(&vector::<D>(about)),
                particles: select(case, particles, region, body, problems),
            },
            model::ProbeKind::Sensor { at, normal, radius } => {
                match sensor(case, particles, body, (at, normal, *radius)) {
                    Ok(sensor) => ProbeKind::Sensor(sensor),
                    Err(found) => {
                        problems.extend(found);
                        continue;
                    }
                }
            }
            model::ProbeKind::Gauge { from, to } => {
                let (kernel, ratio) = kernel_of(case);
                let of_body = of_body(particles, body);
                ProbeKind::Gauge(Gauge {
                    ends: [from.value.clone(), to.value.clone()],
                    kernel,
                    smoothing_length: ratio * largest_spacing(particles),
                    periods: periods(case),
                    particles: of_body.map(|a| (a, particles.volume[a as usize])).collect(),
                })
            }
            model::ProbeKind::Flux { point, normal, inside } => ProbeKind::Flux(Flux {
                point: point.clone(),
                normal: normal.clone(),
                reach: 2.0 * largest_spacing(particles),
                periods: periods(case),
                inside: inside.clone(),
                particles: of_body(particles, body).collect(),
            }),
            model::ProbeKind::Void => ProbeKind::Void(Void {
                periods: periods(case),
                particles: of_body(particles, body)
                    .map(|a| (a, particles.spacing[a as usize]))
                    .collect(),
            }),
            model::ProbeKind::Opening => {
                ProbeKind::Opening(body.map_or(0, |body| body.value as u32))
            }
            model::ProbeKind::Point { at, relative_to, fields } => {
                let places = std::iter::once(at).chain(relative_to).map(|at| at.value.clone());
                let places = places.collect();
                ProbeKind::Point(interpolated(case, particles, body, places, fields))
            }
            model::ProbeKind::Tangent { step } => match case.time.rule {
                Some(ImplicitRule::Theta(rule)) => ProbeKind::Tangent { rule, step: *step },
                // The reader of cases has refused others.
                _ => continue,
            },
            // Those have tables of their own.
            model::ProbeKind::Line { .. } => continue,
            model::ProbeKind::Error { parts, without_mean, norm, region } => {
                ProbeKind::Error(Deviation {
                    parts: parts.iter().map(|(field, exact)| (*field, function(exact))).collect(),
                    without_mean: *without_mean,
                    norm: *norm,
                    particles: select(case, particles, region, body, problems),
                })
            }
            model::ProbeKind::Extremum { field, of, region, inside } => ProbeKind::Extremum {
                field: field.value,
                largest: *of == model::Extremum::Largest,
                particles: select(case, particles, region, body, problems),
                inside: inside.clone(),
            },
        };
        probes.push(Probe { name: probe.name.value.clone(), kind });
    }
    probes
}

/// What of a spacing the first layer of a wall may be in front of its face, and behind it.
const FIRST_LAYER: std::ops::Range<f64> = -0.25..0.75;

/// The particles of a wall behind a patch of its face, with its middle in m, its unit normal and its radius in m.
fn sensor<const D: usize>(
    case: &Case,
    particles: &Particles<D>,
    body: Option<&Located<usize>>,
    (at, normal, radius): (&Located<Vec<f64>>, &[f64], f64),
) -> Result<Sensor, Vec<Problem>> {
    let (kernel, ratio) = kernel_of(case);
    let domain = super::domain::<D>(case)?;
    let (middle, axis) = (vector::<D>(at), vector::<D>(normal));
    let refuse = |message: &str, label: &str| {
        let help =
            "`at` has to be on a face of the wall, and `normal` points from there to the fluid";
        vec![case.problem_at(at.place, message, label, Some(help.to_owned()))]
    };
    let (mut behind, mut area) = (Vec::new(), 0.0);
    for a in of_body(particles, body) {
        let spacing = particles.spacing[a as usize];
        let way = domain.separation(&middle, &particles.position[a as usize]);
        let depth = -way.dot(&axis);
        let share = Sensor::share((way + axis * depth).norm(), radius, spacing);
        let deepest = kernel.support_radius(ratio * spacing);
        if share == 0.0 || depth.abs() >= deepest {
            continue;
        }
        if depth < FIRST_LAYER.start * spacing {
            return Err(refuse("the wall continues in front of the sensor", "inside of the wall"));
        }
        behind.push((a, share));
        if depth < FIRST_LAYER.end * spacing {
            area += share * spacing.powi(D as i32 - 1);
        }
    }
    if area > 0.0 {
        return Ok(Sensor { particles: behind, normal: normal.to_vec(), area });
    }
    let message = "no particle of the wall is behind this place within the radius of the sensor";
    Err(refuse(message, "no wall here"))
}

/// Probes of a particle are meant to have one within this many spacings.
const NEAR: f64 = 1.5;

/// What the user should know of probes whose particle is not where they are.
pub(super) fn far<const D: usize>(case: &Case, particles: &Particles<D>) -> Vec<String> {
    let warning = |(probe, at): (&model::Probe, &Located<Vec<f64>>)| {
        let at = vector::<D>(at);
        let a = nearest(particles, probe.body.as_ref(), &at)?;
        let (distance, spacing) = ((particles.position[a] - at).norm(), particles.spacing[a]);
        (distance > NEAR * spacing).then(|| {
            format!(
                "the probe `{}` follows a particle that is {:.4} m away from its point, {:.1} spacings: give \
                 it a point within the body",
                *probe.name,
                distance,
                distance / spacing
            )
        })
    };
    let points = case.probes.iter().flat_map(|probe| {
        let points = match &probe.kind {
            model::ProbeKind::Particle { at, relative_to, .. } => [Some(at), relative_to.as_ref()],
            _ => [None; 2],
        };
        points.into_iter().flatten().map(move |at| (probe, at))
    });
    points.filter_map(warning).collect()
}

/// The particle of a body, or of all, that is nearest to a point.
fn nearest<const D: usize>(
    particles: &Particles<D>,
    body: Option<&Located<usize>>,
    at: &Vector<D>,
) -> Option<usize> {
    let distance = |a: usize| (particles.position[a] - at).norm_squared();
    let all = of_body(particles, body).map(|a| a as usize);
    all.min_by(|&a, &b| distance(a).total_cmp(&distance(b)))
}

/// The lines of a case.
pub(super) fn lines<const D: usize>(case: &Case, particles: &Particles<D>) -> Vec<Line> {
    let line = |probe: &model::Probe| {
        let model::ProbeKind::Line { from, to, points, fields, times, mean_over } = &probe.kind
        else {
            return None;
        };
        let length = probe.kind.length()?;
        let shares = (0..*points).map(|number| number as f64 / (points - 1) as f64);
        let place = |share: f64| -> Vec<f64> {
            let ends = from.iter().zip(&to.value);
            // Both ends are met exactly.
            ends.map(|(from, to)| from * (1.0 - share) + to * share).collect()
        };
        let places = shares.clone().map(place).collect();
        Some(Line {
            name: probe.name.value.clone(),
            distances: shares.map(|share| share * length).collect(),
            values: interpolated(case, particles, probe.body.as_ref(), places, fields),
            schedule: match (times, mean_over) {
                (Some(times), Some(span)) => {
                    let every = *case.output.table_every;
                    let earlier = |end: f64| {
                        let before = times.iter().copied().filter(|time| *time < end);
                        let last = before.fold(0.0, f64::max);
                        let first = (end - span).max(last) - 1e-9 * every;
                        let times = (0..).map(move |number| end - f64::from(number) * every);
                        let snapped = |time: f64| if time < 1e-9 * every { 0.0 } else { time };
                        times.take_while(move |time| *time >= first).map(snapped)
                    };
                    Schedule::at(times.iter().flat_map(|end| earlier(*end)).collect())
                }
                (Some(times), None) => Schedule::at(times.clone()),
                (None, _) => Schedule::Every(*case.output.every),
            },
            means: mean_over.and_then(|_| Some(Schedule::at(times.clone()?))),
            over_time: maps_of(case, &probe.name),
        })
    };
    case.probes.iter().filter_map(line).collect()
}

/// The columns of a line that maps are drawn of.
fn maps_of(case: &Case, line: &str) -> Vec<String> {
    let maps = case.plots.iter().filter(|plot| plot.over_time);
    let columns = maps.flat_map(|plot| &plot.curves).map(|curve| &curve.value);
    let of_line = columns
        .filter(|column| matches!(column, model::Quantity::Probe { probe, .. } if *probe == line));
    of_line.map(model::Quantity::name).collect()
}

/// Fields of a body, or of all, at some places.
fn interpolated<const D: usize>(
    case: &Case,
    particles: &Particles<D>,
    body: Option<&Located<usize>>,
    places: Vec<Vec<f64>>,
    fields: &[Located<FieldDescription>],
) -> Interpolated {
    let (kernel, ratio) = kernel_of(case);
    let widest = largest_spacing(particles);
    let smoothing_length =
        |place: &Vec<f64>| ratio * super::levels::spacing_at(case, place, widest);
    Interpolated {
        smoothing_lengths: places.iter().map(smoothing_length).collect(),
        places,
        fields: fields.iter().map(|field| field.value).collect(),
        kernel,
        periods: periods(case),
        particles: of_body(particles, body).collect(),
    }
}

/// Periods of space in m by axis, infinite where it is open.
fn periods(case: &Case) -> Vec<f64> {
    let period = |ends: &Option<Located<[f64; 2]>>| {
        ends.as_ref().map_or(f64::INFINITY, |ends| ends.value[1] - ends.value[0])
    };
    case.domain.periodic.iter().map(period).collect()
}

/// The particles of a body, or of all.
fn of_body<const D: usize>(
    particles: &Particles<D>,
    body: Option<&Located<usize>>,
) -> impl Iterator<Item = u32> {
    let body = body.map(|body| body.value);
    let is_its =
        move |a: &u32| body.is_none_or(|body| particles.body[*a as usize] as usize == body);
    (0..particles.len() as u32).filter(is_its)
}

fn largest_spacing<const D: usize>(particles: &Particles<D>) -> f64 {
    particles.spacing.iter().copied().fold(0.0, f64::max)
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
        model::Scheme::TotalLagrangian(settings) => {
            let kernel = kernel(&settings.kernel);
            let radius = match *settings.support {
                // Wide supports smooth; a value at a place is one of the particles around it.
                model::SupportSize::Spacings(radius) => radius.min(2.5),
                // As many as these are about so far away.
                model::SupportSize::Neighbors(_) => 2.0,
            };
            (kernel, radius / kernel.support_over_h())
        }
        // At a particle its own value, which others are not mixed into.
        model::Scheme::Interpolation(_) => {
            (Kernel::CubicSpline, 1.0 / Kernel::CubicSpline.support_over_h())
        }
    }
}
