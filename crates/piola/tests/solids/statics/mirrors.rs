//! A quarter of a body between mirrors is a quarter of the body, an eighth an eighth.

use std::sync::atomic::AtomicBool;

use piola::case::{self, LoadOptions, Session};
use piola::observe::Series;

/// A block that a suction on its ends draws out, in this many dimensions.
fn block(dimension: usize, is_part: bool, clock: &str) -> String {
    let is_static = !clock.contains("newmark");
    let vector = |x: f64, y: f64, z: f64| format!("{:?}", &[x, y, z][..dimension]);
    let support = if dimension == 3 { 1.6 } else { 2.3 };
    let low = if is_part { 0.0 } else { -1.0 };
    let motion = if is_static { "displacement" } else { "velocity" };
    let mut text = format!(
        "version = 1\ntitle = 'A block'\ndimension = {dimension}\n\n\
         [[body]]\nname = 'block'\n\
         shape = {{ kind = 'box', min = {}, max = {} }}\n\
         spacing = 0.25\nlattice = {{ on = 'boundary' }}\n\
         material = {{ kind = 'neo_hookean_logarithmic', density = 1.0, young_modulus = 1.0, poisson_ratio = 0.35 }}\n\n\
         [scheme]\nkind = 'total_lagrangian'\ngradients = 'plain'\nsupport = {support}\nhourglass = 0.2\n\n\
         [time]\n{clock}\ntolerance = 1e-11\n\n",
        vector(low, 0.5 * low, 0.5 * low),
        vector(1.0, 0.5, 0.5),
    );
    for (axis, name) in ["x", "y", "z"].into_iter().enumerate().take(dimension) {
        let normal = std::array::from_fn(|k| if k == axis { -1.0 } else { 0.0 });
        let [x, y, z]: [f64; 3] = normal;
        text += &format!(
            "[[boundary]]\nname = '{name}'\nwhere = {{ kind = 'plane', point = {}, normal = {} }}\n\
             {motion} = {{ {name} = '0' }}\nmirror = {is_part}\n\n",
            vector(0.0, 0.0, 0.0),
            vector(x, y, z),
        );
    }
    for (end, is_there) in [(1.0, true), (-1.0, !is_part)] {
        if is_there {
            text += &format!(
                "[[load]]\nname = 'end{end}'\nkind = 'pressure'\n\
                 where = {{ kind = 'plane', point = {}, normal = {} }}\npressure = '-0.3 * t'\n\n",
                vector(end, 0.0, 0.0),
                vector(end, 0.0, 0.0),
            );
        }
    }
    for (name, place) in [("corner", [1.0, 0.5, 0.5]), ("inside", [0.25, 0.25, 0.25])] {
        let [x, y, z] = place;
        text += &format!(
            "[[probe]]\nname = '{name}'\nkind = 'particle'\nat = {}\nfields = ['displacement', 'stress']\n\n",
            vector(x, y, z)
        );
    }
    text
}

pub fn values(text: &str, names: &[&str]) -> Vec<f64> {
    let case = case::parse(text, "case.toml", &LoadOptions::default());
    let case = case.unwrap_or_else(|problems| panic!("{problems}"));
    let session = Session::new(&case).unwrap_or_else(|problems| panic!("{problems}"));
    let finished = session.run(&AtomicBool::new(false), &mut |_| {}).unwrap();
    let last = |name: &&str| match finished.quantity(name) {
        Some(Series::Curve { values, .. }) => *values.last().expect("a row at the end"),
        other => panic!("{name}: {other:?}"),
    };
    names.iter().map(last).collect()
}

/// In statics and in implicit steps, by factors and by Krylov's method, with a pressure that follows: bounds are
/// that of the solution, 1e-11 of the forces, with a condition of some hundred.
#[test]
fn a_part_between_mirrors_is_a_part_of_the_body() {
    let columns = [
        "corner.displacement.x",
        "corner.displacement.y",
        "inside.displacement.x",
        "inside.stress.xx",
        "inside.stress.xy",
        "energy.strain",
        "energy.hourglass",
    ];
    let clocks = [
        "integrator = 'static'\nend = 1.0\nstep = 0.5",
        "integrator = 'static'\nend = 1.0\nstep = 0.5\nlinear_solver = 'krylov'",
        "integrator = 'newmark'\nend = 2.0\nstep = 0.25",
    ];
    for (dimension, clocks) in [(2, &clocks[..]), (3, &clocks[..2])] {
        for clock in clocks {
            let [whole, part] =
                [false, true].map(|is_part| values(&block(dimension, is_part, clock), &columns));
            assert!(whole[0] > 0.1, "{clock}: it is drawn out by {} m", whole[0]);
            for ((name, whole), part) in columns.iter().zip(&whole).zip(&part) {
                let parts =
                    if name.starts_with("energy") { 0.5_f64.powi(dimension as i32) } else { 1.0 };
                let off = (part - parts * whole).abs();
                assert!(off < 1e-8, "{dimension}D, {clock}, {name}: {part} for {}", parts * whole);
            }
        }
    }
}
