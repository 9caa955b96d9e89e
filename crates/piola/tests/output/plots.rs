//! Charts: curves where they should be, a panel for each unit, and no panic whatever the numbers.

use piola::output::{Column, Plot, Series, Style, Table};
use proptest::prelude::*;

use crate::image::{Colour, Image};

/// The first two colours of lines and the first of marks.
const BLUE: Colour = [0, 114, 178];
const ORANGE: Colour = [213, 94, 0];
const BLACK: Colour = [0; 3];

fn series(name: &str, unit: &str, style: Style, points: &[[f64; 2]]) -> Series {
    Series { column: Column::new(name, unit), points: points.to_vec(), style }
}

fn draw(series: Vec<Series>) -> Image {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("plot.png");
    let title = "A chart".into();
    let plot = Plot { title, abscissa: Column::new("time", "s"), series };
    let length = plot.write_png(&path).unwrap();
    assert_eq!(std::fs::metadata(&path).unwrap().len(), length);
    Image::read(&path)
}

#[test]
fn a_line_goes_from_corner_to_corner_and_breaks_where_it_is_not_finite() {
    let points: Vec<[f64; 2]> = (0..=100)
        .map(|i| [f64::from(i), if (40..=60).contains(&i) { f64::NAN } else { f64::from(i) }])
        .collect();
    let image = draw(vec![series("x", "m", Style::Line, &points)]);
    assert_eq!(image.width, 1200);
    let columns = image.upright_lines(300);
    let (left, right) = (columns[0] as f64 + 1.0, columns[1] as f64 + 1.0);
    let rows = image.level_lines(300);
    let (top, bottom) = (rows[0] as f64 + 1.0, rows[1] as f64 + 1.0);
    for (time, value) in [(10.0, 10.0), (25.0, 25.0), (90.0, 90.0)] {
        let x = left + time / 100.0 * (right - left);
        // The range of values is 5 % wider on both sides than they are.
        let y = bottom - (value + 5.0) / 110.0 * (bottom - top);
        let spot = image.spot(BLUE, x as usize, x as usize + 1).unwrap();
        assert!((spot.y - y).abs() < 2.0, "{} for {y} at {time} s", spot.y);
    }
    let gap = |time: f64| (left + time / 100.0 * (right - left)) as usize;
    assert!(image.spot(BLUE, gap(41.0), gap(59.0)).is_none(), "the gap is bridged");
}

/// What is compared with a line and lies on it leaves it to be seen.
#[test]
fn dashes_let_what_is_below_them_be_seen() {
    let points: Vec<[f64; 2]> = (0..=100).map(|i| [f64::from(i), 1.0]).collect();
    let one = series("one", "m", Style::Line, &points);
    let image = draw(vec![one.clone(), series("other", "m", Style::Dashes, &points)]);
    let rows = image.level_lines(300);
    let middle = (rows[0] + rows[1]) / 2 + 1;
    let blue = (0..image.width).filter(|&x| image.at(x, middle) == BLUE).count();
    assert!((200..800).contains(&blue), "{blue} pixels");
}

#[test]
fn a_million_points_keep_their_extremes() {
    let mut points: Vec<[f64; 2]> = (0..1_000_000).map(|i| [f64::from(i), 0.0]).collect();
    points[500_123][1] = 1.0;
    points[500_124][1] = -1.0;
    let image = draw(vec![series("x", "m", Style::Line, &points)]);
    let rows = image.level_lines(300);
    let middle = (rows[0] + rows[1]) / 2 + 1;
    let seen = |y: usize| (0..image.width).any(|x| image.at(x, y) == BLUE);
    let peak = (rows[1] - rows[0]) * 10 / 22 - 4;
    assert!(seen(middle) && seen(middle - peak) && seen(middle + peak));
}

#[test]
fn each_unit_has_a_panel_and_references_are_rings() {
    let line = [[0.0, 0.0], [1.0, 1.0]];
    let image = draw(vec![
        series("top.displacement.y", "m", Style::Line, &line),
        series("energy.total", "J", Style::Line, &line),
        series("toe.displacement.y", "m", Style::Line, &line[..1]),
        series("reference", "m", Style::Marks, &[[0.5, 0.5]]),
    ]);
    assert_eq!(image.level_lines(800).len(), 4, "two frames of two level lines");
    assert!(image.spot(BLUE, 0, image.width).is_some());
    assert!(image.spot(ORANGE, 0, image.width).is_some());
    let columns = image.upright_lines(200);
    let middle = (columns[0] + columns[1]) / 2;
    let rows = image.level_lines(800);
    let ring = image.spot(BLACK, middle - 8, middle + 10).unwrap();
    // The legend has one as well, above the frame.
    assert!(ring.y > rows[0] as f64 - 40.0 && ring.pixels > 10);
    assert_eq!(image.at(middle + 1, (rows[0] + rows[1]) / 2 + 1), [255; 3], "rings are hollow");
}

#[test]
fn a_series_comes_from_a_table() {
    let mut table = Table::new(vec![Column::new("time", "s"), Column::new("a", "m")]);
    table.push_row(&[0.0, 3.0]).unwrap();
    table.push_row(&[1.0, 4.0]).unwrap();
    let expected = series("a", "m", Style::Line, &[[0.0, 3.0], [1.0, 4.0]]);
    assert_eq!(Series::of_table(&table, "a"), Some(expected));
    assert_eq!(Series::of_table(&table, "b"), None);
}

/// Values that were met in tests to make the drawing library panic, and names longer than a
/// picture.
#[test]
fn extremes_are_drawn() {
    let huge = f64::from_bits(12036566759015290355);
    let larger = f64::from_bits(6224961975343810402);
    let points = [[-1e240, huge], [huge, larger], [f64::MAX, f64::MIN], [0.0, 0.0]];
    let name = "pressure.".repeat(3000);
    draw(vec![
        series(&name, &name, Style::Line, &points),
        series(&name, &name, Style::Marks, &points),
    ]);
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(16))]
    #[test]
    fn no_numbers_make_it_panic(
        curves in proptest::collection::vec(
            (
                "\\PC{0,30}",
                "m|J|",
                0..3_usize,
                proptest::collection::vec(any::<[u64; 2]>(), 0..8),
            ),
            0..30,
        ),
    ) {
        let series = curves.into_iter().map(|(name, unit, style, bits)| Series {
            column: Column::new(name, unit),
            points: bits.into_iter().map(|pair| pair.map(f64::from_bits)).collect(),
            style: [Style::Line, Style::Dashes, Style::Marks][style],
        });
        draw(series.collect());
    }
}
