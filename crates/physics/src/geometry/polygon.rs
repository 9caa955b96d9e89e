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
                touch(&other[1], one).or_else(|| touch(&one[0], other))
            } else if i == 0 && j + 1 == sides.len() {
                touch(&other[0], one).or_else(|| touch(&one[1], other))
            } else {
                cross(one, other)
            };
            if let Some(place) = meet {
                let place = place.into();
                return Err(GeometryError::CrossingSides { first: i + 1, second: j + 1, place });
            }
        }
    }
    Ok(())
}

/// A point that sides of two polygons have in common.
pub(super) fn meet(one: &[Vector<2>], other: &[Vector<2>]) -> Option<Vector<2>> {
    sides(one).find_map(|own| sides(other).find_map(|side| cross(&own, &side)))
}

/// A point that two sides have in common.
fn cross(one: &[Vector<2>; 2], other: &[Vector<2>; 2]) -> Option<Vector<2>> {
    // Twice the areas of the ends of a side with another.
    let areas =
        |[a, b]: &[Vector<2>; 2], side: &[Vector<2>; 2]| side.map(|end| twice_area([*a, *b, end]));
    let apart = |[c, d]: [f64; 2]| c * d < 0.0;
    let ends = areas(one, other);
    if apart(ends) && apart(areas(other, one)) {
        return Some(other[0] + (other[1] - other[0]) * (ends[0] / (ends[0] - ends[1])));
    }
    let end = one.iter().find_map(|point| touch(point, other));
    end.or_else(|| other.iter().find_map(|point| touch(point, one)))
}

/// The point, if it is on a side.
fn touch(point: &Vector<2>, side: &[Vector<2>; 2]) -> Option<Vector<2>> {
    (distance(point, side) == 0.0).then_some(*point)
}
