//! The angles of the rotors along a prediction.

use crate::grey_box::SpeedPrediction;
use std::f64::consts::TAU;

/// Turns of the four rotors since the first point of a prediction.
pub(super) struct Turns<'a> {
    prediction: &'a SpeedPrediction,
    turns: Vec<[f64; 4]>,
    /// Which rotors are listened to.
    pub(super) sounding: [bool; 4],
}

impl<'a> Turns<'a> {
    pub(super) fn of(prediction: &'a SpeedPrediction) -> Self {
        let mut sum = [0.0; 4];
        let mut turns = Vec::with_capacity(prediction.speed_rad_s.len());
        turns.push(sum);
        for pair in prediction.speed_rad_s.windows(2) {
            for (rotor, sum) in sum.iter_mut().enumerate() {
                *sum += 0.5 * (pair[0][rotor] + pair[1][rotor]) * prediction.step_s / TAU;
            }
            turns.push(sum);
        }
        Self { prediction, turns, sounding: [true; 4] }
    }

    /// Turns at a time. The speed is straight between the points, and that of the nearest point outside.
    pub(super) fn at(&self, time_s: f64) -> [f64; 4] {
        let wanted = (time_s - self.prediction.start_s) / self.prediction.step_s;
        let place = wanted.clamp(0.0, (self.turns.len() - 1) as f64);
        let (before, share) = (place as usize, place.fract());
        let outside_s = (wanted - place) * self.prediction.step_s;
        let next = (before + 1).min(self.turns.len() - 1);
        let (from, to) = (&self.prediction.speed_rad_s[before], &self.prediction.speed_rad_s[next]);
        let since_s = share * self.prediction.step_s;
        std::array::from_fn(|rotor| {
            let mean = from[rotor] + 0.5 * share * (to[rotor] - from[rotor]);
            self.turns[before][rotor] + (mean * since_s + from[rotor] * outside_s) / TAU
        })
    }
}
