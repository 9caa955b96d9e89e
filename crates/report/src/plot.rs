//! Line charts as PNG: curves against one abscissa, one panel for each unit, with reference points
//! over them if there are any.

mod legend;

use std::path::Path;

use super::drawing::axes::{self, Axis, Frame, ROOM_BELOW};
use super::drawing::canvas::{Canvas, Colour, INK, Pen, WHITE};
use super::drawing::colours::CURVES;
use super::drawing::{Area, GAP, LINE, ticks};
use super::head::Head;
use super::{Column, OutputError, Table, atomic};
use legend::Legend;

const WIDTH: f32 = 1200.0;
/// Distance between panels.
const BETWEEN: f32 = 3.0 * GAP;
/// Radius of marks.
const MARK: f32 = 6.0;

/// How points are drawn.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Style {
    /// Joined by a line, which breaks at points that are not finite.
    #[default]
    Line,
    /// The same with dashes, for what is compared with a line and may lie on it.
    Dashes,
    /// As rings, for references.
    Marks,
}

impl Style {
    /// Whether points are joined.
    pub fn is_line(self) -> bool {
        self != Self::Marks
    }
}

/// One curve.
#[derive(Clone, Debug, PartialEq)]
pub struct Series {
    /// Its name in the legend, and its unit. Curves of one unit share a panel.
    pub column: Column,
    /// Abscissa and ordinate of its points, in order.
    pub points: Vec<[f64; 2]>,
    /// How they are drawn.
    pub style: Style,
}

impl Series {
    /// The column called `name` of `table` against its first column; `None` if it has no such
    /// column.
    pub fn of_table(table: &Table, name: &str) -> Option<Self> {
        let index = table.index(name)?;
        let points = table.rows().map(|row| [row[0], row[index]]).collect();
        Some(Self { column: table.columns()[index].clone(), points, style: Style::Line })
    }
}

/// A chart of curves against one abscissa.
#[derive(Clone, Debug, PartialEq)]
pub struct Plot {
    /// Stands above; long ones are wrapped and at last cut.
    pub title: String,
    /// Name and unit of the abscissa.
    pub abscissa: Column,
    /// The curves, in the order of their legend.
    pub series: Vec<Series>,
}

/// A curve with its looks.
struct Styled<'a> {
    series: &'a Series,
    pen: Pen,
}

impl Plot {
    /// Draws the chart and writes it to the file `path`, and returns its length in bytes. Numbers
    /// that are not finite are left out.
    ///
    /// # Errors
    /// The file cannot be written.
    pub fn write_png(&self, path: &Path) -> Result<u64, OutputError> {
        let canvas = self.draw();
        atomic::write_file(path, |out| canvas.write_png(out))
    }

    fn draw(&self) -> Canvas {
        let panels = self.panels();
        let count = panels.len() as f32;
        let panel_height = (700.0 / count).clamp(240.0, 560.0).round();
        let all = || self.series.iter().flat_map(|series| &series.points);
        let x = ticks::usable_range(ticks::range_of(all().map(|point| point[0])));
        let y_axes: Vec<(Axis, [f64; 2])> =
            panels.iter().map(|panel| y_axis(panel, panel_height)).collect();

        let head = Head::new(&self.title, Vec::new());
        let rooms = y_axes.iter().map(|(axis, _)| axis.room_beside());
        let left = (GAP + rooms.fold(0.0, f32::max)).round();
        let width = (WIDTH - left - 3.0 * GAP).round();
        let x_axis = Axis::horizontal(x, width, &self.abscissa.name, &self.abscissa.unit);
        let legends: Vec<Legend> = panels.iter().map(|panel| Legend::new(panel, width)).collect();

        let above: f32 = legends.iter().map(|legend| legend.height().round()).sum();
        let heights = count * (panel_height + BETWEEN) - BETWEEN + above;
        let mut top = head.height(WIDTH).round();
        let mut canvas = Canvas::new(WIDTH, top + heights + ROOM_BELOW + 1.5 * GAP);
        head.draw(&mut canvas, WIDTH);
        for (number, (panel, (y_axis, y))) in panels.iter().zip(&y_axes).enumerate() {
            let legend = &legends[number];
            let below = top + legend.height().round();
            let area = Area { left, top: below, width, height: panel_height };
            let frame = Frame { area, x, y: *y };
            legend.draw(&mut canvas, panel, area, top);
            axes::draw_grid(&mut canvas, &frame, &x_axis, y_axis);
            draw_curves(&mut canvas, &frame, panel);
            let last = number + 1 == panels.len();
            axes::draw(&mut canvas, &frame, last.then_some(&x_axis), y_axis);
            top = area.bottom() + BETWEEN;
        }
        canvas
    }

    /// The curves by unit, each with its looks; one empty panel if there is no curve.
    fn panels(&self) -> Vec<Vec<Styled<'_>>> {
        let styled = |series| Styled { series, pen: Pen::new(LINE, INK) };
        let panels = by_unit(&self.series).into_iter();
        let mut panels: Vec<Vec<Styled>> =
            panels.map(|panel| panel.into_iter().map(styled).collect()).collect();
        for panel in &mut panels {
            for lines in [true, false] {
                let alike = panel.iter_mut().filter(|it| it.series.style.is_line() == lines);
                for (number, styled) in alike.enumerate() {
                    styled.pen = pen(styled.series.style, number);
                }
            }
        }
        if panels.is_empty() {
            panels.push(Vec::new());
        }
        panels
    }
}

