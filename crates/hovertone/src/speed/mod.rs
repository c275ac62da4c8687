//! Ridges → shaft speed: one number per harmonic, combined over harmonics, with spread and uncertainty.

use crate::config::{Method, RidgeConfig};
use crate::ridge::{Peak, Ridge};
use crate::span::Span;
use crate::statistics::{mean, median, std, std_uncertainty_of_mean};
use crate::warning::Warning;
use hovertone_vehicle::{Order, RotorSpeed};
use serde::Serialize;

/// Standard deviation of an interpolated Hann peak, in resolution cells, at a peak as strong as the noise. The
/// Cramér-Rao bound is √6 / 2π = 0.39; the log parabola reaches 1.6 times that where noise, not its bias, is the limit.
const PEAK_STD_CELLS: f64 = 0.62;

/// Harmonics of one shaft differ by 0.67 standard deviations in the typical frame. This leaves room for the peak's bias
/// and for speed that changes within a frame.
const ONE_SHAFT_STDS: f64 = 3.0;

/// What one harmonic says.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct HarmonicSpeed {
    /// Number of the harmonic: 1 for the tone itself.
    pub harmonic: u32,
    /// Its order.
    pub order: Order,
    /// Mean frequency (eq 7).
    pub mean_hz: f64,
    /// Standard deviation over the frames (eq 8, with the square that its print lacks).
    pub std_hz: Option<f64>,
    /// Frames with a point.
    pub frame_count: usize,
    /// Share of the speed that comes from this harmonic.
    pub weight: f64,
}

/// Shaft speed over a stretch of time, by one method.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct SpeedEstimate {
    /// How the ridge was read.
    pub method: Method,
    /// Order of the tone.
    pub order: Order,
    /// Mean shaft speed.
    #[serde(rename = "speed_rad_s")]
    pub speed: RotorSpeed,
    /// Standard uncertainty of the mean from the scatter of its frames and their correlation. It does not know of what
    /// all frames share: the ridge follows the loudest rotor, and the recorder's clock may be off by 0.005 %.
    pub std_uncertainty_rev_s: Option<f64>,
    /// Standard deviation of the speed over the frames: the wander of the flight and the noise of the method.
    pub spread_rev_s: Option<f64>,
    /// Frames with a point.
    pub frame_count: usize,
    /// The harmonics that it comes from.
    pub harmonics: Vec<HarmonicSpeed>,
}

/// One frame of the track: all harmonics together.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct TrackPoint {
    /// Middle of the frame.
    pub time_s: f64,
    /// Frequency of the tone itself.
    pub tone_hz: f64,
    /// Shaft speed.
    pub speed_rev_s: f64,
    /// Standard uncertainty of that speed from the noise around the lines.
    pub std_uncertainty_rev_s: f64,
    /// Level of the strongest harmonic, dB re a full-scale sine.
    pub level_db: f64,
}

/// The harmonics that are used, with their weights. Eq 9 as printed is no average (its weights sum to 1.833 for exact
/// harmonics); the corrected form weighs each harmonic's speed by the inverse of its variance.
///
/// - Harmonics that agree frame by frame come from one shaft. Then noise of density Φ is what limits them, and the
///   weight is o² A² / Φ (Whittle).
/// - Harmonics that disagree come from several rotors, and what limits them is which rotor wins. The rotors' lines are
///   parted in proportion to the order, and so grows that variance: the weight is A² / (Φ o).
#[derive(Clone, Debug)]
pub(crate) struct HarmonicWeights<'a> {
    used: Vec<(&'a Ridge, f64)>,
}

impl<'a> HarmonicWeights<'a> {
    /// Weighs the ridges and leaves out, with a warning, those that have too few points or disagree with the clearest.
    pub(crate) fn from_ridges(ridges: &'a [Ridge], config: &RidgeConfig, warnings: &mut Vec<Warning>) -> Self {
        let shaft_rev_s = |ridge: &Ridge| {
            mean(&ridge.points_hz(Method::MaximumTrace)).map(|hz| hz / ridge.band.order.lines_per_turn())
        };
        let clearest = ridges.iter().max_by(|a, b| a.line_share.total_cmp(&b.line_share));
        let Some((clearest, reference_rev_s)) = clearest.and_then(|ridge| Some((ridge, shaft_rev_s(ridge)?))) else {
            return Self { used: Vec::new() };
        };
        let mut used = Vec::new();
        for ridge in ridges {
            let reason = match shaft_rev_s(ridge).map(|speed_rev_s| speed_rev_s / reference_rev_s - 1.0) {
                _ if ridge.point_share() < config.point_share_min => {
                    format!("only {:.0} % of its frames hold a tone", 100.0 * ridge.point_share())
                }
                Some(share) if share.abs() > config.harmonic_disagreement_share_max => {
                    format!("its speed differs by {:.1} % from the clearest one's", 100.0 * share)
                }
                Some(_) => {
                    used.push(ridge);
                    continue;
                }
                None => "it holds no tone".to_owned(),
            };
            warnings.push(Warning::HarmonicLeftOut { harmonic: ridge.band.harmonic, reason });
        }
        let order_power = if used.iter().all(|ridge| is_of_one_shaft(clearest, ridge)) { 2 } else { -1 };
        let weight = |ridge: &Ridge| ridge.band.order.lines_per_turn().powi(order_power) * typical_over_sides(ridge);
        let total: f64 = used.iter().map(|ridge| weight(ridge)).sum();
        Self { used: used.into_iter().map(|ridge| (ridge, weight(ridge) / total)).collect() }
    }

