//! Pair laws: one body for all number types, momentum that comes in pairs, and manufactured fields.

mod conjugate;
mod frozen;

use std::cell::Cell;
use std::fs;
use std::path::Path;

use nalgebra::{SVector, Vector2};
use num_dual::Dual64;
use piola_formulas::kernels::{Kernel, Needs};
use piola_formulas::pairs::{
    AreaPair, Areas, Components, Each, Frozen, Moving, MovingPair, Of, One, PairLaw, Periods,
    Record, Square, corrected, fit, fluid, solid, sums, total_lagrangian, upwind, wall,
};
use piola_formulas::{Lanes, Lanes4, WIDTH};

/// A record of different numbers between a half and two, which are all positive.
fn some<R: Record>(seed: f64) -> Of<R, f64> {
    let next = Cell::new(seed);
    R::map([&R::zero::<f64>()], &|_: [f64; 1]| {
        next.set((next.get() * 7.31 + 0.377).fract());
        0.5 + 1.5 * next.get()
    })
}

/// All numbers of a record.
fn numbers<R: Record>(record: &Of<R, f64>) -> Vec<f64> {
    let all = std::cell::RefCell::new(Vec::new());
    R::map([record], &|[x]: [f64; 1]| {
        all.borrow_mut().push(x);
        x
    });
    all.into_inner()
}

fn sums_of<L: PairLaw>(
    law: &L,
    [me, other]: [&Of<L::Side, f64>; 2],
    pair: &Of<L::Pair, f64>,
) -> Of<L::Sums, f64> {
    let mut sums = L::Sums::zero();
    law.add(me, other, pair, &mut sums);
    sums
}

/// Lanes and dual numbers give what single numbers give, and a pair beyond the support adds nothing.
fn check<L: PairLaw>(name: &str, law: L) {
    let sides: [_; WIDTH + 1] = std::array::from_fn(|k| some::<L::Side>(0.1 + 0.17 * k as f64));
    let [me, others @ ..] = &sides;
    let pairs: [_; WIDTH] = std::array::from_fn(|k| some::<L::Pair>(0.05 + 0.21 * k as f64));
    let spread = |[x]: [f64; 1]| Lanes4::from(x);
    let spread = L::Side::map([me], &spread);
    let other = L::Side::map(others.each_ref(), &Lanes4::load);
    let pair = L::Pair::map(pairs.each_ref(), &Lanes4::load);
    let mut lanes = L::Sums::zero();
    law.add(&spread, &other, &pair, &mut lanes);
    let as_dual = |[x]: [f64; 1]| Dual64::from(x);
    let mut adds = false;
    for k in 0..WIDTH {
        let single = numbers::<L::Sums>(&sums_of(&law, [me, &others[k]], &pairs[k]));
        let lane = L::Sums::map([&lanes], &|[x]: [Lanes4; 1]| x.store()[k]);
        assert_eq!(numbers::<L::Sums>(&lane), single, "{name}, lane {k}");
        let mut dual = L::Sums::zero();
        law.add(
            &L::Side::map([me], &as_dual),
            &L::Side::map([&others[k]], &as_dual),
            &L::Pair::map([&pairs[k]], &as_dual),
            &mut dual,
        );
        let real = L::Sums::map([&dual], &|[x]: [Dual64; 1]| x.re);
        for (x, y) in numbers::<L::Sums>(&real).iter().zip(&single) {
            assert!((x - y).abs() <= 1e-13 * y.abs(), "{name}: {x} {y}");
        }
        adds |= single.iter().any(|x| *x != 0.0);
    }
    assert!(adds, "{name} adds nothing");
}

/// A pair far beyond the support, as it fills up the last lanes.
fn check_padding<const D: usize, L: PairLaw<Pair = MovingPair<D>>>(name: &str, law: &L) {
    let far = Moving {
        separation: SVector::repeat(10.0),
        square: 100.0 * D as f64,
        value: 0.0,
        slope: 0.0,
    };
    let (me, other) = (some::<L::Side>(0.3), some::<L::Side>(0.4));
    for x in numbers::<L::Sums>(&sums_of(law, [&me, &other], &far)) {
        assert_eq!(x, 0.0, "{name}");
    }
}

