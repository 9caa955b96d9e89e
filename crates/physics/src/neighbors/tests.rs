//! Brute force as the oracle of neighbour lists.

use super::*;
use crate::Vector;
use proptest::prelude::*;
use rand::{RngExt, SeedableRng};
use rand_pcg::Pcg64;

/// Rows by comparing all pairs, with a minimal image found by trying all images next to a point.
fn brute_force<const D: usize>(
    points: &[Vector<D>],
    support: &[f64],
    domain: &Domain<D>,
) -> Vec<Vec<u32>> {
    let points: Vec<_> = points.iter().map(|point| domain.wrap(point)).collect();
    let square = |a: usize, b: usize| -> f64 {
        (0..D)
            .map(|axis| {
                let difference = points[b][axis] - points[a][axis];
                let Some([lower, upper]) = domain.periodic()[axis] else {
                    return difference * difference;
                };
                let length = upper - lower;
                let images = [difference - length, difference, difference + length];
                images.iter().map(|image| image * image).fold(f64::INFINITY, f64::min)
            })
            .sum()
    };
    let near = |a: usize, b: usize| a != b && square(a, b) < support[a] * support[a];
    let row = |a| (0..points.len()).filter(|&b| near(a, b)).map(|b| b as u32).collect();
    (0..points.len()).map(row).collect()
}

fn rows(list: &NeighborList) -> Vec<Vec<u32>> {
    (0..list.len()).map(|a| list.row(a).to_vec()).collect()
}

fn random<const D: usize>(count: usize, seed: u64) -> Vec<Vector<D>> {
    let mut source = Pcg64::seed_from_u64(seed);
    (0..count).map(|_| Vector::from_fn(|_, _| source.random_range(0.0..1.0))).collect()
}

fn assert_equals_brute_force<const D: usize>(
    points: &[Vector<D>],
    support: &[f64],
    domain: &Domain<D>,
) {
    let list = search(points, support, domain).unwrap();
    let expected = brute_force(points, support, domain);
    assert_eq!(rows(&list), expected);
    let dual = list.dual();
    let symmetric = list.clone().symmetric_closure();
    for a in 0..points.len() {
        let sees = |b: usize, a: usize| expected[b].contains(&(a as u32));
        let seen: Vec<u32> = (0..points.len()).filter(|&b| sees(b, a)).map(|b| b as u32).collect();
        assert_eq!(dual.row(a), seen);
        let both = |&b: &usize| sees(b, a) || sees(a, b);
        let both: Vec<u32> = (0..points.len()).filter(both).map(|b| b as u32).collect();
        assert_eq!(symmetric.row(a), both);
    }
    let reverse = symmetric.reverse_entries().unwrap();
    for a in 0..points.len() {
        for entry in symmetric.range(a) {
            let b = symmetric.indices()[entry] as usize;
            let back = reverse[entry] as usize;
            assert!(symmetric.range(b).contains(&back));
            assert_eq!(symmetric.indices()[back], a as u32);
        }
    }
    assert_eq!(list.reverse_entries().is_ok(), list == symmetric);
}

/// Clustered points, some of them coincident or on the bounds, and supports of several octaves.
fn cloud<const D: usize>(count: usize, seed: u64) -> (Vec<Vector<D>>, Vec<f64>) {
    let mut source = Pcg64::seed_from_u64(seed);
    let mut points = random::<D>(count, seed);
    for i in 0..count {
        match source.random_range(0..8) {
            0 => points[i] = points[source.random_range(0..count)],
            1 => points[i][source.random_range(0..D)] = 1.0,
            2 => points[i][source.random_range(0..D)] = 0.0,
            3 => points[i] *= 0.01,
            4 => points[i] += Vector::repeat(source.random_range(-3.0..3.0)),
            _ => (),
        }
    }
    let support = (0..count).map(|_| 0.5 * 0.5f64.powf(source.random_range(0.0..12.0))).collect();
    (points, support)
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(48))]
    #[test]
    fn lists_equal_brute_force(
        count in 0usize..160, seed: u64, x: bool, y: bool, z: bool, uniform: bool,
    ) {
        let bound = |periodic: bool| periodic.then_some([0.0, 1.0]);
        fn case<const D: usize>(count: usize, seed: u64, uniform: bool, domain: Domain<D>) {
            let (points, mut support) = cloud::<D>(count, seed);
            if uniform {
                support.fill(0.23);
            }
            assert_equals_brute_force(&points, &support, &domain);
        }
        case(count, seed, uniform, Domain::new([bound(x)]).unwrap());
        case(count, seed, uniform, Domain::new([bound(x), bound(y)]).unwrap());
        case(count, seed, uniform, Domain::new([bound(x), bound(y), bound(z)]).unwrap());
    }

    #[test]
    fn far_away_points_cost_nothing(
        count in 1usize..120, seed: u64, distance in prop::sample::select(vec![
            1e6, 1e9, 1e12, 1e17, 1e150, 1e300, -1e300, f64::MAX, -f64::MAX,
        ]),
    ) {
        let mut points = random::<3>(count, seed);
        points[0] = Vector::repeat(distance);
        points[count / 2].y = -distance;
        points.push(Vector::repeat(f64::MAX));
        points.push(Vector::repeat(-f64::MAX));
        let support = vec![0.2; points.len()];
        assert_equals_brute_force(&points, &support, &Domain::open());
    }
}

