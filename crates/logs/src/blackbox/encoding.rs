//! How the values of a frame are written (`blackbox-tools`, `decoders.c`).

/// Largest number of values in a frame.
pub(super) const FIELDS_MAX: usize = 256;
/// Numbers of one byte that are decoded at once.
const NUMBERS_AT_ONCE: usize = 4;
/// The bit of each of their bytes that says that another byte follows.
const LONG_NUMBERS: u32 = 0x8080_8080;

/// A place in the bytes of a frame.
#[derive(Clone, Copy)]
pub(super) struct Cursor<'a> {
    bytes: &'a [u8],
    at: usize,
}

impl<'a> Cursor<'a> {
    pub(super) fn new(bytes: &'a [u8]) -> Self {
        Self { bytes, at: 0 }
    }

    /// Number of bytes that lie behind.
    pub(super) fn at(&self) -> usize {
        self.at
    }

    #[inline]
    pub(super) fn byte(&mut self) -> Option<u8> {
        let byte = *self.bytes.get(self.at)?;
        self.at += 1;
        Some(byte)
    }

    pub(super) fn skip(&mut self, count: usize) -> Option<()> {
        self.at += count;
        (self.at <= self.bytes.len()).then_some(())
    }

    /// Seven bits a byte, the lowest first; the highest bit says that another byte follows.
    #[inline]
    pub(super) fn unsigned(&mut self) -> Option<u32> {
        let first = self.byte()?;
        if first < 0x80 {
            return Some(u32::from(first));
        }
        let mut value = u32::from(first & 0x7f);
        for shift in [7, 14, 21, 28] {
            let byte = self.byte()?;
            value |= u32::from(byte & 0x7f) << shift;
            if byte < 0x80 {
                return Some(value);
            }
        }
        // no number has more than five bytes
        None
    }

    /// The same for numbers with a sign: 0, −1, 1, −2, …
    #[inline]
    pub(super) fn signed(&mut self) -> Option<i32> {
        self.unsigned().map(with_folded_sign)
    }

    /// The next bytes, if each of them is a number; `None` where a number is longer, or where the bytes end.
    #[inline]
    fn bytes_of_one_number_each(&mut self) -> Option<[u8; NUMBERS_AT_ONCE]> {
        let bytes = *self.bytes.get(self.at..)?.first_chunk()?;
        let has_long = u32::from_le_bytes(bytes) & LONG_NUMBERS != 0;
        (!has_long).then(|| {
            self.at += NUMBERS_AT_ONCE;
            bytes
        })
    }

    /// Bytes of a number, the lowest first, with its sign.
    fn little_endian(&mut self, count: u32) -> Option<i32> {
        let mut value = 0;
        for at in 0..count {
            value |= u32::from(self.byte()?) << (8 * at);
        }
        Some(with_sign(value, 8 * count))
    }
}

/// The number that was written as 0, −1, 1, −2, …
#[inline]
fn with_folded_sign(value: u32) -> i32 {
    (value >> 1).cast_signed() ^ -(value & 1).cast_signed()
}

/// A number of `bits` bits with its sign.
fn with_sign(value: u32, bits: u32) -> i32 {
    let unused_bits = 32 - bits;
    (value << unused_bits).cast_signed() >> unused_bits
}

/// How one or several values are written.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Encoding {
    /// Numbers with a sign, one after the other.
    Signed {
        count: usize,
    },
    Unsigned,
    /// The negative of a number of 14 bits.
    Negative14,
    /// Up to 8 values of which only those are written that are not 0.
    Nonzero {
        count: usize,
    },
    /// Three values of 2, 4, 6 or 8 to 32 bits.
    Three,
    /// Three values of 2 bits, 5, 5 and 4, 8, 7 and 7, or 8 to 32 bits.
    ThreeOfOwnWidth,
    /// Four values of 0, 4, 8 or 16 bits.
    Four,
    Nothing,
}

/// How the values of a frame are written, one after the other.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct FrameLayout {
    encodings: Vec<Encoding>,
    field_count: usize,
}

