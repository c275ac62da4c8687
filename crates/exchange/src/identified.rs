//! `results.json` → what simulators want to know.

use crate::units::GRAVITY_STANDARD_M_S2;
use serde::Deserialize;
use serde_json::Value;

/// A rotor whose thrust constant was identified, and the vehicle that it lifts.
#[derive(Clone, Debug, PartialEq)]
pub struct IdentifiedRotor {
    /// What flew.
    pub vehicle_name: String,
    /// Constant of one rotor.
    pub thrust_constant_n_s2: f64,
    /// Its expanded uncertainty, k = 2; absent where nothing tells.
    pub expanded_uncertainty_n_s2: Option<f64>,
    /// Constant of the whole vehicle by weighing and speeds alone: its standard uncertainty.
    pub measured_std_total_n_s2: Option<f64>,
    /// How far the mean of all rotors may be from the speeds that were heard, as a share.
    pub rotors_std_share: f64,
    /// Rotors of the vehicle.
    pub rotor_count: u32,
    /// Mass of the vehicle without added load; absent where only bench runs were heard.
    pub mass_kg: Option<f64>,
    /// Shaft speed at which it was heard to hover with that mass.
    pub hover_speed_rad_s: Option<f64>,
    /// Gravity where it flew.
    pub gravity_m_s2: f64,
    /// Diameter of the propellers.
    pub propeller_diameter_m: Option<f64>,
    /// Density of the air.
    pub air_density_kg_m3: Option<f64>,
    /// Torque of one rotor over its squared speed, where somebody measured it: sound does not tell.
    pub torque_constant_n_m_s2: Option<f64>,
    /// Command (0 to 1) at which it hovers, where somebody read it.
    pub hover_command: Option<f64>,
    /// The tone by which it was heard.
    pub tone: Option<HeardTone>,
    /// Name of the method by which its speeds were read.
    pub method: Option<String>,
    /// Scatter of the speed from one trial to another, as a share.
    pub trial_std_share: Option<f64>,
    /// Where the numbers come from, for a comment.
    pub origin: String,
}

/// The tone by which a rotor was heard: what it takes to hear it again in the same way.
#[derive(Clone, Copy, Debug, PartialEq, Deserialize)]
pub struct HeardTone {
    /// Lines per turn of the shaft.
    pub order: f64,
    /// How many harmonics had a ridge.
    pub harmonics: u32,
    /// Blades of the rotor, where they were known.
    pub blades: Option<u32>,
    /// Half width of a found band as a share of its middle.
    pub band_half_width_share: f64,
    /// Slowest shaft that was looked for.
    pub speed_rad_s_min: f64,
    /// Fastest shaft that was looked for.
    pub speed_rad_s_max: f64,
}

impl IdentifiedRotor {
    /// Torque over thrust, in metres: what Gazebo calls momentConstant.
    pub fn moment_constant_m(&self) -> Option<f64> {
        Some(self.torque_constant_n_m_s2? / self.thrust_constant_n_s2)
    }

    /// Shaft speed at which this constant carries this mass.
    pub fn hover_speed_by_balance_rad_s(&self) -> Option<f64> {
        let weight_n = self.mass_kg? * self.gravity_m_s2;
        Some((weight_n / (f64::from(self.rotor_count) * self.thrust_constant_n_s2)).sqrt())
    }
}

/// Why a file is no results of hovertone.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum ResultsError {
    /// No JSON.
    #[error("this is no results.json: {0}")]
    NotJson(#[from] serde_json::Error),
    /// JSON of something else.
    #[error("this is no results.json of `hovertone identify`: {what} is missing")]
    Missing {
        /// What.
        what: &'static str,
    },
    /// Nothing was identified.
    #[error("nothing was identified in these results: no recording had a rotor tone")]
    NothingIdentified,
    /// A number that no rotor has.
    #[error("{name} = {value} in these results, it must be a number above 0")]
    OutOfRange {
        /// Which.
        name: &'static str,
        /// What stands there.
        value: f64,
    },
}

#[derive(Deserialize)]
struct Constant {
    value: f64,
    std_uncertainty: Option<f64>,
}

/// What the budget says of rotors that were not all told apart.
fn rotors_std_share(results: &Value) -> f64 {
    let lines = results.pointer("/uncertainty_budget/lines").and_then(Value::as_array);
    let line = lines.into_iter().flatten().find(|line| line["input"] == "loudest_rotor");
    line.and_then(|line| line["std_uncertainty"].as_f64()).filter(|share| share.is_finite()).unwrap_or(0.0)
}

