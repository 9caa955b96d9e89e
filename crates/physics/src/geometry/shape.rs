//! Closed regions of space that particles fill.

mod layer;

use std::f64::consts::PI;
use std::sync::Arc;

use nalgebra::{Rotation3, Unit, Vector3};

use super::error::{axis_name, finite, positive};
use super::polygon;
use super::{Facets, GeometryError};
use crate::{Tensor, Vector};

use layer::Layer;
pub use layer::LayerSide;

/// The depth in a surface of facets from outside, at a place, where it has to be known by this many m further than that of the shape.
pub(super) type OfSurface<'f, 'a> = dyn FnMut(&'a Facets, &Vector<3>, f64) -> f64 + 'f;

/// A region of space with its boundary.
#[derive(Clone, Debug, PartialEq)]
pub struct Shape<const D: usize>(Kind<D>);

#[derive(Clone, Debug, PartialEq)]
enum Kind<const D: usize> {
    Box {
        min: Vector<D>,
        max: Vector<D>,
    },
    /// A ball without the open ball of radius `inner`, which may be 0.
    Ball {
        center: Vector<D>,
        inner: f64,
        outer: f64,
    },
    Cylinder {
        start: Vector<D>,
        direction: Vector<D>,
        length: f64,
        radius: f64,
    },
    /// In 3D between two ends along z.
    Polygon {
        corners: Vec<Vector<2>>,
        ends: Option<[f64; 2]>,
    },
    /// In 3D.
    Surface(Arc<Facets>),
    Turned {
        of: Box<Shape<D>>,
        about: Vector<D>,
        rotation: Tensor<D>,
    },
    Layer(Layer<D>),
    Union(Vec<Shape<D>>),
    Intersection(Vec<Shape<D>>),
    Difference {
        from: Box<Shape<D>>,
        remove: Vec<Shape<D>>,
    },
}

/// The volume in m^D of a ball with a radius in m.
pub fn ball_volume(dimension: usize, radius: f64) -> f64 {
    match dimension {
        1 => 2.0 * radius,
        2 => PI * radius * radius,
        _ => 4.0 / 3.0 * PI * radius.powi(3),
    }
}

impl<const D: usize> Shape<D> {
    /// The box between two corners in m.
    ///
    /// # Errors
    /// Corners that are not finite or not in order.
    pub fn cuboid(min: Vector<D>, max: Vector<D>) -> Result<Self, GeometryError> {
        finite("the lower corner of a box", min.as_slice())?;
        finite("the upper corner of a box", max.as_slice())?;
        finite("the extent of a box", (max - min).as_slice())?;
        if let Some(axis) = (0..D).find(|&axis| min[axis] >= max[axis]) {
            let (axis, min, max) = (axis_name(axis), min[axis], max[axis]);
            return Err(GeometryError::Corners { axis, min, max });
        }
        Ok(Self(Kind::Box { min, max }))
    }

    /// A ball, in 2D a disc, with `center` and `radius` in m.
    ///
    /// # Errors
    /// A centre that is not finite, a radius that is not positive.
    pub fn ball(center: Vector<D>, radius: f64) -> Result<Self, GeometryError> {
        positive("the radius of a ball", radius)?;
        finite("the center of a ball", center.as_slice())?;
        let extent = center.abs().add_scalar(radius);
        finite("the largest coordinate of a ball", (2.0 * extent).as_slice())?;
        Ok(Self(Kind::Ball { center, inner: 0.0, outer: radius }))
    }

    /// What lies between two radii in m around `center`: a ring in 2D, a hollow ball in 3D.
    ///
    /// # Errors
    /// A centre that is not finite, radii that are not positive or not in order, 1D.
    pub fn annulus(center: Vector<D>, inner: f64, outer: f64) -> Result<Self, GeometryError> {
        if D < 2 {
            let (what, expected) = ("an annulus", "2D or 3D");
            return Err(GeometryError::Dimension { what, got: D, expected });
        }
        positive("the inner radius of an annulus", inner)?;
        Self::ball(center, outer)?;
        if inner >= outer {
            return Err(GeometryError::Radii { inner, outer });
        }
        Ok(Self(Kind::Ball { center, inner, outer }))
    }

    /// A straight cylinder with flat ends around the points `start` and `end`, in 3D; all in m.
    ///
    /// # Errors
    /// Ends that are not finite or the same, a radius that is not positive, 1D and 2D.
    pub fn cylinder(start: Vector<D>, end: Vector<D>, radius: f64) -> Result<Self, GeometryError> {
        if D != 3 {
            let (what, expected) = ("a cylinder", "3D; in 2D its section is a ball or a box");
            return Err(GeometryError::Dimension { what, got: D, expected });
        }
        Self::ball(start, radius)?;
        Self::ball(end, radius)?;
        let length = (end - start).norm();
        positive("the length of a cylinder", length)?;
        let direction = (end - start) / length;
        Ok(Self(Kind::Cylinder { start, direction, length, radius }))
    }

    /// What the straight sides between `corners` in m enclose, in either sense of rotation; in 3D between two `ends`
    /// in m along z.
    ///
    /// # Errors
    /// Less than three corners, ones that are not finite or there twice, sides that cross or touch, 1D, in 3D ends that are missing
    /// or not in order.
    pub fn polygon(corners: Vec<Vector<2>>, ends: Option<[f64; 2]>) -> Result<Self, GeometryError> {
        if D < 2 || (D == 3) != ends.is_some() {
            let (what, expected) = ("a polygon", "2D, or 3D with two ends along z");
            return Err(GeometryError::Dimension { what, got: D, expected });
        }
        corners.iter().try_for_each(|x| finite("a corner of a polygon", x.as_slice()))?;
        if let Some([min, max]) = ends {
            finite("the ends of a polygon along z", &[min, max])?;
            if min >= max {
                return Err(GeometryError::Corners { axis: axis_name(2), min, max });
            }
        }
        polygon::check(&corners)?;
        Ok(Self(Kind::Polygon { corners, ends }))
    }

    /// What a closed surface of triangles encloses, in 3D.
    ///
    /// # Errors
    /// 1D and 2D.
    pub fn surface(facets: Arc<Facets>) -> Result<Self, GeometryError> {
        if D != 3 {
            let (what, expected) = ("a surface of facets", "3D; in 2D its outline is a polygon");
            return Err(GeometryError::Dimension { what, got: D, expected });
        }
        Ok(Self(Kind::Surface(facets)))
    }

    /// A shape turned by an angle in rad about a point in m, in 3D about a unit axis: counter-clockwise as seen from
    /// its tip, in 2D from the tip of z. Particles that fill it are on a lattice that is turned with it.
    ///
    /// # Errors
    /// An angle or point that is not finite, an axis without a direction, 1D.
    pub fn turned(
        self,
        angle: f64,
        about: Vector<D>,
        axis: Vector3<f64>,
    ) -> Result<Self, GeometryError> {
        if D < 2 {
            let (what, expected) = ("a turned shape", "2D or 3D");
            return Err(GeometryError::Dimension { what, got: D, expected });
        }
        finite("the angle of a turned shape", &[angle])?;
        finite("the point about which a shape is turned", about.as_slice())?;
        finite("the axis of a turned shape", axis.as_slice())?;
        positive("the length of the axis of a turned shape", axis.norm())?;
        let turn = Rotation3::from_axis_angle(&Unit::new_normalize(axis), angle);
        let rotation = Tensor::<D>::from_fn(|i, j| turn[(i, j)]);
        Ok(Self(Kind::Turned { of: Box::new(self), about, rotation }))
    }

    /// What lies in any of `shapes`.
    ///
    /// # Errors
    /// No shapes.
    pub fn union(shapes: Vec<Self>) -> Result<Self, GeometryError> {
        if shapes.is_empty() {
            return Err(GeometryError::NoShapes { what: "a union" });
        }
        Ok(Self(Kind::Union(shapes)))
    }

    /// What lies in all of `shapes`.
    ///
    /// # Errors
    /// No shapes.
    pub fn intersection(shapes: Vec<Self>) -> Result<Self, GeometryError> {
        if shapes.is_empty() {
            return Err(GeometryError::NoShapes { what: "an intersection" });
        }
        Ok(Self(Kind::Intersection(shapes)))
    }

    /// What lies in `from` and not inside any shape of `remove`; their boundary stays.
    ///
    /// # Errors
    /// No shapes to remove.
    pub fn difference(from: Self, remove: Vec<Self>) -> Result<Self, GeometryError> {
        if remove.is_empty() {
            return Err(GeometryError::NoShapes { what: "what a difference removes" });
        }
        Ok(Self(Kind::Difference { from: Box::new(from), remove }))
    }

    /// Whether `point` lies inside or on the boundary; never where it is not finite.
    pub fn contains(&self, point: &Vector<D>) -> bool {
        point.iter().all(|x| x.is_finite()) && self.depth(point) >= 0.0
    }

    /// A depth below the boundary in m: 0 on it, negative outside, and nowhere further from 0 than
    /// the boundary is from `point`.
    pub fn depth(&self, point: &Vector<D>) -> f64 {
        self.depth_by(point, &mut |facets, place, _| facets.depth(place))
    }

    /// The depth with that in surfaces of facets from outside.
    pub(super) fn depth_by<'a>(
        &'a self,
        point: &Vector<D>,
        of_surface: &mut OfSurface<'_, 'a>,
    ) -> f64 {
        match &self.0 {
            Kind::Box { min, max } => {
                let depth = |axis: usize| (point[axis] - min[axis]).min(max[axis] - point[axis]);
                (0..D).map(depth).fold(f64::INFINITY, f64::min)
            }
            Kind::Ball { center, inner, outer } => {
                let distance = (point - center).norm();
                let inside = if *inner > 0.0 { distance - inner } else { f64::INFINITY };
                inside.min(outer - distance)
            }
            Kind::Cylinder { start, direction, length, radius } => {
                let arm = point - start;
                let along = arm.dot(direction);
                let across = (arm - direction * along).norm();
                along.min(length - along).min(radius - across)
            }
            Kind::Polygon { corners, ends } => {
                let depth = polygon::depth(corners, &point.fixed_rows::<2>(0).into_owned());
                let along = |[min, max]: [f64; 2]| (point[D - 1] - min).min(max - point[D - 1]);
                ends.map_or(depth, |ends| depth.min(along(ends)))
            }
            Kind::Surface(facets) => of_surface(facets, &in_space(point), 0.0),
            Kind::Turned { of, about, rotation } => {
                of.depth_by(&(rotation.transpose() * (point - about) + about), of_surface)
            }
            Kind::Layer(layer) => layer.depth_by(point, of_surface),
            Kind::Union(shapes) => shapes
                .iter()
                .map(|shape| shape.depth_by(point, of_surface))
                .fold(f64::NEG_INFINITY, f64::max),
            Kind::Intersection(shapes) => shapes
                .iter()
                .map(|shape| shape.depth_by(point, of_surface))
                .fold(f64::INFINITY, f64::min),
            Kind::Difference { from, remove } => {
                let whole = from.depth_by(point, of_surface);
                remove.iter().map(|shape| -shape.depth_by(point, of_surface)).fold(whole, f64::min)
            }
        }
    }

    /// Lower and upper corner in m of a box around the shape: the smallest one for all but differences,
    /// intersections and what is turned. The corners of an empty intersection may be out of order.
    pub fn bounding_box(&self) -> (Vector<D>, Vector<D>) {
        match &self.0 {
            Kind::Box { min, max } => (*min, *max),
            Kind::Ball { center, outer, .. } => {
                (center.add_scalar(-outer), center.add_scalar(*outer))
            }
            Kind::Cylinder { start, direction, length, radius } => {
                let end = start + direction * *length;
                let reach = direction.map(|d| radius * (1.0 - d * d).max(0.0).sqrt());
                (start.inf(&end) - reach, start.sup(&end) + reach)
            }
            Kind::Polygon { corners, ends } => {
                let [min, max] = [f64::min, f64::max].map(|choose: fn(f64, f64) -> f64| {
                    corners[1..].iter().fold(corners[0], |x, y| x.zip_map(y, choose))
                });
                let whole = |plane: Vector<2>, end: fn([f64; 2]) -> f64| {
                    Vector::from_fn(|axis, _| match axis {
                        0 | 1 => plane[axis],
                        _ => ends.map_or(0.0, end),
                    })
                };
                (whole(min, |[low, _]| low), whole(max, |[_, high]| high))
            }
            Kind::Surface(facets) => {
                let (min, max) = facets.bounding_box();
                (from_space(&min), from_space(&max))
            }
            Kind::Turned { of, about, rotation } => {
                let (min, max) = of.bounding_box();
                let (middle, half) = (0.5 * (min + max), 0.5 * (max - min));
                let (middle, half) = (rotation * (middle - about) + about, rotation.abs() * half);
                (middle - half, middle + half)
            }
            Kind::Layer(layer) => layer.bounding_box(),
            Kind::Union(shapes) => join(shapes, |(a, b), (c, d)| (a.inf(&c), b.sup(&d))),
            Kind::Intersection(shapes) => join(shapes, |(a, b), (c, d)| (a.sup(&c), b.inf(&d))),
            Kind::Difference { from, .. } => from.bounding_box(),
        }
    }

    /// The volume in m^D, where it is known: for boxes, balls, annuli, cylinders, polygons and closed surfaces, for these turned, and for these
    /// with others cut out of a box wholly inside of it and apart from each other.
    #[inline(never)]
    pub fn exact_volume(&self) -> Option<f64> {
        match &self.0 {
            Kind::Box { min, max } => Some((max - min).product()),
            Kind::Ball { inner, outer, .. } => {
                Some(ball_volume(D, *outer) - ball_volume(D, *inner))
            }
            Kind::Cylinder { length, radius, .. } => Some(PI * radius * radius * length),
            Kind::Polygon { corners, ends } => {
                Some(polygon::area(corners).abs() * ends.map_or(1.0, |[min, max]| max - min))
            }
            Kind::Surface(facets) => facets.volume(),
            Kind::Turned { of, .. } => of.exact_volume(),
            Kind::Layer(_) => None,
            Kind::Union(shapes) | Kind::Intersection(shapes) => match shapes.as_slice() {
                [only] => only.exact_volume(),
                _ => None,
            },
            Kind::Difference { from, remove } => {
                let bounds: Vec<_> = remove.iter().map(Self::bounding_box).collect();
                let is_box = matches!(from.0, Kind::Box { .. });
                let inside = bounds.iter().all(|(a, b)| from.contains(a) && from.contains(b));
                let apart = bounds.iter().enumerate().all(|(i, (a, b))| {
                    let apart = |(c, d): &(Vector<D>, Vector<D>)| {
                        (0..D).any(|axis| b[axis] <= c[axis] || d[axis] <= a[axis])
                    };
                    bounds[..i].iter().all(apart)
                });
                let removed: Option<f64> = remove.iter().map(Self::exact_volume).sum();
                (is_box && inside && apart).then_some(from.exact_volume()? - removed?)
            }
        }
    }

    /// What was turned, the point and the rotation, where the shape is one that was turned as a whole.
    pub fn as_turned(&self) -> Option<(&Self, &Vector<D>, &Tensor<D>)> {
        match &self.0 {
            Kind::Turned { of, about, rotation } => Some((of, about, rotation)),
            _ => None,
        }
    }

    /// Its centre, radii and axis, where the shape is one ball, annulus or cylinder.
    pub(super) fn as_round(&self) -> Option<Round<D>> {
        match self.0 {
            Kind::Ball { center, inner, outer } => {
                Some(Round { center, radii: [inner, outer], axis: None })
            }
            Kind::Cylinder { start, direction, length, radius } => {
                let axis = Some((direction, length));
                Some(Round { center: start, radii: [0.0, radius], axis })
            }
            _ => None,
        }
    }

    /// The surfaces of triangles that bound it, but those of what is turned.
    pub(super) fn surfaces(&self) -> Vec<&Facets> {
        match &self.0 {
            Kind::Surface(facets) => vec![facets],
            Kind::Layer(layer) => layer.of.surfaces(),
            Kind::Union(shapes) | Kind::Intersection(shapes) => {
                shapes.iter().flat_map(Self::surfaces).collect()
            }
            Kind::Difference { from, remove } => {
                std::iter::once(&**from).chain(remove).flat_map(Self::surfaces).collect()
            }
            _ => Vec::new(),
        }
    }

    /// The corners, where the shape is one box.
    pub(super) fn corners(&self) -> Option<(Vector<D>, Vector<D>)> {
        match self.0 {
            Kind::Box { min, max } => Some((min, max)),
            _ => None,
        }
    }
}

