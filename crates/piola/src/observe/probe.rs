//! Quantities of selected particles against time.

use std::borrow::Cow;

use nalgebra::Vector3;

use super::comparison::Deviation;
use super::flow::{Flux, Gauge};
use super::interpolation::Interpolated;
use super::sensor::Sensor;
use super::void::Void;
use crate::fields::{FieldDescription, FieldSelector, component_name};
use crate::output::Column;
use crate::schemes::{Observation, Sensitivity, Theta, momentum_components};

/// A probe bound to the particles of a run.
#[derive(Clone)]
pub struct Probe {
    /// First part of the names of its columns.
    pub name: String,
    /// What it records.
    pub kind: ProbeKind,
}

/// What a probe records.
#[derive(Clone)]
pub enum ProbeKind {
    /// Whole fields of one particle.
    Particle {
        /// Its index in memory.
        particle: u32,
        /// Index of a particle whose fields are subtracted.
        relative_to: Option<u32>,
        /// The fields, with all their components.
        fields: Vec<FieldDescription>,
    },
    /// The largest or smallest value over a set of particles.
    Extremum {
        /// One number of each particle.
        field: FieldSelector,
        /// Whether it is the largest.
        largest: bool,
        /// Their indices in memory, at least one.
        particles: Vec<u32>,
        /// Lower and upper corner in m of a box; particles that are outside it at the time do not count.
        inside: Option<[Vec<f64>; 2]>,
    },
    /// The sum of a field over a set of particles, with all its components.
    Sum {
        /// The field.
        field: FieldDescription,
        /// Their indices in memory, at least one.
        particles: Vec<u32>,
    },
    /// The mean of a field over a set of particles, with all its components.
    Mean {
        /// The field.
        field: FieldDescription,
        /// Their indices in memory, at least one.
        particles: Vec<u32>,
    },
    /// The resultant of forces on a set of particles, and their moment about a point.
    Force {
        /// The field of the forces, in N.
        field: FieldDescription,
        /// The point in m, padded with zeros to three.
        about: [f64; 3],
        /// Their indices in memory, at least one.
        particles: Vec<u32>,
    },
    /// The pressure on a patch of a wall.
    Sensor(Sensor),
    /// How far a fluid reaches along a line.
    Gauge(Gauge),
    /// The flow through a plane.
    Flux(Flux),
    /// The largest hole.
    Void(Void),
    /// What has entered and left through the open boundary whose buffer is the body of this number.
    Opening(u32),
    /// Whole fields interpolated at one fixed point in space; with two points, those at the first less those at the
    /// second.
    Point(Interpolated),
    /// How far a field is from a function of position and time.
    Error(Deviation),
    /// The Taylor test of the tangent of an implicit step from the current state.
    Tangent {
        /// The rule of the step.
        rule: Theta,
        /// Its length in s.
        step: f64,
    },
}

/// Distances of the Taylor test, a decade apart.
const SIZES: [f64; 5] = [1e-2, 1e-3, 1e-4, 1e-5, 1e-6];

/// Columns of the Taylor test: the smallest and the largest slope over a decade, which are 2 if the tangent is exact,
/// and the remainder at each distance.
pub const TANGENT_COLUMNS: [(&str, &str); 7] = [
    ("least_slope", "1"),
    ("largest_slope", "1"),
    ("remainder_1", "kg m/s"),
    ("remainder_2", "kg m/s"),
    ("remainder_3", "kg m/s"),
    ("remainder_4", "kg m/s"),
    ("remainder_5", "kg m/s"),
];

/// Columns of what has gone through an opening, with their units.
pub fn opening_columns(dimension: usize) -> impl Iterator<Item = (&'static str, &'static str)> {
    let own = [("entered", "kg"), ("left", "kg"), ("energy", "J")].into_iter();
    own.chain(momentum_components(dimension).iter().map(|it| (it.name, it.unit)))
}

/// The axes about which there are moments in `dimension` dimensions.
pub fn moment_axes(dimension: usize) -> &'static [&'static str] {
    match dimension {
        1 => &[],
        2 => &["z"],
        _ => &["x", "y", "z"],
    }
}

