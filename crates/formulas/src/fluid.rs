//! Laws of weakly compressible fluids, and the coefficients of their exchange between particles.
//!
//! Paper: CTVF. Pairs are named as there: `r_ab = r_a - r_b`, `u_ab = u_a - u_b`.

use nalgebra::SVector;

use crate::Number;

/// Pressure in Pa of the isothermal law `K (rho / rho0 - 1)`, `K = rho0 c^2`, CTVF (8), theory (25).
#[inline]
pub fn pressure<T: Number>(density: T, reference_density: f64, wave_speed: f64) -> T {
    (density - reference_density) * (wave_speed * wave_speed)
}

/// Density in kg/m^3 at which the law of [`pressure`] gives a pressure in Pa.
#[inline]
pub fn density<T: Number>(
    pressure: T,
    reference_density: impl Into<T>,
    wave_speed: impl Into<T>,
) -> T {
    let wave_speed = wave_speed.into();
    pressure / (wave_speed * wave_speed) + reference_density.into()
}

/// Diffusivity of the pressure `alpha h c / 8` in m^2/s, CTVF (24).
#[inline]
pub fn pressure_diffusivity(alpha: f64, smoothing_length: f64, wave_speed: f64) -> f64 {
    alpha * smoothing_length * wave_speed / 8.0
}

/// What keeps the quotients of CTVF (26) to (29) finite: `0.01 h^2` in m^2.
#[inline]
pub fn softening(smoothing_length: f64) -> f64 {
    0.01 * smoothing_length * smoothing_length
}

/// `1 / ((rho_a + rho_b) (r_ab^2 + 0.01 h^2))`, which the exchanges below share.
#[inline(always)]
pub fn exchange_scale<T: Number>(densities: T, square: T, softening: f64) -> T {
    ((square + softening) * densities).recip()
}

/// Diffusion between two particles: `4 nu (r_ab . grad W_ab) scale` with [`exchange_scale`],
/// CTVF (26), theory (23). Times `m_b` and the difference of a field between a and b it is the rate at
/// a of `nu lap`. Negative: what is larger at a than around it falls.
#[inline(always)]
pub fn diffusion<T: Number>(diffusivity: f64, square: T, slope: T, scale: T) -> T {
    square * slope * scale * (4.0 * diffusivity)
}

/// Viscosity between two particles, with the sum of their densities: `4 nu (r_ab . grad W_ab) / (r_ab^2 (rho_a + rho_b))`,
/// which is finite without the softening of CTVF (27), theory (23). Times `m_b u_ab` it is the acceleration of a by
/// `div(rho nu grad u) / rho`.
#[inline(always)]
pub fn viscous_drag<T: Number>(viscosity: f64, slope: T, densities: T) -> T {
    slope * densities.recip() * (4.0 * viscosity)
}

/// Viscous stress between two particles in D dimensions, for `approach = u_ab . r_ab` and [`exchange_scale`]: times `m_b r_ab`
/// it is the acceleration of a, theory (90), of Monaghan and Cleary.
#[inline(always)]
pub fn viscous_push<T: Number, const D: usize>(
    viscosity: f64,
    approach: T,
    slope: T,
    scale: T,
) -> T {
    approach * slope * scale * (4.0 * (D as f64 + 2.0) * viscosity)
}

/// Artificial viscosity `Pi_ab` of particles that approach each other, CTVF (28) with (29), theory (24), for
/// `approach = u_ab . r_ab` and [`exchange_scale`]; zero for those that part.
///
/// It adds to the pressure: `- sum_b m_b Pi_ab grad W_ab`.
#[inline(always)]
pub fn artificial_viscosity<T: Number>(strength: T, approach: T, scale: T) -> T {
    // Pi = -alpha h c phi / mean density, phi = approach / (r^2 + 0.01 h^2).
    T::select(approach.below(0.0), approach * scale * (strength * -2.0), T::zero())
}

/// The factor `1 + R (W_ab / W(dx))^4` of CTVF (35), `ratio = W_ab / W(dx)`, with R = 0.2.
#[inline(always)]
pub fn repulsion<T: Number>(ratio: T) -> T {
    let square = ratio * ratio;
    square * square * 0.2 + 1.0
}

/// A deviation in m/s, shortened to a length where it is longer, as the source of SPST has it.
#[inline(always)]
pub fn shortened<T: Number, const D: usize>(deviation: SVector<T, D>, most: T) -> SVector<T, D> {
    let length = deviation.dot(&deviation).sqrt();
    let (is_long, shorter) = (most.less(length), most / length);
    deviation.map(|component| T::select(is_long, component * shorter, component))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_law_of_state_and_its_inverse() {
        let (reference, wave_speed) = (1000.0, 20.0);
        assert_eq!(pressure(reference, reference, wave_speed), 0.0);
        // K = rho0 c^2 = 4e5 Pa: 1 % of compression is 4000 Pa.
        assert!((pressure(1010.0, reference, wave_speed) - 4000.0_f64).abs() < 1e-9);
        assert!((density(4000.0_f64, reference, wave_speed) - 1010.0).abs() < 1e-9);
    }

    #[test]
    fn only_particles_that_approach_feel_artificial_viscosity() {
        let scale = exchange_scale(2.0, 0.5_f64, softening(1.0));
        assert_eq!(artificial_viscosity(1.0, 0.3, scale), 0.0);
        // -alpha h c (u.r) / (r^2 + 0.01) / rho with alpha h c = 2, u.r = -0.3, rho = 1.
        let expected = 2.0 * 0.3 / 0.51;
        assert!((artificial_viscosity(2.0, -0.3, scale) - expected).abs() < 1e-15);
    }

    #[test]
    fn diffusion_takes_from_the_larger_value() {
        let scale = exchange_scale(2.0, 0.5_f64, softening(1.0));
        let coefficient = diffusion(3.0, 0.5, -7.0, scale);
        assert!((coefficient + 4.0 * 3.0 * 0.5 * 7.0 / (2.0 * 0.51)).abs() < 1e-13);
        assert_eq!(repulsion(0.0), 1.0);
        assert_eq!(repulsion(1.0), 1.2);
    }

    #[test]
    fn a_deviation_keeps_its_direction() {
        let long = SVector::from([3.0, 4.0]);
        assert_eq!(shortened(long, 2.5), SVector::from([1.5, 2.0]));
        assert_eq!(shortened(long, 5.0), long);
        assert_eq!(shortened(long * 0.0, 0.0), long * 0.0);
    }
}
