//! An order of unknowns in which a factorisation fills little.

/// Points below which a part is not cut further.
const LEAF: usize = 48;

/// Numbers of points in the order of nested dissection: a cut across the longest extent leaves two
/// parts that do not see each other, and the points that part them come after both.
///
/// `coupled[a]` are the points that a shares an entry of the matrix with. The order depends on the
/// points alone.
pub fn dissect<const D: usize>(
    points: &[nalgebra::SVector<f64, D>],
    coupled: &[Vec<u32>],
) -> Vec<u32> {
    let mut order = Vec::with_capacity(points.len());
    let mut side = vec![Side::Outside; points.len()];
    let all = (0..points.len() as u32).collect();
    cut(points, coupled, all, &mut side, &mut order);
    order
}

#[derive(Clone, Copy, PartialEq)]
enum Side {
    Outside,
    Near,
    Far,
}

fn cut<const D: usize>(
    points: &[nalgebra::SVector<f64, D>],
    coupled: &[Vec<u32>],
    mut part: Vec<u32>,
    side: &mut [Side],
    order: &mut Vec<u32>,
) {
    if part.len() <= LEAF {
        order.append(&mut part);
        return;
    }
    let axis = longest(points, &part);
    // Equal places are told apart by the number, so that the order is the only one.
    let key = |a: &u32| (points[*a as usize][axis], *a);
    part.sort_by(|a, b| {
        let ((x, a), (y, b)) = (key(a), key(b));
        x.total_cmp(&y).then(a.cmp(&b))
    });
    let far = part.split_off(part.len() / 2);
    part.iter().for_each(|&a| side[a as usize] = Side::Near);
    far.iter().for_each(|&a| side[a as usize] = Side::Far);
    let touches = |a: &u32| coupled[*a as usize].iter().any(|&b| side[b as usize] == Side::Far);
    let (between, near): (Vec<u32>, Vec<u32>) = part.into_iter().partition(touches);
    let all = near.iter().chain(&between).chain(&far);
    all.for_each(|&a| side[a as usize] = Side::Outside);
    // Where nothing is left on one side there is nothing to gain.
    if near.is_empty() {
        order.extend(far.into_iter().chain(between));
        return;
    }
    cut(points, coupled, near, side, order);
    cut(points, coupled, far, side, order);
    order.extend(between);
}

/// The axis along which the part is longest.
fn longest<const D: usize>(points: &[nalgebra::SVector<f64, D>], part: &[u32]) -> usize {
    let extent = |axis: usize| {
        let places = part.iter().map(|&a| points[a as usize][axis]);
        let (low, high) = places
            .fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), x| (low.min(x), high.max(x)));
        high - low
    };
    (1..D).fold(0, |best, axis| if extent(axis) > extent(best) { axis } else { best })
}
