//! Settings of the sound of a flight. Every default stands here or beside its own settings, with its reason.

use super::babble::BabbleSettings;
use super::directivity::Directivity;
use super::microphone::MicrophoneSettings;
use super::room::{Room, Surroundings};
use super::tone_settings::ToneSettings;
use hovertone_vehicle::{QuantityError, RotorSpeed, Vehicle};

/// The allowed values of a number.
#[derive(Clone, Copy)]
pub(crate) enum Bound {
    Finite,
    Positive,
    ZeroOrMore,
    Within(f64, f64, &'static str),
}

/// Refuses a number out of bounds, naming it.
pub(crate) fn checked(name: &'static str, value: f64, bound: Bound) -> Result<(), QuantityError> {
    let (kept, must_be) = match bound {
        Bound::Finite => (true, "a number"),
        Bound::Positive => (value > 0.0, "above 0"),
        Bound::ZeroOrMore => (value >= 0.0, "0 or more"),
        Bound::Within(low, high, words) => ((low..=high).contains(&value), words),
    };
    if kept && value.is_finite() { Ok(()) } else { Err(QuantityError { name, value, must_be }) }
}

/// Tones of an electric motor: `harmonic_levels[h - 1]` at `h` times the order.
#[derive(Clone, Debug, PartialEq)]
pub struct MotorTones {
    /// Lines per turn of the rotor's shaft; need not be whole. A brushless motor with `p` pole pairs behind a gear of
    /// ratio `r` has its electrical frequency at order `p r` and its commutation at `6 p r`.
    pub order: f64,
    /// Levels, in the unit of [`ToneSettings`].
    pub harmonic_levels: Vec<f64>,
}

/// The broadband noise of one rotor.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BroadbandSettings {
    /// Level of one rotor at 1 m in its loudest direction, over the whole band, at the reference speed.
    pub level_db_spl: f64,
    /// Below this frequency the density is flat.
    pub flat_below_hz: f64,
    /// Slope of the density above, between -6 and 0.
    pub slope_db_per_octave: f64,
    /// Exponent of the tip speed in the power.
    pub speed_exponent: f64,
    /// Depth m of `1 + m cos(blade pass)` on the noise's amplitude; its mean power stays.
    pub modulation_depth: f64,
}

impl BroadbandSettings {
    /// The density at a frequency over that of low frequencies, dB.
    pub(crate) fn density_db(&self, hz: f64) -> f64 {
        self.slope_db_per_octave * (hz / self.flat_below_hz).max(1.0).log2()
    }
}

impl Default for BroadbandSettings {
    /// - 60 dB: with four rotors 66 dB at 1 m, 3 dB below the lines (assumed; real rotors lie on both sides).
    /// - Flat to 1 kHz, then -5 dB per octave: from the octave floors of a recording of a hovering DJI M300
    ///   (106, 111, 108, 106, 99, 86 dB re arbitrary from 250 Hz to 8 kHz).
    /// - Fifth power: edge noise (Ffowcs Williams and Hall 1970); sixth is a compact dipole (Curle 1955).
    /// - Depth 0.3: blade pass modulates the broadband noise of small rotors (Baars, Bullard, Mohamed, TU Delft); the number
    ///   is assumed.
    fn default() -> Self {
        Self {
            level_db_spl: 60.0,
            flat_below_hz: 1000.0,
            slope_db_per_octave: -5.0,
            speed_exponent: 5.0,
            modulation_depth: 0.3,
        }
    }
}

/// The sound of each rotor. All rotors have the same set of lines; phases, levels and unsteadiness differ.
#[derive(Clone, Debug, PartialEq)]
pub struct SourceSettings {
    /// Shaft speed at which the levels are given.
    pub reference_speed: RotorSpeed,
    /// The lines of shaft, blades and gear, in units of `tone_level_db_spl`.
    pub tones: ToneSettings,
    /// Level of a line of level 1 of one rotor, at 1 m in its loudest direction, at the reference speed.
    pub tone_level_db_spl: f64,
    /// Teeth of the pinion, for sidebands of the mesh at ± the speed of the motor's shaft.
    pub pinion_teeth: Option<u32>,
    /// Level of the pinion's sidebands, as a share of their harmonic.
    pub pinion_sideband_level: f64,
    /// Electrical tones of the motor.
    pub motor: Option<MotorTones>,
    /// Broadband noise.
    pub broadband: Option<BroadbandSettings>,
    /// Exponent of the speed in the power of the blade-pass lines.
    pub blade_speed_exponent: f64,
    /// Exponent of the speed in the power of shaft, gear and motor lines.
    pub mechanical_speed_exponent: f64,
    /// Standard deviation of the slow change of each line, in amplitude and, in radians, in phase: a share of 1.
    pub unsteadiness: f64,
    /// Time constant of that change (a critically damped second-order process).
    pub unsteadiness_time_constant_s: f64,
    /// Directivity of the blade-pass lines.
    pub blade_directivity: Directivity,
    /// Directivity of shaft, gear and motor lines.
    pub mechanical_directivity: Directivity,
    /// Directivity of the broadband noise.
    pub broadband_directivity: Directivity,
}

