//! Implicit steps of second order in time, and what a formulation offers for them.

use thiserror::Error;

use super::{NoSolution, Scheme};

/// The weights of one implicit step of `M a = f(u, t)`, theory (53): those of Newmark (1959) and the
/// instants at which inertia and forces balance, of Chung and Hulbert (1993).
///
/// ```text
/// u' = u + h v + h^2 [(1/2 - beta) a + beta a'],   v' = v + h [(1 - gamma) a + gamma a']
/// M [(1 - alpha_m) a' + alpha_m a] = f((1 - alpha_f) u' + alpha_f u, t + (1 - alpha_f) h)
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Newmark {
    beta: f64,
    gamma: f64,
    alpha_m: f64,
    alpha_f: f64,
}

/// Weights with which no step is safe, however small, or only small ones are.
#[derive(Clone, Copy, Debug, Error, PartialEq)]
#[error(
    "beta = {beta} and gamma = {gamma} do not give unconditionally stable steps: \
     2 beta >= gamma >= 1/2 does, and gamma = 1/2 is of second order"
)]
pub struct UnstableWeights {
    /// Weight of the new acceleration in the displacement.
    pub beta: f64,
    /// Weight of the new acceleration in the velocity.
    pub gamma: f64,
}

impl Newmark {
    /// The acceleration is the mean of both ends: no damping, and of a linear body the energy is kept.
    pub const AVERAGE_ACCELERATION: Self =
        Self { beta: 0.25, gamma: 0.5, alpha_m: 0.0, alpha_f: 0.0 };

    /// Newmark's method.
    ///
    /// # Errors
    /// [`UnstableWeights`].
    pub fn new(beta: f64, gamma: f64) -> Result<Self, UnstableWeights> {
        if !(2.0 * beta >= gamma && gamma >= 0.5 && beta.is_finite()) {
            return Err(UnstableWeights { beta, gamma });
        }
        Ok(Self { beta, gamma, alpha_m: 0.0, alpha_f: 0.0 })
    }

    /// The method of Hilber, Hughes and Taylor (1977): forces at `u' - alpha (u' - u)`, of second
    /// order, with a damping of short periods that grows with alpha from 0 to 1/3.
    pub fn hilber_hughes_taylor(alpha: f64) -> Self {
        let alpha = alpha.clamp(0.0, 1.0 / 3.0);
        let beta = 0.25 * (1.0 + alpha).powi(2);
        Self { beta, gamma: 0.5 + alpha, alpha_m: 0.0, alpha_f: alpha }
    }

    /// The generalised-alpha method of Chung and Hulbert (1993): of second order, with the least
    /// damping of long periods for a given `radius`, by which a step multiplies the shortest ones.
    /// A radius of 1 is the implicit midpoint rule, without damping, which keeps linear and
    /// angular momentum of any body.
    pub fn generalised_alpha(radius: f64) -> Self {
        let radius = radius.clamp(0.0, 1.0);
        let alpha_m = (2.0 * radius - 1.0) / (radius + 1.0);
        let alpha_f = radius / (radius + 1.0);
        let gamma = 0.5 - alpha_m + alpha_f;
        Self { beta: 0.25 * (0.5 + gamma).powi(2), gamma, alpha_m, alpha_f }
    }

    /// Whether it takes energy from periods that are short against its steps.
    pub fn damps(&self) -> bool {
        self.gamma > 0.5
    }

    /// Order of its errors in the length of a step.
    pub fn order(&self) -> i32 {
        let second = 0.5 - self.alpha_m + self.alpha_f;
        if (self.gamma - second).abs() < 1e-12 { 2 } else { 1 }
    }

    /// How far into a step forces are evaluated, `1 - alpha_f`.
    pub fn reach(&self) -> f64 {
        1.0 - self.alpha_f
    }

    /// `da/du` in 1/s^2, where a is the acceleration that balances the forces of the displacement u,
    /// in a step of `step` s.
    pub fn stiffening(&self, step: f64) -> f64 {
        (1.0 - self.alpha_m) / (self.reach() * self.beta * step * step)
    }

    /// The displacement beyond u at which a step ends that starts with velocity v and acceleration a
    /// and ends without any.
    pub fn coast(&self, step: f64, v: f64, a: f64) -> f64 {
        step * v + step * step * (0.5 - self.beta) * a
    }

    /// The displacement beyond u where forces would have to be zero: the acceleration that balances
    /// them is [`Self::stiffening`] times what is beyond it.
    pub fn free(&self, step: f64, v: f64, a: f64) -> f64 {
        self.reach() * self.coast(step, v, a) - self.alpha_m / self.stiffening(step) * a
    }

    /// Acceleration at the end of a step by `moved` beyond u.
    pub fn acceleration(&self, step: f64, moved: f64, v: f64, a: f64) -> f64 {
        (moved - self.coast(step, v, a)) / (self.beta * step * step)
    }

