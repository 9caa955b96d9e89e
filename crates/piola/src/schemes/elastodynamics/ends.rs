//! The ends of a row of particles in the strong form: ghosts that are made from the row.

use super::settings::Mixture;
use crate::operators::{
    Continuation, Cover, FoldedGradient, GradientForm, Mirror, OperatorError, PlaneData, images,
};
use crate::{Tensor, Vector};

/// Steps of Newton's method for the slope at a loaded end.
const MOST_STEPS: usize = 60;

/// One end of a row.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct End {
    /// The particle that lies on it.
    pub particle: usize,
    /// Whether it is the upper one.
    pub is_upper: bool,
    /// Whether its velocity is prescribed; otherwise its stress is, if only as zero.
    pub is_held: bool,
}

/// Both ends, with the matrix that takes the divergence of the stress. Displacements are odd about a
/// held end and have the slope of the load at a loaded one; stresses are even about the one and odd
/// about the other, theory (64).
pub(super) struct Ends<const D: usize> {
    pub ends: Vec<End>,
    pub divergence: FoldedGradient<D>,
}

impl Continuation {
    fn of_displacement(end: &End) -> Self {
        if end.is_held { Self::Odd } else { Self::Slope }
    }

    fn of_stress(end: &End) -> Self {
        if end.is_held { Self::Even } else { Self::Odd }
    }
}

/// Matrices of displacements and of stresses of a row with its ends at `cover.particles`, whose own
/// images are not used.
pub(super) fn matrices<const D: usize>(
    cover: &Cover<'_, D>,
    ends: &[End],
) -> Result<[FoldedGradient<D>; 2], OperatorError> {
    let reach = cover.radius.iter().copied().fold(0.0, f64::max);
    let particles = cover.particles;
    let of = |continuation: fn(&End) -> Continuation| {
        let mirror = |end: &End| Mirror {
            axis: 0,
            place: particles.position[end.particle][0],
            is_upper: end.is_upper,
            continuation: continuation(end),
        };
        let mirrors: Vec<Mirror> = ends.iter().map(mirror).collect();
        let made = images(&particles.position, &particles.spacing, &mirrors, reach);
        let cover = Cover {
            particles,
            group: cover.group,
            images: &made,
            kernel: cover.kernel,
            radius: cover.radius,
            domain: cover.domain,
        };
        FoldedGradient::new(&cover, GradientForm::Plain)
    };
    Ok([of(Continuation::of_displacement)?, of(Continuation::of_stress)?])
}

impl<const D: usize> Ends<D> {
    /// The data of displacements and of stresses, from what is known of each end: its displacement in
    /// m if it is held, its stress in Pa and the slope that belongs to it otherwise.
    pub fn data(&self, of: impl Fn(&End) -> [f64; 2]) -> [PlaneData<D>; 2] {
        let mut data = [[[0.0; 2]; D]; 2];
        for end in &self.ends {
            let side = usize::from(end.is_upper);
            let [first, second] = of(end);
            data[0][0][side] = first;
            data[1][0][side] = if end.is_held { 0.0 } else { second };
        }
        data
    }

    /// The loaded ends.
    pub fn loaded(&self) -> impl Iterator<Item = &End> {
        self.ends.iter().filter(|end| !end.is_held)
    }
}

/// The displacement gradient along the row at which a material has a stress along it, in Pa.
///
/// By Newton's method from rest, with steps that do not lead through the point where there is no
/// length left.
pub(super) fn slope_of<const D: usize>(mixture: &Mixture<D>, stress: f64) -> f64 {
    if stress == 0.0 {
        return 0.0;
    }
    let along = |slope: f64| {
        let mut gradient = Tensor::<D>::zeros();
        gradient[(0, 0)] = slope;
        gradient
    };
    let mut slope = 0.0_f64;
    for _ in 0..MOST_STEPS {
        let gradient = along(slope);
        let rest = mixture.stress(&gradient)[(0, 0)] - stress;
        let stiffness = mixture.wave_moduli(&gradient)[1];
        let change = -rest / stiffness;
        if !change.is_finite() {
            return f64::NAN;
        }
        let next = (slope + change).max(0.5 * (slope - 1.0));
        if (next - slope).abs() <= 4.0 * f64::EPSILON * (1.0 + slope.abs()).min(slope.abs()) {
            return next;
        }
        slope = next;
    }
    slope
}

/// The unit vector along a row, out of an end.
pub(super) fn outward<const D: usize>(end: &End) -> Vector<D> {
    let mut normal = Vector::zeros();
    normal[0] = if end.is_upper { 1.0 } else { -1.0 };
    normal
}
