//! Open boundaries: bodies that are buffers, and the particles that are to come in.

use std::sync::Arc;

use super::bodies::{self, vector};
use super::selections::over_time;
use crate::Vector;
use crate::boundaries::{Profiled, SpaceTime, padded};
use crate::case::diagnostics::Problem;
use crate::case::expression::Expression;
use crate::case::model::{self, Body, Case, OpenFlow, Opening};
use crate::case::source::Located;
use crate::coordinates;
use crate::geometry::Particles;
use crate::neighbors::search;
use crate::schemes::transport_velocity::{Flow, OpenBoundaries, OpenBoundary};

/// Relaxation time of mean pressures, in ways of sound through all bodies.
const WAYS: f64 = 20.0;

/// Which part of the particles waits in the reserve, if no number is given.
const RESERVE: f64 = 0.05;

/// What of all inflow may be missing among the outflow where the fluid can go nowhere else.
const UNBALANCED: f64 = 1e-6;

/// Times between start and end of a run, both included, at which prescribed velocities are compared.
const TIMES: u32 = 33;

/// Mean pressures at several openings may take this part of the time in which the fluid passes through all bodies. Of a tee
/// that it passes in 5.6 s, with two such openings, fluid circulates through both with 7.4 s, and does not with 3 s.
const SLOW: f64 = 0.5;

/// What velocities that are prescribed at an opening do at [`TIMES`].
struct Inflow {
    /// Volumes that come in, in m^D/s.
    rates: Vec<f64>,
    /// The largest mean speed along the normal in m/s.
    speed: f64,
}

/// Times of a run that are looked at, in s.
fn times(case: &Case) -> impl Iterator<Item = f64> {
    let end = *case.time.end;
    (0..TIMES).map(move |number| end * f64::from(number) / f64::from(TIMES - 1))
}

/// The diagonal of the box around all particles in m.
fn extent<const D: usize>(particles: &Particles<D>) -> f64 {
    let (low, high) = bodies::box_around(&particles.position);
    (high - low).norm()
}

/// A component of a velocity that is a flow rate over an area.
struct Share {
    rate: Arc<dyn SpaceTime>,
    factor: f64,
}

impl SpaceTime for Share {
    fn value(&self, x: [f64; 3], t: f64) -> f64 {
        self.factor * self.rate.value(x, t)
    }

    fn rate(&self, x: [f64; 3], t: f64) -> f64 {
        self.factor * self.rate.rate(x, t)
    }

    fn is_steady(&self) -> bool {
        self.rate.is_steady()
    }
}

