//! Steps of the passes, compiled as C with their loops, against the same loops in Rust.

use std::fmt::Write;

use piola_device::passes::fluid::{Fluid, SIDE};
use piola_device::passes::solid::{Body, Solid};
use piola_device::passes::{Rows, SLICE};
use piola_device::{Argument, Column, Device, Language, Precision};

use super::compiled::run;
use super::devices::device;
use super::{assert_bits, random};

const SIDE_LENGTH: usize = 5;
const SPACING: f64 = 0.01;

/// Particles near the points of a lattice.
fn positions() -> Vec<[f64; 3]> {
    let mut random = random(8);
    let n = SIDE_LENGTH;
    (0..n * n * n)
        .map(|k| [k % n, k / n % n, k / n / n].map(|i| (i as f64 + 0.2 * random()) * SPACING))
        .collect()
}

/// All pairs closer than a radius.
fn rows(positions: &[[f64; 3]], radius: f64) -> Rows {
    let mut rows = Rows { offsets: vec![0], neighbors: Vec::new() };
    for (a, x) in positions.iter().enumerate() {
        for (b, y) in positions.iter().enumerate() {
            let square: f64 = (0..3).map(|axis| (x[axis] - y[axis]).powi(2)).sum();
            if a != b && square < radius * radius {
                rows.neighbors.push(b as u32);
            }
        }
        rows.offsets.push(rows.neighbors.len() as u32);
    }
    rows
}

/// An array of C, by bits where it holds numbers.
fn array(text: &mut String, name: &str, numbers: &[f64]) {
    let bits: Vec<String> = numbers.iter().map(|x| format!("{:#x}", x.to_bits())).collect();
    writeln!(text, "static unsigned long long {name}[] = {{{}}};", bits.join(",")).unwrap();
}

fn indices(text: &mut String, name: &str, numbers: &[u32]) {
    let all: Vec<String> = numbers.iter().map(u32::to_string).collect();
    writeln!(text, "static int {name}[] = {{{}}};", all.join(",")).unwrap();
}

fn parse(output: &str) -> Vec<f64> {
    output
        .split_whitespace()
        .map(|word| f64::from_bits(u64::from_str_radix(word, 16).unwrap()))
        .collect()
}

#[test]
fn steps_of_a_fluid_have_the_bits_of_the_processor() {
    let (positions, fluid) = (positions(), Fluid::water(SPACING));
    let rows = rows(&positions, 2.7 * SPACING);
    let mut sides: Vec<[f64; 8]> = positions
        .iter()
        .map(|[x, y, z]| {
            let wave = (70.0 * x + 30.0 * y).sin();
            [*x, *y, *z, wave, (90.0 * z).cos(), -wave, 1000.0 + wave, 400.0 * wave]
        })
        .collect();
    let mut text = fluid.text(Language::C, Precision::Double);
    indices(&mut text, "first", &rows.offsets);
    indices(&mut text, "row", &rows.neighbors);
    array(&mut text, "side", sides.as_flattened());
    writeln!(
        text,
        "#include <stdio.h>\nint main(void) {{ static Sums sums[{n}]; Side *all = (Side *)side;\n\
         for (int step = 0; step < 20; ++step) {{ fluid_sums({n}, first, row, all, sums); \
         fluid_step({n}, sums, all); }}\n\
         for (int k = 0; k < {}; ++k) printf(\"%llx \", side[k]); return 0; }}",
        SIDE.len() * sides.len(),
        n = sides.len()
    )
    .unwrap();
    let on_device = device().map(|device| fluid_steps(&device, &fluid, &rows, &sides));
    let compiled = run(&text, "").map(|output| parse(&output));
    let mut sums = vec![[0.0; 7]; sides.len()];
    for _ in 0..20 {
        fluid.fill(&sides, &rows, 0, &mut sums);
        for (side, sums) in sides.iter_mut().zip(&sums) {
            *side = fluid.advance(side, sums);
        }
    }
    for got in [on_device, compiled].into_iter().flatten() {
        assert_bits("fluid", &got, sides.as_flattened(), &[]);
    }
}

