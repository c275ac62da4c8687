//! Where the fit starts: hover speeds, sizes of the gains, and which rotor is which, by the likelihood of the sound.

use super::along::{NEAR_SHARE, SoundConfig, WIDE_SHARE, widest_rad_s};
use super::heard_lines::HeardLines;
use super::turns::Turns;
use super::window::{Window, likelihood_value};
use crate::grey_box::{GreyBoxModel, LoopInputs, SpeedPrediction};
use hovertone_vehicle::Axis;
use nalgebra::Vector4;
use std::f64::consts::TAU;

/// Highest order of the search over the whole flight: the blade passes. *Physics.*
pub(super) const ORDER_MAX: f64 = 24.0;
/// Highest order of the search in hover: the first mesh. *Physics.*
const HOVER_ORDER_MAX: f64 = 100.0;
/// Windows of hover, and their length in windows of the flight. *Numeric*: longer ones separate rotors better.
const HOVER_WINDOWS: usize = 12;
const HOVER_LENGTH: f64 = 2.0;
/// Most windows of the search. *Numeric.*
const WINDOWS_MAX: usize = 120;
/// Step of the speed, in widths of a window's main lobe at the highest order. *Numeric.*
const STEP_SHARE: f64 = 0.35;
/// Factors of the gains that are tried. *Decision*: controllers differ from the vehicle's numbers by less than a factor of three.
const GAIN_FACTORS: [f64; 9] = [0.33, 0.5, 0.66, 0.8, 1.0, 1.25, 1.5, 2.0, 3.0];
/// Factors of the time constant that are tried. *Decision.*
const TIME_FACTORS: [f64; 7] = [0.4, 0.6, 0.8, 1.0, 1.3, 1.7, 2.4];
/// Delays that are tried, in steps, and the step, s: sound needs 3 ms per metre, and filters and ESCs up to 50 ms. *Physics.*
const DELAYS: [i8; 16] = [-8, -4, -2, -1, 0, 1, 2, 3, 4, 5, 6, 8, 10, 12, 16, 20];
const DELAY_STEP_S: f64 = 0.003;
/// Candidates of a rotor that is sought again, and steps to both sides of each. *Numeric.*
const CANDIDATES: usize = 3;
const FINE_STEPS: i32 = 3;
/// By how much the sound must be more likely with another model than with the one so far, nats. *Decision.*
pub(super) const BETTER_NATS: f64 = 20.0;
/// Sweeps over rotors and loops. *Numeric.*
const SWEEPS: usize = 2;

/// Logarithm of the likelihood of the windows along a model's prediction.
fn score(heard: &HeardLines, order_max: f64, inputs: &LoopInputs, model: &GreyBoxModel, windows: &[Window]) -> f64 {
    nats_along(heard, order_max, &SpeedPrediction::new(inputs, model), windows)
}

/// Logarithm of the likelihood of the windows along a prediction.
pub(super) fn nats_along(heard: &HeardLines, order_max: f64, prediction: &SpeedPrediction, windows: &[Window]) -> f64 {
    let turns = Turns::of(prediction);
    windows.iter().map(|window| likelihood_value(heard, order_max, &turns, *window, &Vector4::zeros())).sum()
}

/// The most likely of several models.
fn best(models: impl Iterator<Item = GreyBoxModel>, score: impl Fn(&GreyBoxModel) -> f64) -> Option<GreyBoxModel> {
    let scored = models.map(|model| (score(&model), model));
    scored.max_by(|a, b| a.0.total_cmp(&b.0)).map(|(_, model)| model)
}

