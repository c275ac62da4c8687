//! The rotors of a hover followed back in time to their starts.

use super::frames::{FRAME_S, Frames, HOP_S, noise_of};
use super::lines::Lines;
use super::onset::{Begin, HEARD_SHARE, begin_of};
use super::other_speed::{Followed, other_speed_rev_s};
use super::{RotorBegin, SpinUp};
use crate::speed_curve::SpeedCurve;
use hovertone_analysis::{Hover, NotTold, RotorEstimate, Span};
use hovertone_rotor_speed::{ToneConfig, blades_known};
use hovertone_signal::passes::StretchListener;
use hovertone_signal::statistics::median;
use hovertone_vehicle::BLADES_MAX;
use std::f64::consts::TAU;

/// So much of the hover is heard too: who each track is, and how loud.
const INTO_HOVER_S: f64 = 10.0;
/// Motors are started within this time.
pub(super) const SPIN_UP_S_MAX: f64 = 60.0;
/// A longer way from the hover back to the start is not followed.
const SPAN_S_MAX: f64 = 2.0 * SPIN_UP_S_MAX;
/// Lines of two rotors are of use from the order at which they lie so many resolutions apart.
const APART_CELLS: f64 = 1.5;
/// How many of those lines, and the highest order of blades: higher ones smear within a frame.
const LINES_MAX: usize = 10;
const BLADE_ORDER_MAX: f64 = 40.0;
const LINES_MIN: usize = 2;
/// In the hover each rotor must be so much louder than noise over all its lines, or its begin is not heard.
const TYPICAL_OVER_NOISE: f64 = 20.0;
/// All rotors are there if they are heard in this share of so many frames in a row.
const ANCHOR_FRAMES: usize = 10;
const ANCHOR_SHARE: f64 = 0.8;
/// A speed changes by no more than this from frame to frame, and in all.
const REACH_SHARE: f64 = 0.003;
const CHANGE_SHARE_MAX: f64 = 0.05;
/// Two rotors that come closer to each other than so many resolutions of the highest line may be taken for one another.
const CLOSE_CELLS: f64 = 1.5;
/// A rotor may be faint for so many frames while it runs up, and for none after that: it may have been another one since.
const RUN_UP_FRAMES: usize = 4;
/// A rotor that is not heard in so many frames in a row does not turn yet.
const LOST_FRAMES: usize = 3;

/// The rotors whose starts are wanted.
pub(super) struct SpinUpWanted<'a> {
    pub(super) sample_rate_hz: f64,
    pub(super) heard: Span,
    pub(super) rotor_count: usize,
    pub(super) tone: &'a ToneConfig,
}

/// Whether a speed went as far as it was looked for: it may have gone further, and what was found there may be another rotor.
fn is_at_reach(before: f64, after: f64) -> bool {
    (before / after - 1.0).abs() > 0.95 * REACH_SHARE
}

/// Hears the rotors begin, whose speeds in the hover are known.
pub(super) struct SpinUpReader {
    pub(super) span: Span,
    /// Where the hover begins.
    hover_s: f64,
    base_order: f64,
    orders: Vec<f64>,
    curves: Vec<SpeedCurve>,
    speeds_rev_s: Vec<f64>,
    frames: Frames,
}

impl StretchListener for SpinUpReader {
    fn restart(&mut self, _: f64, _: f64) {}
    fn push(&mut self, samples: &[f32]) {
        self.frames.push(samples);
    }
}

impl SpinUpReader {
    pub(super) fn new(wanted: &SpinUpWanted<'_>, hover: &Hover, rotors: &[RotorEstimate]) -> Result<Self, NotTold> {
        let SpinUpWanted { sample_rate_hz, heard, rotor_count, tone } = *wanted;
        if rotors.len() != rotor_count {
            return Err(NotTold::TooFewTracks { tracks: rotors.len(), needed: rotor_count });
        }
        let longest = hover.segments.iter().max_by(|a, b| a.length_s().total_cmp(&b.length_s()));
        let longest = longest.copied().unwrap_or(heard);
        let span = Span { from_s: heard.from_s, to_s: longest.to_s.min(longest.from_s + INTO_HOVER_S) };
        // where nothing was cut away, motors may start anywhere in it
        let span =
            if longest.from_s - heard.from_s < INTO_HOVER_S { Span { to_s: longest.to_s, ..span } } else { span };
        let span = Span { to_s: span.to_s.min(span.from_s + SPAN_S_MAX), ..span };
        if span.to_s <= longest.from_s + ANCHOR_FRAMES as f64 * HOP_S {
            return Err(NotTold::SpinUpTooLong { before_hover_s: longest.from_s - heard.from_s });
        }
        let speeds_rev_s: Vec<f64> = rotors.iter().map(|rotor| rotor.speed.speed.rev_s()).collect();
        let mut sorted = speeds_rev_s.clone();
        sorted.sort_by(f64::total_cmp);
        let apart_rev_s = sorted.windows(2).map(|pair| pair[1] - pair[0]).fold(f64::INFINITY, f64::min);
        let fastest_rev_s = sorted.last().copied().unwrap_or(0.0);
        let tone_order = tone.order.lines_per_turn();
        let base_order = blades_known(tone).map_or(tone_order, f64::from);
        let order_max = if base_order > BLADES_MAX { 2.0 * base_order } else { BLADE_ORDER_MAX };
        let highest = order_max.min(0.4 * sample_rate_hz / fastest_rev_s.max(f64::MIN_POSITIVE));
        let orders: Vec<f64> = (1..)
            .map(|multiple| base_order * f64::from(multiple))
            .take_while(|order| *order <= highest)
            .filter(|order| order * apart_rev_s * FRAME_S >= APART_CELLS)
            .take(LINES_MAX)
            .collect();
        if orders.len() < LINES_MIN {
            return Err(NotTold::RotorsTooClose { apart_rev_s });
        }
        let high_hz = 1.2 * fastest_rev_s * orders.last().copied().unwrap_or(highest);
        Ok(Self {
            span,
            hover_s: longest.from_s,
            base_order,
            orders,
            curves: rotors.iter().map(|rotor| SpeedCurve::through(&rotor.track)).collect(),
            speeds_rev_s,
            frames: Frames::new(sample_rate_hz, span.from_s, high_hz),
        })
    }

