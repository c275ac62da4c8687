//! The sound of a recording, small enough for a page.

use audioadapter_buffers::direct::InterleavedSlice;
use base64::Engine as _;
use base64::engine::general_purpose::STANDARD;
use hovertone_analysis::Span;
use hovertone_signal::{SignalSource, SourceError};
use opus_pure::{Application, MAX_PACKET_BYTES, OggOpusWriter, OpusEncoder, OpusHead};
use rubato::audioadapter::Adapter;
use rubato::{Async, FixedAsync, Resampler, SincInterpolationParameters, WindowFunction};

/// Bits per second of the sound in the page, best first. With 32 kbit/s a hover sounds as recorded; below 24 kbit/s the codec would
/// drop everything above 8 kHz.
const BITS_PER_S: [i32; 2] = [32_000, 24_000];
/// Sample rate of the codec.
const CODEC_RATE_HZ: u32 = 48_000;
/// Audio samples of one packet, 20 ms.
const PACKET_SAMPLES: usize = CODEC_RATE_HZ as usize / 50;
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

/// How the sound of all recordings shares the page.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct SoundShare {
    /// Bits per second of the codec.
    pub(crate) bits_per_s: i32,
    /// Most seconds of each recording; absent where every clip is whole.
    pub(crate) seconds_max: Option<f64>,
}

/// The best sound of which all clips together have at most `bytes_max` bytes as text in a page. Where even the lowest bit rate is too
/// much, all clips are cut to the same length.
pub(crate) fn sound_share(clips: &[&SoundClip], bytes_max: f64) -> SoundShare {
    let bytes = |seconds: f64, bits_per_s: i32| seconds * f64::from(bits_per_s) / 8.0 * TEXT_PER_BYTE;
    let lengths_s: Vec<f64> = clips.iter().map(|clip| clip.length_s()).collect();
    let total_s = lengths_s.iter().sum();
    if let Some(bits_per_s) = BITS_PER_S.into_iter().find(|&bits_per_s| bytes(total_s, bits_per_s) <= bytes_max) {
        return SoundShare { bits_per_s, seconds_max: None };
    }
    let bits_per_s = BITS_PER_S[BITS_PER_S.len() - 1];
    let allowed_s = bytes_max / bytes(1.0, bits_per_s);
    // shorter clips leave their time to the longer ones
    let mut sorted_s = lengths_s;
    sorted_s.sort_by(f64::total_cmp);
    let mut left_s = allowed_s;
    for (index, &length_s) in sorted_s.iter().enumerate() {
        let each_s = left_s / (sorted_s.len() - index) as f64;
        if length_s > each_s {
            return SoundShare { bits_per_s, seconds_max: Some(each_s) };
        }
        left_s -= length_s;
    }
    SoundShare { bits_per_s, seconds_max: None }
}

impl SoundClip {
    fn length_s(&self) -> f64 {
        self.samples.len() as f64 / self.sample_rate_hz
    }
}

/// The clip as Opus in Ogg, as a data URI. `None` for a silent clip.
pub(crate) fn opus_uri(clip: &SoundClip, share: SoundShare) -> Option<String> {
    let count = share.seconds_max.map_or(usize::MAX, |seconds| (seconds * clip.sample_rate_hz) as usize);
    let samples = clip.samples.get(..count.min(clip.samples.len()))?;
    let mut samples = resampled(samples, clip.sample_rate_hz)?;
    let peak = samples.iter().fold(0.0, |peak: f32, sample| peak.max(sample.abs()));
    if peak <= 0.0 || !peak.is_finite() {
        return None;
    }
    let gain = (PEAK_SHARE / peak).min(GAIN_MAX);
    samples.iter_mut().for_each(|sample| *sample *= gain);
    let ogg = ogg_opus(&samples, share.bits_per_s).ok()?;
    Some(format!("data:audio/ogg;base64,{}", STANDARD.encode(ogg)))
}

/// Mono samples at [`CODEC_RATE_HZ`] as an Ogg Opus file of the same length (RFC 7845).
fn ogg_opus(samples: &[f32], bits_per_s: i32) -> opus_pure::Result<Vec<u8>> {
    let mut encoder = OpusEncoder::new(CODEC_RATE_HZ as i32, 1, Application::Audio)?;
    encoder.bitrate_bps = bits_per_s;
    let head = OpusHead::for_encoder(&encoder, CODEC_RATE_HZ);
    let pre_skip = usize::from(head.pre_skip);
    // the last samples leave the encoder only after its delay; the length of the last packet tells a player where the sound ends
    let end = (pre_skip + samples.len()) as u64;
    let packet_count = (samples.len() + pre_skip).div_ceil(PACKET_SAMPLES);
    let mut ogg = Vec::new();
    let mut writer = OggOpusWriter::new(&mut ogg, head)?;
    let mut packet = vec![0; MAX_PACKET_BYTES];
    for index in 0..packet_count {
        let part = samples.get(index * PACKET_SAMPLES..).unwrap_or_default();
        let mut block = part[..part.len().min(PACKET_SAMPLES)].to_vec();
        block.resize(PACKET_SAMPLES, 0.0);
        let length = encoder.encode(&block, PACKET_SAMPLES, &mut packet)?;
        if index + 1 == packet_count {
            let rest = end.saturating_sub(writer.granule() as u64);
            writer.write_packet_with_duration(&packet[..length], rest as u32)?;
        } else {
            writer.write_packet(&packet[..length])?;
        }
    }
    writer.finish()?;
    Ok(ogg)
}

