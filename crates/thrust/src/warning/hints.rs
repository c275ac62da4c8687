//! The advice of each warning.

use super::ThrustWarning;
use crate::drift::{Drift, DriftKind};
use crate::square_law::LoadRange;
use crate::warning_words::is_shifted_point;

impl ThrustWarning {
    /// Advice to the user.
    pub fn hint(&self) -> &'static str {
        match self {
            Self::LoadDoesNotFit { is_row, mass_that_fits_kg, is_left_out, .. } => {
                misfit_hint(*is_row, mass_that_fits_kg.is_some(), *is_left_out)
            }
            Self::LoadsDisagree { are_rows: true, .. } => "check the units, the zero of the scale and the propellers",
            Self::LoadsDisagree { has_added_mass, names, .. } => disagree_hint(*has_added_mass, names.len()),
            Self::HeavierTurnedSlower { .. } => {
                "do not use this constant: check whether two masses are exchanged, and which recording belongs to which load"
            }
            Self::TrialsInGroups { .. } => {
                "if the recordings were flown with different masses, give each mass a [[load]] of its own"
            }
            Self::ConstantsDiffer { .. } => {
                "do not use this constant: check masses, units and tone of both loads, and which recording belongs to which load"
            }
            Self::TrialFarFromOthers { .. } | Self::TrialsDiffer { .. } => {
                "check that each recording is under the right [[load]]; if so, run `hovertone speed` on each of them: its warnings say which speed is doubtful"
            }
            Self::MassFarFromKnown { mass_kg, known_kg, .. } if is_shifted_point(mass_kg / known_kg) => {
                "do not use this constant: check the decimal point and the unit of this mass; a load needs its mass as flown, vehicle and added mass together; check the name of the vehicle too"
            }
            Self::MassFarFromKnown { .. } => {
                "check the mass, its unit and the name of the vehicle: 1 % of error in the mass is 1 % in C_f"
            }
            Self::VehicleDoesNotFit { .. } => {
                "do not use this constant: check the vehicle, its blades and its gear; if they are right, record again with the microphone nearer"
            }
            Self::RowsDoNotFit { .. } => {
                "look for a mistake in these rows: a rotor whose speed still changed, a scale that does not show 0 without thrust, another unit or another propeller"
            }
            Self::TrialLeftOut { .. } => {
                "check this recording with `hovertone speed`: the tone may come from another harmonic or another machine"
            }
            Self::ConstantsSplit => {
                "do not use this constant: check the masses or forces, their units, the number of rotors and the speeds (a wrong number of blades or a wrong gear changes them), then measure one more load or table row"
            }
            Self::MixedBenchAndHover => {
                "at the same speed, a rotor has another thrust on a bench than in flight: put bench runs and hovers into two experiment files"
            }
            Self::SingleLoad => "measure a second load",
            Self::OneRecordingEach { .. } => "record each load five times, if possible, and land in between",
            Self::EqualLoads { .. } => {
                "measure masses or thrusts that differ as much as is safe: equal ones cannot test the law"
            }
            Self::NarrowLoadRange(LoadRange { force_ratio_needed: None, .. }) => {
                "check the masses or thrusts, the uncertainties that you stated, and which recording belongs to which load"
            }
            Self::NarrowLoadRange(_) => {
                "C_f is still valid near these forces; to test the law, measure a wider range of forces; `hovertone fit --plan` plans such hovers"
            }
            Self::OtherLawPreferred { .. } => "simulators use F = C_f ω²: use C_f only near the measured speeds",
            Self::ConstantDrifts(Drift { kind: DriftKind::PerRow | DriftKind::PerVolt, .. }) => {
                "neither time nor voltage changes the thrust at a given speed, so it is the stand that drifts: zero it between runs, let it warm up, and measure in a random sequence"
            }
            Self::ConstantDrifts(_) => {
                "fly all loads at the same height and place, in a random sequence, and each with an equally full battery"
            }
            Self::ImplausibleThrustCoefficient { .. } => {
                "propellers have 0.03 to 0.25: check the diameter, the number of rotors, and the number of blades or the gear"
            }
            Self::ImplausibleFigureOfMerit { .. } => {
                "rotors have 0.05 to 0.85: check the power (of all running rotors together), its unit, and the diameter"
            }
            Self::UncertaintiesIncomplete { .. } => "give an uncertainty in every row, or in none",
            Self::MassNotWeighed { .. } => {
                "weigh the vehicle ready to fly, and write mass_kg under [vehicle]: 1 % of error in the mass is 1 % in C_f, and the ± does not include it"
            }
            Self::TooUncertain { is_of_rows: true, .. } => {
                "do not use this constant: check the speeds, the forces, their units and the uncertainties that you stated, and measure more rows"
            }
            Self::TooUncertain { .. } => {
                "do not use this constant: check the masses and which recording belongs to which load, then record each load five times"
            }
            Self::LoudestRotor => {
                "with rotor speeds 1 to 2 % apart, C_f can be off by 2 to 4 %, and the ± includes this error; to separate the rotors, place the microphone nearer (the methods maximum_trace and gaussian never separate them)"
            }
        }
    }
}

/// What to check where one load or row does not fit the others.
fn misfit_hint(is_row: bool, has_mass: bool, is_left_out: bool) -> &'static str {
    match (is_row, is_left_out, has_mass) {
        (true, ..) => "check the unit, the zero of the scale and the propeller of this row",
        (false, true, _) => "check the mass of this load, its unit and recordings",
        (false, false, true) => "weigh that load again, and check that it does not block the air of the rotors",
        (false, false, false) => "check the thrust and the recordings of that load",
    }
}

/// What to check where loads do not fit each other. Two whose masses are exchanged turn slower under the heavier one, which has its own warning.
fn disagree_hint(has_added_mass: bool, loads: usize) -> &'static str {
    match (has_added_mass, loads) {
        (true, 2) => {
            "weigh both again, and check which recording belongs to which load; added_mass_kg must not include the mass of the vehicle"
        }
        (false, 2) => "weigh both again, and check which recording belongs to which load",
        (true, _) => {
            "check whether two masses are exchanged, and which recording belongs to which load; added_mass_kg must not include the \
             mass of the vehicle"
        }
        (false, _) => "check whether two masses are exchanged, and which recording belongs to which load",
    }
}