impl Probe {
    /// The columns that it fills, in `dimension` dimensions.
    pub fn columns(&self, dimension: usize) -> Vec<Column> {
        match &self.kind {
            ProbeKind::Particle { fields, .. } | ProbeKind::Point(Interpolated { fields, .. }) => {
                component_columns(&self.name, fields, dimension)
            }
            ProbeKind::Sum { field, .. } | ProbeKind::Mean { field, .. } => {
                component_columns(&self.name, std::slice::from_ref(field), dimension)
            }
            ProbeKind::Force { field, .. } => {
                let mut columns =
                    component_columns(&self.name, std::slice::from_ref(field), dimension);
                let moment =
                    |axis: &&str| Column::new(format!("{}.moment.{axis}", self.name), "N m");
                columns.extend(moment_axes(dimension).iter().map(moment));
                columns
            }
            ProbeKind::Sensor(_) => vec![Column::new(format!("{}.pressure", self.name), "Pa")],
            ProbeKind::Gauge(_) => vec![Column::new(format!("{}.elevation", self.name), "m")],
            ProbeKind::Flux(_) => vec![Column::new(format!("{}.flux", self.name), "kg/s")],
            ProbeKind::Void(_) => {
                let unit = ["m", "m^2", "m^3"][dimension - 1];
                vec![Column::new(format!("{}.volume", self.name), unit)]
            }
            ProbeKind::Opening(_) => opening_columns(dimension)
                .map(|(column, unit)| Column::new(format!("{}.{column}", self.name), unit))
                .collect(),
            ProbeKind::Tangent { .. } => TANGENT_COLUMNS
                .iter()
                .map(|(column, unit)| Column::new(format!("{}.{column}", self.name), *unit))
                .collect(),
            ProbeKind::Error(_) => vec![Column::new(format!("{}.error", self.name), "1")],
            ProbeKind::Extremum { field, .. } => {
                let name = format!("{}.{}", self.name, field.name(dimension));
                vec![Column::new(name, field.field.unit)]
            }
        }
    }

    /// Renumbers its particles; those without a number no longer count.
    pub fn renumber(&mut self, index: &dyn Fn(u32) -> Option<u32>) {
        match &mut self.kind {
            ProbeKind::Particle { particle, relative_to, .. } => {
                for particle in std::iter::once(particle).chain(relative_to) {
                    *particle = index(*particle).unwrap_or(*particle);
                }
            }
            ProbeKind::Extremum { particles, .. }
            | ProbeKind::Sum { particles, .. }
            | ProbeKind::Mean { particles, .. }
            | ProbeKind::Force { particles, .. }
            | ProbeKind::Flux(Flux { particles, .. })
            | ProbeKind::Error(Deviation { particles, .. }) => {
                *particles = particles.iter().filter_map(|&a| index(a)).collect();
            }
            ProbeKind::Point(point) => point.renumber(index),
            ProbeKind::Sensor(sensor) => sensor.renumber(index),
            ProbeKind::Gauge(Gauge { particles, .. }) | ProbeKind::Void(Void { particles, .. }) => {
                let renamed = particles.iter().filter_map(|&(a, size)| Some((index(a)?, size)));
                *particles = renamed.collect();
            }
            ProbeKind::Opening(_) | ProbeKind::Tangent { .. } => (),
        }
    }

    /// The derivatives of its columns of displacements and reactions, by name, if it is linear in them.
    pub fn sensitivities(&self, of: &Sensitivity, dimension: usize) -> Vec<(String, f64)> {
        let each = |particles: &[u32], weight: f64| {
            particles.iter().map(|&particle| (particle, weight)).collect()
        };
        let (fields, weights): (_, Vec<_>) = match &self.kind {
            ProbeKind::Particle { particle, relative_to, fields } => {
                let own = std::iter::once((*particle, 1.0));
                (fields.as_slice(), own.chain(relative_to.map(|other| (other, -1.0))).collect())
            }
            ProbeKind::Sum { field, particles } => {
                (std::slice::from_ref(field), each(particles, 1.0))
            }
            ProbeKind::Mean { field, particles } => {
                (std::slice::from_ref(field), each(particles, 1.0 / particles.len() as f64))
            }
            _ => return Vec::new(),
        };
        let derivatives = |field: &FieldDescription| match field.name {
            "displacement" | "position" => Some(&of.displacement),
            "reaction" => Some(&of.reaction),
            _ => None,
        };
        let mut all = Vec::new();
        for field in fields {
            let Some(values) = derivatives(field) else { continue };
            let columns = component_columns(&self.name, std::slice::from_ref(field), dimension);
            for (component, column) in columns.into_iter().enumerate() {
                let value = |&(particle, weight): &(u32, f64)| {
                    weight * values[particle as usize * dimension + component]
                };
                all.push((column.name, weights.iter().map(value).sum()));
            }
        }
        all
    }

