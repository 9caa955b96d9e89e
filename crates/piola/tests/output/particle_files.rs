//! Particle files and their time series, decoded from the description of the format: the XML by
//! roxmltree, the appended data by hand.

use std::collections::HashMap;
use std::io::Read;
use std::path::Path;

use piola::fields::{FieldDescription, FieldKind, FieldValues, Snapshot};
use piola::output::{Compression, OutputError, pvd, vtp};
use proptest::prelude::*;

const fn description(name: &'static str, unit: &'static str, kind: FieldKind) -> FieldDescription {
    FieldDescription::new(name, unit, kind, "")
}

const PRESSURE: FieldDescription = description("pressure", "Pa", FieldKind::Scalar);
const VELOCITY: FieldDescription = description("velocity", "m/s", FieldKind::Vector);
/// A name and a unit with what XML must not hold as it is.
const STRETCH: FieldDescription = description("F<\"&\">", "1", FieldKind::Tensor);
const STRESS: FieldDescription = description("stress", "Pa", FieldKind::Symmetric);

/// A snapshot whose numbers all differ, with the special ones among them.
fn snapshot(dimension: usize, count: usize, seed: u64) -> Snapshot {
    let special = [f64::NAN, f64::INFINITY, -0.0, 5e-324, f64::MAX, -1.0 / 3.0];
    let numbers = |components: usize, salt: u64| -> Vec<f64> {
        (0..count * components)
            .map(|i| match (i as u64 + seed + salt) % 97 {
                at @ 0..6 => special[at as usize],
                _ => ((i as u64 * 7 + seed * 13 + salt) as f64).sin() * 1e3,
            })
            .collect()
    };
    let fields = [PRESSURE, VELOCITY, STRETCH, STRESS].into_iter().zip(1..);
    Snapshot {
        dimension,
        time: 0.1 + seed as f64,
        step: seed,
        positions: numbers(dimension, 0),
        ids: (0..count as u32).rev().collect(),
        bodies: (0..count as u32).map(|i| i % 3).collect(),
        widths: vec![1.0; count],
        fields: fields
            .map(|(description, salt)| FieldValues {
                description,
                values: numbers(description.kind.components(dimension), salt),
            })
            .collect(),
    }
}

/// One array of a file.
#[derive(Debug)]
struct Array {
    kind: String,
    components: usize,
    unit: Option<String>,
    bytes: Vec<u8>,
}

impl Array {
    fn floats(&self) -> Vec<u64> {
        assert_eq!(self.kind, "Float64");
        assert_eq!(self.bytes.len() % (8 * self.components), 0);
        self.bytes.chunks(8).map(|bytes| u64::from_le_bytes(bytes.try_into().unwrap())).collect()
    }

    fn integers(&self) -> Vec<u32> {
        assert_eq!((self.kind.as_str(), self.components), ("UInt32", 1));
        self.bytes.chunks(4).map(|bytes| u32::from_le_bytes(bytes.try_into().unwrap())).collect()
    }
}

/// Number of points and vertices, and the arrays by the element they stand in and their name.
struct Decoded {
    points: usize,
    verts: usize,
    arrays: HashMap<(String, String), Array>,
}

fn find(bytes: &[u8], what: &[u8]) -> usize {
    bytes.windows(what.len()).position(|window| window == what).expect("the file has this part")
}

fn word(bytes: &[u8], index: usize) -> usize {
    u64::from_le_bytes(bytes[8 * index..8 * index + 8].try_into().unwrap()) as usize
}

/// The data at the start of `bytes` and the number of bytes that they take in the file.
fn unpack(bytes: &[u8], compressed: bool) -> (Vec<u8>, usize) {
    if !compressed {
        let end = 8 + word(bytes, 0);
        return (bytes[8..end].to_vec(), end);
    }
    let (blocks, full, last) = (word(bytes, 0), word(bytes, 1), word(bytes, 2));
    let mut data = Vec::new();
    let mut start = 8 * (3 + blocks);
    for block in 0..blocks {
        let end = start + word(bytes, 3 + block);
        let before = data.len();
        flate2::read::ZlibDecoder::new(&bytes[start..end]).read_to_end(&mut data).unwrap();
        let expected = if block + 1 == blocks && last > 0 { last } else { full };
        assert_eq!(data.len() - before, expected, "block {block} of {blocks}");
        start = end;
    }
    (data, start)
}

