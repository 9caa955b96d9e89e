//! Motions of what hangs together, as a whole, that supports leave free.

use nalgebra::DMatrix;

use super::faces::Spring;
use super::supports::Supports;
use crate::Vector;
use crate::geometry::Particles;

/// Smallest eigenvalue over the largest of the constrained parts of rigid motions below which one
/// of them is free.
const FREE: f64 = 1e-10;

/// A rigid motion that nothing holds, in words, with the first particle of what moves. `parts` are
/// the numbers of what hangs together, of each particle.
pub(super) fn free_motion<const D: usize>(
    particles: &Particles<D>,
    parts: &[u32],
    supports: &Supports<D>,
    springs: &[Spring<D>],
) -> Option<(usize, String)> {
    let count = parts.iter().max().map_or(0, |&part| part + 1);
    (0..count).find_map(|part| free_motion_of(particles, (parts, part), supports, springs))
}

fn free_motion_of<const D: usize>(
    particles: &Particles<D>,
    (parts, part): (&[u32], u32),
    supports: &Supports<D>,
    springs: &[Spring<D>],
) -> Option<(usize, String)> {
    let own: Vec<usize> = (0..particles.len()).filter(|&a| parts[a] == part).collect();
    let first = *own.first()?;
    let center = own.iter().map(|&a| particles.position[a]).sum::<Vector<D>>() / own.len() as f64;
    let reach = |&a: &usize| (particles.position[a] - center).norm();
    let size = own.iter().map(reach).fold(f64::MIN_POSITIVE, f64::max);
    let place = |a: usize| (particles.position[a] - center) / size;
    let held = supports.entries().iter().filter(|entry| parts[entry.particle] == part);
    let mut rows: Vec<Vec<f64>> = held
        .map(|entry| {
            let direction = supports.frame(entry.particle).column(entry.component).into_owned();
            motions(&place(entry.particle), &direction)
        })
        .collect();
    let own = |spring: &&Spring<D>| parts[spring.owner as usize] == part;
    rows.extend(
        springs
            .iter()
            .filter(own)
            .map(|spring| motions(&((spring.place - center) / size), &spring.direction)),
    );
    for tie in supports.ties() {
        let axis = Vector::from_fn(|i, _| f64::from(u8::from(i == tie.component)));
        let of = |a: u32| match parts[a as usize] == part {
            true => motions(&place(a as usize), &axis),
            false => vec![0.0; names::<D>().len()],
        };
        let leader = of(tie.particles[0]);
        let apart = |a: &u32| of(*a).iter().zip(&leader).map(|(m, f)| m - f).collect();
        rows.extend(tie.particles[1..].iter().map(apart));
    }
    let modes = names::<D>().len();
    let mut gram = DMatrix::zeros(modes, modes);
    for row in &rows {
        gram += DMatrix::from_fn(modes, modes, |i, j| row[i] * row[j]);
    }
    let eigen = gram.symmetric_eigen();
    let (weakest, least) = eigen.eigenvalues.argmin();
    if least > FREE * eigen.eigenvalues.max() {
        return None;
    }
    let mode = eigen.eigenvectors.column(weakest);
    Some((first, names::<D>()[mode.iamax()].to_owned()))
}

fn names<const D: usize>() -> &'static [&'static str] {
    match D {
        1 => &["shift along x"],
        2 => &["shift along x", "shift along y", "turn about z"],
        _ => &[
            "shift along x",
            "shift along y",
            "shift along z",
            "turn about x",
            "turn about y",
            "turn about z",
        ],
    }
}

/// By how much each rigid motion moves a place along a direction.
fn motions<const D: usize>(place: &Vector<D>, direction: &Vector<D>) -> Vec<f64> {
    let mut all: Vec<f64> = direction.iter().copied().collect();
    if D == 2 {
        all.push(place[0] * direction[1] - place[1] * direction[0]);
    }
    if D == 3 {
        let turn = |i: usize, j: usize| place[i] * direction[j] - place[j] * direction[i];
        all.extend([turn(1, 2), turn(2, 0), turn(0, 1)]);
    }
    all
}
