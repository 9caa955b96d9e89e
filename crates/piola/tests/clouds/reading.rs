//! The same mesh in all formats.

use piola::geometry::{CloudPoints, CloudSpec, CloudVolumes, Mesh, Particles, from_mesh};

use crate::{CELLS, MIXED, NODES, data, from_bytes, seed};

fn same(a: &Particles<3>, b: &Particles<3>) {
    assert_eq!(a.len(), b.len());
    for (x, y) in a.position.iter().zip(&b.position) {
        assert!((x - y).amax() < 1e-12);
    }
    for (v, w) in a.volume.iter().zip(&b.volume) {
        assert!((v / w - 1.0).abs() < 1e-12);
    }
}

#[test]
fn formats_agree() {
    let whole = from_mesh::<3>(&data("tets-41.msh"), &CELLS).unwrap();
    for name in ["tets.vtu", "tets42.vtk", "tets51.vtk"] {
        same(&whole, &from_mesh(&data(name), &CELLS).unwrap());
        let nodes = from_mesh::<3>(&data(name), &NODES).unwrap();
        same(&from_mesh(&data("tets-41.msh"), &NODES).unwrap(), &nodes);
    }
    let (old, new) = (
        from_mesh::<2>(&data("triangles-22.msh"), &NODES).unwrap(),
        from_mesh::<2>(&data("triangles-41.msh"), &NODES).unwrap(),
    );
    assert_eq!(old, new);
}

#[test]
fn physical_groups_become_sets() {
    let particles = from_mesh::<2>(&data("triangles-41.msh"), &NODES).unwrap();
    let names: Vec<&str> = particles.surface.sets.keys().map(String::as_str).collect();
    assert_eq!(names, ["block", "left", "lower", "right"]);
    let left = &particles.surface.sets["left"];
    assert!(left.particles.iter().all(|&a| particles.position[a as usize][0].abs() < 1e-12));
    let length: f64 =
        left.faces.iter().map(|&face| particles.surface.faces[face as usize].area.norm()).sum();
    assert!((length - 1.0).abs() < 1e-12, "{length}");
    assert_eq!(left.particles.len(), left.faces.len() + 1);
    assert_eq!(particles.surface.sets["block"].particles.len(), particles.len());

    let cells = from_mesh::<2>(&data("triangles-41.msh"), &CELLS).unwrap();
    let left = &cells.surface.sets["left"];
    let behind: Vec<u32> =
        left.faces.iter().map(|&face| cells.surface.faces[face as usize].particles[0]).collect();
    assert!(behind.iter().all(|a| left.particles.contains(a)));
    let named = from_mesh::<2>(&seed("plane-41.msh"), &NODES).unwrap();
    assert!(named.surface.sets.contains_key("lower side"));
}

/// Supports in spacings are those of the file then.
#[test]
fn spacings_are_read() {
    let spec = CloudSpec { spacings: Some("volume".into()), ..NODES };
    let particles = from_mesh::<2>(&seed("plane.vtu"), &spec).unwrap();
    let expected = [1.0 / 3.0, 0.5, 0.25, 1.0 / 6.0, 0.5, 0.25];
    for (spacing, expected) in particles.spacing.iter().zip(expected) {
        assert!((spacing - expected).abs() < 1e-12);
    }
}

#[test]
fn integer_arrays_become_sets_and_numbers_volumes() {
    for name in ["plane.vtu", "packed.vtu", "raw.vtu", "plane42.vtk", "plane51.vtk"] {
        let volumes = CloudVolumes::Array("volume".into());
        for (points, count) in [(CloudPoints::Nodes, 6), (CloudPoints::Cells, 3)] {
            let spec = CloudSpec { points, volumes: volumes.clone(), ..NODES };
            let particles = from_mesh::<2>(&seed(name), &spec).unwrap();
            assert_eq!(particles.len(), count, "{name}");
            let expected = if count == 6 { 1.0 / 3.0 } else { 0.5 };
            assert!((particles.volume[0] - expected).abs() < 1e-12);
        }
        let part = Some("part:2".to_owned());
        let spec = CloudSpec { part, ..CELLS };
        let particles = from_mesh::<2>(&seed(name), &spec).unwrap();
        assert_eq!(particles.volume, [1.0], "{name}");
        assert_eq!(particles.surface.faces.len(), 4);
        let all = from_mesh::<2>(&seed(name), &CELLS).unwrap();
        assert_eq!(all.surface.sets["part:1"].particles, [0, 1]);
        assert_eq!(all.surface.sets["part:3"].faces.len(), 1);
    }
}

