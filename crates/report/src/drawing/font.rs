//! Text as outlines of the embedded font, DejaVu Sans: the face that readers of papers know from
//! most figures, with Greek, superscripts and mathematical signs, free to embed. Nothing is asked
//! of the fonts of the machine, so pictures look the same everywhere.

use std::sync::LazyLock;

use tiny_skia::{Path, PathBuilder};
use ttf_parser::{Face, OutlineBuilder};

static FACE: LazyLock<Face<'static>> = LazyLock::new(|| {
    Face::parse(dejavu::sans::regular(), 0).expect("the embedded font is the same in each build")
});

/// Height of a capital letter over the size of the font.
pub const CAPITAL: f32 = 0.73;

/// Width of `text` in pixels at font size `size`.
pub fn width(text: &str, size: f32) -> f32 {
    let advances = text.chars().map(|letter| f32::from(advance(letter)));
    advances.sum::<f32>() * scale(size)
}

/// Outline of `text` at font size `size`, starting at `x` on the base line `y`. Nothing if there
/// is nothing to see, as for blanks.
pub fn outline(text: &str, size: f32, x: f32, y: f32) -> Option<Path> {
    let mut pen = Pen { path: PathBuilder::new(), scale: scale(size), x, y };
    for letter in text.chars() {
        // A letter that the font lacks is glyph 0, a box.
        FACE.outline_glyph(FACE.glyph_index(letter).unwrap_or_default(), &mut pen);
        pen.x += f32::from(advance(letter)) * pen.scale;
    }
    pen.path.finish()
}

/// Cuts `text` between words into lines of at most `width` pixels, at most `most` of them; what
/// does not fit ends in an ellipsis.
pub fn wrap(text: &str, size: f32, width: f32, most: usize) -> Vec<String> {
    let mut lines: Vec<String> = Vec::new();
    for word in text.split_whitespace() {
        match lines.last_mut() {
            Some(line) if self::width(&format!("{line} {word}"), size) <= width => {
                line.push(' ');
                line.push_str(word);
            }
            _ => lines.push(word.to_owned()),
        }
        if lines.len() > most {
            break;
        }
    }
    // The word that found no place makes the last line too wide, so that it is cut.
    if lines.len() > most
        && let Some(next) = lines.pop()
        && let Some(last) = lines.last_mut()
    {
        *last = format!("{last} {next}");
    }
    lines.iter().map(|line| cut(line, size, width)).collect()
}

/// `text`, with an ellipsis in the place of what exceeds `width` pixels.
pub fn cut(text: &str, size: f32, width: f32) -> String {
    if self::width(text, size) <= width {
        return text.to_owned();
    }
    let room = width - self::width("…", size);
    let mut used = 0.0;
    let fitting = text.char_indices().find(|&(_, letter)| {
        used += f32::from(advance(letter)) * scale(size);
        used > room
    });
    format!("{}…", &text[..fitting.map_or(text.len(), |(end, _)| end)])
}

fn scale(size: f32) -> f32 {
    size / f32::from(FACE.units_per_em())
}

fn advance(letter: char) -> u16 {
    FACE.glyph_hor_advance(FACE.glyph_index(letter).unwrap_or_default()).unwrap_or_default()
}

/// Turns outlines in units of the font, y upwards, into a path in pixels, y downwards.
struct Pen {
    path: PathBuilder,
    scale: f32,
    x: f32,
    y: f32,
}

impl Pen {
    fn at(&self, x: f32, y: f32) -> (f32, f32) {
        (self.x + x * self.scale, self.y - y * self.scale)
    }
}

impl OutlineBuilder for Pen {
    fn move_to(&mut self, x: f32, y: f32) {
        let (x, y) = self.at(x, y);
        self.path.move_to(x, y);
    }

    fn line_to(&mut self, x: f32, y: f32) {
        let (x, y) = self.at(x, y);
        self.path.line_to(x, y);
    }

    fn quad_to(&mut self, x1: f32, y1: f32, x: f32, y: f32) {
        let ((x1, y1), (x, y)) = (self.at(x1, y1), self.at(x, y));
        self.path.quad_to(x1, y1, x, y);
    }

    fn curve_to(&mut self, x1: f32, y1: f32, x2: f32, y2: f32, x: f32, y: f32) {
        let ((x1, y1), (x2, y2), (x, y)) = (self.at(x1, y1), self.at(x2, y2), self.at(x, y));
        self.path.cubic_to(x1, y1, x2, y2, x, y);
    }

    fn close(&mut self) {
        self.path.close();
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn wrapped_lines_fit_and_hold_all_words() {
        let text = "A column of fluid hits a wall and climbs it";
        let lines = wrap(text, 20.0, 160.0, 9);
        assert!(lines.len() > 2);
        assert!(lines.iter().all(|line| width(line, 20.0) <= 160.0), "{lines:?}");
        assert_eq!(lines.join(" "), text);
    }

    #[test]
    fn what_does_not_fit_ends_in_an_ellipsis() {
        for text in ["unbreakable".repeat(50), "many words ".repeat(50)] {
            let lines = wrap(&text, 20.0, 160.0, 2);
            assert!(lines.len() <= 2);
            assert!(lines.iter().all(|line| width(line, 20.0) <= 160.0), "{lines:?}");
            assert!(lines.last().unwrap().ends_with('…'), "{lines:?}");
        }
        assert!(wrap("", 20.0, 160.0, 2).is_empty());
    }
}
