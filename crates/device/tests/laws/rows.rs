//! Sums over rows that do not change, on a device.

use piola_device::{Among, Frozen, Gather, Layout, Machine, Order, Rows, difference, own};
use piola_formulas::pairs::total_lagrangian::Gradients;
use piola_formulas::pairs::{Components, Each, Square};

use super::devices::device;
use super::random;

const COUNT: usize = 40;
/// Of four numbers of a pair the third is zero in all of them.
const KEPT: [Option<usize>; 4] = [Some(0), Some(1), None, Some(2)];

/// Neighbours with the numbers of their pairs.
type Row = Vec<(usize, [f64; 4])>;

fn rows() -> Vec<Row> {
    let mut random = random(11);
    let mut row = |a: usize| -> Row {
        let mut pair = |k: usize| {
            let numbers = [random(), random() - 0.5, 0.0, random() - 0.5];
            ((a * 7 + k * k + 1) % COUNT, numbers)
        };
        // None, less than a block, a block, more.
        (0..[0, 3, 8, 13, 21][a % 5]).map(&mut pair).collect()
    };
    (0..COUNT).map(&mut row).collect()
}

/// `sum_b (u_b - u_a) (x) g_ab^n`, neighbour k in lane k mod 8, lanes added by halves.
fn sums(row: &Row, field: &[f64], a: usize) -> Vec<f64> {
    let mut lanes = [[0.0; 8]; 8];
    for (k, (b, pair)) in row.iter().enumerate() {
        for (number, lanes) in lanes.iter_mut().enumerate() {
            let (n, i, j) = (number / 4, number / 2 % 2, number % 2);
            lanes[k % 8] += (field[2 * b + i] - field[2 * a + i]) * pair[2 * n + j];
        }
    }
    let sum = |l: &[f64; 8]| ((l[0] + l[4]) + (l[2] + l[6])) + ((l[1] + l[5]) + (l[3] + l[7]));
    lanes.iter().map(sum).collect()
}

/// What a device makes of it, with these columns in single precision.
fn on_device(narrow: &'static [&'static str], field: &[f64]) -> Option<Vec<f64>> {
    let (mut first, mut count, mut neighbors, mut numbers) = (vec![], vec![], vec![], vec![]);
    for row in rows() {
        first.push(neighbors.len() as u32 / 8);
        count.push(row.len() as u32);
        for block in row.chunks(8) {
            let entry = |k: usize| block[k.min(block.len() - 1)];
            neighbors.extend((0..8).map(|k| entry(k).0 as u32));
            for number in (0..4).filter(|number| KEPT[*number].is_some()) {
                numbers.extend((0..8).map(|k| entry(k).1[number]));
            }
        }
    }
    let columns = Rows {
        first: "first",
        count: "count",
        neighbors: "neighbors",
        numbers: "numbers",
        kept: KEPT.into(),
    };
    let pairs = Frozen::<Each<Components<2>, 2>>::new(columns);
    let passes = |dialect| {
        let (field, writes) = ([difference("field", 2)], [own("gradient", 8)]);
        let gather = Gather::<Each<Square<2>, 2>, _>::new(
            dialect,
            "gradients",
            &pairs,
            Among::All,
            Order::Lanes,
        );
        let gather = gather.term(&Gradients::<2, 2>, &field, Among::All);
        let entries = |sums: &[nalgebra::SMatrix<_, 2, 2>; 2]| {
            sums.iter().flat_map(|it| it.transpose().as_slice().to_vec()).collect()
        };
        vec![gather.close(&[], &[], &writes, |sums, _| entries(sums))]
    };
    let mut machine =
        Machine::new(device()?, None, Layout { narrow, planes: &[] }, passes, 16).unwrap();
    machine.add_indices("first", &first).unwrap();
    machine.add_indices("count", &count).unwrap();
    machine.add_indices("neighbors", &neighbors).unwrap();
    machine.add("numbers", &numbers).unwrap();
    machine.add("field", field).unwrap();
    machine.add_zeros("gradient", 8 * COUNT).unwrap();
    machine.start("gradients", COUNT, &[]).unwrap();
    let mut found = vec![0.0; 8 * COUNT];
    machine.device().read(machine.column("gradient"), &mut found).unwrap();
    Some(found)
}

fn expected(field: &[f64]) -> Vec<f64> {
    rows().iter().enumerate().flat_map(|(a, row)| sums(row, field, a)).collect()
}

#[test]
fn sums_over_rows_have_the_bits_of_lanes() {
    let mut random = random(12);
    let field: Vec<f64> = (0..2 * COUNT).map(|_| random()).collect();
    let Some(found) = on_device(&[], &field) else { return };
    assert_eq!(found, expected(&field));
}

/// Differences are taken in double precision: those of 1e-3 beside 1e6 keep the digits of single precision.
#[test]
fn in_single_precision_differences_keep_their_digits() {
    let mut random = random(13);
    let field: Vec<f64> = (0..2 * COUNT).map(|_| 1e6 + 1e-3 * random()).collect();
    let Some(found) = on_device(&["numbers"], &field) else { return };
    // Numbers and differences are rounded, products and sums of 21 terms of at most 1e-3.
    let rounding = 0.5 * f64::from(f32::EPSILON) * 1e-3 * 21.0 * (3.0 + 5.0);
    for (found, expected) in found.iter().zip(expected(&field)) {
        assert!((found - expected).abs() <= rounding, "{found} {expected}");
        assert_eq!(*found, f64::from(*found as f32), "sums are in single precision");
    }
    assert_ne!(found, expected(&field));
}
