//! Closed surfaces of triangles, as files of drawings have them.

mod local;
mod read;
mod sound;
mod tree;
mod triangle;

use std::path::Path;

use nalgebra::Rotation3;

pub use read::SurfaceError;
pub use sound::{Soundness, Spot};

pub(super) use local::Local;

use crate::Vector;
use tree::Tree;

/// A triangle by its corners in m, counter-clockwise as seen from outside.
type Triangle = [Vector<3>; 3];

/// How the facets of a file become those of a body: made larger, turned about the origin, and then moved.
#[derive(Clone, Debug, PartialEq)]
pub struct Arrangement {
    /// Metres of a unit of the file.
    pub scale: f64,
    /// The rotation.
    pub rotation: Rotation3<f64>,
    /// By how much they are moved in m.
    pub shift: Vector<3>,
}

/// What a surface of triangles encloses, theory (97).
///
/// Inside is where the winding number is above one half: `w = sum Omega_f / 4 pi`, with the solid angles of the facets as seen
/// from the point, is 1 inside of a closed surface and 0 outside, and where facets are missing it changes smoothly through the
/// hole. Of facets that are far from a point, those of a node of the tree, the area vectors are taken
/// together, to the second order.
#[derive(Clone, Debug, PartialEq)]
pub struct Facets {
    tree: Tree,
    volume: f64,
    soundness: Soundness,
}

impl Facets {
    /// Those of triangles, of which facets without an area and those that are there twice are left out, and those that are the
    /// other way round than the ones beside them are flipped; all of them, if they enclose what is outside.
    ///
    /// # Errors
    /// Corners that are not finite, and no facets.
    pub fn new(triangles: Vec<[Vector<3>; 3]>) -> Result<Self, SurfaceError> {
        Self::numbered(triangles.into_iter().zip(1..).collect())
    }

    /// Those of triangles with the number of a facet each.
    fn numbered(triangles: Vec<(Triangle, u32)>) -> Result<Self, SurfaceError> {
        sound::check(&triangles)?;
        let (triangles, soundness, volume) = sound::mended(triangles)?;
        Ok(Self { tree: Tree::new(triangles), volume, soundness })
    }

    /// Those of a file: STL, binary or ASCII, OBJ, PLY, by the end of its name.
    ///
    /// # Errors
    /// A file that cannot be read, is of another kind or broken, and what [`Self::new`] refuses.
    pub fn from_file(path: &Path, arrangement: &Arrangement) -> Result<Self, SurfaceError> {
        let mut triangles = read::triangles(path)?;
        let of_file = |error: SurfaceError| SurfaceError::Broken {
            path: path.to_owned(),
            reason: error.to_string(),
        };
        // Before what is not finite spreads to all coordinates.
        sound::check(&triangles).map_err(of_file)?;
        let Arrangement { scale, rotation, shift } = arrangement;
        for corner in triangles.iter_mut().flat_map(|(triangle, _)| triangle) {
            *corner = rotation * (*corner * *scale) + shift;
        }
        Self::numbered(triangles).map_err(of_file)
    }

    /// What was found when the facets were read.
    pub fn soundness(&self) -> &Soundness {
        &self.soundness
    }

    /// What they enclose, in m^3, where they are one closed piece: of several, one may lie in another.
    pub fn volume(&self) -> Option<f64> {
        (self.soundness.is_closed() && self.soundness.pieces == 1).then_some(self.volume)
    }

    /// Lower and upper corner in m of the box around them.
    pub fn bounding_box(&self) -> (Vector<3>, Vector<3>) {
        self.tree.bounds()
    }

    /// How often they wind round a point: 1 inside, 0 outside, between them near holes.
    pub fn winding(&self, point: &Vector<3>) -> f64 {
        self.tree.winding(point)
    }

    /// By how much [`Self::winding`] changes on the straight way between two points, if the surface is closed and no edge of a
    /// facet is in the way.
    pub(super) fn change(&self, from: &Vector<3>, to: &Vector<3>) -> Option<i32> {
        self.soundness.is_closed().then(|| self.tree.change(from, to)).flatten()
    }

    /// The facets that may be less than `reach` m away from a point.
    pub(super) fn around(&self, point: &Vector<3>, reach: f64) -> Local {
        self.tree.around(point, reach)
    }

    /// The distance in m from the nearest facet.
    pub fn distance(&self, point: &Vector<3>) -> f64 {
        self.distance_within(point, f64::INFINITY).unwrap_or(f64::INFINITY)
    }

    /// The same if it is less than `reach` m.
    pub(super) fn distance_within(&self, point: &Vector<3>, reach: f64) -> Option<f64> {
        self.tree.nearest(point, reach).map(|(place, _)| (place - point).norm())
    }

    /// The same, but no more than `most` m.
    pub(super) fn distance_up_to(&self, point: &Vector<3>, most: f64) -> f64 {
        self.distance_within(point, most).unwrap_or(most)
    }

    /// The distance in m from the nearest facet, less than zero outside. Through a hole it jumps.
    pub fn depth(&self, point: &Vector<3>) -> f64 {
        let distance = self.distance(point);
        if self.winding(point) > 0.5 { distance } else { -distance }
    }

    /// The nearest places on facets, with the unit normals of these, that are no more than `reach` times as far from a point as
    /// the nearest of all, which comes first.
    pub fn nearest(&self, point: &Vector<3>, reach: f64) -> Vec<(Vector<3>, Vector<3>)> {
        let Some(first) = self.tree.nearest(point, f64::INFINITY) else { return Vec::new() };
        let mut all = vec![first];
        all.extend(self.tree.within(point, reach * (first.0 - point).norm()));
        let normal = |number: usize| triangle::area(&self.tree.triangles()[number]).normalize();
        all.into_iter().map(|(place, number)| (place, normal(number))).collect()
    }

    /// How many pairs of facets that have no corner in common and do not lie in one plane cross each other, as far as they are
    /// counted: up to `most`.
    pub fn crossings(&self, most: usize) -> usize {
        self.tree.crossings(most)
    }

    /// The first facet that crosses another, where it does, and the number of the first that it crosses.
    pub fn first_crossing(&self) -> Option<(Spot, usize)> {
        self.tree.first_crossing()
    }

    /// The thinnest part in m, if it is thinner than `most` m: the shortest way from the middle of a facet straight through to the
    /// other side, with the first facet that it is behind.
    pub fn thinner_than(&self, most: f64) -> Option<(f64, Spot)> {
        self.tree.thinnest(most)
    }
}
