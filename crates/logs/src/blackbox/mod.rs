//! From a blackbox log of Betaflight, INAV or Cleanflight to rows (Betaflight, "Blackbox internals"; `blackbox-tools`).
//!
//! A file holds one log per arming. Each begins with lines of text (`header`) that describe the frames. A frame is one letter and its values
//! (`encoding`), and most values of main frames are differences to a prediction (`main_frames`). The other frames have no time of their own:
//! they are passed over.

mod encoding;
mod event;
mod header;
mod main_frames;

use crate::LogError;
use crate::byte_window::ByteWindow;
use crate::loss::Loss;
use crate::table::{Findings, RowSink, RowValues, SIGNALS_MAX};
use encoding::FrameLayout;
use event::Event;
use header::{Header, MainSignal};
use main_frames::MainFrames;
use std::io::Read;

/// The first line of each log.
pub(crate) const FIRST_LINE: &[u8] = b"H Product:Blackbox flight data recorder by Nicholas Sherlock\n";
/// Longest frame that is read.
const FRAME_BYTES_MAX: usize = 1 << 11;
/// Longest header that is read.
const HEADER_BYTES_MAX: usize = 1 << 17;

/// Hands the main frames of a blackbox log over as rows.
pub(crate) fn read<R: Read>(bytes: &mut ByteWindow<R>, sink: &mut impl RowSink) -> Result<Findings, LogError> {
    let mut findings = Findings::default();
    let is_first_line = |ahead: &[u8]| ahead.starts_with(FIRST_LINE);
    let mut has_ended = false;
    let (mut log_count, mut signal_count) = (0, 0);
    loop {
        let ahead = bytes.ahead(HEADER_BYTES_MAX)?;
        if ahead.is_empty() {
            return Ok(findings);
        }
        if !is_first_line(ahead) {
            // a memory chip is empty behind the end of a log
            let mut empty = Loss::default();
            let loss = if has_ended { &mut empty } else { &mut findings.loss };
            bytes.skip_damage(FIRST_LINE.len(), None, loss, is_first_line)?;
            continue;
        }
        let (header, size) = Header::parse(&ahead[..ahead.len().min(HEADER_BYTES_MAX)]);
        header.check_version()?;
        bytes.consume(size);
        has_ended = match Log::of(&header) {
            Some(mut log) if signal_count + log.signals.len() <= SIGNALS_MAX => {
                signal_count += log.signals.len();
                log.table = log_count;
                log_count += 1;
                let name = if log_count == 1 { "main".to_owned() } else { format!("main[{log_count}]") };
                sink.table(name, log.signals.iter().map(|signal| signal.signal.clone()).collect());
                log.read(bytes, sink, &mut findings)?;
                log.has_ended
            }
            _ => false,
        };
    }
}

/// The frame at a place.
struct Frame {
    size: usize,
    content: Content,
}

enum Content {
    /// A main frame, decoded.
    Main,
    Event(Event),
    Other,
}

/// One log of the file.
struct Log {
    main: MainFrames,
    /// By the letters S, G and H.
    others: [Option<FrameLayout>; 3],
    signals: Vec<MainSignal>,
    table: usize,
    has_ended: bool,
}

impl Log {
    /// `None` for a header without main frames.
    fn of(header: &Header) -> Option<Self> {
        let others = ["S", "G", "H"].map(|letter| header.layout(letter));
        let (main, signals) = (MainFrames::of(header)?, header.main_signals());
        Some(Self { main, others, signals, table: 0, has_ended: false })
    }

    /// Reads the frames up to the end of the log or to the header of the next.
    fn read<R: Read>(
        &mut self,
        bytes: &mut ByteWindow<R>,
        sink: &mut impl RowSink,
        findings: &mut Findings,
    ) -> Result<(), LogError> {
        loop {
            let ahead = bytes.ahead(2 * FRAME_BYTES_MAX)?;
            if ahead.is_empty() || self.has_ended || ahead[0] == b'H' && ahead.starts_with(FIRST_LINE) {
                return Ok(());
            }
            match self.frame_at(ahead) {
                Some(Frame { size, content }) => {
                    self.take(&content, sink)?;
                    bytes.consume(size);
                }
                None => {
                    self.main.lose();
                    let goes_on = |ahead: &[u8]| self.goes_on_at(ahead);
                    bytes.skip_damage(2 * FRAME_BYTES_MAX, self.main.last_s(), &mut findings.loss, goes_on)?;
                }
            }
        }
    }

    /// The frame here, if it is valid and another one, or the end, follows. A main frame is decoded.
    fn frame_at(&mut self, bytes: &[u8]) -> Option<Frame> {
        let (&letter, rest) = bytes.split_first()?;
        let (size, content) = match letter {
            b'I' => (self.main.decode_intra(rest)?, Content::Main),
            b'P' => (self.main.decode_inter(rest)?, Content::Main),
            b'E' => {
                let event = Event::at(rest)?;
                (event.size, Content::Event(event))
            }
            _ => (self.other(letter)?.size_at(rest)?, Content::Other),
        };
        let is_end = matches!(content, Content::Event(Event { is_end: true, .. }));
        let is_followed = is_end || rest.get(size).is_none_or(|next| is_letter(*next));
        is_followed.then_some(Frame { size: size + 1, content })
    }

    fn other(&self, letter: u8) -> Option<&FrameLayout> {
        let at = b"SGH".iter().position(|other| *other == letter)?;
        self.others[at].as_ref()
    }

    fn take(&mut self, content: &Content, sink: &mut impl RowSink) -> Result<(), LogError> {
        match content {
            Content::Main => {
                let time_s = self.main.keep();
                sink.row(self.table, time_s, &MainRow { values: self.main.values(), signals: &self.signals })?;
            }
            Content::Event(event) => {
                self.has_ended = event.is_end;
                if event.is_resume {
                    self.main.resume();
                }
            }
            Content::Other => {}
        }
        Ok(())
    }

    /// Whether reading can go on here: at the next header, or at a frame that depends on no other, with another one behind it.
    fn goes_on_at(&self, bytes: &[u8]) -> bool {
        if bytes.starts_with(FIRST_LINE) {
            return true;
        }
        let Some(size) = bytes.strip_prefix(b"I").and_then(|rest| self.main.intra_size(rest)) else { return false };
        let Some((&letter, rest)) = bytes.get(size + 1..).and_then(<[u8]>::split_first) else { return true };
        match letter {
            b'I' => self.main.intra_size(rest).is_some(),
            b'P' => self.main.inter_size(rest).is_some(),
            b'E' => Event::at(rest).is_some(),
            _ => self.other(letter).is_some_and(|layout| layout.size_at(rest).is_some()),
        }
    }
}

fn is_letter(byte: u8) -> bool {
    b"IPSGHE".contains(&byte)
}

/// A main frame.
struct MainRow<'a> {
    values: &'a [i32],
    signals: &'a [MainSignal],
}

impl RowValues for MainRow<'_> {
    fn value(&self, signal: usize) -> f64 {
        let Some(signal) = self.signals.get(signal) else { return f64::NAN };
        let Some(&value) = self.values.get(signal.field) else { return f64::NAN };
        let number = if signal.is_signed { f64::from(value) } else { f64::from(value.cast_unsigned()) };
        number * signal.factor
    }
}
