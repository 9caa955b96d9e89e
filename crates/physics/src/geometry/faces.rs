//! The faces of a wall that a point inside it is behind.

use piola_formulas::tensor;

use crate::{Tensor, Vector};

/// The outward unit normals of those faces of a shape that are nearest to a point inside it: one as a
/// rule, several behind an edge, none where there is no way out.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Faces<const D: usize> {
    normals: Vec<Vector<D>>,
    /// How far the point is behind each of them in m.
    depths: Vec<f64>,
}

impl<const D: usize> FromIterator<(Vector<D>, f64)> for Faces<D> {
    /// Faces with unit normals, each with how far the point is behind it in m.
    fn from_iter<I: IntoIterator<Item = (Vector<D>, f64)>>(faces: I) -> Self {
        let (normals, depths) = faces.into_iter().unzip();
        Self { normals, depths }
    }
}

impl<const D: usize> Faces<D> {
    /// Faces with these unit normals, that a point is so deep behind, in m.
    pub fn new(normals: Vec<Vector<D>>, depth: f64) -> Self {
        let depths = vec![depth; normals.len()];
        Self { normals, depths }
    }

    /// The normals.
    pub fn normals(&self) -> &[Vector<D>] {
        &self.normals
    }

    /// How far the point is behind the nearest face in m; 0 without a face.
    pub fn depth(&self) -> f64 {
        self.depths.iter().copied().reduce(f64::min).unwrap_or(0.0)
    }

    /// How far the point is behind each of the faces in m.
    pub fn depths(&self) -> &[f64] {
        &self.depths
    }

    /// Becomes those faces at `rest` as a deformation gradient leaves them: planes turn to
    /// `n = F^-T N / |F^-T N|`, and a layer between them and the point is `1 / |F^-T N|` as thick as it was. One that
    /// has no inverse leaves them as they are.
    pub fn follow(&mut self, rest: &Self, deformation: &Tensor<D>) {
        let Some(inverse) = tensor::inverse(deformation) else { return };
        self.normals.clear();
        self.depths.clear();
        for (normal, depth) in rest.normals.iter().zip(&rest.depths) {
            let (turned, stretched) = turned(&inverse, normal);
            self.normals.push(turned);
            self.depths.push(depth / stretched);
        }
    }

    /// The unit normal between those of the faces; zero if there is none.
    pub fn between(&self) -> Vector<D> {
        let Some(first) = self.normals.first() else { return Vector::zeros() };
        let between: Vector<D> = self.normals.iter().sum();
        // Opposite faces, as of a plate, have nothing between them.
        between.try_normalize(0.1).unwrap_or(*first)
    }

    /// The unit normal of the side that faces a direction of any length: that of the one face, and behind
    /// an edge the normals of those that face it, each by how much. If none does it is the one
    /// between them.
    pub fn towards(&self, direction: &Vector<D>) -> Vector<D> {
        if self.normals.len() < 2 {
            return self.between();
        }
        let part = |normal: &Vector<D>| normal * direction.dot(normal).max(0.0);
        let sum: Vector<D> = self.normals.iter().map(part).sum();
        sum.try_normalize(1e-6 * direction.norm()).unwrap_or_else(|| self.between())
    }

    /// How far a place is in front of the faces, in m, for the way to there from the point behind them, with the
    /// normal of that face which it is most in front of; nothing without a face.
    pub fn in_front(&self, way: &Vector<D>) -> Option<(f64, &Vector<D>)> {
        let faces = self.normals.iter().zip(&self.depths);
        let heights = faces.map(|(normal, depth)| (way.dot(normal) - depth, normal));
        heights.reduce(|best, other| if other.0 > best.0 { other } else { best })
    }
}

/// The unit normal of a plane with the unit normal `rest` as a deformation leaves it, which has this inverse, and
/// `|F^-T N|`.
fn turned<const D: usize>(inverse: &Tensor<D>, rest: &Vector<D>) -> (Vector<D>, f64) {
    let turned = inverse.transpose() * rest;
    (turned.normalize(), turned.norm())
}

