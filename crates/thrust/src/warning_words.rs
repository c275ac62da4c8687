//! Numbers and names in the words of warnings.

use crate::drift::{Drift, DriftKind};
use crate::square_law::LoadRange;
use crate::statistics::p_value_text;
use hovertone_vehicle::COVERAGE_FACTOR;

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

/// What makes it uncertain whether forces of a range show the law.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum RangeDoubt {
    /// The uncertainties of the speeds, mostly.
    Speeds,
    /// The stated uncertainties of the forces, where the speeds have none.
    Forces,
    /// The scatter, where no uncertainty is stated.
    Scatter,
}

/// Why the law is not tested over a range of forces.
pub fn range_text(range: &LoadRange, doubt: RangeDoubt) -> String {
    let Some(needed) = range.force_ratio_needed else {
        let too_uncertain = match doubt {
            RangeDoubt::Speeds => "the forces and speeds are too uncertain",
            RangeDoubt::Forces => "the forces are too uncertain",
            RangeDoubt::Scatter => "the scatter of the rows is too large",
        };
        return format!("{too_uncertain} to test F = C_f ω²");
    };
    let [ratio, needed] = compared([range.force_ratio, needed]);
    let with = match doubt {
        RangeDoubt::Speeds => "with speeds as uncertain as these",
        RangeDoubt::Forces => "with forces as uncertain as these",
        RangeDoubt::Scatter => "with as much scatter as in these rows",
    };
    format!(
        "the forces are too alike to test F = C_f ω²: the largest is {ratio} times the smallest, but {with}, it must be \
        {needed} times or more"
    )
}

/// Rows of which only some have an uncertainty, or none.
pub(crate) fn incomplete_text(stated: usize, of: usize) -> String {
    let rows = match stated {
        0 => "no row has".to_owned(),
        1 => format!("only one of {of} rows has"),
        stated => format!("only {stated} of {of} rows have"),
    };
    format!("{rows} an uncertainty above 0: the ± comes from the scatter of all rows")
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

/// Of two loads that do not fit each other: the mass of either with which they would.
pub(crate) fn either_mass_text(names: &[String], masses_that_fit_kg: &[f64]) -> String {
    match (names, masses_that_fit_kg) {
        ([one, other], [of_one_kg, of_other_kg]) => format!(
            "; they would fit if \"{one}\" weighed {}, or if \"{other}\" weighed {}",
            mass_text(*of_one_kg),
            mass_text(*of_other_kg)
        ),
        _ => String::new(),
    }
}

/// From here on, a probability would be rounded to 100.0 %, which is no certainty. *Decision.*
const ROUNDED_TO_ONE: f64 = 0.9995;

/// A probability in percent.
pub(crate) fn probability_text(probability: f64) -> String {
    if probability < ROUNDED_TO_ONE { format!("{:.1} %", 100.0 * probability) } else { "above 99.9 %".to_owned() }
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
pub(crate) fn misfit_text(
    name: &str,
    is_row: bool,
    mass_that_fits_kg: Option<(f64, Option<f64>)>,
    is_left_out: bool,
) -> String {
    let of = if is_row { format!("{name} of the file") } else { format!("load \"{name}\"") };
    let would = match mass_that_fits_kg {
        Some((mass_kg, Some(std_kg))) => {
            format!("; a mass of {:.1} g ± {:.1} g would fit", 1e3 * mass_kg, 1e3 * COVERAGE_FACTOR * std_kg)
        }
        Some((mass_kg, None)) => format!("; a mass of {:.1} g would fit", 1e3 * mass_kg),
        None => String::new(),
    };
    let left_out = if is_left_out {
        "; it is left out: its constant is more than twice, or less than half, the constant of the others"
    } else {
        "; the fit still uses it"
    };
    format!("{of} does not fit the others{would}{left_out}")
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
