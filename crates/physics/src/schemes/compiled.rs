//! What is compiled for each number of dimensions by a crate of its own.
//!
//! Generic code is compiled in the crate that names its types, and again in each crate above it; only functions that
//! are never inlined are shared with those above, where a crate below has them for the same types. So the ways into
//! formulations are `#[inline(never)]`, and `piola-physics-1d`, `-2d` and `-3d`, which can be compiled side by side,
//! name them through this function: the library above, its tests and the program find them compiled. Each is called
//! once for a run or a step, so that nothing is lost.

use super::Scheme;
use super::interpolation::Interpolation;
use super::total_lagrangian::TotalLagrangian;
use super::transport_velocity::{Hypoelastic, Levels, TransportVelocity, WeaklyCompressible};
use super::upwind::Upwind;
use super::world::World;

/// Ways into the formulations.
pub type Doors = [*const (); 14];

/// All formulations in `D` dimensions.
pub fn compiled<const D: usize>() -> Doors {
    type Fluid<const D: usize> = TransportVelocity<D, WeaklyCompressible<D>>;
    type Solids<const D: usize> = TransportVelocity<D, Hypoelastic<D>>;
    [
        Upwind::<D>::new as *const (),
        Fluid::<D>::new as *const (),
        Solids::<D>::new as *const (),
        Levels::<D>::new as *const (),
        TotalLagrangian::<D>::new as *const (),
        Interpolation::<D>::new as *const (),
        World::<D>::new as *const (),
        methods::<Upwind<D>> as *const (),
        methods::<Fluid<D>> as *const (),
        methods::<Solids<D>> as *const (),
        methods::<Levels<D>> as *const (),
        methods::<TotalLagrangian<D>> as *const (),
        methods::<Interpolation<D>> as *const (),
        methods::<World<D>> as *const (),
    ]
}

/// All methods of a formulation.
fn methods<S: Scheme + 'static>(scheme: &mut S) -> &mut dyn Scheme {
    scheme
}
