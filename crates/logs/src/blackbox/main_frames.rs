//! The main frames: a whole one every now and then, and differences to predictions in between.

use super::encoding::FrameLayout;
use super::header::Header;

/// A main frame follows the one before it within this time, unless something lies between them.
const STEP_US_MAX: u32 = 10_000_000;
/// Times have 32 bits and start again at 0.
const TIME_US_COUNT: f64 = 4_294_967_296.0;

/// What a value is predicted from.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Prediction {
    Constant(i32),
    Previous,
    StraightLine,
    Average,
    /// Another value of the same frame.
    Field(usize),
    /// One more than the previous value, and one for each loop that was not written.
    Increment,
}

/// One kind of main frames.
struct Coding {
    layout: FrameLayout,
    predictions: Vec<Prediction>,
}

impl Coding {
    fn of(header: &Header, letter: &str, field_count: usize) -> Option<Self> {
        let layout = header.layout(letter)?;
        let predictions = header.predictions(letter)?;
        let is_sound = layout.field_count() == field_count && predictions.len() == field_count;
        is_sound.then_some(Self { layout, predictions })
    }
}

/// The main frames of a log, in their sequence.
pub(super) struct MainFrames {
    intra: Coding,
    inter: Coding,
    is_signed: Vec<bool>,
    /// Numbers of these values.
    iteration: Option<usize>,
    time: usize,
    /// Of each `intervals[0]` loops the first is written as a whole; of the others, `intervals[1]` of `intervals[2]` are written.
    intervals: [u32; 3],
    /// The frame that is being decoded, the last one, and the one before it.
    present: Vec<i32>,
    last: Vec<i32>,
    second_last: Vec<i32>,
    /// Whether the last frames are known, so that differences to them mean something.
    has_last: bool,
    /// Whether the next whole frame may have any time.
    may_jump: bool,
    last_us: Option<u32>,
    /// Time before the last start of the clock at 0.
    before_us: f64,
    is_intra: bool,
}

impl MainFrames {
    /// `None` for a header that does not describe main frames with a time.
    pub(super) fn of(header: &Header) -> Option<Self> {
        let names = header.names()?;
        let count = names.len();
        let at = |wanted: &str| names.iter().position(|name| *name == wanted);
        let is_signed = header.signs().filter(|signs| signs.len() == count)?;
        Some(Self {
            intra: Coding::of(header, "I", count)?,
            inter: Coding::of(header, "P", count)?,
            is_signed,
            iteration: at("loopIteration"),
            time: at("time")?,
            intervals: header.intervals(),
            present: vec![0; count],
            last: vec![0; count],
            second_last: vec![0; count],
            has_last: false,
            may_jump: true,
            last_us: None,
            before_us: 0.0,
            is_intra: false,
        })
    }

    pub(super) fn intra_size(&self, bytes: &[u8]) -> Option<usize> {
        self.intra.layout.size_at(bytes)
    }

    pub(super) fn inter_size(&self, bytes: &[u8]) -> Option<usize> {
        self.inter.layout.size_at(bytes)
    }

    /// Decodes a whole frame; returns the number of its bytes. `None` if it is incomplete or not in the sequence of time.
    pub(super) fn decode_intra(&mut self, bytes: &[u8]) -> Option<usize> {
        let size = self.intra.layout.decode(bytes, &mut self.present)?;
        for (at, prediction) in self.intra.predictions.iter().enumerate() {
            let predicted = match *prediction {
                Prediction::Constant(value) => value,
                Prediction::Field(field) => self.present[field],
                // a whole frame depends on no other
                _ => 0,
            };
            self.present[at] = self.present[at].wrapping_add(predicted);
        }
        self.is_intra = true;
        self.is_in_sequence().then_some(size)
    }

    /// Decodes a frame of differences, like [`MainFrames::decode_intra`]. `None` as well if the last frames are not known.
    pub(super) fn decode_inter(&mut self, bytes: &[u8]) -> Option<usize> {
        if !self.has_last {
            return None;
        }
        let size = self.inter.layout.decode(bytes, &mut self.present)?;
        let skipped = self.skipped_loops();
        let frames = self.last.iter().zip(&self.second_last).zip(&self.is_signed);
        for (at, (prediction, ((&last, &second_last), &is_signed))) in
            self.inter.predictions.iter().zip(frames).enumerate()
        {
            let predicted = match *prediction {
                Prediction::Constant(value) => value,
                Prediction::Previous => last,
                Prediction::StraightLine => last.wrapping_mul(2).wrapping_sub(second_last),
                Prediction::Average if is_signed => ((i64::from(last) + i64::from(second_last)) / 2) as i32,
                Prediction::Average => {
                    ((u64::from(last.cast_unsigned()) + u64::from(second_last.cast_unsigned())) / 2) as i32
                }
                Prediction::Field(field) => self.present[field],
                Prediction::Increment => last.wrapping_add(1).wrapping_add(skipped),
            };
            self.present[at] = self.present[at].wrapping_add(predicted);
        }
        self.is_intra = false;
        self.is_in_sequence().then_some(size)
    }

    /// Number of loops between the last frame and this one that were not to be written.
    fn skipped_loops(&self) -> i32 {
        let [whole, numerator, denominator] = self.intervals;
        let Some(iteration) = self.iteration.filter(|_| denominator > 1) else { return 0 };
        let last = self.last[iteration].cast_unsigned();
        let is_written = |loops: u32| {
            let index = last.wrapping_add(1).wrapping_add(loops) % whole;
            index == 0 || index.wrapping_add(numerator).wrapping_sub(1) % denominator < numerator
        };
        (0..denominator.min(whole)).find(|loops| is_written(*loops)).unwrap_or(0).cast_signed()
    }

    fn is_in_sequence(&self) -> bool {
        let time_us = self.present[self.time].cast_unsigned();
        match self.last_us {
            Some(last_us) if !self.may_jump => time_us.wrapping_sub(last_us) < STEP_US_MAX,
            _ => true,
        }
    }

    /// Keeps the decoded frame as the last one, and returns its time.
    pub(super) fn keep(&mut self) -> f64 {
        std::mem::swap(&mut self.last, &mut self.second_last);
        std::mem::swap(&mut self.present, &mut self.last);
        if self.is_intra {
            self.second_last.copy_from_slice(&self.last);
        }
        let time_us = self.last[self.time].cast_unsigned();
        if self.last_us.is_some_and(|last_us| time_us < last_us && last_us - time_us > u32::MAX / 2) {
            self.before_us += TIME_US_COUNT;
        }
        (self.has_last, self.may_jump, self.last_us) = (true, false, Some(time_us));
        self.time_s(time_us)
    }

    fn time_s(&self, time_us: u32) -> f64 {
        1e-6 * (self.before_us + f64::from(time_us))
    }

    /// The last frame.
    pub(super) fn values(&self) -> &[i32] {
        &self.last
    }

    /// Something was lost: differences mean nothing up to the next whole frame.
    pub(super) fn lose(&mut self) {
        (self.has_last, self.may_jump) = (false, true);
    }

    /// The log goes on after a pause.
    pub(super) fn resume(&mut self) {
        self.may_jump = true;
    }

    pub(super) fn last_s(&self) -> Option<f64> {
        self.last_us.map(|last_us| self.time_s(last_us))
    }
}
