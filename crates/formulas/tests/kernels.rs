//! Properties of every registered kernel: the tests run over [`Kernel::ALL`].
#![allow(clippy::approx_constant, reason = "reference values are written as computed")]

use num_dual::Dual64;
use piola_formulas::kernels::{Kernel, KernelShape, KernelVisitor, ScaledKernel};
use proptest::prelude::*;

/// What the literature says of a kernel, with a smoothing length of 1.
struct Reference {
    name: &'static str,
    support: f64,
    /// `W(0)` in 1, 2 and 3 dimensions.
    centre: [f64; 3],
    /// `W(support / 2)` in 1, 2 and 3 dimensions.
    half_way: [f64; 3],
}

const fn reference(
    name: &'static str,
    support: f64,
    centre: [f64; 3],
    half_way: [f64; 3],
) -> Reference {
    Reference { name, support, centre, half_way }
}

/// Computed to 30 digits from the kernels' other definitions, without our polynomials and
/// normalisations: B-splines as sums of truncated powers, Wendland's functions by his integral
/// operator `I^k (1 - s)_+^(floor(d / 2) + k + 1)`, all normalised by adaptive quadrature.
#[rustfmt::skip]
const REFERENCES: [Reference; 11] = [
    reference("cubic_spline", 2.0, [0.6666666666666666, 0.4547284088339867, 0.3183098861837907], [0.16666666666666666, 0.11368210220849667, 0.07957747154594767]),
    reference("quintic_spline", 3.0, [0.55, 0.3076551619600655, 0.17507043740108488], [0.06171875, 0.03452380368585962, 0.019645688287905833]),
    reference("lucy", 1.0, [1.25, 1.5915494309189533, 2.088908628081126], [0.390625, 0.4973591971621729, 0.652783946275352]),
    reference("gaussian", 3.0, [0.5642020470513832, 0.3183491735929349, 0.17966614821808718], [0.05946645825543229, 0.03355375603660568, 0.018936672702203373]),
    reference("mollifier", 1.0, [0.8285688398691051, 0.7885737797126773, 0.8340256392375335], [0.593695516732014, 0.5650378038616511, 0.5976054843350121]),
    reference("modified_mollifier", 1.0, [1.769381279061376, 3.2175546038600307, 6.004604869467829], [0.1269248642949366, 0.23080818492276858, 0.43073455519220677]),
    reference("linear", 2.0, [0.5, 0.238732414637843, 0.1193662073189215], [0.25, 0.1193662073189215, 0.05968310365946075]),
    reference("quadratic", 2.0, [0.75, 0.477464829275686, 0.29841551829730373], [0.1875, 0.1193662073189215, 0.07460387957432595]),
    reference("wendland_c2", 2.0, [0.625, 0.5570423008216336, 0.4177817256162253], [0.1953125, 0.10444543140405631, 0.07833407355304224]),
    reference("wendland_c4", 2.0, [0.75, 0.716197243913529, 0.615482006488189], [0.12890625, 0.07740152505836316, 0.06651693559703084]),
    reference("wendland_c6", 2.0, [0.859375, 0.886720397226274, 0.8486191301579575], [0.0797271728515625, 0.052822211162893276, 0.05055250677698771]),
];

/// Kernels whose slope jumps: at the centre, at the edge, or both.
const CUSPS: [&str; 2] = ["linear", "quadratic"];
const KINKED_EDGES: [&str; 1] = ["linear"];
/// Kernels that end in a jump of the value, and what part of `W(0)` it is.
const JUMPS: [(&str, f64); 1] = [("gaussian", 0.00012340980408667956)];

fn jump(kernel: Kernel) -> f64 {
    JUMPS.iter().find(|(name, _)| *name == kernel.name()).map_or(0.0, |(_, jump)| *jump)
}

/// All kernels in all dimensions.
fn kernels() -> impl Iterator<Item = (Kernel, usize)> {
    Kernel::ALL.iter().flat_map(|&kernel| (1..=3).map(move |dimension| (kernel, dimension)))
}

/// A kernel, its dimension, and a position in units of the support, from centre to beyond it.
fn cases() -> impl Strategy<Value = (Kernel, usize, f64)> {
    (prop::sample::select(Kernel::ALL), 1..=3usize, 1e-6..1.1)
}

/// Surface of the unit sphere.
fn unit_surface(dimension: usize) -> f64 {
    use std::f64::consts::PI;
    [2.0, 2.0 * PI, 4.0 * PI][dimension - 1]
}