/// What fills up the last lanes of a frozen list.
fn check_frozen_padding<R: Record, L: PairLaw<Pair = Frozen<R>>>(name: &str, law: L) {
    let (me, other) = (some::<L::Side>(0.3), some::<L::Side>(0.4));
    for x in numbers::<L::Sums>(&sums_of(&law, [&me, &other], &<(R, One)>::zero())) {
        assert_eq!(x, 0.0, "{name}");
    }
}

const FLUID: fluid::ForceConstants = fluid::ForceConstants {
    softening: 0.01,
    viscosity: 0.3,
    viscous: fluid::Viscous::Laplacian,
    artificial: 0.2,
    dilatation: 1.0,
    crowding: 0.7,
};

const STRESSED: fluid::ForceConstants =
    fluid::ForceConstants { viscous: fluid::Viscous::Stress, ..FLUID };

const SOLID: solid::ForceConstants = solid::ForceConstants {
    softening: 0.01,
    artificial: 0.2,
    artificial_apart: 0.1,
    penalty: 0.4,
    spacing: 3.0,
    crowding: 0.7,
};

/// Calls a check with each law, by name.
macro_rules! each_law {
    ($check:ident) => {{
        use fluid::{FULL, NONE, STRESS};
        use solid::{ALONE, ANY, ELASTIC, ONE, PUSH, SPRINGS};
        let kernel = Kernel::QuinticSpline;
        let rates = fluid::RateConstants { softening: 0.01, diffusivity: 0.2 };
        let gradients =
            solid::RateConstants { softening: 0.01, artificial: 0.2, diffusion: 0.1, moves: 1.0 };
        $check("forces", fluid::Forces::<3, FULL, true, true>(FLUID));
        $check("forces", fluid::Forces::<2, STRESS, true, false>(FLUID));
        $check("forces", fluid::Forces::<1, NONE, false, true>(FLUID));
        $check("wall forces", fluid::WallForces(fluid::Forces::<2, FULL, true, true>(FLUID)));
        $check("wall", fluid::Wall::<2>::of(&FLUID));
        $check("stresses", fluid::Forces::<3, NONE, false, false>(STRESSED));
        $check("wall stresses", fluid::Wall::<2>::of(&STRESSED));
        $check("rates", fluid::Rates::<2, true, true, true>(rates));
        $check("rates", fluid::Rates::<3, false, false, false>(rates));
        let law = fluid::Forces::<3, FULL, true, true>(FLUID);
        $check("corrected forces", corrected::CorrectedForces(law, 0.3));
        let law = corrected::CorrectedForces(fluid::Forces::<2, FULL, false, false>(FLUID), 0.3);
        $check("corrected wall forces", corrected::CorrectedWallForces(law));
        $check("corrected wall", corrected::CorrectedWall(fluid::Wall::<2>::of(&FLUID)));
        $check("corrected rates", corrected::CorrectedRates::<3, true>(rates));
        $check("corrected velocity gradient", corrected::VelocityGradient::<2>);
        $check("corrected wall moment", corrected::WallMoment::<3>);
        $check("solid forces", solid::Forces::<2, true, ONE>(SOLID));
        $check("solid forces", solid::Forces::<3, false, PUSH>(SOLID));
        $check("solid forces", solid::Forces::<2, false, SPRINGS>(SOLID));
        $check("solid wall forces", solid::WallForces(solid::Forces::<2, false, ONE>(SOLID)));
        $check("solid wall", solid::Wall::<3>);
        $check("solid rates", solid::Rates::<3, ANY, true>(gradients));
        $check("solid rates", solid::Rates::<2, ELASTIC, true>(gradients));
        $check("solid rates", solid::Rates::<1, ALONE, false>(gradients));
        $check("moments", solid::Moments::<2>);
        $check("fit", fit::Fit::<2>);
        $check("extrapolation", wall::Extrapolation::<2>);
        $check("stress extrapolation", wall::StressExtrapolation::<3>);
        $check("density", sums::Density::<2>);
        $check("opening", sums::Opening::<2>);
        $check("velocity gradient", sums::VelocityGradient::<3>);
        $check("surface normal", sums::SurfaceNormal::<2>);
        let (crowding, smoothing_length) = (0.7, 0.8);
        $check("crowding", sums::CrowdingWithin::<2> { kernel, smoothing_length, crowding });
        let smoothing_length = Some(0.8);
        $check("displacement", sums::Displacement::<2> { kernel, smoothing_length });
        $check("background", sums::Background::<2> { kernel, smoothing_length: 0.8 });
    }};
}

