//! Posterior probability of every assignment of tracks to rotors, and the labels that follow.
//!
//! Two hypotheses have a prior probability of one half each: "unrelated" (the log, or the array, has no relation to the tracks), and
//! "related". Under "related" all N pairs of an assignment and an offset are equally probable. With the likelihood ratio `L` of a pair
//! to "unrelated" and its sum over all pairs `Σ L`, the posterior probability of "related" is `R / (1 + R)`, `R = Σ L / N`. That of an
//! assignment is its part of `Σ L`, summed over the offsets, times the probability of "related".

use crate::settings::LabelsConfig;
use hovertone_analysis::{LabelSource, NotTold, RotorLabel, RotorLabels};
use hovertone_signal::statistics::log_sum_exp;

/// Fewest tracks that are compared: differences between rotors need two. *Numeric.*
pub(crate) const TRACKS_MIN: usize = 2;
/// Smallest posterior probability of "related" at which labels are given: the more probable hypothesis is taken. *Decision.*
const RELATED_MIN: f64 = 0.5;
/// Distance between the best offset and a limit of the search, in steps, below which a better offset may lie beyond the limit. *Decision.*
const LIMIT_STEPS: f64 = 2.0;

/// All assignments of `tracks` tracks to `rotors` rotors: `assignments[which][track]` is a rotor, and no two tracks have the same rotor.
pub(crate) fn assignments(tracks: usize, rotors: usize) -> Vec<Vec<usize>> {
    (0..tracks).fold(vec![Vec::new()], |shorter, _| {
        let longer = |taken: &Vec<usize>| -> Vec<Vec<usize>> {
            let free = (0..rotors).filter(|rotor| !taken.contains(rotor));
            free.map(|rotor| [taken.as_slice(), &[rotor]].concat()).collect()
        };
        shorter.iter().flat_map(longer).collect()
    })
}

/// The posterior over assignments and offsets, summed up offset by offset.
pub(crate) struct Posterior<'a> {
    assignments: &'a [Vec<usize>],
    offset_count: usize,
    /// Of each assignment, over the offsets: `Σ L`, divided by `exp(ln_peak)`.
    sums: Vec<f64>,
    /// Largest `ln L`.
    ln_peak: f64,
    /// The offsets with enough rows.
    offsets: Vec<WeighedOffset>,
    offset_s_min: f64,
    offset_s_max: f64,
}

/// An offset of the clocks and its weight.
#[derive(Clone, Copy)]
struct WeighedOffset {
    offset_s: f64,
    /// `ln Σ L` over the assignments.
    ln_weight: f64,
}

/// Posterior of the offset.
struct OffsetEstimate {
    mean_s: f64,
    std_s: f64,
    most_probable_s: f64,
}

impl<'a> Posterior<'a> {
    pub(crate) fn new(assignments: &'a [Vec<usize>], offset_count: usize) -> Self {
        Self {
            assignments,
            offset_count,
            sums: vec![0.0; assignments.len()],
            ln_peak: f64::NEG_INFINITY,
            offsets: Vec::new(),
            offset_s_min: f64::INFINITY,
            offset_s_max: f64::NEG_INFINITY,
        }
    }

    /// Adds one offset: `ln L` of each assignment; `None` if too few rows overlap at this offset.
    pub(crate) fn add(&mut self, offset_s: f64, ln_ratios: Option<Vec<f64>>) {
        (self.offset_s_min, self.offset_s_max) = (self.offset_s_min.min(offset_s), self.offset_s_max.max(offset_s));
        let Some(ln_ratios) = ln_ratios else { return };
        let highest = ln_ratios.iter().copied().fold(f64::NEG_INFINITY, f64::max);
        if highest > self.ln_peak {
            let scale = (self.ln_peak - highest).exp();
            self.sums.iter_mut().for_each(|sum| *sum *= scale);
            self.ln_peak = highest;
        }
        for (sum, ln_ratio) in self.sums.iter_mut().zip(&ln_ratios) {
            *sum += (ln_ratio - self.ln_peak).exp();
        }
        self.offsets.push(WeighedOffset { offset_s, ln_weight: log_sum_exp(ln_ratios.iter().copied()) });
    }

