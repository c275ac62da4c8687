//! Recordings that begin with the motors' start, one after the other: their sound, with the truth known.

use super::Count;
use crate::accuracy::drawn;
use hovertone::rotors::{LabelsConfig, RotorLabels, labels_from_spin_up, passes_of_spin_up, speed_after_spin_up};
use hovertone::sound::{Passes, Signal};
use hovertone::speed::{Config, Error, Method, Outcome, ToneConfig};
use hovertone_vehicle::Order;
use rand::seq::SliceRandom;
use rand::{RngExt, SeedableRng};
use rand_distr::{Distribution, StandardNormal};
use rand_pcg::Pcg64;
use std::f64::consts::TAU;

const RATE_HZ: f64 = 16000.0;
const LENGTH_S: f64 = 16.0;

/// How motors are started.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Start {
    /// One after the other, 0.9 to 2 s apart, straight to within 1 % of the hover's speed, to which all go then.
    InOrder,
    /// As before, but each within 2.5 % of its speed in the hover, so that rotors have the speeds of others.
    NearHover,
    /// As before, but all at once go to the hover, which is 2 to 5 % faster: as far as rotors are apart.
    Shifted,
    /// As before, but the hover is 12 % faster, and all go there at once.
    FarFromHover,
    /// All within a tenth of a second.
    Together,
    /// Two by two.
    InPairs,
    /// They turn when the recording begins.
    Before,
    /// They idle in one order, at six tenths of the speed, and come up to it in another.
    IdleFirst,
}

