use std::path::Path;

use piola_device::{
    Among, Dialect, Frozen, Gather, Language, Layout, Order, Pass, Precision, Rows, Space, Traced,
    cuda, difference, laws, own,
};
use piola_formulas::kernels::Kernel;
use piola_formulas::pairs::fluid::{FULL, ForceConstants, ForceSum, Forces, Viscous};
use piola_formulas::pairs::sums::Density;
use piola_formulas::pairs::total_lagrangian::Gradients;
use piola_formulas::pairs::{Components, Each, One, Square};

/// Compares with a stored text; `PIOLA_RENEW=1` stores it.
fn compare(name: &str, text: &str) {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/text").join(name);
    if std::env::var_os("PIOLA_RENEW").is_some() {
        std::fs::write(&path, text).unwrap();
    }
    let stored = std::fs::read_to_string(&path).unwrap();
    assert!(
        stored == text,
        "{name} has changed: look at it, then renew it with PIOLA_RENEW=1:\n{text}"
    );
}

#[test]
fn the_text_of_laws_is_the_stored_one() {
    let kernel = laws::kernel(Kernel::QuinticSpline, 3, 1.0);
    compare("quintic_spline.c", &kernel.text(Language::C, Precision::Double));
    let [_, (name, johnson_cook)] = laws::strengths();
    let law = laws::return_to_surface(name, &johnson_cook, laws::SHEAR_MODULUS);
    compare("johnson_cook.cl", &law.text(Language::OpenCl, Precision::Single));
}

/// Sides in planes, pairs in single precision.
const SINGLE: Layout =
    Layout { narrow: &["side", "numbers", "spot"], planes: &["place", "side", "spot"] };

/// Sums of density, one after the other, and of forces in lanes, in 2D with one periodic axis; sums over rows that do not
/// change in both orders.
fn gathers(dialect: Dialect) -> [Pass; 4] {
    let periods = [Some(2.0), None];
    let space = Space { kernel: Kernel::WendlandC2, smoothing_length: 0.1, periods, reach: 0.23 };
    let side = [own("side", 8)];
    let density = Gather::<One, _>::new(dialect, "density", &space, Among::Active, Order::Single)
        .term(&Density::<2>, &side, Among::All)
        .close(&[], &[], &[own("summed", 1)], |sum, _| vec![*sum]);
    let law = Forces::<2, FULL, false, true>(ForceConstants {
        softening: 1e-4,
        viscosity: 1e-2,
        viscous: Viscous::Laplacian,
        artificial: 0.0,
        dilatation: 0.0,
        crowding: 0.02,
    });
    let forces = Gather::<ForceSum<2>, _>::new(dialect, "forces", &space, Among::All, Order::Lanes)
        .only("near")
        .term(&law, &side, Among::Active)
        .close(&["scale"], &[], &[own("force", 2)], |sums, x| {
            (0..2).map(|axis| (sums.pressure[axis] + sums.viscosity[axis]) * x[0]).collect()
        });
    let rows = Rows {
        first: "row",
        count: "row_count",
        neighbors: "neighbors",
        numbers: "numbers",
        kept: vec![Some(0), Some(1)],
    };
    let rows = Frozen::<Each<Components<2>, 1>>::new(rows);
    let gradients = |name, order| {
        Gather::<Each<Square<2>, 1>, _>::new(dialect, name, &rows, Among::All, order)
            .term(&Gradients::<2, 1>, &[difference("displacement", 2)], Among::All)
            .close(&[], &[], &[own("gradient", 4)], |sums, _| {
                sums[0].transpose().as_slice().to_vec()
            })
    };
    let [in_lanes, in_order] = [("gradients", Order::Lanes), ("in_order", Order::Single)]
        .map(|(name, of)| gradients(name, of));
    [density, forces, in_lanes, in_order]
}

