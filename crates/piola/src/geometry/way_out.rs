//! The shortest way out of a shape.

use super::Shape;
use crate::Vector;

/// Halvings of the turn by which directions are improved.
const HALVINGS: u32 = 40;
/// Steps of a walk along a ray, each as long as the depth allows.
const MOST_STEPS: usize = 200;

impl<const D: usize> Shape<D> {
    /// The direction of the shortest way from `point` inside the shape to space outside of it that
    /// lies between the corners `bounds` in m: the outward normal of the nearest face that is not
    /// on these bounds. `None` where every way leads beyond them.
    ///
    /// Directions are searched from those to the faces, edges and corners of a cube.
    pub fn way_out(&self, point: &Vector<D>, bounds: &(Vector<D>, Vector<D>)) -> Option<Vector<D>> {
        let extent = (bounds.1 - bounds.0).norm();
        let starts = (0..3usize.pow(D as u32)).filter_map(|number| {
            let turn = |axis: usize| (number / 3usize.pow(axis as u32) % 3) as f64 - 1.0;
            Vector::<D>::from_fn(|axis, _| turn(axis)).try_normalize(0.0)
        });
        let length = |direction: &Vector<D>| self.walk(point, direction, bounds, extent);
        let mut best: Option<(f64, Vector<D>)> = None;
        for direction in starts {
            let found = length(&direction);
            // A later direction must be shorter by more than round-off, so that symmetric
            // places choose alike.
            if found < best.map_or(f64::INFINITY, |(least, _)| least * (1.0 - 1e-9)) {
                best = Some((found, direction));
            }
        }
        let (mut least, mut direction) = best?;
        let mut turn = 0.3;
        for _ in 0..HALVINGS {
            for axis in 0..D {
                for sign in [-turn, turn] {
                    let mut tried = direction;
                    tried[axis] += sign;
                    let tried = tried.normalize();
                    let found = length(&tried);
                    if found < least * (1.0 - 1e-12) {
                        (least, direction) = (found, tried);
                    }
                }
            }
            turn *= 0.5;
        }
        Some(direction)
    }

    /// Length of the way out along a direction, infinite if it leaves the bounds.
    fn walk(
        &self,
        point: &Vector<D>,
        direction: &Vector<D>,
        bounds: &(Vector<D>, Vector<D>),
        extent: f64,
    ) -> f64 {
        let least = 1e-9 * extent;
        let mut length = 0.0;
        for _ in 0..MOST_STEPS {
            let place = point + direction * length;
            let inside = (0..D).all(|axis| {
                bounds.0[axis] + least < place[axis] && place[axis] < bounds.1[axis] - least
            });
            let depth = self.depth(&place);
            if depth < 0.0 {
                return if inside { length } else { f64::INFINITY };
            }
            if length > extent {
                break;
            }
            length += depth.max(least);
        }
        f64::INFINITY
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn tank() -> (Shape<2>, (Vector<2>, Vector<2>)) {
        let corner = |x, y| Vector::<2>::new(x, y);
        let outer = Shape::cuboid(corner(-0.3, -0.3), corner(1.3, 1.0)).unwrap();
        let inner = Shape::cuboid(corner(0.0, 0.0), corner(1.0, 2.0)).unwrap();
        (Shape::difference(outer, vec![inner]).unwrap(), (corner(-0.3, -0.3), corner(1.3, 1.0)))
    }

    #[test]
    fn the_walls_of_a_tank_face_its_inside() {
        let (tank, bounds) = tank();
        let way = |x, y| tank.way_out(&Vector::<2>::new(x, y), &bounds).expect("there is a way");
        let close = |way: Vector<2>, x, y| (way - Vector::<2>::new(x, y)).norm() < 1e-4;
        assert!(close(way(0.5, -0.05), 0.0, 1.0));
        assert!(close(way(0.05, -0.25), 0.0, 1.0), "deep in the floor, close to a corner");
        assert!(close(way(-0.25, 0.5), 1.0, 0.0));
        assert!(close(way(1.15, 0.97), -1.0, 0.0), "at the rim");
        let diagonal = 0.5_f64.sqrt();
        assert!(close(way(-0.1, -0.1), diagonal, diagonal));
    }

    #[test]
    fn a_round_wall_has_radial_normals() {
        let center = Vector::<2>::new(1.0, 2.0);
        let ball = Shape::ball(center, 0.5).unwrap();
        let bounds = (Vector::<2>::repeat(-3.0), Vector::<2>::repeat(5.0));
        for angle in [0.1_f64, 0.9, 2.0, 4.0] {
            let radial = Vector::<2>::new(angle.cos(), angle.sin());
            let way = ball.way_out(&(center + radial * 0.4), &bounds).expect("there is a way");
            // Lengths are found to 1e-8 m of 0.1 m, and grow with the square of the turn.
            assert!((way - radial).norm() < 2e-3, "{way} for {radial}");
        }
        // On the bounds there is no way out.
        assert_eq!(ball.way_out(&center, &(center, center)), None);
    }
}
