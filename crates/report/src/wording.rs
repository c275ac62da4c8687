//! Advice in the words of a command that says facts in another way than by the flags of `hovertone speed`.

/// What a command has in place of flags that advice names: pairs of a flag, with words around it, and what to say. The first pairs are
/// replaced first.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Wording(pub &'static [(&'static str, &'static str)]);

impl Wording {
    /// For an experiment file, in which facts have keys.
    pub const IN_EXPERIMENT: Self = Self(&[
        ("--from and --to", "from_s and to_s under [[load]]"),
        ("--band LOW:HIGH", "band_hz = [LOW, HIGH] under [tone]"),
        ("--band", "band_hz under [tone]"),
        ("--harmonics 1", "harmonics = 1 under [tone]"),
        ("leave --rotors 1 out", "correct rotors under [vehicle] or rotors_running under [[load]]"),
        ("with --rotors", "as rotors under [vehicle], or on a bench as rotors_running under [[load]]"),
        ("--rotors", "rotors under [vehicle]"),
        ("give --blades N", "write blades = N under [vehicle]"),
        ("give --blades ", "under [vehicle] write blades = "),
        ("--diameter-m", "propeller_diameter_m under [vehicle]"),
        ("--mass-kg", "mass_kg under [vehicle]"),
    ]);

    /// The advice in these words.
    pub fn of(self, advice: &str) -> String {
        self.0.iter().fold(advice.to_owned(), |advice, (flag, words)| advice.replace(flag, words))
    }
}
