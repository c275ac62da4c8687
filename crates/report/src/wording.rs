//! Advice in the words of a command that says facts in another way than by the flags of `hovertone speed`.

use crate::experiment_key::ExperimentKey;
use hovertone_analysis::FEWER_ROTORS;

/// What a command has in place of flags that advice names.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Wording {
    /// Pairs of a flag, with words around it, and what to say. The first pairs are replaced first.
    pub phrases: &'static [(&'static str, &'static str)],
    /// Keys in place of all other flags.
    pub keys: &'static [ExperimentKey],
    /// Whether each recording belongs to a load, whose mass cannot be left out.
    pub has_loads: bool,
    /// Whether all loads hover: then all rotors of the vehicle turn.
    pub is_flight: bool,
}

/// In place of the advice to hear one rotor in a band: the loads of an experiment have their tones in different bands.
pub const ONE_BAND_FOR_ALL: &str = "; a nearer microphone may help to separate the rotors";

/// Advice where one tone stands for all rotors, because --mean-only or --method harmonic asks for it.
pub const LEAVE_MEAN_ONLY_OUT: &str = "to hear each rotor, leave --mean-only or --method harmonic out";

/// The same where another method asks for it.
pub const LEAVE_METHOD_OUT: &str = "to hear each rotor, leave --method out";

impl Wording {
    /// For an experiment file, in which facts have keys.
    pub const IN_EXPERIMENT: Self = Self {
        phrases: &[
            ("--from and --to", "from_s and to_s under [[load]]"),
            ("; to follow one rotor, give --band LOW:HIGH around its tone", ONE_BAND_FOR_ALL),
            ("--band LOW:HIGH", "band_hz = [LOW, HIGH] under [tone]"),
            ("--harmonics 1", "harmonics = 1 under [tone]"),
            ("the speed is the mean of", "C_f uses the mean speed of"),
            (
                "to separate them and get a smaller ±, ",
                "the ± of C_f includes this uncertainty; to separate them and get a smaller ±, ",
            ),
            (
                "if fewer rotors turn, give their number with --rotors",
                "if fewer rotors turn on a bench, write rotors_running = N under the [[load]] of this recording",
            ),
            (
                "if more rotors turn, give their number with --rotors; if not, ",
                "check preset or rotors under [vehicle] (on a bench, rotors_running under [[load]]); if it is right, ",
            ),
            ("with --rotors", "as rotors under [vehicle], or on a bench as rotors_running under [[load]]"),
            (" alone, in place of the vehicle", " and rotors = N, in place of preset"),
            ("give --blades N alone", "write order = N under [tone] for N blades"),
            ("give --blades N", "write blades = N under [vehicle]"),
            ("give --blades ", "under [vehicle] write blades = "),
        ],
        keys: &ExperimentKey::ALL,
        has_loads: true,
        is_flight: false,
    };

    /// The same, where all loads hover.
    pub const IN_FLIGHT: Self = Self { is_flight: true, ..Self::IN_EXPERIMENT };

    /// For an experiment file, whose loads all hover or not.
    pub fn of_experiment(is_flight: bool) -> Self {
        if is_flight { Self::IN_FLIGHT } else { Self::IN_EXPERIMENT }
    }

    /// Some phrases alone.
    pub const fn of_phrases(phrases: &'static [(&'static str, &'static str)]) -> Self {
        Self { phrases, keys: &[], has_loads: false, is_flight: false }
    }

    /// The advice in these words.
    pub fn of(self, advice: &str) -> String {
        let advice = if self.is_flight { advice.replace(FEWER_ROTORS, "") } else { advice.to_owned() };
        let in_phrases = self.phrases.iter().fold(advice, |advice, (flag, words)| advice.replace(flag, words));
        self.keys.iter().fold(in_phrases, |advice, key| key.in_place_of_flag(&advice))
    }
}
