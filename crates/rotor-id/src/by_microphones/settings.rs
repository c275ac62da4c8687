//! Settings of telling rotors by several microphones.

use hovertone_vehicle::{ConfigError, check_range};
use serde::Serialize;

/// How levels and delays at several microphones are compared with where microphones and rotors stand.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct MicrophonesConfig {
    /// How well each coordinate of a microphone in the vehicle's frame is known: a vehicle that hovers over a spot is off it by a hand's
    /// breadth on the average, and its heading by 5° (a tenth of the distance). Microphones fixed to the vehicle are known to 0.01 m.
    pub position_std_m: f64,
    /// How well microphones are as sensitive as each other: those of one kind agree within ±3 dB.
    pub gain_std_db: f64,
    /// Air temperature, for the speed of sound: 10 °C off is 2 %, less than the positions.
    pub temperature_c: f64,
    /// What body, arms, rotor wash and the rotor's own pattern make of all its lines at a microphone together. Rotors on one frame differ
    /// by some decibels at one distance; where a microphone stands near a rotor's axis the pattern adds to this.
    pub level_std_db: f64,
    /// Scatter of single lines' levels about that, before it is measured: echoes as strong as the sound make 5.6 dB (Rayleigh).
    pub line_level_std_db: f64,
    /// Scatter of single lines' phases that is integrated over, in rad (as 1/√κ of von Mises): echoes off body and frame of a third of
    /// the sound; echoes as strong as the sound; nearly lost in them.
    pub phase_std_rad: [f64; 3],
    /// Share of lines whose phase says nothing, because something else sounds there.
    pub phase_outlier_share: f64,
    /// Lines are solved for in blocks of at most this length: resolves rotors half a turn per second apart from the second line on.
    pub block_s: f64,
    /// And at most this over their order: 3 resolution cells between rotors of 60 rev/s that differ by 0.2 %, while errors of a track
    /// of 0.03 % leave the phase alone, and so does a vehicle that drifts at 0.05 m/s.
    pub block_order_s: f64,
    /// No more than this is listened to, from where rotors are first followed: what noise there is has averaged out by then, and echoes,
    /// shadows and places do not. It bounds what is kept.
    pub listen_s_max: f64,
    /// Power over that of noise at which a line is heard in one block; in n blocks, by a √n less far above.
    pub heard_over_noise: f64,
    /// Probability that microphones and rotors stand where it is said, before anything is heard: who measures gets it wrong in one of five
    /// hundred set-ups. Two microphones cannot tell more of it than this; with four a wrong place shows.
    pub array_prior: f64,
    /// Power of the likelihood that is believed, as for logs: errors of echoes and shadows are not independent from line to line.
    pub evidence_share: f64,
    /// A rotor is labelled if the label has this probability.
    pub probability_min: f64,
}

impl Default for MicrophonesConfig {
    fn default() -> Self {
        Self {
            position_std_m: 0.1,
            gain_std_db: 3.0,
            temperature_c: 20.0,
            level_std_db: 3.0,
            line_level_std_db: 5.6,
            phase_std_rad: [0.3, 0.8, 1.6],
            phase_outlier_share: 0.1,
            block_s: 2.0,
            block_order_s: 24.0,
            listen_s_max: 120.0,
            heard_over_noise: 8.0,
            array_prior: 0.998,
            evidence_share: 0.5,
            probability_min: 0.99,
        }
    }
}

impl MicrophonesConfig {
    /// Refuses settings that mean nothing, by name, value and limit.
    pub fn check(&self) -> Result<(), ConfigError> {
        check_range("position_std_m", self.position_std_m, 0.001, 10.0)?;
        check_range("gain_std_db", self.gain_std_db, 0.1, 60.0)?;
        check_range("temperature_c", self.temperature_c, -60.0, 60.0)?;
        check_range("level_std_db", self.level_std_db, 0.1, 60.0)?;
        check_range("line_level_std_db", self.line_level_std_db, 0.1, 60.0)?;
        for phase_std_rad in self.phase_std_rad {
            check_range("phase_std_rad", phase_std_rad, 0.01, 10.0)?;
        }
        check_range("phase_outlier_share", self.phase_outlier_share, 0.001, 0.9)?;
        check_range("block_s", self.block_s, 0.1, 60.0)?;
        check_range("block_order_s", self.block_order_s, 1.0, 1e4)?;
        check_range("listen_s_max", self.listen_s_max, 1.0, 1e5)?;
        check_range("heard_over_noise", self.heard_over_noise, 1.0, 1e6)?;
        check_range("array_prior", self.array_prior, 0.5, 0.9999)?;
        check_range("evidence_share", self.evidence_share, 0.01, 1.0)?;
        check_range("probability_min", self.probability_min, 0.5, 1.0)
    }

    /// Speed of sound in dry air, m/s: 331.3 √(1 + t / 273.15).
    pub(crate) fn sound_m_s(&self) -> f64 {
        331.3 * (1.0 + self.temperature_c / 273.15).sqrt()
    }
}
