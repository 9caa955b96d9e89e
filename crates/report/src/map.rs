//! Maps as PNG: the values along a line at many times, in colours over place and time.

use std::path::Path;

use super::drawing::axes::{self, Axis, Frame, ROOM_BELOW};
use super::drawing::canvas::{Canvas, MAGENTA};
use super::drawing::colour_bar::ColourBar;
use super::drawing::{Area, GAP, ticks};
use super::head::Head;
use super::{Column, OutputError, atomic};

/// Size of a picture in pixels, about.
const SIZE: (f32, f32) = (1200.0, 900.0);

/// Values over place and time.
#[derive(Clone, Copy, Debug)]
pub struct Map<'a> {
    /// Stands above; long ones are wrapped and at last cut.
    pub title: &'a str,
    /// What the values are.
    pub column: &'a Column,
    /// Distances from the start of the line in m, ascending.
    pub distances: &'a [f64],
    /// Times in s, ascending.
    pub times: &'a [f64],
    /// One row of all places for each time. Values that are not finite are drawn in magenta.
    pub values: &'a [f64],
}

impl Map<'_> {
    /// Draws the map, each place of it in the colour of the nearest value, and writes it to the file
    /// `path`. Returns its length in bytes.
    ///
    /// # Errors
    /// The file cannot be written, or there is not one value for each place and time.
    pub fn write_png(&self, path: &Path) -> Result<u64, OutputError> {
        let (expected, got) = (self.distances.len() * self.times.len(), self.values.len());
        if expected != got || got == 0 {
            let what = "the values over place and time".into();
            return Err(OutputError::WrongLength { path: path.into(), what, expected, got });
        }
        let canvas = self.draw();
        atomic::write_file(path, |out| canvas.write_png(out))
    }

    fn draw(&self) -> Canvas {
        let x = ticks::usable_range([self.distances[0], self.distances[self.distances.len() - 1]]);
        let y = ticks::usable_range([self.times[0], self.times[self.times.len() - 1]]);
        let range = ticks::usable_range(ticks::range_of(self.values.iter().copied()));
        let head = Head::new(self.title, Vec::new());
        let top = head.height(SIZE.0).round();
        let height = (SIZE.1 - top - ROOM_BELOW - 1.5 * GAP).round();
        let bar = ColourBar::upright(range, height, &self.column.name, &self.column.unit);
        let y_axis = Axis::vertical(y, height, "time", "s");
        let left = (GAP + y_axis.room_beside()).round();
        let width = (SIZE.0 - left - bar.room_beside() - GAP).round();
        let x_axis = Axis::horizontal(x, width, "distance", "m");
        let area = Area { left, top, width, height };
        let frame = Frame { area, x, y };

        let mut canvas = Canvas::new(SIZE.0, SIZE.1);
        head.draw(&mut canvas, SIZE.0);
        let columns = nearest(self.distances, x, width as usize);
        let rows = nearest(self.times, y, height as usize);
        for (row, &time) in rows.iter().enumerate() {
            let values = &self.values[time * self.distances.len()..][..self.distances.len()];
            let mut first = 0;
            while first < columns.len() {
                let place = columns[first];
                let count = columns[first..].iter().take_while(|other| **other == place).count();
                let value = values[place];
                let colour = if value.is_finite() { bar.colour(value) } else { MAGENTA };
                let pixels = Area {
                    left: left + first as f32,
                    top: area.bottom() - 1.0 - row as f32,
                    width: count as f32,
                    height: 1.0,
                };
                canvas.fill(pixels, colour, 255);
                first += count;
            }
        }
        axes::draw(&mut canvas, &frame, Some(&x_axis), &y_axis);
        bar.draw_beside(&mut canvas, area);
        canvas
    }
}

/// For each of `count` pixels along `range` the number of the nearest of `values`, which ascend.
fn nearest(values: &[f64], [low, high]: [f64; 2], count: usize) -> Vec<usize> {
    let of_pixel = |pixel: usize| {
        let at = low + (pixel as f64 + 0.5) / count as f64 * (high - low);
        let next = values.partition_point(|value| *value < at).min(values.len() - 1);
        let before = next.saturating_sub(1);
        if at - values[before] < values[next] - at { before } else { next }
    };
    (0..count).map(of_pixel).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn pixels_take_the_nearest_value() {
        assert_eq!(nearest(&[0.0, 1.0, 4.0], [0.0, 4.0], 8), [0, 1, 1, 1, 1, 2, 2, 2]);
        assert_eq!(nearest(&[3.0], [2.0, 4.0], 3), [0, 0, 0]);
    }

    #[test]
    fn a_map_needs_a_value_for_each_place_and_time() {
        let column = Column::new("line.stress.xx", "Pa");
        let map = Map {
            title: "t",
            column: &column,
            distances: &[0.0, 1.0],
            times: &[0.0],
            values: &[1.0],
        };
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("map.png");
        assert!(matches!(map.write_png(&path), Err(OutputError::WrongLength { .. })));
        let whole = Map { values: &[1.0, f64::NAN], ..map };
        assert!(whole.write_png(&path).unwrap() > 1000);
        assert!(Map { distances: &[], times: &[], values: &[], ..map }.write_png(&path).is_err());
    }
}
