//! Settings of a hover's sound. Every default stands here or beside its own settings, with its reason.

use super::noise::NoiseSettings;
use super::profile::SpeedProfile;
use crate::sound::ToneSettings;
use hovertone_vehicle::{QuantityError, RotorSpeed, Vehicle};

/// One rotor: speed, loudness, wander.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RotorSound {
    /// Mean shaft speed in hover.
    pub mean_speed: RotorSpeed,
    /// Level of all its lines over the levels in [`ToneSettings`], dB.
    pub level_db: f64,
    /// Standard deviation of the speed's wander, as a share of the mean speed.
    pub wander_std_share: f64,
    /// Time constant τ of the wander's autocorrelation `e^(-t/τ)`.
    pub wander_time_constant_s: f64,
}

impl RotorSound {
    /// A rotor at 0 dB with the wander of the paper's tables: 1.2 % (44 to 48 rpm of 3610 to 3820), and 0.3 s (assumed; the
    /// paper gives no time constant).
    pub fn at(mean_speed: RotorSpeed) -> Self {
        Self { mean_speed, level_db: 0.0, wander_std_share: 0.012, wander_time_constant_s: 0.3 }
    }

    /// A rotor whose speed does not change.
    pub fn steady(mean_speed: RotorSpeed) -> Self {
        Self { wander_std_share: 0.0, ..Self::at(mean_speed) }
    }
}

/// Settings of a [`HoverSound`](super::HoverSound).
#[derive(Clone, Debug, PartialEq)]
pub struct HoverSettings {
    /// Samples per second.
    pub sample_rate_hz: u32,
    /// Length of the sound, rounded to a whole sample.
    pub duration_s: f64,
    /// The rotors.
    pub rotors: Vec<RotorSound>,
    /// The lines that each rotor has.
    pub tones: ToneSettings,
    /// Broadband noise of the rotors; silent while they stand.
    pub rotor_noise: Option<NoiseSettings>,
    /// Noise of the place, from the first to the last sample; its level is set as the level of the rotors' noise.
    pub ambient_noise: Option<NoiseSettings>,
    /// Take-off and landing.
    pub profile: SpeedProfile,
    /// Scale all speeds by one factor, so that the mean of Σω² over the hover is exactly `Σ mean_speed²`, as the balance of
    /// forces demands. Without it the mean of the random wander changes the weight of each trial by some 0.3 %. Costs a
    /// second run of the speeds, without sound.
    pub hold_hover_balance: bool,
    /// Largest possible sum of the lines, plus six standard deviations of noise; full scale is 1.
    pub peak: f64,
    /// Time between rows of the truth, rounded to a whole sample.
    pub truth_step_s: f64,
    /// All random numbers come from this seed.
    pub seed: u64,
}

impl Default for HoverSettings {
    /// Ten seconds (the paper's trial) at 48 kHz, without rotors. A peak of 0.5 leaves 6 dB of headroom.
    fn default() -> Self {
        Self {
            sample_rate_hz: 48_000,
            duration_s: 10.0,
            rotors: Vec::new(),
            tones: ToneSettings::default(),
            rotor_noise: Some(NoiseSettings::default()),
            ambient_noise: None,
            profile: SpeedProfile::default(),
            hold_hover_balance: false,
            peak: 0.5,
            truth_step_s: 0.01,
            seed: 1,
        }
    }
}

impl HoverSettings {
    /// All rotors of a vehicle at one mean speed, each with a wander of its own, and the lines of its gear and blades.
    pub fn for_vehicle(vehicle: &Vehicle, mean_speed: RotorSpeed) -> Self {
        Self {
            rotors: vec![RotorSound::at(mean_speed); vehicle.rotor_count.value as usize],
            tones: ToneSettings::for_vehicle(vehicle),
            ..Self::default()
        }
    }

    pub(super) fn check(&self) -> Result<(), QuantityError> {
        let refused = |name, value, must_be| Err(QuantityError { name, value, must_be });
        if !(8_000..=192_000).contains(&self.sample_rate_hz) {
            return refused("sample_rate_hz", f64::from(self.sample_rate_hz), "between 8000 and 192000");
        }
        if self.rotors.is_empty() {
            return refused("rotors", 0.0, "at least one");
        }
        if !(self.peak > 0.0 && self.peak <= 1.0) {
            return refused("peak", self.peak, "above 0, at most 1");
        }
        if !(self.truth_step_s.is_finite() && self.truth_step_s > 0.0) {
            return refused("truth_step_s", self.truth_step_s, "above 0");
        }
        if !(self.duration_s.is_finite() && self.duration_s * f64::from(self.sample_rate_hz) >= 0.5) {
            return refused("duration_s", self.duration_s, "at least one sample");
        }
        self.tones.check()?;
        for rotor in &self.rotors {
            let speed_rev_s = rotor.mean_speed.rev_s();
            if !(speed_rev_s > 0.0 && speed_rev_s < f64::from(self.sample_rate_hz) / 4.0) {
                return refused("mean_speed", speed_rev_s, "above 0 and below a quarter of the sample rate, in rev/s");
            }
            if !rotor.level_db.is_finite() {
                return refused("level_db", rotor.level_db, "a number");
            }
            // With more, the Gaussian wander could stop the rotor.
            if !(0.0..=0.1).contains(&rotor.wander_std_share) {
                return refused("wander_std_share", rotor.wander_std_share, "between 0 and 0.1");
            }
            if !(rotor.wander_time_constant_s.is_finite() && rotor.wander_time_constant_s > 0.0) {
                return refused("wander_time_constant_s", rotor.wander_time_constant_s, "above 0");
            }
        }
        Ok(())
    }
}
