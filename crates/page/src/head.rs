//! The head of a warning: its beginning, on one line of a screen. The whole warning stands where the line leads to.

use hovertone_figures::{beginning, shortened, without_advice};

/// Most letters of a line: as many as the answer is wide on a screen of 1200 px.
pub(crate) const LETTERS_MAX: usize = 100;
/// Most letters of a name in a line.
const NAME_LETTERS_MAX: usize = 28;

/// A text on a line that begins and ends with other words: names in quotation marks and long words are shortened; then the advice, and at
/// last the end of the sentence, are left out where there is no room.
pub(crate) fn head_of(before: &str, text: &str, after: &str) -> String {
    let (before, text) = (with_short_names(before), with_short_names(text));
    let room = LETTERS_MAX.saturating_sub(before.chars().count() + after.chars().count());
    let head = if text.chars().count() <= room { text } else { beginning(without_advice(&text), room) };
    format!("{before}{head}{after}")
}

/// The text with its names shortened: what stands in quotation marks, and long words.
fn with_short_names(text: &str) -> String {
    let short = |name: &str| shortened(name, NAME_LETTERS_MAX);
    let quoted = |(index, part): (usize, &str)| {
        let words = || part.split(' ').map(short).collect::<Vec<_>>().join(" ");
        if index % 2 == 1 { short(part) } else { words() }
    };
    text.split('"').enumerate().map(quoted).collect::<Vec<_>>().join("\"")
}

#[cfg(test)]
mod tests {
    use super::*;
    use hovertone_thrust::{Drift, DriftKind, ForceLaw, LoadRange, ThrustWarning};

    /// Every warning about the constant, as long as its numbers and names can make it.
    fn longest_warnings() -> Vec<ThrustWarning> {
        let name = || "load with a very long name ".repeat(5);
        let recording = || format!("{}.wav", "recording_of_a_long_day_".repeat(5));
        let names = || vec![name(); 9];
        let range = LoadRange {
            force_ratio: 1.000_001,
            intercept_std_share: 0.5,
            shows_intercept: false,
            force_ratio_needed: Some(1.000_002),
        };
        let drift = |kind: DriftKind| {
            ThrustWarning::ConstantDrifts(Drift {
                kind,
                constant_share: -1.23e-8,
                std_uncertainty_share: 1e-9,
                p_value: 1e-9,
            })
        };
        let does_not_fit = |is_row: bool, mass: Option<f64>| ThrustWarning::LoadDoesNotFit {
            name: name(),
            is_row,
            mass_that_fits_kg: mass,
            mass_that_fits_std_kg: mass,
            is_left_out: true,
        };
        vec![
            does_not_fit(true, None),
            does_not_fit(false, Some(12_345.678)),
            ThrustWarning::LoadsDisagree {
                names: names(),
                are_rows: false,
                has_added_mass: true,
                masses_that_fit_kg: vec![12_345.678; 2],
            },
            ThrustWarning::TrialFarFromOthers { load: name(), recording: recording(), thrust_share: -123.0 },
            ThrustWarning::TrialsInGroups { load: name(), groups_rev_s: vec![123.4; 4] },
            ThrustWarning::ConstantsDiffer { least: name(), most: name(), share: 123.0, stated_share: 12.3 },
            ThrustWarning::TrialsDiffer { load: name(), least: recording(), most: recording(), thrust_share: 123.0 },
            ThrustWarning::HeavierTurnedSlower { heavy: name(), light: name() },
            ThrustWarning::MassFarFromKnown { load: name(), mass_kg: 12_345.678, known_kg: 0.001 },
            ThrustWarning::VehicleDoesNotFit { hardly_heard: 12_345, elsewhere: 12_345, of: 12_345 },
            ThrustWarning::RowsDoNotFit { names: names(), are_left_out: true },
            ThrustWarning::TrialLeftOut { load: name(), recording: recording() },
            ThrustWarning::ConstantsSplit,
            ThrustWarning::MixedBenchAndHover,
            ThrustWarning::SingleLoad,
            ThrustWarning::OneRecordingEach { load_count: 1 },
            ThrustWarning::OneRecordingEach { load_count: 123 },
            ThrustWarning::EqualLoads { count: 12_345 },
            ThrustWarning::NarrowLoadRange(range),
            ThrustWarning::NarrowLoadRange(LoadRange { force_ratio_needed: None, ..range }),
            ThrustWarning::OtherLawPreferred { law: ForceLaw::SquareWithIntercept, probability: 0.999 },
            drift(DriftKind::PerRow),
            drift(DriftKind::PerVolt),
            ThrustWarning::ImplausibleThrustCoefficient { propeller: 12_345.0 },
            ThrustWarning::ImplausibleFigureOfMerit { name: name(), figure_of_merit: 12_345.0 },
            ThrustWarning::UncertaintiesIncomplete { stated: 12_345, of: 12_345 },
            ThrustWarning::MassNotWeighed { mass_kg: 12_345.0 },
            ThrustWarning::LoudestRotor,
        ]
    }

    #[test]
    fn the_longest_warnings_are_heads_of_one_line() {
        let mut cut = 0;
        for warning in longest_warnings() {
            let text = warning.to_string();
            let head = head_of("", &text, "");
            assert!(head.chars().count() <= LETTERS_MAX, "{head}");
            // enough of it stays to tell the warnings apart
            assert!(head.chars().count() >= text.chars().count().min(30), "{head}");
            cut += usize::from(head != text);
        }
        assert!(cut >= 10, "only {cut} warnings were longer than a line");
    }

    #[test]
    fn names_are_shortened_before_words_are_left_out() {
        let recording = format!("{}.wav", "recording_of_a_long_day_".repeat(5));
        let text = format!("{recording} of load \"{}\" has 12 % more thrust than the others", "a long load ".repeat(9));
        let head = head_of("", &text, "");
        assert!(head.contains("long_day_.wav of load \"a long load"), "{head}");
        assert!(head.contains(" has 12 % more"), "{head}");
        let reason = "several rotor speeds explain this sound, and the vehicle could fly at more than one of them; check the diameter";
        let head = head_of("load 1 · trial_1.wav: ", reason, " (in 3 of 4 recordings)");
        assert!(head.ends_with("… (in 3 of 4 recordings)") && !head.contains("check"), "{head}");
        assert_eq!(head_of("a: ", "short; do it", ""), "a: short; do it");
    }
}
