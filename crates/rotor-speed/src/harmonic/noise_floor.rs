//! The noise around a line: its variance in one sample of the channel.

use super::frame_transform::FrameTransform;
use hovertone_signal::fft::ComplexPlanner;
use hovertone_signal::statistics::median;
use realfft::num_complex::Complex;

/// Share of the bins of a channel, around its middle, that count: the outer bins lie on the slopes of the band-pass filter.
/// *Numeric.*
const MIDDLE_SHARE: f64 = 0.8;
/// Length of the frames of the noise spectrum, in hops of the filter bank: 0.34 s, so that a line of varying frequency covers
/// few bins. *Numeric.*
const NOISE_FRAME_HOPS: usize = 4;

/// Independent frames that each further frame adds: Hann frames that overlap by half share part of their sound (Welch, IEEE
/// Trans. Audio and Electroacoustics 15, 1967). *Numeric.*
const INDEPENDENT_PER_FRAME: f64 = 0.9;

/// Measures the noise floor of one channel.
pub(crate) struct NoiseMeter {
    frames: FrameTransform,
    /// Sum of the power spectra of all frames.
    power: Vec<f64>,
    /// Scratch for the bins that count.
    middle: Vec<f64>,
}

impl NoiseMeter {
    pub(crate) fn new(hop_samples: usize, planner: &mut ComplexPlanner) -> Self {
        let length = NOISE_FRAME_HOPS * hop_samples;
        Self { frames: FrameTransform::new(length, 1, planner), power: vec![0.0; length], middle: Vec::new() }
    }

    /// Variance of the noise in one complex sample, `E |e|²`: the median over the bins of the mean power spectrum (Welch 1967). The
    /// median leaves out the lines of this rotor and of others. `None` for less than one frame.
    ///
    /// The median of a mean of M independent exponential values is 1 − 1 / 3M of its expectation, and ln 2 for M = 1; the result
    /// is corrected for that.
    pub(crate) fn noise_variance(&mut self, series: &[Complex<f32>]) -> Option<f64> {
        let length = self.frames.length();
        self.power.fill(0.0);
        let mut frames = 0;
        for start in (0..(series.len() + 1).saturating_sub(length)).step_by(length / 2) {
            for (sum, bin) in self.power.iter_mut().zip(self.frames.spectrum(&series[start..])) {
                *sum += f64::from(bin.norm_sqr());
            }
            frames += 1;
        }
        let half = (MIDDLE_SHARE * length as f64 / 2.0) as usize;
        self.middle.clear();
        self.middle.extend_from_slice(&self.power[..half]);
        self.middle.extend_from_slice(&self.power[length - half..]);
        let middle = median(&self.middle).filter(|_| frames > 0)? / f64::from(frames);
        let independent = 1.0 + INDEPENDENT_PER_FRAME * f64::from(frames - 1);
        let median_of_mean = if frames == 1 { std::f64::consts::LN_2 } else { 1.0 - 1.0 / (3.0 * independent) };
        Some(middle / self.frames.energy / median_of_mean)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use rand::SeedableRng;
    use rand_distr::{Distribution, StandardNormal};

    #[test]
    fn the_floor_is_the_noise_whatever_lines_stand_on_it() {
        let mut rng = rand_pcg::Pcg64::seed_from_u64(3);
        let hop_samples = 48;
        let mut meter = NoiseMeter::new(hop_samples, &mut ComplexPlanner::new());
        for (frames, tolerance) in [(60, 0.05), (6, 0.2)] {
            let series: Vec<Complex<f32>> = (0..frames * 2 * hop_samples)
                .map(|n| {
                    let mut noise = || -> f32 { StandardNormal.sample(&mut rng) };
                    let line = Complex::from_polar(30.0, 0.3 * n as f32);
                    Complex::new(noise(), noise()) + line
                })
                .collect();
            let got = meter.noise_variance(&series).unwrap();
            assert!((got / 2.0 - 1.0).abs() < tolerance, "{frames}: {got}");
        }
        assert!(meter.noise_variance(&[]).is_none());
    }
}
