//! The shortest ways out of a shape.

use super::shape::{from_space, in_space};
use super::{Faces, Shape};
use crate::Vector;

/// Halvings of the turn by which directions are improved, and of the last step of a walk.
const HALVINGS: u32 = 40;
/// Steps of a walk along a ray, each as long as the depth allows.
const MOST_STEPS: usize = 200;
/// Most ways to facets that are told apart.
const MOST_WAYS: usize = 256;
/// A place that is no deeper in a shape than this part of the box around it is on its boundary.
const ON_FACET: f64 = 1e-9;
/// How far from the boundary, as a part of the box around everything, ways are searched for a place on it.
const SHIFT: f64 = 1e-6;
/// Ways whose lengths differ by less than this part count as equally short.
const TIE: f64 = 0.05;
/// Starts of a search that are longer than the shortest way by more than this factor are not improved.
const MOST_OF_START: f64 = 1.5;
/// Most normals that are followed to a curved face, and how little the last one turns.
const MOST_TURNS: usize = 30;
const STRAIGHT: f64 = 1e-6;

/// How much larger a depth in m is `step` m ahead of a point than as much behind it, along each axis.
pub(crate) fn slope<const D: usize>(
    point: &Vector<D>,
    step: f64,
    mut depth: impl FnMut(&Vector<D>) -> f64,
) -> Vector<D> {
    Vector::from_fn(|axis, _| {
        let aside = Vector::from_fn(|i, _| if i == axis { step } else { 0.0 });
        depth(&(point + aside)) - depth(&(point - aside))
    })
}

/// The rays from a point inside a shape that is `depth` m below its boundary, as far as the corners `bounds`, a box whose
/// diagonal is `extent` m.
pub(super) struct Rays<'a, const D: usize> {
    shape: &'a Shape<D>,
    point: &'a Vector<D>,
    depth: f64,
    bounds: &'a (Vector<D>, Vector<D>),
    extent: f64,
}

impl<const D: usize> Shape<D> {
    /// The directions of the shortest ways from `point` inside the shape to space outside of it that
    /// lies between the corners `bounds` in m: the outward normal of the nearest face that is not
    /// on these bounds, and behind an edge of all that are equally near, or nearer than `layer` m: those that a particle of the
    /// first layer is behind. None where every way leads beyond the bounds. In surfaces of facets `layer` has no meaning.
    ///
    /// Directions are searched from those to the faces, edges and corners of a cube.
    #[inline(never)]
    pub fn ways_out(
        &self,
        point: &Vector<D>,
        layer: f64,
        bounds: &(Vector<D>, Vector<D>),
    ) -> Faces<D> {
        if let Some(faces) = self.nearest_facets(point, bounds) {
            return faces;
        }
        let extent = (bounds.1 - bounds.0).norm();
        // On the boundary, where all ways are as short up to round-off, the search begins a little deeper.
        if self.depth(point) < ON_FACET * extent
            && let Some(inward) = self.inward(point, SHIFT * extent)
        {
            let shift = inward * (SHIFT * extent);
            if self.depth(&(point + shift)) > ON_FACET * extent {
                let faces = self.ways_out(&(point + shift), layer, bounds);
                let faces = faces.normals().iter().zip(faces.depths());
                let back =
                    |(normal, depth): (&Vector<D>, &f64)| (depth + shift.dot(normal)).max(0.0);
                return faces.map(|face| (*face.0, back(face))).collect();
            }
        }
        let rays = self.rays(point, bounds);
        let mut shortest = f64::INFINITY;
        let starts = (0..3usize.pow(D as u32)).filter_map(|number| {
            let turn = |axis: usize| (number / 3usize.pow(axis as u32) % 3) as f64 - 1.0;
            let start = Vector::<D>::from_fn(|axis, _| turn(axis)).try_normalize(0.0)?;
            let found = rays.length(&start, (1.01 * MOST_OF_START * shortest).max(2.0 * layer));
            shortest = shortest.min(found);
            Some((found, start))
        });
        let mut starts: Vec<(f64, Vector<D>)> =
            starts.filter(|(length, _)| length.is_finite()).collect();
        let first = starts.iter().copied().reduce(|best, start| {
            // A later direction must be shorter by more than round-off, so that symmetric
            // places choose alike.
            if start.0 < best.0 * (1.0 - 1e-9) { start } else { best }
        });
        let Some(first) = first else { return Faces::default() };
        // The straight ways to faces before those between them, which are refined to them less well.
        starts.sort_by_key(|start| start.0 > first.0 * (1.0 + TIE));
        let mut faces = vec![rays.refine(first)];
        let least = faces[0].0;
        let most = least * (1.0 + TIE);
        let is_other = |way: &Vector<D>, faces: &[(f64, Vector<D>)]| {
            faces.iter().all(|face| face.1.dot(way) < 1.0 - TIE)
        };
        for start in &starts {
            // A way that ends on the plane of a face already found leads to the same face.
            let on_plane =
                |face: &(f64, Vector<D>)| start.0 * start.1.dot(&face.1) >= face.0 * (1.0 - TIE);
            if start.0 > MOST_OF_START * least || faces.iter().any(on_plane) {
                continue;
            }
            let found = rays.refine(*start);
            if is_other(&found.1, &faces) && found.0 <= most {
                faces.push(found);
            }
        }
        for face in &mut faces {
            face.0 = least;
        }
        for start in starts.iter().filter(|start| start.0 <= 2.0 * layer) {
            let found = rays.face_along(&start.1, SHIFT * extent);
            let found = found.filter(|face| face.0 <= layer && is_other(&face.1, &faces));
            faces.extend(found);
        }
        faces.into_iter().map(|(length, normal)| (normal, length)).collect()
    }

