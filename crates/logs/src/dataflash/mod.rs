//! From a DataFlash log of ArduPilot to rows (ArduPilot, `AP_Logger/LogStructure.h`).
//!
//! Each message begins with two fixed bytes and its type. FMT messages describe the other types; UNIT, MULT and FMTU their units, and PARM the
//! motor of each output. `layout` knows the places of the values in a message.

mod layout;

use crate::LogError;
use crate::byte_window::ByteWindow;
use crate::packed::{PackedRow, Place};
use crate::table::{Findings, RowSink, SIGNALS_MAX};
use layout::{Layout, Units, text_of};
use std::collections::BTreeMap;
use std::io::Read;

const MAGIC: [u8; 2] = [0xa3, 0x95];
/// Type of the messages that describe the others.
const FMT: u8 = 128;
/// Length of such a message, with its head.
const FMT_BYTES: usize = 89;
/// The first bytes of a log: it begins with the description of the descriptions.
pub(crate) const FIRST_BYTES: [u8; 3] = [MAGIC[0], MAGIC[1], FMT];
/// The two fixed bytes and the type.
const HEAD_BYTES: usize = 3;
/// Longest message, whose length one byte holds.
const MESSAGE_BYTES_MAX: usize = u8::MAX as usize;
/// Number of valid messages in a row that are not there by chance. Behind damage, reading continues at such a run.
const MESSAGES_IN_A_ROW: usize = 3;
/// `SERVOn_FUNCTION` of motors 1 to 8 and 9 to 12 begins with these numbers.
const FUNCTIONS_OF_MOTORS: [[u32; 2]; 2] = [[33, 40], [82, 85]];

/// Hands the messages of a DataFlash log over as rows.
pub(crate) fn read<R: Read>(bytes: &mut ByteWindow<R>, sink: &mut impl RowSink) -> Result<Findings, LogError> {
    let mut findings = Findings::default();
    let mut types = MessageTypes::new();
    loop {
        let ahead = bytes.ahead(MESSAGE_BYTES_MAX)?;
        if ahead.is_empty() {
            return Ok(findings);
        }
        match types.message_at(ahead).filter(|message| is_followed(&ahead[message.len()..])) {
            Some(message) => {
                let size = message.len();
                types.take(message, sink, &mut findings.motor_of_output)?;
                bytes.consume(size);
            }
            None => {
                let goes_on = |ahead: &[u8]| types.go_on_at(ahead);
                bytes.skip_damage(MESSAGES_IN_A_ROW * MESSAGE_BYTES_MAX, types.last_s, &mut findings.loss, goes_on)?;
            }
        }
    }
}

/// Whether another message, or the end, follows: otherwise the damage may have begun within the message.
fn is_followed(rest: &[u8]) -> bool {
    rest.iter().zip(MAGIC).all(|(byte, magic)| *byte == magic)
}

/// A type of messages.
struct MessageType {
    layout: Layout,
    /// Place of the time, in seconds.
    time: Option<Place>,
    /// Place of the number of the sensor or ESC that a message is of.
    instance: Option<Place>,
    /// Numbers of its tables by the instance of the sensor or ESC; without instances there is one.
    tables: BTreeMap<u32, usize>,
    /// Places with factors, made with the first table.
    places: Vec<Place>,
    /// Whether it tells about other types.
    is_about_log: bool,
}

/// What later messages need from all messages so far.
struct MessageTypes {
    /// By their number.
    known: Vec<Option<MessageType>>,
    units: Units,
    table_count: usize,
    signal_count: usize,
    last_s: Option<f64>,
}

impl MessageTypes {
    fn new() -> Self {
        let mut known: Vec<Option<MessageType>> = Vec::new();
        known.resize_with(usize::from(u8::MAX) + 1, || None);
        Self { known, units: Units::default(), table_count: 0, signal_count: 0, last_s: None }
    }