/// Integral from 0 to `end` by Gauss's five points in each of 200 panels per unit.
///
/// Breakpoints of the kernels are panel ends; the rule's own error is below 1e-15 for all.
fn integral(end: f64, integrand: impl Fn(f64) -> f64) -> f64 {
    let (a, b) = (
        (5.0 - (40.0_f64 / 7.0).sqrt()).sqrt() / 3.0,
        (5.0 + (40.0_f64 / 7.0).sqrt()).sqrt() / 3.0,
    );
    let (u, v) =
        ((322.0 + 13.0 * 70.0_f64.sqrt()) / 900.0, (322.0 - 13.0 * 70.0_f64.sqrt()) / 900.0);
    let rule = [(0.0, 128.0 / 225.0), (a, u), (-a, u), (b, v), (-b, v)];
    let panels = (200.0 * end) as usize;
    let half = 0.5 * end / panels as f64;
    (0..panels)
        .flat_map(|panel| {
            rule.map(|(x, w)| half * w * integrand(half * (2.0 * panel as f64 + 1.0 + x)))
        })
        .sum()
}

#[test]
fn every_registered_kernel_has_a_reference() {
    let registered: Vec<_> = Kernel::ALL.iter().map(|kernel| kernel.name()).collect();
    let tested: Vec<_> = REFERENCES.iter().map(|reference| reference.name).collect();
    assert_eq!(registered, tested, "a kernel needs a row of REFERENCES, and a row a kernel");
}

#[test]
fn names_and_supports_are_those_of_the_literature() {
    for reference in &REFERENCES {
        let kernel = Kernel::from_name(reference.name).unwrap();
        assert_eq!(kernel.name(), reference.name);
        assert_eq!(kernel.support_over_h(), reference.support);
        assert_eq!(kernel.support_radius(0.25), 0.25 * reference.support);
    }
    for unknown in ["", "cubic", "Cubic_Spline", " cubic_spline"] {
        assert_eq!(Kernel::from_name(unknown), None);
    }
}

#[test]
fn values_are_those_of_the_literature() {
    for reference in &REFERENCES {
        let kernel = Kernel::from_name(reference.name).unwrap();
        for dimension in 1..=3 {
            for (r, expected) in [
                (0.0, reference.centre[dimension - 1]),
                (0.5 * reference.support, reference.half_way[dimension - 1]),
            ] {
                let got: f64 = kernel.value(dimension, r, 1.0);
                let error = (got / expected - 1.0).abs();
                assert!(error < 2e-15, "{kernel:?} in {dimension}D at {r}: {got}, {expected}");
            }
        }
    }
}

#[test]
fn integral_is_one() {
    for (kernel, dimension) in kernels() {
        let total = unit_surface(dimension)
            * integral(kernel.support_over_h(), |q| {
                kernel.value(dimension, q, 1.0) * q.powi(dimension as i32 - 1)
            });
        assert!((total - 1.0).abs() < 2e-14, "{kernel:?} in {dimension}D: {total}");
    }
}

/// By parts, `int x . grad W = -d int W`, plus the edge's share where `W` ends in a jump.
#[test]
fn first_moment_of_the_gradient_is_minus_the_dimension() {
    for (kernel, dimension) in kernels() {
        let support = kernel.support_over_h();
        let moment = unit_surface(dimension)
            * integral(support, |q| {
                kernel.derivative_over_r(dimension, q, 1.0) * q.powi(dimension as i32 + 1)
            });
        let edge = unit_surface(dimension)
            * support.powi(dimension as i32)
            * jump(kernel)
            * kernel.value(dimension, 0.0, 1.0);
        let expected = edge - dimension as f64;
        assert!((moment - expected).abs() < 1e-13, "{kernel:?} in {dimension}D: {moment}");
    }
}

/// A sum over a fine lattice knows nothing of radial integrals.
#[test]
fn sum_over_a_fine_lattice_is_one() {
    for (kernel, dimension) in kernels() {
        let (per_radius, support) = (20_i32, kernel.support_over_h());
        let spacing = support / f64::from(per_radius);
        let coordinate = |k: i32| (f64::from(k) + 0.5) * spacing;
        let range = |used: bool| if used { -per_radius..per_radius } else { 0..1 };
        let mut sum = 0.0;
        for i in range(true) {
            for j in range(dimension > 1) {
                for k in range(dimension > 2) {
                    let mut square = coordinate(i).powi(2);
                    if dimension > 1 {
                        square += coordinate(j).powi(2);
                    }
                    if dimension > 2 {
                        square += coordinate(k).powi(2);
                    }
                    sum += kernel.value(dimension, square.sqrt(), 1.0);
                }
            }
        }
        sum *= spacing.powi(dimension as i32);
        // The midpoint rule's error at a kink or a cusp is of the order (dx / support)^2 = 2.5e-3.
        assert!((sum - 1.0).abs() < 2.5e-3, "{kernel:?} in {dimension}D: {sum}");
    }
}

