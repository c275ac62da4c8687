//! Broadband noise of a hover: its power density has a straight slope over the whole band.

use crate::sound::SlopeFilterRoots;
use hovertone_vehicle::QuantityError;
use rand::RngExt;
use rand_distr::StandardNormal;
use rand_pcg::Pcg64;
use std::f64::consts::TAU;

/// Below this frequency the noise is flat: nothing is heard there, and a slope without end has no finite power.
const SHELF_HZ: f64 = 20.0;
/// In this time the slowest pole, at `SHELF_HZ`, decays by e^-20; after it the noise is stationary.
const SETTLING_S: f64 = 20.0 / (TAU * SHELF_HZ);

/// Level and colour of the noise.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct NoiseSettings {
    /// Power of the reference line (`level²/2` of the gear mesh, else of the blade pass, of a rotor at 0 dB) over the
    /// noise's power density at that line's frequency, dB-Hz.
    pub carrier_to_noise_density_db_hz: f64,
    /// Slope of the power density, between -6 and 0.
    pub slope_db_per_octave: f64,
}

impl Default for NoiseSettings {
    /// 50 dB-Hz puts a steady line 37.5 dB above the noise of its bin in a 4096-point Hann frame at 48 kHz (17.6 Hz
    /// wide). Both numbers are assumed, not measured.
    fn default() -> Self {
        Self { carrier_to_noise_density_db_hz: 50.0, slope_db_per_octave: -3.0 }
    }
}

impl NoiseSettings {
    pub(super) fn check(&self) -> Result<(), QuantityError> {
        let (value, name) = (self.slope_db_per_octave, "slope_db_per_octave");
        if !(-6.0..=0.0).contains(&value) {
            return Err(QuantityError { name, value, must_be: "between -6 and 0" });
        }
        let (value, name) = (self.carrier_to_noise_density_db_hz, "carrier_to_noise_density_db_hz");
        if !value.is_finite() {
            return Err(QuantityError { name, value, must_be: "a number" });
        }
        Ok(())
    }

    /// One-sided power density at the reference line.
    pub(super) fn density_at_reference(&self, reference_level: f64) -> f64 {
        reference_level.powi(2) / 2.0 / 10_f64.powf(self.carrier_to_noise_density_db_hz / 10.0)
    }
}

/// A stream of noise samples.
#[derive(Clone)]
pub(super) struct Noise {
    gain: f64,
    filter: SlopeFilter,
    random: Pcg64,
    std: f64,
}

impl Noise {
    /// Noise whose one-sided power density at `reference_hz` is `density` (units² per Hz).
    pub(super) fn new(
        density: f64,
        reference_hz: f64,
        slope_db_per_octave: f64,
        sample_rate_hz: f64,
        random: Pcg64,
    ) -> Self {
        let filter = SlopeFilter::new(slope_db_per_octave, sample_rate_hz);
        // White noise of variance 1 has the one-sided density 2 / sample rate.
        let gain = (density * sample_rate_hz / 2.0).sqrt() / filter.power_gain(reference_hz).sqrt();
        let std = gain * filter.mean_power_gain().sqrt();
        let mut noise = Self { gain, filter, random, std };
        for _ in 0..(SETTLING_S * sample_rate_hz) as usize {
            noise.next();
        }
        noise
    }

    /// Standard deviation of the samples.
    pub(super) fn std(&self) -> f64 {
        self.std
    }

    pub(super) fn next(&mut self) -> f64 {
        let white: f64 = self.random.sample(StandardNormal);
        self.gain * self.filter.filtered(white)
    }
}

/// The filter of [`SlopeFilterRoots`] as a cascade of first-order sections.
#[derive(Clone)]
struct SlopeFilter {
    sections: Vec<Section>,
    sample_rate_hz: f64,
}

#[derive(Clone, Copy)]
struct Section {
    pole: f64,
    zero: f64,
    input: f64,
    output: f64,
}

impl SlopeFilter {
    fn new(slope_db_per_octave: f64, sample_rate_hz: f64) -> Self {
        let roots = SlopeFilterRoots::new(slope_db_per_octave, SHELF_HZ, sample_rate_hz);
        let section = |pole, zero| Section { pole, zero, input: 0.0, output: 0.0 };
        let mut sections: Vec<Section> = roots.ladder.iter().map(|root| section(root.pole, root.zero)).collect();
        if !sections.is_empty() {
            sections.push(section(0.0, roots.top_zero));
        }
        Self { sections, sample_rate_hz }
    }

    fn filtered(&mut self, sample: f64) -> f64 {
        let mut value = sample;
        for section in &mut self.sections {
            section.output = value + (section.pole * section.output - section.zero * section.input);
            section.input = value;
            value = section.output;
        }
        value
    }