    /// Mean speed over a stretch of time: eq 7 per harmonic, eq 9 corrected over harmonics. `None` where no harmonic
    /// has a point.
    pub(crate) fn speed_in(&self, span: Option<&Span>, method: Method, order: Order) -> Option<SpeedEstimate> {
        let is_in = |time_s: f64| span.is_none_or(|span| span.contains(time_s));
        let harmonics: Vec<HarmonicSpeed> = self
            .used
            .iter()
            .filter_map(|(ridge, weight)| {
                let points: Vec<f64> = ridge
                    .frames
                    .iter()
                    .filter(|frame| is_in(frame.time_s))
                    .filter_map(|frame| frame.peak.map(|peak| peak.hz(method)))
                    .collect();
                Some(HarmonicSpeed {
                    harmonic: ridge.band.harmonic,
                    order: ridge.band.order,
                    mean_hz: mean(&points)?,
                    std_hz: std(&points),
                    frame_count: points.len(),
                    weight: *weight,
                })
            })
            .collect();
        let total: f64 = harmonics.iter().map(|harmonic| harmonic.weight).sum();
        let speed_rev_s = harmonics.iter().map(|h| h.weight / total * h.mean_hz / h.order.lines_per_turn()).sum();
        let track: Vec<f64> =
            self.track(method, order).filter(|point| is_in(point.time_s)).map(|point| point.speed_rev_s).collect();
        (!track.is_empty()).then(|| SpeedEstimate {
            method,
            order,
            speed: RotorSpeed::from_rev_s(speed_rev_s),
            std_uncertainty_rev_s: std_uncertainty_of_mean(&track),
            spread_rev_s: std(&track),
            frame_count: track.len(),
            harmonics: harmonics.into_iter().map(|h| HarmonicSpeed { weight: h.weight / total, ..h }).collect(),
        })
    }

    /// The speed of every frame in which at least one harmonic has a point.
    pub(crate) fn track(&self, method: Method, order: Order) -> impl Iterator<Item = TrackPoint> + '_ {
        let frame_count = self.used.first().map_or(0, |(ridge, _)| ridge.frames.len());
        (0..frame_count).filter_map(move |index| {
            let present: Vec<(&Ridge, f64, Peak)> = self
                .used
                .iter()
                .filter_map(|&(ridge, weight)| Some((ridge, weight, ridge.frames.get(index)?.peak?)))
                .collect();
            let total: f64 = present.iter().map(|(_, weight, _)| weight).sum();
            let (ridge, ..) = present.first()?;
            let over_turns = |of: &dyn Fn(&Ridge, &Peak) -> f64, power: i32| -> f64 {
                present
                    .iter()
                    .map(|(ridge, weight, peak)| {
                        (weight / total * of(ridge, peak) / ridge.band.order.lines_per_turn()).powi(power)
                    })
                    .sum()
            };
            let speed_rev_s = over_turns(&|_, peak| peak.hz(method), 1);
            Some(TrackPoint {
                time_s: ridge.frames[index].time_s,
                tone_hz: speed_rev_s * order.lines_per_turn(),
                speed_rev_s,
                std_uncertainty_rev_s: over_turns(&peak_std_hz, 2).sqrt(),
                level_db: present.iter().map(|(_, _, peak)| peak.level_db).fold(f64::MIN, f64::max),
            })
        })
    }
}

/// Standard deviation of a peak's frequency from the noise around it.
fn peak_std_hz(ridge: &Ridge, peak: &Peak) -> f64 {
    let over_mean_noise = 10f64.powf(peak.over_sides_db / 10.0) * std::f64::consts::LN_2;
    PEAK_STD_CELLS * ridge.resolution_hz / over_mean_noise.sqrt()
}

/// Whether two harmonics agree frame by frame as closely as the noise around them lets them.
fn is_of_one_shaft(a: &Ridge, b: &Ridge) -> bool {
    let over_noise: Vec<f64> = a
        .frames
        .iter()
        .zip(&b.frames)
        .filter_map(|(a_frame, b_frame)| Some((a_frame.peak?, b_frame.peak?)))
        .map(|(a_peak, b_peak)| {
            let turns = |ridge: &Ridge, hz: f64| hz / ridge.band.order.lines_per_turn();
            let apart = turns(a, a_peak.maximum_hz) - turns(b, b_peak.maximum_hz);
            apart.abs() / turns(a, peak_std_hz(a, &a_peak)).hypot(turns(b, peak_std_hz(b, &b_peak)))
        })
        .collect();
    median(&over_noise).is_none_or(|typical| typical <= ONE_SHAFT_STDS)
}

/// Power of the typical peak of a ridge over the noise around it.
fn typical_over_sides(ridge: &Ridge) -> f64 {
    let levels: Vec<f64> = ridge.frames.iter().filter_map(|frame| frame.peak.map(|peak| peak.over_sides_db)).collect();
    10f64.powf(median(&levels).unwrap_or_default() / 10.0)
}
