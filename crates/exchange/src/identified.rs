//! From `results.json` to the numbers for simulators.

use hovertone_vehicle::{GRAVITY_STANDARD_M_S2, QuantityError, check_positive};
use serde::Deserialize;
use serde_json::Value;
use serde_json::error::Category;

/// A rotor with its measured thrust constant, and its vehicle.
#[derive(Clone, Debug, PartialEq)]
pub struct IdentifiedRotor {
    /// Name of the vehicle.
    pub vehicle_name: String,
    /// Constant of one rotor.
    pub thrust_constant_n_s2: f64,
    /// Expanded uncertainty (k = 2) of the constant; absent where it is unknown.
    pub expanded_uncertainty_n_s2: Option<f64>,
    /// Standard uncertainty of the constant of the whole vehicle from weighing and speeds alone.
    pub measured_std_total_n_s2: Option<f64>,
    /// Standard deviation of the difference between the mean of all rotors and the heard speeds, as a share.
    pub rotors_std_share: f64,
    /// Number of rotors of the vehicle.
    pub rotor_count: u32,
    /// Mass of the vehicle without added load; absent after bench runs only.
    pub mass_kg: Option<f64>,
    /// Shaft speed in hover with that mass.
    pub hover_speed_rad_s: Option<f64>,
    /// Gravity at the place of the flights.
    pub gravity_m_s2: f64,
    /// Diameter of the propellers.
    pub propeller_diameter_m: Option<f64>,
    /// Density of the air.
    pub air_density_kg_m3: Option<f64>,
    /// Torque of one rotor over its squared speed, where it was measured. Sound does not contain it.
    pub torque_constant_n_m_s2: Option<f64>,
    /// Command (0 to 1) in hover, where it was recorded.
    pub hover_command: Option<f64>,
    /// The tone behind the speeds.
    pub tone: Option<HeardTone>,
    /// Name of the method of the speeds.
    pub method: Option<String>,
    /// Standard deviation of the speed from trial to trial, as a share.
    pub trial_std_share: Option<f64>,
    /// Whether a warning says not to use the constant.
    pub forbids_use: bool,
    /// Warnings about the constant.
    pub doubts: Vec<Doubt>,
    /// Hashes of the recordings behind the constant.
    pub recordings_sha256: Vec<String>,
    /// Correction of the clock of their recorder, in millionths.
    pub clock_correction_ppm: f64,
    /// Source of the numbers, for a comment.
    pub origin: String,
}

/// A warning of results.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Doubt {
    /// The problem.
    pub text: String,
    /// The advice; empty without one.
    pub hint: String,
}

impl Doubt {
    /// From a line of results: `text (hint: advice)`.
    fn from_line(line: &str) -> Self {
        let parts = line.strip_suffix(')').and_then(|line| line.rsplit_once(" (hint: "));
        let (text, hint) = parts.unwrap_or((line, ""));
        Self { text: text.to_owned(), hint: hint.to_owned() }
    }
}

/// The tone of a rotor, with all settings that are needed to find it again.
#[derive(Clone, Copy, Debug, PartialEq, Deserialize)]
pub struct HeardTone {
    /// Lines per turn of the shaft.
    pub order: f64,
    /// Number of harmonics with a ridge.
    pub harmonics: u32,
    /// Blades of the rotor, where known.
    pub blades: Option<u32>,
    /// Half width of a band around a found tone, as a share of its centre.
    pub band_half_width_share: f64,
    /// Slowest shaft speed of the search.
    pub speed_rad_s_min: f64,
    /// Fastest shaft speed of the search.
    pub speed_rad_s_max: f64,
}

impl IdentifiedRotor {
    /// Torque over thrust, in metres: momentConstant of Gazebo.
    pub fn moment_constant_m(&self) -> Option<f64> {
        Some(self.torque_constant_n_m_s2? / self.thrust_constant_n_s2)
    }

    /// Shaft speed at which all rotors carry this mass.
    pub fn hover_speed_by_balance_rad_s(&self) -> Option<f64> {
        let weight_n = self.mass_kg? * self.gravity_m_s2;
        Some((weight_n / (f64::from(self.rotor_count) * self.thrust_constant_n_s2)).sqrt())
    }
}

