//! People talking outside: synthetic voices, from pulses and noise through formants, in syllables.

use super::biquad::Biquad;
use super::level::rms_pa;
use super::settings::{Bound, LEVEL, checked};
use crate::seed::{Part, stream};
use hovertone_vehicle::QuantityError;
use rand::RngExt;
use rand_pcg::Pcg64;
use std::ops::Range;

/// Formants 1 and 2 of the vowels of heed, hid, head, had, hod, hawed, hood, who'd, Hz: means of ten speakers, read by B. Nevin
/// (discourse.iapct.org/t/formants/13836) from a study after Peterson and Barney 1952.
const VOWELS_HZ: [(f64, f64); 8] = [
    (315.0, 2400.0),
    (425.0, 2100.0),
    (570.0, 1860.0),
    (730.0, 1690.0),
    (710.0, 1200.0),
    (695.0, 985.0),
    (447.0, 1390.0),
    (350.0, 1300.0),
];
/// Formant 3, and the bandwidths of all three (Klatt 1980: 50 to 150 Hz).
const THIRD_FORMANT_HZ: f64 = 2600.0;
const BANDWIDTHS_HZ: [f64; 3] = [80.0, 100.0, 130.0];
/// Lengths of syllables and of the gaps between them, uniform: 4 to 5 syllables per second, as in speech.
const SYLLABLE_S: Range<f64> = 0.12..0.28;
const GAP_S: Range<f64> = 0.01..0.05;
/// On average one gap in this number is a pause for breath.
const PAUSE_EVERY: f64 = 8.0;
const PAUSE_S: Range<f64> = 0.3..0.9;
/// Levels of syllables, uniform.
const SYLLABLE_SPREAD_DB: f64 = 6.0;
/// Pitch of a voice, uniform in its logarithm from low male to high female; within a syllable it falls by 10 %.
const PITCH_HZ: Range<f64> = 95.0..230.0;
const PITCH_FALL: f64 = 0.1;
/// Share of breath in a voice's power.
const BREATH_POWER: f64 = 0.05;

/// Babble of a few voices that comes from one place (a door, a window).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BabbleSettings {
    /// Level of all voices together at 1 m from the place, mean over a long time.
    pub level_db_spl: f64,
    /// Number of people who talk at once.
    pub voices: u32,
    /// Pass band; outside of it the voices fall by 24 dB per octave.
    pub band_hz: (f64, f64),
    /// Position of the source; its sound falls with 1/distance, without reflections.
    pub position_m: [f64; 3],
}

impl Default for BabbleSettings {
    /// Three voices of 55 dB together at the door of the default room: a quiet talk has "both about 50 dB(A)" at 1 m
    /// (van Heusden, Plomp, Pols 1979), and three make 5 dB more. 150 Hz to 3 kHz: a telephone's band, for a door that
    /// muffles (assumed).
    fn default() -> Self {
        Self { level_db_spl: 55.0, voices: 3, band_hz: (150.0, 3000.0), position_m: [4.0, 2.0, 1.5] }
    }
}

impl BabbleSettings {
    pub(crate) fn check(&self) -> Result<(), QuantityError> {
        checked("babble level_db_spl", self.level_db_spl, LEVEL)?;
        checked("babble voices", f64::from(self.voices), Bound::Within(1.0, 20.0, "between 1 and 20"))?;
        checked("babble band_hz", self.band_hz.0, Bound::Within(50.0, 1000.0, "between 50 and 1000"))?;
        checked("babble band_hz", self.band_hz.1, Bound::Within(1000.0, 3500.0, "between 1000 and 3500"))?;
        self.position_m.into_iter().try_for_each(|value| checked("babble position_m", value, Bound::Finite))
    }
}

/// All voices.
pub(crate) struct Babble {
    voices: Vec<Voice>,
    band: [Biquad; 4],
}

struct Voice {
    random: Pcg64,
    sample_rate_hz: f64,
    band_hz: Range<f64>,
    /// Root mean square of the voice over a long time, Pa.
    rms: f64,
    base_pitch_hz: f64,
    formants: [Biquad; 3],
    syllable: Syllable,
}

/// One syllable and the silence after it. Its envelope is sin², which has the mean square 3/8.
#[derive(Clone, Copy)]
struct Syllable {
    at: usize,
    voiced: usize,
    total: usize,
    gain: f64,
    breath: f64,
    pitch_hz: f64,
    /// Share of a period since the last pulse.
    phase: f64,
}