/// The same with each law of frozen lists.
macro_rules! each_frozen_law {
    ($check:ident) => {{
        use upwind::{Divergence, Exchange, Gradient, Reconstructed, Slopes};
        let open = Periods::new([f64::INFINITY; 2]);
        let periodic = Periods::new([0.9, f64::INFINITY, 0.4]);
        $check("exchange", Exchange::<2, false, false>(open));
        $check("exchange", Exchange::<2, true, false>(open));
        $check("exchange", Exchange::<3, false, true>(periodic));
        $check("reconstructed", Reconstructed(Exchange::<2, true, true>(open)));
        $check("reconstructed", Reconstructed(Exchange::<3, true, true>(periodic)));
        $check("slopes", Slopes::<3>(periodic));
        $check("gradient", Gradient::<2>);
        $check("divergence", Divergence::<3>);
        use total_lagrangian::{Forces, Gradients};
        $check("gradients", Gradients::<2, 1>);
        $check("gradients", Gradients::<3, 2>);
        $check("forces", Forces::<2, 2>);
        $check("forces", Forces::<3, 1>);
    }};
}

#[test]
fn a_law_is_the_same_for_all_numbers() {
    each_law!(check);
    each_frozen_law!(check);
}

#[test]
fn what_fills_up_lanes_adds_nothing() {
    fn check<const D: usize, L: PairLaw<Pair = MovingPair<D>>>(name: &str, law: L) {
        check_padding(name, &law);
    }
    each_law!(check);
    each_frozen_law!(check_frozen_padding);
}

/// Every law of the crate is in the list above.
#[test]
fn no_law_is_left_out() {
    let here = include_str!("main.rs");
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("src/pairs");
    let mut laws = 0;
    for file in fs::read_dir(&folder).expect("the crate has pair laws") {
        let path = file.expect("it can be listed").path();
        if path.extension().is_none_or(|kind| kind != "rs") {
            continue;
        }
        let source = fs::read_to_string(&path).expect("it is text");
        let module = path.file_stem().and_then(|name| name.to_str()).unwrap_or_default();
        for after in source.split("PairLaw").skip(1) {
            let Some(after) = after.trim_start().strip_prefix("for ") else { continue };
            let name = after.split(['<', ' ']).next().unwrap_or_default();
            let path = format!("{module}::{name}");
            // A check names the module too, but for the two whose laws are imported where they are listed.
            let called = match module {
                "total_lagrangian" | "upwind" => name.to_owned(),
                _ => path.clone(),
            };
            let is_listed =
                ["::<", "("].iter().any(|after| here.contains(&format!("\", {called}{after}")));
            assert!(is_listed, "{path} is not tested");
            laws += 1;
        }
    }
    // There are more; fewer mean that the search for them is broken.
    assert!(laws > 20, "{laws}");
}

/// The pair as the other particle sees it.
fn turned<const D: usize>(pair: &Moving<f64, D>) -> Moving<f64, D> {
    Moving { separation: -pair.separation, ..*pair }
}

