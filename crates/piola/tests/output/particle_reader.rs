//! Particle files read back: what was written comes again, and what is damaged is refused.

use std::fs;
use std::path::Path;

use piola::fields::{FieldDescription, FieldKind, FieldValues, Snapshot};
use piola::output::vtp_reader::{ParticleFile, ParticleFileError};
use piola::output::{Compression, vtp};
use proptest::prelude::*;

const FIELDS: [FieldDescription; 3] = [
    FieldDescription::new("pressure", "Pa", FieldKind::Scalar, ""),
    FieldDescription::new("velocity", "m/s", FieldKind::Vector, ""),
    FieldDescription::new("F<\"&\">", "1", FieldKind::Tensor, ""),
];

/// Numbers that all differ.
fn snapshot(dimension: usize, count: usize) -> Snapshot {
    let numbers = |components: usize, salt: f64| -> Vec<f64> {
        (0..count * components).map(|i| (i as f64 + salt) / 7.0).collect()
    };
    let fields = FIELDS.into_iter().zip(1..).map(|(description, salt)| FieldValues {
        description,
        values: numbers(description.kind.components(dimension), f64::from(salt) * 1e6),
    });
    Snapshot {
        dimension,
        time: 0.25,
        step: 3,
        positions: numbers(dimension, 0.0),
        ids: (0..count as u32).rev().collect(),
        bodies: (0..count as u32).map(|i| i % 3).collect(),
        widths: vec![1.0; count],
        fields: fields.collect(),
    }
}

/// Reads everything that a file names.
fn read_all(path: &Path) -> Result<usize, ParticleFileError> {
    let mut file = ParticleFile::open(path)?;
    let arrays: Vec<_> = file.arrays.iter().chain([&file.points]).cloned().collect();
    let lengths = arrays.iter().map(|array| Ok(file.rows(array, 1)?.len()));
    lengths.sum()
}

fn written(folder: &Path, dimension: usize, count: usize, packed: bool) -> std::path::PathBuf {
    let path = folder.join("frame.vtp");
    let packing = if packed { Compression::Zlib } else { Compression::None };
    vtp::write(&path, &snapshot(dimension, count), packing).unwrap();
    path
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(48))]

    #[test]
    fn what_was_written_is_read(
        dimension in 1_usize..=3,
        // Beyond 16384 particles a scalar has two blocks, beyond 1820 a tensor.
        count in prop_oneof![0_usize..6, 1800_usize..1900, Just(16_385)],
        packed in any::<bool>(),
        stride in 1_usize..9,
    ) {
        let folder = tempfile::tempdir().unwrap();
        let path = written(folder.path(), dimension, count, packed);
        let expected = snapshot(dimension, count);
        let mut file = ParticleFile::open(&path).unwrap();
        prop_assert_eq!((file.count, file.time), (count, 0.25));
        let ids = file.array("id").unwrap().clone();
        let kept: Vec<usize> = (0..count).step_by(stride).collect();
        let ids = file.rows(&ids, stride).unwrap();
        prop_assert_eq!(ids, kept.iter().map(|i| f64::from(expected.ids[*i])).collect::<Vec<_>>());
        for field in &expected.fields {
            let array = file.array(field.description.name).unwrap().clone();
            prop_assert_eq!(&array.unit, field.description.unit);
            let rows = file.rows(&array, stride).unwrap();
            prop_assert_eq!(rows.len(), kept.len() * array.components);
            let own = field.description.kind.components(dimension);
            for (row, i) in rows.chunks(array.components).zip(&kept) {
                // What lower dimensions lack is zero: compare the numbers that are not.
                let numbers: Vec<f64> = row.iter().copied().filter(|v| *v != 0.0).collect();
                let values = &field.values[i * own..(i + 1) * own];
                prop_assert_eq!(numbers, values);
            }
        }
    }

    #[test]
    fn a_damaged_file_is_refused_or_read_without_a_panic(
        packed in any::<bool>(),
        cut in 0.0_f64..1.0,
        flips in prop::collection::vec((0.0_f64..1.0, any::<u8>()), 0..6),
    ) {
        let folder = tempfile::tempdir().unwrap();
        let path = written(folder.path(), 2, 300, packed);
        let whole = fs::read(&path).unwrap();
        let mut bytes = whole.clone();
        for (place, value) in &flips {
            let place = (place * bytes.len() as f64) as usize;
            bytes[place] = *value;
        }
        fs::write(&path, &bytes).unwrap();
        let _ = read_all(&path);
        bytes.truncate((cut * bytes.len() as f64) as usize);
        fs::write(&path, &bytes).unwrap();
        // The last array lies at the end, before 30 bytes of closing tags.
        if bytes.len() + 40 < whole.len() && flips.is_empty() {
            // Lines and offsets are not read, so a cut there is not noticed.
            let _ = read_all(&path);
        }
        if bytes.len() < 1000 {
            prop_assert!(read_all(&path).is_err());
        }
    }
}