/// A start from which listening along the prediction converges.
pub(super) fn start_model(
    heard: &HeardLines,
    inputs: &LoopInputs,
    start: &GreyBoxModel,
    windows: &[Window],
    config: &SoundConfig,
) -> GreyBoxModel {
    let windows = thinned(windows);
    let wide = heard.followed(&SpeedPrediction::new(inputs, start), WIDE_SHARE);
    let mut model = same_hover(&wide, inputs, start, &windows, config);
    let near = heard.followed(&SpeedPrediction::new(inputs, &model), NEAR_SHARE);
    model = four_hovers(&near, inputs, &model, &windows, config);
    let score = |model: &GreyBoxModel| score(&wide, ORDER_MAX, inputs, model, &windows);
    for _ in 0..SWEEPS {
        model = swapped(&model, score).model;
        let late = DELAYS.map(|step| {
            let delay_s = DELAY_STEP_S * f64::from(step);
            GreyBoxModel { command_delay_s: delay_s, measured_delay_s: delay_s, ..model }
        });
        model = best(late.into_iter(), score).unwrap_or(model);
        model = better_model(&model, start, score).unwrap_or(model);
        let slower =
            TIME_FACTORS.map(|factor| GreyBoxModel { time_constant_s: factor * start.time_constant_s, ..model });
        model = best(slower.into_iter(), score).unwrap_or(model);
        model = swapped(&model, score).model;
    }
    model
}

/// A fitted model with the delay of another flight: the most likely of shifts on both sides of its own.
pub(super) fn with_delay(
    heard: &HeardLines,
    inputs: &LoopInputs,
    model: &GreyBoxModel,
    windows: &[Window],
) -> GreyBoxModel {
    let windows = thinned(windows);
    let near = heard.followed(&SpeedPrediction::new(inputs, model), NEAR_SHARE);
    let score = |model: &GreyBoxModel| score(&near, ORDER_MAX, inputs, model, &windows);
    let moved = DELAYS.map(|step| {
        let delay_s = DELAY_STEP_S * f64::from(step);
        let (command_delay_s, measured_delay_s) = (model.command_delay_s + delay_s, model.measured_delay_s + delay_s);
        GreyBoxModel { command_delay_s, measured_delay_s, ..*model }
    });
    best(moved.into_iter(), score).unwrap_or(*model)
}

/// The model with the gains of each loop in another ratio to the vehicle's, both gains together and the derivative's alone, with measured values
/// that are later or earlier, with a part of the time constant as a delay or as a lead of the loops, and with motors that are alike, where that
/// makes the sound clearly more likely. `None` if nothing changes.
fn better_model(
    model: &GreyBoxModel,
    start: &GreyBoxModel,
    score: impl Fn(&GreyBoxModel) -> f64,
) -> Option<GreyBoxModel> {
    let (mut better, mut now) = (*model, score(model));
    let mut keep_better = |changed: GreyBoxModel, better: &mut GreyBoxModel| {
        let value = score(&changed);
        if value > now + BETTER_NATS {
            (*better, now) = (changed, value);
        }
    };
    // motors that were fitted to rotors with wrong names
    keep_better(GreyBoxModel { motor_gain: start.motor_gain, ..better }, &mut better);
    for axis in [Axis::Climb, Axis::YawRate, Axis::Roll, Axis::Pitch] {
        let of_start = &start.loops[axis as usize];
        for factor in GAIN_FACTORS {
            let mut scaled = better;
            let gains = &mut scaled.loops[axis as usize];
            gains.proportional = factor * of_start.proportional;
            gains.derivative = factor * of_start.derivative;
            keep_better(scaled, &mut better);
        }
        for factor in GAIN_FACTORS.into_iter().filter(|_| of_start.derivative != 0.0) {
            let mut scaled = better;
            scaled.loops[axis as usize].derivative = factor * of_start.derivative;
            keep_better(scaled, &mut better);
        }
    }
    for step in DELAYS {
        let measured_delay_s = better.command_delay_s + DELAY_STEP_S * f64::from(step);
        keep_better(GreyBoxModel { measured_delay_s, ..better }, &mut better);
    }
    // a motor that is slower by as much as the delays are shorter answers nearly the same
    for factor in TIME_FACTORS {
        let time_constant_s = factor * start.time_constant_s;
        let shorter_s = time_constant_s - better.time_constant_s;
        let (command_delay_s, measured_delay_s) =
            (better.command_delay_s - shorter_s, better.measured_delay_s - shorter_s);
        keep_better(GreyBoxModel { time_constant_s, command_delay_s, measured_delay_s, ..better }, &mut better);
    }
    // and so does one whose loops lead by as much: (P + D s)/(1 + τ s) keeps its value at low frequencies with D + P Δτ and τ + Δτ
    for factor in TIME_FACTORS {
        let mut leading = GreyBoxModel { time_constant_s: factor * start.time_constant_s, ..better };
        let slower_s = leading.time_constant_s - better.time_constant_s;
        for gains in &mut leading.loops {
            gains.derivative += gains.proportional * slower_s;
        }
        keep_better(leading, &mut better);
    }
    (better != *model).then_some(better)
}