/// The unit normal of a plane with the unit normal `rest` as a deformation gradient leaves it; the same where that
/// has no inverse.
pub(crate) fn turned_normal<const D: usize>(
    deformation: &Tensor<D>,
    rest: &Vector<D>,
) -> Vector<D> {
    tensor::inverse(deformation).map_or(*rest, |inverse| turned(&inverse, rest).0)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn faces_follow_a_deformation() {
        let rest = Faces::new(vec![Vector::<2>::new(0.0, 1.0)], 0.1);
        let mut faces = rest.clone();
        // Sheared along the face it stays where it is, and pulled across it is twice as thick.
        faces.follow(&rest, &Tensor::from([[1.0, 0.0], [0.7, 1.0]]));
        assert!((faces.normals[0] - rest.normals[0]).norm() < 1e-15 && faces.depth() == 0.1);
        faces.follow(&rest, &Tensor::from([[1.0, 0.0], [0.0, 2.0]]));
        assert_eq!((faces.normals[0], faces.depth()), (rest.normals[0], 0.2));
        // What is pulled along one face is as thin as before behind that, and thicker behind the other.
        let (x, y) = (Vector::<2>::new(1.0, 0.0), Vector::<2>::new(0.0, 1.0));
        let edge: Faces<2> = [(x, 0.1), (y, 0.3)].into_iter().collect();
        let mut pulled = edge.clone();
        pulled.follow(&edge, &Tensor::from([[0.5, 0.0], [0.0, 2.0]]));
        assert_eq!((pulled.normals(), pulled.depths()), (&[x, y][..], &[0.05, 0.6][..]));
        // A quarter turn to the left.
        faces.follow(&rest, &Tensor::from([[0.0, 1.0], [-1.0, 0.0]]));
        assert!((faces.normals[0] - Vector::<2>::new(-1.0, 0.0)).norm() < 1e-15);
        faces.follow(&rest, &Tensor::zeros());
        assert!((faces.normals[0] - Vector::<2>::new(-1.0, 0.0)).norm() < 1e-15);
    }

    #[test]
    fn an_edge_faces_where_it_is_looked_at_from() {
        let [x, y] = [Vector::<2>::new(1.0, 0.0), Vector::<2>::new(0.0, 1.0)];
        let edge = Faces::new(vec![x, y], 0.05);
        let diagonal = (x + y).normalize();
        assert_eq!(edge.towards(&(x * 3.0)), x);
        assert_eq!(edge.towards(&(x - y * 0.5)), x);
        assert!((edge.towards(&(x + y)) - diagonal).norm() < 1e-15);
        assert!((edge.towards(&-x) - diagonal).norm() < 1e-15, "from behind");
        assert!((edge.between() - diagonal).norm() < 1e-15);
        // In front of one face is in front of the wall.
        assert!(edge.in_front(&Vector::<2>::new(-0.1, -0.2)).is_some_and(|found| found.0 < -0.05));
        assert_eq!(edge.in_front(&Vector::<2>::new(0.15, -0.2)), Some((0.15 - 0.05, &x)));
        assert_eq!(Faces::<2>::default().in_front(&x), None);
        // Each face is as far away as it is.
        let uneven: Faces<2> = [(x, 0.05), (y, 0.1)].into_iter().collect();
        assert_eq!((uneven.depth(), uneven.depths()), (0.05, &[0.05, 0.1][..]));
        let found = uneven.in_front(&Vector::<2>::new(0.0, 0.25)).expect("two faces");
        assert!((found.0 - 0.15).abs() < 1e-15 && *found.1 == y);
        assert_eq!(Faces::new(vec![x], 0.0).towards(&y), x);
        assert_eq!(Faces::new(vec![x, -x], 0.0).between(), x);
        assert_eq!(Faces::<2>::default().towards(&x), Vector::<2>::zeros());
    }
}
