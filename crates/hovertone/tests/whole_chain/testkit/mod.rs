//! Sound with known truth, made by `hovertone_sim::prescribed`: the simulator does not know the estimator, so the estimator
//! cannot be right by construction.

pub(crate) mod not_rotors;

use hovertone::sound::Signal;
use hovertone::speed::{Config, Outcome, RotorTone, SpeedAnalysis, ToneConfig, speed_from_source};
use hovertone_sim::prescribed::{Line, Noise, Recording, Rotor, Sampling};
use hovertone_vehicle::Order;
use rand::SeedableRng;
use rand_pcg::Pcg64;
use std::f64::consts::TAU;

pub(crate) const SAMPLE_RATE_HZ: f64 = 44100.0;

/// Order and amplitude of each line of a rotor with two blades.
pub(crate) const TWO_BLADES: [(f64, f64); 5] = [(1.0, 0.01), (2.0, 0.1), (4.0, 0.05), (6.0, 0.03), (8.0, 0.02)];

/// Order and amplitude of each line of a rotor with two unlike blades, from the amplitudes of the harmonics of its blade pass: line 1 is
/// 14 dB below the strongest, the lines between are 7 dB below the mean of their neighbours, as real rotors have them on average.
pub(crate) fn unlike_blades(blade_pass: &[f64]) -> Vec<(f64, f64)> {
    let strongest = blade_pass.iter().copied().fold(0.0, f64::max);
    let mut lines = vec![(1.0, 0.2 * strongest)];
    for (index, &level) in blade_pass.iter().enumerate() {
        let order = 2.0 * (index + 1) as f64;
        lines.push((order, level));
        lines.extend(blade_pass.get(index + 1).map(|next| (order + 1.0, 0.45 * (level * next).sqrt())));
    }
    lines
}

/// A rotor with this shaft speed and with lines of these orders and amplitudes. Phases are fixed: 0.37 turns times the order,
/// and the shaft begins at 0.1 turns.
pub(crate) fn rotor<'a>(speed_rev_s: impl Fn(f64) -> f64 + 'a, lines: &[(f64, f64)]) -> Rotor<'a> {
    let line = |&(order, level): &(f64, f64)| Line::new(order, level).with_phase_rad(TAU * 0.37 * order);
    Rotor::new(speed_rev_s, lines.iter().map(line).collect()).from_turns(0.1)
}

/// Rotors in white noise of a standard deviation.
pub(crate) fn recording(rotors: &[Rotor<'_>], length_s: f64, noise_std: f64, seed: u64) -> Recording {
    let mut recording = Recording::of_rotors(rotors, Sampling::new(SAMPLE_RATE_HZ, length_s));
    recording.add_noise(&Noise::white(noise_std), &mut Pcg64::seed_from_u64(seed));
    recording
}

/// The samples of rotors in white noise of a standard deviation.
pub(crate) fn sound(rotors: &[Rotor<'_>], length_s: f64, noise_std: f64, seed: u64) -> Vec<f32> {
    recording(rotors, length_s, noise_std, seed).samples_f32()
}

/// Noise alone.
pub(crate) fn noise(noise: &Noise, length_s: f64, seed: u64) -> Vec<f32> {
    let mut recording = Recording::of_rotors(&[], Sampling::new(SAMPLE_RATE_HZ, length_s));
    recording.add_noise(noise, &mut Pcg64::seed_from_u64(seed));
    recording.samples_f32()
}

/// One steady rotor of two blades.
pub(crate) fn steady(speed_rev_s: f64, length_s: f64, noise_std: f64) -> Vec<f32> {
    sound(&[rotor(|_| speed_rev_s, &TWO_BLADES)], length_s, noise_std, 1)
}

/// Every method is examined.
pub(crate) fn config(order: f64) -> Config {
    let tone = ToneConfig::of_order(Order::new(order).expect("an order"));
    Config { all_methods: true, ..Config::for_tone(tone) }
}

pub(crate) fn analyse(samples: Vec<f32>, config: &Config) -> SpeedAnalysis {
    let mut source = Signal::new(samples, SAMPLE_RATE_HZ);
    speed_from_source(&mut source, config, &mut |_| {}).expect("an analysis")
}

pub(crate) fn tone(analysis: &SpeedAnalysis) -> &RotorTone {
    match &analysis.outcome {
        Outcome::Ok(tone) => tone,
        Outcome::NoRotorTone { reason } => panic!("no rotor tone: {reason}"),
    }
}

pub(crate) fn hears_nothing(analysis: &SpeedAnalysis) -> bool {
    matches!(analysis.outcome, Outcome::NoRotorTone { .. })
}
