//! Heard speeds against the speeds in a log of the same flight: offset of the clocks, which track is which motor, bias, scatter and coverage.
//!
//! For each offset, each track is compared with each motor, and the pairs are assigned by their mean squares: the best pair first, then the best of
//! the rest. A log whose speeds are a simple multiple of the heard ones is scaled first, so that a wrong order is told as such.

#[cfg(test)]
mod tests;

use super::agreement::agreement_of;
use super::differences::{Difference, POINTS_MIN, compared_point, near_rows, rounding_std};
use super::not_verified::NotVerified;
use hovertone_analysis::{MEAN_OF_MOTORS, RotorsHeard, TrackPoint, Verification, VerifiedRotor};
use hovertone_vehicle::COVERAGE_FACTOR;

/// Step of the coarse search of the offset, in s. *Numeric.*
const OFFSET_STEP_S: f64 = 0.1;
/// Steps of the fine search. *Numeric.*
const FINE_STEP_S: f64 = 0.004;
/// Points of a track in the coarse search. *Numeric.*
const COARSE_POINTS: usize = 300;
/// The same in the fine search. *Numeric.*
const FINE_POINTS: usize = 1200;
/// Offsets of the coarse search that are searched finely. *Numeric.*
const PLACES_MAX: usize = 16;
/// Most offsets. *Decision.*
const OFFSETS_MAX: usize = 40_000;
/// Share of the shorter series that both must cover. *Decision.*
const OVERLAP_SHARE_MIN: f64 = 0.5;
/// Longest time between log rows over which the speed is straight, in s. *Decision.*
const GAP_S_MAX: f64 = 1.0;
/// Offsets this far away, and speeds that do not change, must be worse by this factor. *Decision.*
const ELSEWHERE_S: f64 = 1.0;
const ELSEWHERE_FACTOR: f64 = 1.2;
/// Widest limits that tell an offset, in s. *Decision.*
const GIVEN_S_MAX: f64 = 2.0;
/// Ratios that a wrong order, wrong blades or wrong pole pairs make. *Physics.*
const RATIOS: [f64; 9] = [0.25, 1.0 / 3.0, 0.5, 2.0 / 3.0, 1.0, 1.5, 2.0, 3.0, 4.0];
/// A ratio of speeds is one of these if it is nearer than this. *Decision.*
const RATIO_SHARE: f64 = 0.05;
/// Shortest comparison that tells the rate of the clocks, in s. *Decision.*
const RATE_S_MIN: f64 = 60.0;

/// Speeds of the motors in a log.
#[derive(Clone, Copy, Debug)]
pub struct LoggedSpeeds<'a> {
    /// Times of the rows, increasing.
    pub time_s: &'a [f64],
    /// Names of the motors.
    pub names: &'a [String],
    /// `speeds_rev_s[motor][row]`.
    pub speeds_rev_s: &'a [Vec<f64>],
}

/// Compares the tracks of rotors that are heard in some way with a log. `offsets_s` limits the offset, where it is known.
///
/// # Errors
/// Nothing to compare.
pub fn verification_of_heard(
    tracks: &[&[TrackPoint]],
    heard: Option<RotorsHeard>,
    log: LoggedSpeeds<'_>,
    offsets_s: Option<[f64; 2]>,
) -> Result<Verification, NotVerified> {
    match (tracks, heard) {
        ([track], Some(RotorsHeard::Group)) => verification_of_group(track, log, offsets_s),
        _ => verification_from_log(tracks, log, offsets_s),
    }
}

