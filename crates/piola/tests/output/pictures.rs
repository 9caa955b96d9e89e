//! Pictures of particles: the right colour at the right pixel, and no panic whatever the numbers.

use std::path::Path;

use piola::output::{Bounds, OutputError, Picture, When};
use proptest::prelude::*;

use crate::image::{Colour, Image};

/// Ends and middle of viridis, as published.
const LOW: Colour = [68, 1, 84];
const MIDDLE: Colour = [33, 145, 140];
const HIGH: Colour = [253, 231, 37];
const MAGENTA: Colour = [255, 0, 255];

const PLAIN: Picture = Picture {
    title: "Three particles",
    when: Some(When::Time(0.5)),
    label: "pressure",
    unit: "Pa",
    dimension: 2,
    positions: &[0.0, 0.0, 2.0, 0.0, 0.0, 1.4],
    values: &[0.0, 1e5, 5e4],
    spacing: 0.2,
    widths: &[],
    range: None,
    bounds: None,
};

fn draw(picture: &Picture) -> Image {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("picture.png");
    let length = picture.write_png(&path).unwrap();
    assert_eq!(std::fs::metadata(&path).unwrap().len(), length);
    Image::read(&path)
}

/// Left and right of the frame, without those of the colour bar.
fn frame(image: &Image) -> (usize, usize) {
    let lines = image.upright_lines(300);
    assert_eq!(lines.len(), 4, "frame and bar have two upright lines each: {lines:?}");
    (lines[0], lines[1] + 2)
}

#[test]
fn particles_are_where_they_should_be_in_their_colours() {
    let image = draw(&PLAIN);
    let longer = image.width.max(image.height);
    assert!((1100..1300).contains(&longer), "{longer} pixels");
    let (left, right) = frame(&image);
    let spot = |colour| image.spot(colour, left + 2, right - 2).unwrap();
    let (low, high, middle) = (spot(LOW), spot(HIGH), spot(MIDDLE));
    let metre = (high.x - low.x) / 2.0;
    assert!(metre > 250.0);
    assert!((high.y - low.y).abs() < 0.5, "on one level");
    assert!((middle.x - low.x).abs() < 0.5, "above each other");
    assert!((low.y - middle.y - 1.4 * metre).abs() < 1.0, "y upwards, to the scale of x");
    // The frame is as far from the particles on all sides.
    let rows = image.level_lines(300);
    let (top, bottom) = (rows[0] as f64 + 1.0, rows[rows.len() - 1] as f64 + 1.0);
    let around = low.x - (left as f64 + 1.0);
    assert!((right as f64 - 1.0 - high.x - around).abs() < 1.5);
    assert!((middle.y - top - around).abs() < 1.5);
    assert!((bottom - low.y - around).abs() < 1.5);
    // The diameter is the spacing; blurred pixels of the rim are not counted.
    let area = std::f64::consts::PI * (0.1 * metre).powi(2);
    for spot in [low, high, middle] {
        let ratio = spot.pixels as f64 / area;
        assert!((0.85..1.02).contains(&ratio), "{ratio} of the disc's area");
    }
}

#[test]
fn a_range_around_zero_goes_from_blue_to_red() {
    let image = draw(&Picture { range: Some([-1e5, 1e5]), ..PLAIN });
    let (left, right) = frame(&image);
    // Moreland's grey and red.
    assert!(image.spot([221, 221, 221], left + 2, right - 2).is_some());
    assert!(image.spot([180, 4, 38], left + 2, right - 2).is_some());
}

#[test]
fn values_that_are_not_finite_are_magenta_and_do_not_stretch_the_range() {
    let whole = draw(&PLAIN);
    assert!(whole.spot(MAGENTA, 0, whole.width).is_none());
    let positions = [PLAIN.positions, &[2.0, 1.4, 1.0, 0.7]].concat();
    let values = [PLAIN.values, &[f64::NAN, f64::NEG_INFINITY]].concat();
    let image = draw(&Picture { positions: &positions, values: &values, ..PLAIN });
    let (left, right) = frame(&image);
    let spot = |colour| image.spot(colour, left + 2, right - 2).unwrap();
    let (low, high, magenta) = (spot(LOW), spot(HIGH), spot(MAGENTA));
    let metre = (high.x - low.x) / 2.0;
    // The middle of both magenta ones.
    assert!((magenta.x - (low.x + 1.5 * metre)).abs() < 0.5);
    assert!((low.y - magenta.y - 1.05 * metre).abs() < 0.5);
    for (dimension, positions) in
        [(1, &positions[..5]), (3, &[positions.as_slice(); 2].concat()[..15])]
    {
        let image = draw(&Picture { dimension, positions, values: &values, ..PLAIN });
        assert!(image.spot(MAGENTA, 0, image.width).is_some(), "{dimension}D");
    }
}

