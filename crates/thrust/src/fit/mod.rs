//! From the speeds of all trials to the thrust constant: the fit and its budget, and the paper's averages beside them.

#[cfg(test)]
mod campaign_tests;
#[cfg(test)]
mod misfiled_tests;
#[cfg(test)]
mod outline_tests;
mod row_misfits;
#[cfg(test)]
mod suspicious_tests;
#[cfg(test)]
mod tests;

use crate::air::{ThrustCoefficients, figure_of_merit, is_plausible_merit, thrust_constant_n_s2};
use crate::budget::{UncertaintyBudget, budget_of_fit};
use crate::campaign::{Campaign, GrossTrial, HeardLoad, trial_bootstrap, whole_vehicle_factor};
use crate::drift::drifts;
use crate::force::Force;
use crate::misfiled::{exchanged_rows, misfiled};
use crate::outline::{LoadOutline, too_alike, warnings_of_masses, warnings_of_recordings};
use crate::settings::ThrustSettings;
use crate::speeds::{LoadSpeeds, TrialSpeeds};
use crate::square_law::{ForceLaw, ForcePoint, PointVerdict, SquareLawFit, are_split, square_law_fit};
use crate::statistics::{mean, std, student_factor};
use crate::table::{LoadThrust, SampleThrust, ThrustTable, TrialThrust};
use crate::warning::ThrustWarning;
use hovertone_analysis::{Method, RotorsHeardCounts};
use hovertone_vehicle::AIR_KG_M3;
use hovertone_vehicle::{Ending, Estimate, RotorSpeed};
use row_misfits::warnings_of_misfits;

/// A law that is so many times as probable as another is clearly preferred to it. *Decision.*
const PREFERRED_FACTOR: f64 = 3.0;

/// The thrust constant from loads.
///
/// The result is the constant of the square law through all loads, with the uncertainties of forces and speeds (York et al. 2004).
/// Speeds are means over trials; their uncertainty is the scatter of the trials about the means of their loads, pooled over the
/// loads. The error of the weighing of the vehicle is common to all loads and does not average out. Where loads disagree, their
/// scatter enlarges the uncertainty. The stated standard uncertainty is the combined one of the budget: weighing, speeds, and the assumed
/// limits of other effects, of which the largest is that a single ridge follows the loudest rotor.
///
/// The averages of the paper's tables stand beside it: for each load from the mean speed of all its samples (C = F / ω̄², not the
/// mean over the constants of the samples), for all loads the plain mean. The squared mean in place of the mean square makes C too
/// large by the square of the relative spread: 0.015 % at the spread of 1.23 % in the paper.
pub fn thrust_from_loads(loads: &[LoadSpeeds], method: Method, settings: &ThrustSettings) -> ThrustTable {
    let rotor_count = settings.rotor_count.max(1);
    let campaign = Campaign::of(loads, rotor_count);
    let fit = square_law_fit(&campaign.points, campaign.noise).ok();
    let budget = fit.as_ref().map(|fit| budget_of_fit(&campaign, fit, settings));
    let rows = rows(loads, &campaign, fit.as_ref(), settings);
    let plain = mean_over_loads(&campaign, &rows);
    let trials: usize = campaign.loads.iter().map(|load| load.trials_rad_s.len()).sum();
    let total = fit.as_ref().zip(budget.as_ref()).map(|(fit, budget)| answer(fit, budget, trials)).or(plain);
    let per_rotor = total.map(|total| total.scaled(1.0 / f64::from(rotor_count)));
    let propeller = per_rotor.zip(settings.propeller_diameter_m);
    let in_air = |density_kg_m3: f64| {
        propeller.map(|(of_rotor, diameter_m)| ThrustCoefficients::of_rotor(of_rotor.value, diameter_m, density_kg_m3))
    };
    let coefficients = settings.air_density_kg_m3.and_then(in_air);
    let drifts = drifts(&campaign);
    let mut warnings = warnings_of(&campaign, loads, &rows, fit.as_ref());
    warnings.extend(drifts.iter().copied().map(ThrustWarning::ConstantDrifts));
    // the air of any place is near enough to tell what no propeller has
    warnings.extend(
        coefficients
            .or(in_air(AIR_KG_M3))
            .filter(|coefficients| !coefficients.is_plausible)
            .map(|coefficients| ThrustWarning::ImplausibleThrustCoefficient { propeller: coefficients.propeller }),
    );
    warnings.extend(total.and_then(|total| ThrustWarning::of_uncertainty(total, false)));
    warnings.extend(implausible_merits(&rows));
    warnings.extend(warnings_of_masses(&outlines_of(loads, &campaign), settings));
    if settings.follows_loudest && loads.iter().any(|load| load.rotors_running > 1) && total.is_some() {
        warnings.push(ThrustWarning::LoudestRotor);
    }
    ThrustTable {
        method,
        rotors_heard: rotors_heard_of(&campaign, fit.as_ref()),
        rotor_count,
        bootstrap: fit.as_ref().and_then(|fit| trial_bootstrap(&campaign, fit)),
        loads: rows,
        thrust_constant_total_n_s2: total,
        thrust_constant_per_rotor_n_s2: per_rotor,
        measured_std_total_n_s2: budget.as_ref().map(UncertaintyBudget::measured_std_n_s2).filter(|std| *std > 0.0),
        plain_mean_total_n_s2: plain,
        coefficients,
        fit,
        budget,
        drifts,
        warnings,
    }
}

