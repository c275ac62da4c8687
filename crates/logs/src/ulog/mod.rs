//! From a ULog of PX4 to rows (PX4 guide, "ULog file format", version 1).
//!
//! `layout` knows the places of the values in a message; this file finds the messages, and goes on behind damage.

mod layout;
mod signals;

use crate::LogError;
use crate::byte_window::ByteWindow;
use crate::packed::{PackedRow, Place};
use crate::table::{Findings, RowSink, SIGNALS_MAX};
use layout::Layouts;
use std::collections::HashMap;
use std::io::Read;

const MAGIC: [u8; 7] = [0x55, 0x4c, 0x6f, 0x67, 0x01, 0x12, 0x35];
const HEADER_BYTES: usize = 16;
/// Length and type before each message, in bytes.
const HEAD_BYTES: usize = 3;
/// Longest message, whose length two bytes hold.
const MESSAGE_BYTES_MAX: usize = HEAD_BYTES + u16::MAX as usize;
/// Number of valid messages in a row that are not there by chance. Behind damage, reading continues at such a run.
const MESSAGES_IN_A_ROW: usize = 4;
/// Bytes in which that run is looked for. Longer messages are rare, and damage ends at one of the others.
const LOOKAHEAD_BYTES: usize = 1 << 14;

/// Whether the bytes begin with the magic of a ULog.
pub(crate) fn is_ulog(bytes: &[u8]) -> bool {
    bytes.starts_with(&MAGIC)
}

/// Hands the data messages of a ULog over as rows.
pub(crate) fn read<R: Read>(bytes: &mut ByteWindow<R>, sink: &mut impl RowSink) -> Result<Findings, LogError> {
    let mut findings = Findings::default();
    let mut topics = Topics::default();
    bytes.consume(HEADER_BYTES);
    loop {
        let ahead = bytes.ahead(MESSAGE_BYTES_MAX)?;
        if ahead.is_empty() {
            return Ok(findings);
        }
        let is_sound = |message: &Message| topics.are_possible_with(message) && is_followed(&ahead[message.size()..]);
        match Message::at(ahead, 0).filter(is_sound) {
            Some(message) => {
                topics.take(&message, sink)?;
                let size = message.size();
                bytes.consume(size);
            }
            None => {
                let goes_on = |ahead: &[u8]| topics.go_on_at(ahead);
                bytes.skip_damage(LOOKAHEAD_BYTES, topics.last_s, &mut findings.loss, goes_on)?;
            }
        }
    }
}

/// Whether another message, or the end, follows: otherwise the damage may have begun within the message.
fn is_followed(rest: &[u8]) -> bool {
    rest.get(HEAD_BYTES - 1).is_none_or(|kind| is_kind(*kind))
}

/// Whether a message can be of this type.
fn is_kind(kind: u8) -> bool {
    b"ABCDFILMOPQRS".contains(&kind)
}

/// A message with its type and payload.
struct Message<'a> {
    kind: u8,
    content: &'a [u8],
}

impl<'a> Message<'a> {
    /// The message at a position, if it is complete.
    fn at(bytes: &'a [u8], from: usize) -> Option<Self> {
        let head = bytes.get(from..from + HEAD_BYTES)?;
        let length = usize::from(u16::from_le_bytes([head[0], head[1]]));
        let content = bytes.get(from + HEAD_BYTES..from + HEAD_BYTES + length)?;
        Some(Self { kind: head[2], content })
    }

    fn size(&self) -> usize {
        HEAD_BYTES + self.content.len()
    }

    /// Number of the topic in a data message.
    fn topic(&self) -> Option<usize> {
        Some(usize::from(u16::from_le_bytes(self.content.get(..2)?.try_into().ok()?)))
    }
}

/// A topic whose data can be read.
struct Topic {
    /// Number of its table.
    table: usize,
    places: Vec<Place>,
    /// The places of the times of a message: when it was sampled, and when it was published.
    sampled: Option<Place>,
    published: Place,
    /// The lengths of a message, without and with the padding at its end.
    short: usize,
    long: usize,
}

