//! Numbers at fixed places of a message, little-endian.

use crate::table::RowValues;

/// Type of a number in a message.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Scalar {
    Int(usize),
    UInt(usize),
    /// Two bytes, IEEE 754.
    Half,
    Float,
    Double,
}

impl Scalar {
    /// Number of its bytes.
    pub(crate) fn size(self) -> usize {
        match self {
            Self::Int(size) | Self::UInt(size) => size,
            Self::Half => 2,
            Self::Float => 4,
            Self::Double => 8,
        }
    }
}

/// Position and type of a number, and the unit of the signal per unit of the message.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Place {
    pub(crate) offset: usize,
    pub(crate) scalar: Scalar,
    pub(crate) factor: f64,
}

impl Place {
    pub(crate) fn plain(offset: usize, scalar: Scalar) -> Self {
        Self { offset, scalar, factor: 1.0 }
    }

    /// The number at this position; `None` behind the end.
    pub(crate) fn read(self, message: &[u8]) -> Option<f64> {
        let size = self.scalar.size();
        let found = message.get(self.offset..self.offset + size)?;
        let mut bytes = [0; 8];
        bytes[..size].copy_from_slice(found);
        let unsigned = u64::from_le_bytes(bytes);
        let number = match self.scalar {
            Scalar::UInt(_) => unsigned as f64,
            Scalar::Int(size) => {
                let unused_bits = 64 - 8 * size;
                (((unsigned << unused_bits) as i64) >> unused_bits) as f64
            }
            Scalar::Half => from_half(unsigned as u16),
            Scalar::Float => f64::from(f32::from_bits(unsigned as u32)),
            Scalar::Double => f64::from_bits(unsigned),
        };
        Some(self.factor * number)
    }
}

/// A number of two bytes: sign, 5 bits of exponent, 10 bits of fraction.
fn from_half(bits: u16) -> f64 {
    let sign = if bits >> 15 == 1 { -1.0 } else { 1.0 };
    let fraction = f64::from(bits & 0x3ff) / 1024.0;
    match i32::from(bits >> 10 & 0x1f) {
        0 => sign * fraction * 2f64.powi(-14),
        31 if fraction > 0.0 => f64::NAN,
        31 => sign * f64::INFINITY,
        exponent => sign * (1.0 + fraction) * 2f64.powi(exponent - 15),
    }
}

/// A message and the places of its signals.
pub(crate) struct PackedRow<'a> {
    pub(crate) message: &'a [u8],
    pub(crate) places: &'a [Place],
}

impl RowValues for PackedRow<'_> {
    fn value(&self, signal: usize) -> f64 {
        self.places.get(signal).and_then(|place| place.read(self.message)).unwrap_or(f64::NAN)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_of_all_types() {
        let read = |scalar: Scalar, bytes: &[u8]| Place::plain(0, scalar).read(bytes);
        assert_eq!(read(Scalar::Int(2), &[0xfe, 0xff]), Some(-2.0));
        assert_eq!(read(Scalar::UInt(2), &[0xfe, 0xff]), Some(65_534.0));
        assert_eq!(read(Scalar::Float, &1.5f32.to_le_bytes()), Some(1.5));
        assert_eq!(read(Scalar::Double, &(-2.25f64).to_le_bytes()), Some(-2.25));
        for (bits, number) in [(0x3c00, 1.0), (0xc000, -2.0), (0x3555, 0.333_251_953_125), (0x0001, 2f64.powi(-24))] {
            assert_eq!(read(Scalar::Half, &u16::to_le_bytes(bits)), Some(number));
        }
        assert_eq!(read(Scalar::Double, &[0; 7]), None);
        assert_eq!(Place { offset: 1, scalar: Scalar::UInt(1), factor: 0.5 }.read(&[0, 7]), Some(3.5));
    }
}
