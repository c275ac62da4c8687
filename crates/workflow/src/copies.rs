//! Copies of one recording, which would count as recordings of their own and make the ± too small.

use hovertone_report::SpeedRecord;
use std::collections::BTreeMap;

/// The names of two recordings in which exactly the same speed is heard: copies of one recording in two formats, or with other metadata.
///
/// Two flights never have the same speed to the last digit of a number.
pub fn same_sound<'a>(records: impl IntoIterator<Item = &'a SpeedRecord>) -> Option<[&'a str; 2]> {
    let mut known: BTreeMap<[u64; 2], &str> = BTreeMap::new();
    for record in records {
        let Some(heard) = record.speed() else { continue };
        let u_rev_s = heard.combined_std_uncertainty_rev_s().unwrap_or_default();
        let digits = [heard.speed.rev_s(), u_rev_s].map(f64::to_bits);
        if let Some(first) = known.insert(digits, &record.file) {
            return Some([first, &record.file]);
        }
    }
    None
}

/// What is wrong with two recordings that are the same.
pub fn same_recording_text([first, other]: [&str; 2]) -> String {
    format!(
        "{first} and {other} are the same recording: a recording that counts twice makes the uncertainty (±) too small"
    )
}
