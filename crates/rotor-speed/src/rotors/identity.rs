//! Which track is which rotor: where two rotors cross, their tracks may have changed places.
//!
//! The labelling of each frame is one of all permutations of the tracks; the best sequence of them (Viterbi) keeps each rotor's
//! speed continuous and its lines as loud, against each other, as they were: loudness is what tells rotors apart that have
//! come out of a crossing. How probable it is that two rotors changed places all the same is part of the answer.

use super::labellings::{Labellings, UNCHANGED};
use super::loudness::{Levels, Sides, level_cost, sides_of_frames};
use super::pace::Pace;
use crate::thresholds::SLOPE_SHARE_PER_S;
use hovertone_signal::statistics::median;

/// Standard deviation of the speed of a rotor from the one that its last speed and slopes predict, as a share of the speed. *Decision.*
const STEP_STD_SHARE: f64 = 0.0008;
/// Cost of a step up to which it is its square, in nats. A wider one costs less than its square, because rotors jump in a gust. With a tenth,
/// levels that rise and fall move rotors between names; with ten times, rotors 0.1 % apart lose each other. *Decision.*
const STEP_COST: f64 = 100.0;
/// Largest slope that is believed, as a share of the speed in a second.
const SLOPE_SHARE_S_MAX: f64 = SLOPE_SHARE_PER_S;
/// Largest number of times that the levels of the rotors, and then the rotors by their levels, are found. *Numeric.*
const PASSES: usize = 4;
/// Less probable exchanges of two rotors change no mean by what its uncertainty would show. *Numeric.*
const MEETING_CHANCE_MIN: f64 = 1e-6;

/// Which track each rotor is in each frame, and where that is in doubt.
#[derive(Clone, Debug, Default)]
pub(super) struct Labelling {
    /// The track of each rotor: `tracks[frame][rotor]`.
    pub(super) tracks: Vec<Vec<usize>>,
    pub(super) meetings: Vec<Meeting>,
}

/// A frame before which two rotors may have changed places.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Meeting {
    pub(super) frame: usize,
    pub(super) rotors: (usize, usize),
    /// Probability that they did.
    pub(super) chance: f64,
}

/// One track in one frame.
#[derive(Clone, Debug, Default)]
pub(super) struct TrackFrame {
    pub(super) speed_rev_s: f64,
    pub(super) slope_rev_s2: f64,
    /// Logarithm of each line's level; `None` where it is not apart from another rotor's.
    pub(super) levels: Vec<Option<f64>>,
    /// Whether its lines are worth more than anything that is left beside all rotors.
    pub(super) is_heard: bool,
}

/// What is known of the rotors from what came before.
#[derive(Clone, Debug, Default)]
pub(super) struct Identity {
    /// Each rotor's last frame, and the levels that it is known by.
    last: Vec<TrackFrame>,
    known: Vec<Vec<Option<f64>>>,
}

impl Identity {
    /// For each frame, the track of each rotor.
    pub(super) fn labelled(&mut self, tracks: &[Vec<TrackFrame>], steps: &Steps) -> Labelling {
        let frame_s = steps.frame_s;
        let count = tracks.len();
        let frames = tracks.iter().map(Vec::len).min().unwrap_or(0);
        if frames == 0 {
            return Labelling::default();
        }
        let labellings = Labellings::of(count);
        let mut path = vec![UNCHANGED; frames];
        let rotors_of = |path: &[usize]| -> Vec<Vec<&TrackFrame>> {
            let of_frame = |(frame, &place): (usize, &usize)| {
                labellings.all[place].iter().map(|&track| &tracks[track][frame]).collect()
            };
            path.iter().enumerate().map(of_frame).collect()
        };
        for pass in 0..PASSES {
            let expected: Vec<Vec<Vec<Option<f64>>>> = if pass == 0 && !self.known.is_empty() {
                vec![self.known.clone(); frames]
            } else {
                self.sides(&rotors_of(&path), frame_s, pass > 0).iter().map(Sides::expected).collect()
            };
            let before = std::mem::replace(&mut path, self.best_sequence(tracks, &labellings, &expected, steps));
            // the next pass would expect the same levels
            if pass > 0 && path == before {
                break;
            }
        }
        let rotors = rotors_of(&path);
        let sides = self.sides(&rotors, frame_s, true);
        let meetings = self.meetings(&rotors, &sides, steps);
        let known = sides.last().map(Sides::expected);
        if let (Some(last), Some(known)) = (rotors.last(), known) {
            self.last = last.iter().map(|&frame| frame.clone()).collect();
            self.known = known;
        }
        let labelled = path.iter().map(|&place| labellings.all[place].clone()).collect();
        Labelling { tracks: labelled, meetings }
    }

