//! Stage 4, one pass: hover → ridges of the harmonics of the tone, and the speed by harmonic likelihood from all lines.

use super::{Silence, Stop, Surveyed};
use crate::config::Config;
use crate::detection::{clearest_ridges, or_mains_hum};
use crate::harmonic::{HarmonicTracer, HarmonicTrack};
use crate::ridge::RidgeTracer;
use crate::tone::{bands_around, bands_worth_following, lines_around, lines_worth_hearing};
use hovertone_analysis::{Band, Hover, NoTone, Ridge, Warning};
use hovertone_signal::passes::Passes;

/// The lines of one candidate in its hover, as ridges and by harmonic likelihood.
pub(crate) struct Lines {
    /// Bands of the ridges.
    pub(crate) bands: Vec<Band>,
    /// The ridges at the frame length of the settings, where given; otherwise the clearest.
    pub(crate) ridges: Vec<Ridge>,
    /// Speed along the hover by harmonic likelihood.
    pub(crate) harmonic: HarmonicTrack,
    /// Bands that were left out, with the reasons.
    pub(crate) warnings: Vec<Warning>,
}

impl Lines {
    /// Whether the lines keep their phase in most of the hover.
    pub(crate) fn keep_phase(&self, hover: &Hover, config: &Config) -> bool {
        self.harmonic.steady_share(hover.length_s()) >= config.ridge.steady_share_min
    }
}

/// Analyses the hover at every frame length of the ladder, and all lines together, in one pass.
///
/// # Errors
/// A source that fails, a band above half the sample rate; "no rotor tone" where no band can be followed or no frame fits in the hover.
pub(crate) fn lines_from_hover(
    passes: &mut Passes<'_>,
    surveyed: &Surveyed,
    hover: &Hover,
    speed_rev_s: f64,
    config: &Config,
) -> Result<Lines, Stop> {
    let (survey, sample_rate_hz) = (&surveyed.survey, passes.sample_rate_hz());
    let mut warnings = Vec::new();
    let bands = bands_around(speed_rev_s, &config.tone, sample_rate_hz, &mut warnings)?;
    let bands = match bands_worth_following(bands, survey, &mut warnings) {
        Ok(bands) => bands,
        Err(reason) => return Err(Silence { reason, hover: hover.clone(), warnings }.into()),
    };
    let channel_bands = lines_worth_hearing(lines_around(speed_rev_s, &config.tone, sample_rate_hz), survey);
    let tracers = ridge_tracers(&bands, hover.length_s(), sample_rate_hz, config);
    let mut listeners = (tracers, HarmonicTracer::new(sample_rate_hz, &channel_bands));
    passes.listen(&hover.spans_s(), &mut listeners)?;
    let mut ladder: Vec<Vec<Ridge>> = listeners.0.into_iter().map(RidgeTracer::finish).collect();
    let harmonic = listeners.1.finish();
    let wanted = config.spectrogram.window_s.and_then(|_| ladder.pop());
    match clearest_ridges(&ladder).cloned() {
        Some(clearest) => {
            let ridges = wanted.unwrap_or(clearest);
            Ok(Lines { bands, ridges, harmonic, warnings })
        }
        None => {
            let reason = or_mains_hum(NoTone::NoHover, survey);
            Err(Silence { reason, hover: hover.clone(), warnings }.into())
        }
    }
}

/// A tracer for each frame length of the ladder, and last for the frame length of the settings, where given.
fn ridge_tracers(bands: &[Band], hover_s: f64, sample_rate_hz: f64, config: &Config) -> Vec<RidgeTracer> {
    let spectrogram = &config.spectrogram;
    let frames_max = if config.wants_ridges() { spectrogram.frames_max } else { spectrogram.verdict_frames_max };
    spectrogram
        .ladder_s(bands.first().map_or(0.0, Band::width_hz))
        .into_iter()
        .chain(spectrogram.window_s)
        .map(|window_s| {
            let hop_s = spectrogram.hop_s(window_s, hover_s, frames_max);
            RidgeTracer::new(window_s, hop_s, bands, sample_rate_hz, spectrogram, &config.ridge)
        })
        .collect()
}
