//! Surfaces of triangles against shapes that are known, and files of them.

use std::f64::consts::PI;
use std::io::Write;

use nalgebra::Rotation3;
use proptest::prelude::*;

use crate::Vector;
use crate::geometry::{
    Arrangement, Facets, GeometryError, LatticeSpec, Placement, Shape, SurfaceError, fill,
};

pub(super) type Triangle = [Vector<3>; 3];

/// A torus about z with radii of 1 and 0.4 m, its outside facing out.
pub(super) fn torus(around: usize, along: usize) -> Vec<Triangle> {
    let place = |i: usize, j: usize| {
        let [a, b] = [i as f64 / around as f64, j as f64 / along as f64].map(|x| 2.0 * PI * x);
        let radius = 1.0 + 0.4 * b.cos();
        Vector::<3>::new(radius * a.cos(), radius * a.sin(), 0.4 * b.sin())
    };
    let mut all = Vec::new();
    for i in 0..around {
        for j in 0..along {
            let (k, l) = ((i + 1) % around, (j + 1) % along);
            all.push([place(i, j), place(k, j), place(k, l)]);
            all.push([place(i, j), place(k, l), place(i, l)]);
        }
    }
    all
}

/// The depth in a torus without facets.
fn depth_of_torus(x: &Vector<3>) -> f64 {
    0.4 - (x.xy().norm() - 1.0).hypot(x.z)
}

/// The box from 0 to `end`.
pub(super) fn cuboid(end: [f64; 3]) -> Vec<Triangle> {
    let corner = |bits: usize| {
        Vector::<3>::from_fn(|axis, _| if bits >> axis & 1 == 1 { end[axis] } else { 0.0 })
    };
    let sides =
        [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]];
    let both = |[a, b, c, d]: [usize; 4]| [[a, b, c], [a, c, d]].map(|facet| facet.map(corner));
    sides.into_iter().flat_map(both).collect()
}

/// Places all over a box that is somewhat larger than a torus.
fn places() -> impl Iterator<Item = Vector<3>> {
    // Three numbers without a common measure fill the box evenly.
    (1..3000).map(|k| {
        let part = |step: f64| (f64::from(k) * step).fract() - 0.5;
        Vector::<3>::new(3.2 * part(0.819_172_5), 3.2 * part(0.671_043_6), 1.2 * part(0.549_700_4))
    })
}

#[test]
fn a_torus_is_as_deep_as_its_facets_are_fine() {
    let facets = Facets::new(torus(200, 80)).unwrap();
    assert!(facets.soundness().is_closed());
    assert_eq!((facets.soundness().flipped, facets.soundness().left_out), (0, 0));
    // Chords are r (1 - cos(half an angle)) below their arcs: 1.4 (1.57e-2)^2/2 and 0.4 (3.93e-2)^2/2.
    let chord = 1.8e-4 + 3.1e-4;
    for x in places() {
        let expected = depth_of_torus(&x);
        let found = facets.depth(&x);
        assert!((found - expected).abs() < chord, "{found} for {expected} at {x}");
        let winding = facets.winding(&x);
        let sharp = if found > 0.0 { 1.0 } else { 0.0 };
        // What nodes at twice their radius are off by, the third power of a half, leaves no doubt on which side of a half.
        assert!((winding - sharp).abs() < 1.0 / 8.0, "{winding} at {x}, {found} deep");
    }
    let exact = 2.0 * PI * PI * 0.16;
    let volume = facets.volume().unwrap();
    assert!(volume < exact && volume > exact * (1.0 - 2.0 * chord / 0.4), "{volume} of {exact}");
}