    pub(super) fn rays<'a>(
        &'a self,
        point: &'a Vector<D>,
        bounds: &'a (Vector<D>, Vector<D>),
    ) -> Rays<'a, D> {
        let (depth, extent) = (self.depth(point), (bounds.1 - bounds.0).norm());
        Rays { shape: self, point, depth, bounds, extent }
    }

    /// The direction in which the depth grows about a point, by differences over `step` m on both sides.
    fn inward(&self, point: &Vector<D>, step: f64) -> Option<Vector<D>> {
        slope(point, step, |x| self.depth(x)).try_normalize(0.1 * step)
    }

    /// The ways to the nearest facets, where the nearest part of the boundary is one of facets, and within the bounds. A point on
    /// a facet has the normal of that.
    fn nearest_facets(
        &self,
        point: &Vector<D>,
        bounds: &(Vector<D>, Vector<D>),
    ) -> Option<Faces<D>> {
        if let Some((of, about, rotation)) = self.as_turned() {
            // The bounds are judged where the point is.
            let everywhere = (Vector::repeat(f64::NEG_INFINITY), Vector::repeat(f64::INFINITY));
            let faces =
                of.nearest_facets(&(rotation.tr_mul(&(point - about)) + about), &everywhere)?;
            let normals: Vec<_> = faces.normals().iter().map(|normal| rotation * normal).collect();
            let ends = normals.iter().map(|normal| point + normal * faces.depth());
            return is_within(ends, bounds).then(|| Faces::new(normals, faces.depth()));
        }
        let surfaces = self.surfaces();
        if surfaces.is_empty() {
            return None;
        }
        let (low, high) = self.bounding_box();
        let (depth, tiny) = (self.depth(point), ON_FACET * (high - low).norm());
        let found = surfaces.iter().flat_map(|facets| facets.nearest(&in_space(point), 1.0 + TIE));
        let found: Vec<(Vector<D>, Vector<D>)> =
            found.map(|(place, normal)| (from_space(&place), from_space(&normal))).collect();
        let distance = |place: &Vector<D>| (place - point).norm();
        let least = found.iter().map(|(place, _)| distance(place)).fold(f64::INFINITY, f64::min);
        // Another part of the boundary is nearer, or the point is outside.
        if depth < -tiny || (least - depth.max(0.0)).abs() > tiny {
            let is_far = |thickness: f64| (thickness - least - depth).abs() <= tiny && depth > tiny;
            return self.thickness().filter(|&thickness| is_far(thickness)).and_then(|_| {
                // The far face of a layer is beyond the point as seen from the near one.
                let ways: Vec<_> =
                    found.iter().map(|(place, _)| (point - place) / distance(place)).collect();
                let ways = apart(&ways);
                let ends = ways.iter().map(|way| point + way * depth);
                is_within(ends, bounds).then(|| Faces::new(ways.clone(), depth))
            });
        }
        let mut ways = Vec::with_capacity(found.len());
        for (place, normal) in found {
            let length = distance(&place);
            if length > (1.0 + TIE) * least + tiny || self.depth(&place).abs() > tiny {
                continue;
            }
            if !is_within(std::iter::once(place), bounds) {
                return None;
            }
            if length > tiny {
                ways.push((place - point) / length);
            } else {
                let step = normal * (10.0 * tiny);
                let is_out = self.depth(&(place + step)) < self.depth(&(place - step));
                ways.push(if is_out { normal } else { -normal });
            }
        }
        (!ways.is_empty()).then(|| Faces::new(apart(&ways), least))
    }

    /// The faces on the two sides of a point inside a thin part of the shape, where the face opposite to the
    /// nearest is less than `reach` m away, for a `layer` in m: those that [`Self::ways_out`] finds but the opposite, and that one.
    /// The first of each are the two of the thin part. `None` in thick parts and within `reach` of a free end, round
    /// which what is on both sides is one.
    #[inline(never)]
    pub fn sides(
        &self,
        point: &Vector<D>,
        [reach, layer]: [f64; 2],
        bounds: &(Vector<D>, Vector<D>),
    ) -> Option<[Faces<D>; 2]> {
        let rays = self.rays(point, bounds);
        let length = |direction: &Vector<D>| rays.length(direction, reach);
        let nearest = self.ways_out(point, layer, bounds);
        let across = nearest.normals().iter().find(|normal| length(&-**normal) < reach)?;
        let along = |axis: usize| {
            let unit = Vector::from_fn(|i, _| f64::from(u8::from(i == axis)));
            (unit - across * across[axis]).try_normalize(0.1)
        };
        let ends = (0..D).filter_map(along).flat_map(|way| [way, -way]);
        if ends.map(|way| length(&way)).any(|length| length < reach) {
            return None;
        }
        let all = || nearest.normals().iter().copied().zip(nearest.depths().iter().copied());
        let own = all().filter(|face| face.0 == *across);
        let others = all().filter(|face| face.0.dot(across).abs() < 0.5);
        let front = own.chain(others).collect();
        let back = Faces::new(vec![-across], length(&-across));
        Some([front, back])
    }
}

