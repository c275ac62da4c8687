//! Whether the ridges show a rotor at all, and what weakens what they show.

use crate::hover::HoverConfig;
use crate::ridge::RidgeConfig;
use crate::survey::Survey;
use hovertone_analysis::{
    CutReason, Hover, Method, NoTone, Ridge, RotorEstimate, SampleSpeeds, Span, SpeedEstimate, Warning,
};
use hovertone_signal::statistics::{mean, std};

/// Frame lengths whose share of lines differs by less than this are equally clear, and the longest, which resolves most,
/// is taken. Where rotors part or wander, lines get fewer with length, so that clarity itself keeps frames short. *Decision.*
const EQUALLY_CLEAR_SHARE: f64 = 0.01;
/// One-sided 95 % of a normal distribution. *Numeric.*
const CONFIDENCE_STDS: f64 = 1.645;
/// A ridge on the edge of its band in more frames than this is not in its band. *Decision.*
const EDGE_SHARE: f64 = 0.2;
/// More gaps than this are said. *Decision.*
const GAP_SHARE: f64 = 0.3;
/// A spread of twice the paper's (1.2 to 1.3 %) means more than one line. *Decision.*
const SPREAD_SHARE: f64 = 0.025;
/// A sample of fewer frames has a mean that one bad frame spoils. *Decision.*
const FEW_FRAMES: usize = 8;
/// Another speed is worth a warning when it lasts this share of the hover. *Decision.*
const OTHER_SPEED_LENGTH_SHARE: f64 = 0.5;

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

/// Why these ridges are no rotor; `None` when they are one.
///
/// The clearest harmonic must be a line in `line_share_min` of its frames with 95 % confidence (few frames prove little),
/// and another harmonic must be heard with it unless it is nearly always a line.
pub(crate) fn no_tone_reason(ridges: &[Ridge], config: &RidgeConfig) -> Option<NoTone> {
    let mut by_clarity: Vec<&Ridge> = ridges.iter().collect();
    by_clarity.sort_by(|a, b| b.line_share.total_cmp(&a.line_share));
    let clearest = by_clarity.first()?;
    let line_share = clearest.line_share;
    let tone_hz = mean(&clearest.points_hz(Method::MaximumTrace))
        .unwrap_or((clearest.band.band_hz_low + clearest.band.band_hz_high) / 2.0);
    if surely_above(line_share, clearest.independent_frames()) < config.line_share_min {
        return Some(NoTone::NotALine { tone_hz, line_share, line_share_min: config.line_share_min });
    }
    let has_company = by_clarity.get(1).is_none_or(|second| second.line_share >= config.company_share_min);
    (!has_company && line_share < config.lonely_line_share_min).then_some(NoTone::LonelyLine { tone_hz, line_share })
}

/// Why a hover that lies in pieces among other tones is none: music, speech and beeps change, a hover holds its speed.
pub(crate) fn not_held_reason(restless_s: f64, hover: &Hover, tone_hz: f64, config: &HoverConfig) -> Option<NoTone> {
    let held_s = hover.segments.iter().map(Span::length_s).fold(0.0, f64::max);
    let is_restless = held_s < config.held_s_min && restless_s > hover.length_s();
    (is_restless && held_s > 0.0).then_some(NoTone::NotHeld { tone_hz, held_s })
}

/// The reason as it is said where mains hum was taken out before: then the hum is what was heard.
pub(crate) fn or_mains_hum(reason: NoTone, survey: &Survey) -> NoTone {
    match (&survey.hum, &reason) {
        (Some(hum), NoTone::NoSeries | NoTone::NoHover | NoTone::NotALine { .. } | NoTone::LonelyLine { .. }) => {
            NoTone::MainsHum { mains_hz: hum.mains_hz }
        }
        _ => reason,
    }
}

/// Whether the clearest of the ridges is a line of the mains hum that was heard. A gear mesh above what was searched for hum
/// is none, whatever number it happens to stand at.
pub(crate) fn mains_hum_reason(ridges: &[Ridge], survey: &Survey) -> Option<NoTone> {
    let hum = survey.hum.as_ref()?;
    let clearest = ridges.iter().rev().max_by(|a, b| a.line_share.total_cmp(&b.line_share))?;
    let points_hz = clearest.points_hz(Method::MaximumTrace);
    let (mean_hz, std_hz) = (mean(&points_hz)?, std(&points_hz)?);
    let is_hum = mean_hz <= survey.fine_hz_max && hum.holds(mean_hz, std_hz);
    is_hum.then_some(NoTone::MainsHum { mains_hz: hum.mains_hz })
}

/// What a share counted in so many observations is above with 95 % confidence (Wilson's lower bound).
fn surely_above(share: f64, observations: f64) -> f64 {
    let z2 = CONFIDENCE_STDS * CONFIDENCE_STDS / observations.max(f64::MIN_POSITIVE);
    (share + z2 / 2.0 - (share * (1.0 - share) * z2 + z2 * z2 / 4.0).sqrt()) / (1.0 + z2)
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

/// What the samples say against their speeds.
pub(crate) fn warning_of_samples(samples: &[SampleSpeeds]) -> Option<Warning> {
    let fewest = samples.iter().flat_map(|sample| &sample.speeds).map(|speed| speed.frame_count).min()?;
    (fewest < FEW_FRAMES).then_some(Warning::FewFrames { frame_count: fewest })
}

/// Whether all rotors that there are were told apart.
pub(crate) fn warning_of_rotors(rotors: &[RotorEstimate], speeds: &[SpeedEstimate], count: u32) -> Option<Warning> {
    let resolved = rotors.len();
    let has_mean = speeds.iter().any(|speed| speed.method == Method::Separated);
    (count > 1 && resolved < count as usize).then_some(Warning::RotorsNotApart { resolved, of: count, has_mean })
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
            warnings.push(Warning::RidgeOnBandEdge { harmonic: ridge.band.harmonic, frames_share });
        }
    }
    let harmonic_count = ridges.iter().filter(used).count();
    if 2 * harmonic_count < ridges.len() || !ridges.iter().filter(used).any(|ridge| ridge.band.harmonic == 1) {
        warnings.push(Warning::FewHarmonicsAgree { used: harmonic_count, of: ridges.len() });
    }
    let gap_share = ridges.iter().filter(used).map(|ridge| 1.0 - ridge.point_share()).fold(1.0, f64::min);
    if gap_share > GAP_SHARE {
        warnings.push(Warning::ManyGaps { gap_share });
    }
    let spread_share =
        speeds.iter().filter_map(|speed| Some(speed.spread_rev_s? / speed.speed.rev_s())).fold(0.0, f64::max);
    if spread_share > SPREAD_SHARE {
        warnings.push(Warning::SeveralLines { spread_share });
    }
    warnings
}

#[cfg(test)]
mod tests {
    use super::surely_above;

    #[test]
    fn few_frames_prove_little() {
        assert!(surely_above(1.0, 1.0) < 0.5 && surely_above(1.0, 2.0) < 0.5);
        assert!(surely_above(1.0, 4.0) > 0.5);
        assert!(surely_above(0.6, 10.0) < 0.5 && surely_above(0.6, 200.0) > 0.5);
        assert!(surely_above(0.5, 1e9) < 0.5 && surely_above(0.501, 1e9) > 0.5);
        // NIST handbook 7.2.4.1: 4 of 20, two-sided 90 %: lower limit 0.0931 by Wilson's formula
        assert!((surely_above(0.2, 20.0) - 0.0931).abs() < 5e-4, "{}", surely_above(0.2, 20.0));
    }
}
