//! Particles turned into a weakly compressible fluid between walls.

use super::bodies::{self, BodyReport};
use super::{Built, initial, kernel, loads, probes, row_statistics, selections, tanks};
use crate::Vector;
use crate::boundaries::PrescribedVelocity;
use crate::case::diagnostics::Problem;
use crate::case::model::{self, Case};
use crate::geometry::{Faces, Particles, Shape};
use crate::neighbors::{Domain, NeighborStatistics, spatial_order};
use crate::schemes::transport_velocity::{
    Continuum, Fluid, Guard, Hypoelastic, Solid, SolidsInput, TransportVelocity,
    TransportVelocityError, TransportVelocityInput, Wall, WeaklyCompressible,
};
use crate::schemes::{Initial, Scheme};

/// Builds the scheme `transport_velocity`.
pub(super) fn build<const D: usize>(
    case: &Case,
    settings: &model::TransportVelocity,
    mut particles: Particles<D>,
    reports: Vec<BodyReport>,
    domain: Domain<D>,
) -> Result<(Box<dyn Scheme>, Built), Vec<Problem>> {
    let kernel = kernel(case, &settings.kernel)?;
    let spacing = particles.spacing.iter().copied().fold(0.0, f64::max);
    let smoothing_length = *settings.smoothing_length * spacing;
    let order = spatial_order(&particles.position, kernel.support_radius(smoothing_length));
    let place = settings.smoothing_length.place;
    particles.reorder(&order.map_err(|error| {
        vec![case.problem_at(place, error.to_string(), "with this smoothing length", None)]
    })?);
    let matter = match materials(case) {
        Some(materials) => Matter::Solids(materials),
        None => Matter::Fluid(fluid(case)?),
    };
    let (faces, shape) = faces(case, &particles)?;
    let mut problems = Vec::new();
    let probes = probes::probes(case, &particles, &mut problems);
    let lines = probes::lines(case, &particles);
    let motion = selections::prescribed(case, &particles, &mut problems);
    if !problems.is_empty() {
        return Err(problems);
    }
    let walls = walls(case);
    let (motion, held) = match matter {
        Matter::Solids(_) => split(motion, &particles, &walls),
        Matter::Fluid(_) => (motion, Vec::new()),
    };
    let mut warnings = Vec::new();
    let no_face = Faces::default();
    if faces
        .iter()
        .zip(&particles.body)
        .any(|(faces, &body)| walls.iter().any(|wall| wall.body == body) && *faces == no_face)
    {
        warnings.push(
            "some particles of walls have no way to the fluid inside the box around all bodies, \
             so that they have no normal: they do not hold back what flows through them"
                .into(),
        );
    }
    let support = kernel.support_radius(smoothing_length);
    if let Some(shape) = &shape {
        warnings.extend(tanks::warnings(case, shape, &particles, &faces, support));
    }
    let initial = initial(case, &particles);
    if let Matter::Fluid(fluid) = &matter {
        warnings.extend(compression(fluid, &initial));
    }
    let sliding = sliding(case, &particles);
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
        particles,
    };
    let refuse = |error: TransportVelocityError| {
        let (place, label) = match &error {
            TransportVelocityError::Start { .. } => {
                (case.bodies[0].name.place, "initial values of a body")
            }
            TransportVelocityError::SelfContact { .. } => {
                (settings.self_contact.as_ref().map_or(place, |it| it.place), "make it larger")
            }
            TransportVelocityError::Spacing { .. } => (case.bodies[0].spacing.place, "spacing"),
            _ => (place, "with this smoothing length"),
        };
        vec![case.problem_at(place, error.to_string(), label, None)]
    };
    let guard = Guard {
        bodies: case.bodies.iter().map(|body| body.name.value.clone()).collect(),
        removes: settings.removes_escaped,
    };
    let (scheme, (neighbors, poorly_supported)) = match matter {
        Matter::Fluid(fluid) => {
            let built = TransportVelocity::<D, WeaklyCompressible<D>>::new(input, fluid);
            guarded(built.map_err(refuse)?, guard)
        }
        Matter::Solids(materials) => {
            let solids = SolidsInput {
                materials,
                contact: settings.contact,
                self_contact: settings.self_contact.as_ref().map(|distance| **distance * spacing),
                corrected: settings.corrected_gradients,
                held,
            };
            let built = TransportVelocity::<D, Hypoelastic<D>>::new(input, solids);
            guarded(built.map_err(refuse)?, guard)
        }
    };
    Ok((scheme, Built { probes, lines, bodies: reports, neighbors, poorly_supported, warnings }))
}