/// Data behind the description, raw and in letters.
#[test]
fn appended_data_are_read() {
    let array = |numbers: &[f64]| {
        let bytes: Vec<u8> = numbers.iter().flat_map(|x| x.to_le_bytes()).collect();
        [&(bytes.len() as u32).to_le_bytes()[..], &bytes].concat()
    };
    let arrays = [
        array(&[0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0, 0.0]),
        array(&[0.0, 1.0, 2.0]),
        array(&[3.0]),
        array(&[5.0]),
    ];
    let letters = arrays.clone().map(|array| base64(&array));
    for (encoding, arrays) in [("raw", arrays), ("base64", letters.map(String::into_bytes))] {
        let mut offset = 0;
        let mut tags = Vec::new();
        for (name, array) in ["Points", "connectivity", "offsets", "types"].iter().zip(&arrays) {
            let components = if *name == "Points" { 3 } else { 1 };
            tags.push(format!(
                "<DataArray type=\"Float64\" Name=\"{name}\" NumberOfComponents=\"{components}\" \
                 format=\"appended\" offset=\"{offset}\"/>"
            ));
            offset += array.len();
        }
        let head = format!(
            "<VTKFile type=\"UnstructuredGrid\" byte_order=\"LittleEndian\"><UnstructuredGrid>\
             <Piece><Points>{}</Points><Cells>{}</Cells></Piece></UnstructuredGrid>\
             <AppendedData encoding=\"{encoding}\">\n_",
            tags[0],
            tags[1..].concat()
        );
        let tail = b"</AppendedData></VTKFile>";
        let file = [head.as_bytes(), &arrays.concat(), tail].concat();
        let particles = from_bytes::<2>(&file, &CELLS).unwrap();
        assert_eq!(particles.volume, [0.5], "{encoding}");
    }
}

fn base64(bytes: &[u8]) -> String {
    const LETTERS: &[u8; 64] = b"ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    let mut text = String::new();
    for group in bytes.chunks(3) {
        let word = (0..3).fold(0u32, |word, k| word << 8 | u32::from(*group.get(k).unwrap_or(&0)));
        for k in 0..4 {
            let letter = LETTERS[(word >> (18 - 6 * k) & 63) as usize] as char;
            text.push(if k > group.len() { '=' } else { letter });
        }
    }
    text
}

/// VTK and Gmsh turn wedges differently: only cells of one kind must agree.
#[test]
fn kinds_may_turn_differently() {
    let turned = MIXED.replace("6 1 8 2 5 9 6", "6 5 9 6 1 8 2");
    let (a, b) = (
        from_bytes::<3>(MIXED.as_bytes(), &CELLS).unwrap(),
        from_bytes::<3>(turned.as_bytes(), &CELLS).unwrap(),
    );
    assert_eq!(a.volume, b.volume);
    let total = |particles: &Particles<3>| -> f64 {
        particles.surface.faces.iter().map(|face| face.area.dot(&face.place)).sum()
    };
    assert!((total(&a) - total(&b)).abs() < 1e-14);
}

#[test]
fn lines_are_meshes_of_one_dimension() {
    let line = "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n3\n1 0 0 0\n2 0.5 0 0\n3 2 0 0\n\
                $EndNodes\n$Elements\n3\n1 15 2 7 1 1\n2 1 2 8 1 1 2\n3 1 2 8 1 2 3\n$EndElements\n";
    let particles = from_bytes::<1>(line.as_bytes(), &NODES).unwrap();
    assert_eq!(particles.volume, [0.25, 1.0, 0.75]);
    assert_eq!(particles.weight, [0.5, 1.0, 1.5]);
    let areas = particles.surface.areas(3);
    assert_eq!([areas[0][0], areas[1][0], areas[2][0]], [-1.0, 0.0, 1.0]);
    assert_eq!(particles.surface.sets["7"].faces, [0]);
    let mesh = Mesh::read(&seed("plane-22.msh")).unwrap();
    assert_eq!((mesh.nodes.len(), mesh.cells.len()), (5, 5));
}
