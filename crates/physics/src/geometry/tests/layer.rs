//! Layers against the volumes of parallel bodies.

use std::f64::consts::PI;
use std::sync::Arc;

use proptest::prelude::*;

use super::facets::cuboid;
use crate::Vector;
use crate::geometry::{
    Facets, LatticeSpec, LayerSide, Placement, Probe, Shape, fill, surroundings,
};

const SIDES: [LayerSide; 2] = [LayerSide::Outside, LayerSide::Inside];

/// What particles of a lattice find the volume of a shape to be.
fn volume<const D: usize>(shape: &Shape<D>, spacing: f64) -> f64 {
    let spec = LatticeSpec { placement: Placement::Cells, ..LatticeSpec::square([spacing; D]) };
    fill(shape, &spec).unwrap().total_volume
}

fn block_of_facets(end: [f64; 3]) -> Shape<3> {
    Shape::surface(Arc::new(Facets::new(cuboid(end)).unwrap())).unwrap()
}

/// A sphere of facets, by halving the edges of an octahedron. The radius is that of the corners.
fn sphere(halvings: usize) -> Facets {
    let axis =
        |axis: usize, sign: f64| Vector::<3>::from_fn(|k, _| if k == axis { sign } else { 0.0 });
    let mut all = Vec::new();
    for signs in 0..8 {
        let ends: [Vector<3>; 3] =
            std::array::from_fn(|k| axis(k, if signs >> k & 1 == 0 { 1.0 } else { -1.0 }));
        all.push(if (signs as u32).count_ones().is_multiple_of(2) {
            ends
        } else {
            [ends[1], ends[0], ends[2]]
        });
    }
    for _ in 0..halvings {
        all = all
            .into_iter()
            .flat_map(|[a, b, c]| {
                let [d, e, f] = [a + b, b + c, c + a].map(|x| x.normalize());
                [[a, d, f], [d, b, e], [f, e, c], [d, e, f]]
            })
            .collect();
    }
    Facets::new(all).unwrap()
}

/// The volume within `t` of a convex body, with what is in it: `V + S t + M t^2 + 4 pi t^3/3`, with the sum of its edges times
/// their angles, here a quarter turn each, over two in `M` (Steiner).
#[test]
fn layers_outside_have_the_volumes_of_parallel_bodies() {
    let end = [1.0, 1.5, 0.5];
    let t = 0.25;
    let [faces, edges] = [2.0 * (1.5 + 0.5 + 0.75), 4.0 * 3.0];
    let exact = faces * t + edges * PI / 4.0 * t * t + 4.0 / 3.0 * PI * t.powi(3);
    let plain = Shape::cuboid(Vector::zeros(), Vector::<3>::from(end)).unwrap();
    let corners = [[0.0, 0.0], [1.0, 0.0], [1.0, 1.5], [0.0, 1.5]].map(Vector::<2>::from).to_vec();
    let prism = Shape::polygon(corners.clone(), Some([0.0, 0.5])).unwrap();
    for shape in [block_of_facets(end), plain, prism] {
        let layer = shape.layer(t, LayerSide::Outside).unwrap();
        let (min, max) = layer.bounding_box();
        assert_eq!((min, max), (Vector::repeat(-t), Vector::<3>::from(end).add_scalar(t)));
        // The edges are quarters of cylinders of 40 midpoints of cells in radius.
        let found = volume(&layer, 0.05);
        assert!((found / exact - 1.0).abs() < 1e-3, "{found} of {exact}");
    }
    // In the plane `A + P t + pi t^2`.
    let flat = Shape::<2>::polygon(corners, None).unwrap();
    let found = volume(&flat.layer(t, LayerSide::Outside).unwrap(), 0.05);
    let exact = 5.0 * t + PI * t * t;
    assert!((found / exact - 1.0).abs() < 1e-3, "{found} of {exact}");
}

#[test]
fn layers_inside_are_what_is_left_of_a_body_without_its_core() {
    let (end, t) = ([1.0, 1.5, 0.5], 0.2);
    let exact = 0.75 - 0.6 * 1.1 * 0.1;
    let found = volume(&block_of_facets(end).layer(t, LayerSide::Inside).unwrap(), 0.1);
    assert!((found / exact - 1.0).abs() < 1e-3, "{found} of {exact}");
    // One that is as thick as the body is the body.
    let found = volume(&block_of_facets(end).layer(0.25, LayerSide::Inside).unwrap(), 0.1);
    assert!((found - 0.75).abs() < 1e-12, "{found}");
}

