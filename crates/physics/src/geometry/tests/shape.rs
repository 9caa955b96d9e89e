//! Shapes against their definitions.

use crate::Vector;
use crate::geometry::{GeometryError, Shape};
use proptest::prelude::*;

fn plate() -> Shape<2> {
    let sheet = Shape::cuboid(Vector::zeros(), Vector::<2>::new(4.0, 2.0)).unwrap();
    let hole = Shape::ball(Vector::<2>::new(1.0, 1.0), 0.5).unwrap();
    Shape::difference(sheet, vec![hole]).unwrap()
}

#[test]
fn boundaries_belong_to_shapes() {
    let plate = plate();
    for (x, y, inside) in [
        (0.0, 0.0, true),
        (4.0, 2.0, true),
        (4.0 + 1e-12, 2.0, false),
        (1.0, 1.5, true),
        (1.0, 1.4, false),
        (f64::NAN, 1.0, false),
        (f64::INFINITY, 1.0, false),
    ] {
        assert_eq!(plate.contains(&Vector::<2>::new(x, y)), inside, "{x} {y}");
    }
    let (start, end) = (Vector::<3>::new(1.0, 1.0, 0.0), Vector::<3>::new(1.0, 1.0, 2.0));
    let cylinder = Shape::cylinder(start, end, 0.5).unwrap();
    assert!(cylinder.contains(&Vector::<3>::new(1.5, 1.0, 2.0)));
    assert!(!cylinder.contains(&Vector::<3>::new(1.4, 1.4, 1.0)));
    assert!(!cylinder.contains(&Vector::<3>::new(1.0, 1.0, 2.1)));
    assert!(!cylinder.contains(&Vector::<3>::new(1.0, f64::NAN, 1.0)));
}

#[test]
fn volumes_are_those_of_geometry_books() {
    use std::f64::consts::PI;
    let origin = Vector::<3>::zeros();
    let ball = Shape::ball(origin, 2.0).unwrap();
    let shell = Shape::annulus(origin, 1.0, 2.0).unwrap();
    let cylinder = Shape::cylinder(origin, Vector::<3>::new(0.0, 3.0, 4.0), 0.5).unwrap();
    let ring = Shape::annulus(Vector::<2>::zeros(), 1.0, 2.0).unwrap();
    let rod = Shape::ball(Vector::<1>::zeros(), 2.0).unwrap();
    for (volume, expected) in [
        (ball.exact_volume(), 32.0 / 3.0 * PI),
        (shell.exact_volume(), 28.0 / 3.0 * PI),
        (cylinder.exact_volume(), 1.25 * PI),
        (ring.exact_volume(), 3.0 * PI),
        (rod.exact_volume(), 4.0),
        (plate().exact_volume(), 8.0 - 0.25 * PI),
    ] {
        assert!((volume.unwrap() / expected - 1.0).abs() < 1e-14, "{volume:?} {expected}");
    }
    let disc = |x| Shape::ball(Vector::<2>::new(x, 1.0), 0.5).unwrap();
    let sheet = Shape::cuboid(Vector::zeros(), Vector::<2>::new(4.0, 2.0)).unwrap();
    let cut = |holes| Shape::difference(sheet.clone(), holes).unwrap().exact_volume();
    assert!(cut(vec![disc(1.0), disc(2.0)]).is_some());
    assert_eq!(cut(vec![disc(1.0), disc(1.9)]), None);
    assert_eq!(cut(vec![disc(0.4)]), None);
    assert_eq!(Shape::union(vec![disc(1.0), disc(1.5)]).unwrap().exact_volume(), None);
    assert_eq!(Shape::union(vec![disc(1.0)]).unwrap().exact_volume(), disc(0.0).exact_volume());
}

