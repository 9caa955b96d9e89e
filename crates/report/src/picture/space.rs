//! Particles in space: shaded spheres in parallel projection, drawn from far to near, inside a box
//! with ticks on three of its edges. The reader stands at azimuth -60 degrees (from x towards y)
//! and 25 degrees above the horizon, z upwards.

use super::super::drawing::canvas::{Anchor, Canvas, FAINT, INK, Pen};
use super::super::drawing::colour_bar::ColourBar;
use super::super::drawing::ticks::{self, Ticks};
use super::super::drawing::{Area, GAP, LARGE, LINE, SMALL, TICK, font};
use super::{Bounds, LONG, Picture, colour, dot_radius};

/// How much darker the rim of a sphere is than its middle, if it is small and if it is large:
/// many dark rims of small ones would darken all.
const SHADE: [f32; 2] = [0.25, 0.45];
/// Largest size of the projected box.
const WIDTH: f32 = LONG - 330.0;
const HEIGHT: f32 = LONG - 170.0;
/// Height of the colour bar at least.
const LEAST_HEIGHT: f32 = 300.0;

pub fn draw(picture: &Picture) -> Canvas {
    let (region, spacing) = picture.region();
    let (mut view, (width, height)) = Projection::filling(&region);
    let room = Room::around(&edges(&view, &region), width, height);
    let bar_height = height.max(LEAST_HEIGHT).round();
    let bar = ColourBar::upright(picture.value_range(), bar_height, picture.label, picture.unit);

    let inside =
        |at: &[f64]| (0..3).all(|axis| (region.min[axis]..=region.max[axis]).contains(&at[axis]));
    let head = picture.head(picture.particles().filter(|(at, _)| !inside(at)).count());
    let bar_left = room.left + width + room.right;
    let total_width = bar_left + bar.room_beside() + GAP;
    let top = head.height(total_width).round();
    // A flat box stands in the middle of the bar's height.
    let above = 0.5 * (bar_height - height);
    let total_height = top + (above + height + room.below).max(bar_height) + GAP;
    view.origin.0 += f64::from(room.left);
    view.origin.1 += f64::from(top + above);

    let mut canvas = Canvas::new(total_width, total_height);
    head.draw(&mut canvas, total_width);
    draw_box(&mut canvas, &view, &region);
    draw_spheres(&mut canvas, picture, &view, &bar, spacing, inside);
    for edge in edges(&view, &region) {
        edge.draw(&mut canvas);
    }
    let beside = Area { left: bar_left.round(), top, width: 0.0, height: bar_height };
    bar.draw_beside(&mut canvas, beside);
    canvas
}

/// The direction of view: x goes mostly to the right and y mostly into the picture.
struct Projection {
    right: [f64; 3],
    up: [f64; 3],
    /// Towards the reader.
    near: [f64; 3],
    /// Pixels a metre across the direction of view.
    scale: f64,
    /// Pixel of the projected origin.
    origin: (f64, f64),
}

impl Projection {
    const AZIMUTH: f64 = -60.0;
    const ELEVATION: f64 = 25.0;

    /// The projection that fills `WIDTH` by `HEIGHT` with `region`, its left upper corner at the
    /// origin of pixels, and the size that is really used.
    fn filling(region: &Bounds) -> (Self, (f32, f32)) {
        let (sin, cos) = Self::AZIMUTH.to_radians().sin_cos();
        let (rise, run) = Self::ELEVATION.to_radians().sin_cos();
        let (right, up) = ([-sin, cos, 0.0], [-rise * cos, -rise * sin, run]);
        let extent = |direction: [f64; 3]| {
            let along =
                [0, 1, 2, 3, 4, 5, 6, 7].map(|number| dot(direction, corner(region, number)));
            ticks::range_of(along.into_iter())
        };
        let ([left, far_right], [bottom, top]) = (extent(right), extent(up));
        let (width, height) = (far_right - left, top - bottom);
        let scale = (f64::from(WIDTH) / width).min(f64::from(HEIGHT) / height);
        let near = [run * cos, run * sin, rise];
        let view = Self { right, up, near, scale, origin: (-left * scale, top * scale) };
        (view, ((width * scale) as f32, (height * scale) as f32))
    }

    fn at(&self, point: [f64; 3]) -> (f32, f32) {
        let (x, y) = (dot(self.right, point), dot(self.up, point));
        ((self.origin.0 + self.scale * x) as f32, (self.origin.1 - self.scale * y) as f32)
    }
}

fn dot(one: [f64; 3], two: [f64; 3]) -> f64 {
    one[0] * two[0] + one[1] * two[1] + one[2] * two[2]
}

/// The corner that takes the largest coordinate along the axes whose bit is set in `number`: 1 for
/// x, 2 for y, 4 for z.
fn corner(region: &Bounds, number: usize) -> [f64; 3] {
    [0, 1, 2].map(|axis| if number >> axis & 1 == 1 { region.max[axis] } else { region.min[axis] })
}

/// An edge of the box that carries an axis.
struct Edge {
    ends: [(f32, f32); 2],
    ticks: Vec<((f32, f32), String)>,
    label: String,
    /// Direction of ticks and labels.
    away: (f32, f32),
    /// Which point of a tick's label stands at its end.
    anchor: Anchor,
    /// Middle of the label.
    label_at: (f32, f32),
    upright: bool,
}

