//! Stage 1, one pass: sound → survey of the whole recording.

use super::Silence;
use crate::config::Config;
use crate::error::Error;
use crate::evidence::{Beliefs, EvidenceConfig, ExcessBuilder, Looks, RotorLines, WantedRotor, beliefs_from_looks};
use crate::survey::{MainsHum, RowsBuilder, Survey, SurveyBuilder};
use hovertone_analysis::{NoTone, Span};
use hovertone_signal::passes::{Passes, Piece};
use std::ops::RangeInclusive;

/// A survey of a recording, with the span that it covers.
#[derive(Debug)]
pub struct Surveyed {
    pub(crate) survey: Survey,
    pub(crate) heard: Span,
    /// End of the recording, or of the chosen times if they end before it.
    end_s: f64,
    /// Power over the floor in short and long frames.
    pub(crate) looks: Looks,
}

impl Surveyed {
    /// The span of the survey on the recording's clock.
    pub fn heard(&self) -> Span {
        self.heard
    }

    /// The beliefs in the speeds of a rotor. `None` where none is heard.
    ///
    /// # Errors
    /// Mains hum, where the blade pass of the rotor is one of its lines.
    pub(crate) fn beliefs(&self, wanted: &WantedRotor, config: &Config) -> Result<Option<Beliefs>, NoTone> {
        // who names the tone by a band says that it is there: then only evidence against it refutes it
        let levels_nats_min = if config.tone.is_named_by_band() { 0.0 } else { config.evidence.levels_nats_min };
        let evidence = EvidenceConfig { levels_nats_min, ..config.evidence };
        let heard = beliefs_from_looks(&self.looks, wanted, &evidence);
        // above the frequencies that were searched for hum, a line may happen to be at a multiple
        let lines_hz = || heard.iter().flat_map(|beliefs| beliefs.telling_hz(&evidence));
        let is_searched = |line_hz: &RangeInclusive<f64>| *line_hz.end() <= self.survey.fine_hz_max;
        let holds = |hum: &&MainsHum| lines_hz().filter(is_searched).any(|line_hz| hum.holds(&line_hz));
        match self.survey.hum.as_ref().filter(holds) {
            Some(hum) => Err(NoTone::MainsHum { mains_hz: hum.mains_hz }),
            None => Ok(heard),
        }
    }

    /// Checks that the survey may hold a tone.
    ///
    /// # Errors
    /// "No rotor tone" where the span of the settings is outside the recording, or the survey is too short or silent.
    pub(crate) fn check(&self, config: &Config) -> Result<(), Silence> {
        if config.span.is_given() && self.heard.length_s() <= 0.0 {
            return Err(Silence::because(NoTone::OutsideRecording { end_s: self.end_s }));
        }
        self.survey.why_nothing(self.heard.length_s()).map_or(Ok(()), |reason| Err(Silence::because(reason)))
    }
}

/// Number of passes of the survey.
pub(crate) fn passes_of_survey() -> u32 {
    1
}

/// Surveys the span of the settings. The builder `beside` gets the same samples in the same pass.
///
/// # Errors
/// A source that fails.
pub(crate) fn survey_from_source(
    passes: &mut Passes<'_>,
    config: &Config,
    mut beside: Option<&mut RowsBuilder>,
) -> Result<Surveyed, Error> {
    let mut from_s = config.span.from_s.unwrap_or(f64::MIN).max(passes.start_s());
    let span_s = from_s..config.span.to_s.unwrap_or(f64::INFINITY);
    let mut builder = SurveyBuilder::new(config.hover.survey(), passes.sample_rate_hz(), from_s);
    let hz_max = RotorLines::of_tone(&config.tone).hz_max();
    let mut excess = ExcessBuilder::new(passes.sample_rate_hz(), from_s, hz_max);
    let to_s = passes.pieces(std::slice::from_ref(&span_s), |piece| match piece {
        Piece::Start(time_s) => from_s = time_s,
        Piece::Samples(samples) => {
            builder.push(samples);
            excess.push(samples);
            if let Some(beside) = &mut beside {
                beside.push(samples);
            }
        }
        Piece::Heard(_) => {}
    })?;
    let heard = Span { from_s, to_s: to_s.max(from_s) };
    Ok(Surveyed { survey: builder.finish(to_s), heard, end_s: to_s, looks: excess.finish() })
}
