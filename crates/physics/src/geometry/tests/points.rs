//! Files of points.

use std::io::Write;
use std::path::Path;

use crate::Vector;
use crate::geometry::{GeometryError, Particles, PointCloud, PointsFault, from_points};
use proptest::prelude::*;

fn read<const D: usize>(bytes: &[u8]) -> Result<Particles<D>, GeometryError> {
    let mut file = tempfile::NamedTempFile::new().unwrap();
    file.write_all(bytes).unwrap();
    from_points(file.path())
}

#[test]
fn points_become_particles() {
    let text = "\u{feff}X, y,volume\r\n0,0,4\r\n\r\n1e0, -2.5 ,\"0.25\"\r\n";
    let particles = read::<2>(text.as_bytes()).unwrap();
    assert_eq!(particles.position, [Vector::<2>::zeros(), Vector::<2>::new(1.0, -2.5)]);
    assert_eq!(particles.volume, [4.0, 0.25]);
    assert_eq!(particles.weight, [4.0, 0.25]);
    assert_eq!(particles.spacing, [2.0, 0.5]);
    assert_eq!((particles.id, particles.body), (vec![0, 1], vec![0, 0]));
    assert_eq!(read::<1>(b"x,volume\n1,3").unwrap().spacing, [3.0]);
    assert_eq!(read::<3>(b"x,y,z,volume\n1,1,1,8").unwrap().spacing, [2.0]);
}

#[test]
fn faults_are_named_with_line_and_column() {
    let faults: [(&[u8], &str); 20] = [
        (b"", ": holds no points"),
        (b"\n\n", ": holds no points"),
        (b"x,y,volume\n", ": holds no points"),
        (
            b"x,y,z,volume\n0,0,0,1\n",
            ", line 1: the header is `x,y,z,volume`, expected `x,y,volume`",
        ),
        (b"0,0,1\n1,0,1\n", ", line 1: the header is `0,0,1`"),
        (b"x;y;volume\n0;0;1\n", ", line 1: the header is `x;y;volume`"),
        (b"x,y,volume\n0,0,1\n1,0\n", ", line 3: 2 fields, expected 3"),
        (b"x,y,volume\n\n\n0,0,1,5\n", ", line 4: 4 fields, expected 3"),
        (b"x,y,volume\n0,one,1\n", ", line 2, column y: `one` is not a number"),
        (b"x,y,volume\n0,,1\n", ", line 2, column y: `` is not a number"),
        (b"x,y,volume\n0,1 m,1\n", ", line 2, column y: `1 m` is not a number"),
        (b"x,y,volume\n0,0,1\n\n\n1,nan,1\n", ", line 5, column y: NaN is not finite"),
        (b"x,y,volume\n-inf,0,1\n", ", line 2, column x: -inf is not finite"),
        (b"x,y,volume\n1e999,0,1\n", ", line 2, column x: inf is not finite"),
        (b"x,y,volume\n0,0,0\n", ", line 2, column volume: a volume of 0"),
        (b"x,y,volume\r\n0,0,-1\r\n", ", line 2, column volume: a volume of -1"),
        (b"x,y,volume\n0,0,1\n1,0,1\n-0,0,1\n", ", line 4: the point (0, 0) is already on line 2"),
        (b"x,y,volume\n0,\xff,1\n", ", line 2, column y: bytes that are not UTF-8"),
        (b"\xff\xfe\x00", ", line 1: the header is"),
        (b"x,y,volume\n0,0,\"1\n2,2,2\n", ", line 2, column volume: `1"),
    ];
    for (bytes, message) in faults {
        let error = read::<2>(bytes).expect_err(message).to_string();
        assert!(error.contains(message), "{error}\nexpected {message}");
    }
}

#[test]
fn files_that_cannot_be_read_are_named() {
    let folder = tempfile::tempdir().unwrap();
    let fault = |path: &Path| match from_points::<2>(path).unwrap_err() {
        GeometryError::Points(error) => {
            assert!(error.to_string().starts_with(&path.display().to_string()), "{error}");
            error.fault
        }
        other => panic!("{other}"),
    };
    assert!(matches!(fault(folder.path()), PointsFault::NotAFile));
    assert!(matches!(fault(&folder.path().join("none.csv")), PointsFault::Unreadable(_)));
    let large = folder.path().join("large.csv");
    // A file with a hole takes no room on the disk.
    std::fs::File::create(&large).unwrap().set_len((1 << 31) + 1).unwrap();
    assert!(matches!(fault(&large), PointsFault::TooLarge));
}

