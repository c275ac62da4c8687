//! Rotors named with a log of the same flight.
//!
//! ```text
//! tracks of rotors ─────────┐                                ┌─ motors      commands or speeds of each motor
//!                           ├─ rows at each offset (rows) ───┤                                                ─▶ evidence of
//! log on its own clock ─────┘                                └─ body_rates  the torques of the rotors turn        each assignment
//!                                                                           the body                                 │
//! labels, their probability, the offset of the clocks ◀── posterior over all assignments and offsets ◀───────────────┘
//! ```

mod body_rates;
mod evidence;
mod log;
mod motors;
mod rows;
mod whitening;

pub use log::{FlightLog, LogError, LogSignals, MotorSignal};

use crate::posterior::{Posterior, assignments};
use crate::settings::LabelsConfig;
use crate::speed_curve::SpeedCurve;
use body_rates::BodyRates;
use evidence::Evidence;
use hovertone_analysis::{LABELLED_ROTORS_MAX, LabelSource, NotTold, RotorLabels, Span, TrackPoint};
use motors::Motors;
use rows::LogRows;

/// Which rotor each track is, from a log of the same flight: `rotor_count` rotors turn, of which `tracks` have been told apart.
///
/// Every assignment of tracks to rotors is weighed at every offset of the log's clock against the recording's, by its likelihood
/// ratio to "this log has nothing to do with these tracks" (a prior probability of one half):
///
/// - *Motors*: `n_i − ⟨n⟩ = a_i + b (m_j − ⟨m⟩) + noise`, with `m_j` the command or speed of the motor behind a lag, one positive
///   gain b for all, and a constant a_i of each track: what counts is how speeds change against each other. Measured speeds are also
///   compared by their means.
/// - *Body rates*: `Ω_axis(t) = g Σ_i s_i,axis ∫ω_i² dt + a + b t + noise`, with `s` the lever of the rotor that track i is taken for
///   (y for roll, −x for pitch, its sense of turning for yaw), and an unknown positive gain g for each axis, so that no inertia is
///   needed; that of yaw may have either sign. Every rotor must be told apart.
///
/// The noise is white on top of a random walk, in a ratio that is integrated over. The clocks run equally fast.
///
/// The answer is "not told" where nothing stands out, per rotor and altogether. Measured limits: docs/rotors.md.
pub fn labels_from_log(
    tracks: &[&[TrackPoint]],
    rotor_count: usize,
    log: &FlightLog,
    config: &LabelsConfig,
) -> RotorLabels {
    let source = log.source();
    let not_told = |reason| RotorLabels::not_told(source, tracks.len(), reason);
    let names = log.names();
    if names.len() != rotor_count {
        return not_told(NotTold::OtherCount { rotors: rotor_count, of_log: names.len() });
    }
    if rotor_count > LABELLED_ROTORS_MAX {
        return not_told(NotTold::TooManyRotors { rotors: rotor_count });
    }
    let needed = if source == LabelSource::BodyRates { rotor_count } else { 2 };
    if tracks.len() < needed || tracks.len() > rotor_count {
        return not_told(NotTold::TooFewTracks { tracks: tracks.len(), needed });
    }
    let curves: Vec<SpeedCurve> = tracks.iter().map(|track| SpeedCurve::through(track)).collect();
    let rows = LogRows::of(log, config.row_s);
    let Some(hover) = SpeedCurve::span_of_all(&curves) else { return not_told(NotTold::NoOverlap) };
    let offsets = match offsets_s(&rows, hover, config) {
        Ok(offsets) => offsets,
        Err(reason) => return not_told(reason),
    };
    let assignments = assignments(tracks.len(), rotor_count);
    let evidence: Box<dyn Evidence> = match &log.signals {
        LogSignals::Motors { signal, .. } => Box::new(Motors::new(&rows, *signal, config)),
        LogSignals::BodyRates { places, .. } => Box::new(BodyRates::new(&rows, places)),
    };
    let mut posterior = Posterior::new(&assignments, offsets.len());
    for &offset_s in &offsets {
        let heard = rows.heard_at(offset_s, &curves, hover);
        let is_enough = heard.len() >= config.rows_min;
        let believed = || {
            let ratios = evidence.log_ratios(&heard, &assignments);
            // numbers that overflow say nothing
            ratios
                .into_iter()
                .map(|ratio| if ratio.is_finite() { config.evidence_share * ratio } else { 0.0 })
                .collect()
        };
        posterior.add(offset_s, is_enough.then(believed));
    }
    posterior.labels(source, &names, config)
}

/// The offsets to try.
fn offsets_s(rows: &LogRows, hover: Span, config: &LabelsConfig) -> Result<Vec<f64>, NotTold> {
    let Some(log) = rows.span().filter(|log| log.length_s() > 0.0) else { return Err(NotTold::NoOverlap) };
    let shared_s = config.overlap_share_min * log.length_s().min(hover.length_s());
    let low_s = config.offset_s_low.unwrap_or(hover.from_s + shared_s - log.to_s);
    let high_s = config.offset_s_high.unwrap_or(hover.to_s - shared_s - log.from_s).max(low_s);
    let count = ((high_s - low_s) / config.offset_step_s).ceil() as usize + 1;
    let rows_per_s = rows.len() as f64 / log.length_s();
    let rows_compared = (rows_per_s * hover.length_s().min(log.length_s())) as usize + 1;
    if count.saturating_mul(rows_compared) > config.comparisons_max {
        return Err(NotTold::TooManyOffsets { low_s, high_s });
    }
    let middle_s = (low_s + high_s) / 2.0;
    // about the middle, so that a log on the recording's own clock has its offset 0 among them
    Ok((0..count).map(|index| middle_s + config.offset_step_s * (index as f64 - (count - 1) as f64 / 2.0)).collect())
}