    pub(super) fn finish(self) -> SpinUp {
        self.begins().unwrap_or_else(SpinUp::not_told)
    }

    fn begins(&self) -> Result<SpinUp, NotTold> {
        let frames = &self.frames.frames;
        let rotors = self.curves.len();
        let mean_rev_s = self.speeds_rev_s.iter().sum::<f64>() / rotors.max(1) as f64;
        let in_hover = frames.partition_point(|frame| frame.middle_s < self.hover_s);
        let noise = self.orders.iter().map(|order| noise_of(&frames[in_hover..], order * mean_rev_s)).collect();
        let lines = Lines { orders: self.orders.clone(), noise };
        let floor = lines.orders.len() as f64;
        // by the tracks, as far as they go
        let tracked: Vec<Option<Vec<f64>>> = frames.iter().map(|frame| self.tracked_rev_s(frame.middle_s)).collect();
        let powers: Vec<Option<Vec<f64>>> = frames
            .iter()
            .zip(&tracked)
            .map(|(frame, speeds)| speeds.as_ref().map(|speeds| lines.powers(frame, speeds)))
            .collect();
        let of_rotor =
            |rotor: usize| -> Vec<f64> { powers[in_hover..].iter().flatten().map(|all| all[rotor]).collect() };
        // the later half: in the earlier one rotors may not yet be there
        let typical: Vec<f64> = (0..rotors)
            .map(|rotor| {
                let all = of_rotor(rotor);
                median(&all[all.len() / 2..]).unwrap_or(0.0)
            })
            .collect();
        let not_followed = |tracks: usize| NotTold::NotFollowed { tracks };
        let faint = typical.iter().filter(|typical| **typical < TYPICAL_OVER_NOISE * floor).count();
        if faint > 0 {
            return Err(not_followed(faint));
        }
        let are_heard =
            |powers: &Vec<f64>| powers.iter().zip(&typical).all(|(power, typical)| *power >= HEARD_SHARE * typical);
        let is_anchor = |from: &usize| {
            let window = &powers[*from..*from + ANCHOR_FRAMES];
            let heard = window.iter().flatten().filter(|powers| are_heard(powers)).count();
            window[0].as_ref().is_some_and(are_heard) && heard as f64 >= ANCHOR_SHARE * ANCHOR_FRAMES as f64
        };
        let anchor = (0..frames.len().saturating_sub(ANCHOR_FRAMES)).find(is_anchor).ok_or(not_followed(rotors))?;
        let at_anchor = tracked[anchor].clone().ok_or(not_followed(rotors))?;
        let (speeds, mut levels) = self.followed_back(&lines, &at_anchor, anchor, &typical);
        levels.extend(powers[anchor..anchor + ANCHOR_FRAMES].iter().flatten().cloned());
        let first_s = frames.first().map_or(0.0, |frame| frame.middle_s);
        let begins: Vec<Begin> = (0..rotors)
            .map(|rotor| {
                let own: Vec<f64> = levels.iter().map(|all| all[rotor]).collect();
                begin_of(&own, first_s, floor, typical[rotor])
            })
            .collect();
        let unclear = begins.iter().filter(|begin| **begin == Begin::Unclear).count();
        if unclear > 0 {
            return Err(not_followed(unclear));
        }
        let begins: Vec<RotorBegin> = begins.into_iter().map(|begin| self.told(begin)).collect();
        let frame_at = |time_s: f64| frames.partition_point(|frame| frame.middle_s < time_s);
        let is_heard_throughout = |rotor: &usize| {
            let from = frame_at(begins[*rotor].time_s) + RUN_UP_FRAMES;
            let level = |frame: &Vec<f64>| frame[*rotor] >= HEARD_SHARE * typical[*rotor];
            let is_alone = |at: usize| self.is_alone(*rotor, &speeds[at], frames[at].middle_s, &begins);
            let own: Vec<f64> = speeds[from.min(anchor)..].iter().map(|speeds| speeds[*rotor]).collect();
            let steps: Vec<bool> = own.windows(2).map(|pair| is_at_reach(pair[0], pair[1])).collect();
            levels[from.min(anchor)..anchor].iter().all(level)
                && (from..anchor).all(is_alone)
                && !steps.windows(2).any(|pair| pair[0] && pair[1])
        };
        let interrupted = rotors - (0..rotors).filter(is_heard_throughout).count();
        if interrupted > 0 {
            return Err(not_followed(interrupted));
        }
        let latest_s = begins.iter().map(|begin| begin.time_s).fold(f64::NEG_INFINITY, f64::max);
        let followed = |at: usize, speeds: &[f64]| {
            let middle_s = frames[at].middle_s;
            let heard = begins.iter().zip(speeds).filter(|(begin, _)| begin.time_s < middle_s + FRAME_S);
            Followed {
                frame: &frames[at],
                speeds_rev_s: heard.map(|(_, speed)| *speed).collect(),
                is_changing: begins.iter().any(|begin| (begin.time_s - middle_s).abs() < 2.0 * FRAME_S),
            }
        };
        let before: Vec<Followed> =
            (0..anchor).filter(|&at| frames[at].middle_s < latest_s).map(|at| followed(at, &speeds[at])).collect();
        let hover: Vec<Followed> =
            (anchor..frames.len()).filter_map(|at| Some(followed(at, tracked[at].as_ref()?))).collect();
        let limits = (
            self.speeds_rev_s.iter().copied().fold(f64::INFINITY, f64::min),
            self.speeds_rev_s.iter().copied().fold(0.0, f64::max),
        );
        let faintest = typical.iter().copied().fold(f64::INFINITY, f64::min);
        match other_speed_rev_s(&before, &hover, &lines, self.base_order, limits, faintest) {
            Some(speed_rev_s) => Err(NotTold::OtherSpeedBefore { speed_rev_s }),
            None => Ok(SpinUp { begins, not_told: None }),
        }
    }

