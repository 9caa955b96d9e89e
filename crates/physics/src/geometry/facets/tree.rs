//! A tree of boxes around triangles, and what is asked of it.

use std::f64::consts::PI;

use rayon::prelude::*;

use super::Triangle;
use crate::{Tensor, Vector};

/// Most triangles of a leaf.
const LEAF: usize = 4;

/// A node is far from a point if that is further from its middle than so many times its radius: the triangles of its
/// leaves are then taken together.
const FAR: f64 = 2.0;

/// Most nodes that wait while the tree is walked: two a level, of which there are at most 32.
const DEEPEST: usize = 64;

/// Boxes around triangles, each node before what is below it.
#[derive(Clone, PartialEq)]
pub(super) struct Tree {
    triangles: Vec<Triangle>,
    nodes: Vec<Node>,
}

#[derive(Clone, Debug, PartialEq)]
struct Node {
    low: Vector<3>,
    high: Vector<3>,
    /// The sum of the area vectors, in m^2.
    area: Vector<3>,
    /// The sum of `(x - middle) (x) area` over its triangles, in m^3.
    spread: Tensor<3>,
    trace: f64,
    /// The middle of the areas, and how far the box goes from there, in m.
    middle: Vector<3>,
    radius: f64,
    below: Below,
}

#[derive(Clone, Copy, Debug, PartialEq)]
enum Below {
    /// The second of two nodes; the first one follows this.
    Nodes(u32),
    /// Triangles, the first and how many.
    Triangles(u32, u32),
}

/// The number of triangles: there may be millions.
impl std::fmt::Debug for Tree {
    fn fmt(&self, out: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(out, "{} triangles", self.triangles.len())
    }
}

impl Tree {
    pub fn new(mut triangles: Vec<Triangle>) -> Self {
        let mut nodes = Vec::with_capacity(triangles.len());
        add(&mut triangles, 0, &mut nodes);
        Self { triangles, nodes }
    }

    pub fn triangles(&self) -> &[Triangle] {
        &self.triangles
    }

    pub fn bounds(&self) -> (Vector<3>, Vector<3>) {
        (self.nodes[0].low, self.nodes[0].high)
    }

    /// Visits the triangles of all nodes that `enters` lets it into.
    #[inline]
    fn visit(&self, mut enters: impl FnMut(&Node) -> bool, mut see: impl FnMut(&Triangle)) {
        let (mut open, mut count) = ([0u32; DEEPEST], 1);
        while count > 0 {
            count -= 1;
            let number = open[count];
            let node = &self.nodes[number as usize];
            if !enters(node) {
                continue;
            }
            match node.below {
                Below::Nodes(second) => {
                    (open[count], open[count + 1]) = (second, number + 1);
                    count += 2;
                }
                Below::Triangles(first, count) => {
                    self.triangles[first as usize..][..count as usize].iter().for_each(&mut see);
                }
            }
        }
    }

    /// The place on a triangle that is nearest to a point.
    pub fn nearest(&self, point: &Vector<3>) -> Vector<3> {
        let (mut best, mut square) = (self.triangles[0][0], f64::INFINITY);
        let (mut open, mut count) = ([(0u32, 0.0); DEEPEST], 1);
        while count > 0 {
            count -= 1;
            let (number, least) = open[count];
            if least >= square {
                continue;
            }
            match self.nodes[number as usize].below {
                Below::Nodes(second) => {
                    let one = (number + 1, self.nodes[number as usize + 1].square(point));
                    let other = (second, self.nodes[second as usize].square(point));
                    // The nearer one is looked at first.
                    let (last, next) = if one.1 < other.1 { (other, one) } else { (one, other) };
                    (open[count], open[count + 1]) = (last, next);
                    count += 2;
                }
                Below::Triangles(first, many) => {
                    for triangle in &self.triangles[first as usize..][..many as usize] {
                        let found = nearest_of(triangle, point);
                        let distance = (found - point).norm_squared();
                        if distance < square {
                            (best, square) = (found, distance);
                        }
                    }
                }
            }
        }
        best
    }

