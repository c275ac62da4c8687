//! From a scenario file to the settings of the flight, of the sound, and a schedule.

use super::file::ScenarioFile;
use super::maneuver::Maneuver;
use super::schedule::Schedule;
use super::sections::{
    AutomaticGainSection, GustSection, JitterSection, LineLevelsName, MicrophoneSection, SampleFormat, VehicleSection,
};
use super::{Scenario, ScenarioError};
use crate::control::Setpoint;
use crate::environment::{Air, Gusts};
use crate::flight_settings::{FlightSettings, MotorWander, Payload, Spread, Start};
use crate::sound::{
    AmbientSettings, AutomaticGain, BabbleSettings, MicrophoneSettings, Room, SoundSettings, SourceSettings,
    Surroundings, WallAbsorption,
};
use hovertone_vehicle::{FlightParameters, LineLevels, RotorSpeed, Sourced, find_flight_parameters, find_preset};
use std::collections::BTreeMap;

/// Source of a number from the file.
const SOURCE: &str = "the scenario file";
/// A WAV file counts its bytes in 32 bits; its header is far below a kilobyte.
const SOUND_BYTES_MAX: f64 = 4_294_966_272.0;
/// Longest flight: a day.
const DURATION_S_MAX: f64 = 86_400.0;

impl ScenarioFile {
    /// Resolves the file. `tables` has the text of every file of [`command_files`](Self::command_files), by its name as
    /// written.
    ///
    /// # Errors
    /// On a preset without flight parameters, a faulty table, maneuvers that cannot follow each other, and numbers out of
    /// bounds. Numbers of the sound are checked later ([`ScenarioRun::new`](super::ScenarioRun::new)).
    pub fn resolve(&self, tables: &BTreeMap<String, String>) -> Result<Scenario, ScenarioError> {
        let mut vehicle = vehicle_of(&self.vehicle)?;
        if let Some(controller) = &self.controller {
            controller.apply(&mut vehicle.controller);
        }
        let flight = self.flight_of(vehicle)?;
        // what follows computes with these numbers
        flight.check()?;
        let start = match flight.start {
            Start::Hover(setpoint) => setpoint,
            Start::Ground { place_m: [x, y], yaw_rad } => Setpoint { position_m: [x, y, 0.0], yaw_rad },
        };
        let schedule = Schedule::new(&self.maneuvers, start, self.flight.starts_on_ground, tables)?;
        self.check_pilot()?;
        let duration_s = self.duration_s.unwrap_or(schedule.end_s());
        let steps = duration_s / flight.step_s;
        if !(steps.round() >= 1.0 && duration_s <= DURATION_S_MAX) {
            return Err(ScenarioError::out_of_range("duration_s", duration_s, "above 0 and at most a day"));
        }
        let steps_per_row = 1.0 / (self.truth_rate_hz * flight.step_s);
        if !(steps_per_row.round() >= 1.0 && (steps_per_row - steps_per_row.round()).abs() < 1e-6 * steps_per_row) {
            let must_be =
                "a divisor of the number of steps in a second: with steps of 1 ms, 1000, 500, 250, 200 or 100";
            return Err(ScenarioError::out_of_range("truth_rate_hz", self.truth_rate_hz, must_be));
        }
        let sound = self.sound_of(&flight)?;
        let format = self.sound.sample_format;
        let bytes_per_s = f64::from(sound.sample_rate_hz * format.byte_count()) * sound.microphones.len() as f64;
        if duration_s * bytes_per_s > SOUND_BYTES_MAX {
            let must_be = "shorter: a WAV file holds at most 4 GiB for all channels together";
            return Err(ScenarioError::out_of_range("duration_s", duration_s, must_be));
        }
        Ok(Scenario {
            flight,
            sound,
            schedule,
            holds_place: self.pilot.holds_place,
            jitter: self.pilot.jitter,
            step_count: steps.round() as u64,
            steps_per_row: steps_per_row.round() as u64,
            sample_format: format,
        })
    }

