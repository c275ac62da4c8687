//! Steps with the echoes of their place: each step's spectra along its curve, and the curve from them.

use hovertone_dynamics::{
    MotorStep, PLACES, PlaceBelief, RoomCurve, RoomRequest, RoomStep, StepSpectra, StepVerdict, TurnFrame, any_place,
    place_of, step_in_room,
};
use hovertone_rotor_speed::{Error, PathWindow, SpeedPath, ToneConfig, TurnFrames, turn_frames_from_passes};
use hovertone_signal::passes::Passes;
use hovertone_signal::statistics::median;
use hovertone_vehicle::{Ending, Estimate};

/// Rounds along the curves of the round before. *Numeric.*
pub(super) const ROUNDS: usize = 3;
/// Part of the recording around the start of a step, for the level before and the tail of a room. *Decision.*
const BEFORE_S: f64 = 0.2;
const BEHIND_S: f64 = 0.3;
/// The part behind has as many time constants more. *Numeric.*
const BEHIND_TIME_CONSTANTS: f64 = 3.0;
/// Time between frames: a fifth of a frame. *Numeric.*
const HOP_S: f64 = 0.015;
/// Step of a path, and its length beyond the part that is heard. *Numeric.*
const PATH_STEP_S: f64 = 0.001;
const PATH_MARGIN_S: f64 = 0.5;
/// Power of the echoes over the direct sound below which a place is open: the likeness of frames tells τ better there. *Decision.*
const OPEN_RATIO: f64 = 0.1;
/// Shortest time constant over the length of a frame: a faster change is the path that jumps to half the speed, and no motor. *Decision.*
const TIME_CONSTANT_SHARE_MIN: f64 = 0.25;
/// A step is tried with τ of the others where it differs by this share. *Decision.*
const OTHER_SHARE: f64 = 0.08;

/// Fits the steps with a curve again, in rounds. In the open they stay as they are.
pub(super) fn with_echoes(
    passes: &mut Passes<'_>,
    tone: &ToneConfig,
    speed_rev_s: f64,
    steps: &mut [MotorStep],
) -> Result<(), Error> {
    let mut place = any_place();
    let mut curves: Vec<Option<RoomCurve>> = steps.iter().map(curve_of).collect();
    let mut heard: Vec<Option<RoomStep>> = Vec::new();
    for round in 0..ROUNDS {
        let windows: Vec<PathWindow> = curves.iter().flatten().map(window_of).collect();
        let mut frames =
            turn_frames_from_passes(passes, tone, speed_rev_s, &windows, PLACES)?.into_iter().zip(&windows);
        heard.clear();
        for curve in &curves {
            let Some((curve, (frames, window))) = curve.as_ref().and_then(|curve| Some((curve, frames.next()?))) else {
                heard.push(None);
                continue;
            };
            let other_time_constant_s = if round > 0 { other_time_constant_s(&curves, curve) } else { None };
            let request = RoomRequest { curve: *curve, place, other_time_constant_s };
            let spectra = spectra_of(frames, window);
            let shortest_s = TIME_CONSTANT_SHARE_MIN * spectra.frames.first().map_or(0.0, |frame| frame.length_s);
            let is_motor = |step: &RoomStep| step.curve.time_constant_s > shortest_s;
            heard.push(step_in_room(&spectra, &request).filter(is_motor));
        }
        let told: Vec<RoomStep> = heard.iter().flatten().copied().collect();
        place = place_of(&told, &place);
        if is_open(&place) {
            return Ok(());
        }
        curves = heard.iter().map(|step| step.map(|step| step.curve)).collect();
    }
    for (step, heard) in steps.iter_mut().zip(heard).filter(|(step, _)| step.time_constant_s.is_some()) {
        *step = heard.map_or_else(|| without_curve(step), |heard| with_curve(step, &heard));
    }
    Ok(())
}

fn is_open(place: &PlaceBelief) -> bool {
    place[0].value < OPEN_RATIO.ln()
}

fn curve_of(step: &MotorStep) -> Option<RoomCurve> {
    Some(RoomCurve {
        start_s: step.time_s.value,
        time_constant_s: step.time_constant_s?.value,
        from_rev_s: step.speed_from_rev_s,
        to_rev_s: step.speed_to_rev_s,
    })
}

fn with_curve(step: &MotorStep, heard: &RoomStep) -> MotorStep {
    let estimate = |value: f64, std: f64| Estimate { value, std_uncertainty: Some(std), ending: Ending::Solved };
    let later_s = heard.curve.start_s - step.time_s.value;
    let dead_time = |told: Estimate| {
        let std_s = told.std_uncertainty.unwrap_or(0.0).hypot(heard.start_std_s);
        estimate(told.value + later_s, std_s)
    };
    MotorStep {
        dead_time_s: step.dead_time_s.map(dead_time),
        time_s: estimate(heard.curve.start_s, heard.start_std_s),
        time_constant_s: Some(estimate(heard.curve.time_constant_s, heard.time_constant_std_s)),
        speed_to_rev_s: heard.curve.to_rev_s,
        verdict: StepVerdict::Used,
        ..*step
    }
}

fn without_curve(step: &MotorStep) -> MotorStep {
    MotorStep { time_constant_s: None, dead_time_s: None, verdict: StepVerdict::OtherCurve, ..*step }
}

/// The median τ of the other steps of this sense, where it differs.
fn other_time_constant_s(curves: &[Option<RoomCurve>], curve: &RoomCurve) -> Option<f64> {
    let is_up = |curve: &RoomCurve| curve.to_rev_s > curve.from_rev_s;
    let others = curves.iter().flatten().filter(|other| *other != curve && is_up(other) == is_up(curve));
    let other_s = median(&others.map(|other| other.time_constant_s).collect::<Vec<_>>())?;
    ((other_s / curve.time_constant_s).ln().abs() > OTHER_SHARE).then_some(other_s)
}

fn window_of(curve: &RoomCurve) -> PathWindow {
    let behind_s = BEHIND_S + BEHIND_TIME_CONSTANTS * curve.time_constant_s;
    let span_s = (curve.start_s - BEFORE_S).max(0.0)..curve.start_s + behind_s;
    let from_s = span_s.start - PATH_MARGIN_S;
    let count = ((span_s.end + PATH_MARGIN_S - from_s) / PATH_STEP_S) as usize;
    let time_s: Vec<f64> = (0..count).map(|at| from_s + at as f64 * PATH_STEP_S).collect();
    let speed_rev_s = time_s.iter().map(|&at_s| curve.at(at_s)).collect();
    PathWindow { span_s, hop_s: HOP_S, path: SpeedPath { time_s, speed_rev_s } }
}

fn spectra_of(frames: TurnFrames, window: &PathWindow) -> StepSpectra {
    let frame = |frame: hovertone_rotor_speed::TurnFrame| TurnFrame {
        centre_s: frame.centre_s,
        length_s: frame.length_s,
        place_s: std::array::from_fn(|place| frame.place_s[place]),
        path_rev_s: std::array::from_fn(|place| window.path.at(frame.place_s[place])),
        power: frame.power,
    };
    StepSpectra {
        turns: frames.turns,
        first_bin: frames.first_bin,
        orders: frames.orders,
        hop_s: window.hop_s,
        frames: frames.frames.into_iter().map(frame).collect(),
    }
}
