//! The uncertainty budget of a thrust constant in the form of the GUM (JCGM 100:2008): every input with its standard uncertainty,
//! its sensitivity and its share of the variance.

use crate::campaign::{Campaign, HeardLoad};
use crate::force::Force;
use crate::regression::Agreement;
use crate::settings::{ThrustSettings, UncertaintyInputs};
use crate::square_law::{LawAgreement, PointNoise, SquareLawFit, covering_factor};
use crate::statistics::mean;
use hovertone_vehicle::{COVERAGE_FACTOR, SOUND_M_S};
use serde::Serialize;

/// Inputs of a thrust constant.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
#[non_exhaustive]
pub enum BudgetInput {
    /// Mass of the vehicle, weighed once for all loads.
    VehicleMass,
    /// Added masses of the loads, each weighed separately.
    AddedMass,
    /// Calibration of the scale.
    Scale,
    /// Thrust of a bench run.
    Thrust,
    /// Local gravity.
    Gravity,
    /// Mean shaft speed, from the scatter of the trials.
    SpeedStatistics,
    /// Mean shaft speed, from the uncertainty that the estimator states for each trial.
    SpeedEstimator,
    /// Clock of the recorder.
    RecorderClock,
    /// One ridge follows the loudest rotor, or not all rotors are separated.
    LoudestRotor,
    /// A climb or sink rate that changes over the hover.
    VerticalAcceleration,
    /// Change of the distance to the microphone during a hover.
    Drift,
    /// Tilt against a draught.
    Tilt,
    /// Ground effect of the floor.
    GroundEffect,
    /// Wake of the rotors on the airframe and its load.
    Downwash,
    /// Scatter of the loads beyond all other inputs.
    LoadScatter,
}

impl BudgetInput {
    /// Name for people.
    pub fn title(self) -> &'static str {
        match self {
            Self::VehicleMass => "mass of the vehicle",
            Self::AddedMass => "added masses",
            Self::Scale => "calibration of the scale",
            Self::Thrust => "thrust on the bench",
            Self::Gravity => "local gravity",
            Self::SpeedStatistics => "speed (scatter of recordings)",
            Self::SpeedEstimator => "speed (estimator)",
            Self::RecorderClock => "clock of the recorder",
            Self::LoudestRotor => "rotors not separated",
            Self::VerticalAcceleration => "vertical acceleration",
            Self::Drift => "drift of the hovers",
            Self::Tilt => "tilt",
            Self::GroundEffect => "ground effect",
            Self::Downwash => "downwash",
            Self::LoadScatter => "disagreement of the loads",
        }
    }

    /// Whether the uncertainty comes from a measurement of this campaign (weighing and speeds), not from an assumed limit.
    fn is_measured(self) -> bool {
        matches!(
            self,
            Self::VehicleMass
                | Self::AddedMass
                | Self::Thrust
                | Self::SpeedStatistics
                | Self::SpeedEstimator
                | Self::LoadScatter
        )
    }
}

/// One input of the budget.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct BudgetLine {
    /// Which input.
    pub input: BudgetInput,
    /// Its estimate, in `unit`; 0 for a correction that is not applied.
    pub value: f64,
    /// Its standard uncertainty, in `unit`.
    pub std_uncertainty: f64,
    /// Its unit; "1" for a share.
    pub unit: &'static str,
    /// Change of the constant per unit of the input.
    pub sensitivity_n_s2_per_unit: f64,
    /// Contribution to the standard uncertainty of the constant: sensitivity times standard uncertainty.
    pub contribution_n_s2: f64,
    /// Its share of the combined variance.
    pub share: f64,
    /// Degrees of freedom; absent for a type B evaluation, which uses no repeated observations.
    pub degrees_of_freedom: Option<f64>,
}

/// The budget of the constant of the whole vehicle.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct UncertaintyBudget {
    /// Every input, including inputs that contribute nothing here.
    pub lines: Vec<BudgetLine>,
    /// Combined standard uncertainty: root of the sum of the squared contributions.
    pub combined_std_uncertainty_n_s2: f64,
    /// Coverage factor k.
    pub coverage_factor: f64,
    /// k times the combined standard uncertainty.
    pub expanded_uncertainty_n_s2: f64,
    /// Expanded uncertainty over the constant.
    pub expanded_share: f64,
    /// Effective degrees of freedom (Welch and Satterthwaite, JCGM 100:2008, G.4); absent where only type B inputs contribute.
    pub effective_degrees_of_freedom: Option<f64>,
}

