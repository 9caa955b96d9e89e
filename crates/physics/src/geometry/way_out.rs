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

impl<const D: usize> Shape<D> {
    /// The directions of the shortest ways from `point` inside the shape to space outside of it that
    /// lies between the corners `bounds` in m: the outward normal of the nearest face that is not
    /// on these bounds, and behind an edge of all that are equally near, or nearer than `layer` m: those that a particle of the
    /// first layer is behind. None where every way leads beyond the bounds. In surfaces of facets `layer` has no meaning.
    ///
    /// Directions are searched from those to the faces, edges and corners of a cube.
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
        let length = |direction: &Vector<D>| self.walk(point, direction, bounds, extent);
        let starts = (0..3usize.pow(D as u32)).filter_map(|number| {
            let turn = |axis: usize| (number / 3usize.pow(axis as u32) % 3) as f64 - 1.0;
            let start = Vector::<D>::from_fn(|axis, _| turn(axis)).try_normalize(0.0)?;
            Some((length(&start), start))
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
        let mut faces = vec![refine(first, &length)];
        let least = faces[0].0;
        let most = least * (1.0 + TIE);
        let is_other = |way: &Vector<D>, faces: &[(f64, Vector<D>)]| {
            faces.iter().all(|face| face.1.dot(way) < 1.0 - TIE)
        };
        for start in &starts {
            // A way that ends on the plane of a face already found leads to the same face.
            let on_plane =
                |face: &(f64, Vector<D>)| start.0 * start.1.dot(&face.1) >= face.0 * (1.0 - TIE);
            if start.0 > 1.5 * least || faces.iter().any(on_plane) {
                continue;
            }
            let found = refine(*start, &length);
            if is_other(&found.1, &faces) && found.0 <= most {
                faces.push(found);
            }
        }
        for face in &mut faces {
            face.0 = least;
        }
        for start in starts.iter().filter(|start| start.0 <= 2.0 * layer) {
            let found = self.face_along(point, &start.1, SHIFT * extent, &length);
            let found = found.filter(|face| face.0 <= layer && is_other(&face.1, &faces));
            faces.extend(found);
        }
        faces.into_iter().map(|(length, normal)| (normal, length)).collect()
    }

    /// The face that a ray leaves the shape through, or on a curved one that to which its normal leads, with the length of the
    /// straight way there in m; slopes are taken over `step` m. `None` at an edge and where that does not end.
    fn face_along(
        &self,
        point: &Vector<D>,
        direction: &Vector<D>,
        step: f64,
        length: &impl Fn(&Vector<D>) -> f64,
    ) -> Option<(f64, Vector<D>)> {
        let mut way = *direction;
        for _ in 0..MOST_TURNS {
            let found = Some(length(&way)).filter(|length| length.is_finite())?;
            let slope = slope(&(point + way * found), step, |x| self.depth(x));
            // Across an edge the depth does not grow by all of the step.
            let normal = -slope.try_normalize(1.9 * step)?;
            if (normal - way).norm() < STRAIGHT {
                return Some((found, normal));
            }
            way = normal;
        }
        None
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
    pub fn sides(
        &self,
        point: &Vector<D>,
        [reach, layer]: [f64; 2],
        bounds: &(Vector<D>, Vector<D>),
    ) -> Option<[Faces<D>; 2]> {
        let extent = (bounds.1 - bounds.0).norm();
        let length = |direction: &Vector<D>| self.walk(point, direction, bounds, extent);
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

    /// Length of the way out along a direction, infinite if it leaves the bounds.
    fn walk(
        &self,
        point: &Vector<D>,
        direction: &Vector<D>,
        bounds: &(Vector<D>, Vector<D>),
        extent: f64,
    ) -> f64 {
        let least = 1e-9 * extent;
        let (mut length, mut last) = (0.0, 0.0);
        for _ in 0..MOST_STEPS {
            let place = point + direction * length;
            let inside = (0..D).all(|axis| {
                bounds.0[axis] + least < place[axis] && place[axis] < bounds.1[axis] - least
            });
            let depth = self.depth(&place);
            if depth < 0.0 {
                return if inside {
                    self.crossing(point, direction, last, length)
                } else {
                    f64::INFINITY
                };
            }
            if length > extent {
                break;
            }
            last = length;
            length += depth.max(least);
        }
        f64::INFINITY
    }

    /// Where a ray leaves the shape between two lengths, inside at the first one and outside at the second.
    fn crossing(
        &self,
        point: &Vector<D>,
        direction: &Vector<D>,
        mut inner: f64,
        mut outer: f64,
    ) -> f64 {
        for _ in 0..HALVINGS {
            let middle = 0.5 * (inner + outer);
            if self.depth(&(point + direction * middle)) < 0.0 {
                outer = middle;
            } else {
                inner = middle;
            }
        }
        outer
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

/// The shortest way close to a start, and its direction.
fn refine<const D: usize>(
    (mut least, mut direction): (f64, Vector<D>),
    length: &impl Fn(&Vector<D>) -> f64,
) -> (f64, Vector<D>) {
    let mut turn = 0.3;
    for _ in 0..HALVINGS {
        for axis in 0..D {
            for sign in [-turn, turn] {
                let mut tried = direction;
                tried[axis] += sign;
                let tried = tried.normalize();
                let found = length(&tried);
                if found < least * (1.0 - 1e-12) {
                    (least, direction) = (found, tried);
                }
            }
        }
        turn *= 0.5;
    }
    (least, direction)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn tank() -> (Shape<2>, (Vector<2>, Vector<2>)) {
        let corner = |x, y| Vector::<2>::new(x, y);
        let outer = Shape::cuboid(corner(-0.3, -0.3), corner(1.3, 1.0)).unwrap();
        let inner = Shape::cuboid(corner(0.0, 0.0), corner(1.0, 2.0)).unwrap();
        (Shape::difference(outer, vec![inner]).unwrap(), (corner(-0.3, -0.3), corner(1.3, 1.0)))
    }

    #[test]
    fn the_walls_of_a_tank_face_its_inside() {
        let (tank, bounds) = tank();
        let way = |x, y| tank.ways_out(&Vector::<2>::new(x, y), 0.0, &bounds).between();
        let close = |way: Vector<2>, x, y| (way - Vector::<2>::new(x, y)).norm() < 1e-4;
        assert!(close(way(0.5, -0.05), 0.0, 1.0));
        assert!(close(way(0.05, -0.25), 0.0, 1.0), "deep in the floor, close to a corner");
        assert!(close(way(-0.25, 0.5), 1.0, 0.0));
        assert!(close(way(1.15, 0.97), -1.0, 0.0), "at the rim");
        let diagonal = 0.5_f64.sqrt();
        assert!(close(way(-0.1, -0.1), diagonal, diagonal));
    }

    #[test]
    fn places_on_the_boundary_face_out_of_it() {
        let bounds = (Vector::<2>::repeat(-5.0), Vector::<2>::repeat(5.0));
        let ball = Shape::ball(Vector::<2>::new(0.2, 0.1), 0.5).unwrap();
        for number in 0..100 {
            let angle = 0.063 * f64::from(number);
            let normal = Vector::<2>::new(angle.cos(), angle.sin());
            for depth in [-1e-16, 0.0, 1e-16] {
                let at = Vector::<2>::new(0.2, 0.1) + normal * (0.5 - depth);
                let faces = ball.ways_out(&at, 0.0, &bounds);
                assert!((faces.between() - normal).norm() < 1e-3, "{angle} {faces:?}");
                assert!(faces.depth() < 1e-9, "{faces:?}");
            }
        }
        let (tank, bounds) = tank();
        let floor = tank.ways_out(&Vector::<2>::new(0.3, 0.0), 0.0, &bounds);
        assert_eq!(floor.normals(), [Vector::<2>::new(0.0, 1.0)]);
        assert!(floor.depth() < 1e-9);
        // On the outer bounds, where the way leads through the floor.
        let below = tank.ways_out(&Vector::<2>::new(0.3, -0.3), 0.0, &bounds);
        assert_eq!(below.normals(), [Vector::<2>::new(0.0, 1.0)]);
        assert!((below.depth() - 0.3).abs() < 1e-9, "{below:?}");
    }

    #[test]
    fn a_thin_plate_has_two_sides_but_at_its_end() {
        let corner = |x, y| Vector::<2>::new(x, y);
        let plate = Shape::cuboid(corner(0.0, 0.0), corner(0.3, 4.0)).unwrap();
        let bounds = (Vector::<2>::repeat(-5.0), Vector::<2>::repeat(9.0));
        let sides = |x, y| plate.sides(&corner(x, y), [0.29, 0.1], &bounds);
        let [left, right] = sides(0.05, 2.0).expect("seen from the right, too");
        assert!((left.between() + right.between()).norm() < 1e-9);
        assert!((left.between() - corner(-1.0, 0.0)).norm() < 1e-4);
        assert!((left.depth() - 0.05).abs() < 1e-6 && (right.depth() - 0.25).abs() < 1e-6);
        assert!(sides(0.15, 2.0).is_some() && sides(0.15, 0.2).is_none(), "the end is 0.2 away");
        assert_eq!(
            plate.sides(&corner(0.05, 2.0), [0.24, 0.1], &bounds),
            None,
            "thicker than the reach"
        );
    }

    #[test]
    fn the_edges_of_a_pillar_face_between_its_sides() {
        let low = Vector::<3>::new(1.0, 0.0, -1.0);
        let pillar = Shape::cuboid(low, low + Vector::<3>::new(0.5, 0.5, 3.0)).unwrap();
        let bounds = (Vector::<3>::repeat(-3.0), Vector::<3>::repeat(5.0));
        let way = |x, y| pillar.ways_out(&Vector::<3>::new(x, y, 0.5), 0.0, &bounds).between();
        let diagonal = 0.5_f64.sqrt();
        for (x, y, sign_x, sign_y) in
            [(1.1, 0.1, -1.0, -1.0), (1.4, 0.1, 1.0, -1.0), (1.4, 0.4, 1.0, 1.0)]
        {
            let expected = Vector::<3>::new(sign_x, sign_y, 0.0) * diagonal;
            assert!((way(x, y) - expected).norm() < 2e-3, "{} at {x}, {y}", way(x, y));
        }
        let side = Vector::<3>::new(-1.0, 0.0, 0.0);
        assert!((way(1.1, 0.2) - side).norm() < 2e-3, "on a side");
    }

    /// A lattice of cells that are not as high as long, or that does not fit the shape: in the first layer behind a face is what is
    /// less than a spacing behind it.
    #[test]
    fn in_the_first_layer_behind_two_faces_both_count() {
        let block = Shape::cuboid(Vector::<2>::zeros(), Vector::<2>::new(1.0, 2.0)).unwrap();
        let bounds = (Vector::<2>::repeat(-3.0), Vector::<2>::repeat(5.0));
        let faces = |x, y| block.ways_out(&Vector::<2>::new(x, y), 0.2, &bounds);
        for [x, y] in [[0.1, 0.115], [0.115, 0.1], [0.1, 0.104], [0.02, 0.19], [0.19, 0.02]] {
            let faces = faces(x, y);
            assert_eq!(faces.normals().len(), 2, "{faces:?}");
            for (normal, depth) in faces.normals().iter().zip(faces.depths()) {
                let exact = if normal[0] < -0.5 { x } else { y };
                // What is longer by less than 5 % counts as equally short.
                let shared = if exact < 1.05 * x.min(y) { x.min(y) } else { exact };
                assert!((depth - shared).abs() < 1e-9, "{depth} at {x}, {y}");
            }
        }
        for [x, y] in [[0.1, 0.21], [0.3, 0.1], [0.3, 0.4]] {
            assert_eq!(faces(x, y).normals().len(), 1, "{x}, {y}");
        }
    }

    /// Ways that differ by less than 1e-12 of their length count as equal: directions are off by the root of that.
    #[test]
    fn behind_the_corners_of_a_box_there_are_the_normals_of_its_sides() {
        let bounds = (Vector::<2>::repeat(-3.0), Vector::<2>::repeat(5.0));
        for angle in [0.0, 0.1, 0.4, 0.7, 1.3] {
            let block = Shape::cuboid(Vector::<2>::zeros(), Vector::<2>::new(1.0, 2.0)).unwrap();
            let block = block.turned(angle, Vector::<2>::zeros(), nalgebra::Vector3::z()).unwrap();
            let turn = nalgebra::Rotation2::new(angle);
            for [x, y] in [[0.1, 0.1], [0.9, 0.1], [0.1, 1.9], [0.9, 1.9]] {
                let faces = block.ways_out(&(turn * Vector::<2>::new(x, y)), 0.0, &bounds);
                assert_eq!(faces.normals().len(), 2, "{faces:?}");
                let out = Vector::<2>::new(2.0 * x - 1.0, y - 1.0).map(f64::signum);
                for normal in faces.normals() {
                    let normal = turn.inverse() * normal;
                    let axis = normal.iamax();
                    let off = (normal[axis] - out[axis]).abs() + normal[1 - axis].abs();
                    assert!(off < 3e-6, "{normal} at {x}, {y}, turned by {angle}");
                }
            }
        }
    }

    #[test]
    fn a_round_wall_has_radial_normals() {
        let center = Vector::<2>::new(1.0, 2.0);
        let ball = Shape::ball(center, 0.5).unwrap();
        let bounds = (Vector::<2>::repeat(-3.0), Vector::<2>::repeat(5.0));
        for angle in [0.1_f64, 0.9, 2.0, 4.0] {
            let radial = Vector::<2>::new(angle.cos(), angle.sin());
            for layer in [0.0, 0.2] {
                let faces = ball.ways_out(&(center + radial * 0.4), layer, &bounds);
                // Lengths are found to 1e-8 m of 0.1 m, and grow with the square of the turn.
                let way = faces.between();
                assert!((way - radial).norm() < 2e-3, "{way} for {radial}");
                assert_eq!(faces.normals().len(), 1, "{faces:?}");
            }
        }
        // Two and a half, five and ten spacings of 0.1 m in radius, in the first layer and in the next.
        let bounds = (Vector::<3>::repeat(-3.0), Vector::<3>::repeat(3.0));
        for (radius, number) in
            [0.25, 0.5, 1.0].into_iter().flat_map(|r| (0..40).map(move |n| (r, n)))
        {
            let ball = Shape::ball(Vector::<3>::zeros(), radius).unwrap();
            let [turn, up] = [0.7 * f64::from(number), 0.05 * f64::from(number) - 0.975];
            let around = (1.0 - up * up).sqrt();
            let radial = Vector::<3>::new(around * turn.cos(), around * turn.sin(), up);
            for depth in [0.02, 0.05, 0.09, 0.15] {
                let faces = |layer| ball.ways_out(&(radial * (radius - depth)), layer, &bounds);
                // Ways within 5 % of the shortest may be told apart on the smallest ball; a layer adds none.
                let [alone, layer] = [0.0, 0.099].map(faces);
                assert_eq!(alone, layer, "{depth} in {radius} at {radial}");
            }
        }
        // On the bounds there is no way out.
        assert_eq!(ball.ways_out(&center, 0.0, &(center, center)), Faces::default());
    }
}
