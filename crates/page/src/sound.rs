//! The sound of a recording, small enough for a page.

use audioadapter_buffers::direct::InterleavedSlice;
use base64::Engine as _;
use base64::engine::general_purpose::STANDARD;
use hovertone_analysis::Span;
use hovertone_signal::{SignalSource, SourceError};
use rubato::audioadapter::Adapter;
use rubato::{Async, FixedAsync, Resampler, SincInterpolationParameters, WindowFunction};

/// Sample rates that every browser plays, highest first.
const RATES_HZ: [u32; 6] = [48_000, 24_000, 16_000, 12_000, 8000, 6000];
const BYTES_PER_SAMPLE: usize = 2;
/// Bytes of base64 text per byte of sound.
const TEXT_PER_BYTE: f64 = 4.0 / 3.0;
/// Most seconds of a recording: a minute is enough to recognise a hover.
pub const SOUND_S_MAX: f64 = 60.0;
/// Share of full scale for the loudest sample, since distant hovers are quiet.
const PEAK_SHARE: f32 = 0.7;
/// Largest gain: beyond it only the noise becomes louder.
const GAIN_MAX: f32 = 30.0;
/// Frames per step of the resampler; the result does not depend on it.
const CHUNK_FRAMES: usize = 1024;
/// Samples of the filter of the resampler, at the lower rate.
const FILTER_SAMPLES: usize = 128;

/// A part of the sound of a recording.
#[derive(Clone, Debug, PartialEq)]
pub struct SoundClip {
    /// Start on the clock of the recording.
    pub from_s: f64,
    /// Samples per second.
    pub sample_rate_hz: f64,
    /// Samples, full scale ±1.
    pub samples: Vec<f32>,
}

/// The part of a source between two times.
///
/// # Errors
/// A source that fails.
pub fn clip_from_source(source: &mut dyn SignalSource, span: Span) -> Result<SoundClip, SourceError> {
    let (sample_rate_hz, start_s) = (source.sample_rate_hz(), source.start_s());
    let sample_at = |time_s: f64| ((time_s - start_s) * sample_rate_hz).round().max(0.0) as usize;
    let (first, end) = (sample_at(span.from_s), sample_at(span.to_s));
    let (mut position, mut samples) = (0, Vec::new());
    source.rewind()?;
    while position < end {
        let Some(block) = source.next_block()? else { break };
        let from = first.clamp(position, position + block.len()) - position;
        let to = end.min(position + block.len()) - position;
        samples.extend_from_slice(block.get(from..to).unwrap_or_default());
        position += block.len();
    }
    Ok(SoundClip { from_s: start_s + first as f64 / sample_rate_hz, sample_rate_hz, samples })
}

/// The highest rate at which all clips together have at most `bytes_max` bytes as text in a page, and the number of clips with sound.
/// Where even the lowest rate is too much, the number of first clips that fit.
pub(crate) fn rate_and_count(clips: &[&SoundClip], bytes_max: f64) -> (u32, usize) {
    let bytes = |clips: &[&SoundClip], rate_hz: u32| {
        let seconds: f64 = clips.iter().map(|clip| clip.samples.len() as f64 / clip.sample_rate_hz).sum();
        seconds * f64::from(rate_hz) * BYTES_PER_SAMPLE as f64 * TEXT_PER_BYTE
    };
    if let Some(rate_hz) = RATES_HZ.into_iter().find(|&rate_hz| bytes(clips, rate_hz) <= bytes_max) {
        return (rate_hz, clips.len());
    }
    let lowest_hz = RATES_HZ[RATES_HZ.len() - 1];
    let fitting = (0..=clips.len()).take_while(|&count| bytes(&clips[..count], lowest_hz) <= bytes_max).last();
    (lowest_hz, fitting.unwrap_or(0))
}

/// The clip as a 16-bit WAV at a rate, as a data URI. A clip with a lower rate keeps it. `None` for a silent clip.
pub(crate) fn wav_uri(clip: &SoundClip, rate_hz: u32) -> Option<String> {
    let own_hz = clip.sample_rate_hz.round() as u32;
    let (samples, rate_hz) =
        if rate_hz < own_hz { (resampled(clip, rate_hz)?, rate_hz) } else { (clip.samples.clone(), own_hz) };
    let peak = samples.iter().fold(0.0, |peak: f32, sample| peak.max(sample.abs()));
    if peak <= 0.0 || !peak.is_finite() {
        return None;
    }
    let gain = (PEAK_SHARE / peak).min(GAIN_MAX);
    let mut wav = header(samples.len(), rate_hz);
    for sample in samples {
        let scaled = (sample * gain).clamp(-1.0, 1.0) * f32::from(i16::MAX);
        wav.extend_from_slice(&(scaled.round() as i16).to_le_bytes());
    }
    Some(format!("data:audio/wav;base64,{}", STANDARD.encode(wav)))
}

/// Band-limited resampling to the new rate; `None` where the clip is too short.
fn resampled(clip: &SoundClip, rate_hz: u32) -> Option<Vec<f32>> {
    let ratio = f64::from(rate_hz) / clip.sample_rate_hz.round();
    let filter_samples = (FILTER_SAMPLES as f64 / ratio) as usize;
    let filter = SincInterpolationParameters::new(filter_samples, WindowFunction::BlackmanHarris2);
    let mut resampler = Async::<f32>::new_sinc(ratio, 1.0, &filter, CHUNK_FRAMES, 1, FixedAsync::Input).ok()?;
    let input = InterleavedSlice::new(&clip.samples, 1, clip.samples.len()).ok()?;
    let output = resampler.process_all(&input, clip.samples.len(), None).ok()?;
    (0..output.frames()).map(|frame| output.read_sample(0, frame)).collect()
}