/// Error in a results file.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum ResultsError {
    /// Not JSON.
    #[error("this file is no results.json, because {}", json_fault(.0))]
    NotJson(#[from] serde_json::Error),
    /// JSON without the fields of a result.
    #[error("this file is no results.json of `hovertone identify`, because {what} is missing in it")]
    Missing {
        /// The missing field.
        what: &'static str,
    },
    /// Several groups, and none is chosen.
    #[error("these results have several groups: {names}")]
    SeveralGroups {
        /// Their names.
        names: String,
    },
    /// No group of this name.
    #[error("these results have no group \"{name}\"; they have: {names}")]
    NoSuchGroup {
        /// The wanted name.
        name: String,
        /// The names.
        names: String,
    },
    /// A group is wanted, and there are none.
    #[error("these results have no groups, so there is no group \"{name}\"")]
    NoGroups {
        /// The wanted name.
        name: String,
    },
    /// The result has no constant.
    #[error("these results have no thrust constant, because no recording has a usable speed")]
    NothingIdentified,
    /// A number out of range.
    #[error(transparent)]
    Quantity(#[from] QuantityError),
}

/// Why a text is not the wanted JSON, without the words of the parser.
pub(crate) fn json_fault(error: &serde_json::Error) -> String {
    match (error.classify(), error.line(), error.column()) {
        (Category::Eof, 1, 0) => "the file is empty".to_owned(),
        (Category::Eof, line, _) => format!("the file ends too early, in line {line}"),
        (Category::Data, ..) => "a value in it is missing, or is of the wrong type".to_owned(),
        (_, line, column) => format!("it is not valid JSON: line {line}, column {column} is wrong"),
    }
}

#[derive(Deserialize)]
struct Constant {
    value: f64,
    std_uncertainty: Option<f64>,
}

/// Term of the budget for rotors that were not separated.
fn rotors_std_share(results: &Value) -> f64 {
    let lines = results.pointer("/uncertainty_budget/lines").and_then(Value::as_array);
    let line = lines.into_iter().flatten().find(|line| line["input"] == "loudest_rotor");
    line.and_then(|line| line["std_uncertainty"].as_f64()).filter(|share| share.is_finite()).unwrap_or(0.0)
}

/// Name of a group of a table: its words, or else the name of its file.
fn name_of_group(results: &Value) -> Option<&str> {
    let text = |field: &str| results.get(field).and_then(Value::as_str).filter(|name| !name.is_empty());
    text("group").or(text("file"))
}

/// The results of the group with this name; without a name the only results.
fn one_of(document: Value, group: Option<&str>) -> Result<Value, ResultsError> {
    let all = match document.get("groups").and_then(Value::as_array) {
        Some(groups) if groups.is_empty() => return Err(ResultsError::Missing { what: "a group" }),
        Some(groups) => groups.clone(),
        None if group.is_some() && name_of_group(&document).is_none() => {
            return Err(ResultsError::NoGroups { name: group.unwrap_or_default().to_owned() });
        }
        None => vec![document],
    };
    let names =
        || all.iter().filter_map(name_of_group).map(|name| format!("\"{name}\"")).collect::<Vec<_>>().join(", ");
    let named: Vec<&Value> =
        all.iter().filter(|results| group.is_none_or(|group| name_of_group(results) == Some(group))).collect();
    match (named.as_slice(), group) {
        ([one], _) => Ok((*one).clone()),
        ([], Some(name)) => Err(ResultsError::NoSuchGroup { name: name.to_owned(), names: names() }),
        _ => Err(ResultsError::SeveralGroups { names: names() }),
    }
}

/// Reads `results.json`, or the output of `hovertone fit --json`, of which `group` chooses one of several groups.
///
/// # Errors
/// Not JSON, no results of hovertone, no such group, no constant, a number out of range.
pub fn identified_from_results(text: &str, group: Option<&str>) -> Result<IdentifiedRotor, ResultsError> {
    let results = one_of(serde_json::from_str(text)?, group)?;
    let constant = results
        .get("thrust_constant_per_rotor_n_s2")
        .ok_or(ResultsError::Missing { what: "thrust_constant_per_rotor_n_s2" })?;
    let constant: Option<Constant> = serde_json::from_value(constant.clone())?;
    let constant = constant.ok_or(ResultsError::NothingIdentified)?;
    check_positive("thrust_constant_per_rotor_n_s2", constant.value)?;
    let number_at = |pointer: &str| results.pointer(pointer).and_then(Value::as_f64);
    // the fields of `identify`, or else of `fit`
    let rotor_count = results.pointer("/settings/experiment/rotor_count").or_else(|| results.get("rotor_count"));
    let rotor_count = rotor_count.and_then(Value::as_u64).and_then(|count| u32::try_from(count).ok());
    let rotor_count = rotor_count.ok_or(ResultsError::Missing { what: "the number of rotors" })?;
    check_positive("rotor_count", f64::from(rotor_count))?;
    let budgeted = number_at("/uncertainty_budget/expanded_uncertainty_n_s2");
    let hover = results.pointer("/settings/experiment").and_then(|experiment| unladen_hover(&results, experiment));
    let text = |pointer: &str| results.pointer(pointer).and_then(Value::as_str);
    let file = text("/settings/file").or(text("/file")).unwrap_or("?");
    let sha256 = text("/settings/sha256").or(text("/sha256")).unwrap_or("?");
    // older results have no such field
    let forbids_use = results.get("forbids_use").and_then(Value::as_bool).unwrap_or(false);
    Ok(IdentifiedRotor {
        vehicle_name: text("/settings/experiment/vehicle_name")
            .or(text("/group").filter(|group| !group.is_empty()))
            .unwrap_or("a rotor on a thrust stand")
            .to_owned(),
        thrust_constant_n_s2: constant.value,
        expanded_uncertainty_n_s2: budgeted
            .map(|total| total / f64::from(rotor_count))
            .or(constant.std_uncertainty.map(|std| 2.0 * std)),
        // the first version of the file had no such field: there the uncertainty of the constant was that of weighing and speeds
        measured_std_total_n_s2: match results.get("measured_std_total_n_s2") {
            Some(measured) => measured.as_f64(),
            None => constant.std_uncertainty.map(|std| std * f64::from(rotor_count)),
        },
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
        forbids_use,
        doubts: doubts(&results),
        recordings_sha256: recordings_sha256(&results),
        clock_correction_ppm: number_at("/settings/experiment/clock_correction_ppm").unwrap_or(0.0),
        origin: format!(
            "{}computed by hovertone {} from {file} (its checksum, SHA-256, starts with {}){}",
            if forbids_use { "DO NOT USE THIS CONSTANT, its warnings say why: " } else { "" },
            text("/version").unwrap_or("?"),
            sha256.chars().take(12).collect::<String>(),
            text("/method").map_or(String::new(), |method| format!(", method: {}", method_in_words(method, &results)))
        ) + &doubts(&results).iter().map(|doubt| format!("; warning: {}", doubt.text)).collect::<String>(),
    })
}

/// The warnings of `identify`, or the notices of `fit`.
fn doubts(results: &Value) -> Vec<Doubt> {
    let lines = results.get("warnings").or_else(|| results.get("notices")).and_then(Value::as_array);
    lines.into_iter().flatten().filter_map(Value::as_str).map(Doubt::from_line).collect()
}

fn recordings_sha256(results: &Value) -> Vec<String> {
    let inputs = results.get("inputs").and_then(Value::as_array).into_iter().flatten();
    inputs.filter_map(|input| Some(input.pointer("/recording/sha256")?.as_str()?.to_owned())).collect()
}

/// The method, and in how many recordings the rotors were heard in which way, where several were sought: "rotors separated in 9 recordings,
/// only partly separated in 2, heard as a group in 6".
fn method_in_words(method: &str, results: &Value) -> String {
    let count = |way: &str| results.pointer(&format!("/rotors_heard/{way}")).and_then(Value::as_u64).unwrap_or(0);
    // older results have no such field
    let partly = results.get("partly_separated").and_then(Value::as_u64).unwrap_or(0).min(count("separated"));
    let ways = [
        (count("separated") - partly, "separated"),
        (partly, "only partly separated"),
        (count("group"), "heard as a group"),
        (count("one_tone"), "heard as one tone"),
    ];
    let mut heard = ways.into_iter().filter(|(count, _)| *count > 0);
    let first = heard.next().filter(|_| method == "separated");
    let Some((count, way)) = first else { return method.to_owned() };
    let noun = if count == 1 { "recording" } else { "recordings" };
    heard.fold(format!("rotors {way} in {count} {noun}"), |text, (count, way)| format!("{text}, {way} in {count}"))
}

#[derive(Clone, Copy)]
struct UnladenHover {
    mass_kg: f64,
    gravity_m_s2: f64,
    speed_rad_s: Option<f64>,
}

/// Mass and speed of the load without added mass.
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

/// From the standard uncertainty of the mean speed of a load to the standard deviation of a trial. The scatter is pooled over the loads,
/// so the first load is enough. One trial in all shows no scatter.
fn trial_std_share(results: &Value) -> Option<f64> {
    let number = |load: &Value, name: &str| load.get(name).and_then(Value::as_f64);
    let loads = results.get("loads")?.as_array()?;
    let trials: f64 = loads.iter().filter_map(|load| number(load, "trial_count")).sum();
    loads.iter().filter(|_| trials > 1.0).find_map(|load| {
        let share = number(load, "std_uncertainty_rad_s")? / number(load, "speed_rad_s")?;
        Some(share * number(load, "trial_count")?.sqrt()).filter(|share| share.is_finite())
    })
}

#[cfg(test)]
mod tests {
    use super::method_in_words;
    use serde_json::json;

    #[test]
    fn rotors_that_are_partly_separated_are_told_apart_from_those_that_all_are() {
        let told = |separated: u64, partly: u64| {
            let heard = json!({"separated": separated, "group": 1, "one_tone": 0});
            method_in_words("separated", &json!({"rotors_heard": heard, "partly_separated": partly}))
        };
        assert_eq!(told(3, 0), "rotors separated in 3 recordings, heard as a group in 1");
        assert_eq!(told(3, 2), "rotors separated in 1 recording, only partly separated in 2, heard as a group in 1");
        assert_eq!(told(2, 2), "rotors only partly separated in 2 recordings, heard as a group in 1");
    }
}