/// How the rotors are heard in the recordings that the constant comes from.
fn rotors_heard_of(campaign: &Campaign<'_>, fit: Option<&SquareLawFit>) -> RotorsHeardCounts {
    let is_left_out = |place: usize| fit.and_then(|fit| fit.points.get(place)).is_some_and(|point| point.is_gross);
    let used = campaign.loads.iter().enumerate().filter(|(place, _)| !is_left_out(*place));
    used.flat_map(|(_, load)| load.rotors_heard.iter().copied()).collect()
}

fn implausible_merits(rows: &[LoadThrust]) -> Vec<ThrustWarning> {
    let of = |row: &LoadThrust| {
        let figure_of_merit = row.figure_of_merit.filter(|merit| !is_plausible_merit(*merit))?;
        Some(ThrustWarning::ImplausibleFigureOfMerit { name: row.name.clone(), figure_of_merit })
    };
    rows.iter().filter_map(of).collect()
}

fn answer(fit: &SquareLawFit, budget: &UncertaintyBudget, trials: usize) -> Estimate {
    let std = budget.combined_std_uncertainty_n_s2;
    Estimate {
        value: fit.thrust_constant_n_s2.value,
        std_uncertainty: (std > 0.0).then_some(std),
        ending: if trials > 1 { Ending::Solved } else { Ending::SingleObservation },
    }
}

fn rows(
    loads: &[LoadSpeeds],
    campaign: &Campaign<'_>,
    fit: Option<&SquareLawFit>,
    settings: &ThrustSettings,
) -> Vec<LoadThrust> {
    let few = campaign.student_factor();
    let row = |(index, load): (usize, &LoadSpeeds)| {
        let place = campaign.loads.iter().position(|heard| heard.index == index);
        let heard = place.and_then(|place| campaign.loads.get(place));
        let verdict = place.and_then(|place| fit?.points.get(place));
        row_of_load(load, heard, verdict, settings, few)
    };
    loads.iter().enumerate().map(row).collect()
}

