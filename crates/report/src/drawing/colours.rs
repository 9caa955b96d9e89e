//! Colour maps, and the colours of curves.

use super::canvas::Colour;

/// How a value becomes a colour.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ColourMap {
    /// From dark violet over green to yellow.
    Sequential,
    /// From blue over grey to red, for ranges around 0.
    Diverging,
}

impl ColourMap {
    /// The map for `range`: diverging if it is as wide below 0 as above.
    pub fn for_range([low, high]: [f64; 2]) -> Self {
        if low == -high { Self::Diverging } else { Self::Sequential }
    }

    /// The colour at `place` of 0 to 1; outside, that of the nearer end.
    pub fn colour(self, place: f64) -> Colour {
        let place = place.clamp(0.0, 1.0);
        match self {
            Self::Sequential => viridis(place),
            Self::Diverging => cool_to_warm(place),
        }
    }
}

/// The perceptually uniform map viridis of S. van der Walt and N. Smith, by the fit of degree 6 of
/// M. Zucker (<https://www.shadertoy.com/view/WlfXRN>, CC0): each part is within 0.013 of the
/// table.
fn viridis(place: f64) -> Colour {
    const COEFFICIENTS: [[f64; 3]; 7] = [
        [0.2777273272234177, 0.005407344544966578, 0.3340998053353061],
        [0.1050930431085774, 1.404613529898575, 1.384590162594685],
        [-0.3308618287255563, 0.214847559468213, 0.09509516302823659],
        [-4.634230498983486, -5.799100973351585, -19.33244095627987],
        [6.228269936347081, 14.17993336680509, 56.69055260068105],
        [4.776384997670288, -13.74514537774601, -65.35303263337234],
        [-5.435455855934631, 4.645852612178535, 26.3124352495832],
    ];
    [0, 1, 2].map(|part| {
        let value = COEFFICIENTS.iter().rev().fold(0.0, |sum, term| sum * place + term[part]);
        to_byte(value)
    })
}

/// The diverging map of K. Moreland, Diverging Color Maps for Scientific Visualization, ISVC 2009:
/// straight lines in his polar form (M, s, h) of CIELAB, from blue and red to a grey of M = 88 in
/// the middle, where the hue turns as his section 5 asks for.
fn cool_to_warm(place: f64) -> Colour {
    const END: f64 = 80.0;
    const MIDDLE: f64 = 88.0;
    const SATURATION: f64 = 1.08;
    const BLUE: f64 = -1.1;
    const RED: f64 = 0.5;
    let turn = SATURATION * (MIDDLE * MIDDLE - END * END).sqrt() / (END * SATURATION.sin());
    // 1 at the ends, 0 in the middle.
    let far = (2.0 * place - 1.0).abs();
    // From the end of a hue above -60 degrees the hue turns onwards, else backwards.
    let hue = if place < 0.5 { BLUE - turn * (1.0 - far) } else { RED + turn * (1.0 - far) };
    let (length, saturation) = (MIDDLE + (END - MIDDLE) * far, SATURATION * far);
    let colourful = length * saturation.sin();
    lab_to_rgb(length * saturation.cos(), colourful * hue.cos(), colourful * hue.sin())
}

/// CIELAB with the white point D65 to sRGB (IEC 61966-2-1).
fn lab_to_rgb(light: f64, a: f64, b: f64) -> Colour {
    const D65: [f64; 3] = [0.95047, 1.0, 1.08883];
    let cubed = |value: f64| {
        if value > 6.0 / 29.0 { value.powi(3) } else { 108.0 / 841.0 * (value - 4.0 / 29.0) }
    };
    let middle = (light + 16.0) / 116.0;
    let [x, y, z] = [
        D65[0] * cubed(middle + a / 500.0),
        D65[1] * cubed(middle),
        D65[2] * cubed(middle - b / 200.0),
    ];
    let linear = [
        3.2406 * x - 1.5372 * y - 0.4986 * z,
        -0.9689 * x + 1.8758 * y + 0.0415 * z,
        0.0557 * x - 0.2040 * y + 1.0570 * z,
    ];
    linear.map(|part| {
        let bent =
            if part > 0.0031308 { 1.055 * part.powf(1.0 / 2.4) - 0.055 } else { 12.92 * part };
        to_byte(bent)
    })
}

fn to_byte(part: f64) -> u8 {
    // The cast saturates.
    (part * 255.0).round() as u8
}

/// The colours of M. Okabe and K. Ito (2008), told apart by readers of all kinds of sight; their
/// yellow is left out, which is faint on white.
pub const CURVES: [Colour; 7] = [
    [0, 114, 178],
    [213, 94, 0],
    [0, 158, 115],
    [204, 121, 167],
    [86, 180, 233],
    [230, 159, 0],
    [0, 0, 0],
];

#[cfg(test)]
mod tests {
    use super::*;

    /// The table's entries 0, 64, 128, 192 and 255, as published with matplotlib.
    #[test]
    fn viridis_is_the_published_table() {
        let table = [
            (0.0, [68, 1, 84]),
            (64.0 / 255.0, [59, 82, 139]),
            (128.0 / 255.0, [33, 145, 140]),
            (192.0 / 255.0, [94, 201, 98]),
            (1.0, [253, 231, 37]),
        ];
        for (place, expected) in table {
            let got = ColourMap::Sequential.colour(place);
            for (got, expected) in got.into_iter().zip(expected) {
                // 0.013 of 255, and the rounding of both.
                assert!(u8::abs_diff(got, expected) <= 4, "{place}: {got} for {expected}");
            }
        }
    }

    /// Moreland's table of 33 entries: its ends, quarters and middle.
    #[test]
    fn cool_to_warm_is_the_published_table() {
        let table = [
            (0.0, [59, 76, 192]),
            (0.25, [141, 176, 254]),
            (0.5, [221, 221, 221]),
            (0.75, [244, 154, 123]),
            (1.0, [180, 4, 38]),
        ];
        for (place, expected) in table {
            let got = ColourMap::Diverging.colour(place);
            for (got, expected) in got.into_iter().zip(expected) {
                assert!(u8::abs_diff(got, expected) <= 2, "{place}: {got} for {expected}");
            }
        }
    }

    #[test]
    fn any_value_has_a_colour() {
        for map in [ColourMap::Sequential, ColourMap::Diverging] {
            for place in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY, -1.0, 2.0] {
                map.colour(place);
            }
            assert_eq!(map.colour(-1.0), map.colour(0.0));
            assert_eq!(map.colour(2.0), map.colour(1.0));
        }
        assert_eq!(ColourMap::for_range([-2.0, 2.0]), ColourMap::Diverging);
        assert_eq!(ColourMap::for_range([-2.0, 3.0]), ColourMap::Sequential);
    }
}
