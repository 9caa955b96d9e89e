//! Mirror images of particles beyond the planes that end a body.

use super::reference::PlaneData;
use crate::Vector;

/// Particles nearer to a plane than this share of their spacing lie on it and have no image there.
const ON_PLANE: f64 = 1e-6;

/// What a field is beyond a plane where it is known on this side, with a datum d of the plane.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Continuation {
    /// `f(x') = 2 d - f(x)`: it has the value d on the plane.
    Odd,
    /// `f(x') = f(x)`: its slope across the plane is zero.
    Even,
    /// `f(x') = f(x) + (x' - x) d`: its slope across the plane, along the axis, is d.
    Slope,
}

/// A plane across an axis that ends a body.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Mirror {
    /// 0, 1 or 2 for x, y or z.
    pub axis: usize,
    /// Where it cuts the axis, in m.
    pub place: f64,
    /// Whether the body lies below it on the axis.
    pub is_upper: bool,
    /// How the component of a field along the axis goes on beyond it. Other components go on evenly.
    pub continuation: Continuation,
}

/// A ghost of a particle.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Image<const D: usize> {
    /// The particle that it mirrors, by index in memory.
    pub source: u32,
    /// Where it is, in m.
    pub position: Vector<D>,
    /// What the components of the source's field are multiplied with.
    pub sign: [f64; D],
    /// What the data of the lower and the upper plane of each axis add to the component along it.
    pub data: [[f64; 2]; D],
}

impl<const D: usize> Image<D> {
    /// What data of planes add to each component.
    pub fn carried(&self, data: &PlaneData<D>) -> Vector<D> {
        let of = |axis: usize| -> f64 {
            self.data[axis].iter().zip(&data[axis]).map(|(share, datum)| share * datum).sum()
        };
        Vector::from_fn(|axis, _| of(axis))
    }
}

/// One axis of an image.
#[derive(Clone, Copy)]
struct Part {
    place: f64,
    sign: f64,
    data: [f64; 2],
}

impl Part {
    /// The part reflected once more.
    fn reflected(self, mirror: &Mirror) -> Self {
        let place = 2.0 * mirror.place - self.place;
        let side = usize::from(mirror.is_upper);
        let mut next = Self { place, ..self };
        match mirror.continuation {
            Continuation::Odd => {
                next.sign = -next.sign;
                next.data = next.data.map(|entry| -entry);
                next.data[side] += 2.0;
            }
            Continuation::Even => {}
            Continuation::Slope => next.data[side] += place - self.place,
        }
        next
    }
}

/// The images of particles at `positions`, with spacings in m, that lie within `reach` m beyond one
/// of the planes; of two planes across an axis those of images, too. At most one lower and one upper
/// plane an axis counts, the last of each.
pub fn images<const D: usize>(
    positions: &[Vector<D>],
    spacing: &[f64],
    mirrors: &[Mirror],
    reach: f64,
) -> Vec<Image<D>> {
    let plane = |axis: usize, is_upper: bool| {
        mirrors.iter().rfind(|mirror| mirror.axis == axis && mirror.is_upper == is_upper)
    };
    let mut all = Vec::new();
    for (source, (position, spacing)) in (0u32..).zip(positions.iter().zip(spacing)) {
        let mut made =
            vec![Image { source, position: *position, sign: [1.0; D], data: [[0.0; 2]; D] }];
        for axis in 0..D {
            let ends = [plane(axis, false), plane(axis, true)];
            let parts = parts(position[axis], ON_PLANE * spacing, ends, reach);
            let before = made.len();
            for part in parts {
                for index in 0..before {
                    let mut image = made[index];
                    image.position[axis] = part.place;
                    image.sign[axis] = part.sign;
                    image.data[axis] = part.data;
                    made.push(image);
                }
            }
        }
        all.extend_from_slice(&made[1..]);
    }
    all
}

/// The images of a place on an axis with a lower and an upper plane, without the place itself.
fn parts(place: f64, slack: f64, ends: [Option<&Mirror>; 2], reach: f64) -> Vec<Part> {
    let mut all = Vec::new();
    let is_near = |place: f64| {
        let beyond = |mirror: &&Mirror| match mirror.is_upper {
            true => place - mirror.place,
            false => mirror.place - place,
        };
        ends.iter().flatten().map(beyond).all(|distance| distance < reach)
    };
    for first in 0..2 {
        let mut part = Part { place, sign: 1.0, data: [0.0; 2] };
        let mut turn = first;
        while let Some(mirror) = ends[turn] {
            let next = part.reflected(mirror);
            let stays = (next.place - part.place).abs() <= 2.0 * slack;
            if stays || !is_near(next.place) {
                break;
            }
            all.push(next);
            part = next;
            turn = 1 - turn;
        }
    }
    all
}

#[cfg(test)]
mod tests {
    use super::*;

    const fn mirror(axis: usize, place: f64, is_upper: bool, continuation: Continuation) -> Mirror {
        Mirror { axis, place, is_upper, continuation }
    }

    /// Five particles between two planes, seen as far as three lengths away: a full lattice.
    #[test]
    fn repeated_images_continue_a_lattice_without_gaps() {
        let positions: Vec<Vector<1>> = (0..5).map(|k| Vector::from([f64::from(k)])).collect();
        let mirrors =
            [mirror(0, 0.0, false, Continuation::Odd), mirror(0, 4.0, true, Continuation::Even)];
        let made = images(&positions, &[1.0; 5], &mirrors, 12.5);
        let mut places: Vec<f64> = positions
            .iter()
            .map(|x| x[0])
            .chain(made.iter().map(|image| image.position[0]))
            .collect();
        places.sort_by(f64::total_cmp);
        let expected: Vec<f64> = (-12..=16).map(f64::from).collect();
        assert_eq!(places, expected);
    }

    /// A field that is known everywhere is what its images say.
    #[test]
    fn images_carry_on_the_fields_they_belong_to() {
        // Odd about 3 at x = 0, slope 2 at x = 1: f = 3 + 2x is both.
        let mirrors =
            [mirror(0, 0.0, false, Continuation::Odd), mirror(0, 1.0, true, Continuation::Slope)];
        let f = |x: f64| 3.0 + 2.0 * x;
        let positions: Vec<Vector<2>> =
            (0..=4).map(|k| Vector::from([0.25 * f64::from(k), 7.0])).collect();
        let made = images(&positions, &[0.25; 5], &mirrors, 2.6);
        assert!(made.len() > 15);
        for image in made {
            let own = f(positions[image.source as usize][0]);
            let value = image.sign[0] * own + image.data[0][0] * 3.0 + image.data[0][1] * 2.0;
            assert!((value - f(image.position[0])).abs() < 1e-12, "{image:?}");
            assert_eq!((image.sign[1], image.position[1]), (1.0, 7.0));
        }
    }

    #[test]
    fn a_corner_has_images_in_all_quadrants() {
        let mirrors =
            [mirror(0, 0.0, false, Continuation::Odd), mirror(1, 0.0, false, Continuation::Odd)];
        let made = images(&[Vector::from([0.1, 0.2])], &[0.1], &mirrors, 1.0);
        let signs: Vec<_> = made.iter().map(|image| (image.position.into(), image.sign)).collect();
        let expected: [([f64; 2], [f64; 2]); 3] =
            [([-0.1, 0.2], [-1.0, 1.0]), ([0.1, -0.2], [1.0, -1.0]), ([-0.1, -0.2], [-1.0, -1.0])];
        assert_eq!(signs, expected);
        assert!(images(&[Vector::from([0.0, 0.0])], &[0.1], &mirrors, 1.0).is_empty());
    }
}