fn decode(path: &Path) -> Decoded {
    let bytes = std::fs::read(path).unwrap();
    let marker = b"<AppendedData encoding=\"raw\">\n   _";
    let split = find(&bytes, marker) + marker.len();
    let xml = String::from_utf8(bytes[..split].to_vec()).unwrap() + "</AppendedData></VTKFile>";
    let document = roxmltree::Document::parse(&xml).unwrap();
    let root = document.root_element();
    assert_eq!(root.attribute("type"), Some("PolyData"));
    assert_eq!(root.attribute("byte_order"), Some("LittleEndian"));
    assert_eq!(root.attribute("header_type"), Some("UInt64"));
    let compressed = match root.attribute("compressor") {
        None => false,
        Some(compressor) => compressor == "vtkZLibDataCompressor",
    };
    let data = &bytes[split..];
    let mut arrays = HashMap::new();
    let mut end = 0;
    for element in document.descendants().filter(|node| node.has_tag_name("DataArray")) {
        let offset: usize = element.attribute("offset").unwrap().parse().unwrap();
        assert_eq!(offset, end, "arrays follow each other without a gap");
        let (bytes, length) = unpack(&data[offset..], compressed);
        end = offset + length;
        let unit = element.children().find(|node| node.attribute("name") == Some("UNITS_LABEL"));
        let components = element.attribute("NumberOfComponents").unwrap_or("1");
        let array = Array {
            kind: element.attribute("type").unwrap().into(),
            components: components.parse().unwrap(),
            unit: unit.and_then(|node| node.text()).map(str::to_owned),
            bytes,
        };
        let place = element.parent().unwrap().tag_name().name().to_owned();
        arrays.insert((place, element.attribute("Name").unwrap().to_owned()), array);
    }
    assert_eq!(&data[end..], b"\n  </AppendedData>\n</VTKFile>\n");
    let piece = document.descendants().find(|node| node.has_tag_name("Piece")).unwrap();
    let number = |name: &str| piece.attribute(name).unwrap().parse().unwrap();
    Decoded { points: number("NumberOfPoints"), verts: number("NumberOfVerts"), arrays }
}

/// Values in three dimensions, by index arithmetic on components.
fn padded(values: &[f64], dimension: usize, rank: u32) -> Vec<u64> {
    let components = dimension.pow(rank);
    let mut padded = Vec::new();
    for particle in 0..values.len().checked_div(components).unwrap_or(0) {
        for at in 0..3_usize.pow(rank) {
            let (row, column) = (at / 3, at % 3);
            let inside = column < dimension && row < dimension;
            let from = particle * components + row * dimension + column;
            padded.push(if inside { values[from].to_bits() } else { 0 });
        }
    }
    padded
}

