//! Wind at the microphone, noise with an echo, knocks and crackle.

use super::{Dice, add, add_at, red_noise, resonated, sample_count};

/// Red noise in gusts, with a whistle at an edge in some.
pub(super) fn wind(dice: &mut Dice, length_s: f64) -> Vec<f64> {
    let corner_hz = dice.between(20.0, 200.0);
    let mut samples = red_noise(dice, corner_hz, length_s);
    let whistle_source = dice.noise(1.0, samples.len());
    let (hz, width_hz) = (dice.between(200.0, 900.0), dice.between(15.0, 80.0));
    let whistle_share = dice.pick(&[0.0, 0.05, 0.2]);
    add(&mut samples, &resonated(&whistle_source, hz, width_hz), whistle_share);
    let gusts = red_noise(dice, 0.4, length_s);
    let gust_rms = (gusts.iter().map(|x| x * x).sum::<f64>() / gusts.len() as f64).sqrt();
    samples.iter().zip(&gusts).map(|(x, gust)| x * (1.0 + gust / gust_rms).abs()).collect()
}

/// Noise that comes again from a wall or the ground: its spectrum has crests at multiples of one frequency, as a rotor has lines.
pub(super) fn echo(dice: &mut Dice, length_s: f64) -> Vec<f64> {
    let corner_hz = dice.between(200.0, 4000.0);
    let mut samples = red_noise(dice, corner_hz, length_s);
    let heard = samples.clone();
    let share = dice.between(0.5, 0.9);
    add_at(&mut samples, dice.between(0.002, 0.012), &heard.iter().map(|x| share * x).collect::<Vec<f64>>());
    samples
}

/// Clicks and knocks, in some at a steady rate.
pub(super) fn impulses(dice: &mut Dice, length_s: f64) -> Vec<f64> {
    let mut samples = dice.noise(0.002, sample_count(length_s));
    let every_s = dice.between(0.02, 0.5);
    let is_steady = dice.pick(&[true, false]);
    let mut time_s = 0.0;
    while time_s < length_s {
        let kick: Vec<f64> =
            (0..sample_count(0.08)).map(|n| if n < 8 { 10.0 * dice.between(0.3, 1.0) } else { 0.0 }).collect();
        let knock = resonated(&kick, dice.between(150.0, 4000.0), dice.between(100.0, 900.0));
        add_at(&mut samples, time_s, &knock);
        time_s += if is_steady { every_s } else { every_s * dice.between(0.2, 1.8) };
    }
    samples
}
