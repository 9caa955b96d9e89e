//! Exact sums against integers of any length.

use num_bigint::BigInt;
use piola_ranks::Exact;
use proptest::prelude::*;

/// A number over the smallest one, 2⁻¹⁰⁷⁴. Infinity stands for the number that would follow the largest one.
fn whole(x: f64) -> BigInt {
    if x.is_infinite() {
        return BigInt::from(x.signum() as i8) << 2098;
    }
    let exponent = (x.to_bits() >> 52 & 0x7ff) as u32;
    let fraction = x.to_bits() & ((1 << 52) - 1);
    let magnitude = match exponent {
        0 => BigInt::from(fraction),
        _ => BigInt::from(fraction + (1 << 52)) << (exponent - 1),
    };
    if x < 0.0 { -magnitude } else { magnitude }
}

/// Whether no number is nearer to `sum` than `x`, or as near and even.
fn is_nearest(sum: &BigInt, x: f64) -> bool {
    let distance = |x: f64| (sum - whole(x)).magnitude().clone();
    let is_even = x.to_bits() & 1 == 0;
    [x.next_up(), x.next_down()]
        .into_iter()
        .filter(|other| !other.is_nan())
        .all(|other| distance(x) < distance(other) || is_even && distance(x) == distance(other))
}

fn of(terms: &[f64]) -> Exact {
    let mut sum = Exact::default();
    terms.iter().for_each(|&term| sum.add(term));
    sum
}

/// The sum over several ranks, on the first of them.
fn together(ranks: impl IntoIterator<Item = Exact>) -> Exact {
    let add = |mut sum: Exact, mut part: Exact| {
        let limbs = sum.limbs_mut().iter_mut().zip(part.limbs_mut());
        limbs.for_each(|(sum, limb)| *sum = sum.wrapping_add(*limb));
        sum
    };
    ranks.into_iter().reduce(add).unwrap_or_default()
}

/// Checks the total of terms against the sum of integers, and returns it.
fn checked(terms: &[f64]) -> f64 {
    let total = of(terms).total();
    let sum: BigInt = terms.iter().map(|&term| whole(term)).sum();
    assert!(is_nearest(&sum, total), "{total:e} is not the sum of {terms:?}");
    total
}

/// Finite numbers of all exponents.
fn any_finite() -> impl Strategy<Value = f64> {
    any::<u64>().prop_map(f64::from_bits).prop_filter("finite", |x| x.is_finite())
}

/// Few bits each, close to each other, so that sums are often half way between two numbers.
fn close(lowest: i32) -> impl Strategy<Value = f64> {
    (-3i8..=3, lowest..lowest + 60)
        .prop_map(|(digit, exponent)| f64::from(digit) * 2f64.powi(exponent))
}

fn terms() -> impl Strategy<Value = Vec<f64>> {
    let each = prop_oneof![
        prop::collection::vec(any_finite(), 0..40).boxed(),
        prop::collection::vec(close(-1074), 0..12).boxed(),
        prop::collection::vec(close(-30), 0..12).boxed(),
        prop::collection::vec(close(962), 0..12).boxed(),
    ];
    // Some of the terms are there again with the other sign.
    (each, 0..10usize).prop_map(|(mut terms, cancelled)| {
        let again: Vec<f64> = terms.iter().take(cancelled).map(|term| -term).collect();
        terms.extend(again);
        terms
    })
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(4000))]

    #[test]
    fn a_total_is_the_number_nearest_to_the_sum(terms in terms()) {
        checked(&terms);
    }

    #[test]
    fn a_single_term_is_its_own_sum(x in any_finite()) {
        prop_assume!(x != 0.0);
        prop_assert_eq!(of(&[x]).total().to_bits(), x.to_bits());
    }

    /// Each term goes to one of four ranks, whose sums are added entry by entry.
    #[test]
    fn neither_order_nor_grouping_changes_a_bit(
        (terms, shuffled) in terms().prop_flat_map(|terms| (Just(terms.clone()), Just(terms).prop_shuffle())),
        ranks in prop::collection::vec(0..4usize, 50),
    ) {
        let expected = of(&terms).total().to_bits();
        prop_assert_eq!(of(&shuffled).total().to_bits(), expected);
        let mut parts = vec![Exact::default(); 4];
        shuffled.iter().zip(ranks.iter().cycle()).for_each(|(&term, &rank)| parts[rank].add(term));
        prop_assert_eq!(together(parts).total().to_bits(), expected);
    }
}

