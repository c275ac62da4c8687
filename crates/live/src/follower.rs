//! Follows a heard rotor, or several that move alike, from frame to frame.
//!
//! The lines of all rotors make a pattern over the logarithm of the speed, which a review gives: the mean of the scores of its frames, each
//! shifted by the speed that the review found there. In each later frame the shift of the pattern is the most probable one by the likeness of
//! the scores to the pattern, and by the shift before: a motor may change its speed at any time, but seldom does.

use crate::comb::{Comb, Lines};
use crate::steady_mean::{MeanSpeed, SteadyMean};
use hovertone_signal::spectrogram::{Stft, Window};

/// Length of a frame: most rotors in flight are clearest in 0.1 s. *Decision.*
const FRAME_S: f64 = 0.1;
/// Step between frames. *Numeric.*
pub(crate) const HOP_S: f64 = 0.025;
/// Hops in a frame. *Numeric.*
const HOPS_PER_FRAME: usize = 4;
/// Zero padding of the transforms. *Numeric.*
const ZERO_PAD_FACTOR: u32 = 4;
/// Step of the logarithm of the speed: a fifth of the width of the twentieth line of a fast rotor. *Numeric.*
const STEP: f64 = 5e-4;
/// Steps on either side of the middle of the grid: 25 %. *Numeric.*
const HALF_GRID: usize = 500;
/// Steps on either side of the middle of the pattern: rotors of one vehicle are up to 11 % from their mean. *Physics.*
const HALF_PATTERN: usize = 220;
/// Shifts on either side of 0 at which the whole pattern is on the grid. *Numeric.*
const HALF_SHIFTS: usize = HALF_GRID - HALF_PATTERN;
/// The grid moves after the pattern once that is further from the middle. *Numeric.*
const RECENTRE_SHIFTS: isize = 100;
/// Scale of the change of the speed from frame to frame, in steps: 0.3 %, as rotors wander. Larger changes cost the logarithm of their square, so
/// that a motor may step. *Decision.*
const CHANGE_STEPS: f64 = 6.0;
/// Largest difference between the beliefs in two shifts that is kept, in nats: what is less probable may become the truth again. *Numeric.*
const BELIEF_RANGE: f64 = 60.0;
/// Frames over which the height of the pattern is a mean: 0.3 s. *Decision.*
const HEIGHT_FRAMES: f64 = 12.0;
/// A rotor is lost where its pattern stands no higher than this share of its height at the review. *Decision.*
const HEIGHT_SHARE_MIN: f64 = 0.3;

/// A change of the speed from frame to frame by more than so many steps is that of a motor: 3 %. *Decision.*
const STEP_SHIFTS_MIN: usize = 60;

/// The odd lines stand as high beside the pattern as at the review, or no lower than this share of it: at half of a new speed, only the line
/// of its shaft is among them. *Decision.*
const ODD_SHARE_MIN: f64 = 0.5;
/// Height of the odd lines at a review, in nats, from which they tell anything: e to one. *Decision.*
const ODD_NATS_MIN: f64 = 1.0;

const SHIFTS: usize = 2 * HALF_SHIFTS + 1;

/// A speed over time at the review, by which the frames are shifted.
pub(crate) trait SpeedAt {
    /// The speed at a time; `None` where the review has none.
    fn speed_rev_s_at(&self, time_s: f64) -> Option<f64>;

    /// Its standard uncertainty.
    fn std_uncertainty_rev_s_at(&self, time_s: f64) -> Option<f64>;

    /// The mean speed of all rotors.
    fn mean_rev_s(&self) -> f64;
}

/// The state of following. It takes no more memory after its start.
pub(crate) struct Follower {
    stft: Stft<f32>,
    pattern: Pattern,
    mean: SteadyMean,
    /// Mean height of the pattern over the last frames, and at the review.
    height: f64,
    review_height: f64,
    /// The same of the odd lines, over the gaps between lines.
    odd_height: f64,
    review_odd_height: f64,
    /// Mean speed in the review over that of the pattern: the middle of the lines of rotors that are not told apart is not their mean.
    scale: f64,
    /// Standard uncertainty of an answer: how far answers over the sound of the review are from the speed that the review found at those moments.
    answer_std_rev_s: f64,
}