#[test]
fn zero_at_and_beyond_the_support() {
    for (kernel, dimension) in kernels() {
        for h in [1.0, 0.5, 8.0] {
            let edge = kernel.support_radius(h);
            for r in [edge, edge.next_up(), 1.5 * edge, 1e300] {
                assert_eq!(kernel.value(dimension, r, h), 0.0, "{kernel:?} at {r}");
                assert_eq!(kernel.derivative_over_r(dimension, r, h), 0.0, "{kernel:?} at {r}");
                assert_eq!(kernel.derivative(dimension, r, h), 0.0, "{kernel:?} at {r}");
                assert_eq!(kernel.second_derivative(dimension, r, h), 0.0, "{kernel:?} at {r}");
            }
        }
    }
}

/// At the ends of all pieces; the derivatives' tests leave the ends out.
#[test]
fn value_and_slope_are_continuous() {
    for (kernel, dimension) in kernels() {
        let support = kernel.support_over_h();
        let centre: f64 = kernel.value(dimension, 0.0, 1.0);
        let mut end = 1.0;
        while end <= support {
            let step = 1e-9;
            let is_edge = end == support;
            let drop = kernel.value(dimension, end - step, 1.0) - kernel.value(dimension, end, 1.0);
            let expected = if is_edge { jump(kernel) * centre } else { 0.0 };
            // Slopes are at most a few times the centre's value, second derivatives a few dozen.
            assert!((drop - expected).abs() < 1e-8 * centre, "{kernel:?} at {end}: {drop}");
            if !(is_edge && (jump(kernel) > 0.0 || KINKED_EDGES.contains(&kernel.name()))) {
                let turn = kernel.derivative(dimension, end, 1.0)
                    - kernel.derivative(dimension, end - step, 1.0);
                assert!(turn.abs() < 1e-7 * centre, "{kernel:?} at {end}: slope turns by {turn}");
            }
            end += 1.0;
        }
    }
}

#[test]
fn finite_at_the_centre_and_near_it() {
    for (kernel, dimension) in kernels() {
        for h in [1e-6, 1.0, 1e6] {
            let w = |r| kernel.value::<f64>(dimension, r, h);
            let over_r = |r| kernel.derivative_over_r::<f64>(dimension, r, h);
            let curvature = kernel.second_derivative::<f64>(dimension, 0.0, h);
            assert!(curvature.is_finite());
            for r in [0.0, f64::MIN_POSITIVE, 1e-200 * h, 1e-99 * h, 1e-12 * h] {
                assert!(w(r).is_finite() && over_r(r).is_finite(), "{kernel:?} at {r}, h {h}");
                assert!((w(r) / w(0.0) - 1.0).abs() < 1e-11);
                assert!((r * over_r(r)).is_finite());
            }
            if CUSPS.contains(&kernel.name()) {
                assert_eq!(over_r(0.0), 0.0);
                assert!(kernel.derivative::<f64>(dimension, 0.0, h) < 0.0);
            } else {
                // L'Hopital: W'(r) / r tends to W''(0).
                assert!((over_r(0.0) / curvature - 1.0).abs() < 1e-14, "{kernel:?}");
                assert_eq!(kernel.derivative::<f64>(dimension, 0.0, h), 0.0);
            }
        }
    }
}

#[test]
fn other_dimensions_give_nan() {
    for &kernel in Kernel::ALL {
        for dimension in [0, 4, usize::MAX] {
            assert!(kernel.value::<f64>(dimension, 0.5, 1.0).is_nan());
            assert!(kernel.visit(Normalisation(dimension)).is_nan());
        }
    }
}

struct Normalisation(usize);

impl KernelVisitor for Normalisation {
    type Output = f64;
    fn visit<K: KernelShape>(self, _shape: K) -> f64 {
        K::normalisation(self.0)
    }
}

/// A loop's use of a kernel: one choice of the shape, then no more.
struct SlopeAt<const D: usize> {
    r: f64,
    h: f64,
}

