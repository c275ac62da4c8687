//! The most likely step.

use super::evaluation::{Cells, Scored};
use super::expected::Expectation;
use super::parameters::{Beliefs, CURVE, GAINS, Layout, NOISE_KNOTS, PLACE, RoomCurve, SHARES};
use super::spectra::StepSpectra;
use hovertone_signal::statistics::median;
use nalgebra::DVector;

/// Rounds of scoring. *Numeric.*
const ROUNDS: usize = 16;
/// First damping, and its factor after a step that is kept or not. *Numeric.*
const DAMPING: f64 = 1e-2;
const DAMPING_FACTOR: f64 = 5.0;
/// Largest change of an unknown in a round. *Numeric.*
const CHANGE_MAX: f64 = 1.5;
const CURVE_CHANGE_MAX: [f64; CURVE] = [0.01, 0.2, 0.03, 1.0];
/// A fit has ended where ln τ changes by less. *Numeric.*
const ENDED: f64 = 1e-3;
/// Standard deviations of beliefs: start, s; ln τ; ln(to/from); power of the speed; logarithms of powers; gains, from the fading of a room.
/// *Decision*: all wide.
const CURVE_STD: [f64; CURVE] = [0.05, 1.0, 0.1, 2.0];
const POWER_STD: f64 = 3.0;
const GAIN_STD: f64 = 1.0;
/// Echoes, time constant of their tail and time of the first one before anything is heard: logarithms and their standard deviations. *Decision.*
const PLACE_MEAN: [f64; PLACE] = [-1.0, -3.5, -4.5];
const PLACE_STD: [f64; PLACE] = [2.0, 0.5, 0.5];
/// Power of the speed with which lines get louder, before anything is heard: dipoles. *Physics.*
const LOUDER: f64 = 5.0;

/// A logarithm that is believed of a place.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PlaceValue {
    /// The logarithm.
    pub value: f64,
    /// Its variance.
    pub variance: f64,
}

/// What is believed of a place before anything is heard.
pub fn any_place() -> [PlaceValue; PLACE] {
    std::array::from_fn(|at| PlaceValue { value: PLACE_MEAN[at], variance: PLACE_STD[at].powi(2) })
}

/// What the steps of a recording tell of their place: the information of each, less that of what was believed before it.
pub fn place_of<'a>(steps: impl Iterator<Item = &'a RoomStep> + Clone) -> [PlaceValue; PLACE] {
    let prior = any_place();
    std::array::from_fn(|at| {
        let (mut weights, mut products) = (prior[at].variance.recip(), prior[at].value / prior[at].variance);
        for step in steps.clone() {
            let of_all = step.place[at].variance.recip();
            let own = (of_all - prior[at].variance.recip()).max(0.0);
            weights += own;
            products += of_all * step.place[at].value - (of_all - own) * prior[at].value;
        }
        PlaceValue { value: products / weights, variance: weights.recip() }
    })
}

/// A step as heard in a room.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RoomStep {
    /// When the speed begins to change.
    pub start_s: f64,
    /// Its standard uncertainty.
    pub start_std_s: f64,
    /// τ.
    pub time_constant_s: f64,
    /// Standard uncertainty of ln τ.
    pub time_constant_std_share: f64,
    /// Speed behind the step over that before.
    pub ratio: f64,
    /// Logarithms of the power of early reflections and of the tail over that of the direct sound, and of the time constant of the tail.
    pub place: [PlaceValue; PLACE],
    /// Minus the logarithm of likelihood times belief.
    pub cost: f64,
    /// Whether the fit came to an end.
    pub is_settled: bool,
}

