//! PNG files decoded, and what is seen in them.

use std::fs::File;
use std::io::BufReader;
use std::path::Path;

pub type Colour = [u8; 3];

/// Of frames and text.
const INK: Colour = [38; 3];

pub struct Image {
    pub width: usize,
    pub height: usize,
    pixels: Vec<Colour>,
}

/// Middle and number of some pixels.
#[derive(Clone, Copy, Debug)]
pub struct Spot {
    pub x: f64,
    pub y: f64,
    pub pixels: usize,
}

impl Image {
    pub fn read(path: &Path) -> Self {
        let decoder = png::Decoder::new(BufReader::new(File::open(path).unwrap()));
        let mut reader = decoder.read_info().unwrap();
        let mut bytes = vec![0; reader.output_buffer_size().unwrap()];
        let info = reader.next_frame(&mut bytes).unwrap();
        assert_eq!((info.color_type, info.bit_depth), (png::ColorType::Rgb, png::BitDepth::Eight));
        let pixels = bytes.chunks_exact(3).map(|part| [part[0], part[1], part[2]]).collect();
        Self { width: info.width as usize, height: info.height as usize, pixels }
    }

    pub fn at(&self, x: usize, y: usize) -> Colour {
        self.pixels[y * self.width + x]
    }

    /// Where pixels of `colour` (to a few parts in 255) are in columns `from..to`.
    pub fn spot(&self, colour: Colour, from: usize, to: usize) -> Option<Spot> {
        let (mut x_sum, mut y_sum, mut pixels) = (0.0, 0.0, 0);
        for y in 0..self.height {
            for x in (from..to).filter(|&x| near(self.at(x, y), colour)) {
                (x_sum, y_sum, pixels) =
                    (x_sum + x as f64 + 0.5, y_sum + y as f64 + 0.5, pixels + 1);
            }
        }
        let count = pixels as f64;
        (pixels > 0).then(|| Spot { x: x_sum / count, y: y_sum / count, pixels })
    }

    /// Columns where long upright lines of frames start: left, right of the first frame, of the
    /// second.
    pub fn upright_lines(&self, at_least: usize) -> Vec<usize> {
        let long = |x: usize| longest((0..self.height).map(|y| self.at(x, y))) >= at_least;
        starts((0..self.width).map(long))
    }

    /// Rows where long level lines of frames start.
    pub fn level_lines(&self, at_least: usize) -> Vec<usize> {
        let long = |y: usize| longest((0..self.width).map(|x| self.at(x, y))) >= at_least;
        starts((0..self.height).map(long))
    }
}

pub fn near(one: Colour, two: Colour) -> bool {
    one.iter().zip(two).all(|(one, two)| one.abs_diff(two) <= 5)
}

/// Length of the longest run of ink.
fn longest(colours: impl Iterator<Item = Colour>) -> usize {
    let (mut longest, mut run) = (0, 0);
    for colour in colours {
        run = if near(colour, INK) { run + 1 } else { 0 };
        longest = longest.max(run);
    }
    longest
}

/// Where runs of `true` start.
fn starts(values: impl Iterator<Item = bool>) -> Vec<usize> {
    let mut before = false;
    let mut starts = Vec::new();
    for (place, value) in values.enumerate() {
        if value && !before {
            starts.push(place);
        }
        before = value;
    }
    starts
}
