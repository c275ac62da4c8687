//! Speeds and known forces → thrust constant: the square law through all loads with its uncertainty budget, and per sample, per
//! trial and per load as the paper averages.

mod air;
mod balance;
mod bootstrap;
mod budget;
#[cfg(test)]
mod campaign_tests;
mod dimensionless;
mod drift;
mod fit;
mod load_points;
mod load_range;
mod plan;
mod point_verdict;
mod row_drift;
mod square_law;
#[cfg(test)]
mod suspicious_tests;
#[cfg(test)]
mod tests;
mod uncertainty_inputs;
mod weighing;

pub use air::Air;
pub use balance::{GRAVITY_STANDARD_M_S2, Gravity, gravity_m_s2, thrust_constant_n_s2};
pub use bootstrap::TrialBootstrap;
pub use budget::{BudgetInput, BudgetLine, COVERAGE_FACTOR, UncertaintyBudget};
pub use dimensionless::{
    PROPELLER_DIAMETER_M, ThrustCoefficients, figure_of_merit, is_plausible_merit, torque_constant_n_m_s2,
};
pub use drift::{Drift, DriftKind};
pub use fit::{thrust_from_loads, warnings_of_points};
pub use load_range::LoadRange;
pub use plan::{FlightPlan, PlanError, PlanWish, flight_plan};
pub use point_verdict::PointVerdict;
pub use row_drift::row_drifts;
pub use square_law::{
    ForceLaw, ForcePoint, InterceptLaw, LawAgreement, LawProbability, PointNoise, PowerLaw, SquareLawFit,
    square_law_fit,
};
pub use uncertainty_inputs::UncertaintyInputs;
pub use weighing::{AcousticScale, HeardHover, WeighedHover};

use crate::budget_config::BudgetConfig;
use crate::method::Method;
use crate::pipeline::{Outcome, SpeedAnalysis};
use crate::span::Span;
use crate::speed::SpeedEstimate;
use crate::warning::Warning;
use hovertone_vehicle::{Estimate, RotorSpeed};
use serde::Serialize;

/// The force that the running rotors balance.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
#[serde(tag = "kind", rename_all = "snake_case")]
pub enum Force {
    /// A hover: the weight of vehicle and payload.
    Weight {
        /// Mass of the vehicle, weighed once for all loads.
        vehicle_mass_kg: f64,
        /// Mass that this load adds.
        added_mass_kg: f64,
        /// Standard uncertainty of a weighing.
        mass_std_kg: f64,
        /// Local gravity.
        gravity_m_s2: f64,
        /// Its standard uncertainty.
        gravity_std_m_s2: f64,
    },
    /// A bench run: thrust read from a scale.
    Thrust {
        /// Thrust of all rotors that run.
        thrust_n: f64,
        /// Its standard uncertainty.
        thrust_std_n: f64,
    },
}

impl Force {
    /// The force itself.
    pub fn newtons(&self) -> f64 {
        match *self {
            Self::Weight { vehicle_mass_kg, added_mass_kg, gravity_m_s2, .. } => {
                (vehicle_mass_kg + added_mass_kg) * gravity_m_s2
            }
            Self::Thrust { thrust_n, .. } => thrust_n,
        }
    }

    /// Mass that is lifted; none on a bench.
    pub fn mass_kg(&self) -> Option<f64> {
        match *self {
            Self::Weight { vehicle_mass_kg, added_mass_kg, .. } => Some(vehicle_mass_kg + added_mass_kg),
            Self::Thrust { .. } => None,
        }
    }

    /// Relative standard uncertainty that this load has alone, and the one it shares with the others.
    fn relative_std(&self) -> (f64, f64) {
        match *self {
            Self::Weight { vehicle_mass_kg, added_mass_kg, mass_std_kg, .. } => {
                let shared = mass_std_kg / (vehicle_mass_kg + added_mass_kg);
                (if added_mass_kg == 0.0 { 0.0 } else { shared }, shared)
            }
            Self::Thrust { thrust_n, thrust_std_n } => (thrust_std_n / thrust_n, 0.0),
        }
    }
}

/// What a constant needs to be known beside its loads.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct ThrustSettings {
    /// Rotors of the vehicle.
    pub rotor_count: u32,
    /// Diameter of its propellers, where known.
    pub propeller_diameter_m: Option<f64>,
    /// Density of the air, where known.
    pub air_density_kg_m3: Option<f64>,
    /// How far the recorder's clock may be off, in millionths: a half width.
    pub clock_ppm: f64,
    /// Whether the speeds are those of a single ridge, which follows the loudest rotor.
    pub follows_loudest: bool,
    /// Where they are not: how far, as a share, their mean may be from that of all rotors, since not all were told apart.
    pub unresolved_std_share: f64,
    /// Whether somebody weighed the vehicle: a preset's or a model's mass is that of another specimen.
    pub is_weighed: bool,
    /// How large the effects may be that nobody measured.
    pub uncertainty: UncertaintyInputs,
}

impl ThrustSettings {
    /// Of a vehicle with so many rotors, all else by default.
    pub fn for_rotors(rotor_count: u32) -> Self {
        Self {
            rotor_count,
            propeller_diameter_m: None,
            air_density_kg_m3: None,
            clock_ppm: BudgetConfig::default().clock_ppm,
            follows_loudest: true,
            unresolved_std_share: 0.0,
            is_weighed: true,
            uncertainty: UncertaintyInputs::default(),
        }
    }
}