    /// The labels: a track has one if one rotor has at least `probability_min` of the posterior, summed over all assignments.
    pub(crate) fn labels(&self, source: LabelSource, names: &[String], config: &LabelsConfig) -> RotorLabels {
        let tracks = self.assignments.first().map_or(0, Vec::len);
        if self.offsets.is_empty() {
            return RotorLabels::not_told(source, tracks, NotTold::NoOverlap);
        }
        let total: f64 = self.sums.iter().sum();
        let related = self.related_probability(total);
        if related < RELATED_MIN {
            let reason = NotTold::NothingInCommon { probability: related };
            return RotorLabels { probability: Some(related), ..RotorLabels::not_told(source, tracks, reason) };
        }
        let delay_std_s = if source == LabelSource::MotorCommands { config.command_delay_std_s } else { 0.0 };
        let offset = self.offset(config.offset_step_s, delay_std_s);
        if self.is_at_limit(offset.most_probable_s, config.offset_step_s) {
            let reason = NotTold::OffsetAtLimit { offset_s: offset.most_probable_s };
            return RotorLabels::not_told(source, tracks, reason);
        }
        let shares: Vec<f64> = self.sums.iter().map(|sum| related * sum / total).collect();
        let rotors: Vec<Option<RotorLabel>> =
            (0..tracks).map(|track| self.label_of(track, &shares, names, config.probability_min)).collect();
        let open = rotors.iter().filter(|label| label.is_none()).count();
        RotorLabels {
            source,
            offset_s: Some(offset.mean_s),
            offset_std_s: Some(offset.std_s),
            probability: Some(shares.iter().copied().fold(0.0, f64::max)),
            rotors,
            not_told: (open > 0).then_some(NotTold::SeveralFit { tracks: open }),
        }
    }

    /// Posterior probability of "related", from the sum of all scaled likelihood ratios.
    fn related_probability(&self, total: f64) -> f64 {
        let ln_ratio = self.ln_peak + total.ln() - ((self.assignments.len() * self.offset_count) as f64).ln();
        1.0 / (1.0 + (-ln_ratio).exp())
    }

    /// Mean, standard deviation and maximum of the offset's posterior. The step adds the variance of a uniform distribution, step² / 12.
    fn offset(&self, step_s: f64, delay_std_s: f64) -> OffsetEstimate {
        let highest = self.offsets.iter().map(|offset| offset.ln_weight).fold(f64::NEG_INFINITY, f64::max);
        let weights: Vec<f64> = self.offsets.iter().map(|offset| (offset.ln_weight - highest).exp()).collect();
        let weighed = || self.offsets.iter().map(|offset| offset.offset_s).zip(&weights);
        let total: f64 = weights.iter().sum();
        let mean_s = weighed().map(|(offset_s, weight)| offset_s * weight).sum::<f64>() / total;
        let variance = weighed().map(|(offset_s, weight)| weight * (offset_s - mean_s).powi(2)).sum::<f64>() / total;
        let std_s = (variance + step_s.powi(2) / 12.0).sqrt().hypot(delay_std_s);
        let best = self.offsets.iter().max_by(|a, b| a.ln_weight.total_cmp(&b.ln_weight));
        OffsetEstimate { mean_s, std_s, most_probable_s: best.map_or(mean_s, |best| best.offset_s) }
    }

    /// Is an offset so near a limit of the search that a better one may lie beyond it?
    fn is_at_limit(&self, offset_s: f64, step_s: f64) -> bool {
        let edge_s = LIMIT_STEPS * step_s;
        let is_search = self.offset_s_max - self.offset_s_min > 2.0 * edge_s;
        is_search && (offset_s - self.offset_s_min < edge_s || self.offset_s_max - offset_s < edge_s)
    }

    /// The most probable rotor of a track, if its probability reaches the limit.
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
    fn every_assignment_occurs_once() {
        for (tracks, rotors, count) in [(4, 4, 24), (3, 4, 24), (2, 4, 12), (6, 6, 720)] {
            let all = assignments(tracks, rotors);
            let distinct: std::collections::BTreeSet<_> = all.iter().collect();
            assert_eq!((all.len(), distinct.len()), (count, count));
            assert!(all.iter().all(|rotors| rotors.len() == tracks));
        }
    }

    #[test]
    fn a_track_is_labelled_if_all_probable_assignments_agree_on_its_rotor() {
        let all = assignments(3, 3);
        let names = ["a", "b", "c"].map(str::to_owned);
        let config = LabelsConfig { offset_step_s: 0.1, ..LabelsConfig::default() };
        let mut posterior = Posterior::new(&all, 11);
        for step in 0..11 {
            // tracks 1 and 2 can change places; the right offset is 0.5
            let ln_ratio = |rotors: &Vec<usize>| if step == 5 && rotors[0] == 2 { 30.0 } else { 0.0 };
            posterior.add(0.1 * f64::from(step), Some(all.iter().map(ln_ratio).collect()));
        }
        let labels = posterior.labels(LabelSource::BodyRates, &names, &config);
        assert_eq!(labels.rotors[0].as_ref().map(|label| (label.number, label.name.as_str())), Some((3, "c")));
        assert_eq!((&labels.rotors[1], &labels.rotors[2]), (&None, &None));
        assert_eq!(labels.not_told, Some(NotTold::SeveralFit { tracks: 2 }));
        assert!((labels.offset_s.unwrap() - 0.5).abs() < 1e-9);
        // one offset has all the weight: the uncertainty is that of the step
        assert!((labels.offset_std_s.unwrap() - 0.1 / 12f64.sqrt()).abs() < 1e-6);
        assert!((labels.probability.unwrap() - 0.5).abs() < 1e-6);
    }
}
