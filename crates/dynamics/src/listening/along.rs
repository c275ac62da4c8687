//! The fit to a recording: listen along the prediction, fit the model to what is heard, and again with more orders.

use super::heard_lines::HeardLines;
use super::mirror::with_positive_gains;
use super::place::{Echoes, echoes_of};
use super::search::{reseated, start_model, with_delay, with_names};
use super::turns::Turns;
use super::window::{Window, likelihood};
use crate::grey_box::{
    GreyBoxConfig, GreyBoxFit, GreyBoxModel, GreyBoxStop, LoopInputs, SpeedObservation, SpeedPrediction, grey_box_near,
};
use nalgebra::{Matrix4, Vector4};
use std::f64::consts::TAU;
use std::ops::Range;

/// Bands about the mean of the predicted speeds, as shares, before the search and after it. *Decision*: mean hover speed, gains and
/// spread may be off.
pub(super) const WIDE_SHARE: f64 = 0.2;
pub(super) const NEAR_SHARE: f64 = 0.06;

/// Settings of listening.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SoundConfig {
    /// Length of a window. *Physics*: the angle of a rotor stays on the prediction for that long; longer windows separate rotors better.
    pub window_s: f64,
    /// Wander of the rotors about the prediction, as a share, before it is known. *Physics*: rotors in flight wander by 0.2 %.
    pub wander_share_first: f64,
    /// Rounds of Newton's method in a window. *Numeric.*
    pub newton_rounds: usize,
    /// Rounds of listening with all lines. *Numeric.*
    pub rounds: usize,
    /// By how much changes of the speed may be early or late at first and in the end; it halves from round to round. *Numeric*: the
    /// steps of the search for delay and time constant; a tenth of the period of a fast controller.
    pub time_error_s_first: f64,
    /// The same in the end.
    pub time_error_s_last: f64,
    /// Half of the range in which the mean hover speed is sought, as a share. *Decision*: mass and C_f by the vehicle's numbers are right to 20 %.
    pub hover_share: f64,
    /// Half of the range of the rotors about their mean, as a share. *Decision.*
    pub spread_share: f64,
    /// Standard uncertainty of the time of changes by echoes, where the place is open. *Physics*: the ground reflects half of the sound 2 ms later.
    pub echo_std_s: f64,
    /// The fit.
    pub fit: GreyBoxConfig,
}

impl Default for SoundConfig {
    fn default() -> Self {
        Self {
            window_s: 0.2,
            wander_share_first: 3e-3,
            newton_rounds: 3,
            rounds: 4,
            time_error_s_first: 4e-3,
            time_error_s_last: 3e-4,
            hover_share: 0.12,
            spread_share: 0.03,
            echo_std_s: 1e-3,
            fit: GreyBoxConfig::default(),
        }
    }
}

/// The fit to a recording.
#[derive(Clone, Debug, PartialEq)]
pub struct SoundFit {
    /// The fit.
    pub fit: GreyBoxFit,
    /// The speeds that were heard.
    pub observations: Vec<SpeedObservation>,
    /// By how much the likelihood falls, in nats, if two rotors swap their names: the smallest over all pairs. Rotors whose hover speeds are equal
    /// need no names.
    pub names_nats: f64,
    /// The echoes of the place; `None` in the open. They are no part of the model.
    pub echoes: Option<Echoes>,
}

/// Fits the model to a recording. `start` is the vehicle by its numbers. `told` gets the finished share after each round.
///
/// # Errors
/// Those of `grey_box_from_speeds`.
pub fn grey_box_from_sound(
    heard: &HeardLines,
    inputs: &LoopInputs,
    start: &GreyBoxModel,
    config: &SoundConfig,
    told: &mut dyn FnMut(f64),
) -> Result<SoundFit, GreyBoxStop> {
    let windows = windows_of(heard, inputs, config.window_s);
    let (mut model, mut names_nats) = (start_model(heard, inputs, start, &windows, config), f64::INFINITY);
    let mut precision = Matrix4::identity() / (config.wander_share_first * start.mean_hover_rad_s()).powi(2);
    let mut rounds = rising_orders(heard);
    rounds.extend(std::iter::repeat_n(f64::INFINITY, config.rounds));
    let (mut last, mut time_error_s) = (None, config.time_error_s_first);
    let (seatings, steps) = (rounds.len() - 2, (rounds.len() + 1) as f64);
    told(1.0 / steps);
    for (round, order_max) in rounds.into_iter().enumerate() {
        let reach = Reach { order_max, time_error_s };
        let near = &heard.followed(&SpeedPrediction::new(inputs, &model), NEAR_SHARE);
        let observations = observe(near, reach, inputs, &model, &windows, &precision, config);
        time_error_s = (0.5 * time_error_s).max(config.time_error_s_last);
        let fit = grey_box_near(&observations, inputs, start, &model, &config.fit)?;
        let upright = with_positive_gains(&fit.model, &inputs.mixer);
        let seated = (round < seatings)
            .then(|| reseated(near, inputs, &upright, &windows, order_max, start, config))
            .flatten()
            .unwrap_or(upright);
        let named = with_names(near, inputs, &seated, &windows, order_max);
        (model, names_nats) = (named.model, named.margin_nats);
        if model == fit.model {
            precision = fit.wander_precision;
        }
        last = Some((fit, observations));
        told((round + 2) as f64 / steps);
    }
    let (fit, observations) = last.ok_or(GreyBoxStop::NotConverged)?;
    let echoes = echoes_of(heard, &fit.prediction(inputs), &windows, &observations);
    let late_s = echoes.map_or(0.0, |echoes| echoes.mean_delay_s()).max(config.echo_std_s);
    let fit = fit.with_time_uncertainty(late_s).with_doppler_uncertainty(inputs.lever_m);
    Ok(SoundFit { fit, observations, names_nats, echoes })
}