/// Some of the windows, evenly.
fn thinned(windows: &[Window]) -> Vec<Window> {
    windows.iter().step_by(windows.len().div_ceil(WINDOWS_MAX).max(1)).copied().collect()
}

/// Speeds around a middle, in steps that the windows resolve at the highest order.
fn offsets(heard: &HeardLines, order_max: f64, window_s: f64, half_rad_s: f64) -> impl Iterator<Item = f64> + Clone {
    let order = heard.lines.iter().map(|line| line.order).filter(|order| *order <= order_max).fold(2.0, f64::max);
    let step_rad_s = STEP_SHARE * TAU / (order * window_s);
    let count = (half_rad_s / step_rad_s).ceil() as i64;
    (-count..=count).map(move |at| at as f64 * step_rad_s)
}

/// The one hover speed of all rotors.
fn same_hover(
    heard: &HeardLines,
    inputs: &LoopInputs,
    start: &GreyBoxModel,
    windows: &[Window],
    config: &SoundConfig,
) -> GreyBoxModel {
    let prediction = SpeedPrediction::new(inputs, start);
    with_same_hover(&mut HoverListener::new(heard, ORDER_MAX, start, &prediction, windows), start, config)
}

/// A model whose rotors all have the hover speed that a listener hears best.
pub(super) fn with_same_hover(
    listener: &mut HoverListener<'_>,
    model: &GreyBoxModel,
    config: &SoundConfig,
) -> GreyBoxModel {
    listener.turns.sounding = [true, false, false, false];
    let hover = model.mean_hover_rad_s();
    let found = listener.best(0, offsets(listener.heard, ORDER_MAX, config.window_s, config.hover_share * hover));
    GreyBoxModel { hover_rad_s: [hover + found; 4], ..*model }
}

/// The hover speed of each rotor, where the flight is quietest: one rotor after the other, each beside those that are found, and then each again
/// beside all others (RELAX, Li and Stoica 1996).
fn four_hovers(
    heard: &HeardLines,
    inputs: &LoopInputs,
    model: &GreyBoxModel,
    windows: &[Window],
    config: &SoundConfig,
) -> GreyBoxModel {
    let prediction = SpeedPrediction::new(inputs, model);
    let quiet = quiet_windows(inputs, &prediction, windows);
    let mut listener = HoverListener::new(heard, HOVER_ORDER_MAX, model, &prediction, &quiet);
    let middle = model.mean_hover_rad_s();
    let length_s = HOVER_LENGTH * config.window_s;
    let offsets = offsets(heard, HOVER_ORDER_MAX, length_s, config.spread_share * middle);
    listener.turns.sounding = [false; 4];
    for at in 0..4 * (1 + SWEEPS) {
        let rotor = at % 4;
        listener.turns.sounding[rotor] = true;
        listener.offset_rad_s[rotor] = listener.best(rotor, offsets.clone());
    }
    let hover_rad_s = std::array::from_fn(|rotor| middle + listener.offset_rad_s[rotor]);
    GreyBoxModel { hover_rad_s, ..*model }
}