/// The same for tracks that may be of any motor.
fn verification_from_log(
    tracks: &[&[TrackPoint]],
    log: LoggedSpeeds<'_>,
    offsets_s: Option<[f64; 2]>,
) -> Result<Verification, NotVerified> {
    let is_long = |index: &usize| tracks[*index].len() >= POINTS_MIN;
    let indices: Vec<usize> = (0..tracks.len()).filter(is_long).collect();
    let tracks: Vec<&[TrackPoint]> = indices.iter().map(|&index| tracks[index]).collect();
    if tracks.is_empty() {
        return Err(NotVerified::NoTrack);
    }
    let motors = log.speeds_rev_s.len();
    if motors < tracks.len() {
        return Err(NotVerified::TooFewMotors { tracks: tracks.len(), motors });
    }
    // the tone of rotors that are not separated is that of one of them, or of their mean
    let with_mean = (tracks.len() == 1 && motors > 1).then(|| with_mean(log));
    let log = with_mean.as_ref().map_or(log, |(names, speeds_rev_s)| LoggedSpeeds { names, speeds_rev_s, ..log });
    let near_ratio = near_ratio(&tracks, log);
    let comparison = Comparison { tracks: &tracks, log, scale: near_ratio.unwrap_or(1.0) };
    let offsets = comparison.offsets(offsets_s)?;
    let places = comparison.best_places(&offsets);
    let Some(&best) = places.first() else {
        return Err(offsets_s.map_or(NotVerified::NoOverlap, |_| NotVerified::NoOverlapAtOffset));
    };
    let everywhere = offsets_s.and_then(|_| Some(comparison.best_places(&comparison.offsets(None).ok()?)));
    let is_offset_told = comparison.tells(everywhere.as_ref().unwrap_or(&places));
    let told_outside = everywhere.as_ref().and_then(|places| comparison.told_outside(places, offsets_s?));
    let is_offset_told = is_offset_told && told_outside.is_none();
    // where the speeds show no offset, none is the simplest
    let calm_s = offsets_s.map_or(0.0, |[low_s, high_s]| f64::midpoint(low_s, high_s));
    let is_calm_as_good = !is_offset_told && comparison.cost(calm_s, FINE_POINTS) <= ELSEWHERE_FACTOR * best.cost;
    let fine_s = if is_calm_as_good { calm_s } else { best.offset_s };
    let offset_s = offsets_s.map_or(fine_s, |[low_s, high_s]| fine_s.min(high_s).max(low_s));
    // a fit that is hardly better outside of the limits tells nothing
    let is_better_outside =
        || comparison.cost(offset_s, COARSE_POINTS) > ELSEWHERE_FACTOR * comparison.cost(fine_s, COARSE_POINTS);
    let better_offset_s = (fine_s != offset_s && is_better_outside()).then_some(fine_s).or_else(|| {
        let outside = told_outside?;
        (comparison.cost(offset_s, FINE_POINTS) > ELSEWHERE_FACTOR * outside.cost).then_some(outside.offset_s)
    });
    let mut rotors = comparison.rotors(offset_s);
    rotors.iter_mut().for_each(|rotor| rotor.track = indices[rotor.track]);
    let heard: f64 = rotors.iter().map(|rotor| rotor.speed_rev_s).sum();
    let logged: f64 = rotors.iter().map(|rotor| rotor.speed_rev_s - rotor.bias_rev_s).sum();
    Ok(Verification {
        offset_s,
        is_offset_told,
        // wide limits tell no offset
        is_offset_given: offsets_s.is_some_and(|[low_s, high_s]| high_s - low_s <= GIVEN_S_MAX),
        is_offset_at_limit: !is_offset_told
            && !is_calm_as_good
            && offsets_s.is_some_and(|limits| limits.contains(&offset_s)),
        better_offset_s,
        agreement: agreement_of(&rotors),
        clock_rate_share: comparison.clock_rate_share(offset_s),
        rotors,
        speed_ratio: heard / logged,
        near_ratio: near_ratio.filter(|ratio| *ratio != 1.0),
    })
}

impl LoggedSpeeds<'_> {
    /// The mean speed of all motors in each row.
    fn mean(self) -> Vec<f64> {
        let count = self.speeds_rev_s.len() as f64;
        let mean = |row: usize| self.speeds_rev_s.iter().map(|speeds| speeds[row]).sum::<f64>() / count;
        (0..self.time_s.len()).map(mean).collect()
    }
}

/// Names and speeds of the motors, and of their mean.
fn with_mean(log: LoggedSpeeds<'_>) -> (Vec<String>, Vec<Vec<f64>>) {
    let names = log.names.iter().cloned().chain([MEAN_OF_MOTORS.to_owned()]);
    (names.collect(), log.speeds_rev_s.iter().cloned().chain([log.mean()]).collect())
}

