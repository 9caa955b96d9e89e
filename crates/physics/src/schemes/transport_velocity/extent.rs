//! The box that something is in.

use crate::Vector;
use crate::neighbors::Domain;

/// A box along the axes; periodic axes have no ends.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Extent<const D: usize> {
    /// Its corners in m.
    pub low: Vector<D>,
    pub high: Vector<D>,
}

impl<const D: usize> Extent<D> {
    /// The smallest one around some places; nothing without any.
    pub fn around(mut places: impl Iterator<Item = Vector<D>>) -> Option<Self> {
        let first = places.next()?;
        Some(places.fold(Self { low: first, high: first }, |all, place| Self {
            low: all.low.inf(&place),
            high: all.high.sup(&place),
        }))
    }

    /// A larger one, by this many m on all sides.
    pub fn widened(&self, by: f64) -> Self {
        let by = Vector::repeat(by);
        Self { low: self.low - by, high: self.high + by }
    }

    /// Its longest side in m.
    pub fn length(&self) -> f64 {
        (self.high - self.low).max()
    }

    /// Whether a place is in it.
    pub fn contains(&self, place: &Vector<D>, domain: &Domain<D>) -> bool {
        let periodic = domain.periodic();
        let is_inside = |axis: usize| (self.low[axis]..=self.high[axis]).contains(&place[axis]);
        (0..D).all(|axis| periodic[axis].is_some() || is_inside(axis))
    }

    /// For how long in s what is at a place in it has been in it if its velocity was the same all the time.
    pub fn since(&self, place: &Vector<D>, velocity: &Vector<D>, domain: &Domain<D>) -> f64 {
        let ends =
            (0..D).filter(|axis| domain.periodic()[*axis].is_none() && velocity[*axis] != 0.0);
        let times = ends.map(|axis| {
            let end = if velocity[axis] > 0.0 { self.low[axis] } else { self.high[axis] };
            (place[axis] - end) / velocity[axis]
        });
        times.fold(f64::INFINITY, f64::min)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_in_a_box_came_in_through_the_side_that_it_passed_last() {
        let at = |x, y| Vector::<2>::new(x, y);
        let open = Domain::new([None; 2]).unwrap();
        let periodic = Domain::new([None, Some([0.0, 2.0])]).unwrap();
        let all = Extent::around([at(1.0, 0.5), at(0.25, 2.0), at(0.0, 0.0)].into_iter()).unwrap();
        assert_eq!(all, Extent { low: at(0.0, 0.0), high: at(1.0, 2.0) });
        assert_eq!(all.length(), 2.0);
        assert_eq!(all.widened(0.5), Extent { low: at(-0.5, -0.5), high: at(1.5, 2.5) });
        assert_eq!(Extent::<2>::around(std::iter::empty()), None);
        // From above a tenth of a second ago, from the left half a second ago.
        let (place, velocity) = (at(0.25, 1.9), at(0.5, -1.0));
        assert!((all.since(&place, &velocity, &open) - 0.1).abs() < 1e-15);
        assert_eq!(all.since(&place, &velocity, &periodic), 0.5);
        assert_eq!(all.since(&place, &at(0.0, 0.0), &open), f64::INFINITY);
        assert_eq!(all.since(&place, &at(-1.5, 0.0), &open), 0.5);
        let above = at(0.25, 2.1);
        assert!(all.contains(&place, &open) && !all.contains(&above, &open));
        assert!(all.contains(&above, &periodic) && !all.contains(&at(f64::NAN, 1.0), &open));
    }
}
