//! The drawing base of pictures and charts: a canvas, text, colours, ticks and axes.
//!
//! Lengths are pixels, x to the right and y downwards, as in the file.

pub(super) mod axes;
pub(super) mod canvas;
pub(super) mod colour_bar;
pub(super) mod colours;
pub(super) mod font;
pub(super) mod ticks;

/// Height of the letters of tick labels.
pub(super) const SMALL: f32 = 20.0;
/// Height of the letters of labels and titles.
pub(super) const LARGE: f32 = 23.0;
/// Length of a tick.
pub(super) const TICK: f32 = 7.0;
/// Room between things that belong together, and between a picture and its edge.
pub(super) const GAP: f32 = 10.0;
/// Width of lines of frames and ticks.
pub(super) const LINE: f32 = 2.0;

/// A rectangle of pixels.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Area {
    pub left: f32,
    pub top: f32,
    pub width: f32,
    pub height: f32,
}

impl Area {
    /// Of any canvas.
    pub const ALL: Self = Self { left: 0.0, top: 0.0, width: f32::MAX, height: f32::MAX };

    pub fn right(self) -> f32 {
        self.left + self.width
    }

    pub fn bottom(self) -> f32 {
        self.top + self.height
    }
}
