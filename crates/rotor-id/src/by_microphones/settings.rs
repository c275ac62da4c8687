//! Settings of the labels from several microphones.

use hovertone_vehicle::{ConfigError, check_range};
use serde::Serialize;

/// Speed of sound in dry air of 0 °C, in m/s. *Physics.*
const SOUND_0_C_M_S: f64 = 331.3;
/// 0 °C in K, by definition. *Physics.*
const ZERO_C_K: f64 = 273.15;

/// How levels and delays at several microphones are compared with the places of microphones and rotors.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct MicrophonesConfig {
    /// Standard deviation of each coordinate of a microphone in the vehicle's frame, in m. A vehicle that hovers over a spot is 0.1 m off it
    /// on average, and its heading is off by 5° (a tenth of the distance). Microphones fixed to the vehicle have 0.01 m.
    pub position_std_m: f64,
    /// Standard deviation of the microphones' gains, in dB: microphones of one kind agree within ±3 dB.
    pub gain_std_db: f64,
    /// Air temperature, for the speed of sound: an error of 10 °C is 2 %, less than that of the positions.
    pub temperature_c: f64,
    /// Standard deviation of what body, arms, rotor wash and the rotor's own directivity change in the levels of all its lines at a
    /// microphone, in dB. Rotors on one frame differ by some decibels at one distance. Near a rotor's axis the directivity adds to this.
    pub level_std_db: f64,
    /// Prior standard deviation of the levels of single lines about their mean, in dB. If echoes dominate, the amplitude has a
    /// Rayleigh distribution, whose level has a standard deviation of 10 / ln 10 · π / √6 = 5.6 dB.
    pub line_level_std_db: f64,
    /// Scatter of the phases of single lines over which the likelihood is averaged, in rad (1/√κ of a von Mises distribution): echoes of a
    /// third of the sound from body and frame; echoes as strong as the sound; lines nearly lost in echoes.
    pub phase_std_rad: [f64; 3],
    /// Share of lines whose phase is uniform, because another source sounds at their frequency.
    pub phase_outlier_share: f64,
    /// Longest block in which the amplitudes are solved, in s: separates rotors half a turn per second apart from the second line on.
    pub block_s: f64,
    /// Longest block times the order of the line, in s. At 24 s, rotors of 60 rev/s that differ by 0.2 % are 3 resolution cells apart, while
    /// track errors of 0.03 % and a vehicle that drifts at 0.05 m/s keep the phase.
    pub block_order_s: f64,
    /// Longest stretch that is analysed, in s, from the first point of a track. By then the noise has averaged out, while echoes, shadows
    /// and errors of the places do not. It limits the memory.
    pub listen_s_max: f64,
    /// A line is audible if its mean power over n blocks exceeds 1 + this / √n times the power of the noise.
    pub heard_over_noise: f64,
    /// Prior probability that microphones and rotors are at the given places: one of five hundred set-ups is measured wrongly. Two
    /// microphones can hardly change this probability; with four a wrong place shows.
    pub array_prior: f64,
    /// Exponent of the likelihood, as for logs: errors from echoes and shadows are not independent from line to line.
    pub evidence_share: f64,
    /// Smallest probability of a label that is given.
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
    /// Checks that each setting is in its range.
    ///
    /// # Errors
    /// The first setting that is not: its name, value and limits.
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

    /// Speed of sound in dry air, an ideal gas: `331.3 √(1 + t / 273.15)`.
    pub(super) fn sound_m_s(&self) -> f64 {
        SOUND_0_C_M_S * (1.0 + self.temperature_c / ZERO_C_K).sqrt()
    }
}