/// What is round: a ball with a hole or none, or a cylinder.
pub(super) struct Round<const D: usize> {
    /// Its centre; of a cylinder that of the end where it starts.
    pub center: Vector<D>,
    /// Radii of the hole and of the outside in m.
    pub radii: [f64; 2],
    /// Unit vector along the axis of a cylinder, and its length in m.
    pub axis: Option<(Vector<D>, f64)>,
}

/// A point of a surface, which is in 3D.
pub(super) fn in_space<const D: usize>(point: &Vector<D>) -> Vector<3> {
    Vector::from_fn(|axis, _| if axis < D { point[axis] } else { 0.0 })
}

/// The same the other way round.
pub(super) fn from_space<const D: usize>(point: &Vector<3>) -> Vector<D> {
    Vector::from_fn(|axis, _| point[axis])
}

type Bounds<const D: usize> = (Vector<D>, Vector<D>);

/// Combines the bounds of `shapes`, of which there is at least one.
fn join<const D: usize>(
    shapes: &[Shape<D>],
    combine: impl Fn(Bounds<D>, Bounds<D>) -> Bounds<D>,
) -> Bounds<D> {
    let bounds = shapes.iter().map(Shape::bounding_box).reduce(combine);
    bounds.expect("combinations are made of at least one shape")
}
