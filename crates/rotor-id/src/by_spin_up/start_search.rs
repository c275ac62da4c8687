//! The rotors of a hover, followed back in time to their starts.
//!
//! ```text
//! frames ─▶ speeds and powers along the tracks ─▶ powers in the hover ─▶ anchor: the first frame from which all rotors are audible
//!                                                                          │
//! starts ◀── checks ◀── onset of each rotor ◀── speeds and powers, followed back from the anchor
//! ```

use super::RotorStart;
use super::frames::{FRAME_S, Frame};
use super::joint_lines::JointLines;
use super::onset::{AUDIBLE_SHARE, Onset, onset_from_powers};
use super::other_speed::{KnownFrame, OtherSpeedSearch};
use crate::speed_curve::SpeedCurve;
use hovertone_analysis::NotTold;
use hovertone_signal::statistics::median;
use std::f64::consts::TAU;

/// Smallest power of a rotor in the hover over that of the noise, both summed over all lines: the start of a fainter one is not audible.
/// *Decision.*
const HOVER_OVER_NOISE: f64 = 20.0;
/// Frames of the anchor. *Decision.*
pub(super) const ANCHOR_FRAMES: usize = 10;
/// Smallest share of the anchor's frames in which all rotors are audible. *Decision.*
const ANCHOR_SHARE_MIN: f64 = 0.8;
/// Largest change of a speed from frame to frame, as a share: 3 % per second. *Decision.*
const STEP_SHARE_MAX: f64 = 0.003;
/// A change above this share of the largest is at the limit of its search: the speed may have changed more, and what was found there may
/// be another rotor. *Numeric.*
const AT_LIMIT_SHARE: f64 = 0.95;
/// Distance from the speed at the anchor, as a share, from which on a speed is not searched any more. *Decision.*
const CHANGE_SHARE_MAX: f64 = 0.05;
/// Distance in resolution cells of the highest lines of two rotors, below which one may be mistaken for the other. *Decision.*
const CONFUSED_CELLS: f64 = 1.5;
/// Frames after its onset in which a rotor may be faint, because it runs up. Later it must be audible: else another rotor may have taken its
/// place. *Decision.*
const RUN_UP_FRAMES: usize = 4;
/// Consecutive frames without an audible rotor, after which, back in time, it does not turn. *Decision.*
const LOST_FRAMES: usize = 3;

/// The sound of a spin-up, and the rotors of the hover after it.
pub(super) struct StartSearch {
    pub(super) recording_start_s: f64,
    pub(super) hover_start_s: f64,
    /// All lines of the rotors lie at multiples of this order.
    pub(super) base_order: f64,
    pub(super) lines: JointLines,
    pub(super) curves: Vec<SpeedCurve>,
    /// Mean speed of each rotor in the hover.
    pub(super) speeds_rev_s: Vec<f64>,
    pub(super) frames: Vec<Frame>,
}

/// The rotors in one frame.
#[derive(Clone)]
struct RotorState {
    speeds_rev_s: Vec<f64>,
    /// Powers of [`JointLines::powers`].
    powers: Vec<f64>,
}

/// How the rotors sound: in frames along the tracks, in the hover, and followed back.
struct Followed {
    /// For each frame: the rotors along their tracks; none in gaps and before the tracks.
    tracked: Vec<Option<RotorState>>,
    /// Median power of each rotor in the hover.
    hover_powers: Vec<f64>,
    /// First frame of the anchor.
    anchor: usize,
    /// For each frame before the anchor: the rotors, followed back.
    back: Vec<RotorState>,
}

impl StartSearch {
    /// The start of each rotor, in their sequence, or the reason why one is unknown.
    pub(super) fn starts(&self) -> Result<Vec<RotorStart>, NotTold> {
        let followed = self.follow()?;
        let starts = self.starts_from_powers(&followed)?;
        let interrupted = (0..starts.len()).filter(|&rotor| !self.is_certain(rotor, &followed, &starts)).count();
        if interrupted > 0 {
            return Err(NotTold::NotFollowed { tracks: interrupted });
        }
        match self.other_speed_rev_s(&followed, &starts) {
            Some(speed_rev_s) => Err(NotTold::OtherSpeedBefore { speed_rev_s }),
            None => Ok(starts),
        }
    }

    /// Finds the rotors in all frames: from the tracks to the anchor, and from there back in time.
    fn follow(&self) -> Result<Followed, NotTold> {
        let tracked: Vec<Option<RotorState>> = self.frames.iter().map(|frame| self.tracked(frame)).collect();
        let hover_powers = self.hover_powers(&tracked)?;
        let nothing_followed = NotTold::NotFollowed { tracks: self.curves.len() };
        let Some(anchor) = anchor(&tracked, &hover_powers) else { return Err(nothing_followed) };
        let Some(at_anchor) = &tracked[anchor] else { return Err(nothing_followed) };
        let back = self.followed_back(&at_anchor.speeds_rev_s, anchor, &hover_powers);
        Ok(Followed { tracked, hover_powers, anchor, back })
    }