#[test]
fn scattered_clusters_stay_linear() {
    // 20 000 pairs along a diagonal, 1e9 supports apart: 1e27 cells of a whole grid. Comparing all
    // particles of even a hundredth of them with each other would take minutes.
    let points: Vec<Vector<3>> = (0..40_000)
        .map(|i| Vector::repeat(1e9 * f64::from(i / 2) + 0.1 * f64::from(i % 2)))
        .collect();
    let list = search(&points, &vec![1.0; points.len()], &Domain::open()).unwrap();
    let statistics = list.statistics();
    assert_eq!((statistics.least, statistics.mean, statistics.most), (1, 1.0, 1));
}

#[test]
fn a_far_away_point_does_not_merge_the_others_into_one_cell() {
    // Were the coordinates taken from the far point, all others would share a cell, and this
    // would take 1e10 comparisons.
    let mut points = random::<2>(100_000, 3);
    points[17] = Vector::<2>::new(-1e300, 1e300);
    let list = search(&points, &vec![0.005; points.len()], &Domain::open()).unwrap();
    assert!(list.row(17).is_empty());
    assert!((6.0..9.0).contains(&list.statistics().mean), "{:?}", list.statistics());
}

#[test]
fn a_large_offset_keeps_neighbours() {
    // Near 1e9 coordinates are multiples of 1.2e-7; the support is 0.25.
    let offset = Vector::<2>::new(1e9, -1e9);
    let points: Vec<_> = random::<2>(300, 5).iter().map(|x| x + offset).collect();
    assert_equals_brute_force(&points, &vec![0.25; 300], &Domain::open());
}

#[test]
fn threads_do_not_change_a_bit() {
    let (points, support) = cloud::<2>(5000, 11);
    let support: Vec<f64> = support.iter().map(|s| 0.1 * s).collect();
    let domain = Domain::new([Some([0.0, 1.0]), None]).unwrap();
    let run = |threads| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        pool.install(|| {
            let list = search(&points, &support, &domain).unwrap();
            let order = spatial_order(&points, 0.02).unwrap();
            (list.dual(), list.clone().symmetric_closure(), list, order)
        })
    };
    let one = run(1);
    for threads in [2, 3, 7] {
        assert_eq!(run(threads), one);
    }
}

#[test]
fn a_period_of_two_supports_is_the_shortest() {
    let points = [Vector::<1>::new(0.0), Vector::<1>::new(0.9), Vector::<1>::new(1.0)];
    let domain = Domain::new([Some([0.0, 2.0])]).unwrap();
    let list = search(&points, &[1.0; 3], &domain).unwrap();
    assert_eq!(rows(&list), [vec![1], vec![0, 2], vec![1]]);
    let error = search(&points, &[1.0, 1.1, 1.0], &domain).unwrap_err();
    assert_eq!(
        error,
        NeighborError::PeriodicTooShort { axis: "x", length: 2.0, particle: 1, support: 1.1 }
    );
    let long = Domain::new([Some([0.0, 1e300])]).unwrap();
    let error = search(&points, &[1.0; 3], &long).unwrap_err();
    assert!(matches!(error, NeighborError::PeriodicTooLong { axis: "x", .. }));
}

#[test]
fn unusable_input_is_refused() {
    let points = [Vector::<2>::zeros(), Vector::<2>::new(0.0, f64::NAN)];
    let open = Domain::open();
    let error = search(&points, &[1.0; 2], &open).unwrap_err();
    assert!(matches!(error, NeighborError::NonFinite { particle: 1, .. }), "{error}");
    for bad in [0.0, -1.0, f64::NAN, f64::INFINITY, 1e-200, 1e200] {
        let error = search(&points[..1], &[bad], &open).unwrap_err();
        assert!(matches!(error, NeighborError::Support { particle: 0, .. }), "{error}");
    }
    let error = search(&points, &[1.0], &open).unwrap_err();
    assert_eq!(error, NeighborError::SupportCount { points: 2, supports: 1 });
}

