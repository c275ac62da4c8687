//! All assignments of tracks to rotors, and what remains plausible of them.

use crate::settings::LabelsConfig;
use hovertone_analysis::{LabelSource, NotTold, RotorLabel, RotorLabels};
use hovertone_signal::statistics::log_sum_exp;

/// Below this probability the log is taken for that of another flight.
const RELATED_MIN: f64 = 0.5;
/// An offset within so many steps of a limit may lie beyond it.
const LIMIT_STEPS: f64 = 2.0;

/// `assignments[which][track]` is a rotor; no two tracks have the same.
pub(crate) fn assignments(tracks: usize, rotors: usize) -> Vec<Vec<usize>> {
    (0..tracks).fold(vec![Vec::new()], |shorter, _| {
        let longer = |taken: &Vec<usize>| -> Vec<Vec<usize>> {
            let free = (0..rotors).filter(|rotor| !taken.contains(rotor));
            free.map(|rotor| [taken.as_slice(), &[rotor]].concat()).collect()
        };
        shorter.iter().flat_map(longer).collect()
    })
}

/// Probabilities of assignments and offsets, as evidence comes in offset by offset.
pub(crate) struct Posterior<'a> {
    assignments: &'a [Vec<usize>],
    offset_count: usize,
    /// Of each assignment, over the offsets: Σ exp(ratio − peak).
    sums: Vec<f64>,
    peak: f64,
    /// Each offset that was tried with enough rows, and ln Σ over assignments.
    offsets: Vec<(f64, f64)>,
    limits_s: (f64, f64),
}

impl<'a> Posterior<'a> {
    pub(crate) fn new(assignments: &'a [Vec<usize>], offset_count: usize) -> Self {
        Self {
            assignments,
            offset_count,
            sums: vec![0.0; assignments.len()],
            peak: f64::NEG_INFINITY,
            offsets: Vec::new(),
            limits_s: (f64::INFINITY, f64::NEG_INFINITY),
        }
    }

    /// Takes in what is known at an offset: the logarithms of the assignments' likelihood ratios, where there are rows enough.
    pub(crate) fn add(&mut self, offset_s: f64, log_ratios: Option<Vec<f64>>) {
        self.limits_s = (self.limits_s.0.min(offset_s), self.limits_s.1.max(offset_s));
        let Some(log_ratios) = log_ratios else { return };
        let highest = log_ratios.iter().copied().fold(f64::NEG_INFINITY, f64::max);
        if highest > self.peak {
            let scale = (self.peak - highest).exp();
            self.sums.iter_mut().for_each(|sum| *sum *= scale);
            self.peak = highest;
        }
        for (sum, ratio) in self.sums.iter_mut().zip(&log_ratios) {
            *sum += (ratio - self.peak).exp();
        }
        self.offsets.push((offset_s, log_sum_exp(log_ratios.iter().copied())));
    }

