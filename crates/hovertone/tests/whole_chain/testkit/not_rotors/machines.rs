//! Machines that turn and are no multirotor.

use super::{Dice, add, falling, red_noise, series};
use hovertone_sim::prescribed::Line;

/// A slow shaft's wander, a few thousandths.
fn wander(dice: &mut Dice, hz: f64, share: f64) -> impl Fn(f64) -> f64 + use<> {
    let waves: Vec<(f64, f64)> =
        (0..4).map(|_| (dice.between(0.5, 6.0), dice.between(0.0, std::f64::consts::TAU))).collect();
    move |t| hz * (1.0 + share / 2.0 * waves.iter().map(|(rate, phase)| (rate * t + phase).sin()).sum::<f64>())
}

/// Partials weaker by up to this many dB, each by a random number.
fn uneven(dice: &mut Dice, partials: Vec<Line>, by_db_max: f64) -> Vec<Line> {
    partials.into_iter().map(|line| line.times(10f64.powf(dice.between(-by_db_max, 0.0) / 20.0))).collect()
}

/// A main rotor of 5 to 7 turns a second with two to four blades and a slapping series of lines, and a tail rotor.
pub(super) fn helicopter(dice: &mut Dice, length_s: f64) -> Vec<f64> {
    let main_hz = dice.between(5.0, 7.0) * dice.pick(&[2.0, 3.0, 4.0]);
    let main = wander(dice, main_hz, 0.003);
    let slope = dice.between(1.0, 4.0);
    let partials = uneven(dice, falling(40, slope), 6.0);
    let mut samples = series(length_s, &partials, main, |_| 1.0);
    // the tail is geared to the main rotor, at no whole ratio
    let tail_hz = main_hz * dice.between(4.1, 5.9);
    let tail = wander(dice, tail_hz, 0.003);
    let tail_share = dice.between(0.0, 0.5);
    add(&mut samples, &series(length_s, &falling(10, 4.0), tail, |_| 1.0), tail_share);
    let rumble = red_noise(dice, 300.0, length_s);
    add(&mut samples, &rumble, 1.5);
    samples
}

/// A four-stroke engine: firing rate and half orders, as strong as one another.
pub(super) fn engine(dice: &mut Dice, length_s: f64) -> Vec<f64> {
    let cycle_hz = dice.between(6.0, 14.0);
    let pitch = wander(dice, cycle_hz, 0.01);
    let partials = uneven(dice, falling(60, 3.0), 12.0);
    let mut samples = series(length_s, &partials, pitch, |_| 1.0);
    let rumble = red_noise(dice, 500.0, length_s);
    add(&mut samples, &rumble, 1.0);
    samples
}
