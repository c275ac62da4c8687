//! Stage 3: candidate → the spans in which it hovers.

use super::{Candidates, Surveyed};
use crate::config::Config;
use crate::hover::{HoverPart, WantedHover, hover_from_survey};
use hovertone_analysis::Hover;

/// The hover at the leading speed of the candidates. Where the settings give a span, the whole span counts as hover.
pub(crate) fn hover_from_candidate(surveyed: &Surveyed, candidates: &Candidates, config: &Config) -> Hover {
    let hover = if config.span.is_given() {
        Hover::whole(surveyed.heard)
    } else {
        let wanted = WantedHover {
            speed_rev_s: candidates.leading_rev_s,
            band_half_width_share: config.tone.band_half_width_share,
            has_several_rotors: config.rotors.are_several(),
        };
        hover_from_survey(&surveyed.survey, &candidates.map, &wanted, &config.hover)
    };
    match config.hover_part {
        HoverPart::Whole => hover,
        HoverPart::LaterHalf { of_s_max } => hover.later_half(of_s_max),
        HoverPart::After { time_s } => hover.after_take_off(time_s),
    }
}
