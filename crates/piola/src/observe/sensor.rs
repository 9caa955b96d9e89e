//! What a sensor in a wall measures.

use crate::schemes::Observation;

/// The pressure on a patch of a wall: `-n . sum_w s_w F_w / A` over the particles w behind the patch, where F is the force
/// of the fluid on them, n the normal towards the fluid, and s the share of the cell of each that is in the patch. A is the
/// area of those parts of the first layer, so that a uniform pressure is reproduced wherever the lattice lies.
#[derive(Clone)]
pub struct Sensor {
    /// Indices in memory of the wall particles, with their shares.
    pub particles: Vec<(u32, f64)>,
    /// The unit normal n.
    pub normal: Vec<f64>,
    /// The area A in m^(D-1).
    pub area: f64,
}

impl Sensor {
    /// The share of a particle in a patch of some radius, for its distance from the axis of the patch and its spacing in m:
    /// 1 inside, and a fraction from half a spacing before the edge to half a spacing beyond it.
    pub fn share(distance: f64, radius: f64, spacing: f64) -> f64 {
        ((radius - distance) / spacing + 0.5).clamp(0.0, 1.0)
    }

    /// Renumbers its particles; those without a number no longer count.
    pub fn renumber(&mut self, index: &dyn Fn(u32) -> Option<u32>) {
        let renamed = self.particles.iter().filter_map(|&(a, share)| Some((index(a)?, share)));
        self.particles = renamed.collect();
    }

    pub(super) fn record(&self, now: &mut Observation) -> f64 {
        let particles: Vec<u32> = self.particles.iter().map(|(a, _)| *a).collect();
        let forces = now.values("force", &particles);
        let along = forces.chunks_exact(self.normal.len()).zip(&self.particles).map(
            |(force, (_, share))| -> f64 {
                share * force.iter().zip(&self.normal).map(|(f, n)| f * n).sum::<f64>()
            },
        );
        -along.sum::<f64>() / self.area
    }
}
