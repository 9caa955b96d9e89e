//! A tree of boxes around triangles, and what is asked of it.

use std::f64::consts::PI;
use std::sync::atomic::{AtomicU64, AtomicUsize, Ordering};

use rayon::prelude::*;

use super::local::Local;
use super::triangle::{area, cross, ends, meets, nearest_of, passage, solid_angle};
use super::{Spot, Triangle};
use crate::{Tensor, Vector};

/// Most triangles of a leaf.
const LEAF: usize = 4;

/// A node is far from a point if that is further from its middle than this many times its radius: the triangles of its
/// leaves are then taken together.
const FAR: f64 = 2.0;

/// Most nodes that wait while the tree is walked: two a level, of which there are at most 32.
const DEEPEST: usize = 64;

/// Boxes around triangles, each node before what is below it.
#[derive(Clone, PartialEq)]
pub(super) struct Tree {
    triangles: Vec<Triangle>,
    /// The number of the facet of a file that each triangle is of.
    numbers: Vec<u32>,
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
    /// That of triangles with the number of a facet each.
    pub fn new(mut facets: Vec<(Triangle, u32)>) -> Self {
        let mut nodes = Vec::with_capacity(facets.len());
        add(&mut facets, 0, &mut nodes);
        let (triangles, numbers) = facets.into_iter().unzip();
        Self { triangles, numbers, nodes }
    }

    pub fn triangles(&self) -> &[Triangle] {
        &self.triangles
    }

    pub fn bounds(&self) -> (Vector<3>, Vector<3>) {
        (self.nodes[0].low, self.nodes[0].high)
    }

