//! The whole flow on one screen: source → survey → hover → bands → ridges → samples → speed. No arithmetic here.

use crate::channel::ChannelBand;
use crate::config::Config;
use crate::error::Error;
use crate::harmonic::{HarmonicTracer, HarmonicTrack, RotorTracks};
use crate::hover::{Hover, RowsBuilder, Survey, SurveyBuilder, hover_from_survey, restless_s};
use crate::labels::SpinUp;
use crate::listening::{PASS_COUNT, listen_again};
use crate::method::Method;
use crate::ridge::{Ridge, RidgeTracer};
use crate::rotor_readings::{condition_from_source, hover_after_spin_up, rotors_from_source, spin_up_from_source};
use crate::sample::samples_from_hover;
use crate::signal::SignalSource;
use crate::span::Span;
use crate::speed::{HarmonicWeights, RotorEstimate, SpeedEstimate, Track, TrackPoint, mean_track};
use crate::stream::{Piece, Progress, checked_rate_hz, for_each_piece};
use crate::tone::{
    BLADES_MAX, Band, CombMap, bands_around, bands_worth_following, families_agree, foreign_series, lines_and_between,
    lines_around, lines_worth_hearing, search_range_rev_s,
};
use crate::verdict::{
    NoTone, clearest_ridges, mains_hum_reason, no_tone_reason, not_held_reason, or_mains_hum, warning_of_rotors,
    warning_of_samples, warnings_of_hover, warnings_of_speed,
};
use crate::warning::Warning;
use serde::Serialize;

/// What a recording says of its rotors.
#[derive(Clone, Debug, Serialize)]
pub struct SpeedAnalysis {
    /// What was listened to, on the recording's clock.
    pub heard: Span,
    /// What was used of it, and what was cut away and why.
    pub hover: Hover,
    /// The speeds, or why there are none.
    pub outcome: Outcome,
    /// What weakens the result.
    pub warnings: Vec<Warning>,
}

/// The answer: speeds, or that there is no rotor tone.
#[derive(Clone, Debug, Serialize)]
#[serde(tag = "status", rename_all = "snake_case")]
#[allow(clippy::large_enum_variant)] // one per recording, never in a hot collection
pub enum Outcome {
    /// A rotor was heard.
    Ok(RotorTone),
    /// No rotor was heard, and why.
    NoRotorTone {
        /// Why.
        reason: NoTone,
    },
}

/// A rotor's tone and the speeds it means.
#[derive(Clone, Debug, Serialize)]
pub struct RotorTone {
    /// Where the ridges were looked for.
    pub bands: Vec<Band>,
    /// Length of the frames.
    pub window_s: f64,
    /// One ridge for each band.
    pub ridges: Vec<Ridge>,
    /// Mean over all of the hover, one for each method in the order of [`Method::ALL`].
    pub speeds: Vec<SpeedEstimate>,
    /// Speed of each frame, by the configured method: of several rotors their mean, where all are told apart.
    pub track: Vec<TrackPoint>,
    /// The rotors one by one, fastest first; empty where they are not told apart.
    pub rotors: Vec<RotorEstimate>,
    /// When each rotor began to turn, where that is wanted.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub spin_up: Option<SpinUp>,
    /// The paper's samples, each with one speed for each method.
    pub samples: Vec<SampleSpeeds>,
}

/// One sample of a hover.
#[derive(Clone, Debug, Serialize)]
pub struct SampleSpeeds {
    /// When.
    pub span: Span,
    /// Its speed by each method in the order of [`Method::ALL`].
    pub speeds: Vec<SpeedEstimate>,
}

impl SampleSpeeds {
    /// The sample's speed by one method; by that of a single rotor where several were to be told apart and not even their mean is known.
    pub fn speed(&self, method: Method) -> Option<&SpeedEstimate> {
        speed_by(&self.speeds, method)
    }
}

fn speed_by(speeds: &[SpeedEstimate], method: Method) -> Option<&SpeedEstimate> {
    let instead = (method == Method::Separated).then_some(Method::Harmonic);
    [Some(method), instead].into_iter().flatten().find_map(|method| speeds.iter().find(|speed| speed.method == method))
}