fn check(snapshot: &Snapshot, compression: Compression) {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("particles.vtp");
    let length = vtp::write(&path, snapshot, compression).unwrap();
    assert_eq!(std::fs::metadata(&path).unwrap().len(), length);
    let Decoded { points, verts, arrays } = decode(&path);
    let count = snapshot.len();
    assert_eq!((points, verts), (count, count));
    let array = |place: &str, name: &str| &arrays[&(place.to_owned(), name.to_owned())];
    let numbers: Vec<u32> = (0..count as u32).collect();
    assert_eq!(array("Verts", "connectivity").integers(), numbers);
    assert_eq!(array("Verts", "offsets").integers(), (1..=count as u32).collect::<Vec<_>>());
    assert_eq!(array("PointData", "id").integers(), snapshot.ids);
    assert_eq!(array("PointData", "body").integers(), snapshot.bodies);
    assert_eq!(array("FieldData", "TimeValue").floats(), [snapshot.time.to_bits()]);
    assert_eq!(array("FieldData", "step").bytes, snapshot.step.to_le_bytes());
    let dimension = snapshot.dimension;
    let positions = array("Points", "Points");
    assert_eq!((positions.components, positions.unit.as_deref()), (3, Some("m")));
    assert_eq!(positions.floats(), padded(&snapshot.positions, dimension, 1));
    for field in &snapshot.fields {
        let got = array("PointData", field.description.name);
        assert_eq!(got.unit.as_deref(), Some(field.description.unit));
        let expected = match field.description.kind {
            FieldKind::Scalar | FieldKind::Symmetric => {
                field.values.iter().map(|value| value.to_bits()).collect()
            }
            FieldKind::Vector => padded(&field.values, dimension, 1),
            FieldKind::Tensor => padded(&field.values, dimension, 2),
        };
        assert_eq!(got.floats(), expected, "{}", field.description.name);
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(24))]
    #[test]
    fn every_value_reads_back_to_the_bit(
        dimension in 1_usize..=3,
        count in 0_usize..400,
        seed in 0_u64..1000,
        zlib in any::<bool>(),
    ) {
        let compression = if zlib { Compression::Zlib } else { Compression::None };
        check(&snapshot(dimension, count, seed), compression);
    }
}

/// 5461 particles and one more lie on both sides of a full block of 131 072 bytes of points, and
/// 30 000 take several blocks.
#[test]
fn data_of_many_blocks_read_back() {
    for count in [5461, 5462, 16_384, 30_000] {
        check(&snapshot(2, count, 1), Compression::Zlib);
    }
}

#[test]
fn nothing_depends_on_the_number_of_threads() {
    let folder = tempfile::tempdir().unwrap();
    let snapshot = snapshot(3, 20_000, 5);
    let write = |threads: usize| {
        let path = folder.path().join(format!("{threads}.vtp"));
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        pool.install(|| vtp::write(&path, &snapshot, Compression::Zlib)).unwrap();
        std::fs::read(path).unwrap()
    };
    assert!(write(1) == write(4), "the files differ");
}

#[test]
fn contradicting_lengths_are_refused_and_leave_nothing() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("particles.vtp");
    let good = snapshot(2, 4, 1);
    let mut bad = vec![good.clone(); 5];
    bad[0].positions.pop();
    bad[1].bodies.push(1);
    bad[2].fields[1].values.pop();
    bad[3].dimension = 0;
    bad[4].dimension = 4;
    for (number, snapshot) in bad.iter().enumerate() {
        let error = vtp::write(&path, snapshot, Compression::None).unwrap_err();
        match number {
            0..3 => assert!(matches!(error, OutputError::WrongLength { .. }), "{error}"),
            _ => assert!(matches!(error, OutputError::WrongDimension { .. }), "{error}"),
        }
    }
    let error = vtp::write(&path, &bad[2], Compression::None).unwrap_err().to_string();
    assert!(error.contains("the field velocity has 7 values where 8 are expected"), "{error}");
    assert_eq!(std::fs::read_dir(folder.path()).unwrap().count(), 0);
}

#[test]
fn a_series_lists_its_frames_in_order() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("particles.pvd");
    let frames: Vec<pvd::Frame> = [0.0, 0.1 + 0.2, 1e-7, 1e22]
        .into_iter()
        .enumerate()
        .map(|(frame, time)| pvd::Frame { time, file: format!("particles/a&b_{frame}.vtp") })
        .collect();
    for count in 0..=frames.len() {
        pvd::write(&path, &frames[..count]).unwrap();
        let text = std::fs::read_to_string(&path).unwrap();
        let document = roxmltree::Document::parse(&text).unwrap();
        assert_eq!(document.root_element().attribute("type"), Some("Collection"));
        let read: Vec<pvd::Frame> = document
            .descendants()
            .filter(|node| node.has_tag_name("DataSet"))
            .map(|node| pvd::Frame {
                time: node.attribute("timestep").unwrap().parse().unwrap(),
                file: node.attribute("file").unwrap().to_owned(),
            })
            .collect();
        assert_eq!(read, frames[..count]);
    }
}
