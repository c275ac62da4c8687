//! Before the flights: how many loads, trials and seconds a wanted uncertainty needs. Each candidate plan is a synthetic campaign with
//! the expected scatter, fitted like a real one, so that plan and budget always agree.

use crate::budget::BudgetInput;
use crate::fit::thrust_from_loads;
use crate::force::Force;
use crate::settings::ThrustSettings;
use crate::speeds::{LoadSpeeds, SampleSpeed, TrialSpeeds};
use crate::square_law::force_ratio_for_intercept;
use hovertone_analysis::{Method, Span};
use hovertone_vehicle::{
    MASS_FACTOR_MAX, QuantityError, RotorSpeed, check_diameter, check_not_negative, check_positive, is_swamped,
};
use serde::Serialize;

/// Numbers of loads that are tried. From three loads on, one that does not fit can be named. *Numeric.*
const LOADS: [usize; 4] = [3, 4, 5, 8];
/// Numbers of trials per load that are tried. Three trials are the fewest that show their scatter. *Numeric.*
const TRIALS: [usize; 6] = [3, 4, 5, 8, 12, 20];
/// Lengths of a hover that are tried, s. *Numeric.*
const SECONDS: [f64; 5] = [5.0, 10.0, 20.0, 30.0, 60.0];
/// Time of a flight beside the hover, s: take-off, landing and the change of the load. *Decision.*
const OVERHEAD_S: f64 = 20.0;
/// Longest correlation of a speed, s: that of the longest hover. *Decision.*
const CORRELATION_S_MAX: f64 = 60.0;
/// Largest wanted uncertainty and largest spread of a speed, as shares. Above it a percentage was meant. *Decision.*
pub const PLAN_SHARE_MAX: f64 = 0.5;
/// Speed of the synthetic campaign without added mass, rad/s. Only relative speeds matter. *Numeric.*
const SPEED_RAD_S: f64 = 400.0;

/// The wanted uncertainty, and the vehicle and place of the flights.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct PlanWish {
    /// Wanted expanded uncertainty (k = 2) of the constant, as a share.
    pub wanted_share: f64,
    /// Mass of the vehicle.
    pub vehicle_mass_kg: f64,
    /// Largest added mass.
    pub added_mass_kg_max: f64,
    /// Standard uncertainty of a weighing.
    pub mass_std_kg: f64,
    /// Gravity at the place of the flights.
    pub gravity_m_s2: f64,
    /// Its standard uncertainty.
    pub gravity_std_m_s2: f64,
    /// Relative standard deviation σ of the speed in a hover (in the paper's tables STD over speed is 0.0123) …
    pub speed_spread_share: f64,
    /// … and its correlation time τ.
    pub correlation_time_s: f64,
    /// All other settings of the constant.
    pub settings: ThrustSettings,
}

/// A plan that reaches the wanted uncertainty.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct FlightPlan {
    /// Loads, evenly spaced from none to the largest.
    pub load_count: usize,
    /// Trials of each load.
    pub trials_per_load: usize,
    /// Seconds of hover in each trial.
    pub trial_s: f64,
    /// Seconds of hover in all.
    pub hover_s: f64,
    /// Expected expanded uncertainty (k = 2), as a share.
    pub expanded_share: f64,
    /// The input with the largest share of the variance.
    pub largest: BudgetInput,
    /// Ratio of the largest to the smallest weight that would show an intercept, with the same number of trials; absent where no
    /// ratio would.
    pub force_ratio_for_intercept: Option<f64>,
}

/// Why there is no plan.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum PlanError {
    /// A mass or a share out of range.
    #[error(transparent)]
    Quantity(#[from] QuantityError),
    /// No number of flights reaches the wanted uncertainty.
    #[error(
        "with any number of flights, the ± of C_f stays above {:.2} % (k = 2); its largest part comes from: {}",
        100.0 * .best_share, .largest.title()
    )]
    OutOfReach {
        /// The smallest expanded uncertainty that can be reached.
        best_share: f64,
        /// Its largest input.
        largest: BudgetInput,
    },
}