impl SourceSettings {
    /// The lines of a vehicle's gear and blades, at levels for this speed (its hover).
    ///
    /// No published level of an AR.Drone was found. Tones of 53 dB make the lines of four rotors 69 dB at 1 m, and 71 dB with
    /// the noise. The EU's limit for a class C1 drone (below 900 g) is about 74 dB at 1 m: a sound power of 85 dB(A) minus
    /// 11 dB (Regulation 2019/945). Assumed: the relative levels; the fifth power of the speed for the blades (as for the
    /// noise); the fourth power for gear and motor (amplitude proportional to load); an unsteadiness of 10 % and 1 s.
    pub fn for_vehicle(vehicle: &Vehicle, hover_speed: RotorSpeed) -> Self {
        let gear = vehicle.gear.map(|gear| gear.value);
        Self {
            reference_speed: hover_speed,
            tones: ToneSettings::for_vehicle(vehicle),
            tone_level_db_spl: 53.0,
            pinion_teeth: gear.map(|gear| gear.pinion),
            pinion_sideband_level: 0.1,
            // Commutation with one pole pair: the AR.Drone's number of poles was not found.
            motor: gear.map(|gear| MotorTones { order: 6.0 * gear.ratio(), harmonic_levels: vec![0.2, 0.1] }),
            broadband: Some(BroadbandSettings::default()),
            blade_speed_exponent: 5.0,
            mechanical_speed_exponent: 4.0,
            unsteadiness: 0.1,
            unsteadiness_time_constant_s: 1.0,
            blade_directivity: Directivity::BLADES,
            mechanical_directivity: Directivity::OMNI,
            broadband_directivity: Directivity::BROADBAND,
        }
    }

    /// One steady line at this order, the same in all directions, 94 dB SPL at 1 m at every speed, and nothing else: for
    /// checks against a closed form.
    pub fn single_line(order: u32, reference_speed: RotorSpeed) -> Self {
        Self {
            reference_speed,
            tones: ToneSettings::single(order),
            tone_level_db_spl: 94.0,
            pinion_teeth: None,
            pinion_sideband_level: 0.0,
            motor: None,
            broadband: None,
            blade_speed_exponent: 0.0,
            mechanical_speed_exponent: 0.0,
            unsteadiness: 0.0,
            unsteadiness_time_constant_s: 1.0,
            blade_directivity: Directivity::OMNI,
            mechanical_directivity: Directivity::OMNI,
            broadband_directivity: Directivity::OMNI,
        }
    }

    fn check(&self) -> Result<(), QuantityError> {
        self.tones.check()?;
        checked("reference_speed", self.reference_speed.rad_s(), Bound::Positive)?;
        checked("tone_level_db_spl", self.tone_level_db_spl, LEVEL)?;
        checked("pinion_sideband_level", self.pinion_sideband_level, Bound::ZeroOrMore)?;
        checked("pinion_teeth", f64::from(self.pinion_teeth.unwrap_or(1)), Bound::Positive)?;
        if let Some(motor) = &self.motor {
            checked("motor order", motor.order, Bound::Positive)?;
            for &level in &motor.harmonic_levels {
                checked("motor harmonic_levels", level, Bound::ZeroOrMore)?;
            }
        }
        if let Some(noise) = &self.broadband {
            checked("broadband level_db_spl", noise.level_db_spl, LEVEL)?;
            checked(
                "broadband flat_below_hz",
                noise.flat_below_hz,
                Bound::Within(10.0, 4000.0, "between 10 and 4000"),
            )?;
            checked("broadband slope_db_per_octave", noise.slope_db_per_octave, SLOPE)?;
            checked("broadband speed_exponent", noise.speed_exponent, EXPONENT)?;
            checked("modulation_depth", noise.modulation_depth, SHARE)?;
        }
        checked("blade_speed_exponent", self.blade_speed_exponent, EXPONENT)?;
        checked("mechanical_speed_exponent", self.mechanical_speed_exponent, EXPONENT)?;
        checked("unsteadiness", self.unsteadiness, SHARE)?;
        checked("unsteadiness_time_constant_s", self.unsteadiness_time_constant_s, Bound::Positive)?;
        for pattern in [self.blade_directivity, self.mechanical_directivity, self.broadband_directivity] {
            pattern.check()?;
        }
        Ok(())
    }
}

