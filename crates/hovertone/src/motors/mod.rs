//! Constants of motors from the sound of steps: the track in short frames and the curves of first order, each made better by the other.
//!
//! The first track is within a few per cent of the speed, and the curves are fitted to it. Along the curves the lines stand still through a step,
//! so that the next track hears them in frames longer than the motor needs. What is left between sound and curves has its least squares where the
//! likelihood of the sound is highest.

mod room;

use hovertone_analysis::{Method, NoTone, Outcome, SpeedAnalysis};
use hovertone_dynamics::{
    CommandSeries, MotorConfig, MotorModel, MotorSeries, MotorStep, offset_of_commands, other_offset_of_commands,
};
use hovertone_rotor_speed::{
    Config, Error, QuickTrack, SpanConfig, SpeedPath, ToneConfig, held_spans_from_passes, passes_of_speed,
    quick_track_along, quick_track_from_passes, speed_from_passes,
};
use hovertone_signal::passes::Passes;
use room::with_echoes;
use std::ops::Range;

pub use hovertone_dynamics::{MotorConstants, StaticMap, StepVerdict, constants_of, motor_from_series};

/// How often the track is made again along the curves. *Numeric.*
const ROUNDS: u32 = 4;
/// Passes of [`motor_from_sound`]. *Numeric.*
pub const PASSES_OF_MOTOR: u32 = hovertone_rotor_speed::PASSES_OF_QUICK_TRACK + ROUNDS + room::ROUNDS as u32;
/// Levels that are heard by themselves where the whole recording has no hover. *Decision.*
const LEVELS_MAX: usize = 4;
/// Step of the path along curves: fine against time constants. *Numeric.*
const PATH_STEP_S: f64 = 0.002;
/// Rows over which the track is smoothed for a path where there is no curve. *Numeric.*
const SMOOTH_ROWS: usize = 5;
/// A curve is used from this time before its start… *Decision.*
const BEFORE_S: f64 = 0.15;
/// …to this many time constants behind it: e⁻⁸ of the step is left. *Numeric.*
const BEHIND_TIME_CONSTANTS: f64 = 8.0;
/// Commands on a clock of their own are put this long before their effect: any dead time will do, since none is told. *Decision.*
const ASSUMED_DEAD_TIME_S: f64 = 0.03;

/// What is known of the sound before its steps are heard.
#[derive(Clone, Debug)]
pub struct HeardTone<'a> {
    /// The tone of the rotors.
    pub tone: &'a ToneConfig,
    /// A speed at which they were heard.
    pub speed_rev_s: f64,
    /// Part of the recording that is searched.
    pub span_s: Range<f64>,
}

/// Commands of the motors, beside a recording.
#[derive(Clone, Copy, Debug)]
pub struct HeardCommands<'a> {
    /// The commands, on a clock of their own.
    pub series: CommandSeries<'a>,
    /// Time to be added to that clock to get the recording's, where it is known: dead times are told then.
    pub offset_s: Option<f64>,
}

/// A speed at which rotors are heard in a recording whose speed steps: that of its hover, else of the longest levels. `None` with the reason of the
/// whole recording if there is none. Passes are announced as they are needed.
///
/// # Errors
/// As [`hovertone_rotor_speed::speed_from_source`].
pub fn level_of_rotors(passes: &mut Passes<'_>, config: &Config) -> Result<Result<f64, NoTone>, Error> {
    let config = Config { method: Method::Harmonic, ..config.clone() };
    let whole = speed_from_passes(passes, &config)?;
    let reason = match level_of_analysis(&whole) {
        Ok(speed_rev_s) => return Ok(Ok(speed_rev_s)),
        Err(reason) => reason,
    };
    // a level at 50 or 60 rev/s passes for mains hum by itself, and another one is heard better
    let hum = passes.left_out().cloned();
    passes.expect_more(1);
    let spans = held_spans_from_passes(passes, &config.tone, whole.heard.from_s..whole.heard.to_s)?;
    let mut level = Err(reason);
    for span in spans.into_iter().take(LEVELS_MAX) {
        passes.expect_more(passes_of_speed(&config));
        let span = SpanConfig { from_s: Some(span.start), to_s: Some(span.end) };
        let heard = level_of_analysis(&speed_from_passes(passes, &Config { span, ..config.clone() })?);
        if heard.is_ok() && passes.left_out().is_some() == hum.is_some() {
            level = heard;
            break;
        }
    }
    passes.leave_out(hum);
    Ok(level)
}

/// The speed of an analysis, or its reason.
pub fn level_of_analysis(analysis: &SpeedAnalysis) -> Result<f64, NoTone> {
    match &analysis.outcome {
        Outcome::Ok(found) => found.speed(Method::Harmonic).map(|speed| speed.speed.rev_s()).ok_or(NoTone::Silence),
        Outcome::NoRotorTone { reason } => Err(reason.clone()),
    }
}

/// The motors of a recording: all rotors move together.
#[derive(Clone, Debug, Default)]
pub struct HeardMotor {
    /// Middle of each frame with a speed.
    pub time_s: Vec<f64>,
    /// Its speed, as the frame sees it.
    pub speed_rev_s: Vec<f64>,
    /// Length of a frame.
    pub frame_s: f64,
    /// Steps and static map; `None` where no rotor is heard for long enough.
    pub model: Option<MotorModel>,
    /// Time that was added to commands on a clock of their own; `None` where no such commands are given, or no offset is clear.
    pub offset_s: Option<f64>,
    /// Offset at which the steps of commands and sound agree, where the given one is impossible: the commands are not used then.
    pub other_offset_s: Option<f64>,
}

