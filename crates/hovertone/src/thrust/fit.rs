//! The paper's averages, with uncertainty and a check whether the loads agree.

use super::{LoadSpeeds, LoadThrust, SampleThrust, ThrustTable, TrialSpeeds, TrialThrust, thrust_constant_n_s2};
use crate::method::Method;
use crate::statistics::{mean, std};
use crate::warning::Warning;
use hovertone_vehicle::{Ending, Estimate, RotorSpeed};
use statrs::distribution::{ContinuousCDF, StudentsT};

/// Degrees of freedom of an uncertainty that comes from the frames of one trial: some hundred frames of a hover are worth
/// about so many independent ones.
const FREEDOM_OF_FRAMES: f64 = 20.0;
/// A load that is right is said to disagree with this chance: the usual level of such tests.
const DISAGREEMENT_CHANCE: f64 = 0.05;

/// The thrust constant from loads, as the paper's tables have it: per load from the mean speed of all its samples
/// (C = F / ω̄², not the mean of the samples' constants), over all as the plain mean of the loads. The square of the mean
/// in place of the mean of the squares makes C too large by the square of the relative spread: 0.015 % at the paper's 1.23 %.
///
/// The standard uncertainty of a load combines the scatter of its trials' mean speeds (or, with a single trial, of the
/// frames) and the weighing: u²(C)/C² = u²(F)/F² + 4 u²(ω)/ω². Over the loads, what they share (the vehicle's weighing)
/// does not average out, and where the loads scatter more than their uncertainties say, their scatter is taken.
///
/// Not in it: that a single ridge follows the loudest rotor (2 to 4 % in C with rotors 1 to 2 % apart), which no
/// statistics of the ridge can show. The table warns of it.
pub fn thrust_from_loads(loads: &[LoadSpeeds], method: Method, rotor_count: u32) -> ThrustTable {
    let rotor_count = rotor_count.max(1);
    let mut rows: Vec<LoadThrust> = loads.iter().map(|load| row_of_load(load, rotor_count)).collect();
    judge_loads(loads, &mut rows);
    let total = mean_over_loads(loads, &rows);
    let mut warnings: Vec<Warning> = rows
        .iter()
        .filter(|row| row.fits == Some(false))
        .map(|row| Warning::LoadDoesNotFit { name: row.name.clone(), mass_that_fits_kg: row.mass_that_fits_kg })
        .collect();
    if loads.iter().any(|load| load.rotors_running > 1) && total.is_some() {
        warnings.push(Warning::LoudestRotor);
    }
    ThrustTable {
        method,
        rotor_count,
        loads: rows,
        thrust_constant_total_n_s2: total,
        thrust_constant_per_rotor_n_s2: total.map(|total| total.scaled(1.0 / f64::from(rotor_count))),
        warnings,
    }
}

/// Factor from the constant of the rotors that run to that of the whole vehicle: 1 in a hover.
fn whole_vehicle_factor(rotors_running: u32, rotor_count: u32) -> f64 {
    f64::from(rotor_count) / f64::from(rotors_running.max(1))
}

fn row_of_load(load: &LoadSpeeds, rotor_count: u32) -> LoadThrust {
    let force_n = load.force.newtons();
    let factor = whole_vehicle_factor(load.rotors_running, rotor_count);
    let constant = |speed: RotorSpeed| factor * thrust_constant_n_s2(force_n, speed);
    let trials: Vec<TrialThrust> = load.trials.iter().map(|trial| row_of_trial(trial, &constant)).collect();
    let samples = || load.trials.iter().flat_map(|trial| &trial.samples);
    let speeds: Vec<f64> = samples().map(|sample| sample.speed.rad_s()).collect();
    let speed = mean(&speeds).map(RotorSpeed::from_rad_s);
    let std_uncertainty_rad_s = speed_std_uncertainty_rad_s(load, &trials);
    let total = speed.map(|speed| {
        let (alone, shared) = load.force.relative_std();
        let relative = std_uncertainty_rad_s.map(|std| (2.0 * std / speed.rad_s()).hypot(alone).hypot(shared));
        let heard = trials.iter().filter(|trial| trial.speed.is_some()).count();
        let ending = if heard > 1 { Ending::Solved } else { Ending::SingleObservation };
        let value = constant(speed);
        Estimate { value, std_uncertainty: relative.map(|relative| relative * value), ending }
    });
    LoadThrust {
        name: load.name.clone(),
        mass_kg: load.force.mass_kg(),
        force_n,
        rotors_running: load.rotors_running,
        speed,
        std_uncertainty_rad_s,
        spread_rad_s: spread_rad_s(load, &speeds),
        thrust_constant_total_n_s2: total,
        thrust_constant_per_rotor_n_s2: total.map(|total| total.scaled(1.0 / f64::from(rotor_count))),
        fits: None,
        mass_that_fits_kg: None,
        trials,
    }
}