/// What the bodies of a case are made of; the reader of cases has refused a mixture.
enum Matter {
    Fluid(Fluid),
    Solids(Vec<Solid>),
}

/// A system that looks for particles that escape, with the statistics of its neighbours.
fn guarded<const D: usize, M: Continuum<D>>(
    mut scheme: TransportVelocity<D, M>,
    guard: Guard,
) -> (Box<dyn Scheme>, (NeighborStatistics, Vec<u32>)) {
    scheme.guard(guard);
    // Particles deep in a wall may be alone.
    let statistics = row_statistics(&scheme, |a| !scheme.is_wall(a));
    (Box::new(scheme), statistics)
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
             1 % of a weakly compressible one: pressure and level will be off by as much from those of an \
             incompressible fluid; raise its wave speed to {:.3e} m/s",
            100.0 * pressure / stiffness,
            (pressure / (COMPRESSION * fluid.density)).sqrt()
        )
    })
}

/// The one fluid of the case: its bodies and walls must agree on it.
fn fluid(case: &Case) -> Result<Fluid, Vec<Problem>> {
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

fn walls(case: &Case) -> Vec<Wall> {
    let bodies = (0u32..).zip(&case.bodies);
    let wall = |(number, body): (u32, &model::Body)| {
        body.wall.as_ref().map(|wall| Wall { body: number, slip: wall.slip })
    };
    bodies.filter_map(wall).collect()
}

/// The shape of all walls together, and the faces that their particles are behind: the shortest ways
/// out of all walls together, inside the box around all bodies, so that the outer faces of a tank do
/// not count. In a periodic box the box itself is no wall either.
fn faces<const D: usize>(
    case: &Case,
    particles: &Particles<D>,
) -> Result<(Vec<Faces<D>>, Option<Shape<D>>), Vec<Problem>> {
    let mut faces = vec![Faces::default(); particles.len()];
    let is_wall: Vec<bool> = case.bodies.iter().map(|body| body.wall.is_some()).collect();
    if !is_wall.contains(&true) {
        return Ok((faces, None));
    }
    let (mut shapes, mut bounds) = (Vec::new(), None::<(Vector<D>, Vector<D>)>);
    for (number, (body, is_wall)) in case.bodies.iter().zip(&is_wall).enumerate() {
        let (low, high) = match (&body.shape.value, is_wall) {
            (shape, false) if shape.is_from_file() => box_around(particles, number),
            (shape, true) if shape.is_from_file() => {
                let message = "points from a file have no faces, which a wall needs";
                let help = Some("describe the wall by shapes".to_owned());
                return Err(vec![case.problem_at(body.shape.place, message, "of a wall", help)]);
            }
            _ => {
                let shape: Shape<D> =
                    bodies::shape(case, body, &body.shape).map_err(|problem| vec![problem])?;
                let ends = shape.bounding_box();
                if *is_wall {
                    shapes.push(shape);
                }
                ends
            }
        };
        let (least, most) = bounds.unwrap_or((low, high));
        bounds = Some((least.inf(&low), most.sup(&high)));
    }
    let (Some(bounds), Ok(walls)) = (bounds, Shape::union(shapes)) else {
        return Ok((faces, None));
    };
    crate::parallel::for_each_chunk(&mut faces, |first, rows| {
        for (offset, row) in rows.iter_mut().enumerate() {
            let number = first + offset;
            if is_wall[particles.body[number] as usize] {
                *row = walls.ways_out(&particles.position[number], &bounds);
            }
        }
    });
    Ok((faces, Some(walls)))
}

/// The corners of the box around the particles of a body.
fn box_around<const D: usize>(particles: &Particles<D>, body: usize) -> (Vector<D>, Vector<D>) {
    let ends = (Vector::repeat(f64::INFINITY), Vector::repeat(f64::NEG_INFINITY));
    let own = particles.position.iter().zip(&particles.body);
    own.filter(|(_, number)| **number as usize == body)
        .fold(ends, |(least, most), (x, _)| (least.inf(x), most.sup(x)))
}

/// The velocities of surfaces that slide.
fn sliding<const D: usize>(case: &Case, particles: &Particles<D>) -> Vec<PrescribedVelocity> {
    let mut conditions = Vec::new();
    for (number, body) in case.bodies.iter().enumerate() {
        let Some(wall) = &body.wall else { continue };
        for (component, value) in wall.sliding.iter().enumerate() {
            let Some(value) = value else { continue };
            let of_body = |&a: &u32| particles.body[a as usize] as usize == number;
            conditions.push(PrescribedVelocity {
                name: body.name.value.clone(),
                particles: (0..particles.len() as u32).filter(of_body).collect(),
                component,
                value: selections::function(value),
            });
        }
    }
    conditions
}
