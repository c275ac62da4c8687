//! The frequency of one line in a band, with its uncertainty. Nothing is decided about its source.

use crate::SignalError;
use crate::channels::{ChannelBand, ChannelBank};
use crate::passes::{Passes, Piece};
use crate::statistics::{mean, median, std_uncertainty_of_mean};
use hovertone_fft::ComplexPlanner;
use realfft::num_complex::Complex;
use std::f64::consts::TAU;
use std::ops::Range;

/// Length of a step, s: the phase of the line is read once in each. Between two steps the line may move by 1 / (2 × 0.1 s) = 5 Hz.
/// *Numeric.*
const STEP_S: f64 = 0.1;
/// Largest number of blocks. The scatter of their frequencies is the uncertainty, which 20 blocks give to 16 %. *Numeric.*
const BLOCKS_MAX: usize = 20;
/// Fewest blocks whose scatter is an uncertainty. *Decision.*
const BLOCKS_MIN: usize = 5;
/// Fewest steps of a block. *Numeric.*
const STEPS_MIN: usize = 4;
/// Smallest power of a line over the median power of the band: 16 dB. Noise has less than 13 dB in an hour of sound. *Decision.*
const OVER_MEDIAN_MIN: f64 = 40.0;
/// Smallest power of a line over the power of all sound: −26 dB. A loud line at the edge of the channel leaves images in it that are 29 dB below
/// it (measured by the tests). *Numeric.*
const OF_ALL_SOUND_MIN: f64 = 2.5e-3;
/// Smallest relative standard uncertainty: the audio samples are in single precision. *Numeric.*
const STD_SHARE_MIN: f64 = 5e-8;
/// Smallest power of a block, as a share of the loudest one: the tone may begin late or end early. *Decision.*
const BLOCK_POWER_MIN: f64 = 0.1;

/// Highest level of silence, dB re a sine of full scale: the last of 24 bits, and the rounding noise of an offset of full scale. *Numeric.*
pub const SILENT_DB: f64 = -138.0;

/// What is heard in a band.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct HeardBand {
    /// The line, where a clear one is heard.
    pub line: Option<LineFrequency>,
    /// Whether the whole sound is silent.
    pub is_silent: bool,
}

/// The frequency of a line.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LineFrequency {
    /// Mean frequency over the sound in which the line is heard.
    pub hz: f64,
    /// Its standard uncertainty, from the scatter of the blocks.
    pub std_uncertainty_hz: f64,
}

/// Mean frequency of the strongest line in a band, over a span of the recording: one pass.
///
/// The band becomes one channel at a low rate. The strongest line of its whole spectrum is shifted to 0 Hz; the phase of the rest, step by
/// step, is a straight line in every block, whose slope is the frequency that is left. There is no line where none is 16 dB above the median of the
/// band, or it is 26 dB below all sound, or less than 2 s are heard.
///
/// # Errors
/// A source that fails.
pub fn line_frequency(
    passes: &mut Passes<'_>,
    span_s: Range<f64>,
    band_hz: Range<f64>,
) -> Result<HeardBand, SignalError> {
    let band = ChannelBand {
        order: 1.0,
        is_first: true,
        band_hz_low: band_hz.start,
        band_hz_high: band_hz.end,
        noise_fall_db: 0.0,
    };
    let mut bank = ChannelBank::new(passes.sample_rate_hz(), &[band]);
    let mut series = vec![Vec::new()];
    let (mut squares, mut count) = (0.0, 0.0);
    passes.pieces(std::slice::from_ref(&span_s), |piece| match piece {
        Piece::Start(_) => bank.restart(),
        Piece::Samples(samples) => {
            squares += samples.iter().map(|sample| f64::from(*sample).powi(2)).sum::<f64>();
            count += samples.len() as f64;
            bank.push(samples, &mut series);
        }
        Piece::Heard(_) => {}
    })?;
    bank.finish(&mut series);
    let (centre_hz, rate_hz) = (bank.channels[0].centre_hz, bank.channels[0].rate_hz);
    let reach_hz = band_hz.start - centre_hz..band_hz.end - centre_hz;
    let series = &series[0];
    let line = strongest(series, rate_hz, reach_hz).and_then(|peak| {
        // a sine of amplitude A has the mean square A²/2
        let is_heard = peak.amplitude.powi(2) / 2.0 > OF_ALL_SOUND_MIN * squares / count;
        let left = is_heard.then(|| steps(series, rate_hz, peak.offset_hz)).and_then(|steps| offsets_hz(&steps))?;
        let hz = centre_hz + peak.offset_hz + mean(&left)?;
        Some(LineFrequency { hz, std_uncertainty_hz: std_uncertainty_of_mean(&left)?.max(STD_SHARE_MIN * hz) })
    });
    let is_silent = count > 0.0 && 10.0 * (2.0 * squares / count).log10() < SILENT_DB;
    Ok(HeardBand { line, is_silent })
}

