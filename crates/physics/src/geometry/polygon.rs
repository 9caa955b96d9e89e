//! Polygons of the plane.

use super::GeometryError;
use super::error::positive;
use crate::Vector;

/// The sides, each from one corner to the next.
fn sides(corners: &[Vector<2>]) -> impl Iterator<Item = [Vector<2>; 2]> + Clone + '_ {
    let next = corners.iter().cycle().skip(1);
    corners.iter().zip(next).map(|(from, to)| [*from, *to])
}

/// Twice the area of a triangle in m^2, above 0 where it is gone round counter-clockwise.
fn twice_area([a, b, c]: [Vector<2>; 3]) -> f64 {
    (b - a).perp(&(c - a))
}

/// The area in m^2, above 0 where corners go round counter-clockwise.
pub(super) fn area(corners: &[Vector<2>]) -> f64 {
    let about = corners[0];
    0.5 * sides(corners).map(|[from, to]| twice_area([about, from, to])).sum::<f64>()
}

/// The depth in m below the nearest side, negative outside.
pub(super) fn depth(corners: &[Vector<2>], point: &Vector<2>) -> f64 {
    let mut is_inside = false;
    let mut least = f64::INFINITY;
    for [from, to] in sides(corners) {
        // A ray along x goes in or out where it crosses a side.
        if (from.y > point.y) != (to.y > point.y) {
            let is_left = twice_area([from, to, *point]) > 0.0;
            is_inside ^= is_left == (to.y > from.y);
        }
        least = least.min(distance(point, &[from, to]));
    }
    if is_inside { least } else { -least }
}

/// The distance in m from a point to a side.
fn distance(point: &Vector<2>, [from, to]: &[Vector<2>; 2]) -> f64 {
    let (side, arm) = (to - from, point - from);
    let along = (arm.dot(&side) / side.norm_squared()).clamp(0.0, 1.0);
    (arm - side * along).norm()
}

/// Refuses less than three corners, corners that are the same, sides that cross, touch or lie on each other.
pub(super) fn check(corners: &[Vector<2>]) -> Result<(), GeometryError> {
    if corners.len() < 3 {
        return Err(GeometryError::FewCorners { count: corners.len() });
    }
    let sides: Vec<_> = sides(corners).collect();
    for [from, to] in &sides {
        positive(
            "a side of a polygon (its last corner is joined to its first)",
            (to - from).norm(),
        )?;
    }
    for (i, one) in sides.iter().enumerate() {
        for (j, other) in sides.iter().enumerate().skip(i + 1) {
            // Neighbours have a corner in common, and meet elsewhere only where they lie on each other.
            let meet = if j == i + 1 {
                distance(&other[1], one) == 0.0 || distance(&one[0], other) == 0.0
            } else if i == 0 && j + 1 == sides.len() {
                distance(&other[0], one) == 0.0 || distance(&one[1], other) == 0.0
            } else {
                cross(one, other)
            };
            if meet {
                return Err(GeometryError::CrossingSides { first: i + 1, second: j + 1 });
            }
        }
    }
    Ok(())
}

/// Whether sides of two polygons have a point in common.
pub(super) fn meet(one: &[Vector<2>], other: &[Vector<2>]) -> bool {
    sides(one).any(|own| sides(other).any(|side| cross(&own, &side)))
}

/// Whether two sides have a point in common.
fn cross(one: &[Vector<2>; 2], other: &[Vector<2>; 2]) -> bool {
    let apart = |[a, b]: &[Vector<2>; 2], [c, d]: &[Vector<2>; 2]| {
        twice_area([*a, *b, *c]) * twice_area([*a, *b, *d]) < 0.0
    };
    let touch = |point: &Vector<2>, side: &[Vector<2>; 2]| distance(point, side) == 0.0;
    (apart(one, other) && apart(other, one))
        || one.iter().any(|point| touch(point, other))
        || other.iter().any(|point| touch(point, one))
}
