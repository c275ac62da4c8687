//! What coils and transistors sound like: mains, motors that beep, switching.

use super::{Dice, add, add_at, falling, partial, sample_count, series};
use hovertone_sim::prescribed::Line;

/// A mains frequency with the drift that a grid shows within a minute.
fn grid(dice: &mut Dice) -> impl Fn(f64) -> f64 + use<> {
    let hz = dice.pick(&[50.0, 60.0]) + dice.between(-0.03, 0.03);
    let (drift_hz, period_s) = (dice.between(0.0, 0.02), dice.between(10.0, 40.0));
    move |t| hz + drift_hz * (t / period_s * std::f64::consts::TAU).sin()
}

/// A ground loop: the mains frequency and many harmonics, some odd ones strong.
pub(super) fn mains_hum(dice: &mut Dice, length_s: f64) -> Vec<f64> {
    let slope = dice.between(2.0, 9.0);
    let odd_only = dice.between(0.0, 1.0) < 0.4;
    let partials: Vec<Line> = falling(24, slope)
        .into_iter()
        .map(|line| line.times(10f64.powf(dice.between(-10.0, 0.0) / 20.0)))
        .map(|line| if odd_only && line.order % 2.0 == 0.0 { line.times(0.1) } else { line })
        .collect();
    let mut samples = series(length_s, &partials, grid(dice), |_| 1.0);
    let hiss = dice.noise(0.003, samples.len());
    add(&mut samples, &hiss, 1.0);
    samples
}

pub(super) fn mains_hum_in_noise(dice: &mut Dice, length_s: f64) -> Vec<f64> {
    let mut samples = mains_hum(dice, length_s);
    add_hiss(dice, &mut samples, 1.0);
    samples
}

/// White noise, 40 to 0 dB below a standard deviation.
fn add_hiss(dice: &mut Dice, samples: &mut [f64], std_max: f64) {
    let std = std_max * 10f64.powf(dice.between(-40.0, 0.0) / 20.0);
    let hiss = dice.noise(std, samples.len());
    add(samples, &hiss, 1.0);
}

/// A core hums at twice the mains frequency and its multiples.
pub(super) fn transformer(dice: &mut Dice, length_s: f64) -> Vec<f64> {
    let mains_hz = grid(dice);
    let partials: Vec<Line> = falling(8, 4.0)
        .into_iter()
        .map(|line| partial(2.0 * line.order, line.level * 10f64.powf(dice.between(-9.0, 0.0) / 20.0)))
        .collect();
    let mut samples = series(length_s, &partials, mains_hz, |_| 1.0);
    add_hiss(dice, &mut samples, 0.3);
    samples
}

/// An ESC that starts: short notes of a square-like wave, and a slow repeat of the last while no throttle comes.
pub(super) fn beeps(dice: &mut Dice, length_s: f64) -> Vec<f64> {
    let mut samples = dice.noise(0.003, sample_count(length_s));
    let pitches = [1044.0, 1175.0, 1319.0, 1568.0, 2093.0, 523.3, 784.0];
    let tune = dice.between(0.97, 1.03);
    let base = dice.pick(&pitches) * tune;
    let mut time_s = dice.between(0.1, 1.0);
    while time_s < length_s {
        let hz = if dice.between(0.0, 1.0) < 0.5 { base } else { dice.pick(&pitches) * tune };
        let note_s = dice.pick(&[0.08, 0.15, 0.2, 0.4, 0.7]);
        let ends = move |t: f64| (t / 0.005).min((note_s - t) / 0.005).clamp(0.0, 1.0);
        add_at(&mut samples, time_s, &series(note_s, &falling(6, 8.0), |_| hz, ends));
        time_s += note_s + dice.pick(&[0.05, 0.1, 0.3, 0.6, 1.0, 1.7]);
    }
    samples
}

/// Switching of an ESC that holds a motor still: the PWM frequency and its multiples, with sidebands of a slow modulation.
pub(super) fn pwm_whine(dice: &mut Dice, length_s: f64) -> Vec<f64> {
    let hz = dice.pick(&[8000.0, 16000.0, 4000.0, 19200.0]) * dice.between(0.995, 1.005);
    let mut samples = series(length_s, &falling(5, 6.0), |_| hz, |t| 1.0 + 0.2 * (40.0 * t).sin());
    add_hiss(dice, &mut samples, 0.3);
    samples
}