    fn flight_of(&self, vehicle: FlightParameters) -> Result<FlightSettings, ScenarioError> {
        let section = &self.flight;
        let (position_m, yaw_rad) = (section.start_position_m, section.start_yaw_deg.to_radians());
        let start = match section.starts_on_ground {
            true => Start::Ground { place_m: [position_m[0], position_m[1]], yaw_rad },
            false => Start::Hover(Setpoint { position_m, yaw_rad }),
        };
        Ok(FlightSettings {
            gravity_m_s2: section.gravity_m_s2,
            step_s: section.step_s,
            start,
            payloads: self.payloads.iter().map(|p| Payload { mass_kg: p.mass_kg, position_m: p.position_m }).collect(),
            spread: self.spread_of()?,
            motor_wander: self.motor_wander.map(|wander| MotorWander {
                gain_std_share: wander.gain_std_share,
                time_constant_s: wander.time_constant_s,
            }),
            battery_sag: section.battery_sag,
            ground_effect: section.ground_effect,
            air: self.air.map(|air| Air {
                temperature_c: air.temperature_c,
                pressure_hpa: air.pressure_hpa,
                humidity_percent: air.humidity_percent,
            }),
            wind_m_s: self.wind.map_or([0.0; 3], |wind| wind.velocity_m_s),
            gusts: self.gusts.map(|gusts| gusts_of(&gusts, position_m[2])).transpose()?,
            seed: self.seed,
            ..FlightSettings::for_vehicle(vehicle)
        })
    }

    fn spread_of(&self) -> Result<Option<Spread>, ScenarioError> {
        let Some(section) = self.spread else { return Ok(None) };
        for (name, share) in [
            ("spread thrust_std_share", section.thrust_std_share),
            ("spread motor_gain_std_share", section.motor_gain_std_share),
        ] {
            if !(0.0..=0.15).contains(&share) {
                return Err(ScenarioError::out_of_range(name, share, "between 0 and 0.15"));
            }
        }
        let drawn = Spread::random(section.thrust_std_share, section.motor_gain_std_share, self.seed);
        Ok(Some(Spread {
            thrust_shares: section.thrust_shares.unwrap_or(drawn.thrust_shares),
            motor_gains: section.motor_gains.unwrap_or(drawn.motor_gains),
        }))
    }

    fn check_pilot(&self) -> Result<(), ScenarioError> {
        let needs_pilot = |maneuver: &&Maneuver| {
            !matches!(
                maneuver,
                Maneuver::Hover { .. } | Maneuver::Step { .. } | Maneuver::Doublet { .. } | Maneuver::Csv { .. }
            )
        };
        if !self.pilot.holds_place && self.maneuvers.iter().any(|maneuver| needs_pilot(&maneuver)) {
            return Err(ScenarioError::Contradiction {
                what: "a maneuver flies to a place, but with holds_place = false the vehicle flies to no place"
                    .to_owned(),
                hint: "leave holds_place out, or use only hover, step, doublet and csv",
            });
        }
        if let Some(jitter) = &self.pilot.jitter {
            let JitterSection { roll_std, pitch_std, yaw_rate_std, climb_std, time_constant_s } = *jitter;
            for std in [roll_std, pitch_std, yaw_rate_std, climb_std] {
                if !(0.0..=1.0).contains(&std) {
                    return Err(ScenarioError::out_of_range("jitter std", std, "between 0 and 1"));
                }
            }
            if !(time_constant_s > 0.0 && time_constant_s.is_finite()) {
                return Err(ScenarioError::out_of_range("jitter time_constant_s", time_constant_s, "above 0"));
            }
        }
        Ok(())
    }

