//! A real motor on the bench with two plateaus of speed: is the track on the right one of the rotor's lines?

use super::condition::METHODS;
use super::single_rotor::shown;
use super::track::median;
use crate::document::Document;
use hovertone::speed::{Config, Method, NoTone, Outcome, SpanConfig, ToneConfig, TrackPoint, speed_from_source};
use hovertone_media::{OpenOptions, Recording};
use hovertone_vehicle::Order;
use std::path::{Path, PathBuf};

/// A speed within this share of the right one is right: the plateaus themselves drift by some 0.3 %.
const RIGHT_SHARE: f64 = 0.02;
const BLADES: u32 = 2;

/// A stretch of steady speed, five time constants after the step before it.
struct Plateau {
    from_s: f64,
    to_s: f64,
    blade_pass_hz: f64,
}

/// `motor-step/` in the README of the test recordings; the motor is at speed from 9 s on.
const PLATEAUS: [Plateau; 3] = [
    Plateau { from_s: 9.0, to_s: 12.9, blade_pass_hz: 105.5 },
    Plateau { from_s: 13.3, to_s: 17.9, blade_pass_hz: 183.6 },
    Plateau { from_s: 18.8, to_s: 20.0, blade_pass_hz: 105.4 },
];

/// Says that it is left out where the recording is not there.
pub(super) fn add_real_motor(document: &mut Document, root: &Path) -> Result<(), String> {
    document.heading("A real motor, two plateaus");
    let data = std::env::var_os("HOVERTONE_TEST_DATA").map_or_else(|| root.join("../shared/data"), PathBuf::from);
    let wav = data.join("motor-step/motor_step.wav");
    if !wav.exists() {
        document.paragraph(&format!("Left out: {} is not there.", wav.display()));
        return Ok(());
    }
    document.paragraph(
        "One motor with a two-bladed propeller, 20 s with handling noise and ESC beeps; the second harmonic is stronger than \
         the blade pass on the slow plateaus. `--blades 2` and no other hint. Heard: share of the plateau that the track \
         covers. Right: share of its frames within 2 % of the right speed. First of the recording as a whole, where \
         hovertone keeps the stretch of one speed and says what it cut; then of each plateau with `--from` and `--to`.",
    );
    let (mut rows, mut notes) = (Vec::new(), Vec::new());
    for method in METHODS {
        let whole = track(&wav, method, SpanConfig::default())?.unwrap_or_default();
        for plateau in &PLATEAUS {
            let span = SpanConfig { from_s: Some(plateau.from_s), to_s: Some(plateau.to_s) };
            let alone = track(&wav, method, span)?.unwrap_or_else(|reason| {
                notes.push((
                    shown(method),
                    format!("nothing in {:.1}–{:.1} s alone, {reason}", plateau.from_s, plateau.to_s),
                ));
                Vec::new()
            });
            let mut row = vec![
                shown(method),
                format!("{:.1}–{:.1}", plateau.from_s, plateau.to_s),
                format!("{:.2}", plateau.speed_rev_s()),
            ];
            row.extend(plateau.cells(&whole));
            row.extend(plateau.cells(&alone));
            rows.push(row);
        }
    }
    let heads = ["method", "s", "right rev/s", "whole: heard %", "right %", "alone: heard %", "right %"];
    document.table(&heads, &rows);
    document.notes(notes);
    Ok(())
}

impl Plateau {
    fn speed_rev_s(&self) -> f64 {
        self.blade_pass_hz / f64::from(BLADES)
    }

    /// Share of the plateau that the track covers, and share of its frames there that are right.
    fn cells(&self, track: &[TrackPoint]) -> [String; 2] {
        let steps = track.windows(2).map(|pair| pair[1].time_s - pair[0].time_s).collect();
        let inside: Vec<&TrackPoint> =
            track.iter().filter(|point| (self.from_s..self.to_s).contains(&point.time_s)).collect();
        let heard = median(steps).map_or(0.0, |step_s| inside.len() as f64 * step_s / (self.to_s - self.from_s));
        let is_right = |point: &&&TrackPoint| (point.speed_rev_s / self.speed_rev_s() - 1.0).abs() <= RIGHT_SHARE;
        let right = inside.iter().filter(is_right).count() as f64 / inside.len() as f64;
        let right = if inside.is_empty() { "–".to_owned() } else { format!("{:.0}", 100.0 * right) };
        [format!("{:.0}", 100.0 * heard.min(1.0)), right]
    }
}

/// The inner error is why no rotor tone was found.
fn track(wav: &Path, method: Method, span: SpanConfig) -> Result<Result<Vec<TrackPoint>, NoTone>, String> {
    let order = Order::from_blades(BLADES).map_err(|error| error.to_string())?;
    let tone = ToneConfig { blades: Some(BLADES), ..ToneConfig::of_order(order) };
    let config = Config { method, span, ..Config::for_tone(tone) };
    let mut recording = Recording::open(wav, &OpenOptions::default()).map_err(|error| error.to_string())?;
    let analysis = speed_from_source(&mut recording, &config, &mut |_| {}).map_err(|error| error.to_string())?;
    Ok(match analysis.outcome {
        Outcome::Ok(tone) => Ok(tone.track),
        Outcome::NoRotorTone { reason } => Err(reason),
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_share_heard_and_the_share_right() {
        let point = |time_s: f64, speed_rev_s: f64| TrackPoint {
            time_s,
            tone_hz: 2.0 * speed_rev_s,
            speed_rev_s,
            std_uncertainty_rev_s: 0.1,
            level_db: -20.0,
        };
        let plateau = Plateau { from_s: 1.0, to_s: 3.0, blade_pass_hz: 100.0 };
        let track = [point(0.5, 50.0), point(1.0, 50.9), point(1.5, 51.1), point(2.0, 100.0)];
        assert_eq!(plateau.cells(&track), ["75", "33"]);
        assert_eq!(plateau.cells(&[]), ["0", "–"]);
    }
}