impl RotorTone {
    /// The mean over the hover by one method; by that of a single rotor where several were to be told apart and not even their mean is known.
    pub fn speed(&self, method: Method) -> Option<&SpeedEstimate> {
        speed_by(&self.speeds, method)
    }
}

/// From a recording to the speed of its rotors. Reads the source twice, and a third time where a tone is weak and steady; memory does not grow with its length, but for
/// the list of samples.
///
/// # Errors
/// Settings that mean nothing, a source that fails, a band above half the sample rate. That there is no rotor tone is
/// no error but [`Outcome::NoRotorTone`].
pub fn speed_from_source(
    source: &mut dyn SignalSource,
    config: &Config,
    on_progress: &mut dyn FnMut(Progress),
) -> Result<SpeedAnalysis, Error> {
    config.check()?;
    let sample_rate_hz = checked_rate_hz(source)?;
    // a tone that the recording cannot hold is refused before it is read
    search_range_rev_s(&config.tone, sample_rate_hz)?;
    let (survey, heard) = survey_from_source(source, config, None, on_progress)?;
    speed_from_survey(source, &survey, heard, config, on_progress)
}

/// What follows the first reading.
pub(crate) fn speed_from_survey(
    source: &mut dyn SignalSource,
    survey: &Survey,
    heard: Span,
    config: &Config,
    on_progress: &mut dyn FnMut(Progress),
) -> Result<SpeedAnalysis, Error> {
    let sample_rate_hz = checked_rate_hz(source)?;
    let search_rev_s = search_range_rev_s(&config.tone, sample_rate_hz)?;
    let warnings = Vec::new();
    if config.span.is_given() && heard.length_s() <= 0.0 {
        return Ok(nothing_heard(heard, Hover::default(), NoTone::OutsideRecording, warnings));
    }
    if let Some(reason) = survey.why_nothing(heard.length_s()) {
        return Ok(nothing_heard(heard, Hover::default(), reason, warnings));
    }
    let map = CombMap::from_survey(survey, &config.tone, search_rev_s);
    let Some(speed_rev_s) = map.leading_speed_rev_s() else {
        return Ok(nothing_heard(heard, Hover::default(), or_mains_hum(NoTone::NoSeries, survey), warnings));
    };
    let first = speed_near(source, (survey, &map), heard, speed_rev_s, config, warnings.clone(), on_progress)?;
    // the comb takes a weak tone for one of its multiples; its lines say so
    let slower_rev_s = match &first.outcome {
        Outcome::NoRotorTone { reason: NoTone::SlowerShaft { speed_rev_s, .. } } => *speed_rev_s,
        _ => None,
    };
    let Some(slower_rev_s) = slower_rev_s.filter(|&speed| speed >= search_rev_s.0) else { return Ok(first) };
    let second = speed_near(source, (survey, &map), heard, slower_rev_s, config, warnings, on_progress)?;
    Ok(if matches!(second.outcome, Outcome::Ok(_)) { second } else { first })
}

