//! The main frames: a whole one every now and then, and differences to predictions in between.

use super::encoding::FrameLayout;
use super::header::Header;
use std::ops::Range;

/// A main frame follows the one before it within this time, unless something lies between them.
const STEP_US_MAX: u32 = 10_000_000;
/// Longest distance of whole frames, in loops.
const WHOLE_MAX: u32 = 4096;
/// Times have 32 bits and start again at 0.
const TIME_US_COUNT: f64 = 4_294_967_296.0;

/// What a value is predicted from.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Prediction {
    Constant(i32),
    Previous,
    StraightLine,
    Average {
        is_signed: bool,
    },
    /// Another value of the same frame.
    Field(usize),
    /// One more than the previous value, and one for each loop that was not written.
    Increment,
}

/// One kind of main frames.
struct Coding {
    layout: FrameLayout,
    runs: Vec<Run>,
}

/// Neighbouring fields with the same prediction.
struct Run {
    prediction: Prediction,
    fields: Range<usize>,
}

/// Runs of predictions. Each value that is predicted from another of its frame is a run: the other may be its neighbour.
fn runs_of(predictions: &[Prediction]) -> Vec<Run> {
    let mut runs: Vec<Run> = Vec::new();
    for (at, &prediction) in predictions.iter().enumerate() {
        let is_alone = matches!(prediction, Prediction::Field(_));
        match runs.last_mut().filter(|run| run.prediction == prediction && !is_alone) {
            Some(run) => run.fields.end = at + 1,
            None => runs.push(Run { prediction, fields: at..at + 1 }),
        }
    }
    runs
}

impl Coding {
    fn of(header: &Header, letter: &str, field_count: usize) -> Option<Self> {
        let layout = header.layout(letter)?;
        let predictions = header.predictions(letter)?;
        let is_sound = layout.field_count() == field_count && predictions.len() == field_count;
        is_sound.then(|| Self { layout, runs: runs_of(&predictions) })
    }
}

/// The main frames of a log, in their sequence.
pub(super) struct MainFrames {
    intra: Coding,
    inter: Coding,
    /// Numbers of these values.
    iteration: Option<usize>,
    time: usize,
    /// By the number of the last frame, modulo the length: loops before the next frame that are not written.
    skipped: Vec<i32>,
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

/// Adds predictions from the last and the second last frame.
#[inline]
fn add(present: &mut [i32], last: &[i32], second_last: &[i32], predicted: impl Fn(i32, i32) -> i32) {
    for ((value, &last), &second_last) in present.iter_mut().zip(last).zip(second_last) {
        *value = value.wrapping_add(predicted(last, second_last));
    }
}

/// The average without its fraction.
fn signed_average(one: i32, other: i32) -> i32 {
    ((i64::from(one) + i64::from(other)) / 2) as i32
}

fn unsigned_average(one: i32, other: i32) -> i32 {
    ((u64::from(one.cast_unsigned()) + u64::from(other.cast_unsigned())) / 2) as i32
}

/// Number of loops behind each loop, up to the next whole frame, that are not written. Of each `whole` loops the first is written as a whole;
/// of the others, `numerator` of `denominator` are written.
fn skipped_loops([whole, numerator, denominator]: [u32; 3]) -> Vec<i32> {
    let whole = whole.min(WHOLE_MAX);
    let is_written = |index: u32| {
        let index = index % whole;
        index == 0 || index.wrapping_add(numerator).wrapping_sub(1) % denominator < numerator
    };
    let skipped = |last: u32| (last + 1..=last + whole).take_while(|index| !is_written(*index)).count();
    (0..whole).map(|last| skipped(last) as i32).collect()
}

impl MainFrames {
    /// `None` for a header that does not describe main frames with a time.
    pub(super) fn of(header: &Header) -> Option<Self> {
        let names = header.names()?;
        let count = names.len();
        let at = |wanted: &str| names.iter().position(|name| *name == wanted);
        Some(Self {
            intra: Coding::of(header, "I", count)?,
            inter: Coding::of(header, "P", count)?,
            iteration: at("loopIteration"),
            time: at("time")?,
            skipped: skipped_loops(header.intervals()),
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
        for Run { prediction, fields } in &self.intra.runs {
            let predicted = match *prediction {
                Prediction::Constant(value) => value,
                Prediction::Field(field) => self.present[field],
                // a whole frame depends on no other
                _ => 0,
            };
            let values = &mut self.present[fields.clone()];
            values.iter_mut().for_each(|value| *value = value.wrapping_add(predicted));
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
        let last_loop = self.iteration.map_or(0, |iteration| self.last[iteration].cast_unsigned() as usize);
        let skipped = self.skipped[last_loop % self.skipped.len()];
        for Run { prediction, fields } in &self.inter.runs {
            let (last, second_last) = (&self.last[fields.clone()], &self.second_last[fields.clone()]);
            let predicted = match *prediction {
                Prediction::Field(field) => Prediction::Constant(self.present[field]),
                other => other,
            };
            let present = &mut self.present[fields.clone()];
            match predicted {
                Prediction::Constant(value) => add(present, last, second_last, |_, _| value),
                Prediction::Previous => add(present, last, second_last, |last, _| last),
                Prediction::StraightLine => {
                    add(present, last, second_last, |last, before| last.wrapping_mul(2).wrapping_sub(before));
                }
                Prediction::Average { is_signed: true } => add(present, last, second_last, signed_average),
                Prediction::Average { is_signed: false } => add(present, last, second_last, unsigned_average),
                Prediction::Increment => add(present, last, second_last, |last, _| last.wrapping_add(1 + skipped)),
                // was replaced by its value
                Prediction::Field(_) => {}
            }
        }
        self.is_intra = false;
        self.is_in_sequence().then_some(size)
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
