//! How far a fluid reaches, and how much of it flows through a plane.

use piola_formulas::kernels::Kernel;

use super::interpolation::way;
use super::probe::within;
use crate::schemes::Observation;

/// The share of space that particles fill at the surface: half of the kernel lies beyond it.
const SURFACE: f64 = 0.5;

/// Places along a gauge that are looked at, in smoothing lengths.
const STRIDE: f64 = 0.25;

/// Halvings between two of these places.
const HALVINGS: usize = 30;

/// How far a fluid reaches along a line, as a gauge in a tank shows it: from the start of the line to the last point
/// on it where `sum_b V_b W(x - x_b)` is one half, 0 if there is none. The line has to be at least a support away
/// from walls.
#[derive(Clone)]
pub struct Gauge {
    /// Both ends of the line in m.
    pub ends: [Vec<f64>; 2],
    /// The kernel.
    pub kernel: Kernel,
    /// Its smoothing length in m.
    pub smoothing_length: f64,
    /// Periods of space in m by axis, infinite where it is open.
    pub periods: Vec<f64>,
    /// Indices in memory of the particles that count, with the volume of each in m^D.
    pub particles: Vec<(u32, f64)>,
}

impl Gauge {
    pub(super) fn record(&self, now: &mut Observation) -> f64 {
        let dimension = now.scheme().dimension();
        let particles: Vec<u32> = self.particles.iter().map(|(a, _)| *a).collect();
        let places = now.values("position", &particles);
        let bodies = now.scheme().bodies();
        let is_there =
            |a: u32| now.scheme().body_of(now.state(), a as usize) == Some(bodies[a as usize]);
        let [start, end] = &self.ends;
        let along: Vec<f64> = start.iter().zip(end).map(|(start, end)| end - start).collect();
        let length = along.iter().map(|x| x * x).sum::<f64>().sqrt();
        let reach = self.kernel.support_radius(self.smoothing_length);
        let direction: Vec<f64> = along.iter().map(|x| x / length).collect();
        let middle: Vec<f64> = start.iter().zip(end).map(|(a, b)| 0.5 * (a + b)).collect();
        // Where particles are along the line and how far from it, of those within reach.
        let near = places.chunks_exact(dimension).zip(&self.particles).filter_map(|(x, own)| {
            let offset = way(&middle, x, &self.periods);
            let along: f64 = offset.clone().zip(&direction).map(|(x, e)| x * e).sum();
            let across = offset.map(|x| x * x).sum::<f64>() - along * along;
            (across < reach * reach && is_there(own.0)).then_some((
                along + 0.5 * length,
                across.max(0.0),
                own.1,
            ))
        });
        let near: Vec<(f64, f64, f64)> = near.collect();
        let share = |at: f64| -> f64 {
            let terms = near.iter().map(|(along, across, volume)| {
                let distance = ((along - at).powi(2) + across).sqrt();
                volume * self.kernel.value::<f64>(dimension, distance, self.smoothing_length)
            });
            terms.sum()
        };
        let strides = (length / (STRIDE * self.smoothing_length)).ceil().max(1.0) as usize;
        let place = |k: usize| length * k as f64 / strides as f64;
        let Some(last) = (0..=strides).rev().find(|&k| share(place(k)) >= SURFACE) else {
            return 0.0;
        };
        if last == strides {
            return length;
        }
        let (mut inside, mut outside) = (place(last), place(last + 1));
        for _ in 0..HALVINGS {
            let middle = 0.5 * (inside + outside);
            if share(middle) >= SURFACE { inside = middle } else { outside = middle }
        }
        0.5 * (inside + outside)
    }
}

/// The mass that flows through a plane per second, `sum_b m_b v_b . n K(d_b)`, d being the distance from the plane
/// and K a hat as wide as two spacings on each side: integrated over the time in which a particle goes through it
/// this is the mass of the particle.
#[derive(Clone)]
pub struct Flux {
    /// A point of the plane in m.
    pub point: Vec<f64>,
    /// Its unit normal.
    pub normal: Vec<f64>,
    /// Half the width of the hat in m.
    pub reach: f64,
    /// Periods of space in m by axis, infinite where it is open.
    pub periods: Vec<f64>,
    /// Corners in m of a box outside of which nothing counts.
    pub inside: Option<[Vec<f64>; 2]>,
    /// Indices in memory of the particles that count.
    pub particles: Vec<u32>,
}

impl Flux {
    pub(super) fn record(&self, now: &mut Observation) -> f64 {
        let dimension = now.scheme().dimension();
        let particles = now.present(&self.particles);
        let counted = match &self.inside {
            None => particles.into_owned(),
            Some(corners) => within(corners, &particles, now),
        };
        let places = now.values("position", &counted);
        let velocities = now.values("velocity", &counted);
        let along = |vector: &mut dyn Iterator<Item = f64>| -> f64 {
            vector.zip(&self.normal).map(|(x, n)| x * n).sum()
        };
        let scheme = now.scheme();
        let both = places.chunks_exact(dimension).zip(velocities.chunks_exact(dimension));
        both.zip(&counted)
            .map(|((place, velocity), &a)| {
                let distance = along(&mut way(&self.point, place, &self.periods)).abs();
                let share = (1.0 - distance / self.reach).max(0.0) / self.reach;
                scheme.mass(a as usize) * along(&mut velocity.iter().copied()) * share
            })
            .sum()
    }
}
