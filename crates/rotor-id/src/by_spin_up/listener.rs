//! Takes in the sound from the start of the recording into the hover, and decides which lines of the rotors are used.

use super::SpinUp;
use super::frames::{FRAME_S, FrameCollector, HOP_S, median_noise};
use super::joint_lines::JointLines;
use super::start_search::{ANCHOR_FRAMES, StartSearch};
use crate::speed_curve::SpeedCurve;
use hovertone_analysis::{Hover, NotTold, RotorEstimate, Span};
use hovertone_rotor_speed::{ToneConfig, blades_known};
use hovertone_signal::passes::StretchListener;
use hovertone_vehicle::BLADES_MAX;

/// Length of the hover that is taken in, in s: it shows the loudness of each rotor. *Decision.*
const INTO_HOVER_S: f64 = 10.0;
/// Longest time in which the motors are started, in s. *Decision.*
pub(super) const SPIN_UP_S_MAX: f64 = 60.0;
/// Longest stretch of sound that is taken in, in s. *Decision.*
const SPAN_S_MAX: f64 = 2.0 * SPIN_UP_S_MAX;
/// Distance in resolution cells of the lines of the two nearest rotors, from which on their order is used. *Decision.*
const APART_CELLS: f64 = 1.5;
/// Most orders that are used. *Decision.*
const ORDERS_MAX: usize = 10;
/// Fewest orders that are used. *Decision.*
const ORDERS_MIN: usize = 2;
/// Highest order of the blade pass that is used: higher lines smear within a frame. *Decision.*
const BLADE_ORDER_MAX: f64 = 40.0;
/// Highest multiple of a gear mesh that is used, for the same reason. *Decision.*
const MESH_LINES: f64 = 2.0;
/// Highest frequency of a line, as a share of the sample rate. *Numeric.*
const SAMPLE_RATE_SHARE: f64 = 0.4;
/// Highest frequency of the spectra, over that of the highest line: speeds above the hover's are searched, too. *Decision.*
const FREQUENCY_MARGIN: f64 = 1.2;

/// The search for the starts of the rotors of a hover.
pub(super) struct SpinUpRequest<'a> {
    pub(super) sample_rate_hz: f64,
    pub(super) recording: Span,
    pub(super) rotor_count: usize,
    pub(super) tone: &'a ToneConfig,
}

/// Takes in the sound of a spin-up.
pub(super) struct SpinUpListener {
    /// The stretch of sound that is needed.
    pub(super) span: Span,
    hover_start_s: f64,
    base_order: f64,
    orders: Vec<f64>,
    curves: Vec<SpeedCurve>,
    speeds_rev_s: Vec<f64>,
    frames: FrameCollector,
}

impl StretchListener for SpinUpListener {
    fn restart(&mut self, _: f64, _: f64) {}
    fn push(&mut self, samples: &[f32]) {
        self.frames.push(samples);
    }
}

impl SpinUpListener {
    pub(super) fn new(request: &SpinUpRequest<'_>, hover: &Hover, rotors: &[RotorEstimate]) -> Result<Self, NotTold> {
        let SpinUpRequest { sample_rate_hz, recording, rotor_count, tone } = *request;
        if rotors.len() != rotor_count {
            return Err(NotTold::TooFewTracks { tracks: rotors.len(), needed: rotor_count });
        }
        let longest = hover.segments.iter().max_by(|a, b| a.length_s().total_cmp(&b.length_s()));
        let segment = longest.copied().unwrap_or(recording);
        let span = span_to_hover(recording, segment);
        if span.to_s <= segment.from_s + ANCHOR_FRAMES as f64 * HOP_S {
            return Err(NotTold::SpinUpTooLong { before_hover_s: segment.from_s - recording.from_s });
        }
        let speeds_rev_s: Vec<f64> = rotors.iter().map(|rotor| rotor.speed.speed.rev_s()).collect();
        let mut sorted = speeds_rev_s.clone();
        sorted.sort_by(f64::total_cmp);
        let apart_rev_s = sorted.windows(2).map(|pair| pair[1] - pair[0]).fold(f64::INFINITY, f64::min);
        let fastest_rev_s = sorted.last().copied().unwrap_or(0.0);
        let base_order = blades_known(tone).map_or(tone.order.lines_per_turn(), f64::from);
        let order_max = if base_order > BLADES_MAX { MESH_LINES * base_order } else { BLADE_ORDER_MAX };
        let order_max = order_max.min(SAMPLE_RATE_SHARE * sample_rate_hz / fastest_rev_s.max(f64::MIN_POSITIVE));
        let orders = separating_orders(base_order, order_max, apart_rev_s);
        if orders.len() < ORDERS_MIN {
            return Err(NotTold::RotorsTooClose { apart_rev_s });
        }
        let high_hz = FREQUENCY_MARGIN * fastest_rev_s * orders.last().copied().unwrap_or(order_max);
        Ok(Self {
            span,
            hover_start_s: segment.from_s,
            base_order,
            orders,
            curves: rotors.iter().map(|rotor| SpeedCurve::through(&rotor.track)).collect(),
            speeds_rev_s,
            frames: FrameCollector::new(sample_rate_hz, span.from_s, high_hz),
        })
    }

    /// The starts of the rotors, or the reason why they are unknown.
    pub(super) fn finish(self) -> SpinUp {
        let lines = JointLines { noise: self.noise_in_hover(), orders: self.orders };
        let search = StartSearch {
            recording_start_s: self.span.from_s,
            hover_start_s: self.hover_start_s,
            base_order: self.base_order,
            lines,
            curves: self.curves,
            speeds_rev_s: self.speeds_rev_s,
            frames: self.frames.frames,
        };
        match search.starts() {
            Ok(starts) => SpinUp { starts, not_told: None },
            Err(reason) => SpinUp::not_told(reason),
        }
    }

    /// Power of the noise in the hover at the line of each order.
    fn noise_in_hover(&self) -> Vec<f64> {
        let mean_rev_s = self.speeds_rev_s.iter().sum::<f64>() / self.speeds_rev_s.len().max(1) as f64;
        let frames = &self.frames.frames;
        let hover = &frames[frames.partition_point(|frame| frame.middle_s < self.hover_start_s)..];
        self.orders.iter().map(|order| median_noise(hover, order * mean_rev_s)).collect()
    }
}

/// From the start of the recording into a segment of the hover. If the segment starts with the recording, the motors may start anywhere in
/// it, and all of it is needed.
fn span_to_hover(recording: Span, segment: Span) -> Span {
    let is_cut = segment.from_s - recording.from_s >= INTO_HOVER_S;
    let to_s = if is_cut { segment.to_s.min(segment.from_s + INTO_HOVER_S) } else { segment.to_s };
    Span { from_s: recording.from_s, to_s: to_s.min(recording.from_s + SPAN_S_MAX) }
}

/// The lowest orders at which the lines of the two nearest rotors are far enough apart.
fn separating_orders(base_order: f64, order_max: f64, apart_rev_s: f64) -> Vec<f64> {
    (1..)
        .map(|multiple| base_order * f64::from(multiple))
        .take_while(|order| *order <= order_max)
        .filter(|order| order * apart_rev_s * FRAME_S >= APART_CELLS)
        .take(ORDERS_MAX)
        .collect()
}