    fn tracked_rev_s(&self, time_s: f64) -> Option<Vec<f64>> {
        self.curves.iter().map(|curve| Some(curve.at(time_s)?.speed_rad_s / TAU)).collect()
    }

    /// Speeds and powers of all frames before the anchor, from there back in time until each rotor is gone. Should one come back, nobody
    /// accounts for its lines, and that is seen.
    fn followed_back(
        &self,
        lines: &Lines,
        at_anchor: &[f64],
        anchor: usize,
        typical: &[f64],
    ) -> (Vec<Vec<f64>>, Vec<Vec<f64>>) {
        let mut speeds = at_anchor.to_vec();
        let mut lost = vec![0_usize; speeds.len()];
        let (mut all_speeds, mut all_powers) = (Vec::with_capacity(anchor), Vec::with_capacity(anchor + ANCHOR_FRAMES));
        for frame in self.frames.frames[..anchor].iter().rev() {
            // one that is gone would only take a share of whoever comes near its last speed
            let there: Vec<usize> = (0..speeds.len()).filter(|&rotor| lost[rotor] < LOST_FRAMES).collect();
            let expected: Vec<f64> = there.iter().map(|&rotor| speeds[rotor]).collect();
            let reach = |rotor: &usize| {
                let is_near = (speeds[*rotor] / at_anchor[*rotor] - 1.0).abs() < CHANGE_SHARE_MAX;
                if is_near { REACH_SHARE } else { 0.0 }
            };
            let reach: Vec<f64> = there.iter().map(reach).collect();
            let found = lines.followed(frame, &expected, &reach);
            let mut powers = vec![0.0; speeds.len()];
            for ((&rotor, power), speed) in there.iter().zip(lines.powers(frame, &found)).zip(found) {
                (powers[rotor], speeds[rotor]) = (power, speed);
                lost[rotor] = if power >= HEARD_SHARE * typical[rotor] { 0 } else { lost[rotor] + 1 };
            }
            all_speeds.push(speeds.clone());
            all_powers.push(powers);
        }
        all_speeds.reverse();
        all_powers.reverse();
        (all_speeds, all_powers)
    }

    /// Whether no other rotor that turns, or is about to, is at its speed or nearly.
    fn is_alone(&self, rotor: usize, speeds_rev_s: &[f64], time_s: f64, begins: &[RotorBegin]) -> bool {
        let highest = self.orders.last().copied().unwrap_or(1.0);
        let is_apart = |other: usize| {
            let apart_rev_s = (speeds_rev_s[other] - speeds_rev_s[rotor]).abs();
            let is_there = begins[other].time_s < time_s + FRAME_S;
            other == rotor || !is_there || apart_rev_s * highest * FRAME_S >= CLOSE_CELLS
        };
        (0..speeds_rev_s.len()).all(is_apart)
    }

    fn told(&self, begin: Begin) -> RotorBegin {
        match begin {
            Begin::At { time_s, std_s } => RotorBegin { time_s, std_uncertainty_s: std_s },
            Begin::Before | Begin::Unclear => RotorBegin { time_s: self.span.from_s, std_uncertainty_s: 0.0 },
        }
    }
}
