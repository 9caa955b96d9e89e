//! Tractions as forces that a homogeneous stress is in equilibrium with.

use crate::Vector;
use crate::boundaries::Traction;
use crate::boundaries::traction::Loaded;
use crate::geometry::Particles;
use crate::operators::ReferenceGradient;
use crate::{Tensor, parallel};

/// How far loaded particles may be off their plane, in spacings.
const FLAT: f64 = 1e-6;

/// How far the foot of a particle may be from a loaded one, in spacings of that.
const BESIDE: f64 = 1.0;

/// By how much the sum of the areas of the gradient may differ from the area of the face.
const COMPLETE: f64 = 0.2;

/// The body as loads need it.
pub(super) struct Body<'a, const D: usize> {
    pub particles: &'a Particles<D>,
    pub operator: &'a ReferenceGradient<D>,
    pub group: &'a [u32],
    pub radius: &'a [f64],
}

impl<const D: usize> Body<'_, D> {
    /// The forces of a traction on a plane face with normal N.
    ///
    /// Under a homogeneous stress P the forces of (63) are `- P A_q` with the area vectors
    /// `A_q = sum_p V_p X_pq`. They vanish inside, but beside a face they are spread over as many
    /// layers as covers reach, and a load on the outermost layer alone is in equilibrium with another
    /// stress there. The load is therefore taken as `t (N . A_q)`, on the particles behind the face,
    /// scaled so that the whole force is that of the face.
    ///
    /// A face that is not plane, or of which the particles do not make one, is loaded as it is.
    pub fn loads(&self, traction: &Traction<D>) -> Vec<Loaded<D>> {
        let positions = &self.particles.position;
        self.spread(traction).unwrap_or_else(|| traction.loaded(positions).collect())
    }

    fn spread(&self, traction: &Traction<D>) -> Option<Vec<Loaded<D>>> {
        let (positions, spacing) = (&self.particles.position, &self.particles.spacing);
        let loaded: Vec<usize> = traction.particles.iter().map(|&a| a as usize).collect();
        let (&first, total) = (loaded.first()?, traction.areas.iter().sum::<f64>());
        let normal = self.normal(&loaded)?;
        let group = self.group[first];
        let depth = |q: usize| normal.dot(&(positions[q] - positions[first]));
        if !loaded.iter().all(|&a| self.group[a] == group && depth(a).abs() < FLAT * spacing[a]) {
            return None;
        }
        let own = || (0..positions.len()).filter(|&q| self.group[q] == group);
        let extent = own().map(|q| depth(q).abs()).fold(0.0, f64::max);
        let reach = loaded.iter().map(|&a| 2.0 * self.radius[a]).fold(0.0, f64::max);
        let reach = reach.min(0.5 * extent);
        let behind: Vec<(usize, Vector<D>)> = own()
            .filter(|&q| depth(q).abs() <= reach)
            .map(|q| (q, positions[q] - normal * depth(q)))
            .filter(|(_, foot)| {
                let is_beside = |&a: &usize| (positions[a] - foot).norm() <= BESIDE * spacing[a];
                loaded.iter().any(is_beside)
            })
            .collect();
        let areas = self.areas(&normal);
        let sum: Vector<D> = behind.iter().map(|(q, _)| areas[*q]).sum();
        // The normal may point either way, and what a plane turns round has no sum.
        let scale = Vector::<D>::from_fn(|i, _| total / sum[i]);
        let is_complete = |i: usize| (scale[i].abs() - 1.0).abs() < COMPLETE;
        if !(0..D).all(|i| is_complete(i) || self.is_zero(traction, i)) {
            return None;
        }
        let load = |(q, foot): &(usize, Vector<D>)| {
            let area =
                Vector::from_fn(|i, _| if is_complete(i) { areas[*q][i] * scale[i] } else { 0.0 });
            traction.at(*q, area, foot)
        };
        Some(behind.iter().map(load).collect())
    }

    /// `N . A_q` of all particles, for each component of the displacement.
    fn areas(&self, normal: &Vector<D>) -> Vec<Vector<D>> {
        let volume = &self.particles.volume;
        let still = vec![Vector::zeros(); volume.len() + self.operator.images()];
        let mut tension = vec![Tensor::<D>::zeros(); still.len()];
        parallel::for_each_chunk(&mut tension[..volume.len()], |start, rows| {
            for (offset, tension) in rows.iter_mut().enumerate() {
                *tension = Tensor::from_fn(|_, j| -volume[start + offset] * normal[j]);
            }
        });
        let mut areas = still.clone();
        self.operator.forces(&still, &tension, &mut areas);
        self.operator.fold(&mut areas);
        areas
    }

    /// The normal of a plane through particles, if they make one.
    fn normal(&self, loaded: &[usize]) -> Option<Vector<D>> {
        let positions = &self.particles.position;
        let first = *loaded.first()?;
        let mut along: Vec<Vector<D>> = Vec::new();
        let across = |place: Vector<D>, along: &[Vector<D>]| {
            along.iter().fold(place, |rest, edge| rest - edge * edge.dot(&rest))
        };
        while along.len() + 1 < D {
            let rest = |&a: &usize| across(positions[a] - positions[first], &along);
            let far = loaded.iter().map(rest).fold(Vector::zeros(), |far: Vector<D>, rest| {
                if rest.norm() > far.norm() { rest } else { far }
            });
            if far.norm() < FLAT * self.particles.spacing[first] {
                return None;
            }
            along.push(far.normalize());
        }
        let axis = |k: usize| Vector::<D>::from_fn(|i, _| f64::from(u8::from(i == k)));
        let rest = (0..D).map(|k| across(axis(k), &along));
        let best = rest.fold(
            Vector::zeros(),
            |best: Vector<D>, rest| {
                if rest.norm() > best.norm() { rest } else { best }
            },
        );
        Some(best.normalize())
    }

    /// Whether a component of the load is nothing at any time, as far as that is known.
    fn is_zero(&self, traction: &Traction<D>, component: usize) -> bool {
        let value = &traction.value[component];
        let mut parts = traction.parts(&self.particles.position);
        value.is_steady() && parts.all(|(_, _, place)| value.value(place, 0.0) == 0.0)
    }
}