fn row_of_trial(trial: &TrialSpeeds, constant: &dyn Fn(RotorSpeed) -> f64) -> TrialThrust {
    let speeds: Vec<f64> = trial.samples.iter().map(|sample| sample.speed.rad_s()).collect();
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

/// Standard uncertainty of a load's mean speed: from the scatter of its trials (their windows overlap and share a flight,
/// so trials are what counts) or from the frames within them, whichever is larger; a single trial has only its frames.
fn speed_std_uncertainty_rad_s(load: &LoadSpeeds, trials: &[TrialThrust]) -> Option<f64> {
    let means: Vec<f64> = trials.iter().filter_map(|trial| Some(trial.speed?.rad_s())).collect();
    let within: Vec<f64> = load
        .trials
        .iter()
        .flat_map(|trial| &trial.samples)
        .filter_map(|sample| Some(RotorSpeed::from_rev_s(sample.std_uncertainty_rev_s?).rad_s()))
        .collect();
    let count = means.len().max(1) as f64;
    let by_frames = mean(&within).map(|std| std / count.sqrt());
    // two or three trials can agree by chance better than their frames allow
    std(&means).map(|scatter| scatter / count.sqrt()).into_iter().chain(by_frames).reduce(f64::max)
}

/// Spread of the speed over all frames of a load: within the samples and between them.
fn spread_rad_s(load: &LoadSpeeds, speeds: &[f64]) -> Option<f64> {
    let squares: Vec<f64> = load
        .trials
        .iter()
        .flat_map(|trial| &trial.samples)
        .filter_map(|sample| Some(RotorSpeed::from_rev_s(sample.spread_rev_s?).rad_s().powi(2)))
        .collect();
    Some((mean(&squares)? + std(speeds).unwrap_or_default().powi(2)).sqrt())
}

/// A load's constant with the variance that it has alone (what all loads share cancels in a comparison) and the degrees of
/// freedom that its trials leave.
struct Alone {
    value: f64,
    variance: f64,
    degrees_of_freedom: f64,
}

/// Leaves each load out in turn and asks by Student's test whether it agrees with the rest (Welch and Satterthwaite's
/// degrees of freedom).
fn judge_loads(loads: &[LoadSpeeds], rows: &mut [LoadThrust]) {
    let alone: Vec<Option<Alone>> = loads.iter().zip(&*rows).map(|(load, row)| alone_of(load, row)).collect();
    for (index, row) in rows.iter_mut().enumerate() {
        let others: Vec<&Alone> = alone
            .iter()
            .enumerate()
            .filter(|&(other, _)| other != index)
            .filter_map(|(_, alone)| alone.as_ref())
            .collect();
        let values: Vec<f64> = others.iter().map(|other| other.value).collect();
        let (Some(own), Some(expected)) = (&alone[index], mean(&values)) else { continue };
        // the difference's variances: this load's, and each other's share of their mean
        let parts: Vec<(f64, f64)> = std::iter::once((own.variance, own.degrees_of_freedom))
            .chain(others.iter().map(|o| (o.variance / (others.len() as f64).powi(2), o.degrees_of_freedom)))
            .collect();
        let variance: f64 = parts.iter().map(|(variance, _)| variance).sum();
        let degrees_of_freedom =
            variance.powi(2) / parts.iter().map(|(variance, dof)| variance.powi(2) / dof).sum::<f64>();
        let Ok(student) = StudentsT::new(0.0, 1.0, degrees_of_freedom) else { continue };
        let apart_stds_max = student.inverse_cdf(1.0 - DISAGREEMENT_CHANCE / 2.0);
        let fits = (own.value - expected).abs() <= apart_stds_max * variance.sqrt();
        row.fits = Some(fits);
        row.mass_that_fits_kg = row.mass_kg.filter(|_| !fits).map(|mass_kg| mass_kg * expected / own.value);
    }
}

/// Variance of a load's constant without what all loads share: its speed's and its own weighing's.
fn variance_alone(load: &LoadSpeeds, row: &LoadThrust) -> Option<f64> {
    let speed_share = 2.0 * row.std_uncertainty_rad_s? / row.speed?.rad_s();
    Some((row.thrust_constant_total_n_s2?.value * speed_share.hypot(load.force.relative_std().0)).powi(2))
}

fn alone_of(load: &LoadSpeeds, row: &LoadThrust) -> Option<Alone> {
    let value = row.thrust_constant_total_n_s2?.value;
    let heard = row.trials.iter().filter(|trial| trial.speed.is_some()).count();
    // a single trial's uncertainty comes from its many frames
    let degrees_of_freedom = if heard > 1 { heard as f64 - 1.0 } else { FREEDOM_OF_FRAMES };
    let variance = variance_alone(load, row)?;
    (variance > 0.0).then_some(Alone { value, variance, degrees_of_freedom })
}

fn mean_over_loads(loads: &[LoadSpeeds], rows: &[LoadThrust]) -> Option<Estimate> {
    let heard: Vec<(&LoadSpeeds, &LoadThrust, Estimate)> =
        loads.iter().zip(rows).filter_map(|(load, row)| Some((load, row, row.thrust_constant_total_n_s2?))).collect();
    let values: Vec<f64> = heard.iter().map(|(.., total)| total.value).collect();
    let count = values.len() as f64;
    let value = mean(&values)?;
    let alone: Option<f64> = heard.iter().map(|(load, row, _)| variance_alone(load, row)).sum();
    let shared: Vec<f64> = heard.iter().map(|(load, _, total)| total.value * load.force.relative_std().1).collect();
    let by_parts = alone.map(|squares| squares.sqrt() / count);
    let by_scatter = std(&values).map(|scatter| scatter / count.sqrt());
    let std_uncertainty =
        by_parts.into_iter().chain(by_scatter).reduce(f64::max).map(|std| std.hypot(mean(&shared).unwrap_or_default()));
    let trials = heard.iter().flat_map(|(_, row, _)| &row.trials).filter(|trial| trial.speed.is_some()).count();
    let is_solved = trials > 1 && std_uncertainty.is_some();
    Some(Estimate {
        value,
        std_uncertainty,
        ending: if is_solved { Ending::Solved } else { Ending::SingleObservation },
    })
}
