//! The sound of one rotor with nothing in it that is not known exactly: lines at whole orders of a shaft whose turns are
//! counted at every sample, and Gaussian noise whose power density has a formula. Shares no code with the core, nor with
//! the simulator.

use hovertone::speed::Span;
use rand::RngExt;
use rand_distr::StandardNormal;
use rand_pcg::Pcg64;
use std::f64::consts::{PI, TAU};

pub(super) const SAMPLE_RATE_HZ: f64 = 48_000.0;
pub(super) const DURATION_S: f64 = 5.0;
/// Falling noise is flat below this (no tone is that low) and falls by 6 dB per octave above.
const CORNER_HZ: f64 = 20.0;
/// Largest sample: all lines at their peaks together with six standard deviations of noise.
const PEAK: f64 = 0.5;
const NOISE_PEAK_STDS: f64 = 6.0;
/// Nodes of the wander; a whole number of samples.
const WANDER_STEP_S: f64 = 0.05;
/// Half width, in nodes, of the Hann weights that smooth it.
const WANDER_SMOOTHING_NODES: i32 = 4;

/// A series of lines: levels (amplitudes) at 1, 2, 3 … times the order.
#[derive(Clone, Debug)]
pub(super) struct Series {
    pub(super) order: u32,
    pub(super) levels: Vec<f64>,
}

impl Series {
    /// Order and level of each line.
    pub(super) fn lines(&self) -> impl Iterator<Item = (f64, f64)> {
        (1..).map(f64::from).zip(&self.levels).map(|(number, &level)| (number * f64::from(self.order), level))
    }
}

/// Power of all lines together.
pub(super) fn tone_power(series: &[Series]) -> f64 {
    series.iter().flat_map(Series::lines).map(|(_, level)| level * level / 2.0).sum()
}

/// Colour of the noise.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Colour {
    White,
    Falling,
}

/// Stationary Gaussian noise, `e[n] = pole · e[n-1] + white[n]`; white where the pole is 0.
#[derive(Clone, Copy, Debug)]
pub(super) struct Noise {
    pole: f64,
    /// Its variance: the power between 0 and half the sample rate.
    power: f64,
}

impl Noise {
    pub(super) fn of_power(colour: Colour, power: f64) -> Self {
        let pole = match colour {
            Colour::White => 0.0,
            Colour::Falling => (-TAU * CORNER_HZ / SAMPLE_RATE_HZ).exp(),
        };
        Self { pole, power }
    }

    /// One-sided power density, exactly: `2/fs · power (1 - p²) / |1 - p e^(-iω)|²`.
    pub(super) fn density(&self, hz: f64) -> f64 {
        let distance_square = 1.0 - 2.0 * self.pole * (TAU * hz / SAMPLE_RATE_HZ).cos() + self.pole * self.pole;
        2.0 / SAMPLE_RATE_HZ * self.kick_power() / distance_square
    }

    fn kick_power(&self) -> f64 {
        self.power * (1.0 - self.pole * self.pole)
    }

    fn add(&self, samples: &mut [f64], random: &mut Pcg64) {
        let normal = |random: &mut Pcg64| -> f64 { random.sample(StandardNormal) };
        let kick_std = self.kick_power().sqrt();
        let mut value = self.power.sqrt() * normal(random);
        for sample in samples {
            *sample += value;
            value = self.pole * value + kick_std * normal(random);
        }
    }
}

/// How the shaft turns.
#[derive(Clone, Copy, Debug)]
pub(super) enum Turning {
    Steady,
    /// An Ornstein-Uhlenbeck process at nodes 0.05 s apart, smoothed over nine of them and straight in between.
    Wandering {
        std_share: f64,
        time_constant_s: f64,
    },
}

/// A rotor to be heard.
#[derive(Clone, Debug)]
pub(super) struct Rotor {
    pub(super) mean_rev_s: f64,
    pub(super) turning: Turning,
    pub(super) series: Vec<Series>,
    pub(super) noise: Noise,
}

/// What is heard, and the turns of the shaft at every sample and at the end.
pub(super) struct Rendered {
    pub(super) samples: Vec<f32>,
    turns: Vec<f64>,
}

impl Rendered {
    /// Mean speed over these spans together, from the turns between their ends.
    pub(super) fn mean_rev_s(&self, spans: &[Span]) -> Option<f64> {
        let length_s: f64 = spans.iter().map(Span::length_s).sum();
        let turned: f64 = spans.iter().map(|span| self.turns_at(span.to_s) - self.turns_at(span.from_s)).sum();
        (length_s > 0.0).then(|| turned / length_s)
    }

    fn turns_at(&self, time_s: f64) -> f64 {
        let last = self.turns.len() - 1;
        let position = (time_s * SAMPLE_RATE_HZ).clamp(0.0, last as f64);
        let before = (position.floor() as usize).min(last - 1);
        self.turns[before] + (position - before as f64) * (self.turns[before + 1] - self.turns[before])
    }
}