/// What particles show after 20 steps on a device.
fn fluid_steps(device: &Device, fluid: &Fluid, rows: &Rows, sides: &[[f64; 8]]) -> Vec<f64> {
    let program = device.compile(&fluid.text(device.language(), Precision::Double)).unwrap();
    let (n, count) = (sides.len(), Argument::Count(sides.len() as i32));
    let first = device.upload(&rows.offsets).unwrap();
    let row = device.upload(&rows.neighbors).unwrap();
    let side = device.upload(sides.as_flattened()).unwrap();
    let sums = device.zeros(7 * n).unwrap();
    let [get, take] = ["fluid_sums", "fluid_step"].map(|name| program.kernel(name).unwrap());
    let (first, row) = (Argument::Indices(&first), Argument::Indices(&row));
    let (side_given, sums) = (Argument::Doubles(&side), Argument::Doubles(&sums));
    for _ in 0..20 {
        get.start(8 * n, 64, &[count, first, row, side_given, sums]).unwrap();
        take.start(n, 64, &[count, sums, side_given]).unwrap();
    }
    device.download(&side).unwrap()
}

#[test]
fn steps_of_a_solid_have_the_bits_of_the_processor() {
    let (positions, solid) = (positions(), Solid::rubber());
    let rows = rows(&positions, 2.62 * SPACING);
    let mut random = random(9);
    // Any antisymmetric coefficients of the right size do here.
    let reverse_entries = rows.reverse();
    let mut coefficients = vec![[0.0; 3]; rows.neighbors.len()];
    for entry in 0..coefficients.len() {
        let reverse = reverse_entries[entry] as usize;
        if reverse > entry {
            coefficients[entry] = [(); 3].map(|()| 2.0 * random() - 1.0);
            coefficients[reverse] = coefficients[entry].map(|g| -1.1 * g);
        }
    }
    let total = (0..rows.len())
        .map(|a| std::array::from_fn(|i| coefficients[rows.range(a)].iter().map(|g| g[i]).sum()))
        .collect();
    let body = Body {
        reverse: reverse_entries.iter().map(|entry| coefficients[*entry as usize]).collect(),
        total,
        volume: vec![1e-6; rows.len()],
        inverse_mass: vec![1e3; rows.len()],
        coefficients,
        rows,
    };
    let n = positions.len();
    let start: Vec<[f64; 3]> = positions.iter().map(|x| x.map(|x| (80.0 * x).sin())).collect();
    let (sliced, mut text) = (body.rows.sliced(), solid.text(Language::C, Precision::Double));
    indices(&mut text, "first", &sliced.first);
    indices(&mut text, "length", &sliced.length);
    let row = body.rows.arranged(&sliced, 0, |entry| body.rows.neighbors[entry]);
    assert_eq!(row.len() % SLICE, 0);
    indices(&mut text, "row", &row);
    for (name, all) in [("g", &body.coefficients), ("r", &body.reverse)] {
        for (axis, number) in ["0", "1", "2"].iter().enumerate() {
            let numbers = body.rows.arranged(&sliced, 0.0, |entry| all[entry][axis]);
            array(&mut text, &format!("{name}{number}"), &numbers);
        }
    }
    let padded = |rows: &[[f64; 3]]| -> Vec<f64> {
        rows.iter().flat_map(|row| [row[0], row[1], row[2], 0.0]).collect()
    };
    array(&mut text, "total", &padded(&body.total));
    array(&mut text, "volume", &body.volume);
    array(&mut text, "inverse_mass", &body.inverse_mass);
    array(&mut text, "velocity", &padded(&start));
    writeln!(
        text,
        "#include <stdio.h>\n#define R(x) ((const real *)(x))\n\
         int main(void) {{ static Tensor tension[{n}]; static Point u[{n}]; Point *v = (Point *)velocity;\n\
         for (int step = 0; step < 20; ++step) {{\n\
         solid_tensions({n}, first, length, row, R(g0), R(g1), R(g2), u, R(volume), tension);\n\
         solid_step({n}, first, length, row, R(r0), R(r1), R(r2), tension, (Point *)total, \
         R(inverse_mass), v, u);\n}}\n\
         for (int a = 0; a < {n}; ++a) printf(\"%llx %llx %llx %llx %llx %llx\\n\", p_bits(v[a].x), \
         p_bits(v[a].y), p_bits(v[a].z), p_bits(u[a].x), p_bits(u[a].y), p_bits(u[a].z));\n\
         return 0; }}"
    )
    .unwrap();
    let on_device = device().map(|device| solid_steps(&device, &solid, &body, &start));
    let compiled = run(&text, "").map(|output| parse(&output));
    let mut states: Vec<_> = start.iter().map(|v| (*v, [0.0; 3])).collect();
    let mut tensions = vec![[0.0; 9]; n];
    for _ in 0..20 {
        let displacement: Vec<[f64; 3]> = states.iter().map(|(_, u)| *u).collect();
        solid.fill_tensions(&body, &displacement, 0, &mut tensions);
        solid.advance(&body, &tensions, 0, &mut states);
    }
    let expected: Vec<f64> = states.iter().flat_map(|(v, u)| [*v, *u].concat()).collect();
    assert!(expected.iter().all(|x| x.is_finite()), "the numbers of the test are too large");
    for got in [on_device, compiled].into_iter().flatten() {
        assert_bits("solid", &got, &expected, &[]);
    }
}

