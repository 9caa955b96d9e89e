//! Neighbour lists made on a device against a look at all pairs.

use piola_device::lists::{self, Lists};
use piola_device::{Column, Device, Language, Precision, cuda};

use super::devices::device;
use super::random;

/// Particles in a space.
struct Cloud {
    /// Coordinates in m, particle by particle.
    positions: Vec<Vec<f64>>,
    passive: Vec<bool>,
    excluded: Vec<bool>,
    support: f64,
    periodic: Vec<Option<[f64; 2]>>,
}

const SKIN: f64 = 0.2;

impl Cloud {
    /// Random particles in the unit box, every fifth of them passive.
    fn new(count: usize, support: f64, periodic: &[Option<[f64; 2]>]) -> Self {
        let mut random = random(count as u64);
        let positions =
            (0..count).map(|_| periodic.iter().map(|_| random()).collect()).collect::<Vec<_>>();
        let passive = (0..count).map(|number| number % 5 == 2).collect();
        let excluded = vec![false; count];
        Self { positions, passive, excluded, support, periodic: periodic.to_vec() }
    }

    /// Square of the shorter way, as the processor has it.
    fn square(&self, a: usize, b: usize) -> f64 {
        let mut square = 0.0;
        for (axis, bounds) in self.periodic.iter().enumerate() {
            let mut way = self.positions[a][axis] - self.positions[b][axis];
            if let &Some([lower, upper]) = bounds {
                let (period, half) = (upper - lower, 0.5 * (upper - lower));
                way = match way {
                    _ if way < -half => way + period,
                    _ if way > half => way - period,
                    _ => way,
                };
            }
            square += way * way;
        }
        square
    }

    /// Numbers of the neighbours of each particle closer than a radius: passive ones last.
    fn rows(&self, radius: f64) -> Vec<[Vec<u32>; 2]> {
        let all = 0..self.positions.len();
        let of = |a: usize, is_passive: bool| -> Vec<u32> {
            all.clone()
                .filter(|&b| a != b && self.passive[b] == is_passive)
                .filter(|&b| !(self.excluded[a] || self.excluded[b]))
                .filter(|_| !(self.passive[a] && is_passive))
                .filter(|&b| self.square(a, b) < radius * radius)
                .map(|b| b as u32)
                .collect()
        };
        all.clone().map(|a| [of(a, false), of(a, true)]).collect()
    }

    /// Moves every particle by less than half of the skin.
    fn move_on(&mut self, seed: u64) {
        let mut random = random(seed);
        let most = 0.499 * SKIN * self.support / (self.periodic.len() as f64).sqrt();
        for position in &mut self.positions {
            for (x, bounds) in position.iter_mut().zip(&self.periodic) {
                *x += most * (2.0 * random() - 1.0);
                if let &Some([lower, upper]) = bounds {
                    *x = lower + (*x - lower).rem_euclid(upper - lower);
                    *x = if *x < upper { *x } else { lower };
                }
            }
        }
    }

    fn lists(&self, device: &Device) -> Lists {
        let skin = SKIN * self.support;
        Lists::new(device, &self.passive, self.support, skin, &self.periodic).unwrap()
    }

    /// Makes the list anew.
    fn build(&self, lists: &mut Lists, device: &Device) {
        lists.build(&device.upload(&self.positions.concat()).unwrap()).unwrap();
        let candidates = self.rows(self.support + SKIN * self.support);
        let total = candidates.iter().flatten().map(Vec::len).sum();
        assert_eq!(lists.candidates(), total, "candidates");
    }

    /// Compares rows with a look at all pairs.
    fn compare(&self, lists: &mut Lists, device: &Device, what: &str) {
        let get = |column: &Column<u32>| device.download(column).unwrap();
        let (numbers, slots) = (get(lists.numbers()), get(lists.slots()));
        for (number, slot) in slots.iter().enumerate() {
            assert_eq!(numbers[*slot as usize] as usize, number, "{what}");
        }
        // The first two coordinates of all, then the third of all.
        let of = |from: usize, to: usize| {
            let place = move |a: &u32| self.positions[*a as usize][from..to].to_vec();
            numbers.iter().flat_map(place)
        };
        let axes = self.periodic.len();
        let by_slot: Vec<f64> = of(0, axes.min(2)).chain(of(axes.min(2), axes)).collect();
        lists.pick(&device.upload(&by_slot).unwrap()).unwrap();
        let (first, active) = (get(lists.first()), get(lists.active()));
        let (from, passive) = (get(lists.passive_first()), get(lists.passive_count()));
        let entries = get(lists.entries());
        for (a, expected) in self.rows(self.support).iter().enumerate() {
            let s = slots[a] as usize;
            let row = |from: u32, count: u32| -> Vec<u32> {
                let row = &entries[from as usize..][..count as usize];
                row.iter().map(|slot| numbers[*slot as usize]).collect()
            };
            let got = [row(first[s], active[s]), row(from[s], passive[s])];
            assert_eq!(&got, expected, "{what}, particle {a}");
        }
    }

