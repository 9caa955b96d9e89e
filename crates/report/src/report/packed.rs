//! Particle data made small enough for a page.
//!
//! A number becomes the upper three bytes of a 32-bit float: its relative error is below 1e-5, and
//! a particle that has flown off takes nothing from the others. The numbers of one component lie
//! together, first the most significant byte of all, then the next, then the last: neighbours in
//! memory are neighbours in space, so that zlib finds much to shorten.

use std::io::Write;

use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use flate2::Compression;
use flate2::write::ZlibEncoder;

use piola_physics::fields::is_absent;

/// Bytes of one number before zlib.
pub const BYTES_OF_NUMBER: usize = 3;

/// The upper three bytes of `value` as a 32-bit float, rounded to nearest; what is not finite is
/// not a number, and what particles do not have is less than all numbers.
fn rounded(value: f64) -> u32 {
    const ABSENT: u32 = 0xff_8000;
    const NOT_A_NUMBER: u32 = 0x7f_c000;
    const LARGEST: u32 = 0x7f_7fff;
    let single = value as f32;
    if !value.is_finite() {
        return if is_absent(value) { ABSENT } else { NOT_A_NUMBER };
    }
    let bits = single.to_bits();
    let sign = (bits >> 31) << 23;
    // The sign apart, so that rounding up a number carries into its exponent only.
    let size = ((bits & 0x7fff_ffff).saturating_add(0x80) >> 8).min(LARGEST);
    sign | size
}

/// Appends the bytes of `values`, plane by plane.
pub fn push(bytes: &mut Vec<u8>, values: impl Iterator<Item = f64> + Clone) {
    for shift in [16, 8, 0] {
        bytes.extend(values.clone().map(|value| (rounded(value) >> shift) as u8));
    }
}

/// `bytes` shortened by zlib, as text.
pub fn text(bytes: &[u8]) -> String {
    let mut encoder = ZlibEncoder::new(Vec::new(), Compression::default());
    let packed = encoder.write_all(bytes).and_then(|()| encoder.finish());
    STANDARD.encode(packed.expect("writing into memory cannot fail"))
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    /// As the page reads a number.
    fn read(bits: u32) -> f32 {
        f32::from_bits(bits << 8)
    }

    proptest! {
        #[test]
        fn numbers_keep_five_digits(value in any::<f64>()) {
            let got = f64::from(read(rounded(value)));
            if value.is_finite() && value.abs() < 3.39e38 {
                // Below the normal numbers of a single float the spacing is absolute.
                let allowed = (value.abs() * 2_f64.powi(-16)).max(1e-42);
                prop_assert!((got - value).abs() <= allowed, "{value} became {got}");
                prop_assert!(got.is_finite());
            }
        }
    }

    #[test]
    fn what_is_no_number_stays_none() {
        for value in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
            assert!(read(rounded(value)).is_nan());
        }
        assert_eq!(read(rounded(piola_physics::fields::ABSENT)), f32::NEG_INFINITY);
        // Finite, but beyond a single float: the largest one, not infinity.
        assert!(read(rounded(1e300)).is_finite() && read(rounded(1e300)) > 3.4e38);
        assert!(read(rounded(-1e300)).is_finite() && read(rounded(-1e300)) < -3.4e38);
        assert_eq!(read(rounded(-0.0)), 0.0);
        assert_eq!(read(rounded(1.0)), 1.0);
    }

    #[test]
    fn planes_follow_each_other() {
        let mut bytes = Vec::new();
        push(&mut bytes, [1.0, -2.0].into_iter());
        // 1 is 3f800000, -2 is c0000000.
        assert_eq!(bytes, [0x3f, 0xc0, 0x80, 0x00, 0x00, 0x00]);
    }
}
