//! Power spectra over orders in frames of whole turns along a path: a line that follows the path stands in one bin through a step.

use super::SpeedPath;
use super::lines::TrackedLines;
use crate::error::Error;
use crate::tone::ToneConfig;
use hovertone_signal::passes::{Passes, StretchListener};
use realfft::num_complex::Complex;
use std::f64::consts::TAU;
use std::ops::Range;

/// Turns of a frame: half orders are resolved. *Numeric.*
const TURNS: f64 = 4.0;
/// Highest order: with rotors a per cent apart, lines above it are no longer narrow against their distance. *Decision.*
const ORDER_MAX: f64 = 40.0;

/// A part of a recording and the path in it.
#[derive(Clone, Debug)]
pub struct PathWindow {
    /// From the middle of the first frame to that of the last.
    pub span_s: Range<f64>,
    /// Time between frames.
    pub hop_s: f64,
    /// Speed of the rotors.
    pub path: SpeedPath,
}

/// The spectra of a [`PathWindow`].
#[derive(Clone, Debug, Default, PartialEq)]
pub struct TurnFrames {
    /// Turns of a frame: its bins are 1/turns orders apart.
    pub turns: f64,
    /// Order of the first bin, in bins.
    pub first_bin: usize,
    /// Orders of the lines.
    pub orders: Vec<f64>,
    /// The frames, in the sequence of time.
    pub frames: Vec<TurnFrame>,
}

/// A Hann frame over the turns of the shaft.
#[derive(Clone, Debug, PartialEq)]
pub struct TurnFrame {
    /// Its middle.
    pub centre_s: f64,
    /// Its length.
    pub length_s: f64,
    /// Times in the middle of equal parts of its turns.
    pub place_s: Vec<f64>,
    /// Power of each bin.
    pub power: Vec<f64>,
}

/// The spectra of some windows, which do not overlap and are in the sequence of time; one pass. `places`: parts of a frame whose times are
/// given. Windows without a line have no frames.
///
/// # Errors
/// A source that fails.
pub fn turn_frames_from_passes(
    passes: &mut Passes<'_>,
    tone: &ToneConfig,
    heard_rev_s: f64,
    windows: &[PathWindow],
    places: usize,
) -> Result<Vec<TurnFrames>, Error> {
    let lines = TrackedLines::of_heard(tone, heard_rev_s, passes.sample_rate_hz());
    let margin_s = TURNS / lines.slowest_rev_s;
    let spans_s: Vec<Range<f64>> =
        windows.iter().map(|window| (window.span_s.start - margin_s).max(0.0)..window.span_s.end + margin_s).collect();
    let mut listener = WindowListener { sounds: Vec::new() };
    passes.listen(&merged(&spans_s), &mut listener)?;
    let rate_hz = passes.sample_rate_hz();
    Ok(windows.iter().map(|window| frames_of(window, &lines, &listener.sounds, rate_hz, places)).collect())
}

/// Spans that touch or overlap become one.
fn merged(spans_s: &[Range<f64>]) -> Vec<Range<f64>> {
    let mut merged: Vec<Range<f64>> = Vec::new();
    for span_s in spans_s {
        match merged.last_mut() {
            Some(last) if span_s.start <= last.end => last.end = last.end.max(span_s.end),
            _ => merged.push(span_s.clone()),
        }
    }
    merged
}

/// Keeps the sound of the windows.
struct WindowListener {
    sounds: Vec<KeptSound>,
}

struct KeptSound {
    start_s: f64,
    samples: Vec<f32>,
}

impl StretchListener for WindowListener {
    fn restart(&mut self, start_s: f64, _length_s: f64) {
        self.sounds.push(KeptSound { start_s, samples: Vec::new() });
    }

    fn push(&mut self, samples: &[f32]) {
        if let Some(sound) = self.sounds.last_mut() {
            sound.samples.extend_from_slice(samples);
        }
    }
}

fn frames_of(
    window: &PathWindow,
    lines: &TrackedLines,
    sounds: &[KeptSound],
    rate_hz: f64,
    places: usize,
) -> TurnFrames {
    let fastest_rev_s = window.path.speed_rev_s.iter().copied().fold(f64::MIN_POSITIVE, f64::max);
    let count = lines.count_at(fastest_rev_s).min((ORDER_MAX / lines.order) as u32);
    let Some(sound) = sounds.iter().rev().find(|sound| sound.start_s <= window.span_s.start) else {
        return TurnFrames::default();
    };
    if count == 0 {
        return TurnFrames::default();
    }
    let mut turned = 0.0;
    let turns: Vec<f64> = (0..sound.samples.len())
        .map(|sample| {
            turned += window.path.at(sound.start_s + sample as f64 / rate_hz) / rate_hz;
            turned
        })
        .collect();
    let first_bin = (0.5 * lines.order * TURNS).round().max(1.0) as usize;
    let bin_count = (f64::from(count) * lines.order * TURNS) as usize;
    let turned = TurnedSound { samples: &sound.samples, turns: &turns, start_s: sound.start_s, rate_hz };
    let centres = ((window.span_s.end - window.span_s.start) / window.hop_s) as usize + 1;
    let frame = |at: usize| {
        let centre_s = window.span_s.start + at as f64 * window.hop_s;
        turned.frame(centre_s, first_bin..first_bin + bin_count, places)
    };
    TurnFrames {
        turns: TURNS,
        first_bin,
        orders: (1..=count).map(|number| f64::from(number) * lines.order).collect(),
        frames: (0..centres).filter_map(frame).collect(),
    }
}

/// Samples with the turns of the path since the first.
struct TurnedSound<'a> {
    samples: &'a [f32],
    turns: &'a [f64],
    start_s: f64,
    rate_hz: f64,
}

impl TurnedSound<'_> {
    fn time_s(&self, sample: usize) -> f64 {
        self.start_s + sample as f64 / self.rate_hz
    }

    /// A frame; `None` at the ends of the sound.
    fn frame(&self, centre_s: f64, bins: Range<usize>, places: usize) -> Option<TurnFrame> {
        let middle = ((centre_s - self.start_s) * self.rate_hz).round().max(0.0) as usize;
        let centre = *self.turns.get(middle)?;
        let at = |turn: f64| self.turns.partition_point(|&turns| turns < turn);
        let (from, to) = (at(centre - 0.5 * TURNS), at(centre + 0.5 * TURNS));
        if from == 0 || to >= self.turns.len() {
            return None;
        }
        let mut power = vec![Complex::new(0.0, 0.0); bins.len()];
        for sample in from..to {
            let turn = self.turns[sample] - centre;
            let weight = 0.5 + 0.5 * (TAU * turn / TURNS).cos();
            let angle_step = self.turns[sample] - self.turns[sample - 1];
            let mut value = Complex::from_polar(
                f64::from(self.samples[sample]) * weight * angle_step / TURNS,
                -TAU * bins.start as f64 * turn / TURNS,
            );
            let step = Complex::from_polar(1.0, -TAU * turn / TURNS);
            for sum in &mut power {
                *sum += value;
                value *= step;
            }
        }
        let place = |place: usize| {
            let turn = centre + ((place as f64 + 0.5) / places as f64 - 0.5) * TURNS;
            self.time_s(at(turn))
        };
        Some(TurnFrame {
            centre_s: self.time_s(middle),
            length_s: (to - from) as f64 / self.rate_hz,
            place_s: (0..places).map(place).collect(),
            power: power.into_iter().map(|sum| sum.norm_sqr()).collect(),
        })
    }
}