impl Babble {
    pub(crate) fn new(settings: &BabbleSettings, sample_rate_hz: f64, seed: u64) -> Self {
        let rms = rms_pa(settings.level_db_spl) / f64::from(settings.voices).sqrt();
        let (low_hz, high_hz) = settings.band_hz;
        let voice = |index: u32| Voice::new(rms, low_hz..high_hz, sample_rate_hz, seed, index);
        Self { voices: (0..settings.voices).map(voice).collect(), band: band(&(low_hz..high_hz), sample_rate_hz) }
    }

    /// The next samples at 1 m, Pa.
    pub(crate) fn fill(&mut self, samples: &mut [f32]) {
        for sample in samples {
            let mut value = self.voices.iter_mut().map(Voice::sample).sum();
            for filter in &mut self.band {
                value = filter.filtered(value);
            }
            *sample = value as f32;
        }
    }
}

fn band(band_hz: &Range<f64>, sample_rate_hz: f64) -> [Biquad; 4] {
    let low = Biquad::high_pass(band_hz.start, sample_rate_hz);
    let high = Biquad::low_pass(band_hz.end, sample_rate_hz);
    [low, low, high, high]
}

impl Voice {
    fn new(rms: f64, band_hz: Range<f64>, sample_rate_hz: f64, seed: u64, index: u32) -> Self {
        let mut random = stream(seed, Part::Babble, u64::from(index));
        let base_pitch_hz = PITCH_HZ.start * (PITCH_HZ.end / PITCH_HZ.start).powf(random.random());
        let silence = Syllable { at: 0, voiced: 0, total: 0, gain: 0.0, breath: 0.0, pitch_hz: 100.0, phase: 0.0 };
        let formants = [Biquad::resonance(500.0, 100.0, sample_rate_hz); 3];
        let mut voice = Self { random, sample_rate_hz, band_hz, rms, base_pitch_hz, formants, syllable: silence };
        voice.begin_syllable();
        // Each voice begins at a random point of its first syllable.
        voice.syllable.at = (voice.random.random::<f64>() * voice.syllable.total as f64) as usize;
        voice
    }

    fn uniform(&mut self, range: Range<f64>) -> f64 {
        range.start + (range.end - range.start) * self.random.random::<f64>()
    }

    fn begin_syllable(&mut self) {
        let voiced_s = self.uniform(SYLLABLE_S);
        let pause = self.random.random::<f64>() * PAUSE_EVERY < 1.0;
        let silent_s = self.uniform(if pause { PAUSE_S } else { GAP_S });
        let (first_hz, second_hz) = VOWELS_HZ[self.random.random_range(0..VOWELS_HZ.len())];
        let rate = self.sample_rate_hz;
        for ((filter, hz), width_hz) in
            self.formants.iter_mut().zip([first_hz, second_hz, THIRD_FORMANT_HZ]).zip(BANDWIDTHS_HZ)
        {
            *filter = Biquad::resonance(hz, width_hz, rate).keeping(filter);
        }
        let pitch_hz = self.base_pitch_hz * self.uniform(0.9..1.15);
        let level_db = self.uniform(-SYLLABLE_SPREAD_DB / 2.0..SYLLABLE_SPREAD_DB / 2.0);
        let level = 10_f64.powf(level_db / 20.0) / mean_power_of_levels().sqrt();

        // Pulses of height 1 every f_s/f₀ samples have lines of power 2 (f₀/f_s)² at all multiples of f₀; breath is white.
        let band = band(&self.band_hz, rate);
        let power_gain =
            |hz: f64| -> f64 { self.formants.iter().chain(&band).map(|filter| filter.power_gain(hz, rate)).product() };
        let top_hz = 0.5 * rate.min(16_000.0);
        let middle_hz = pitch_hz * (1.0 - PITCH_FALL / 2.0);
        let lines = (top_hz / middle_hz) as u32;
        let pulses: f64 = (1..=lines).map(|number| power_gain(f64::from(number) * middle_hz)).sum::<f64>()
            * 2.0
            * (middle_hz / rate).powi(2);
        let steps = 80;
        let step_hz = top_hz / f64::from(steps);
        // Uniform on ±√3 has variance 1, and a one-sided density of 2/f_s.
        let white: f64 =
            (0..steps).map(|step| power_gain((f64::from(step) + 0.5) * step_hz)).sum::<f64>() * step_hz * 2.0 / rate;
        let breath = (BREATH_POWER / (1.0 - BREATH_POWER) * pulses / white).sqrt();
        let power = pulses / (1.0 - BREATH_POWER);
        let gain = self.rms * level / (power * 0.375 * voiced_share()).sqrt();
        let count = |time_s: f64| (time_s * rate) as usize;
        self.syllable = Syllable {
            at: 0,
            voiced: count(voiced_s),
            total: count(voiced_s) + count(silent_s),
            gain,
            breath,
            pitch_hz,
            phase: self.syllable.phase,
        };
    }