impl UncertaintyBudget {
    /// Standard uncertainty from weighing and speeds, without the inputs that are assumed limits.
    pub(crate) fn measured_std_n_s2(&self) -> f64 {
        self.std_of_inputs(BudgetInput::is_measured)
    }

    /// Standard uncertainty from some of the inputs.
    pub fn std_of_inputs(&self, is_wanted: impl Fn(BudgetInput) -> bool) -> f64 {
        let wanted = self.lines.iter().filter(|line| is_wanted(line.input));
        wanted.map(|line| line.contribution_n_s2.powi(2)).sum::<f64>().sqrt()
    }
}

/// The budget of the constant of a fit.
pub(crate) fn budget_of_fit(
    campaign: &Campaign<'_>,
    fit: &SquareLawFit,
    settings: &ThrustSettings,
) -> UncertaintyBudget {
    let sensitivity = Sensitivity::of(campaign, fit);
    let mut lines = of_forces(campaign, &sensitivity);
    lines.extend(of_speeds(campaign, &sensitivity, settings));
    lines.extend(of_flight(campaign, &sensitivity, settings));
    lines.extend(of_scatter(fit, campaign));
    summed(lines, fit.thrust_constant_n_s2.value)
}

fn summed(mut lines: Vec<BudgetLine>, constant_n_s2: f64) -> UncertaintyBudget {
    let variance: f64 = lines.iter().map(|line| line.contribution_n_s2.powi(2)).sum();
    for line in &mut lines {
        line.share = if variance > 0.0 { line.contribution_n_s2.powi(2) / variance } else { 0.0 };
    }
    let combined = variance.sqrt();
    let by_freedom: f64 =
        lines.iter().filter_map(|line| Some(line.contribution_n_s2.powi(4) / line.degrees_of_freedom?)).sum();
    UncertaintyBudget {
        lines,
        combined_std_uncertainty_n_s2: combined,
        coverage_factor: COVERAGE_FACTOR,
        expanded_uncertainty_n_s2: COVERAGE_FACTOR * combined,
        expanded_share: COVERAGE_FACTOR * combined / constant_n_s2,
        effective_degrees_of_freedom: (by_freedom > 0.0).then(|| variance.powi(2) / by_freedom),
    }
}

/// Contributions of the loads to the constant.
struct Sensitivity {
    constant_n_s2: f64,
    /// For each load, its part of the constant; the parts add up to the constant.
    parts_n_s2: Vec<f64>,
    /// Sum of the parts of the hovers.
    hover_n_s2: f64,
    /// Mean speed over the loads.
    mean_speed_rad_s: f64,
}

impl Sensitivity {
    fn of(campaign: &Campaign<'_>, fit: &SquareLawFit) -> Self {
        let parts: Vec<f64> = campaign
            .points
            .iter()
            .zip(&fit.shares)
            .map(|(point, share)| share * point.thrust_constant_n_s2())
            .collect();
        let hover = campaign.loads.iter().zip(&parts).filter(|(load, _)| load.is_hover()).map(|(_, part)| part).sum();
        let speeds: Vec<f64> = campaign.loads.iter().map(|load| load.speed_rad_s).collect();
        Self {
            constant_n_s2: fit.thrust_constant_n_s2.value,
            hover_n_s2: hover,
            mean_speed_rad_s: mean(&speeds).unwrap_or_default(),
            parts_n_s2: parts,
        }
    }

    /// Root of the sum of squares of part times relative error, for errors that are independent from load to load.
    fn independent(&self, campaign: &Campaign<'_>, of: impl Fn(&HeardLoad<'_>) -> f64) -> f64 {
        let squares: f64 =
            campaign.loads.iter().zip(&self.parts_n_s2).map(|(load, part)| (part * of(load)).powi(2)).sum();
        squares.sqrt()
    }

    /// Sum of part times relative error, for an error that all loads share.
    fn shared(&self, campaign: &Campaign<'_>, of: impl Fn(&HeardLoad<'_>) -> f64) -> f64 {
        campaign.loads.iter().zip(&self.parts_n_s2).map(|(load, part)| part * of(load)).sum()
    }
}

fn line(input: BudgetInput, unit: &'static str, value: f64, std_uncertainty: f64, sensitivity: f64) -> BudgetLine {
    BudgetLine {
        input,
        value,
        std_uncertainty,
        unit,
        sensitivity_n_s2_per_unit: sensitivity,
        contribution_n_s2: (sensitivity * std_uncertainty).abs(),
        share: 0.0,
        degrees_of_freedom: None,
    }
}

