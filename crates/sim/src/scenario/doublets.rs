//! Flights of doublets, from which the low-level model can be identified.

use super::file::ScenarioFile;
use super::maneuver::Maneuver;
use super::sections::{GroundSection, MicrophoneSection, VehicleSection};
use hovertone_vehicle::Axis;

/// Hover before the first doublet, s.
const HOVER_S: f64 = 2.0;
/// Rest after each doublet, s.
const PAUSE_S: f64 = 0.6;
/// Lengths of the halves, s: the short one tells the response of the motors, the long one the gains on angles and rates.
const HALVES_S: [f64; 2] = [0.2, 0.5];

impl ScenarioFile {
    /// A hover, then doublets about all four axes, short and long, one way first and then the other way, and a hover for the rest of `duration_s`.
    /// Open ground, one microphone; table rows of the truth every 4 ms.
    pub fn doublets(preset: &str, seed: u64, duration_s: f64, amounts: DoubletAmounts) -> Self {
        let mut maneuvers = vec![Maneuver::Hover { duration_s: HOVER_S }];
        let (mut end_s, mut sign) = (HOVER_S, 1.0);
        'flight: loop {
            for half_s in HALVES_S {
                for (axis, amount) in [
                    (Axis::Roll, amounts.tilt),
                    (Axis::Pitch, amounts.tilt),
                    (Axis::YawRate, amounts.yaw_rate),
                    (Axis::Climb, amounts.climb),
                ] {
                    end_s += 2.0 * half_s + PAUSE_S;
                    if end_s > duration_s {
                        break 'flight;
                    }
                    let amount = sign * amount;
                    maneuvers.push(Maneuver::Doublet { axis, amount, half_s, repeat: 1, pause_s: PAUSE_S });
                }
            }
            sign = -sign;
        }
        Self {
            duration_s: Some(duration_s),
            seed,
            truth_rate_hz: 250.0,
            vehicle: VehicleSection { preset: preset.to_owned(), ..VehicleSection::default() },
            maneuvers,
            ground: Some(GroundSection::default()),
            microphones: vec![MicrophoneSection::at([-2.0, 0.3, 1.0])],
            ..Self::default()
        }
    }
}

/// Commands of the doublets, of ±1.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DoubletAmounts {
    /// Roll and pitch.
    pub tilt: f64,
    /// Yaw rate.
    pub yaw_rate: f64,
    /// Vertical rate.
    pub climb: f64,
}

impl Default for DoubletAmounts {
    fn default() -> Self {
        Self { tilt: 0.6, yaw_rate: 0.8, climb: 0.3 }
    }
}