/// Sums over answers a and the speeds s of the review at the same moments.
#[derive(Default)]
struct Misses {
    count: f64,
    answers: f64,
    products: f64,
    speeds: f64,
    variances: f64,
}

impl Misses {
    fn add(&mut self, answer_rev_s: f64, speed_rev_s: f64, std_rev_s: f64) {
        self.count += 1.0;
        self.answers += answer_rev_s * answer_rev_s;
        self.products += answer_rev_s * speed_rev_s;
        self.speeds += speed_rev_s * speed_rev_s;
        self.variances += std_rev_s * std_rev_s;
    }

    /// Root of the mean square of `scale a − s`, with the uncertainty of s.
    fn std_rev_s(&self, scale: f64) -> f64 {
        let squares = scale * scale * self.answers - 2.0 * scale * self.products + self.speeds;
        ((squares.max(0.0) + self.variances) / self.count.max(1.0)).sqrt()
    }
}

impl Follower {
    /// Learns the pattern of the rotors from the sound of a review, and follows them to the end of that sound. `None` where the review has no
    /// speed in any frame.
    pub(crate) fn of_review(
        sound: &[f32],
        start_s: f64,
        sample_rate_hz: f64,
        order: f64,
        speeds: &dyn SpeedAt,
    ) -> Option<Self> {
        let mut stft = Stft::new(sample_rate_hz, Window::Hann, FRAME_S, HOP_S, ZERO_PAD_FACTOR);
        let mut at_review = Vec::new();
        stft.restart(start_s);
        stft.push(sound, |frame| at_review.extend(speeds.speed_rev_s_at(frame.centre_s)));
        let slowest_rev_s = at_review.iter().copied().reduce(f64::min)?;
        let mut pattern = Pattern::new(slowest_rev_s, order, stft.bin_hz(), sample_rate_hz);
        stft.restart(start_s);
        stft.push(sound, |frame| {
            if let Some(speed_rev_s) = speeds.speed_rev_s_at(frame.centre_s) {
                pattern.learn(frame.power, speed_rev_s);
            }
        });
        pattern.start(at_review[0]);
        let mut follower = Self {
            stft,
            pattern,
            mean: SteadyMean::new(HOPS_PER_FRAME),
            height: 0.0,
            review_height: 0.0,
            odd_height: 0.0,
            review_odd_height: 0.0,
            scale: 1.0,
            answer_std_rev_s: 0.0,
        };
        let mut misses = Misses::default();
        let (mut heights, mut odd_heights, mut followed_rev_s) = (0.0, 0.0, 0.0);
        follower.stft.restart(start_s);
        follower.push_with(sound, &mut |centre_s, seen, answer| {
            // an answer is for the end of its last frame
            let now_s = centre_s + FRAME_S / 2.0;
            if let (Some(answer), Some(speed_rev_s), Some(std_rev_s)) =
                (answer, speeds.speed_rev_s_at(now_s), speeds.std_uncertainty_rev_s_at(now_s))
            {
                misses.add(answer.speed_rev_s, speed_rev_s, std_rev_s);
            }
            if speeds.speed_rev_s_at(centre_s).is_some() {
                heights += seen.height;
                odd_heights += seen.odd_height;
                followed_rev_s += seen.speed_rev_s;
            }
        });
        let frames = at_review.len() as f64;
        (follower.review_height, follower.review_odd_height) = (heights / frames, odd_heights / frames);
        follower.scale = speeds.mean_rev_s() * frames / followed_rev_s;
        follower.answer_std_rev_s = misses.std_rev_s(follower.scale);
        Some(follower)
    }

    /// Takes in the next samples. Allocates nothing.
    pub(crate) fn push(&mut self, samples: &[f32]) {
        self.push_with(samples, &mut |_, _, _| {});
    }

    fn push_with(&mut self, samples: &[f32], on_seen: &mut dyn FnMut(f64, SeenPattern, Option<MeanSpeed>)) {
        let Self { stft, pattern, mean, height, odd_height, .. } = self;
        stft.push(samples, |frame| {
            let seen = pattern.follow(frame.power);
            mean.push(seen.speed_rev_s);
            // the heights before a step say nothing about the speed after it
            if seen.is_step {
                (*height, *odd_height) = (seen.height, seen.odd_height);
            }
            *height += (seen.height - *height) / HEIGHT_FRAMES;
            *odd_height += (seen.odd_height - *odd_height) / HEIGHT_FRAMES;
            on_seen(frame.centre_s, seen, mean.last());
        });
    }

