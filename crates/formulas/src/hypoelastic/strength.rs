//! Yield and the return to the yield surface.

/// The flow stress of Johnson and Cook,
/// `(A + B ep^n) (1 + C ln(ep' / ep0')) (1 - T*^m)`, `T* = (T - T_r) / (T_m - T_r)`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct JohnsonCook {
    /// Yield stress A in Pa.
    pub yield_stress: f64,
    /// Hardening B in Pa and its exponent n.
    pub hardening: f64,
    /// Exponent n of the plastic strain.
    pub exponent: f64,
    /// Factor C of the strain rate.
    pub rate_factor: f64,
    /// Plastic strain rate in 1/s below which the rate has no effect.
    pub reference_rate: f64,
    /// Exponent m of the temperature.
    pub softening: f64,
    /// Temperature T_r in K below which it has no effect.
    pub reference_temperature: f64,
    /// Temperature T_m in K at which nothing is left.
    pub melting_temperature: f64,
}

impl JohnsonCook {
    /// Flow stress in Pa at a plastic strain, its rate in 1/s, and a temperature in K.
    pub fn flow_stress(&self, plastic_strain: f64, rate: f64, temperature: f64) -> f64 {
        let hardened = self.yield_stress + self.hardening * plastic_strain.powf(self.exponent);
        let rate = 1.0 + self.rate_factor * (rate / self.reference_rate).max(1.0).ln();
        let span = self.melting_temperature - self.reference_temperature;
        let heat = ((temperature - self.reference_temperature) / span).clamp(0.0, 1.0);
        hardened * rate * (1.0 - heat.powf(self.softening))
    }
}

/// When a solid flows.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Strength {
    /// Never.
    Elastic,
    /// At a yield stress that grows with the plastic strain, `Y + H ep`; perfectly plastic for H 0.
    Linear {
        /// Yield stress Y in Pa.
        yield_stress: f64,
        /// Plastic modulus H in Pa.
        hardening: f64,
    },
    /// As Johnson and Cook have it.
    JohnsonCook(JohnsonCook),
}

/// What the return to the yield surface does to a trial stress.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Returned {
    /// Factor of the deviatoric stress, 1 where it was within.
    pub scale: f64,
    /// Growth of the equivalent plastic strain.
    pub increment: f64,
    /// Equivalent stress in Pa with which it grew.
    pub stress: f64,
}

impl Strength {
    /// Return along the radius, theory (70), of a trial stress with the equivalent stress
    /// `von_mises` in Pa to where `von_mises - 3 G increment` is the flow stress, at the plastic
    /// strain before, a temperature in K and a step in s. CTVF section 4.7 has it for H = 0 as the
    /// factor `Y / von_mises`; its `Y^2 / (3 J2)` is the square of that.
    pub fn return_to_surface(
        &self,
        von_mises: f64,
        shear_modulus: f64,
        plastic_strain: f64,
        temperature: f64,
        step: f64,
    ) -> Returned {
        let within = Returned { scale: 1.0, increment: 0.0, stress: von_mises };
        let three_g = 3.0 * shear_modulus;
        let increment = match *self {
            Self::Elastic => return within,
            Self::Linear { yield_stress, hardening } => {
                let excess = von_mises - yield_stress - hardening * plastic_strain;
                excess / (three_g + hardening)
            }
            Self::JohnsonCook(law) => {
                let excess = |increment: f64| {
                    let strain = plastic_strain + increment;
                    let flow = law.flow_stress(strain, increment / step, temperature);
                    von_mises - three_g * increment - flow
                };
                zero_of(excess, von_mises / three_g)
            }
        };
        // A stress that is no number is none of ours to hide.
        if increment <= 0.0 || increment.is_nan() || !(von_mises > 0.0) {
            return within;
        }
        let stress = von_mises - three_g * increment;
        Returned { scale: stress / von_mises, increment, stress }
    }
}

/// The zero between 0 and `most` of a function that falls from a positive value to one that is not;
/// 0 where it is not positive there. False position with Illinois' halving, which needs no slope: that
/// of a power of the plastic strain is infinite at the start.
fn zero_of(function: impl Fn(f64) -> f64, most: f64) -> f64 {
    let (mut low, mut high) = ((0.0, function(0.0)), (most, function(most)));
    if !(low.1 > 0.0) {
        return 0.0;
    }
    let mut last_rose = None;
    for _ in 0..200 {
        if high.0 - low.0 <= 1e-14 * most || high.1 == 0.0 {
            break;
        }
        let middle = (low.0 * high.1 - high.0 * low.1) / (high.1 - low.1);
        let value = function(middle);
        let rises = value > 0.0;
        // The end that stays a second time counts half.
        let factor = if last_rose == Some(rises) { 0.5 } else { 1.0 };
        if rises {
            (low, high.1) = ((middle, value), high.1 * factor);
        } else {
            (high, low.1) = ((middle, value), low.1 * factor);
        }
        last_rose = Some(rises);
    }
    high.0
}
