//! Bodies that are partly in the same place, or touch.

use std::collections::BTreeSet;

use super::bodies::shape;
use crate::case::diagnostics::Problem;
use crate::case::model::{Body, Case, LatticeOrigin};
use crate::geometry::Particles;
use crate::neighbors::{Domain, search};

/// The largest depth in spacings at which a particle may lie in another body. Where two bodies touch it is half a spacing
/// outside, or on the common face.
const DEPTH: f64 = 0.5;

/// The largest distance in spacings of two particles of bodies that touch, whose particles are half a spacing from their
/// faces: where lattices are shifted along the common face by half a spacing in each direction, 1.23 in 3D.
const TOUCH: f64 = 1.25;

/// By how much less that is for each body that has particles on its faces; 0.71 of both, and 0.87 of one, are needed.
const ON_FACE: f64 = 0.25;

/// What to do about bodies that overlap.
pub(super) const REMEDY: &str =
    "move one of them, or cut one out of the other with a shape of the kind `difference`";

/// The pairs of bodies that overlap, a problem each. Walls may overlap one another; those in the buffer of an opening are
/// told of with it. Of two bodies from files nothing is known but their particles: they are not compared.
pub(super) fn overlaps<const D: usize>(
    case: &Case,
    domain: &Domain<D>,
    particles: &Particles<D>,
) -> Vec<Problem> {
    // Particles are stored body by body.
    let start = |body: usize| particles.body.partition_point(|&of| (of as usize) < body);
    let rows: Vec<_> = (0..case.bodies.len()).map(|body| start(body)..start(body + 1)).collect();
    let mut found: Vec<[usize; 2]> = Vec::new();
    let mut problems = Vec::new();
    for (number, body) in case.bodies.iter().enumerate() {
        // A shape that cannot be built has been refused.
        let inner = (!body.shape.is_from_file()).then(|| shape::<D>(case, body, &body.shape));
        let Some(Ok(inner)) = inner else { continue };
        let (min, max) = inner.bounding_box();
        let center = (min + max) / 2.0;
        let spacing = body.spacing.iter().copied().fold(f64::INFINITY, f64::min);
        // The first particle of a body that lies deeper than this part of a spacing. In a periodic box it may be the
        // image of one.
        let deeper = |other: usize, depth: f64| {
            let first = rows[other].start;
            let deeper = inner.first_deeper(rows[other].len(), |offset| {
                let (x, own) =
                    (&particles.position[first + offset], particles.spacing[first + offset]);
                (center + domain.separation(&center, x), depth * spacing.min(own))
            });
            deeper.map(|offset| first + offset)
        };
        // None of its own lies deeper in a body of one or two layers.
        let depth = if deeper(number, DEPTH).is_none() { 0.5 * DEPTH } else { DEPTH };
        for (other, outer) in case.bodies.iter().enumerate() {
            let is_exempt = |one: &Body, two: &Body| {
                one.wall.is_some() && (two.wall.is_some() || two.opening.is_some())
            };
            let may_overlap = is_exempt(body, outer) || is_exempt(outer, body);
            if other == number || may_overlap || found.contains(&[other, number]) {
                continue;
            }
            if let Some(particle) = deeper(other, depth) {
                found.push([number, other]);
                problems.push(problem(case, [body, outer], particles, particle));
            }
        }
    }
    problems
}

/// Particle `a` of the second body lies in the first.
fn problem<const D: usize>(
    case: &Case,
    [body, other]: [&Body; 2],
    particles: &Particles<D>,
    a: usize,
) -> Problem {
    let remedy = if other.shape.is_from_file() { "move one of them" } else { REMEDY };
    let message = format!(
        "the bodies `{0}` and `{1}` overlap: particle {2} of `{1}`, at {3:?} m, lies inside `{0}`",
        *body.name,
        *other.name,
        particles.id[a],
        particles.position[a].as_slice(),
    );
    let label = format!("body `{}`", *body.name);
    case.problem_at(body.shape.place, message, label, Some(remedy.to_owned()))
}

/// The pairs of bodies of a solid that touch at the start although none of their particles see those of the other, which
/// are those of another `group`, and that do not `share` particles: a warning each, with what to do.
pub(super) fn touching<const D: usize>(
    case: &Case,
    domain: &Domain<D>,
    particles: &Particles<D>,
    group: &[u32],
    (share, remedy): (impl Fn(u32, u32) -> bool, &str),
) -> Vec<String> {
    if group.iter().all(|of| *of == group[0]) {
        return Vec::new();
    }
    let reach: Vec<f64> = particles.spacing.iter().map(|spacing| TOUCH * spacing).collect();
    // What cannot be searched is refused with its supports.
    let Ok(list) = search(&particles.position, &reach, domain) else { return Vec::new() };
    // The spacing of a particle along an axis, in m: lattices may have another along each.
    let spacing = |a: usize, axis: usize| {
        let of_body = &case.bodies[particles.body[a] as usize].spacing;
        of_body.get(axis).or(of_body.first()).copied().unwrap_or(particles.spacing[a])
    };
    let are_close = |a: usize, b: usize| {
        let way = domain.separation(&particles.position[a], &particles.position[b]);
        let in_spacings = |axis| 2.0 * way[axis] / (spacing(a, axis) + spacing(b, axis));
        let on_face = |&a: &usize| {
            let body = &case.bodies[particles.body[a] as usize];
            !body.shape.is_points() && body.lattice.on == LatticeOrigin::Boundary
        };
        let most = TOUCH - ON_FACE * [a, b].iter().filter(|a| on_face(a)).count() as f64;
        (0..D).map(in_spacings).map(|way| way * way).sum::<f64>() < most * most
    };
    let mut found = BTreeSet::new();
    for a in 0..particles.len() {
        let others = list.row(a).iter().map(|&b| b as usize);
        let others = others.filter(|&b| group[b] != group[a] && are_close(a, b));
        found.extend(others.map(|b| {
            let (one, other) = (particles.body[a], particles.body[b]);
            (one.min(other), one.max(other))
        }));
    }
    let name = |body: u32| &*case.bodies[body as usize].name;
    let warn = |(one, other)| {
        format!(
            "the bodies `{}` and `{}` touch at the start and would pass through each other, as bodies of one system do \
             not see each other: {remedy}, or give each a `[[system]]` in a fluid",
            name(one),
            name(other)
        )
    };
    found.into_iter().filter(|(one, other)| !share(*one, *other)).map(warn).collect()
}
