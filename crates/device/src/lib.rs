//! The formulas of piola as text for other machines.
//!
//! A law is a Rust function that is generic over [`Number`](piola_formulas::Number). Run once with
//! [`Traced`] numbers it is recorded as a [`Law`]: a list of operations, without those that would be
//! done twice. A law can be [run](Law::run) here, with the bits of the function itself, or written as
//! [text](Law::text) in C, OpenCL C or CUDA C++, in double or single precision. There is no second
//! source of a formula. In double precision a device has the bits of the processor: the exponentials,
//! logarithms and circular functions in the text are those of [`functions`](piola_formulas::functions).
//!
//! - [`laws`] is the list of all laws by name: kernels, elastic solids, volumetric materials, fluids.
//! - [`Gather`] writes loops over neighbours around pair laws, [`local`] passes over particles around laws of one.
//! - [`lists`] are neighbours that a device finds.
//! - [`Device`] is a GPU, or a processor with OpenCL, that compiles and runs them. Nothing of CUDA or
//!   OpenCL is needed to build.

mod card;
pub mod cuda;
mod device;
mod dialect;
mod error;
mod gather;
mod law;
pub mod laws;
pub mod lists;
mod machine;
mod opencl;
mod operators;
mod pass;
mod record;
pub mod reduce;
mod text;
mod work;

pub use card::{CARDS, Card};
pub use device::{Argument, Column, Device, Element, Found, Kernel, Program, devices, missing};
pub use dialect::{Dialect, Layout};
pub use error::DeviceError;
pub use gather::{Among, Frozen, Gather, Meeting, Meets, Order, Rows, Space};
pub use law::{Law, Outputs};
pub use machine::Machine;
pub use pass::{Ask, At, Pass, Use, difference, filled, flat, local, own, spread, through};
pub use record::{Traced, Truth};
pub use text::{Language, Precision};
pub use work::{Operations, Work};
