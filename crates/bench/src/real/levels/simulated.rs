//! Flights with levels drawn from those of real rotors, in places, winds and recorders that are drawn too, through codecs of phones.

use super::super::cases::{SpeedRange, Truth};
use super::super::library::sound_of;
use crate::workspace::output_of;
use hovertone::sound::Signal;
use hovertone_sim::scenario::{
    AmbientSection, AutomaticGainSection, FlightSection, GustSection, JitterSection, LineLevelsName, MicrophoneSection,
    MotorWanderSection, PeopleSection, PilotSection, ScenarioFile, ScenarioRun, SoundSection,
};
use hovertone_sim::{FlightState, SourceSettings};
use hovertone_vehicle::{LineLevels, RotorSpeed, Sourced, Vehicle, find_preset};
use rand::{RngExt, SeedableRng};
use rand_pcg::Pcg64;
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::process::Command;

const DURATION_S: f64 = 6.0;
/// Each rotor's constant, up to this share off.
const SPREAD_SHARE: f64 = 0.02;
/// Largest share by which the front and the rear rotors are apart.
const FRONT_TO_REAR_SHARE: f64 = 0.15;
/// Share of the vehicles without a gear that have three blades.
const THREE_BLADES_SHARE: f64 = 0.25;
/// Blades of a vehicle whose preset does not have them.
const BLADES_OF_MOST: u32 = 2;
/// Codecs of phones and cameras: the arguments of ffmpeg, and the ending of the file.
const CODECS: [Codec; 5] = [
    Codec { arguments: &[], ending: "wav" },
    Codec { arguments: &["-c:a", "aac", "-b:a", "128k"], ending: "m4a" },
    Codec { arguments: &["-c:a", "aac", "-b:a", "64k"], ending: "m4a" },
    Codec { arguments: &["-c:a", "libopus", "-b:a", "48k"], ending: "opus" },
    Codec { arguments: &["-c:a", "libopus", "-b:a", "24k"], ending: "opus" },
];

struct Codec {
    arguments: &'static [&'static str],
    ending: &'static str,
}

/// A simulated flight with its truth.
pub(super) struct Flight {
    pub(super) sound: Signal,
    pub(super) blades: u32,
    pub(super) mean_rev_s: f64,
    pub(super) truth: Truth,
}

/// Whether codecs can be simulated.
pub(super) fn has_ffmpeg() -> bool {
    output_of(Command::new("ffmpeg").arg("-version")).is_ok()
}

/// Flies one of them. Files of codecs go to the folder.
pub(super) fn flown(seed: u64, folder: &Path, has_ffmpeg: bool) -> Result<Flight, String> {
    let failed = |error: &dyn std::fmt::Display| format!("simulated flight {seed}: {error}");
    let random = &mut Pcg64::seed_from_u64(seed);
    let file = scenario_of(seed, random);
    let preset = find_preset(&file.vehicle.preset).ok_or_else(|| failed(&"no such vehicle"))?;
    let mut scenario = file.resolve(&BTreeMap::new()).map_err(|error| failed(&error))?;
    let mut blades = preset.blade_count.map_or(BLADES_OF_MOST, |blades| blades.value);
    if preset.gear.is_none() && random.random::<f64>() < THREE_BLADES_SHARE {
        blades = 3;
    }
    let own = Vehicle { blade_count: Some(Sourced { value: blades, source: "drawn" }), ..preset.clone() };
    let plain = &scenario.sound.source;
    scenario.sound.source = SourceSettings {
        tone_level_db_spl: plain.tone_level_db_spl,
        broadband: plain.broadband,
        unsteadiness: plain.unsteadiness,
        ..SourceSettings::drawn(&own, plain.reference_speed, &LineLevels::default(), seed)
    };
    let rate_hz = scenario.sound.sample_rate_hz;
    let mut run = ScenarioRun::new(scenario).map_err(|error| failed(&error))?;
    let (mut channels, mut rows) = (Vec::new(), Vec::new());
    while run.advance(&mut channels, &mut rows).map_err(|error| failed(&error))? {}
    run.finish(&mut channels);
    let samples = channels.into_iter().next().unwrap_or_default();
    let codec = &CODECS[random.random_range(0..CODECS.len())];
    let recorder = Recorder { folder, seed, codec: if has_ffmpeg { codec } else { &CODECS[0] } };
    let sound = recorder.recorded(&samples, rate_hz)?;
    let speeds_rev_s = speeds_of(&rows);
    let all = || speeds_rev_s.iter().copied();
    let accepted = SpeedRange { low: all().fold(f64::INFINITY, f64::min), high: all().fold(0.0, f64::max) };
    let name = format!("{seed} ({}, {} blades, {})", preset.id, blades, recorder.codec.name());
    let truth = Truth { file: name, kind: "multi".to_owned(), accept_whole_rev_s: Some(accepted), ..Truth::default() };
    Ok(Flight { sound, blades, mean_rev_s: all().sum::<f64>() / speeds_rev_s.len() as f64, truth })
}

fn speeds_of(rows: &[FlightState]) -> Vec<f64> {
    rows.iter().flat_map(|row| row.speed_rad_s).map(|speed| RotorSpeed::from_rad_s(speed).rev_s()).collect()
}