/// The plan that reaches the wanted uncertainty in the shortest time.
///
/// # Errors
/// Numbers out of range, or an uncertainty that no number of flights reaches.
pub fn flight_plan(wish: &PlanWish) -> Result<FlightPlan, PlanError> {
    for (name, value) in [
        ("wanted_share", wish.wanted_share),
        ("mass_kg", wish.vehicle_mass_kg),
        ("added_mass_kg", wish.added_mass_kg_max),
        ("gravity_m_s2", wish.gravity_m_s2),
        ("speed_spread_share", wish.speed_spread_share),
        ("correlation_s", wish.correlation_time_s),
    ] {
        check_positive(name, value)?;
    }
    for (name, value) in [("mass_std_kg", wish.mass_std_kg), ("gravity_std_m_s2", wish.gravity_std_m_s2)] {
        check_not_negative(name, value)?;
    }
    if wish.correlation_time_s > CORRELATION_S_MAX {
        let (name, value) = ("correlation_s", wish.correlation_time_s);
        return Err(QuantityError { name, value, must_be: "at most 60, the length of the longest hover" }.into());
    }
    for (name, value) in [("wanted_share", wish.wanted_share), ("speed_spread_share", wish.speed_spread_share)] {
        if value > PLAN_SHARE_MAX {
            return Err(QuantityError { name, value, must_be: "a share of at most 0.5: 2 % are 0.02" }.into());
        }
    }
    if wish.added_mass_kg_max > MASS_FACTOR_MAX * wish.vehicle_mass_kg {
        let (name, value) = ("added_mass_kg", wish.added_mass_kg_max);
        let must_be =
            "at most ten times the mass of the vehicle; masses are in kilograms, or with a unit: 31 g are 0.031 or 31g";
        return Err(QuantityError { name, value, must_be }.into());
    }
    if is_swamped(wish.vehicle_mass_kg, wish.mass_std_kg) {
        let (name, value) = ("mass_std_kg", wish.mass_std_kg);
        return Err(QuantityError { name, value, must_be: "at most half of the mass of the vehicle" }.into());
    }
    let diameter_m = wish.settings.propeller_diameter_m;
    diameter_m.map_or(Ok(()), |diameter_m| check_diameter("diameter_m", diameter_m))?;
    let mut plans: Vec<FlightPlan> = Vec::new();
    for load_count in LOADS {
        for trials_per_load in TRIALS {
            plans.extend(SECONDS.iter().filter_map(|&trial_s| expected(wish, load_count, trials_per_load, trial_s)));
        }
    }
    let cost_s = |plan: &FlightPlan| plan.hover_s + OVERHEAD_S * (plan.load_count * plan.trials_per_load) as f64;
    let good = plans.iter().filter(|plan| plan.expanded_share <= wish.wanted_share);
    match good.min_by(|a, b| cost_s(a).total_cmp(&cost_s(b))) {
        Some(plan) => Ok(*plan),
        None => {
            let best = plans.iter().min_by(|a, b| a.expanded_share.total_cmp(&b.expanded_share));
            let must_be = "larger: no plan can be computed for it";
            let nothing = QuantityError { name: "wanted_share", value: wish.wanted_share, must_be }.into();
            Err(best.map_or(nothing, |best| PlanError::OutOfReach {
                best_share: best.expanded_share,
                largest: best.largest,
            }))
        }
    }
}

/// Standard uncertainty of the mean speed of a trial of length T, as a share: σ √(2 τ/T), at most σ.
fn trial_std_share(wish: &PlanWish, trial_s: f64) -> f64 {
    wish.speed_spread_share * (2.0 * wish.correlation_time_s / trial_s).sqrt().min(1.0)
}

