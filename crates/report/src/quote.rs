//! What a person quotes of an identified experiment: the constant with its ±, and the verdict on the loads.

use crate::number::{PowerOfTen, fixed, with_uncertainty};
use crate::thrust::{CONSTANT_UNIT, WITHOUT_FLIGHTS};
use hovertone_analysis::RotorsHeardCounts;
use hovertone_thrust::{ThrustTable, ThrustWarning, p_value_text};
use hovertone_vehicle::{COVERAGE_FACTOR, Estimate, Order};

/// Whether the loads agree with each other.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Verdict {
    /// Every load agrees with the others.
    Holds(String),
    /// Some loads do not.
    Fails(String),
    /// There is nothing to compare.
    Untested(String),
}

impl Verdict {
    /// The verdict on the loads of a table.
    pub fn of(table: &ThrustTable) -> Self {
        let misfits: Vec<&str> =
            table.loads.iter().filter(|load| load.fits == Some(false)).map(|load| load.name.as_str()).collect();
        let agreement = table.fit.as_ref().and_then(|fit| fit.agreement).map_or(String::new(), |agreement| {
            format!(
                " ({}: if all loads have the same C_f, chance alone makes differences this large, or larger, with this probability)",
                p_value_text(agreement.p_value)
            )
        });
        if let Some(foreign) = table.warnings.iter().find(|warning| warning.is_of_other_vehicle()) {
            return Self::Fails(foreign.to_string());
        }
        let is_exchange = |warning: &&ThrustWarning| matches!(warning, ThrustWarning::HeavierTurnedSlower { .. });
        if let Some(exchange) = table.warnings.iter().find(is_exchange) {
            return Self::Fails(format!("the loads contradict each other: {exchange}{agreement}"));
        }
        let heard = table.loads.iter().filter(|load| load.speed.is_some()).count();
        if !table.loads.iter().any(|load| load.fits.is_some()) {
            let differ = table.warnings.iter().find(|warning| {
                matches!(warning, ThrustWarning::ConstantsDiffer { .. } | ThrustWarning::ConstantsSplit)
            });
            if let Some(differ) = differ {
                return Self::Fails(format!("the loads do not fit each other: {differ}"));
            }
            let why = match heard {
                0 | 1 => "there is no second load with a speed to compare with",
                _ => {
                    "each load has only one recording, so nothing shows how much the speed differs from flight to flight"
                }
            };
            return Self::Untested(format!("whether the loads agree was not tested, because {why}"));
        }
        match misfits.as_slice() {
            [] => {
                let differ = table.warnings.iter().find(|it| matches!(it, ThrustWarning::TrialsDiffer { .. }));
                let but = differ.map_or(String::new(), |differ| format!("; but {differ}"));
                Self::Holds(format!("every load agrees with the others{agreement}{but}"))
            }
            all if all.len() > 1 && all.len() == heard => {
                Self::Fails(format!("the loads do not fit each other: {}{agreement}", all.join(", ")))
            }
            [one] => Self::Fails(format!("this load does not fit the others: {one}{agreement}")),
            several => Self::Fails(format!("these loads do not fit the others: {}{agreement}", several.join(", "))),
        }
    }

    /// The verdict in words.
    pub fn words(&self) -> &str {
        match self {
            Self::Holds(words) | Self::Fails(words) | Self::Untested(words) => words,
        }
    }
}

/// "C_f = (7.09 ± 0.03) 1e-6 N s² for one rotor, (2.836 ± 0.012) 1e-5 N s² for the whole vehicle; ± is 0.42 % (k = 2: about 95 of 100 true
/// values lie within it)"; `None` without a constant.
pub fn quoted_constants(table: &ThrustTable) -> Option<String> {
    let (total, per_rotor) = (table.thrust_constant_total_n_s2?, table.thrust_constant_per_rotor_n_s2?);
    let vehicle = match table.rotor_count {
        1 => String::new(),
        _ => format!(", {} for the whole vehicle", quoted(total)),
    };
    let share = total.std_uncertainty.map(|std| 100.0 * COVERAGE_FACTOR * std / total.value);
    let covers = if table.forbids_use() {
        ""
    } else if table.has_one_trial() {
        WITHOUT_FLIGHTS
    } else {
        ": about 95 of 100 true values lie within it"
    };
    let meaning = share.map_or("; ± is not known".to_owned(), |percent| {
        format!("; ± is {} % (k = {COVERAGE_FACTOR}{covers})", fixed(percent, percent_decimals(percent)))
    });
    Some(format!("C_f = {} for one rotor{vehicle}{meaning}", quoted(per_rotor)))
}

/// Decimals of an uncertainty in percent: two of a small one, none of one that tells hardly more than the size.
fn percent_decimals(percent: f64) -> usize {
    match percent {
        ..10.0 => 2,
        ..100.0 => 1,
        _ => 0,
    }
}

/// "(7.09 ± 0.03) 1e-6 N s²".
pub(crate) fn quoted(constant: Estimate) -> String {
    let unit = PowerOfTen::of([constant.value]);
    let digits = with_uncertainty(unit.scale(constant.value), constant.std_uncertainty.map(|std| unit.scale(std)));
    format!("({digits}) {}", unit.unit(CONSTANT_UNIT))
}

/// "rotors: separated in 9 recordings, heard as a group in 6 other recordings"; `None` where one tone is used for all. In `partly` of the
/// recordings with separated rotors, some could not be separated.
pub fn rotors_heard_text(counts: RotorsHeardCounts, partly: usize) -> Option<String> {
    if counts.separated + counts.group == 0 {
        return None;
    }
    let partly = partly.min(counts.separated);
    let whole = counts.separated - partly;
    let parts = [
        (whole, "separated"),
        (partly, "only some of them separated"),
        (counts.group, "heard as a group"),
        (counts.one_tone, "heard as one tone"),
    ];
    let parts: Vec<String> = parts
        .into_iter()
        .filter(|(count, _)| *count > 0)
        .enumerate()
        .map(|(at, (count, how))| {
            format!("{how} in {}", counted(count, if at == 0 { "recording" } else { "other recording" }))
        })
        .collect();
    Some(format!("rotors: {}", parts.join(", ")))
}

/// "tone at 2 times the rotor speed".
pub fn tone_of_order(order: Order) -> String {
    match order.lines_per_turn() {
        1.0 => "tone at the rotor speed".to_owned(),
        times => format!("tone at {times} times the rotor speed"),
    }
}

/// "1 load", "3 loads".
pub fn counted(count: usize, noun: &str) -> String {
    let ending = if count == 1 { "" } else { "s" };
    format!("{count} {noun}{ending}")
}
