//! One look over a state: is it sound, how fast is it, and what is largest of that which bounds the step.

use std::ops::Range;

use nalgebra::SVector;
use piola_formulas::{Lanes as _, Lanes4, Mask4, Number};

use super::Health;
use crate::parallel::{Reduce, Team};

/// What one particle contributes, or what four of them do, a lane each.
pub(crate) struct Seen<const D: usize, const N: usize, T = f64> {
    pub velocity: SVector<T, D>,
    /// Largest speed of a wave in m/s.
    pub wave_speed: T,
    /// Smallest volume ratio.
    pub ratio: T,
    /// Difference of an evolved volume ratio and the determinant.
    pub mismatch: T,
    /// Figures of the formulation, of which the largest count.
    pub figures: [T; N],
}

impl<const D: usize, const N: usize, T: Number> Seen<D, N, T> {
    /// What is common to all formulations, of which the largest count: squared speed, wave speed, the negative volume ratio
    /// and the mismatch.
    #[inline(always)]
    fn common(&self) -> [T; 4] {
        let mut speed_squared = T::zero();
        for &own in &self.velocity {
            speed_squared += own * own;
        }
        [speed_squared, self.wave_speed, -self.ratio, self.mismatch]
    }
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

/// The largest of a figure in each of four lanes, with the numbers of those who have it.
#[derive(Clone, Copy)]
struct Most4 {
    value: Lanes4,
    particle: Lanes4,
}

impl Most4 {
    /// Sees others, of those that a mask has; what is not a number is not seen.
    #[inline(always)]
    fn see(&mut self, mask: Mask4, value: Lanes4, particle: Lanes4) {
        let is_larger = mask & self.value.less(value);
        self.value = Lanes4::select(is_larger, value, self.value);
        self.particle = Lanes4::select(is_larger, particle, self.particle);
    }

    /// The largest of all lanes, and the first that has it.
    fn of_all_lanes(self) -> Most {
        let mut most = Most::NOTHING;
        for (value, particle) in self.value.store().into_iter().zip(self.particle.store()) {
            let particle = particle as usize;
            if value > most.value || value == most.value && particle < most.particle {
                most = Most { value, particle };
            }
        }
        most
    }
}

/// What has been seen of particles four at a time, a lane each.
pub(crate) struct Sight4<const N: usize> {
    /// The number of the first particle here among those of all ranks.
    first: f64,
    not_finite: Most4,
    common: [Most4; 4],
    own: [Most4; N],
}

impl<const N: usize> Sight4<N> {
    /// Sees four particles from the one at index `first` on, of which those that are not finite take no part. Lanes beyond the
    /// last particle have what it has.
    #[inline(always)]
    pub fn see<const D: usize>(
        &mut self,
        first: usize,
        is_finite: Mask4,
        seen: &Seen<D, N, Lanes4>,
    ) {
        let particle = Lanes4::load([0.0, 1.0, 2.0, 3.0]) + Lanes4::from(self.first + first as f64);
        self.not_finite.see(!is_finite, Lanes4::from(1.0), particle);
        for (most, value) in self.common.iter_mut().zip(seen.common()) {
            most.see(is_finite, value, particle);
        }
        for (most, value) in self.own.iter_mut().zip(seen.figures) {
            most.see(is_finite, value, particle);
        }
    }

    fn of_all_lanes(&self) -> Sight<N> {
        let not_finite = self.not_finite.of_all_lanes();
        Sight {
            first_not_finite: (not_finite.value > 0.0).then_some(not_finite.particle),
            common: self.common.map(Most4::of_all_lanes),
            own: self.own.map(Most4::of_all_lanes),
        }
    }
}

/// What has been seen of some particles: what is [common](Seen::common), and the figures of the formulation.
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
        sight.common.iter_mut().zip(seen.common()).for_each(|(it, value)| it.see(value, particle));
        sight.own.iter_mut().zip(seen.figures).for_each(|(it, value)| it.see(value, particle));
    };
    look_over(team, count, least, |own, sight| own.for_each(|a| see(a, sight)))
}