#[test]
fn pictures_of_one_region_have_one_frame_and_hide_what_is_outside() {
    let bounds = Bounds { min: [0.0; 3], max: [1.0, 1.0, 0.0] };
    let inside = Picture { bounds: Some(bounds), range: Some([0.0, 1e5]), ..PLAIN };
    let first = draw(&inside);
    let second = draw(&Picture { positions: &[0.4, 0.3, 7.0, 9.0, -5.0, 0.5], ..inside });
    assert_eq!((first.width, first.height), (second.width, second.height));
    let (left, right) = frame(&second);
    assert_eq!(frame(&first), (left, right));
    assert!(second.spot(LOW, left + 2, right - 2).is_some());
    assert!(second.spot(HIGH, 0, right - 2).is_none(), "a particle outside is drawn");
    let found = Bounds::of(2, PLAIN.positions).unwrap();
    assert_eq!(found, Bounds { min: [0.0; 3], max: [2.0, 1.4, 0.0] });
    assert_eq!(found.union(bounds), found);
    assert_eq!(Bounds::of(2, &[f64::NAN, 0.0]), None);
}

/// Two particles on one line of sight, azimuth -60 and elevation 25 degrees.
#[test]
fn the_nearer_particle_hides_the_farther() {
    let (azimuth, elevation) = (-60_f64.to_radians(), 25_f64.to_radians());
    let near = [elevation.cos() * azimuth.cos(), elevation.cos() * azimuth.sin(), elevation.sin()];
    let far = [0.0; 3];
    for swap in [false, true] {
        let positions = if swap { [near, far].concat() } else { [far, near].concat() };
        let values = if swap { [0.5, 0.0] } else { [0.0, 0.5] };
        let picture = Picture {
            dimension: 3,
            positions: &positions,
            values: &values,
            spacing: 0.3,
            widths: &[],
            range: Some([0.0, 1.0]),
            ..PLAIN
        };
        let image = draw(&picture);
        let bar = image.upright_lines(300);
        let right_of_box = bar[bar.len() - 2];
        assert!(image.spot(MIDDLE, 0, right_of_box).is_some(), "the nearer one is hidden");
        assert!(image.spot(LOW, 0, right_of_box).is_none(), "the farther one is seen");
    }
}

#[test]
fn a_line_of_particles_is_drawn_against_x() {
    let positions: Vec<f64> = (0..=20).map(|i| f64::from(i) / 20.0).collect();
    let picture = Picture { dimension: 1, positions: &positions, values: &positions, ..PLAIN };
    let image = draw(&picture);
    // The first of the colours of curves.
    let blue = [0, 114, 178];
    let half = image.width / 2;
    let left = image.spot(blue, 0, half).unwrap();
    let right = image.spot(blue, half, image.width).unwrap();
    assert!(right.y < left.y - 100.0, "values rise to the right");
}

#[test]
fn contradictions_are_refused() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("picture.png");
    let error = Picture { positions: &[0.0; 5], ..PLAIN }.write_png(&path).unwrap_err();
    assert!(matches!(error, OutputError::WrongLength { expected: 6, got: 5, .. }), "{error}");
    for dimension in [0, 4] {
        let error = Picture { dimension, ..PLAIN }.write_png(&path).unwrap_err();
        assert!(matches!(error, OutputError::WrongDimension { .. }), "{error}");
    }
    assert!(!path.exists());
    let error = PLAIN.write_png(Path::new("/missing/picture.png")).unwrap_err();
    assert!(matches!(error, OutputError::ParentMissing { .. }), "{error}");
}

#[test]
fn sizes_stay_sensible() {
    let long = "A very long title ".repeat(2000);
    let slender = [0.0, 0.0, 1e6, 1e-6, 5e5, 0.0];
    let tall = [0.0, 0.0, 1e-6, 1e6, 0.0, 5e5];
    let far = [1e9, 1e9, 1e9 + 1.0, 1e9, 1e9, 1e9 + 1.0];
    let blown_up = [0.0, 0.0, 1e90, 1e99, -1e95, 0.0];
    for (title, positions) in [
        (long.as_str(), PLAIN.positions),
        ("", &slender),
        ("tall", &tall),
        ("far", &far),
        ("blown up", &blown_up),
    ] {
        let image = draw(&Picture { title, label: title, positions, ..PLAIN });
        let (width, height) = (image.width, image.height);
        assert!((400..1600).contains(&width) && (300..1600).contains(&height), "{width}x{height}");
        assert_eq!((width % 2, height % 2), (0, 0));
    }
}

/// Any number there is, the ordinary ones as often as the others.
fn number() -> impl Strategy<Value = f64> {
    prop_oneof![any::<u64>().prop_map(f64::from_bits), -10.0..10.0, Just(0.0), Just(f64::NAN)]
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(24))]
    #[test]
    fn no_numbers_make_it_panic(
        dimension in 1_usize..=3,
        values in proptest::collection::vec(number(), 0..6),
        coordinates in proptest::collection::vec(number(), 15),
        (spacing, range) in (number(), proptest::option::of([number(), number()])),
        corners in proptest::option::of([number(), number()]),
        title in "\\PC{0,60}",
    ) {
        let bounds = corners.map(|[low, high]| Bounds { min: [low; 3], max: [high; 3] });
        draw(&Picture {
            title: &title,
            when: Some(When::Time(spacing)),
            widths: &[],
            label: &title,
            unit: "kg/m^3",
            dimension,
            positions: &coordinates[..values.len() * dimension],
            values: &values,
            spacing,
            range,
            bounds,
        });
    }
}
