//! Trials that look as if they belong to another load, and loads whose masses look exchanged.

use crate::campaign::{Campaign, EQUAL_FORCES_SHARE, HeardLoad};
use crate::square_law::{ForcePoint, PointNoise, is_off_by_a_factor};
use crate::statistics::median;
use crate::warning::ThrustWarning;
use crate::warning_words::first_names;
use crate::weighing::ALIKE_SHARE_MAX;
use hovertone_vehicle::{COVERAGE_FACTOR, RotorSpeed};

/// Fewest trials of a load among which one can be called far from the others. *Decision.*
const TRIALS_MIN: usize = 4;
/// A trial is far from the others if its thrust differs by this many of their scaled median deviations … *Decision.*
const FAR_DEVIATIONS: f64 = 5.0;
/// … and by this share: trials in moving air differ by no more. *Decision.*
const FAR_SHARE: f64 = 2.0 * ALIKE_SHARE_MAX;
/// Gaps between groups are wider than those within by this factor. *Decision.*
const INNER_GAPS: f64 = 3.0;
/// The constants of two loads are far apart if they differ by this share: flights in moving air differ by 3 %, and the laws of real vehicles
/// change a constant by up to 5 % over a usual range of loads. *Decision.*
const DIFFERENT_SHARE: f64 = 0.1;
/// Standard deviation of a normal distribution over its median absolute deviation. *Numeric.*
const STD_PER_MEDIAN_DEVIATION: f64 = 1.4826;

/// A trial and the thrust that it needs.
struct TrialSquare<'a> {
    recording: &'a str,
    /// ω².
    square: f64,
}

/// Warnings about trials and loads of which some may be filed under a wrong mass.
pub(crate) fn misfiled(campaign: &Campaign<'_>) -> Vec<ThrustWarning> {
    let mut warnings: Vec<ThrustWarning> =
        campaign.loads.iter().flat_map(|load| far_trials(load, &squares_of(load))).collect();
    warnings.extend(exchanged_loads(campaign));
    warnings.extend(different_constants(campaign));
    warnings
}

/// The trials of a load that are not left out.
fn squares_of<'a>(load: &HeardLoad<'a>) -> Vec<TrialSquare<'a>> {
    let trials = load.recordings.iter().zip(&load.trials_rad_s);
    trials.map(|(recording, speed_rad_s)| TrialSquare { recording, square: speed_rad_s.powi(2) }).collect()
}

/// Trials that need another thrust than the others. Of few trials nothing shows which one is wrong: both ends are named.
fn far_trials(load: &HeardLoad<'_>, trials: &[TrialSquare<'_>]) -> Vec<ThrustWarning> {
    let name = || load.load.name.clone();
    if trials.len() < TRIALS_MIN {
        let least = trials.iter().min_by(|a, b| a.square.total_cmp(&b.square));
        let most = trials.iter().max_by(|a, b| a.square.total_cmp(&b.square));
        let differ = least.zip(most).and_then(|(least, most)| {
            let thrust_share = most.square / least.square - 1.0;
            let [least, most] = [least, most].map(|trial| trial.recording.to_owned());
            (thrust_share > FAR_SHARE).then(|| ThrustWarning::TrialsDiffer { load: name(), least, most, thrust_share })
        });
        return differ.into_iter().collect();
    }
    let Some(middle) = median(&trials.iter().map(|trial| trial.square).collect::<Vec<_>>()) else { return Vec::new() };
    let share = |trial: &TrialSquare<'_>| trial.square / middle - 1.0;
    let deviations: Vec<f64> = trials.iter().map(|trial| share(trial).abs()).collect();
    let std_share = STD_PER_MEDIAN_DEVIATION * median(&deviations).unwrap_or_default();
    let is_far = |trial: &&TrialSquare<'_>| share(trial).abs() > FAR_SHARE.max(FAR_DEVIATIONS * std_share);
    let warning = |trial: &TrialSquare<'_>| ThrustWarning::TrialFarFromOthers {
        load: name(),
        recording: trial.recording.to_owned(),
        thrust_share: share(trial),
    };
    let far: Vec<ThrustWarning> = trials.iter().filter(is_far).map(warning).collect();
    if far.is_empty() { in_groups(name(), trials).into_iter().collect() } else { far }
}

