//! Stage 1, one pass, two where there is mains hum: sound → survey of the whole recording.

use super::Silence;
use crate::config::Config;
use crate::error::Error;
use crate::evidence::{
    Beliefs, EvidenceConfig, ExcessBuilder, Looks, RotorLines, WantedRotor, beliefs_from_looks,
    clear_beliefs_from_looks,
};
use crate::survey::{HumFinder, RowsBuilder, Survey};
use hovertone_analysis::{NoTone, Span};
use hovertone_signal::passes::{Passes, Piece};

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
    pub(crate) fn beliefs(&self, wanted: &WantedRotor, config: &Config) -> Option<Beliefs> {
        // who names the tone by a band says that it is there: then only evidence against it refutes it
        let levels_nats_min = if config.tone.is_named_by_band() { 0.0 } else { config.evidence.levels_nats_min };
        beliefs_from_looks(&self.looks, wanted, &EvidenceConfig { levels_nats_min, ..config.evidence })
    }

    /// The same of a rotor that is not faint, and that no band names.
    pub(crate) fn clear_beliefs(&self, wanted: &WantedRotor, config: &EvidenceConfig) -> Option<Beliefs> {
        clear_beliefs_from_looks(&self.looks, wanted, config)
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

/// Number of passes of the survey. Mains hum, where it is heard, makes one more.
pub(crate) fn passes_of_survey() -> u32 {
    1
}

/// Surveys the span of the settings; where there is mains hum, again without it, and so are all later passes. The builder `beside` gets the
/// samples of the first pass.
///
/// # Errors
/// A source that fails.
pub(crate) fn survey_from_source(
    passes: &mut Passes<'_>,
    config: &Config,
    mut beside: Option<&mut RowsBuilder>,
) -> Result<Surveyed, Error> {
    // an earlier survey may have been of another part
    passes.leave_out(None);
    let start_s = config.span.start_s(passes.start_s());
    let mut finder = HumFinder::new(config.hover.survey(), passes.sample_rate_hz(), start_s);
    let mut surveyed = survey_from_pass(passes, config, |samples| {
        finder.push(samples);
        if let Some(beside) = &mut beside {
            beside.push(samples);
        }
    })?;
    let hum = finder.finish(surveyed.end_s);
    if hum.is_some() {
        passes.leave_out(hum.clone());
        passes.expect_more(passes_of_survey());
        let rows_with_hum = std::mem::take(&mut surveyed.survey.rows);
        surveyed = survey_from_pass(passes, config, |_| {})?;
        surveyed.survey.rows_with_hum = Some(rows_with_hum);
        surveyed.survey.hum = hum;
    }
    Ok(surveyed)
}

/// One pass: the survey. `beside` gets the same samples.
fn survey_from_pass(
    passes: &mut Passes<'_>,
    config: &Config,
    mut beside: impl FnMut(&[f32]),
) -> Result<Surveyed, Error> {
    let mut from_s = config.span.start_s(passes.start_s());
    let span_s = from_s..config.span.to_s.unwrap_or(f64::INFINITY);
    let mut rows = RowsBuilder::new(passes.sample_rate_hz(), from_s, config.hover.survey().coarse_rows());
    let hz_max = RotorLines::of_tone(&config.tone).hz_max();
    let mut excess = ExcessBuilder::new(passes.sample_rate_hz(), from_s, hz_max, passes.left_out().cloned());
    let to_s = passes.pieces(std::slice::from_ref(&span_s), |piece| match piece {
        Piece::Start(time_s) => from_s = time_s,
        Piece::Samples(samples) => {
            rows.push(samples);
            excess.push(samples);
            beside(samples);
        }
        Piece::Heard(_) => {}
    })?;
    let heard = Span { from_s, to_s: to_s.max(from_s) };
    Ok(Surveyed { survey: Survey::of_rows(rows.finish(to_s)), heard, end_s: to_s, looks: excess.finish() })
}