/// Reads `results.json`.
///
/// # Errors
/// Not JSON, not hovertone's, nothing identified, numbers that mean nothing.
pub fn identified_from_results(text: &str) -> Result<IdentifiedRotor, ResultsError> {
    let results: Value = serde_json::from_str(text)?;
    let constant = results
        .get("thrust_constant_per_rotor_n_s2")
        .ok_or(ResultsError::Missing { what: "thrust_constant_per_rotor_n_s2" })?;
    let constant: Option<Constant> = serde_json::from_value(constant.clone())?;
    let constant = constant.ok_or(ResultsError::NothingIdentified)?;
    positive("thrust_constant_per_rotor_n_s2", constant.value)?;
    let number_at = |pointer: &str| results.pointer(pointer).and_then(Value::as_f64);
    // of `identify`, or of `fit`
    let rotor_count = results.pointer("/settings/experiment/rotor_count").or_else(|| results.get("rotor_count"));
    let rotor_count = rotor_count.and_then(Value::as_u64).and_then(|count| u32::try_from(count).ok());
    let rotor_count = rotor_count.ok_or(ResultsError::Missing { what: "the number of rotors" })?;
    positive("rotor_count", f64::from(rotor_count))?;
    let budgeted = number_at("/uncertainty_budget/expanded_uncertainty_n_s2");
    let hover = results.pointer("/settings/experiment").and_then(|experiment| unladen_hover(&results, experiment));
    let text = |pointer: &str| results.pointer(pointer).and_then(Value::as_str);
    let file = text("/settings/file").or(text("/file")).unwrap_or("?");
    let sha256 = text("/settings/sha256").or(text("/sha256")).unwrap_or("?");
    Ok(IdentifiedRotor {
        vehicle_name: text("/settings/experiment/vehicle_name")
            .or(text("/group").filter(|group| !group.is_empty()))
            .unwrap_or("a rotor on a thrust stand")
            .to_owned(),
        thrust_constant_n_s2: constant.value,
        expanded_uncertainty_n_s2: budgeted
            .map(|total| total / f64::from(rotor_count))
            .or(constant.std_uncertainty.map(|std| 2.0 * std)),
        measured_std_total_n_s2: constant.std_uncertainty.map(|std| std * f64::from(rotor_count)),
        rotors_std_share: rotors_std_share(&results),
        rotor_count,
        mass_kg: hover.map(|hover| hover.mass_kg),
        hover_speed_rad_s: hover.and_then(|hover| hover.speed_rad_s),
        gravity_m_s2: hover.map_or(GRAVITY_STANDARD_M_S2, |hover| hover.gravity_m_s2),
        propeller_diameter_m: number_at("/settings/experiment/propeller_diameter_m")
            .or(number_at("/propeller_diameter_m")),
        air_density_kg_m3: number_at("/thrust_coefficients/density_kg_m3"),
        torque_constant_n_m_s2: number_at("/torque_constant_per_rotor_n_m_s2"),
        hover_command: None,
        tone: results.pointer("/settings/experiment/config/tone").and_then(|tone| HeardTone::deserialize(tone).ok()),
        method: text("/method").map(str::to_owned),
        trial_std_share: trial_std_share(&results),
        origin: format!(
            "hovertone {} from {file} (sha256 {}){}",
            text("/version").unwrap_or("?"),
            sha256.chars().take(12).collect::<String>(),
            text("/method").map_or(String::new(), |method| format!(", method {method}"))
        ),
    })
}

fn positive(name: &'static str, value: f64) -> Result<(), ResultsError> {
    if value.is_finite() && value > 0.0 { Ok(()) } else { Err(ResultsError::OutOfRange { name, value }) }
}

#[derive(Clone, Copy)]
struct UnladenHover {
    mass_kg: f64,
    gravity_m_s2: f64,
    speed_rad_s: Option<f64>,
}

/// The vehicle by itself, and the speed of the load that adds nothing.
fn unladen_hover(results: &Value, experiment: &Value) -> Option<UnladenHover> {
    let loads = experiment.get("loads")?.as_array()?;
    let hovers = || loads.iter().filter_map(|load| Some((load.get("name")?, load.get("force")?)));
    let of = |force: &Value, name: &str| force.get(name).and_then(Value::as_f64);
    let (_, force) = hovers().find(|(_, force)| of(force, "vehicle_mass_kg").is_some())?;
    let unladen = hovers().find(|(_, force)| of(force, "added_mass_kg") == Some(0.0)).map(|(name, _)| name);
    let speed = results.get("loads")?.as_array()?.iter().find(|load| load.get("name") == unladen);
    Some(UnladenHover {
        mass_kg: of(force, "vehicle_mass_kg")?,
        gravity_m_s2: of(force, "gravity_m_s2")?,
        speed_rad_s: speed.and_then(|load| load.get("speed_rad_s")?.as_f64()),
    })
}

/// From the standard uncertainty of a load's mean speed to that of a trial: the scatter is pooled, so the first load tells.
fn trial_std_share(results: &Value) -> Option<f64> {
    let number = |load: &Value, name: &str| load.get(name).and_then(Value::as_f64);
    results.get("loads")?.as_array()?.iter().find_map(|load| {
        let share = number(load, "std_uncertainty_rad_s")? / number(load, "speed_rad_s")?;
        Some(share * number(load, "trial_count")?.sqrt()).filter(|share| share.is_finite())
    })
}
