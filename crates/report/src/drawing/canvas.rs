//! A canvas of pixels: lines, text and dots, anti-aliased, and the PNG that it becomes.

use std::io::{self, Write};

use png::{BitDepth, ColorType, Encoder};
use tiny_skia::{
    Color, FillRule, LineCap, LineJoin, Paint, PathBuilder, Pixmap, PremultipliedColorU8, Rect,
    Stroke, StrokeDash, Transform,
};

use super::{Area, font};

/// Red, green and blue of 0 to 255 (sRGB).
pub type Colour = [u8; 3];

pub const WHITE: Colour = [255; 3];
/// Of frames and text.
pub const INK: Colour = [38; 3];
/// Of what is there to help the eye only.
pub const FAINT: Colour = [222; 3];
/// Of particles without a finite value.
pub const MAGENTA: Colour = [255, 0, 255];
/// What has no number.
pub const GREY: Colour = [160; 3];

/// How far beyond the canvas lines are drawn.
const MARGIN: f32 = 1000.0;

/// Which point of a text is put where it is asked for: 0 is its left or upper end, 1 its right or
/// lower one.
#[derive(Clone, Copy, Debug)]
pub struct Anchor(pub f32, pub f32);

/// Width, colour and dashes of a line.
#[derive(Clone, Debug)]
pub struct Pen {
    pub width: f32,
    pub colour: Colour,
    /// Lengths of dashes and gaps in turn; none for a full line.
    pub dashes: Vec<f32>,
}

impl Pen {
    pub fn new(width: f32, colour: Colour) -> Self {
        Self { width, colour, dashes: Vec::new() }
    }
}

/// A picture in the making.
pub struct Canvas {
    pixmap: Pixmap,
}

impl Canvas {
    /// A white canvas; its sides are made even, as encoders of films want them.
    pub fn new(width: f32, height: f32) -> Self {
        // No picture of ours is larger; a fault in a layout must not fill the memory.
        let even = |side: f32| ((side.clamp(2.0, 8000.0) / 2.0).ceil() * 2.0) as u32;
        let mut pixmap = Pixmap::new(even(width), even(height)).expect("both sides are positive");
        pixmap.fill(Color::WHITE);
        Self { pixmap }
    }

    /// A line through `points`. Those that are not finite or far from the canvas break it:
    /// tiny-skia panics at large coordinates (<https://github.com/linebender/resvg/issues/940>).
    pub fn line(&mut self, points: &[(f32, f32)], pen: &Pen) {
        let (right, bottom) = (self.pixmap.width() as f32, self.pixmap.height() as f32);
        let near = |place: f32, end: f32| (-MARGIN..=end + MARGIN).contains(&place);
        let mut path = PathBuilder::new();
        let mut pen_is_down = false;
        for &(x, y) in points {
            let drawn = near(x, right) && near(y, bottom);
            match (drawn, pen_is_down) {
                (true, true) => path.line_to(x, y),
                (true, false) => path.move_to(x, y),
                (false, _) => {}
            }
            pen_is_down = drawn;
        }
        let Some(path) = path.finish() else { return };
        let stroke = Stroke {
            width: pen.width,
            line_cap: if pen.dashes.is_empty() { LineCap::Square } else { LineCap::Butt },
            line_join: LineJoin::Round,
            dash: StrokeDash::new(pen.dashes.clone(), 0.0),
            ..Stroke::default()
        };
        let identity = Transform::identity();
        self.pixmap.stroke_path(&path, &paint(pen.colour, 255), &stroke, identity, None);
    }

    /// The outline of `area`.
    pub fn outline(&mut self, area: Area, pen: &Pen) {
        let (left, top, right, bottom) = (area.left, area.top, area.right(), area.bottom());
        self.line(&[(left, top), (right, top), (right, bottom), (left, bottom), (left, top)], pen);
    }

    /// A filled rectangle, `opacity` from 0 to 255.
    pub fn fill(&mut self, area: Area, colour: Colour, opacity: u8) {
        if let Some(rect) = Rect::from_xywh(area.left, area.top, area.width, area.height) {
            self.pixmap.fill_rect(rect, &paint(colour, opacity), Transform::identity(), None);
        }
    }