/// The open boundaries of a case, whose particles become those of the first body of fluid, with particles in
/// reserve behind all others; and warnings.
pub(super) fn open<const D: usize>(
    case: &Case,
    settings: &model::TransportVelocity,
    particles: &mut Particles<D>,
    support: f64,
) -> Result<(OpenBoundaries<D>, Vec<String>), Vec<Problem>> {
    let buffers = || (0u32..).zip(&case.bodies).filter(|(_, body)| body.opening.is_some());
    if buffers().next().is_none() {
        if settings.reserve.is_some() && settings.refine.is_empty() {
            let message = "`reserve` has no meaning where no body has the key `opening` and nothing is refined";
            let help = Some("remove it".to_owned());
            return Err(vec![case.problem_at(case.scheme.place, message, "no meaning here", help)]);
        }
        return Ok((OpenBoundaries::default(), Vec::new()));
    }
    let is_fluid = |(_, body): &(u32, &Body)| body.wall.is_none() && body.opening.is_none();
    let Some((fluid, _)) = (0u32..).zip(&case.bodies).find(is_fluid) else {
        let place = case.scheme.place;
        let message = "every body is a wall or the buffer of an opening";
        return Err(vec![case.problem_at(place, message, "no fluid", None)]);
    };
    let mut open =
        OpenBoundaries { buffers: vec![0; particles.len()], ..OpenBoundaries::default() };
    let (mut problems, mut inflows) = (Vec::new(), Vec::new());
    for (number, body) in buffers() {
        let Some(opening) = &body.opening else { continue };
        match boundary(case, particles, (number, body, opening), support) {
            Ok((boundary, inflow)) => {
                open.all.push(boundary);
                inflows.push(inflow);
                let own = particles.body.iter().zip(&mut open.buffers);
                for (_, buffer) in own.filter(|(body, _)| **body == number) {
                    *buffer = open.all.len() as u32;
                }
            }
            Err(problem) => problems.push(problem),
        }
    }
    let cut = match problems.is_empty() && open.all.len() > 1 {
        true => cut_off(case, particles, &open)?,
        false => Vec::new(),
    };
    // What is in the way may move out of it, or the fluid rise above it.
    let is_of_system = |body: &Body| body.system.is_some();
    let moves = !case.boundaries.is_empty() || case.bodies.iter().any(is_of_system);
    let may_open = moves || settings.settings.free_surface;
    if !may_open {
        problems.extend(cut.iter().map(|boundary| {
            let place = case.bodies[boundary.body as usize].name.place;
            let help = "let fluid fill a way between them, two spacings wide at least, or remove the opening";
            case.problem_at(place, no_way_from(boundary), "cut off", Some(help.to_owned()))
        }));
    }
    if !problems.is_empty() {
        return Err(problems);
    }
    let cut = cut.iter().map(|boundary| {
        let message = no_way_from(boundary);
        format!(
            "{message} at the start: nothing passes until a moving body or rising \
             fluid opens one"
        )
    });
    let cut: Vec<String> = cut.collect();
    let in_buffers =
        particles.body.iter_mut().zip(&open.buffers).filter(|(_, buffer)| **buffer > 0);
    in_buffers.for_each(|(body, _)| *body = fluid);
    let unbalanced = unbalanced(case, &inflows, settings.settings.free_surface);
    let slow = slow(&open, &inflows, extent(particles));
    let warnings = unbalanced.into_iter().chain(slow).chain(cut).collect();
    let in_buffers = open.buffers.iter().filter(|buffer| **buffer > 0).count();
    let all = particles.body.iter().filter(|body| **body == fluid).count();
    let most = (RESERVE * all as f64).ceil() as usize;
    open.reserve = settings.reserve.map_or(most.max(2 * in_buffers), |reserve| reserve as usize);
    open.reserve += case.more_in_reserve;
    let model = open.buffers.iter().position(|buffer| *buffer > 0);
    let Some(model) = model else { return Ok((open, warnings)) };
    particles.reserve(model, fluid, open.reserve);
    open.buffers.resize(particles.len(), 0);
    Ok((open, warnings))
}

/// Fluid is continued by particles within this many spacings, neighbours along diagonals included.
const NEXT: f64 = 1.5;

/// The openings from which no way through the fluid leads to another one.
fn cut_off<'a, const D: usize>(
    case: &Case,
    particles: &Particles<D>,
    open: &'a OpenBoundaries<D>,
) -> Result<Vec<&'a OpenBoundary<D>>, Vec<Problem>> {
    let reach: Vec<f64> = particles.spacing.iter().map(|spacing| NEXT * spacing).collect();
    let list = search(&particles.position, &reach, &super::domain(case)?)
        .map_err(|error| vec![case.problem_at(case.scheme.place, error.to_string(), "", None)])?;
    let is_wall = |a: usize| case.bodies[particles.body[a] as usize].wall.is_some();
    let leads_on = |own: u32| {
        let of_own = |a: &usize| open.buffers[*a] == own;
        let mut next: Vec<usize> = (0..particles.len()).filter(of_own).collect();
        let mut seen: Vec<bool> = (0..particles.len()).map(|a| of_own(&a) || is_wall(a)).collect();
        while let Some(a) = next.pop() {
            for b in list.row(a).iter().map(|&b| b as usize) {
                if seen[b] {
                    continue;
                }
                if open.buffers[b] > 0 {
                    return true;
                }
                seen[b] = true;
                next.push(b);
            }
        }
        false
    };
    let cut = (1..).zip(&open.all).filter(|(own, _)| !leads_on(*own));
    Ok(cut.map(|(_, boundary)| boundary).collect())
}

/// What is said of an opening that is cut off.
fn no_way_from<const D: usize>(boundary: &OpenBoundary<D>) -> String {
    format!("no way through the fluid leads from `{}` to another opening", boundary.name)
}