/// The plan with its expected uncertainty; `None` where the synthetic campaign has no fit.
fn expected(wish: &PlanWish, load_count: usize, trials_per_load: usize, trial_s: f64) -> Option<FlightPlan> {
    let std_share = trial_std_share(wish, trial_s);
    // evenly spaced speeds whose standard deviation is exactly `std_share`
    let middle = (trials_per_load as f64 - 1.0) / 2.0;
    let squares: f64 = (0..trials_per_load).map(|trial| (trial as f64 - middle).powi(2)).sum();
    let unit = std_share * ((trials_per_load as f64 - 1.0) / squares).sqrt();
    let loads: Vec<LoadSpeeds> = (0..load_count)
        .map(|load| {
            let added_mass_kg = wish.added_mass_kg_max * load as f64 / (load_count as f64 - 1.0);
            let mass_kg = wish.vehicle_mass_kg + added_mass_kg;
            let rad_s = SPEED_RAD_S * (mass_kg / wish.vehicle_mass_kg).sqrt();
            let trial = |trial: usize| TrialSpeeds {
                recording: String::new(),
                hover_s: trial_s,
                hover: None,
                samples: vec![SampleSpeed {
                    span: Span { from_s: 0.0, to_s: trial_s },
                    speed: RotorSpeed::from_rad_s(rad_s * (1.0 + unit * (trial as f64 - middle))),
                    std_uncertainty_rev_s: None,
                    spread_rev_s: None,
                    frame_count: 1,
                }],
                rotors_heard: None,
            };
            LoadSpeeds {
                name: load.to_string(),
                force: Force::Weight {
                    vehicle_mass_kg: wish.vehicle_mass_kg,
                    added_mass_kg,
                    mass_std_kg: wish.mass_std_kg,
                    gravity_m_s2: wish.gravity_m_s2,
                    gravity_std_m_s2: wish.gravity_std_m_s2,
                },
                rotors_running: wish.settings.rotor_count,
                power_w: None,
                trials: (0..trials_per_load).map(trial).collect(),
            }
        })
        .collect();
    let budget = thrust_from_loads(&loads, Method::default(), &wish.settings).budget?;
    let largest = budget.lines.iter().max_by(|a, b| a.share.total_cmp(&b.share))?.input;
    let load_std_share =
        (2.0 * std_share / (trials_per_load as f64).sqrt()).hypot(wish.mass_std_kg / wish.vehicle_mass_kg);
    Some(FlightPlan {
        load_count,
        trials_per_load,
        trial_s,
        hover_s: (load_count * trials_per_load) as f64 * trial_s,
        expanded_share: budget.expanded_share,
        largest,
        force_ratio_for_intercept: force_ratio_for_intercept(load_std_share, load_count),
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn wish(wanted_share: f64) -> PlanWish {
        PlanWish {
            wanted_share,
            vehicle_mass_kg: 0.413,
            added_mass_kg_max: 0.1,
            mass_std_kg: 0.0005,
            gravity_m_s2: 9.785,
            gravity_std_m_s2: 0.0005,
            speed_spread_share: 0.0123,
            correlation_time_s: 0.3,
            settings: ThrustSettings { follows_loudest: false, ..ThrustSettings::for_rotors(4) },
        }
    }

    #[test]
    fn a_stricter_wish_needs_more_flying() {
        let plans = [0.01, 0.006, 0.0045].map(|share| flight_plan(&wish(share)).unwrap());
        assert!(plans[0].hover_s < plans[1].hover_s && plans[1].hover_s < plans[2].hover_s, "{plans:?}");
        assert!(plans.iter().zip([0.01, 0.006, 0.0045]).all(|(plan, share)| plan.expanded_share <= share));
        assert!(plans[2].force_ratio_for_intercept.unwrap() < plans[0].force_ratio_for_intercept.unwrap_or(11.0));
    }

    #[test]
    fn what_no_flying_reaches_says_what_is_in_the_way() {
        let ridge = PlanWish { settings: ThrustSettings::for_rotors(4), ..wish(0.01) };
        let Err(PlanError::OutOfReach { best_share, largest }) = flight_plan(&ridge) else { panic!("a plan") };
        assert_eq!(largest, BudgetInput::LoudestRotor);
        assert!((best_share - 0.02).abs() < 0.002, "{best_share}");
        assert!(matches!(flight_plan(&wish(0.0)), Err(PlanError::Quantity(_))));
        let refused = |wish: PlanWish| matches!(flight_plan(&wish), Err(PlanError::Quantity(_)));
        assert!(refused(PlanWish { vehicle_mass_kg: f64::NAN, ..wish(0.01) }));
        assert!(refused(PlanWish { mass_std_kg: f64::NAN, ..wish(0.01) }));
        assert!(refused(PlanWish { mass_std_kg: -0.1, ..wish(0.01) }));
        assert!(
            refused(PlanWish { mass_std_kg: 0.21, ..wish(0.01) })
                && !refused(PlanWish { mass_std_kg: 0.2, ..wish(0.01) })
        );
        assert!(refused(PlanWish { gravity_std_m_s2: f64::INFINITY, ..wish(0.01) }));
        let diameter = ThrustSettings { propeller_diameter_m: Some(254.0), ..wish(0.01).settings };
        assert!(refused(PlanWish { settings: diameter, ..wish(0.01) }));
    }
}