/// A row of the table; `few` is Student's factor on the uncertainty of the speeds.
fn row_of_load(
    load: &LoadSpeeds,
    heard: Option<&HeardLoad<'_>>,
    verdict: Option<&PointVerdict>,
    settings: &ThrustSettings,
    few: f64,
) -> LoadThrust {
    let rotor_count = settings.rotor_count.max(1);
    let force_n = load.force.newtons();
    let factor = whole_vehicle_factor(load.rotors_running, rotor_count);
    let constant = |speed: RotorSpeed| factor * thrust_constant_n_s2(force_n, speed);
    let trials: Vec<TrialThrust> = load.trials.iter().map(|trial| row_of_trial(trial, &constant)).collect();
    let counted = load.trials.iter().flat_map(TrialSpeeds::counted);
    let speeds: Vec<f64> = counted.map(|sample| sample.speed.rad_s()).collect();
    let speed = mean(&speeds).map(RotorSpeed::from_rad_s);
    let speed_std_share = heard.map(|heard| few * heard.speed_std_share).filter(|share| *share > 0.0);
    let total = speed.map(|speed| {
        let force = load.force.relative_std();
        let relative = speed_std_share.map(|share| (2.0 * share).hypot(force.own).hypot(force.shared));
        let heard = trials.iter().filter(|trial| trial.speed.is_some()).count();
        let ending = if heard > 1 { Ending::Solved } else { Ending::SingleObservation };
        let value = constant(speed);
        Estimate { value, std_uncertainty: relative.map(|relative| relative * value), ending }
    });
    // the verdict has forces of the whole vehicle
    let mass_of = |force_n: Option<f64>| {
        let (force_n, mass_kg) = (force_n?, load.force.mass_kg()?);
        Some(mass_kg * force_n / load.force.newtons())
    };
    LoadThrust {
        name: load.name.clone(),
        mass_kg: load.force.mass_kg(),
        force_n,
        rotors_running: load.rotors_running,
        speed,
        std_uncertainty_rad_s: speed.zip(speed_std_share).map(|(speed, share)| speed.rad_s() * share),
        spread_rad_s: spread_rad_s(load, &speeds),
        thrust_constant_total_n_s2: total,
        thrust_constant_per_rotor_n_s2: total.map(|total| total.scaled(1.0 / f64::from(rotor_count))),
        fits: verdict.and_then(|verdict| verdict.fits),
        figure_of_merit: figure_of_merit_of(load, settings),
        p_value: verdict.and_then(|verdict| verdict.p_value),
        mass_that_fits_kg: mass_of(verdict.and_then(|verdict| verdict.force_that_fits_n)),
        mass_that_fits_std_kg: mass_of(verdict.and_then(|verdict| verdict.force_that_fits_std_n)),
        trials,
    }
}

/// Figure of merit of one running rotor; all running rotors have equal thrust and power.
fn figure_of_merit_of(load: &LoadSpeeds, settings: &ThrustSettings) -> Option<f64> {
    let running = f64::from(load.rotors_running.max(1));
    let (thrust_n, power_w) = (load.force.newtons() / running, load.power_w? / running);
    Some(figure_of_merit(thrust_n, power_w, settings.propeller_diameter_m?, settings.air_density_kg_m3?))
}

fn row_of_trial(trial: &TrialSpeeds, constant: &dyn Fn(RotorSpeed) -> f64) -> TrialThrust {
    let speeds: Vec<f64> = trial.counted().iter().map(|sample| sample.speed.rad_s()).collect();
    let speed = mean(&speeds).map(RotorSpeed::from_rad_s);
    TrialThrust {
        recording: trial.recording.clone(),
        speed,
        thrust_constant_total_n_s2: speed.map(constant),
        samples: trial
            .samples
            .iter()
            .map(|sample| SampleThrust { speed: sample.clone(), thrust_constant_total_n_s2: constant(sample.speed) })
            .collect(),
    }
}

/// Standard deviation of the speed over all frames of a load: spread within the samples and between them, added in squares.
fn spread_rad_s(load: &LoadSpeeds, speeds: &[f64]) -> Option<f64> {
    let squares: Vec<f64> = load
        .trials
        .iter()
        .flat_map(TrialSpeeds::counted)
        .filter_map(|sample| Some(RotorSpeed::from_rev_s(sample.spread_rev_s?).rad_s().powi(2)))
        .collect();
    Some((mean(&squares)? + std(speeds).unwrap_or_default().powi(2)).sqrt())
}