#[test]
fn what_cancels_leaves_nothing_behind() {
    assert_eq!(of(&[]).total().to_bits(), 0);
    assert_eq!(of(&[-0.0]).total().to_bits(), 0);
    assert_eq!(checked(&[f64::MAX, 5e-324, -f64::MAX]), 5e-324);
    assert_eq!(checked(&[1e16, 1.0, -1e16, 1e-16]), 1.0);
    assert_eq!(checked(&[f64::MAX, f64::MAX, -f64::MAX]), f64::MAX);
}

#[test]
fn sums_half_way_go_to_the_even_number() {
    let unit = f64::EPSILON;
    assert_eq!(checked(&[1.0, unit / 2.0]), 1.0);
    assert_eq!(checked(&[1.0 + unit, unit / 2.0]), 1.0 + 2.0 * unit);
    assert_eq!(checked(&[1.0, unit / 2.0, 5e-324]), 1.0 + unit);
    assert_eq!(checked(&[1.0 + unit, unit / 2.0, -5e-324]), 1.0 + unit);
    assert_eq!(checked(&[f64::MIN_POSITIVE, -5e-324]), f64::MIN_POSITIVE.next_down());
}

#[test]
fn sums_beyond_the_largest_number_are_infinite() {
    let half = 2f64.powi(970);
    assert_eq!(checked(&[f64::MAX, half.next_down()]), f64::MAX);
    assert_eq!(checked(&[f64::MAX, half]), f64::INFINITY);
    assert_eq!(checked(&[-f64::MAX, -half]), f64::NEG_INFINITY);
    assert_eq!(of(&[f64::MAX; 2]).total(), f64::INFINITY);
    assert_eq!(of(&[-f64::MAX; 5]).total(), f64::NEG_INFINITY);
}

#[test]
fn infinities_and_what_is_no_number_stay() {
    let (infinite, nan) = (f64::INFINITY, f64::NAN);
    let cases = [
        (vec![infinite, -f64::MAX, infinite], infinite),
        (vec![1.0, -infinite], -infinite),
        (vec![infinite, -infinite], nan),
        (vec![nan, 1.0], nan),
        (vec![nan, infinite], nan),
    ];
    for (terms, expected) in cases {
        assert_eq!(of(&terms).total().to_bits(), expected.to_bits(), "{terms:?}");
        let parts = [Exact::default(), of(&terms[..1]), of(&terms[1..])];
        assert_eq!(together(parts).total().to_bits(), expected.to_bits(), "{terms:?}");
        let mut added = of(&terms);
        *added.limbs_mut() = of(&terms).limbs_mut().map(|limb| limb * 4096);
        assert_eq!(added.total().to_bits(), expected.to_bits(), "{terms:?}");
    }
}

/// Doubled 70 times, with all bits of a term set, sums hold more terms than entries could without carrying.
#[test]
fn entries_do_not_overflow() {
    for exponent in [0, 1, 31, 32, 33, 900] {
        for sign in [1.0, -1.0] {
            let term = sign * (2.0 - f64::EPSILON) * 2f64.powi(exponent);
            let doubled = |sum: Exact| (0..35).fold(sum, |sum, _| together([sum.clone(), sum]));
            let mut sum = doubled(of(&[term]));
            assert_eq!(sum.total(), term * 2f64.powi(35));
            // As from 2³⁰ ranks.
            let limbs = *sum.limbs_mut();
            *sum.limbs_mut() = limbs.map(|limb| limb << 30);
            sum.add(term);
            let expected = (whole(term) << 65) + whole(term);
            assert!(is_nearest(&expected, sum.total()));
            assert!(is_nearest(&(expected << 35), doubled(sum).total()));
        }
    }
}
