//! Gradients that are exact for linear fields, and the forces that are conjugate to them.

use nalgebra::{Matrix1, Matrix2, Matrix3};

use super::*;

#[test]
fn corrections_are_inverses_and_go_over_to_the_identity() {
    let upper = |a: f64, b: f64, c: f64| Matrix2::new(a, b, f64::NAN, c);
    let moment = Matrix2::new(1.1, -0.2, -0.2, 0.8);
    let unit = moment * corrected::correction::<f64, 2>(&upper(1.1, -0.2, 0.8));
    assert!((unit - Matrix2::identity()).norm() < 1e-15, "{unit}");
    let moment = Matrix3::new(1.1, -0.2, 0.1, -0.2, 0.8, 0.3, 0.1, 0.3, 1.2);
    let unit = moment * corrected::correction::<f64, 3>(&moment);
    assert!((unit - Matrix3::identity()).norm() < 1e-14, "{unit}");
    // Of a particle alone, and of a singular moment; from one side of 1/2 to the other nothing jumps.
    for (moment, expected) in [(0.0, 1.0), (0.25, 1.5), (0.5, 2.0), (2.0, 0.5)] {
        let of_number = corrected::correction::<f64, 1>(&Matrix1::new(moment));
        assert_eq!(of_number, Matrix1::new(expected), "{moment}");
    }
    let alone = corrected::correction::<f64, 3>(&Matrix3::zeros());
    assert_eq!(alone, Matrix3::identity());
    let of_half = corrected::correction::<f64, 3>(&(Matrix3::identity() * 0.5));
    assert_eq!(of_half, Matrix3::identity() * 1.25);
    let alone = corrected::correction::<f64, 2>(&upper(0.0, 0.0, 0.0));
    assert_eq!(alone, Matrix2::identity());
    let of_half = corrected::correction::<f64, 2>(&upper(0.5, 0.0, 0.5));
    assert_eq!(of_half, Matrix2::identity() * 1.5);
    let row = corrected::correction::<f64, 2>(&upper(1.0, 0.0, 0.0));
    assert_eq!(row, Matrix2::new(1.0, 0.0, 0.0, 3.0));
    let [below, above] =
        [0.5 - 1e-9, 0.5 + 1e-9].map(|a| corrected::correction::<f64, 2>(&upper(1.0, 0.0, a)));
    assert!((below - above).norm() < 1e-7, "{below} {above}");
}

/// What a particle of fluid does to another one, with the mass, is what the other one does to it, turned round; that of
/// walls, too.
#[test]
fn corrected_forces_come_in_pairs() {
    type Corrected = (fluid::FluidSide<2>, corrected::GradientSide<2>);
    let (one, two) = (some::<Corrected>(0.2), some::<Corrected>(0.7));
    let pair = some::<MovingPair<2>>(0.4);
    let back = turned(&pair);
    let law =
        corrected::CorrectedForces(fluid::Forces::<2, { fluid::FULL }, false, false>(FLUID), 0.3);
    let [there, here] = [sums_of(&law, [&one, &two], &pair), sums_of(&law, [&two, &one], &back)];
    let [of_one, of_two] = [one.0.mass(), two.0.mass()];
    for (a, b) in [
        (there.pressure, here.pressure),
        (there.viscosity, here.viscosity),
        (there.artificial_viscosity, here.artificial_viscosity),
    ] {
        assert!((a * of_one + b * of_two).norm() < 1e-14 * a.norm() * of_one, "{a} {b}");
    }
    let shear = Vector2::new(0.3, -0.8);
    let [wet, wall] = [((one.0, shear), one.1), ((two.0, shear), two.1)];
    let there = sums_of(&corrected::CorrectedWallForces(law), [&wet, &wall], &pair).walls;
    let by_wall = corrected::CorrectedWall(fluid::Wall::<2>::of(&FLUID));
    let here = sums_of(&by_wall, [&wall, &wet], &back);
    assert!((there * of_one + here * of_two).norm() < 1e-14 * there.norm() * of_one);
}