/// The boundary of one buffer, with what comes in, if it is prescribed.
fn boundary<const D: usize>(
    case: &Case,
    particles: &Particles<D>,
    (number, body, opening): (u32, &Body, &Located<Opening>),
    support: f64,
) -> Result<(OpenBoundary<D>, Option<Inflow>), Problem> {
    let refuse = |message: String, label: &str, help: &str| {
        Err(case.problem_at(opening.place, message, label, Some(help.to_owned())))
    };
    let name = body.name.value.clone();
    if body.shape.value.is_from_file() {
        let message = format!("the buffer `{name}` is made of points from a file");
        return refuse(message, "no shape", "describe it by shapes");
    }
    let is_repeated =
        |axis: usize| case.domain.periodic[axis].is_some() && opening.normal[axis] != 0.0;
    if (0..D).any(is_repeated) {
        let message = format!(
            "the normal of the opening `{name}` points along a periodic axis, which has no end"
        );
        return refuse(message, "along a period", "make that axis open, or turn the normal");
    }
    let shape = bodies::shape::<D>(case, body, &body.shape)?;
    let normal: Vector<D> = vector(&opening.normal);
    let own = || (0..particles.len()).filter(|&a| particles.body[a] == number);
    let along = || own().map(|a| particles.position[a].dot(&normal));
    let [low, high] =
        [along().fold(f64::INFINITY, f64::min), along().fold(f64::NEG_INFINITY, f64::max)];
    let spacing = own().map(|a| particles.spacing[a]).fold(0.0, f64::max);
    let layers = ((high - low) / spacing).round();
    // Of a lattice that fits the shape, to the bit.
    let layer = if layers > 0.0 { (high - low) / layers } else { spacing };
    let (plane, length) = (high + 0.5 * layer, high - low + layer);
    if length < (1.0 - 1e-9) * support {
        let message = format!(
            "the buffer `{name}` is {length:.3e} m long along its normal, and the support of the kernel {support:.3e} m: \
             the fluid would see its end"
        );
        return refuse(message, "too short", "make its shape at least as long as the support");
    }
    let leaves = |a: &usize| {
        let place = particles.position[*a];
        let ends = [0.5 * layer, length - 0.5 * layer];
        let depth = plane - place.dot(&normal);
        ends.iter().any(|end| shape.depth(&(place + normal * (depth - end))) < -0.5 * spacing)
    };
    if let Some(a) = own().find(leaves) {
        let place = coordinates(particles.position[a].as_slice());
        let message = format!(
            "the buffer `{name}` does not extend straight along its normal, for example at \
             {place} m"
        );
        let help = "make it a box, or a `turned` one, whose sides are along the normal";
        return refuse(message, "not straight", help);
    }
    let volume: f64 = own().map(|a| particles.volume[a]).sum();
    let prescribed = |expression: &Expression| -> Arc<dyn SpaceTime> {
        let value = over_time(expression, opening.history.as_ref());
        let factor = opening.profile.as_ref().and_then(|it| Some((it, it.factor.clone()?)));
        match factor {
            Some((profile, factor)) => Arc::new(Profiled {
                value,
                profile: factor,
                from: padded(&vector::<D>(&profile.from)),
                normal: padded(&normal),
            }),
            None => value,
        }
    };
    let flow = match &opening.flow {
        OpenFlow::Velocity(velocity) => {
            Flow::Velocity(std::array::from_fn(|axis| prescribed(&velocity[axis])))
        }
        OpenFlow::Rate(rate) => {
            let rate = prescribed(rate);
            let share =
                |axis: usize| Share { rate: rate.clone(), factor: normal[axis] * length / volume };
            Flow::Velocity(std::array::from_fn(|axis| -> Arc<dyn SpaceTime> {
                Arc::new(share(axis))
            }))
        }
        OpenFlow::Pressure(pressure) => Flow::Pressure(prescribed(pressure)),
    };
    let expressions = opening.flow.expressions();
    let is_finite = |a: usize| {
        let value = |it: &Expression| it.eval(padded(&particles.position[a]), 0.0);
        expressions.iter().all(|it| value(it).is_finite())
    };
    if let Some(a) = own().find(|&a| !is_finite(a)) {
        let place = coordinates(particles.position[a].as_slice());
        let message =
            format!("the value prescribed at the opening `{name}` is not a number at {place} m");
        return refuse(message, "not finite", "correct the expression");
    }
    let relaxation = opening.relaxation.unwrap_or_else(|| {
        let density = body.material.density();
        WAYS * extent(particles) / (body.material.bulk_modulus(case.dimension) / density).sqrt()
    });
    let boundary = OpenBoundary {
        name: name.clone(),
        body: number,
        shape,
        normal,
        plane,
        length,
        flow,
        relaxation,
    };
    let is_in_front = |a: usize| {
        let body = &case.bodies[particles.body[a] as usize];
        let is_fluid = body.wall.is_none() && body.opening.is_none();
        let depth = boundary.depth(&particles.position[a], spacing);
        is_fluid && depth.is_some_and(|depth| (-support..0.0).contains(&depth))
    };
    if !(0..particles.len()).any(is_in_front) {
        let message = format!(
            "no fluid is in front of the opening `{name}`: none is within {support:.3e} m of its end along its normal"
        );
        let help =
            "put it beside the fluid, and let its normal point from the buffer into the fluid";
        return refuse(message, "leads nowhere", help);
    }
    let is_in_way = |a: &usize| {
        let depth = boundary.depth(&particles.position[*a], -spacing);
        let is_wall = case.bodies[particles.body[*a] as usize].wall.is_some();
        is_wall && depth.is_some_and(|depth| (-spacing..length).contains(&depth))
    };
    if let Some(a) = (0..particles.len()).find(is_in_way) {
        let wall = &case.bodies[particles.body[a] as usize].name.value;
        let message = format!(
            "the wall `{wall}` is in the opening `{name}`, at {} m",
            coordinates(particles.position[a].as_slice())
        );
        return refuse(
            message,
            "a wall is in the way",
            "cut the wall off there, or make the opening smaller",
        );
    }
    let inflow = matches!(boundary.flow, Flow::Velocity(_)).then(|| {
        let rate = |time: f64| {
            let inwards = own().map(|a| {
                let velocity = boundary.velocity(&particles.position[a], time);
                velocity.map_or(0.0, |velocity| particles.volume[a] * velocity.dot(&normal))
            });
            inwards.sum::<f64>() / length
        };
        let rates: Vec<f64> = times(case).map(rate).collect();
        let most = rates.iter().fold(0.0, |most: f64, rate| most.max(rate.abs()));
        Inflow { rates, speed: most * length / volume }
    });
    Ok((boundary, inflow))
}

