//! Sound that is in memory already, such as an array of another program.

use crate::frames::{Frames, Incidents};
use std::io;
use std::sync::Arc;

/// Frames that are handed on at once.
const FRAMES_AT_ONCE: usize = 4096;

/// Interleaved samples of all channels, in memory. A copy of it shares them.
#[derive(Clone, Debug)]
pub struct Samples {
    interleaved: Arc<[f32]>,
    channel_count: usize,
    sample_rate_hz: f64,
}

impl Samples {
    /// Samples of full scale 1. Those of an unfinished last frame are not heard.
    pub fn new(interleaved: Arc<[f32]>, channel_count: usize, sample_rate_hz: f64) -> Self {
        Self { interleaved, channel_count, sample_rate_hz }
    }

    /// Samples of 16 bits become the numbers that the decoder of a WAV file makes of them.
    pub fn from_16_bits(interleaved: &[i16], channel_count: usize, sample_rate_hz: f64) -> Self {
        let scaled = interleaved.iter().map(|sample| f32::from(*sample) / -f32::from(i16::MIN));
        Self::new(scaled.collect(), channel_count, sample_rate_hz)
    }

    /// Samples of 32 bits become the numbers that the decoder of a WAV file makes of them.
    pub fn from_32_bits(interleaved: &[i32], channel_count: usize, sample_rate_hz: f64) -> Self {
        let scaled = interleaved.iter().map(|sample| (f64::from(*sample) / -f64::from(i32::MIN)) as f32);
        Self::new(scaled.collect(), channel_count, sample_rate_hz)
    }

    /// Samples of double precision, rounded to single precision, with which hovertone calculates.
    pub fn from_doubles(interleaved: &[f64], channel_count: usize, sample_rate_hz: f64) -> Self {
        Self::new(interleaved.iter().map(|sample| *sample as f32).collect(), channel_count, sample_rate_hz)
    }

    /// Samples per second.
    pub fn sample_rate_hz(&self) -> f64 {
        self.sample_rate_hz
    }

    /// Length of the sound.
    pub fn duration_s(&self) -> f64 {
        (self.interleaved.len() / self.channel_count.max(1)) as f64 / self.sample_rate_hz
    }
}

/// One pass through samples in memory.
pub(crate) struct SampleFrames {
    samples: Samples,
    next: usize,
}

impl SampleFrames {
    pub(crate) fn of(samples: &Samples) -> Self {
        Self { samples: samples.clone(), next: 0 }
    }
}

impl Frames for SampleFrames {
    fn sample_rate_hz(&self) -> f64 {
        self.samples.sample_rate_hz
    }

    fn channel_count(&self) -> usize {
        self.samples.channel_count
    }

    fn next_frames(&mut self, out: &mut Vec<f32>, _: &mut Incidents) -> io::Result<bool> {
        let channel_count = self.samples.channel_count.max(1);
        let all = &self.samples.interleaved;
        let end = all.len() - all.len() % channel_count;
        let to = end.min(self.next + FRAMES_AT_ONCE * channel_count);
        out.clear();
        out.extend_from_slice(&all[self.next..to]);
        self.next = to;
        Ok(to < end)
    }
}

#[cfg(test)]
mod tests {
    use super::Samples;
    use crate::{MediaError, OpenOptions, Recording};
    use hovertone_signal::SignalSource;

    fn heard(recording: &mut Recording) -> Vec<f32> {
        let mut all = Vec::new();
        while let Some(block) = recording.next_block().unwrap() {
            all.extend_from_slice(block);
        }
        all
    }

    #[test]
    fn samples_in_memory_are_heard_as_often_as_wanted() {
        let interleaved: Vec<f32> = (0..20_001).map(|n| n as f32).collect();
        let samples = Samples::new(interleaved.into(), 2, 8000.0);
        let mut both = Recording::of_samples(&samples, &OpenOptions::default()).unwrap();
        assert_eq!((both.info().channel_count, both.info().declared_duration_s), (2, Some(1.25)));
        for _ in 0..2 {
            let mono = heard(&mut both);
            assert_eq!((mono.len(), mono[5000]), (10_000, 10_000.5));
            both.rewind().unwrap();
        }
        assert!(!both.is_prefix() && both.warnings().is_empty());
        let right = OpenOptions { channel: Some(2), clock_correction_ppm: 500_000.0, ..OpenOptions::default() };
        let mut right = Recording::of_samples(&samples, &right).unwrap();
        assert_eq!((right.info().sample_rate_hz, heard(&mut right)[7]), (12_000.0, 15.0));
    }

    #[test]
    fn whole_numbers_have_the_full_scale_of_a_file() {
        let of = |samples: Samples| heard(&mut Recording::of_samples(&samples, &OpenOptions::default()).unwrap());
        assert_eq!(of(Samples::from_16_bits(&[i16::MIN, 0, 16_384], 1, 8000.0)), [-1.0, 0.0, 0.5]);
        assert_eq!(of(Samples::from_32_bits(&[i32::MIN, 0, 1 << 30], 1, 8000.0)), [-1.0, 0.0, 0.5]);
        assert_eq!(of(Samples::from_doubles(&[0.25, -0.5], 1, 8000.0)), [0.25, -0.5]);
    }

    #[test]
    fn what_is_not_there_is_refused() {
        let open = |samples: &[f32], options: &OpenOptions| {
            Recording::of_samples(&Samples::new(samples.into(), 1, 8000.0), options).err().unwrap()
        };
        assert!(matches!(open(&[], &OpenOptions::default()), MediaError::NoSampleInArray));
        for rate_hz in [0.0, -1.0, f64::NAN] {
            let samples = Samples::new([0.0_f32].into(), 1, rate_hz);
            let error = Recording::of_samples(&samples, &OpenOptions::default()).err().unwrap();
            assert!(matches!(error, MediaError::RateOfArray { .. }), "{rate_hz}: {error}");
        }
        let second = OpenOptions { channel: Some(2), ..OpenOptions::default() };
        assert!(matches!(open(&[0.0], &second), MediaError::NoSuchChannel { asked: 2, count: 1 }));
        let second = OpenOptions { audio_track: Some(2), ..OpenOptions::default() };
        assert!(matches!(open(&[0.0], &second), MediaError::NoSuchTrack { asked: 2, count: 1 }));
    }
}
