//! Passes over a source: the stretches of time that are wanted, block by block, planned and counted.

use crate::without_lines::LineFilter;
use crate::{SignalError, SignalSource, SteadyLines};
use std::ops::Range;

/// A time this close before a sample still includes it, in samples: times carry rounding errors. *Numeric.*
const SAMPLE_TOLERANCE: f64 = 1e-6;

/// How far an analysis has come, for a progress display.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Progress {
    /// Number of this pass over the sound, from 1.
    pub pass: u32,
    /// Number of passes that are planned, this one included.
    pub pass_count: u32,
    /// Position of the pass on the recording's clock.
    pub time_s: f64,
}

/// One event of a pass.
pub enum Piece<'a> {
    /// A stretch begins: its first sample is at this time.
    Start(f64),
    /// Samples of the stretch.
    Samples(&'a [f32]),
    /// A block was read up to this time, wanted or not.
    Heard(f64),
}

/// Takes in stretches of sound, one after the other.
pub trait StretchListener {
    /// A new stretch begins at `start_s` and should last `length_s`.
    fn restart(&mut self, start_s: f64, length_s: f64);

    /// The next samples of the stretch.
    fn push(&mut self, samples: &[f32]);
}

/// Several listeners in one pass.
impl<L: StretchListener> StretchListener for Vec<L> {
    fn restart(&mut self, start_s: f64, length_s: f64) {
        self.iter_mut().for_each(|listener| listener.restart(start_s, length_s));
    }

    fn push(&mut self, samples: &[f32]) {
        self.iter_mut().for_each(|listener| listener.push(samples));
    }
}

/// Two listeners of different kinds in one pass.
impl<A: StretchListener, B: StretchListener> StretchListener for (A, B) {
    fn restart(&mut self, start_s: f64, length_s: f64) {
        self.0.restart(start_s, length_s);
        self.1.restart(start_s, length_s);
    }

    fn push(&mut self, samples: &[f32]) {
        self.0.push(samples);
        self.1.push(samples);
    }
}

/// A source and the passes that an analysis plans to make over it.
///
/// Each pass reports its number and the number of passes planned. A pass whose need shows only on the way is announced with
/// [`Passes::expect_more`] before it begins, so that the count is never wrong when a pass runs.
pub struct Passes<'a> {
    source: &'a mut dyn SignalSource,
    sample_rate_hz: f64,
    planned: u32,
    made: u32,
    on_progress: &'a mut dyn FnMut(Progress),
    /// Lines that all later passes leave out.
    left_out: Option<(SteadyLines, LineFilter)>,
}

impl<'a> Passes<'a> {
    /// Plans `planned` passes over a source.
    ///
    /// # Errors
    /// A sample rate outside 1 kHz to 1 MHz.
    pub fn planned(
        source: &'a mut dyn SignalSource,
        planned: u32,
        on_progress: &'a mut dyn FnMut(Progress),
    ) -> Result<Self, SignalError> {
        let sample_rate_hz = checked_rate_hz(source)?;
        Ok(Self { source, sample_rate_hz, planned, made: 0, on_progress, left_out: None })
    }

    /// Samples per second.
    pub fn sample_rate_hz(&self) -> f64 {
        self.sample_rate_hz
    }

    /// Time of the first sample on the recording's clock.
    pub fn start_s(&self) -> f64 {
        self.source.start_s()
    }

    /// Adds passes to the plan.
    pub fn expect_more(&mut self, passes: u32) {
        self.planned += passes;
    }

    /// Leaves these lines, and no others, out of the sound in all later passes.
    pub fn leave_out(&mut self, lines: Option<SteadyLines>) {
        self.left_out = lines.map(|lines| {
            let filter = LineFilter::new(&lines, self.sample_rate_hz);
            (lines, filter)
        });
    }

    /// The lines that are left out of the sound.
    pub fn left_out(&self) -> Option<&SteadyLines> {
        self.left_out.as_ref().map(|(lines, _)| lines)
    }

    /// One pass: hands out the samples in `spans_s` (in order, not overlapping), and ends after the last span.
    ///
    /// Returns the time at which the source or the last span ended.
    ///
    /// # Errors
    /// A source that fails.
    pub fn pieces(&mut self, spans_s: &[Range<f64>], mut on_piece: impl FnMut(Piece<'_>)) -> Result<f64, SignalError> {
        self.made += 1;
        let (pass, pass_count) = (self.made, self.planned.max(self.made));
        let on_progress = &mut *self.on_progress;
        let on_piece = |piece: Piece<'_>| {
            if let Piece::Heard(time_s) = piece {
                on_progress(Progress { pass, pass_count, time_s });
            }
            on_piece(piece);
        };
        match &mut self.left_out {
            Some((_, filter)) => for_each_piece(&mut filter.over(self.source), spans_s, on_piece),
            None => for_each_piece(self.source, spans_s, on_piece),
        }
    }

