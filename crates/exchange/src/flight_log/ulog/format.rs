//! Layout of the messages of a ULog: from "uint64_t timestamp;float[3] xyz" to the byte of a value.

use std::collections::HashMap;

/// Deepest nesting of types. `esc_status` contains `esc_report`, and no topic of PX4 nests deeper.
const NESTING_MAX: usize = 4;
/// Largest length of a message, which two bytes hold.
const SIZE_MAX: usize = u16::MAX as usize;

/// Type of a number in a message.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Scalar {
    Int(usize),
    UInt(usize),
    Float,
    Double,
}

impl Scalar {
    fn of(name: &str) -> Option<Self> {
        Some(match name {
            "int8_t" => Self::Int(1),
            "int16_t" => Self::Int(2),
            "int32_t" => Self::Int(4),
            "int64_t" => Self::Int(8),
            "uint8_t" | "bool" | "char" => Self::UInt(1),
            "uint16_t" => Self::UInt(2),
            "uint32_t" => Self::UInt(4),
            "uint64_t" => Self::UInt(8),
            "float" => Self::Float,
            "double" => Self::Double,
            _ => return None,
        })
    }

    fn size(self) -> usize {
        match self {
            Self::Int(size) | Self::UInt(size) => size,
            Self::Float => 4,
            Self::Double => 8,
        }
    }
}

/// Position and type of a number.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Place {
    offset: usize,
    scalar: Scalar,
}

impl Place {
    /// The little-endian number at this position; `None` behind the end.
    pub(super) fn read(self, message: &[u8]) -> Option<f64> {
        let size = self.scalar.size();
        let found = message.get(self.offset..self.offset + size)?;
        let mut bytes = [0; 8];
        bytes[..size].copy_from_slice(found);
        let unsigned = u64::from_le_bytes(bytes);
        Some(match self.scalar {
            Scalar::UInt(_) => unsigned as f64,
            Scalar::Int(size) => {
                let unused_bits = 64 - 8 * size;
                (((unsigned << unused_bits) as i64) >> unused_bits) as f64
            }
            Scalar::Float => f64::from(f32::from_bits(unsigned as u32)),
            Scalar::Double => f64::from_bits(unsigned),
        })
    }
}

struct Field {
    type_name: String,
    /// Number of elements, for an array.
    length: Option<usize>,
    name: String,
}

impl Field {
    /// Parses "float[3] xyz".
    fn parse(text: &str) -> Option<Self> {
        let (declared, name) = text.split_once(' ')?;
        let (type_name, length) = match declared.split_once('[') {
            // arrays of length 0 are refused: they take no room, so the limit of a message's length would not bound their number
            Some((type_name, length)) => {
                (type_name, Some(length.strip_suffix(']')?.parse().ok().filter(|length| *length > 0)?))
            }
            None => (declared, None),
        };
        Some(Self { type_name: type_name.to_owned(), length, name: name.to_owned() })
    }

    fn is_padding(&self) -> bool {
        self.name.starts_with("_padding")
    }
}

/// All layouts of a log.
#[derive(Default)]
pub(super) struct Formats {
    fields: HashMap<String, Vec<Field>>,
}

impl Formats {
    /// Adds "name:type field;type field;". Invalid text is ignored.
    pub(super) fn add(&mut self, text: &str) {
        let Some((name, fields)) = text.split_once(':') else { return };
        let parts = fields.split(';').filter(|part| !part.is_empty());
        if let Some(fields) = parts.map(Field::parse).collect::<Option<Vec<Field>>>() {
            self.fields.insert(name.to_owned(), fields);
        }
    }

    /// Possible lengths of a message, with and without the padding at its end.
    pub(super) fn sizes(&self, message: &str) -> Option<(usize, usize)> {
        let fields = self.fields.get(message)?;
        let whole = self.size_of(message, 0)?;
        let padding = match fields.last().filter(|last| last.is_padding()) {
            Some(last) => self.size_of_field(last, 0)?,
            None => 0,
        };
        Some((whole - padding, whole))
    }

