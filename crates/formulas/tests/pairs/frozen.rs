//! Laws of lists that do not change: what is conserved, and what is exact.

use super::*;

/// The sums of both particles of a pair.
fn exchanged<L>(
    law: &L,
    sides: [&Of<L::Side, f64>; 2],
    pair: &Areas<f64, 2>,
) -> [upwind::ExchangeSums<f64, 2>; 2]
where
    L: PairLaw<Pair = Frozen<AreaPair<2>>, Sums = upwind::ExchangeSum<2>>,
{
    let back = Areas { area: pair.transposed, transposed: pair.area };
    [sums_of(law, sides, &(*pair, 1.0)), sums_of(law, [sides[1], sides[0]], &(back, 1.0))]
}

#[test]
fn what_dissipation_gives_to_one_it_takes_from_the_other() {
    let open = Periods::new([f64::INFINITY; 2]);
    let (one, two) = (some::<upwind::UpwindSide<2>>(0.2), some::<upwind::UpwindSide<2>>(0.7));
    let (slope, other) = (some::<upwind::UpwindSlope<2>>(0.3), some::<upwind::UpwindSlope<2>>(0.6));
    let pair = some::<AreaPair<2>>(0.4);
    let law = upwind::Exchange::<2, true, true>(open);
    let reconstructed = upwind::Reconstructed(law);
    let plain = exchanged(&law, [&one, &two], &pair);
    let with_slopes = exchanged(&reconstructed, [&(one, slope), &(two, other)], &pair);
    for [forward, back] in [plain, with_slopes] {
        let force = forward.upwind_force;
        assert!((force + back.upwind_force).norm() <= 1e-14 * force.norm() && force.norm() > 1e-3);
        let rate = forward.upwind_volume_rate;
        assert!((rate + back.upwind_volume_rate).abs() <= 1e-14 * rate.abs() && rate != 0.0);
    }
}

#[test]
fn a_linear_field_has_no_reconstructed_jump() {
    let open = Periods::new([f64::INFINITY; 2]);
    let mut slope = <upwind::UpwindSlope<2> as Record>::zero::<f64>();
    (slope.velocity[(0, 1)], slope.pressure[0]) = (0.3, 0.7);
    let mut one = some::<upwind::UpwindSide<2>>(0.2);
    let mut two = some::<upwind::UpwindSide<2>>(0.7);
    let way = two.reference - one.reference;
    two.velocity = one.velocity + slope.velocity * way;
    two.pressure = one.pressure + slope.pressure.dot(&way);
    let pair = (some::<AreaPair<2>>(0.4), 1.0);
    let law = upwind::Reconstructed(upwind::Exchange::<2, true, true>(open));
    let sums = sums_of(&law, [&(one, slope), &(two, slope)], &pair);
    assert!(sums.upwind_force.norm() + sums.upwind_volume_rate.abs() <= 1e-14);
    // Without dissipation what is left is adjoint: p H : dF is the power of the internal force.
    one.velocity = zero();
    let given = sums_of(&upwind::Exchange::<2, false, false>(open), [&one, &two], &pair);
    let gradient = sums_of(&upwind::Gradient::<2>, [&one.velocity, &two.velocity], &pair);
    assert_eq!(given.volume_deformation_rate, gradient);
    let stress = two.cofactor * two.pressure;
    let force = sums_of(&upwind::Divergence::<2>, [&stress, &stress], &pair);
    assert!((given.internal_force - force).norm() <= 1e-14 * force.norm());
    assert!((force - stress * pair.0.transposed).norm() <= 1e-14 * force.norm());
    // Least squares find the slope along the way, round a periodic box, too.
    let around = Periods::new([0.1 + way[0].abs(), f64::INFINITY]);
    let shorter = Vector2::new(-0.1 * way[0].signum(), way[1]);
    for (periods, way) in [(open, way), (around, shorter)] {
        let moments = sums_of(&upwind::Slopes(periods), [&one, &two], &pair);
        let expected = two.velocity * way.transpose() / way.norm_squared();
        assert!((moments.velocity - expected).norm() <= 1e-14, "{moments:?}");
    }
}

#[test]
fn what_a_support_takes_the_other_side_gets_back() {
    use total_lagrangian::{Forces, Gradients};
    let [g, h] = [0.4, 0.8].map(some::<Components<2>>);
    let [one, two] = [0.2, 0.7].map(some::<Components<2>>);
    // An energy of the sums W is E = R . W, and k |u_ab|^2/2 of a difference.
    let (tension, stiffness) = (some::<Each<Square<2>, 2>>(0.3), 0.6);
    let energy = |[one, two]: [SVector<f64, 2>; 2]| {
        let sums = sums_of(&Gradients::<2, 2>, [&one, &two], &([g, h], 1.0));
        let of_sums: f64 = tension.iter().zip(&sums).map(|(r, sum)| r.dot(sum)).sum();
        of_sums + 0.5 * stiffness * (two - one).norm_squared()
    };
    let sides = [(tension, one), (tension, two)];
    let pair = (([g, h], stiffness), 1.0);
    let force = sums_of(&Forces::<2, 2>, [&sides[1], &sides[0]], &pair);
    for i in 0..2 {
        let moved = |step: f64| {
            let mut two = two;
            two[i] += step;
            energy([one, two])
        };
        // The energy is quadratic, so that this difference is its slope.
        let slope = 0.5 * (moved(1.0) - moved(-1.0));
        assert!((force[i] + slope).abs() <= 1e-14, "{} {slope}", force[i]);
    }
}
