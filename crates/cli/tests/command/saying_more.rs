//! Saying more of the vehicle never makes the speed worse: simulated hovers with known speeds, heard by their blades alone, and with more.

use crate::testkit::{flown_hover, hovertone, text};
use hovertone_vehicle::{COVERAGE_FACTOR, RotorSpeed, find_preset};
use serde_json::Value;
use std::fs;
use std::path::Path;

/// `cargo run --release -p hovertone-bench -- saying-more` hears a hundred, and the semi-real recordings.
const SEEDS: std::ops::RangeInclusive<u64> = 1..=4;
const DURATION_S: f64 = 6.0;
const SPREAD_SHARE: f64 = 0.01;
/// The true mean is that of the whole hover, and a part of it is heard: their means differ by this much.
const TRUTH_SHARE: f64 = 0.003;

/// One way of hearing a recording.
struct Heard {
    what: &'static str,
    status: String,
    /// Error of the mean speed, as a share; absent without a speed.
    error_share: Option<f64>,
    /// Standard uncertainty of the mean speed, as a share.
    std_share: f64,
}

impl Heard {
    fn is_right(&self) -> bool {
        self.error_share.is_some_and(|error| error.abs() <= TRUTH_SHARE)
    }

    /// Is the error of `more` at most this error and the ± that was stated with it, and `more` right where this is?
    fn is_no_better_than(&self, more: &Heard) -> bool {
        if self.is_right() && !more.is_right() {
            return false;
        }
        match (self.error_share, more.error_share) {
            (Some(less), Some(error)) => {
                error.abs() <= less.abs() + (COVERAGE_FACTOR * self.std_share).max(TRUTH_SHARE)
            }
            (less, _) => less.is_none(),
        }
    }
}

/// A recording heard by its blades alone, and with more.
fn heard_in_all_ways(folder: &Path, seed: u64) -> Vec<Heard> {
    let (file, truth) = flown_hover(folder, seed, DURATION_S, SPREAD_SHARE);
    let speeds_rad_s: Vec<f64> =
        truth["hover"]["mean_speed_rad_s"].as_array().unwrap().iter().filter_map(Value::as_f64).collect();
    let true_speed = RotorSpeed::from_rad_s(speeds_rad_s.iter().sum::<f64>() / speeds_rad_s.len() as f64);
    let vehicle = find_preset(&file.vehicle.preset).unwrap();
    let blades = vehicle.blade_count.map_or(2, |blades| blades.value).to_string();
    let diameter_m = vehicle.propeller_diameter_m.map(|diameter| diameter.value.to_string());
    let rotors = speeds_rad_s.len().to_string();
    let mut ways: Vec<(&'static str, Vec<&str>)> = vec![
        ("blades", vec!["--blades", &blades]),
        ("blades, rotors", vec!["--blades", &blades, "--rotors", &rotors]),
        ("vehicle", vec!["--vehicle", vehicle.id]),
    ];
    if let Some(diameter_m) = &diameter_m {
        ways.push(("blades, diameter", vec!["--blades", &blades, "--diameter-m", diameter_m]));
        ways.push((
            "blades, rotors, diameter",
            vec!["--blades", &blades, "--rotors", &rotors, "--diameter-m", diameter_m],
        ));
    }
    let sound = folder.join("flown/sound.wav");
    let of_way = |(what, flags): (&'static str, Vec<&str>)| {
        let run = hovertone(&[&["speed", "--json", text(&sound)], flags.as_slice()].concat());
        let line = run.json_lines().remove(0);
        let std = line["combined_std_uncertainty_rev_s"].as_f64();
        Heard {
            what,
            status: line["status"].as_str().unwrap().to_owned(),
            error_share: line["speed_rev_s"].as_f64().map(|speed| speed / true_speed.rev_s() - 1.0),
            std_share: std.unwrap_or(0.0) / true_speed.rev_s(),
        }
    };
    ways.into_iter().map(of_way).collect()
}

/// The ways in which saying more makes it worse: a right answer becomes a wrong one or none, or the error grows by more than the ± stated
/// without it.
fn worse(seeds: impl Iterator<Item = u64>) -> Vec<String> {
    let folder = tempfile::tempdir().unwrap();
    let (mut found, mut right) = (Vec::new(), 0);
    for seed in seeds {
        let place = folder.path().join(seed.to_string());
        let mut ways = heard_in_all_ways(&place, seed).into_iter();
        fs::remove_dir_all(&place).unwrap();
        let alone = ways.next().unwrap();
        right += usize::from(alone.is_right());
        for more in ways {
            let of = |heard: &Heard| match heard.error_share {
                Some(error) => format!("{:+.3} % (u {:.3} %)", 100.0 * error, 100.0 * heard.std_share),
                None => heard.status.clone(),
            };
            let line = format!("seed {seed}: {} {}, {} {}", alone.what, of(&alone), more.what, of(&more));
            println!("{line}");
            found.extend((!alone.is_no_better_than(&more)).then_some(line));
        }
    }
    assert!(right > 0, "no recording is heard right by its blades alone: nothing was compared");
    found
}

#[test]
fn saying_more_never_makes_an_error_larger() {
    let found = worse(SEEDS);
    assert!(found.is_empty(), "{}", found.join("\n"));
}
