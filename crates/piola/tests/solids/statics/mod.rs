//! Bodies in equilibrium.

mod cantilever;
mod cells;
mod cube;
mod equilibrium;
pub mod mirrors;
mod paths;
mod pressure;
mod rubber;
mod stiffness;

use std::sync::Arc;

use piola::Vector;
use piola::boundaries::{PrescribedDisplacement, SpaceTime, Traction};
use piola::schemes::total_lagrangian::{Discrete, Gradients, Material, Settings};
use piola::solve::Iteration;
use piola_formulas::hyperelastic::{HyperelasticLaw, LameConstants, Reduced};
use piola_formulas::volumetric::StressState;

use crate::clouds::Cloud;
use crate::support::Function;

/// E of 1 MPa, nu of 0.3.
pub fn constants() -> LameConstants {
    LameConstants::from_young(1e6, 0.3).unwrap()
}

/// A body with patch-consistent gradients.
pub fn body<const D: usize>(
    cloud: &Cloud<D>,
    law: HyperelasticLaw,
    state: StressState,
) -> Discrete<D> {
    let gradients = Gradients::PatchConsistent { areas: cloud.areas.clone() };
    let settings = Settings { gradients, hourglass: 0.1, ..Settings::default() };
    let law = Reduced::new(law, state).unwrap();
    let materials = vec![Material { density: 1000.0, law }];
    Discrete::new(cloud.particles.clone(), cloud.support(), &settings, materials).unwrap()
}

/// A value that grows in proportion to the load factor.
pub fn growing(
    value: impl Fn([f64; 3]) -> f64 + Clone + Send + Sync + 'static,
) -> Arc<dyn SpaceTime> {
    let rate = value.clone();
    Arc::new(Function {
        value: move |x: [f64; 3], factor: f64| factor * value(x),
        rate: move |x: [f64; 3], _: f64| rate(x),
    })
}

/// Dead forces in N that grow in proportion to the load factor.
pub fn forces<const D: usize>(forces: &[Vector<D>]) -> Vec<Traction<D>> {
    let each = forces.iter().enumerate().filter(|(_, force)| force.amax() > 0.0);
    each.map(|(a, force)| {
        let value = std::array::from_fn(|i| {
            let component = force[i];
            growing(move |_| component)
        });
        Traction {
            name: "force".into(),
            particles: vec![a as u32],
            areas: vec![1.0],
            places: vec![],
            value,
        }
    })
    .collect()
}

/// A component of one particle that moves to a place at full load.
pub fn moved<const D: usize>(a: usize, component: usize, to: f64) -> PrescribedDisplacement<D> {
    PrescribedDisplacement::component("hold", vec![a as u32], component, growing(move |_| to))
}

/// Particles whose reference place fulfils a condition.
pub fn select<const D: usize>(cloud: &Cloud<D>, on: impl Fn(&Vector<D>) -> bool) -> Vec<u32> {
    let places = cloud.particles.position.iter().enumerate();
    places.filter(|(_, x)| on(x)).map(|(a, _)| a as u32).collect()
}

/// Whether each of the last iterations squared the residual, but for a factor.
pub fn is_quadratic(iterations: &[Iteration], last: f64, factor: f64) -> bool {
    let mut residuals: Vec<f64> = iterations.iter().map(|i| i.residual).collect();
    residuals.push(last);
    let small: Vec<f64> = residuals.into_iter().filter(|r| *r < 1e-2).collect();
    // Rounding ends it.
    small.len() >= 3 && small.windows(2).all(|pair| pair[1] < factor * pair[0] * pair[0] + 1e-12)
}