/// A warning of flow rates that do not balance where all are prescribed and the fluid has no surface to rise.
fn unbalanced(case: &Case, inflows: &[Option<Inflow>], has_surface: bool) -> Option<String> {
    let all: Option<Vec<&Inflow>> = inflows.iter().map(Option::as_ref).collect();
    let all = all.filter(|_| !has_surface)?;
    let at = |(number, time): (usize, f64)| {
        let rates = || all.iter().map(|inflow| inflow.rates[number]);
        let (sum, size): (f64, f64) = (rates().sum(), rates().map(f64::abs).sum());
        (sum.abs() > UNBALANCED * size).then_some((time, sum))
    };
    let (time, sum) = times(case).enumerate().find_map(at)?;
    Some(format!(
        "velocities or flow rates are prescribed at all openings, and {sum:.3e} m^D/s more flow in than out at t = \
         {time} s: the pressure will rise or fall without bound; prescribe the pressure at one of them"
    ))
}

/// A warning of mean pressures that follow slowly at several openings, theory (87): fluid may circulate through them.
fn slow<const D: usize>(
    open: &OpenBoundaries<D>,
    inflows: &[Option<Inflow>],
    extent: f64,
) -> Option<String> {
    let ends = || open.all.iter().filter(|opening| matches!(opening.flow, Flow::Pressure(_)));
    let speed = inflows.iter().flatten().fold(0.0, |most: f64, inflow| most.max(inflow.speed));
    let (way, time) = (extent / speed, ends().fold(0.0, |most: f64, end| most.max(end.relaxation)));
    (ends().count() > 1 && time > SLOW * way).then(|| {
        format!(
            "pressures are prescribed at several openings and follow within {time:.2} s, in which the fluid may circulate through \
             them: it passes in {way:.2} s; set `relaxation` of each `opening` to at most {:.2}",
            SLOW * way
        )
    })
}