impl FrameLayout {
    /// From the numbers of the encodings in the header; `None` for an unknown one, or for too many.
    pub(super) fn of(numbers: &[u32]) -> Option<Self> {
        if numbers.len() > FIELDS_MAX {
            return None;
        }
        let mut encodings = Vec::new();
        let mut at = 0;
        while let Some(&number) = numbers.get(at) {
            let (encoding, count) = match number {
                0 => {
                    let count = numbers[at..].iter().take_while(|next| **next == 0).count();
                    (Encoding::Signed { count }, count)
                }
                1 => (Encoding::Unsigned, 1),
                3 => (Encoding::Negative14, 1),
                6 => match numbers[at..].iter().take(8).take_while(|next| **next == 6).count() {
                    1 => (Encoding::Signed { count: 1 }, 1),
                    count => (Encoding::Nonzero { count }, count),
                },
                7 => (Encoding::Three, 3),
                8 => (Encoding::Four, 4),
                9 => (Encoding::Nothing, 1),
                10 => (Encoding::ThreeOfOwnWidth, 3),
                _ => return None,
            };
            encodings.push(encoding);
            at += count;
        }
        Some(Self { encodings, field_count: numbers.len() })
    }

    pub(super) fn field_count(&self) -> usize {
        self.field_count
    }

    /// Number of bytes of the values here, if they are complete.
    pub(super) fn size_at(&self, bytes: &[u8]) -> Option<usize> {
        self.decode(bytes, &mut [0; FIELDS_MAX])
    }

    /// Decodes the values here; returns the number of their bytes. `into` has room for all values.
    pub(super) fn decode(&self, bytes: &[u8], into: &mut [i32]) -> Option<usize> {
        let mut cursor = Cursor::new(bytes);
        let mut at = 0;
        for encoding in &self.encodings {
            let value = match *encoding {
                Encoding::Unsigned => cursor.unsigned()?.cast_signed(),
                Encoding::Nothing => 0,
                Encoding::Negative14 => -with_sign(cursor.unsigned()? & 0x3fff, 14),
                group => {
                    let room = into.get_mut(at..)?;
                    at += match group {
                        Encoding::Signed { count } => several_signed(&mut cursor, room.get_mut(..count)?)?,
                        Encoding::Nonzero { count } => nonzero(&mut cursor, room.get_mut(..count)?)?,
                        Encoding::Four => put(room, four(&mut cursor)?),
                        _ => put(room, three(&mut cursor, group == Encoding::ThreeOfOwnWidth)?),
                    };
                    continue;
                }
            };
            *into.get_mut(at)? = value;
            at += 1;
        }
        Some(cursor.at())
    }
}

/// Puts values where there is room; at the end of a frame there may be none for the last ones.
fn put<const COUNT: usize>(room: &mut [i32], values: [i32; COUNT]) -> usize {
    match room.first_chunk_mut() {
        Some(places) => *places = values,
        None => room.iter_mut().zip(values).for_each(|(place, value)| *place = value),
    }
    COUNT
}

/// Numbers with a sign. Most have one byte each: then four bytes are four numbers.
fn several_signed(cursor: &mut Cursor, room: &mut [i32]) -> Option<usize> {
    let count = room.len();
    let (fours, rest) = room.as_chunks_mut::<NUMBERS_AT_ONCE>();
    for four in fours {
        match cursor.bytes_of_one_number_each() {
            Some(bytes) => *four = bytes.map(|byte| with_folded_sign(u32::from(byte))),
            None => four.iter_mut().try_for_each(|place| cursor.signed().map(|value| *place = value))?,
        }
    }
    rest.iter_mut().try_for_each(|place| cursor.signed().map(|value| *place = value))?;
    Some(count)
}

fn nonzero(cursor: &mut Cursor, room: &mut [i32]) -> Option<usize> {
    let which = cursor.byte()?;
    for (bit, place) in room.iter_mut().enumerate() {
        *place = if which >> bit & 1 == 1 { cursor.signed()? } else { 0 };
    }
    Some(room.len())
}

