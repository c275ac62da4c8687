//! Whether the place of a flight has echoes, and which.

use super::along::widest_rad_s;
use super::echoed::echoed_value;
use super::heard_lines::HeardLines;
use super::search::BETTER_NATS;
use super::turns::Turns;
use super::window::{Window, likelihood_value};
use crate::grey_box::{SpeedObservation, SpeedPrediction};
use nalgebra::Vector4;
use std::f64::consts::LN_10;

/// What a place adds to the direct sound of the rotors.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Echoes {
    /// Power of the direct sound over that of the whole.
    pub direct_share: f64,
    /// Time in which the echoes fall by 60 dB.
    pub reverberation_s: f64,
}

/// What is tried, the first pair at first. *Physics*: from nearly no echoes to ten times as much echo as direct sound, in small and in large rooms.
const DIRECT_SHARES: [f64; 8] = [0.55, 0.95, 0.85, 0.7, 0.4, 0.3, 0.2, 0.1];
const REVERBERATIONS_S: [f64; 8] = [0.6, 0.14, 0.2, 0.3, 0.4, 0.9, 1.4, 2.0];
/// Windows that are compared: those in which the speeds change most. *Numeric.*
const WINDOWS: usize = 24;
/// Most samples of a line in a window: the time grows with the third power of them. *Numeric*: twelve orders of 95 rev/s.
const SAMPLES_MAX: f64 = 100.0;
/// Band about the mean of the predicted speeds, as a share: echoes of a climb are far from the speed now. *Physics.*
const ECHO_SHARE: f64 = 0.2;
/// Rounds over shares and decays. *Numeric.*
const ROUNDS: usize = 2;

impl Echoes {
    /// Time in which the power of the echoes falls to 1/e, which is their mean delay.
    pub fn decay_s(&self) -> f64 {
        self.reverberation_s / (6.0 * LN_10)
    }

    /// Mean delay of all that is heard, by power.
    pub(super) fn mean_delay_s(&self) -> f64 {
        (1.0 - self.direct_share) * self.decay_s()
    }
}

/// The echoes of the place, where the windows in which the speeds change most are clearly more likely with echoes; `None` in the open.
pub(super) fn echoes_of(
    heard: &HeardLines,
    prediction: &SpeedPrediction,
    windows: &[Window],
    observations: &[SpeedObservation],
) -> Option<Echoes> {
    let turns = Turns::of(prediction);
    let near = heard.followed(prediction, ECHO_SHARE);
    let moving = moving_windows(prediction, windows, observations);
    let length_s = windows.first().map_or(0.0, |window| window.length_s);
    let few = near.lines.iter().filter(|line| line.rate_hz * length_s <= SAMPLES_MAX);
    let order_max = few.map(|line| line.order).fold(0.0, f64::max);
    let open = moving.iter().map(|(window, offset)| likelihood_value(&near, order_max, &turns, *window, offset));
    let open: f64 = open.sum();
    let nats = |echoes: Echoes| {
        let of_window = |(window, offset): &(Window, Vector4<f64>)| {
            let lines = near.lines.iter().filter(|line| line.order <= order_max);
            lines.map(|line| echoed_value(line, &echoes, near.start_s, &turns, *window, offset)).sum::<f64>()
        };
        moving.iter().map(of_window).sum::<f64>() - open
    };
    let first = Echoes { direct_share: DIRECT_SHARES[0], reverberation_s: REVERBERATIONS_S[0] };
    let mut best = Likeliest { echoes: first, nats: nats(first) };
    for _ in 0..ROUNDS {
        for direct_share in DIRECT_SHARES {
            best.take_better(Echoes { direct_share, ..best.echoes }, nats);
        }
        for reverberation_s in REVERBERATIONS_S {
            best.take_better(Echoes { reverberation_s, ..best.echoes }, nats);
        }
    }
    (best.nats > BETTER_NATS).then_some(best.echoes)
}

/// The most likely echoes so far, and by how much more likely they are than none.
struct Likeliest {
    echoes: Echoes,
    nats: f64,
}

impl Likeliest {
    fn take_better(&mut self, echoes: Echoes, nats: impl Fn(Echoes) -> f64) {
        if echoes == self.echoes {
            return;
        }
        let nats = nats(echoes);
        if nats > self.nats {
            *self = Self { echoes, nats };
        }
    }
}

/// The windows in which the speeds change most, each with what was heard beside the prediction.
fn moving_windows(
    prediction: &SpeedPrediction,
    windows: &[Window],
    observations: &[SpeedObservation],
) -> Vec<(Window, Vector4<f64>)> {
    // half of a window before it is heard in it as echoes
    let range_rad_s = |(window, _): &(&Window, _)| {
        let span_s = window.span_s();
        widest_rad_s(prediction, span_s.start - window.length_s / 2.0..span_s.end)
    };
    let mut moving: Vec<(&Window, &SpeedObservation)> = windows.iter().zip(observations).collect();
    moving.sort_by(|a, b| range_rad_s(b).total_cmp(&range_rad_s(a)));
    moving.truncate(WINDOWS);
    let offset = |(window, observed): (&Window, &SpeedObservation)| {
        (*window, observed.speed_rad_s - observed.of_prediction(prediction))
    };
    moving.into_iter().map(offset).collect()
}

