//! Layout of uncompressed frames, and their conversion to `f32`.
//!
//! RIFF: 8 bits are unsigned, more are signed and little-endian. QuickTime File Format, "Sound sample descriptions"; for `lpcm` the flags
//! of Core Audio's AudioStreamBasicDescription; for `ipcm` and `fpcm` ISO/IEC 23003-5. Companding: ITU-T G.711.

/// Number format of a sample.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum PcmKind {
    /// Two's complement.
    Signed,
    /// Offset binary.
    Unsigned,
    /// IEEE 754.
    Float,
    /// G.711 µ-law.
    MuLaw,
    /// G.711 A-law.
    ALaw,
}

/// The layout of interleaved PCM.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct PcmLayout {
    pub(crate) kind: PcmKind,
    pub(crate) is_little_endian: bool,
    /// Bytes of one sample of one channel: 1 to 4, for floats 4 or 8.
    pub(crate) sample_bytes: u8,
    /// Empty bits above the value: full scale is lower than that of the container by this number of bits. Zero for nearly every file.
    pub(crate) empty_high_bits: u8,
}

impl PcmLayout {
    /// Signed integers that fill their bytes. `None` for a width that no file uses.
    pub(crate) fn signed(sample_bytes: u8, is_little_endian: bool) -> Option<Self> {
        (1..=4).contains(&sample_bytes).then_some(Self {
            kind: PcmKind::Signed,
            is_little_endian,
            sample_bytes,
            empty_high_bits: 0,
        })
    }

    /// Offset binary of one byte.
    pub(crate) fn unsigned_8() -> Self {
        Self { kind: PcmKind::Unsigned, is_little_endian: false, sample_bytes: 1, empty_high_bits: 0 }
    }

    /// IEEE floats of 4 or 8 bytes.
    pub(crate) fn float(sample_bytes: u8, is_little_endian: bool) -> Option<Self> {
        matches!(sample_bytes, 4 | 8).then_some(Self {
            kind: PcmKind::Float,
            is_little_endian,
            sample_bytes,
            empty_high_bits: 0,
        })
    }

    /// A G.711 code, one byte per sample.
    pub(crate) fn companded(kind: PcmKind) -> Self {
        Self { kind, is_little_endian: false, sample_bytes: 1, empty_high_bits: 0 }
    }

    /// Name for people.
    pub(crate) fn name(&self) -> &'static str {
        match (self.kind, self.sample_bytes) {
            (PcmKind::MuLaw, _) => "mu-law",
            (PcmKind::ALaw, _) => "A-law",
            (PcmKind::Float, 8) => "64-bit float PCM",
            (PcmKind::Float, _) => "32-bit float PCM",
            (_, 1) => "8-bit PCM",
            (_, 2) => "16-bit PCM",
            (_, 3) => "24-bit PCM",
            _ => "32-bit PCM",
        }
    }

    /// Appends the samples in `bytes` to `out`, full scale at 1. A part of a sample at the end is left out.
    ///
    /// Integers are divided by 2^(bits - 1), so -1 is reached and +1 is not. 32-bit integers and 64-bit floats are
    /// rounded to the nearest `f32`.
    pub(crate) fn decode(&self, bytes: &[u8], out: &mut Vec<f32>) {
        match (self.kind, self.sample_bytes, self.is_little_endian) {
            (PcmKind::Unsigned, ..) => out.extend(bytes.iter().map(|b| (f32::from(*b) - 128.0) / 128.0)),
            (PcmKind::MuLaw, ..) => out.extend(bytes.iter().map(|b| f32::from(linear_from_mu_law(*b)) / 32_768.0)),
            (PcmKind::ALaw, ..) => out.extend(bytes.iter().map(|b| f32::from(linear_from_a_law(*b)) / 32_768.0)),
            (PcmKind::Float, 8, true) => extend(bytes, out, |b: [u8; 8]| f64::from_le_bytes(b) as f32),
            (PcmKind::Float, 8, false) => extend(bytes, out, |b: [u8; 8]| f64::from_be_bytes(b) as f32),
            (PcmKind::Float, _, true) => extend(bytes, out, f32::from_le_bytes),
            (PcmKind::Float, _, false) => extend(bytes, out, f32::from_be_bytes),
            // Integers are shifted to the top of 32 bits, so that one scale fits all of them.
            (PcmKind::Signed, 1, _) => self.extend_signed(bytes, out, |[a]: [u8; 1]| [a, 0, 0, 0]),
            (PcmKind::Signed, 2, true) => self.extend_signed(bytes, out, |[a, b]: [u8; 2]| [b, a, 0, 0]),
            (PcmKind::Signed, 2, false) => self.extend_signed(bytes, out, |[a, b]: [u8; 2]| [a, b, 0, 0]),
            (PcmKind::Signed, 3, true) => self.extend_signed(bytes, out, |[a, b, c]: [u8; 3]| [c, b, a, 0]),
            (PcmKind::Signed, 3, false) => self.extend_signed(bytes, out, |[a, b, c]: [u8; 3]| [a, b, c, 0]),
            (PcmKind::Signed, _, true) => self.extend_signed(bytes, out, |[a, b, c, d]: [u8; 4]| [d, c, b, a]),
            (PcmKind::Signed, _, false) => self.extend_signed(bytes, out, |bytes: [u8; 4]| bytes),
        }
    }

    fn extend_signed<const N: usize>(&self, bytes: &[u8], out: &mut Vec<f32>, widen: impl Fn([u8; N]) -> [u8; 4]) {
        let shift = u32::from(self.empty_high_bits.min(31));
        extend(bytes, out, |sample| (i32::from_be_bytes(widen(sample)) << shift) as f32 / 2_147_483_648.0);
    }
}

