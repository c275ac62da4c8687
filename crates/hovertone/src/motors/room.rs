//! Steps with the echoes of the place: each step's spectra along its curve, and the curve from them.

use hovertone_dynamics::{MotorStep, PLACE, PLACES, PlaceValue, RoomStep, any_place, place_of, StepSpectra, TurnFrame, step_in_room};
use hovertone_rotor_speed::{Error, PathWindow, SpeedPath, ToneConfig, TurnFrames, turn_frames_from_passes};
use hovertone_signal::passes::Passes;
use hovertone_vehicle::{Ending, Estimate};

/// Rounds along the curves of the round before. *Numeric.*
pub(super) const ROUNDS: u32 = 3;
/// Part of the recording around the start of a step. *Physics*: the level before; and τ of a slow motor, with the tail of a room.
const BEFORE_S: f64 = 0.2;
const BEHIND_S: f64 = 0.3;
/// The same in time constants. *Numeric.*
const BEHIND_TIME_CONSTANTS: f64 = 3.0;
/// Time between frames. *Numeric.*
const HOP_S: f64 = 0.015;
/// Step of the path. *Numeric.*
const PATH_STEP_S: f64 = 0.001;
const PATH_MARGIN_S: f64 = 0.5;

/// Fits the steps with a curve again.
pub(super) fn steps_with_echoes(
    passes: &mut Passes<'_>,
    tone: &ToneConfig,
    speed_rev_s: f64,
    steps: &mut [MotorStep],
) -> Result<(), Error> {
    let mut firsts: Vec<MotorStep> = steps.to_vec();
    let mut place = any_place();
    for round in 0..ROUNDS {
        let windows: Vec<PathWindow> = firsts.iter().map(window_of).collect();
        let all = turn_frames_from_passes(passes, tone, speed_rev_s, &windows, PLACES)?;
        let mut all_heard = Vec::new();
        for (((step, first), frames), window) in steps.iter_mut().zip(&mut firsts).zip(all).zip(&windows) {
            let Some(heard) = heard_step(first, frames, window, &place) else { continue };
            all_heard.push(heard);
            let std_s = heard.time_constant_std_share * heard.time_constant_s;
            let estimate = |value: f64, std: f64| Estimate { value, std_uncertainty: Some(std), ending: Ending::Solved };
            if std::env::var("ROOM").is_ok() {
                eprintln!(
                    "{round} at {:.4} -> {:.4} ± {:.4}: {:.2} -> {:.2} ± {:.2} ms, ratio {:.4} of {:.4}, echoes {:.2} {:.0} ms first {:.0} ms cost {:.1} {}",
                    first.time_s.value,
                    heard.start_s,
                    heard.start_std_s,
                    1e3 * first.time_constant_s.map_or(0.0, |told| told.value),
                    1e3 * heard.time_constant_s,
                    1e3 * std_s,
                    heard.ratio,
                    first.speed_to_rev_s / first.speed_from_rev_s,
                    heard.place[0].value.exp(),
                    heard.place[1].value.exp() * 1e3,
                    1e3 * heard.place[2].value.exp(),
                    heard.cost,
                    heard.is_settled
                );
            }
            first.time_s = estimate(heard.start_s, heard.start_std_s);
            first.time_constant_s = Some(estimate(heard.time_constant_s, std_s));
            first.speed_to_rev_s = first.speed_from_rev_s * heard.ratio;
            *step = *first;
        }
        place = place_of(all_heard.iter());
    }
    Ok(())
}

fn window_of(step: &MotorStep) -> PathWindow {
    let start_s = step.time_s.value;
    let time_constant_s = step.time_constant_s.map_or(0.0, |told| told.value);
    let span_s = (start_s - BEFORE_S).max(0.0)..start_s + BEHIND_S + BEHIND_TIME_CONSTANTS * time_constant_s;
    let from_s = span_s.start - PATH_MARGIN_S;
    let count = ((span_s.end + PATH_MARGIN_S - from_s) / PATH_STEP_S) as usize;
    let time_s: Vec<f64> = (0..count).map(|at| from_s + at as f64 * PATH_STEP_S).collect();
    let speed_rev_s = time_s.iter().map(|&at_s| step.speed_rev_s_at(at_s).unwrap_or(step.speed_to_rev_s)).collect();
    PathWindow { span_s, hop_s: HOP_S, path: SpeedPath { time_s, speed_rev_s } }
}

fn heard_step(step: &MotorStep, frames: TurnFrames, window: &PathWindow, place: &[PlaceValue; PLACE]) -> Option<RoomStep> {
    let time_constant_s = step.time_constant_s?.value;
    let frame = |frame: hovertone_rotor_speed::TurnFrame| TurnFrame {
        centre_s: frame.centre_s,
        length_s: frame.length_s,
        place_s: std::array::from_fn(|place| frame.place_s[place]),
        path_rev_s: std::array::from_fn(|place| window.path.at(frame.place_s[place])),
        power: frame.power,
    };
    let spectra = StepSpectra {
        turns: frames.turns,
        first_bin: frames.first_bin,
        orders: frames.orders,
        hop_s: window.hop_s,
        frames: frames.frames.into_iter().map(frame).collect(),
    };
    step_in_room(&spectra, step.time_s.value, time_constant_s, step.speed_from_rev_s, step.speed_to_rev_s, place)
}
