//! Ridges → shaft speed: the speed of each harmonic, combined over the harmonics, with spread and uncertainty.

mod budget;
mod excerpts;
mod harmonic;
mod sample_settings;
mod separated;
mod settings;

pub(crate) use budget::with_budget;
pub(crate) use excerpts::excerpts_from_hover;
pub use sample_settings::SampleConfig;
pub(crate) use separated::mean_track;
pub use settings::BudgetConfig;

use crate::ridge::RidgeConfig;
use crate::thresholds::NOISE_STDS_MAX;
use hovertone_analysis::{
    HarmonicSpeed, Method, Peak, Ridge, Span, SpeedEstimate, TrackPoint, Warning, percent_in_words,
};
use hovertone_signal::statistics::{mean, median, std, std_uncertainty_of_mean};
use hovertone_vehicle::{Order, RotorSpeed};

/// Standard deviation of an interpolated Hann peak, in resolution cells, at a power equal to the mean noise. The Cramér-Rao bound (Rife
/// and Boorstyn, IEEE Trans. Information Theory 20, 1974) is √6 / 2π = 0.39; the parabola through log powers reaches 1.6 times the bound
/// where noise exceeds its bias. *Numeric.*
const PEAK_STD_CELLS: f64 = 0.62;

/// Largest median difference of two harmonics of one shaft, in standard deviations of their noise. Noise alone gives 0.67; the rest is for
/// the bias of the peak and for changes of speed within a frame.
const ONE_SHAFT_STDS: f64 = NOISE_STDS_MAX;

/// The harmonics that are used, with their weights: the inverse of the variance of their speeds. Eq 9 of the paper as printed is no
/// average, because its weights sum to 1.833 for exact harmonics.
///
/// - Harmonics that agree frame by frame come from one shaft. Noise of density Φ limits them, and a harmonic of order o and amplitude A
///   has the weight o² A² / Φ.
/// - Harmonics that disagree come from several rotors. The variance is due to the choice of the loudest rotor in each frame, and grows with
///   the order as the distance between the lines of the rotors does: the weight is A² / (Φ o).
#[derive(Clone, Debug)]
pub(crate) struct HarmonicWeights<'a> {
    used: Vec<WeightedRidge<'a>>,
    /// Largest difference of a harmonic from the others, as a share: it follows another rotor. 0 where all agree.
    pub(crate) difference_share: f64,
}

/// A harmonic and its weight; the weights of all used harmonics sum to 1.
#[derive(Clone, Copy, Debug)]
struct WeightedRidge<'a> {
    ridge: &'a Ridge,
    weight: f64,
}

/// The peak of a harmonic in one frame, with the weight of the harmonic.
struct WeightedPeak<'a> {
    ridge: &'a Ridge,
    weight: f64,
    peak: Peak,
}

impl<'a> HarmonicWeights<'a> {
    /// Weights of the ridges. Ridges with too few points, and ridges that disagree with the reference, are left out with a warning. The
    /// reference is the harmonic with which most others agree; among equals the clearest, then the lowest.
    pub(crate) fn from_ridges(ridges: &'a [Ridge], config: &RidgeConfig, warnings: &mut Vec<Warning>) -> Self {
        let speeds: Vec<Option<f64>> = ridges
            .iter()
            .map(|ridge| Some(mean(&ridge.points_hz(Method::MaximumTrace))? / ridge.band.order.lines_per_turn()))
            .map(|speed| speed.filter(|speed| speed.is_finite()))
            .collect();
        let agree = |a: f64, b: f64| (a / b - 1.0).abs() <= config.harmonic_disagreement_share_max;
        let has_points = |ridge: &Ridge| ridge.point_share() >= config.point_share_min;
        let agreeing = |speed: f64| {
            ridges
                .iter()
                .zip(&speeds)
                .filter(|(r, other)| has_points(r) && other.is_some_and(|o| agree(o, speed)))
                .count()
        };
        let reference = ridges
            .iter()
            .zip(&speeds)
            .filter(|(ridge, _)| has_points(ridge))
            .filter_map(|(ridge, speed)| Some((ridge, (*speed)?)))
            .rev()
            .max_by(|(a, a_speed), (b, b_speed)| {
                agreeing(*a_speed).cmp(&agreeing(*b_speed)).then(a.line_share.total_cmp(&b.line_share))
            });
        let (mut used, mut difference_share) = (Vec::new(), 0.0);
        for (ridge, speed) in ridges.iter().zip(&speeds) {
            let reason = match (speed, reference) {
                _ if !has_points(ridge) => {
                    format!("it is heard for only {} of the time", percent_in_words(ridge.point_share()))
                }
                (Some(speed), Some((_, reference))) if !agree(*speed, reference) => {
                    let share = speed / reference - 1.0;
                    difference_share = share.abs().max(difference_share);
                    let how = if share < 0.0 { "lower" } else { "higher" };
                    let others = if ridge.band.harmonic == 1 { "its multiples" } else { "the other harmonics" };
                    format!("it is {:.1} % {how} than {others} show, so it may be another sound", 100.0 * share.abs())
                }
                (Some(_), Some(_)) => {
                    used.push(ridge);
                    continue;
                }
                _ => "it is not heard".to_owned(),
            };
            warnings.push(Warning::HarmonicLeftOut { harmonic: ridge.band.harmonic, reason });
        }
        let is_one_shaft =
            reference.is_some_and(|(reference, _)| used.iter().all(|ridge| is_of_one_shaft(reference, ridge)));
        let order_power = if is_one_shaft { 2 } else { -1 };
        let weight = |ridge: &Ridge| ridge.band.order.lines_per_turn().powi(order_power) * typical_over_sides(ridge);
        let total: f64 = used.iter().map(|ridge| weight(ridge)).sum();
        let used = used.into_iter().map(|ridge| WeightedRidge { ridge, weight: weight(ridge) / total }).collect();
        Self { used, difference_share }
    }