impl Start {
    /// All, with words for a table.
    pub(super) const ALL: [(Self, &'static str); 8] = [
        (Self::InOrder, "one after the other"),
        (
            Self::NearHover,
            "to within 2.5 % of its speed in the hover, each for itself, and then there at once (within 0.05 to 0.4 s)",
        ),
        (Self::Shifted, "2 to 5 % below the hover, and then there at once"),
        (Self::FarFromHover, "12 % below the hover, and then there at once"),
        (Self::IdleFirst, "idling at 60 % in another order before (right: in the order in which they come up)"),
        (Self::InPairs, "two by two"),
        (Self::Together, "all within 0.3 s"),
        (Self::Before, "before the recording begins"),
    ];
}

/// A rotor: its speed in the hover, and changes of it: from when on it goes to which share, within about 0.1 s or so.
struct Rotor {
    hover_rev_s: f64,
    changes: Vec<(f64, f64, f64)>,
}

fn rotors(start: Start, rng: &mut Pcg64) -> Vec<Rotor> {
    let slowest = rng.random_range(55.0..85.0);
    let mut speeds: Vec<f64> = Vec::new();
    for rotor in 0..4 {
        let above = if rotor == 0 { 0.0 } else { rng.random_range(0.015..0.04) };
        speeds.push(speeds.last().copied().unwrap_or(slowest) * (1.0 + above));
    }
    // the order of the starts has nothing to do with that of the speeds
    speeds.shuffle(rng);
    let mut at_s = rng.random_range(0.8..1.5);
    let mut starts = Vec::new();
    for rotor in 0..4 {
        starts.push(at_s);
        at_s += match start {
            Start::Together => rng.random_range(0.0..0.1),
            Start::InPairs if rotor % 2 == 0 => rng.random_range(0.0..0.1),
            _ => rng.random_range(0.9..2.0),
        };
    }
    let hover_s = at_s + 0.5;
    let common = rng.random_range(-0.01..0.01);
    let (shift, shift_s) = (rng.random_range(0.02..0.05), rng.random_range(0.03..0.3));
    let mut second: Vec<usize> = vec![1, 3, 0, 2];
    second.shuffle(rng);
    let rotor = |(rotor, hover_rev_s): (usize, f64)| {
        let run_up_s = rng.random_range(0.05..0.12);
        let first = 1.0 + common + rng.random_range(-0.003..0.003);
        let changes = match start {
            Start::NearHover => {
                let near = 1.0 + rng.random_range(-0.025..0.025);
                vec![(starts[rotor], near, run_up_s), (hover_s, 1.0, rng.random_range(0.05..0.4))]
            }
            Start::Shifted => vec![(starts[rotor], first - shift, run_up_s), (hover_s, 1.0, shift_s)],
            Start::Before => vec![(-10.0, first, run_up_s)],
            Start::FarFromHover => vec![(starts[rotor], 0.88 * first, run_up_s), (hover_s, 1.0, 0.1)],
            Start::IdleFirst => {
                vec![(0.3 + 0.5 * second[rotor] as f64, 0.6, run_up_s), (starts[rotor] + 2.0, 1.0, run_up_s)]
            }
            _ => vec![(starts[rotor], first, run_up_s), (hover_s, 1.0, 0.5)],
        };
        Rotor { hover_rev_s, changes }
    };
    speeds.into_iter().enumerate().map(rotor).collect()
}

/// Blade pass and harmonics of four rotors that wander by 0.1 %, in noise.
fn sound(rotors: &[Rotor], rng: &mut Pcg64) -> Vec<f32> {
    let count = (LENGTH_S * RATE_HZ) as usize;
    let mut samples = vec![0.0; count];
    for rotor in rotors {
        let (mut wander, keep) = (0.0, (-1.0 / (0.6 * RATE_HZ)).exp());
        let (mut share, mut turns) = (0.0, 0.0);
        let mut path: Vec<(f64, f64)> = Vec::with_capacity(count);
        for n in 0..count {
            let time_s = n as f64 / RATE_HZ;
            let change = rotor.changes.iter().rev().find(|(at_s, ..)| time_s >= *at_s);
            if let Some((_, to, lag_s)) = change {
                share += (to - share) / (lag_s * RATE_HZ);
            }
            let normal: f64 = StandardNormal.sample(rng);
            wander = keep * wander + 0.001 * (1.0 - keep * keep).sqrt() * normal;
            turns += rotor.hover_rev_s * share * (1.0 + wander) / RATE_HZ;
            path.push((turns, share));
        }
        for harmonic in 1..=20 {
            let spread_db: f64 = StandardNormal.sample(rng);
            let level = 2.0 * f64::from(harmonic).powf(-0.7) * 10f64.powf(3.0 * spread_db / 20.0);
            let (order, phase) = (2.0 * f64::from(harmonic), rng.random_range(0.0..TAU));
            for (sample, (turns, share)) in samples.iter_mut().zip(&path) {
                // radiated sound grows with the fifth power of the speed
                *sample += level * share.powf(2.5) * (TAU * (order * turns).fract() + phase).cos();
            }
        }
    }
    let noise = |rng: &mut Pcg64| -> f64 { StandardNormal.sample(rng) };
    samples.into_iter().map(|sample| (0.003 * (sample + 0.7 * noise(rng))) as f32).collect()
}

/// What the labels are, and which rotor each track is; `None` where no rotor is heard.
fn labelled(start: Start, seed: u64) -> Result<Option<(RotorLabels, Vec<usize>)>, String> {
    let mut rng = Pcg64::seed_from_u64(seed);
    let rotors = rotors(start, &mut rng);
    let samples = sound(&rotors, &mut rng);
    let order = Order::from_blades(2).map_err(|error| error.to_string())?;
    let mut config = Config::for_tone(ToneConfig::of_order(order));
    (config.rotors.count, config.method) = (4, Method::Separated);
    let mut signal = Signal::new(samples, RATE_HZ);
    let on_progress = &mut |_| {};
    let (analysis, spin_up) = Passes::planned(&mut signal, passes_of_spin_up(&config), on_progress)
        .map_err(Error::from)
        .and_then(|mut passes| speed_after_spin_up(&mut passes, &config))
        .map_err(|error| error.to_string())?;
    let Outcome::Ok(tone) = &analysis.outcome else { return Ok(None) };
    let names: Vec<(usize, String)> = (1..=4).map(|number| (number, format!("motor {number}"))).collect();
    let labels = labels_from_spin_up(&spin_up, tone.rotors.len(), &names, &LabelsConfig::default());
    let nearest = |speed_rev_s: f64| {
        let off = |rotor: &usize| (rotors[*rotor].hover_rev_s - speed_rev_s).abs();
        (0..4).min_by(|a, b| off(a).total_cmp(&off(b))).unwrap_or(0)
    };
    let truth = tone.rotors.iter().map(|rotor| nearest(rotor.speed.speed.rev_s())).collect();
    Ok(Some((labels, truth)))
}

/// Labels the rotors of so many recordings.
pub(super) fn by_spin_up(start: Start, count: usize) -> Result<Count, String> {
    let outcomes = drawn(count, |seed| labelled(start, seed as u64))?;
    let mut counted = Count::default();
    for outcome in outcomes {
        match outcome {
            Some((labels, truth)) if truth.len() == 4 => counted.add(&labels, &truth, 0.0),
            _ => counted.flights += 1,
        }
    }
    Ok(counted)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Three quarters are told: of twelve at that rate, seven or more with a probability of 0.95.
    #[test]
    fn rotors_started_one_after_the_other_are_named_or_not_told() {
        let count = by_spin_up(Start::InOrder, 12).unwrap();
        assert!(count.flights == 12 && count.right >= 7 && count.wrong == 0, "{count:?}");
    }

    #[test]
    fn starts_that_tell_nothing_are_refused() {
        for start in [Start::Together, Start::InPairs, Start::Before, Start::FarFromHover] {
            let count = by_spin_up(start, 4).unwrap();
            assert_eq!((count.flights, count.right, count.wrong), (4, 0, 0), "{start:?}");
        }
        for start in [Start::IdleFirst, Start::NearHover, Start::Shifted] {
            assert_eq!(by_spin_up(start, 4).unwrap().wrong, 0, "{start:?}");
        }
    }
}