    /// The message here, with its head, if it is complete and of a known type.
    fn message_at<'a>(&self, bytes: &'a [u8]) -> Option<&'a [u8]> {
        let kind = *bytes.strip_prefix(&MAGIC)?.first()?;
        let size = match kind {
            FMT => FMT_BYTES,
            _ => self.known[usize::from(kind)].as_ref()?.layout.size,
        };
        bytes.get(..size)
    }

    /// Whether a run of valid messages begins here, or valid messages up to the end.
    fn go_on_at(&self, bytes: &[u8]) -> bool {
        let mut at = 0;
        (0..MESSAGES_IN_A_ROW).all(|count| match self.message_at(&bytes[at..]) {
            Some(message) => {
                at += message.len();
                true
            }
            None => count > 0 && at == bytes.len(),
        })
    }

    fn take(
        &mut self,
        message: &[u8],
        sink: &mut impl RowSink,
        motor_of_output: &mut BTreeMap<u32, u32>,
    ) -> Result<(), LogError> {
        let content = &message[HEAD_BYTES..];
        let number = usize::from(message[HEAD_BYTES - 1]);
        if message[HEAD_BYTES - 1] == FMT {
            self.describe(content);
            return Ok(());
        }
        let Some(kind) = &self.known[number] else { return Ok(()) };
        if kind.is_about_log {
            match kind.layout.name.as_str() {
                "UNIT" => self.units.add_unit(&kind.layout, content),
                "MULT" => self.units.add_multiplier(&kind.layout, content),
                "FMTU" => {
                    if let Some(number) = self.units.add_units_of_type(&kind.layout, content) {
                        self.find_instance(usize::from(number));
                    }
                }
                _ => {
                    if let Some([output, motor]) = motor_of_parameter(&kind.layout, content) {
                        motor_of_output.insert(output, motor);
                    }
                }
            }
            return Ok(());
        }
        self.row(number, content, sink)
    }

    /// Takes the description of a type. A type that is described again keeps its tables.
    fn describe(&mut self, content: &[u8]) {
        let Some((number, layout)) = Layout::parse(content) else { return };
        let known = &mut self.known[usize::from(number)];
        if known.as_ref().is_some_and(|known| known.layout == layout) {
            return;
        }
        let is_about_log = ["FMT", "UNIT", "MULT", "FMTU", "PARM"].contains(&layout.name.as_str());
        let time = layout.time();
        let (tables, places) = (BTreeMap::new(), Vec::new());
        *known = Some(MessageType { layout, time, instance: None, tables, places, is_about_log });
        self.find_instance(usize::from(number));
    }

    /// The units of a type may come behind its description.
    fn find_instance(&mut self, number: usize) {
        let Some(kind) = &mut self.known[number] else { return };
        let at = kind.layout.instance_index(self.units.of_type(number));
        kind.instance = at.and_then(|at| kind.layout.fields[at].place);
    }

    fn row(&mut self, number: usize, content: &[u8], sink: &mut impl RowSink) -> Result<(), LogError> {
        let Some(kind) = &mut self.known[number] else { return Ok(()) };
        let Some(time_s) = kind.time.and_then(|place| place.read(content)) else { return Ok(()) };
        let instance = kind.instance.and_then(|place| place.read(content)).map(|value| value as u32);
        let key = instance.unwrap_or(0);
        let table = match kind.tables.get(&key) {
            Some(&table) => table,
            None => {
                let (signals, places) = kind.layout.signals(self.units.of_type(number), instance, &self.units);
                if self.signal_count + signals.len() > SIGNALS_MAX {
                    return Ok(());
                }
                self.signal_count += signals.len();
                let name = match instance {
                    Some(instance) => format!("{}[{instance}]", kind.layout.name),
                    None => kind.layout.name.clone(),
                };
                sink.table(name, signals);
                kind.places = places;
                kind.tables.insert(key, self.table_count);
                self.table_count += 1;
                self.table_count - 1
            }
        };
        self.last_s = Some(time_s);
        sink.row(table, time_s, &PackedRow { message: content, places: &kind.places })
    }
}

/// The output, from 0, and its motor, from 1, of a parameter "SERVO3_FUNCTION".
fn motor_of_parameter(layout: &Layout, content: &[u8]) -> Option<[u32; 2]> {
    let name = text_of(layout.bytes_of("Name", content)?);
    let output: u32 = name.strip_prefix("SERVO")?.strip_suffix("_FUNCTION")?.parse().ok()?;
    let function = layout.field("Value")?.place?.read(content)? as u32;
    let mut motors_before = 0;
    for [first, last] in FUNCTIONS_OF_MOTORS {
        if (first..=last).contains(&function) {
            return Some([output.checked_sub(1)?, motors_before + function - first + 1]);
        }
        motors_before += last - first + 1;
    }
    None
}