    /// Where two rotors may have changed places. Their two steps, and the levels of their lines before and after, give the odds.
    fn meetings(&self, rotors: &[Vec<&TrackFrame>], sides: &[Sides], steps: &Steps) -> Vec<Meeting> {
        let mut meetings = Vec::new();
        let mut before: Vec<&TrackFrame> = self.last.iter().collect();
        for (frame, now) in rotors.iter().enumerate() {
            let costs = steps.costs(frame, &before, now);
            for (a, own) in costs.iter().enumerate() {
                for b in a + 1..costs.len().min(now.len()) {
                    let of_steps = own[b] + costs[b][a] - own[a] - costs[b][b];
                    let of_levels = frame.checked_sub(1).map_or(0.0, |before| sides[before].cost_of_exchange(a, b));
                    // a cost is twice the logarithm of the odds
                    let chance = 1.0 / (1.0 + ((of_steps + of_levels) / 2.0).exp());
                    if chance > MEETING_CHANCE_MIN {
                        meetings.push(Meeting { frame, rotors: (a, b), chance });
                    }
                }
            }
            before.clone_from(now);
        }
        meetings
    }

    /// The levels of the rotors before and after each frame; at first, those of whole tracks.
    fn sides(&self, rotors: &[Vec<&TrackFrame>], frame_s: f64, drift: bool) -> Vec<Sides> {
        let levels: Vec<Vec<&Levels>> =
            rotors.iter().map(|rotors| rotors.iter().map(|rotor| &*rotor.levels).collect()).collect();
        sides_of_frames(&levels, &self.known, frame_s, drift)
    }

    fn best_sequence(
        &self,
        tracks: &[Vec<TrackFrame>],
        labellings: &Labellings,
        expected: &[Vec<Vec<Option<f64>>>],
        steps: &Steps,
    ) -> Vec<usize> {
        let frame_of = |frame: usize| -> Vec<&TrackFrame> { tracks.iter().map(|track| &track[frame]).collect() };
        let mut total: Vec<f64> = vec![0.0; labellings.all.len()];
        let mut origins: Vec<Vec<usize>> = Vec::with_capacity(expected.len());
        for (frame, expected) in expected.iter().enumerate() {
            let now = frame_of(frame);
            let before = if frame == 0 { self.last.iter().collect() } else { frame_of(frame - 1) };
            let level_costs: Vec<Vec<f64>> = expected
                .iter()
                .map(|expected| now.iter().map(|it| level_cost(&it.levels, expected, steps.frame_s)).collect())
                .collect();
            let steps = steps.costs(frame, &before, &now).concat();
            let levels = labellings.costs(&level_costs);
            let mut origin = vec![0; labellings.all.len()];
            let mut next = vec![0.0; labellings.all.len()];
            for (to, (origin, next)) in origin.iter_mut().zip(&mut next).enumerate() {
                let (best, cost) = if before.is_empty() {
                    (0, 0.0)
                } else if frame == 0 {
                    // the rotors of what came before stand in their own order
                    (0, labellings.cost_of_change(UNCHANGED, to, &steps))
                } else {
                    let costs = total.iter().enumerate();
                    let costs = costs.map(|(from, total)| total + labellings.cost_of_change(from, to, &steps));
                    costs.enumerate().min_by(|a, b| a.1.total_cmp(&b.1)).unwrap_or((0, 0.0))
                };
                (*origin, *next) = (best, cost + levels[to]);
            }
            total = next;
            origins.push(origin);
        }
        let mut place = (0..total.len()).min_by(|&a, &b| total[a].total_cmp(&total[b])).unwrap_or(0);
        let mut path = vec![place];
        for origin in origins.iter().skip(1).rev() {
            place = origin[place];
            path.push(place);
        }
        path.reverse();
        path
    }
}

