//! Sounds without a rotor that are made of the recordings, and what is heard in them.

use super::answer::Status;
use super::cases::{Told, TruthSet};
use super::library::{LoadedCase, answer_to};
use super::limits::poisson_upper_limit;
use super::progress::Progress;
use crate::accuracy::drawn;
use crate::document::Document;
use hovertone::sound::{Signal, SignalSource};
use hovertone_fft::ComplexPlanner;
use rand::{RngExt, SeedableRng};
use realfft::num_complex::Complex;
use std::f64::consts::TAU;

/// Sounds with random phases of each recording without a rotor.
const DRAWS: u64 = 8;
/// Shift of all lines of a rotor, in orders of the shaft: no shaft has lines at the orders k + 0.37.
const SHIFT_ORDERS: f64 = 0.37;
const SECONDS_PER_HOUR: f64 = 3600.0;

/// Positive frequencies of a sound as a complex signal: its real part is the sound without its mean.
struct Analytic {
    spectrum: Vec<Complex<f32>>,
    sample_rate_hz: f64,
}

impl Analytic {
    fn of(sound: &Signal) -> Self {
        let mut spectrum: Vec<Complex<f32>> = sound.samples().iter().map(|&sample| Complex::new(sample, 0.0)).collect();
        let length = spectrum.len();
        ComplexPlanner::new().forward(length).process(&mut spectrum);
        let scale = 2.0 / length as f32;
        for (bin, value) in spectrum.iter_mut().enumerate() {
            *value = if bin > 0 && bin < length / 2 { *value * scale } else { Complex::default() };
        }
        Self { spectrum, sample_rate_hz: sound.sample_rate_hz() }
    }

    fn signal(mut self, turn: impl Fn(f64) -> f64) -> Signal {
        let length = self.spectrum.len();
        ComplexPlanner::new().inverse(length).process(&mut self.spectrum);
        let turned = self.spectrum.iter().enumerate().map(|(sample, value)| {
            let angle = TAU * (turn(sample as f64 / self.sample_rate_hz)).fract();
            (value * Complex::from_polar(1.0, angle as f32)).re
        });
        Signal::new(turned.collect(), self.sample_rate_hz)
    }
}

/// The sound with the same spectrum and random phases: noise and steady lines, and nothing that moves.
fn with_random_phases(sound: &Signal, seed: u64) -> Signal {
    let mut rng = rand_pcg::Pcg64::seed_from_u64(seed);
    let mut analytic = Analytic::of(sound);
    for value in &mut analytic.spectrum {
        *value *= Complex::from_polar(1.0, rng.random_range(0.0..std::f32::consts::TAU));
    }
    analytic.signal(|_| 0.0)
}

/// The sound with all frequencies higher by `shift_hz`: lines that move as a rotor does, and that are no harmonics.
fn shifted(sound: &Signal, shift_hz: f64) -> Signal {
    Analytic::of(sound).signal(|time_s| shift_hz * time_s)
}

/// What was heard in sounds of one kind.
struct Heard {
    name: &'static str,
    statuses: Vec<Status>,
    length_s: f64,
}

impl Heard {
    fn cells(&self) -> Vec<String> {
        let count = |status: Status| self.statuses.iter().filter(|heard| **heard == status).count();
        let alarms = count(Status::Ok);
        let per_hour = |count: f64| format!("{:.0}", count / self.length_s * SECONDS_PER_HOUR);
        vec![
            self.name.to_owned(),
            self.statuses.len().to_string(),
            format!("{:.1}", self.length_s / 60.0),
            alarms.to_string(),
            per_hour(alarms as f64),
            per_hour(poisson_upper_limit(alarms)),
            count(Status::Ambiguous).to_string(),
        ]
    }
}

fn heard<'a>(
    name: &'static str,
    sounds: &[(&LoadedCase<'a>, u64)],
    made: impl Fn(&LoadedCase<'a>, u64) -> Signal + Sync,
) -> Result<Heard, String> {
    let progress = Progress::new(name, sounds.len());
    let statuses = drawn(sounds.len(), |number| {
        let (case, seed) = sounds[number];
        let answer = answer_to(made(case, seed), &case.config()?)?;
        progress.step();
        Ok(answer.status)
    })?;
    let length_s = sounds.iter().map(|(case, _)| case.sound.samples().len() as f64 / case.sound.sample_rate_hz()).sum();
    Ok(Heard { name, statuses, length_s })
}

/// The section of the report.
pub(super) fn add_decoys(document: &mut Document, set: &TruthSet) -> Result<(), String> {
    let cases = LoadedCase::all(set, |told| told == Told::Blades)?;
    let (silent, sounding): (Vec<_>, Vec<_>) = cases.iter().partition(|case| case.case.truth.kind == "negative");
    let draws: Vec<_> = silent.iter().flat_map(|case| (0..DRAWS).map(|seed| (*case, seed))).collect();
    let once: Vec<_> = sounding.iter().map(|case| (*case, 0)).collect();
    let of_rotors = |case: &LoadedCase<'_>| {
        let speeds = &case.case.truth.speeds_rev_s;
        let speed_rev_s = speeds.iter().sum::<f64>() / speeds.len().max(1) as f64;
        shifted(&case.sound, SHIFT_ORDERS * speed_rev_s)
    };
    document.paragraph(&format!(
        "Decoys, heard with the blades alone: each trusted recording without a rotor with {DRAWS} draws of random phases, which keep its spectrum \
         and nothing that moves; and each trusted recording of a rotor with all frequencies shifted by {SHIFT_ORDERS} of its shaft speed, so that \
         its lines move as a rotor's lines do and are no harmonics."
    ));
    let rows = [
        heard("random phases", &draws, |case, seed| with_random_phases(&case.sound, seed))?,
        heard("shifted rotors", &once, |case, _| of_rotors(case))?,
    ];
    let heads = ["decoy", "sounds", "minutes", "false alarms", "per hour", "95 % limit per hour", "ambiguous"];
    document.table(&heads, &rows.iter().map(Heard::cells).collect::<Vec<_>>());
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn sine(hz: f64) -> Signal {
        Signal::new((0..8000).map(|n| (TAU * hz * f64::from(n) / 8000.0).cos() as f32).collect(), 8000.0)
    }

    fn power_at(sound: &Signal, hz: f64) -> f64 {
        let turned =
            sound.samples().iter().enumerate().map(|(n, &sample)| {
                Complex::from_polar(f64::from(sample), -TAU * hz * n as f64 / sound.sample_rate_hz())
            });
        (turned.sum::<Complex<f64>>() * 2.0 / sound.samples().len() as f64).norm_sqr()
    }

    #[test]
    fn a_shift_moves_lines_and_random_phases_do_not() {
        let moved = shifted(&sine(1000.0), 37.0);
        assert!((power_at(&moved, 1037.0) - 1.0).abs() < 1e-3 && power_at(&moved, 1000.0) < 1e-6);
        let random = with_random_phases(&sine(1000.0), 1);
        assert!((power_at(&random, 1000.0) - 1.0).abs() < 1e-3);
        assert_ne!(random.samples()[0], sine(1000.0).samples()[0]);
    }
}
