//! Outlines of drawings.

use kurbo::{Arc, BezPath, PathEl, Point, Shape, SvgArc, Vec2};
use roxmltree::{Document, Node};
use svgtypes::{PathParser, PathSegment};

use super::Fault;
use crate::Vector;

/// How far a curve may be from its sides, as a part of the size of the outline.
const FLATNESS: f64 = 1e-4;
/// The same of an arc and the cubic curves that it is made of first, as a part of its radius.
const ARC: f64 = 1e-6;
/// Coordinates of which all powers that curves need are finite.
const FURTHEST: f64 = 1e30;

/// The loops of the paths and polygons of an SVG.
pub(super) fn loops(bytes: &[u8]) -> Result<Vec<Vec<Vector<2>>>, Fault> {
    let text = std::str::from_utf8(bytes).map_err(|_| (None, "it is not text".to_owned()))?;
    let document = Document::parse(text)
        .map_err(|error| (Some(u64::from(error.pos().row)), error.to_string()))?;
    let mut all = BezPath::new();
    for node in document.descendants().filter(Node::is_element) {
        let line = Some(u64::from(document.text_pos_at(node.range().start).row));
        let name = node.tag_name().name();
        if node.attribute("transform").is_some() {
            let reason = format!(
                "`transform` of <{name}> is not supported: apply transforms before the export"
            );
            return Err((line, reason));
        }
        let of = |key: &str| node.attribute(key).unwrap_or_default();
        let read = match name {
            "path" => path(of("d")),
            "polygon" => path(&format!("M{}Z", of("points"))),
            "rect" | "circle" | "ellipse" | "line" | "polyline" | "text" | "image" | "use" => {
                let reason = format!(
                    "<{name}> is not supported: convert objects to paths before the export"
                );
                return Err((line, reason));
            }
            _ => continue,
        };
        all.extend(read.map_err(|reason| (line, reason))?);
    }
    let size = all.bounding_box().size();
    let tolerance = FLATNESS * size.width.max(size.height);
    let mut loops: Vec<Vec<Vector<2>>> = Vec::new();
    kurbo::flatten(&all, tolerance.max(f64::MIN_POSITIVE), |element| {
        // Ends of loops go back to their start; what is drawn from there begins with a move.
        let (PathEl::MoveTo(to) | PathEl::LineTo(to)) = element else { return };
        if matches!(element, PathEl::MoveTo(_)) {
            loops.push(Vec::new());
        }
        if let Some(corners) = loops.last_mut() {
            corners.push(Vector::<2>::new(to.x, -to.y));
        }
    });
    // A move that nothing is drawn after draws nothing.
    loops.retain(|corners| corners.len() > 1);
    Ok(loops)
}

/// The curves of the data of a path. The crate for curves reads such data too, but has arcs to a tenth of a unit only.
fn path(data: &str) -> Result<BezPath, String> {
    let mut path = BezPath::new();
    let (mut start, mut at, mut is_closed) = (Point::ZERO, Point::ZERO, false);
    // What a smooth curve mirrors: the last control point of a cubic and of a quadratic one.
    let mut last: [Option<Point>; 2] = [None; 2];
    for segment in PathParser::from(data) {
        let segment = segment.map_err(|error| format!("the path cannot be read: {error}"))?;
        let base = if segment.is_abs() { Vec2::ZERO } else { at.to_vec2() };
        let to = |x: f64, y: f64| Point::new(x, y) + base;
        let [cubic, quadratic] = last.map(|last| last.map_or(at, |last| at + (at - last)));
        last = [None; 2];
        // After its end a loop continues from its start.
        let begins = matches!(segment, PathSegment::MoveTo { .. });
        if is_closed && !begins {
            path.move_to(start);
        }
        is_closed = matches!(segment, PathSegment::ClosePath { .. });
        at = match segment {
            PathSegment::MoveTo { x, y, .. } => {
                start = to(x, y);
                path.move_to(start);
                start
            }
            PathSegment::ClosePath { .. } => {
                path.close_path();
                start
            }
            PathSegment::LineTo { x, y, .. } => line(&mut path, to(x, y)),
            PathSegment::HorizontalLineTo { x, .. } => {
                line(&mut path, Point::new(x + base.x, at.y))
            }
            PathSegment::VerticalLineTo { y, .. } => line(&mut path, Point::new(at.x, y + base.y)),
            PathSegment::CurveTo { x1, y1, x2, y2, x, y, .. } => {
                last[0] = Some(to(x2, y2));
                path.curve_to(to(x1, y1), to(x2, y2), to(x, y));
                to(x, y)
            }
            PathSegment::SmoothCurveTo { x2, y2, x, y, .. } => {
                last[0] = Some(to(x2, y2));
                path.curve_to(cubic, to(x2, y2), to(x, y));
                to(x, y)
            }
            PathSegment::Quadratic { x1, y1, x, y, .. } => {
                last[1] = Some(to(x1, y1));
                path.quad_to(to(x1, y1), to(x, y));
                to(x, y)
            }
            PathSegment::SmoothQuadratic { x, y, .. } => {
                last[1] = Some(quadratic);
                path.quad_to(quadratic, to(x, y));
                to(x, y)
            }
            PathSegment::EllipticalArc {
                rx, ry, x_axis_rotation, large_arc, sweep, x, y, ..
            } => {
                let radii = Vec2::new(rx, ry);
                let x_rotation = x_axis_rotation.to_radians();
                let arc = SvgArc { from: at, to: to(x, y), radii, x_rotation, large_arc, sweep };
                arc_to(&mut path, &arc)
            }
        };
    }
    let is_near = |point: Point| point.x.abs().max(point.y.abs()) <= FURTHEST;
    let is_whole = path.elements().iter().all(|element| match *element {
        PathEl::MoveTo(a) | PathEl::LineTo(a) => is_near(a),
        PathEl::QuadTo(a, b) => is_near(a) && is_near(b),
        PathEl::CurveTo(a, b, c) => is_near(a) && is_near(b) && is_near(c),
        PathEl::ClosePath => true,
    });
    if is_whole { Ok(path) } else { Err(format!("the path goes beyond {FURTHEST:e}")) }
}

fn line(path: &mut BezPath, end: Point) -> Point {
    path.line_to(end);
    end
}

/// Adds an arc, which ends where it should to the bit.
fn arc_to(path: &mut BezPath, arc: &SvgArc) -> Point {
    let Some(round) = Arc::from_svg_arc(arc) else { return line(path, arc.to) };
    let mut pieces = Vec::new();
    let tolerance = ARC * round.radii.x.max(round.radii.y);
    round.to_cubic_beziers(tolerance, |a, b, c| pieces.push([a, b, c]));
    if let Some(piece) = pieces.last_mut() {
        piece[2] = arc.to;
    }
    pieces.into_iter().for_each(|[a, b, c]| path.curve_to(a, b, c));
    arc.to
}
