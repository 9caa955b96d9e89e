//! What is compiled for each number of dimensions by a crate of its own.
//!
//! Generic code is compiled in the crate that names its types, and again in each crate above it; only functions that
//! are never inlined are shared with those above, where a crate below has them for the same types. So the ways into
//! formulations, and into what makes their particles and rows, are `#[inline(never)]`, and `piola-physics-1d`, `-2d` and
//! `-3d`, which can be compiled side by side, name them through this function: the library above, its tests and the
//! program find them compiled. Nothing is lost: methods of formulations are called through `dyn Scheme` anyhow, and the
//! others when a run is set up, with much to do in each call.

use super::Scheme;
use super::interpolation::Interpolation;
use super::total_lagrangian::TotalLagrangian;
use super::transport_velocity::{Hypoelastic, Levels, TransportVelocity, WeaklyCompressible};
use super::upwind::Upwind;
use super::world::World;
use crate::geometry::{
    BoundaryFace, PointCloud, Shape, fill, from_mesh, from_points, surroundings,
};
use crate::neighbors::spatial_order;
use crate::operators::{
    DirectedSupport, DualGradient, GradientOperator, Support, Trace, exposed_areas, lattice_areas,
    nearest_radii, pack, relax,
};

/// Ways into the formulations and to their particles.
pub type Doors = Vec<*const ()>;

/// All formulations in `D` dimensions, and what makes particles and rows for them.
pub fn compiled<const D: usize>() -> Doors {
    type Fluid<const D: usize> = TransportVelocity<D, WeaklyCompressible<D>>;
    type Solids<const D: usize> = TransportVelocity<D, Hypoelastic<D>>;
    vec![
        Upwind::<D>::new as *const (),
        Fluid::<D>::new as *const (),
        Solids::<D>::new as *const (),
        Levels::<D>::new as *const (),
        TotalLagrangian::<D>::new as *const (),
        Interpolation::<D>::new as *const (),
        World::<D>::new as *const (),
        boxed::<Upwind<D>> as *const (),
        boxed::<Fluid<D>> as *const (),
        boxed::<Solids<D>> as *const (),
        boxed::<Levels<D>> as *const (),
        boxed::<TotalLagrangian<D>> as *const (),
        boxed::<Interpolation<D>> as *const (),
        boxed::<World<D>> as *const (),
        Fluid::<D>::terms as *const (),
        Solids::<D>::terms as *const (),
        fill::<D> as *const (),
        surroundings::<D> as *const (),
        from_mesh::<D> as *const (),
        from_points::<D> as *const (),
        PointCloud::particles::<D> as *const (),
        Shape::<D>::ways_out as *const (),
        Shape::<D>::sides as *const (),
        Shape::<D>::exact_volume as *const (),
        BoundaryFace::<D>::samples as *const (),
        pack::<D> as *const (),
        relax::<D> as *const (),
        spatial_order::<D> as *const (),
        Support::<D>::new as *const (),
        DirectedSupport::<D>::of as *const (),
        DualGradient::<D>::of as *const (),
        GradientOperator::<D>::new as *const (),
        Trace::<D>::new as *const (),
        exposed_areas::<D> as *const (),
        lattice_areas::<D> as *const (),
        nearest_radii::<D> as *const (),
    ]
}

/// A formulation whose type is not told any more: a crate that does not ask for its methods does not compile them.
#[inline(never)]
pub fn boxed<S: Scheme + 'static>(scheme: S) -> Box<dyn Scheme> {
    Box::new(scheme)
}
