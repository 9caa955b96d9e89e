//! Meshes that cannot be used, and what is said of them.

use piola::geometry::{CloudSpec, CloudVolumes, from_mesh};

use crate::{CELLS, MIXED, NODES, data, from_bytes, seed};

const SQUARE: &str = "$MeshFormat
2.2 0 8
$EndMeshFormat
$Nodes
5
1 0 0 0
2 1 0 0
3 1 1 0
4 0 1 0
5 0.5 2 0
$EndNodes
$Elements
3
1 2 2 9 1 1 2 3
2 2 2 9 1 1 3 4
3 2 2 9 1 4 3 5
$EndElements
";

#[test]
fn faults_are_named_with_their_line() {
    let square = |from: &str, to: &str| SQUARE.replacen(from, to, 1);
    for (text, parts) in [
        (String::new(), &["is not a mesh"][..]),
        ("solid cube\nfacet".into(), &["is not a mesh"]),
        (square("2.2 0 8", "4 0 8"), &["line 2", "version 4 of Gmsh's format", "4.1 or 2.2"]),
        (square("2.2 0 8", "2.2 1 8"), &["line 2", "binary", "Mesh.Binary = 0"]),
        (square("3 1 1 0", "3 1 x 0"), &["line 8: got `x`, expected a coordinate"]),
        (square("3 1 1 0", "3 1 nan 0"), &["line 8", "got `nan`"]),
        (square("4 0 1 0", "3 0 1 0"), &["line 9", "node 3 appears twice"]),
        (square("2 2 2 9 1 1 3 4", "2 2 2 9 1 1 3 7"), &["line 15", "cell 2 refers to node 7"]),
        (square("2 2 2 9 1 1 3 4", "1 2 2 9 1 1 3 4"), &["line 15", "element 1 appears twice"]),
        (square("1 2 2 9", "1 9 2 9"), &["line 14", "higher order", "Mesh.ElementOrder"]),
        (square("1 2 2 9", "1 99 2 9"), &["line 14", "type 99 are not supported"]),
        (square("$EndElements\n", ""), &["the file ends, expected $EndElements"]),
        (square("\n5\n", "\n4\n"), &["line 10", "got `5`, expected $EndNodes"]),
        (square("$Nodes", "$Notes"), &["the file ends, expected the end of a section"]),
        (square("2 2 2 9 1 1 3 4", "2 2 2 9 1 4 3 1"), &["line 15", "cell 2", "is inverted"]),
        (square("3 1 1 0", "3 0.5 0 0"), &["line 14", "cell 1", "is flat"]),
        (square("3 2 2 9 1 4 3 5", "3 2 2 9 1 1 3 5"), &["cell 3", "two other cells"]),
        (square("3 1 1 0", "3 1 1 0.1"), &["cell 1", "lies at z = 0.1 m", "in a plane"]),
        (MIXED.replace("ASCII", "BINARY"), &["line 3", "binary", ".vtu"]),
        (MIXED.replace("UNSTRUCTURED_GRID", "POLYDATA"), &["line 4", "got `POLYDATA`"]),
        (MIXED.replace("12 13 14", "12 13 24"), &["line 12", "higher order"]),
        (MIXED.replace("12 13 14", "12 13 10"), &["line 12", "has 5 entries, expected 4"]),
        ("<VTKFile type=\"PolyData\"/>".into(), &["a VTK file of PolyData"]),
        ("<VTKFile\n type=PolyData/>".into(), &["line 2", "its XML"]),
    ] {
        let error = from_bytes::<2>(text.as_bytes(), &NODES).unwrap_err().to_string();
        for part in parts {
            assert!(error.contains(part), "`{error}` should say `{part}`");
        }
    }
}

#[test]
fn meshes_of_other_dimensions_are_refused() {
    let error = from_mesh::<3>(&data("triangles-41.msh"), &NODES).unwrap_err().to_string();
    assert!(error.contains("cells of dimension 1 and cells of dimension 2 only"), "{error}");
    let error = from_mesh::<2>(&data("tets-41.msh"), &NODES).unwrap_err().to_string();
    assert!(error.contains("has cells of dimension 3; a case of dimension 2"), "{error}");
    let error = from_mesh::<2>(&data("nothing.msh"), &NODES).unwrap_err().to_string();
    assert!(error.contains("nothing.msh: cannot be read"), "{error}");
    let error = from_mesh::<2>(&data(""), &NODES).unwrap_err().to_string();
    assert!(error.contains("is not a file"), "{error}");
}

/// An array of no components has no words to run out of.
#[test]
fn an_endless_array_ends() {
    let text =
        format!("{MIXED}POINT_DATA 11\nFIELD data 1\nnothing 0 18446744073709551615 double\n");
    assert!(from_bytes::<3>(text.as_bytes(), &NODES).is_ok());
}

#[test]
fn a_folded_cell_is_refused() {
    // The fourth corner lies behind the diagonal of the others.
    let folded = "# vtk DataFile Version 3.0\nfolded\nASCII\nDATASET UNSTRUCTURED_GRID\n\
                  POINTS 4 double\n0 0 0 1 0 0 0.1 0.1 0 0 1 0\nCELLS 1 5\n4 0 1 2 3\n\
                  CELL_TYPES 1\n9\n";
    let error = from_bytes::<2>(folded.as_bytes(), &NODES).unwrap_err().to_string();
    assert!(error.contains("is folded"), "{error}");
}

#[test]
fn sets_and_arrays_that_are_not_there_are_named() {
    let error =
        |spec: &CloudSpec| from_mesh::<2>(&seed("plane.vtu"), spec).unwrap_err().to_string();
    let part = |name: &str| CloudSpec { part: Some(name.into()), ..CELLS };
    assert!(error(&part("steel")).contains("has no set `steel`; it has `part:1`"));
    let array = |name: &str, spec: CloudSpec| CloudSpec {
        volumes: CloudVolumes::Array(name.into()),
        ..spec
    };
    let message = error(&array("mass", NODES));
    assert!(message.contains("no array `mass` of nodes; it has `volume`"), "{message}");
    let message = error(&array("part", CELLS));
    assert!(message.contains("sum to 4 m^D, but the cells to 2"), "{message}");
    let text = std::fs::read_to_string(seed("plane42.vtk")).unwrap();
    let negative = text.replacen("0.5 0.5 1.0", "-0.5 1.5 1.0", 1);
    let spec = array("volume", CELLS);
    let message = from_bytes::<2>(negative.as_bytes(), &spec).unwrap_err().to_string();
    assert!(message.contains("has -0.5 for cell 0"), "{message}");
}