/// A line from its contribution; the sensitivity follows from it.
fn contributed(
    input: BudgetInput,
    unit: &'static str,
    value: f64,
    std_uncertainty: f64,
    contribution: f64,
) -> BudgetLine {
    let sensitivity = if std_uncertainty > 0.0 { contribution / std_uncertainty } else { 0.0 };
    line(input, unit, value, std_uncertainty, sensitivity)
}

fn of_forces(campaign: &Campaign<'_>, sensitivity: &Sensitivity) -> Vec<BudgetLine> {
    let mut lines = Vec::new();
    let weights = || {
        campaign.loads.iter().filter_map(|load| match load.load.force {
            Force::Weight { vehicle_mass_kg, mass_std_kg, gravity_m_s2, gravity_std_m_s2, .. } => {
                Some((vehicle_mass_kg, mass_std_kg, gravity_m_s2, gravity_std_m_s2))
            }
            Force::Thrust { .. } => None,
        })
    };
    if let Some((mass_kg, mass_std_kg, gravity_m_s2, gravity_std_m_s2)) = weights().next() {
        let per_kg = |load: &HeardLoad<'_>| load.load.force.mass_kg().map_or(0.0, f64::recip);
        let added = |load: &HeardLoad<'_>| if load.load.force.relative_std().own > 0.0 { per_kg(load) } else { 0.0 };
        lines.push(line(BudgetInput::VehicleMass, "kg", mass_kg, mass_std_kg, sensitivity.shared(campaign, per_kg)));
        let added_masses: Vec<f64> = campaign
            .loads
            .iter()
            .filter_map(|load| Some(load.load.force.mass_kg()? - mass_kg))
            .filter(|added_kg| *added_kg > 0.0)
            .collect();
        let added_kg = mean(&added_masses).unwrap_or(0.0);
        let independent = sensitivity.independent(campaign, added);
        lines.push(line(BudgetInput::AddedMass, "kg", added_kg, mass_std_kg, independent));
        lines.push(line(
            BudgetInput::Gravity,
            "m/s²",
            gravity_m_s2,
            gravity_std_m_s2,
            sensitivity.hover_n_s2 / gravity_m_s2,
        ));
    }
    let bench: Vec<&HeardLoad<'_>> = campaign.loads.iter().filter(|load| !load.is_hover()).collect();
    if !bench.is_empty() {
        let mean_n = mean(&bench.iter().map(|load| load.load.force.newtons()).collect::<Vec<_>>()).unwrap_or_default();
        let share = |load: &HeardLoad<'_>| if load.is_hover() { 0.0 } else { load.load.force.relative_std().own };
        let std_n = mean(&bench.iter().map(|load| share(load) * load.load.force.newtons()).collect::<Vec<_>>());
        let contribution = sensitivity.independent(campaign, share);
        lines.push(contributed(BudgetInput::Thrust, "N", mean_n, std_n.unwrap_or_default(), contribution));
    }
    lines
}

fn of_speeds(campaign: &Campaign<'_>, sensitivity: &Sensitivity, settings: &ThrustSettings) -> Vec<BudgetLine> {
    let rad_s = sensitivity.mean_speed_rad_s;
    let per_rad_s = -2.0 * sensitivity.constant_n_s2 / rad_s;
    let freedom = campaign.speed_freedom;
    // a mean of few trials is more uncertain than its standard error
    let few = campaign.student_factor();
    let statistics = few
        * 2.0
        * sensitivity.independent(campaign, |load| {
            (load.speed_std_share.powi(2) - load.estimator_std_share.powi(2)).max(0.0).sqrt()
        });
    let estimator = few * 2.0 * sensitivity.independent(campaign, |load| load.estimator_std_share);
    let speed = |input, contribution: f64| BudgetLine {
        degrees_of_freedom: Some(freedom),
        ..line(input, "rad/s", rad_s, contribution / per_rad_s.abs(), per_rad_s)
    };
    let clock_std_rad_s = rad_s * settings.clock_ppm / 1e6 / 3f64.sqrt();
    // the sound may tell that the rotors differ by more than it is assumed where nothing is known
    let assumed = if settings.follows_loudest { loudest_std_share(campaign, &settings.uncertainty) } else { 0.0 };
    let loudest = settings.unresolved_std_share.max(assumed);
    let several = |load: &HeardLoad<'_>| if load.load.rotors_running > 1 { 1.0 } else { 0.0 };
    vec![
        speed(BudgetInput::SpeedStatistics, statistics),
        speed(BudgetInput::SpeedEstimator, estimator),
        line(BudgetInput::RecorderClock, "rad/s", 0.0, clock_std_rad_s, per_rad_s),
        line(BudgetInput::LoudestRotor, "1", 0.0, loudest, 2.0 * sensitivity.shared(campaign, several)),
    ]
}