/// How rotors go from one frame to the next.
pub(super) struct Steps {
    pub(super) frame_s: f64,
    pub(super) pace: Pace,
    /// Two tracks that are closer may lie in place of each other.
    pub(super) resolution_rev_s: f64,
    /// How long nothing was listened to before the first frame.
    pub(super) gap_s: f64,
}

impl Steps {
    /// What it costs each rotor before a frame to be each track in it.
    fn costs(&self, frame: usize, before: &[&TrackFrame], now: &[&TrackFrame]) -> Vec<Vec<f64>> {
        if frame == 0 && self.gap_s > self.frame_s {
            self.costs_after_gap(before, now)
        } else {
            self.costs_of_step(before, now)
        }
    }

    /// From one frame to the next. Where rotors bob, it costs by how a rotor moves against the others: what they share changes by more from frame
    /// to frame than they are apart.
    fn costs_of_step(&self, before: &[&TrackFrame], now: &[&TrackFrame]) -> Vec<Vec<f64>> {
        let shared = |value: fn(&TrackFrame) -> f64, frames: &[&TrackFrame]| match self.pace {
            Pace::Steady => 0.0,
            Pace::Bobbing => frames.iter().map(|frame| value(frame)).sum::<f64>() / frames.len() as f64,
        };
        let shared_step = shared(|frame| frame.speed_rev_s, now) - shared(|frame| frame.speed_rev_s, before);
        let slope = |frame: &TrackFrame, all: &[&TrackFrame]| {
            let own = frame.slope_rev_s2 - shared(|frame| frame.slope_rev_s2, all);
            let slope_rev_s2_max = SLOPE_SHARE_S_MAX * frame.speed_rev_s;
            own.clamp(-slope_rev_s2_max, slope_rev_s2_max)
        };
        let expected_rev_s = |from: &TrackFrame, to: &TrackFrame| {
            from.speed_rev_s + shared_step + self.frame_s * (slope(from, before) + slope(to, now)) / 2.0
        };
        self.costs_of(before, now, expected_rev_s, STEP_STD_SHARE)
    }

    /// Over a gap, such as a manoeuvre or a new load. The vehicle may have changed the speeds of all rotors in one ratio, which their order of speed
    /// tells; what each did by itself is a random walk, and slopes predict nothing.
    fn costs_after_gap(&self, before: &[&TrackFrame], now: &[&TrackFrame]) -> Vec<Vec<f64>> {
        let sorted = |frames: &[&TrackFrame]| {
            let mut speeds: Vec<f64> = frames.iter().map(|frame| frame.speed_rev_s).collect();
            speeds.sort_by(f64::total_cmp);
            speeds
        };
        let ratios: Vec<f64> = sorted(now).iter().zip(sorted(before)).map(|(now, before)| now / before).collect();
        let ratio = median(&ratios).unwrap_or(1.0);
        let std_share = STEP_STD_SHARE * (self.gap_s / self.frame_s).sqrt();
        self.costs_of(before, now, |from, _| ratio * from.speed_rev_s, std_share)
    }