    /// One pass: a listener takes in the stretches `spans_s`.
    ///
    /// # Errors
    /// A source that fails.
    pub fn listen(&mut self, spans_s: &[Range<f64>], listener: &mut impl StretchListener) -> Result<(), SignalError> {
        let mut lengths_s = spans_s.iter().map(|span| span.end - span.start);
        self.pieces(spans_s, |piece| match piece {
            Piece::Start(start_s) => listener.restart(start_s, lengths_s.next().unwrap_or(0.0)),
            Piece::Samples(samples) => listener.push(samples),
            Piece::Heard(_) => {}
        })?;
        Ok(())
    }
}

/// Reads a source from its start and hands out the samples in `spans_s` (in order, not overlapping). Ends after the last span. Holds no
/// more than one block.
///
/// Returns the time at which the source or the last span ended.
///
/// # Errors
/// A source that fails, or whose sample rate is outside 1 kHz to 1 MHz.
pub fn for_each_piece(
    source: &mut dyn SignalSource,
    spans_s: &[Range<f64>],
    mut on_piece: impl FnMut(Piece<'_>),
) -> Result<f64, SignalError> {
    let sample_rate_hz = checked_rate_hz(source)?;
    let start_s = source.start_s();
    // the first sample at or after a time
    let sample_at = |time_s: f64| {
        ((time_s - start_s) * sample_rate_hz - SAMPLE_TOLERANCE).ceil().clamp(0.0, u64::MAX as f64) as u64
    };
    let ranges: Vec<(u64, u64)> = spans_s.iter().map(|span| (sample_at(span.start), sample_at(span.end))).collect();
    let time_s = |sample: u64| start_s + sample as f64 / sample_rate_hz;
    let end = ranges.last().map_or(0, |range| range.1);
    let (mut position, mut current) = (0u64, None);
    source.rewind()?;
    while position < end {
        let Some(block) = source.next_block()? else { break };
        let block_end = position + block.len() as u64;
        for (index, &(from, to)) in ranges.iter().enumerate() {
            let (first, last) = (from.max(position), to.min(block_end));
            if first < last {
                if current != Some(index) {
                    current = Some(index);
                    on_piece(Piece::Start(time_s(first)));
                }
                on_piece(Piece::Samples(&block[(first - position) as usize..(last - position) as usize]));
            }
        }
        position = block_end;
        on_piece(Piece::Heard(time_s(position)));
    }
    Ok(time_s(position.min(end)))
}

/// The sample rate of a source.
///
/// # Errors
/// A rate outside 1 kHz to 1 MHz.
fn checked_rate_hz(source: &dyn SignalSource) -> Result<f64, SignalError> {
    let sample_rate_hz = source.sample_rate_hz();
    if (1e3..=1e6).contains(&sample_rate_hz) {
        Ok(sample_rate_hz)
    } else {
        Err(SignalError::SampleRate { sample_rate_hz })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Signal;

    #[test]
    fn spans_are_cut_to_the_sample_on_the_recordings_clock() {
        let samples: Vec<f32> = (0..4000).map(|n| n as f32).collect();
        let mut source = Signal::new(samples, 1000.0).with_start_s(1.0);
        let spans = [0.0..1.5, 2.0..2.25, 4.9..9.0];
        let mut pieces: Vec<(f64, Vec<f32>)> = Vec::new();
        let end_s = for_each_piece(&mut source, &spans, |piece| match piece {
            Piece::Start(time_s) => pieces.push((time_s, Vec::new())),
            Piece::Samples(samples) => pieces.last_mut().unwrap().1.extend_from_slice(samples),
            Piece::Heard(_) => {}
        })
        .unwrap();
        assert_eq!(end_s, 5.0);
        let ends: Vec<_> = pieces.iter().map(|(at, s)| (*at, s[0], s[s.len() - 1])).collect();
        assert_eq!(ends, [(1.0, 0.0, 499.0), (2.0, 1000.0, 1249.0), (4.9, 3900.0, 3999.0)]);
    }

    #[test]
    fn an_impossible_rate_is_refused() {
        for rate in [0.0, -1.0, f64::NAN, f64::INFINITY, 1e9] {
            let mut source = Signal::new(vec![0.0; 10], rate);
            assert!(for_each_piece(&mut source, std::slice::from_ref(&(0.0..1.0)), |_| {}).is_err(), "{rate}");
        }
    }

    #[test]
    fn passes_are_counted_and_one_more_is_announced() {
        let mut source = Signal::new(vec![0.0; 4000], 1000.0);
        let mut seen = Vec::new();
        let mut on_progress = |progress: Progress| seen.push((progress.pass, progress.pass_count));
        let mut passes = Passes::planned(&mut source, 2, &mut on_progress).unwrap();
        let all = 0.0..4.0;
        passes.pieces(std::slice::from_ref(&all), |_| {}).unwrap();
        passes.expect_more(1);
        passes.pieces(std::slice::from_ref(&all), |_| {}).unwrap();
        passes.pieces(std::slice::from_ref(&all), |_| {}).unwrap();
        assert_eq!(seen, [(1, 2), (2, 3), (3, 3)]);
    }
}
