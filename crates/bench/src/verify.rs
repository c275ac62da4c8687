//! `cargo run --release -p hovertone-bench -- verify`: sound against telemetry on simulated flights. Prints the tables of `docs/verify.md`. Run by
//! people; its test flies fewer.

use hovertone::rotors::{LoggedSpeeds, Verification, verification_of_heard};
use hovertone::sound::Signal;
use hovertone::speed::{Config, Method, Outcome, RotorsHeard, ToneConfig, TrackPoint, speed_from_source};
use hovertone_sim::FlightState;
use hovertone_sim::scenario::{ScenarioFile, ScenarioRun};
use hovertone_vehicle::find_preset;
use rand::{RngExt, SeedableRng};
use rand_pcg::Pcg64;
use std::borrow::Cow;
use std::collections::BTreeMap;
use std::f64::consts::TAU;

const FLIGHTS: u64 = 100;
const DURATION_S: f64 = 15.0;
/// Rotors are up to this far apart, as a share.
const SPREAD_SHARE: f64 = 0.03;
/// Rows of the truth, per second: as often as the fastest telemetry.
const TRUTH_HZ: f64 = 200.0;
/// Telemetry is rounded to this.
const STEP_RPM: f64 = 10.0;
/// Largest error of an offset that is right: the sound comes up to 15 ms late.
const OFFSET_ERROR_S_MAX: f64 = 0.05;

/// A log of the same flight.
#[derive(Clone, Copy, Debug)]
struct Telemetry {
    name: &'static str,
    rate_hz: f64,
    /// Logged over true speed: another number of pole pairs or blades.
    factor: f64,
    /// How much too fast the recorder's clock runs, as a share: it hears all speeds too low, and its times are too long.
    clock_share: f64,
    is_right: bool,
}

const TELEMETRY: [Telemetry; 7] = [
    Telemetry { name: "right, 3 rows per second", rate_hz: 3.0, factor: 1.0, clock_share: 0.0, is_right: true },
    Telemetry { name: "right, 10 rows per second", rate_hz: 10.0, factor: 1.0, clock_share: 0.0, is_right: true },
    Telemetry { name: "right, 100 rows per second", rate_hz: 100.0, factor: 1.0, clock_share: 0.0, is_right: true },
    Telemetry { name: "half the order", rate_hz: 10.0, factor: 0.5, clock_share: 0.0, is_right: false },
    Telemetry { name: "twice the order", rate_hz: 10.0, factor: 2.0, clock_share: 0.0, is_right: false },
    Telemetry { name: "7 for 6 pole pairs", rate_hz: 10.0, factor: 7.0 / 6.0, clock_share: 0.0, is_right: false },
    Telemetry { name: "clock 1 % too fast", rate_hz: 10.0, factor: 1.0, clock_share: 0.01, is_right: false },
];

/// A flight that was flown and heard.
struct Heard {
    states: Vec<FlightState>,
    tracks: Vec<Vec<TrackPoint>>,
    /// Number of rotors that the tracks are of; 1 for the one tone of all.
    rotor_count: usize,
    /// How these are heard.
    heard: Option<RotorsHeard>,
}

/// A log against the tracks of a flight.
struct Compared {
    found: Verification,
    offset_error_s: f64,
    /// Whether each track is given the rotor whose true speed it follows best.
    names: Vec<bool>,
}

