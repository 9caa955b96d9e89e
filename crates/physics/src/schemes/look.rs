//! One look over a state: is it sound, how fast is it, and what is largest of that which bounds the step.

use super::Health;
use crate::Vector;
use crate::parallel::{self, Sums};

/// What one particle contributes.
pub(crate) struct Seen<const D: usize, const N: usize> {
    pub velocity: Vector<D>,
    /// Largest speed of a wave in m/s.
    pub wave_speed: f64,
    /// Smallest volume ratio.
    pub ratio: f64,
    /// Difference of an evolved volume ratio and the determinant.
    pub mismatch: f64,
    /// Figures of the formulation, of which the largest count.
    pub figures: [f64; N],
}

/// The largest of a figure over particles, and who has it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Most {
    pub value: f64,
    /// Index in memory; the first of those that have it.
    pub particle: usize,
}

impl Most {
    /// What is less than anything that is seen.
    const NOTHING: Self = Self { value: f64::NEG_INFINITY, particle: 0 };

    /// Sees another; what is not a number is not seen.
    #[inline]
    fn see(&mut self, value: f64, particle: usize) {
        if value > self.value {
            *self = Self { value, particle };
        }
    }

    /// At least `least`, which none has.
    fn at_least(self, least: f64) -> Self {
        if self.value > least { self } else { Self { value: least, particle: 0 } }
    }
}

/// What has been seen of some particles: squared speed, wave speed, the negative volume ratio and the
/// mismatch, and the figures of the formulation.
#[derive(Clone, Copy)]
struct Sight<const N: usize> {
    first_not_finite: Option<usize>,
    common: [Most; 4],
    own: [Most; N],
}

impl<const N: usize> Sums for Sight<N> {
    const ZERO: Self =
        Self { first_not_finite: None, common: [Most::NOTHING; 4], own: [Most::NOTHING; N] };

    fn add(&mut self, other: &Self) {
        self.first_not_finite = self.first_not_finite.or(other.first_not_finite);
        let own = self.common.iter_mut().chain(&mut self.own);
        let others = other.common.iter().chain(&other.own);
        own.zip(others).for_each(|(own, other)| own.see(other.value, other.particle));
    }
}

/// The health of `count` particles, and the largest of their figures, which are no less than `least`.
/// `see` has what a particle contributes; nothing if a value is not finite.
pub(crate) fn look<const D: usize, const N: usize>(
    count: usize,
    least: [f64; N],
    see: impl Fn(usize) -> Option<Seen<D, N>> + Sync,
) -> (Health, [Most; N]) {
    let sight = parallel::sums(count, |particle, sight: &mut Sight<N>| {
        let Some(seen) = see(particle) else {
            sight.first_not_finite.get_or_insert(particle);
            return;
        };
        let common = [seen.velocity.norm_squared(), seen.wave_speed, -seen.ratio, seen.mismatch];
        sight.common.iter_mut().zip(common).for_each(|(most, value)| most.see(value, particle));
        sight.own.iter_mut().zip(seen.figures).for_each(|(most, value)| most.see(value, particle));
    });
    let [speed, wave_speed, ratio, mismatch] = sight.common;
    let speed = speed.at_least(0.0);
    let health = Health {
        largest_speed: speed.value.sqrt(),
        largest_speed_particle: speed.particle,
        largest_wave_speed: wave_speed.at_least(0.0).value,
        smallest_ratio: -ratio.value,
        smallest_ratio_particle: ratio.particle,
        ratio_mismatch: mismatch.at_least(0.0).value,
        first_not_finite: sight.first_not_finite,
        first_escaped: None,
    };
    let mut own = sight.own;
    own.iter_mut().zip(least).for_each(|(most, least)| *most = most.at_least(least));
    (health, own)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// What is seen of 3000 particles, more than a chunk: a speed and a figure of each.
    fn seen(speed: impl Fn(usize) -> f64 + Sync, least: f64) -> (Health, Most) {
        let (health, [most]) = look(3000, [least], |a| {
            let value = speed(a);
            let velocity = Vector::from([value, 0.0]);
            let seen =
                Seen { velocity, wave_speed: 1.0, ratio: value, mismatch: 0.0, figures: [value] };
            (value != f64::INFINITY).then_some(seen)
        });
        (health, most)
    }

    #[test]
    fn the_first_particle_of_the_worst_is_named() {
        // 7 at 1500, 2500 and 2900, and 1 elsewhere but for 0.5 at 40 and 2000.
        let speed = |a: usize| match a {
            1500 | 2500 | 2900 => 7.0,
            40 | 2000 => 0.5,
            _ => 1.0,
        };
        let (health, most) = seen(speed, 0.0);
        assert_eq!((health.largest_speed, health.largest_speed_particle), (7.0, 1500));
        assert_eq!((health.smallest_ratio, health.smallest_ratio_particle), (0.5, 40));
        assert_eq!(most, Most { value: 7.0, particle: 1500 });
        // Nobody has what all of them have to exceed.
        assert_eq!(seen(speed, 8.0).1, Most { value: 8.0, particle: 0 });
        assert_eq!(health.first_not_finite, None);
    }

    #[test]
    fn what_is_not_finite_is_named_and_takes_no_part() {
        let speed = |a: usize| match a {
            1700 | 2800 => f64::INFINITY,
            2 => f64::NAN,
            _ => 3.0,
        };
        let (health, most) = seen(speed, 0.0);
        assert_eq!(health.first_not_finite, Some(1700));
        assert_eq!((health.largest_speed, health.smallest_ratio), (3.0, 3.0));
        assert_eq!(most, Most { value: 3.0, particle: 0 });
        // Of nothing there is nothing to say.
        let (none, [most]) = look::<2, 1>(0, [0.0], |_| None);
        assert_eq!((none, most), (Health::NEUTRAL, Most { value: 0.0, particle: 0 }));
    }
}