/// Seeks each rotor again beside the other three, since it may follow a line that is no rotor's, such as a side line of a mesh.
/// Candidates come from the quiet windows; one is taken if the whole flight is more likely with it. `None` if no rotor moves.
pub(super) fn reseated(
    heard: &HeardLines,
    inputs: &LoopInputs,
    model: &GreyBoxModel,
    windows: &[Window],
    order_max: f64,
    start: &GreyBoxModel,
    config: &SoundConfig,
) -> Option<GreyBoxModel> {
    let prediction = SpeedPrediction::new(inputs, model);
    let quiet = quiet_windows(inputs, &prediction, windows);
    let windows = thinned(windows);
    let mut quietly = HoverListener::new(heard, HOVER_ORDER_MAX, model, &prediction, &quiet);
    let mut wholly = HoverListener::new(heard, order_max, model, &prediction, &windows);
    let middle = model.mean_hover_rad_s();
    let length_s = HOVER_LENGTH * config.window_s;
    let offsets = offsets(heard, HOVER_ORDER_MAX, length_s, config.spread_share * middle);
    let mut now = wholly.value();
    let before = now;
    for rotor in 0..4 {
        let own = model.hover_rad_s[rotor];
        let offsets: Vec<f64> = offsets.clone().map(|offset| middle + offset - own).collect();
        for candidate in quietly.peaks(rotor, &offsets, CANDIDATES) {
            let step_rad_s = STEP_SHARE * TAU / (order_max.min(heard.order_max()) * config.window_s);
            for fine in -FINE_STEPS..=FINE_STEPS {
                let mut moved = wholly.offset_rad_s;
                moved[rotor] = candidate + f64::from(fine) * step_rad_s;
                let value = wholly.value_at(&moved);
                if value > now + BETTER_NATS {
                    (now, wholly.offset_rad_s, quietly.offset_rad_s) = (value, moved, moved);
                }
            }
        }
    }
    let hover_rad_s = std::array::from_fn(|rotor| model.hover_rad_s[rotor] + wholly.offset_rad_s[rotor]);
    let seated = GreyBoxModel { hover_rad_s, ..*model };
    let score = |model: &GreyBoxModel| score(heard, order_max, inputs, model, &windows);
    better_model(&seated, start, score).or((now > before).then_some(seated))
}

/// Listens along one prediction with the hover speeds off it.
pub(super) struct HoverListener<'a> {
    heard: &'a HeardLines,
    order_max: f64,
    turns: Turns<'a>,
    windows: &'a [Window],
    /// Hover speeds of the prediction, and what is sought beside them.
    hover_rad_s: [f64; 4],
    offset_rad_s: Vector4<f64>,
}

impl<'a> HoverListener<'a> {
    pub(super) fn new(
        heard: &'a HeardLines,
        order_max: f64,
        model: &GreyBoxModel,
        prediction: &'a SpeedPrediction,
        windows: &'a [Window],
    ) -> Self {
        let (turns, hover_rad_s) = (Turns::of(prediction), model.hover_rad_s);
        Self { heard, order_max, turns, windows, hover_rad_s, offset_rad_s: Vector4::zeros() }
    }

    fn value_at(&self, offset_rad_s: &Vector4<f64>) -> f64 {
        let value = |window: &Window| likelihood_value(self.heard, self.order_max, &self.turns, *window, offset_rad_s);
        self.windows.iter().map(value).sum()
    }

    /// Whether a rotor at this offset would stand on a side line of the mesh of another one, whose order differs from that of the mesh
    /// by 1. It cannot be told from that line, which is there for certain.
    fn is_side_line(&self, rotor: usize, offset_rad_s: f64) -> bool {
        let Some(mesh) = self.heard.mesh_order() else { return false };
        let hover = |rotor: usize, offset: f64| self.hover_rad_s[rotor] + offset;
        let others = (0..4).filter(|other| *other != rotor && self.turns.sounding[*other]);
        let width_rad_s = TAU / self.windows.first().map_or(1.0, |window| window.length_s);
        let mut sides =
            others.flat_map(|other| [-1.0, 1.0].map(|side| (mesh + side) * hover(other, self.offset_rad_s[other])));
        sides.any(|side| (mesh * hover(rotor, offset_rad_s) - side).abs() < width_rad_s)
    }

