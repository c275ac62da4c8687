//! Layout of the messages of a DataFlash log: from "QBffff" and "TimeUS,I,GyrX,…" to the byte of a value, and the units of the values.

use crate::packed::{Place, Scalar};
use crate::table::{SignalRole, TableSignal};
use std::collections::HashMap;
use std::f64::consts::TAU;

/// Places of the parts of an FMT message behind its type: length, name, types and labels.
const NAME: std::ops::Range<usize> = 2..6;
const TYPES: std::ops::Range<usize> = 6..22;
const LABELS: std::ops::Range<usize> = 22..86;
/// Mark of the field that says which sensor or ESC a message is of, in the units of the message.
const INSTANCE: u8 = b'#';
/// Labels of that field, in logs without units.
const INSTANCE_LABELS: [&str; 3] = ["I", "Instance", "Inst"];
/// Largest number of outputs of ArduPilot, whose commands are logged as C1 to C32.
const OUTPUTS_MAX: u32 = 32;

/// A value of a message.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Field {
    pub(super) label: String,
    /// First byte and number of bytes.
    start: usize,
    size: usize,
    /// `None` for text and arrays.
    pub(super) place: Option<Place>,
    /// Whether the type has a factor of its own, such as 0.01.
    has_own_factor: bool,
}

/// Layout of a type of messages.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Layout {
    pub(super) name: String,
    /// Length of a message with its head.
    pub(super) size: usize,
    pub(super) fields: Vec<Field>,
}

/// Text up to the first zero.
pub(super) fn text_of(bytes: &[u8]) -> String {
    let end = bytes.iter().position(|byte| *byte == 0).unwrap_or(bytes.len());
    String::from_utf8_lossy(&bytes[..end]).trim().to_owned()
}

impl Layout {
    /// The number of a type and its layout, from the content of an FMT message. `None` where both contradict each other.
    pub(super) fn parse(content: &[u8]) -> Option<(u8, Self)> {
        let [number, size, ..] = *content else { return None };
        let types = text_of(content.get(TYPES)?);
        let labels = text_of(content.get(LABELS)?);
        let mut labels = labels.split(',');
        let mut fields = Vec::new();
        let mut start = 0;
        for letter in types.bytes() {
            let (size, number) = type_of(letter)?;
            let (scalar, factor) = number.unzip();
            let place = scalar.map(|scalar| Place { offset: start, scalar, factor: factor.unwrap_or(1.0) });
            let label = labels.next().unwrap_or_default().trim().to_owned();
            fields.push(Field {
                label,
                start,
                size,
                place,
                has_own_factor: factor.is_some_and(|factor| factor != 1.0),
            });
            start += size;
        }
        let name = text_of(content.get(NAME)?);
        let size = usize::from(size);
        (size == start + super::HEAD_BYTES && !name.is_empty()).then_some((number, Self { name, size, fields }))
    }

    pub(super) fn field(&self, label: &str) -> Option<&Field> {
        self.fields.iter().find(|field| field.label == label)
    }

    pub(super) fn bytes_of<'a>(&self, label: &str, content: &'a [u8]) -> Option<&'a [u8]> {
        let field = self.field(label)?;
        content.get(field.start..field.start + field.size)
    }

    /// Place of the time, in seconds; `None` for messages without one.
    pub(super) fn time(&self) -> Option<Place> {
        // the time is the first field, where there is one
        let first = self.fields.first()?;
        let unit_s = match first.label.as_str() {
            "TimeUS" => 1e-6,
            "TimeMS" => 1e-3,
            _ => return None,
        };
        Some(Place { factor: unit_s, ..first.place? })
    }

    /// Index of the field that says which sensor or ESC a message is of.
    pub(super) fn instance_index(&self, units: Option<&UnitsOfType>) -> Option<usize> {
        let marked = units.and_then(|units| units.units.iter().position(|unit| *unit == INSTANCE));
        let at =
            marked.or_else(|| self.fields.iter().position(|field| INSTANCE_LABELS.contains(&field.label.as_str())))?;
        self.fields.get(at)?.place.map(|_| at)
    }

    /// The signals of a table, and their places with the factors to their units.
    pub(super) fn signals(
        &self,
        units: Option<&UnitsOfType>,
        instance: Option<u32>,
        all: &Units,
    ) -> (Vec<TableSignal>, Vec<Place>) {
        let instance_at = self.instance_index(units);
        let numbers = self.fields.iter().enumerate().skip(1).filter(|(at, _)| Some(*at) != instance_at);
        numbers
            .filter_map(|(at, field)| {
                let place = field.place?;
                let multiplier = if field.has_own_factor { 1.0 } else { all.multiplier(units, at) };
                Some(self.signal(
                    field,
                    Place { factor: place.factor * multiplier, ..place },
                    all.unit(units, at),
                    instance,
                ))
            })
            .unzip()
    }

    fn signal(&self, field: &Field, place: Place, unit: &str, instance: Option<u32>) -> (TableSignal, Place) {
        let label = field.label.clone();
        let scaled = |factor: f64| Place { factor: place.factor * factor, ..place };
        let is_rpm = unit == "rpm" || label.eq_ignore_ascii_case("rpm") || label == "RawRPM";
        let role = match self.name.as_str() {
            "ESC" if label == "RPM" => Some(SignalRole::RotorSpeed(instance.unwrap_or(0) + 1)),
            // until ArduPilot 4.0 each ESC had a type of its own, ESC1 to ESC8
            name if label == "RPM" => {
                name.strip_prefix("ESC").and_then(|esc| Some(SignalRole::RotorSpeed(esc.parse().ok()?)))
            }
            "RCOU" | "RCO2" | "RCO3" => label.strip_prefix('C').and_then(|output| {
                let output: u32 = output.parse().ok()?;
                (1..=OUTPUTS_MAX).contains(&output).then_some(SignalRole::Command(output))
            }),
            "IMU" => ["GyrX", "GyrY", "GyrZ"].iter().position(|axis| *axis == label).map(SignalRole::BodyRate),
            _ => None,
        };
        let plain = TableSignal { unit: unit.to_owned(), ..TableSignal::plain(label.clone()) };
        match role {
            Some(role @ SignalRole::Command(_)) => (TableSignal { role: Some(role), ..plain }, place),
            Some(role @ SignalRole::RotorSpeed(_)) => (TableSignal::with_role(label, role), scaled(1.0 / 60.0)),
            Some(role) => {
                let factor = if unit.starts_with("deg") { TAU / 360.0 } else { 1.0 };
                (TableSignal::with_role(label, role), scaled(factor))
            }
            None if is_rpm => (TableSignal { unit: "rev/s".to_owned(), ..plain }, scaled(1.0 / 60.0)),
            None => (plain, place),
        }
    }
}