#[test]
fn a_box_of_facets_is_a_box() {
    let end = [1.0, 2.0, 3.0];
    let facets = Facets::new(cuboid(end)).unwrap();
    assert_eq!(facets.volume(), Some(6.0));
    assert_eq!(facets.bounding_box(), (Vector::zeros(), Vector::from(end)));
    let (thickness, spot) = facets.thinner_than(2.0).unwrap();
    // Facets 9 to 12 have the least to their other sides; of those, x is 0 behind the first.
    assert!((thickness - 1.0).abs() < 1e-12 && spot.facet == 9, "{thickness} {spot}");
    assert_eq!(spot.place.x, 0.0);
    assert_eq!(facets.thinner_than(0.9), None);
    assert_eq!(facets.crossings(9), 0);
    let surface = Shape::surface(facets.into()).unwrap();
    let plain = Shape::cuboid(Vector::zeros(), Vector::<3>::from(end)).unwrap();
    for x in places() {
        let x = x + Vector::<3>::new(0.5, 1.0, 1.5);
        let (found, expected) = (surface.depth(&x), plain.depth(&x));
        let is_same = if expected > 0.0 { (found - expected).abs() < 1e-12 } else { found < 0.0 };
        assert!(is_same, "{found} for {expected} at {x}");
    }
    // On the same lattice there are the same particles, with what is inside of their cells.
    let spec =
        LatticeSpec { placement: Placement::Cells, ..LatticeSpec::square([0.25, 0.25, 0.25]) };
    let [found, expected] = [&surface, &plain].map(|shape| fill(shape, &spec).unwrap());
    assert_eq!(found.particles.position, expected.particles.position);
    assert!((found.total_volume - 6.0).abs() < 1e-12);
}

#[test]
fn walls_of_facets_have_their_normals() {
    let surface = Shape::surface(Facets::new(torus(200, 80)).unwrap().into()).unwrap();
    let far = Shape::ball(Vector::<3>::repeat(8.0), 1.0).unwrap();
    let bounds = (Vector::<3>::repeat(-9.0), Vector::<3>::repeat(9.0));
    for shape in [surface.clone(), Shape::union(vec![far, surface]).unwrap()] {
        for x in places().filter(|x| (0.02..0.3).contains(&depth_of_torus(x))).take(200) {
            let ring = Vector::<3>::new(x.x, x.y, 0.0).normalize();
            let faces = shape.ways_out(&x, 0.0, &bounds);
            // A facet is an eightieth of a turn.
            let turned = faces.between().dot(&(x - ring).normalize());
            assert!(turned > (PI / 80.0_f64).cos() - 1e-3, "{turned} at {x}");
            assert!((faces.depth() - depth_of_torus(&x)).abs() < 5e-4);
        }
    }
    let cuboid = Shape::surface(Facets::new(cuboid([1.0; 3])).unwrap().into()).unwrap();
    let faces = cuboid.ways_out(&Vector::<3>::new(0.1, 0.1, 0.5), 0.0, &bounds);
    assert_eq!(faces.normals().len(), 2, "behind an edge: {faces:?}");
    // A tank has the walls of what is cut out of it, and on a facet there is its normal.
    let block = Shape::cuboid(Vector::<3>::repeat(-1.0), Vector::<3>::repeat(2.0)).unwrap();
    let tank = Shape::difference(block, vec![cuboid.clone()]).unwrap();
    for (x, shape, sign) in
        [(-0.2, &tank, 1.0), (0.0, &tank, 1.0), (0.0, &cuboid, -1.0), (0.2, &cuboid, -1.0)]
    {
        let faces = shape.ways_out(&Vector::<3>::new(x, 0.45, 0.55), 0.0, &bounds);
        assert_eq!(faces.normals().len(), 1, "{faces:?}");
        assert!((faces.between() - Vector::x() * sign).norm() < 1e-9, "{faces:?} at {x}");
        assert!((faces.depth() - x.abs()).abs() < 1e-9);
    }
    let askew = cuboid.clone().turned(0.3, Vector::zeros(), Vector::<3>::z()).unwrap();
    let faces = askew.ways_out(&Vector::<3>::new(0.1, 0.4, 0.5), 0.0, &bounds);
    assert!((faces.between() + Vector::<3>::new(0.3_f64.cos(), 0.3_f64.sin(), 0.0)).norm() < 1e-9);
    let side = cuboid.ways_out(&Vector::<3>::new(0.1, 0.3, 0.5), 0.0, &bounds);
    assert_eq!(side.normals().len(), 1);
    assert!((side.between() + Vector::x()).norm() < 1e-12, "{side:?}");
}

