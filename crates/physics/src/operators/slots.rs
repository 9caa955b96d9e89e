//! Where the particles of a rank stand.

use std::collections::HashMap;
use std::ops::Range;

/// The slots of a rank among those of all: its particles, their images behind planes, and copies of slots of others.
#[derive(Clone, Debug, Default)]
pub struct Slots {
    /// Its particles.
    pub own: Range<usize>,
    /// Their images.
    pub images: Vec<usize>,
    /// What it has copies of: the rank that has it and its slot there among all, rank by rank.
    pub copies: Vec<(usize, usize)>,
    /// Where images and copies stand here.
    places: HashMap<usize, u32>,
}

impl Slots {
    /// Particles, their images, and copies.
    pub fn new(own: Range<usize>, images: Vec<usize>, copies: Vec<(usize, usize)>) -> Self {
        let behind = images.iter().copied().chain(copies.iter().map(|(_, slot)| *slot));
        let places = behind.zip(own.len() as u32..).collect();
        Self { own, images, copies, places }
    }

    /// All of them, in the order in which they stand here.
    pub fn iter(&self) -> impl Iterator<Item = usize> {
        let behind = self.images.iter().copied().chain(self.copies.iter().map(|(_, slot)| *slot));
        self.own.clone().chain(behind)
    }

    /// Where a slot stands here; behind all of them if it does not.
    pub fn place(&self, slot: u32) -> u32 {
        let slot = slot as usize;
        match self.own.contains(&slot) {
            true => (slot - self.own.start) as u32,
            false => self.places.get(&slot).copied().unwrap_or(u32::MAX),
        }
    }

    /// How many ranks it has copies of.
    pub fn partners(&self) -> usize {
        self.copies.chunk_by(|one, other| one.0 == other.0).count()
    }

    /// How many of them are its own.
    pub fn owned(&self) -> usize {
        self.own.len() + self.images.len()
    }
}