/// The speeds of another flight, heard along the prediction of a fitted model, and the prediction. The clocks of log and recording may
/// differ otherwise than in the fit: the delay is sought again.
pub fn speeds_along(
    heard: &HeardLines,
    inputs: &LoopInputs,
    fit: &GreyBoxFit,
    config: &SoundConfig,
) -> (Vec<SpeedObservation>, SpeedPrediction) {
    let windows = windows_of(heard, inputs, config.window_s);
    let model = with_delay(heard, inputs, &fit.model, &windows);
    let prediction = SpeedPrediction::new(inputs, &model);
    let near = heard.followed(&prediction, NEAR_SHARE);
    let reach = Reach { order_max: f64::INFINITY, time_error_s: config.time_error_s_last };
    let precision = Matrix4::identity() / (config.wander_share_first * model.mean_hover_rad_s()).powi(2);
    let observations = observe(&near, reach, inputs, &model, &windows, &precision, config);
    (observations, prediction)
}

/// Blade passes first, then one mesh after the other: a prediction that is right for low orders is near enough for the next.
fn rising_orders(heard: &HeardLines) -> Vec<f64> {
    let mut orders: Vec<f64> = heard.lines.iter().map(|line| line.order).collect();
    orders.sort_by(f64::total_cmp);
    let jumps = orders.windows(2).filter(|pair| pair[1] > 1.5 * pair[0] && pair[0] > 8.0).map(|pair| pair[0]);
    let mut rising: Vec<f64> = jumps.collect();
    rising.insert(0, orders.get(orders.len() / 3).copied().unwrap_or(f64::INFINITY));
    rising
}

/// Windows with the sound and the log, overlapping by half.
fn windows_of(heard: &HeardLines, inputs: &LoopInputs, length_s: f64) -> Vec<Window> {
    let (from_s, to_s) = (heard.start_s.max(inputs.start_s), heard.end_s.min(inputs.end_s()));
    windows_within(from_s, to_s, length_s).into_iter().filter(|window| window.is_known(inputs)).collect()
}

/// Windows of a span, overlapping by half.
pub(super) fn windows_within(from_s: f64, to_s: f64, length_s: f64) -> Vec<Window> {
    let count = ((2.0 * (to_s - from_s) / length_s) as usize).saturating_sub(1);
    let window = |index: usize| Window { time_s: from_s + 0.5 * length_s * (index + 1) as f64, length_s };
    (0..count).map(window).collect()
}

/// Orders for which the prediction is near enough: its angle is right to a quarter of a turn of the line within the window.
#[derive(Clone, Copy, Debug)]
struct Reach {
    order_max: f64,
    /// By how much changes of the speed may come too early or too late.
    time_error_s: f64,
}

impl Reach {
    fn order_max_in(&self, prediction: &SpeedPrediction, window: Window) -> f64 {
        let widest_rad_s = widest_rad_s(prediction, window.span_s());
        self.order_max.min(0.25 * TAU / (widest_rad_s * self.time_error_s))
    }
}

/// Range of the predicted speed within a span, of the rotor that moves most.
pub(super) fn widest_rad_s(prediction: &SpeedPrediction, span_s: Range<f64>) -> f64 {
    let place = |time_s: f64| ((time_s - prediction.start_s) / prediction.step_s).max(0.0) as usize;
    let (from, to) = (place(span_s.start), place(span_s.end));
    let speeds = &prediction.speed_rad_s[from..(to + 1).min(prediction.speed_rad_s.len())];
    let range = |rotor: usize| {
        let of_rotor = || speeds.iter().map(|four| four[rotor]);
        of_rotor().fold(0.0, f64::max) - of_rotor().fold(f64::INFINITY, f64::min)
    };
    (0..4).map(range).fold(0.0, f64::max)
}

/// The speeds of all windows, heard along the prediction of a model.
fn observe(
    heard: &HeardLines,
    reach: Reach,
    inputs: &LoopInputs,
    model: &GreyBoxModel,
    windows: &[Window],
    precision: &Matrix4<f64>,
    config: &SoundConfig,
) -> Vec<SpeedObservation> {
    let prediction = SpeedPrediction::new(inputs, model);
    let turns = Turns::of(&prediction);
    let observation = |window: &Window| {
        let order_max = reach.order_max_in(&prediction, *window);
        let mut offset = Vector4::zeros();
        let mut at = likelihood(heard, order_max, &turns, *window, &offset);
        for _ in 0..config.newton_rounds {
            let Some(inverse) = (at.information + precision).try_inverse() else { break };
            let step = inverse * (at.gradient - precision * offset);
            offset += step;
            at = likelihood(heard, order_max, &turns, *window, &offset);
        }
        // the peak of the window alone: without the pull of the prediction
        let ridge = Matrix4::from_diagonal_element(1e-6 * at.information.trace() + f64::MIN_POSITIVE);
        let inverse = (at.information + ridge).try_inverse().unwrap_or_else(Matrix4::zeros);
        let mut observed = SpeedObservation {
            time_s: window.time_s,
            window_s: window.length_s,
            speed_rad_s: Vector4::zeros(),
            information: at.information,
            overlap_rad_s: -inverse * at.overlap,
        };
        observed.speed_rad_s = observed.of_prediction(&prediction) + offset + inverse * at.gradient;
        observed
    };
    windows.iter().map(observation).collect()
}
