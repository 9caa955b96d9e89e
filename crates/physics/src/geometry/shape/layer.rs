//! Layers along the boundary of a shape.

use super::super::error::{finite, positive};
use super::{Kind, OfSurface, Shape};
use crate::Vector;
use crate::geometry::{GeometryError, polygon};

/// On which side of the boundary of a shape a layer lies.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum LayerSide {
    /// Around the shape.
    Outside,
    /// In the shape, behind its boundary.
    Inside,
}

/// What lies on one side of the boundary of a shape, not too far from it.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Layer<const D: usize> {
    pub of: Box<Shape<D>>,
    pub side: LayerSide,
    /// In m.
    pub thickness: f64,
}

impl<const D: usize> Layer<D> {
    /// The depth below the nearer of its two faces.
    pub fn depth_by<'a>(&'a self, point: &Vector<D>, of_surface: &mut OfSurface<'_, 'a>) -> f64 {
        let further = self.thickness;
        let distance = self.of.distance_by(point, &mut |facets, place, more| {
            of_surface(facets, place, further + more)
        });
        let behind = match self.side {
            LayerSide::Outside => -distance,
            LayerSide::Inside => distance,
        };
        behind.min(self.thickness - behind)
    }

    /// See [`Shape::bounding_box`].
    pub fn bounding_box(&self) -> (Vector<D>, Vector<D>) {
        let (min, max) = self.of.bounding_box();
        match self.side {
            LayerSide::Outside => (min.add_scalar(-self.thickness), max.add_scalar(self.thickness)),
            LayerSide::Inside => (min, max),
        }
    }
}

impl<const D: usize> Shape<D> {
    /// What lies on one side of the boundary of the shape, no further than `thickness` m from it. Around convex edges a layer
    /// outside is round. That of a turned shape is turned with it.
    ///
    /// # Errors
    /// A thickness that is not positive, or too large for coordinates, and shapes whose distance is not known: layers, and
    /// combinations of others than polygons. Of these it is known where their sides do not meet, as in an
    /// [`Outline`](crate::geometry::Outline).
    pub fn layer(self, thickness: f64, side: LayerSide) -> Result<Self, GeometryError> {
        positive("the thickness of a layer", thickness)?;
        if let Kind::Turned { of, about, rotation } = self.0 {
            let of = Box::new(of.layer(thickness, side)?);
            return Ok(Self(Kind::Turned { of, about, rotation }));
        }
        let is_known = match self.0 {
            Kind::Intersection(_) | Kind::Layer(_) => false,
            Kind::Union(_) | Kind::Difference { .. } => self.in_plane(&Vector::zeros()).is_some(),
            _ => true,
        };
        if !is_known {
            return Err(GeometryError::NoLayer);
        }
        let layer = Layer { of: Box::new(self), side, thickness };
        let (min, max) = layer.bounding_box();
        finite("the extent of a layer", (max - min).as_slice())?;
        Ok(Self(Kind::Layer(layer)))
    }

    /// The thickness in m, where the shape is one layer.
    pub(in crate::geometry) fn thickness(&self) -> Option<f64> {
        match &self.0 {
            Kind::Layer(layer) => Some(layer.thickness),
            _ => None,
        }
    }

    /// The same shape, with the layers in it thicker by `more` m on their far sides.
    pub fn thickened(&self, more: f64) -> Self {
        let thickened = |shape: &Self| shape.thickened(more);
        let all = |shapes: &[Self]| shapes.iter().map(thickened).collect();
        Self(match &self.0 {
            Kind::Layer(layer) => {
                Kind::Layer(Layer { thickness: layer.thickness + more, ..layer.clone() })
            }
            Kind::Turned { of, about, rotation } => {
                let of = Box::new(thickened(of));
                Kind::Turned { of, about: *about, rotation: *rotation }
            }
            Kind::Union(shapes) => Kind::Union(all(shapes)),
            Kind::Intersection(shapes) => Kind::Intersection(all(shapes)),
            Kind::Difference { from, remove } => {
                Kind::Difference { from: Box::new(thickened(from)), remove: remove.clone() }
            }
            other => other.clone(),
        })
    }

    /// The distance in m from the boundary, negative outside. It is the depth but beyond edges.
    fn distance_by<'a>(&'a self, point: &Vector<D>, of_surface: &mut OfSurface<'_, 'a>) -> f64 {
        let plane = Vector::from_fn(|axis, _| if axis < D { point[axis] } else { 0.0 });
        match &self.0 {
            Kind::Box { min, max } => {
                let depth = |axis: usize| (point[axis] - min[axis]).min(max[axis] - point[axis]);
                of_product((0..D).map(depth))
            }
            Kind::Cylinder { start, direction, length, radius } => {
                let arm = point - start;
                let along = arm.dot(direction);
                let across = (arm - direction * along).norm();
                of_product([along.min(length - along), radius - across].into_iter())
            }
            _ => match self.in_plane(&plane) {
                Some((depth, Some([min, max]))) => {
                    let along = (point[D - 1] - min).min(max - point[D - 1]);
                    of_product([depth, along].into_iter())
                }
                Some((depth, None)) => depth,
                None => self.depth_by(point, of_surface),
            },
        }
    }

    /// The depth in the plane of a polygon, or of what is made of polygons whose sides do not meet, and the ends along z in m.
    fn in_plane(&self, point: &Vector<2>) -> Option<(f64, Option<[f64; 2]>)> {
        let depth = |shape: &Self| shape.in_plane(point);
        match &self.0 {
            Kind::Polygon { corners, ends } => Some((polygon::depth(corners, point), *ends)),
            Kind::Union(shapes) => {
                let all = shapes.iter().map(depth).collect::<Option<Vec<_>>>()?;
                let are_level = all.windows(2).all(|both| both[0].1 == both[1].1);
                all.into_iter()
                    .filter(|_| are_level)
                    .reduce(|one, other| (one.0.max(other.0), one.1))
            }
            Kind::Difference { from, remove } => {
                let (whole, all) = (depth(from)?, remove.iter().map(depth));
                let all = all.collect::<Option<Vec<_>>>()?;
                let are_level = all.iter().all(|hole| hole.1 == whole.1);
                let cut = |whole: (f64, _), hole: (f64, _)| (whole.0.min(-hole.0), whole.1);
                are_level.then(|| all.into_iter().fold(whole, cut))
            }
            _ => None,
        }
    }
}

/// The distance from the boundary of what lies in several regions at once that are bounded in directions at right angles to each
/// other, from the distances of their boundaries.
fn of_product(distances: impl Iterator<Item = f64> + Clone) -> f64 {
    let least = distances.clone().fold(f64::INFINITY, f64::min);
    let outside = distances.map(|distance| distance.min(0.0));
    if least < 0.0 { -outside.map(|x| x * x).sum::<f64>().sqrt() } else { least }
}