    /// Adds the nearest places of all triangles that are at most so far from a point.
    pub fn within(&self, point: &Vector<3>, reach: f64, found: &mut Vec<Vector<3>>) {
        let square = reach * reach;
        self.visit(
            |node| node.square(point) <= square,
            |triangle| {
                let place = nearest_of(triangle, point);
                if (place - point).norm_squared() <= square {
                    found.push(place);
                }
            },
        );
    }

    /// The winding number, theory (97), (98). The solid angle of a far node is that of its area in the middle, with the slope of the solid angle over
    /// its spread: right to the third power of radius over distance.
    pub fn winding(&self, point: &Vector<3>) -> f64 {
        let (mut far, mut near) = (0.0, 0.0);
        self.visit(
            |node| {
                let way = node.middle - point;
                let distance = way.norm();
                let is_far = distance > FAR * node.radius;
                if is_far {
                    let square = distance * distance;
                    let sloped = 3.0 * way.dot(&(node.spread * way)) / square;
                    far +=
                        (node.area.dot(&way) + node.spread.trace() - sloped) / (square * distance);
                }
                !is_far
            },
            |triangle| near += solid_angle(triangle, point),
        );
        (far + near) / (4.0 * PI)
    }

    /// How far it is from a point along a unit direction to the nearest triangle, beyond `least`.
    fn along(&self, point: &Vector<3>, direction: &Vector<3>, least: f64) -> f64 {
        let best = std::cell::Cell::new(f64::INFINITY);
        self.visit(
            |node| node.entry(point, direction) < best.get(),
            |triangle| {
                if let Some(length) = meets(triangle, point, direction)
                    && length > least
                {
                    best.set(best.get().min(length));
                }
            },
        );
        best.get()
    }

    /// See [`super::Facets::thickness`].
    pub fn thickness(&self) -> f64 {
        let (low, high) = self.bounds();
        let least = 1e-9 * (high - low).norm();
        let through = |triangle: &Triangle| {
            let [a, b, c] = triangle;
            let inwards = -area(triangle).normalize();
            self.along(&((a + b + c) / 3.0), &inwards, least)
        };
        self.triangles.par_iter().map(through).reduce(|| f64::INFINITY, f64::min)
    }

    /// See [`super::Facets::crossings`].
    pub fn crossings(&self) -> usize {
        let crossed = |(number, triangle): (usize, &Triangle)| {
            let [low, high] = [Vector::inf, Vector::sup].map(
                |choose: fn(&Vector<3>, &Vector<3>) -> Vector<3>| {
                    triangle[1..].iter().fold(triangle[0], |end, corner| choose(&end, corner))
                },
            );
            let mut count = 0;
            let mut open = vec![0u32];
            while let Some(at) = open.pop() {
                let node = &self.nodes[at as usize];
                if (0..3).any(|axis| node.low[axis] > high[axis] || node.high[axis] < low[axis]) {
                    continue;
                }
                match node.below {
                    Below::Nodes(second) => open.extend([second, at + 1]),
                    Below::Triangles(first, many) => {
                        let others = (first..first + many).filter(|&other| other as usize > number);
                        count += others
                            .filter(|&other| cross(triangle, &self.triangles[other as usize]))
                            .count();
                    }
                }
            }
            count
        };
        self.triangles.par_iter().enumerate().map(crossed).sum()
    }
}

impl Node {
    /// The square of the distance of a point from the box.
    #[inline]
    fn square(&self, point: &Vector<3>) -> f64 {
        let mut square = 0.0;
        for axis in 0..3 {
            let (below, above) = (self.low[axis] - point[axis], point[axis] - self.high[axis]);
            let beyond = if below > above { below } else { above };
            square += if beyond > 0.0 { beyond * beyond } else { 0.0 };
        }
        square
    }