/// Trials in groups of two and more, with gaps between the groups as flights of one mass do not have, and far wider than those within.
fn in_groups(load: String, trials: &[TrialSquare<'_>]) -> Option<ThrustWarning> {
    let mut speeds_rad_s: Vec<f64> = trials.iter().map(|trial| trial.square.sqrt()).collect();
    speeds_rad_s.sort_by(f64::total_cmp);
    let gap = |slow: &f64, fast: &f64| fast / slow - 1.0;
    let groups: Vec<&[f64]> = speeds_rad_s.chunk_by(|slow, fast| gap(slow, fast) <= ALIKE_SHARE_MAX).collect();
    let inner =
        groups.iter().flat_map(|group| group.windows(2)).map(|pair| gap(&pair[0], &pair[1])).fold(0.0, f64::max);
    let ends = groups.windows(2).filter_map(|pair| Some(gap(pair[0].last()?, pair[1].first()?)));
    let are_groups = groups.len() > 1 && groups.iter().all(|group| group.len() > 1);
    let are_apart = ends.fold(f64::INFINITY, f64::min) > INNER_GAPS * inner;
    let mean_rev_s = |group: &&[f64]| RotorSpeed::from_rad_s(group.iter().sum::<f64>() / group.len() as f64).rev_s();
    (are_groups && are_apart)
        .then(|| ThrustWarning::TrialsInGroups { load, groups_rev_s: groups.iter().map(mean_rev_s).collect() })
}

/// The two loads whose constants differ most, where each load has one recording, and the constants differ by more than flights do and the stated
/// uncertainties of the forces explain. Constants that are off by a factor are another warning.
fn different_constants(campaign: &Campaign<'_>) -> Option<ThrustWarning> {
    if campaign.loads.iter().any(|load| load.trials_rad_s.len() > 1) {
        return None;
    }
    let constant = |point: &ForcePoint| point.thrust_constant_n_s2();
    let force_std_share = |point: &ForcePoint| point.force_std_n / point.force_n;
    let differ = |least: &ForcePoint, most: &ForcePoint| {
        let share = constant(most) / constant(least) - 1.0;
        let stated_share = COVERAGE_FACTOR * force_std_share(most).hypot(force_std_share(least));
        let differ =
            share > DIFFERENT_SHARE.hypot(stated_share) && !is_off_by_a_factor(constant(most), constant(least));
        differ.then(|| {
            let (least, most) = (least.name.clone(), most.name.clone());
            (share, ThrustWarning::ConstantsDiffer { least, most, share, stated_share })
        })
    };
    let pairs = campaign.points.iter().flat_map(|least| campaign.points.iter().map(move |most| (least, most)));
    let differing = pairs.filter_map(|(least, most)| differ(least, most));
    differing.max_by(|a, b| a.0.total_cmp(&b.0)).map(|(_, warning)| warning)
}

/// The rows of two masses, of which the heavier turned slower by the largest share, more than hovers of one mass differ. `points` are hovers with
/// a weighed mass.
pub(crate) fn exchanged_rows(points: &[ForcePoint]) -> Option<ThrustWarning> {
    let mut sorted: Vec<&ForcePoint> = points.iter().collect();
    sorted.sort_by(|a, b| a.force_n.total_cmp(&b.force_n));
    let masses: Vec<&[&ForcePoint]> =
        sorted.chunk_by(|a, b| b.force_n <= a.force_n * (1.0 + EQUAL_FORCES_SHARE)).collect();
    let speed = |rows: &[&ForcePoint]| {
        median(&rows.iter().map(|row| row.speed_square_rad2_s2.sqrt()).collect::<Vec<_>>()).unwrap_or_default()
    };
    let names = |rows: &[&ForcePoint]| first_names(&rows.iter().map(|row| row.name.clone()).collect::<Vec<String>>());
    let mut slower: Option<(f64, ThrustWarning)> = None;
    for (at, heavy) in masses.iter().enumerate() {
        for light in &masses[..at] {
            let share = 1.0 - speed(heavy) / speed(light);
            if share > ALIKE_SHARE_MAX && slower.as_ref().is_none_or(|(most, _)| share > *most) {
                slower = Some((share, ThrustWarning::HeavierTurnedSlower { heavy: names(heavy), light: names(light) }));
            }
        }
    }
    slower.map(|(_, warning)| warning)
}

/// The pair of hovers whose heavier load turned slower by the largest share. Repeated trials show how much is chance; without them a
/// difference counts that trials of one load do not have.
fn exchanged_loads(campaign: &Campaign<'_>) -> Option<ThrustWarning> {
    let is_repeated = matches!(campaign.noise, PointNoise::Measured { .. });
    let hovers = || campaign.loads.iter().filter(|load| load.is_hover());
    let constant = |load: &HeardLoad<'_>| ForcePoint::thrust_constant_n_s2(&load.point());
    let slower = |light: &HeardLoad<'_>, heavy: &HeardLoad<'_>| {
        let chance = match is_repeated {
            true => COVERAGE_FACTOR * campaign.student_factor() * light.speed_std_share.hypot(heavy.speed_std_share),
            false => ALIKE_SHARE_MAX,
        };
        let share = 1.0 - heavy.speed_rad_s / light.speed_rad_s;
        let is_heavier = heavy.force_n > light.force_n * (1.0 + EQUAL_FORCES_SHARE);
        (is_heavier && share > chance && !is_off_by_a_factor(constant(heavy), constant(light))).then_some(share)
    };
    let pairs = hovers().flat_map(|light| hovers().map(move |heavy| (light, heavy)));
    let exchanged = pairs.filter_map(|(light, heavy)| Some((slower(light, heavy)?, light, heavy)));
    let (_, light, heavy) = exchanged.max_by(|a, b| a.0.total_cmp(&b.0))?;
    Some(ThrustWarning::HeavierTurnedSlower { heavy: heavy.load.name.clone(), light: light.load.name.clone() })
}
