//! Which rotor is which, on tracks and logs made here. `hovertone-bench labels` does it with simulated flights.

use hovertone::rotors::{
    FlightLog, LabelSource, LabelsConfig, LogError, LogSignals, MotorSignal, NotTold, RotorLabels, labels_from_log,
};
use hovertone::speed::TrackPoint;
use hovertone_vehicle::{Layout, RotorPlace};
use rand::SeedableRng;
use rand_distr::{Distribution, StandardNormal};
use rand_pcg::Pcg64;
use std::f64::consts::TAU;

const STEP_S: f64 = 0.005;
const LENGTH_S: f64 = 10.0;
const MEAN_RAD_S: f64 = 380.0;
/// Independent wander of 0.2 % that lasts 0.4 s, track errors of 0.03 %, a gyro of 0.02 rad/s, and what 1 rad²/s² more does to the AR.Drone.
const WANDER_SHARE: f64 = 0.002;
const WANDER_S: f64 = 0.4;
const TRACK_SHARE: f64 = 0.0003;
const GYRO_RAD_S: f64 = 0.02;
const GAIN_1_S2: f64 = 4e-4;
const OFFSET_S: f64 = 12.34;

struct Flight {
    /// `speeds[rotor][step]`
    speeds: Vec<Vec<f64>>,
    random: Pcg64,
}

impl Flight {
    fn new(rotors: usize, seed: u64) -> Self {
        let mut random = Pcg64::seed_from_u64(seed);
        let keep = (-STEP_S / WANDER_S).exp();
        let wander = |random: &mut Pcg64| -> Vec<f64> {
            let mut state: f64 = StandardNormal.sample(random);
            (0..(LENGTH_S / STEP_S) as usize)
                .map(|_| {
                    let kick: f64 = StandardNormal.sample(random);
                    state = keep * state + (1.0 - keep * keep).sqrt() * kick;
                    MEAN_RAD_S * (1.0 + WANDER_SHARE * state)
                })
                .collect()
        };
        let speeds = (0..rotors).map(|_| wander(&mut random)).collect();
        Self { speeds, random }
    }

    fn noise(&mut self, std: f64) -> f64 {
        let normal: f64 = StandardNormal.sample(&mut self.random);
        std * normal
    }

    /// The tracks of some rotors, without what lies in a gap.
    fn tracks(&mut self, rotors: &[usize], gap_s: (f64, f64)) -> Vec<Vec<TrackPoint>> {
        let of = |flight: &mut Self, rotor: usize| {
            (0..(LENGTH_S / 0.04) as usize)
                .map(|index| {
                    let error = flight.noise(TRACK_SHARE);
                    let speed_rev_s = flight.speeds[rotor][8 * index + 4] / TAU * (1.0 + error);
                    let time_s = 0.04 * index as f64 + 0.02;
                    TrackPoint { time_s, tone_hz: speed_rev_s, speed_rev_s, std_uncertainty_rev_s: 0.02, level_db: 0.0 }
                })
                .filter(|point| !(gap_s.0..gap_s.1).contains(&point.time_s))
                .collect()
        };
        rotors.iter().map(|&rotor| of(self, rotor)).collect()
    }

    fn rates(&mut self, places: &[RotorPlace]) -> FlightLog {
        let levers = |place: &RotorPlace| [place.y_m, -place.x_m, -0.2 * place.spin];
        let (mut rates, mut rows) = ([0.0; 3], [Vec::new(), Vec::new(), Vec::new()]);
        for step in 0..self.speeds[0].len() {
            for (place, speeds) in places.iter().zip(self.speeds.clone()) {
                let excess = speeds[step].powi(2) - MEAN_RAD_S.powi(2);
                for (rate, lever) in rates.iter_mut().zip(levers(place)) {
                    *rate += STEP_S * GAIN_1_S2 * lever * excess;
                }
            }
            if step % 10 == 0 {
                for (row, rate) in rows.iter_mut().zip(rates) {
                    row.push(rate + self.noise(GYRO_RAD_S));
                }
            }
        }
        let time_s = (0..rows[0].len()).map(|row| 10.0 * STEP_S * row as f64 - OFFSET_S).collect();
        FlightLog::new(time_s, LogSignals::BodyRates { places: places.to_vec(), rates_rad_s: rows }).unwrap()
    }

    fn commands(&mut self) -> FlightLog {
        let names = (1..=self.speeds.len()).map(|number| format!("motor {number}")).collect();
        let rows: Vec<usize> = (0..self.speeds[0].len()).step_by(10).collect();
        // each motor has a level and a gain of its own
        let of = |flight: &Self, rotor: usize| -> Vec<f64> {
            let (level, gain) = (1400.0 + 30.0 * rotor as f64, 8.0 + rotor as f64);
            rows.iter().map(|&row| level + gain * (flight.speeds[rotor][row] - MEAN_RAD_S)).collect()
        };
        let values: Vec<Vec<f64>> = (0..self.speeds.len()).map(|rotor| of(self, rotor)).collect();
        let time_s = rows.iter().map(|&row| STEP_S * row as f64 - OFFSET_S).collect();
        FlightLog::new(time_s, LogSignals::Motors { signal: MotorSignal::Command, names, values }).unwrap()
    }
}

fn labelled(tracks: &[Vec<TrackPoint>], rotors: usize, log: &FlightLog) -> RotorLabels {
    let tracks: Vec<&[TrackPoint]> = tracks.iter().map(Vec::as_slice).collect();
    labels_from_log(&tracks, rotors, log, &LabelsConfig::default())
}

fn numbers(labels: &RotorLabels) -> Vec<Option<usize>> {
    labels.rotors.iter().map(|label| label.as_ref().map(|label| label.number - 1)).collect()
}

