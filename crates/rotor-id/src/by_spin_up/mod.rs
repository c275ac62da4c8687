//! Labels from the sequence in which the motors were started at the beginning of a recording: who starts them knows it.
//!
//! ```text
//! sound before and in the hover ─▶ spectra of short frames (listener, frames)
//!                                          │
//! tracks of the hover ─────────────────────┼─▶ speed and power of each rotor, all rotors solved together (joint_lines), followed back
//!                                          │   in time (start_search)
//!                                          ▼
//! labels ◀── sequence of the starts ◀── onset of each rotor's power (onset), unless lines of another speed are present (other_speed)
//! ```

mod frames;
mod joint_lines;
mod listener;
mod onset;
mod other_speed;
mod start_search;

use crate::settings::LabelsConfig;
use frames::FRAME_S;
use hovertone_analysis::{
    Hover, LabelSource, NotTold, Outcome, RotorEstimate, RotorLabel, RotorLabels, Span, SpeedAnalysis,
};
use hovertone_rotor_speed::{
    Config, Error, HoverPart, HoverRotors, ToneConfig, passes_of_speed, rotors_from_survey, speed_from_survey,
    survey_from_passes,
};
use hovertone_signal::SignalError;
use hovertone_signal::passes::Passes;
use listener::{SPIN_UP_S_MAX, SpinUpListener, SpinUpRequest};
use serde::Serialize;
use statrs::distribution::{ContinuousCDF, Normal};

/// Time after the last start from which on all rotors turn steadily, in s. *Decision.*
const SETTLED_S: f64 = 1.0;

/// The starts of the rotors of a hover.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct SpinUp {
    /// The start of each rotor, in the sequence of the rotors; empty if one is unknown.
    pub starts: Vec<RotorStart>,
    /// Why the starts are unknown.
    pub not_told: Option<NotTold>,
}

/// The time at which a rotor reaches about the speed of the hover.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct RotorStart {
    /// On the recording's clock; the start of the recording if the rotor turns already by then.
    pub time_s: f64,
    /// Standard uncertainty, from the sound and from the unknown time that the motor needs to run up.
    pub std_uncertainty_s: f64,
}

impl SpinUp {
    fn not_told(reason: NotTold) -> Self {
        Self { starts: Vec::new(), not_told: Some(reason) }
    }

    /// The same, where the hover begins with the recording: starts that are not found are not there.
    fn of_hover(self, analysis: &SpeedAnalysis) -> Self {
        let begins_with = |segment: &Span| segment.from_s - analysis.heard.from_s < FRAME_S;
        let has_no_lead = analysis.hover.segments.first().is_some_and(begins_with);
        match self.not_told {
            Some(NotTold::NotFollowed { .. } | NotTold::RotorsTooClose { .. }) if has_no_lead => {
                Self::not_told(NotTold::NoStart)
            }
            _ if self.turn_from_first() => Self::not_told(NotTold::NoStart),
            _ => self,
        }
    }

    /// Whether all rotors turn already where the recording begins: such a start has no uncertainty.
    fn turn_from_first(&self) -> bool {
        !self.starts.is_empty() && self.starts.iter().all(|start| start.std_uncertainty_s == 0.0)
    }

    /// Time from which on all rotors turn steadily.
    fn settled_s(&self) -> f64 {
        self.starts.iter().map(|start| start.time_s).fold(f64::NEG_INFINITY, f64::max) + SETTLED_S
    }
}