    fn costs_of(
        &self,
        before: &[&TrackFrame],
        now: &[&TrackFrame],
        expected_rev_s: impl Fn(&TrackFrame, &TrackFrame) -> f64,
        std_share: f64,
    ) -> Vec<Vec<f64>> {
        let cost = |from: &TrackFrame, to: &TrackFrame| {
            let expected = expected_rev_s(from, to);
            let deviation = (to.speed_rev_s - expected) / (std_share * expected).hypot(self.resolution_rev_s);
            STEP_COST * (deviation.powi(2) / STEP_COST).ln_1p()
        };
        before.iter().map(|from| now.iter().map(|to| cost(from, to)).collect()).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn frame(speed_rev_s: f64, level: f64) -> TrackFrame {
        TrackFrame { speed_rev_s, levels: vec![Some(level), Some(-level)], ..TrackFrame::default() }
    }

    fn steps(pace: Pace, gap_s: f64) -> Steps {
        Steps { frame_s: 0.04, pace, resolution_rev_s: 0.0, gap_s }
    }

    #[test]
    fn tracks_that_change_places_are_put_right() {
        let loud = [0.9, -0.4, 0.1];
        let speeds = [60.0, 60.02, 63.0];
        // tracks 0 and 1 change places after the tenth frame, which their speeds hardly show
        let tracks: Vec<Vec<TrackFrame>> = (0..3)
            .map(|track| {
                (0..30)
                    .map(|index| {
                        let rotor = if index >= 10 && track < 2 { 1 - track } else { track };
                        frame(speeds[rotor], loud[rotor])
                    })
                    .collect()
            })
            .collect();
        let mut identity = Identity::default();
        let labelled = identity.labelled(&tracks, &steps(Pace::Steady, 0.0)).tracks;
        assert!(labelled[..10].iter().all(|labelling| labelling == &labelled[0]));
        assert!(labelled[10..].iter().all(|labelling| labelling == &labelled[10]));
        assert_eq!(labelled[0][0], labelled[10][1]);
        assert_eq!(labelled[0][2], labelled[10][2]);
        // what comes next keeps the names, whatever the order of the tracks
        let turned: Vec<Vec<TrackFrame>> = [2, 0, 1].iter().map(|&track| tracks[track][10..].to_vec()).collect();
        let next = identity.labelled(&turned, &steps(Pace::Steady, 0.0)).tracks;
        let of_before = |rotor: usize| tracks[labelled[29][rotor]][29].speed_rev_s;
        assert!((0..3).all(|rotor| turned[next[0][rotor]][0].speed_rev_s == of_before(rotor)));
    }

    #[test]
    fn levels_do_not_move_a_rotor_that_crosses_no_other() {
        // two rotors 5 % apart; their levels change places, as where the vehicle turns
        let loud = |rotor: usize, index: usize| if (rotor == 0) == (index < 100) { 1.0 } else { -1.0 };
        let tracks: Vec<Vec<TrackFrame>> = [60.0, 63.0]
            .into_iter()
            .enumerate()
            .map(|(rotor, speed_rev_s)| (0..200).map(|index| frame(speed_rev_s, loud(rotor, index))).collect())
            .collect();
        let labelled = Identity::default().labelled(&tracks, &steps(Pace::Steady, 0.0)).tracks;
        assert!(labelled.iter().all(|labelling| labelling == &labelled[0]));
    }

    #[test]
    fn rotors_keep_their_names_where_all_turn_faster_after_a_gap() {
        let track = |speed_rev_s: f64| vec![frame(speed_rev_s, 0.0); 20];
        let mut identity = Identity::default();
        identity.labelled(&[97.1, 103.3, 106.7, 109.9].map(track), &steps(Pace::Steady, 0.0));
        // the slowest one is now where the fastest one was
        let faster = [125.3, 110.7, 121.6, 117.8].map(track);
        let after = identity.labelled(&faster, &steps(Pace::Steady, 5.0));
        assert!(after.tracks.iter().all(|labels| labels == &[1, 3, 2, 0]), "{:?}", after.tracks);
        assert!(after.meetings.iter().all(|meeting| meeting.chance < 0.2), "{:?}", after.meetings);
    }

    #[test]
    fn rotors_that_bob_keep_their_names() {
        // all change by more than they are apart from frame to frame; and the tracks change places with every frame
        let tracks: Vec<Vec<TrackFrame>> = (0..3)
            .map(|track| {
                let rotor = |index: usize| (track + index) % 3;
                let speed = |index: usize| 60.0 + 0.6 * rotor(index) as f64 + 2.0 * (1.7 * index as f64).sin();
                (0..40).map(|index| TrackFrame { speed_rev_s: speed(index), ..TrackFrame::default() }).collect()
            })
            .collect();
        let mut identity = Identity::default();
        let labelled = identity.labelled(&tracks, &steps(Pace::Bobbing, 0.0)).tracks;
        let rotor = |place: usize, index: usize| (labelled[index][place] + index) % 3;
        assert!((0..3).all(|place| (0..40).all(|index| rotor(place, index) == rotor(place, 0))));
        // and where they are steady again, from where they were
        let steady =
            |track: usize| vec![TrackFrame { speed_rev_s: tracks[track][39].speed_rev_s, ..TrackFrame::default() }; 5];
        let next = identity.labelled(&[steady(2), steady(0), steady(1)], &steps(Pace::Steady, 0.0)).tracks;
        assert!((0..3).all(|place| [2, 0, 1][next[4][place]] == labelled[39][place]));
    }
}