    pub(crate) fn labels(&self, source: LabelSource, names: &[String], config: &LabelsConfig) -> RotorLabels {
        let tracks = self.assignments.first().map_or(0, Vec::len);
        if self.offsets.is_empty() {
            return RotorLabels::not_told(source, tracks, NotTold::NoOverlap);
        }
        // "nothing in common" is as probable, before anything is known, as all assignments at all offsets together
        let total: f64 = self.sums.iter().sum();
        let log_related = self.peak + total.ln() - ((self.assignments.len() * self.offset_count) as f64).ln();
        let related = 1.0 / (1.0 + (-log_related).exp());
        if related < RELATED_MIN {
            let reason = NotTold::NothingInCommon { probability: related };
            return RotorLabels { probability: Some(related), ..RotorLabels::not_told(source, tracks, reason) };
        }
        let highest = self.offsets.iter().map(|(_, log)| *log).fold(f64::NEG_INFINITY, f64::max);
        let weighed: Vec<(f64, f64)> = self.offsets.iter().map(|&(at_s, log)| (at_s, (log - highest).exp())).collect();
        let weights: f64 = weighed.iter().map(|(_, weight)| weight).sum();
        let offset_s = weighed.iter().map(|(at_s, weight)| at_s * weight).sum::<f64>() / weights;
        let variance = weighed.iter().map(|(at_s, weight)| weight * (at_s - offset_s).powi(2)).sum::<f64>() / weights;
        // within a step of the offset any place is as good
        let delay_std_s = if source == LabelSource::MotorCommands { config.command_delay_std_s } else { 0.0 };
        let offset_std_s = (variance + config.offset_step_s.powi(2) / 12.0).sqrt().hypot(delay_std_s);
        let edge_s = LIMIT_STEPS * config.offset_step_s;
        let best_s = self.offsets.iter().max_by(|a, b| a.1.total_cmp(&b.1)).map_or(offset_s, |best| best.0);
        let is_range = self.limits_s.1 - self.limits_s.0 > 2.0 * edge_s;
        if is_range && (best_s - self.limits_s.0 < edge_s || self.limits_s.1 - best_s < edge_s) {
            let reason = NotTold::OffsetAtLimit { offset_s: best_s };
            return RotorLabels::not_told(source, tracks, reason);
        }
        let shares: Vec<f64> = self.sums.iter().map(|sum| related * sum / total).collect();
        let rotors: Vec<Option<RotorLabel>> =
            (0..tracks).map(|track| self.label_of(track, &shares, names, config.probability_min)).collect();
        let open = rotors.iter().filter(|label| label.is_none()).count();
        RotorLabels {
            source,
            offset_s: Some(offset_s),
            offset_std_s: Some(offset_std_s),
            probability: Some(shares.iter().copied().fold(0.0, f64::max)),
            rotors,
            not_told: (open > 0).then_some(NotTold::SeveralFit { tracks: open }),
        }
    }

    /// The rotor that a track is in nearly all that is plausible.
    fn label_of(&self, track: usize, shares: &[f64], names: &[String], probability_min: f64) -> Option<RotorLabel> {
        let mut of_rotor = vec![0.0; names.len()];
        for (assignment, share) in self.assignments.iter().zip(shares) {
            of_rotor[assignment[track]] += share;
        }
        let (rotor, probability) = of_rotor.into_iter().enumerate().max_by(|a, b| a.1.total_cmp(&b.1))?;
        (probability >= probability_min).then(|| RotorLabel {
            number: rotor + 1,
            name: names[rotor].clone(),
            probability: probability.min(1.0),
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn assignments_are_all_there_once() {
        for (tracks, rotors, count) in [(4, 4, 24), (3, 4, 24), (2, 4, 12), (6, 6, 720)] {
            let all = assignments(tracks, rotors);
            let distinct: std::collections::BTreeSet<_> = all.iter().collect();
            assert_eq!((all.len(), distinct.len()), (count, count));
            assert!(all.iter().all(|rotors| rotors.len() == tracks));
        }
    }

    #[test]
    fn what_two_assignments_share_is_told_and_what_they_do_not_is_not() {
        let all = assignments(3, 3);
        let names = ["a", "b", "c"].map(str::to_owned);
        let config = LabelsConfig { offset_step_s: 0.1, ..LabelsConfig::default() };
        let mut posterior = Posterior::new(&all, 11);
        for step in 0..11 {
            // tracks 1 and 2 can change places; the right offset is 0.5
            let fits = |rotors: &Vec<usize>| if step == 5 && rotors[0] == 2 { 30.0 } else { 0.0 };
            posterior.add(0.1 * f64::from(step), Some(all.iter().map(fits).collect()));
        }
        let labels = posterior.labels(LabelSource::BodyRates, &names, &config);
        assert_eq!(labels.rotors[0].as_ref().map(|label| (label.number, label.name.as_str())), Some((3, "c")));
        assert_eq!((&labels.rotors[1], &labels.rotors[2]), (&None, &None));
        assert_eq!(labels.not_told, Some(NotTold::SeveralFit { tracks: 2 }));
        assert!((labels.offset_s.unwrap() - 0.5).abs() < 1e-9);
        // known to within its step
        assert!((labels.offset_std_s.unwrap() - 0.1 / 12f64.sqrt()).abs() < 1e-6);
        assert!((labels.probability.unwrap() - 0.5).abs() < 1e-6);
    }
}