    fn sound_of(&self, flight: &FlightSettings) -> Result<SoundSettings, ScenarioError> {
        let id = flight.vehicle.id;
        let preset = find_preset(id).ok_or_else(|| ScenarioError::UnknownPreset { name: id.to_owned() })?;
        let section = &self.sound;
        let hover_speed = bare_hover_speed(flight);
        let mut source = match section.line_levels {
            LineLevelsName::Assumed => SourceSettings::for_vehicle(preset, hover_speed),
            LineLevelsName::Drawn => SourceSettings::drawn(preset, hover_speed, &LineLevels::default(), self.seed),
        };
        source.tone_level_db_spl = section.tone_level_db_spl;
        source.unsteadiness = section.unsteadiness;
        if let Some(noise) = &mut source.broadband {
            noise.level_db_spl = section.broadband_level_db_spl;
        }
        let plain = SoundSettings::laboratory(source);
        let microphones: Vec<MicrophoneSettings> = match self.microphones.as_slice() {
            [] => plain.microphones.clone(),
            sections => sections.iter().map(microphone_of).collect(),
        };
        let bits = section.sample_format.integer_bits();
        let microphones = microphones.into_iter().map(|microphone| MicrophoneSettings { bits, ..microphone }).collect();
        let speed_of_sound_m_s =
            self.air.map_or(plain.speed_of_sound_m_s, |air| 331.3 * (1.0 + air.temperature_c / 273.15).sqrt());
        Ok(SoundSettings {
            sample_rate_hz: section.sample_rate_hz,
            surroundings: self.surroundings_of()?,
            speed_of_sound_m_s,
            microphones,
            ambient: self.ambient.map(|section| {
                let plain = AmbientSettings::default();
                AmbientSettings { level_db_spl: section.level_db_spl.unwrap_or(plain.level_db_spl), ..plain }
            }),
            babble: self.people.map(|section| {
                let plain = BabbleSettings::default();
                BabbleSettings {
                    level_db_spl: section.level_db_spl.unwrap_or(plain.level_db_spl),
                    voices: section.voices.unwrap_or(plain.voices),
                    position_m: section.position_m.unwrap_or(plain.position_m),
                    ..plain
                }
            }),
            seed: self.seed,
            ..plain
        })
    }

    fn surroundings_of(&self) -> Result<Surroundings, ScenarioError> {
        match (self.room, self.ground) {
            (Some(_), Some(_)) => Err(ScenarioError::Contradiction {
                what: "there are both a [room] and a [ground]".to_owned(),
                hint: "a room has its own floor: remove [ground] or [room]",
            }),
            (None, None) => Ok(Surroundings::FreeField),
            (None, Some(ground)) => Ok(Surroundings::Ground { absorption: ground.absorption }),
            (Some(section), None) => {
                let plain = Room::default();
                let wall = |own: f64| section.wall_absorption.unwrap_or(own);
                Ok(Surroundings::Room(Room {
                    corner_m: section.corner_m.unwrap_or(plain.corner_m),
                    size_m: section.size_m.unwrap_or(plain.size_m),
                    absorption: WallAbsorption {
                        x_low: wall(plain.absorption.x_low),
                        x_high: wall(plain.absorption.x_high),
                        y_low: wall(plain.absorption.y_low),
                        y_high: wall(plain.absorption.y_high),
                        floor: section.floor_absorption.unwrap_or(plain.absorption.floor),
                        ceiling: section.ceiling_absorption.unwrap_or(plain.absorption.ceiling),
                    },
                    reverberation_s: section.reverberation_s.or(plain.reverberation_s).filter(|time_s| *time_s != 0.0),
                }))
            }
        }
    }
}

/// Speed of the vehicle's hover without payload, the reference speed of the levels of its sound.
fn bare_hover_speed(flight: &FlightSettings) -> RotorSpeed {
    let (mass_kg, constant) = (flight.vehicle.mass_kg.value, flight.vehicle.rotor.thrust_constant_n_s2.value);
    RotorSpeed::from_rad_s((mass_kg * flight.gravity_m_s2 / (4.0 * constant)).sqrt())
}

pub(super) fn set<T>(own: &mut Sourced<T>, value: Option<T>) {
    if let Some(value) = value {
        *own = Sourced { value, source: SOURCE };
    }
}