    /// Mean speed over a span of time, or over the whole track, of a track from these weights. `None` where no frame has a point.
    ///
    /// The harmonics are combined in each frame, and the frames are averaged. Where every harmonic has a point in every frame, this equals
    /// eq 7 of the paper for each harmonic and the corrected eq 9 over the harmonics. Where a harmonic has gaps, the mean is not drawn
    /// towards the times at which it has points.
    pub(crate) fn speed_in(&self, span: Option<&Span>, track: &Track) -> Option<SpeedEstimate> {
        let points = track.points_in(span);
        let speeds: Vec<f64> = points.iter().map(|point| point.speed_rev_s).collect();
        Some(SpeedEstimate {
            method: track.method,
            order: track.order,
            speed: RotorSpeed::from_rev_s(mean(&speeds)?),
            std_uncertainty_rev_s: std_uncertainty_of_mean(&speeds),
            spread_rev_s: std(&speeds),
            mean_square_rad2_s2: None,
            frame_count: speeds.len(),
            budget: Vec::new(),
            harmonics: self.used.iter().filter_map(|&harmonic| harmonic_in(span, harmonic, track.method)).collect(),
        })
    }

    /// The speed of every frame in which at least one harmonic has a point. `None` for a method that does not use ridges.
    pub(crate) fn track(&self, method: Method, order: Order) -> Option<Track> {
        if !method.reads_ridges() {
            return None;
        }
        let frame_count = self.used.first().map_or(0, |harmonic| harmonic.ridge.frames.len());
        let points = (0..frame_count).filter_map(|index| self.point_of_frame(index, method, order)).collect();
        Some(Track { method, order, points })
    }

    /// The speed of one frame: the weighted mean over the harmonics with a point.
    fn point_of_frame(&self, index: usize, method: Method, order: Order) -> Option<TrackPoint> {
        let present: Vec<WeightedPeak<'_>> = self
            .used
            .iter()
            .filter_map(|&WeightedRidge { ridge, weight }| {
                Some(WeightedPeak { ridge, weight, peak: ridge.frames.get(index)?.peak? })
            })
            .collect();
        let first = present.first()?.ridge;
        let total: f64 = present.iter().map(|harmonic| harmonic.weight).sum();
        // factor from the frequency of a harmonic to its part of the speed
        let share = |harmonic: &WeightedPeak<'_>| harmonic.weight / total / harmonic.ridge.band.order.lines_per_turn();
        let speed_rev_s: f64 = present.iter().map(|harmonic| share(harmonic) * harmonic.peak.hz(method)).sum();
        let std_hz = |harmonic: &WeightedPeak<'_>| peak_std_hz(harmonic.ridge, &harmonic.peak);
        let variance: f64 = present.iter().map(|harmonic| (share(harmonic) * std_hz(harmonic)).powi(2)).sum();
        Some(TrackPoint {
            time_s: first.frames[index].time_s,
            tone_hz: speed_rev_s * order.lines_per_turn(),
            speed_rev_s,
            std_uncertainty_rev_s: variance.sqrt(),
            level_db: present.iter().map(|harmonic| harmonic.peak.level_db).fold(f64::MIN, f64::max),
        })
    }
}

/// The speed of each frame by one method, in order of time.
#[derive(Clone, Debug)]
pub(crate) struct Track {
    pub(crate) method: Method,
    order: Order,
    pub(crate) points: Vec<TrackPoint>,
}

impl Track {
    /// The points in a span of time, or all without a span.
    fn points_in(&self, span: Option<&Span>) -> &[TrackPoint] {
        let Some(span) = span else { return &self.points };
        let from = self.points.partition_point(|point| point.time_s < span.from_s);
        let to = self.points.partition_point(|point| point.time_s < span.to_s);
        &self.points[from..to.max(from)]
    }
}

/// The mean frequency of one harmonic over a span of time, or over the whole ridge. `None` where no frame has a point.
fn harmonic_in(span: Option<&Span>, harmonic: WeightedRidge<'_>, method: Method) -> Option<HarmonicSpeed> {
    let WeightedRidge { ridge, weight } = harmonic;
    let from = span.map_or(0, |span| ridge.frames.partition_point(|frame| frame.time_s < span.from_s));
    let to = span.map_or(ridge.frames.len(), |span| ridge.frames.partition_point(|frame| frame.time_s < span.to_s));
    let points: Vec<f64> =
        ridge.frames[from..to.max(from)].iter().filter_map(|frame| Some(frame.peak?.hz(method))).collect();
    Some(HarmonicSpeed {
        harmonic: ridge.band.harmonic,
        order: ridge.band.order,
        mean_hz: mean(&points)?,
        std_hz: std(&points),
        frame_count: points.len(),
        weight,
    })
}

/// Standard deviation of the frequency of a peak due to the noise around it, Hz. The mean of noise is its median over ln 2.
fn peak_std_hz(ridge: &Ridge, peak: &Peak) -> f64 {
    let over_mean_noise = 10f64.powf(peak.over_sides_db / 10.0) * std::f64::consts::LN_2;
    PEAK_STD_CELLS * ridge.resolution_hz / over_mean_noise.sqrt()
}

/// Whether two harmonics agree frame by frame within the noise around them.
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

/// Median power of the peaks of a ridge over their surroundings.
fn typical_over_sides(ridge: &Ridge) -> f64 {
    let levels: Vec<f64> = ridge.frames.iter().filter_map(|frame| frame.peak.map(|peak| peak.over_sides_db)).collect();
    10f64.powf(median(&levels).unwrap_or_default() / 10.0)
}
