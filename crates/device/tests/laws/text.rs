use std::path::Path;

use piola_device::{Language, Precision, cuda, laws, passes};
use piola_formulas::kernels::Kernel;

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
