//! Whether a speed is held, and what weakens it.

use crate::hover::HoverConfig;
use crate::survey::Survey;
use crate::thresholds::{FEW, HELD_S, MANY, MOST};
use crate::tone::ToneConfig;
use hovertone_analysis::{
    Band, CutReason, Hover, NoTone, OtherRotor, Ridge, RotorEstimate, SampleSpeeds, Span, SpeedEstimate, TrackPoint,
    Warning,
};
use hovertone_signal::statistics::mean;

/// Frame lengths whose share of lines differs by less than this are equally clear, and the longest, which resolves most,
/// is taken. Where rotors part or wander, lines get fewer with length, so that clarity itself keeps frames short. *Decision.*
const EQUALLY_CLEAR_SHARE: f64 = 0.01;
/// A ridge on the edge of its band in more frames than this is not in its band.
const EDGE_SHARE: f64 = FEW;
/// More gaps than this are said.
const GAP_SHARE: f64 = MANY;
/// A spread of twice the paper's (1.2 to 1.3 %) means more than one line. *Decision.*
const SPREAD_SHARE: f64 = 0.025;
/// A sample of fewer frames has a mean that one bad frame spoils. *Decision.*
const FEW_FRAMES: usize = 8;
/// Another speed is worth a warning when it lasts this share of the hover.
const OTHER_SPEED_LENGTH_SHARE: f64 = MOST;

/// The ridges of the frame length that shows lines in most frames; among those equally clear, of the longest.
pub(crate) fn clearest_ridges(ladder: &[Vec<Ridge>]) -> Option<&Vec<Ridge>> {
    let clarity = |ridges: &[Ridge]| {
        let shares: Vec<f64> = ridges.iter().map(|ridge| ridge.line_share).collect();
        mean(&shares).unwrap_or_default()
    };
    let drawn = || ladder.iter().filter(|ridges| ridges.iter().any(|ridge| !ridge.frames.is_empty()));
    let clearest = drawn().map(|ridges| clarity(ridges)).fold(0.0, f64::max);
    drawn().rfind(|ridges| clarity(ridges) >= clearest - EQUALLY_CLEAR_SHARE)
}

/// Why a hover that lies in pieces among other tones is none: music, speech and beeps change, a hover holds its speed.
pub(crate) fn not_held_reason(restless_s: f64, hover: &Hover, tone_hz: f64, config: &HoverConfig) -> Option<NoTone> {
    let held_s = hover.segments.iter().map(Span::length_s).fold(0.0, f64::max);
    let is_restless = held_s < config.held_s_min && restless_s > hover.length_s();
    (is_restless && held_s > 0.0).then_some(NoTone::NotHeld { tone_hz, held_s })
}

/// Nothing sounds like a rotor with that tone.
pub(crate) fn no_series(tone: &ToneConfig, instead: Option<OtherRotor>) -> NoTone {
    NoTone::NoSeries { only_rev_s: tone.narrowed_rev_s(), instead }
}

/// The reason as it is said where mains hum was taken out before: then the hum is what was heard.
pub(crate) fn or_mains_hum(reason: NoTone, survey: &Survey) -> NoTone {
    match (&survey.hum, &reason) {
        (Some(hum), NoTone::NoSeries { .. } | NoTone::NoHover) => NoTone::MainsHum { mains_hz: hum.fundamental_hz },
        _ => reason,
    }
}

/// What the cuts say against the speed.
pub(crate) fn warnings_of_hover(hover: &Hover) -> Vec<Warning> {
    let length_s_min = OTHER_SPEED_LENGTH_SHARE * hover.length_s();
    hover
        .cuts
        .iter()
        .filter(|cut| cut.span.length_s() >= length_s_min)
        .filter_map(|cut| match cut.reason {
            CutReason::OtherSpeed { speed_rev_s } => {
                Some(Warning::OtherSteadySpeed { speed_rev_s, from_s: cut.span.from_s, to_s: cut.span.to_s })
            }
            _ => None,
        })
        .collect()
}