    /// Velocity at the end of a step with acceleration `a` at its start and `end` at its end.
    pub fn velocity(&self, step: f64, v: f64, a: f64, end: f64) -> f64 {
        v + step * ((1.0 - self.gamma) * a + self.gamma * end)
    }
}

/// A formulation whose inertia is a mass times the second derivative of its displacements, and that
/// solves for them.
pub trait NewmarkScheme: Scheme {
    /// Writes the state one step of `rule` after `old` at `time` to `new`.
    ///
    /// # Errors
    /// [`NoSolution`]; `new` is of no use then.
    fn advance(
        &mut self,
        rule: &Newmark,
        time: f64,
        step: f64,
        old: &[f64],
        new: &mut [f64],
    ) -> Result<(), NoSolution>;

    /// `sqrt(sum_a m_a |v_a - w_a|^2)` of the velocities v and w of two states, in J^(1/2).
    fn kinetic_distance(&self, one: &[f64], other: &[f64]) -> f64;
}

#[cfg(test)]
mod tests {
    use super::*;

    /// What one step of `rule` makes of an oscillator of frequency `1` with the state `[u, v, a]`.
    fn step(rule: &Newmark, h: f64, [u, v, a]: [f64; 3]) -> [f64; 3] {
        let (c, free) = (rule.stiffening(h), u + rule.free(h, v, a));
        // c (x - free) = -x
        let x = c * free / (c + 1.0);
        let moved = (x - u) / rule.reach();
        let end = rule.acceleration(h, moved, v, a);
        [u + moved, rule.velocity(h, v, a, end), end]
    }

    /// Largest factor by which a step of length h multiplies a state, from many of them.
    fn growth(rule: &Newmark, h: f64) -> f64 {
        let size = |[u, v, _]: [f64; 3]| u.hypot(v).ln();
        let mut state = [1.0, 0.3, -1.0];
        let mut start = 0.0;
        for count in 0..80 {
            if count == 40 {
                start = size(state);
            }
            state = step(rule, h, state);
        }
        ((size(state) - start) / 40.0).exp()
    }

    #[test]
    fn all_rules_are_of_second_order() {
        let rules = [
            Newmark::AVERAGE_ACCELERATION,
            Newmark::new(0.3, 0.5).expect("stable weights"),
            Newmark::hilber_hughes_taylor(0.2),
            Newmark::generalised_alpha(0.0),
            Newmark::generalised_alpha(0.6),
            Newmark::generalised_alpha(1.0),
        ];
        for rule in rules {
            let error = |steps: usize| {
                let h = 2.0 / steps as f64;
                let mut state = [1.0, 0.0, -1.0];
                for _ in 0..steps {
                    state = step(&rule, h, state);
                }
                (state[0] - 2.0_f64.cos()).abs() + (state[1] + 2.0_f64.sin()).abs()
            };
            let order = (error(100) / error(200)).log2();
            assert!((order - 2.0).abs() < 0.05, "{rule:?}: {order}");
            assert_eq!(rule.order(), 2, "{rule:?}");
        }
    }

    /// The shortest periods are multiplied by the radius that was asked for, long ones by one.
    #[test]
    fn damping_is_as_asked_for() {
        for radius in [0.2, 0.5, 0.8, 1.0] {
            let rule = Newmark::generalised_alpha(radius);
            assert_eq!(rule.damps(), radius < 1.0);
            // Roots that coincide grow like a power of the number of steps besides.
            assert!((growth(&rule, 1e6) - radius).abs() < 0.02, "{}", growth(&rule, 1e6));
            assert!((growth(&rule, 1e-2) - 1.0).abs() < 1e-5, "{}", growth(&rule, 1e-2));
        }
        assert!((growth(&Newmark::AVERAGE_ACCELERATION, 3.0) - 1.0).abs() < 1e-6);
        assert!(!Newmark::AVERAGE_ACCELERATION.damps());
        let damped = Newmark::hilber_hughes_taylor(1.0 / 3.0);
        assert!(damped.damps());
        assert!(growth(&damped, 1e6) < 0.55 && growth(&damped, 3.0) < 0.95);
        // First order, with gamma above one half.
        let dissipative = Newmark::new(0.5, 0.9).expect("stable weights");
        assert!(growth(&dissipative, 1.0) < 0.9);
        assert_eq!(dissipative.order(), 1);
    }

    #[test]
    fn rules_that_need_small_steps_are_refused() {
        for (beta, gamma) in [(1.0 / 6.0, 0.5), (0.25, 0.4), (f64::NAN, 0.5), (0.3, 0.7)] {
            assert!(Newmark::new(beta, gamma).is_err(), "{beta} {gamma}");
        }
    }
}