/// Standard deviation of the difference between the loudest rotor and the mean of all, as a share. It is the same rotor at all loads.
fn loudest_std_share(campaign: &Campaign<'_>, inputs: &UncertaintyInputs) -> f64 {
    let rotors = campaign.loads.iter().map(|load| load.load.rotors_running).max().unwrap_or(1);
    inputs.loudest_std_share(rotors)
}

fn of_flight(campaign: &Campaign<'_>, sensitivity: &Sensitivity, settings: &ThrustSettings) -> Vec<BudgetLine> {
    let inputs = &settings.uncertainty;
    let hovers: Vec<&HeardLoad<'_>> = campaign.loads.iter().filter(|load| load.is_hover()).collect();
    let Some(gravity_m_s2) = hovers.iter().find_map(|load| match load.load.force {
        Force::Weight { gravity_m_s2, .. } => Some(gravity_m_s2),
        Force::Thrust { .. } => None,
    }) else {
        return Vec::new();
    };
    let of_hover = sensitivity.hover_n_s2;
    let trial_s = mean(&hovers.iter().filter_map(|load| load.trial_s()).collect::<Vec<_>>());
    let acceleration = trial_s.filter(|s| *s > 0.0).map_or(0.0, |s| inputs.climb_rate_m_s_max / s / 3f64.sqrt());
    // each trial drifts independently; the drift is uniform within its limits, hence the 3
    let trials = hovers.iter().map(|load| load.trials_rad_s.len()).sum::<usize>() as f64;
    let drift =
        trial_s.filter(|s| *s > 0.0).map_or(0.0, |s| inputs.drift_m_max / (s * SOUND_M_S) / (3.0 * trials).sqrt());
    let tilt = (inputs.tilt_deg_max.to_radians().cos().recip() - 1.0) / 3f64.sqrt();
    let radius_m = settings.propeller_diameter_m.map_or(inputs.rotor_radius_m, |diameter_m| diameter_m / 2.0);
    // T/T∞ = 1/(1 − (R/4z)²) for one rotor (Cheeseman and Bennett 1955). The whole effect counts as one standard uncertainty, since
    // the effect of several rotors is larger.
    let ground = (radius_m / (4.0 * inputs.hover_height_m)).powi(2);
    vec![
        line(BudgetInput::Scale, "1", 0.0, inputs.scale_share_max / 3f64.sqrt(), of_hover),
        line(BudgetInput::VerticalAcceleration, "m/s²", 0.0, acceleration, of_hover / gravity_m_s2),
        line(BudgetInput::Drift, "1", 0.0, drift, -2.0 * of_hover),
        line(BudgetInput::Tilt, "1", 0.0, tilt, of_hover),
        line(BudgetInput::GroundEffect, "1", 0.0, ground, -of_hover),
        line(BudgetInput::Downwash, "1", 0.0, inputs.downwash_share_max / 3f64.sqrt(), of_hover),
    ]
}

/// The scatter of the loads beyond their stated uncertainties, where they disagree or state none.
fn of_scatter(fit: &SquareLawFit, campaign: &Campaign<'_>) -> Option<BudgetLine> {
    let compared = fit.points.iter().filter(|point| !point.is_gross).count();
    let (extra, freedom) = match fit.agreement {
        Some(LawAgreement { chi_square, degrees_of_freedom, .. }) => {
            let factor = covering_factor(Agreement { chi_square, degrees_of_freedom }, campaign.noise)?;
            (fit.own_std_n_s2 * (factor.powi(2) - 1.0).max(0.0).sqrt(), degrees_of_freedom)
        }
        // unless the loads were the repeated observations, so that their scatter is that of the speeds
        None if compared > 1 && matches!(fit.noise, PointNoise::FromResiduals | PointNoise::FromShares) => {
            (fit.thrust_constant_n_s2.std_uncertainty?, compared - 1)
        }
        _ => return None,
    };
    (extra > 0.0).then(|| BudgetLine {
        degrees_of_freedom: Some(freedom as f64),
        ..line(BudgetInput::LoadScatter, "N s²", fit.thrust_constant_n_s2.value, extra, 1.0)
    })
}