/// What follows once the speed is known roughly.
fn speed_near(
    source: &mut dyn SignalSource,
    (survey, map): (&Survey, &CombMap),
    heard: Span,
    speed_rev_s: f64,
    config: &Config,
    mut warnings: Vec<Warning>,
    on_progress: &mut dyn FnMut(Progress),
) -> Result<SpeedAnalysis, Error> {
    let sample_rate_hz = source.sample_rate_hz();
    let hover =
        if config.span.is_given() { Hover::whole(heard) } else { hover_from_survey(survey, map, speed_rev_s, config) };
    let (hover, no_spin_up) = hover_after_spin_up(source, (heard, hover), speed_rev_s, survey, config, on_progress)?;
    let bands = bands_around(speed_rev_s, &config.tone, sample_rate_hz, &mut warnings)?;
    let tone_hz = speed_rev_s * config.tone.order.lines_per_turn();
    let bands = match bands_worth_following(bands, survey, &mut warnings) {
        Ok(bands) => bands,
        Err(reason) => return Ok(nothing_heard(heard, hover, reason, warnings)),
    };
    let lines = lines_worth_hearing(lines_around(speed_rev_s, &config.tone, sample_rate_hz), survey);
    let (mut ladder, harmonic) = lines_from_source(source, &hover, &bands, &lines, config, on_progress)?;
    let chosen = config.spectrogram.window_s.and_then(|_| ladder.pop());
    let Some(clearest) = clearest_ridges(&ladder) else {
        return Ok(nothing_heard(heard, hover, or_mains_hum(NoTone::NoHover, survey), warnings));
    };
    let mut not_a_line = no_tone_reason(clearest, &config.ridge);
    if not_a_line.is_some() && harmonic.steady_share(hover.length_s()) >= config.ridge.steady_share_min {
        let steady_rev_s = harmonic.speed_in(None, config.tone.order).map_or(speed_rev_s, |found| found.speed.rev_s());
        not_a_line = slower_shaft_from_source(source, &hover, (&lines, steady_rev_s), config, on_progress)?;
    }
    // several rotors crowd each other's lines; what both of their families say of the shaft is worth more
    let are_crowded = config.rotors.are_several() && matches!(not_a_line, Some(NoTone::NotALine { .. }));
    if are_crowded && families_agree(survey, map, &config.tone, sample_rate_hz, speed_rev_s)? {
        not_a_line = None;
    }
    if let Some(reason) = not_a_line
        .or_else(|| not_held_reason(restless_s(&hover, survey, map), &hover, tone_hz, &config.hover))
        .or_else(|| mains_hum_reason(clearest, survey))
        .or_else(|| foreign_series(survey, &hover, config, speed_rev_s))
    {
        return Ok(nothing_heard(heard, hover, or_mains_hum(reason, survey), warnings));
    }
    let ridges = chosen.unwrap_or_else(|| clearest.clone());
    let weights = HarmonicWeights::from_ridges(&ridges, &config.ridge, &mut warnings);
    let tracks: Vec<Track> = config.methods().filter_map(|method| weights.track(method, config.tone.order)).collect();
    let order = config.tone.order;
    let apart_is_wanted = config.methods().any(|method| method == Method::Separated);
    let apart = if apart_is_wanted {
        rotors_from_source(source, &hover, speed_rev_s, survey, config, on_progress)?
    } else {
        RotorTracks::default()
    };
    let apart = apart.unless_doubtful_beside(&harmonic, order);
    let speeds_in = |span: Option<&Span>| -> Vec<SpeedEstimate> {
        let length_s = span.map_or(hover.length_s(), Span::length_s);
        let loudest_share = config.budget.loudest_rotor_share(config.rotors.count);
        config
            .methods()
            .filter_map(|method| match tracks.iter().find(|track| track.method == method) {
                Some(track) => Some((weights.speed_in(span, track)?, loudest_share)),
                None if method == Method::Separated => apart.speed_in(span, order),
                None => Some((harmonic.speed_in(span, order)?, loudest_share)),
            })
            .map(|(speed, rotors_std_share)| speed.with_budget(&config.budget, rotors_std_share, length_s))
            .collect()
    };
    let window_s = ridges.first().map_or(0.0, |ridge| ridge.window_s);
    let speeds = speeds_in(None);
    if speeds.is_empty() {
        let reason = NoTone::NoFrame { window_s, hover_s: hover.length_s() };
        return Ok(nothing_heard(heard, hover, reason, warnings));
    }
    let samples: Vec<SampleSpeeds> = samples_from_hover(&hover, &config.samples, &mut warnings)
        .into_iter()
        .map(|span| SampleSpeeds { speeds: speeds_in(Some(&span)), span })
        .filter(|sample| !sample.speeds.is_empty())
        .collect();
    warnings.extend(warnings_of_hover(&hover));
    warnings.extend(warnings_of_speed(&ridges, &speeds));
    warnings.extend(warning_of_samples(&samples));
    let mut rotors = apart.rotors(order, &config.budget);
    let are_all_apart = config.method == Method::Separated && rotors.len() == config.rotors.count as usize;
    let track = match tracks.into_iter().find(|track| track.method == config.method) {
        Some(track) => track.points,
        None if are_all_apart => mean_track(&rotors),
        None => harmonic.points_in(None, order),
    };
    condition_from_source(source, &hover, &mut rotors, config, on_progress)?;
    let spin_up = match no_spin_up {
        Some(reason) => Some(SpinUp::not_told(reason)),
        None => spin_up_from_source(source, (heard, &hover), &rotors, config, on_progress)?,
    };
    warnings.extend(warning_of_rotors(&rotors, &speeds, if apart_is_wanted { config.rotors.count } else { 1 }));
    let outcome = Outcome::Ok(RotorTone { bands, window_s, speeds, track, rotors, spin_up, samples, ridges });
    Ok(SpeedAnalysis { heard, hover, outcome, warnings })
}