/// One load: a known force and the trials flown with it.
#[derive(Clone, Debug, PartialEq)]
pub struct LoadSpeeds {
    /// Its name.
    pub name: String,
    /// What the rotors balance.
    pub force: Force,
    /// How many rotors balance it.
    pub rotors_running: u32,
    /// Power that they take together, where known.
    pub power_w: Option<f64>,
    /// Its trials.
    pub trials: Vec<TrialSpeeds>,
}

/// One trial: a recording, the speed of its hover and those of its samples.
#[derive(Clone, Debug, PartialEq)]
pub struct TrialSpeeds {
    /// Name of the recording.
    pub recording: String,
    /// How long it hovers, without what was cut.
    pub hover_s: f64,
    /// Over all of its hover, where that is what counts; else the mean of the samples does, as in the paper.
    ///
    /// A force balance holds over a stretch of time but for the climb that begins or ends in it, which is the less the longer the
    /// stretch; samples leave out the end of a hover and hear its middle twice.
    pub hover: Option<SampleSpeed>,
    /// Its samples.
    pub samples: Vec<SampleSpeed>,
}

impl TrialSpeeds {
    /// What is heard in a recording by one method: over all of its hover by ours, in samples by the paper's. `None` without a rotor tone.
    pub fn from_analysis(recording: impl Into<String>, analysis: &SpeedAnalysis, method: Method) -> Option<Self> {
        let Outcome::Ok(tone) = &analysis.outcome else { return None };
        let speed_in = |span: Span, estimate: &SpeedEstimate| SampleSpeed {
            span,
            speed: estimate.speed_of_thrust(),
            std_uncertainty_rev_s: estimate.std_uncertainty_rev_s,
            spread_rev_s: estimate.spread_rev_s,
            frame_count: estimate.frame_count,
        };
        let segments = &analysis.hover.segments;
        let (from_s, to_s) = (segments.first()?.from_s, segments.last()?.to_s);
        let hover = tone.speed(method).filter(|_| !method.reads_ridges());
        Some(Self {
            recording: recording.into(),
            hover_s: analysis.hover.length_s(),
            hover: hover.map(|estimate| speed_in(Span { from_s, to_s }, estimate)),
            samples: tone
                .samples
                .iter()
                .filter_map(|sample| Some(speed_in(sample.span, sample.speed(method)?)))
                .collect(),
        })
    }

    /// What counts of it.
    pub(crate) fn counted(&self) -> &[SampleSpeed] {
        if self.hover.is_some() { self.hover.as_slice() } else { &self.samples }
    }
}

/// Speed in one sample, or in all of a hover.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct SampleSpeed {
    /// When.
    #[serde(flatten)]
    pub span: Span,
    /// Shaft speed: the mean, or where rotors are told apart the root of the mean square over them.
    #[serde(rename = "speed_rad_s")]
    pub speed: RotorSpeed,
    /// Standard uncertainty of the mean, from the sound alone.
    pub std_uncertainty_rev_s: Option<f64>,
    /// Standard deviation over the frames.
    pub spread_rev_s: Option<f64>,
    /// Frames in it.
    pub frame_count: usize,
}

/// The thrust constant by one method: the paper's table, and the answer under it.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct ThrustTable {
    /// How the ridges were read.
    pub method: Method,
    /// Rotors of the vehicle.
    pub rotor_count: u32,
    /// One row for each load.
    pub loads: Vec<LoadThrust>,
    /// Constant of the whole vehicle by the fit, uncertain by weighing and speeds; absent where nothing was heard.
    pub thrust_constant_total_n_s2: Option<Estimate>,
    /// Constant of one rotor: the total over the number of rotors.
    pub thrust_constant_per_rotor_n_s2: Option<Estimate>,
    /// Constant of the whole vehicle as the paper has it: the plain mean over the loads.
    pub plain_mean_total_n_s2: Option<Estimate>,
    /// The fit: the law's agreement, the laws beside it, each load against the others.
    pub fit: Option<SquareLawFit>,
    /// All that makes the constant of the whole vehicle uncertain.
    pub budget: Option<UncertaintyBudget>,
    /// The constant of one rotor without its dimension, where air and diameter are known.
    pub coefficients: Option<ThrustCoefficients>,
    /// Its scatter when trials are drawn anew: to be compared with what the budget says of the speeds.
    pub bootstrap: Option<TrialBootstrap>,
    /// What drifts beyond chance.
    pub drifts: Vec<Drift>,
    /// What weakens the result.
    pub warnings: Vec<Warning>,
}

/// One row of the table.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct LoadThrust {
    /// Name of the load.
    pub name: String,
    /// Mass that is lifted; none on a bench.
    pub mass_kg: Option<f64>,
    /// Force that the rotors balance.
    pub force_n: f64,
    /// How many rotors balance it.
    pub rotors_running: u32,
    /// Mean shaft speed over all trials, or over all their samples by the methods of the paper; absent where nothing was heard.
    #[serde(rename = "speed_rad_s")]
    pub speed: Option<RotorSpeed>,
    /// Its standard uncertainty, from the scatter of the trials.
    pub std_uncertainty_rad_s: Option<f64>,
    /// Standard deviation of the speed over all frames: the paper's STD column.
    pub spread_rad_s: Option<f64>,
    /// Constant of the whole vehicle from this load alone.
    pub thrust_constant_total_n_s2: Option<Estimate>,
    /// Constant of one rotor from this load alone.
    pub thrust_constant_per_rotor_n_s2: Option<Estimate>,
    /// Whether it agrees with the other loads; absent where there is nothing to compare.
    pub fits: Option<bool>,
    /// Figure of merit, where power, air and diameter are known.
    pub figure_of_merit: Option<f64>,
    /// Chance that a right load is as far from the others as this one.
    pub p_value: Option<f64>,
    /// Mass that would agree with the other loads, where this one does not …
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