/// The same of particles that are seen four at a time: `see` shows those of a chunk.
pub(crate) fn look_at_fours<const N: usize>(
    team: &Team,
    count: usize,
    least: [f64; N],
    see: impl Fn(Range<usize>, &mut Sight4<N>) + Sync,
) -> (Health, [Most; N]) {
    let nothing = Most4 { value: Lanes4::from(f64::NEG_INFINITY), particle: Lanes4::from(0.0) };
    let (first, not_finite) = (team.first() as f64, nothing);
    look_over(team, count, least, |own, sight| {
        let mut fours = Sight4 { first, not_finite, common: [nothing; 4], own: [nothing; N] };
        see(own, &mut fours);
        *sight = fours.of_all_lanes();
    })
}

fn look_over<const N: usize>(
    team: &Team,
    count: usize,
    least: [f64; N],
    see: impl Fn(Range<usize>, &mut Sight<N>) + Sync,
) -> (Health, [Most; N]) {
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
    use piola_formulas::WIDTH;

    use super::*;

    /// Of so many particles, more than a chunk and no multiple of four.
    const COUNT: usize = 3002;

    /// What a particle or four of them show: a speed and a figure.
    fn shown<T: Number>(value: T) -> Seen<2, 1, T> {
        let (one, zero) = (T::from(1.0), T::from(0.0));
        let velocity = SVector::from([value, zero]);
        Seen { velocity, wave_speed: one, ratio: value, mismatch: zero, figures: [value] }
    }

    /// What is seen of all, one by one and four at a time.
    fn seen(speed: impl Fn(usize) -> f64 + Sync, least: f64) -> (Health, Most) {
        let team = Team::default();
        let (health, [most]) = look(&team, COUNT, [least], |a| {
            let value = speed(a);
            (value != f64::INFINITY).then(|| shown(value))
        });
        let in_fours = look_at_fours(&team, COUNT, [least], |own, sight| {
            for first in own.clone().step_by(WIDTH) {
                let value = |lane: usize| speed((first + lane).min(own.end - 1));
                let values = Lanes4::load(std::array::from_fn(value));
                let is_finite = !Lanes4::from(f64::INFINITY).at_most(values);
                sight.see(first, is_finite, &shown(values));
            }
        });
        assert_eq!(in_fours, (health, [most]));
        (health, most)
    }

    #[test]
    fn the_first_particle_of_the_worst_is_named() {
        // 7 at 1503, 1504 and 2900, and 1 elsewhere but for 0.5 at 42, 44 and 3001.
        let speed = |a: usize| match a {
            1503 | 1504 | 2900 => 7.0,
            42 | 44 | 3001 => 0.5,
            _ => 1.0,
        };
        let (health, most) = seen(speed, 0.0);
        assert_eq!((health.largest_speed, health.largest_speed_particle), (7.0, 1503));
        assert_eq!((health.smallest_ratio, health.smallest_ratio_particle), (0.5, 42));
        assert_eq!(most, Most { value: 7.0, particle: 1503 });
        // Nobody has what all of them have to exceed.
        assert_eq!(seen(speed, 8.0).1, Most { value: 8.0, particle: 0 });
        assert_eq!(health.first_not_finite, None);
    }

    #[test]
    fn what_is_not_finite_is_named_and_takes_no_part() {
        let speed = |a: usize| match a {
            1703 | 1704 | 3001 => f64::INFINITY,
            2 => f64::NAN,
            _ => 3.0,
        };
        let (health, most) = seen(speed, 0.0);
        assert_eq!(health.first_not_finite, Some(1703));
        assert_eq!((health.largest_speed, health.smallest_ratio), (3.0, 3.0));
        assert_eq!(most, Most { value: 3.0, particle: 0 });
        // Of nothing there is nothing to say.
        let (none, [most]) = look::<2, 1>(&Team::default(), 0, [0.0], |_| None);
        assert_eq!((none, most), (Health::NEUTRAL, Most { value: 0.0, particle: 0 }));
    }
}