fn extend<const N: usize>(bytes: &[u8], out: &mut Vec<f32>, value: impl Fn([u8; N]) -> f32) {
    let (samples, _) = bytes.as_chunks::<N>();
    out.extend(samples.iter().map(|sample| value(*sample)));
}

/// ITU-T G.711 µ-law to 16 bits (the 14-bit value times 4).
fn linear_from_mu_law(code: u8) -> i16 {
    let code = !code;
    let magnitude = (((i16::from(code & 0x0f) << 3) + 0x84) << (code >> 4 & 7)) - 0x84;
    if code & 0x80 != 0 { -magnitude } else { magnitude }
}

/// ITU-T G.711 A-law to 16 bits (the 13-bit value times 8).
fn linear_from_a_law(code: u8) -> i16 {
    let code = code ^ 0x55;
    let step = i16::from(code & 0x0f) << 4;
    let magnitude = match code >> 4 & 7 {
        0 => step + 8,
        segment => (step + 0x108) << (segment - 1),
    };
    if code & 0x80 != 0 { magnitude } else { -magnitude }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn decoded(layout: PcmLayout, bytes: &[u8]) -> Vec<f32> {
        let mut out = Vec::new();
        layout.decode(bytes, &mut out);
        out
    }

    #[test]
    fn every_width_and_byte_order() {
        let half = |bytes: u8, little: bool| PcmLayout::signed(bytes, little).unwrap();
        assert_eq!(decoded(half(1, false), &[0x40, 0x80, 0xff]), [0.5, -1.0, -1.0 / 128.0]);
        assert_eq!(decoded(half(2, false), &[0x40, 0x00, 0x80, 0x00]), [0.5, -1.0]);
        assert_eq!(decoded(half(2, true), &[0x00, 0x40, 0x01, 0x00]), [0.5, 1.0 / 32_768.0]);
        assert_eq!(decoded(half(3, false), &[0x12, 0x34, 0x56]), [1_193_046.0 / 8_388_608.0]);
        assert_eq!(decoded(half(3, true), &[0x56, 0x34, 0x12]), [1_193_046.0 / 8_388_608.0]);
        assert_eq!(decoded(half(4, false), &[0xc0, 0, 0, 0]), [-0.5]);
        assert_eq!(decoded(half(4, true), &[0, 0, 0, 0xc0]), [-0.5]);
        assert_eq!(decoded(PcmLayout::unsigned_8(), &[0, 128, 192]), [-1.0, 0.0, 0.5]);
        assert_eq!(decoded(PcmLayout::float(4, true).unwrap(), &0.3_f32.to_le_bytes()), [0.3]);
        assert_eq!(decoded(PcmLayout::float(4, false).unwrap(), &0.3_f32.to_be_bytes()), [0.3]);
        assert_eq!(decoded(PcmLayout::float(8, true).unwrap(), &0.3_f64.to_le_bytes()), [0.3]);
        assert_eq!(decoded(PcmLayout::float(8, false).unwrap(), &0.3_f64.to_be_bytes()), [0.3]);
        assert_eq!(
            (PcmLayout::signed(5, true), PcmLayout::signed(0, true), PcmLayout::float(3, true)),
            (None, None, None)
        );
    }

    #[test]
    fn twenty_four_bits_at_the_bottom_of_thirty_two() {
        let low = PcmLayout { empty_high_bits: 8, ..PcmLayout::signed(4, true).unwrap() };
        assert_eq!(decoded(low, &[0x00, 0x00, 0x40, 0x00, 0x00, 0x00, 0xc0, 0xff]), [0.5, -0.5]);
    }

    #[test]
    fn companding_tables_at_their_ends_and_middles() {
        // G.711 tables 1a to 2b, scaled to 16 bits.
        let mu = [
            (0x00, -32_124),
            (0x80, 32_124),
            (0x7f, 0),
            (0xff, 0),
            (0xfe, 8),
            (0xf0, 120),
            (0xef, 132),
            (0x0f, -16_764),
        ];
        for (code, value) in mu {
            assert_eq!(linear_from_mu_law(code), value, "µ-law {code:#x}");
        }
        let a = [(0xd5, 8), (0x55, -8), (0xaa, 32_256), (0x2a, -32_256), (0xc5, 264), (0xda, 248)];
        for (code, value) in a {
            assert_eq!(linear_from_a_law(code), value, "A-law {code:#x}");
        }
        for code in 0..=255 {
            linear_from_mu_law(code);
            linear_from_a_law(code);
        }
    }

    #[test]
    fn a_part_of_a_sample_is_left_out() {
        assert_eq!(decoded(PcmLayout::signed(3, false).unwrap(), &[0x40, 0, 0, 0x40, 0]), [0.5]);
    }
}
