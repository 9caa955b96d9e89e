//! The bar that says which colour is which number.

use super::axes::{Axis, crisp};
use super::canvas::{Anchor, Canvas, INK, Pen};
use super::colours::ColourMap;
use super::{Area, GAP, LARGE, LINE, SMALL, TICK};

/// Width of the coloured part.
const THICK: f32 = 26.0;
/// Distance between a picture's frame and its bar.
const DISTANCE: f32 = 3.0 * GAP;

/// A bar for numbers in `range`.
pub struct ColourBar {
    pub range: [f64; 2],
    pub map: ColourMap,
    pub axis: Axis,
}

impl ColourBar {
    /// A bar on the right of a frame, `length` pixels high.
    pub fn upright(range: [f64; 2], length: f32, name: &str, unit: &str) -> Self {
        let axis = Axis::vertical(range, length, name, unit);
        Self { range, map: ColourMap::for_range(range), axis }
    }

    /// A bar below a frame, `length` pixels long.
    pub fn lying(range: [f64; 2], length: f32, name: &str, unit: &str) -> Self {
        let axis = Axis::horizontal(range, length, name, unit);
        Self { range, map: ColourMap::for_range(range), axis }
    }

    /// The colour of `value`.
    pub fn colour(&self, value: f64) -> super::canvas::Colour {
        self.map.colour((value - self.range[0]) / (self.range[1] - self.range[0]))
    }

    /// Room on the right of a frame.
    pub fn room_beside(&self) -> f32 {
        DISTANCE + THICK + self.axis.room_beside()
    }

    /// Room below a frame and its axis.
    pub const ROOM_BELOW: f32 = 2.0 * GAP + THICK + super::axes::ROOM_BELOW;

    /// Draws the bar on the right of a frame.
    pub fn draw_beside(&self, canvas: &mut Canvas, frame: Area) {
        let bar = Area { left: frame.right() + DISTANCE, width: THICK, ..frame };
        for row in 0..bar.height as usize {
            let place = 1.0 - (row as f64 + 0.5) / f64::from(bar.height);
            let line = Area { top: bar.top + row as f32, height: 1.0, ..bar };
            canvas.fill(line, self.map.colour(place), 255);
        }
        let pen = Pen::new(LINE, INK);
        for (value, text) in self.axis.ticks.values.iter().zip(&self.axis.ticks.labels) {
            let at = crisp(bar.bottom() - self.place(*value) * bar.height, LINE);
            canvas.line(&[(bar.right(), at), (bar.right() + TICK, at)], &pen);
            canvas.text(text, SMALL, (bar.right() + TICK + 0.7 * GAP, at), Anchor(0.0, 0.5));
        }
        canvas.outline(bar, &pen);
        let middle = (bar.right() + self.axis.label_distance(), bar.top + bar.height / 2.0);
        canvas.upright_text(&self.axis.label, LARGE, middle);
    }

    /// Draws the bar below a frame, its upper edge at `top`.
    pub fn draw_below(&self, canvas: &mut Canvas, frame: Area, top: f32) {
        let bar = Area { top, height: THICK, ..frame };
        for column in 0..bar.width as usize {
            let place = (column as f64 + 0.5) / f64::from(bar.width);
            let line = Area { left: bar.left + column as f32, width: 1.0, ..bar };
            canvas.fill(line, self.map.colour(place), 255);
        }
        let pen = Pen::new(LINE, INK);
        let below = bar.bottom() + TICK + 0.7 * GAP;
        for (value, text) in self.axis.ticks.values.iter().zip(&self.axis.ticks.labels) {
            let at = crisp(bar.left + self.place(*value) * bar.width, LINE);
            canvas.line(&[(at, bar.bottom()), (at, bar.bottom() + TICK)], &pen);
            canvas.text(text, SMALL, (at, below), Anchor(0.5, 0.0));
        }
        canvas.outline(bar, &pen);
        let middle = (bar.left + bar.width / 2.0, below + SMALL + GAP);
        canvas.text(&self.axis.label, LARGE, middle, Anchor(0.5, 0.0));
    }

    fn place(&self, value: f64) -> f32 {
        ((value - self.range[0]) / (self.range[1] - self.range[0])) as f32
    }
}