#[test]
fn the_text_of_gathers_is_the_stored_one() {
    let [density, ..] = gathers(Language::OpenCl.into());
    compare("density.cl", &density.text);
    let [density, forces, gradients, in_order] = gathers(Language::Cuda.into());
    compare("density.cu", &density.text);
    compare("forces.cu", &forces.text);
    compare("gradients.cu", &gradients.text);
    compare("in_order.cu", &in_order.text);
    let single = Dialect { language: Language::Cuda, layout: SINGLE };
    let [_, forces, gradients, _] = gathers(single);
    compare("forces_single.cu", &forces.text);
    compare("gradients_single.cu", &gradients.text);
}

#[test]
fn single_precision_has_no_double_literal_and_no_double_function() {
    for law in laws::all() {
        let text = law.text(Language::Cuda, Precision::Single);
        for word in text.split(|c: char| !c.is_ascii_alphanumeric() && !".-+_".contains(c)) {
            let is_number =
                word.starts_with(|c: char| c.is_ascii_digit()) && word.contains(['.', 'e']);
            assert!(!is_number || word.ends_with('f'), "{}: {word}", law.name);
        }
        for function in ["exp(", "log(", "sqrt(", "fabs(", "pow(", "cos(", "p_exp", "double"] {
            assert!(!text.contains(&format!(" {function}")), "{}: {function}", law.name);
        }
    }
}

#[test]
fn all_cuda_text_compiles() {
    if !cuda::has_compiler() {
        assert!(std::env::var_os("PIOLA_NVRTC_REQUIRED").is_none(), "there is no NVRTC");
        eprintln!("NOT RUN: there is no NVRTC on this machine");
        return;
    }
    for precision in [Precision::Double, Precision::Single] {
        let mut text = Language::Cuda.prologue(precision);
        for law in laws::all() {
            text += &law.text(Language::Cuda, precision);
        }
        if precision == Precision::Double {
            let single = Dialect { language: Language::Cuda, layout: SINGLE };
            let mixed = text.clone() + &gathers(single).map(|pass| pass.text).concat();
            cuda::compile(&mixed, Precision::Single, "compute_80")
                .unwrap_or_else(|e| panic!("{e}\n{mixed}"));
            gathers(Language::Cuda.into()).iter().for_each(|pass| text += &pass.text);
        }
        let module =
            cuda::compile(&text, precision, "compute_80").unwrap_or_else(|e| panic!("{e}\n{text}"));
        // The exponentials of the machine, which single precision uses, are made of fused operations.
        let is_fused = precision == Precision::Double && module.text().contains("fma.");
        assert!(!is_fused, "an operation is fused");
    }
}

/// Counts of places differ by the shorter way round a periodic axis, whatever its length, and by no more than half a unit each.
#[test]
fn counts_tell_ways_between_places() {
    let reach = 0.3;
    for period in [None, Some(0.7), Some(1.5), Some(40.0), Some(123.4)] {
        let periods = [period, None];
        let space = Space { kernel: Kernel::WendlandC2, smoothing_length: 0.1, periods, reach };
        let unit = space.unit(0);
        let finest = period.map_or(4.0 * reach, |period| period.min(8.0 * reach));
        assert!(unit * 2.0_f64.powi(32) <= finest, "{period:?}: {unit:e} m");
        let count = |x: f64| (x / unit).round_ties_even() as i64 as u32;
        for (here, way) in [(0.01, 0.29), (-3e3, -0.3), (0.5, -0.2), (7e5, 0.123), (0.0, 0.3)] {
            // Inside the bounds of a periodic axis.
            let inside = |x: f64| period.map_or(x, |period| x.rem_euclid(period));
            let (from, to) = (inside(here), inside(here + way));
            let apart = f64::from(count(to).wrapping_sub(count(from)) as i32) * unit;
            let rounding = f64::EPSILON * here.abs().max(1.0);
            assert!(
                (apart - way).abs() <= unit + 4.0 * rounding,
                "{period:?}: {apart} for {way} m"
            );
        }
    }
}

#[test]
#[should_panic(expected = "numbers are traced where a law is recorded")]
fn a_number_that_is_traced_where_no_law_is_recorded_panics() {
    let _ = Traced::from(1.0);
}