fn vehicle_of(section: &VehicleSection) -> Result<FlightParameters, ScenarioError> {
    let unknown = || ScenarioError::UnknownPreset { name: section.preset.clone() };
    let mut vehicle = find_flight_parameters(&section.preset).ok_or_else(unknown)?.clone();
    set(&mut vehicle.mass_kg, section.mass_kg);
    set(&mut vehicle.inertia_kg_m2, section.inertia_kg_m2);
    set(&mut vehicle.layout, section.layout.map(Into::into));
    set(&mut vehicle.arm_length_m, section.arm_length_m);
    set(&mut vehicle.drag_n_s_m, section.drag_n_s_m);
    set(&mut vehicle.rotor.thrust_constant_n_s2, section.thrust_constant_per_rotor_n_s2);
    set(&mut vehicle.rotor.torque_constant_n_m_s2, section.torque_constant_per_rotor_n_m_s2);
    set(&mut vehicle.rotor.air_density_kg_m3, section.air_density_kg_m3);
    set(&mut vehicle.motor.resistance_ohm, section.motor_resistance_ohm);
    set(&mut vehicle.motor.constant_v_s_rad, section.motor_constant_v_s_rad);
    set(&mut vehicle.motor.viscous_n_m_s, section.motor_viscous_n_m_s);
    set(&mut vehicle.motor.inertia_kg_m2, section.motor_inertia_kg_m2);
    set(&mut vehicle.battery.voltage_v, section.battery_voltage_v);
    set(&mut vehicle.battery.capacity_a_h, section.battery_capacity_a_h);
    set(&mut vehicle.battery.resistance_ohm, section.battery_resistance_ohm);
    vehicle.check()?;
    Ok(vehicle)
}

fn gusts_of(section: &GustSection, height_m: f64) -> Result<Gusts, ScenarioError> {
    let by_wind = section.wind_at_6_m_m_s.map(|wind_m_s| Gusts::low_altitude(height_m, wind_m_s));
    let own = (section.std_m_s, section.length_m, section.airspeed_m_s);
    match (by_wind, own) {
        (Some(gusts), (None, None, None)) => Ok(gusts),
        (None, (Some(std_m_s), Some(length_m), Some(airspeed_m_s))) => Ok(Gusts { std_m_s, length_m, airspeed_m_s }),
        (Some(_), _) => Err(ScenarioError::Contradiction {
            what: "[gusts] has wind_at_6_m_m_s, but also std_m_s, length_m or airspeed_m_s".to_owned(),
            hint: "keep wind_at_6_m_m_s alone, or std_m_s, length_m and airspeed_m_s",
        }),
        (None, _) => Err(ScenarioError::Missing {
            what: "the strength of the gusts".to_owned(),
            hint: "write wind_at_6_m_m_s under [gusts], or all of std_m_s, length_m and airspeed_m_s",
        }),
    }
}

fn microphone_of(section: &MicrophoneSection) -> MicrophoneSettings {
    let plain = match section.ideal {
        true => MicrophoneSettings::ideal(section.position_m),
        false => MicrophoneSettings::at(section.position_m),
    };
    MicrophoneSettings {
        full_scale_db_spl: section.full_scale_db_spl.unwrap_or(plain.full_scale_db_spl),
        self_noise_db_spl: section.self_noise_db_spl.or(plain.self_noise_db_spl),
        wind_noise_db_spl: section.wind_noise_db_spl,
        automatic_gain: section.automatic_gain.map(automatic_gain_of),
        ..plain
    }
}

fn automatic_gain_of(section: AutomaticGainSection) -> AutomaticGain {
    let plain = AutomaticGain::default();
    AutomaticGain {
        target_dbfs: section.target_dbfs.unwrap_or(plain.target_dbfs),
        attack_s: section.attack_s.unwrap_or(plain.attack_s),
        release_s: section.release_s.unwrap_or(plain.release_s),
        gain_db_max: section.gain_db_max.unwrap_or(plain.gain_db_max),
    }
}

impl SampleFormat {
    /// A sample of ±1 as a whole number of this format. Samples of a sound of this format are already such numbers over
    /// 2^(bits-1), so only the product is rounded.
    pub fn whole_number(bits: u32, sample: f32) -> i32 {
        let steps = 2_f64.powi(bits.clamp(2, 24) as i32 - 1);
        (f64::from(sample) * steps).round().clamp(-steps, steps - 1.0) as i32
    }
}