    /// The speed now. `None` where the rotors are lost.
    pub(crate) fn now(&mut self) -> Option<MeanSpeed> {
        if self.is_lost() {
            return None;
        }
        let MeanSpeed { speed_rev_s, std_uncertainty_rev_s, frame_count } = self.mean.now()?.scaled(self.scale);
        let std_uncertainty_rev_s = std_uncertainty_rev_s.max(self.answer_std_rev_s);
        Some(MeanSpeed { speed_rev_s, std_uncertainty_rev_s, frame_count })
    }

    /// Whether the rotors are no longer heard, or only the even half of their lines: then they turn at twice the followed speed, after a step.
    pub(crate) fn is_lost(&self) -> bool {
        let has_odd_lines = self.review_odd_height > ODD_NATS_MIN;
        self.height < HEIGHT_SHARE_MIN * self.review_height
            || has_odd_lines
                && self.odd_height * self.review_height < ODD_SHARE_MIN * self.review_odd_height * self.height
    }
}

/// Raises each belief to what is left of the one it comes from.
fn raise(to: &mut [f64], from: &[f64], cost: f64) {
    for (to, from) in to.iter_mut().zip(from) {
        let left = from - cost;
        if left > *to {
            *to = left;
        }
    }
}

/// The pattern of the lines and its most probable shift.
struct Pattern {
    comb: Comb,
    /// Speed in the middle of the grid.
    middle_rev_s: f64,
    /// Scores of the speeds of the grid in this frame.
    scores: Vec<f64>,
    /// Weights of the pattern, with the sum 1.
    weights: Vec<f64>,
    likeness: Vec<f64>,
    belief: Vec<f64>,
    next_belief: Vec<f64>,
    /// The most probable shift in the last frame.
    best: usize,
    /// Cost of a change by so many steps.
    change_nats: Vec<f64>,
}

/// What a frame shows of the pattern.
#[derive(Clone, Copy, Debug)]
struct SeenPattern {
    speed_rev_s: f64,
    /// Likeness over its mean over all shifts, in nats.
    height: f64,
    /// The odd lines of the pattern over the gaps between lines, in nats.
    odd_height: f64,
    /// Whether the speed is far from that of the frame before.
    is_step: bool,
}

impl Pattern {
    fn new(slowest_rev_s: f64, order: f64, bin_hz: f64, sample_rate_hz: f64) -> Self {
        let lines = Lines::new(order, slowest_rev_s, sample_rate_hz);
        let change = |steps: usize| (steps as f64 / CHANGE_STEPS).powi(2).ln_1p();
        Self {
            comb: Comb::new(lines, bin_hz, slowest_rev_s),
            middle_rev_s: slowest_rev_s,
            scores: vec![0.0; 2 * HALF_GRID + 1],
            weights: vec![0.0; 2 * HALF_PATTERN + 1],
            likeness: vec![0.0; SHIFTS],
            belief: vec![0.0; SHIFTS],
            next_belief: vec![0.0; SHIFTS],
            best: HALF_SHIFTS,
            change_nats: (0..SHIFTS).map(change).collect(),
        }
    }

    fn speed_rev_s(&self, steps: f64) -> f64 {
        self.middle_rev_s * (STEP * steps).exp()
    }

    fn score_all(&mut self, power: &[f64]) {
        self.comb.take(power);
        let middle = HALF_GRID as f64;
        for place in 0..self.scores.len() {
            self.scores[place] = self.comb.score(self.speed_rev_s(place as f64 - middle));
        }
    }

    /// Adds a frame at a known speed to the pattern.
    fn learn(&mut self, power: &[f64], speed_rev_s: f64) {
        self.comb.take(power);
        for (place, weight) in self.weights.iter_mut().enumerate() {
            let steps = place as f64 - HALF_PATTERN as f64;
            *weight += self.comb.score(speed_rev_s * (STEP * steps).exp());
        }
    }