#[test]
fn forces_between_two_particles_of_a_fluid_are_opposite() {
    let law = fluid::Forces::<2, { fluid::NONE }, true, false>(FLUID);
    let (one, two) = (some::<fluid::FluidSide<2>>(0.2), some::<fluid::FluidSide<2>>(0.7));
    let pair: Moving<f64, 2> =
        Moving { slope: -0.8, separation: Vector2::new(-0.4, 0.3), ..some::<MovingPair<2>>(0.4) };
    let forward = sums_of(&law, [&one, &two], &pair);
    let back = sums_of(&law, [&two, &one], &turned(&pair));
    let opposite = |a: &Vector2<f64>, b: &Vector2<f64>| {
        let sum = a * one.mass() + b * two.mass();
        assert!(sum.norm() <= 1e-15 && a.norm() > 1e-3, "{a} {b}");
    };
    opposite(&forward.pressure, &back.pressure);
    opposite(&forward.viscosity, &back.viscosity);
    // One of the two signs of the jump is an approach.
    if forward.artificial_viscosity.norm() > 0.0 {
        opposite(&forward.artificial_viscosity, &back.artificial_viscosity);
    } else {
        assert_eq!(back.artificial_viscosity.norm(), 0.0);
    }
    // What a wall gets is what the fluid gets from it.
    let wall = fluid::Wall::<2>::of(&FLUID);
    let shear = two.velocity;
    let given = sums_of(&fluid::WallForces(law), [&(one, shear), &(two, shear)], &pair).walls;
    let taken = sums_of(&wall, [&(two, shear), &(one, shear)], &turned(&pair));
    assert!((given * one.mass() + taken * two.mass()).norm() <= 1e-15 && given.norm() > 1e-3);
}

#[test]
fn forces_between_two_particles_of_solids_are_opposite() {
    type Stressed = (fluid::FluidSide<2>, solid::SolidTension<2>);
    let weighed = |seed: f64| {
        let (side, mut tension) = some::<Stressed>(seed);
        tension.weight = side.mass();
        (side, tension)
    };
    let (one, two) = (weighed(0.2), weighed(0.7));
    let pair = Moving {
        slope: -0.8,
        square: 0.25,
        separation: Vector2::new(-0.4, 0.3),
        ..some::<MovingPair<2>>(0.4)
    };
    let law = solid::Forces::<2, false, { solid::PUSH }>(SOLID);
    for own in [0.0, 1.0] {
        let forward = sums_of(&law, [&(one, own), &(two, own)], &pair);
        let back = sums_of(&law, [&(two, own), &(one, own)], &turned(&pair));
        let [a, b] = [&forward, &back].map(|sums| sums.stress + sums.contact + sums.artificial);
        assert!((a * one.0.mass() + b * two.0.mass()).norm() <= 1e-14 && a.norm() > 1e-3);
    }
}

/// A lattice of spacing 1 around the origin, with the pairs of the particle there.
fn around(law_needs: Needs, look: &mut dyn FnMut(Vector2<f64>, Moving<f64, 2>)) {
    let (kernel, h) = (Kernel::QuinticSpline, 1.3);
    assert_ne!(law_needs, Needs::Nothing);
    for i in -4..=4 {
        for j in -4..=4 {
            if (i, j) != (0, 0) {
                let place = Vector2::new(f64::from(i), f64::from(j));
                let distance = place.norm();
                look(
                    place,
                    Moving {
                        separation: -place,
                        square: place.norm_squared(),
                        value: kernel.value(2, distance, h),
                        slope: kernel.derivative_over_r(2, distance, h),
                    },
                );
            }
        }
    }
}

/// The sums at the origin of fields on the lattice.
fn sum_of<L: PairLaw<Pair = MovingPair<2>>>(
    law: &L,
    side: impl Fn(Vector2<f64>) -> Of<L::Side, f64>,
) -> Of<L::Sums, f64> {
    let me = side(Vector2::zeros());
    let mut sums = L::Sums::zero();
    around(L::NEEDS, &mut |place, pair| law.add(&me, &side(place), &pair, &mut sums));
    sums
}

/// A fluid of density and pressure, velocity and deviation.
fn water(density: f64, pressure: f64, velocity: Vector2<f64>, deviation: Vector2<f64>) -> Side {
    let mut side = fluid::FluidSide::<2>::zero();
    side.set(density, density, pressure);
    (side.velocity, side.deviation) = (velocity, deviation);
    side
}