/// The step whose curve is near the given one; `None` where there is nothing to fit.
pub fn step_in_room(
    spectra: &StepSpectra,
    start_s: f64,
    time_constant_s: f64,
    from_rev_s: f64,
    to_rev_s: f64,
    place: &[PlaceValue; PLACE],
) -> Option<RoomStep> {
    if spectra.bin_count() == 0 {
        return None;
    }
    let first = RoomCurve { start_s, time_constant_s, from_rev_s, to_rev_s };
    let expectation = Expectation::new(spectra, &first);
    let cells = Cells::of(spectra);
    let beliefs = beliefs_of(spectra, &first, place);
    let mut unknowns = beliefs.mean.clone();
    let mut cost = cells.cost(&expectation.power(&unknowns), &unknowns, &beliefs);
    let (mut damping, mut is_settled) = (DAMPING, false);
    let mut scored = Scored::at(&expectation, &cells, &unknowns, &beliefs);
    for round in 0..ROUNDS {
        if round == HUNT_ROUND {
            let found = hunted(&expectation, &cells, &unknowns, &beliefs);
            let found_cost = cells.cost(&expectation.power(&found), &found, &beliefs);
            if found_cost < cost {
                if std::env::var("ROOM").is_ok() {
                    eprintln!("hunt {:.4} {:.1} -> {:.4} {:.1}: {}", unknowns[0], 1e3*unknowns[1].exp(), found[0], 1e3*found[1].exp(), cost - found_cost);
                }
                (unknowns, cost) = (found, found_cost);
                scored = Scored::at(&expectation, &cells, &unknowns, &beliefs);
                damping = DAMPING;
            }
        }
        let step = limited(scored.step(damping)?);
        let moved = &unknowns + &step;
        let moved_cost = cells.cost(&expectation.power(&moved), &moved, &beliefs);
        if moved_cost < cost {
            (unknowns, cost) = (moved, moved_cost);
            damping /= DAMPING_FACTOR;
            scored = Scored::at(&expectation, &cells, &unknowns, &beliefs);
            if step[1].abs() < ENDED && step[0].abs() < ENDED * time_constant_s {
                is_settled = true;
                break;
            }
        } else {
            damping *= DAMPING_FACTOR * DAMPING_FACTOR;
        }
    }
    let mut none = unknowns.clone();
    none[2] = 0.0;
    let none_cost = cells.cost(&expectation.power(&none), &none, &beliefs);
    let covariance = scored.covariance()?;
    let curve = expectation.curve(&unknowns);
    Some(RoomStep {
        start_s: curve.start_s,
        start_std_s: covariance[(0, 0)].sqrt(),
        time_constant_s: curve.time_constant_s,
        time_constant_std_share: covariance[(1, 1)].sqrt(),
        ratio: curve.to_rev_s / curve.from_rev_s,
        place: std::array::from_fn(|at| {
            let unknown = CURVE + at;
            PlaceValue { value: unknowns[unknown], variance: covariance[(unknown, unknown)] }
        }),
        cost: none_cost - cost,
        is_settled,
    })
}

const HUNT_ROUND: usize = 4;
const HUNT_STARTS_S: [f64; 13] = [-0.07, -0.06, -0.05, -0.04, -0.03, -0.02, -0.01, 0.0, 0.01, 0.02, 0.03, 0.04, 0.05];
const HUNT_LOGARITHMS: [f64; 7] = [-0.6, -0.4, -0.2, 0.0, 0.2, 0.4, 0.6];

/// The best of starts and time constants, with all else as it is.
fn hunted(expectation: &Expectation, cells: &Cells, unknowns: &DVector<f64>, beliefs: &Beliefs) -> DVector<f64> {
    let moved = |start_s: f64, logarithm: f64| {
        let mut moved = unknowns.clone();
        moved[0] += start_s;
        moved[1] += logarithm;
        (cells.cost(&expectation.power(&moved), &moved, beliefs), moved)
    };
    let all = HUNT_STARTS_S.iter().flat_map(|start_s| HUNT_LOGARITHMS.iter().map(move |logarithm| moved(*start_s, *logarithm)));
    all.min_by(|a, b| a.0.total_cmp(&b.0)).map_or_else(|| unknowns.clone(), |(_, best)| best)
}

fn limited(step: DVector<f64>) -> DVector<f64> {
    let shrink = CURVE_CHANGE_MAX.iter().zip(&step).map(|(most, change)| most / change.abs()).fold(1.0, f64::min);
    let is_curve = |at: usize| at < CURVE;
    step.map_with_location(|at, _, change| {
        if is_curve(at) { change * shrink } else { change.clamp(-CHANGE_MAX, CHANGE_MAX) }
    })
}

fn beliefs_of(spectra: &StepSpectra, first: &RoomCurve, place: &[PlaceValue; PLACE]) -> Beliefs {
    let layout = Layout::of(spectra);
    let mut mean = DVector::zeros(layout.count());
    let mut std = DVector::from_element(layout.count(), POWER_STD);
    mean[0] = first.start_s;
    mean[1] = first.time_constant_s.ln();
    mean[3] = LOUDER;
    mean[2] = (first.to_rev_s / first.from_rev_s).ln();
    for (at, of_curve) in CURVE_STD.into_iter().enumerate() {
        std[at] = of_curve;
    }
    let mean_power: Vec<f64> = (0..spectra.bin_count())
        .map(|bin| spectra.frames.iter().map(|frame| frame.power[bin]).sum::<f64>() / spectra.frames.len() as f64)
        .collect();
    let floor = median(&mean_power).unwrap_or(1.0).max(f64::MIN_POSITIVE);
    for (line, order) in spectra.orders.iter().enumerate() {
        let bin = (order * spectra.turns).round() as usize - spectra.first_bin;
        let near = &mean_power[bin.saturating_sub(2)..(bin + 3).min(mean_power.len())];
        let highest = near.iter().copied().fold(0.3 * floor, f64::max);
        for share in 0..SHARES.len() {
            mean[layout.power(line, share)] = (highest / SHARES.len() as f64).ln();
        }
        for knot in 0..GAINS {
            std[layout.gain(line, knot)] = GAIN_STD;
        }
    }
    for (at, belief) in place.iter().enumerate() {
        mean[CURVE + at] = belief.value;
        std[CURVE + at] = belief.variance.sqrt();
    }
    for knot in 0..NOISE_KNOTS {
        for side in 0..2 {
            mean[layout.noise(knot, side)] = (0.5 * floor).ln();
        }
    }
    Beliefs { mean, precision: std.map(|std: f64| std.powi(-2)) }
}