pub(crate) fn nothing_heard(heard: Span, hover: Hover, reason: NoTone, warnings: Vec<Warning>) -> SpeedAnalysis {
    SpeedAnalysis { heard, hover, outcome: Outcome::NoRotorTone { reason }, warnings }
}

/// First reading: the whole recording in coarse rows, and in those of a second builder beside them.
pub(crate) fn survey_from_source(
    source: &mut dyn SignalSource,
    config: &Config,
    mut beside: Option<&mut RowsBuilder>,
    on_progress: &mut dyn FnMut(Progress),
) -> Result<(Survey, Span), Error> {
    let mut from_s = config.span.from_s.unwrap_or(f64::MIN).max(source.start_s());
    let span = Span { from_s, to_s: config.span.to_s.unwrap_or(f64::INFINITY) };
    let mut builder = SurveyBuilder::new(&config.hover, source.sample_rate_hz(), from_s);
    let to_s = for_each_piece(source, &[span], |piece| match piece {
        Piece::Start(time_s) => from_s = time_s,
        Piece::Samples(samples) => {
            builder.push(samples);
            if let Some(beside) = &mut beside {
                beside.push(samples);
            }
        }
        Piece::Heard(time_s) => on_progress(Progress { pass: 1, pass_count: PASS_COUNT, time_s }),
    })?;
    Ok((builder.finish(to_s), Span { from_s, to_s: to_s.max(from_s) }))
}

/// Third reading, where a steady tone is too weak for the comb to have settled its octave: whether lines between the assumed ones
/// sound as well. A gear mesh has no octave to settle.
fn slower_shaft_from_source(
    source: &mut dyn SignalSource,
    hover: &Hover,
    (lines, speed_rev_s): (&[ChannelBand], f64),
    config: &Config,
    on_progress: &mut dyn FnMut(Progress),
) -> Result<Option<NoTone>, Error> {
    let order = config.tone.order.lines_per_turn();
    if order > BLADES_MAX {
        return Ok(None);
    }
    let mut harmonic = HarmonicTracer::new(source.sample_rate_hz(), &lines_and_between(lines, order, speed_rev_s));
    listen_again(source, hover, &mut harmonic, on_progress)?;
    Ok(harmonic.finish().lines_between(order).map(|between| NoTone::SlowerShaft {
        line_count: between.count,
        speed_rev_s: between.times_slower.map(|times| speed_rev_s / f64::from(times)),
    }))
}

/// Second reading: the ridges of the hover at every frame length that is tried, the one that the user wants last; and the
/// harmonic likelihood.
fn lines_from_source(
    source: &mut dyn SignalSource,
    hover: &Hover,
    bands: &[Band],
    lines: &[ChannelBand],
    config: &Config,
    on_progress: &mut dyn FnMut(Progress),
) -> Result<(Vec<Vec<Ridge>>, HarmonicTrack), Error> {
    let sample_rate_hz = source.sample_rate_hz();
    let spectrogram = &config.spectrogram;
    let frames_max = if config.wants_ridges() { spectrogram.frames_max } else { spectrogram.verdict_frames_max };
    let tracers: Vec<RidgeTracer> = spectrogram
        .ladder_s(bands.first().map_or(0.0, Band::width_hz))
        .into_iter()
        .chain(spectrogram.window_s)
        .map(|window_s| (window_s, spectrogram.hop_s(window_s, hover.length_s(), frames_max)))
        .map(|frames_s| RidgeTracer::new(frames_s, bands, sample_rate_hz, spectrogram, &config.ridge))
        .collect();
    let mut listeners = (tracers, HarmonicTracer::new(sample_rate_hz, lines));
    listen_again(source, hover, &mut listeners, on_progress)?;
    let (tracers, harmonic) = listeners;
    Ok((tracers.into_iter().map(RidgeTracer::finish).collect(), harmonic.finish()))
}