#[test]
fn layers_of_spheres_are_shells() {
    let facets = Arc::new(sphere(5));
    // The facets are below the sphere by at most the height of a chord of 1/32 of a quarter turn.
    let chord = 1.0 - (PI / 128.0).cos();
    for (side, [inner, outer]) in SIDES.into_iter().zip([[1.0, 1.3], [0.7, 1.0]]) {
        let shell = Shape::<3>::surface(facets.clone()).unwrap().layer(0.3, side).unwrap();
        let exact = 4.0 / 3.0 * PI * (outer * outer * outer - inner * inner * inner);
        let found = volume(&shell, 0.1);
        // All of the layer lies deeper by up to that, so that its volume is less by the difference of what two spheres are less.
        let less = 4.0 * PI * chord * (outer * outer - inner * inner);
        assert!((found - exact).abs() < less + 1e-3 * exact, "{found} of {exact}");
        let ball = Shape::ball(Vector::<3>::zeros(), 1.0).unwrap().layer(0.3, side).unwrap();
        let found = volume(&ball, 0.1);
        assert!((found / exact - 1.0).abs() < 1e-3, "{found} of {exact}");
    }
    let (t, exact) = (0.3, PI * (1.3 * 1.3 - 1.0));
    let disc =
        Shape::ball(Vector::<2>::zeros(), 1.0).unwrap().layer(t, LayerSide::Outside).unwrap();
    let found = volume(&disc, 0.05);
    assert!((found / exact - 1.0).abs() < 1e-3, "{found} of {exact}");
}

/// A plate with a hole.
fn plate<const D: usize>(ends: Option<[f64; 2]>) -> Shape<D> {
    let square = |from: f64, to: f64| {
        let corners = [[from, from], [to, from], [to, to], [from, to]];
        Shape::polygon(corners.map(Vector::<2>::from).to_vec(), ends).unwrap()
    };
    Shape::difference(square(0.0, 2.0), vec![square(0.5, 1.5)]).unwrap()
}

#[test]
fn layers_of_outlines_are_on_all_their_sides() {
    let t = 0.1;
    // Round outside of corners, and square in those of the hole.
    let exact = 4.0 * 2.0 * t + PI * t * t + (1.0 - 0.8 * 0.8);
    let layer = plate::<2>(None).layer(t, LayerSide::Outside).unwrap();
    let found = volume(&layer, 0.05);
    assert!((found / exact - 1.0).abs() < 1e-3, "{found} of {exact}");
    // A thick one has none over the mouth of the hole.
    let layer = plate::<3>(Some([0.0, 1.0])).layer(t, LayerSide::Outside).unwrap();
    let at = |x, z| layer.contains(&Vector::<3>::new(x, 1.0, z));
    assert!(at(0.55, 0.5) && !at(1.0, 0.5) && !at(1.0, 1.05) && at(0.2, 1.05) && !at(0.2, 1.11));
    // Above the rim of the hole it is round.
    let off = |r: f64| Vector::<3>::new(0.5 + r * 0.6, 1.0, 1.0 + r * 0.8);
    assert!(layer.contains(&off(0.0999)) && !layer.contains(&off(0.1001)));
}

#[test]
fn impossible_layers_are_refused() {
    let ball = |x: f64| Shape::ball(Vector::<2>::new(x, 0.0), 1.0).unwrap();
    let of = |shape: Shape<2>, thickness| {
        shape.layer(thickness, LayerSide::Outside).map_err(|error| error.to_string()).unwrap_err()
    };
    for thickness in [0.0, -1.0, f64::NAN, f64::INFINITY] {
        assert!(of(ball(0.0), thickness).contains("the thickness of a layer is"), "{thickness}");
    }
    assert!(of(ball(0.0), 1e308).contains("the extent of a layer"));
    let pair = || vec![ball(0.0), ball(1.0)];
    let layer = ball(0.0).layer(0.1, LayerSide::Inside).unwrap();
    for shape in [Shape::union(pair()), Shape::intersection(pair()), Ok(layer)] {
        assert!(of(shape.unwrap(), 0.1).contains("the boundary of one shape"));
    }
}

#[test]
fn layers_of_turned_shapes_are_turned() {
    let block = || Shape::cuboid(Vector::zeros(), Vector::<2>::new(2.0, 1.0)).unwrap();
    let about = Vector::<2>::new(0.5, 0.5);
    let axis = nalgebra::Vector3::z();
    let one = block().turned(0.4, about, axis).unwrap().layer(0.2, LayerSide::Outside).unwrap();
    let other = block().layer(0.2, LayerSide::Outside).unwrap().turned(0.4, about, axis).unwrap();
    assert_eq!(one, other);
}