/// The steps of the motors in a recording; [`PASSES_OF_MOTOR`] passes.
///
/// # Errors
/// A source that fails.
pub fn motor_from_sound(
    passes: &mut Passes<'_>,
    heard: &HeardTone<'_>,
    commands: Option<HeardCommands<'_>>,
) -> Result<HeardMotor, Error> {
    let &HeardTone { tone, speed_rev_s, ref span_s } = heard;
    let mut motor = motor_of_track(&quick_track_from_passes(passes, tone, speed_rev_s, span_s.clone())?);
    for _ in 0..ROUNDS {
        let Some(path) = path_of(&motor) else { break };
        motor = motor_of_track(&quick_track_along(passes, tone, speed_rev_s, span_s.clone(), &path)?);
    }
    if let Some(commands) = commands {
        motor = with_commands(motor, commands);
    }
    if let Some(model) = &mut motor.model {
        with_echoes(passes, tone, speed_rev_s, &mut model.steps)?;
    }
    Ok(motor)
}

fn motor_of_track(track: &QuickTrack) -> HeardMotor {
    let time_s: Vec<f64> = track.stretches.iter().flat_map(|stretch| stretch.time_s.clone()).collect();
    let speed_rev_s: Vec<f64> = track.stretches.iter().flat_map(|stretch| stretch.speed_rev_s.clone()).collect();
    let motor = HeardMotor { time_s, speed_rev_s, frame_s: track.frame_s, ..HeardMotor::default() };
    HeardMotor { model: model_of(&motor, None), ..motor }
}

fn model_of(motor: &HeardMotor, command: Option<CommandSeries<'_>>) -> Option<MotorModel> {
    let config = MotorConfig { frame_s: motor.frame_s, ..MotorConfig::default() };
    let series = MotorSeries { time_s: &motor.time_s, speed_rev_s: &motor.speed_rev_s };
    let model = motor_from_series(series, command, &config)?;
    // where no motor turns, the track follows other sound: only what the steps lead to is a speed of the motor
    let levels = model.steps.iter().map(|step| step.speed_from_rev_s.max(step.speed_to_rev_s));
    let speed_rev_s_max = levels.reduce(f64::max).unwrap_or(model.speed_rev_s_max);
    Some(MotorModel { speed_rev_s_max, ..model })
}

fn with_commands(motor: HeardMotor, commands: HeardCommands<'_>) -> HeardMotor {
    let shifted =
        |offset_s: f64| -> Vec<f64> { commands.series.time_s.iter().map(|time_s| time_s + offset_s).collect() };
    let steps = motor.model.as_ref().map_or(&[][..], |model| &model.steps);
    if let Some(offset_s) = commands.offset_s {
        let other_offset_s = other_offset_of_commands(steps, &commands.series, offset_s, &MotorConfig::default());
        if other_offset_s.is_some() {
            return HeardMotor { other_offset_s, ..motor };
        }
        let time_s = shifted(offset_s);
        let series = CommandSeries { time_s: &time_s, ..commands.series };
        return HeardMotor { model: model_of(&motor, Some(series)), ..motor };
    }
    let Some(offset_s) = offset_of_commands(steps, &commands.series, &MotorConfig::default()) else { return motor };
    let time_s = shifted(offset_s - ASSUMED_DEAD_TIME_S);
    let mut model = model_of(&motor, Some(CommandSeries { time_s: &time_s, ..commands.series }));
    model.iter_mut().flat_map(|model| &mut model.steps).for_each(|step| step.dead_time_s = None);
    HeardMotor { model, offset_s: Some(offset_s), ..motor }
}

/// The curves of the steps, and the track where there is none; `None` without any curve.
fn path_of(motor: &HeardMotor) -> Option<SpeedPath> {
    let steps: Vec<&MotorStep> =
        motor.model.as_ref()?.steps.iter().filter(|step| step.time_constant_s.is_some()).collect();
    let (&first_s, &last_s) = (motor.time_s.first()?, motor.time_s.last()?);
    steps.first()?;
    let track = SpeedPath { time_s: motor.time_s.clone(), speed_rev_s: smoothed(&motor.speed_rev_s) };
    let count = ((last_s - first_s) / PATH_STEP_S) as usize + 1;
    let time_s: Vec<f64> = (0..count).map(|at| first_s + at as f64 * PATH_STEP_S).collect();
    let mut at = 0;
    let speed = |&time_s: &f64| {
        while steps.get(at + 1).is_some_and(|next| time_s >= next.time_s.value - BEFORE_S) {
            at += 1;
        }
        curve_at(steps[at], time_s).unwrap_or_else(|| track.at(time_s))
    };
    Some(SpeedPath { speed_rev_s: time_s.iter().map(speed).collect(), time_s })
}

/// The speed of a step's curve near the step.
fn curve_at(step: &MotorStep, time_s: f64) -> Option<f64> {
    let since_s = time_s - step.time_s.value;
    let is_near = since_s >= -BEFORE_S && since_s <= BEHIND_TIME_CONSTANTS * step.time_constant_s?.value;
    is_near.then(|| step.speed_rev_s_at(time_s)).flatten()
}

fn smoothed(values: &[f64]) -> Vec<f64> {
    let half = SMOOTH_ROWS / 2;
    let mean = |at: usize| {
        let near = &values[at.saturating_sub(half)..(at + half + 1).min(values.len())];
        near.iter().sum::<f64>() / near.len() as f64
    };
    (0..values.len()).map(mean).collect()
}