#[cfg(test)]
mod tests {
    use super::super::heard_lines::HeardLine;
    use super::super::window::phasor;
    use super::*;
    use nalgebra::{Complex, Matrix4};
    use std::f64::consts::TAU;

    const STEP_S: f64 = 2e-3;
    const RATE_HZ: f64 = 400.0;
    const LENGTH_S: f64 = 12.0;

    /// Four rotors that step between two speeds, each at its own times.
    fn stepping() -> SpeedPrediction {
        let points = (LENGTH_S / STEP_S) as usize + 1;
        let speeds = |point: usize| {
            let time_s = point as f64 * STEP_S;
            std::array::from_fn(|rotor| {
                let period_s = [0.9, 1.1, 1.3, 1.7][rotor];
                let is_up = (time_s / period_s).fract() < 0.5;
                400.0 + 2.0 * rotor as f64 + if is_up { 16.0 } else { 0.0 }
            })
        };
        SpeedPrediction { start_s: 0.0, step_s: STEP_S, speed_rad_s: (0..points).map(speeds).collect() }
    }

    /// The blade pass of the four, with noise; `echogram` has the delay and the amplitude of each arrival.
    fn heard(prediction: &SpeedPrediction, echogram: &[(f64, Complex<f64>)]) -> HeardLines {
        let (order, count) = (4.0, (LENGTH_S * RATE_HZ) as usize);
        let turns = Turns::of(prediction);
        let carrier = |n: usize| order * 407.0 / TAU * n as f64 / RATE_HZ;
        let sample = |n: usize| {
            let arrival = |(delay_s, amplitude): &(f64, Complex<f64>)| {
                let own = turns.at(n as f64 / RATE_HZ - delay_s);
                let lines = own.iter().enumerate().map(|(rotor, own)| phasor(order * own + 0.3 * rotor as f64));
                *amplitude * lines.sum::<Complex<f64>>()
            };
            let noise = 0.1 * phasor(0.317 * (n * n) as f64);
            let sum = echogram.iter().map(arrival).sum::<Complex<f64>>() * phasor(-carrier(n)) + noise;
            Complex::new(sum.re as f32, sum.im as f32)
        };
        let power: f64 = echogram.iter().map(|(_, amplitude)| amplitude.norm_sqr()).sum();
        let line = HeardLine {
            order,
            rate_hz: RATE_HZ,
            samples: (0..count).map(sample).collect(),
            carrier: (0..count).map(carrier).collect(),
            noise: 0.01,
            amplitude_variance: power,
        };
        HeardLines { start_s: 0.0, end_s: LENGTH_S, lines: vec![line] }
    }

    fn found(echogram: &[(f64, Complex<f64>)]) -> Option<Echoes> {
        let prediction = stepping();
        let heard = heard(&prediction, echogram);
        let windows: Vec<Window> = (2..110).map(|at| Window { time_s: 0.1 * f64::from(at), length_s: 0.2 }).collect();
        let observation = |window: &Window| {
            let mut observed = SpeedObservation {
                time_s: window.time_s,
                window_s: window.length_s,
                speed_rad_s: Vector4::zeros(),
                information: Matrix4::identity(),
                overlap_rad_s: Vector4::zeros(),
            };
            observed.speed_rad_s = observed.of_prediction(&prediction);
            observed
        };
        let observations: Vec<SpeedObservation> = windows.iter().map(observation).collect();
        echoes_of(&heard, &prediction, &windows, &observations)
    }

    /// Fifty arrivals of random phases after the direct sound.
    fn tail(direct_share: f64, decay_s: f64) -> Vec<(f64, Complex<f64>)> {
        let echo = |at: usize| {
            let delay_s = 0.004 * (at + 1) as f64;
            let power = (1.0 - direct_share) * 0.004 / decay_s * (-delay_s / decay_s).exp();
            (delay_s, power.sqrt() * phasor(0.7548 * (at * at) as f64))
        };
        let direct = (0.0, Complex::new(direct_share.sqrt(), 0.0));
        std::iter::once(direct).chain((0..50).map(echo)).collect()
    }

    #[test]
    fn an_open_place_has_no_echoes() {
        assert_eq!(found(&[(0.0, Complex::new(1.0, 0.0))]), None);
        // a ground, 2 ms later
        assert_eq!(found(&[(0.0, Complex::new(1.0, 0.0)), (0.002, Complex::new(0.3, 0.4))]), None);
    }

    #[test]
    fn the_echoes_of_a_room_are_found() {
        for (direct_share, decay_s) in [(0.7, 0.045), (0.3, 0.03), (0.5, 0.065)] {
            let echoes = found(&tail(direct_share, decay_s)).expect("echoes");
            let share = echoes.direct_share;
            assert!((share - direct_share).abs() <= 0.2, "{direct_share} {decay_s}: {echoes:?}");
            let ratio = echoes.decay_s() / decay_s;
            assert!((0.4..2.5).contains(&ratio), "{direct_share} {decay_s}: {echoes:?}");
        }
    }
}