    /// How far along a direction a ray enters the box; infinite if it does not.
    fn entry(&self, point: &Vector<3>, direction: &Vector<3>) -> f64 {
        let (mut first, mut last) = (0.0_f64, f64::INFINITY);
        for axis in 0..3 {
            let ends = [self.low[axis], self.high[axis]].map(|end| end - point[axis]);
            if direction[axis] == 0.0 {
                if ends[0] > 0.0 || ends[1] < 0.0 {
                    return f64::INFINITY;
                }
                continue;
            }
            let [one, other] = ends.map(|end| end / direction[axis]);
            (first, last) = (first.max(one.min(other)), last.min(one.max(other)));
        }
        // What lies in a face of the box is met in spite of round-off.
        if first <= last * (1.0 + 1e-12) { first } else { f64::INFINITY }
    }
}

/// Adds the node around triangles of which so many others come before, and all below it.
fn add(triangles: &mut [Triangle], before: u32, nodes: &mut Vec<Node>) {
    let [mut low, mut high] = [f64::INFINITY, f64::NEG_INFINITY].map(Vector::<3>::repeat);
    let (mut sum, mut middle, mut whole) = (Vector::zeros(), Vector::zeros(), 0.0);
    for triangle in &*triangles {
        for corner in triangle {
            (low, high) = (low.inf(corner), high.sup(corner));
        }
        let area = area(triangle);
        sum += area;
        middle += thrice_centre(triangle) * (area.norm() / 3.0);
        whole += area.norm();
    }
    middle /= whole;
    let outer =
        |triangle: &Triangle| (thrice_centre(triangle) / 3.0 - middle) * area(triangle).transpose();
    let spread: Tensor<3> = triangles.iter().map(outer).sum();
    let radius = (high - middle).abs().sup(&(low - middle).abs()).norm();
    let number = nodes.len();
    let below = Below::Triangles(before, triangles.len() as u32);
    nodes.push(Node { low, high, area: sum, spread, trace: spread.trace(), middle, radius, below });
    if triangles.len() <= LEAF {
        return;
    }
    let axis = (high - low).imax();
    let half = triangles.len() / 2;
    let along = |triangle: &Triangle| thrice_centre(triangle)[axis];
    triangles.select_nth_unstable_by(half, |a, b| along(a).total_cmp(&along(b)));
    let (first, second) = triangles.split_at_mut(half);
    add(first, before, nodes);
    nodes[number].below = Below::Nodes(nodes.len() as u32);
    add(second, before + half as u32, nodes);
}

fn thrice_centre([a, b, c]: &Triangle) -> Vector<3> {
    a + b + c
}

/// The area vector of a triangle.
pub(super) fn area([a, b, c]: &Triangle) -> Vector<3> {
    (b - a).cross(&(c - a)) * 0.5
}

/// The solid angle of a triangle as seen from a point, more than zero from behind [Oosterom1983].
fn solid_angle(triangle: &Triangle, point: &Vector<3>) -> f64 {
    let (a, b, c) = (triangle[0] - point, triangle[1] - point, triangle[2] - point);
    let (x, y, z) = (a.norm(), b.norm(), c.norm());
    let volume = a.dot(&b.cross(&c));
    let below = x * y * z + a.dot(&b) * z + b.dot(&c) * x + c.dot(&a) * y;
    2.0 * volume.atan2(below)
}

/// The place on a triangle that is nearest to a point: by the part of its plane that this is over.
fn nearest_of([a, b, c]: &Triangle, point: &Vector<3>) -> Vector<3> {
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
fn meets([a, b, c]: &Triangle, point: &Vector<3>, direction: &Vector<3>) -> Option<f64> {
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

/// Whether two triangles without a common corner cross: a side of one goes through the other.
fn cross(one: &Triangle, other: &Triangle) -> bool {
    if one.iter().any(|corner| other.contains(corner)) {
        return false;
    }
    let goes_through = |sides: &Triangle, triangle: &Triangle| {
        (0..3).any(|k| {
            let way = sides[(k + 1) % 3] - sides[k];
            meets(triangle, &sides[k], &way).is_some_and(|part| part > 0.0 && part < 1.0)
        })
    };
    goes_through(one, other) || goes_through(other, one)
}