/// The header of a mono PCM file, 44 bytes.
fn header(sample_count: usize, rate_hz: u32) -> Vec<u8> {
    let bytes = (sample_count * BYTES_PER_SAMPLE) as u32;
    let mut header = Vec::with_capacity(44 + bytes as usize);
    header.extend_from_slice(b"RIFF");
    header.extend_from_slice(&(36 + bytes).to_le_bytes());
    header.extend_from_slice(b"WAVEfmt ");
    header.extend_from_slice(&16u32.to_le_bytes());
    for field in [1u16, 1] {
        header.extend_from_slice(&field.to_le_bytes());
    }
    header.extend_from_slice(&rate_hz.to_le_bytes());
    header.extend_from_slice(&(rate_hz * BYTES_PER_SAMPLE as u32).to_le_bytes());
    for field in [BYTES_PER_SAMPLE as u16, 8 * BYTES_PER_SAMPLE as u16] {
        header.extend_from_slice(&field.to_le_bytes());
    }
    header.extend_from_slice(b"data");
    header.extend_from_slice(&bytes.to_le_bytes());
    header
}

#[cfg(test)]
mod tests {
    use super::*;
    use hovertone_signal::Signal;
    use std::f64::consts::TAU;

    fn clip(seconds: f64, rate_hz: f64, tone_hz: f64) -> SoundClip {
        let samples =
            (0..(seconds * rate_hz) as usize).map(|n| (0.1 * (TAU * tone_hz * n as f64 / rate_hz).sin()) as f32);
        SoundClip { from_s: 0.0, sample_rate_hz: rate_hz, samples: samples.collect() }
    }

    fn decoded(uri: &str) -> (u32, Vec<i16>) {
        let bytes = STANDARD.decode(uri.strip_prefix("data:audio/wav;base64,").unwrap()).unwrap();
        assert_eq!((&bytes[..4], &bytes[8..16], &bytes[36..40]), (&b"RIFF"[..], &b"WAVEfmt "[..], &b"data"[..]));
        let number = |at: usize| u32::from_le_bytes(bytes[at..at + 4].try_into().unwrap());
        assert_eq!(number(4) as usize + 8, bytes.len());
        assert_eq!(number(40) as usize + 44, bytes.len());
        let samples = bytes[44..].chunks(2).map(|pair| i16::from_le_bytes(pair.try_into().unwrap()));
        (number(24), samples.collect())
    }

    #[test]
    fn a_tone_keeps_its_pitch_and_time_at_a_lower_rate() {
        let (rate_hz, samples) = decoded(&wav_uri(&clip(2.0, 48_000.0, 1000.0), 12_000).unwrap());
        assert_eq!(rate_hz, 12_000);
        assert!(samples.len().abs_diff(24_000) <= 12, "{}", samples.len());
        let crossings = samples.windows(2).filter(|pair| pair[0] < 0 && pair[1] >= 0).count();
        assert!(crossings.abs_diff(2000) <= 2, "{crossings}");
        // away from the ends, where the resampler rings
        let peak = samples[1000..20_000].iter().map(|sample| sample.unsigned_abs()).max().unwrap();
        assert!((f64::from(peak) / f64::from(i16::MAX) - f64::from(PEAK_SHARE)).abs() < 0.05, "{peak}");
    }

    #[test]
    fn what_a_rate_cannot_hold_is_silent_and_silence_is_no_sound() {
        assert_eq!(decoded(&wav_uri(&clip(1.0, 8000.0, 440.0), 12_000).unwrap()).0, 8000);
        assert_eq!(wav_uri(&clip(1.0, 8000.0, 0.0), 12_000), None);
        assert_eq!(wav_uri(&clip(0.0, 8000.0, 440.0), 12_000), None);
        // a faint click is not amplified without limit, which would only amplify noise
        let faint = SoundClip { samples: vec![1e-4; 100], ..clip(0.0, 8000.0, 0.0) };
        let loudest = decoded(&wav_uri(&faint, 8000).unwrap()).1.into_iter().max().unwrap();
        assert!((f32::from(loudest) / f32::from(i16::MAX) - 1e-4 * GAIN_MAX).abs() < 1e-3, "{loudest}");
    }

    #[test]
    fn many_clips_share_the_page() {
        let ten_s = clip(10.0, 48_000.0, 440.0);
        let (rate_hz, count) = rate_and_count(&[&ten_s; 15], 5e6);
        assert_eq!((rate_hz, count), (12_000, 15));
        // 6 kHz, 16 bits and base64 are 160 kB for ten seconds
        assert_eq!(rate_and_count(&[&ten_s; 100], 5e6), (6000, 31));
        assert_eq!(rate_and_count(&[], 5e6).1, 0);
        let total: usize = (0..15).map(|_| wav_uri(&ten_s, rate_hz).unwrap().len()).sum();
        assert!(total < 5_000_000, "{total}");
    }

    #[test]
    fn a_clip_is_cut_on_the_recordings_clock() {
        let samples: Vec<f32> = (0..40_000).map(|n| n as f32 / 1e5).collect();
        let mut source = Signal::new(samples, 1000.0).with_start_s(2.0);
        let clip = clip_from_source(&mut source, Span { from_s: 3.0, to_s: 3.5 }).unwrap();
        assert_eq!((clip.from_s, clip.samples.len(), clip.samples[0]), (3.0, 500, 0.01));
        let clip = clip_from_source(&mut source, Span { from_s: 0.0, to_s: 2.1 }).unwrap();
        assert_eq!((clip.from_s, clip.samples.len(), clip.samples[0]), (2.0, 100, 0.0));
    }
}
