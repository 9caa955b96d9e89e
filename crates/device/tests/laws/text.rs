use std::path::Path;

use piola_device::{
    Among, Gather, Language, Order, Pass, Precision, Space, cuda, laws, own, passes,
};
use piola_formulas::kernels::Kernel;
use piola_formulas::pairs::One;
use piola_formulas::pairs::fluid::{FULL, ForceConstants, ForceSum, Forces, Viscous};
use piola_formulas::pairs::sums::Density;

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
    let solid = passes::solid::Solid::rubber();
    compare("solid.cu", &solid.text(Language::Cuda, Precision::Double));
    let fluid = passes::fluid::Fluid::water(0.1);
    compare("fluid.cl", &fluid.text(Language::OpenCl, Precision::Single));
}

/// Sums of density, one after the other, and of forces in lanes, in 2D with one periodic axis.
fn gathers(language: Language) -> [Pass; 2] {
    let periods = [Some(2.0), None];
    let space = Space { kernel: Kernel::WendlandC2, smoothing_length: 0.1, periods };
    let side = [own("side", 8)];
    let density = Gather::<One, _>::new(language, "density", &space, Among::Active, Order::Single)
        .term(&Density::<2>, &side, Among::All)
        .close(&[], &[], &[own("summed", 1)], |sum, _| vec![*sum]);
    let law = Forces::<2, FULL, false, true>(ForceConstants {
        softening: 1e-4,
        viscosity: 1e-2,
        viscous: Viscous::Laplacian,
        artificial: 0.0,
        stress: 1.0,
        dilatation: 1.0,
        transport: 0.0,
        crowding: 0.02,
    });
    let forces =
        Gather::<ForceSum<2>, _>::new(language, "forces", &space, Among::All, Order::Lanes)
            .only("near")
            .term(&law, &side, Among::Active)
            .close(&["scale"], &[], &[own("force", 2)], |sums, x| {
                (0..2).map(|axis| (sums.pressure[axis] + sums.viscosity[axis]) * x[0]).collect()
            });
    [density, forces]
}

#[test]
fn the_text_of_gathers_is_the_stored_one() {
    let [density, _] = gathers(Language::OpenCl);
    compare("density.cl", &density.text);
    let [_, forces] = gathers(Language::Cuda);
    compare("forces.cu", &forces.text);
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
            gathers(Language::Cuda).iter().for_each(|pass| text += &pass.text);
        }
        for text in [
            text,
            passes::solid::Solid::rubber().text(Language::Cuda, precision),
            passes::fluid::Fluid::water(0.1).text(Language::Cuda, precision),
        ] {
            let module =
                cuda::compile(&text, "compute_80").unwrap_or_else(|e| panic!("{e}\n{text}"));
            // The exponentials of the machine, which single precision uses, are made of fused operations.
            let is_fused = precision == Precision::Double && module.text().contains("fma.");
            assert!(!is_fused, "an operation is fused");
        }
    }
}
