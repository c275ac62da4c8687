//! What the tests of the flight's sound share: flights by formula, and tones measured.
use hovertone_sim::{FlightSound, RotorState, SoundSettings, SoundState};
use nalgebra::Complex;
use std::f64::consts::TAU;

pub(crate) const UP: [f64; 3] = [0.0, 0.0, 1.0];

/// Renders states at `step_s`, the first at 0 and the last at `duration_s` or just after it.
pub(crate) fn render(
    settings: &SoundSettings,
    duration_s: f64,
    step_s: f64,
    rotors: impl Fn(f64) -> Vec<RotorState>,
) -> Vec<Vec<f32>> {
    let mut sound = FlightSound::new(settings.clone()).unwrap();
    let mut out = Vec::new();
    for step in 0..=(duration_s / step_s - 1e-9).ceil() as u32 {
        let time_s = f64::from(step) * step_s;
        sound.push(&SoundState { time_s, rotors: rotors(time_s) }, &mut out).unwrap();
    }
    sound.finish(&mut out);
    out
}

/// One rotor standing in the air.
pub(crate) fn standing(speed_rev_s: f64, position_m: [f64; 3]) -> impl Fn(f64) -> Vec<RotorState> {
    move |_| vec![RotorState { speed_rad_s: TAU * speed_rev_s, position_m, axis: UP }]
}

/// Complex amplitude of the tone `Re(a e^(2πi turns(n)))`, by Hann's window over those samples.
pub(crate) fn amplitude(samples: &[f32], first: usize, count: usize, turns: impl Fn(usize) -> f64) -> Complex<f64> {
    let (mut re, mut im, mut weights) = (0.0, 0.0, 0.0);
    for (n, &value) in samples.iter().enumerate().skip(first).take(count) {
        let weight = 0.5 - 0.5 * (TAU * ((n - first) as f64 + 0.5) / count as f64).cos();
        let (sine, cosine) = (TAU * turns(n).fract()).sin_cos();
        re += weight * f64::from(value) * cosine;
        im -= weight * f64::from(value) * sine;
        weights += weight;
    }
    Complex::new(2.0 * re / weights, 2.0 * im / weights)
}

pub(crate) fn mean_square(samples: &[f32]) -> f64 {
    samples.iter().map(|&value| f64::from(value).powi(2)).sum::<f64>() / samples.len() as f64
}

pub(crate) fn distance(a: [f64; 3], b: [f64; 3]) -> f64 {
    (0..3).map(|axis| (a[axis] - b[axis]).powi(2)).sum::<f64>().sqrt()
}
