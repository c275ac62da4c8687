//! Stage 6: decision → the answer, by every wanted method.

use super::{Decision, Lines, Silence, Stop, at_ratio};
use crate::config::Config;
use crate::detection::{warning_of_parts, warning_of_rotors, warning_of_samples, warnings_of_hover, warnings_of_speed};
use crate::rotors::RotorTracks;
use crate::speed::{BudgetConfig, HarmonicWeights, Track, excerpts_from_hover, mean_track, with_budget};
use hovertone_analysis::{
    Hover, Method, NoTone, Outcome, Reading, RotorTone, SampleSpeeds, Span, SpeedAnalysis, SpeedEstimate, Warning,
};

/// Speeds over the hover and in each excerpt (*sample* in the paper), tracks, rotors, and warnings.
///
/// # Errors
/// "No rotor tone" where no method has a speed.
pub(crate) fn speeds_from_decision(
    heard: Span,
    hover: Hover,
    decision: Decision,
    config: &Config,
) -> Result<SpeedAnalysis, Stop> {
    let Decision { lines, rotors: rotor_tracks, alternatives, weighed, spread_share } = decision;
    let mut warnings = lines.warnings.clone();
    let order = config.tone.order;
    let weights = HarmonicWeights::from_ridges(&lines.ridges, &config.ridge, &mut warnings);
    // harmonics that differ follow different rotors: half of the distance is the standard deviation of two
    let rotor_spread_share = spread_share.max(weights.difference_share / 2.0);
    let config = &Config { budget: BudgetConfig { rotor_spread_share, ..config.budget }, ..config.clone() };
    let tracks: Vec<Track> = config.methods().filter_map(|method| weights.track(method, order)).collect();
    let one_line_count = config.rotors.count_of_one_line(lines.keep_phase(&hover, config));
    let heard_by =
        HeardBy { weights: &weights, tracks: &tracks, lines: &lines, rotor_tracks: &rotor_tracks, one_line_count };
    let speeds = heard_by.speeds_in(None, hover.length_s(), config);
    let window_s = lines.ridges.first().map_or(0.0, |ridge| ridge.window_s);
    if speeds.is_empty() {
        let reason = NoTone::NoFrame { window_s, hover_s: hover.length_s() };
        return Err(Silence { reason, hover, warnings }.into());
    }
    let samples: Vec<SampleSpeeds> = excerpts_from_hover(&hover, &config.samples, &mut warnings)
        .into_iter()
        .map(|span| SampleSpeeds { speeds: heard_by.speeds_in(Some(&span), span.length_s(), config), span })
        .filter(|sample| !sample.speeds.is_empty())
        .collect();
    warnings.extend(warnings_of_hover(&hover));
    warnings.extend(warnings_of_speed(&lines.ridges, &speeds));
    let is_of_all = speeds.first().is_some_and(|speed| speed.method == Method::Separated);
    let wants_rotors = config.wants_rotors();
    // where rotors were to be separated, another warning says it
    let stands_for_unknown = !config.rotors.is_count_known && one_line_count > 1;
    if !is_of_all && stands_for_unknown && (config.rotors.count == 1 || !wants_rotors) {
        warnings.push(Warning::RotorCountUnknown { spread_share: config.budget.rotor_spread_share });
    }
    warnings.extend(warning_of_samples(&samples, config.samples.length_s));
    let rotors = rotor_tracks.rotors(order, &config.budget);
    if is_of_all {
        // the result is the mean of all rotors: it follows neither the loudest nor any harmonic of all together
        warnings.retain(|warning| !matches!(warning, Warning::SeveralLines { .. } | Warning::HarmonicLeftOut { .. }));
    }
    warnings.extend(warning_of_rotors(
        &rotors,
        if speeds.iter().any(|speed| speed.method == Method::Separated) { rotor_tracks.in_mean() } else { 0 },
        if wants_rotors { config.rotors.count } else { 1 },
        !config.rotors.is_count_known,
        config.budget.rotor_spread_share,
    ));
    let are_all_apart = config.method == Method::Separated && rotors.len() == config.rotors.count as usize;
    let track = match tracks.into_iter().find(|track| track.method == config.method) {
        Some(track) => track.points,
        None if are_all_apart => mean_track(&rotors, rotor_tracks.step_s()),
        None => lines.harmonic.points_in(None, order),
    };
    warnings.extend(warning_of_parts(&hover, &track, config.hover.manoeuvre_share_min));
    let alternatives = as_heard(alternatives, speeds.first());
    let Lines { bands, ridges, .. } = lines;
    let condition = None;
    let tone = RotorTone { bands, window_s, speeds, track, rotors, condition, samples, ridges, alternatives, weighed };
    Ok(SpeedAnalysis { heard, hover, outcome: Outcome::Ok(tone), warnings })
}

/// The readings at the speed that was heard for the first of them: the evidence knows it by wide frames and of the loudest rotor only. They are
/// readings of the same lines, so that one ratio holds for all.
fn as_heard(readings: Vec<Reading>, heard: Option<&SpeedEstimate>) -> Vec<Reading> {
    let ratio = readings.first().zip(heard).map(|(first, heard)| heard.speed.rad_s() / first.speed.rad_s());
    let Some(ratio) = ratio else { return readings };
    readings.iter().map(|reading| at_ratio(reading, ratio)).collect()
}

/// One hover as each method analyses it.
struct HeardBy<'a> {
    weights: &'a HarmonicWeights<'a>,
    tracks: &'a [Track],
    lines: &'a Lines,
    rotor_tracks: &'a RotorTracks,
    /// Rotors for which one line may stand.
    one_line_count: u32,
}

impl HeardBy<'_> {
    /// The speed in a span of length `length_s`, or in the whole hover without a span: one estimate for each wanted method that has one.
    fn speeds_in(&self, span: Option<&Span>, length_s: f64, config: &Config) -> Vec<SpeedEstimate> {
        let order = config.tone.order;
        let loudest_share = config.budget.loudest_rotor_share(self.one_line_count);
        config
            .methods()
            .filter_map(|method| match self.tracks.iter().find(|track| track.method == method) {
                Some(track) => Some((self.weights.speed_in(span, track)?, loudest_share)),
                None if method == Method::Separated => self.rotor_tracks.speed_in(span, order),
                None => Some((self.lines.harmonic.speed_in(span, order)?, loudest_share)),
            })
            .map(|(speed, rotors_std_share)| with_budget(speed, &config.budget, rotors_std_share, length_s))
            .collect()
    }
}
