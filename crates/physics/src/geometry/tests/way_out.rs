//! Ways out of shapes.

use super::super::{Faces, Shape};
use crate::Vector;

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
    for (radius, number) in [0.25, 0.5, 1.0].into_iter().flat_map(|r| (0..40).map(move |n| (r, n)))
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

/// A ray is as long with a bound on its length as without, or infinite if it is longer than that.
#[test]
fn bounds_on_rays_change_no_length() {
    fn check<const D: usize>(shape: &Shape<D>, bounds: &(Vector<D>, Vector<D>)) {
        let (low, high) = shape.bounding_box();
        let part =
            |number: usize, k: usize| (number as f64 * [2.0_f64, 3.0, 5.0, 7.0][k].sqrt()).fract();
        let (mut shorter, mut longer) = (0, 0);
        for number in 1..200 {
            let point =
                Vector::<D>::from_fn(|axis, _| low[axis] + (high - low)[axis] * part(number, axis));
            if shape.depth(&point) < 0.0 {
                continue;
            }
            let rays = shape.rays(&point, bounds);
            let way = Vector::<D>::from_fn(|axis, _| part(number + 7, axis + 1) - 0.5).normalize();
            let whole = rays.length(&way, f64::INFINITY);
            let depth = shape.depth(&point);
            for most in [0.0, 0.5 * depth, depth, 1.5 * depth, whole, 2.0 * whole] {
                let found = rays.length(&way, most);
                assert!(
                    found == whole || found.is_infinite() && whole > most,
                    "{found} for {whole}"
                );
                shorter += usize::from(found < f64::INFINITY);
                longer += usize::from(found.is_infinite() && whole.is_finite());
            }
        }
        assert!(shorter > 20 && longer > 20, "{shorter} {longer}");
    }
    let (tank, bounds) = tank();
    check(&tank, &bounds);
    let around = (Vector::<2>::repeat(-5.0), Vector::<2>::repeat(9.0));
    let plate = Shape::cuboid(Vector::<2>::zeros(), Vector::<2>::new(0.3, 4.0)).unwrap();
    check(&plate.turned(0.4, Vector::<2>::zeros(), nalgebra::Vector3::z()).unwrap(), &around);
    check(&Shape::ball(Vector::<2>::new(0.2, 0.1), 0.5).unwrap(), &around);
    let around = (Vector::<3>::repeat(-5.0), Vector::<3>::repeat(9.0));
    let block = Shape::cuboid(Vector::<3>::zeros(), Vector::<3>::new(1.0, 2.0, 0.5)).unwrap();
    let ball = Shape::ball(Vector::<3>::new(0.5, 1.0, 0.5), 0.3).unwrap();
    check(&Shape::difference(block, vec![ball]).unwrap(), &around);
}