#[test]
fn holes_and_facets_that_are_turned_or_there_twice_do_no_harm() {
    let sound = Facets::new(torus(60, 30)).unwrap();
    let mut spoilt = torus(60, 30);
    for triangle in spoilt.iter_mut().skip(5).step_by(7) {
        triangle.swap(0, 1);
    }
    let turned = spoilt.iter().skip(5).step_by(7).count();
    let twice: Vec<Triangle> = spoilt.iter().step_by(11).copied().collect();
    let count = twice.len();
    spoilt.extend(twice);
    spoilt.push([spoilt[0][0], spoilt[0][0], spoilt[0][1]]);
    let mended = Facets::new(spoilt).unwrap();
    let found = mended.soundness();
    assert_eq!((found.flipped, found.left_out, found.open_edges), (turned, count + 1, 0));
    let text = found.to_string();
    let middle = |[a, b, c]: Triangle| (a + b + c) / 3.0;
    let first = found.first_flipped.unwrap();
    assert_eq!(first.facet, 6);
    assert!((first.place - middle(torus(60, 30)[5])).norm() < 1e-12, "{first}");
    // What is there twice comes behind the others: the first of it is like the first of all.
    let first = found.first_left_out.unwrap();
    assert_eq!(first.facet, torus(60, 30).len() + 1);
    assert!((first.place - middle(torus(60, 30)[0])).norm() < 1e-12, "{first}");
    assert!(text.contains(&format!(
        "{turned} facets with reversed orientation were flipped, first facet 6 at (1."
    )));
    let said = "that are duplicates or have no area were left out, first facet 3601 at (1.";
    assert!(text.contains(said), "{text}");
    let mut one = torus(60, 30);
    one[6].swap(0, 1);
    one.push(one[8]);
    let one = Facets::new(one).unwrap().soundness().to_string();
    for said in [
        "1 facet with reversed orientation was flipped, facet 7 at (",
        "1 facet that is a duplicate or has no area was left out, facet 3601 at (",
    ] {
        assert!(one.contains(said), "{one}");
    }
    // A hole of a facet of 0.13 by 0.08 m.
    let holed = Facets::new(torus(60, 30)[1..].to_vec()).unwrap();
    assert_eq!((holed.soundness().open_edges, holed.volume()), (3, None));
    // The second facet is beside the first one: they have a diagonal in common.
    let diagonal = (torus(60, 30)[0][0] + torus(60, 30)[0][2]) * 0.5;
    let first = holed.soundness().first_open.unwrap();
    assert!(first.facet == 1 && (first.place - diagonal).norm() < 1e-12, "{first}");
    let said = "3 edges have no facet on their other side, first an edge of facet 1 at (1.3";
    let text = holed.soundness().to_string();
    assert!(text.contains(said), "{text}");
    for x in places() {
        let expected = sound.depth(&x);
        assert!((mended.depth(&x) - expected).abs() < 1e-12, "at {x}");
        let is_near = (x - torus(60, 30)[0][0]).norm() < 0.3;
        assert!(is_near || (holed.depth(&x) - expected).abs() < 1e-12, "at {x}");
    }
    // Two boxes that touch are one, and a surface that is inside out is turned as a whole.
    let beside = cuboid([1.0; 3]).into_iter().map(|facet| facet.map(|x| x + Vector::x()));
    let both = Facets::new(cuboid([1.0; 3]).into_iter().chain(beside).collect()).unwrap();
    assert!(both.soundness().is_sound() && both.soundness().pieces > 1);
    assert!((both.depth(&Vector::<3>::new(0.9, 0.5, 0.4)) - 0.1).abs() < 1e-12);
    assert!((both.winding(&Vector::<3>::new(0.999, 0.5, 0.4)) - 1.0).abs() < 1e-12);
    let inside_out = |[a, b, c]: Triangle| [a, c, b];
    let turned = Facets::new(cuboid([1.0; 3]).into_iter().map(inside_out).collect()).unwrap();
    assert_eq!((turned.soundness().flipped, turned.volume()), (12, Some(1.0)));
    assert!((turned.depth(&Vector::<3>::new(0.5, 0.5, 0.3)) - 0.3).abs() < 1e-12);
    // A facet whose corners are in line closes the sides beside it.
    let mut sliver = cuboid([1.0; 3]);
    let [a, b, c] = sliver.remove(0);
    let middle = (a + b) * 0.5;
    sliver.extend([[a, b, middle], [a, middle, c], [middle, b, c]]);
    let closed = Facets::new(sliver).unwrap();
    assert_eq!((closed.soundness().open_edges, closed.soundness().left_out), (0, 1));
    // One box in another, and one that sticks out of it.
    let moved = |by: f64| {
        let all = cuboid([1.0; 3]).into_iter();
        all.map(move |facet| facet.map(|x| x * 0.5 + Vector::<3>::repeat(by)))
    };
    let crossings = |by: f64| {
        Facets::new(cuboid([1.0; 3]).into_iter().chain(moved(by)).collect())
            .unwrap()
            .crossings(1000)
    };
    assert_eq!(crossings(0.3), 0);
    // Edges of each box go through faces of the other.
    assert!(crossings(0.7) > 0);
    let both = Facets::new(cuboid([1.0; 3]).into_iter().chain(moved(0.7)).collect()).unwrap();
    let (first, other) = both.first_crossing().unwrap();
    // The face z = 1, which facets 3 and 4 make, is the first that the other box sticks out of, by four of its edges.
    assert!((3..=4).contains(&first.facet) && other > 12, "{first} {other}");
    assert!((first.place.z - 1.0).abs() < 1e-12, "{first}");
    assert!(first.place.iter().take(2).all(|x| (0.7..=1.0).contains(x)), "{first}");
    assert_eq!(Facets::new(cuboid([1.0; 3])).unwrap().first_crossing(), None);
}

