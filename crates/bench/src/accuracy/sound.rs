//! The sound of one rotor with known truth: lines at whole orders of a shaft whose turns are counted at every sample, and
//! Gaussian noise whose power density has a formula. Made by `hovertone_sim::prescribed`, which shares no code with the core.

use hovertone::speed::Span;
use hovertone_sim::prescribed::{self, Line, Nodes, Recording, Sampling, Wander};
use rand_pcg::Pcg64;

pub(super) const SAMPLE_RATE_HZ: f64 = 48_000.0;
pub(super) const DURATION_S: f64 = 5.0;
/// Falling noise is flat below this corner (no tone is that low) and falls by 6 dB per octave above.
const CORNER_HZ: f64 = 20.0;
/// Largest sample: all lines at their peaks together with six standard deviations of noise.
const PEAK: f64 = 0.5;
const NOISE_PEAK_STDS: f64 = 6.0;
/// Nodes of the wander.
const WANDER_STEP_S: f64 = 0.05;
/// Half width, in nodes, of the Hann weights that smooth it.
const WANDER_SMOOTHING_NODES: u32 = 4;

/// Lines at 1, 2, 3 … times an order with these levels (amplitudes).
pub(super) fn series(order: u32, levels: &[f64]) -> Vec<Line> {
    (1..).map(f64::from).zip(levels).map(|(number, &level)| Line::new(number * f64::from(order), level)).collect()
}

/// Power of all lines together.
pub(super) fn tone_power(lines: &[Line]) -> f64 {
    lines.iter().map(Line::power).sum()
}

/// Colour of the noise.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Colour {
    White,
    Falling,
}

/// Stationary noise of a colour and of a power between 0 and half the sample rate.
#[derive(Clone, Copy, Debug)]
pub(super) struct Noise {
    pub(super) colour: Colour,
    pub(super) power: f64,
}

impl Noise {
    fn std(&self) -> f64 {
        self.power.sqrt()
    }

    fn process(&self) -> prescribed::Noise {
        match self.colour {
            Colour::White => prescribed::Noise::white(self.std()),
            Colour::Falling => prescribed::Noise::falling(self.std(), CORNER_HZ, SAMPLE_RATE_HZ),
        }
    }

    /// One-sided power density.
    pub(super) fn density(&self, hz: f64) -> f64 {
        self.process().density(hz, SAMPLE_RATE_HZ)
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

/// The rotor to be rendered.
#[derive(Clone, Debug)]
pub(super) struct Rotor {
    pub(super) mean_rev_s: f64,
    pub(super) turning: Turning,
    pub(super) lines: Vec<Line>,
    pub(super) noise: Noise,
}

/// The sound, its wander, phases and noise drawn in this order.
pub(super) fn rendered(rotor: &Rotor, random: &mut Pcg64) -> Recording {
    let shares = shares_of(rotor.turning, random);
    let lines: Vec<Line> = rotor.lines.iter().map(|line| line.clone().with_random_phase(random)).collect();
    let sampling = Sampling::new(SAMPLE_RATE_HZ, DURATION_S).with_truth_at_every_sample();
    let turning = prescribed::Rotor::new(|time_s| rotor.mean_rev_s * shares.at(time_s), lines);
    let mut recording = Recording::of_rotors(&[turning], sampling);
    recording.add_noise(&rotor.noise.process(), random);
    let lines_peak: f64 = rotor.lines.iter().map(|line| line.level).sum();
    recording.scale(PEAK / (lines_peak + NOISE_PEAK_STDS * rotor.noise.std()));
    recording
}

/// True mean speed over these spans together; none for spans of no length.
pub(super) fn mean_rev_s(recording: &Recording, spans: &[Span]) -> Option<f64> {
    let within = |time_s: f64| time_s.clamp(0.0, DURATION_S);
    let within = |span: &Span| hovertone_sim::Span { from_s: within(span.from_s), to_s: within(span.to_s) };
    let spans: Vec<_> = spans.iter().map(within).collect();
    recording.truth().mean_speed_over(0, &spans).map(|speed| speed.rev_s())
}

/// The speed over time, as a share of its mean.
fn shares_of(turning: Turning, random: &mut Pcg64) -> Nodes {
    let deviations = match turning {
        Turning::Steady => Vec::new(),
        Turning::Wandering { std_share, time_constant_s } => {
            let count = (DURATION_S / WANDER_STEP_S).ceil() as usize + 1;
            Wander { std: std_share, time_constant_s, step_s: WANDER_STEP_S, count }
                .smoothed(WANDER_SMOOTHING_NODES, random)
        }
    };
    Nodes::about(1.0, WANDER_STEP_S, deviations)
}

#[cfg(test)]
mod tests {
    use super::*;
    use rand::SeedableRng;
    use std::f64::consts::TAU;

    fn mesh() -> Vec<Line> {
        series(69, &[1.0, 0.5, 0.25])
    }

    fn rotor(lines: Vec<Line>, colour: Colour, power: f64) -> Rotor {
        Rotor { mean_rev_s: 60.172_39, turning: Turning::Steady, lines, noise: Noise { colour, power } }
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
            let both = rendered(&rotor(mesh(), colour, noise_power), &mut Pcg64::seed_from_u64(5)).samples_f32();
            let tones = rendered(&rotor(mesh(), colour, 0.0), &mut Pcg64::seed_from_u64(5)).samples_f32();
            // without noise the gain is another: it is PEAK over the sum of the levels
            let gain = PEAK / (1.75 + NOISE_PEAK_STDS * noise_power.sqrt());
            assert!((power(&tones) / (PEAK / 1.75).powi(2) / tone_power(&mesh()) - 1.0).abs() < 1e-4);
            let noise = power(&both) / gain.powi(2) - tone_power(&mesh());
            assert!((noise / noise_power - 1.0).abs() < tolerance, "{colour:?}: {}", noise / noise_power);
            assert!(both.iter().all(|sample| sample.abs() < 1.0));
        }
    }

    #[test]
    fn lines_stand_at_their_orders_with_their_levels() {
        let sound = rendered(&rotor(mesh(), Colour::White, 0.0), &mut Pcg64::seed_from_u64(7));
        for line in mesh() {
            let (mut re, mut im) = (0.0, 0.0);
            for (sample, row) in sound.samples_f32().iter().zip(sound.truth().rows()) {
                let (sine, cosine) = (TAU * line.order * row.rotors[0].turns).sin_cos();
                re += f64::from(*sample) * cosine;
                im += f64::from(*sample) * sine;
            }
            let found = 2.0 * f64::hypot(re, im) / sound.samples().len() as f64 * 1.75 / PEAK;
            assert!((found - line.level).abs() < 1e-3, "order {}: {found}", line.order);
        }
    }

    #[test]
    fn the_truth_of_a_wandering_rotor_is_its_mean() {
        let turning = Turning::Wandering { std_share: 0.004, time_constant_s: 0.8 };
        let rotor = Rotor { turning, ..rotor(mesh(), Colour::White, 1.0) };
        let sound = rendered(&rotor, &mut Pcg64::seed_from_u64(8));
        let whole = mean_rev_s(&sound, &[Span { from_s: 0.0, to_s: DURATION_S }]).unwrap();
        let turns = sound.truth().rows().last().unwrap().rotors[0].turns;
        assert!((whole - turns / DURATION_S).abs() < 1e-12);
        assert!((whole / 60.172_39 - 1.0).abs() < 0.02 && whole != 60.172_39);
        assert_eq!(mean_rev_s(&sound, &[]), None);
    }
}