/// The highest bin of a spectrum.
struct Peak {
    offset_hz: f64,
    amplitude: f64,
}

/// The highest bin of the whole series in a band. `None` where it is no line.
fn strongest(series: &[Complex<f32>], rate_hz: f64, band_hz: Range<f64>) -> Option<Peak> {
    let count = series.len();
    let hann = |n: usize| 0.5 - 0.5 * (TAU * (n as f64 + 0.5) / count as f64).cos();
    let mut spectrum: Vec<Complex<f32>> = series.iter().enumerate().map(|(n, z)| z * hann(n) as f32).collect();
    ComplexPlanner::new().forward(count).process(&mut spectrum);
    // the upper half of the bins are the frequencies below the centre
    let hz_of = |bin: usize| {
        let bin = if 2 * bin < count { bin as f64 } else { bin as f64 - count as f64 };
        bin * rate_hz / count as f64
    };
    let in_band: Vec<(f64, f64)> = spectrum
        .iter()
        .enumerate()
        .map(|(bin, z)| (hz_of(bin), f64::from(z.norm_sqr())))
        .filter(|(hz, _)| band_hz.contains(hz))
        .collect();
    let middle = median(&in_band.iter().map(|(_, power)| *power).collect::<Vec<_>>())?;
    let (hz, power) = in_band.into_iter().max_by(|a, b| a.1.total_cmp(&b.1))?;
    // the Hann window sums up to half of the count
    let amplitude = power.sqrt() / (count as f64 / 2.0);
    (power > OVER_MEDIAN_MIN * middle).then_some(Peak { offset_hz: hz, amplitude })
}

/// The line at a low rate: its complex amplitude in every step.
struct Steps {
    means: Vec<Complex<f64>>,
    step_s: f64,
}

/// The series, shifted by a frequency and averaged in steps. The first and the last step are left out, in which the sound fades.
fn steps(series: &[Complex<f32>], rate_hz: f64, shift_hz: f64) -> Steps {
    let step_samples = (STEP_S * rate_hz).round().max(1.0) as usize;
    let shifted = |(n, z): (usize, &Complex<f32>)| {
        let turns = shift_hz * n as f64 / rate_hz;
        Complex::new(f64::from(z.re), f64::from(z.im)) * Complex::from_polar(1.0, -TAU * turns.fract())
    };
    let shifted: Vec<Complex<f64>> = series.iter().enumerate().map(shifted).collect();
    let mean_of = |step: &[Complex<f64>]| step.iter().sum::<Complex<f64>>() / step_samples as f64;
    let mut means: Vec<Complex<f64>> = shifted.chunks_exact(step_samples).map(mean_of).collect();
    means.pop();
    Steps { means: means.split_off(1.min(means.len())), step_s: step_samples as f64 / rate_hz }
}

/// Frequency in each block in which the line is heard. `None` where there are too few blocks.
fn offsets_hz(steps: &Steps) -> Option<Vec<f64>> {
    let block_count = (steps.means.len() / STEPS_MIN).min(BLOCKS_MAX);
    if block_count < BLOCKS_MIN {
        return None;
    }
    let blocks: Vec<&[Complex<f64>]> = steps.means.chunks_exact(steps.means.len() / block_count).collect();
    let power = |block: &&[Complex<f64>]| block.iter().map(Complex::norm_sqr).sum::<f64>();
    let loudest = blocks.iter().map(power).fold(0.0, f64::max);
    let heard = blocks.iter().filter(|block| power(block) >= BLOCK_POWER_MIN * loudest);
    let offsets: Vec<f64> = heard.map(|block| slope_turns(block) / steps.step_s).collect();
    (offsets.len() >= BLOCKS_MIN).then_some(offsets)
}

