//! Hover → excerpts: overlapping spans of equal length, which the paper calls samples (its database, figure 5).

use crate::speed::SampleConfig;
use hovertone_analysis::{Hover, Span, Warning};

/// Largest part of an excerpt that may be missing at the end of a segment, as a share: rounding, or the last packet of a codec. *Numeric.*
const MISSING_SHARE_MAX: f64 = 0.02;

/// The excerpts of each segment of a hover: of length `length_s`, each `1 − overlap` of this length after the last. A hover shorter than
/// one excerpt gives one shorter excerpt, with a warning.
///
/// A trial of 10 s gives two excerpts of 5 s with 40 % overlap; the five of the paper would need 2.94 s.
pub(crate) fn excerpts_from_hover(hover: &Hover, config: &SampleConfig, warnings: &mut Vec<Warning>) -> Vec<Span> {
    let hop_s = config.length_s * (1.0 - config.overlap);
    let tolerance_s = MISSING_SHARE_MAX * config.length_s;
    let mut excerpts = Vec::new();
    for segment in &hover.segments {
        let count = ((segment.length_s() - config.length_s + tolerance_s) / hop_s).floor() + 1.0;
        excerpts.extend((0..count.max(0.0) as usize).map(|index| {
            let from_s = segment.from_s + hop_s * index as f64;
            Span { from_s, to_s: (from_s + config.length_s).min(segment.to_s) }
        }));
    }
    if excerpts.is_empty()
        && let Some(longest) = hover.segments.iter().max_by(|a, b| a.length_s().total_cmp(&b.length_s()))
    {
        warnings.push(Warning::HoverShorterThanSample { hover_s: longest.length_s(), length_s: config.length_s });
        excerpts.push(*longest);
    }
    excerpts
}

#[cfg(test)]
mod tests {
    use super::*;

    fn excerpts(length_s: f64, hover_s: f64) -> Vec<Span> {
        let hover = Hover::whole(Span { from_s: 1.0, to_s: 1.0 + hover_s });
        excerpts_from_hover(&hover, &SampleConfig { length_s, overlap: 0.4 }, &mut Vec::new())
    }

    #[test]
    fn ten_seconds_hold_two_excerpts_of_five_or_five_of_2_94() {
        let two = excerpts(5.0, 10.0);
        assert_eq!(two, [Span { from_s: 1.0, to_s: 6.0 }, Span { from_s: 4.0, to_s: 9.0 }]);
        assert_eq!(excerpts(2.94, 10.0).len(), 5);
    }

    #[test]
    fn a_short_hover_is_one_excerpt_with_a_warning() {
        let hover = Hover::whole(Span { from_s: 0.0, to_s: 3.0 });
        let mut warnings = Vec::new();
        assert_eq!(excerpts_from_hover(&hover, &SampleConfig::default(), &mut warnings).len(), 1);
        assert!(matches!(warnings[..], [Warning::HoverShorterThanSample { .. }]));
        assert_eq!(excerpts_from_hover(&Hover::default(), &SampleConfig::default(), &mut Vec::new()), []);
    }

    #[test]
    fn a_recording_of_one_length_less_a_packet_is_one_excerpt() {
        let one = excerpts(5.0, 4.98);
        assert_eq!(one.len(), 1);
        assert!(one[0].to_s <= 5.98 + 1e-12);
    }
}
