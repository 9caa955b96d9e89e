//! The motion of one rigid body, in space in any dimension.

use nalgebra::{Matrix3, Rotation3, SMatrix, SVector, Vector3};

use crate::Vector;
use crate::boundaries::padded;

/// Components of a motion: those of V, then those of W.
pub const COMPONENTS: usize = 6;

/// Most iterations for the rotation of a step.
const MOST_ITERATIONS: usize = 50;

/// A motion of a body: the velocity, or the acceleration, of its point, and about it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Motion {
    pub velocity: Vector3<f64>,
    pub spin: Vector3<f64>,
}

impl Motion {
    /// What it is at an arm from its point.
    pub fn at(&self, arm: &Vector3<f64>) -> Vector3<f64> {
        self.velocity + self.spin.cross(arm)
    }
}

/// Moments of a body about its point: its mass, mass times centre, the inertia, and both momenta.
pub struct Moments {
    pub mass: f64,
    pub first: Vector3<f64>,
    pub inertia: Matrix3<f64>,
    pub linear: Vector3<f64>,
    pub angular: Vector3<f64>,
}

impl Moments {
    /// The motion with these momenta where components are as `held`.
    pub fn motion(&self, held: &[Option<f64>; COMPONENTS]) -> Motion {
        let across = self.first.cross_matrix();
        let mut matrix = SMatrix::<f64, COMPONENTS, COMPONENTS>::zeros();
        matrix.fixed_view_mut::<3, 3>(0, 0).copy_from(&(Matrix3::identity() * self.mass));
        matrix.fixed_view_mut::<3, 3>(0, 3).copy_from(&-across);
        matrix.fixed_view_mut::<3, 3>(3, 0).copy_from(&across);
        matrix.fixed_view_mut::<3, 3>(3, 3).copy_from(&self.inertia);
        let mut momenta = SVector::<f64, COMPONENTS>::zeros();
        momenta.fixed_rows_mut::<3>(0).copy_from(&self.linear);
        momenta.fixed_rows_mut::<3>(3).copy_from(&self.angular);
        for (k, value) in held.iter().enumerate().filter_map(|(k, held)| Some((k, (*held)?))) {
            momenta -= matrix.column(k) * value;
        }
        for (k, value) in held.iter().enumerate().filter_map(|(k, held)| Some((k, (*held)?))) {
            matrix.row_mut(k).fill(0.0);
            matrix.column_mut(k).fill(0.0);
            matrix[(k, k)] = 1.0;
            momenta[k] = value;
        }
        let nothing = SVector::<f64, COMPONENTS>::repeat(f64::NAN);
        let all = matrix.cholesky().map_or(nothing, |factor| factor.solve(&momenta));
        Motion { velocity: all.fixed_rows::<3>(0).into(), spin: all.fixed_rows::<3>(3).into() }
    }
}

/// A vector in space.
pub fn in_space<const D: usize>(vector: &Vector<D>) -> Vector3<f64> {
    Vector3::from(padded(vector))
}

/// The components that there are in `D` dimensions of a vector in space.
pub fn in_plane<const D: usize>(vector: &Vector3<f64>) -> Vector<D> {
    Vector::from_fn(|i, _| vector[i])
}

/// The components of motions that there are not in `dimension` dimensions.
pub fn is_missing(dimension: usize, component: usize) -> bool {
    match component {
        0..3 => component >= dimension,
        5 => dimension < 2,
        _ => dimension < 3,
    }
}

/// The rotation of a body in `step` s on which nothing acts, and its angular velocity behind it, theory (84): of
/// a body with this inertia and angular velocity.
pub fn turn_freely(
    inertia: &Matrix3<f64>,
    spin: &Vector3<f64>,
    step: f64,
) -> (Matrix3<f64>, Vector3<f64>) {
    let Some(inverse) = inertia.try_inverse() else {
        return (Matrix3::identity(), Vector3::repeat(f64::NAN));
    };
    let momentum = inertia * spin;
    // Seen from the body, at both ends of the step.
    let mut last = *spin;
    let mean = |last: &Vector3<f64>| (spin + last) * 0.5;
    for _ in 0..MOST_ITERATIONS {
        let next = inverse * (Rotation3::new(mean(&last) * -step) * momentum);
        let change = (next - last).norm();
        last = next;
        if change <= f64::EPSILON * spin.norm() {
            break;
        }
    }
    let turned = Rotation3::new(mean(&last) * step);
    (*turned.matrix(), turned * last)
}