fn three(cursor: &mut Cursor, has_own_widths: bool) -> Option<[i32; 3]> {
    let lead = u32::from(cursor.byte()?);
    Some(match (lead >> 6, has_own_widths) {
        (0, _) => [with_sign(lead >> 4 & 3, 2), with_sign(lead >> 2 & 3, 2), with_sign(lead & 3, 2)],
        (1, false) => {
            let next = u32::from(cursor.byte()?);
            [with_sign(lead & 0xf, 4), with_sign(next >> 4, 4), with_sign(next & 0xf, 4)]
        }
        (1, true) => {
            let all = lead << 8 | u32::from(cursor.byte()?);
            [with_sign(all >> 9 & 0x1f, 5), with_sign(all >> 4 & 0x1f, 5), with_sign(all & 0xf, 4)]
        }
        (2, false) => {
            let next = [u32::from(cursor.byte()?), u32::from(cursor.byte()?)];
            [lead, next[0], next[1]].map(|value| with_sign(value & 0x3f, 6))
        }
        (2, true) => {
            let all = lead << 16 | u32::from(cursor.byte()?) << 8 | u32::from(cursor.byte()?);
            [with_sign(all >> 14 & 0xff, 8), with_sign(all >> 7 & 0x7f, 7), with_sign(all & 0x7f, 7)]
        }
        _ => {
            let mut values = [0; 3];
            for (at, value) in values.iter_mut().enumerate() {
                *value = cursor.little_endian(1 + (lead >> (2 * at) & 3))?;
            }
            values
        }
    })
}

/// Values of whole half bytes, the higher half first: a value of 8 or 16 bits may begin in the middle of a byte.
fn four(cursor: &mut Cursor) -> Option<[i32; 4]> {
    let tags = cursor.byte()?;
    let mut values = [0; 4];
    if tags == 0 {
        return Some(values);
    }
    let (mut kept, mut is_half_kept) = (0, false);
    for (at, value) in values.iter_mut().enumerate() {
        let halves = [0, 1, 2, 4][usize::from(tags >> (2 * at) & 3)];
        let mut bits = 0;
        for _ in 0..halves {
            let half = if is_half_kept {
                kept & 0xf
            } else {
                kept = cursor.byte()?;
                kept >> 4
            };
            is_half_kept = !is_half_kept;
            bits = bits << 4 | u32::from(half);
        }
        if halves > 0 {
            *value = with_sign(bits, 4 * halves);
        }
    }
    Some(values)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn decoded(numbers: &[u32], bytes: &[u8]) -> Option<(Vec<i32>, usize)> {
        let layout = FrameLayout::of(numbers)?;
        let mut into = vec![0; layout.field_count()];
        let size = layout.decode(bytes, &mut into)?;
        Some((into, size))
    }

    #[test]
    fn each_encoding_as_blackbox_tools_writes_it() {
        for (numbers, bytes, values) in [
            (&[1][..], &[0xac, 0x02][..], &[300][..]),
            (&[0, 0], &[0x01, 0x04], &[-1, 2]),
            (&[0], &[0xff, 0xff, 0xff, 0xff, 0x0f], &[i32::MIN]),
            (&[3], &[0x05], &[-5]),
            (&[6, 6, 6], &[0b101, 0x03, 0x02], &[-2, 0, 1]),
            (&[6, 1], &[0x02, 0x07], &[1, 7]),
            (&[7, 7, 7], &[0b0001_1011], &[1, -2, -1]),
            (&[7, 7, 7], &[0x47, 0x81], &[7, -8, 1]),
            (&[7, 7, 7], &[0x9f, 0x20, 0x01], &[31, -32, 1]),
            (&[7, 7, 7], &[0xc0 | 0b10_01_00, 0xff, 0x01, 0x80, 0x01, 0x00, 0x80], &[-1, -32_767, -8_388_607]),
            (&[10, 10, 10], &[0x40 | 0b01_1111, 0b0000_0111], &[15, -16, 7]),
            (&[10, 10, 10], &[0x80 | 0b01_1111, 0b11_000000, 0b1_1111111], &[127, 1, -1]),
            (&[8, 8, 8, 8], &[0b11_10_01_00, 0x71, 0x23, 0x45, 0x60], &[0, 7, 0x12, 0x3456]),
            (&[9, 1], &[0x03], &[0, 3]),
            // the group has room for two of its three values
            (&[7, 7], &[0b0001_1011], &[1, -2]),
        ] {
            assert_eq!(decoded(numbers, bytes), Some((values.to_vec(), bytes.len())), "{numbers:?} {bytes:?}");
            let cut = decoded(numbers, &bytes[..bytes.len() - 1]);
            assert_eq!(cut, None, "{numbers:?} {bytes:?}");
        }
    }

    #[test]
    fn what_has_no_meaning_is_nothing() {
        assert_eq!(FrameLayout::of(&[2]), None);
        assert_eq!(FrameLayout::of(&[1; FIELDS_MAX + 1]), None);
        assert_eq!(decoded(&[1], &[0xff; 6]), None);
    }
}
