//! Random hovers, for exams of an estimator on many of them.

use super::file::{FlightSection, PilotSection, ScenarioFile};
use super::maneuver::Maneuver;
use super::sections::{
    AmbientSection, GroundSection, GustSection, JitterSection, MicrophoneSection, PayloadSection, PeopleSection,
    RoomSection, SoundSection, SpreadSection, VehicleSection,
};
use crate::seed::{Part, mixed, stream};
use hovertone_vehicle::flight_presets;
use rand::RngExt;
use rand_pcg::Pcg64;

impl ScenarioFile {
    /// A hover of this length with everything else drawn from the seed. All distributions are uniform:
    ///
    /// - one of the vehicles with flight parameters, with a payload of up to 15 % of its mass 2 cm below its centre;
    /// - each rotor's C_f and each motor's gain up to `spread_share` off; with equal lift the speeds differ by up to the
    ///   same share from slowest to fastest;
    /// - gravity from 9.78 to 9.83 m/s², vertical rate unsteady by 1 to 4 cm/s, the other commands by up to 0.05, gusts
    ///   of 5 to 20 cm/s;
    /// - half of the time in the laboratory with people talking, else on open ground; a microphone 1 to 3.5 m away and
    ///   0.5 to 2.5 m up;
    /// - lines of 50 to 60 dB and broadband noise of 55 to 65 dB a rotor; 44.1 or 48 kHz.
    pub fn random_hover(seed: u64, duration_s: f64, spread_share: f64) -> Self {
        let random = &mut stream(seed, Part::Scenario, 0);
        let vehicles = flight_presets();
        let vehicle = &vehicles[(uniform(random, 0.0, vehicles.len() as f64) as usize).min(vehicles.len() - 1)];
        let payload = PayloadSection {
            mass_kg: vehicle.mass_kg.value * uniform(random, 0.0, 0.15),
            position_m: [0.0, 0.0, -0.02],
        };
        let mut shares = || std::array::from_fn(|_| uniform(random, 1.0 - spread_share, 1.0 + spread_share));
        let spread =
            SpreadSection { thrust_shares: Some(shares()), motor_gains: Some(shares()), ..SpreadSection::default() };
        let gust_m_s = uniform(random, 0.05, 0.2);
        let jitter = JitterSection {
            roll_std: uniform(random, 0.0, 0.05),
            pitch_std: uniform(random, 0.0, 0.05),
            yaw_rate_std: uniform(random, 0.0, 0.05),
            climb_std: uniform(random, 0.01, 0.04),
            time_constant_s: uniform(random, 0.1, 0.5),
        };
        let (distance_m, angle) = (uniform(random, 1.0, 3.5), uniform(random, 0.0, std::f64::consts::TAU));
        // the room is 6 m wide: a position behind the wall moves before it
        let position_m =
            [distance_m * angle.cos(), (distance_m * angle.sin()).clamp(-2.8, 2.8), uniform(random, 0.5, 2.5)];
        let is_indoors = uniform(random, 0.0, 1.0) < 0.5;
        Self {
            // the draws above and the scenario use different streams
            seed: mixed(seed, Part::Scenario, 1) >> 1,
            vehicle: VehicleSection { preset: vehicle.id.to_owned(), ..VehicleSection::default() },
            payloads: vec![payload],
            flight: FlightSection { gravity_m_s2: uniform(random, 9.78, 9.83), ..FlightSection::default() },
            pilot: PilotSection { jitter: Some(jitter), ..PilotSection::default() },
            maneuvers: vec![Maneuver::Hover { duration_s }],
            spread: Some(spread),
            gusts: Some(GustSection {
                std_m_s: Some([gust_m_s; 3]),
                length_m: Some([1.0; 3]),
                airspeed_m_s: Some(1.0),
                ..GustSection::default()
            }),
            sound: SoundSection {
                sample_rate_hz: if uniform(random, 0.0, 1.0) < 0.5 { 44_100 } else { 48_000 },
                tone_level_db_spl: uniform(random, 50.0, 60.0),
                broadband_level_db_spl: uniform(random, 55.0, 65.0),
                ..SoundSection::default()
            },
            room: is_indoors.then(RoomSection::default),
            ground: (!is_indoors).then(GroundSection::default),
            people: is_indoors.then(PeopleSection::default),
            ambient: Some(AmbientSection::default()),
            microphones: vec![MicrophoneSection::at(position_m)],
            ..Self::default()
        }
    }

    /// Mass of the vehicle with its payloads; none if the preset has no flight parameters.
    pub fn mass_kg(&self) -> Option<f64> {
        let preset = hovertone_vehicle::find_flight_parameters(&self.vehicle.preset)?;
        let own_kg = self.vehicle.mass_kg.unwrap_or(preset.mass_kg.value);
        Some(own_kg + self.payloads.iter().map(|payload| payload.mass_kg).sum::<f64>())
    }
}

fn uniform(random: &mut Pcg64, low: f64, high: f64) -> f64 {
    let unit: f64 = random.random();
    low + (high - low) * unit
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scenario::ScenarioRun;
    use std::collections::{BTreeMap, BTreeSet};

    #[test]
    fn drawn_hovers_can_be_flown_and_cover_all_vehicles() {
        let mut seen = BTreeSet::new();
        for seed in 0..40 {
            let file = ScenarioFile::random_hover(seed, 2.0, 0.01);
            assert_eq!(file, ScenarioFile::random_hover(seed, 2.0, 0.01));
            let run = ScenarioRun::new(file.resolve(&BTreeMap::new()).unwrap()).unwrap();
            let speeds = run.scenario().flight.spread.unwrap().thrust_shares;
            assert!(speeds.iter().all(|share| (share - 1.0).abs() <= 0.01));
            seen.insert((file.vehicle.preset.clone(), file.room.is_some()));
            assert!(file.mass_kg().unwrap() > 0.0 && toml::to_string(&file).is_ok());
        }
        assert_eq!(seen.len(), 2 * flight_presets().len(), "{seen:?}");
    }
}
