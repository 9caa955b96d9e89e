//! The columns and fields that all matter has. Each kind has a table of its own behind them.

use crate::fields::columns;

columns! {
    pub struct Columns, ColumnsMut, enum Made;
    evolved position: Vector, "m", "current position, inside the periodic box";
    evolved velocity: Vector, "m/s", "momentum velocity u";
    kept deviation: Vector, "m/s", "what the particle moves beyond its velocity";
    derived(0) transport_velocity: Vector, "m/s", "velocity uhat of the particle itself";
    kept kick: Vector, "m/s2", "acceleration for the next kick";
    derived(0) acceleration: Vector, "m/s2", "rate of the momentum velocity";
    derived(0) force: Vector, "N", "total force; on a wall or a solid that of the fluid";
    evolved pressure: Scalar, "Pa", "pressure p, positive in compression";
    evolved density: Scalar, "kg/m3", "density rho used by the scheme";
    derived(1) vorticity: Scalar, "1/s", "curl of u, in 3D its magnitude";
    derived(1) divergence: Scalar, "1/s", "divergence of u";
    derived(2) surface: Scalar, "1", "1 on a free surface, if free surfaces are detected";
    derived(2) surface_normal: Vector, "1", "unit normal near a free surface";
    derived(0) wall: Scalar, "1", "1 for particles of walls, 0 for others";
    constant normal: Vector, "1", "unit normal of walls, towards the fluid";
    derived(1) neighbors: Scalar, "1", "number of neighbours inside the support";
    derived(0) mass: Scalar, "kg", "mass, for 1 m in missing dimensions; of a wall its volume times its density, or times that at rest beside open boundaries or finer regions without `density_relaxation`";
}
