//! The most likely step.

use super::beliefs::{Beliefs, PlaceBelief, PlaceValue, beliefs_of};
use super::evaluation::{Cells, Scored};
use super::expected::Expectation;
use super::parameters::{CURVE, RoomCurve};
use super::spectra::StepSpectra;
use nalgebra::DVector;

/// Rounds of scoring, and that before which other curves are tried. *Numeric.*
const ROUNDS: usize = 16;
const HUNT_ROUND: usize = 4;
/// First damping, and its factors after a step that is kept or not. *Numeric.*
const DAMPING: f64 = 1e-2;
const DAMPING_LESS: f64 = 0.2;
const DAMPING_MORE: f64 = 25.0;
/// Largest change in a round: of start, s, ln τ, ln(to/from) and the power of the speed; and of other logarithms. *Numeric.*
const CURVE_CHANGE_MAX: [f64; CURVE] = [0.01, 0.2, 0.03, 1.0];
const CHANGE_MAX: f64 = 1.5;
/// A fit has ended where ln τ, and the start over τ, change by less. *Numeric.*
const ENDED: f64 = 1e-3;
/// Other curves that are tried: starts from earliest to latest, s, and ln τ. A first path stays on the tail of the old speed, so that a step is
/// rather earlier than later. *Numeric.*
const HUNT_STEP_S: f64 = 0.01;
const HUNT_STEPS_EARLIER: i32 = 7;
const HUNT_STEPS_LATER: i32 = 5;
const HUNT_LOGARITHMS: [f64; 7] = [-0.6, -0.4, -0.2, 0.0, 0.2, 0.4, 0.6];
/// True scatter of a step over that by the independence of cells. A line that crosses the resonances of a room slowly fades for several frames.
/// *Decision*: measured on simulated benches in rooms.
const FADING_FACTOR: f64 = 1.75;
/// Standard uncertainty of τ by the shape of the tail, as a share of echoes' power times their time constant: no tail is a pure exponential.
/// *Decision*: measured on the same benches.
const TAIL_SHARE: f64 = 0.1;

/// Where the fit of a step begins.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RoomRequest {
    /// A curve near the step; the spectra are those along it.
    pub curve: RoomCurve,
    /// What is believed of the place.
    pub place: PlaceBelief,
    /// τ of other steps, which is tried too.
    pub other_time_constant_s: Option<f64>,
}

/// A step as heard in a room.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RoomStep {
    /// The curve.
    pub curve: RoomCurve,
    /// Standard uncertainty of the start.
    pub start_std_s: f64,
    /// Standard uncertainty of τ.
    pub time_constant_std_s: f64,
    /// What is believed of the place with this step.
    pub place: PlaceBelief,
}

/// The step near a curve; `None` where there is nothing to fit.
pub fn step_in_room(spectra: &StepSpectra, request: &RoomRequest) -> Option<RoomStep> {
    if spectra.bin_count() == 0 || spectra.orders.is_empty() {
        return None;
    }
    let beliefs = beliefs_of(spectra, &request.curve, &request.place);
    let search = Search { expectation: Expectation::new(spectra, &request.curve), cells: Cells::of(spectra), beliefs };
    let mut best = search.fitted(search.beliefs.mean.clone())?;
    if let Some(other_s) = request.other_time_constant_s {
        let other = search.hunted(&best.unknowns, other_s.ln() - best.unknowns[1], &[0.0]);
        if let Some(other) = search.fitted(other).filter(|other| other.cost < best.cost) {
            best = other;
        }
    }
    let covariance = best.scored.covariance()?;
    let curve = search.expectation.curve(&best.unknowns);
    let std = |at: usize| FADING_FACTOR * covariance[(at, at)].sqrt();
    let [echoes, tail_s, _] = std::array::from_fn(|at| best.unknowns[CURVE + at].exp());
    Some(RoomStep {
        curve,
        start_std_s: std(0),
        time_constant_std_s: (curve.time_constant_s * std(1)).hypot(TAIL_SHARE * echoes * tail_s),
        place: std::array::from_fn(|at| PlaceValue {
            value: best.unknowns[CURVE + at],
            variance: covariance[(CURVE + at, CURVE + at)],
        }),
    })
}

struct Search<'a> {
    expectation: Expectation<'a>,
    cells: Cells,
    beliefs: Beliefs,
}

struct Fitted {
    unknowns: DVector<f64>,
    cost: f64,
    scored: Scored,
}

impl Search<'_> {
    fn cost(&self, unknowns: &DVector<f64>) -> f64 {
        self.cells.cost(&self.expectation.power(unknowns), unknowns, &self.beliefs)
    }

    fn scored(&self, unknowns: &DVector<f64>) -> Scored {
        Scored::at(&self.expectation, &self.cells, unknowns, &self.beliefs)
    }

    /// Fisher's scoring with damping.
    fn fitted(&self, first: DVector<f64>) -> Option<Fitted> {
        let mut now = Fitted { cost: self.cost(&first), scored: self.scored(&first), unknowns: first };
        let mut damping = DAMPING;
        for round in 0..ROUNDS {
            if round == HUNT_ROUND {
                let found = self.hunted(&now.unknowns, 0.0, &HUNT_LOGARITHMS);
                if found != now.unknowns {
                    now = Fitted { cost: self.cost(&found), scored: self.scored(&found), unknowns: found };
                    damping = DAMPING;
                }
            }
            let step = limited(now.scored.step(damping)?);
            let moved = &now.unknowns + &step;
            let cost = self.cost(&moved);
            if cost < now.cost {
                let time_constant_s = moved[1].exp();
                now = Fitted { cost, scored: self.scored(&moved), unknowns: moved };
                damping *= DAMPING_LESS;
                if round > HUNT_ROUND && step[1].abs() < ENDED && step[0].abs() < ENDED * time_constant_s {
                    break;
                }
            } else {
                damping *= DAMPING_MORE;
            }
        }
        Some(now)
    }

    /// The best of several starts and time constants, with all else as it is. `offset` is added to ln τ.
    fn hunted(&self, unknowns: &DVector<f64>, offset: f64, logarithms: &[f64]) -> DVector<f64> {
        let starts = -HUNT_STEPS_EARLIER..=HUNT_STEPS_LATER;
        let all = starts.flat_map(|start| logarithms.iter().map(move |logarithm| (start, logarithm)));
        let tried = all.map(|(start, logarithm)| {
            let mut tried = unknowns.clone();
            tried[0] += HUNT_STEP_S * f64::from(start);
            tried[1] += offset + logarithm;
            (self.cost(&tried), tried)
        });
        tried.min_by(|a, b| a.0.total_cmp(&b.0)).map_or_else(|| unknowns.clone(), |(_, best)| best)
    }
}

/// A step with changes that the model bears.
fn limited(step: DVector<f64>) -> DVector<f64> {
    let shrink = CURVE_CHANGE_MAX.iter().zip(&step).map(|(most, change)| most / change.abs()).fold(1.0, f64::min);
    step.map_with_location(
        |at, _, change| {
            if at < CURVE { change * shrink } else { change.clamp(-CHANGE_MAX, CHANGE_MAX) }
        },
    )
}
