//! Irregular clouds of particles with exact volumes and boundary areas.

use nalgebra::DMatrix;
use piola::geometry::Particles;
use piola::neighbors::Domain;
use piola::operators::DirectedSupport;
use piola::{Tensor, Vector};
use piola_formulas::kernels::Kernel;

use crate::support::{jittered, lattice, noise};

/// Nodes of a mesh of simplices with their shares of volume and boundary area.
#[derive(Clone)]
pub struct Cloud<const D: usize> {
    pub particles: Particles<D>,
    /// Outward area vectors.
    pub areas: Vec<Vector<D>>,
}

impl<const D: usize> Cloud<D> {
    /// A box of cells with disordered corners, each cut into simplices along its diagonal
    /// (Kuhn's way). A node takes `V/(D + 1)` of each of its simplices, and `V grad(lambda)` of its
    /// barycentric coordinate, which add up to its share of the surface.
    pub fn simplices(lengths: [f64; D], intervals: [usize; D], jitter: f64) -> Self {
        Self::of(jittered(lengths, intervals, jitter), intervals)
    }

    /// As [`Self::simplices`], with disorder inside only: the faces stay plane.
    pub fn block(lengths: [f64; D], intervals: [usize; D], jitter: f64) -> Self {
        let mut particles = jittered(lengths, intervals, jitter);
        let regular = lattice(lengths, intervals);
        for (x, place) in particles.position.iter_mut().zip(&regular.position) {
            for axis in 0..D {
                if place[axis] == 0.0 || place[axis] == lengths[axis] {
                    x[axis] = place[axis];
                }
            }
        }
        Self::of(particles, intervals)
    }

    /// A lattice moved to other places.
    pub fn bent(
        lengths: [f64; D],
        intervals: [usize; D],
        place: impl Fn(&Vector<D>) -> Vector<D>,
    ) -> Self {
        let mut particles = lattice(lengths, intervals);
        particles.position.iter_mut().for_each(|x| *x = place(x));
        Self::of(particles, intervals)
    }

    fn of(mut particles: Particles<D>, intervals: [usize; D]) -> Self {
        let mut areas = vec![Vector::zeros(); particles.len()];
        particles.volume.iter_mut().for_each(|volume| *volume = 0.0);
        let cells: usize = intervals.iter().product();
        for cell in 0..cells {
            let mut rest = cell;
            let corner: [usize; D] = std::array::from_fn(|axis| {
                let index = rest % intervals[axis];
                rest /= intervals[axis];
                index
            });
            for order in permutations::<D>() {
                let mut at = corner;
                let mut nodes = vec![number(&at, &intervals)];
                for axis in order {
                    at[axis] += 1;
                    nodes.push(number(&at, &intervals));
                }
                share(&mut particles, &mut areas, &nodes);
            }
        }
        particles.weight.clone_from(&particles.volume);
        Self { particles, areas }
    }

    /// Supports of different size for neighbouring particles, from 1.9 to 2.7 spacings.
    pub fn support(&self) -> DirectedSupport<D> {
        let radius = self.particles.spacing.iter().enumerate();
        let radius = radius.map(|(a, spacing)| spacing * (2.3 + 0.4 * noise(7 * a + 3)));
        let radius = radius.collect();
        DirectedSupport::new(&self.particles, Kernel::QuinticSpline, radius, Domain::open())
            .expect("the support exists")
    }
}

fn number<const D: usize>(at: &[usize; D], intervals: &[usize; D]) -> usize {
    (0..D).rev().fold(0, |number, axis| number * (intervals[axis] + 1) + at[axis])
}

/// Orders of the axes.
fn permutations<const D: usize>() -> Vec<[usize; D]> {
    let all: Vec<Vec<usize>> = match D {
        1 => vec![vec![0]],
        2 => vec![vec![0, 1], vec![1, 0]],
        _ => [[0, 1, 2], [0, 2, 1], [1, 0, 2], [1, 2, 0], [2, 0, 1], [2, 1, 0]]
            .map(|order| order.to_vec())
            .to_vec(),
    };
    all.into_iter().map(|order| std::array::from_fn(|k| order[k])).collect()
}

fn share<const D: usize>(particles: &mut Particles<D>, areas: &mut [Vector<D>], nodes: &[usize]) {
    let origin = particles.position[nodes[0]];
    let edges = DMatrix::from_fn(D, D, |i, k| particles.position[nodes[k + 1]][i] - origin[i]);
    let factorial = [1.0, 2.0, 6.0][D - 1];
    let volume = edges.determinant().abs() / factorial;
    let inverse = edges.try_inverse().expect("a simplex has a volume");
    // Rows of the inverse are the gradients of the coordinates of all nodes but the first.
    for (k, &node) in nodes.iter().enumerate() {
        particles.volume[node] += volume / (D + 1) as f64;
        areas[node] += Vector::<D>::from_fn(|i, _| match k {
            0 => -(0..D).map(|row| inverse[(row, i)]).sum::<f64>(),
            _ => inverse[(k - 1, i)],
        }) * volume;
    }
}

/// A displacement gradient of about a tenth, not symmetric.
pub fn some_gradient<const D: usize>() -> Tensor<D> {
    Tensor::from_fn(|i, j| 0.13 * noise(31 * i + 17 * j + 5))
}

/// Displacements without any order, of the size of a part of the spacing.
pub fn disorder<const D: usize>(particles: &Particles<D>, size: f64) -> Vec<Vector<D>> {
    let displacement =
        |a: usize| Vector::from_fn(|i, _| size * particles.spacing[a] * noise(1000 + a * D + i));
    (0..particles.len()).map(displacement).collect()
}