    /// The rotors in a frame, at the speeds of their tracks.
    fn tracked(&self, frame: &Frame) -> Option<RotorState> {
        let speed_rev_s = |curve: &SpeedCurve| Some(curve.at(frame.middle_s)?.speed_rad_s / TAU);
        let speeds_rev_s: Vec<f64> = self.curves.iter().map(speed_rev_s).collect::<Option<_>>()?;
        let powers = self.lines.powers(frame, &speeds_rev_s);
        Some(RotorState { speeds_rev_s, powers })
    }

    /// Median power of each rotor in the later half of the hover: in the earlier half it may not have started yet.
    fn hover_powers(&self, tracked: &[Option<RotorState>]) -> Result<Vec<f64>, NotTold> {
        let hover_start = self.frames.partition_point(|frame| frame.middle_s < self.hover_start_s);
        let median_power = |rotor: usize| {
            let powers: Vec<f64> = tracked[hover_start..].iter().flatten().map(|state| state.powers[rotor]).collect();
            median(&powers[powers.len() / 2..]).unwrap_or(0.0)
        };
        let hover_powers: Vec<f64> = (0..self.curves.len()).map(median_power).collect();
        let faint = hover_powers.iter().filter(|power| **power < HOVER_OVER_NOISE * self.noise_power()).count();
        if faint > 0 { Err(NotTold::NotFollowed { tracks: faint }) } else { Ok(hover_powers) }
    }

    /// Power of noise alone, summed over the lines, in the unit of all powers.
    fn noise_power(&self) -> f64 {
        self.lines.orders.len() as f64
    }

    /// The rotors in all frames before the anchor, followed from there back in time until each one does not turn. If one sounds again
    /// further back, its lines belong to no known rotor, which [`OtherSpeedSearch`] finds.
    fn followed_back(&self, at_anchor_rev_s: &[f64], anchor: usize, hover_powers: &[f64]) -> Vec<RotorState> {
        let mut speeds = at_anchor_rev_s.to_vec();
        let mut lost = vec![0_usize; speeds.len()];
        let mut states = Vec::with_capacity(anchor);
        for frame in self.frames[..anchor].iter().rev() {
            // a rotor that does not turn would take a share of another one that comes near its last speed
            let turning: Vec<usize> = (0..speeds.len()).filter(|&rotor| lost[rotor] < LOST_FRAMES).collect();
            let expected: Vec<f64> = turning.iter().map(|&rotor| speeds[rotor]).collect();
            let reach = |rotor: &usize| {
                let is_near = (speeds[*rotor] / at_anchor_rev_s[*rotor] - 1.0).abs() < CHANGE_SHARE_MAX;
                if is_near { STEP_SHARE_MAX } else { 0.0 }
            };
            let reach: Vec<f64> = turning.iter().map(reach).collect();
            let found = self.lines.speeds_near(frame, &expected, &reach);
            let mut powers = vec![0.0; speeds.len()];
            for ((&rotor, power), speed) in turning.iter().zip(self.lines.powers(frame, &found)).zip(found) {
                (powers[rotor], speeds[rotor]) = (power, speed);
                lost[rotor] = if power >= AUDIBLE_SHARE * hover_powers[rotor] { 0 } else { lost[rotor] + 1 };
            }
            states.push(RotorState { speeds_rev_s: speeds.clone(), powers });
        }
        states.reverse();
        states
    }

    /// The starts from the onsets of the powers, up to the end of the anchor.
    fn starts_from_powers(&self, followed: &Followed) -> Result<Vec<RotorStart>, NotTold> {
        let Followed { tracked, hover_powers, anchor, back } = followed;
        let states = || back.iter().chain(tracked[*anchor..*anchor + ANCHOR_FRAMES].iter().flatten());
        let first_middle_s = self.frames.first().map_or(0.0, |frame| frame.middle_s);
        let onset = |rotor: usize| {
            let powers: Vec<f64> = states().map(|state| state.powers[rotor]).collect();
            onset_from_powers(&powers, first_middle_s, self.noise_power(), hover_powers[rotor])
        };
        let onsets: Vec<Onset> = (0..self.curves.len()).map(onset).collect();
        let unclear = onsets.iter().filter(|onset| **onset == Onset::Unclear).count();
        if unclear > 0 {
            return Err(NotTold::NotFollowed { tracks: unclear });
        }
        let start = |onset: Onset| match onset {
            Onset::At { time_s, std_s } => RotorStart { time_s, std_uncertainty_s: std_s },
            Onset::BeforeRecording | Onset::Unclear => {
                RotorStart { time_s: self.recording_start_s, std_uncertainty_s: 0.0 }
            }
        };
        Ok(onsets.into_iter().map(start).collect())
    }