/// A random hover in which also the following is drawn, uniformly:
///
/// - lines of 45 to 63 dB a rotor; rotors up to 15 % apart from front to rear;
/// - wander of each motor's gain of 0.2 to 0.4 %, and of the vertical rate, which moves all rotors together, of 2 to 10 cm/s;
/// - outdoors a height of 4 m, a microphone 2 to 12 m away, gusts of a wind of up to 3 m/s and its noise of 50 to 85 dB;
/// - noise of the place of 30 to 60 dB, in rooms people of 40 to 65 dB; an automatic gain in half of the recorders.
fn scenario_of(seed: u64, random: &mut Pcg64) -> ScenarioFile {
    let mut uniform = |low: f64, high: f64| low + (high - low) * random.random::<f64>();
    let plain = ScenarioFile::random_hover(seed, DURATION_S, SPREAD_SHARE);
    let apart = uniform(-FRONT_TO_REAR_SHARE, FRONT_TO_REAR_SHARE);
    let mut spread = plain.spread.unwrap_or_default();
    if let Some(shares) = &mut spread.thrust_shares {
        // front left, rear left, rear right, front right; or front, left, rear, right
        for (share, side) in shares.iter_mut().zip([-1.0, 1.0, 1.0, -1.0]) {
            *share *= 1.0 + side * apart;
        }
    }
    let is_outdoors = plain.ground.is_some();
    let (distance_m, angle, height_m) = (uniform(2.0, 12.0), uniform(0.0, std::f64::consts::TAU), uniform(0.5, 2.0));
    let (wind_m_s, wind_noise_db_spl, people_db_spl) = (uniform(0.5, 3.0), uniform(50.0, 85.0), uniform(40.0, 65.0));
    let place_m = [distance_m * angle.cos(), distance_m * angle.sin(), height_m];
    let inside = plain.microphones.first().copied().unwrap_or_else(|| MicrophoneSection::at([1.0, 0.0, 1.0]));
    let gain = AutomaticGainSection { release_s: Some(uniform(0.5, 4.0)), ..AutomaticGainSection::default() };
    let microphone = MicrophoneSection {
        wind_noise_db_spl: is_outdoors.then_some(wind_noise_db_spl),
        automatic_gain: (uniform(0.0, 1.0) < 0.5).then_some(gain),
        ..if is_outdoors { MicrophoneSection::at(place_m) } else { inside }
    };
    // gusts do not press it to the ground
    let high_up = FlightSection { start_position_m: [0.0, 0.0, 4.0], ..plain.flight.clone() };
    let jitter = JitterSection { climb_std: uniform(0.02, 0.1), ..plain.pilot.jitter.unwrap_or_default() };
    let outdoors = GustSection { wind_at_6_m_m_s: Some(wind_m_s), ..GustSection::default() };
    let people = PeopleSection { level_db_spl: Some(people_db_spl), ..PeopleSection::default() };
    ScenarioFile {
        spread: Some(spread),
        motor_wander: Some(MotorWanderSection { gain_std_share: uniform(0.002, 0.004), ..Default::default() }),
        pilot: PilotSection { jitter: Some(jitter), ..plain.pilot },
        flight: if is_outdoors { high_up } else { plain.flight },
        gusts: if is_outdoors { Some(outdoors) } else { plain.gusts },
        ambient: Some(AmbientSection { level_db_spl: Some(uniform(30.0, 60.0)) }),
        people: plain.people.map(|_| people),
        sound: SoundSection {
            tone_level_db_spl: uniform(45.0, 63.0),
            line_levels: LineLevelsName::Drawn,
            ..plain.sound
        },
        microphones: vec![microphone],
        ..plain
    }
}

/// A recorder with its codec.
struct Recorder<'a> {
    folder: &'a Path,
    seed: u64,
    codec: &'static Codec,
}

impl Codec {
    fn name(&self) -> String {
        match self.arguments {
            [_, codec, _, rate] => format!("{codec} {rate}"),
            _ => "uncompressed".to_owned(),
        }
    }
}

impl Recorder<'_> {
    /// The sound as it comes out of the file.
    fn recorded(&self, samples: &[f32], rate_hz: u32) -> Result<Signal, String> {
        if self.codec.arguments.is_empty() {
            return Ok(Signal::new(samples.to_vec(), f64::from(rate_hz)));
        }
        let (before, after) = (self.path("wav"), self.path(self.codec.ending));
        self.write(&before, samples, rate_hz).map_err(|error| format!("{}: {error}", before.display()))?;
        let mut command = Command::new("ffmpeg");
        // the file names its one channel "front left", which encoders refuse
        command.args(["-y", "-loglevel", "error", "-i"]).arg(&before).args(["-ac", "1"]);
        command.args(self.codec.arguments).arg(&after);
        output_of(&mut command)?;
        sound_of(&after, None)
    }

    fn path(&self, ending: &str) -> PathBuf {
        self.folder.join(format!("{}.{ending}", self.seed))
    }

    fn write(&self, path: &Path, samples: &[f32], sample_rate: u32) -> Result<(), hound::Error> {
        let spec =
            hound::WavSpec { channels: 1, sample_rate, bits_per_sample: 32, sample_format: hound::SampleFormat::Float };
        let mut writer = hound::WavWriter::create(path, spec)?;
        for sample in samples {
            writer.write_sample(*sample)?;
        }
        writer.finalize()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use hovertone::sound::SignalSource;

    #[test]
    fn flights_differ_and_their_speeds_lie_in_the_accepted_range() {
        let folder = Path::new("unused");
        let flights = [1, 2].map(|seed| flown(seed, folder, false).unwrap());
        for flight in &flights {
            let accepted = flight.truth.accept_whole_rev_s.unwrap();
            assert!(accepted.low < flight.mean_rev_s && flight.mean_rev_s < accepted.high, "{accepted:?}");
            let count = flight.sound.samples().len() as f64 / flight.sound.sample_rate_hz();
            assert!((count - DURATION_S).abs() < 0.01, "{count} s");
        }
        assert_ne!(flights[0].mean_rev_s, flights[1].mean_rev_s);
    }
}