/// The same for rotors that are heard as a group, whose speed is their mean: the mean of the motors alone is compared with it.
fn verification_of_group(
    track: &[TrackPoint],
    log: LoggedSpeeds<'_>,
    offsets_s: Option<[f64; 2]>,
) -> Result<Verification, NotVerified> {
    let (names, speeds_rev_s) = ([MEAN_OF_MOTORS.to_owned()], [log.mean()]);
    verification_from_log(&[track], LoggedSpeeds { names: &names, speeds_rev_s: &speeds_rev_s, ..log }, offsets_s)
}

/// The simple ratio of the heard and the logged speeds.
fn near_ratio(tracks: &[&[TrackPoint]], log: LoggedSpeeds<'_>) -> Option<f64> {
    let heard = mean(tracks.iter().flat_map(|track| track.iter().map(|point| point.speed_rev_s)))?;
    let turning = log.speeds_rev_s.iter().flatten().copied().filter(|speed_rev_s| *speed_rev_s > 0.0);
    let fastest = turning.clone().fold(0.0, f64::max);
    // rows on the ground and at rest are no flight
    let logged = mean(turning.filter(|speed_rev_s| *speed_rev_s > 0.5 * fastest))?;
    RATIOS.into_iter().find(|ratio| (heard / logged / ratio - 1.0).abs() < RATIO_SHARE)
}

fn mean(values: impl Iterator<Item = f64>) -> Option<f64> {
    let (sum, count) = values.fold((0.0, 0_usize), |(sum, count), value| (sum + value, count + 1));
    (count > 0).then(|| sum / count as f64)
}

/// An offset and the squares that it leaves.
#[derive(Clone, Copy, Debug)]
struct Place {
    offset_s: f64,
    cost: f64,
}

struct Comparison<'a> {
    tracks: &'a [&'a [TrackPoint]],
    log: LoggedSpeeds<'a>,
    /// Factor of the logged speeds during alignment.
    scale: f64,
}