/// The curves by unit, in the order in which the units appear.
pub(super) fn by_unit(series: &[Series]) -> Vec<Vec<&Series>> {
    let mut panels: Vec<Vec<&Series>> = Vec::new();
    for one in series {
        let same = |panel: &&mut Vec<&Series>| panel[0].column.unit == one.column.unit;
        match panels.iter_mut().find(same) {
            Some(panel) => panel.push(one),
            None => panels.push(vec![one]),
        }
    }
    panels
}

/// The looks of the curve `number` of lines or of marks: lines take the colours from the first on and then
/// dashes, marks take them from the last, black, backwards.
fn pen(style: Style, number: usize) -> Pen {
    let colours = CURVES.len();
    match style {
        Style::Marks => Pen::new(LINE, CURVES[colours - 1 - number % colours]),
        Style::Line | Style::Dashes => {
            let dashes = match (style, number / colours) {
                (Style::Line, 0) => Vec::new(),
                (_, 0 | 1) => vec![14.0, 6.0],
                _ => vec![4.0, 5.0],
            };
            Pen { width: 2.6, colour: CURVES[number % colours], dashes }
        }
    }
}

/// Axis and range of the ordinates of `panel`.
fn y_axis(panel: &[Styled], height: f32) -> (Axis, [f64; 2]) {
    let panel: Vec<&Series> = panel.iter().map(|styled| styled.series).collect();
    let y = ordinates(&panel);
    let unit = panel.first().map_or("", |series| &series.column.unit);
    (Axis::vertical(y, height, &common_name(&panel), unit), y)
}

/// The range of the ordinates of `panel`, and a little around it.
pub(super) fn ordinates(panel: &[&Series]) -> [f64; 2] {
    let all = panel.iter().flat_map(|series| &series.points);
    let drawn = all.filter(|point| point[0].is_finite());
    let [low, high] = ticks::usable_range(ticks::range_of(drawn.map(|point| point[1])));
    let around = 0.05 * (high - low);
    [low - around, high + around]
}

/// What the names of `panel` have in common: `displacement.y` of `top.displacement.y` and
/// `tip.displacement.y`, `energy` of `energy.kinetic` and `energy.strain`. References over curves
/// may be called anything, and of members of a sweep or variants a value or a name stands in front.
pub(super) fn common_name(panel: &[&Series]) -> String {
    let only_marks = !panel.iter().any(|series| series.style.is_line());
    let counted = || panel.iter().filter(|series| only_marks || series.style.is_line());
    let bare = |name: &'_ str| name.rfind(": ").map_or(0, |end| end + 2);
    let names = || {
        counted().map(|series| {
            let name = &series.column.name;
            name[bare(name)..].split('.')
        })
    };
    let mut end = common_start(names().map(Iterator::rev));
    end.reverse();
    if end.is_empty() { common_start(names()).join(".") } else { end.join(".") }
}

/// The parts with which all of `names` begin.
fn common_start<'a>(
    mut names: impl Iterator<Item = impl Iterator<Item = &'a str>>,
) -> Vec<&'a str> {
    let mut common: Vec<&str> = names.next().map_or(Vec::new(), Iterator::collect);
    for name in names {
        let same = common.iter().zip(name).take_while(|(one, two)| *one == two).count();
        common.truncate(same);
    }
    common
}

fn draw_curves(canvas: &mut Canvas, frame: &Frame, panel: &[Styled]) {
    for Styled { series, pen } in panel {
        let points = series.points.iter().map(|&[x, y]| frame.at(x, y));
        match series.style {
            Style::Line | Style::Dashes => {
                let points = thinned(points);
                canvas.line(&points, pen);
                // A single point makes no line.
                if let [point] = points[..] {
                    canvas.dot(point, pen.width, pen.colour, 0.0, Area::ALL);
                }
            }
            Style::Marks => {
                for point in points {
                    ring(canvas, point, pen.colour);
                }
            }
        }
    }
}

/// A ring around `at`.
fn ring(canvas: &mut Canvas, at: (f32, f32), colour: Colour) {
    canvas.dot(at, MARK, colour, 0.0, Area::ALL);
    canvas.dot(at, MARK - 2.2, WHITE, 0.0, Area::ALL);
}

/// The same line with four points at most in each column of pixels: first, lowest, highest, last.
/// A point that is not finite is kept, as it breaks the line.
pub(super) fn thinned(points: impl Iterator<Item = (f32, f32)>) -> Vec<(f32, f32)> {
    let mut kept: Vec<(f32, f32)> = Vec::new();
    let mut column: Vec<(f32, f32)> = Vec::new();
    let flush = |column: &mut Vec<(f32, f32)>, kept: &mut Vec<(f32, f32)>| {
        if column.len() > 4 {
            let ends = [column[0], column[column.len() - 1]];
            let by_height = |one: &&(f32, f32), two: &&(f32, f32)| one.1.total_cmp(&two.1);
            kept.push(ends[0]);
            kept.extend(column.iter().min_by(by_height));
            kept.extend(column.iter().max_by(by_height));
            kept.push(ends[1]);
        } else {
            kept.extend_from_slice(column);
        }
        column.clear();
    };
    for point in points {
        let finite = point.0.is_finite() && point.1.is_finite();
        if column.first().is_some_and(|first| !finite || first.0.floor() != point.0.floor()) {
            flush(&mut column, &mut kept);
        }
        if finite { column.push(point) } else { kept.push((f32::NAN, f32::NAN)) }
    }
    flush(&mut column, &mut kept);
    kept
}
