//! The lines above a panel that say which curve is which. Above, since inside it would hide curves.

use super::super::drawing::canvas::{Anchor, Canvas};
use super::super::drawing::{Area, GAP, SMALL, font};
use super::{Style, Styled, ring};

/// Length of the piece of a curve that stands for it.
const SAMPLE: f32 = 44.0;
/// Distance between entries.
const BETWEEN: f32 = 3.0 * GAP;
const LEADING: f32 = 1.4 * SMALL;
/// Most rows; the number of curves without a row is shown.
const ROWS: usize = 4;

/// The entries of a panel, row by row.
pub struct Legend {
    rows: Vec<Vec<Entry>>,
}

struct Entry {
    /// Number of the curve in its panel; none for the remark that there are more.
    curve: Option<usize>,
    name: String,
    width: f32,
}

impl Legend {
    /// The legend of `panel` on `width` pixels; empty for a single curve, whose name is the label
    /// of the axis.
    pub fn new(panel: &[Styled], width: f32) -> Self {
        let mut rows: Vec<Vec<Entry>> = Vec::new();
        if panel.len() < 2 {
            return Self { rows };
        }
        let mut used = f32::INFINITY;
        for (number, styled) in panel.iter().enumerate() {
            // A third of the width, so that a row holds two names and the remark.
            let name = font::wrap(&styled.series.column.name, SMALL, width / 3.0, 1).concat();
            let entry = Entry {
                width: SAMPLE + GAP + font::width(&name, SMALL),
                curve: Some(number),
                name,
            };
            let last_row = rows.len() == ROWS;
            let remark = if last_row { BETWEEN + 80.0 } else { 0.0 };
            if used + BETWEEN + entry.width + remark > width {
                if last_row {
                    let name = format!("+ {} more", panel.len() - number);
                    let width = font::width(&name, SMALL);
                    rows[ROWS - 1].push(Entry { curve: None, name, width });
                    break;
                }
                used = -BETWEEN;
                rows.push(Vec::new());
            }
            used += BETWEEN + entry.width;
            if let Some(row) = rows.last_mut() {
                row.push(entry);
            }
        }
        Self { rows }
    }

    /// Its height, with the distance to the panel.
    pub fn height(&self) -> f32 {
        if self.rows.is_empty() { 0.0 } else { self.rows.len() as f32 * LEADING + 0.3 * GAP }
    }

    /// Draws the legend of `panel` from `top` on, around the middle of `area`.
    pub fn draw(&self, canvas: &mut Canvas, panel: &[Styled], area: Area, top: f32) {
        let mut middle = top + 0.5 * LEADING;
        for row in &self.rows {
            let entries = row.iter().map(|entry| entry.width).sum::<f32>();
            let width = entries + BETWEEN * (row.len() as f32 - 1.0);
            let mut left = area.left + 0.5 * (area.width - width);
            for entry in row {
                let curve = entry.curve.and_then(|number| panel.get(number));
                if let Some(Styled { series, pen }) = curve {
                    match series.style {
                        Style::Line | Style::Dashes => {
                            canvas.line(&[(left, middle), (left + SAMPLE, middle)], pen);
                        }
                        Style::Marks => {
                            ring(canvas, (left + SAMPLE / 2.0, middle), pen.colour);
                        }
                    }
                }
                let indent = if curve.is_some() { SAMPLE + GAP } else { 0.0 };
                canvas.text(&entry.name, SMALL, (left + indent, middle), Anchor(0.0, 0.5));
                left += entry.width + BETWEEN;
            }
            middle += LEADING;
        }
    }
}
