//! A frame with ticks and labels, and where data lie in it.

use super::canvas::{Anchor, Canvas, FAINT, INK, Pen};
use super::ticks::{Ticks, label};
use super::{Area, GAP, LARGE, LINE, SMALL, TICK, font};

/// The ranges of data that an area of pixels shows, y upwards.
#[derive(Clone, Copy, Debug)]
pub struct Frame {
    pub area: Area,
    pub x: [f64; 2],
    pub y: [f64; 2],
}

impl Frame {
    /// Where `(x, y)` is drawn; not finite if one of them is not.
    pub fn at(&self, x: f64, y: f64) -> (f32, f32) {
        let along = |value: f64, [low, high]: [f64; 2]| ((value - low) / (high - low)) as f32;
        (
            self.area.left + along(x, self.x) * self.area.width,
            self.area.bottom() - along(y, self.y) * self.area.height,
        )
    }
}

/// Ticks of one axis and what its numbers are.
#[derive(Clone, Debug)]
pub struct Axis {
    pub ticks: Ticks,
    pub label: String,
}

impl Axis {
    /// An axis along the bottom, `length` pixels long.
    pub fn horizontal(range: [f64; 2], length: f32, name: &str, unit: &str) -> Self {
        Self::new(Ticks::beside_each_other(range, length), name, unit)
    }

    /// An axis along the left or right side, `length` pixels long.
    pub fn vertical(range: [f64; 2], length: f32, name: &str, unit: &str) -> Self {
        Self::new(Ticks::above_each_other(range, length), name, unit)
    }

    fn new(ticks: Ticks, name: &str, unit: &str) -> Self {
        Self { label: label(name, unit, ticks.exponent), ticks }
    }

    /// Distance from the left or right of a frame to the middle of its label.
    pub fn label_distance(&self) -> f32 {
        TICK + 0.7 * GAP + self.ticks.widest() + 1.2 * GAP + LARGE / 2.0
    }

    /// Room for ticks and labels on the left or right of a frame. There is room for a minus and
    /// three digits at least, so that the frames of a series are equally large.
    pub fn room_beside(&self) -> f32 {
        let usual = font::width("−0.00", SMALL);
        self.label_distance() + (usual - self.ticks.widest()).max(0.0) + LARGE / 2.0
    }
}

/// Room for ticks and labels below a frame.
pub const ROOM_BELOW: f32 = TICK + 0.7 * GAP + SMALL + GAP + LARGE;

/// Draws the lines of the ticks inside the frame, under what is to come.
pub fn draw_grid(canvas: &mut Canvas, frame: &Frame, x: &Axis, y: &Axis) {
    let pen = Pen::new(1.0, FAINT);
    let Area { left, top, .. } = frame.area;
    for &value in &x.ticks.values {
        let at = crisp(frame.at(value, frame.y[0]).0, pen.width);
        canvas.line(&[(at, top), (at, frame.area.bottom())], &pen);
    }
    for &value in &y.ticks.values {
        let at = crisp(frame.at(frame.x[0], value).1, pen.width);
        canvas.line(&[(left, at), (frame.area.right(), at)], &pen);
    }
}

/// Draws the frame with ticks and labels outside it. An `x` of `None` leaves out the labels below.
pub fn draw(canvas: &mut Canvas, frame: &Frame, x: Option<&Axis>, y: &Axis) {
    let pen = Pen::new(LINE, INK);
    let area = frame.area;
    if let Some(axis) = x {
        for (&value, text) in axis.ticks.values.iter().zip(&axis.ticks.labels) {
            let at = crisp(frame.at(value, frame.y[0]).0, LINE);
            canvas.line(&[(at, area.bottom()), (at, area.bottom() + TICK)], &pen);
            let below = (at, area.bottom() + TICK + 0.7 * GAP);
            canvas.text(text, SMALL, below, Anchor(0.5, 0.0));
        }
        let middle = area.left + area.width / 2.0;
        let below = area.bottom() + TICK + 0.7 * GAP + SMALL + GAP;
        canvas.text(&axis.label, LARGE, (middle, below), Anchor(0.5, 0.0));
    }
    for (&value, text) in y.ticks.values.iter().zip(&y.ticks.labels) {
        let at = crisp(frame.at(frame.x[0], value).1, LINE);
        canvas.line(&[(area.left, at), (area.left - TICK, at)], &pen);
        canvas.text(text, SMALL, (area.left - TICK - 0.7 * GAP, at), Anchor(1.0, 0.5));
    }
    let middle = (area.left - y.label_distance(), area.top + area.height / 2.0);
    canvas.upright_text(&y.label, LARGE, middle);
    canvas.outline(area, &pen);
}

/// The place next to `at` where a line of `width` covers whole pixels.
pub fn crisp(at: f32, width: f32) -> f32 {
    (at - width / 2.0).round() + width / 2.0
}