/// A file with these bytes, and what is read of it.
fn read(name: &str, bytes: &[u8]) -> Result<Facets, SurfaceError> {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join(name);
    std::fs::File::create(&path).unwrap().write_all(bytes).unwrap();
    let rotation = Rotation3::identity();
    let arrangement = Arrangement { scale: 1.0, rotation, shift: Vector::zeros() };
    Facets::from_file(&path, &arrangement)
}

fn binary(head: &[u8; 80], triangles: &[Triangle]) -> Vec<u8> {
    let mut bytes = head.to_vec();
    bytes.extend((triangles.len() as u32).to_le_bytes());
    for triangle in triangles {
        bytes.extend([0; 12]);
        let numbers = triangle.iter().flat_map(|corner| corner.iter());
        bytes.extend(numbers.flat_map(|x| (*x as f32).to_le_bytes()));
        bytes.extend([0; 2]);
    }
    bytes
}

fn text(triangles: &[Triangle]) -> String {
    let mut text = "solid\n".to_owned();
    for triangle in triangles {
        text += " facet normal 0 0 0\n  outer loop\n";
        for x in triangle {
            text += &format!("   vertex {} {} {}\n", x.x, x.y, x.z);
        }
        text += "  endloop\n endfacet\n";
    }
    text + "endsolid\n"
}

const OBJ: &str = "# a box\nmtllib none.mtl\no box\nv 0 0 0\nv 1 0 0\nv 0 2 0\nv 1 2 0\nv 0 0 3\nv 1 0 3\nv 0 2 3\nv 1 2 3\n\
    f 1 3 4 2\nf 5 6 8 7\nf 1 2 6 5\nf 3 7 8 4\nf 1 5 7 3\nf 2 4 8 6\n";

const PLY: &str = "ply\nformat ascii 1.0\nelement vertex 8\nproperty float x\nproperty float y\nproperty float z\n\
    element face 6\nproperty list uchar int vertex_indices\nend_header\n0 0 0\n1 0 0\n0 2 0\n1 2 0\n0 0 3\n1 0 3\n0 2 3\n1 2 3\n\
    4 0 2 3 1\n4 4 5 7 6\n4 0 1 5 4\n4 2 6 7 3\n4 0 4 6 2\n4 1 3 7 5\n";