/// Slope of the phase in turns per step, by least squares.
fn slope_turns(block: &[Complex<f64>]) -> f64 {
    let mut turns = 0.0;
    let mut phases = vec![0.0];
    for pair in block.windows(2) {
        turns += (pair[1] * pair[0].conj()).arg() / TAU;
        phases.push(turns);
    }
    let middle = (phases.len() as f64 - 1.0) / 2.0;
    let (products, squares) = phases.iter().enumerate().fold((0.0, 0.0), |(products, squares), (n, phase)| {
        let x = n as f64 - middle;
        (products + x * phase, squares + x * x)
    });
    products / squares
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Signal;
    use rand::SeedableRng;
    use rand_distr::{Distribution, StandardNormal};

    const RATE_HZ: f64 = 8000.0;

    fn heard(samples: Vec<f32>, band_hz: Range<f64>) -> Option<LineFrequency> {
        let mut signal = Signal::new(samples, RATE_HZ);
        let mut on_progress = |_| {};
        let mut passes = Passes::planned(&mut signal, 1, &mut on_progress).unwrap();
        line_frequency(&mut passes, 0.0..f64::INFINITY, band_hz).unwrap().line
    }

    fn noise(seed: u64, count: usize, std: f64) -> Vec<f64> {
        let mut random = rand_pcg::Pcg64::seed_from_u64(seed);
        (0..count)
            .map(|_| {
                let value: f64 = StandardNormal.sample(&mut random);
                std * value
            })
            .collect()
    }

    /// The error against the stated uncertainty, over levels of noise from 20 dB below the line to 10 dB above it, at frequencies within
    /// the band.
    #[test]
    fn the_stated_uncertainty_covers_the_frequency() {
        let (mut covered, mut errors_ppm) = (0, Vec::new());
        let runs = 90;
        for run in 0..runs {
            let hz = 431.0 + 0.21 * run as f64;
            let noise = noise(run, 48_000, [0.07, 0.3, 2.2][run as usize % 3]);
            let samples = noise.iter().enumerate().map(|(n, noise)| (TAU * hz * n as f64 / RATE_HZ).sin() + noise);
            let line = heard(samples.map(|sample| sample as f32).collect(), 429.0..451.0).unwrap();
            covered += usize::from((line.hz - hz).abs() <= 2.0 * line.std_uncertainty_hz);
            errors_ppm.push(1e6 * (line.hz / hz - 1.0).abs());
        }
        errors_ppm.sort_by(f64::total_cmp);
        // k = 2 covers 95 %, and 14 degrees of freedom 93 %; 90 runs show that to 2.6 %
        assert!(covered as f64 >= (0.93 - 2.0 * 0.026) * runs as f64, "{covered} of {runs}");
        assert!(errors_ppm[45] < 5.0, "{errors_ppm:?}");
    }

    #[test]
    fn a_tone_that_wanders_or_begins_late_is_heard_with_its_mean() {
        let wander = |n: usize| 440.0 + 0.5 * (TAU * n as f64 / 10_000.0).sin();
        let mut turns = 0.0;
        let samples: Vec<f32> = (0..80_000)
            .map(|n| {
                turns += wander(n) / RATE_HZ;
                if n < 20_000 { 0.0 } else { (0.1 * (TAU * turns).sin()) as f32 }
            })
            .collect();
        let line = heard(samples, 429.0..451.0).unwrap();
        assert!((line.hz - 440.0).abs() < 3.0 * line.std_uncertainty_hz, "{line:?}");
        assert!((0.01..0.2).contains(&line.std_uncertainty_hz), "{line:?}");
    }

    #[test]
    fn noise_silence_and_a_line_beside_the_band_are_no_line() {
        assert_eq!(heard(vec![0.0; 80_000], 429.0..451.0), None);
        let tone = |n: usize| (TAU * 480.0 * n as f64 / RATE_HZ).sin();
        // without noise, the side lobes of a loud line are all that the band holds
        for step in 0..40 {
            let loud = |n: usize| (TAU * (460.0 + 2.0 * f64::from(step)) * n as f64 / RATE_HZ).sin();
            assert_eq!(heard((0..40_000).map(|n| loud(n) as f32).collect(), 429.0..451.0), None, "{step}");
        }
        for seed in 0..20 {
            let noise = noise(seed, 80_000, 0.01);
            let beside = noise.iter().enumerate().map(|(n, noise)| (tone(n) + noise) as f32).collect();
            assert_eq!(heard(noise.iter().map(|noise| *noise as f32).collect(), 429.0..451.0), None, "{seed}");
            assert_eq!(heard(beside, 429.0..451.0), None, "{seed}");
        }
        assert_eq!(heard((0..8000).map(|n| tone(n) as f32).collect(), 470.0..490.0), None, "too short");
    }
}
