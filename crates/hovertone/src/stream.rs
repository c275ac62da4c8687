//! A source, cut to stretches of time, without ever holding more than a block.

use crate::error::Error;
use crate::signal::SignalSource;
use crate::span::Span;

/// Part of an analysis that reads the sound, for a progress display.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Progress {
    /// Which reading of the sound this is.
    pub pass: u32,
    /// How many readings there are.
    pub pass_count: u32,
    /// How far on the recording's clock it has come.
    pub time_s: f64,
}

/// What comes out of a cut stream.
pub(crate) enum Piece<'a> {
    /// A stretch begins: the next samples start at this time.
    Start(f64),
    /// Samples of the stretch.
    Samples(&'a [f32]),
    /// A block was read, whether or not it was wanted.
    Heard(f64),
}

/// Reads a source from its start and hands out what lies in `spans` (in order, not overlapping). Stops after the last
/// span. Returns the time at which the source, or the last span, ended.
pub(crate) fn for_each_piece(
    source: &mut dyn SignalSource,
    spans: &[Span],
    mut on_piece: impl FnMut(Piece<'_>),
) -> Result<f64, Error> {
    let sample_rate_hz = checked_rate_hz(source)?;
    let start_s = source.start_s();
    // the first sample at or after a time; the last digits of a time must not cost a sample
    let sample_at =
        |time_s: f64| ((time_s - start_s) * sample_rate_hz - 1e-6).ceil().clamp(0.0, u64::MAX as f64) as u64;
    let ranges: Vec<(u64, u64)> = spans.iter().map(|span| (sample_at(span.from_s), sample_at(span.to_s))).collect();
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

pub(crate) fn checked_rate_hz(source: &dyn SignalSource) -> Result<f64, Error> {
    let sample_rate_hz = source.sample_rate_hz();
    if (1e3..=1e6).contains(&sample_rate_hz) { Ok(sample_rate_hz) } else { Err(Error::SampleRate { sample_rate_hz }) }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::signal::Signal;

    #[test]
    fn spans_are_cut_to_the_sample_on_the_recordings_clock() {
        let samples: Vec<f32> = (0..4000).map(|n| n as f32).collect();
        let mut source = Signal::new(samples, 1000.0).with_start_s(1.0);
        let spans =
            [Span { from_s: 0.0, to_s: 1.5 }, Span { from_s: 2.0, to_s: 2.25 }, Span { from_s: 4.9, to_s: 9.0 }];
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
            assert!(for_each_piece(&mut source, &[Span { from_s: 0.0, to_s: 1.0 }], |_| {}).is_err(), "{rate}");
        }
    }
}