    /// Visits the triangles of all nodes that `enters` lets it into.
    #[inline]
    fn visit(&self, mut enters: impl FnMut(&Node) -> bool, mut see: impl FnMut(usize, &Triangle)) {
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
                Below::Triangles(first, many) => {
                    let all = first as usize..(first + many) as usize;
                    all.for_each(|triangle| see(triangle, &self.triangles[triangle]));
                }
            }
        }
    }

    /// The place on a triangle that is nearest to a point, and the number of the triangle, if one is nearer than `reach` m.
    pub fn nearest(&self, point: &Vector<3>, reach: f64) -> Option<(Vector<3>, usize)> {
        let (mut best, mut square) = (None, reach * reach);
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
                    for triangle in first as usize..(first + many) as usize {
                        let found = nearest_of(&self.triangles[triangle], point);
                        let distance = (found - point).norm_squared();
                        if distance < square {
                            (best, square) = (Some((found, triangle)), distance);
                        }
                    }
                }
            }
        }
        best
    }

    /// The nearest places on all triangles that are at most so far from a point, with the numbers of these.
    pub fn within(&self, point: &Vector<3>, reach: f64) -> Vec<(Vector<3>, usize)> {
        let (square, mut found) = (reach * reach, Vec::new());
        self.visit(
            |node| node.square(point) <= square,
            |number, triangle| {
                let place = nearest_of(triangle, point);
                if (place - point).norm_squared() <= square {
                    found.push((place, number));
                }
            },
        );
        found
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
            |_, triangle| near += solid_angle(triangle, point),
        );
        (far + near) / (4.0 * PI)
    }

    /// By how much the winding number changes on the straight way from one point to another: less by one where the way
    /// leads out through a triangle, more by one where it leads in. `None` where round-off does not tell whether it leads
    /// through one.
    pub fn change(&self, from: &Vector<3>, to: &Vector<3>) -> Option<i32> {
        let (way, mut change) = (to - from, Some(0));
        self.visit(
            |node| node.entry(from, &way) <= 1.0,
            |_, triangle| change = change.zip(passage(triangle, from, to)).map(|(a, b)| a + b),
        );
        change
    }

    /// The triangles of which parts may be less than `reach` m away from a point.
    pub fn around(&self, point: &Vector<3>, reach: f64) -> Local {
        let mut local = Local::default();
        let square = reach * reach;
        self.visit(|node| node.square(point) <= square, |_, triangle| local.push(triangle));
        local
    }

    /// How far it is from a point along a unit direction to the nearest triangle, between `least` and `most`; `most` if there is none.
    fn along(&self, point: &Vector<3>, direction: &Vector<3>, [least, most]: [f64; 2]) -> f64 {
        let best = std::cell::Cell::new(most);
        self.visit(
            |node| node.entry(point, direction) < best.get(),
            |_, triangle| {
                if let Some(length) = meets(triangle, point, direction)
                    && length > least
                {
                    best.set(best.get().min(length));
                }
            },
        );
        best.get()
    }

    /// See [`super::Facets::thinner_than`].
    pub fn thinnest(&self, most: f64) -> Option<(f64, Spot)> {
        let (low, high) = self.bounds();
        let least = 1e-9 * (high - low).norm();
        let through = |triangle: &Triangle, most: f64| {
            let inwards = -area(triangle).normalize();
            self.along(&(thrice_centre(triangle) / 3.0), &inwards, [least, most])
        };
        // Nothing is asked beyond the thinnest part so far, so that the least is the same whatever the order. Numbers that
        // are not negative have the order of their bits.
        let best = AtomicU64::new(most.max(0.0).to_bits());
        self.triangles.par_iter().for_each(|triangle| {
            let found = through(triangle, f64::from_bits(best.load(Ordering::Relaxed)));
            best.fetch_min(found.to_bits(), Ordering::Relaxed);
        });
        let thickness = f64::from_bits(best.into_inner());
        if !(thickness < most) {
            return None;
        }
        // Of several that are as thin, the first of the file.
        let all = self.triangles.par_iter().zip(&self.numbers);
        let thin = all.filter(|(triangle, _)| through(triangle, thickness.next_up()) <= thickness);
        let (triangle, facet) = thin.min_by_key(|(_, number)| **number)?;
        let place = thrice_centre(triangle) / 3.0;
        Some((thickness, Spot { facet: *facet as usize, place }))
    }

    /// See [`super::Facets::crossings`].
    pub fn crossings(&self, most: usize) -> usize {
        let found = AtomicUsize::new(0);
        self.triangles.par_iter().enumerate().for_each(|(number, triangle)| {
            if found.load(Ordering::Relaxed) >= most {
                return;
            }
            let [low, high] = ends(triangle);
            let mut count = 0;
            self.visit(
                |node| {
                    (0..3).all(|axis| node.low[axis] <= high[axis] && node.high[axis] >= low[axis])
                },
                |other, its| {
                    count += usize::from(other > number && cross(triangle, its).is_some());
                },
            );
            found.fetch_add(count, Ordering::Relaxed);
        });
        found.into_inner().min(most)
    }

    /// See [`super::Facets::first_crossing`].
    pub fn first_crossing(&self) -> Option<(Spot, usize)> {
        let number = |triangle: usize| self.numbers[triangle] as usize;
        let mut order: Vec<usize> = (0..self.triangles.len()).collect();
        order.sort_unstable_by_key(|&triangle| (number(triangle), triangle));
        order.par_iter().find_map_first(|&triangle| {
            let own = &self.triangles[triangle];
            let [low, high] = ends(own);
            let mut first: Option<([usize; 2], Vector<3>)> = None;
            self.visit(
                |node| {
                    (0..3).all(|axis| node.low[axis] <= high[axis] && node.high[axis] >= low[axis])
                },
                |other, its| {
                    let key = [number(other), other];
                    if first.is_none_or(|(known, _)| key < known)
                        && let Some(place) = cross(own, its)
                    {
                        first = Some((key, place));
                    }
                },
            );
            first.map(|([other, _], place)| (Spot { facet: number(triangle), place }, other))
        })
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

/// Adds the node around triangles of which this many others come before, and all below it.
fn add(triangles: &mut [(Triangle, u32)], before: u32, nodes: &mut Vec<Node>) {
    let [mut low, mut high] = [f64::INFINITY, f64::NEG_INFINITY].map(Vector::<3>::repeat);
    let (mut sum, mut middle, mut whole) = (Vector::zeros(), Vector::zeros(), 0.0);
    for (triangle, _) in &*triangles {
        for corner in triangle {
            (low, high) = (low.inf(corner), high.sup(corner));
        }
        let area = area(triangle);
        sum += area;
        middle += thrice_centre(triangle) * (area.norm() / 3.0);
        whole += area.norm();
    }
    middle /= whole;
    let outer = |(triangle, _): &(Triangle, u32)| {
        (thrice_centre(triangle) / 3.0 - middle) * area(triangle).transpose()
    };
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
    let along = |(triangle, _): &(Triangle, u32)| thrice_centre(triangle)[axis];
    triangles.select_nth_unstable_by(half, |a, b| along(a).total_cmp(&along(b)));
    let (first, second) = triangles.split_at_mut(half);
    add(first, before, nodes);
    nodes[number].below = Below::Nodes(nodes.len() as u32);
    add(second, before + half as u32, nodes);
}

fn thrice_centre([a, b, c]: &Triangle) -> Vector<3> {
    a + b + c
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A bent patch that is not closed: what is left of its solid angle is of the next order but one, a fourth power of the
    /// distance, and of the third without the spread.
    #[test]
    fn nodes_are_taken_together_to_the_second_order() {
        let corner = |x: f64, y: f64| Vector::<3>::new(x, y, 0.3 * x * x - 0.2 * x * y + 0.4 * y);
        let step = |k: u32| f64::from(k) * 0.25 - 0.5;
        let all = (0..4).flat_map(|i| (0..4).map(move |j| (i, j))).flat_map(|(i, j)| {
            let [x, y] = [step(i), step(j)];
            let corners = [corner(x, y), corner(x + 0.25, y), corner(x + 0.25, y + 0.25)];
            [corners, [corners[0], corners[2], corner(x, y + 0.25)]]
        });
        let tree = Tree::new(all.map(|triangle| (triangle, 1)).collect());
        let left = |distance: f64| {
            let point = Vector::<3>::new(0.6, 0.5, -0.7).normalize() * distance;
            let exact: f64 = tree.triangles.iter().map(|it| solid_angle(it, &point)).sum();
            (tree.winding(&point) - exact / (4.0 * PI)).abs()
        };
        let ratio = left(8.0) / left(16.0);
        assert!((14.0..18.0).contains(&ratio), "{ratio} for 16");
    }
}
