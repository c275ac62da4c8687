//! The thrust constant by one method, load by load, the output of the fit.

use crate::air::ThrustCoefficients;
use crate::budget::UncertaintyBudget;
use crate::campaign::TrialBootstrap;
use crate::drift::Drift;
use crate::speeds::SampleSpeed;
use crate::square_law::SquareLawFit;
use crate::warning::ThrustWarning;
use hovertone_analysis::{Method, RotorsHeardCounts};
use hovertone_vehicle::{Estimate, RotorSpeed};
use serde::Serialize;

/// The thrust constant by one method: a table like those of the paper, and the result below it.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct ThrustTable {
    /// Method of the speeds.
    pub method: Method,
    /// How the rotors are heard in the trials that the constant comes from.
    pub rotors_heard: RotorsHeardCounts,
    /// Number of rotors of the vehicle.
    pub rotor_count: u32,
    /// One row for each load.
    pub loads: Vec<LoadThrust>,
    /// Constant of the whole vehicle by the fit, with the combined uncertainty of the budget; absent without any speed.
    pub thrust_constant_total_n_s2: Option<Estimate>,
    /// Constant of one rotor: the total divided by the number of rotors.
    pub thrust_constant_per_rotor_n_s2: Option<Estimate>,
    /// Standard uncertainty of the constant of the whole vehicle from weighing and speeds alone, without the assumed limits of the budget.
    pub measured_std_total_n_s2: Option<f64>,
    /// Constant of the whole vehicle as in the paper: the plain mean over the loads.
    pub plain_mean_total_n_s2: Option<Estimate>,
    /// The fit: agreement of the square law, the laws beside it, each load against the others.
    pub fit: Option<SquareLawFit>,
    /// The uncertainty budget of the constant of the whole vehicle.
    pub budget: Option<UncertaintyBudget>,
    /// Thrust coefficients of one rotor, where air and diameter are known.
    pub coefficients: Option<ThrustCoefficients>,
    /// Bootstrap over trials, to be compared with the inputs of the budget for the speeds.
    pub bootstrap: Option<TrialBootstrap>,
    /// Significant drifts of the constant.
    pub drifts: Vec<Drift>,
    /// Warnings about the result.
    pub warnings: Vec<ThrustWarning>,
}

impl ThrustTable {
    /// Whether a warning says not to use the constant.
    pub fn forbids_use(&self) -> bool {
        self.warnings.iter().any(ThrustWarning::forbids_use)
    }

    /// Name of the method for people. Rotors that are heard as a group are called that.
    pub fn title(&self) -> &'static str {
        match self.method {
            Method::Separated => match (self.rotors_heard.separated > 0, self.rotors_heard.group > 0) {
                (true, false) => "Rotors separated",
                (false, true) => "Rotors as a group",
                (true, true) => "Rotors separated or as a group",
                (false, false) => "One tone for all rotors",
            },
            Method::Harmonic => "Harmonic likelihood",
            Method::MaximumTrace => "Maximum trace",
            Method::Gaussian => "Gaussian approximation",
            _ => self.method.name(),
        }
    }

    /// Whether one trial is all there is: nothing shows how much the speed differs from flight to flight.
    pub fn has_one_trial(&self) -> bool {
        self.loads.iter().flat_map(|load| &load.trials).filter(|trial| trial.speed.is_some()).count() == 1
    }
}

/// One row of the table.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct LoadThrust {
    /// Name of the load.
    pub name: String,
    /// Mass in the air; absent on a bench.
    pub mass_kg: Option<f64>,
    /// Force that the rotors balance.
    pub force_n: f64,
    /// Number of rotors that balance it.
    pub rotors_running: u32,
    /// Mean shaft speed over all trials, or over all their samples by the methods of the paper; absent without any speed.
    #[serde(rename = "speed_rad_s")]
    pub speed: Option<RotorSpeed>,
    /// Its standard uncertainty, from the scatter of the trials, with Student's factor for few of them.
    pub std_uncertainty_rad_s: Option<f64>,
    /// Standard deviation of the speed over all frames: column STD of the paper.
    pub spread_rad_s: Option<f64>,
    /// Constant of the whole vehicle from this load alone.
    pub thrust_constant_total_n_s2: Option<Estimate>,
    /// Constant of one rotor from this load alone.
    pub thrust_constant_per_rotor_n_s2: Option<Estimate>,
    /// Whether it agrees with the other loads; absent where there is nothing to compare.
    pub fits: Option<bool>,
    /// Figure of merit, where power, air and diameter are known.
    pub figure_of_merit: Option<f64>,
    /// Probability that a correct load deviates from the others at least this much.
    pub p_value: Option<f64>,
    /// Mass that would agree with the other loads, where this load does not fit …
    pub mass_that_fits_kg: Option<f64>,
    /// … and its standard uncertainty.
    pub mass_that_fits_std_kg: Option<f64>,
    /// Its trials.
    pub trials: Vec<TrialThrust>,
}

/// One trial of a load.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct TrialThrust {
    /// Name of the recording.
    pub recording: String,
    /// Mean shaft speed over its hover, or over its samples by the methods of the paper.
    #[serde(rename = "speed_rad_s")]
    pub speed: Option<RotorSpeed>,
    /// Constant of the whole vehicle from this trial alone.
    pub thrust_constant_total_n_s2: Option<f64>,
    /// Its samples.
    pub samples: Vec<SampleThrust>,
}

/// One sample of a trial.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct SampleThrust {
    /// Speed of the sample.
    #[serde(flatten)]
    pub speed: SampleSpeed,
    /// Constant of the whole vehicle from this sample alone.
    pub thrust_constant_total_n_s2: f64,
}
