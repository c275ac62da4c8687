//! The last seconds of the sound, in memory of a fixed size.

use hovertone_signal::{Signal, SignalSource};

/// The last audio samples.
pub(crate) struct Recent {
    /// A ring: the oldest audio sample is at `next` once the ring is full.
    samples: Vec<f32>,
    next: usize,
    /// All audio samples so far.
    heard: u64,
    sample_rate_hz: f64,
}

impl Recent {
    pub(crate) fn new(window_s: f64, sample_rate_hz: f64) -> Self {
        let count = ((window_s * sample_rate_hz) as usize).max(1);
        Self { samples: vec![0.0; count], next: 0, heard: 0, sample_rate_hz }
    }

    pub(crate) fn push(&mut self, samples: &[f32]) {
        self.heard += samples.len() as u64;
        let count = self.samples.len();
        for part in samples[samples.len().saturating_sub(count)..].chunks(count) {
            let (before_end, rest) = part.split_at(part.len().min(count - self.next));
            self.samples[self.next..self.next + before_end.len()].copy_from_slice(before_end);
            self.samples[..rest.len()].copy_from_slice(rest);
            self.next = (self.next + part.len()) % count;
        }
    }

    /// Length of all sound so far.
    pub(crate) fn heard_s(&self) -> f64 {
        self.heard as f64 / self.sample_rate_hz
    }

    /// The sound of the last seconds from a time on, on the clock of all sound.
    pub(crate) fn sound_since(&self, time_s: f64) -> Signal {
        let whole = self.sound();
        let first = ((time_s - whole.start_s()) * self.sample_rate_hz).round().max(0.0) as usize;
        let samples = whole.samples().get(first..).unwrap_or_default().to_vec();
        let start_s = whole.start_s() + first as f64 / self.sample_rate_hz;
        Signal::new(samples, self.sample_rate_hz).with_start_s(start_s)
    }

    /// The sound of the last seconds, on the clock of all sound.
    pub(crate) fn sound(&self) -> Signal {
        let count = usize::try_from(self.heard).map_or(self.samples.len(), |heard| heard.min(self.samples.len()));
        let (newer, older) = self.samples.split_at(self.next);
        let mut samples: Vec<f32> = older.iter().chain(newer).copied().collect();
        samples.drain(..samples.len() - count);
        let start_s = self.heard_s() - count as f64 / self.sample_rate_hz;
        Signal::new(samples, self.sample_rate_hz).with_start_s(start_s)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_last_seconds_stay_in_the_order_of_time() {
        for block in [1, 3, 7, 10, 25] {
            let mut recent = Recent::new(1.0, 10.0);
            let all: Vec<f32> = (0..33u8).map(f32::from).collect();
            for (at, part) in all.chunks(block).enumerate() {
                recent.push(part);
                let heard = at * block + part.len();
                let sound = recent.sound();
                assert_eq!(sound.samples(), &all[heard.saturating_sub(10)..heard], "blocks of {block}");
                let since = recent.sound_since(recent.heard_s() - 0.5);
                assert_eq!(since.samples(), &all[heard.saturating_sub(5)..heard], "blocks of {block}");
                let start_s = heard.saturating_sub(10) as f64 / 10.0;
                assert!(
                    (sound.start_s() - start_s).abs() < 1e-12 && (recent.heard_s() - heard as f64 / 10.0).abs() < 1e-12
                );
            }
        }
    }
}
