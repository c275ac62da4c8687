//! In which order motors were started at the beginning of a recording: who starts them knows it, and so whose each track is.
//!
//! ```text
//! sound before and into the hover ─▶ spectra of frames (frames) ─▶ level of each rotor, all rotors solved for together (lines),
//!                                                                                    │   their speeds followed back in time
//! tracks of the hover ───────────────────────────────────────────────────────────────┘
//! labels ◀── names in the order of the starts ◀── when each begins (onset), unless something turns at other speeds (other_speed)
//! ```

mod frames;
mod lines;
mod onset;
mod other_speed;
mod reader;

use crate::settings::LabelsConfig;
use frames::FRAME_S;
use hovertone_analysis::{Hover, LabelSource, NotTold, Outcome, RotorEstimate, RotorLabel, RotorLabels, SpeedAnalysis};
use hovertone_rotor_speed::{
    Config, Error, HoverPart, HoverRotors, ToneConfig, passes_of_speed, rotors_from_survey, speed_from_survey,
    survey_from_passes,
};
use hovertone_signal::SignalError;
use hovertone_signal::passes::Passes;
use reader::{SPIN_UP_S_MAX, SpinUpReader, SpinUpWanted};
use serde::Serialize;
use statrs::distribution::{ContinuousCDF, Normal};

/// So long after the last motor's start all turn steadily.
const SETTLED_S: f64 = 1.0;

/// When each rotor began to turn at the speed that it has in the hover.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct SpinUp {
    /// Of each rotor, in their order; empty where it is not told.
    pub begins: Vec<RotorBegin>,
    /// Why it is not told.
    pub not_told: Option<NotTold>,
}

/// When a rotor began.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct RotorBegin {
    /// On the recording's clock; where it was there before the recording, the recording's start.
    pub time_s: f64,
    /// Its standard uncertainty: of the sound, and of how long motors take to run up.
    pub std_uncertainty_s: f64,
}

impl SpinUp {
    fn not_told(reason: NotTold) -> Self {
        Self { begins: Vec::new(), not_told: Some(reason) }
    }

    /// From when on all rotors turn.
    fn settled_s(&self) -> f64 {
        self.begins.iter().map(|begin| begin.time_s).fold(f64::NEG_INFINITY, f64::max) + SETTLED_S
    }
}

/// Labels of `tracks` rotors from the order in which they were started: `names` in that order, each with its number from 1.
///
/// The starts are ordered beyond doubt, or nothing is told: neighbours must be further apart than a frame, and the probability of
/// the order, of Gaussian errors, above `probability_min`.
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
    if tracks != names.len() || tracks != spin_up.begins.len() {
        return not_told(NotTold::TooFewTracks { tracks, needed: names.len() });
    }
    let mut order: Vec<usize> = (0..tracks).collect();
    order.sort_by(|&a, &b| spin_up.begins[a].time_s.total_cmp(&spin_up.begins[b].time_s));
    let (mut probability, mut nearest_s) = (1.0, f64::INFINITY);
    for pair in order.windows(2) {
        let [earlier, later] = [spin_up.begins[pair[0]], spin_up.begins[pair[1]]];
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
    for (&track, (number, name)) in order.iter().zip(names) {
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

/// When each rotor of a finished analysis began to turn; one pass. `rotor_count` rotors turn, and all must have been separated.
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
    let wanted = SpinUpWanted { sample_rate_hz: passes.sample_rate_hz(), heard: analysis.heard, rotor_count, tone };
    spin_up_of_rotors(passes, &wanted, &analysis.hover, rotors)
}

fn spin_up_of_rotors(
    passes: &mut Passes<'_>,
    wanted: &SpinUpWanted<'_>,
    hover: &Hover,
    rotors: &[RotorEstimate],
) -> Result<SpinUp, SignalError> {
    let mut reader = match SpinUpReader::new(wanted, hover, rotors) {
        Ok(reader) => reader,
        Err(reason) => return Ok(SpinUp::not_told(reason)),
    };
    passes.listen(&Hover::whole(reader.span).spans_s(), &mut reader)?;
    Ok(reader.finish())
}

/// Passes that [`speed_after_spin_up`] makes: those of the speed, two for the rotors before, and one for each search of the starts.
pub fn passes_of_spin_up(config: &Config) -> u32 {
    passes_of_speed(config) + 2 + 2
}

/// The speeds of a recording that begins before its rotors turn, and when each of them began.
///
/// Rotors are separated in the later half of the hover, where all turn, and followed back to their starts. The speeds are those of the
/// hover after the last start, in which the rotors are separated and followed back once more. Where the starts are not found, the speeds
/// are those of the whole hover.
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
    let wanted = SpinUpWanted {
        sample_rate_hz: passes.sample_rate_hz(),
        heard: surveyed.heard(),
        rotor_count,
        tone: &config.tone,
    };
    let first = spin_up_of_rotors(passes, &wanted, &hover, &rotors)?;
    if first.not_told.is_some() {
        return Ok((speed_from_survey(passes, &surveyed, config)?, first));
    }
    let settled = in_part(HoverPart::After { time_s: first.settled_s() });
    let analysis = speed_from_survey(passes, &surveyed, &settled)?;
    let spin_up = spin_up_from_analysis(passes, &analysis, rotor_count, &config.tone)?;
    Ok((analysis, spin_up))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn told(times_s: &[f64], std_uncertainty_s: f64) -> RotorLabels {
        let begins = times_s.iter().map(|&time_s| RotorBegin { time_s, std_uncertainty_s }).collect();
        let names: Vec<(usize, String)> = [3, 1, 2].map(|number| (number, format!("motor {number}"))).into();
        labels_from_spin_up(&SpinUp { begins, not_told: None }, 3, &names, &LabelsConfig::default())
    }

    #[test]
    fn names_go_by_the_order_of_the_begins() {
        let labels = told(&[5.0, 1.0, 3.0], 0.1);
        let numbers: Vec<usize> = labels.rotors.iter().flatten().map(|label| label.number).collect();
        assert_eq!((numbers, labels.not_told), (vec![2, 3, 1], None));
        assert!(labels.probability.unwrap() > 0.9999 && labels.offset_s.is_none());
    }

    #[test]
    fn begins_that_could_be_in_another_order_tell_nothing_of_any_rotor() {
        // within a frame of each other; or too uncertain: two of 0.6 s, 1 s apart: P = Φ(1 / 0.85) = 0.88
        for (times_s, std_s) in [([5.0, 1.0, 1.3], 0.01), ([1.0, 2.0, 5.0], 0.6)] {
            let labels = told(&times_s, std_s);
            assert_eq!(labels.rotors, vec![None; 3]);
            assert!(matches!(labels.not_told, Some(NotTold::StartedTogether { .. })), "{labels:?}");
        }
        let fewer = told(&[1.0, 3.0], 0.1);
        assert!(matches!(fewer.not_told, Some(NotTold::TooFewTracks { tracks: 3, needed: 3 })), "{fewer:?}");
    }
}