/// Band-limited resampling to the rate of the codec; `None` where the clip is too short.
fn resampled(samples: &[f32], rate_hz: f64) -> Option<Vec<f32>> {
    let ratio = f64::from(CODEC_RATE_HZ) / rate_hz.round();
    if ratio == 1.0 {
        return Some(samples.to_vec());
    }
    let filter_samples = (FILTER_SAMPLES as f64 / ratio.min(1.0)) as usize;
    let filter = SincInterpolationParameters::new(filter_samples, WindowFunction::BlackmanHarris2);
    let mut resampler = Async::<f32>::new_sinc(ratio, 1.0, &filter, CHUNK_FRAMES, 1, FixedAsync::Input).ok()?;
    let input = InterleavedSlice::new(samples, 1, samples.len()).ok()?;
    let output = resampler.process_all(&input, samples.len(), None).ok()?;
    (0..output.frames()).map(|frame| output.read_sample(0, frame)).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use hovertone_signal::Signal;
    use std::f64::consts::TAU;

    const WHOLE: SoundShare = SoundShare { bits_per_s: 32_000, seconds_max: None };

    fn clip(seconds: f64, rate_hz: f64, tone_hz: f64) -> SoundClip {
        let samples =
            (0..(seconds * rate_hz) as usize).map(|n| (0.1 * (TAU * tone_hz * n as f64 / rate_hz).sin()) as f32);
        SoundClip { from_s: 0.0, sample_rate_hz: rate_hz, samples: samples.collect() }
    }

    /// What a player hears, and the bytes of the file.
    fn decoded(uri: &str) -> (Vec<f32>, usize) {
        let bytes = STANDARD.decode(uri.strip_prefix("data:audio/ogg;base64,").unwrap()).unwrap();
        let mut reader = opus_pure::OggOpusReader::new(bytes.as_slice()).unwrap();
        let pre_skip = usize::from(reader.head().pre_skip);
        let mut decoder = reader.head().decoder(CODEC_RATE_HZ as i32).unwrap();
        let (mut samples, mut end) = (Vec::new(), 0);
        while let Some(packet) = reader.read_packet().unwrap() {
            let mut block = vec![0.0; 2 * PACKET_SAMPLES];
            let count = decoder.decode(&packet.data, block.len(), &mut block).unwrap();
            samples.extend_from_slice(&block[..count]);
            end = packet.page_granule as usize;
        }
        (samples[pre_skip..end.min(samples.len())].to_vec(), bytes.len())
    }

    #[test]
    fn a_tone_keeps_its_pitch_its_time_and_a_known_loudness() {
        for rate_hz in [48_000.0, 44_100.0, 8000.0] {
            let (samples, bytes) = decoded(&opus_uri(&clip(2.0, rate_hz, 1000.0), WHOLE).unwrap());
            assert!(samples.len().abs_diff(96_000) <= 48, "{rate_hz}: {}", samples.len());
            let crossings = samples.windows(2).filter(|pair| pair[0] < 0.0 && pair[1] >= 0.0).count();
            assert!(crossings.abs_diff(2000) <= 4, "{rate_hz}: {crossings}");
            // away from the ends, where resampler and codec ring
            let peak = samples[5000..90_000].iter().fold(0.0f32, |peak, sample| peak.max(sample.abs()));
            assert!((peak - PEAK_SHARE).abs() < 0.1, "{rate_hz}: {peak}");
            assert!(bytes < 12_000, "{rate_hz}: {bytes} bytes");
        }
    }

    #[test]
    fn silence_is_no_sound_and_noise_is_not_amplified_without_limit() {
        assert_eq!(opus_uri(&clip(1.0, 8000.0, 0.0), WHOLE), None);
        assert_eq!(opus_uri(&clip(0.0, 48_000.0, 440.0), WHOLE), None);
        let faint = SoundClip { samples: vec![1e-4; 4800], ..clip(0.0, 48_000.0, 0.0) };
        let (samples, _) = decoded(&opus_uri(&faint, WHOLE).unwrap());
        let loudest = samples.iter().fold(0.0f32, |peak, sample| peak.max(sample.abs()));
        assert!(loudest < 2.0 * 1e-4 * GAIN_MAX, "{loudest}");
    }

    #[test]
    fn many_clips_share_the_page() {
        let ten_s = clip(10.0, 8000.0, 440.0);
        assert_eq!(sound_share(&[&ten_s; 15], 1.5e6), WHOLE);
        assert_eq!(sound_share(&[], 1.5e6), WHOLE);
        let many = sound_share(&[&ten_s; 60], 1.5e6);
        // 24 kbit/s and base64 are 4000 bytes for a second
        assert_eq!(many, SoundShare { bits_per_s: 24_000, seconds_max: Some(1.5e6 / 4000.0 / 60.0) });
        // a short clip leaves its time to the long ones
        let short = clip(1.0, 8000.0, 440.0);
        assert_eq!(sound_share(&[&short, &ten_s, &ten_s], 4e4).seconds_max, Some(4.5));
        let (samples, _) = decoded(&opus_uri(&ten_s, SoundShare { seconds_max: Some(0.5), ..many }).unwrap());
        assert!(samples.len().abs_diff(24_000) <= 48, "{}", samples.len());
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