/// Runs the exam.
pub(crate) fn run(options: &[&str]) -> Result<(), String> {
    let count = match options {
        [] => FLIGHTS,
        ["--count", count] => count.parse().map_err(|_| "--count needs a number".to_owned())?,
        _ => return Err("verify takes --count N".to_owned()),
    };
    let heard: Vec<Heard> = (1..=count).filter_map(|seed| heard(seed).transpose()).collect::<Result<_, _>>()?;
    let separated = heard.iter().filter(|flight| flight.rotor_count > 1).count();
    println!("{count} flights, {} with a rotor tone, {separated} of them with separated rotors\n", heard.len());
    println!(
        "| rotors | log | compared | speed check right | not decided | offset within 50 ms | names right | bias, \
        median | within ± |"
    );
    println!("|---|---|---|---|---|---|---|---|---|");
    for (rotors, is_separated) in [("separated", true), ("one tone", false)] {
        for telemetry in TELEMETRY {
            let of_kind = heard.iter().zip(1..).filter(|(flight, _)| (flight.rotor_count > 1) == is_separated);
            let compared: Vec<Option<Compared>> =
                of_kind.map(|(flight, seed)| compared(flight, &telemetry, seed)).collect();
            println!("| {rotors} {}", row_of(&telemetry, &compared));
        }
    }
    Ok(())
}

/// Flies a random hover and hears it; `None` without a rotor tone.
fn heard(seed: u64) -> Result<Option<Heard>, String> {
    let file = ScenarioFile { truth_rate_hz: TRUTH_HZ, ..ScenarioFile::random_hover(seed, DURATION_S, SPREAD_SHARE) };
    let scenario = file.resolve(&BTreeMap::new()).map_err(|error| error.to_string())?;
    let mut run = ScenarioRun::new(scenario).map_err(|error| error.to_string())?;
    let (mut channels, mut states) = (Vec::new(), Vec::new());
    while run.advance(&mut channels, &mut states).map_err(|error| error.to_string())? {}
    run.finish(&mut channels);
    let samples = channels.into_iter().next().unwrap_or_default();
    let mut signal = Signal::new(samples, f64::from(file.sound.sample_rate_hz));
    let vehicle = find_preset(&file.vehicle.preset).ok_or("no such vehicle".to_owned())?;
    let order = vehicle.tone_order().ok_or("a vehicle without a tone".to_owned())?;
    let blades = vehicle.blade_count.as_ref().map(|blades| blades.value);
    let mut config = Config::for_tone(ToneConfig { blades, ..ToneConfig::of_order(order) });
    (config.rotors.count, config.method) = (4, Method::Separated);
    let analysis = speed_from_source(&mut signal, &config, &mut |_| {}).map_err(|error| error.to_string())?;
    let Outcome::Ok(tone) = analysis.outcome else { return Ok(None) };
    let rotor_count = tone.rotors.len().max(1);
    let tracks = tone.tracks_beside_log(config.method).into_iter().map(Cow::into_owned).collect();
    let heard = tone.rotors_heard(config.method);
    Ok(Some(Heard { states, tracks, rotor_count, heard }))
}

fn compared(flight: &Heard, telemetry: &Telemetry, seed: u64) -> Option<Compared> {
    let mut random = Pcg64::seed_from_u64(seed);
    let offset_s = -60.0 + 120.0 * random.random::<f64>();
    let late_s = random.random::<f64>() / telemetry.rate_hz;
    let end_s = flight.states.last()?.time_s;
    let times_s: Vec<f64> =
        (0..).map(|row| late_s + f64::from(row) / telemetry.rate_hz).take_while(|time_s| *time_s < end_s).collect();
    let step_rev_s = STEP_RPM / 60.0;
    let logged = |rotor: usize| -> Vec<f64> {
        let speed = |time_s: &f64| telemetry.factor * true_rev_s(flight, rotor, *time_s);
        times_s.iter().map(speed).map(|speed_rev_s| (speed_rev_s / step_rev_s).round() * step_rev_s).collect()
    };
    let speeds_rev_s: Vec<Vec<f64>> = (0..4).map(logged).collect();
    let log_time_s: Vec<f64> = times_s.iter().map(|time_s| time_s - offset_s).collect();
    let names: Vec<String> = (1..=4).map(|motor| format!("motor {motor}")).collect();
    let log = LoggedSpeeds { time_s: &log_time_s, names: &names, speeds_rev_s: &speeds_rev_s };
    let clock = 1.0 + telemetry.clock_share;
    let tracks: Vec<Vec<TrackPoint>> = flight.tracks.iter().map(|track| by_clock(track, clock)).collect();
    let tracks: Vec<&[TrackPoint]> = tracks.iter().map(Vec::as_slice).collect();
    let found = verification_of_heard(&tracks, flight.heard, log, None).ok()?;
    let is_right = |track: usize, motor: usize| nearest_rotor(flight, &flight.tracks[track]) == motor;
    Some(Compared {
        offset_error_s: (found.offset_s - offset_s).abs(),
        names: found
            .rotors
            .iter()
            .filter(|_| flight.rotor_count > 1)
            .map(|rotor| is_right(rotor.track, rotor.motor))
            .collect(),
        found,
    })
}