/// A wall that is a layer holds what is in its shape, wherever in the layer a particle is.
#[test]
fn ways_out_of_a_thicker_layer_lead_to_its_shape() {
    let bounds = (Vector::<3>::repeat(-0.3), Vector::<3>::repeat(1.3));
    let layer = block_of_facets([1.0; 3]).layer(0.3, LayerSide::Outside).unwrap();
    let thick = layer.thickened((bounds.1 - bounds.0).norm());
    for depth in [0.05, 0.15, 0.25] {
        let faces = thick.ways_out(&Vector::<3>::new(0.4, 0.5, -depth), 0.0, &bounds);
        assert!((faces.between() - Vector::z()).norm() < 1e-9, "{faces:?}");
        assert!((faces.depth() - depth).abs() < 1e-9);
    }
    let disc = Shape::ball(Vector::<2>::zeros(), 1.0).unwrap();
    let layer = disc.layer(0.3, LayerSide::Outside).unwrap();
    let (low, high) = layer.bounding_box();
    let thick = layer.thickened((high - low).norm());
    let radial = Vector::<2>::new(0.6, 0.8);
    let way = |shape: &Shape<2>| shape.ways_out(&(radial * 1.25), 0.0, &(low, high)).between();
    assert!((way(&thick) + radial).norm() < 2e-3, "{}", way(&thick));
    // As it is, its other face is nearer.
    assert!((way(&layer) - radial).norm() < 2e-3, "{}", way(&layer));
}

/// A layer that is no wall has two faces, the nearer of which counts.
#[test]
fn ways_out_of_a_layer_of_facets_lead_to_the_nearer_face() {
    let bounds = (Vector::<3>::repeat(-9.0), Vector::<3>::repeat(9.0));
    for (side, sign) in SIDES.into_iter().zip([-1.0, 1.0]) {
        let layer = block_of_facets([1.0; 3]).layer(0.3, side).unwrap();
        for (depth, out, least) in [(0.1, -1.0, 0.1), (0.2, 1.0, 0.1), (0.25, 1.0, 0.05)] {
            let faces = layer.ways_out(&Vector::<3>::new(0.4, 0.5, sign * depth), 0.0, &bounds);
            let expected = Vector::z() * (sign * out);
            assert!((faces.between() - expected).norm() < 1e-9, "{faces:?}");
            assert!((faces.depth() - least).abs() < 1e-9, "{faces:?}");
        }
    }
    // Both of them, where the layer is thin.
    let layer = block_of_facets([1.0; 3]).layer(0.3, LayerSide::Inside).unwrap();
    let sides = layer.sides(&Vector::<3>::new(0.4, 0.5, 0.2), [0.4, 0.0], &bounds).unwrap();
    let [up, down] = sides.map(|faces| (faces.between(), faces.depth()));
    assert!((up.0 - Vector::z()).norm() < 1e-9 && (up.1 - 0.1).abs() < 1e-9, "{up:?}");
    assert!((down.0 + Vector::z()).norm() < 1e-9 && (down.1 - 0.2).abs() < 1e-6, "{down:?}");
}

#[test]
fn sites_around_a_layer_are_not_in_it() {
    let layer = block_of_facets([1.0; 3]).layer(0.2, LayerSide::Inside).unwrap();
    let spec = LatticeSpec { placement: Placement::Cells, ..LatticeSpec::square([0.1; 3]) };
    let around = surroundings(&layer, &spec, 0.1).unwrap();
    // The next layer of sites around the ten of an edge, 0.05 off, and the outermost of the six in the middle.
    let [outside, inside] = [12 * 12 * 12 - 10 * 10 * 10, 6 * 6 * 6 - 4 * 4 * 4];
    assert_eq!(around.len(), outside + inside);
}

fn layers() -> Vec<Shape<3>> {
    let v = Vector::<3>::new;
    let shapes = || {
        [
            block_of_facets([1.0, 0.8, 0.6]),
            Shape::cuboid(Vector::zeros(), v(1.0, 0.8, 0.6)).unwrap(),
            Shape::cylinder(v(0.2, 0.2, 0.2), v(0.8, 0.8, 0.8), 0.4).unwrap(),
            Shape::annulus(Vector::repeat(0.5), 0.3, 0.6).unwrap(),
        ]
    };
    SIDES
        .into_iter()
        .flat_map(|side| shapes().map(|shape| shape.layer(0.15, side).unwrap()))
        .collect()
}

proptest! {
    /// What the cut cells of a lattice rely on, and what places near each other find one after the other.
    #[test]
    fn depths_in_layers_change_no_faster_than_positions(
        from in prop::array::uniform3(-0.5..1.5f64), to in prop::array::uniform3(-0.5..1.5f64),
    ) {
        let [from, to] = [from, to].map(Vector::<3>::from);
        for shape in layers() {
            let change = (shape.depth(&to) - shape.depth(&from)).abs();
            prop_assert!(change <= (to - from).norm() * (1.0 + 1e-12));
            let mut probe = Probe::of(&shape);
            for x in [from, to] {
                let (depth, reach) = (shape.depth(&x), 0.1);
                let found = probe.depth(&x, reach);
                let is_same = match depth.abs() < reach {
                    true => (found - depth).abs() < 1e-12,
                    false => found * depth > 0.0 && found.abs() >= reach * (1.0 - 1e-12),
                };
                prop_assert!(is_same, "{} for {} at {}", found, depth, x);
                prop_assert_eq!(probe.contains(&x), depth >= 0.0);
            }
        }
    }
}