#[test]
fn files_of_all_kinds_have_the_same_box() {
    let triangles = cuboid([1.0, 2.0, 3.0]);
    let mut solid = [b' '; 80];
    solid[..5].copy_from_slice(b"solid");
    let parts = triangles.split_at(7);
    let several = text(parts.0).to_uppercase().replace("NORMAL 0 0 0", "normal nan nan nan");
    let several = several.to_lowercase() + &text(parts.1);
    let files: [(&str, Vec<u8>); 6] = [
        ("several.stl", several.into_bytes()),
        ("box.stl", binary(&[b'-'; 80], &triangles)),
        ("like_text.STL", binary(&solid, &triangles)),
        ("text.stl", text(&triangles).into_bytes()),
        ("box.obj", OBJ.as_bytes().to_vec()),
        ("box.ply", PLY.as_bytes().to_vec()),
    ];
    for (name, bytes) in files {
        let facets = read(name, &bytes).unwrap();
        assert_eq!(facets.volume(), Some(6.0), "{name}");
        assert!(facets.soundness().is_sound(), "{name}");
    }
    // Facets are counted as in the file, also where they have four corners.
    let open = OBJ.replace("f 1 2 6 5\n", "");
    let first = read("open.obj", open.as_bytes()).unwrap().soundness().first_open.unwrap();
    assert!(first.facet == 1 && first.place == Vector::<3>::new(0.5, 0.0, 0.0), "{first}");
    let turned = PLY.replace("4 1 3 7 5", "4 5 7 3 1");
    let found = *read("turned.ply", turned.as_bytes()).unwrap().soundness();
    assert_eq!((found.flipped, found.first_flipped.unwrap().facet), (1, 6));
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("box.obj");
    std::fs::write(&path, OBJ).unwrap();
    let rotation = Rotation3::from_axis_angle(&Vector::<3>::z_axis(), 0.5 * PI);
    let shift = Vector::<3>::new(0.0, 0.0, 7.0);
    let facets = Facets::from_file(&path, &Arrangement { scale: 1e-3, rotation, shift }).unwrap();
    let (low, high) = facets.bounding_box();
    assert!((low - Vector::<3>::new(-2e-3, 0.0, 7.0)).norm() < 1e-15);
    assert!((high - Vector::<3>::new(0.0, 1e-3, 7.003)).norm() < 1e-15);
}

#[test]
fn broken_files_are_told() {
    let mut short = binary(&[b'-'; 80], &cuboid([1.0; 3]));
    short.truncate(500);
    let mut nan = cuboid([1.0; 3]);
    nan[4][1].y = f64::NAN;
    let mut solid = [b' '; 80];
    solid[..5].copy_from_slice(b"solid");
    let mut long = binary(&solid, &cuboid([1.0; 3]));
    long.extend([0; 10]);
    let mut worded = text(&cuboid([1.0; 3]));
    worded = worded.replacen("vertex 0 1 0", "vertex 0 NaN 0", 1);
    let mut bits = b"ply\nformat binary_little_endian 1.0\nelement vertex 2\nproperty float x\nproperty float y\n\
        property float z\nend_header\n"
        .to_vec();
    bits.extend([0.0, 1.0, 2.0, 3.0, f32::NAN, 4.0].into_iter().flat_map(f32::to_le_bytes));
    let faults: [(&str, Vec<u8>, &str); 17] = [
        ("a.ply", bits, "the vertex 1 (from 0) is at (3, NaN, 4), expected finite coordinates"),
        ("a.stl", long, "its header announces 12 facets, and it has 10 bytes after the last"),
        (
            "a.ply",
            b"ply\nformat binary_little_endian 1.0\nelement x 18446744073709551615\nend_header\n"
                .to_vec(),
            "is broken: ",
        ),
        ("a.stl", short, "its header announces 12 facets, and it ends after 8 of them"),
        (
            "a.stl",
            b"solid a\nfacet normal 0 0 1\nouter loop\nvertex 1 2\n".to_vec(),
            "line 4: expected three finite coordinates after `vertex`, got `vertex 1 2`",
        ),
        ("a.stl", b"solid a\nfacet normal 0 0 1\nouter\n".to_vec(), "facet 1: "),
        (
            "a.stl",
            worded.into_bytes(),
            "line 5: expected three finite coordinates after `vertex`, got `vertex 0 NaN 0`",
        ),
        (
            "a.obj",
            OBJ.replace("v 1 2 0", "v 1 inf 0").into_bytes(),
            "line 7: expected three finite coordinates after `v`, got `v 1 inf 0`",
        ),
        (
            "a.obj",
            OBJ.replace("f 3 7 8 4", "f 3 7/1 9/1 4").into_bytes(),
            "line 15: a face refers to the vertex `9/1` (from 1) of 8",
        ),
        (
            "a.ply",
            PLY.replace("0 2 0\n", "0 nan 0\n").into_bytes(),
            "line 12: expected finite numbers or what the header announces, got `0 nan 0`",
        ),
        (
            "a.ply",
            PLY.replace("1 2 0\n", "1 two 0\n").into_bytes(),
            "line 13: expected finite numbers or what the header announces, got `1 two 0`",
        ),
        ("a.stl", binary(&[b'-'; 80], &nan), "a corner of facet 5 is at (1, NaN"),
        ("a.stl", binary(&[b'-'; 80], &[]), "no facets"),
        (
            "a.obj",
            b"v 0 0 0\nf 1 2 3\n".to_vec(),
            "is broken: line 2: a face refers to the vertex `2` (from 1) of 1",
        ),
        (
            "a.ply",
            PLY.replace("4 1 3 7 5", "4 1 3 7 8").into_bytes(),
            "facet 6 refers to the vertex 8 (from 0) of 8",
        ),
        ("a.ply", PLY.replace("float z", "float w").into_bytes(), "a vertex has no number `z`"),
        ("a.step", Vec::new(), "ends with `.stl`, `.obj` or `.ply`"),
    ];
    for (name, bytes, said) in faults {
        let error = read(name, &bytes).unwrap_err().to_string();
        assert!(error.contains(said), "{error}");
    }
    let missing = std::path::Path::new("no such file.stl");
    let rotation = Rotation3::identity();
    let plain = Arrangement { scale: 1.0, rotation, shift: Vector::zeros() };
    let error = Facets::from_file(missing, &plain).unwrap_err().to_string();
    assert!(error.contains("no such file.stl` cannot be read"), "{error}");
    let flat = Shape::<2>::surface(Facets::new(cuboid([1.0; 3])).unwrap().into());
    assert!(matches!(flat, Err(GeometryError::Dimension { .. })));
}

