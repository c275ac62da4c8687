//! A part of a recording as a picture for the page, and as sound for its player.

use hound::{SampleFormat, WavSpec, WavWriter};
use hovertone::speed::Span;
use hovertone_figures::{PictureConfig, PictureView, levels_of_picture, pictures_from_source};
use hovertone_media::Recording;
use hovertone_page::clip_from_source;
use std::io::Cursor;
use wasm_bindgen::prelude::wasm_bindgen;

/// Length of a frame where a second has few columns.
const LONG_FRAME_S: f64 = 0.128;
/// Length of a frame in the shortest span.
const SHORT_FRAME_S: f64 = 0.016;
/// From this length of a recording on, frames do not overlap: the first picture comes twice as fast.
const LONG_RECORDING_S: f64 = 300.0;
/// Frames in the shortest span that is looked at.
const FRAMES_MIN: f64 = 8.0;
/// Columns that a short span has at least, by frames that overlap more.
const COLUMNS_MIN: f64 = 400.0;
/// Smallest step between frames, as a share of their length.
const HOP_SHARE_MIN: f64 = 0.05;

/// A spectrogram as levels: one byte for each cell, column by column from low frequency to high.
#[wasm_bindgen]
pub struct Levels {
    cells: Vec<u8>,
    /// Number of columns, in order of time.
    pub columns: usize,
    /// Number of rows.
    pub rows: usize,
    /// Left edge of the first column.
    pub from_s: f64,
    /// Right edge of the last column.
    pub to_s: f64,
    /// Lower edge of the first row.
    pub hz_low: f64,
    /// Upper edge of the last row.
    pub hz_high: f64,
    /// Level of the darkest colour, dB re a full-scale sine.
    pub level_db_low: f64,
    /// Level of the brightest colour.
    pub level_db_high: f64,
    /// Length of the sound, where its header tells it.
    pub declared_s: f64,
}

#[wasm_bindgen]
impl Levels {
    /// The levels, and an empty memory behind them.
    pub fn take(&mut self) -> Vec<u8> {
        std::mem::take(&mut self.cells)
    }
}

/// The levels of a part of a recording between two frequencies, with at most the given numbers of columns and rows.
pub(crate) fn levels_of(
    recording: &mut Recording,
    [from_s, to_s]: [f64; 2],
    [hz_low, hz_high]: [f64; 2],
    [columns_max, rows_max]: [usize; 2],
) -> Result<Levels, String> {
    let (declared_s, rate_hz) = (recording.info().declared_duration_s, recording.info().sample_rate_hz);
    let length_s = declared_s.unwrap_or(f64::INFINITY).min(to_s - from_s);
    let default = PictureConfig::default();
    let is_long = length_s > LONG_RECORDING_S;
    let window_s = if is_long { default.window_s } else { LONG_FRAME_S.min(length_s / FRAMES_MIN).max(SHORT_FRAME_S) };
    let hop_share = match is_long {
        true => 1.0,
        false => (length_s / COLUMNS_MIN / window_s).clamp(HOP_SHARE_MIN, default.hop_share),
    };
    let config = PictureConfig { hop_share, columns_max, rows_max, zoom_window_s: window_s, ..default };
    let view = PictureView { harmonic: None, hz_low, hz_high: hz_high.min(rate_hz / 2.0), window_s };
    let span = Span { from_s: from_s.max(recording.info().start_s), to_s };
    let pictures = pictures_from_source(recording, span, &[view], &[], &config).map_err(|error| error.to_string())?;
    let picture = pictures.pictures.into_iter().next().ok_or("the sound is too short for a picture")?;
    let levels = levels_of_picture(&picture);
    Ok(Levels {
        cells: levels.cells,
        columns: picture.column_count,
        rows: picture.row_count,
        from_s: picture.span.from_s,
        to_s: picture.span.to_s,
        hz_low: picture.hz_low,
        hz_high: picture.hz_high,
        level_db_low: levels.level_db_low,
        level_db_high: levels.level_db_high,
        declared_s: declared_s.unwrap_or(0.0),
    })
}

/// A part of a recording as a WAV file of 16 bits.
pub(crate) fn sound_wav(recording: &mut Recording, [from_s, to_s]: [f64; 2]) -> Result<Vec<u8>, String> {
    let clip = clip_from_source(recording, Span { from_s, to_s }).map_err(|error| error.to_string())?;
    wav_of(&clip.samples, clip.sample_rate_hz.round() as u32)
}

/// Samples of one channel as a WAV file of 16 bits.
pub(crate) fn wav_of(samples: &[f32], sample_rate: u32) -> Result<Vec<u8>, String> {
    let spec = WavSpec { channels: 1, sample_rate, bits_per_sample: 16, sample_format: SampleFormat::Int };
    let whole = |&sample: &f32| hovertone_sim::scenario::SampleFormat::whole_number(16, sample) as i16;
    written(samples.iter().map(whole), spec)
}

/// Samples of one channel as a WAV file of 32-bit floats: the samples themselves.
pub(crate) fn wav_of_floats(samples: &[f32], sample_rate: u32) -> Result<Vec<u8>, String> {
    let spec = WavSpec { channels: 1, sample_rate, bits_per_sample: 32, sample_format: SampleFormat::Float };
    written(samples.iter().copied(), spec)
}

fn written<S: hound::Sample>(samples: impl Iterator<Item = S>, spec: WavSpec) -> Result<Vec<u8>, String> {
    let mut bytes = Cursor::new(Vec::new());
    let write = || -> hound::Result<()> {
        let mut writer = WavWriter::new(&mut bytes, spec)?;
        for sample in samples {
            writer.write_sample(sample)?;
        }
        writer.finalize()
    };
    write().map_err(|error| error.to_string())?;
    Ok(bytes.into_inner())
}
