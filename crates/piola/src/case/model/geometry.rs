//! Domain, bodies and regions of space.

use std::path::PathBuf;
use std::sync::{Arc, OnceLock};

use super::{Material, Opening, Wall};
use crate::case::expression::Expression;
use crate::case::source::{Located, Place};
use crate::geometry::{Arrangement, CloudSpec, Facets, LayerSide, PointCloud};

/// The space that the particles live in.
#[derive(Clone, Debug, PartialEq)]
pub struct Domain {
    /// Per axis, the ends of the period in m, or `None`.
    pub periodic: Vec<Option<Located<[f64; 2]>>>,
}

/// A connected piece of one material.
#[derive(Clone, Debug)]
pub struct Body {
    /// Unique name.
    pub name: Located<String>,
    /// The space that it fills in the reference state.
    pub shape: Located<Shape>,
    /// Distance between particles in m, one number per axis; empty if the particles come from a file.
    pub spacing: Located<Vec<f64>>,
    /// How the particles are arranged. Not used if they come from a file.
    pub lattice: Lattice,
    /// What it is made of.
    pub material: Located<Material>,
    /// Its state at the start.
    pub initial: Initial,
    /// What makes it a wall, if it is one.
    pub wall: Option<Located<Wall>>,
    /// What makes it the buffer of an open boundary, if it is one.
    pub opening: Option<Located<Opening>>,
    /// Number of the system that it belongs to, if that is not the main one.
    pub system: Option<usize>,
}

/// A surface of triangles from a file.
#[derive(Clone, Debug, PartialEq)]
pub struct Surface {
    /// The file, relative paths resolved against the folder of the case file.
    pub file: Located<PathBuf>,
    /// How its facets are placed in space.
    pub arrangement: Arrangement,
    /// The facets, once they have been read: shared by all shapes of this file with the same arrangement.
    pub facets: Arc<OnceLock<Arc<Facets>>>,
}

/// A region that particles fill.
#[derive(Clone, Debug, PartialEq)]
pub enum Shape {
    /// The box between two corners, in m.
    Box {
        /// Lower corner.
        min: Vec<f64>,
        /// Upper corner, larger in every component.
        max: Vec<f64>,
    },
    /// A ball, in 2D a disc.
    Ball {
        /// Centre in m.
        center: Vec<f64>,
        /// Radius in m.
        radius: f64,
    },
    /// The region between two radii: a ring in 2D, a hollow ball in 3D.
    Annulus {
        /// Centre in m.
        center: Vec<f64>,
        /// Inner radius in m.
        inner: f64,
        /// Outer radius in m, the larger one.
        outer: f64,
    },
    /// A straight cylinder in 3D.
    Cylinder {
        /// Centre of one end, in m.
        start: Vec<f64>,
        /// Centre of the other end, in m.
        end: Vec<f64>,
        /// Radius in m.
        radius: f64,
    },
    /// The region enclosed by straight sides in the x-y plane.
    Polygon {
        /// Corners in m, at least three.
        corners: Vec<[f64; 2]>,
        /// In 3D the ends along z in m.
        ends: Option<[f64; 2]>,
    },
    /// The region enclosed by the loops of a file in the x-y plane.
    Outline {
        /// The file, relative paths resolved against the folder of the case file.
        file: Located<PathBuf>,
        /// Length of its unit in m.
        scale: f64,
        /// Where its origin is moved to, in m.
        shift: [f64; 2],
        /// In 3D the ends along z in m.
        ends: Option<[f64; 2]>,
    },
    /// The region enclosed by the triangles of a file.
    Surface(Surface),
    /// A shape rotated together with its lattice.
    Turned {
        /// The shape.
        of: Box<Located<Shape>>,
        /// Angle in rad.
        angle: f64,
        /// A point that stays in place, in m.
        about: Vec<f64>,
        /// The axis, of length 1: z in 2D.
        axis: [f64; 3],
    },
    /// The layer along the boundary of a shape that is no combination.
    Layer {
        /// The shape.
        of: Box<Located<Shape>>,
        /// Its thickness in m.
        thickness: f64,
        /// Where it is.
        side: LayerSide,
    },
    /// What lies in any of the shapes. Not empty.
    Union(Vec<Located<Shape>>),
    /// What lies in all of the shapes. Not empty.
    Intersection(Vec<Located<Shape>>),
    /// What lies in one shape and in none of the others.
    Difference {
        /// The shape to cut from.
        from: Box<Located<Shape>>,
        /// What is cut away.
        remove: Vec<Located<Shape>>,
    },
    /// The points of a CSV file, with their volumes.
    Points {
        /// The file, relative paths resolved against the folder of the case file.
        file: Located<PathBuf>,
    },
    /// Points that a program has given, with their volumes.
    Cloud {
        /// What stands for them in the text, with its mark.
        name: Located<String>,
        /// The points; none in a record, which does not hold them.
        cloud: Option<Arc<PointCloud>>,
    },
    /// The nodes or the cells of a mesh.
    Mesh {
        /// The file, relative paths resolved against the folder of the case file.
        file: Located<PathBuf>,
        /// What is made into particles, and how.
        spec: CloudSpec,
    },
}

