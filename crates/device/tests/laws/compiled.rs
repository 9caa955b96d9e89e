use std::fmt::Write;
use std::process::{Command, Stdio};

use piola_device::{Language, Law, Precision, laws};

use super::{assert_bits, random};

/// Output of a C program, or `None` where there is no C compiler.
pub fn run(program: &str, input: &str) -> Option<String> {
    let folder = tempfile::tempdir().unwrap();
    let (source, binary) = (folder.path().join("program.c"), folder.path().join("program"));
    std::fs::write(&source, program).unwrap();
    let compiler = std::env::var("CC").unwrap_or_else(|_| "cc".into());
    let compiled = Command::new(compiler)
        .args(["-std=gnu99", "-O2", "-ffp-contract=off", "-Wno-unused-function", "-o"])
        .args([&binary, &source])
        .arg("-lm")
        .output();
    let Ok(compiled) = compiled else {
        eprintln!("NOT RUN: there is no C compiler");
        return None;
    };
    assert!(compiled.status.success(), "{}", String::from_utf8_lossy(&compiled.stderr));
    let data = folder.path().join("data");
    std::fs::write(&data, input).unwrap();
    let output = Command::new(&binary)
        .stdin(Stdio::from(std::fs::File::open(&data).unwrap()))
        .output()
        .unwrap();
    assert!(output.status.success(), "the compiled program failed: {:?}", output.status);
    Some(String::from_utf8(output.stdout).unwrap())
}

/// A main function that reads the number of a law and bits of numbers, calls the law, and prints bits of
/// results, line by line.
pub fn driver(laws: &[Law]) -> String {
    let list = |count: usize, of: &dyn Fn(usize) -> String| {
        (0..count).map(of).collect::<Vec<_>>().join(", ")
    };
    let mut cases = String::new();
    for (number, law) in laws.iter().enumerate() {
        let (takes, gives) = (law.inputs.len(), law.outputs.len());
        writeln!(
            cases,
            "    if (law == {number}) {{ read_all(x, {takes}); {}({}, {}); write_all(y, {gives}); }}",
            law.name,
            list(takes, &|i| format!("x[{i}]")),
            list(gives, &|i| format!("&y[{i}]")),
        )
        .unwrap();
    }
    format!(
        "#include <stdio.h>\nstatic void read_all(double *x, int n) {{\n  unsigned long long bits;\n  \
         for (int i = 0; i < n; ++i) if (scanf(\"%llx\", &bits) == 1) x[i] = p_number(bits);\n}}\n\
         static void write_all(double *y, int n) {{\n  \
         for (int i = 0; i < n; ++i) printf(\"%llx \", (unsigned long long)p_bits(y[i]));\n  \
         printf(\"\\n\");\n}}\n\
         int main(void) {{\n  double x[32], y[32];\n  int law;\n  \
         while (scanf(\"%d\", &law) == 1) {{\n{cases}  }}\n  return 0;\n}}\n",
    )
}

/// Numbers of a size that a law takes.
pub fn sample(law: &Law, random: &mut impl FnMut() -> f64) -> Vec<f64> {
    let of = |name: &str, x: f64| match name {
        "r" => 3.2 * x,
        "ratio" => 0.3 + 2.0 * x,
        "density" | "a_density" | "b_density" => 9000.0 + 2000.0 * x,
        "von_mises" => 2e9 * x,
        "temperature" => 250.0 + 1200.0 * x,
        "step" => 1e-8,
        "volume" | "inverse_mass" | "plastic_strain" => x,
        _ => 0.3 * (2.0 * x - 1.0),
    };
    law.inputs.iter().map(|name| of(name, random())).collect()
}

#[test]
fn the_compiled_text_has_the_bits_of_the_processor() {
    let (laws, mut random) = (laws::all(), random(6));
    let mut text = Language::C.prologue(Precision::Double);
    let (mut lines, mut all) = (String::new(), Vec::new());
    for (number, law) in laws.iter().enumerate() {
        text += &law.text(Language::C, Precision::Double);
        for _ in 0..300 {
            let numbers = sample(law, &mut random);
            write!(lines, "{number}").unwrap();
            numbers.iter().for_each(|x| write!(lines, " {:x}", x.to_bits()).unwrap());
            lines.push('\n');
            all.push((law, numbers));
        }
    }
    let Some(output) = run(&(text + &driver(&laws)), &lines) else { return };
    assert_eq!(output.lines().count(), all.len());
    for (line, (law, numbers)) in output.lines().zip(&all) {
        let got: Vec<f64> = line
            .split_whitespace()
            .map(|word| f64::from_bits(u64::from_str_radix(word, 16).unwrap()))
            .collect();
        assert_bits(&law.name, &got, &law.run(numbers), numbers);
    }
}
