//! Moving particles against a look at all pairs, and ranks against one.

use std::sync::Arc;

use piola_ranks::{Ranks, Threads};
use rand::{RngExt, SeedableRng};
use rand_pcg::Pcg64;

use super::*;
use crate::operators::LANES;
use crate::parallel::Halo;
use piola_formulas::Lanes;

/// What [`MovingSupport`] shows of a particle (row): numbers in order, the passive ones last.
fn shown<const D: usize>(support: &MovingSupport<D>, row: usize) -> Vec<u32> {
    let place = support.list().places()[row] as usize;
    let (kernel, h) = (support.kernel(), support.smoothing_length());
    let (mut row, mut block) = (support.row(place, Among::All), NeighborBlock::default());
    let mut numbers = Vec::new();
    loop {
        let count = support.next(&mut row, Needs::Both, &mut block);
        if count == 0 {
            break;
        }
        let (mut all, mut true_ones) = (0.0, 0.0);
        for k in 0..count {
            let (other, pair) = support.one(&block, k);
            numbers.push(support.list().numbers()[other]);
            true_ones += kernel.value(D, pair.square.sqrt(), h);
        }
        // Lanes that are filled up add nothing.
        for first in (0..count.next_multiple_of(LANES)).step_by(WIDTH) {
            all += support.four(&block, first).1.value.store().iter().sum::<f64>();
        }
        assert!((all - true_ones).abs() <= 1e-13 * all);
    }
    numbers
}

/// Particles that wander in a box that is periodic along all axes but the last, so that some
/// are near to its bounds, compared with a look at all pairs after each of several moves. The
/// steps are so short that most of the lists are old ones.
fn compare<const D: usize>(count: usize, h: f64) {
    let domain = Domain::new(std::array::from_fn(|axis| (axis + 1 < D).then_some([0.0, 1.0])));
    let domain = domain.expect("the bounds are in order");
    let mut source = Pcg64::seed_from_u64(7);
    let mut positions: Vec<Vector<D>> =
        (0..count).map(|_| Vector::from_fn(|_, _| source.random_range(0.0..1.0))).collect();
    let passive: Vec<bool> = (0..count).map(|number| number % 5 == 0).collect();
    let kernel = Kernel::QuinticSpline;
    let mut support =
        MovingSupport::new(&positions, passive.clone(), kernel, h, domain).expect("it fits");
    let radius = kernel.support_radius(h);
    let reach = 0.04 * radius;
    for _ in 0..6 {
        for a in 0..count {
            let is_near = |b: usize| {
                let separation = domain.separation(&positions[a], &positions[b]);
                b != a && separation.norm() < radius && !(passive[a] && passive[b])
            };
            let near = |is_passive: bool| -> Vec<u32> {
                let others = (0..count).filter(|&b| passive[b] == is_passive && is_near(b));
                others.map(|b| b as u32).collect()
            };
            let expected = [near(false), near(true)].concat();
            assert_eq!(shown(&support, a), expected, "{D}D, particle {a}");
        }
        for position in &mut positions {
            *position += Vector::from_fn(|_, _| source.random_range(-reach..reach));
        }
        support.update(|number| positions[number]).expect("it fits");
    }
    assert!((2..5).contains(&support.list().builds()), "{D}D {}", support.list().builds());
}

/// Ranks show of their own particles what one shows that has all, and know where the copies are that stand in
/// their rows; also where particles are not seen any more.
#[test]
fn ranks_show_the_neighbors_of_one() {
    let (count, bounds) = (400, vec![0, 96, 240, 400]);
    let domain = Domain::new([Some([0.0, 1.0]), None]).expect("the bounds are in order");
    let mut source = Pcg64::seed_from_u64(11);
    let mut positions: Vec<Vector<2>> =
        (0..count).map(|_| Vector::from_fn(|_, _| source.random_range(0.0..1.0))).collect();
    // Each rank has a stripe.
    positions.sort_by(|one, other| one[1].total_cmp(&other[1]));
    let mut rounds = Vec::new();
    for _ in 0..8 {
        rounds.push(positions.clone());
        for position in &mut positions {
            *position += Vector::from_fn(|_, _| source.random_range(-0.006..0.006));
        }
    }
    let passive: Vec<bool> = (0..count).map(|number| number % 5 == 0).collect();
    let excluded: Vec<bool> = (0..count).map(|number| number % 50 == 0).collect();
    let (kernel, start) = (Kernel::QuinticSpline, &rounds[0]);
    let follow = |ranks: Threads| {
        let own = bounds[ranks.rank()]..bounds[ranks.rank() + 1];
        let team = Team::new(Arc::new(ranks), bounds.clone(), Halo::default());
        let alone = MovingSupport::new(start, passive.clone(), kernel, 0.045, domain);
        let mut alone = alone.expect("it fits");
        let mut part = alone.part(team, own.len());
        for (round, positions) in rounds.iter().enumerate() {
            if round == 5 {
                alone.exclude(&passive, &excluded);
                part.exclude(&passive, &excluded);
            }
            alone.update(|number| positions[number]).expect("it fits");
            part.update(|number| positions[number]).expect("it fits");
            for number in own.clone() {
                let shown = [shown(&alone, number), shown(&part, number - own.start)];
                assert_eq!(shown[0], shown[1], "{number} in round {round}");
            }
            let list = part.list();
            assert!(list.owned() == own.len() && list.len() > own.len() && list.len() < count);
            for (number, position) in list.numbers().iter().zip(list.positions()) {
                assert_eq!(*position, domain.wrap(&positions[*number as usize]));
            }
        }
        part.list().builds()
    };
    let builds = std::thread::scope(|scope| {
        let ranks = Threads::group(3).into_iter();
        let all: Vec<_> = ranks.map(|rank| scope.spawn(|| follow(rank))).collect();
        all.into_iter().map(|it| it.join().expect("no rank fails")).collect::<Vec<_>>()
    });
    assert!(builds[0] > 2 && builds[0] < 8 && builds.iter().all(|it| *it == builds[0]));
}

#[test]
fn neighbors_are_those_inside_the_support_in_the_order_of_their_numbers() {
    compare::<1>(60, 0.05);
    compare::<2>(400, 0.045);
    compare::<3>(500, 0.08);
}
