//! Music: notes of the tempered scale.

use super::{Dice, add, add_at, falling, partial, resonated, sample_count, series};

fn note_hz(half_tones_from_a: i32) -> f64 {
    440.0 * 2f64.powf(f64::from(half_tones_from_a) / 12.0)
}

const MAJOR: [i32; 7] = [0, 2, 4, 5, 7, 9, 11];

/// One voice, notes of 0.15 to 1.2 s, some with vibrato.
pub(super) fn melody(dice: &mut Dice, length_s: f64) -> Vec<f64> {
    let mut samples = dice.noise(0.003, sample_count(length_s));
    let key = dice.pick(&[-21, -17, -12, -9, -5, 0]);
    let partials = falling(dice.pick(&[3, 6, 12]), dice.between(4.0, 9.0));
    let vibrato_share = dice.pick(&[0.0, 0.0, 0.006]);
    let mut time_s = 0.0;
    while time_s < length_s {
        let hz = note_hz(key + dice.pick(&MAJOR) + 12 * dice.pick(&[0, 0, 1]));
        let note_s = dice.pick(&[0.15, 0.25, 0.3, 0.5, 0.6, 1.2]);
        let pitch = move |t: f64| hz * (1.0 + vibrato_share * (35.0 * t).sin());
        let swell = move |t: f64| (t / 0.02).min(1.0) * (-t / 0.6).exp() * ((note_s - t) / 0.02).clamp(0.0, 1.0);
        add_at(&mut samples, time_s, &series(note_s, &partials, pitch, swell));
        time_s += note_s;
    }
    samples
}

/// Chords of three or four notes, each held for 0.5 to 4 s, with a bass.
pub(super) fn chords(dice: &mut Dice, length_s: f64) -> Vec<f64> {
    let mut samples = dice.noise(0.003, sample_count(length_s));
    let partials = falling(dice.pick(&[4, 8, 12]), dice.between(4.0, 9.0));
    let chord_s = dice.pick(&[0.5, 1.0, 2.0, 4.0]);
    let key = dice.pick(&[-21, -17, -14, -12, -9]);
    let mut time_s = 0.0;
    while time_s < length_s {
        let root = key + dice.pick(&[0, 5, 7, 9]);
        let third = dice.pick(&[3, 4]);
        for (note, level) in [(root - 12, 0.8), (root, 1.0), (root + third, 0.8), (root + 7, 0.8), (root + 12, 0.5)] {
            let hz = note_hz(note) * (1.0 + 0.0005 * dice.normal());
            let swell = move |t: f64| level * (t / 0.03).min((chord_s - t) / 0.03).clamp(0.0, 1.0);
            add_at(&mut samples, time_s, &series(chord_s, &partials, |_| hz, swell));
        }
        time_s += chord_s;
    }
    samples
}

/// Drums at a steady beat.
pub(super) fn percussion(dice: &mut Dice, length_s: f64) -> Vec<f64> {
    let mut samples = dice.noise(0.002, sample_count(length_s));
    let beat_s = dice.between(0.12, 0.3);
    let mut time_s = 0.0;
    let mut beat = 0;
    while time_s < length_s {
        let drum = if beat % 4 == 0 {
            series(0.25, &[partial(1.0, 1.0)], |t| 55.0 + 60.0 * (-t / 0.03).exp(), |t| (-t / 0.07).exp())
        } else {
            let hiss = dice.noise(1.0, sample_count(0.12));
            let mut ring = resonated(&hiss, dice.pick(&[190.0, 3000.0, 8000.0]), 900.0);
            ring.iter_mut().enumerate().for_each(|(n, x)| *x *= (-(n as f64) / 900.0).exp());
            ring
        };
        add_at(&mut samples, time_s, &drum);
        time_s += beat_s;
        beat += 1;
    }
    samples
}

/// A voice that holds notes of 0.6 to 2.5 s, with vibrato.
pub(super) fn singing(dice: &mut Dice, length_s: f64) -> Vec<f64> {
    let mut samples = dice.noise(0.003, sample_count(length_s));
    let key = dice.pick(&[-24, -17, -12, -7]);
    let mut time_s = dice.between(0.0, 0.3);
    while time_s < length_s {
        let hz = note_hz(key + dice.pick(&MAJOR));
        let note_s = dice.between(0.6, 2.5);
        let (depth, rate) = (dice.between(0.004, 0.02), dice.between(28.0, 40.0));
        let pitch = move |t: f64| hz * (1.0 - 0.05 * (-t / 0.06).exp() + depth * (rate * t).sin());
        let swell = move |t: f64| (t / 0.08).min((note_s - t) / 0.1).clamp(0.0, 1.0);
        let source = series(note_s, &falling(30, 6.0), pitch, swell);
        let first = sample_count(time_s).min(samples.len());
        for (formant_hz, level) in [(600.0, 1.0), (1000.0, 0.7), (2700.0, 0.4)] {
            add(&mut samples[first..], &resonated(&source, formant_hz, 90.0), level);
        }
        time_s += note_s + dice.pick(&[0.02, 0.05, 0.4]);
    }
    samples
}
