//! The paper's averages, with uncertainty and a check whether the loads agree.

use super::{Force, LoadSpeeds, LoadThrust, SampleThrust, ThrustTable, TrialSpeeds, TrialThrust, thrust_constant_n_s2};
use crate::config::Method;
use crate::statistics::{mean, std};
use crate::warning::Warning;
use hovertone_vehicle::{Ending, Estimate, RotorSpeed};

/// A load disagrees when it lies this many standard uncertainties from the others: one chance in a hundred.
const DISAGREEMENT_STDS: f64 = 2.58;

/// The thrust constant from loads, as the paper's tables have it: per load from the mean speed of all its samples
/// (C = F / ω̄², not the mean of the samples' constants), over all as the plain mean of the loads.
///
/// The standard uncertainty of a load combines the scatter of its trials' mean speeds (or, with a single trial, of the
/// frames) and the weighing: u²(C)/C² = u²(F)/F² + 4 u²(ω)/ω². Over the loads, what they share (the vehicle's weighing)
/// does not average out, and where the loads scatter more than their uncertainties say, their scatter is taken.
///
/// Not in it: that a single ridge follows the loudest rotor (2 to 4 % in C with rotors 1 to 2 % apart), which no
/// statistics of the ridge can show. The table warns of it.
pub fn thrust_from_loads(loads: &[LoadSpeeds], method: Method, rotor_count: u32) -> ThrustTable {
    let mut rows: Vec<LoadThrust> = loads.iter().map(|load| row_of_load(load, rotor_count)).collect();
    judge_loads(&mut rows);
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
        let ending = if trials.len() > 1 { Ending::Solved } else { Ending::SingleObservation };
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

/// Standard uncertainty of a load's mean speed. Windows of one trial overlap and share its flight, so trials are what
/// counts; a single trial can only tell by its frames.
fn speed_std_uncertainty_rad_s(load: &LoadSpeeds, trials: &[TrialThrust]) -> Option<f64> {
    let means: Vec<f64> = trials.iter().filter_map(|trial| Some(trial.speed?.rad_s())).collect();
    if let Some(scatter) = std(&means) {
        return Some(scatter / (means.len() as f64).sqrt());
    }
    let within: Vec<f64> = load
        .trials
        .iter()
        .flat_map(|trial| &trial.samples)
        .filter_map(|sample| Some(RotorSpeed::from_rev_s(sample.std_uncertainty_rev_s?).rad_s()))
        .collect();
    mean(&within)
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

/// Leaves each load out in turn and asks whether it agrees with the rest.
fn judge_loads(rows: &mut [LoadThrust]) {
    let totals: Vec<Option<Estimate>> = rows.iter().map(|row| row.thrust_constant_total_n_s2).collect();
    for (index, row) in rows.iter_mut().enumerate() {
        let others: Vec<Estimate> =
            totals.iter().enumerate().filter(|&(other, _)| other != index).filter_map(|(_, total)| *total).collect();
        let values: Vec<f64> = others.iter().map(|other| other.value).collect();
        let (Some(own), Some(expected)) = (totals[index], mean(&values)) else { continue };
        let Some(own_std) = own.std_uncertainty else { continue };
        let Some(others_std) = others.iter().map(|other| Some(other.std_uncertainty?.powi(2))).sum::<Option<f64>>()
        else {
            continue;
        };
        let apart_std = own_std.hypot(others_std.sqrt() / others.len() as f64);
        let fits = (own.value - expected).abs() <= DISAGREEMENT_STDS * apart_std;
        row.fits = Some(fits);
        row.mass_that_fits_kg = row.mass_kg.filter(|_| !fits).map(|mass_kg| mass_kg * expected / own.value);
    }
}

fn mean_over_loads(loads: &[LoadSpeeds], rows: &[LoadThrust]) -> Option<Estimate> {
    let heard: Vec<(&Force, &LoadThrust, Estimate)> = loads
        .iter()
        .zip(rows)
        .filter_map(|(load, row)| Some((&load.force, row, row.thrust_constant_total_n_s2?)))
        .collect();
    let values: Vec<f64> = heard.iter().map(|(.., total)| total.value).collect();
    let count = values.len() as f64;
    let value = mean(&values)?;
    let alone: Option<f64> = heard
        .iter()
        .map(|(force, row, total)| {
            let speed_share = 2.0 * row.std_uncertainty_rad_s? / row.speed?.rad_s();
            Some((total.value * speed_share.hypot(force.relative_std().0)).powi(2))
        })
        .sum();
    let shared: Vec<f64> = heard.iter().map(|(force, _, total)| total.value * force.relative_std().1).collect();
    let std_uncertainty = alone.map(|squares| {
        let by_parts = squares.sqrt() / count;
        let by_scatter = std(&values).map_or(0.0, |scatter| scatter / count.sqrt());
        by_parts.max(by_scatter).hypot(mean(&shared).unwrap_or_default())
    });
    let is_single = heard.iter().map(|(_, row, _)| row.trials.len()).sum::<usize>() < 2;
    Some(Estimate {
        value,
        std_uncertainty,
        ending: if is_single { Ending::SingleObservation } else { Ending::Solved },
    })
}