    /// |H|² at a frequency, by formula.
    fn power_gain(&self, hz: f64) -> f64 {
        let cosine = (TAU * hz / self.sample_rate_hz).cos();
        let distance_square = |root: f64| 1.0 - 2.0 * root * cosine + root * root;
        self.sections.iter().map(|section| distance_square(section.zero) / distance_square(section.pole)).product()
    }

    /// Mean of |H|² over the band: variance out for variance 1 in.
    fn mean_power_gain(&self) -> f64 {
        // Steps of half the width of the flat shelf, so that no part of the slope falls between two steps.
        let count = (self.sample_rate_hz / SHELF_HZ) as u32;
        let step_hz = self.sample_rate_hz / 2.0 / f64::from(count);
        (0..count).map(|step| self.power_gain((f64::from(step) + 0.5) * step_hz)).sum::<f64>() / f64::from(count)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::seed::{Part, stream};

    #[test]
    fn the_filters_slope_is_straight() {
        for rate_hz in [44_100.0, 48_000.0] {
            for slope in [-6.0, -3.0, -1.5, 0.0] {
                let filter = SlopeFilter::new(slope, rate_hz);
                let db = |hz: f64| 10.0 * filter.power_gain(hz).log10();
                let ideal = |hz: f64| db(1000.0) + slope * (hz / 1000.0).log2();
                let worst = (0..200)
                    .map(|step| 120.0 * (16_000.0_f64 / 120.0).powf(f64::from(step) / 199.0))
                    .map(|hz| (db(hz) - ideal(hz)).abs())
                    .fold(0.0, f64::max);
                assert!(worst < 0.15, "slope {slope} at {rate_hz} Hz is off by {worst} dB");
            }
        }
    }

    /// The mean of M periodograms has the relative standard error 1/√M.
    #[test]
    fn the_samples_have_the_set_density_at_every_frequency() {
        let (rate_hz, density, reference_hz, slope) = (48_000.0, 2.5e-6, 4152.0, -3.0);
        let mut noise = Noise::new(density, reference_hz, slope, rate_hz, stream(3, Part::RotorNoise, 0));
        let (length, count) = (2048_usize, 800_u32);
        let frequencies_hz = [70.3125, 210.9375, 703.125, 2109.375, 4148.4375, 9000.0, 15_000.0, 20_015.625];
        let window: Vec<f64> =
            (0..length).map(|n| 0.5 - 0.5 * (TAU * (n as f64 + 0.5) / length as f64).cos()).collect();
        let window_power: f64 = window.iter().map(|weight| weight * weight).sum();
        let mut sums = [0.0; 8];
        let (mut total_square, mut total_count) = (0.0, 0.0);
        for _ in 0..count {
            let frame: Vec<f64> = (0..length).map(|_| noise.next()).collect();
            total_square += frame.iter().map(|value| value * value).sum::<f64>();
            total_count += length as f64;
            for (sum, hz) in sums.iter_mut().zip(frequencies_hz) {
                let (mut re, mut im) = (0.0, 0.0);
                for (n, (value, weight)) in frame.iter().zip(&window).enumerate() {
                    let (sine, cosine) = (TAU * hz * n as f64 / rate_hz).sin_cos();
                    re += weight * value * cosine;
                    im += weight * value * sine;
                }
                *sum += (re * re + im * im) * 2.0 / (rate_hz * window_power);
            }
        }
        let relative_error = 1.0 / f64::from(count).sqrt();
        for (sum, hz) in sums.into_iter().zip(frequencies_hz) {
            let expected = density * noise.filter.power_gain(hz) / noise.filter.power_gain(reference_hz);
            let ratio = sum / f64::from(count) / expected;
            // The window's main lobe of ±47 Hz averages over the slope: up to 2 % at the lowest frequency.
            let smearing = if hz < 100.0 { 0.05 } else { 0.005 };
            assert!((ratio - 1.0).abs() < 5.0 * relative_error + smearing, "{hz} Hz: {ratio}");
        }
        // Variance of pink noise: few effective degrees of freedom, so a wide bound; it only sets the headroom.
        assert!((total_square / total_count / noise.std().powi(2) - 1.0).abs() < 0.03);
    }

    #[test]
    fn a_slope_that_the_filter_cannot_make_is_refused() {
        for slope_db_per_octave in [-6.1, 1.0, f64::NAN] {
            assert!(NoiseSettings { slope_db_per_octave, ..NoiseSettings::default() }.check().is_err());
        }
        assert!(NoiseSettings::default().check().is_ok());
    }
}