/// The average of the paper: the plain mean over the loads. Its uncertainty follows from the uncertainties of the loads, or from their
/// scatter where that is larger; the shared part of the forces is added.
fn mean_over_loads(campaign: &Campaign<'_>, rows: &[LoadThrust]) -> Option<Estimate> {
    let heard: Vec<(&HeardLoad<'_>, Estimate)> = campaign
        .loads
        .iter()
        .filter_map(|load| Some((load, rows.get(load.index)?.thrust_constant_total_n_s2?)))
        .collect();
    let values: Vec<f64> = heard.iter().map(|(_, total)| total.value).collect();
    let count = values.len() as f64;
    let value = mean(&values)?;
    let alone = |(load, total): &(&HeardLoad<'_>, Estimate)| {
        total.value
            * (2.0 * campaign.student_factor() * load.speed_std_share).hypot(load.own_force_std_n / load.force_n)
    };
    let by_parts = heard.iter().map(|load| alone(load).powi(2)).sum::<f64>().sqrt() / count;
    let by_scatter = std(&values).map_or(0.0, |scatter| student_factor(count - 1.0) * scatter / count.sqrt());
    let shared: Vec<f64> =
        heard.iter().map(|(load, total)| total.value * load.load.force.relative_std().shared).collect();
    let std_uncertainty = by_parts.max(by_scatter).hypot(mean(&shared).unwrap_or_default());
    let trials: usize = campaign.loads.iter().map(|load| load.trials_rad_s.len()).sum();
    Some(Estimate {
        value,
        std_uncertainty: (std_uncertainty > 0.0).then_some(std_uncertainty),
        ending: if trials > 1 { Ending::Solved } else { Ending::SingleObservation },
    })
}

fn warnings_of(
    campaign: &Campaign<'_>,
    loads: &[LoadSpeeds],
    rows: &[LoadThrust],
    fit: Option<&SquareLawFit>,
) -> Vec<ThrustWarning> {
    let left_out = |GrossTrial { load, recording }: &GrossTrial| ThrustWarning::TrialLeftOut {
        load: load.clone(),
        recording: recording.clone(),
    };
    let mut warnings: Vec<ThrustWarning> = campaign.gross_trials.iter().map(left_out).collect();
    let is_gross =
        |name: &str| fit.is_some_and(|fit| fit.points.iter().any(|point| point.is_gross && point.name == name));
    let misfits: Vec<&LoadThrust> = rows.iter().filter(|row| row.fits == Some(false)).collect();
    if misfits.len() > 1 && misfits.len() == campaign.loads.len() {
        let names = misfits.iter().map(|row| row.name.clone()).collect();
        let has_added =
            |load: &LoadSpeeds| matches!(load.force, Force::Weight { added_mass_kg, .. } if added_mass_kg > 0.0);
        let has_added_mass = loads.iter().any(has_added);
        let of_two = |row: &&LoadThrust| row.mass_that_fits_kg.filter(|_| misfits.len() == 2);
        let masses_that_fit_kg = misfits.iter().filter_map(of_two).collect();
        warnings.push(ThrustWarning::LoadsDisagree { names, are_rows: false, has_added_mass, masses_that_fit_kg });
    } else {
        warnings.extend(misfits.into_iter().map(|row| ThrustWarning::LoadDoesNotFit {
            name: row.name.clone(),
            is_row: false,
            mass_that_fits_kg: row.mass_that_fits_kg,
            mass_that_fits_std_kg: row.mass_that_fits_std_kg,
            is_left_out: is_gross(&row.name),
        }));
    }
    warnings.extend(misfiled(campaign));
    // the pair that shows most of what is wrong stands on top
    warnings.sort_by_key(|warning| !matches!(warning, ThrustWarning::HeavierTurnedSlower { .. }));
    warnings.extend(warnings_of_recordings(&outlines_of(loads, campaign)));
    let are_split = campaign.are_split || are_split_points(&campaign.points);
    let is_contradicted = warnings.iter().any(ThrustWarning::is_of_misfiled);
    let of_range = fit.map(|fit| range_warnings(&campaign.points, fit, are_split)).unwrap_or_default();
    warnings.extend(of_range.into_iter().filter(|warning| tells(warning, is_contradicted)));
    warnings
}

/// Whether a warning about the range of loads means anything: a range that would be wide enough for misfiled loads tells nothing.
fn tells(warning: &ThrustWarning, is_contradicted: bool) -> bool {
    !is_contradicted || !matches!(warning, ThrustWarning::NarrowLoadRange(_))
}

/// All loads, with the number of their trials that are used.
fn outlines_of<'a>(loads: &'a [LoadSpeeds], campaign: &Campaign<'_>) -> Vec<LoadOutline<'a>> {
    let used = |index: usize| {
        let heard = campaign.loads.iter().find(|load| load.index == index);
        heard.map_or(0, |load| load.trials_rad_s.len())
    };
    let outline = |(index, load): (usize, &'a LoadSpeeds)| LoadOutline {
        name: &load.name,
        force: load.force,
        rotors_running: load.rotors_running,
        recording_count: used(index),
    };
    loads.iter().enumerate().map(outline).collect()
}

fn are_split_points(points: &[ForcePoint]) -> bool {
    are_split(&points.iter().map(ForcePoint::thrust_constant_n_s2).collect::<Vec<_>>())
}

/// Warnings about the set of loads: they contradict each other, are too few or too similar, or another law describes them better.
fn range_warnings(points: &[ForcePoint], fit: &SquareLawFit, are_split: bool) -> Vec<ThrustWarning> {
    if are_split {
        // where half of the constants are wrong, range and law of the loads mean nothing
        return vec![ThrustWarning::ConstantsSplit];
    }
    if let Some(alike) = too_alike(&points.iter().map(|point| point.force_n).collect::<Vec<_>>()) {
        return vec![alike];
    }
    // forces that show another law are not too alike to test this one
    let narrow = || fit.range.filter(|range| !range.shows_intercept).map(ThrustWarning::NarrowLoadRange);
    law_warning(fit).or_else(narrow).into_iter().collect()
}

/// Warnings about a fit of the rows of a table. `gravity_m_s2` is given where the rows are masses that hover.
pub fn warnings_of_points(points: &[ForcePoint], fit: &SquareLawFit, gravity_m_s2: Option<f64>) -> Vec<ThrustWarning> {
    let mut warnings = warnings_of_misfits(&fit.points, gravity_m_s2);
    // a row that is left out contradicts nothing
    let is_kept = |(point, verdict): (&ForcePoint, &PointVerdict)| (!verdict.is_gross).then(|| point.clone());
    let kept: Vec<ForcePoint> = points.iter().zip(&fit.points).filter_map(is_kept).collect();
    let exchanged = gravity_m_s2.and_then(|_| exchanged_rows(&kept));
    let is_contradicted = exchanged.is_some();
    warnings.extend(exchanged);
    warnings.extend(ThrustWarning::of_uncertainty(fit.thrust_constant_n_s2, true));
    // rows that do not fit are why the law cannot be tested
    let has_misfits = fit.points.iter().any(|point| point.fits == Some(false) && !point.is_gross);
    let is_explained = |warning: &ThrustWarning| has_misfits && matches!(warning, ThrustWarning::NarrowLoadRange(_));
    let of_range = range_warnings(points, fit, are_split_points(points)).into_iter();
    warnings.extend(of_range.filter(|warning| tells(warning, is_contradicted) && !is_explained(warning)));
    warnings
}

/// The warning that another law is preferred to the square law, which simulators use. Its probability is that in the table of laws.
fn law_warning(fit: &SquareLawFit) -> Option<ThrustWarning> {
    let law = preferred_law(fit).filter(|law| *law != ForceLaw::Square)?;
    Some(ThrustWarning::OtherLawPreferred { law, probability: probability_of(fit, law) })
}

/// The law that is clearly preferred: another law where it is three times as probable as the square law, and the square law
/// where it is as much more probable than each other. `None` where no law is, or nothing is compared.
pub fn preferred_law(fit: &SquareLawFit) -> Option<ForceLaw> {
    let rivals = fit.laws.iter().filter(|rival| match fit.preferred {
        ForceLaw::Square => rival.law != ForceLaw::Square,
        _ => rival.law == ForceLaw::Square,
    });
    let rival = rivals.map(|rival| rival.probability).reduce(f64::max)?;
    (probability_of(fit, fit.preferred) > PREFERRED_FACTOR * rival).then_some(fit.preferred)
}

fn probability_of(fit: &SquareLawFit, law: ForceLaw) -> f64 {
    fit.laws.iter().find(|known| known.law == law).map_or(0.0, |known| known.probability)
}
