//! Which particles are of one continuum, and which only touch.

use piola_formulas::pairs::One;
use piola_formulas::{Lanes, Lanes4, WIDTH};

use super::Common;
use crate::neighbors::{Domain, SkinList};
use crate::operators::Source;
use crate::{Vector, parallel};

/// The label of walls, which belong to every continuum.
const WALL: u32 = u32::MAX;

/// To which continuum particles belong, by place.
#[derive(Clone, Debug)]
pub(super) struct Continua<const D: usize> {
    /// [`WALL`], or the body where bodies are apart; empty where all are of one.
    labels: Vec<u32>,
    /// Where particles began, in m; empty unless bodies touch themselves.
    starts: Vec<Vector<D>>,
    /// How far apart particles of one continuum may have begun, in m.
    farthest: f64,
    domain: Domain<D>,
    /// For which places, counted by lists of neighbours, the rest stands.
    builds: Option<u64>,
}

impl<const D: usize> Continua<D> {
    /// All particles are of one continuum.
    pub fn one(domain: Domain<D>) -> Self {
        Self {
            labels: Vec::new(),
            starts: Vec::new(),
            farthest: f64::INFINITY,
            domain,
            builds: None,
        }
    }

    /// Each body is one by itself, and what began farther apart than that in m, if it is given, is not of one.
    pub fn of_bodies(common: &Common<D>, farthest: Option<f64>) -> Self {
        let one = Self::one(*common.support.list().domain());
        let (bodies, is_wall) = (&common.particles.body, &common.is_wall);
        let mut own = bodies.iter().zip(is_wall).filter(|(_, is_wall)| !*is_wall);
        let first = own.next().map(|(body, _)| *body);
        let is_one = own.all(|(body, _)| Some(*body) == first);
        let labels = vec![0; bodies.len()];
        match farthest {
            None if is_one => one,
            None => Self { labels, ..one },
            Some(farthest) => {
                let starts = vec![Vector::zeros(); bodies.len()];
                Self { labels, starts, farthest, ..one }
            }
        }
    }

    /// The same for other places.
    pub fn renewed(&self) -> Self {
        Self { builds: None, ..self.clone() }
    }

    /// Whether there are several bodies, or parts of one, that are apart from each other.
    pub fn are_several(&self) -> bool {
        !self.labels.is_empty()
    }

    /// How far apart in m particles of one continuum may have begun, if bodies touch themselves.
    pub fn farthest(&self) -> Option<f64> {
        (!self.starts.is_empty()).then_some(self.farthest)
    }

    /// Fills what belongs to the places of particles of bodies, of walls or not, that began somewhere in m,
    /// where a new list has renewed them.
    pub fn follow(
        &mut self,
        list: &SkinList<D>,
        bodies: &[u32],
        begin: &[Vector<D>],
        is_wall: &[bool],
    ) {
        if self.builds == Some(list.builds()) {
            return;
        }
        self.builds = Some(list.builds());
        let numbers = list.numbers();
        if self.are_several() {
            self.labels.resize(numbers.len(), WALL);
        }
        if !self.starts.is_empty() {
            self.starts.resize(numbers.len(), Vector::zeros());
        }
        parallel::for_each_chunk(&mut self.labels, |first, labels| {
            for (label, &number) in labels.iter_mut().zip(&numbers[first..]) {
                *label = match is_wall[number as usize] {
                    true => WALL,
                    false => bodies[number as usize],
                };
            }
        });
        parallel::for_each_chunk(&mut self.starts, |first, starts| {
            for (start, &number) in starts.iter_mut().zip(&numbers[first..]) {
                *start = begin[number as usize];
            }
        });
    }

    /// Whether two particles (places) belong to the same continuum: one
    /// body and walls, and of a body that touches itself what began close to each other, theory (75).
    #[inline]
    pub fn is_own(&self, place: usize, other: usize) -> bool {
        let Some(label) = self.labels.get(other) else { return true };
        if *label == WALL {
            return true;
        }
        *label == self.labels[place] && (self.starts.is_empty() || self.began_close(place, other))
    }

    fn began_close(&self, place: usize, other: usize) -> bool {
        let apart = self.domain.separation(&self.starts[place], &self.starts[other]);
        apart.norm_squared() <= self.farthest * self.farthest
    }
}

/// 1 for neighbours of the same continuum, 0 for others.
impl<const D: usize> Source<One> for Continua<D> {
    fn own(&self, _place: usize) -> f64 {
        1.0
    }

    #[inline]
    fn one(&self, place: usize, other: usize) -> f64 {
        f64::from(u8::from(self.is_own(place, other)))
    }

    #[inline(always)]
    fn four(&self, place: usize, others: &[u32; WIDTH]) -> Lanes4 {
        if self.labels.is_empty() || !self.starts.is_empty() {
            return self.four_by_one(place, others);
        }
        let mine = self.labels[place];
        let own = |other: u32| {
            let label = self.labels[other as usize];
            if label == mine || label == WALL { 1.0 } else { 0.0 }
        };
        let [a, b, c, d] = *others;
        Lanes4::load([own(a), own(b), own(c), own(d)])
    }
}

impl<const D: usize> Continua<D> {
    #[inline(never)]
    fn four_by_one(&self, place: usize, others: &[u32; WIDTH]) -> Lanes4 {
        Lanes4::load(others.map(|other| self.one(place, other as usize)))
    }
}