    /// Compares after a build, after moves, and after another build.
    fn check(&mut self, device: &Device, what: &str) {
        let mut lists = self.lists(device);
        for seed in 1..3 {
            self.build(&mut lists, device);
            self.compare(&mut lists, device, what);
            self.move_on(seed);
            self.compare(&mut lists, device, what);
        }
        self.build(&mut lists, device);
        self.compare(&mut lists, device, what);
    }
}

const UNIT: Option<[f64; 2]> = Some([0.0, 1.0]);

#[test]
fn rows_are_those_of_all_pairs() {
    let Some(device) = device() else { return };
    for (count, support, periodic) in [
        (200, 0.03, vec![None]),
        (200, 0.03, vec![UNIT]),
        (700, 0.08, vec![None, None]),
        (700, 0.08, vec![UNIT, None]),
        (900, 0.16, vec![None, None, None]),
        (900, 0.16, vec![UNIT, None, UNIT]),
    ] {
        Cloud::new(count, support, &periodic).check(&device, &format!("{periodic:?}"));
    }
}

#[test]
fn few_cells_list_nobody_twice() {
    let Some(device) = device() else { return };
    // Three cells, two, and one, along periods that are and are not longer than two ways.
    for support in [0.25, 0.35, 0.41, 0.49, 0.8, 1.7] {
        for periodic in [vec![UNIT], vec![UNIT, None], vec![UNIT, None, UNIT]] {
            Cloud::new(90, support, &periodic).check(&device, &format!("{support}, {periodic:?}"));
        }
    }
}

#[test]
fn clusters_and_outliers_are_found() {
    let Some(device) = device() else { return };
    let mut cloud = Cloud::new(600, 0.1, &[None, None, None]);
    for position in &mut cloud.positions[300..] {
        position.iter_mut().for_each(|x| *x = 0.7 + 0.02 * *x);
    }
    cloud.check(&device, "a cluster");
    for far in [50.0, -1e5, 1e9, -1e30, f64::MAX] {
        cloud.positions[77] = vec![far, 0.5, -far];
        cloud.check(&device, &format!("an outlier at {far}"));
    }
    cloud.positions.iter_mut().for_each(|x| *x = vec![0.3, 0.3, 0.3]);
    cloud.check(&device, "all in one place");
    // Few particles in a space of very many cells, some pairs of them close.
    let mut cloud = Cloud::new(120, 0.5, &[Some([-1e4, 1e6]), None]);
    for (a, position) in cloud.positions.iter_mut().enumerate() {
        position[0] = -1e4 + 1.01e6 * (0.9999 * (a / 3) as f64 / 40.0) + 0.3 * position[0];
        position[1] *= 3.0;
    }
    cloud.check(&device, "a large space");
}

#[test]
fn what_is_excluded_sees_nobody_and_is_not_seen() {
    let Some(device) = device() else { return };
    let mut cloud = Cloud::new(500, 0.12, &[UNIT, None]);
    // Many of them in one place, which others are near to.
    for a in (0..500).filter(|a| a % 7 == 3) {
        cloud.positions[a] = vec![0.4, 0.5];
    }
    let (mut lists, passive) = (cloud.lists(&device), cloud.passive.clone());
    for every in [Some(7), Some(14), None] {
        let is_out = |a: usize| every.is_some_and(|every| a % every == 3);
        cloud.excluded = (0..500).map(is_out).collect();
        cloud.passive = (0..500).map(|a| passive[a] || is_out(a)).collect();
        lists.exclude(&cloud.passive, &cloud.excluded).unwrap();
        cloud.build(&mut lists, &device);
        cloud.compare(&mut lists, &device, &format!("{every:?}"));
    }
}

#[test]
fn what_is_no_number_has_no_neighbours() {
    let Some(device) = device() else { return };
    let mut cloud = Cloud::new(50, 0.3, &[UNIT, None]);
    cloud.positions[3] = vec![f64::NAN, 0.4];
    cloud.positions[9] = vec![0.1, f64::NAN];
    cloud.positions[10] = vec![0.2, f64::INFINITY];
    let mut lists = cloud.lists(&device);
    cloud.build(&mut lists, &device);
    cloud.compare(&mut lists, &device, "NaN");
    cloud.positions.iter_mut().for_each(|x| *x = vec![f64::NAN; 2]);
    cloud.build(&mut lists, &device);
    cloud.compare(&mut lists, &device, "only NaN");
}

#[test]
fn there_may_be_one_particle_or_none() {
    let Some(device) = device() else { return };
    for count in [0, 1, 2] {
        Cloud::new(count, 2.0, &[UNIT, None]).check(&device, &format!("{count} particles"));
    }
}

#[test]
fn the_text_of_lists_compiles_for_cuda() {
    if !cuda::has_compiler() {
        assert!(std::env::var_os("PIOLA_NVRTC_REQUIRED").is_none(), "there is no NVRTC");
        eprintln!("NOT RUN: there is no NVRTC on this machine");
        return;
    }
    for periodic in [vec![false], vec![true, false], vec![true, false, true]] {
        let text = lists::text(Language::Cuda, &periodic);
        let module = cuda::compile(&text, Precision::Double, "compute_80")
            .unwrap_or_else(|e| panic!("{e}\n{text}"));
        assert!(!module.text().contains("fma."), "an operation is fused");
    }
}
