//! The noise around a line: how much of it falls into one sample of a channel.

use super::frame::FrameTransform;
use hovertone_signal::statistics::median;
use realfft::num_complex::Complex;
use rustfft::FftPlanner;

/// Share of a channel's bins, around its middle, that count: the outermost are the band-pass' own slopes.
const MIDDLE_SHARE: f64 = 0.8;
/// Frames of the noise spectrum, in hops of the bank: 0.34 s, so that a wandering line covers few bins.
const FRAME_HOPS: usize = 4;

/// Measures the floor of one channel.
pub(crate) struct FloorMeter {
    frames: FrameTransform,
    power: Vec<f64>,
    middle: Vec<f64>,
}

impl FloorMeter {
    pub(crate) fn new(hop_samples: usize, planner: &mut FftPlanner<f32>) -> Self {
        let length = FRAME_HOPS * hop_samples;
        Self { frames: FrameTransform::new(length, 1, planner), power: vec![0.0; length], middle: Vec::new() }
    }

    /// Variance of the noise in one complex sample, `E |e|²`: the median over the channel's bins of the mean power
    /// spectrum, so that the lines themselves, of this rotor and others, do not count. `None` of less than one frame.
    ///
    /// The median of a mean of M exponential values lies 1 / 3M below their mean; that is corrected for.
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
        // neighbouring frames share half of their sound: two are worth 1.9
        let worth = 1.0 + 0.9 * f64::from(frames - 1);
        let median_of_mean = if frames == 1 { std::f64::consts::LN_2 } else { 1.0 - 1.0 / (3.0 * worth) };
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
        let mut meter = FloorMeter::new(hop_samples, &mut FftPlanner::new());
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
