//! Bodies to measure on.

use nalgebra::{Matrix3, Vector3};
use piola_device::passes::Rows;
use piola_device::passes::solid::Body;
use piola_formulas::kernels::{QuinticSpline, ScaledKernel};
use piola_formulas::tensor;

/// A cube of jittered particles in the order of Morton's curve.
pub fn cube(side: usize, spacing: f64) -> Vec<[f64; 3]> {
    let spread = |mut x: u64| {
        x = (x | (x << 16)) & 0x0000_ff00_00ff;
        x = (x | (x << 8)) & 0x00f0_0f00_f00f;
        x = (x | (x << 4)) & 0x0c30_c30c_30c3;
        (x | (x << 2)) & 0x2492_4924_9249
    };
    let mut places: Vec<(u64, [usize; 3])> = Vec::with_capacity(side * side * side);
    for k in 0..side * side * side {
        let place = [k % side, k / side % side, k / side / side];
        let [x, y, z] = place.map(|i| spread(i as u64));
        places.push((x | (y << 1) | (z << 2), place));
    }
    places.sort_unstable();
    let mut state = 0x9e37_79b9_7f4a_7c15_u64;
    let mut random = move || {
        state ^= state << 13;
        state ^= state >> 7;
        state ^= state << 17;
        (state >> 11) as f64 / (1_u64 << 53) as f64 - 0.5
    };
    places.iter().map(|(_, place)| place.map(|i| (i as f64 + 0.2 * random()) * spacing)).collect()
}

/// All neighbours within a radius, in ascending order.
pub fn neighbors(positions: &[[f64; 3]], radius: f64) -> Rows {
    let cell = |x: &[f64; 3]| x.map(|x| ((x / radius).floor() as i64 + 2) as usize);
    let most = positions.iter().flat_map(cell).max().unwrap_or(0) + 2;
    let number = |[x, y, z]: [usize; 3]| (z * most + y) * most + x;
    let mut cells: Vec<Vec<u32>> = vec![Vec::new(); most * most * most];
    positions.iter().enumerate().for_each(|(a, x)| cells[number(cell(x))].push(a as u32));
    let mut rows = Rows { offsets: vec![0], neighbors: Vec::new() };
    for (a, x) in positions.iter().enumerate() {
        let first = rows.neighbors.len();
        let [i, j, k] = cell(x);
        for step in 0..27 {
            let around = [i + step % 3 - 1, j + step / 3 % 3 - 1, k + step / 9 - 1];
            for &b in &cells[number(around)] {
                let y = &positions[b as usize];
                let square: f64 = (0..3).map(|axis| (x[axis] - y[axis]).powi(2)).sum();
                if b as usize != a && square < radius * radius {
                    rows.neighbors.push(b);
                }
            }
        }
        rows.neighbors[first..].sort_unstable();
        rows.offsets.push(rows.neighbors.len() as u32);
    }
    rows
}

/// A solid body with its lists and corrected gradients.
pub fn body(positions: &[[f64; 3]], radius: f64, volume: f64, density: f64) -> Body {
    let rows = neighbors(positions, radius);
    let kernel = ScaledKernel::<QuinticSpline, 3>::new(radius / 3.0);
    let mut coefficients = Vec::with_capacity(rows.neighbors.len());
    let mut total = Vec::with_capacity(positions.len());
    for (a, x) in positions.iter().enumerate() {
        let x = Vector3::from(*x);
        let terms: Vec<(Vector3<f64>, f64)> = rows
            .row(a)
            .iter()
            .map(|b| Vector3::from(positions[*b as usize]) - x)
            .map(|separation| (separation, -volume * kernel.derivative_over_r(separation.norm())))
            .collect();
        let moment: Matrix3<f64> = terms.iter().map(|(x, s)| x * x.transpose() * *s).sum();
        let inverse = tensor::inverse(&moment).expect("neighbours span the space");
        let first = coefficients.len();
        coefficients.extend(terms.iter().map(|(x, s)| <[f64; 3]>::from(inverse * x * *s)));
        let sum: Vector3<f64> = coefficients[first..].iter().map(|g| Vector3::from(*g)).sum();
        total.push(sum.into());
    }
    let reverse = rows.reverse().iter().map(|entry| coefficients[*entry as usize]).collect();
    Body {
        coefficients,
        reverse,
        total,
        volume: vec![volume; positions.len()],
        inverse_mass: vec![1.0 / (density * volume); positions.len()],
        rows,
    }
}
