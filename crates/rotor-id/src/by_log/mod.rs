//! Labels from a log of the same flight.
//!
//! ```text
//! tracks of rotors ──────┐                                ┌─▶ motor_model      command or speed of each motor ──┐
//!                        ├─▶ log rows, at every offset ───┤                                                     ├─▶ likelihood ratio of
//! log on its own clock ──┘   of the clocks (log_rows)     └─▶ body_rate_model  torques of the rotors on the ────┘   each assignment
//!                                                                              body                                     │
//! labels, their probability, offset of the clocks ◀── posterior over all assignments and offsets ◀──────────────────────┘
//! ```
//!
//! Both models are linear regressions (`bayes_factor`) of series with drifting noise, which a filter makes white (`noise_model`). Series
//! that carry no information about single rotors are projected out first (`nuisance`).

mod agreement;
mod bayes_factor;
mod body_rate_model;
mod differences;
mod flight_log;
mod log_rows;
mod motor_model;
mod noise_model;
mod not_verified;
mod nuisance;
mod verification;

pub use not_verified::NotVerified;
pub use verification::{LoggedSpeeds, verification_of_heard};

pub use flight_log::{FlightLog, LogError, LogSignals, MotorSignal};

use crate::posterior::{Posterior, TRACKS_MIN, assignments};
use crate::settings::LabelsConfig;
use crate::speed_curve::SpeedCurve;
use body_rate_model::BodyRateModel;
use hovertone_analysis::{LABELLED_ROTORS_MAX, LabelSource, NotTold, RotorLabels, Span, TrackPoint};
use log_rows::{LogRows, MatchedRows};
use motor_model::MotorModel;

/// How a kind of log depends on the assignment of tracks to rotors.
trait AssignmentModel {
    /// Logarithm of the likelihood ratio of each assignment to "the log has no relation to the tracks", at one offset of the clocks.
    fn ln_likelihood_ratios(&self, rows: &MatchedRows, assignments: &[Vec<usize>]) -> Vec<f64>;
}

/// The labels of tracks, from a log of the same flight. `rotor_count` rotors turn; `tracks` holds a track of each separated rotor.
///
/// Every assignment of tracks to rotors is compared, at every offset of the log's clock, with the hypothesis "this log has no relation to
/// these tracks", which has a prior probability of one half. Both hypotheses are linear regressions:
///
/// - *Motors*: `n_i − ⟨n⟩ = a_i + b (m_j − ⟨m⟩) + noise`. n_i is the speed of track i, m_j the command or speed of motor j behind a
///   first-order lag, ⟨⟩ the mean over the rotors, b > 0 one gain for all motors, and a_i a constant of each track. So the changes of the
///   speeds relative to each other are compared. The mean values of measured speeds are compared as well.
/// - *Body rates*: `Ω_axis(t) = g Σ_i s_i,axis ∫ω_i² dt + a + b t + noise`. `s_i,axis` is the lever of the rotor assigned to track i (y
///   for roll, −x for pitch, minus the direction of rotation for yaw). The gain g of each axis is unknown, so no inertia is needed; it is
///   positive, but may have either sign for yaw. A track of every rotor is needed.
///
/// The noise is white plus a random walk of the value or of the slope; the ratio of the two is integrated out. Both clocks run equally fast.
///
/// A track without a label, or the reason why no track has one, is part of the result. Measured limits: docs/rotors.md.
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
    if tracks.len() > rotor_count {
        return not_told(NotTold::OtherCount { rotors: tracks.len(), of_log: names.len() });
    }
    let needed = if source == LabelSource::BodyRates { rotor_count } else { TRACKS_MIN };
    if tracks.len() < needed {
        return not_told(NotTold::TooFewTracks { tracks: tracks.len(), needed });
    }
    let curves: Vec<SpeedCurve> = tracks.iter().map(|track| SpeedCurve::through(track)).collect();
    let rows = LogRows::from_log(log, config.row_s);
    let Some(hover) = SpeedCurve::span_of_all(&curves) else { return not_told(NotTold::NoOverlap) };
    let offsets = match offsets_s(&rows, hover, config) {
        Ok(offsets) => offsets,
        Err(reason) => return not_told(reason),
    };
    let assignments = assignments(tracks.len(), rotor_count);
    let model: Box<dyn AssignmentModel> = match log.signals() {
        LogSignals::Motors { signal, .. } => Box::new(MotorModel::new(&rows, *signal, config)),
        LogSignals::BodyRates { places, .. } => Box::new(BodyRateModel::new(&rows, places)),
    };
    let mut posterior = Posterior::new(&assignments, offsets.len());
    for &offset_s in &offsets {
        let matched = rows.matched_at(offset_s, &curves, hover);
        let is_enough = matched.len() >= config.rows_min;
        let tempered = || {
            let ln_ratios = model.ln_likelihood_ratios(&matched, &assignments);
            // a ratio that overflowed carries no information
            ln_ratios
                .into_iter()
                .map(|ratio| if ratio.is_finite() { config.evidence_share * ratio } else { 0.0 })
                .collect()
        };
        posterior.add(offset_s, is_enough.then(tempered));
    }
    let labels = posterior.labels(source, &names, config);
    // a log of body rates has no motors
    let not_told = labels.not_told.map(|reason| match reason {
        NotTold::SeveralFit { tracks } if source == LabelSource::BodyRates => NotTold::SeveralFitRates { tracks },
        other => other,
    });
    RotorLabels { not_told, ..labels }
}

/// The offsets to try, in steps about the middle of the limits: a log on the recording's own clock has its offset 0 among them.
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
    Ok((0..count).map(|index| middle_s + config.offset_step_s * (index as f64 - (count - 1) as f64 / 2.0)).collect())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_log_of_fewer_motors_than_rotors_are_heard_is_of_another_vehicle() {
        let names = vec!["motor 1".to_owned(), "motor 2".to_owned()];
        let signals = LogSignals::Motors { signal: MotorSignal::Speed, names, values: vec![vec![400.0; 3]; 2] };
        let log = FlightLog::new(vec![0.0, 0.1, 0.2], signals).unwrap();
        let track: &[TrackPoint] = &[];
        let reason = |tracks: &[&[TrackPoint]]| labels_from_log(tracks, 2, &log, &LabelsConfig::default()).not_told;
        assert_eq!(reason(&[track; 3]), Some(NotTold::OtherCount { rotors: 3, of_log: 2 }));
        assert_eq!(reason(&[track; 1]), Some(NotTold::TooFewTracks { tracks: 1, needed: 2 }));
    }
}