#[test]
fn impossible_shapes_are_refused() {
    let (o, far) = (Vector::<2>::zeros(), Vector::<2>::new(1.0, f64::INFINITY));
    let unit = Vector::<2>::new(1.0, 1.0);
    let refused: Vec<(Result<Shape<2>, GeometryError>, &str)> = vec![
        (Shape::cuboid(o, far), "the upper corner of a box is (1, inf)"),
        (Shape::cuboid(far * -1.0, o), "the lower corner of a box"),
        (Shape::cuboid(unit * -1e308, unit * 1e308), "the extent of a box"),
        (Shape::cuboid(unit, o), "a box reaches from 1 to 0 m in x"),
        (Shape::cuboid(o, Vector::<2>::new(1.0, 0.0)), "a box reaches from 0 to 0 m in y"),
        (Shape::ball(o, 0.0), "the radius of a ball is 0 m"),
        (Shape::ball(o, -1.0), "the radius of a ball is -1 m"),
        (Shape::ball(o, f64::NAN), "the radius of a ball is NaN m"),
        (Shape::ball(far, 1.0), "the center of a ball"),
        (Shape::ball(o, 1e308), "the largest coordinate of a ball"),
        (Shape::annulus(o, 1.0, 1.0), "the radii 1 and 1 m"),
        (Shape::annulus(o, 2.0, 1.0), "the radii 2 and 1 m"),
        (Shape::annulus(o, 0.0, 1.0), "the inner radius of an annulus is 0 m"),
        (Shape::cylinder(o, unit, 1.0), "a cylinder in 2D, expected 3D"),
        (Shape::union(vec![]), "a union has no shapes"),
        (Shape::intersection(vec![]), "an intersection has no shapes"),
        (Shape::difference(Shape::ball(o, 1.0).unwrap(), vec![]), "what a difference removes"),
    ];
    for (result, message) in refused {
        let error = result.expect_err(message).to_string();
        assert!(error.contains(message), "{error}");
    }
    let origin = Vector::<3>::zeros();
    let error = Shape::cylinder(origin, origin, 1.0).unwrap_err().to_string();
    assert!(error.contains("the length of a cylinder is 0 m"), "{error}");
    let error = Shape::annulus(Vector::<1>::zeros(), 1.0, 2.0).unwrap_err().to_string();
    assert!(error.contains("an annulus in 1D"), "{error}");
}

/// Shapes with a test of their own for whether a point is inside.
type Definition = fn(&Vector<3>) -> bool;

fn shapes() -> Vec<(Shape<3>, Definition)> {
    let v = Vector::<3>::new;
    let cube = || Shape::cuboid(v(-1.0, -1.0, -1.0), v(1.0, 1.0, 1.0)).unwrap();
    let ball = || Shape::ball(v(1.0, 0.0, 0.0), 1.0).unwrap();
    let axis = || Shape::cylinder(v(0.0, 0.0, -2.0), v(0.0, 0.0, 2.0), 0.5).unwrap();
    fn in_cube(x: &Vector<3>) -> bool {
        x.amax() <= 1.0
    }
    fn in_ball(x: &Vector<3>) -> bool {
        (x.x - 1.0).powi(2) + x.y.powi(2) + x.z.powi(2) <= 1.0
    }
    fn in_axis(x: &Vector<3>) -> bool {
        x.x.hypot(x.y) <= 0.5 && x.z.abs() <= 2.0
    }
    vec![
        (cube(), in_cube),
        (ball(), in_ball),
        (axis(), in_axis),
        (Shape::annulus(v(1.0, 0.0, 0.0), 0.5, 1.0).unwrap(), |x| {
            in_ball(x) && (x - Vector::<3>::new(1.0, 0.0, 0.0)).norm() >= 0.5
        }),
        (Shape::union(vec![cube(), ball(), axis()]).unwrap(), |x| {
            in_cube(x) || in_ball(x) || in_axis(x)
        }),
        (Shape::intersection(vec![cube(), ball()]).unwrap(), |x| in_cube(x) && in_ball(x)),
        (Shape::difference(cube(), vec![ball(), axis()]).unwrap(), |x| {
            in_cube(x) && !in_ball(x) && !in_axis(x)
        }),
    ]
}

proptest! {
    #[test]
    fn shapes_hold_what_their_definition_says(x in -2.2..2.2f64, y in -2.2..2.2f64, z in -2.2..2.2f64) {
        let point = Vector::<3>::new(x, y, z);
        for (shape, definition) in shapes() {
            // Rounding decides within 1e-12 of a boundary; a random point is never that near.
            prop_assert_eq!(shape.contains(&point), definition(&point));
            let (min, max) = shape.bounding_box();
            if shape.contains(&point) {
                prop_assert!((0..3).all(|k| min[k] <= point[k] && point[k] <= max[k]));
            }
        }
    }

    #[test]
    fn depths_change_no_faster_than_positions(
        from in prop::array::uniform3(-3.0..3.0f64), to in prop::array::uniform3(-3.0..3.0f64),
    ) {
        // What the cut cells of a lattice rely on.
        let [from, to] = [from, to].map(Vector::<3>::from);
        for (shape, _) in shapes() {
            let change = (shape.depth(&to) - shape.depth(&from)).abs();
            prop_assert!(change <= (to - from).norm() * (1.0 + 1e-12));
        }
    }

    #[test]
    fn cylinders_touch_their_bounding_boxes(
        end in prop::array::uniform3(-1.0..1.0f64), radius in 0.1..2.0f64,
    ) {
        prop_assume!(Vector::<3>::from(end).norm() > 0.1);
        let end = Vector::<3>::from(end);
        let shape = Shape::cylinder(Vector::zeros(), end, radius).unwrap();
        let (min, max) = shape.bounding_box();
        let direction = end.normalize();
        for axis in 0..3 {
            // The highest point of the rim around an end, by projecting the axis on its plane.
            let mut up = Vector::<3>::zeros();
            up[axis] = 1.0;
            let across = up - direction * direction[axis];
            let rim = if across.norm() > 0.0 { across.normalize()[axis] * radius } else { 0.0 };
            prop_assert!((max[axis] - end[axis].max(0.0) - rim).abs() < 1e-9);
            prop_assert!((min[axis] - end[axis].min(0.0) + rim).abs() < 1e-9);
        }
    }
}