/// Velocities and displacements after 20 steps on a device.
fn solid_steps(device: &Device, solid: &Solid, body: &Body, start: &[[f64; 3]]) -> Vec<f64> {
    let program = device.compile(&solid.text(device.language(), Precision::Double)).unwrap();
    let (n, sliced) = (start.len(), body.rows.sliced());
    let indices = [
        &sliced.first,
        &sliced.length,
        &body.rows.arranged(&sliced, 0, |entry| body.rows.neighbors[entry]),
    ]
    .map(|numbers| device.upload(numbers).unwrap());
    let upload = |numbers: &[f64]| device.upload(numbers).unwrap();
    let coefficients = [&body.coefficients, &body.reverse].map(|all| {
        [0, 1, 2].map(|axis| upload(&body.rows.arranged(&sliced, 0.0, |entry| all[entry][axis])))
    });
    let padded = |rows: &[[f64; 3]]| -> Vec<f64> {
        rows.iter().flat_map(|row| [row[0], row[1], row[2], 0.0]).collect()
    };
    let columns = [
        device.zeros(4 * n).unwrap(),
        upload(&body.volume),
        device.zeros(10 * n).unwrap(),
        upload(&padded(&body.total)),
        upload(&body.inverse_mass),
        upload(&padded(start)),
    ];
    let [displacement, volume, tension, total, inverse_mass, velocity] = columns.each_ref();
    let kernels = ["solid_tensions", "solid_step"].map(|name| program.kernel(name).unwrap());
    let given = |which: usize, columns: &[&'_ Column<f64>]| {
        let mut arguments = vec![Argument::Count(n as i32)];
        arguments.extend(indices.iter().map(Argument::Indices));
        arguments.extend(coefficients[which].iter().map(Argument::Doubles));
        arguments.extend(columns.iter().map(|column| Argument::Doubles(column)));
        kernels[which].start(n, 64, &arguments).unwrap();
    };
    for _ in 0..20 {
        given(0, &[displacement, volume, tension]);
        given(1, &[tension, total, inverse_mass, velocity, displacement]);
    }
    let [velocity, displacement] =
        [velocity, displacement].map(|column| device.download(column).unwrap());
    let points = velocity.chunks(4).zip(displacement.chunks(4));
    points.flat_map(|(v, u)| [v[0], v[1], v[2], u[0], u[1], u[2]]).collect()
}
