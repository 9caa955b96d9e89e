//! Walls that will not hold: thinner than the support of the kernel, or with gaps narrower than it.

use crate::Vector;
use crate::case::model::Case;
use crate::coordinates;
use crate::geometry::{Faces, Particles, Shape};

/// Steps a spacing in which a wall is probed.
const STEPS: f64 = 4.0;

/// What the user should know of the walls that `walls` is the union of, with the faces that
/// particles are behind, whether they count at their spacing and the support radius in m.
pub(super) fn warnings<const D: usize>(
    case: &Case,
    walls: &Shape<D>,
    particles: &Particles<D>,
    (faces, counts): (&[Faces<D>], impl Fn(&Vector<D>) -> bool),
    support: f64,
) -> Vec<String> {
    let is_wall = |a: &usize| {
        let body = &case.bodies[particles.body[*a] as usize];
        body.wall.is_some() && body.system.is_none() && counts(&particles.position[*a])
    };
    let all: Vec<usize> = (0..particles.len()).filter(is_wall).collect();
    let thin = first(&all, particles, |a| {
        let spacing = particles.spacing[a];
        let (position, normal) = (&particles.position[a], &faces[a].between());
        // Only where the next layer would be in the fluid is there a face to measure from.
        if normal.norm_squared() == 0.0 || walls.contains(&(position + normal * spacing)) {
            return None;
        }
        let ahead = extent(walls, position, normal, spacing, support);
        let thickness = ahead + extent(walls, position, &-normal, spacing, support);
        (thickness < support - 0.6 * spacing).then_some(thickness)
    });
    let gap = first(&all, particles, |a| {
        let (position, spacing) = (&particles.position[a], particles.spacing[a]);
        (0..2 * D).find_map(|side| {
            let sign = if side % 2 == 0 { 1.0 } else { -1.0 };
            let direction = Vector::from_fn(|axis, _| if axis == side / 2 { sign } else { 0.0 });
            gap(walls, position, &direction, spacing, support)
        })
    });
    let name = |a: usize| &case.bodies[particles.body[a] as usize].name.value;
    let place = |a: usize| coordinates(particles.position[a].as_slice());
    let mut warnings = Vec::new();
    if let Some((a, thickness)) = thin {
        warnings.push(format!(
            "the wall `{}` is about {thickness:.3e} m thick at {} m, thinner than the support of the \
             kernel, {support:.3e} m: fluid may pass through it; make it {} layers of particles \
             thick",
            name(a),
            place(a),
            (support / particles.spacing[a] - 0.01).ceil()
        ));
    }
    if let Some((a, width)) = gap {
        warnings.push(format!(
            "the wall `{}` has a gap of about {width:.3e} m at {} m, narrower than the support of \
             the kernel, {support:.3e} m: particles on its two sides interact, and fluid may \
             leak; close it, or resolve it with smaller particles",
            name(a),
            place(a),
        ));
    }
    warnings
}

/// The particle of the smallest number in the order of creation for which `found` gives something.
fn first<const D: usize>(
    all: &[usize],
    particles: &Particles<D>,
    found: impl Fn(usize) -> Option<f64>,
) -> Option<(usize, f64)> {
    let found = all.iter().filter_map(|&a| Some((a, found(a)?)));
    found.min_by_key(|(a, _)| particles.id[*a])
}

/// How far the wall continues from a point inside it, at most `most` m.
fn extent<const D: usize>(
    walls: &Shape<D>,
    from: &Vector<D>,
    direction: &Vector<D>,
    spacing: f64,
    most: f64,
) -> f64 {
    let step = spacing / STEPS;
    let count = (most / step).ceil() as u32;
    let inside = |k: &u32| walls.contains(&(from + direction * (f64::from(*k) * step)));
    f64::from((1..=count).take_while(inside).count() as u32) * step
}

/// The width of the gap in which the wall ends ahead of a point inside it, if it goes on behind
/// one that is narrower than the support.
fn gap<const D: usize>(
    walls: &Shape<D>,
    from: &Vector<D>,
    direction: &Vector<D>,
    spacing: f64,
    support: f64,
) -> Option<f64> {
    let step = spacing / STEPS;
    let point = |k: u32| from + direction * (f64::from(k) * step);
    // The next particle is inside unless the gap is right here.
    let start = (1..=STEPS as u32).find(|&k| !walls.contains(&point(k)))?;
    let count = (support / step - 1e-9).ceil() as u32;
    let width = (1..count).find(|&k| walls.contains(&point(start + k)))?;
    Some(f64::from(width) * step)
}