    /// Is it the same rotor from its run-up to the anchor? It must be audible in every frame, never near the speed of another rotor, and its
    /// speed must not change twice in a row by the largest step.
    fn is_certain(&self, rotor: usize, followed: &Followed, starts: &[RotorStart]) -> bool {
        let Followed { hover_powers, anchor, back, .. } = followed;
        let onset = self.frames.partition_point(|frame| frame.middle_s < starts[rotor].time_s);
        let from = (onset + RUN_UP_FRAMES).min(*anchor);
        let is_audible = |state: &RotorState| state.powers[rotor] >= AUDIBLE_SHARE * hover_powers[rotor];
        let is_apart = |at: usize| self.is_apart(rotor, &back[at].speeds_rev_s, self.frames[at].middle_s, starts);
        let speeds: Vec<f64> = back[from..].iter().map(|state| state.speeds_rev_s[rotor]).collect();
        let is_jump: Vec<bool> = speeds.windows(2).map(|pair| is_at_limit(pair[0], pair[1])).collect();
        back[from..].iter().all(is_audible)
            && (from..*anchor).all(is_apart)
            && !is_jump.windows(2).any(|pair| pair[0] && pair[1])
    }

    /// Is no other rotor that turns, or starts within a frame, near the speed of this one?
    fn is_apart(&self, rotor: usize, speeds_rev_s: &[f64], time_s: f64, starts: &[RotorStart]) -> bool {
        let highest = self.lines.orders.last().copied().unwrap_or(1.0);
        let is_apart_from = |other: usize| {
            let apart_rev_s = (speeds_rev_s[other] - speeds_rev_s[rotor]).abs();
            let is_there = starts[other].time_s < time_s + FRAME_S;
            other == rotor || !is_there || apart_rev_s * highest * FRAME_S >= CONFUSED_CELLS
        };
        (0..speeds_rev_s.len()).all(is_apart_from)
    }

    /// The speed of lines that no known rotor makes, before the last start.
    fn other_speed_rev_s(&self, followed: &Followed, starts: &[RotorStart]) -> Option<f64> {
        let Followed { tracked, hover_powers, anchor, back } = followed;
        let latest_s = starts.iter().map(|start| start.time_s).fold(f64::NEG_INFINITY, f64::max);
        let known = |frame, state| known_frame(frame, state, starts);
        let before: Vec<KnownFrame<'_>> = self.frames[..*anchor]
            .iter()
            .zip(back)
            .filter(|(frame, _)| frame.middle_s < latest_s)
            .map(|(frame, state)| known(frame, state))
            .collect();
        let hover: Vec<KnownFrame<'_>> = self.frames[*anchor..]
            .iter()
            .zip(&tracked[*anchor..])
            .filter_map(|(frame, state)| Some(known(frame, state.as_ref()?)))
            .collect();
        let search = OtherSpeedSearch {
            lines: &self.lines,
            base_order: self.base_order,
            slowest_rev_s: self.speeds_rev_s.iter().copied().fold(f64::INFINITY, f64::min),
            fastest_rev_s: self.speeds_rev_s.iter().copied().fold(0.0, f64::max),
            faintest_power: hover_powers.iter().copied().fold(f64::INFINITY, f64::min),
        };
        search.speed_rev_s(&before, &hover)
    }
}

/// The first frame from which on all rotors are audible, in it and in most frames of the anchor.
fn anchor(tracked: &[Option<RotorState>], hover_powers: &[f64]) -> Option<usize> {
    let are_audible = |state: &RotorState| {
        state.powers.iter().zip(hover_powers).all(|(power, hover_power)| *power >= AUDIBLE_SHARE * hover_power)
    };
    let is_anchor = |from: &usize| {
        let frames = &tracked[*from..*from + ANCHOR_FRAMES];
        let audible = frames.iter().flatten().filter(|state| are_audible(state)).count();
        frames[0].as_ref().is_some_and(are_audible) && audible as f64 >= ANCHOR_SHARE_MIN * ANCHOR_FRAMES as f64
    };
    (0..(tracked.len() + 1).saturating_sub(ANCHOR_FRAMES)).find(is_anchor)
}

/// A frame with the speeds of the rotors that have started by then.
fn known_frame<'a>(frame: &'a Frame, state: &RotorState, starts: &[RotorStart]) -> KnownFrame<'a> {
    let started = starts.iter().zip(&state.speeds_rev_s).filter(|(start, _)| start.time_s < frame.middle_s + FRAME_S);
    KnownFrame {
        frame,
        speeds_rev_s: started.map(|(_, speed)| *speed).collect(),
        is_run_up: starts.iter().any(|start| (start.time_s - frame.middle_s).abs() < 2.0 * FRAME_S),
    }
}

/// Does a speed change by as much as was searched?
fn is_at_limit(before_rev_s: f64, after_rev_s: f64) -> bool {
    (before_rev_s / after_rev_s - 1.0).abs() > AT_LIMIT_SHARE * STEP_SHARE_MAX
}
