//! SPH operators on frozen neighbour lists: gradients with their corrections and adjoints, and the
//! least-squares gradient.
//!
//! An operator is built once from the reference positions and then applied every step. Its rows
//! are gathered: particle a sums over its own neighbours in a fixed order. [`MovingSupport`] is for
//! particles that move: it shows the neighbours of the moment to the sums of a scheme.

mod adjoint;
mod areas;
mod block;
mod boundary_values;
mod continued;
mod directed;
mod dual_gradient;
mod error;
mod frozen;
mod gather;
mod gradient;
mod images;
mod inside;
mod lattice_areas;
mod least_squares;
mod moving;
mod packing;
mod patch;
mod reference;
mod relax;
mod slots;
mod sparse;
mod sph_matrices;
mod stencil;
mod strained;
mod support;
mod trace;

pub(crate) use adjoint::AdjointPairs;
pub use areas::PairAreas;
pub use block::NeighborBlock;
pub use boundary_values::{BoundaryValueError, ModifiedMatrix, POOR_CONDITION, raise_ghosts};
pub use continued::{ContinuedGradient, Ghost, Share};
pub use directed::{DirectedSupport, nearest_radii};
pub use dual_gradient::DualGradient;
pub(crate) use dual_gradient::dual_row;
pub use error::OperatorError;
pub use frozen::{Columns, FrozenRows, LANES, Lanes, Row, RowSizes};
pub use gather::{
    Among, OfCenter, OfOther, Pairs, Same, Source, Sum, Term, add_at, gather, gather_parts, sum_at,
    visit,
};
pub use gradient::{Correction, GradientOperator};
pub use images::{Continuation, Image, Mirror, images};
pub use lattice_areas::{exposed_areas, lattice_areas};
pub use least_squares::LeastSquares;
pub use moving::{MovingSupport, Remaining};
pub use packing::{Packing, PackingError, pack};
pub(crate) use reference::Pairs as ReferencePairs;
pub use reference::{PlaneData, ReferenceGradient};
pub use relax::relax;
pub use slots::Slots;
pub use sparse::SparseOperator;
pub use sph_matrices::SphMatrices;
pub use stencil::{Cover, GradientForm};
pub(crate) use strained::stabilised;
pub use strained::{Strained, one_by_one};
pub use support::Support;
pub use trace::{Face, Trace};