#[test]
fn large_files_with_wrong_counts_are_refused() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("a.stl");
    let rotation = Rotation3::identity();
    let plain = Arrangement { scale: 1.0, rotation, shift: Vector::zeros() };
    // Behind the header of 84 bytes, 100 MiB have 2 097 150 facets of 50 bytes, and 16 bytes.
    for (count, said) in [
        (7_u32, "its header announces 7 facets, and it has 104857166 bytes after the last"),
        (u32::MAX, "its header announces 4294967295 facets, and it ends after 2097150 of them"),
    ] {
        // What is not written takes no room on the disk.
        let mut file = std::fs::File::create(&path).unwrap();
        file.write_all(&[b' '; 80]).unwrap();
        file.write_all(&count.to_le_bytes()).unwrap();
        file.set_len(100 << 20).unwrap();
        let error = Facets::from_file(&path, &plain).unwrap_err().to_string();
        assert!(error.contains(said), "{error}");
    }
    let bits = PLY.replace("ascii", "binary_little_endian");
    for (text, said) in [
        (
            PLY.replace("vertex 8", "vertex 5000000"),
            "the header announces 5000000 elements `vertex`, more than the file can hold",
        ),
        (
            bits.replace("face 6", "face 5000000"),
            "the header announces 5000000 elements `face`, more than the file can hold",
        ),
        (PLY.replace("element face", "element edge 3\nelement face"), "`edge` has no properties"),
    ] {
        let error = read("a.ply", text.as_bytes()).unwrap_err().to_string();
        assert!(error.contains(said), "{error}");
    }
}

proptest! {
    /// Bytes changed, cut out and put into files of all kinds.
    #[test]
    fn no_bytes_cause_a_panic(
        kind in 0usize..5,
        changes in proptest::collection::vec((any::<u16>(), any::<u8>(), 0u8..4), 0..6),
    ) {
        let triangles = cuboid([1.0; 3]);
        let (name, mut bytes) = match kind {
            0 => ("a.stl", binary(&[b'-'; 80], &triangles)),
            1 => ("a.stl", text(&triangles).into_bytes()),
            2 => ("a.obj", OBJ.as_bytes().to_vec()),
            3 => ("a.ply", PLY.as_bytes().to_vec()),
            _ => ("a.ply", PLY.replace("ascii", "binary_little_endian").into_bytes()),
        };
        for (place, byte, change) in changes {
            let place = place as usize % bytes.len().max(1);
            match change {
                0 if place < bytes.len() => bytes[place] = byte,
                1 => bytes.insert(place, byte),
                2 => bytes.truncate(place),
                _ => drop(bytes.drain(place..bytes.len().min(place + 3))),
            }
        }
        let _ = read(name, &bytes);
    }
}
