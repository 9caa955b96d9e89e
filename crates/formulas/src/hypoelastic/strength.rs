//! Yield and the return to the yield surface.

use crate::Number;

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
    pub fn flow_stress<T: Number>(&self, plastic_strain: T, rate: T, temperature: T) -> T {
        let hardened = plastic_strain.powf(self.exponent) * self.hardening + self.yield_stress;
        let ratio = rate / self.reference_rate;
        let ratio = T::select(ratio.above(1.0), ratio, T::one());
        let rate = ratio.ln() * self.rate_factor + 1.0;
        let span = self.melting_temperature - self.reference_temperature;
        let heat = (temperature - self.reference_temperature) / span;
        let heat = T::select(heat.below(0.0), T::zero(), heat);
        let heat = T::select(heat.above(1.0), T::one(), heat);
        hardened * rate * (-heat.powf(self.softening) + 1.0)
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
pub struct Returned<T = f64> {
    /// Factor of the deviatoric stress, 1 where it was within.
    pub scale: T,
    /// Growth of the equivalent plastic strain.
    pub increment: T,
    /// Equivalent stress in Pa with which it grew.
    pub stress: T,
}

impl Strength {
    /// Return along the radius, theory (70), of a trial stress with the equivalent stress
    /// `von_mises` in Pa to where `von_mises - 3 G increment` is the flow stress, at the plastic
    /// strain before, a temperature in K and a step in s. CTVF section 4.7 has it for H = 0 as the
    /// factor `Y / von_mises`; its `Y^2 / (3 J2)` is the square of that.
    #[inline]
    pub fn return_to_surface<T: Number>(
        &self,
        von_mises: T,
        shear_modulus: f64,
        plastic_strain: T,
        temperature: T,
        step: T,
    ) -> Returned<T> {
        let three_g = 3.0 * shear_modulus;
        let increment = match *self {
            Self::Elastic => {
                return Returned { scale: T::one(), increment: T::zero(), stress: von_mises };
            }
            Self::Linear { yield_stress, hardening } => {
                let excess = von_mises - yield_stress - plastic_strain * hardening;
                excess / (three_g + hardening)
            }
            Self::JohnsonCook(law) => {
                let excess = |increment: T| {
                    let strain = plastic_strain + increment;
                    let flow = law.flow_stress(strain, increment / step, temperature);
                    von_mises - increment * three_g - flow
                };
                zero_of(excess, von_mises / three_g)
            }
        };
        // False for what is no number: none of ours to hide.
        let flows = increment.above(0.0) & von_mises.above(0.0);
        let stress = T::select(flows, von_mises - increment * three_g, von_mises);
        Returned {
            scale: T::choose(flows, || stress / von_mises, T::one),
            increment: T::select(flows, increment, T::zero()),
            stress,
        }
    }
}

/// The zero between 0 and `most` of a function that falls from a positive value to one that is not;
/// 0 where it is not positive there. False position with Illinois' halving, which needs no slope: that
/// of a power of the plastic strain is infinite at the start.
#[inline(never)]
fn zero_of<T: Number>(function: impl Fn(T) -> T, most: T) -> T {
    let start = function(T::zero());
    let positive = start.above(0.0);
    // The two ends with their values, and whether the last of the points between had a positive value:
    // 1 if so, -1 if not, 0 before the first.
    let ends = [T::zero(), start, most, function(most), T::zero()];
    let until = |[low, _, high, at_high, _]: &[T; 5]| {
        let vanishes = at_high.at_most(T::zero()) & T::zero().at_most(*at_high);
        !positive | (*high - *low).at_most(most * 1e-14) | vanishes
    };
    let [_, _, high, _, _] = T::repeat(200, ends, until, |[low, at_low, high, at_high, last]| {
        let middle = (low * at_high - high * at_low) / (at_high - at_low);
        let value = function(middle);
        let rises = value.above(0.0);
        // The end that stays a second time counts half.
        let again = |sign: f64, end: T| T::select((last * sign).above(0.0), end * 0.5, end);
        [
            T::select(rises, middle, low),
            T::select(rises, value, again(-1.0, at_low)),
            T::select(rises, high, middle),
            T::select(rises, again(1.0, at_high), value),
            T::select(rises, T::one(), -T::one()),
        ]
    });
    T::select(positive, high, T::zero())
}
