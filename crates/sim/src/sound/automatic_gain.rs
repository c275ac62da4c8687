//! The automatic gain of a recorder.

use super::settings::{Bound, checked};
use hovertone_vehicle::QuantityError;

/// Time constant of the detector of the level: a few periods of the lowest tone that a recorder hears, and far below `attack_s`.
const DETECTOR_S: f64 = 0.02;
/// Time constants after which the gain follows: before, it has the value for the level.
const START_DETECTORS: f64 = 5.0;

/// Automatic gain: the gain in dB goes to the one that brings the sound to the target level, with one time constant where it falls and
/// another one where it rises: `g(t) = g₁ + (g₀ − g₁) e^(−t/τ)` after a step of the level.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct AutomaticGain {
    /// Level that the sound is brought to: its rms over that of a full-scale sine.
    pub target_dbfs: f64,
    /// Time constant of a gain that falls.
    pub attack_s: f64,
    /// Time constant of a gain that rises.
    pub release_s: f64,
    /// Largest gain.
    pub gain_db_max: f64,
}

impl Default for AutomaticGain {
    /// −20 dB, attack 0.1 s, release 2 s, at most 40 dB: between what recorders call fast and slow (assumed).
    fn default() -> Self {
        Self { target_dbfs: -20.0, attack_s: 0.1, release_s: 2.0, gain_db_max: 40.0 }
    }
}

impl AutomaticGain {
    pub(crate) fn check(&self) -> Result<(), QuantityError> {
        const TIME: Bound = Bound::Within(0.02, 60.0, "between 0.02 and 60");
        checked("automatic_gain target_dbfs", self.target_dbfs, Bound::Within(-60.0, 0.0, "between -60 and 0"))?;
        checked("automatic_gain attack_s", self.attack_s, TIME)?;
        checked("automatic_gain release_s", self.release_s, TIME)?;
        checked("automatic_gain gain_db_max", self.gain_db_max, Bound::Within(0.0, 80.0, "between 0 and 80"))
    }
}

/// The gain as it follows the sound.
pub(crate) struct GainControl {
    settings: AutomaticGain,
    detector_share: f64,
    attack_share: f64,
    release_share: f64,
    /// Mean square of the sound, full scale.
    mean_square: f64,
    gain_db: f64,
    start_left: u32,
}

impl GainControl {
    pub(crate) fn new(settings: AutomaticGain, sample_rate_hz: f64) -> Self {
        let share = |time_s: f64| 1.0 - (-1.0 / (time_s * sample_rate_hz)).exp();
        Self {
            settings,
            detector_share: share(DETECTOR_S),
            attack_share: share(settings.attack_s),
            release_share: share(settings.release_s),
            mean_square: 0.0,
            gain_db: 0.0,
            start_left: (START_DETECTORS * DETECTOR_S * sample_rate_hz) as u32,
        }
    }

    /// One sample, full scale ±1.
    pub(crate) fn sample(&mut self, value: f64) -> f64 {
        self.mean_square += self.detector_share * (value * value - self.mean_square);
        // a full-scale sine has a mean square of 1/2
        let level_db = 10.0 * (2.0 * self.mean_square).max(f64::MIN_POSITIVE).log10();
        let wanted_db = (self.settings.target_dbfs - level_db).min(self.settings.gain_db_max);
        let share = match self.start_left {
            0 if wanted_db < self.gain_db => self.attack_share,
            0 => self.release_share,
            _ => 1.0,
        };
        self.start_left = self.start_left.saturating_sub(1);
        self.gain_db += share * (wanted_db - self.gain_db);
        value * 10_f64.powf(self.gain_db / 20.0)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::TAU;

    const RATE_HZ: f64 = 8000.0;

    /// Level over a full-scale sine of the output in each tenth of a second, of a 400 Hz sine whose amplitude steps at 2 s.
    fn levels_db(settings: AutomaticGain, amplitudes: [f64; 2]) -> Vec<f64> {
        let mut control = GainControl::new(settings, RATE_HZ);
        let out: Vec<f64> = (0..80_000)
            .map(|sample| {
                let time_s = f64::from(sample) / RATE_HZ;
                control.sample(amplitudes[usize::from(time_s >= 2.0)] * (TAU * 400.0 * time_s).sin())
            })
            .collect();
        out.chunks(800).map(|part| 10.0 * (2.0 * part.iter().map(|v| v * v).sum::<f64>() / 800.0).log10()).collect()
    }

    /// Before the step and long after it the level is the target. After it, the distance falls as e^(−t/τ), late by the detector: the mean square of
    /// a sound that falls by a power ratio r takes ln r time constants, and its level falls along a straight line, so that half of them is the
    /// delay d. The tolerance is `step · d/τ`, and 0.15 dB for the change within a tenth of a second.
    #[test]
    fn the_level_goes_to_the_target_with_the_set_time_constants() {
        let settings = AutomaticGain { attack_s: 1.0, release_s: 2.0, ..AutomaticGain::default() };
        for (amplitudes, time_constant_s) in [([0.01, 0.1], 1.0), ([0.1, 0.01], 2.0)] {
            let levels = levels_db(settings, amplitudes);
            let step_db = 20.0 * (amplitudes[1] / amplitudes[0]).log10();
            assert!((levels[18] + 20.0).abs() < 0.1, "{}", levels[18]);
            for part in [2, 5, 10, 20, 40] {
                let time_s = 0.1 * (f64::from(part) + 0.5);
                let expected = -20.0 + step_db * (-time_s / time_constant_s).exp();
                let found = levels[20 + part as usize];
                let delay_s = 0.5 * DETECTOR_S * (10_f64.powf(step_db.abs() / 10.0)).ln();
                let tolerance = step_db.abs() * delay_s / time_constant_s + 0.15;
                assert!((found - expected).abs() < tolerance, "{time_s} s: {found} {expected}");
            }
        }
    }

    #[test]
    fn a_faint_sound_gets_no_more_than_the_largest_gain() {
        let faint = levels_db(AutomaticGain { gain_db_max: 30.0, ..AutomaticGain::default() }, [1e-4, 1e-4]);
        assert!((faint[50] - (-80.0 + 30.0)).abs() < 0.01, "{}", faint[50]);
    }
}
