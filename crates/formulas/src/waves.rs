//! Waves on water of even depth: linear theory, spectra, and what a piston has to do to make them.

use std::f64::consts::PI;

/// The wave number k in 1/m of linear waves of an angular frequency in 1/s on water of a depth in m, under the
/// gravity in m/s^2: `omega^2 = g k tanh(k d)`.
pub fn wave_number(frequency: f64, depth: f64, gravity: f64) -> f64 {
    // y = k d, of y tanh y = omega^2 d / g, by Newton's method from above.
    let square = frequency * frequency * depth / gravity;
    let mut y = square.max(square.sqrt());
    for _ in 0..60 {
        let tanh = y.tanh();
        let step = (y * tanh - square) / (tanh + y * (1.0 - tanh * tanh));
        y -= step;
        if step.abs() <= 1e-15 * y {
            break;
        }
    }
    y / depth
}

/// Height of the waves over the stroke of the piston that makes them, for `kd`, the wave number times the depth, theory (93):
/// Biesel's `4 sinh^2(kd) / (sinh(2 kd) + 2 kd)`.
pub fn height_over_stroke(kd: f64) -> f64 {
    // By exponentials that fall, so that nothing overflows in deep water.
    let fall = (-2.0 * kd).exp();
    2.0 * (1.0 - fall).powi(2) / (1.0 - fall * fall + 4.0 * kd * fall)
}

/// The share of the second harmonic in the motion of a piston that makes waves of a `height` in m without free second
/// harmonics on water of a `depth` in m, for `kd`: Madsen's `H^2 / (32 d) (3 cosh(kd) / sinh^3(kd) - 2 S / H)` in m.
pub fn second_harmonic(height: f64, depth: f64, kd: f64) -> f64 {
    let bound = 3.0 / (kd.tanh() * kd.sinh().powi(2));
    height * height / (32.0 * depth) * (bound - 2.0 / height_over_stroke(kd))
}

/// The shape of the spectrum of JONSWAP over the frequency f in Hz with the peak fp, up to a factor,
/// `f^-5 exp(-5/4 (fp/f)^4) gamma^exp(-(f/fp - 1)^2 / (2 s^2))`, s 0.07 below the peak and 0.09 above it. With gamma 1
/// it is that of Pierson and Moskowitz.
pub fn jonswap(frequency: f64, peak: f64, gamma: f64) -> f64 {
    let ratio = frequency / peak;
    let width = if ratio <= 1.0 { 0.07 } else { 0.09 };
    let enhanced = (-0.5 * ((ratio - 1.0) / width).powi(2)).exp();
    ratio.powi(-5) * (-1.25 * ratio.powi(-4)).exp() * gamma.powf(enhanced)
}

/// A solitary wave, of the first order of Boussinesq.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Solitary {
    /// Height over the water at rest in m.
    pub height: f64,
    /// Depth of that in m.
    pub depth: f64,
    /// Gravity in m/s^2.
    pub gravity: f64,
}

impl Solitary {
    /// Its speed `sqrt(g (d + H))` in m/s.
    pub fn speed(&self) -> f64 {
        (self.gravity * (self.depth + self.height)).sqrt()
    }

    /// How narrow it is, `sqrt(3 H / (4 d^3))` in 1/m.
    pub fn narrowness(&self) -> f64 {
        (0.75 * self.height / self.depth.powi(3)).sqrt()
    }

    /// The surface `H / cosh^2 theta` in m.
    pub fn surface(&self, theta: f64) -> f64 {
        self.height / theta.cosh().powi(2)
    }

    /// The phase theta at the piston that makes it, the time in s told from when its crest is there, theory (94):
    /// `theta + H/d tanh theta = kappa c t`, of Goring's `theta = kappa (c t - x)` with `x = H / (kappa d) tanh theta`.
    pub fn phase_at_piston(&self, time: f64) -> f64 {
        let (ratio, target) = (self.height / self.depth, self.narrowness() * self.speed() * time);
        // Convex on each side of zero: from beyond the root Newton's method goes there one way.
        let mut theta = target;
        for _ in 0..60 {
            let tanh = theta.tanh();
            let slope = 1.0 + ratio * (1.0 - tanh * tanh);
            let step = (theta + ratio * tanh - target) / slope;
            theta -= step;
            if step.abs() <= 1e-15 * theta.abs().max(1.0) {
                break;
            }
        }
        theta
    }
}

