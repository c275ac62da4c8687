//! The level of the sound in words.

use hovertone_report::fixed;

/// Levels below this are those of no microphone: the sound is a row of zeros.
const SILENCE_DB: f64 = -150.0;

/// "−18.0 dB", or "silence".
pub(super) fn level_in_words(level_db: f64, decimals: usize) -> String {
    if level_db < SILENCE_DB { "silence".to_owned() } else { format!("{} dB", fixed(level_db, decimals)) }
}

#[cfg(test)]
mod tests {
    use super::level_in_words;

    #[test]
    fn zeros_are_silence_and_no_number() {
        assert_eq!(level_in_words(-200.0, 0), "silence");
        assert_eq!(level_in_words(-18.04, 1), "−18.0 dB");
    }
}