/// What a recorder hears whose clock is this many times as fast.
fn by_clock(track: &[TrackPoint], clock: f64) -> Vec<TrackPoint> {
    let point = |point: &TrackPoint| TrackPoint {
        time_s: clock * point.time_s,
        tone_hz: point.tone_hz / clock,
        speed_rev_s: point.speed_rev_s / clock,
        ..*point
    };
    track.iter().map(point).collect()
}

fn true_rev_s(flight: &Heard, rotor: usize, time_s: f64) -> f64 {
    let at = ((time_s * TRUTH_HZ).round() as usize).min(flight.states.len() - 1);
    flight.states[at].speed_rad_s[rotor] / TAU
}

/// The rotor whose true speed a track follows best.
fn nearest_rotor(flight: &Heard, track: &[TrackPoint]) -> usize {
    let square = |rotor: usize| -> f64 {
        track.iter().map(|point| (point.speed_rev_s - true_rev_s(flight, rotor, point.time_s)).powi(2)).sum()
    };
    (0..4).min_by(|a, b| square(*a).total_cmp(&square(*b))).unwrap_or_default()
}

fn row_of(telemetry: &Telemetry, all: &[Option<Compared>]) -> String {
    let told: Vec<&Compared> = all.iter().flatten().collect();
    let right = told.iter().filter(|compared| compared.found.is_right() == telemetry.is_right).count();
    let undecided = told.iter().filter(|compared| compared.found.is_right() && !compared.found.passes()).count();
    let offsets = told.iter().filter(|compared| compared.found.is_offset_told);
    let (mut offset_count, mut offset_right) = (0, 0);
    for compared in offsets {
        offset_count += 1;
        offset_right += usize::from(compared.offset_error_s < OFFSET_ERROR_S_MAX);
    }
    let names: Vec<bool> = told.iter().flat_map(|compared| compared.names.clone()).collect();
    let rotors = || told.iter().flat_map(|compared| &compared.found.rotors);
    let mut biases: Vec<f64> = rotors().map(|rotor| (rotor.bias_rev_s / rotor.speed_rev_s).abs()).collect();
    biases.sort_by(f64::total_cmp);
    let points: usize = rotors().map(|rotor| rotor.point_count).sum();
    let covered: f64 = rotors().map(|rotor| rotor.coverage * rotor.point_count as f64).sum();
    let dash = || "–".to_owned();
    let (bias, coverage) = match telemetry.is_right {
        true => (
            format!("{:.3} %", 100.0 * biases.get(biases.len() / 2).copied().unwrap_or(f64::NAN)),
            format!("{:.1} %", 100.0 * covered / points.max(1) as f64),
        ),
        false => (dash(), dash()),
    };
    format!(
        "| {} | {} of {} | {right} of {} | {undecided} | {offset_right} of {offset_count} | {} of {} | {bias} | {coverage} |",
        telemetry.name,
        told.len(),
        all.len(),
        told.len(),
        names.iter().filter(|is_right| **is_right).count(),
        names.len(),
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn right_and_wrong_logs_of_a_flight_are_told_apart() {
        let flight = heard(5).unwrap().unwrap();
        for telemetry in TELEMETRY {
            let compared = compared(&flight, &telemetry, 5).unwrap();
            assert_eq!(compared.found.is_right(), telemetry.is_right, "{telemetry:?}");
        }
    }
}