    fn sample(&mut self) -> f64 {
        if self.syllable.at >= self.syllable.total {
            self.begin_syllable();
        }
        let syllable = &mut self.syllable;
        let at = syllable.at;
        syllable.at += 1;
        if at >= syllable.voiced {
            return 0.0;
        }
        let share = at as f64 / syllable.voiced as f64;
        syllable.phase += syllable.pitch_hz * (1.0 - PITCH_FALL * share) / self.sample_rate_hz;
        let mut value = 0.0;
        if syllable.phase >= 1.0 {
            syllable.phase -= 1.0;
            value = 1.0;
        }
        value += syllable.breath * 12_f64.sqrt() * (self.random.random::<f64>() - 0.5);
        for filter in &mut self.formants {
            value = filter.filtered(value);
        }
        // sin²(πx) without a sine for every sample: Bhaskara I, sin(πx) = 16x(1-x) / (5 - 4x(1-x)) to 0.2 %.
        let bow = 4.0 * share * (1.0 - share);
        let sine = 4.0 * bow / (5.0 - bow);
        value * syllable.gain * sine * sine
    }
}

/// Mean of 10^(L/10) over the levels of syllables.
fn mean_power_of_levels() -> f64 {
    let half = SYLLABLE_SPREAD_DB / 2.0 * std::f64::consts::LN_10 / 10.0;
    half.sinh() / half
}

/// Share of the time that is within a syllable.
fn voiced_share() -> f64 {
    let mean = |range: Range<f64>| (range.start + range.end) / 2.0;
    let silent_s = mean(GAP_S) + (mean(PAUSE_S) - mean(GAP_S)) / PAUSE_EVERY;
    mean(SYLLABLE_S) / (mean(SYLLABLE_S) + silent_s)
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::TAU;

    fn babble(voices: u32, seconds: f64) -> Vec<f64> {
        let settings = BabbleSettings { voices, level_db_spl: 60.0, ..BabbleSettings::default() };
        let mut samples = vec![0.0; (seconds * 48_000.0) as usize];
        Babble::new(&settings, 48_000.0, 11).fill(&mut samples);
        samples.into_iter().map(f64::from).collect()
    }

    fn mean_square(samples: &[f64]) -> f64 {
        samples.iter().map(|value| value * value).sum::<f64>() / samples.len() as f64
    }

    #[test]
    fn the_long_mean_level_is_the_set_one() {
        for voices in [1, 4] {
            let level_db = 10.0 * (mean_square(&babble(voices, 100.0)) / rms_pa(0.0).powi(2)).log10();
            // Some 400 syllables whose power spreads by a factor of about 1: 5 % per voice, 0.2 dB.
            assert!((level_db - 60.0).abs() < 0.8, "{voices} voices: {level_db} dB");
        }
    }

    #[test]
    fn it_stays_in_its_band() {
        let samples = babble(3, 20.0);
        let (rate, (low_hz, high_hz)) = (48_000.0, BabbleSettings::default().band_hz);
        let mut outside = samples.clone();
        // An octave beyond the band, steep filters of this test.
        let mut below = [Biquad::low_pass(low_hz / 2.0, rate); 3];
        let mut above = [Biquad::high_pass(2.0 * high_hz, rate); 3];
        for value in &mut outside {
            let (mut low, mut high) = (*value, *value);
            below.iter_mut().for_each(|filter| low = filter.filtered(low));
            above.iter_mut().for_each(|filter| high = filter.filtered(high));
            *value = low + high;
        }
        let share_db = 10.0 * (mean_square(&outside) / mean_square(&samples)).log10();
        assert!(share_db < -30.0, "{share_db}");
    }

    /// The envelope's power in 10 ms frames swings at the rate of syllables: more from 2 to 8 Hz than from 12 to 40 Hz.
    #[test]
    fn it_has_the_rhythm_of_syllables() {
        let envelope: Vec<f64> = babble(1, 60.0).chunks(480).map(|frame| mean_square(frame).sqrt()).collect();
        let mean = envelope.iter().sum::<f64>() / envelope.len() as f64;
        let power = |hz: f64| {
            let (mut re, mut im) = (0.0, 0.0);
            for (frame, value) in envelope.iter().enumerate() {
                let (sine, cosine) = (TAU * hz * frame as f64 * 0.01).sin_cos();
                re += (value - mean) * cosine;
                im += (value - mean) * sine;
            }
            re * re + im * im
        };
        let band =
            |low: u32, high: u32| -> f64 { (10 * low..10 * high).map(|tenth| power(f64::from(tenth) / 10.0)).sum() };
        assert!(band(2, 8) > 3.0 * band(12, 40));
    }
}
