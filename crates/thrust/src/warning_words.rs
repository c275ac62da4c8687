//! The words of the warnings, with their numbers and names.

use crate::drift::{Drift, DriftKind};
use crate::square_law::LoadRange;
use crate::statistics::{COVERAGE_FACTOR, p_value_text};
use crate::warning::ThrustWarning;
use std::fmt;

impl fmt::Display for ThrustWarning {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::LoadDoesNotFit { name, is_row, mass_that_fits_kg, mass_that_fits_std_kg, is_left_out } => {
                f.write_str(&misfit_text(name, *is_row, mass_that_fits_kg.map(|mass_kg| (mass_kg, *mass_that_fits_std_kg))))?;
                if *is_left_out { f.write_str("; it is left out: its constant is more than twice, or less than half, the constant of the \
                others") } else { Ok(()) }
            }
            Self::LoadsDisagree { names, are_rows, .. } => {
                let noun = if *are_rows { "rows" } else { "loads" };
                write!(f, "the {noun} do not fit each other: {}", first_names(names))
            }
            Self::TrialFarFromOthers { load, recording, thrust_share } => {
                let than = if *thrust_share > 0.0 { "more" } else { "less" };
                let percent = 100.0 * thrust_share.abs();
                write!(f, "the rotor speed in {recording} means {percent:.0} % {than} thrust than in the other recordings of load \"{load}\"")
            }
            Self::TrialsInGroups { load, groups_rev_s } => {
                write!(f, "the recordings of load \"{load}\" form {}", groups_text(groups_rev_s))
            }
            Self::ConstantsDiffer { least, most, share, stated_share } => {
                f.write_str(&differ_text([least, most], *share, *stated_share))
            }
            Self::TrialsDiffer { load, least, most, thrust_share } => {
                write!(f, "the rotor speeds mean {:.0} % more thrust in {most} than in {least}, but both are of load \"{load}\"", 100.0 * thrust_share)
            }
            Self::HeavierTurnedSlower { heavy, light } => {
                write!(f, "the rotors turned slower under the heavier load \"{heavy}\" than under the lighter \"{light}\"")
            }
            Self::MassFarFromKnown { load, mass_kg, known_kg } => write!(
                f,
                "load \"{load}\" weighs {}, {} times as much as the named vehicle ({})",
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
                "the constants C_f form two groups that differ by a factor of two or more, and nothing shows which group is right",
            ),
            Self::MixedBenchAndHover => f.write_str("bench runs and hovers are fitted together"),
            Self::SingleLoad => f.write_str("only one load can be used, so the law cannot be tested"),
            Self::OneRecordingEach { load_count: 1 } => {
                f.write_str("only one recording can be used, so the ± does not include how much the speed differs from flight to flight")
            }
            Self::OneRecordingEach { .. } => f.write_str(
                "each load has one recording, so the law cannot be tested; the ± comes from the scatter of the loads",
            ),
            Self::EqualLoads { count } => write!(f, "all {count} loads have the same force, or nearly so"),
            Self::NarrowLoadRange(range) => f.write_str(&range_text(range)),
            Self::OtherLawPreferred { law, probability } => {
                write!(f, "the law {} fits the forces better than F = C_f ω²: its probability is {:.1} %", law.formula(), 100.0 * probability)
            }
            Self::ConstantDrifts(drift) => f.write_str(&drift_text(drift)),
            Self::ImplausibleThrustCoefficient { propeller } => {
                write!(f, "the thrust coefficient C_T = T/(ρ n² D⁴) is {}, and no propeller has that", short_text(*propeller, 3))
            }
            Self::ImplausibleFigureOfMerit { name, figure_of_merit } => {
                write!(f, "the figure of merit (ideal power over measured power) is {} (\"{name}\"), and no rotor has that", short_text(*figure_of_merit, 3))
            }
            Self::UncertaintiesIncomplete { stated, of } => {
                write!(f, "only {stated} of {of} rows have an uncertainty above 0: the ± comes from the scatter of all rows")
            }
            Self::MassNotWeighed { mass_kg } => {
                write!(f, "the mass of the vehicle, {:.1} g, comes from a preset or a model: this vehicle was not weighed", 1e3 * mass_kg)
            }
            Self::LoudestRotor => f.write_str("the rotors could not be separated: one tone is used for all, from the loudest rotor or from \
            several"),
            Self::TooUncertain { share, .. } => {
                write!(f, "the ± of C_f is larger than C_f itself: it is {:.0} % (k = {COVERAGE_FACTOR})", 100.0 * share)
            }
        }
    }
}

/// Most names in the list of a warning. *Decision.*
pub(crate) const NAMES_MAX: usize = 5;

/// Numbers from this on are written with an exponent. *Decision.*
const LARGE: f64 = 1e9;

/// Ratios of masses within this factor about ten are called a shifted decimal point: loads differ from the bare vehicle. *Decision.*
const POINT_MARGIN: f64 = 1.5;

