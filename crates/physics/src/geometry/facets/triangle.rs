//! What is asked of single triangles.

use super::Triangle;
use crate::Vector;

/// The area vector of a triangle.
pub(super) fn area([a, b, c]: &Triangle) -> Vector<3> {
    (b - a).cross(&(c - a)) * 0.5
}

/// Lower and upper corner of the box around a triangle.
pub(super) fn ends([a, b, c]: &Triangle) -> [Vector<3>; 2] {
    [a.inf(b).inf(c), a.sup(b).sup(c)]
}

/// The solid angle of a triangle as seen from a point, more than zero from behind.
pub(super) fn solid_angle(triangle: &Triangle, point: &Vector<3>) -> f64 {
    let (a, b, c) = (triangle[0] - point, triangle[1] - point, triangle[2] - point);
    let (x, y, z) = (a.norm(), b.norm(), c.norm());
    let volume = a.dot(&b.cross(&c));
    let below = x * y * z + a.dot(&b) * z + b.dot(&c) * x + c.dot(&a) * y;
    2.0 * volume.atan2(below)
}

/// The place on a triangle that is nearest to a point: by the part of its plane that this is over.
pub(super) fn nearest_of([a, b, c]: &Triangle, point: &Vector<3>) -> Vector<3> {
    let (ab, ac, ap) = (b - a, c - a, point - a);
    let (d1, d2) = (ab.dot(&ap), ac.dot(&ap));
    if d1 <= 0.0 && d2 <= 0.0 {
        return *a;
    }
    let bp = point - b;
    let (d3, d4) = (ab.dot(&bp), ac.dot(&bp));
    if d3 >= 0.0 && d4 <= d3 {
        return *b;
    }
    let over_ab = d1 * d4 - d3 * d2;
    if over_ab <= 0.0 && d1 >= 0.0 && d3 <= 0.0 {
        return a + ab * (d1 / (d1 - d3));
    }
    let cp = point - c;
    let (d5, d6) = (ab.dot(&cp), ac.dot(&cp));
    if d6 >= 0.0 && d5 <= d6 {
        return *c;
    }
    let over_ac = d5 * d2 - d1 * d6;
    if over_ac <= 0.0 && d2 >= 0.0 && d6 <= 0.0 {
        return a + ac * (d2 / (d2 - d6));
    }
    let over_bc = d3 * d6 - d5 * d4;
    let (along, back) = (d4 - d3, d5 - d6);
    if over_bc <= 0.0 && along >= 0.0 && back >= 0.0 {
        return b + (c - b) * (along / (along + back));
    }
    let whole = over_ab + over_ac + over_bc;
    a + ab * (over_ac / whole) + ac * (over_ab / whole)
}

/// How far along a direction a ray meets a triangle.
pub(super) fn meets([a, b, c]: &Triangle, point: &Vector<3>, direction: &Vector<3>) -> Option<f64> {
    let (ab, ac) = (b - a, c - a);
    let across = direction.cross(&ac);
    let volume = ab.dot(&across);
    if volume == 0.0 {
        return None;
    }
    let arm = point - a;
    let first = arm.dot(&across) / volume;
    let turned = arm.cross(&ab);
    let second = direction.dot(&turned) / volume;
    let is_on = first >= 0.0 && second >= 0.0 && first + second <= 1.0;
    is_on.then(|| ac.dot(&turned) / volume)
}

/// What is smaller than this part of the lengths that it is made of may be round-off.
const ROUND_OFF: f64 = 64.0 * f64::EPSILON;

/// The change of the winding number on the straight way from one point to another through a triangle: -1 out of it, 1 into
/// it, 0 beside it. `None` for a way through its boundary or one that ends on it, as far as round-off tells.
pub(super) fn passage(triangle: &Triangle, from: &Vector<3>, to: &Vector<3>) -> Option<i32> {
    let [a, b, c] = triangle.map(|corner| corner - from);
    let (way, sides) = (to - from, [b - a, c - a]);
    let normal = sides[0].cross(&sides[1]);
    let size = sides[0].norm() * sides[1].norm();
    let sure = |value: f64, scale: f64| match value.abs() > ROUND_OFF * scale {
        true => value.signum() as i32,
        false => 0,
    };
    // The sides of its plane on which the ends of the way are.
    let beyond = a - way;
    let ends = [
        sure(-normal.dot(&a), size * a.norm()),
        sure(-normal.dot(&beyond), size * (a.norm() + way.norm())),
    ];
    if ends[0] * ends[1] > 0 {
        return Some(0);
    }
    // The sides of its edges on which the line of the way passes.
    let square = a.norm_squared().max(b.norm_squared()).max(c.norm_squared());
    let passes = [(a, b), (b, c), (c, a)]
        .map(|(one, other)| sure(way.dot(&one.cross(&other)), way.norm() * square));
    if passes.contains(&1) && passes.contains(&-1) {
        return Some(0);
    }
    let is_sure = !ends.contains(&0) && !passes.contains(&0);
    is_sure.then_some(ends[0])
}

/// Where two triangles without a common corner cross: a side of one goes through the other there. Those that lie in one plane
/// do not count.
pub(super) fn cross(one: &Triangle, other: &Triangle) -> Option<Vector<3>> {
    if one.iter().any(|corner| other.contains(corner)) {
        return None;
    }
    let goes_through = |sides: &Triangle, triangle: &Triangle| {
        (0..3).find_map(|k| {
            let way = sides[(k + 1) % 3] - sides[k];
            let part = meets(triangle, &sides[k], &way)?;
            (part > 0.0 && part < 1.0).then(|| sides[k] + way * part)
        })
    };
    goes_through(one, other).or_else(|| goes_through(other, one))
}