impl<const D: usize> KernelVisitor for SlopeAt<D> {
    type Output = f64;
    fn visit<K: KernelShape>(self, _shape: K) -> f64 {
        ScaledKernel::<K, D>::new(self.h).derivative_over_r(self.r)
    }
}

proptest! {
    #[test]
    fn visitors_get_the_named_kernel((kernel, _, s) in cases(), h in 0.1..10.0) {
        let r = s * kernel.support_radius(h);
        prop_assert_eq!(kernel.visit(SlopeAt::<1> { r, h }), kernel.derivative_over_r(1, r, h));
        prop_assert_eq!(kernel.visit(SlopeAt::<2> { r, h }), kernel.derivative_over_r(2, r, h));
        prop_assert_eq!(kernel.visit(SlopeAt::<3> { r, h }), kernel.derivative_over_r(3, r, h));
    }

    #[test]
    fn derivatives_are_those_of_dual_numbers((kernel, dimension, s) in cases(), h in 0.1..10.0) {
        let r = s * kernel.support_radius(h);
        let centre: f64 = kernel.value(dimension, 0.0, h);
        let dual = Dual64::from_re(r).derivative();

        let value = kernel.value(dimension, dual, h);
        prop_assert_eq!(value.re, kernel.value(dimension, r, h));
        let slope = kernel.derivative(dimension, r, h);
        prop_assert!((value.eps - slope).abs() * h < 1e-13 * centre, "{:?} {}", value, slope);

        let turn = kernel.derivative(dimension, dual, h);
        let curvature: f64 = kernel.second_derivative(dimension, r, h);
        // Second derivatives reach 30 times the centre's value over h^2.
        prop_assert!((turn.eps - curvature).abs() * h * h < 1e-12 * centre, "{:?} {}", turn, curvature);

        let over_r = kernel.derivative_over_r(dimension, r, h) * r;
        prop_assert!((over_r - slope).abs() * h < 1e-14 * centre, "{} {}", over_r, slope);
    }

    #[test]
    fn positive_and_falling_inside_the_support((kernel, dimension, s) in cases(), step in 1e-6..0.1) {
        let support = kernel.support_over_h();
        let (near, far) = (s * support, (s + step) * support);
        let at_near: f64 = kernel.value(dimension, near, 1.0);
        let at_far: f64 = kernel.value(dimension, far, 1.0);
        prop_assert!(at_far >= 0.0 && at_near >= at_far);
        prop_assert!(kernel.derivative(dimension, near, 1.0) <= 0.0);
        // Closer to the edge the mollifiers are below the smallest number.
        if s < 0.99 {
            prop_assert!(at_near > at_far && kernel.derivative(dimension, near, 1.0) < 0.0);
        }
    }

    #[test]
    fn smoothing_length_only_scales((kernel, dimension, s) in cases(), h in 1e-3..1e3_f64) {
        let q = s * kernel.support_over_h();
        let scale = h.powi(-(dimension as i32));
        let close = |scaled: f64, unit: f64| {
            let centre: f64 = kernel.value(dimension, 0.0, 1.0);
            (scaled - unit).abs() <= 1e-12 * (unit.abs() + centre)
        };
        let r = q * h;
        prop_assert!(close(kernel.value(dimension, r, h) / scale, kernel.value(dimension, q, 1.0)));
        prop_assert!(close(
            kernel.derivative(dimension, r, h) * h / scale,
            kernel.derivative(dimension, q, 1.0)
        ));
        prop_assert!(close(
            kernel.second_derivative(dimension, r, h) * h * h / scale,
            kernel.second_derivative(dimension, q, 1.0)
        ));
    }
}

#[test]
fn many_distances_are_the_single_ones() {
    let (h, squares): (f64, Vec<f64>) = (0.3, (1..200).map(|k| f64::from(k) * 5e-3).collect());
    let (mut values, mut slopes) = (vec![0.0; squares.len()], vec![0.0; squares.len()]);
    for &kernel in Kernel::ALL {
        let many = kernel.many::<2>(h);
        many.values(&squares, &mut values);
        many.slopes(&squares, &mut slopes);
        for (k, square) in squares.iter().enumerate() {
            let r = square.sqrt();
            assert_eq!(values[k], kernel.value(2, r, h), "{}", kernel.name());
            assert_eq!(slopes[k], kernel.derivative_over_r(2, r, h), "{}", kernel.name());
        }
    }
}
