//! Depths that follow from those before against depths that are found anew.

use std::sync::Arc;

use nalgebra::Vector3;
use proptest::prelude::*;

use super::facets::{Triangle, cuboid, torus};
use crate::Vector;
use crate::geometry::probe::Probe;
use crate::geometry::{Facets, Shape};

fn surface(triangles: Vec<Triangle>) -> Shape<3> {
    Shape::surface(Arc::new(Facets::new(triangles).unwrap())).unwrap()
}

/// Two boxes of facets in one surface that lie in each other, so that it winds twice round what is in both; the second a bit
/// askew.
fn crossing() -> Vec<Triangle> {
    let turn = nalgebra::Rotation3::from_euler_angles(0.1, 0.2, 0.3);
    let moved = |corner: Vector<3>| turn * corner * 0.7 + Vector::<3>::new(0.5, 0.2, 0.3);
    let mut all = cuboid([1.0, 1.0, 1.0]);
    all.extend(cuboid([1.0, 1.0, 1.0]).iter().map(|facet| facet.map(moved)));
    all
}

fn shapes() -> Vec<Shape<3>> {
    let ring = Arc::new(Facets::new(torus(24, 12)).unwrap());
    let ring = || Shape::surface(ring.clone()).unwrap();
    let low = Vector::<3>::new(-1.6, -1.6, 0.0);
    let half = Shape::cuboid(low, Vector::<3>::new(1.6, 1.6, 1.0)).unwrap();
    let turned = ring().turned(0.7, low, Vector3::new(1.0, 2.0, 0.5)).unwrap();
    vec![
        surface(cuboid([1.0, 1.0, 1.0])),
        surface(crossing()),
        surface(torus(24, 12)[1..].to_vec()),
        Shape::difference(half, vec![ring()]).unwrap(),
        // The same surface in two places.
        Shape::union(vec![ring(), turned]).unwrap(),
    ]
}

proptest! {
    /// Walks on a grid whose planes, edges and corners are those of the facets of a box, so that ways lead along facets and
    /// through edges, and walks off it.
    #[test]
    fn walks_tell_what_is_told_anew(
        steps in prop::collection::vec((-2i32..3, -2i32..3, -2i32..3), 1..60),
        off in prop::sample::select(vec![0.0, 0.013]),
        reach in 0.05..0.6f64,
    ) {
        for shape in shapes() {
            let mut place = Vector::<3>::repeat(off);
            let mut walked = Probe::of(&shape);
            let mut contained = Probe::of(&shape);
            for &(x, y, z) in &steps {
                place += Vector::<3>::new(f64::from(x), f64::from(y), f64::from(z)) * 0.125;
                let expected = shape.depth(&place);
                let found = walked.depth(&place, reach);
                if expected.abs() < reach {
                    prop_assert_eq!(found, expected);
                } else {
                    prop_assert!(found.abs() >= reach && found * expected > 0.0);
                }
                prop_assert_eq!(contained.contains(&place), shape.contains(&place));
            }
        }
    }

    #[test]
    fn what_is_in_a_ball_is_told_from_the_facets_in_it(
        center in prop::array::uniform3(-1.4..1.4f64),
        radius in 0.02..0.5f64,
        places in prop::collection::vec(prop::array::uniform3(-0.57..0.57f64), 1..40),
    ) {
        let center = Vector::<3>::from(center);
        for shape in shapes() {
            let mut probe = Probe::around(&shape, &center, radius);
            for place in &places {
                let place = center + Vector::<3>::from(*place) * radius;
                prop_assert_eq!(probe.contains(&place), shape.contains(&place));
                // A smaller ball that is clear is on one side of the boundary.
                let own = 0.1 * radius;
                let depth = probe.depth(&center, 2.0 * own);
                if depth.abs() > own {
                    prop_assert!(depth * shape.depth(&center) > 0.0);
                    prop_assert!(shape.depth(&center).abs() >= own * (1.0 - 1e-12));
                }
            }
        }
    }
}
