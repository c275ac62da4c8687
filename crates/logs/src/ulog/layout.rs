//! Layout of the messages of a ULog: from "uint64_t timestamp;float[3] xyz" to the byte of a value.

use crate::packed::{Place, Scalar};
use std::collections::HashMap;

/// Deepest nesting of types. `esc_status` contains `esc_report`, and no topic of PX4 nests deeper.
const NESTING_MAX: usize = 4;
/// Largest length of a message, which two bytes hold.
const SIZE_MAX: usize = u16::MAX as usize;
/// Largest number of values in a message; more are an array of bytes, not of measurements.
const VALUES_MAX: usize = 4096;

/// A number of a message.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Value {
    /// Name such as "xyz[2]" or "esc[3].esc_rpm".
    pub(super) name: String,
    pub(super) place: Place,
}

fn scalar_of(name: &str) -> Option<Scalar> {
    Some(match name {
        "int8_t" => Scalar::Int(1),
        "int16_t" => Scalar::Int(2),
        "int32_t" => Scalar::Int(4),
        "int64_t" => Scalar::Int(8),
        "uint8_t" | "bool" | "char" => Scalar::UInt(1),
        "uint16_t" => Scalar::UInt(2),
        "uint32_t" => Scalar::UInt(4),
        "uint64_t" => Scalar::UInt(8),
        "float" => Scalar::Float,
        "double" => Scalar::Double,
        _ => return None,
    })
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
pub(super) struct Layouts {
    fields: HashMap<String, Vec<Field>>,
}

impl Layouts {
    /// Adds "name:type field;type field;". Invalid text is ignored.
    pub(super) fn add(&mut self, text: &str) {
        let Some((name, fields)) = text.split_once(':') else { return };
        let parts = fields.split(';').filter(|part| !part.is_empty());
        if let Some(fields) = parts.map(Field::parse).collect::<Option<Vec<Field>>>() {
            self.fields.insert(name.to_owned(), fields);
        }
    }

    /// Possible lengths of a message, with and without the padding at its end.
    pub(super) fn sizes(&self, message: &str) -> Option<[usize; 2]> {
        let fields = self.fields.get(message)?;
        let whole = self.size_of(message, 0)?;
        let padding = match fields.last().filter(|last| last.is_padding()) {
            Some(last) => self.size_of_field(last, 0)?,
            None => 0,
        };
        Some([whole - padding, whole])
    }

    /// All numbers of a message, without padding and text; `None` for more than `count_max`.
    pub(super) fn values(&self, message: &str, count_max: usize) -> Option<Vec<Value>> {
        let mut values = Vec::new();
        self.collect(message, "", 0, 0, &mut values)?;
        (values.len() <= count_max).then_some(values)
    }

    /// Adds the numbers of a type that stands at `offset`, with `prefix` before their names.
    fn collect(&self, type_name: &str, prefix: &str, offset: usize, depth: usize, into: &mut Vec<Value>) -> Option<()> {
        let fields = self.fields.get(type_name).filter(|_| depth <= NESTING_MAX)?;
        let mut offset = offset;
        for field in fields {
            let size = self.size_of(&field.type_name, depth)?;
            let is_text = field.is_padding() || field.type_name == "char";
            for index in (0..field.length.unwrap_or(1)).filter(|_| !is_text) {
                let index_in_words = field.length.map_or(String::new(), |_| format!("[{index}]"));
                let name = format!("{prefix}{}{index_in_words}", field.name);
                let at = offset + index * size;
                match scalar_of(&field.type_name) {
                    Some(scalar) => into.push(Value { name, place: Place::plain(at, scalar) }),
                    None => self.collect(&field.type_name, &format!("{name}."), at, depth + 1, into)?,
                }
                if into.len() > VALUES_MAX {
                    return None;
                }
            }
            offset += size * field.length.unwrap_or(1);
        }
        Some(())
    }

    fn size_of_field(&self, field: &Field, depth: usize) -> Option<usize> {
        let size = self.size_of(&field.type_name, depth)?.checked_mul(field.length.unwrap_or(1))?;
        (size <= SIZE_MAX).then_some(size)
    }

    fn size_of(&self, type_name: &str, depth: usize) -> Option<usize> {
        if let Some(scalar) = scalar_of(type_name) {
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

    fn layouts() -> Layouts {
        let mut layouts = Layouts::default();
        layouts.add("esc_report:uint64_t timestamp;int32_t esc_rpm;uint8_t[4] _padding0;");
        layouts.add("esc_status:uint64_t timestamp;uint16_t counter;esc_report[8] esc;uint8_t[2] _padding0;");
        layouts.add("loop:loop[2] again;");
        layouts.add("broken:float");
        layouts.add("empty:");
        layouts.add("of_empty:empty[9] a;float[0] b;");
        layouts
    }

    #[test]
    fn values_are_found_through_arrays_and_nested_types() {
        let layouts = layouts();
        // padding at the end of a nested type counts; at the end of the message it can be missing
        assert_eq!(layouts.sizes("esc_status"), Some([8 + 2 + 8 * 16, 8 + 2 + 8 * 16 + 2]));
        let values = layouts.values("esc_status", 100).unwrap();
        let names: Vec<&str> = values.iter().map(|value| value.name.as_str()).take(4).collect();
        assert_eq!(
            (names, values.len()),
            (vec!["timestamp", "counter", "esc[0].timestamp", "esc[0].esc_rpm"], 2 + 8 * 2)
        );
        let place = values.iter().find(|value| value.name == "esc[3].esc_rpm").unwrap().place;
        assert_eq!(place, Place::plain(10 + 3 * 16 + 8, Scalar::Int(4)));
        let mut message = vec![0; 138];
        message[66..70].copy_from_slice(&(-1500_i32).to_le_bytes());
        assert_eq!(place.read(&message), Some(-1500.0));
        assert_eq!(place.read(&message[..69]), None);
        assert_eq!(layouts.values("esc_status", 17), None);
    }

    #[test]
    fn what_is_not_there_or_has_no_end_is_nothing() {
        let layouts = layouts();
        for message in ["loop", "broken", "empty", "of_empty", "nothing"] {
            assert_eq!(layouts.sizes(message), None, "{message}");
        }
        assert_eq!(layouts.values("loop", SIZE_MAX), None);
    }
}