/// Two loads whose constants differ by a share, of which the stated uncertainties of their forces explain another.
pub(crate) fn differ_text([least, most]: [&String; 2], share: f64, stated_share: f64) -> String {
    let words = format!(
        "the constant of load \"{most}\" is {:.0} % larger than the constant of load \"{least}\"",
        100.0 * share
    );
    match 100.0 * stated_share {
        small if small < 0.5 => words,
        percent => {
            format!(
                "{words}; the stated uncertainties of the forces (k = {COVERAGE_FACTOR}) explain a difference of only \
                {percent:.0} %"
            )
        }
    }
}

pub(crate) fn drift_text(drift: &Drift) -> String {
    let step = match drift.kind {
        DriftKind::PerTrial => "from one recording to the next",
        DriftKind::PerSecond => "with each second of a recording",
        DriftKind::PerRow => "from row to row of the table",
        DriftKind::PerVolt => "with each volt of the supply",
    };
    let percent = 100.0 * drift.constant_share;
    // two digits of a small drift, which would else be printed as zero
    let decimals = (1.0 - percent.abs().log10().floor()).clamp(3.0, 9.0) as usize;
    let percent = format!("{percent:+.decimals$}").replace('-', "−");
    format!(
        "the constant drifts by {percent} % {step} (chance of this without a true drift: {})",
        p_value_text(drift.p_value)
    )
}

pub(crate) fn range_text(range: &LoadRange) -> String {
    let Some(needed) = range.force_ratio_needed else {
        return "the forces and speeds are too uncertain to test F = C_f ω²: they scatter too much, or their stated uncertainties are too large".to_owned();
    };
    let [ratio, needed] = compared([range.force_ratio, needed]);
    format!(
        "the forces are too alike to test F = C_f ω²: the largest is {ratio} times the smallest, but must be {needed} \
        times the smallest or more"
    )
}

/// Two different ratios with two decimals, or with as many as show that they differ.
pub fn compared(ratios: [f64; 2]) -> [String; 2] {
    let printed = |decimals: usize| ratios.map(|ratio| short_text(ratio, decimals));
    (2..=6).map(printed).find(|[one, other]| one != other).unwrap_or_else(|| printed(2))
}

/// A number with its decimals; a large one with an exponent.
pub(crate) fn short_text(value: f64, decimals: usize) -> String {
    if value >= LARGE { format!("{value:.1e}") } else { format!("{value:.decimals$}") }
}

/// The first names of a list.
pub(crate) fn first_names(names: &[String]) -> String {
    let more = if names.len() > NAMES_MAX { ", …" } else { "" };
    names.iter().take(NAMES_MAX).map(String::as_str).collect::<Vec<_>>().join(", ") + more
}

/// A mass in grams.
pub(crate) fn mass_text(mass_kg: f64) -> String {
    let grams = 1e3 * mass_kg;
    if grams < 100.0 { format!("{grams:.1} g") } else { format!("{grams:.0} g") }
}

/// A ratio with two digits.
pub(crate) fn ratio_text(ratio: f64) -> String {
    let decimals = (1.0 - ratio.log10().floor()).clamp(0.0, 3.0) as usize;
    format!("{ratio:.decimals$}")
}

/// Whether a ratio of masses is about ten, or a tenth.
pub(crate) fn is_shifted_point(ratio: f64) -> bool {
    let near_ten = 10.0 / POINT_MARGIN..=10.0 * POINT_MARGIN;
    near_ten.contains(&ratio) || near_ten.contains(&ratio.recip())
}

/// A load or a row that does not fit the others, with the mass that would, and its standard uncertainty where known.
pub(crate) fn misfit_text(name: &str, is_row: bool, mass_that_fits_kg: Option<(f64, Option<f64>)>) -> String {
    let of = if is_row { format!("{name} of the table") } else { format!("load \"{name}\"") };
    let would = match mass_that_fits_kg {
        Some((mass_kg, Some(std_kg))) => {
            format!("; a mass of {:.1} g ± {:.1} g would fit", 1e3 * mass_kg, 1e3 * COVERAGE_FACTOR * std_kg)
        }
        Some((mass_kg, None)) => format!("; a mass of {:.1} g would fit", 1e3 * mass_kg),
        None => String::new(),
    };
    format!("{of} does not fit the others{would}")
}

/// Groups of speeds, by their means.
pub(crate) fn groups_text(groups_rev_s: &[f64]) -> String {
    let speeds: Vec<String> = groups_rev_s.iter().map(|rev_s| format!("{rev_s:.1}")).collect();
    format!("{} groups of speeds: {} rev/s", speeds.len(), speeds.join(", "))
}

/// A vehicle that does not fit the sound of most recordings.
pub(crate) fn foreign_text(hardly_heard: usize, elsewhere: usize, of: usize) -> String {
    let recordings = if of == 1 { String::new() } else { format!(" of {of} recordings") };
    let in_recordings = |count: usize| if of == 1 { String::new() } else { format!(" in {count}{recordings}") };
    let hardly = format!("its tone is hardly heard{}", in_recordings(hardly_heard));
    let other = format!("another rotor is heard{}", in_recordings(elsewhere));
    let why = match (hardly_heard, elsewhere) {
        (0, _) => other,
        (_, 0) => hardly,
        _ => format!("{hardly}, and {other}"),
    };
    format!("the vehicle does not fit the sound: {why}")
}
