//! Where two rotors meet, nobody hears whether they pass each other or turn back → how far off the mean speed of each may be.
//!
//! Many histories are drawn: in each, every two rotors that meet change places with the probability that [`Identity`] gives. The means of a
//! history and the reported means are each put in the order of speed. The rms difference at each place is the uncertainty of the reported mean.
//!
//! [`Identity`]: super::identity::Identity

use super::identity::Meeting;
use rand::{RngExt, SeedableRng};
use rand_pcg::Pcg64Mcg;

/// Histories that are drawn: the uncertainty is then known to a tenth. *Numeric.*
const HISTORIES: usize = 64;

/// What the rotors may have done.
pub(super) struct Histories {
    draws: Vec<History>,
    /// Sum of the speeds of each reported rotor.
    reported_rev_s: Vec<f64>,
    frames: usize,
    random: Pcg64Mcg,
}

/// One of them.
#[derive(Clone)]
struct History {
    /// The reported rotor that each rotor is taken for.
    names: Vec<usize>,
    /// Sum of the speeds of each rotor.
    sums_rev_s: Vec<f64>,
}

impl Histories {
    pub(super) fn of(rotors: usize) -> Self {
        let first = History { names: (0..rotors).collect(), sums_rev_s: vec![0.0; rotors] };
        Self {
            draws: vec![first; HISTORIES],
            reported_rev_s: vec![0.0; rotors],
            frames: 0,
            random: Pcg64Mcg::seed_from_u64(0),
        }
    }

    /// Takes the speeds of the reported rotors in the frames of a chunk, `speeds_rev_s[rotor][frame]`, and where they meet.
    pub(super) fn take(&mut self, speeds_rev_s: &[Vec<f64>], meetings: &[Meeting]) {
        let frames = speeds_rev_s.iter().map(Vec::len).min().unwrap_or(0);
        self.frames += frames;
        let mut from = 0;
        for meeting in meetings {
            self.add(speeds_rev_s, from, meeting.frame);
            from = meeting.frame;
            let (a, b) = meeting.rotors;
            for draw in &mut self.draws {
                if self.random.random_bool(meeting.chance) {
                    for name in &mut draw.names {
                        *name = if *name == a {
                            b
                        } else if *name == b {
                            a
                        } else {
                            *name
                        };
                    }
                }
            }
        }
        self.add(speeds_rev_s, from, frames);
    }

    /// Adds the frames from one to another.
    fn add(&mut self, speeds_rev_s: &[Vec<f64>], from: usize, to: usize) {
        let sums: Vec<f64> = speeds_rev_s.iter().map(|speeds| speeds[from..to].iter().sum()).collect();
        self.reported_rev_s.iter_mut().zip(&sums).for_each(|(reported, sum)| *reported += sum);
        for History { names, sums_rev_s } in &mut self.draws {
            for (own, &name) in sums_rev_s.iter_mut().zip(&*names) {
                *own += sums.get(name).copied().unwrap_or(0.0);
            }
        }
    }

    /// Standard uncertainty of the mean speed of each reported rotor.
    pub(super) fn stds_rev_s(&self) -> Vec<f64> {
        let mut order: Vec<usize> = (0..self.reported_rev_s.len()).collect();
        order.sort_by(|&a, &b| self.reported_rev_s[a].total_cmp(&self.reported_rev_s[b]));
        let mut squares = vec![0.0; order.len()];
        for History { sums_rev_s, .. } in &self.draws {
            let mut sums_rev_s = sums_rev_s.clone();
            sums_rev_s.sort_by(f64::total_cmp);
            for (&rotor, sum) in order.iter().zip(&sums_rev_s) {
                squares[rotor] += (sum - self.reported_rev_s[rotor]).powi(2);
            }
        }
        squares.iter().map(|square| (square / HISTORIES as f64).sqrt() / self.frames.max(1) as f64).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const ROTORS: usize = 3;

    fn stds_rev_s(speeds_rev_s: &[Vec<f64>], meetings: &[Meeting]) -> Vec<f64> {
        let mut histories = Histories::of(ROTORS);
        histories.take(speeds_rev_s, meetings);
        histories.stds_rev_s()
    }

    /// Two rotors that touch in the middle, and one apart.
    fn touching() -> Vec<Vec<f64>> {
        let place = |frame: usize| (frame as f64 - 99.5) / 99.5;
        let track = |speed: fn(f64) -> f64| (0..200).map(|frame| speed(place(frame))).collect();
        vec![track(|place| 60.0 + place.abs()), track(|place| 60.0 - place.abs()), track(|_| 70.0)]
    }

    #[test]
    fn rotors_that_never_meet_are_not_exchanged() {
        assert_eq!(stds_rev_s(&touching(), &[]), [0.0; ROTORS]);
    }

    #[test]
    fn a_meeting_in_the_middle_leaves_the_two_means_open() {
        // if they pass each other, both turn at 60 on average, not at 60.5 and 59.5
        let meeting = |chance| Meeting { frame: 100, rotors: (0, 1), chance };
        let stds = stds_rev_s(&touching(), &[meeting(0.5)]);
        let expected = 0.5 * f64::sqrt(0.5);
        assert!(stds[..2].iter().all(|std| (std / expected - 1.0).abs() < 0.2), "{stds:?}");
        assert_eq!(stds[2], 0.0);
        let rare = stds_rev_s(&touching(), &[meeting(0.01)]);
        assert!(rare[0] < 0.3 * stds[0], "{rare:?}");
    }

    #[test]
    fn a_meeting_at_the_end_changes_little_whatever_was_before() {
        // 200 frames, and the exchange is in the last two: each mean moves by a hundredth of their distance
        let meeting = Meeting { frame: 198, rotors: (0, 1), chance: 0.5 };
        let at_the_end = stds_rev_s(&touching(), &[meeting]);
        let at_the_start = stds_rev_s(&touching(), &[Meeting { frame: 2, ..meeting }]);
        assert!(at_the_end[0] < 0.03 && at_the_start[0] < 0.03, "{at_the_end:?} {at_the_start:?}");
    }

    #[test]
    fn exchanges_go_on_in_the_next_chunk() {
        let whole = touching();
        let part =
            |range: std::ops::Range<usize>| whole.iter().map(|track| track[range.clone()].to_vec()).collect::<Vec<_>>();
        let meeting = Meeting { frame: 100, rotors: (0, 1), chance: 0.5 };
        let mut histories = Histories::of(ROTORS);
        histories.take(&part(0..150), &[meeting]);
        histories.take(&part(150..200), &[]);
        let close =
            histories.stds_rev_s().iter().zip(stds_rev_s(&whole, &[meeting])).all(|(a, b)| (a - b).abs() < 1e-9);
        assert!(close);
    }
}