/// Parts of a hover whose speeds differ by as much as a manoeuvre.
pub(crate) fn warning_of_parts(hover: &Hover, track: &[TrackPoint], share_max: f64) -> Option<Warning> {
    let mean_in = |segment: &Span| {
        let speeds: Vec<f64> =
            track.iter().filter(|point| segment.contains(point.time_s)).map(|point| point.speed_rev_s).collect();
        mean(&speeds)
    };
    let long = hover.segments.iter().filter(|segment| segment.length_s() >= HELD_S);
    let means: Vec<f64> = long.filter_map(mean_in).collect();
    let slowest_rev_s = means.iter().copied().min_by(f64::total_cmp)?;
    let fastest_rev_s = means.iter().copied().max_by(f64::total_cmp)?;
    let differ = fastest_rev_s / slowest_rev_s - 1.0 > share_max;
    differ.then_some(Warning::HoversDiffer { slowest_rev_s, fastest_rev_s })
}

/// What the samples say against their speeds. The frames of a whole sample of `length_s` are enough, unless the tone has gaps.
pub(crate) fn warning_of_samples(samples: &[SampleSpeeds], length_s: f64) -> Option<Warning> {
    let counts = samples.iter().flat_map(|sample| sample.speeds.iter().map(|speed| (speed.frame_count, sample.span)));
    let (frame_count, span) = counts.min_by_key(|(frame_count, _)| *frame_count)?;
    let sample_s = span.length_s();
    // in the step of the frames that there are, rounded up to the decimal that is printed
    let needed_s = (10.0 * sample_s * FEW_FRAMES as f64 / frame_count.max(1) as f64).ceil() / 10.0;
    let needed_s = (needed_s <= length_s).then_some(needed_s);
    (frame_count < FEW_FRAMES).then_some(Warning::FewFrames { frame_count, sample_s, needed_s })
}

/// Whether all rotors that there are were told apart.
pub(crate) fn warning_of_rotors(
    rotors: &[RotorEstimate],
    in_mean: usize,
    count: u32,
    is_assumed: bool,
    spread_share: f64,
) -> Option<Warning> {
    let resolved = rotors.len();
    (count > 1 && resolved < count as usize).then_some(Warning::RotorsNotApart {
        resolved,
        of: count,
        in_mean,
        is_assumed,
        spread_share,
    })
}

/// What the ridges say against the speed.
pub(crate) fn warnings_of_speed(ridges: &[Ridge], speeds: &[SpeedEstimate]) -> Vec<Warning> {
    let used =
        |ridge: &&Ridge| speeds.iter().any(|speed| speed.harmonics.iter().any(|h| h.harmonic == ridge.band.harmonic));
    let mut warnings = Vec::new();
    for ridge in ridges.iter().filter(used) {
        let peaks = || ridge.frames.iter().filter_map(|frame| frame.peak);
        let frames_share = peaks().filter(|peak| peak.is_on_edge).count() as f64 / (peaks().count().max(1)) as f64;
        if frames_share > EDGE_SHARE {
            let Band { harmonic, band_hz_low, band_hz_high, .. } = ridge.band;
            warnings.push(Warning::RidgeOnBandEdge { harmonic, frames_share, band_hz_low, band_hz_high });
        }
    }
    let harmonic_count = ridges.iter().filter(used).count();
    if 2 * harmonic_count < ridges.len() || !ridges.iter().filter(used).any(|ridge| ridge.band.harmonic == 1) {
        warnings.push(Warning::FewHarmonicsAgree { used: harmonic_count, of: ridges.len() });
    }
    let clearest = ridges.iter().filter(used).max_by(|a, b| a.point_share().total_cmp(&b.point_share()));
    let gap_share = clearest.map_or(1.0, |ridge| 1.0 - ridge.point_share());
    if gap_share > GAP_SHARE {
        let clear = clearest.and_then(|ridge| ridge.clearest_span(GAP_SHARE));
        warnings.push(Warning::ManyGaps { gap_share, clear: clear.filter(|span| span.length_s() >= HELD_S) });
    }
    // of the speed that is told: those of other methods beside it may follow other lines
    let spread_share = speeds.first().and_then(|speed| Some(speed.spread_rev_s? / speed.speed.rev_s()));
    if let Some(spread_share) = spread_share.filter(|share| *share > SPREAD_SHARE) {
        warnings.push(Warning::SeveralLines { spread_share });
    }
    warnings
}