/// Noise of the place, independent at each microphone.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct AmbientSettings {
    /// Level over the whole band.
    pub level_db_spl: f64,
    /// Below this frequency the density is flat.
    pub flat_below_hz: f64,
    /// Slope of the density above, between -6 and 0.
    pub slope_db_per_octave: f64,
}

impl Default for AmbientSettings {
    /// 50 dB, falling by 5 dB per octave above 60 Hz: about the noise criterion NC-45, the limit for a laboratory (Handbook of
    /// Facilities Planning 1990, at ateam.lbl.gov); its curves fall by 5 dB per octave band.
    fn default() -> Self {
        Self { level_db_spl: 50.0, flat_below_hz: 60.0, slope_db_per_octave: -5.0 }
    }
}

/// Settings of a whole scene. One channel per microphone.
#[derive(Clone, Debug, PartialEq)]
pub struct SoundSettings {
    /// Samples per second.
    pub sample_rate_hz: u32,
    /// The sound of each rotor.
    pub source: SourceSettings,
    /// Room, ground or free field.
    pub surroundings: Surroundings,
    /// Speed of sound, m/s; `331.3 √(1 + t/273.15)` in dry air at t °C.
    pub speed_of_sound_m_s: f64,
    /// The microphones: at least one.
    pub microphones: Vec<MicrophoneSettings>,
    /// Noise of the place.
    pub ambient: Option<AmbientSettings>,
    /// People talking outside.
    pub babble: Option<BabbleSettings>,
    /// All random numbers come from this seed.
    pub seed: u64,
}

impl SoundSettings {
    /// The paper's figure 1: a laboratory with people talking outside, and one microphone 2 m above the floor, by a wall.
    pub fn laboratory(source: SourceSettings) -> Self {
        Self {
            sample_rate_hz: 48_000,
            source,
            surroundings: Surroundings::Room(Room::default()),
            // 20 °C.
            speed_of_sound_m_s: 343.2,
            microphones: vec![MicrophoneSettings::at([-3.5, 1.0, 2.0])],
            ambient: Some(AmbientSettings::default()),
            babble: Some(BabbleSettings::default()),
            seed: 1,
        }
    }

    /// Rotors and ideal microphones in a free field and nothing else: for checks against a closed form.
    pub fn free_field(source: SourceSettings, microphones_m: &[[f64; 3]]) -> Self {
        Self {
            surroundings: Surroundings::FreeField,
            microphones: microphones_m.iter().map(|&place| MicrophoneSettings::ideal(place)).collect(),
            ambient: None,
            babble: None,
            ..Self::laboratory(source)
        }
    }

    pub(crate) fn check(&self) -> Result<(), QuantityError> {
        let rate = f64::from(self.sample_rate_hz);
        checked("sample_rate_hz", rate, Bound::Within(8_000.0, 192_000.0, "between 8000 and 192000"))?;
        checked("speed_of_sound_m_s", self.speed_of_sound_m_s, Bound::Within(100.0, 2000.0, "between 100 and 2000"))?;
        self.source.check()?;
        self.surroundings.check()?;
        if self.microphones.is_empty() {
            return Err(QuantityError { name: "microphones", value: 0.0, must_be: "at least one" });
        }
        for microphone in &self.microphones {
            microphone.check(rate)?;
            self.surroundings.check_place("microphone position_m", microphone.position_m)?;
        }
        if let Some(ambient) = &self.ambient {
            checked("ambient level_db_spl", ambient.level_db_spl, LEVEL)?;
            checked(
                "ambient flat_below_hz",
                ambient.flat_below_hz,
                Bound::Within(10.0, 4000.0, "between 10 and 4000"),
            )?;
            checked("ambient slope_db_per_octave", ambient.slope_db_per_octave, SLOPE)?;
        }
        self.babble.as_ref().map_or(Ok(()), BabbleSettings::check)
    }
}

/// Plausible levels.
pub(crate) const LEVEL: Bound = Bound::Within(-100.0, 200.0, "between -100 and 200");
const SLOPE: Bound = Bound::Within(-6.0, 0.0, "between -6 and 0");
const EXPONENT: Bound = Bound::Within(0.0, 12.0, "between 0 and 12");
const SHARE: Bound = Bound::Within(0.0, 1.0, "between 0 and 1");
