//! One look over a state: is it sound, how fast is it, and what is largest of that which bounds the step.

use super::Health;
use crate::Vector;
use crate::parallel::{Reduce, Team};

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
    pub const NOTHING: Self = Self { value: f64::NEG_INFINITY, particle: 0 };

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

impl<const N: usize> Reduce for Sight<N> {
    const ZERO: Self =
        Self { first_not_finite: None, common: [Most::NOTHING; 4], own: [Most::NOTHING; N] };

    fn add(&mut self, other: &Self) {
        self.first_not_finite = self.first_not_finite.or(other.first_not_finite);
        let own = self.common.iter_mut().chain(&mut self.own);
        let others = other.common.iter().chain(&other.own);
        own.zip(others).for_each(|(own, other)| own.see(other.value, other.particle));
    }
}

impl<const N: usize> Sight<N> {
    /// As numbers.
    fn pack(&self) -> Vec<f64> {
        let first = self.first_not_finite.map_or(-1.0, |first| first as f64);
        let all = self.common.iter().chain(&self.own);
        std::iter::once(first).chain(all.flat_map(|it| [it.value, it.particle as f64])).collect()
    }

    /// Of such numbers.
    fn unpack(numbers: &[f64]) -> Self {
        let (mut sight, mut rest) = (Self::ZERO, numbers.iter());
        let first = rest.next().copied().filter(|first| *first >= 0.0);
        sight.first_not_finite = first.map(|first| first as usize);
        for (most, pair) in
            sight.common.iter_mut().chain(&mut sight.own).zip(rest.as_slice().chunks_exact(2))
        {
            *most = Most { value: pair[0], particle: pair[1] as usize };
        }
        sight
    }
}

/// The health of the particles of a team, of which `count` are here, and the largest of their figures, which are no less
/// than `least`. `see` has what a particle contributes; nothing if a value is not finite. They are named by their
/// numbers among those of all ranks.
pub(crate) fn look<const D: usize, const N: usize>(
    team: &Team,
    count: usize,
    least: [f64; N],
    see: impl Fn(usize) -> Option<Seen<D, N>> + Sync,
) -> (Health, [Most; N]) {
    let first = team.first();
    let see = |a: usize, sight: &mut Sight<N>| {
        let (particle, seen) = (first + a, see(a));
        let Some(seen) = seen else {
            sight.first_not_finite.get_or_insert(particle);
            return;
        };
        let common = [seen.velocity.norm_squared(), seen.wave_speed, -seen.ratio, seen.mismatch];
        sight.common.iter_mut().zip(common).for_each(|(most, value)| most.see(value, particle));
        sight.own.iter_mut().zip(seen.figures).for_each(|(most, value)| most.see(value, particle));
    };
    let sight = team.reduce(count, see, Sight::pack, Sight::unpack);
    judged(sight.first_not_finite, sight.common, sight.own, least)
}

/// What follows from the first particle that is not finite, from the largest squared speed, wave speed, negative volume
/// ratio and mismatch, and from the largest figures of the formulation, which are no less than `least`.
pub(crate) fn judged<const N: usize>(
    first_not_finite: Option<usize>,
    [speed, wave_speed, ratio, mismatch]: [Most; 4],
    mut own: [Most; N],
    least: [f64; N],
) -> (Health, [Most; N]) {
    let speed = speed.at_least(0.0);
    let health = Health {
        largest_speed: speed.value.sqrt(),
        largest_speed_particle: speed.particle,
        largest_wave_speed: wave_speed.at_least(0.0).value,
        smallest_ratio: -ratio.value,
        smallest_ratio_particle: ratio.particle,
        ratio_mismatch: mismatch.at_least(0.0).value,
        first_not_finite,
        first_escaped: None,
    };
    own.iter_mut().zip(least).for_each(|(most, least)| *most = most.at_least(least));
    (health, own)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// What is seen of 3000 particles, more than a chunk: a speed and a figure of each.
    fn seen(speed: impl Fn(usize) -> f64 + Sync, least: f64) -> (Health, Most) {
        let (health, [most]) = look(&Team::default(), 3000, [least], |a| {
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
        let (none, [most]) = look::<2, 1>(&Team::default(), 0, [0.0], |_| None);
        assert_eq!((none, most), (Health::NEUTRAL, Most { value: 0.0, particle: 0 }));
    }
}
