//! Advice in the words of a command that has no flag for what the advice asks.

use hovertone_report::{LEAVE_MEAN_ONLY_OUT, LEAVE_METHOD_OUT, ONE_BAND_FOR_ALL, Wording};

/// Behind `identify --mass KG=FILES`: some facts have flags, others only a place in an experiment file.
pub(crate) const IN_PLACE_OF_FILE: Wording =
    Wording { has_loads: true, is_flight: true, ..Wording::of_phrases(IN_PLACE_OF_KEYS) };

const IN_PLACE_OF_KEYS: &[(&str, &str)] = &[
    (
        "--from and --to",
        "from_s and to_s: run this command with -o DIR, see in DIR/report.html when the tone is clear, write both times (in s) under the [[load]] of this recording in DIR/experiment.toml, and run `hovertone identify DIR/experiment.toml`",
    ),
    ("; to follow one rotor, give --band LOW:HIGH around its tone", ONE_BAND_FOR_ALL),
    (" alone, in place of the vehicle", " and --rotors N, in place of --vehicle"),
    ("the speed is the mean of", "C_f uses the mean speed of"),
    OTHER_ROTORS_IN_FLIGHT,
    ("under [samples] in the experiment file", "under [samples] in DIR/experiment.toml, which -o DIR writes"),
    ("--mass-kg", "--mass"),
    ("under the right [[load]]", "after the right --mass"),
    ("give each mass a [[load]] of its own", "give --mass once for each mass"),
    ("; added_mass_kg must not include the mass of the vehicle", ""),
];

/// In a hover, all rotors of the vehicle turn: no other number of them can be given.
const OTHER_ROTORS_IN_FLIGHT: (&str, &str) =
    ("if more rotors turn, give their number with --rotors; if not, ", "check the number of rotors; if it is right, ");

/// Behind `weigh`, which hears a vehicle in a hover.
pub(crate) const IN_HOVER: Wording = Wording {
    is_flight: true,
    ..Wording::of_phrases(&[
        ("the speed is the mean of", "the mass comes from the mean speed of"),
        (LEAVE_MEAN_ONLY_OUT, HEARD_AS_CONSTANT),
        (LEAVE_METHOD_OUT, HEARD_AS_CONSTANT),
        OTHER_ROTORS_IN_FLIGHT,
    ])
};

/// `weigh` hears by the method of the constant, and has no flag for another one.
const HEARD_AS_CONSTANT: &str = "you need to do nothing: the speeds behind the constant were heard in the same way";

/// Behind `verify`, which compares the speeds of each moment, without the speed of the recording: its table names what is compared.
pub(crate) const IN_VERIFY: Wording = Wording::of_phrases(&[
    ("the speed is the mean of all rotors, and its ± is larger, because they could not be separated; ", ""),
    ("the speed is the mean of all rotors, and its ± is larger, because some could not be separated; ", ""),
    (
        "the speed is the mean of the separated rotors, and its ± is larger, because the speeds of the others are not known; ",
        "",
    ),
    (
        "the speed is the mean of the rotors that are heard, and its ± is larger, because the speeds of the others are not known; ",
        "",
    ),
]);

#[cfg(test)]
mod tests {
    use super::*;
    use crate::args::Arguments;
    use clap::CommandFactory;
    use hovertone::speed::{NoTone, OtherRotor, Warning};

    /// Each advice about a recording that names a flag.
    fn advice() -> Vec<String> {
        let other = OtherRotor { blades: 3, speed_rev_s: 80.0 };
        let apart = Warning::RotorsNotApart { resolved: 0, of: 4, in_mean: 4, is_assumed: false, spread_share: 0.006 };
        let warnings = [
            Warning::RidgeOnBandEdge { harmonic: 1, frames_share: 0.5, band_hz_low: 140.0, band_hz_high: 165.0 },
            Warning::HarmonicLeftOut { harmonic: 1, reason: String::new() },
            Warning::FewHarmonicsAgree { used: 1, of: 3 },
            Warning::FewHarmonicsAgree { used: 2, of: 3 },
            Warning::HoversDiffer { slowest_rev_s: 80.0, fastest_rev_s: 90.0 },
            Warning::HoverShorterThanSample { hover_s: 1.0, length_s: 5.0 },
            Warning::ManyGaps { gap_share: 0.5, clear: None },
            Warning::FewFrames { frame_count: 3, sample_s: 0.2, needed_s: Some(0.8) },
            Warning::FewFrames { frame_count: 3, sample_s: 5.0, needed_s: None },
            apart,
            Warning::OtherRotorsHeard { expected: 1 },
            Warning::OtherRotorsHeard { expected: 3 },
            Warning::SeveralLines { spread_share: 0.02 },
        ];
        let reasons = [
            NoTone::OutsideRecording { end_s: 3.0 },
            NoTone::NoSeries { only_rev_s: None, instead: None },
            NoTone::NoSeries { only_rev_s: Some((13.0, 120.0)), instead: Some(other) },
            NoTone::NoSeries { only_rev_s: None, instead: Some(other) },
            NoTone::NoFrame { window_s: 0.1, hover_s: 3.0 },
            NoTone::NotHeld { tone_hz: 160.0, held_s: 1.0 },
        ];
        let of_records = [
            "give the band around the tone of the blades with --band LOW:HIGH; in flight, give the diameter of the \
            propellers (--diameter-m), the mass (--mass-kg)",
            "the number of rotors (--rotors)",
            "count the blades, and give --blades N too",
            "check the vehicle (--vehicle) and the number of blades (--blades)",
        ];
        let hints = warnings.iter().map(|warning| warning.hint().to_owned());
        hints.chain(reasons.iter().map(ToString::to_string)).chain(of_records.map(str::to_owned)).collect()
    }