    fn value(&self) -> f64 {
        self.value_at(&self.offset_rad_s)
    }

    /// The most likely offsets of a rotor, each higher than its neighbours.
    fn peaks(&self, rotor: usize, offsets: &[f64], count: usize) -> Vec<f64> {
        let value = |offset: &f64| {
            let mut moved = self.offset_rad_s;
            moved[rotor] = *offset;
            self.value_at(&moved)
        };
        let offsets: Vec<f64> = offsets.iter().copied().filter(|offset| !self.is_side_line(rotor, *offset)).collect();
        let values: Vec<f64> = offsets.iter().map(value).collect();
        let is_peak = |at: &usize| values[*at] > values[*at - 1] && values[*at] >= values[*at + 1];
        let mut peaks: Vec<usize> = (1..values.len().saturating_sub(1)).filter(is_peak).collect();
        peaks.sort_by(|a, b| values[*b].total_cmp(&values[*a]));
        peaks.into_iter().take(count).map(|at| offsets[at]).collect()
    }

    /// The most likely offset of a rotor.
    fn best(&self, rotor: usize, offsets: impl Iterator<Item = f64>) -> f64 {
        let own = offsets.filter(|offset| !self.is_side_line(rotor, *offset));
        let scored = own.map(|offset| {
            let mut moved = self.offset_rad_s;
            moved[rotor] = offset;
            (self.value_at(&moved), offset)
        });
        scored.max_by(|a, b| a.0.total_cmp(&b.0)).map_or(0.0, |(_, offset)| offset)
    }
}

/// The windows in which the prediction moves least, made longer.
fn quiet_windows(inputs: &LoopInputs, prediction: &SpeedPrediction, windows: &[Window]) -> Vec<Window> {
    let longer = windows.iter().map(|window| Window { length_s: HOVER_LENGTH * window.length_s, ..*window });
    let mut longer: Vec<Window> = longer.filter(|window| window.is_known(inputs)).collect();
    longer.sort_by(|a, b| widest_rad_s(prediction, a.span_s()).total_cmp(&widest_rad_s(prediction, b.span_s())));
    longer.truncate(HOVER_WINDOWS);
    longer
}

/// A model whose rotors have the most likely names.
pub(super) struct Named {
    pub(super) model: GreyBoxModel,
    /// Smallest loss of likelihood by a swap, nats.
    pub(super) margin_nats: f64,
}

/// Gives the hover speeds the names that the sound supports.
pub(super) fn with_names(
    heard: &HeardLines,
    inputs: &LoopInputs,
    model: &GreyBoxModel,
    windows: &[Window],
    order_max: f64,
) -> Named {
    let windows = thinned(windows);
    swapped(model, |model| score(heard, order_max, inputs, model, &windows))
}

/// Swaps the hover speeds and the motors of two rotors as long as that makes the sound more likely.
fn swapped(model: &GreyBoxModel, score: impl Fn(&GreyBoxModel) -> f64) -> Named {
    let mut named = Named { model: *model, margin_nats: f64::INFINITY };
    let mut now = score(model);
    // each swap raises the likelihood, so that it ends; six pairs of four names need no more
    for _ in 0..6 {
        let pairs = (0..4).flat_map(|a| (a + 1..4).map(move |b| [a, b]));
        let swaps = pairs.map(|[a, b]| {
            let mut swap = named.model;
            swap.hover_rad_s.swap(a, b);
            swap.motor_gain.swap(a, b);
            (score(&swap), swap)
        });
        let Some((highest, swap)) = swaps.max_by(|a, b| a.0.total_cmp(&b.0)) else { break };
        named.margin_nats = now - highest;
        if highest <= now {
            break;
        }
        named = Named { model: swap, margin_nats: 0.0 };
        now = highest;
    }
    named
}