/// The sound, its phases, wander and noise drawn.
pub(super) fn rendered(rotor: &Rotor, random: &mut Pcg64) -> Rendered {
    let count = (DURATION_S * SAMPLE_RATE_HZ).round() as usize;
    let turns = turns_of(rotor, count, random);
    let mut samples = vec![0.0; count];
    for series in &rotor.series {
        let lines: Vec<(f64, f64)> = series
            .levels
            .iter()
            .map(|level| {
                let (sine, cosine) = random.random_range(0.0..TAU).sin_cos();
                (level * cosine, level * sine)
            })
            .collect();
        for (sample, turns) in samples.iter_mut().zip(&turns) {
            // only the part of a turn counts, and a sine is most exact for small arguments
            let turned = f64::from(series.order) * turns;
            let (sine, cosine) = (TAU * (turned - turned.round())).sin_cos();
            let (mut re, mut im) = (cosine, sine);
            for (in_phase, across) in &lines {
                *sample += in_phase * re - across * im;
                (re, im) = (re * cosine - im * sine, re * sine + im * cosine);
            }
        }
    }
    rotor.noise.add(&mut samples, random);
    let lines_peak: f64 = rotor.series.iter().flat_map(|series| &series.levels).sum();
    let gain = PEAK / (lines_peak + NOISE_PEAK_STDS * rotor.noise.power.sqrt());
    Rendered { samples: samples.into_iter().map(|sample| (gain * sample) as f32).collect(), turns }
}

/// Turns at each sample and at the end. The speed between two samples is that halfway, which is its mean there.
fn turns_of(rotor: &Rotor, count: usize, random: &mut Pcg64) -> Vec<f64> {
    let wander = match rotor.turning {
        Turning::Steady => None,
        Turning::Wandering { std_share, time_constant_s } => {
            let nodes = (count as f64 / SAMPLE_RATE_HZ / WANDER_STEP_S).ceil() as usize + 1;
            Some(smooth_wander(std_share, time_constant_s, nodes, random))
        }
    };
    let share_at = |time_s: f64| match &wander {
        None => 1.0,
        Some(nodes) => {
            let position = time_s / WANDER_STEP_S;
            let before = (position as usize).min(nodes.len() - 2);
            1.0 + nodes[before] + (position - before as f64) * (nodes[before + 1] - nodes[before])
        }
    };
    let mut turned = 0.0;
    let mut turns = Vec::with_capacity(count + 1);
    turns.push(turned);
    for sample in 0..count {
        turned += rotor.mean_rev_s * share_at((sample as f64 + 0.5) / SAMPLE_RATE_HZ) / SAMPLE_RATE_HZ;
        turns.push(turned);
    }
    turns
}