    /// The pattern is what stands above the median of the mean scores. Following begins at a speed.
    fn start(&mut self, speed_rev_s: f64) {
        let mut sorted = self.weights.clone();
        sorted.sort_by(f64::total_cmp);
        let median = sorted[sorted.len() / 2];
        self.weights.iter_mut().for_each(|weight| *weight = (*weight - median).max(0.0));
        let sum: f64 = self.weights.iter().sum::<f64>().max(f64::MIN_POSITIVE);
        self.weights.iter_mut().for_each(|weight| *weight /= sum);
        self.middle_rev_s = speed_rev_s;
        self.belief.fill(-BELIEF_RANGE);
        self.belief[HALF_SHIFTS] = 0.0;
    }

    /// The shift of the pattern in the next frame.
    fn follow(&mut self, power: &[f64]) -> SeenPattern {
        self.score_all(power);
        self.likeness.fill(0.0);
        // half of the pattern, its median and what is below, has no weight
        for (offset, &weight) in self.weights.iter().enumerate().filter(|(_, weight)| **weight > 0.0) {
            let scores = &self.scores[offset..];
            self.likeness.iter_mut().zip(scores).for_each(|(likeness, score)| *likeness += score * weight);
        }
        self.believe();
        let best = highest(&self.belief);
        let shift = best as f64 - HALF_SHIFTS as f64 + vertex(&self.likeness, best);
        let mean = self.likeness.iter().sum::<f64>() / SHIFTS as f64;
        let is_step = best.abs_diff(self.best) > STEP_SHIFTS_MIN;
        let seen = SeenPattern {
            speed_rev_s: self.speed_rev_s(shift),
            height: self.likeness[best] - mean,
            odd_height: self.odd_height(best),
            is_step,
        };
        self.best = best;
        self.recentre(best as isize - HALF_SHIFTS as isize);
        seen
    }

    /// Height of the odd lines of the pattern at a shift.
    fn odd_height(&self, at: usize) -> f64 {
        let steps = |offset: usize| (at + offset) as f64 - HALF_GRID as f64;
        let weighted = self.weights.iter().enumerate().filter(|(_, weight)| **weight > 0.0);
        weighted.map(|(offset, weight)| weight * self.comb.odd_lines_over_gaps(self.speed_rev_s(steps(offset)))).sum()
    }

    /// Belief in each shift: that of the most probable path to it (Viterbi, IEEE Trans. Inf. Theory 13, 1967).
    fn believe(&mut self) {
        self.next_belief.fill(f64::MIN);
        for (steps, &cost) in self.change_nats.iter().enumerate() {
            raise(&mut self.next_belief[steps..], &self.belief, cost);
            raise(&mut self.next_belief, &self.belief[steps..], cost);
        }
        self.next_belief.iter_mut().zip(&self.likeness).for_each(|(next, likeness)| *next += likeness);
        let most = self.next_belief.iter().copied().fold(f64::MIN, f64::max);
        self.next_belief.iter_mut().for_each(|belief| *belief = (*belief - most).max(-BELIEF_RANGE));
        std::mem::swap(&mut self.belief, &mut self.next_belief);
    }

    /// Moves the grid after a pattern that is far from the middle.
    fn recentre(&mut self, shift: isize) {
        if shift.abs() <= RECENTRE_SHIFTS {
            return;
        }
        self.middle_rev_s = self.speed_rev_s(shift as f64);
        self.best = HALF_SHIFTS;
        let by = shift.unsigned_abs();
        if shift > 0 {
            self.belief.copy_within(by.., 0);
            self.belief[SHIFTS - by..].fill(-BELIEF_RANGE);
        } else {
            self.belief.copy_within(..SHIFTS - by, by);
            self.belief[..by].fill(-BELIEF_RANGE);
        }
    }
}

fn highest(values: &[f64]) -> usize {
    (0..values.len()).max_by(|&a, &b| values[a].total_cmp(&values[b])).unwrap_or_default()
}

/// The vertex of the parabola through a value and its neighbours, from that value; 0 where there is no maximum near.
fn vertex(values: &[f64], at: usize) -> f64 {
    let around = at.checked_sub(1).and_then(|before| values.get(before..at + 2));
    match around {
        Some(&[before, here, after]) if 2.0 * here > before + after => {
            (0.5 * (after - before) / (2.0 * here - before - after)).clamp(-1.0, 1.0)
        }
        _ => 0.0,
    }
}
