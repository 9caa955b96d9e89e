//! The formulations of `piola-physics`, compiled in 1D: beside the other dimensions, and once for all that runs them.
//! See [`compiled`].

use piola_physics::schemes::{Doors, compiled};

#[used]
static FORMULATIONS: fn() -> Doors = compiled::<1>;