#[test]
fn coincident_particles_are_named() {
    let mut points = random::<3>(2000, 9);
    points[1500] = points[700] + Vector::<3>::new(0.0, 1e-12, 0.0);
    let open = Domain::open();
    assert_eq!(refuse_coincident(&points, 1e-13, &open), Ok(()));
    match refuse_coincident(&points, 1e-9, &open).unwrap_err() {
        NeighborError::Coincident { first, second, distance, .. } => {
            assert_eq!((first, second), (700, 1500));
            assert!((distance - 1e-12).abs() < 1e-15);
        }
        other => panic!("{other}"),
    }
    let heap = vec![Vector::<2>::new(0.5, 0.5); 200_000];
    let error = refuse_coincident(&heap, 1e-9, &Domain::open()).unwrap_err();
    assert!(error.to_string().starts_with("particles 0 and 1 are 0e0 m apart"), "{error}");
    let ends = [Vector::<1>::new(0.0), Vector::<1>::new(1.0)];
    assert_eq!(refuse_coincident(&ends, 1e-9, &Domain::open()), Ok(()));
    assert!(refuse_coincident(&ends, 1e-9, &Domain::new([Some([0.0, 1.0])]).unwrap()).is_err());
}

#[test]
fn statistics_of_nothing_are_zero() {
    let list = search::<2>(&[], &[], &Domain::open()).unwrap();
    assert!(list.is_empty());
    assert_eq!(list.statistics(), NeighborStatistics { least: 0, mean: 0.0, most: 0 });
}

#[test]
fn an_entry_without_its_reverse_is_named() {
    let points = [Vector::<1>::new(0.0), Vector::<1>::new(1.0), Vector::<1>::new(2.0)];
    let list = search(&points, &[1.5, 0.5, 1.5], &Domain::open()).unwrap();
    let error = list.reverse_entries().unwrap_err();
    assert_eq!(error, NeighborError::NotSymmetric { particle: 0, neighbor: 1 });
    let list = search(&points, &[0.5, 1.5, 0.5], &Domain::open()).unwrap();
    let error = list.reverse_entries().unwrap_err();
    assert_eq!(error, NeighborError::NotSymmetric { particle: 1, neighbor: 0 });
}

/// The rows of a list of what moves, by number.
fn rows_by_number<const D: usize>(list: &SkinList<D>) -> Vec<[Vec<u32>; 2]> {
    let name = |row: &[u32]| row.iter().map(|&at| list.numbers()[at as usize]).collect();
    let of = |&place: &u32| {
        let place = place as usize;
        [name(list.active_row(place)), name(list.passive_row(place))]
    };
    list.places().iter().map(of).collect()
}

/// A list that is made in the arrays of others, of more neighbours and of fewer, of crowds and of points far away, with other
/// particles passive and left out, is that of a list that was never another.
#[test]
fn lists_in_the_arrays_of_others_are_as_good_as_new() {
    const COUNT: usize = 2300;
    let mut source = Pcg64::seed_from_u64(5);
    let domain = Domain::<2>::open();
    let mut reused: Option<SkinList<2>> = None;
    for (k, size) in [1.0, 0.4, 3.0, 1e6, 0.6, 1e6, 1.0].into_iter().enumerate() {
        let mut points = random::<2>(COUNT, k as u64);
        points.iter_mut().for_each(|point| *point *= size);
        // Crowds far apart, so that cells are those with points alone.
        let far = |a: usize| if a % 7 == k % 7 { 1e9 * a as f64 } else { 0.0 };
        points.iter_mut().enumerate().for_each(|(a, point)| point.x += far(a));
        let mut some = |share: f64| -> Vec<bool> {
            (0..COUNT).map(|_| source.random_range(0.0..1.0) < share).collect()
        };
        let (passive, excluded) = (some(0.3), some(if k % 2 == 0 { 0.5 } else { 0.0 }));
        let mut new = SkinList::new(&points, passive.clone(), 0.05, 0.01, domain).unwrap();
        let list = reused.get_or_insert_with(|| {
            SkinList::new(&points, vec![false; COUNT], 0.05, 0.01, domain).unwrap()
        });
        for list in [&mut new, list] {
            list.exclude(&passive, &excluded);
            list.update(&mut [(); COUNT], |number, ()| points[number]).unwrap();
        }
        assert_eq!(rows_by_number(list), rows_by_number(&new), "{k}");
        // A list that cannot be made leaves one that can be asked, and the next one is good.
        let broken = list.update(&mut [(); COUNT], |number, ()| match number {
            9 => Vector::<2>::repeat(f64::NAN),
            _ => points[number] * 3.0,
        });
        assert!(broken.is_err());
        assert_eq!(rows_by_number(list).len(), COUNT);
        list.update(&mut [(); COUNT], |number, ()| points[number]).unwrap();
        assert_eq!(rows_by_number(list), rows_by_number(&new), "{k}");
    }
}
