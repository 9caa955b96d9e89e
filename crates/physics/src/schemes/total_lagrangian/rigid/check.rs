//! Rigid bodies that no motion is known of.

use piola_formulas::tensor;

use super::RigidBody;
use super::motion::is_missing;
use crate::geometry::Particles;
use crate::schemes::input::{check_index, check_selected};
use crate::schemes::total_lagrangian::TotalLagrangianError;
use crate::{Tensor, Vector};

/// The share of its largest extent below which a body is flat.
const FLAT: f64 = 1e-9;

/// Refuses bodies that no motion is known of.
pub(in super::super) fn check<const D: usize>(
    bodies: &[RigidBody<D>],
    particles: &Particles<D>,
    periodic: &[Option<[f64; 2]>; D],
) -> Result<(), TotalLagrangianError> {
    let mut is_taken = vec![false; particles.len()];
    for body in bodies {
        check_selected(&body.name, &body.particles, particles.len())?;
        let velocities = body.velocity.iter().map(|&(component, _)| (component, component < D));
        let spins = body.angular_velocity.iter();
        let spins = spins
            .map(|&(component, _)| (component, component < 3 && !is_missing(D, 3 + component)));
        for (component, is_there) in velocities.chain(spins) {
            let what = || format!("`{}`: component", body.name);
            check_index(what, component, if is_there { component + 1 } else { 0 })?;
        }
        let places = || body.particles.iter().map(|&a| particles.position[a as usize]);
        let count = body.particles.len() as f64;
        let centre = places().sum::<Vector<D>>() / count;
        let spread = places().map(|place| (place - centre) * (place - centre).transpose());
        let spread = spread.sum::<Tensor<D>>();
        let size = spread.trace();
        let is_flat = !(tensor::smallest_eigenvalue(&spread) > FLAT * size);
        // A line in space turns freely about itself, and a point about everything.
        let inertia = Tensor::<D>::identity() * size - spread;
        let has_inertia = match D {
            1 => count > 0.0,
            2 => size > 0.0,
            _ => tensor::smallest_eigenvalue(&inertia) > FLAT * size,
        };
        let moved = |axis: usize| body.velocity.iter().any(|(component, _)| *component == axis);
        let turned = body.angular_velocity.len();
        let take = |&a: &u32| std::mem::replace(&mut is_taken[a as usize], true);
        let shares = body.particles.iter().map(take).fold(false, |any, one| any | one);
        let is_torn = (0..D).any(|axis| {
            let period = periodic[axis].map_or(f64::INFINITY, |[low, high]| high - low);
            let ends = [f64::INFINITY, f64::NEG_INFINITY];
            let [low, high] = places()
                .fold(ends, |[low, high], place| [low.min(place[axis]), high.max(place[axis])]);
            high - low > 0.5 * period
        });
        let fault = match () {
            () if shares => {
                "has a particle twice, or one that belongs to another rigid body; merge them into \
                 one body"
            }
            () if !has_inertia => {
                "lies on a line, about which it has no inertia; give it more than one particle across"
            }
            () if body.pivot.is_some() && is_flat => {
                "is flat, so that its pivot is not carried along; give it more than one particle across"
            }
            () if is_torn => {
                "is longer than half of the period of the domain, or crosses its bound; move it, or make the domain longer"
            }
            () if body.pivot.is_some() && !(0..D).all(moved) => {
                "has a pivot that is free to move; prescribe all components of `velocity` there, or remove `pivot`"
            }
            () if D == 3 && turned == 1 => {
                "has one prescribed component of its angular velocity, which its nutation about the other two axes \
                 would make unstable; prescribe two, or all, or none"
            }
            () => continue,
        };
        return Err(TotalLagrangianError::Rigid { name: body.name.clone(), fault });
    }
    Ok(())
}
