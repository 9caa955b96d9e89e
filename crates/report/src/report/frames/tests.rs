use std::fs;
use std::io::Read;

use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use tempfile::TempDir;

use super::*;
use crate::{Compression, vtp};
use piola_physics::fields::{FieldDescription, FieldValues, Snapshot};

const PRESSURE: FieldDescription = FieldDescription::new("pressure", "Pa", FieldKind::Scalar, "");

/// `instants` files of `count` particles in 2D; particle i stands at (i, -i), and its pressure is
/// i + 1000 times the number of the file.
fn files(folder: &TempDir, instants: usize, count: usize) -> Vec<PathBuf> {
    let paths = (0..instants).map(|instant| {
        let path = folder.path().join(format!("frame_{instant:06}.vtp"));
        let snapshot = Snapshot {
            dimension: 2,
            time: instant as f64,
            step: 0,
            positions: (0..count).flat_map(|i| [i as f64, -(i as f64)]).collect(),
            ids: (0..count as u32).collect(),
            bodies: vec![0; count],
            widths: vec![1.0; count],
            fields: vec![FieldValues {
                description: PRESSURE,
                values: (0..count).map(|i| (i + 1000 * instant) as f64).collect(),
            }],
        };
        vtp::write(&path, &snapshot, Compression::Zlib).unwrap();
        path
    });
    paths.collect()
}

/// The numbers of component `number` of a frame, as the page reads them.
fn numbers(frames: &Frames, frame: usize, number: usize) -> Vec<f32> {
    let packed = STANDARD.decode(&frames.frames[frame].data).unwrap();
    let mut bytes = Vec::new();
    flate2::read::ZlibDecoder::new(&packed[..]).read_to_end(&mut bytes).unwrap();
    let count = frames.ids.len();
    let plane = |plane: usize, i: usize| u32::from(bytes[(3 * number + plane) * count + i]);
    let bits = |i| plane(0, i) << 24 | plane(1, i) << 16 | plane(2, i) << 8;
    (0..count).map(|i| f32::from_bits(bits(i))).collect()
}

const ROOMY: Limits = Limits { bytes: 1 << 20, frames: 100, kept_frames: 3 };

#[test]
fn small_runs_are_shown_whole() {
    let folder = tempfile::tempdir().unwrap();
    let frames = read(&files(&folder, 5, 11), 2, ROOMY);
    assert_eq!((frames.stride, frames.frames.len(), frames.ids.len()), (1, 5, 11));
    assert_eq!(frames.centre, [5.0, -5.0]);
    let times: Vec<f64> = frames.frames.iter().map(|frame| frame.time).collect();
    assert_eq!(times, [0.0, 1.0, 2.0, 3.0, 4.0]);
    let expected: Vec<f32> = (0..11_u8).map(|i| f32::from(i) - 5.0).collect();
    assert_eq!(numbers(&frames, 0, 0), expected);
    let mirrored: Vec<f32> = expected.iter().map(|x| -x).collect();
    assert_eq!(numbers(&frames, 0, 1), mirrored);
    let pressure: Vec<f32> = (0..11_u16).map(|i| f32::from(i + 2000)).collect();
    assert_eq!(numbers(&frames, 2, 2), pressure);
    assert_eq!(frames.fields[0].components, [""]);
    assert!(frames.faults.is_empty());
}

#[test]
fn instants_are_left_out_before_particles() {
    let folder = tempfile::tempdir().unwrap();
    let paths = files(&folder, 20, 100);
    // A frame needs 100 particles of 3 numbers of 3 bytes: 900.
    let at = |bytes| {
        let frames = read(&paths, 2, Limits { bytes, ..ROOMY });
        assert!(frames.frames.len() * frames.ids.len() * 9 <= bytes, "{bytes}");
        (frames.frames.len(), frames.stride)
    };
    assert_eq!(at(18_000), (20, 1));
    assert_eq!(at(9_000), (10, 1));
    assert_eq!(at(2_700), (3, 1));
    assert_eq!(at(1_350), (3, 2));
    assert_eq!(at(27), (3, 100));
    let few = read(&paths, 2, Limits { frames: 7, ..ROOMY });
    assert_eq!((few.frames.len(), few.stride), (7, 1));
}

#[test]
fn the_text_of_a_report_is_bounded() {
    // What zlib cannot shorten grows by 5 bytes in 16 KiB at most, and text by a third.
    let Limits { bytes, frames, .. } = Limits::REPORT;
    let text = (bytes + bytes / 2000 + 100 * frames) * 4 / 3;
    assert!(text < (8 << 20) + (1 << 16));
}

#[test]
fn damaged_and_foreign_files_are_left_out_with_a_sentence() {
    let folder = tempfile::tempdir().unwrap();
    let mut paths = files(&folder, 6, 50);
    let bytes = fs::read(&paths[0]).unwrap();
    fs::write(&paths[0], &bytes[..bytes.len() / 2]).unwrap();
    fs::write(&paths[2], "no particles").unwrap();
    let other = tempfile::tempdir().unwrap();
    fs::copy(&files(&other, 1, 51)[0], &paths[4]).unwrap();
    paths.push(folder.path().join("frame_000099.vtp"));
    let frames = read(&paths, 2, ROOMY);
    let times: Vec<f64> = frames.frames.iter().map(|frame| frame.time).collect();
    assert_eq!(times, [1.0, 3.0, 5.0]);
    assert_eq!(frames.faults.len(), 4, "{:?}", frames.faults);
    let of = |name: &str| frames.faults.iter().find(|fault| fault.contains(name)).unwrap();
    assert!(of("frame_000002").contains("is damaged"));
    assert!(of("frame_000004").contains("particles are not those of the first file"));
    assert!(of("frame_000099").contains("cannot be read"));
    let none = read(&paths[2..3], 2, ROOMY);
    assert_eq!((none.frames.len(), none.faults.len()), (0, 1));
    assert_eq!(read(&[], 2, ROOMY).faults.len(), 0);
}

#[test]
fn chosen_instants_are_even_and_hold_both_ends() {
    for count in 1..60 {
        for wanted in 2..70 {
            let chosen = evenly(count, wanted);
            assert_eq!(chosen.len(), wanted.min(count));
            assert_eq!((chosen[0], *chosen.last().unwrap()), (0, count - 1));
            let steps: Vec<usize> = chosen.windows(2).map(|pair| pair[1] - pair[0]).collect();
            if let (Some(least), Some(most)) = (steps.iter().min(), steps.iter().max()) {
                assert!(*least >= 1 && most - least <= 1, "{chosen:?}");
            }
        }
    }
    assert_eq!(evenly(5, 1), [4]);
    assert!(evenly(0, 3).is_empty() && evenly(3, 0).is_empty());
}
