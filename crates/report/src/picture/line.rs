//! Particles on a line: their values against x.

use super::super::drawing::axes::{self, Axis, Frame, ROOM_BELOW};
use super::super::drawing::canvas::{Canvas, MAGENTA, Pen};
use super::super::drawing::colours::CURVES;
use super::super::drawing::{Area, GAP};
use super::{LONG, Picture};
use piola_physics::fields::is_absent;

const HEIGHT: f32 = 720.0;

pub fn draw(picture: &Picture) -> Canvas {
    let (region, spacing) = picture.region();
    let x = [region.min[0], region.max[0]];
    let [low, high] = picture.value_range();
    // A little room, so that dots of the largest values are whole; but not so that the ends of a
    // range that was asked for are no ticks.
    let around = if picture.range.is_some() { 0.02 } else { 0.05 } * (high - low);
    let y = [low - around, high + around];

    let outside = picture
        .particles()
        .filter(|&(at, value)| !(x[0]..=x[1]).contains(&at[0]) || value < y[0] || value > y[1]);
    let head = picture.head(outside.count());
    let (top, bottom) = (head.height(LONG), ROOM_BELOW + GAP);
    let height = HEIGHT - top - bottom;
    let y_axis = Axis::vertical(y, height, picture.label, picture.unit);
    let left = (GAP + y_axis.room_beside()).round();
    let width = (LONG - left - 3.0 * GAP).round();
    let area = Area { left, top: top.round(), width, height: height.round() };
    let x_axis = Axis::horizontal(x, width, "x", "m");
    let frame = Frame { area, x, y };

    let mut canvas = Canvas::new(LONG, HEIGHT);
    head.draw(&mut canvas, LONG);
    axes::draw_grid(&mut canvas, &frame, &x_axis, &y_axis);
    let mut particles: Vec<(f64, f64)> = picture
        .particles()
        .map(|(at, value)| (at[0], value))
        .filter(|(at, _)| (x[0]..=x[1]).contains(at))
        .collect();
    particles.sort_by(|one, two| one.0.total_cmp(&two.0));
    let inside = |value: f64| if value < y[0] || value > y[1] { f64::NAN } else { value };
    let points: Vec<(f32, f32)> =
        particles.iter().map(|&(at, value)| frame.at(at, inside(value))).collect();
    canvas.line(&points, &Pen::new(1.5, CURVES[4]));
    let apart = (spacing / (x[1] - x[0])) as f32 * width;
    let radius = (0.4 * apart).clamp(2.5, 6.0);
    for (&(at, value), &point) in particles.iter().zip(&points) {
        if value.is_finite() {
            if point.1.is_finite() {
                canvas.dot(point, radius, CURVES[0], 0.0, area);
            }
        } else if !is_absent(value) {
            let (along, bottom) = frame.at(at, y[0]);
            canvas.dot((along, bottom - 8.0), radius.max(5.0), MAGENTA, 0.0, area);
        }
    }
    axes::draw(&mut canvas, &frame, Some(&x_axis), &y_axis);
    canvas
}