impl Comparison<'_> {
    /// Whether the speeds tell the offset that is the best of these: steady speeds fit anywhere.
    fn tells(&self, places: &[Place]) -> bool {
        let Some(best) = places.first() else { return false };
        let is_worse = |cost: f64| cost.is_finite() && cost > ELSEWHERE_FACTOR * best.cost;
        let elsewhere = places.iter().find(|place| (place.offset_s - best.offset_s).abs() > ELSEWHERE_S);
        elsewhere.is_some_and(|place| is_worse(place.cost))
            && is_worse(self.cost_of_constants(best.offset_s, FINE_POINTS))
    }

    /// The best of all places, where the speeds tell it and it lies outside of the limits.
    fn told_outside(&self, places: &[Place], [low_s, high_s]: [f64; 2]) -> Option<Place> {
        let best = *places.first()?;
        let is_outside = best.offset_s < low_s - OFFSET_STEP_S || best.offset_s > high_s + OFFSET_STEP_S;
        (is_outside && self.tells(places)).then_some(best)
    }

    fn offsets(&self, limits_s: Option<[f64; 2]>) -> Result<Vec<f64>, NotVerified> {
        let (Some(&log_from_s), Some(&log_to_s)) = (self.log.time_s.first(), self.log.time_s.last()) else {
            return Err(NotVerified::NoOverlap);
        };
        let points = || self.tracks.iter().flat_map(|track| track.iter().map(|point| point.time_s));
        let (from_s, to_s) = (points().fold(f64::INFINITY, f64::min), points().fold(f64::NEG_INFINITY, f64::max));
        let shared_s = OVERLAP_SHARE_MIN * (to_s - from_s).min(log_to_s - log_from_s);
        let [low_s, high_s] = limits_s.unwrap_or([from_s + shared_s - log_to_s, to_s - shared_s - log_from_s]);
        let count = ((high_s - low_s) / OFFSET_STEP_S).ceil().max(0.0) + 1.0;
        if count > OFFSETS_MAX as f64 {
            return Err(NotVerified::TooLong);
        }
        Ok((0..count as usize).map(|at| (low_s + at as f64 * OFFSET_STEP_S).min(high_s.max(low_s))).collect())
    }

    /// Heard less logged speed at the points of a track that the log covers.
    fn differences(&self, track: &[TrackPoint], motor: usize, offset_s: f64, stride: usize) -> Vec<Difference> {
        let difference = |point: &TrackPoint| {
            let Logged { speed_rev_s, row_s } = self.logged_at(motor, point.time_s - offset_s)?;
            Some(Difference { point: *point, logged_rev_s: speed_rev_s, row_s })
        };
        track.iter().step_by(stride).filter_map(difference).collect()
    }

    fn logged_at(&self, motor: usize, time_s: f64) -> Option<Logged> {
        let times_s = self.log.time_s;
        let behind = times_s.partition_point(|&row_s| row_s < time_s);
        let before = behind.checked_sub(1)?;
        let (from_s, to_s) = (times_s[before], *times_s.get(behind)?);
        let speeds = &self.log.speeds_rev_s[motor];
        let share = (time_s - from_s) / (to_s - from_s);
        let logged = || Logged {
            speed_rev_s: speeds[before] + share * (speeds[behind] - speeds[before]),
            row_s: (time_s - from_s).min(to_s - time_s),
        };
        (to_s - from_s <= GAP_S_MAX).then(logged)
    }

    /// Mean square of the differences of a track and a motor; infinite with too little in common.
    fn square(&self, track: &[TrackPoint], motor: usize, offset_s: f64, points_max: usize) -> f64 {
        let stride = track.len().div_ceil(points_max).max(1);
        let differences = self.differences(track, motor, offset_s, stride);
        let expected = track.len().div_ceil(stride);
        if differences.len() < POINTS_MIN || (differences.len() as f64) < 0.5 * OVERLAP_SHARE_MIN * expected as f64 {
            return f64::INFINITY;
        }
        let square =
            |difference: &Difference| (difference.point.speed_rev_s - self.scale * difference.logged_rev_s).powi(2);
        differences.iter().map(square).sum::<f64>() / differences.len() as f64
    }

    /// Which motor each track is, by least squares at an offset: the best pair first, then the best of the rest.
    fn assignment(&self, offset_s: f64, points_max: usize) -> Assignment {
        let mut squares: Vec<PairSquare> = Vec::new();
        for (track, points) in self.tracks.iter().enumerate() {
            for motor in 0..self.log.speeds_rev_s.len() {
                squares.push(PairSquare { track, motor, square: self.square(points, motor, offset_s, points_max) });
            }
        }
        squares.sort_by(|a, b| a.square.total_cmp(&b.square));
        let (mut motors, mut cost) = (vec![None; self.tracks.len()], 0.0);
        for pair in squares {
            if motors[pair.track].is_none() && !motors.contains(&Some(pair.motor)) {
                motors[pair.track] = Some(pair.motor);
                cost += pair.square;
            }
        }
        Assignment { motors, cost }
    }

    fn cost(&self, offset_s: f64, points_max: usize) -> f64 {
        self.assignment(offset_s, points_max).cost
    }

    /// The same where each track is its mean over the points that the log covers at this offset.
    fn cost_of_constants(&self, offset_s: f64, points_max: usize) -> f64 {
        let square = |(track, motor): (&&[TrackPoint], Option<usize>)| {
            let compared = self.differences(track, motor?, offset_s, track.len().div_ceil(points_max).max(1));
            let heard = || compared.iter().map(|difference| difference.point.speed_rev_s);
            let mean_rev_s = mean(heard())?;
            mean(heard().map(|speed_rev_s| (speed_rev_s - mean_rev_s).powi(2)))
        };
        let motors = self.assignment(offset_s, points_max).motors;
        self.tracks.iter().zip(motors).filter_map(square).sum()
    }

    /// The best offsets, each with its cost, best first: the most promising ones of the coarse search are searched finely, because quick changes of
    /// the speed tell an offset that the coarse steps miss. Half of them may lie anywhere, and the others far from all, so that the best one is
    /// compared with others elsewhere.
    fn best_places(&self, offsets: &[f64]) -> Vec<Place> {
        let by_cost = |a: &Place, b: &Place| a.cost.total_cmp(&b.cost);
        let coarse = |&offset_s: &f64| Place { offset_s, cost: self.cost(offset_s, COARSE_POINTS) };
        let mut all: Vec<Place> = offsets.iter().map(coarse).filter(|place| place.cost.is_finite()).collect();
        all.sort_by(by_cost);
        let mut chosen: Vec<Place> = Vec::new();
        for place in all {
            let is_near = |other: &Place| (place.offset_s - other.offset_s).abs() < ELSEWHERE_S;
            if chosen.len() < PLACES_MAX / 2 || chosen.len() < PLACES_MAX && !chosen.iter().any(is_near) {
                chosen.push(place);
            }
        }
        let mut fine: Vec<Place> = chosen.iter().map(|place| self.fine_place(place.offset_s)).collect();
        fine.sort_by(by_cost);
        fine
    }

    /// The best offset near one of the coarse search.
    fn fine_place(&self, coarse_s: f64) -> Place {
        let steps = (OFFSET_STEP_S / FINE_STEP_S) as i32;
        let places = (-steps..=steps).map(|step| coarse_s + f64::from(step) * FINE_STEP_S);
        let costs = places.map(|offset_s| Place { offset_s, cost: self.cost(offset_s, FINE_POINTS) });
        costs.min_by(|a, b| a.cost.total_cmp(&b.cost)).unwrap_or(Place { offset_s: coarse_s, cost: f64::INFINITY })
    }

    /// Change of the offset from the first to the second half, over the time between their middles. `None` where the log covers too little of one
    /// half.
    fn clock_rate_share(&self, offset_s: f64) -> Option<f64> {
        let points = self.tracks.first()?;
        let (from_s, to_s) = (points.first()?.time_s, points.last()?.time_s);
        if to_s - from_s < RATE_S_MIN {
            return None;
        }
        let half = |is_second: bool| -> Vec<&[TrackPoint]> {
            let cut = |track: &&[TrackPoint]| track.partition_point(|point| point.time_s < 0.5 * (from_s + to_s));
            self.tracks
                .iter()
                .map(|track| if is_second { &track[cut(track)..] } else { &track[..cut(track)] })
                .collect()
        };
        let offset_of = |tracks: &[&[TrackPoint]]| {
            let place = Comparison { tracks, ..*self }.fine_place(offset_s);
            place.cost.is_finite().then_some(place.offset_s)
        };
        Some((offset_of(&half(true))? - offset_of(&half(false))?) / (0.5 * (to_s - from_s)))
    }

    fn rotors(&self, offset_s: f64) -> Vec<VerifiedRotor> {
        let assignment = self.assignment(offset_s, usize::MAX);
        let rotor = |(index, motor): (usize, &Option<usize>)| {
            let (track, motor) = (self.tracks[index], (*motor)?);
            let differences = near_rows(self.differences(track, motor, offset_s, 1));
            let count = differences.len() as f64;
            let bias_rev_s = differences.iter().map(Difference::rev_s).sum::<f64>() / count;
            let squares: f64 = differences.iter().map(|one| (one.rev_s() - bias_rev_s).powi(2)).sum();
            let rounding_rev_s = rounding_std(&self.log.speeds_rev_s[motor]);
            let is_covered = |one: &&Difference| {
                one.rev_s().abs() <= COVERAGE_FACTOR * one.point.std_uncertainty_rev_s.hypot(rounding_rev_s)
            };
            Some(VerifiedRotor {
                track: index,
                motor,
                name: self.log.names[motor].clone(),
                speed_rev_s: differences.iter().map(|one| one.point.speed_rev_s).sum::<f64>() / count,
                bias_rev_s,
                scatter_rev_s: (squares / (count - 1.0).max(1.0)).sqrt(),
                coverage: differences.iter().filter(is_covered).count() as f64 / count,
                point_count: differences.len(),
                points: differences.iter().map(compared_point).collect(),
            })
        };
        assignment.motors.iter().enumerate().filter_map(rotor).collect()
    }
}

/// A logged speed, and the time to the nearest log row.
struct Logged {
    speed_rev_s: f64,
    row_s: f64,
}

struct PairSquare {
    track: usize,
    motor: usize,
    square: f64,
}

struct Assignment {
    motors: Vec<Option<usize>>,
    cost: f64,
}