/// Number of bytes of a type of values; of numbers also their type and factor.
fn type_of(letter: u8) -> Option<(usize, Option<(Scalar, f64)>)> {
    let number = |scalar: Scalar| scaled(scalar, 1.0);
    Some(match letter {
        b'b' => number(Scalar::Int(1)),
        b'B' | b'M' => number(Scalar::UInt(1)),
        b'h' => number(Scalar::Int(2)),
        b'H' => number(Scalar::UInt(2)),
        b'i' => number(Scalar::Int(4)),
        b'I' => number(Scalar::UInt(4)),
        b'q' => number(Scalar::Int(8)),
        b'Q' => number(Scalar::UInt(8)),
        b'g' => number(Scalar::Half),
        b'f' => number(Scalar::Float),
        b'd' => number(Scalar::Double),
        b'c' => scaled(Scalar::Int(2), 1e-2),
        b'C' => scaled(Scalar::UInt(2), 1e-2),
        b'e' => scaled(Scalar::Int(4), 1e-2),
        b'E' => scaled(Scalar::UInt(4), 1e-2),
        b'L' => scaled(Scalar::Int(4), 1e-7),
        b'n' => (4, None),
        b'N' => (16, None),
        b'Z' | b'a' => (64, None),
        _ => return None,
    })
}

fn scaled(scalar: Scalar, factor: f64) -> (usize, Option<(Scalar, f64)>) {
    (scalar.size(), Some((scalar, factor)))
}

/// A letter for the unit and one for the factor of each value of a type.
pub(super) struct UnitsOfType {
    units: Vec<u8>,
    multipliers: Vec<u8>,
}

/// Units of all values of a log.
#[derive(Default)]
pub(super) struct Units {
    units: HashMap<u8, String>,
    multipliers: HashMap<u8, f64>,
    of_types: HashMap<u8, UnitsOfType>,
}

impl Units {
    pub(super) fn add_unit(&mut self, layout: &Layout, content: &[u8]) {
        let letter = layout.field("Id").and_then(|field| content.get(field.start));
        if let (Some(letter), Some(label)) = (letter, layout.bytes_of("Label", content)) {
            self.units.insert(*letter, text_of(label));
        }
    }

    pub(super) fn add_multiplier(&mut self, layout: &Layout, content: &[u8]) {
        let letter = layout.field("Id").and_then(|field| content.get(field.start));
        let factor = layout.field("Mult").and_then(|field| field.place?.read(content));
        if let (Some(letter), Some(factor)) = (letter, factor.filter(|factor| factor.is_finite() && *factor > 0.0)) {
            self.multipliers.insert(*letter, factor);
        }
    }

    /// Returns the number of the type.
    pub(super) fn add_units_of_type(&mut self, layout: &Layout, content: &[u8]) -> Option<u8> {
        let number = *content.get(layout.field("FmtType")?.start)?;
        let letters = |label: &str| Some(text_of(layout.bytes_of(label, content)?).into_bytes());
        let units = UnitsOfType { units: letters("UnitIds")?, multipliers: letters("MultIds")? };
        self.of_types.insert(number, units);
        Some(number)
    }

    pub(super) fn of_type(&self, number: usize) -> Option<&UnitsOfType> {
        self.of_types.get(&u8::try_from(number).ok()?)
    }

    /// The unit of a value; empty where the log tells none.
    fn unit(&self, of_type: Option<&UnitsOfType>, at: usize) -> &str {
        let letter = of_type.and_then(|units| units.units.get(at));
        letter.and_then(|letter| self.units.get(letter)).map_or("", String::as_str)
    }

    fn multiplier(&self, of_type: Option<&UnitsOfType>, at: usize) -> f64 {
        let letter = of_type.and_then(|units| units.multipliers.get(at));
        letter.and_then(|letter| self.multipliers.get(letter)).copied().unwrap_or(1.0)
    }
}
