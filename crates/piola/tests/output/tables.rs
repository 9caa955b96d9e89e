//! Tables written as CSV and read back, and reference curves with their faults.

use std::path::PathBuf;

use piola::output::{Column, Curve, Table, TableError};
use proptest::prelude::*;

/// A file with `content` in a folder of its own, which lives as long as the first part.
fn file(content: impl AsRef<[u8]>) -> (tempfile::TempDir, PathBuf) {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("table.csv");
    std::fs::write(&path, content).unwrap();
    (folder, path)
}

fn read(content: impl AsRef<[u8]>) -> Result<Table, TableError> {
    let (_folder, path) = file(content);
    Table::read_csv(&path)
}

fn read_curve(content: impl AsRef<[u8]>) -> Result<Curve, TableError> {
    let (_folder, path) = file(content);
    Curve::read_csv(&path)
}

#[test]
fn the_file_is_what_a_user_expects() {
    let columns = vec![
        Column::new("time", "s"),
        Column::new("top.displacement.x", "m"),
        Column::new("ratio", ""),
    ];
    let mut table = Table::new(columns);
    table.push_row(&[0.0, -1.5e-7, f64::NAN]).unwrap();
    table.push_row(&[0.1, 1.0 / 3.0, f64::INFINITY]).unwrap();
    assert_eq!(table.push_row(&[1.0]), Err(3));
    let mut text = Vec::new();
    table.write_to(&mut text).unwrap();
    let expected = "time [s],top.displacement.x [m],ratio\n0.0,-1.5e-7,NaN\n\
                    0.1,0.3333333333333333,inf\n";
    assert_eq!(String::from_utf8(text).unwrap(), expected);
    assert_eq!(table.len(), 2);
    assert_eq!(table.values("time").unwrap(), [0.0, 0.1]);
    assert_eq!(table.values("missing"), None);
    assert_eq!(table.column(7).count(), 0);
}

proptest! {
    // Each case writes and reads a file.
    #![proptest_config(ProptestConfig::with_cases(64))]
    #[test]
    fn numbers_read_back_to_the_bit(
        bits in proptest::collection::vec(any::<u64>(), 0..60),
        width in 1_usize..5,
    ) {
        let columns = (0..width).map(|i| Column::new(format!("c{i}, \"quoted\""), "kg m/s^2"));
        let mut table = Table::new(columns.collect());
        let numbers: Vec<f64> = bits.iter().map(|&bits| f64::from_bits(bits)).collect();
        for row in numbers.chunks_exact(width) {
            table.push_row(row).unwrap();
        }
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("table.csv");
        let length = table.write_csv(&path).unwrap();
        prop_assert_eq!(std::fs::metadata(&path).unwrap().len(), length);
        let read = Table::read_csv(&path).unwrap();
        prop_assert_eq!(read.columns(), table.columns());
        prop_assert_eq!(read.len(), table.len());
        for (got, expected) in read.rows().flatten().zip(table.rows().flatten()) {
            let same = got.to_bits() == expected.to_bits() || got.is_nan() && expected.is_nan();
            prop_assert!(same, "{} for {}", got, expected);
        }
    }

    #[test]
    fn no_bytes_make_it_panic(bytes in proptest::collection::vec(any::<u8>(), 0..300)) {
        let _ = read(&bytes);
        let _ = read_curve(&bytes);
    }

    #[test]
    fn no_text_near_csv_makes_it_panic(text in "[0-9.,;eE\"#\r\n\t na+-]{0,80}") {
        let _ = read(&text);
        let _ = read_curve(&text);
    }
}

#[test]
fn the_header_is_optional_and_comments_are_skipped() {
    let text =
        "\u{feff}# digitised\r\ntime [s] , height of tip [m/s]\r\n\r\n0, 1\r\n 0.5 ,2e-3\r\n";
    let table = read(text).unwrap();
    let expected = [Column::new("time", "s"), Column::new("height of tip", "m/s")];
    assert_eq!(table.columns(), expected);
    assert_eq!(table.values("height of tip").unwrap(), [1.0, 2e-3]);
    let table = read("0,1\n2,3").unwrap();
    assert_eq!(table.columns(), [Column::new("1", ""), Column::new("2", "")]);
    assert_eq!(table.rows().collect::<Vec<_>>(), [[0.0, 1.0], [2.0, 3.0]]);
    assert!(read("").unwrap().is_empty());
}

#[test]
fn faults_name_line_and_column() {
    let error = read("# by hand\r\nt,x\r\n0,1\r\n# pause\r\n\r\n  \r\n1,abc\r\n").unwrap_err();
    assert!(matches!(&error, TableError::NotANumber { line: 7, column: 2, .. }), "{error}");
    assert!(error.to_string().contains("table.csv, line 7, column 2: expected a number"));
    let error = read("0,1\n1,2,3\n").unwrap_err();
    let ragged = matches!(error, TableError::Ragged { line: 2, expected: 2, got: 3, .. });
    assert!(ragged, "{error}");
    // A misprint in the first row is no header as long as one cell is a number.
    let error = read("0.0,1.o\n1,2\n").unwrap_err();
    assert!(matches!(error, TableError::NotANumber { line: 1, column: 2, .. }), "{error}");
    for separated_otherwise in ["t;x\n0,5;1\n", "t;x\n0;1\n", "t x\n0 1\n"] {
        let error = read(separated_otherwise).unwrap_err().to_string();
        assert!(error.contains("separate columns by commas"), "{error}");
    }
    let error = read(",".repeat(20_000)).unwrap_err();
    assert!(matches!(error, TableError::TooWide { got: 20_001, .. }), "{error}");
    let error = Table::read_csv(std::path::Path::new("/missing.csv")).unwrap_err();
    assert!(matches!(error, TableError::Io { .. }), "{error}");
}

#[test]
fn a_file_above_the_limit_is_refused() {
    let (_folder, path) = file("");
    let handle = std::fs::File::create(&path).unwrap();
    // A hole in the file: no disk is used.
    handle.set_len(Table::MAX_CSV_BYTES + 1).unwrap();
    let error = Table::read_csv(&path).unwrap_err();
    assert!(matches!(error, TableError::TooLarge { .. }), "{error}");
}

#[test]
fn a_curve_grows_and_is_finite() {
    let curve = read_curve("t [s],x [m],y\n0,1,9\n0.5,-2,nan\n").unwrap();
    let expected = Curve { abscissa: vec![0.0, 0.5], ordinate: vec![1.0, -2.0] };
    assert_eq!(curve, expected);
    let error = read_curve("0,1\n1,2\n1,3\n").unwrap_err();
    assert!(matches!(error, TableError::NotACurve { line: 3, column: 1, .. }), "{error}");
    assert!(error.to_string().contains("1 is not larger than 1.0"), "{error}");
    let error = read_curve("0,1\n1,nan\n").unwrap_err();
    assert!(matches!(error, TableError::NotACurve { line: 2, column: 2, .. }), "{error}");
    let error = read_curve("t,x\n").unwrap_err();
    assert!(matches!(error, TableError::Empty { .. }), "{error}");
    let error = read_curve("0\n1\n").unwrap_err();
    assert!(matches!(error, TableError::NoOrdinate { .. }), "{error}");
}