/// A smoothed Ornstein-Uhlenbeck process of that standard deviation (after smoothing) at its nodes.
fn smooth_wander(std: f64, time_constant_s: f64, count: usize, random: &mut Pcg64) -> Vec<f64> {
    let half = WANDER_SMOOTHING_NODES;
    let weights: Vec<f64> =
        (-half..=half).map(|node| 0.5 + 0.5 * (PI * f64::from(node) / f64::from(half + 1)).cos()).collect();
    let keep = (-WANDER_STEP_S / time_constant_s).exp();
    let smoothed_variance: f64 = (0..)
        .zip(&weights)
        .flat_map(|(i, a)| (0..).zip(&weights).map(move |(j, b)| a * b * keep.powi(i32::abs(i - j))))
        .sum();
    let kick_std = (1.0 - keep * keep).sqrt();
    let mut value: f64 = random.sample(StandardNormal);
    let raw: Vec<f64> = (0..count + weights.len())
        .map(|_| {
            let kick: f64 = random.sample(StandardNormal);
            let next = keep * value + kick_std * kick;
            std::mem::replace(&mut value, next)
        })
        .collect();
    raw.windows(weights.len())
        .take(count)
        .map(|window| window.iter().zip(&weights).map(|(value, weight)| value * weight).sum::<f64>())
        .map(|sum| std * sum / smoothed_variance.sqrt())
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use rand::SeedableRng;

    fn mesh() -> Vec<Series> {
        vec![Series { order: 69, levels: vec![1.0, 0.5, 0.25] }]
    }

    fn rotor(series: Vec<Series>, colour: Colour, noise_power: f64) -> Rotor {
        let noise = Noise::of_power(colour, noise_power);
        Rotor { mean_rev_s: 60.172_39, turning: Turning::Steady, series, noise }
    }

    fn power(samples: &[f32]) -> f64 {
        samples.iter().map(|&sample| f64::from(sample).powi(2)).sum::<f64>() / samples.len() as f64
    }

    /// The sample power of N white samples has the relative standard deviation √(2/N); that of noise of correlation
    /// time 1/(2π 20 Hz) has √(1/(2π 20 Hz · 5 s)) = 4 %.
    #[test]
    fn the_signal_to_noise_ratio_is_the_set_one() {
        for (colour, tolerance) in [(Colour::White, 5.0 * (2.0_f64 / 240_000.0).sqrt()), (Colour::Falling, 0.2)] {
            let noise_power = tone_power(&mesh()) * 10.0;
            let both = rendered(&rotor(mesh(), colour, noise_power), &mut Pcg64::seed_from_u64(5));
            let tones = rendered(&rotor(mesh(), colour, 0.0), &mut Pcg64::seed_from_u64(5));
            // without noise the gain is another: it is PEAK over the sum of the levels
            let gain = PEAK / (1.75 + NOISE_PEAK_STDS * noise_power.sqrt());
            assert!((power(&tones.samples) / (PEAK / 1.75).powi(2) / tone_power(&mesh()) - 1.0).abs() < 1e-4);
            let noise = power(&both.samples) / gain.powi(2) - tone_power(&mesh());
            assert!((noise / noise_power - 1.0).abs() < tolerance, "{colour:?}: {}", noise / noise_power);
            assert!(both.samples.iter().all(|sample| sample.abs() < 1.0));
        }
    }

    /// The mean of M periodograms has the relative standard error 1/√M.
    #[test]
    fn falling_noise_has_its_density() {
        let noise = Noise::of_power(Colour::Falling, 2.0);
        let (length, count) = (4800_usize, 400_usize);
        let mut samples = vec![0.0; length * count];
        noise.add(&mut samples, &mut Pcg64::seed_from_u64(6));
        for hz in [120.0, 1000.0, 4150.0, 12_450.0, 20_000.0] {
            let periodogram = |frame: &[f64]| {
                let (mut re, mut im, mut weights) = (0.0, 0.0, 0.0);
                for (n, value) in frame.iter().enumerate() {
                    let weight = 0.5 - 0.5 * (TAU * (n as f64 + 0.5) / length as f64).cos();
                    let (sine, cosine) = (TAU * hz * n as f64 / SAMPLE_RATE_HZ).sin_cos();
                    re += weight * value * cosine;
                    im += weight * value * sine;
                    weights += weight * weight;
                }
                2.0 * (re * re + im * im) / (SAMPLE_RATE_HZ * weights)
            };
            let mean = samples.chunks(length).map(periodogram).sum::<f64>() / count as f64;
            let ratio = mean / noise.density(hz);
            assert!((ratio - 1.0).abs() < 5.0 / (count as f64).sqrt() + 0.03, "{hz} Hz: {ratio}");
        }
        let falls_db = 10.0 * (noise.density(400.0) / noise.density(200.0)).log10();
        assert!((falls_db + 6.0).abs() < 0.05, "{falls_db}");
    }

    #[test]
    fn lines_stand_at_their_orders_with_their_levels() {
        let sound = rendered(&rotor(mesh(), Colour::White, 0.0), &mut Pcg64::seed_from_u64(7));
        for (order, level) in mesh()[0].lines() {
            let (mut re, mut im) = (0.0, 0.0);
            for (sample, turns) in sound.samples.iter().zip(&sound.turns) {
                let (sine, cosine) = (TAU * order * turns).sin_cos();
                re += f64::from(*sample) * cosine;
                im += f64::from(*sample) * sine;
            }
            let found = 2.0 * re.hypot(im) / sound.samples.len() as f64 * 1.75 / PEAK;
            assert!((found - level).abs() < 1e-3, "order {order}: {found}");
        }
    }

    #[test]
    fn the_wander_has_its_spread_and_the_truth_is_its_mean() {
        let mut random = Pcg64::seed_from_u64(8);
        let count = 400_000;
        let wander = smooth_wander(0.004, 0.8, count, &mut random);
        let variance = wander.iter().map(|value| value * value).sum::<f64>() / count as f64;
        // relative standard error of the variance √(2τ/T), see `wander.rs` of the simulator
        let tolerance = 5.0 * (2.0 * 0.8 / (count as f64 * WANDER_STEP_S)).sqrt();
        assert!((variance.sqrt() / 0.004 - 1.0).abs() < tolerance, "{}", variance.sqrt());
        let turning = Turning::Wandering { std_share: 0.004, time_constant_s: 0.8 };
        let rotor = Rotor { turning, ..rotor(mesh(), Colour::White, 1.0) };
        let sound = rendered(&rotor, &mut random);
        let whole = sound.mean_rev_s(&[Span { from_s: 0.0, to_s: DURATION_S }]).unwrap();
        assert!((whole - sound.turns.last().unwrap() / DURATION_S).abs() < 1e-12);
        assert!((whole / 60.172_39 - 1.0).abs() < 0.02 && whole != 60.172_39);
        assert_eq!(sound.mean_rev_s(&[]), None);
    }
}
