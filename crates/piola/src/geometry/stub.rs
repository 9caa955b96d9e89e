#![allow(missing_docs)]
use super::Particles;
use crate::Vector;
pub fn lattice<const D: usize>(min: Vector<D>, max: Vector<D>, dx: Vector<D>) -> Particles<D> {
    let n: [usize; D] =
        std::array::from_fn(|k| (((max[k] - min[k]) / dx[k]).round() as usize).max(1));
    let mut particles = Particles::default();
    let count: usize = n.iter().map(|n| n + 1).product();
    for number in 0..count {
        let (mut rest, mut position, mut volume, mut weight) = (number, Vector::zeros(), 1.0, 1.0);
        for axis in 0..D {
            let index = rest % (n[axis] + 1);
            rest /= n[axis] + 1;
            let cell = (max[axis] - min[axis]) / n[axis] as f64;
            position[axis] = min[axis] + (max[axis] - min[axis]) * index as f64 / n[axis] as f64;
            weight *= cell;
            volume *= if index == 0 || index == n[axis] { 0.5 * cell } else { cell };
        }
        particles.position.push(position);
        particles.volume.push(volume);
        particles.weight.push(weight);
        particles.spacing.push((0..D).map(|k| (max[k] - min[k]) / n[k] as f64).fold(0.0, f64::max));
        particles.body.push(0);
        particles.id.push(number as u32);
    }
    particles
}