    /// The flags in a text that a command does not have.
    fn unknown_flags(text: &str, command: &str) -> Vec<String> {
        let commands = Arguments::command();
        let command = commands.find_subcommand(command).unwrap();
        let is_known = |flag: &str| command.get_arguments().any(|known| known.get_long() == Some(flag));
        let words = text.split(|letter: char| !letter.is_ascii_alphanumeric() && letter != '-');
        words.filter_map(|word| word.strip_prefix("--")).filter(|flag| !is_known(flag)).map(str::to_owned).collect()
    }

    #[test]
    fn advice_names_only_what_the_command_has() {
        for (command, wording) in [("identify", IN_PLACE_OF_FILE), ("weigh", IN_HOVER), ("speed", Wording::default())] {
            for advice in advice() {
                let worded = wording.of(&advice);
                assert_eq!(unknown_flags(&worded, command), Vec::<String>::new(), "{command}: {worded}");
            }
        }
        assert!(advice().iter().any(|advice| !unknown_flags(advice, "identify").is_empty()));
    }

    /// A reader of `demo` wrote no experiment file and cannot move a microphone: the advice says first that the constant is right.
    #[test]
    fn in_an_experiment_the_constant_comes_first() {
        let apart = |in_mean: usize| Warning::RotorsNotApart {
            resolved: 0,
            of: 4,
            in_mean,
            is_assumed: false,
            spread_share: 0.006,
        };
        for (in_mean, begins) in [
            (4, "C_f uses the mean speed of all rotors, and its ± is larger, because they could not be separated; "),
            (0, "the ± of C_f includes this uncertainty; "),
        ] {
            let worded = Wording::IN_EXPERIMENT.of(apart(in_mean).hint());
            assert!(worded.starts_with(begins), "{worded}");
        }
        assert!(!Wording::IN_FLIGHT.of(apart(4).hint()).contains("on a bench"));
        let in_file = Wording::IN_EXPERIMENT.of(apart(4).hint());
        assert!(
            in_file.contains("on a bench, write rotors_running = N under the [[load]] of this recording"),
            "{in_file}"
        );
    }

    /// `verify` names in its table what it compares: the mean of all rotors, or each separated rotor.
    #[test]
    fn a_comparison_has_no_advice_about_the_speed_of_the_recording() {
        for (resolved, in_mean) in [(0, 4), (0, 3), (3, 3), (3, 4)] {
            let apart = Warning::RotorsNotApart { resolved, of: 4, in_mean, is_assumed: false, spread_share: 0.006 };
            let worded = IN_VERIFY.of(apart.hint());
            assert!(worded.starts_with("if fewer rotors turn, ") && !worded.contains("mean"), "{worded}");
        }
    }

    /// A known vehicle in a hover has its number of rotors: `--rotors` with another number is refused.
    #[test]
    fn no_other_number_of_rotors_is_asked_for_in_a_hover() {
        let apart = Warning::RotorsNotApart { resolved: 0, of: 4, in_mean: 4, is_assumed: false, spread_share: 0.006 };
        for warning in [apart, Warning::OtherRotorsHeard { expected: 4 }] {
            for wording in [IN_PLACE_OF_FILE, IN_HOVER] {
                let worded = wording.of(warning.hint());
                assert!(!worded.contains("--rotors") && !worded.contains("fewer"), "{worded}");
            }
            let in_file = Wording::IN_EXPERIMENT.of(warning.hint());
            assert!(!in_file.contains("rotors = N"), "{in_file}");
        }
    }

    /// The method is that of the constant.
    #[test]
    fn weigh_names_no_flag_of_a_method() {
        for advice in [LEAVE_MEAN_ONLY_OUT, LEAVE_METHOD_OUT] {
            assert_eq!(unknown_flags(advice, "speed"), Vec::<String>::new(), "{advice}");
            assert_eq!(IN_HOVER.of(advice), HEARD_AS_CONSTANT);
        }
    }

    #[test]
    fn an_experiment_file_has_a_key_for_each_advice() {
        for advice in advice() {
            let worded = Wording::IN_EXPERIMENT.of(&advice);
            assert!(!worded.contains("--"), "{worded}");
        }
        let blades = Wording::IN_EXPERIMENT.of("give --blades 3 alone, in place of the vehicle");
        assert_eq!(blades, "under [vehicle] write blades = 3 and rotors = N, in place of preset");
    }
}
