//! Circular functions.

use super::{Bits, rounded};
use crate::Number;

/// Largest argument of [`sin`] and [`cos`], which beyond it are NaN.
pub const FARTHEST: f64 = 1e6;

/// `pi/2` in four parts, of which a whole number below `2^20` times each of the first three is exact.
const QUARTERS: [f64; 4] = [
    1.570_796_326_734_125_6,
    6.077_100_506_303_966e-11,
    2.022_266_248_711_166_5e-21,
    8.478_427_660_368_9e-32,
];

/// Sine: error below 0.9 units up to [`FARTHEST`], beyond which too few digits of pi are kept; it is NaN
/// there.
#[inline(always)]
pub fn sin<T: Bits>(x: T) -> T {
    if T::surely(x.abs().below(0.78)) { sine(x, T::zero()) } else { turned(x, 0.0) }
}

/// Cosine, as [`sin`].
#[inline(always)]
pub fn cos<T: Bits>(x: T) -> T {
    if T::surely(x.abs().below(0.78)) { cosine(x, T::zero()) } else { turned(x, 1.0) }
}

/// `sin(x + pi/2 ahead)`.
#[inline(always)]
fn turned<T: Bits>(x: T, ahead: f64) -> T {
    let count = rounded(x * std::f64::consts::FRAC_2_PI);
    // x less so many quarters of a turn, by Cody and Waite, as the sum of two numbers.
    let [first, second, third, last] = QUARTERS.map(|part| count * part);
    let (near, lost) = difference(x - first, second);
    let (near, lost_again) = difference(near, third);
    let rest = last - (lost + lost_again);
    let high = near - rest;
    let low = (near - high) - rest;
    // How many quarters, from -2 to 2.
    let quarter = count + ahead;
    let quarter = quarter - rounded(quarter * 0.25) * 4.0;
    let is_odd = quarter.abs().above(0.5) & quarter.abs().below(1.5);
    let value = T::select(is_odd, cosine(high, low), sine(high, low));
    let value = T::select(quarter.below(-0.5) | quarter.above(1.5), -value, value);
    T::select(x.abs().at_most(T::from(FARTHEST)), value, T::from(f64::NAN))
}

/// A difference and what it has lost.
#[inline(always)]
fn difference<T: Number>(a: T, b: T) -> (T, T) {
    let difference = a - b;
    let back = difference - a;
    (difference, (a - (difference - back)) - (b + back))
}

/// Sine of `x + rest` between `-pi/4` and `pi/4`.
#[inline(always)]
fn sine<T: Number>(x: T, rest: T) -> T {
    let z = x * x;
    let series = z * (z * 1.589_690_995_211_55e-10 - 2.505_076_025_340_686_3e-8);
    let series = z * (z * (series + 2.755_731_370_707_006_8e-6) - 1.984_126_982_985_795e-4);
    let cube = z * x;
    let tail = rest * 0.5 - cube * (series + 8.333_333_333_322_49e-3);
    x - ((z * tail - rest) + cube * 1.666_666_666_666_663_2e-1)
}

/// Cosine of `x + rest` between `-pi/4` and `pi/4`.
#[inline(always)]
fn cosine<T: Number>(x: T, rest: T) -> T {
    let z = x * x;
    let series = z * (z * -1.135_964_755_778_819_5e-11 + 2.087_572_321_298_175e-9);
    let series = z * (z * (series - 2.755_731_435_139_066_3e-7) + 2.480_158_728_947_673e-5);
    let series = z * (z * (series - 1.388_888_888_887_411e-3) + 4.166_666_666_666_66e-2);
    let half = z * 0.5;
    let value = -half + 1.0;
    value + (((-value + 1.0) - half) + (z * series - x * rest))
}

/// Angle of the point `(x, y)` with the first axis: error below 1.6 units. A zero counts as positive.
#[inline(always)]
pub fn atan2<T: Bits>(y: T, x: T) -> T {
    let (up, along) = (y.abs(), x.abs());
    let steep = along.less(up);
    let (small, large) = (T::select(steep, along, up), T::select(steep, up, along));
    // The angle below 45 degrees, from 0, atan(1/2) or 45 degrees, in numbers that neither overflow nor
    // lose digits.
    let factor = T::select(large.above(1e300), T::from(0.125), T::one());
    let factor = T::select(large.below(1e-270), T::from(1e30), factor);
    let endless = large.above(f64::MAX);
    let bounded = |a: T| {
        let at_infinity = T::select(a.above(f64::MAX), T::one(), T::zero());
        T::select(endless, at_infinity, a * factor)
    };
    let (small, large) = (bounded(small), bounded(large));
    let large = T::select(large.at_most(T::zero()), T::one(), large);
    let (middle, upper) = ((large * 0.4375).less(small), (large * 0.6875).less(small));
    let of = |at_zero: f64, at_half: f64, at_one: f64| {
        let value = T::select(middle, T::from(at_half), T::from(at_zero));
        T::select(upper, T::from(at_one), value)
    };
    let slope = of(0.0, 0.5, 1.0);
    let q = (small - large * slope) / (large + small * slope);
    let z = q * q;
    let w = z * z;
    let odd = w * (w * 1.628_582_011_536_578_2e-2 + 4.976_877_994_615_932_4e-2);
    let odd = w * (w * (odd + 6.661_073_137_387_531e-2) + 9.090_887_133_436_507e-2);
    let odd = z * (w * (odd + 1.428_571_427_250_346_6e-1) + 3.333_333_333_333_293e-1);
    let even = w * (w * -3.653_157_274_421_691_6e-2 - 5.833_570_133_790_573_5e-2);
    let even = w * (w * (even - 7.691_876_205_044_83e-2) - 1.111_111_040_546_235_6e-1);
    let even = w * (even - 1.999_999_999_987_648_3e-1);
    let high = of(0.0, 4.636_476_090_008_061e-1, std::f64::consts::FRAC_PI_4);
    let low = of(0.0, 2.269_877_745_296_168_7e-17, 3.061_616_997_868_383e-17);
    let angle = high - ((q * (odd + even) - low) - q);
    // From the axis that is next, and up.
    let left = x.below(0.0);
    let back = (steep & !left) | (!steep & left);
    let angle = T::select(back, -angle, angle);
    let of_axis = |quarter: f64| {
        let other = T::select(left, T::from(2.0 * quarter), T::zero());
        T::select(steep, T::from(quarter), other)
    };
    let angle = of_axis(std::f64::consts::FRAC_PI_2) + (angle + of_axis(6.123_233_995_736_766e-17));
    let angle = T::select(y.below(0.0), -angle, angle);
    T::select(x.at_most(x) & y.at_most(y), angle, T::from(f64::NAN))
}
