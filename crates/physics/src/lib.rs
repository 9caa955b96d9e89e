//! All that computes in piola: particles and who their neighbours are, operators on them, the formulations,
//! integration in time. It reads no case file and draws nothing; meshes and clouds of points it reads, as they are
//! shapes.
//!
//! Its rooms, each of which uses only those further down in this list: [`time`], [`schemes`], [`boundaries`]
//! and [`operators`], [`geometry`] and [`neighbors`], [`solve`] and [`fields`], [`parallel`].

pub mod boundaries;
pub mod fields;
pub mod geometry;
pub mod neighbors;
pub mod operators;
pub mod parallel;
pub mod schemes;
pub mod solve;
pub mod time;

/// A point or vector in `D` dimensions.
pub type Vector<const D: usize> = nalgebra::SVector<f64, D>;
/// A second-order tensor in `D` dimensions.
pub type Tensor<const D: usize> = nalgebra::SMatrix<f64, D, D>;

/// A place in words: coordinates to six digits, of which those that are round-off beside others are 0.
///
/// ```
/// let place = piola_physics::coordinates(&[18.0 / 7.0, 1e-17, -2.5e-6]);
/// assert_eq!(place, "(2.57143, 0, -2.5e-6)");
/// ```
pub fn coordinates(place: &[f64]) -> String {
    let sizes = place.iter().map(|x| x.abs()).filter(|size| size.is_finite());
    let most = sizes.fold(0.0, f64::max);
    let digits = |x: &f64| {
        // What has been written as a number can be read.
        let rounded = format!("{x:.5e}").parse().unwrap_or(*x);
        match rounded.abs() {
            size if size < 1e-9 * most || size == 0.0 => "0".to_owned(),
            size if !(1e-4..1e6).contains(&size) => format!("{rounded:e}"),
            _ => rounded.to_string(),
        }
    };
    format!("({})", place.iter().map(digits).collect::<Vec<_>>().join(", "))
}