type Side = fluid::Side<f64, 2>;

/// By how much the sum over the lattice differs from the integral: a Riemann sum of a smooth kernel.
const QUADRATURE: f64 = 2e-3;

#[test]
fn fluids_have_the_terms_of_their_equations() {
    let law = fluid::Forces::<2, { fluid::FULL }, false, true>(FLUID);
    let zero = Vector2::zeros();
    let gradient = Vector2::new(0.3, -0.2);
    // A linear pressure pulls by its gradient over the density.
    let pressed = sum_of(&law, |x| water(2.0, 5.0 + gradient.dot(&x), zero, zero));
    assert!((pressed.pressure + gradient / 2.0).norm() <= QUADRATURE * gradient.norm());
    // u = (y^2, 0) is dragged by 2 nu.
    let sheared = sum_of(&law, |x| water(2.0, 0.0, Vector2::new(x.y * x.y, 0.0), zero));
    let expected = Vector2::new(2.0 * FLUID.viscosity, 0.0);
    assert!((sheared.viscosity - expected).norm() <= QUADRATURE * expected.norm(), "{sheared:?}");
    // d . grad u of a linear field.
    let carried = |x: Vector2<f64>| {
        let velocity = Vector2::new(1.0 + 0.4 * x.x - 0.1 * x.y, 0.5 + 0.2 * x.y);
        water(2.0, 0.0, velocity, Vector2::new(0.6, -0.3))
    };
    let sums = sum_of(&law, carried);
    let transport = sums.carried;
    let expected = Vector2::new(0.4 * 0.6 + 0.1 * 0.3, 0.2 * -0.3);
    assert!((transport - expected).norm() <= QUADRATURE * expected.norm(), "{transport}");
    // On an even lattice nothing is crowded.
    assert!(sums.crowding.norm() + sums.volume.norm() <= 1e-14);
}

#[test]
fn rates_are_divergences_and_gradients() {
    let constants = fluid::RateConstants { softening: 0.0, diffusivity: 0.2 };
    let side = |x: Vector2<f64>| {
        let velocity = Vector2::new(0.3 * x.x + 0.1 * x.y, 0.4 * x.x - 0.1 * x.y);
        let deviation = Vector2::new(0.6 - 0.2 * x.x, -0.3);
        let mut side = water(2.0, 1.0 + 0.5 * x.x * x.x + 0.7 * x.y, velocity, deviation);
        side.density += 0.1 * x.x;
        (side, Vector2::zeros())
    };
    let law = fluid::Rates::<2, true, false, true>(constants);
    let sums = sum_of(&law, side);
    assert!((sums.divergence - 0.2).abs() <= QUADRATURE * 0.2);
    let moving = sum_of(&fluid::Rates::<2, true, true, true>(constants), side);
    assert!(moving.divergence < sums.divergence - 0.1, "the deviation shrinks");
    // d . grad p = (0.6, -0.3) . (0, 0.7), and the part of x^2 with -0.2 x is odd but for its moment.
    let still = sum_of(&law, |x| {
        let (side, force) = side(x);
        (Side { deviation: Vector2::new(0.6, -0.3), density: 2.0, ..side }, force)
    });
    assert!((still.pressure_transport + 0.3 * 0.7).abs() <= QUADRATURE);
    assert!((still.pressure_diffusion - 0.2).abs() <= 0.01, "{still:?}");
    // The pressure of depth does not diffuse: g = (0, -0.35), dp/dy = -rho 0.35 ... of both halves.
    let depth =
        sum_of(&law, |x| (water(2.0, -0.7 * x.y, zero(), zero()), Vector2::new(0.0, -0.175)));
    assert!(depth.pressure_diffusion.abs() <= 1e-14);
}

fn zero() -> Vector2<f64> {
    Vector2::zeros()
}

