//! The faces of a wall that a point inside it is behind.

use crate::Vector;

/// The outward unit normals of those faces of a shape that are nearest to a point inside it: one as a
/// rule, several behind an edge, none where there is no way out.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Faces<const D: usize> {
    normals: Vec<Vector<D>>,
}

impl<const D: usize> Faces<D> {
    /// Faces with these unit normals.
    pub fn new(normals: Vec<Vector<D>>) -> Self {
        Self { normals }
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

    /// How far a place is in front of that face which it is most in front of, in m, for the way to
    /// there from a point that lies as deep as the faces are counted from; zero without a face.
    pub fn height(&self, way: &Vector<D>) -> f64 {
        self.normals.iter().map(|normal| way.dot(normal)).reduce(f64::max).unwrap_or(0.0)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_edge_faces_where_it_is_looked_at_from() {
        let [x, y] = [Vector::<2>::new(1.0, 0.0), Vector::<2>::new(0.0, 1.0)];
        let edge = Faces::new(vec![x, y]);
        let diagonal = (x + y).normalize();
        assert_eq!(edge.towards(&(x * 3.0)), x);
        assert_eq!(edge.towards(&(x - y * 0.5)), x);
        assert!((edge.towards(&(x + y)) - diagonal).norm() < 1e-15);
        assert!((edge.towards(&-x) - diagonal).norm() < 1e-15, "from behind");
        assert!((edge.between() - diagonal).norm() < 1e-15);
        // In front of one face is in front of the wall.
        assert_eq!(edge.height(&Vector::<2>::new(0.1, -0.2)), 0.1);
        assert!(edge.height(&Vector::<2>::new(-0.1, -0.2)) < 0.0);
        assert_eq!(Faces::new(vec![x]).towards(&y), x);
        assert_eq!(Faces::new(vec![x, -x]).between(), x);
        assert_eq!(Faces::<2>::default().towards(&x), Vector::<2>::zeros());
    }
}
