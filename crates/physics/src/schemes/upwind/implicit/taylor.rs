//! The Taylor test of the tangent, Upwind section 6.2.

use super::equations::StepEquations;
use crate::solve::{Equations, irregular};

impl<const D: usize> StepEquations<'_, D> {
    /// What is left of `r(x + e d) - r(x) - e r'(x) d`, Upwind (6.24) to (6.26), as a norm in kg m/s
    /// for each e of `sizes`: with an exact tangent it falls as e^2. The direction d has no order, and
    /// where e is 1 particles move by about their spacing within the step, and pressures change by
    /// about the modulus.
    pub fn remainders(&mut self, x: &[f64], sizes: &[f64]) -> Vec<f64> {
        let (scheme, split) = (self.scheme, self.parts.solver.reduction().unknowns());
        let least = |numbers: &mut dyn Iterator<Item = f64>| numbers.fold(f64::INFINITY, f64::min);
        let spacing = least(&mut scheme.particles.spacing.iter().copied());
        let wave_speed = least(&mut scheme.reference.iter().map(|side| side.wave_speed));
        let speeds = [spacing / self.parts.weight, wave_speed];
        let direction: Vec<f64> =
            (0..x.len()).map(|k| irregular(k) * speeds[usize::from(k >= split)]).collect();
        let mut at_start = vec![0.0; x.len()];
        let (mut product, mut after) = (at_start.clone(), at_start.clone());
        self.residual(0.0, x, &mut at_start);
        self.product(x, &direction, &mut product);
        let remainder = |&size: &f64| {
            let moved: Vec<f64> = x.iter().zip(&direction).map(|(x, d)| x + size * d).collect();
            self.residual(0.0, &moved, &mut after);
            // The product is that of -r'.
            let terms = after.iter().zip(&at_start).zip(&product);
            let squares = terms.map(|((after, start), k)| (after - start + size * k).powi(2));
            squares.sum::<f64>().sqrt()
        };
        sizes.iter().map(remainder).collect()
    }
}