/// The labels of `tracks` rotors, from the sequence of their starts: `names` in this sequence, each with its number from 1.
///
/// All rotors have a label or none has. Neighbours in the sequence must lie further apart than a frame, and the product of the
/// probabilities that each is later than the one before, for normal errors, must reach `probability_min`.
pub fn labels_from_spin_up(
    spin_up: &SpinUp,
    tracks: usize,
    names: &[(usize, String)],
    config: &LabelsConfig,
) -> RotorLabels {
    let not_told = |reason| RotorLabels::not_told(LabelSource::SpinUp, tracks, reason);
    if let Some(reason) = &spin_up.not_told {
        return not_told(reason.clone());
    }
    if tracks != names.len() || tracks != spin_up.starts.len() {
        return not_told(NotTold::TooFewTracks { tracks, needed: names.len() });
    }
    let mut sequence: Vec<usize> = (0..tracks).collect();
    sequence.sort_by(|&a, &b| spin_up.starts[a].time_s.total_cmp(&spin_up.starts[b].time_s));
    let (mut probability, mut nearest_s) = (1.0, f64::INFINITY);
    for pair in sequence.windows(2) {
        let [earlier, later] = [spin_up.starts[pair[0]], spin_up.starts[pair[1]]];
        let apart_s = later.time_s - earlier.time_s;
        let std_s = earlier.std_uncertainty_s.hypot(later.std_uncertainty_s).max(f64::MIN_POSITIVE);
        probability *= Normal::standard().cdf(apart_s / std_s);
        nearest_s = f64::min(nearest_s, apart_s);
    }
    if nearest_s < FRAME_S || probability < config.probability_min {
        let reason = NotTold::StartedTogether { apart_s: nearest_s };
        return RotorLabels { probability: Some(probability), ..not_told(reason) };
    }
    let mut rotors = vec![None; tracks];
    for (&track, (number, name)) in sequence.iter().zip(names) {
        rotors[track] = Some(RotorLabel { number: *number, name: name.clone(), probability });
    }
    RotorLabels {
        source: LabelSource::SpinUp,
        offset_s: None,
        offset_std_s: None,
        probability: Some(probability),
        rotors,
        not_told: None,
    }
}

/// The starts of the rotors of a finished analysis; one pass. `rotor_count` rotors turn, and all must have been separated.
///
/// # Errors
/// A source that fails.
pub fn spin_up_from_analysis(
    passes: &mut Passes<'_>,
    analysis: &SpeedAnalysis,
    rotor_count: usize,
    tone: &ToneConfig,
) -> Result<SpinUp, SignalError> {
    let rotors: &[RotorEstimate] = match &analysis.outcome {
        Outcome::Ok(found) => &found.rotors,
        Outcome::NoRotorTone { .. } => &[],
    };
    let request =
        SpinUpRequest { sample_rate_hz: passes.sample_rate_hz(), recording: analysis.heard, rotor_count, tone };
    spin_up_of_rotors(passes, &request, &analysis.hover, rotors)
}

fn spin_up_of_rotors(
    passes: &mut Passes<'_>,
    request: &SpinUpRequest<'_>,
    hover: &Hover,
    rotors: &[RotorEstimate],
) -> Result<SpinUp, SignalError> {
    let mut listener = match SpinUpListener::new(request, hover, rotors) {
        Ok(listener) => listener,
        Err(reason) => return Ok(SpinUp::not_told(reason)),
    };
    passes.listen(&Hover::whole(listener.span).spans_s(), &mut listener)?;
    Ok(listener.finish())
}

/// Number of passes of [`speed_after_spin_up`]: the passes of the speed, two for the first separation, and one for each of the two searches of
/// the starts.
pub fn passes_of_spin_up(config: &Config) -> u32 {
    passes_of_speed(config) + 2 + 2
}