/// Whether places lie between two corners.
fn is_within<const D: usize>(
    mut places: impl Iterator<Item = Vector<D>>,
    bounds: &(Vector<D>, Vector<D>),
) -> bool {
    places.all(|place| {
        (0..D).all(|axis| bounds.0[axis] < place[axis] && place[axis] < bounds.1[axis])
    })
}

/// Of unit vectors the first, and the first of each group that is apart from those before: facets of a curved face follow
/// each other by small turns, and those beyond an edge do not. Far from facets, where there are more than [`MOST_WAYS`], the
/// first alone.
fn apart<const D: usize>(ways: &[Vector<D>]) -> Vec<Vector<D>> {
    let mut left: Vec<Vector<D>> = ways.iter().take(MOST_WAYS).copied().collect();
    let mut normals = Vec::new();
    while let Some(first) = left.first().copied() {
        normals.push(first);
        let (mut group, mut next) = (vec![first], 0);
        while let Some(own) = group.get(next).copied() {
            next += 1;
            let (near, rest) = left.iter().partition(|way| way.dot(&own) > 1.0 - TIE);
            left = rest;
            group.extend::<Vec<_>>(near);
        }
        if ways.len() > MOST_WAYS {
            break;
        }
    }
    normals
}

impl<const D: usize> Rays<'_, D> {
    /// Length of the way out along a direction, infinite if it leaves the bounds, or is known to be longer than `most`.
    pub(super) fn length(&self, direction: &Vector<D>, most: f64) -> f64 {
        let &Self { point, bounds, extent, .. } = self;
        let least = 1e-9 * extent;
        let (mut length, mut last) = (0.0, 0.0);
        for _ in 0..MOST_STEPS {
            let place = point + direction * length;
            let inside = (0..D).all(|axis| {
                bounds.0[axis] + least < place[axis] && place[axis] < bounds.1[axis] - least
            });
            let depth = if length == 0.0 { self.depth } else { self.shape.depth(&place) };
            if depth < 0.0 {
                return if inside {
                    self.crossing(direction, [last, length], most)
                } else {
                    f64::INFINITY
                };
            }
            if length > extent || length > most {
                break;
            }
            last = length;
            length += depth.max(least);
        }
        f64::INFINITY
    }

    /// Where a ray leaves the shape between two lengths, inside at the first one and outside at the second. Infinite if it is
    /// inside beyond `most`.
    fn crossing(&self, direction: &Vector<D>, [mut inner, mut outer]: [f64; 2], most: f64) -> f64 {
        for _ in 0..HALVINGS {
            if inner > most {
                return f64::INFINITY;
            }
            let middle = 0.5 * (inner + outer);
            if self.shape.depth(&(self.point + direction * middle)) < 0.0 {
                outer = middle;
            } else {
                inner = middle;
            }
        }
        outer
    }

    /// The face that a ray leaves the shape through, or on a curved one that to which its normal leads, with the length of the
    /// straight way there in m; slopes are taken over `step` m. `None` at an edge and where that does not end.
    fn face_along(&self, direction: &Vector<D>, step: f64) -> Option<(f64, Vector<D>)> {
        let mut way = *direction;
        for _ in 0..MOST_TURNS {
            let found =
                Some(self.length(&way, f64::INFINITY)).filter(|length| length.is_finite())?;
            let slope = slope(&(self.point + way * found), step, |x| self.shape.depth(x));
            // Across an edge the depth does not grow by all of the step.
            let normal = -slope.try_normalize(1.9 * step)?;
            if (normal - way).norm() < STRAIGHT {
                return Some((found, normal));
            }
            way = normal;
        }
        None
    }

    /// The shortest way close to a start, and its direction.
    fn refine(&self, (mut least, mut direction): (f64, Vector<D>)) -> (f64, Vector<D>) {
        let mut turn = 0.3;
        for _ in 0..HALVINGS {
            for axis in 0..D {
                for sign in [-turn, turn] {
                    let mut tried = direction;
                    tried[axis] += sign;
                    let tried = tried.normalize();
                    let shorter = least * (1.0 - 1e-12);
                    let found = self.length(&tried, shorter);
                    if found < shorter {
                        (least, direction) = (found, tried);
                    }
                }
            }
            turn *= 0.5;
        }
        (least, direction)
    }
}
