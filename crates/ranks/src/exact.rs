//! Sums that do not depend on the order of their terms.

/// Entries of an [`Exact`] sum: those of the number, and how often either infinity was added.
pub const LIMBS: usize = DIGITS + 2;

/// Entries of the number. Over the smallest number in `f64`, 2⁻¹⁰⁷⁴, the largest has 2098 bits; the other 78 are for the
/// sign and for what 2⁷⁷ terms carry.
const DIGITS: usize = 68;

/// Bits of an entry of the number, before others are added to it.
const BITS: usize = 32;

const MASK: i64 = (1 << BITS) - 1;

/// Bits of the mantissa of `f64` behind its leading one.
const MANTISSA: usize = f64::MANTISSA_DIGITS as usize - 1;

/// The exponent in the bits of infinities and NaN.
const NOT_FINITE: usize = 0x7ff;

/// Entries are carried before they hold more of 32 bits than this.
const MOST: u32 = 1 << 30;

/// The sum of any numbers, without rounding.
///
/// It is a number in fixed point that is wide enough for all numbers in `f64`, so that no addition rounds, and neither
/// the order nor the grouping of terms makes a difference:
///
/// ```
/// use piola_ranks::Exact;
///
/// let mut sum = Exact::default();
/// [1e300, 1.0, -1e300].into_iter().for_each(|term| sum.add(term));
/// assert_eq!(sum.total(), 1.0);
/// ```
///
/// Ranks find the sum over all of them by adding their [entries](Self::limbs_mut) with [`Ranks::add`](crate::Ranks::add).
#[derive(Clone, Debug)]
pub struct Exact {
    /// The number is the sum of `limbs[k]` 2³²ᵏ⁻¹⁰⁷⁴ over the first [`DIGITS`]. A NaN counts as both infinities.
    limbs: [i64; LIMBS],
    /// No entry but the last of the number is larger than this times 2³², in magnitude: all are 0 if it is.
    load: u32,
}

impl Default for Exact {
    fn default() -> Self {
        Self { limbs: [0; LIMBS], load: 0 }
    }
}

impl Exact {
    /// Adds a term.
    #[inline]
    pub fn add(&mut self, term: f64) {
        let bits = term.to_bits();
        let exponent = (bits >> MANTISSA) as usize & NOT_FINITE;
        if exponent == NOT_FINITE {
            return self.add_infinite(term);
        }
        if self.load >= MOST {
            self.carry();
        }
        self.load += 1;
        let leading = u64::from(exponent > 0) << MANTISSA;
        let mantissa = bits & ((1 << MANTISSA) - 1) | leading;
        // Numbers below the smallest normal one have its unit.
        let shift = exponent.max(1) - 1;
        let wide = u128::from(mantissa) << (shift % BITS);
        let sign = bits as i64 >> 63;
        for (place, limb) in self.limbs[shift / BITS..][..3].iter_mut().enumerate() {
            let part = (wide >> (BITS * place)) as i64 & MASK;
            *limb += (part ^ sign) - sign;
        }
    }

    #[cold]
    fn add_infinite(&mut self, term: f64) {
        // A NaN differs from both.
        self.limbs[DIGITS] += i64::from(term != f64::NEG_INFINITY);
        self.limbs[DIGITS + 1] += i64::from(term != f64::INFINITY);
    }

    /// The entries, which may be replaced by their sums over up to 2³⁰ ranks, entry by entry: the sum is then that over
    /// the terms of all of them.
    pub fn limbs_mut(&mut self) -> &mut [i64; LIMBS] {
        self.carry();
        self.load = MOST;
        &mut self.limbs
    }

    /// Moves what is above 32 bits of an entry of the number to the next one.
    fn carry(&mut self) {
        let mut carry = 0;
        let (last, limbs) = self.number();
        for limb in limbs {
            let low = (*limb & MASK) + carry;
            carry = (*limb >> BITS) + (low >> BITS);
            *limb = low & MASK;
        }
        *last = last.wrapping_add(carry);
        self.load = 1;
    }

    /// The last entry of the number, and those below it.
    fn number(&mut self) -> (&mut i64, &mut [i64]) {
        let (limbs, rest) = self.limbs.split_at_mut(DIGITS - 1);
        (&mut rest[0], limbs)
    }

    /// The sum, rounded once: to the nearest number in `f64`, and to the even one of two that are equally near. Of a
    /// single term it is the term, to the bit, but for `-0.0`, for which it is `0.0`.
    ///
    /// It is infinite if it rounds to more than the largest finite number, or if one kind of infinity was added, and NaN
    /// if both were, or a NaN.
    pub fn total(&self) -> f64 {
        let [positive, negative] = [DIGITS, DIGITS + 1].map(|k| self.limbs[k] != 0);
        if positive || negative {
            let infinite = if negative { f64::NEG_INFINITY } else { f64::INFINITY };
            return if positive && negative { f64::NAN } else { infinite };
        }
        if self.load == 0 {
            return 0.0;
        }
        let mut sum = self.clone();
        sum.carry();
        let is_negative = sum.limbs[DIGITS - 1] < 0;
        if is_negative {
            sum.limbs.iter_mut().for_each(|limb| *limb = limb.wrapping_neg());
            sum.carry();
        }
        let magnitude = f64::from_bits(sum.rounded());
        if is_negative { -magnitude } else { magnitude }
    }

    /// The bits of a number that is not negative, and has been carried.
    fn rounded(&self) -> u64 {
        let limb = |k: usize| self.limbs[k] as u64;
        let Some(last) = (0..DIGITS).rev().find(|&k| limb(k) != 0) else { return 0 };
        let highest = BITS * last + limb(last).ilog2() as usize;
        // Without rounding, the largest exponent of a finite number has this leading bit.
        if highest >= NOT_FINITE - 1 + MANTISSA {
            return f64::INFINITY.to_bits();
        }
        let shift = highest.saturating_sub(MANTISSA);
        let first = shift / BITS;
        let wide = (0..3).fold(0, |wide, k| wide | u128::from(limb(first + k)) << (BITS * k));
        let mantissa = (wide >> (shift % BITS)) as u64 & ((2 << MANTISSA) - 1);
        // The leading one of the mantissa adds one to the exponent, and so does rounding up to the next power of two,
        // which makes the largest one infinite.
        let bits = ((shift as u64) << MANTISSA) + mantissa;
        let Some(half) = shift.checked_sub(1) else { return bits };
        let (place, bit) = (half / BITS, 1 << (half % BITS));
        let is_half = limb(place) & bit != 0;
        let is_above = limb(place) & (bit - 1) != 0 || (0..place).any(|k| limb(k) != 0);
        bits + u64::from(is_half && (is_above || bits & 1 == 1))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Entries as 2³⁰ terms leave them at most.
    #[test]
    fn full_entries_are_carried_before_a_term_is_added() {
        let full = i64::from(MOST) * MASK;
        let mut sum = Exact { limbs: [full; LIMBS], load: MOST };
        sum.add(f64::MAX);
        let (_, limbs) = sum.number();
        assert!(limbs.iter().all(|&limb| limb <= 2 * MASK), "{limbs:?}");
    }
}
