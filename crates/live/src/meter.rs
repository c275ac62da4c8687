//! Level and clipping of the sound.

use hovertone_signal::spectrogram::power_db;

/// Smallest amplitude that counts as clipped: one step of 16 bits below full scale, which filters of recorders leave. *Decision.*
const CLIPPED: f32 = 0.9995;

/// Sums over the sound since the last live speed.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Meter {
    square_sum: f64,
    count: usize,
    clipped: usize,
}

impl Meter {
    pub(crate) fn push(&mut self, samples: &[f32]) {
        // one after the other, so that the sum does not depend on the blocks
        samples.iter().for_each(|&sample| self.square_sum += f64::from(sample).powi(2));
        self.count += samples.len();
        self.clipped += samples.iter().filter(|sample| sample.abs() >= CLIPPED).count();
    }

    /// Level against a sine of full scale, whose mean square is one half.
    pub(crate) fn level_db(&self) -> f64 {
        power_db(2.0 * self.square_sum / self.count.max(1) as f64)
    }

    pub(crate) fn clipped_share(&self) -> f64 {
        self.clipped as f64 / self.count.max(1) as f64
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_sine_of_full_scale_has_the_level_0() {
        let mut meter = Meter::default();
        let sine: Vec<f32> = (0..8000).map(|n| (n as f32 * 0.1).sin()).collect();
        meter.push(&sine[..3000]);
        meter.push(&sine[3000..]);
        assert!(meter.level_db().abs() < 0.01, "{}", meter.level_db());
        // |sin| is above 0.9995 for 2 % of the time
        assert!((meter.clipped_share() - 0.0201).abs() < 0.003, "{}", meter.clipped_share());
        assert_eq!(Meter::default().level_db(), -200.0);
    }
}