impl Topic {
    /// Time at which a message was sampled, or published where the log has no sampling time.
    fn time_s(&self, message: &[u8]) -> Option<f64> {
        let sampled_us = self.sampled.and_then(|place| place.read(message)).filter(|time_us| *time_us > 0.0);
        Some(1e-6 * sampled_us.or_else(|| self.published.read(message))?)
    }
}

/// A topic that was announced.
enum Announced {
    /// Without a layout, or with more signals than a log can have: its data cannot be read.
    Unreadable,
    Readable(Topic),
}

/// What later messages need from all messages so far.
#[derive(Default)]
struct Topics {
    layouts: Layouts,
    /// By the number of a topic.
    announced: Vec<Option<Announced>>,
    /// From the name of a table to its number.
    tables: HashMap<String, usize>,
    signal_count: usize,
    last_s: Option<f64>,
}

impl Topics {
    fn known(&self, message: &Message) -> Option<&Announced> {
        self.announced.get(message.topic()?)?.as_ref()
    }

    fn are_possible_with(&self, message: &Message) -> bool {
        match message.kind {
            b'D' => match self.known(message) {
                Some(Announced::Readable(topic)) => {
                    let length = message.content.len() - 2;
                    length == topic.short || length == topic.long
                }
                Some(Announced::Unreadable) => true,
                None => false,
            },
            b'A' => message.content.len() > 3,
            kind => is_kind(kind),
        }
    }

    /// Whether a run of valid messages begins here.
    fn go_on_at(&self, bytes: &[u8]) -> bool {
        let mut at = 0;
        (0..MESSAGES_IN_A_ROW).all(|_| {
            let message = Message::at(bytes, at).filter(|message| self.are_possible_with(message));
            at += message.as_ref().map_or(0, Message::size);
            message.is_some()
        })
    }

    fn take(&mut self, message: &Message, sink: &mut impl RowSink) -> Result<(), LogError> {
        match message.kind {
            b'F' => self.layouts.add(&String::from_utf8_lossy(message.content)),
            b'A' => {
                if let &[instance, low, high, ref name @ ..] = message.content {
                    let number = usize::from(u16::from_le_bytes([low, high]));
                    self.announce(number, instance, &String::from_utf8_lossy(name), sink);
                }
            }
            b'D' => {
                let Some(Announced::Readable(topic)) = self.known(message) else { return Ok(()) };
                let content = &message.content[2..];
                if let Some(time_s) = topic.time_s(content) {
                    let row = PackedRow { message: content, places: &topic.places };
                    sink.row(topic.table, time_s, &row)?;
                    self.last_s = Some(time_s);
                }
            }
            _ => {}
        }
        Ok(())
    }

    fn announce(&mut self, number: usize, instance: u8, name: &str, sink: &mut impl RowSink) {
        if self.announced.len() <= number {
            self.announced.resize_with(number + 1, || None);
        }
        let topic = self.topic(instance, name, sink).map_or(Announced::Unreadable, Announced::Readable);
        self.announced[number] = Some(topic);
    }

    /// The topic of a name, whose first announcement makes a table.
    fn topic(&mut self, instance: u8, name: &str, sink: &mut impl RowSink) -> Option<Topic> {
        let [short, long] = self.layouts.sizes(name)?;
        let values = self.layouts.values(name, SIGNALS_MAX.saturating_sub(self.signal_count))?;
        let time = |wanted: &str| values.iter().find(|value| value.name == wanted).map(|value| value.place);
        let (sampled, published) = (time("timestamp_sample"), time("timestamp")?);
        let (signals, places) = signals::signals_of(name, &values);
        let table_name = if instance == 0 { name.to_owned() } else { format!("{name}[{instance}]") };
        let table = match self.tables.get(&table_name) {
            Some(&table) => table,
            None => {
                let table = self.tables.len();
                self.signal_count += signals.len();
                self.tables.insert(table_name.clone(), table);
                sink.table(table_name, signals);
                table
            }
        };
        Some(Topic { table, places, sampled, published, short, long })
    }
}