/// The lower left edge (x), the lower right edge (y) and the left edge (z).
fn edges(view: &Projection, region: &Bounds) -> [Edge; 3] {
    [
        ("x", 0, Anchor(1.0, 0.0), (-0.5, 0.85)),
        ("y", 1, Anchor(0.0, 0.3), (0.95, 0.3)),
        ("z", 0, Anchor(1.0, 0.5), (-1.0, 0.0)),
    ]
    .map(|(name, from, anchor, away)| {
        let axis = ["x", "y", "z"].iter().position(|&other| other == name).unwrap_or(0);
        let point = |value: f64| {
            let mut point = corner(region, from);
            point[axis] = value;
            view.at(point)
        };
        let range = [region.min[axis], region.max[axis]];
        let ends = range.map(point);
        let length = (ends[1].0 - ends[0].0).hypot(ends[1].1 - ends[0].1);
        let ticks = Ticks::new(range, ((length / (3.5 * SMALL)) as usize).clamp(2, 9));
        let label = ticks::label(name, "m", ticks.exponent);
        let far = TICK + 0.6 * GAP + ticks.widest() + GAP;
        let (upright, half) = (axis == 2, font::width(&label, LARGE) / 2.0);
        let middle = ((ends[0].0 + ends[1].0) / 2.0, (ends[0].1 + ends[1].1) / 2.0);
        let (x, y) = moved(middle, away, far);
        let label_at = match axis {
            2 => (x - LARGE / 2.0, y),
            _ => (x + half * away.0.signum(), y + LARGE / 2.0),
        };
        let apart = length / ((range[1] - range[0]) / step(&ticks)) as f32;
        // On a short edge the labels of neighbouring ticks would touch.
        let every = if apart < 0.9 * SMALL { ticks.values.len().max(1) } else { 1 };
        let at = ticks.values.iter().map(|&value| point(value));
        let ticks = at.zip(ticks.labels.iter().cloned()).step_by(every).collect();
        Edge { ends, ticks, label, away, anchor, label_at, upright }
    })
}

fn step(ticks: &Ticks) -> f64 {
    ticks.values.windows(2).map(|pair| pair[1] - pair[0]).next().unwrap_or(f64::INFINITY)
}

fn moved((x, y): (f32, f32), direction: (f32, f32), far: f32) -> (f32, f32) {
    (x + far * direction.0, y + far * direction.1)
}

impl Edge {
    fn draw(&self, canvas: &mut Canvas) {
        let pen = Pen::new(LINE, INK);
        canvas.line(&self.ends, &pen);
        for (at, text) in &self.ticks {
            canvas.line(&[*at, moved(*at, self.away, TICK)], &pen);
            canvas.text(text, SMALL, moved(*at, self.away, TICK + 0.6 * GAP), self.anchor);
        }
        match self.upright {
            true => canvas.upright_text(&self.label, LARGE, self.label_at),
            false => canvas.text(&self.label, LARGE, self.label_at, Anchor(0.5, 0.5)),
        }
    }
}

/// Room that ticks and labels take around the box.
struct Room {
    left: f32,
    right: f32,
    below: f32,
}

impl Room {
    fn around(edges: &[Edge; 3], width: f32, height: f32) -> Self {
        // Room for usual labels at least, so that the frames of a series are equally large.
        let mut room = Self { left: 110.0, right: 30.0, below: 50.0 };
        for edge in edges {
            let half = match edge.upright {
                true => LARGE,
                false => font::width(&edge.label, LARGE) / 2.0,
            };
            room.include(edge.label_at, half, width, height);
            for (at, text) in &edge.ticks {
                let (x, y) = moved(*at, edge.away, TICK + 0.6 * GAP);
                let half = font::width(text, SMALL) / 2.0;
                let middle = x + (1.0 - 2.0 * edge.anchor.0) * half;
                room.include((middle, y + SMALL / 2.0), half, width, height);
            }
        }
        room
    }

    /// Makes room for a text of `half` width around `(x, y)`.
    fn include(&mut self, (x, y): (f32, f32), half: f32, width: f32, height: f32) {
        self.left = self.left.max(half - x + GAP);
        self.right = self.right.max(x + half - width);
        self.below = self.below.max(y + LARGE / 2.0 - height + GAP);
    }
}

/// The edges of the three faces behind the particles.
fn draw_box(canvas: &mut Canvas, view: &Projection, region: &Bounds) {
    let pen = Pen::new(1.5, FAINT);
    // They meet in corner 2: x least, y largest, z least.
    for (from, to) in [(2, 3), (2, 0), (2, 6), (6, 4), (6, 7), (7, 3), (4, 0), (0, 1), (3, 1)] {
        let ends = [from, to].map(|number| view.at(corner(region, number)));
        canvas.line(&ends, &pen);
    }
}

fn draw_spheres(
    canvas: &mut Canvas,
    picture: &Picture,
    view: &Projection,
    bar: &ColourBar,
    spacing: f64,
    inside: impl Fn(&[f64]) -> bool,
) {
    let mut spheres: Vec<(f64, (f32, f32), f64, f64)> = picture
        .dots()
        .filter(|(at, ..)| inside(at))
        .map(|(at, value, width)| {
            let at = [at[0], at[1], at[2]];
            (dot(view.near, at), view.at(at), value, width)
        })
        .collect();
    // A stable sort: particles at one depth keep their order.
    spheres.sort_by(|one, two| one.0.total_cmp(&two.0));
    for (_, at, value, width) in spheres {
        let radius = dot_radius((spacing * width * view.scale) as f32);
        let shade = SHADE[0] + (SHADE[1] - SHADE[0]) * ((radius - 3.0) / 5.0).clamp(0.0, 1.0);
        canvas.dot(at, radius, colour(bar, value), shade, Area::ALL);
    }
}