impl Shape {
    /// Whether the particles come from a file or a program, so that there is no lattice.
    pub fn is_from_file(&self) -> bool {
        self.is_points() || matches!(self, Self::Mesh { .. })
    }

    /// Whether it is points and their volumes, without any faces.
    pub fn is_points(&self) -> bool {
        matches!(self, Self::Points { .. } | Self::Cloud { .. })
    }

    /// Whether shapes meet inside it. What is cut away may be a union, as its interior is outside.
    pub fn has_seams(&self) -> bool {
        match self {
            Self::Union(shapes) => shapes.len() > 1,
            Self::Difference { from, .. } => from.has_seams(),
            _ => self.parts().into_iter().any(Self::has_seams),
        }
    }

    /// Whether it is made of several shapes, or is a layer of one, as it is or turned.
    pub fn is_composed(&self) -> bool {
        match self {
            Self::Turned { of, .. } => of.is_composed(),
            Self::Layer { .. } => true,
            _ => !self.parts().is_empty(),
        }
    }

    /// The surfaces from files in it.
    pub fn surfaces(&self) -> Vec<&Surface> {
        match self {
            Self::Surface(surface) => vec![surface],
            _ => self.parts().into_iter().flat_map(Self::surfaces).collect(),
        }
    }

    /// The shapes that it is made of.
    fn parts(&self) -> Vec<&Self> {
        match self {
            Self::Union(shapes) | Self::Intersection(shapes) => {
                shapes.iter().map(|shape| &shape.value).collect()
            }
            Self::Difference { from, remove } => {
                std::iter::once(&from.value).chain(remove.iter().map(|cut| &cut.value)).collect()
            }
            Self::Turned { of, .. } | Self::Layer { of, .. } => vec![&of.value],
            _ => Vec::new(),
        }
    }

    /// The files that the shape reads.
    pub fn files(&self) -> Vec<&Located<PathBuf>> {
        match self {
            Self::Points { file }
            | Self::Mesh { file, .. }
            | Self::Outline { file, .. }
            | Self::Surface(Surface { file, .. }) => vec![file],
            _ => self.parts().into_iter().flat_map(Self::files).collect(),
        }
    }
}

/// How particles are arranged in a body.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Lattice {
    /// Arrangement.
    pub kind: LatticeKind,
    /// Where the first particle lies.
    pub on: LatticeOrigin,
    /// Largest random displacement of a particle, in spacings.
    pub jitter: f64,
    /// Seed of the random displacements.
    pub seed: u64,
    /// Number of relaxation steps after that.
    pub relax: u64,
}

/// Arrangement of particles.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum LatticeKind {
    /// Square in 2D, cubic in 3D.
    Square,
    /// Hexagonal in 2D, hexagonal close packing in 3D.
    Hexagonal,
    /// In layers around a centre or an axis.
    Concentric,
    /// Moved until evenly distributed, the outermost half a spacing below the surface.
    Packed,
}

/// Where the first particle of a lattice lies.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum LatticeOrigin {
    /// Particles on the faces of the body's bounding box.
    Boundary,
    /// Particles half a spacing inside the faces.
    Cells,
}

/// State of a body at the start, as expressions of the reference position or arrays of its particles.
#[derive(Clone, Debug)]
pub struct Initial {
    /// Where it is in the case.
    pub place: Place,
    /// Velocity in m/s.
    pub velocity: Vec<Expression>,
    /// Displacement in m.
    pub displacement: Vec<Expression>,
    /// Pressure in Pa, positive in compression.
    pub pressure: Expression,
}

impl Initial {
    /// All expressions.
    pub fn expressions(&self) -> impl Iterator<Item = &Expression> {
        self.velocity.iter().chain(&self.displacement).chain(std::iter::once(&self.pressure))
    }
}

/// A region that selects particles by their reference position.
#[derive(Clone, Debug, PartialEq)]
pub enum Region {
    /// Every particle.
    All,
    /// Within half a local spacing of a plane (in 2D a line, in 1D a point).
    Plane {
        /// A point of the plane, in m.
        point: Vec<f64>,
        /// Unit normal, outward of the body.
        normal: Vec<f64>,
    },
    /// In the box between two corners, in m.
    Box {
        /// Lower corner.
        min: Vec<f64>,
        /// Upper corner.
        max: Vec<f64>,
    },
    /// Within a distance of a point.
    Ball {
        /// Centre in m.
        center: Vec<f64>,
        /// Radius in m.
        radius: f64,
    },
    /// On the side of a plane that its normal points to.
    HalfSpace {
        /// A point of the plane, in m.
        point: Vec<f64>,
        /// Unit normal.
        normal: Vec<f64>,
    },
    /// A named set of a mesh.
    Set {
        /// Its name.
        name: String,
    },
}
