//! Speech: a gliding voice through formants, in syllables and pauses.

use super::{Dice, add, add_at, falling, resonated, sample_count, series};

const VOWELS_HZ: [[f64; 3]; 6] = [
    [730.0, 1090.0, 2440.0],
    [270.0, 2290.0, 3010.0],
    [300.0, 870.0, 2240.0],
    [530.0, 1840.0, 2480.0],
    [570.0, 840.0, 2410.0],
    [440.0, 1020.0, 2240.0],
];

pub(super) fn speech(dice: &mut Dice, length_s: f64) -> Vec<f64> {
    let mut samples = dice.noise(0.002, sample_count(length_s));
    let voice_hz = dice.between(85.0, 260.0);
    let mut time_s = dice.between(0.0, 0.4);
    let mut phrase_left = 8;
    while time_s < length_s {
        // a consonant of noise, then a vowel that glides
        let hiss_s = dice.between(0.02, 0.09);
        let hiss = dice.noise(0.3, sample_count(hiss_s));
        add_at(&mut samples, time_s, &resonated(&hiss, dice.between(2500.0, 6000.0), 2000.0));
        time_s += hiss_s;
        let vowel_s = dice.between(0.09, 0.35);
        let (from, to) = (voice_hz * dice.between(0.8, 1.3), voice_hz * dice.between(0.75, 1.25));
        let glide = move |t: f64| from + (to - from) * t / vowel_s + 0.6 * (31.0 * t).sin();
        let swell = move |t: f64| (std::f64::consts::PI * t / vowel_s).sin().max(0.0).sqrt();
        let source = series(vowel_s, &falling(40, 6.0), glide, swell);
        let formants = dice.pick(&VOWELS_HZ);
        for (index, hz) in formants.into_iter().enumerate() {
            let heard = resonated(&source, hz, 60.0 + 40.0 * index as f64);
            let first = sample_count(time_s).min(samples.len());
            add(&mut samples[first..], &heard, 1.0 / (1.0 + index as f64));
        }
        time_s += vowel_s + dice.between(0.0, 0.06);
        phrase_left -= 1;
        if phrase_left == 0 {
            time_s += dice.between(0.3, 1.2);
            phrase_left = 4 + (dice.between(0.0, 9.0) as i32);
        }
    }
    samples
}