fn arrow() -> Vec<Vector<2>> {
    [[0.0, 0.0], [2.0, 0.0], [0.5, 0.5], [0.0, 2.0]].map(Vector::<2>::from).to_vec()
}

#[test]
fn polygons_may_be_hollow_and_go_either_way_round() {
    for reverse in [false, true] {
        let mut corners = arrow();
        if reverse {
            corners.reverse();
        }
        let flat = Shape::<2>::polygon(corners.clone(), None).unwrap();
        let tall = Shape::<3>::polygon(corners, Some([1.0, 4.0])).unwrap();
        for (x, y, inside) in [
            (0.25, 0.25, true),
            (0.6, 0.6, false),
            (1.5, 0.1, true),
            (1.5, 0.3, false),
            (-0.1, 1.0, false),
            (0.1, 1.9, false),
            (0.1, 1.0, true),
            (3.0, 0.0, false),
        ] {
            assert_eq!(flat.contains(&Vector::<2>::new(x, y)), inside, "{x} {y}");
            assert_eq!(tall.contains(&Vector::<3>::new(x, y, 2.0)), inside, "{x} {y}");
            assert!(!tall.contains(&Vector::<3>::new(x, y, 0.9)));
        }
        // The distance to the side from (2, 0) to (0.5, 0.5), whose normal is (1, 3).
        let depth = flat.depth(&Vector::<2>::new(1.0, 0.2));
        assert!((depth - 0.2_f64.min(0.4 / 10f64.sqrt())).abs() < 1e-15, "{depth}");
        assert_eq!(flat.exact_volume(), Some(1.0));
        assert_eq!(tall.exact_volume(), Some(3.0));
        let (min, max) = tall.bounding_box();
        assert_eq!((min, max), (Vector::<3>::new(0.0, 0.0, 1.0), Vector::<3>::new(2.0, 2.0, 4.0)));
    }
}

#[test]
fn polygons_that_are_none_are_refused() {
    let of = |corners: &[[f64; 2]]| {
        Shape::<2>::polygon(corners.iter().map(|corner| Vector::from(*corner)).collect(), None)
            .map_err(|error| error.to_string())
            .unwrap_err()
    };
    assert!(of(&[[0.0, 0.0], [1.0, 0.0]]).contains("2 corners"));
    let hourglass = [[0.0, 0.0], [1.0, 1.0], [1.0, 0.0], [0.0, 1.0]];
    assert!(of(&hourglass).contains("sides 1 and 3"));
    assert!(of(&[[0.0, 0.0], [1.0, 0.0], [0.5, 0.0]]).contains("cross or touch"));
    assert!(of(&[[0.0, 0.0], [0.0, 0.0], [0.5, 1.0]]).contains("side of a polygon"));
    assert!(of(&[[0.0, 0.0], [f64::NAN, 0.0], [0.5, 1.0]]).contains("corner of a polygon"));
    let ends = Some([1.0, 1.0]);
    assert!(Shape::<3>::polygon(arrow(), ends).is_err());
    assert!(Shape::<2>::polygon(arrow(), ends).is_err());
    assert!(Shape::<3>::polygon(arrow(), None).is_err());
}

/// A point of the turned shape is one of the shape that was turned there.
#[test]
fn turned_shapes_are_where_rotations_take_them() {
    let block = Shape::cuboid(Vector::zeros(), Vector::<3>::new(3.0, 2.0, 1.0)).unwrap();
    let about = Vector::<3>::new(1.0, 0.0, 0.0);
    let quarter = std::f64::consts::FRAC_PI_2;
    let turned = block.clone().turned(quarter, about, Vector::<3>::new(0.0, 0.0, 2.0)).unwrap();
    let (min, max) = turned.bounding_box();
    let [low, high] = [[-1.0, -1.0, 0.0], [1.0, 2.0, 1.0]].map(Vector::<3>::from);
    assert!((min - low).norm() < 1e-15 && (max - high).norm() < 1e-15, "{min} {max}");
    assert_eq!(turned.exact_volume(), Some(6.0));
    // Of the corner (3, 2), and of a point off it.
    assert!((turned.depth(&Vector::<3>::new(-0.9, 1.9, 0.5)) - 0.1).abs() < 1e-15);
    assert!((turned.depth(&Vector::<3>::new(1.2, 1.0, 0.5)) + 0.2).abs() < 1e-15);
    assert!(block.clone().turned(f64::NAN, about, Vector::<3>::z()).is_err());
    assert!(block.turned(1.0, about, Vector::<3>::zeros()).is_err());
}