proptest! {
    #[test]
    fn no_bytes_cause_a_panic(bytes in prop::collection::vec(any::<u8>(), 0..300)) {
        let _ = read::<1>(&bytes);
        let _ = read::<3>(&[b"x,y,z,volume\n", bytes.as_slice()].concat());
    }

    #[test]
    fn no_text_causes_a_panic(text in "x,volume\n[-0-9.e, \"\n\r]{0,100}") {
        if let Ok(particles) = read::<1>(text.as_bytes()) {
            prop_assert!(particles.volume.iter().all(|volume| *volume > 0.0));
        }
    }

    #[test]
    fn what_is_written_is_read(points in prop::collection::hash_map(
        any::<(u32, u32)>(), 1e-9..1e9f64, 1..50,
    )) {
        let rows: Vec<_> = points.iter().map(|((x, y), v)| (f64::from(*x) / 7.0, f64::from(*y), *v)).collect();
        let lines: String = rows.iter().map(|(x, y, v)| format!("{x},{y:e},{v}\n")).collect();
        let particles = read::<2>(format!("x,y,volume\n{lines}").as_bytes()).unwrap();
        for (a, (x, y, v)) in rows.into_iter().enumerate() {
            prop_assert_eq!(particles.position[a], Vector::<2>::new(x, y));
            prop_assert_eq!(particles.volume[a], v);
        }
    }
}

/// Numbers of a program become the particles that a file of them does.
#[test]
fn clouds_are_what_files_are() {
    let numbers = [[0.0, 0.0, 4.0], [1.0, -2.5, 0.25], [0.1, 1e-3, 1.0 / 3.0]];
    let lines = numbers.map(|[x, y, volume]| format!("{x:?},{y:?},{volume:?}\n"));
    let file = read::<2>(format!("x,y,volume\n{}", lines.concat()).as_bytes()).unwrap();
    let positions = numbers.iter().flat_map(|[x, y, _]| [*x, *y]).collect();
    let volumes = numbers.iter().map(|[.., volume]| *volume).collect();
    let cloud = PointCloud::new(2, positions, volumes).unwrap();
    let given = cloud.particles::<2>().unwrap();
    assert_eq!((given.position, given.volume), (file.position, file.volume));
    assert_eq!((given.weight, given.spacing), (file.weight, file.spacing));
    assert_eq!((given.id, given.body), (file.id, file.body));
    assert!(cloud.particles::<1>().is_none() && cloud.particles::<3>().is_none());
}

#[test]
fn faults_of_clouds_are_named_with_their_particle() {
    let refused = |dimension, positions: &[f64], volumes: &[f64]| {
        PointCloud::new(dimension, positions.to_vec(), volumes.to_vec()).unwrap_err().to_string()
    };
    let found = [
        refused(2, &[0.0, 0.0, 1.0, f64::NAN], &[1.0, 1.0]),
        refused(1, &[0.0, f64::NEG_INFINITY], &[1.0, 1.0]),
        refused(1, &[0.0, 1.0], &[1.0, f64::NAN]),
        refused(1, &[0.0, 1.0], &[1.0, -0.0]),
        refused(1, &[0.0, 2.0, -0.0], &[1.0; 3]),
        refused(3, &[0.0; 4], &[1.0]),
        refused(4, &[0.0; 4], &[1.0]),
        refused(2, &[], &[]),
    ];
    let expected = [
        "particle 1: y is NaN, expected a finite number of m",
        "particle 1: x is -inf, expected a finite number of m",
        "particle 1: the volume is NaN, expected a finite number above 0",
        "particle 1: the volume is -0, expected a finite number above 0",
        "particles 0 and 2 are both at (0), expected each place once",
        "4 coordinates in 3D and 1 volumes, expected 3 for each volume",
        "particles have 4 coordinates, expected 1 to 3",
        "a cloud needs at least one particle",
    ];
    assert_eq!(found, expected);
}
