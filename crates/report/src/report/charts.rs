//! Curves against time or along lines as SVG inside the page, in the colours of its style.
//!
//! The drawing stands without a script; with one, the page reads values under the pointer from
//! the points of the curves and the ranges noted on each panel.

use std::fmt::Write;

use maud::{Markup, html};

use super::Chart;
use crate::drawing::ticks::{self, Ticks};
use crate::plot::{self, Series, Style};

const WIDTH: f64 = 540.0;
const LEFT: f64 = 70.0;
const RIGHT: f64 = 20.0;
const TOP: f64 = 10.0;
const BELOW: f64 = 44.0;
const HEIGHT: f64 = 190.0;
/// Columns into which a curve is thinned.
const INSIDE: f64 = WIDTH - LEFT - RIGHT;
/// Colours of the style before they repeat with dashes.
const COLOURS: usize = 7;
/// Rings of one reference.
const MAX_MARKS: usize = 400;

/// The chart with its heading and legend, one drawing for each unit.
pub fn chart(chart: &Chart) -> Markup {
    let panels = plot::by_unit(&chart.series);
    let all = chart.series.iter().flat_map(|series| &series.points);
    let x = ticks::usable_range(ticks::range_of(all.map(|point| point[0])));
    html! {
        figure .chart {
            figcaption { (chart.title) }
            @for panel in &panels {
                (legend(panel))
                (drawing(chart, panel, x))
            }
            @for source in &chart.sources {
                p .source { (source) }
            }
        }
    }
}

fn class(number: usize, style: Style) -> String {
    let dashes = match (style, number / COLOURS) {
        (Style::Line | Style::Marks, 0) => "",
        (_, 0 | 1) => " dashed",
        _ => " dotted",
    };
    let kind = if style.is_line() { "line" } else { "marks" };
    format!("{kind} c{}{dashes}", number % COLOURS)
}

/// Curves and references are numbered apart: a reference has the colour of the curve it is for.
fn numbers(panel: &[&Series]) -> Vec<usize> {
    let mut lines = 0_usize;
    let number = |series: &&Series| match series.style {
        Style::Line | Style::Dashes => {
            lines += 1;
            lines - 1
        }
        Style::Marks => lines.saturating_sub(1),
    };
    panel.iter().map(number).collect()
}

fn legend(panel: &[&Series]) -> Markup {
    html! {
        ul .legend {
            @for (series, number) in panel.iter().zip(numbers(panel)) {
                li {
                    svg viewBox="0 0 26 10" aria-hidden="true" {
                        @if series.style.is_line() {
                            path .(class(number, series.style)) d="M1 5H25" {}
                        } @else {
                            path .(class(number, series.style).replace("marks", "reference")) d="M1 5H25" {}
                            circle .(class(number, series.style)) cx="13" cy="5" r="3.6" {}
                        }
                    }
                    (series.column.name)
                }
            }
        }
    }
}

fn drawing(chart: &Chart, panel: &[&Series], x: [f64; 2]) -> Markup {
    let Chart { title, across: abscissa, .. } = chart;
    let y = plot::ordinates(panel);
    let unit = panel.first().map_or("", |series| &series.column.unit);
    let (across, up) = (Ticks::new(x, 7), Ticks::new(y, 6));
    let at_x = |value: f64| LEFT + (value - x[0]) / (x[1] - x[0]) * INSIDE;
    let at_y = |value: f64| TOP + (y[1] - value) / (y[1] - y[0]) * HEIGHT;
    let (right, bottom) = (WIDTH - RIGHT, TOP + HEIGHT);
    let y_label = ticks::label(&plot::common_name(panel), unit, up.exponent);
    html! {
        svg .panel viewBox=(format!("0 0 {WIDTH} {}", bottom + BELOW)) role="img"
            aria-label=(format!("{title}: {y_label} against {}", abscissa.name))
            data-x-name=(abscissa.name) data-x-unit=(abscissa.unit)
            data-x0=(x[0]) data-x1=(x[1]) data-y0=(y[0]) data-y1=(y[1]) data-unit=(unit)
            data-left=(LEFT) data-right=(right) data-top=(TOP) data-bottom=(bottom)
        {
            @for (value, label) in up.values.iter().zip(&up.labels) {
                @let y = fixed(at_y(*value));
                path .grid d=(format!("M{LEFT} {y}H{right}")) {}
                text .tick.end x=(LEFT - 7.0) y=(y) dy="0.35em" { (label) }
            }
            @for (value, label) in across.values.iter().zip(&across.labels) {
                @let x = fixed(at_x(*value));
                path .grid d=(format!("M{x} {TOP}V{bottom}")) {}
                text .tick.middle x=(x) y=(bottom + 17.0) { (label) }
            }
            path .frame d=(format!("M{LEFT} {TOP}V{bottom}H{right}")) {}
            text .axis.middle x=((LEFT + right) / 2.0) y=(bottom + 37.0) {
                (ticks::label(&abscissa.name, &abscissa.unit, across.exponent))
            }
            text .axis.middle transform=(format!("translate(13 {}) rotate(-90)", TOP + HEIGHT / 2.0)) {
                (y_label)
            }
            @for (series, number) in panel.iter().zip(numbers(panel)) {
                @let points = points(series, &at_x, &at_y);
                @let class = class(number, series.style);
                g .curve data-name=(series.column.name) {
                    @match series.style {
                        Style::Line | Style::Dashes => { path .(class) d=(line(&points)) {} }
                        Style::Marks => {
                            path .(class.replace("marks", "reference")) d=(line(&points)) {}
                            path .(class) d=(rings(&points)) {}
                        }
                    }
                }
            }
        }
    }
}

/// The points of a curve in the drawing, no more than it can show; those that are not finite are
/// kept and break the line.
fn points(
    series: &Series,
    at_x: &impl Fn(f64) -> f64,
    at_y: &impl Fn(f64) -> f64,
) -> Vec<(f32, f32)> {
    let points = series.points.iter().map(|&[x, y]| (at_x(x) as f32, at_y(y) as f32));
    match series.style {
        Style::Line | Style::Dashes => plot::thinned(points),
        Style::Marks => {
            let step = series.points.len().div_ceil(MAX_MARKS).max(1);
            points.step_by(step).filter(|(x, y)| x.is_finite() && y.is_finite()).collect()
        }
    }
}

fn fixed(value: f64) -> String {
    format!("{value:.2}")
}

fn line(points: &[(f32, f32)]) -> String {
    let mut path = String::new();
    let mut pen = 'M';
    for (x, y) in points {
        if !x.is_finite() || !y.is_finite() {
            pen = 'M';
            continue;
        }
        // Writing into a String cannot fail.
        let _ = write!(path, "{pen}{x:.2} {y:.2}");
        pen = 'L';
    }
    path
}

/// A ring around each point, all in one path.
fn rings(points: &[(f32, f32)]) -> String {
    let mut path = String::new();
    for (x, y) in points {
        let _ = write!(path, "M{:.2} {y:.2}a3.4 3.4 0 1 0 6.8 0a3.4 3.4 0 1 0 -6.8 0", x - 3.4);
    }
    path
}
