//! From the bytes of a ULog to its topics with their messages (PX4 guide, "ULog file format", version 1).

use super::format::{Formats, Place};
use std::collections::HashMap;

const MAGIC: [u8; 7] = [0x55, 0x4c, 0x6f, 0x67, 0x01, 0x12, 0x35];
const HEADER_BYTES: usize = 16;
/// Length and type before each message, in bytes.
const HEAD_BYTES: usize = 3;
/// Number of valid messages in a row that are not there by chance. Behind damage, reading continues at such a run.
const MESSAGES_IN_A_ROW: usize = 4;

/// Whether the bytes begin with the magic of a ULog.
pub(crate) fn is_ulog(bytes: &[u8]) -> bool {
    bytes.starts_with(&MAGIC)
}

/// Content of a log.
pub(super) struct UlogFile<'a> {
    formats: Formats,
    pub(super) topics: Vec<Topic<'a>>,
    /// Number of invalid bytes, and number of places where they stand.
    pub(super) lost_bytes: usize,
    pub(super) lost_places: usize,
}

/// A topic; a log can have several instances of it.
pub(super) struct Topic<'a> {
    pub(super) name: String,
    pub(super) instance: u8,
    /// The messages as in the file, without the number of the topic.
    pub(super) messages: Vec<&'a [u8]>,
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
    fn topic(&self) -> Option<u16> {
        Some(u16::from_le_bytes(self.content.get(..2)?.try_into().ok()?))
    }
}

/// State from all messages so far, which later messages need.
struct Reader<'a> {
    file: UlogFile<'a>,
    /// From the number of a topic to its index in the list, and the lengths of its messages where its format is known.
    known: HashMap<u16, (usize, Option<(usize, usize)>)>,
}

impl<'a> UlogFile<'a> {
    pub(super) fn read(bytes: &'a [u8]) -> Self {
        let file = Self { formats: Formats::default(), topics: Vec::new(), lost_bytes: 0, lost_places: 0 };
        let mut reader = Reader { file, known: HashMap::new() };
        let mut at = HEADER_BYTES.min(bytes.len());
        while at < bytes.len() {
            match Message::at(bytes, at).filter(|message| reader.is_possible(message)) {
                Some(message) => {
                    at += message.size();
                    reader.take(&message);
                }
                None => {
                    let next = (at + 1..bytes.len()).find(|&next| reader.goes_on_at(bytes, next));
                    let next = next.unwrap_or(bytes.len());
                    reader.file.lost_bytes += next - at;
                    reader.file.lost_places += 1;
                    at = next;
                }
            }
        }
        reader.file
    }

    /// Position of a value in the messages of a topic.
    pub(super) fn place(&self, topic: &Topic, path: &str) -> Option<Place> {
        self.formats.place(&topic.name, path)
    }
}

impl<'a> Reader<'a> {
    fn is_possible(&self, message: &Message) -> bool {
        match message.kind {
            b'D' => match message.topic().map(|topic| self.known.get(&topic)) {
                Some(Some((_, Some((short, long))))) => {
                    let length = message.content.len() - 2;
                    length == *short || length == *long
                }
                Some(_) => true,
                None => false,
            },
            b'A' => message.content.len() > 3,
            b'B' | b'F' | b'I' | b'M' | b'P' | b'Q' | b'R' | b'S' | b'O' | b'L' | b'C' => true,
            _ => false,
        }
    }

    /// Whether a run of valid messages begins at this position.
    fn goes_on_at(&self, bytes: &[u8], from: usize) -> bool {
        let mut at = from;
        (0..MESSAGES_IN_A_ROW).all(|_| {
            let is_known = |message: &Message| {
                let is_data = message.kind == b'D';
                let has_topic = message.topic().is_some_and(|topic| self.known.contains_key(&topic));
                self.is_possible(message) && (!is_data || has_topic)
            };
            let message = Message::at(bytes, at).filter(is_known);
            at += message.as_ref().map_or(0, Message::size);
            message.is_some()
        })
    }

    fn take(&mut self, message: &Message<'a>) {
        match message.kind {
            b'F' => self.file.formats.add(&String::from_utf8_lossy(message.content)),
            b'A' => {
                let &[instance, low, high, ref name @ ..] = message.content else { return };
                let name = String::from_utf8_lossy(name).into_owned();
                let sizes = self.file.formats.sizes(&name);
                self.known.insert(u16::from_le_bytes([low, high]), (self.file.topics.len(), sizes));
                self.file.topics.push(Topic { name, instance, messages: Vec::new() });
            }
            b'D' => {
                let topic = message.topic().and_then(|topic| self.known.get(&topic));
                // data of a topic with unknown format cannot be read
                if let Some((place, Some(_))) = topic {
                    self.file.topics[*place].messages.push(&message.content[2..]);
                }
            }
            _ => {}
        }
    }
}
