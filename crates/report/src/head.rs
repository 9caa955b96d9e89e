//! The lines above a picture or a chart: its title, and below it time and notes.

use super::drawing::canvas::{Anchor, Canvas};
use super::drawing::{GAP, LARGE, SMALL, font};

const TITLE_LINES: usize = 3;
const NOTE_LINES: usize = 2;
const LEADING: f32 = 1.35;

/// Title and notes.
pub struct Head {
    title: String,
    notes: String,
}

impl Head {
    pub fn new(title: &str, notes: Vec<String>) -> Self {
        Self { title: title.to_owned(), notes: notes.join(", ") }
    }

    /// Its height on a picture `width` pixels wide, with the distance to what is below.
    pub fn height(&self, width: f32) -> f32 {
        let (title, notes) = self.lines(width);
        let lines = title.len() as f32 * LARGE + notes.len() as f32 * SMALL;
        GAP + lines * LEADING + 0.5 * GAP
    }

    /// Draws it at the top of a picture `width` pixels wide, around `middle`.
    pub fn draw(&self, canvas: &mut Canvas, width: f32) {
        let (title, notes) = self.lines(width);
        let lines = title.iter().map(|line| (line, LARGE));
        let mut top = GAP;
        for (line, size) in lines.chain(notes.iter().map(|line| (line, SMALL))) {
            canvas.text(line, size, (width / 2.0, top + 0.2 * size), Anchor(0.5, 0.0));
            top += LEADING * size;
        }
    }

    fn lines(&self, width: f32) -> (Vec<String>, Vec<String>) {
        let room = width - 2.0 * GAP;
        (
            font::wrap(&self.title, LARGE, room, TITLE_LINES),
            font::wrap(&self.notes, SMALL, room, NOTE_LINES),
        )
    }
}
