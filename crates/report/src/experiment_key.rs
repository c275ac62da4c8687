//! Keys of an experiment file that stand for flags: the one list for advice about either.

/// A key of an experiment file, and the flag that says the same.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct ExperimentKey {
    /// The flag, of any command.
    pub flag: &'static str,
    /// The key.
    pub key: &'static str,
    /// Its table.
    pub table: &'static str,
}

impl ExperimentKey {
    /// All of them.
    pub const ALL: [Self; 21] = [
        Self::of("--vehicle", "preset", "[vehicle]"),
        Self::of("--rotors", "rotors", "[vehicle]"),
        Self::of("--blades", "blades", "[vehicle]"),
        Self::of("--gear", "gear", "[vehicle]"),
        Self::of("--diameter-m", "propeller_diameter_m", "[vehicle]"),
        Self::of("--mass-kg", "mass_kg", "[vehicle]"),
        Self::of("--gravity-m-s2", "gravity_m_s2", "[vehicle]"),
        Self::of("--latitude-deg", "latitude_deg", "[vehicle]"),
        Self::of("--height-m", "height_m", "[vehicle]"),
        Self::of("--order", "order", "[tone]"),
        Self::of("--band", "band_hz", "[tone]"),
        Self::of("--harmonics", "harmonics", "[tone]"),
        Self::of("--from", "from_s", "[[load]]"),
        Self::of("--to", "to_s", "[[load]]"),
        Self::of("--added-mass-kg", "added_mass_kg", "[[load]]"),
        Self::of("--window-s", "window_s", "[spectrogram]"),
        Self::of("--hop-share", "hop_share", "[spectrogram]"),
        Self::of("--temperature-c", "temperature_c", "[air]"),
        Self::of("--pressure-hpa", "pressure_hpa", "[air]"),
        Self::of("--humidity-percent", "humidity_percent", "[air]"),
        Self::of("--clock-ppm", "clock_ppm", "[recorder]"),
    ];

    const fn of(flag: &'static str, key: &'static str, table: &'static str) -> Self {
        Self { flag, key, table }
    }

    /// The key of a flag.
    pub fn of_flag(flag: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|known| known.flag == flag)
    }

    /// Advice with this key in place of its flag.
    pub(crate) fn in_place_of_flag(self, advice: &str) -> String {
        let mut parts = advice.split(self.flag);
        let first = parts.next().unwrap_or_default().to_owned();
        parts.fold(first, |advice, rest| {
            // --rotors is no part of --rotors-separated
            let is_longer = rest.starts_with(|letter: char| letter == '-' || letter.is_alphanumeric());
            match is_longer {
                true => advice + self.flag + rest,
                false => format!("{advice}{} under {}{rest}", self.key, self.table),
            }
        })
    }
}