    /// Appends its numbers to `row`. `scratch` is overwritten.
    pub fn record(&self, now: &mut Observation, scratch: &mut Vec<f64>, row: &mut Vec<f64>) {
        match &self.kind {
            ProbeKind::Particle { particle, relative_to, fields } => {
                for field in fields {
                    let first = row.len();
                    now.read(field, &[*particle], row);
                    if let Some(other) = relative_to {
                        scratch.clear();
                        now.read(field, &[*other], scratch);
                        let own = row[first..].iter_mut().zip(scratch.iter());
                        own.for_each(|(value, other)| *value -= other);
                    }
                }
            }
            ProbeKind::Extremum { field, largest, particles, inside } => {
                let particles = now.present(particles);
                let counted = match inside {
                    None => particles,
                    Some(corners) => Cow::Owned(within(corners, &particles, now)),
                };
                scratch.clear();
                now.read(&field.field, &counted, scratch);
                let components = field.field.kind.components(now.scheme().dimension());
                let values = scratch.chunks_exact(components).map(|value| field.value(value));
                let extremum =
                    if *largest { values.reduce(f64::max) } else { values.reduce(f64::min) };
                row.push(extremum.unwrap_or(f64::NAN));
            }
            ProbeKind::Sum { field, particles } => {
                sum(field, &now.present(particles), 1.0, now, scratch, row);
            }
            ProbeKind::Mean { field, particles } => {
                let particles = now.present(particles);
                sum(field, &particles, 1.0 / particles.len() as f64, now, scratch, row);
            }
            ProbeKind::Force { field, about, particles } => {
                sum(field, particles, 1.0, now, scratch, row);
                let dimension = now.scheme().dimension();
                let places = now.values("position", particles);
                let padded = |vector: &[f64]| {
                    Vector3::from_fn(|i, _| vector.get(i).copied().unwrap_or_default())
                };
                let both = places.chunks_exact(dimension).zip(scratch.chunks_exact(dimension));
                let about = Vector3::from(*about);
                let moments =
                    both.map(|(place, force)| (padded(place) - about).cross(&padded(force)));
                let moment: Vector3<f64> = moments.sum();
                let first = 3 - moment_axes(dimension).len();
                row.extend_from_slice(&moment.as_slice()[first..]);
            }
            ProbeKind::Sensor(sensor) => row.push(sensor.record(now)),
            ProbeKind::Gauge(gauge) => row.push(gauge.record(now)),
            ProbeKind::Flux(flux) => row.push(flux.record(now)),
            ProbeKind::Void(void) => row.push(void.record(now)),
            ProbeKind::Opening(body) => {
                let passed = now.scheme().passed(now.state(), *body);
                let components = momentum_components(now.scheme().dimension()).len();
                match passed {
                    Some(it) => {
                        row.extend([it.entered, it.left, it.energy]);
                        row.extend(&it.momentum[..components]);
                    }
                    None => row.extend(std::iter::repeat_n(f64::NAN, 3 + components)),
                }
            }
            ProbeKind::Point(point) => {
                let first = row.len();
                point.record(now, scratch, row);
                // Of two places, the difference.
                if let [_, _] = point.places.as_slice() {
                    let width = (row.len() - first) / 2;
                    (first..first + width).for_each(|k| row[k] -= row[k + width]);
                    row.truncate(first + width);
                }
            }
            ProbeKind::Error(error) => row.push(error.record(now, scratch)),
            ProbeKind::Tangent { rule, step } => {
                let (time, state) = (now.time(), now.state());
                let tested = now
                    .scheme_mut()
                    .theta()
                    .map(|it| it.remainders(rule, time, *step, state, &SIZES));
                let left = tested.unwrap_or_default();
                let slopes = left.windows(2).map(|pair| (pair[0] / pair[1]).log10());
                let [least, largest] = slopes.fold([f64::NAN; 2], |[least, largest], slope| {
                    [least.min(slope), largest.max(slope)]
                });
                row.extend([least, largest]);
                row.extend((0..SIZES.len()).map(|k| left.get(k).copied().unwrap_or(f64::NAN)));
            }
        }
    }
}

/// Appends the sums of a field over particles times a factor, by component; values are left in `scratch`.
fn sum(
    field: &FieldDescription,
    particles: &[u32],
    factor: f64,
    now: &mut Observation,
    scratch: &mut Vec<f64>,
    row: &mut Vec<f64>,
) {
    scratch.clear();
    now.read(field, particles, scratch);
    let components = field.kind.components(now.scheme().dimension());
    let of = |component: usize| scratch.iter().skip(component).step_by(components).sum::<f64>();
    row.extend((0..components).map(|component| of(component) * factor));
}

/// Those of some particles that are in a box at a time.
pub(super) fn within(
    [lower, upper]: &[Vec<f64>; 2],
    particles: &[u32],
    now: &mut Observation,
) -> Vec<u32> {
    let places = now.values("position", particles);
    let is_inside = |place: &[f64]| {
        place.iter().zip(lower.iter().zip(upper)).all(|(x, (low, high))| low <= x && x <= high)
    };
    let of_particles = places.chunks_exact(now.scheme().dimension()).zip(particles);
    of_particles.filter(|(place, _)| is_inside(place)).map(|(_, particle)| *particle).collect()
}

/// A column for each component of each field, with names that start with that of a probe.
pub(super) fn component_columns(
    probe: &str,
    fields: &[FieldDescription],
    dimension: usize,
) -> Vec<Column> {
    let columns = |field: &FieldDescription| {
        let (name, kind, unit) = (field.name, field.kind, field.unit);
        let column = move |component: String| {
            let dot = if component.is_empty() { "" } else { "." };
            Column::new(format!("{probe}.{name}{dot}{component}"), unit)
        };
        let components =
            (0..kind.components(dimension)).map(|number| component_name(kind, number, dimension));
        components.map(column).collect::<Vec<_>>()
    };
    fields.iter().flat_map(columns).collect()
}
