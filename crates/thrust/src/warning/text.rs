//! What each warning says.

use super::ThrustWarning;
use crate::warning_words::{
    RangeDoubt, differ_text, drift_text, either_mass_text, first_names, foreign_text, groups_text, incomplete_text,
    mass_text, misfit_text, probability_text, range_text, ratio_text, short_text,
};
use hovertone_vehicle::COVERAGE_FACTOR;
use std::fmt;

impl fmt::Display for ThrustWarning {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::LoadDoesNotFit { name, is_row, mass_that_fits_kg, mass_that_fits_std_kg, is_left_out } => {
                let that_fits = mass_that_fits_kg.map(|mass_kg| (mass_kg, *mass_that_fits_std_kg));
                f.write_str(&misfit_text(name, *is_row, that_fits, *is_left_out))
            }
            Self::LoadsDisagree { names, are_rows, masses_that_fit_kg, .. } => {
                let rows_or_loads = if *are_rows {
                    "no single C_f in F = C_f ω² fits these rows"
                } else {
                    "the loads do not fit each other"
                };
                write!(f, "{rows_or_loads}: {}{}", first_names(names), either_mass_text(names, masses_that_fit_kg))
            }
            Self::TrialFarFromOthers { load, recording, thrust_share } => {
                let than = if *thrust_share > 0.0 { "more" } else { "less" };
                let percent = 100.0 * thrust_share.abs();
                write!(f, "by its rotor speed, {recording} has {percent:.0} % {than} thrust than the other recordings of load \"{load}\"")
            }
            Self::TrialsInGroups { load, groups_rev_s } => {
                write!(f, "the recordings of load \"{load}\" form {}", groups_text(groups_rev_s))
            }
            Self::ConstantsDiffer { least, most, share, stated_share } => {
                f.write_str(&differ_text([least, most], *share, *stated_share))
            }
            Self::TrialsDiffer { load, least, most, thrust_share } => {
                write!(f, "by the rotor speeds, {most} has {:.0} % more thrust than {least}, but both are of load \"{load}\"", 100.0 * thrust_share)
            }
            Self::HeavierTurnedSlower { heavy, light } => {
                write!(f, "the rotors turned slower under the heavier load \"{heavy}\" than under the lighter \"{light}\"")
            }
            Self::MassFarFromKnown { load, mass_kg, known_kg } => write!(
                f,
                "load \"{load}\" weighs {}, {} times the mass of the vehicle ({})",
                mass_text(*mass_kg),
                ratio_text(mass_kg / known_kg),
                mass_text(*known_kg)
            ),
            Self::VehicleDoesNotFit { hardly_heard, elsewhere, of } => {
                f.write_str(&foreign_text(*hardly_heard, *elsewhere, *of))
            }
            Self::RowsDoNotFit { names, are_left_out } => {
                write!(f, "{} rows do not fit the others: {}", names.len(), first_names(names))?;
                if *are_left_out { f.write_str("; they are left out: their constants are more than twice, or less than half, the constant of \
                the others") } else { f.write_str("; the fit uses them too") }
            }
            Self::TrialLeftOut { load, recording } => {
                write!(f, "{recording} of load \"{load}\" is left out: its constant is more than twice, or less than half, the constant of \
                the other recordings")
            }
            Self::ConstantsSplit => f.write_str(
                "the loads or rows form two groups: C_f of one group is twice C_f of the other, or more, and nothing shows which group is right",
            ),
            Self::MixedBenchAndHover => f.write_str("bench runs and hovers are fitted together"),
            Self::SingleLoad => f.write_str("there is only one load with a speed, so the law cannot be tested"),
            Self::OneRecordingEach { load_count } => f.write_str(one_each_text(*load_count)),
            Self::EqualLoads { count: 2 } => f.write_str("both loads have the same force, or nearly so"),
            Self::EqualLoads { count } => write!(f, "all {count} loads have the same force, or nearly so"),
            Self::NarrowLoadRange(range) => f.write_str(&range_text(range, RangeDoubt::Speeds)),
            Self::OtherLawPreferred { law, probability } => {
                write!(f, "the law {} fits the forces better than F = C_f ω² (probability of this law: {})", law.formula(), probability_text(*probability))
            }
            Self::ConstantDrifts(drift) => f.write_str(&drift_text(drift)),
            Self::ImplausibleThrustCoefficient { propeller } => {
                write!(f, "the thrust coefficient C_T = F/(ρ n² D⁴) is {}, and no propeller has that", short_text(*propeller, 3))
            }
            Self::ImplausibleFigureOfMerit { name, figure_of_merit } => {
                write!(f, "the figure of merit (ideal power over measured power) is {} (\"{name}\"), and no rotor has that", short_text(*figure_of_merit, 3))
            }
            Self::UncertaintiesIncomplete { stated, of } => f.write_str(&incomplete_text(*stated, *of)),
            Self::MassNotWeighed { mass_kg } => {
                write!(f, "the mass of the vehicle, {:.1} g, comes from a preset or a model: this vehicle was not weighed", 1e3 * mass_kg)
            }
            Self::LoudestRotor => f.write_str("the rotors were not separated: one tone is used for all, and it may come from the loudest rotor alone"),
            Self::TooUncertain { share, .. } => {
                write!(f, "the ± of C_f is larger than C_f itself: it is {:.0} % (k = {COVERAGE_FACTOR})", 100.0 * share)
            }
        }
    }
}

fn one_each_text(load_count: usize) -> &'static str {
    match load_count {
        1 => {
            "only one recording can be used, so the ± does not include how much the speed differs from flight to flight"
        }
        _ => {
            "each load has one recording, so the law cannot be tested; the ± comes from the differences between the loads, and is large, because the loads are few"
        }
    }
}