    /// `text` at font size `size`, its `anchor` at `(x, y)`. Heights are those of capitals. What
    /// is wider than the canvas is cut.
    pub fn text(&mut self, text: &str, size: f32, (x, y): (f32, f32), anchor: Anchor) {
        let text = font::cut(text, size, self.pixmap.width() as f32);
        let left = x - anchor.0 * font::width(&text, size);
        let base = y + (1.0 - anchor.1) * font::CAPITAL * size;
        self.fill_path(font::outline(&text, size, left, base), INK, Transform::identity());
    }

    /// `text` upwards, its middle at `(x, y)`. What is longer than the canvas is cut.
    pub fn upright_text(&mut self, text: &str, size: f32, (x, y): (f32, f32)) {
        let text = font::cut(text, size, self.pixmap.height() as f32);
        let left = x - font::width(&text, size) / 2.0;
        let base = y + font::CAPITAL * size / 2.0;
        let turn = Transform::from_rotate_at(-90.0, x, y);
        self.fill_path(font::outline(&text, size, left, base), INK, turn);
    }

    /// A disc around `(x, y)`, cut at `clip`; nothing if that is not finite. `shade` from 0 to 1 darkens its rim, so that it
    /// looks round.
    ///
    /// A pixel is covered by the part of a pixel's width that its middle lies inside the disc;
    /// for discs of a pixel and more this is the exact cover to a few parts in a hundred, and a
    /// hundred times faster than a path for each of many particles.
    pub fn dot(&mut self, (x, y): (f32, f32), radius: f32, colour: Colour, shade: f32, clip: Area) {
        if !(x.is_finite() && y.is_finite()) {
            return;
        }
        let reach = radius + 0.5;
        let right = (self.pixmap.width() as f32).min(clip.right());
        let bottom = (self.pixmap.height() as f32).min(clip.bottom());
        // Casts of floats saturate, so that a dot anywhere at all is safe.
        let columns = (x - reach).max(clip.left).max(0.0).floor() as usize
            ..(x + reach).min(right).ceil() as usize;
        let rows = (y - reach).max(clip.top).max(0.0).floor() as usize
            ..(y + reach).min(bottom).ceil() as usize;
        let width = self.pixmap.width() as usize;
        let pixels = self.pixmap.pixels_mut();
        for row in rows {
            for column in columns.clone() {
                let (dx, dy) = (column as f32 + 0.5 - x, row as f32 + 0.5 - y);
                let square = dx * dx + dy * dy;
                let cover = (reach - square.sqrt()).min(1.0);
                if cover > 0.0 {
                    let light = 1.0 - shade * (square / (radius * radius)).min(1.0);
                    let pixel = &mut pixels[row * width + column];
                    *pixel = blend(*pixel, colour.map(|part| f32::from(part) * light), cover);
                }
            }
        }
    }

    /// Writes the picture as PNG, with the name and version of the program in its header.
    pub fn write_png(&self, out: &mut dyn Write) -> io::Result<()> {
        let mut encoder = Encoder::new(out, self.pixmap.width(), self.pixmap.height());
        encoder.set_color(ColorType::Rgb);
        encoder.set_depth(BitDepth::Eight);
        let software = format!("piola {}", env!("CARGO_PKG_VERSION"));
        encoder.add_text_chunk("Software".into(), software)?;
        let mut writer = encoder.write_header()?;
        // Everything is painted over opaque white, so that no pixel is transparent.
        let colours = self.pixmap.pixels().iter();
        let bytes: Vec<u8> =
            colours.flat_map(|pixel| [pixel.red(), pixel.green(), pixel.blue()]).collect();
        writer.write_image_data(&bytes)?;
        writer.finish()?;
        Ok(())
    }

    fn fill_path(&mut self, path: Option<tiny_skia::Path>, colour: Colour, turn: Transform) {
        if let Some(path) = path {
            self.pixmap.fill_path(&path, &paint(colour, 255), FillRule::Winding, turn, None);
        }
    }
}

fn paint([red, green, blue]: Colour, opacity: u8) -> Paint<'static> {
    let mut paint = Paint::default();
    paint.set_color_rgba8(red, green, blue, opacity);
    paint.anti_alias = true;
    paint
}

fn blend(below: PremultipliedColorU8, colour: [f32; 3], cover: f32) -> PremultipliedColorU8 {
    let mix =
        |below: u8, above: f32| (f32::from(below) * (1.0 - cover) + above * cover).round() as u8;
    let [red, green, blue] = colour;
    let (red, green, blue) =
        (mix(below.red(), red), mix(below.green(), green), mix(below.blue(), blue));
    PremultipliedColorU8::from_rgba(red, green, blue, 255).expect("no part exceeds an opaque whole")
}
