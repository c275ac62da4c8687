//! The change of a rotor over all recordings.

use super::numbering::Numbering;
use super::pairs::{Pair, PairOfSpeeds, clock_std_share};
use super::tail::two_sided;
use super::{Archives, Change, RotorChange};
use crate::summary::{RotorSummary, Summary};

/// The weighted mean of the changes of all pairs from one rotor to the same or another one; `None` without a pair.
pub(super) fn change_of_pairs(pairs: &[Pair<'_>], earlier: usize, later: usize) -> Option<RotorChange> {
    let speeds: Vec<PairOfSpeeds> = pairs.iter().filter_map(|pair| pair.speeds(earlier, later)).collect();
    let change = change_of_speeds(&speeds)?;
    Some(RotorChange { rotor: earlier, earlier_count: speeds.len(), later_count: speeds.len(), change })
}

/// The same, where a rotor that has a rival in a recording is taken for it there; `None` where no recording has one.
pub(super) fn change_of_rivals(pairs: &[Pair<'_>], rotor: usize, rivals: &[Vec<Option<usize>>]) -> Option<Change> {
    let rivals: Vec<Option<usize>> = rivals.iter().map(|of| of.get(rotor - 1).copied().flatten()).collect();
    rivals.iter().any(Option::is_some).then_some(())?;
    let pairs = pairs.iter().zip(&rivals);
    let speeds: Vec<PairOfSpeeds> =
        pairs.filter_map(|(pair, rival)| pair.speeds(rotor, rival.unwrap_or(rotor))).collect();
    change_of_speeds(&speeds)
}

fn change_of_speeds(speeds: &[PairOfSpeeds]) -> Option<Change> {
    let clock = speeds.iter().map(|speeds| speeds.clock_std_share).reduce(f64::max)?;
    let observed: Vec<Observed> = speeds.iter().map(|speeds| Observed::of(*speeds)).collect();
    let pooled = pooled(&observed);
    let std_share = pooled.std.hypot(clock);
    // the part of the clock is known, the other has the freedom of a scatter (Welch–Satterthwaite)
    let freedom = pooled.degrees_of_freedom.map(|freedom| freedom * (std_share / pooled.std).powi(4));
    Some(tested(pooled.mean, std_share, freedom))
}

/// A change with the variance that is its own.
#[derive(Clone, Copy)]
struct Observed {
    value: f64,
    variance: f64,
}

impl Observed {
    fn of(speeds: PairOfSpeeds) -> Self {
        // the clock is the same in all recordings of an archive and does not average out; rounding must not make it more than the whole
        let own = speeds.std_share.powi(2) - speeds.clock_std_share.powi(2);
        Self { value: speeds.change_share(), variance: own.max(f64::MIN_POSITIVE) }
    }
}

/// A weighted mean with its standard uncertainty.
struct Pooled {
    mean: f64,
    std: f64,
    degrees_of_freedom: Option<f64>,
}

/// The mean with weights 1/(u² + τ²), where τ² is the scatter beyond the reported uncertainties u; its uncertainty comes from the scatter, and
/// is never less than the reported ones make it.
fn pooled(observed: &[Observed]) -> Pooled {
    let weights = |between: f64| observed.iter().map(|one| 1.0 / (one.variance + between)).collect::<Vec<f64>>();
    let fixed = weights(0.0);
    let (mean, sum) = weighted_mean(observed, &fixed);
    let freedom = observed.len() as f64 - 1.0;
    let squares: f64 = fixed.iter().map(|weight| weight * weight).sum();
    let excess = scatter(observed, &fixed, mean) - freedom;
    let between = if freedom > 0.0 { (excess / (sum - squares / sum)).max(0.0) } else { 0.0 };
    let weights = weights(between);
    let (mean, sum) = weighted_mean(observed, &weights);
    if freedom <= 0.0 {
        return Pooled { mean, std: sum.recip().sqrt(), degrees_of_freedom: None };
    }
    let ratio = (scatter(observed, &weights, mean) / freedom).max(1.0);
    Pooled { mean, std: (ratio / sum).sqrt(), degrees_of_freedom: Some(freedom) }
}

fn weighted_mean(observed: &[Observed], weights: &[f64]) -> (f64, f64) {
    let sum: f64 = weights.iter().sum();
    let weighted: f64 = observed.iter().zip(weights).map(|(one, weight)| weight * one.value).sum();
    (weighted / sum, sum)
}

fn scatter(observed: &[Observed], weights: &[f64], mean: f64) -> f64 {
    observed.iter().zip(weights).map(|(one, weight)| weight * (one.value - mean).powi(2)).sum()
}

/// The change of the mean of all recordings; `None` where one archive has fewer than two with this rotor.
pub(super) fn change_of_groups(
    archives: Archives<'_>,
    numbering: Numbering,
    earlier: usize,
    later: usize,
) -> Option<RotorChange> {
    let rotor = earlier;
    let earlier = Group::of(archives.earlier, numbering, earlier)?;
    let later = Group::of(archives.later, numbering, later)?;
    let (of_earlier, of_later) = (earlier.own_std_share().powi(2), later.own_std_share().powi(2));
    let own = of_earlier + of_later;
    let std_share = own.sqrt().hypot(earlier.clock_std_share).hypot(later.clock_std_share);
    let freedom = |share: f64, group: &Group| share.powi(2) / (group.count as f64 - 1.0);
    let degrees_of_freedom = std_share.powi(4) / (freedom(of_earlier, &earlier) + freedom(of_later, &later));
    let ratio = later.mean_rev_s / earlier.mean_rev_s;
    Some(RotorChange {
        rotor,
        earlier_count: earlier.count,
        later_count: later.count,
        change: tested(ratio - 1.0, ratio * std_share, Some(degrees_of_freedom)),
    })
}

/// One speed in all recordings of an archive.
struct Group {
    count: usize,
    mean_rev_s: f64,
    /// Standard deviation of one recording: of the scatter, and at least as reported.
    std_rev_s: f64,
    clock_std_share: f64,
}

impl Group {
    fn of(all: &[Summary], numbering: Numbering, rotor: usize) -> Option<Self> {
        let speed = |summary| Some((summary, numbering.speed_of(summary, rotor)?));
        let speeds: Vec<(&Summary, RotorSummary)> = all.iter().filter_map(speed).collect();
        let count = speeds.len();
        if count < 2 {
            return None;
        }
        let mean_rev_s = speeds.iter().map(|(_, speed)| speed.speed_rev_s).sum::<f64>() / count as f64;
        let squares: f64 = speeds.iter().map(|(_, speed)| (speed.speed_rev_s - mean_rev_s).powi(2)).sum();
        let reported = |(summary, speed): &(&Summary, RotorSummary)| {
            speed.std_rev_s.unwrap_or(0.0).powi(2) - (clock_std_share(summary) * speed.speed_rev_s).powi(2)
        };
        let reported = speeds.iter().map(reported).sum::<f64>() / count as f64;
        Some(Self {
            count,
            mean_rev_s,
            std_rev_s: (squares / (count as f64 - 1.0)).max(reported).sqrt(),
            clock_std_share: speeds.iter().map(|(summary, _)| clock_std_share(summary)).fold(0.0, f64::max),
        })
    }

    fn own_std_share(&self) -> f64 {
        self.std_rev_s / (self.count as f64).sqrt() / self.mean_rev_s
    }
}

/// A change with its test by this uncertainty.
pub(super) fn tested(change_share: f64, std_share: f64, degrees_of_freedom: Option<f64>) -> Change {
    Change {
        change_share,
        std_uncertainty_share: std_share,
        degrees_of_freedom,
        p_value: two_sided(change_share / std_share, degrees_of_freedom),
        p_value_holm: 1.0,
        is_rotor_known: true,
        has_changed: false,
    }
}