/// The speeds of a recording that begins before its rotors turn, and the start of each rotor.
///
/// The rotors are separated in the later half of the hover, where all turn, and followed back to their starts. The hover after the last
/// start gives the speeds; its rotors are separated and followed back once more. If a start is unknown, the whole hover gives the speeds.
///
/// # Errors
/// As [`hovertone_rotor_speed::speed_from_source`].
pub fn speed_after_spin_up(passes: &mut Passes<'_>, config: &Config) -> Result<(SpeedAnalysis, SpinUp), Error> {
    let surveyed = survey_from_passes(passes, config)?;
    let rotor_count = config.rotors.count as usize;
    let in_part = |hover_part: HoverPart| Config { hover_part, ..config.clone() };
    let later = in_part(HoverPart::LaterHalf { of_s_max: SPIN_UP_S_MAX });
    let HoverRotors { hover, rotors } = rotors_from_survey(passes, &surveyed, &later)?;
    if hover.segments.is_empty() {
        let analysis = speed_from_survey(passes, &surveyed, config)?;
        let spin_up = spin_up_from_analysis(passes, &analysis, rotor_count, &config.tone)?;
        return Ok((analysis, spin_up));
    }
    let request = SpinUpRequest {
        sample_rate_hz: passes.sample_rate_hz(),
        recording: surveyed.heard(),
        rotor_count,
        tone: &config.tone,
    };
    let first = spin_up_of_rotors(passes, &request, &hover, &rotors)?;
    if first.not_told.is_some() || first.turn_from_first() {
        let analysis = speed_from_survey(passes, &surveyed, config)?;
        let spin_up = first.of_hover(&analysis);
        return Ok((analysis, spin_up));
    }
    let settled = in_part(HoverPart::After { time_s: first.settled_s() });
    let analysis = speed_from_survey(passes, &surveyed, &settled)?;
    let spin_up = spin_up_from_analysis(passes, &analysis, rotor_count, &config.tone)?;
    Ok((analysis, spin_up))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn labels(times_s: &[f64], std_uncertainty_s: f64) -> RotorLabels {
        let starts = times_s.iter().map(|&time_s| RotorStart { time_s, std_uncertainty_s }).collect();
        let names: Vec<(usize, String)> = [3, 1, 2].map(|number| (number, format!("motor {number}"))).into();
        labels_from_spin_up(&SpinUp { starts, not_told: None }, 3, &names, &LabelsConfig::default())
    }

    #[test]
    fn names_follow_the_sequence_of_the_starts() {
        let labels = labels(&[5.0, 1.0, 3.0], 0.1);
        let numbers: Vec<usize> = labels.rotors.iter().flatten().map(|label| label.number).collect();
        assert_eq!((numbers, labels.not_told), (vec![2, 3, 1], None));
        assert!(labels.probability.unwrap() > 0.9999 && labels.offset_s.is_none());
    }

    /// A recording that begins in the hover has no starts, and is said to have none.
    #[test]
    fn a_hover_from_the_first_moment_on_has_no_starts() {
        let begins_at = |from_s: f64| SpeedAnalysis {
            heard: Span { from_s: 0.0, to_s: 20.0 },
            hover: Hover::whole(Span { from_s, to_s: 20.0 }),
            outcome: Outcome::NoRotorTone { reason: hovertone_analysis::NoTone::NoHover },
            warnings: Vec::new(),
        };
        let lost = || SpinUp::not_told(NotTold::NotFollowed { tracks: 4 });
        assert_eq!(lost().of_hover(&begins_at(0.0)).not_told, Some(NotTold::NoStart));
        assert_eq!(lost().of_hover(&begins_at(8.0)).not_told, Some(NotTold::NotFollowed { tracks: 4 }));
        let turning = RotorStart { time_s: 0.0, std_uncertainty_s: 0.0 };
        let found = SpinUp { starts: vec![turning; 4], not_told: None };
        assert_eq!(found.of_hover(&begins_at(0.0)).not_told, Some(NotTold::NoStart));
        // the first motor turned already, the others start
        let starts = vec![turning, RotorStart { time_s: 3.0, std_uncertainty_s: 0.1 }];
        let found = SpinUp { starts, not_told: None };
        assert_eq!(found.clone().of_hover(&begins_at(0.0)), found);
    }

    #[test]
    fn no_rotor_has_a_label_if_the_sequence_is_uncertain() {
        // within a frame of each other; or too uncertain: two of 0.6 s, 1 s apart: P = Φ(1 / 0.85) = 0.88
        for (times_s, std_s) in [([5.0, 1.0, 1.3], 0.01), ([1.0, 2.0, 5.0], 0.6)] {
            let labels = labels(&times_s, std_s);
            assert_eq!(labels.rotors, vec![None; 3]);
            assert!(matches!(labels.not_told, Some(NotTold::StartedTogether { .. })), "{labels:?}");
        }
        let fewer = labels(&[1.0, 3.0], 0.1);
        assert!(matches!(fewer.not_told, Some(NotTold::TooFewTracks { tracks: 3, needed: 3 })), "{fewer:?}");
    }
}