/// A number that grows smoothly from 0 to 1 within a time in s, `(1 - cos(pi t / T)) / 2`, with its first and second
/// derivative.
pub fn ramp(time: f64, length: f64) -> [f64; 3] {
    if time >= length {
        return [1.0, 0.0, 0.0];
    }
    let rate = PI / length;
    let (sine, cosine) = (rate * time).sin_cos();
    [0.5 * (1.0 - cosine), 0.5 * rate * sine, 0.5 * rate * rate * cosine]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn wave_numbers_fulfil_the_dispersion_from_shallow_to_deep() {
        for kd in [1e-3, 0.1, 1.0, 3.0, 30.0, 800.0_f64] {
            let frequency = (9.81 / 2.5 * kd * kd.tanh()).sqrt();
            let found = wave_number(frequency, 2.5, 9.81) * 2.5;
            assert!((found / kd - 1.0).abs() < 1e-12, "{found} of {kd}");
        }
    }

    /// Shallow water moves as a plug, so that H/S is kd; in deep water it is 2. Between them what tables have.
    #[test]
    fn pistons_make_the_waves_of_biesel() {
        assert!((height_over_stroke(1e-3) / 1e-3 - 1.0).abs() < 1e-6);
        assert!((height_over_stroke(400.0) - 2.0).abs() < 1e-12);
        let of = |kd: f64| 4.0 * kd.sinh().powi(2) / ((2.0 * kd).sinh() + 2.0 * kd);
        for kd in [0.2, 1.0, 2.5] {
            assert!((height_over_stroke(kd) - of(kd)).abs() < 1e-12);
        }
        // sinh 1 = 1.175201, sinh 2 = 3.626860.
        assert!((height_over_stroke(1.0) - 4.0 * 1.381098 / 5.626860).abs() < 1e-6);
    }

    #[test]
    fn the_peak_of_the_spectrum_is_raised_by_gamma() {
        let plain = jonswap(0.5, 0.5, 1.0);
        assert!((plain - (-1.25_f64).exp()).abs() < 1e-15);
        assert!((jonswap(0.5, 0.5, 3.3) / plain - 3.3).abs() < 1e-14);
        // Of Pierson and Moskowitz the area is fp/5 of this shape: m0 = alpha ... / (5 fp^4).
        let step = 1e-4;
        let area: f64 = (1..200_000).map(|k| step * jonswap(step * f64::from(k), 0.5, 1.0)).sum();
        assert!((area - 0.1).abs() < 1e-4, "{area}");
    }

    /// The piston moves with the mean velocity of the water in front of it, `c eta / (d + eta)`.
    #[test]
    fn a_solitary_wave_pushes_the_piston_as_it_pushes_water() {
        let wave = Solitary { height: 0.3, depth: 1.0, gravity: 9.81 };
        let place = |time: f64| {
            wave.height / (wave.narrowness() * wave.depth) * wave.phase_at_piston(time).tanh()
        };
        for time in [-1.0, -0.2, 0.0, 0.4, 2.0] {
            let eta = wave.surface(wave.phase_at_piston(time));
            let velocity = (place(time + 1e-5) - place(time - 1e-5)) / 2e-5;
            assert!((velocity - wave.speed() * eta / (wave.depth + eta)).abs() < 1e-8);
        }
    }

    #[test]
    fn a_ramp_has_its_derivatives() {
        for time in [0.1, 0.7, 1.9] {
            let [_, slope, bend] = ramp(time, 2.0);
            let (before, after) = (ramp(time - 1e-5, 2.0), ramp(time + 1e-5, 2.0));
            assert!(((after[0] - before[0]) / 2e-5 - slope).abs() < 1e-8);
            assert!(((after[1] - before[1]) / 2e-5 - bend).abs() < 1e-8);
        }
        assert_eq!(ramp(2.0, 2.0), [1.0, 0.0, 0.0]);
        assert_eq!(ramp(0.0, 0.0), [1.0, 0.0, 0.0]);
    }
}
