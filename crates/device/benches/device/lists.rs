//! Neighbour lists made on a device: rows against those of the processor, and times.

use piola_device::lists::Lists;
use piola_device::{Column, Device, DeviceError};

use super::cloud;
use super::processor::{FLUID_RADIUS, SPACING};

/// Measurements of which the best counts.
const REPEATS: usize = 10;
/// Skin over the support.
const SKIN: f64 = 0.2;

/// A build and a pick of a cube of particles whose numbers are not in the order of space.
pub fn measure(device: &Device, side: usize) -> Result<(), DeviceError> {
    let support = FLUID_RADIUS * SPACING;
    let ordered = cloud::cube(side, SPACING);
    let count = ordered.len();
    // A step that has no factor in common with the count reaches all.
    let step = (count / 2..).find(|step| gcd(*step, count) == 1).unwrap_or(1);
    let positions: Vec<[f64; 3]> = (0..count).map(|k| ordered[k * step % count]).collect();
    let by_number = device.upload(positions.as_flattened())?;
    let passive: Vec<bool> = (0..count).map(|number| number % 10 == 3).collect();
    let mut lists = Lists::new(device, &passive, support, SKIN * support, &[None; 3])?;
    lists.build(&by_number)?;
    let numbers = device.download(lists.numbers())?;
    let by_slot: Vec<[f64; 3]> = numbers.iter().map(|a| positions[*a as usize]).collect();
    let by_slot = device.upload(by_slot.as_flattened())?;
    lists.pick(&by_slot)?;
    let (entries, wrong) = compare(device, &lists, &positions, &passive)?;
    let mut best = [f64::INFINITY; 2];
    for _ in 0..REPEATS {
        best[0] = best[0].min(device.time(|| lists.build(&by_number))?);
        best[1] = best[1].min(device.time(|| lists.pick(&by_slot))?);
    }
    println!(
        "lists: {count} particles, {:.1} candidates, {:.1} neighbours, {wrong} rows differ from those of the \
         processor; build {:.3} ms, pick {:.3} ms",
        lists.candidates() as f64 / count as f64,
        entries as f64 / count as f64,
        best[0],
        best[1]
    );
    Ok(())
}

fn gcd(a: usize, b: usize) -> usize {
    if b == 0 { a } else { gcd(b, a % b) }
}

/// Entries of all rows, and how many rows are not those of the processor.
fn compare(
    device: &Device,
    lists: &Lists,
    positions: &[[f64; 3]],
    passive: &[bool],
) -> Result<(usize, usize), DeviceError> {
    let get = |column: &Column<u32>| device.download(column);
    let (numbers, slots, entries) =
        (get(lists.numbers())?, get(lists.slots())?, get(lists.entries())?);
    let parts = [
        (get(lists.first())?, get(lists.active())?),
        (get(lists.passive_first())?, get(lists.passive_count())?),
    ];
    let rows = cloud::neighbors(positions, FLUID_RADIUS * SPACING);
    let (mut all, mut wrong) = (0, 0);
    for a in 0..positions.len() {
        let s = slots[a] as usize;
        let got = parts.iter().flat_map(|(first, count)| {
            entries[first[s] as usize..][..count[s] as usize].iter().map(|b| numbers[*b as usize])
        });
        let of = |kind: bool| rows.row(a).iter().filter(move |b| passive[**b as usize] == kind);
        let expected = of(false).chain(of(true).filter(|_| !passive[a]));
        all += expected.clone().count();
        wrong += usize::from(!got.eq(expected.copied()));
    }
    Ok((all, wrong))
}