    /// Position of a value such as "xyz[2]" or "esc[3].esc_rpm".
    pub(super) fn place(&self, message: &str, path: &str) -> Option<Place> {
        let (mut message, mut path, mut offset) = (message, path, 0);
        for _ in 0..=NESTING_MAX {
            let (step, rest) = path.split_once('.').map_or((path, None), |(step, rest)| (step, Some(rest)));
            let (name, index) = match step.split_once('[') {
                Some((name, index)) => (name, Some(index.strip_suffix(']')?.parse::<usize>().ok()?)),
                None => (step, None),
            };
            let fields = self.fields.get(message)?;
            let at = fields.iter().position(|field| field.name == name)?;
            for field in &fields[..at] {
                offset += self.size_of_field(field, 0)?;
            }
            let field = &fields[at];
            if index.is_some() != field.length.is_some() || index.unwrap_or(0) >= field.length.unwrap_or(1) {
                return None;
            }
            offset += index.unwrap_or(0) * self.size_of(&field.type_name, 0)?;
            match rest {
                Some(rest) => (message, path) = (&field.type_name, rest),
                None => return Some(Place { offset, scalar: Scalar::of(&field.type_name)? }),
            }
        }
        None
    }

    fn size_of_field(&self, field: &Field, depth: usize) -> Option<usize> {
        let size = self.size_of(&field.type_name, depth)?.checked_mul(field.length.unwrap_or(1))?;
        (size <= SIZE_MAX).then_some(size)
    }

    fn size_of(&self, type_name: &str, depth: usize) -> Option<usize> {
        if let Some(scalar) = Scalar::of(type_name) {
            return Some(scalar.size());
        }
        let fields = self.fields.get(type_name).filter(|_| depth < NESTING_MAX)?;
        let size = fields.iter().try_fold(0, |sum, field| {
            let sum = sum + self.size_of_field(field, depth + 1)?;
            (sum <= SIZE_MAX).then_some(sum)
        });
        size.filter(|size| *size > 0)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn formats() -> Formats {
        let mut formats = Formats::default();
        formats.add("esc_report:uint64_t timestamp;int32_t esc_rpm;uint8_t[4] _padding0;");
        formats.add("esc_status:uint64_t timestamp;uint16_t counter;esc_report[8] esc;uint8_t[2] _padding0;");
        formats.add("loop:loop[2] again;");
        formats.add("broken:float");
        formats.add("empty:");
        formats.add("of_empty:empty[9] a;float[0] b;");
        formats
    }

    #[test]
    fn values_are_found_through_arrays_and_nested_types() {
        let formats = formats();
        // padding at the end of a nested type counts; at the end of the message it can be missing
        assert_eq!(formats.sizes("esc_status"), Some((8 + 2 + 8 * 16, 8 + 2 + 8 * 16 + 2)));
        let place = formats.place("esc_status", "esc[3].esc_rpm").unwrap();
        assert_eq!(place, Place { offset: 10 + 3 * 16 + 8, scalar: Scalar::Int(4) });
        let mut message = vec![0; 138];
        message[66..70].copy_from_slice(&(-1500_i32).to_le_bytes());
        assert_eq!(place.read(&message), Some(-1500.0));
        assert_eq!(place.read(&message[..69]), None);
    }

    #[test]
    fn what_is_not_there_or_has_no_end_is_nothing() {
        let formats = formats();
        for path in ["esc", "esc[8].esc_rpm", "esc[0]", "counter[0]", "esc[x].esc_rpm", "esc[0].rpm", ""] {
            assert_eq!(formats.place("esc_status", path), None, "{path}");
        }
        for message in ["loop", "broken", "empty", "of_empty", "nothing"] {
            assert_eq!(formats.sizes(message), None, "{message}");
        }
        assert_eq!(formats.place("loop", "again[0].again[1].again[0]"), None);
    }
}