#[test]
fn gradients_and_moments_of_the_lattice() {
    let side = |x: Vector2<f64>| {
        water(2.0, 0.0, Vector2::new(0.3 * x.x + 0.1 * x.y, 0.4 * x.x - 0.1 * x.y), zero())
    };
    let expected = nalgebra::Matrix2::new(0.3, 0.1, 0.4, -0.1);
    let gradient = sum_of(&sums::VelocityGradient::<2>, side);
    assert!((gradient - expected).norm() <= QUADRATURE);
    let moments = sum_of(&solid::Moments::<2>, |x| (side(x), 1.0));
    assert!((moments[(0, 0)] - 1.0).abs() <= QUADRATURE && moments[(0, 1)].abs() <= 1e-14);
    let constants =
        solid::RateConstants { softening: 0.01, artificial: 0.0, diffusion: 0.0, moves: 0.0 };
    let rates = sum_of(&solid::Rates::<2, { solid::ALONE }, true>(constants), |x| {
        let tension = solid::SolidTension::<2>::zero();
        ((Side { deviation: Vector2::new(0.5, 0.0), ..side(x) }, tension), ([0.2 * x.x; 9], 1.0))
    });
    assert!((rates.gradient - expected).norm() <= QUADRATURE);
    assert!((rates.carried[0] - 0.1).abs() <= QUADRATURE, "d . grad of the stress");
    // A linear stress pulls by its divergence.
    let law = solid::Forces::<2, true, { solid::ONE }>(SOLID);
    let pulled = sum_of(&law, |x| {
        let mut tension = solid::SolidTension::<2>::zero();
        tension.tensor = <Square<2> as Record>::zero();
        tension.tensor[(0, 0)] = (1.0 + 0.3 * x.x) / 4.0;
        tension.tensor[(0, 1)] = 0.2 * x.y / 4.0;
        ((water(2.0, 0.0, zero(), zero()), tension), 1.0)
    });
    assert!((pulled.stress - Vector2::new(0.5 / 2.0, 0.0)).norm() <= QUADRATURE, "{pulled:?}");
    let density =
        sum_of(&sums::Density::<2>, side) + 2.0 * Kernel::QuinticSpline.value(2, 0.0, 1.3);
    assert!((density - 2.0).abs() <= QUADRATURE);
}

#[test]
fn walls_take_what_is_around_them() {
    let around = sum_of(&wall::Extrapolation::<2>, |x| {
        water(2.0, 3.0 + x.y, Vector2::new(x.x, 1.0), Vector2::new(0.0, 2.0))
    });
    let weight = around.weight;
    assert!((around.pressure / weight - 3.0).abs() <= 1e-14);
    assert!((around.velocity / weight - Vector2::new(0.0, 1.0)).norm() <= 1e-14);
    assert!((around.deviation / weight - Vector2::new(0.0, 2.0)).norm() <= 1e-14);
    assert!(around.arm.norm() <= 1e-14);
}

#[test]
fn derivatives_of_laws_are_exact() {
    // d(pressure force)/d(p_b) = -m_b grad W / rho_b^2 by dual numbers.
    let law = fluid::Forces::<2, { fluid::NONE }, false, false>(FLUID);
    let (one, two) = (some::<fluid::FluidSide<2>>(0.2), some::<fluid::FluidSide<2>>(0.7));
    let pair = some::<MovingPair<2>>(0.4);
    let as_dual = |[x]: [f64; 1]| Dual64::from(x);
    let mut other = fluid::FluidSide::map([&two], &as_dual);
    other.set(Dual64::from(two.mass()), Dual64::from(two.density), Dual64::new(two.pressure, 1.0));
    let mut sums = fluid::ForceSum::<2>::zero();
    let me = fluid::FluidSide::map([&one], &as_dual);
    law.add(&me, &other, &MovingPair::map([&pair], &as_dual), &mut sums);
    let expected = pair.separation * (-two.mass() * pair.slope / two.density.powi(2));
    let found = Components::<2>::map([&sums.pressure], &|[x]: [Dual64; 1]| x.eps);
    assert!((found - expected).norm() <= 1e-15);
}