const NO_GAP: (f64, f64) = (-1.0, -1.0);

#[test]
fn three_tracks_of_four_rotors_are_told_by_commands_across_a_gap() {
    let mut flight = Flight::new(4, 1);
    let (tracks, log) = (flight.tracks(&[2, 0, 3], (4.0, 5.5)), flight.commands());
    let labels = labelled(&tracks, 4, &log);
    assert_eq!(numbers(&labels), [Some(2), Some(0), Some(3)], "{labels:?}");
    assert_eq!((labels.source, &labels.not_told), (LabelSource::MotorCommands, &None));
    assert!((labels.offset_s.unwrap() - OFFSET_S).abs() < 3.0 * labels.offset_std_s.unwrap(), "{labels:?}");
    // what the rotors do to the body needs all of them
    let log = flight.rates(&Layout::X.places(0.18));
    assert_eq!(labelled(&tracks, 4, &log).not_told, Some(NotTold::TooFewTracks { tracks: 3, needed: 4 }));
}

#[test]
fn six_rotors_are_told_by_rates_and_propellers_may_turn_the_other_way() {
    let places: Vec<RotorPlace> = ["a", "b", "c", "d", "e", "f"]
        .into_iter()
        .zip(0..)
        .map(|(name, index)| {
            let (y_m, x_m) = (TAU * f64::from(index) / 6.0).sin_cos();
            RotorPlace { name, x_m: 0.2 * x_m, y_m: 0.2 * y_m, spin: if index % 2 == 0 { 1.0 } else { -1.0 } }
        })
        .collect();
    let mut flight = Flight::new(6, 2);
    let order = [5, 1, 0, 4, 2, 3];
    let tracks = flight.tracks(&order, NO_GAP);
    let turned: Vec<RotorPlace> = places.iter().map(|place| RotorPlace { spin: -place.spin, ..*place }).collect();
    let LogSignals::BodyRates { rates_rad_s, .. } = flight.rates(&turned).signals().clone() else { unreachable!() };
    let time_s = (0..rates_rad_s[0].len()).map(|row| 10.0 * STEP_S * row as f64 - OFFSET_S).collect();
    let log = FlightLog::new(time_s, LogSignals::BodyRates { places, rates_rad_s }).unwrap();
    let labels = labelled(&tracks, 6, &log);
    assert_eq!(numbers(&labels), order.map(Some), "{labels:?}");
    assert!((labels.offset_s.unwrap() - OFFSET_S).abs() < 3.0 * labels.offset_std_s.unwrap() + STEP_S, "{labels:?}");
}

/// Rotors that do the same on one side cannot be told from each other; that they are of that side can, but that is no label.
#[test]
fn rotors_that_move_alike_are_not_told() {
    let mut flight = Flight::new(4, 3);
    flight.speeds[1] = flight.speeds[0].clone();
    flight.speeds[3] = flight.speeds[2].clone();
    let (tracks, log) = (flight.tracks(&[0, 2, 1, 3], NO_GAP), flight.rates(&Layout::X.places(0.18)));
    let labels = labelled(&tracks, 4, &log);
    assert_eq!(numbers(&labels), [None; 4], "{labels:?}");
    assert_eq!(labels.not_told, Some(NotTold::SeveralFitRates { tracks: 4 }));
}

#[test]
fn what_cannot_be_compared_is_said() {
    let mut flight = Flight::new(4, 4);
    let (tracks, log) = (flight.tracks(&[0, 1, 2, 3], NO_GAP), flight.commands());
    assert_eq!(labelled(&tracks, 6, &log).not_told, Some(NotTold::OtherCount { rotors: 6, of_log: 4 }));
    assert_eq!(labelled(&[], 4, &log).not_told, Some(NotTold::TooFewTracks { tracks: 0, needed: 2 }));
    let tracks: Vec<&[TrackPoint]> = tracks.iter().map(Vec::as_slice).collect();
    let limited = |low_s: f64, high_s: f64| {
        let config = LabelsConfig { offset_s_low: Some(low_s), offset_s_high: Some(high_s), ..LabelsConfig::default() };
        labels_from_log(&tracks, 4, &log, &config)
    };
    assert_eq!(limited(100.0, 101.0).not_told, Some(NotTold::NoOverlap));
    // the limits end where it begins to fit
    let at_limit = limited(OFFSET_S - 2.0, OFFSET_S).not_told;
    assert!(matches!(at_limit, Some(NotTold::OffsetAtLimit { .. })), "{at_limit:?}");
    assert!(matches!(limited(-1e8, 1e8).not_told, Some(NotTold::TooManyOffsets { .. })));
    assert_eq!(numbers(&limited(OFFSET_S - 0.5, OFFSET_S + 0.5)), [0, 1, 2, 3].map(Some));
    let names = || vec!["a".to_owned()];
    let signals = |names, values| LogSignals::Motors { signal: MotorSignal::Speed, names, values };
    let made = |time_s: &[f64], signals| FlightLog::new(time_s.to_vec(), signals).unwrap_err();
    assert_eq!(made(&[0.0], signals(names(), vec![])), LogError::UnequalNames { names: 1, series: 0 });
    assert_eq!(made(&[0.0], signals(names(), vec![vec![]])), LogError::UnequalLengths { length: 0, times: 1 });
    assert_eq!(made(&[0.0, 0.0], signals(names(), vec![vec![1.0; 2]])), LogError::NotInOrder { row: 1, time_s: 0.0 });
    assert_eq!(made(&[0.0], signals(names(), vec![vec![f64::NAN]])), LogError::NotFinite { row: 0 });
}