/// `text` of a sound file replaced by another of any length.
fn changed(path: &Path, from: &str, to: &str) {
    let bytes = fs::read(path).unwrap();
    let at = bytes.windows(from.len()).position(|part| part == from.as_bytes()).unwrap();
    fs::write(path, [&bytes[..at], to.as_bytes(), &bytes[at + from.len()..]].concat()).unwrap();
}

#[test]
fn claims_that_the_file_cannot_keep_are_refused_before_room_is_made() {
    let folder = tempfile::tempdir().unwrap();
    for (from, to, sentence) in [
        ("NumberOfPoints=\"300\"", "NumberOfPoints=\"4294967295\"", "cannot hold the 4294967295"),
        ("NumberOfPoints=\"300\"", "NumberOfPoints=\"301\"", "are expected"),
        ("NumberOfPoints=\"300\"", "NumberOfPoints=\"-1\"", "how many particles"),
        ("NumberOfComponents=\"9\"", "NumberOfComponents=\"800000000000\"", "number of components"),
        ("offset=\"0\"", "offset=\"18446744073709551615\"", "TimeValue"),
        ("type=\"PolyData\"", "type=\"ImageData\"", "not a particle file"),
        ("<AppendedData", "<Appended", "does not end"),
        ("<Points>", "<Point>", "is damaged"),
    ] {
        for packed in [false, true] {
            let path = written(folder.path(), 2, 300, packed);
            changed(&path, from, to);
            let error = read_all(&path).unwrap_err().to_string();
            assert!(error.contains(sentence), "{to}: {error}");
        }
    }
    // A count of blocks that would fill the memory.
    let path = written(folder.path(), 2, 300, true);
    let mut bytes = fs::read(&path).unwrap();
    let start = bytes.windows(2).rposition(|part| part == b" _").unwrap_or(0) + 2;
    let start =
        bytes.windows(8).position(|part| part == b">\n   _\x01\0").map_or(start, |at| at + 6);
    bytes[start..start + 8].copy_from_slice(&u64::MAX.to_le_bytes());
    fs::write(&path, bytes).unwrap();
    let error = read_all(&path).unwrap_err().to_string();
    assert!(error.contains("18446744073709551615 blocks"), "{error}");
}

#[test]
fn entities_cannot_blow_up() {
    let folder = tempfile::tempdir().unwrap();
    let path = written(folder.path(), 2, 3, true);
    let bomb =
        "<?xml version=\"1.0\"?><!DOCTYPE b [<!ENTITY a \"aaaaaaaa\"><!ENTITY b \"&a;&a;&a;\">]>";
    changed(&path, "<?xml version=\"1.0\"?>", bomb);
    assert!(matches!(read_all(&path), Err(ParticleFileError::Damaged { .. })));
    assert!(matches!(read_all(folder.path()), Err(ParticleFileError::Io { .. })));
}
