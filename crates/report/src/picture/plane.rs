//! Particles in a plane, x and y to the same scale.

use super::super::drawing::axes::{self, Axis, Frame, ROOM_BELOW};
use super::super::drawing::canvas::Canvas;
use super::super::drawing::colour_bar::ColourBar;
use super::super::drawing::{Area, GAP};
use super::{LONG, Picture, colour, dot_radius};

/// Regions wider than this, over their height, have their colour bar below.
const WIDE: f64 = 1.8;
/// Smallest frame: slender regions are shown with white around them.
const SMALLEST: (f32, f32) = (240.0, 160.0);
/// What titles, axes and bars usually take of both sides.
const USUAL_BESIDE: f32 = 330.0;
const USUAL_BELOW: f32 = 150.0;

pub fn draw(picture: &Picture) -> Canvas {
    let (region, spacing) = picture.region();
    let (wide, high) = (region.max[0] - region.min[0], region.max[1] - region.min[1]);
    let lying = wide > WIDE * high;
    let (beside, below) = match lying {
        true => (USUAL_BESIDE / 2.0, USUAL_BELOW + ColourBar::ROOM_BELOW),
        false => (USUAL_BESIDE, USUAL_BELOW),
    };
    let scale = (f64::from(LONG - beside) / wide).min(f64::from(LONG - below) / high);
    let width = ((wide * scale) as f32).max(SMALLEST.0).round();
    let height = ((high * scale) as f32).max(SMALLEST.1).round();
    let along = |axis: usize, pixels: f32| {
        let middle = region.min[axis] + 0.5 * (region.max[axis] - region.min[axis]);
        let half = 0.5 * f64::from(pixels) / scale;
        [middle - half, middle + half]
    };
    let (x, y) = (along(0, width), along(1, height));

    let outside = picture
        .particles()
        .filter(|(at, _)| !(x[0]..=x[1]).contains(&at[0]) || !(y[0]..=y[1]).contains(&at[1]));
    let head = picture.head(outside.count());
    let x_axis = Axis::horizontal(x, width, "x", "m");
    let y_axis = Axis::vertical(y, height, "y", "m");
    let range = picture.value_range();
    let make_bar = if lying { ColourBar::lying } else { ColourBar::upright };
    let bar = make_bar(range, if lying { width } else { height }, picture.label, picture.unit);

    let left = (GAP + y_axis.room_beside()).round();
    let right = if lying { 3.0 * GAP } else { bar.room_beside() + GAP };
    let total_width = (left + width + right).round();
    let top = head.height(total_width).round();
    let bottom = ROOM_BELOW + 1.5 * GAP + if lying { ColourBar::ROOM_BELOW } else { 0.0 };
    let frame = Frame { area: Area { left, top, width, height }, x, y };

    let mut canvas = Canvas::new(total_width, top + height + bottom);
    head.draw(&mut canvas, total_width);
    // Magenta last, so that none hides.
    for finite in [true, false] {
        for (at, value, width) in picture.dots().filter(|it| it.1.is_finite() == finite) {
            let radius = dot_radius((spacing * width * scale) as f32);
            let point = frame.at(at[0], at[1]);
            canvas.dot(point, radius, colour(&bar, value), 0.0, frame.area);
        }
    }
    axes::draw(&mut canvas, &frame, Some(&x_axis), &y_axis);
    if lying {
        let below = (frame.area.bottom() + ROOM_BELOW + 2.0 * GAP).round();
        bar.draw_below(&mut canvas, frame.area, below);
    } else {
        bar.draw_beside(&mut canvas, frame.area);
    }
    canvas
}
