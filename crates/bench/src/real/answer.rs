//! What `hovertone speed --json` answers.

use serde::{Deserialize, Serialize};

/// Letters of an error that are kept.
const ERROR_LETTERS: usize = 160;

/// The status of an answer.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Deserialize, Serialize)]
#[serde(rename_all = "snake_case")]
pub(super) enum Status {
    Ok,
    Ambiguous,
    NoRotorTone,
    #[default]
    Error,
    /// The program did not end within its time.
    Timeout,
}

impl Status {
    pub(super) fn name(self) -> &'static str {
        match self {
            Self::Ok => "ok",
            Self::Ambiguous => "ambiguous",
            Self::NoRotorTone => "no_rotor_tone",
            Self::Error => "error",
            Self::Timeout => "timeout",
        }
    }
}

/// The fields that the exam judges.
#[derive(Clone, Debug, Default, Deserialize)]
pub(super) struct Answer {
    pub(super) status: Status,
    pub(super) speed_rev_s: Option<f64>,
    /// By the sound alone.
    pub(super) std_uncertainty_rev_s: Option<f64>,
    /// With the clock and the motion.
    pub(super) combined_std_uncertainty_rev_s: Option<f64>,
    pub(super) mean_square_rad2_s2: Option<f64>,
    /// The analysed stretch.
    pub(super) from_s: Option<f64>,
    pub(super) to_s: Option<f64>,
    pub(super) reason: Option<String>,
    #[serde(default)]
    pub(super) rotors: Vec<ToldRotor>,
    /// The readings of an ambiguous tone.
    #[serde(default)]
    pub(super) alternatives: Vec<ToldReading>,
    /// The reading that was used, where the program chose one.
    #[serde(default)]
    pub(super) found: Option<ToldReading>,
}

/// A separated rotor.
#[derive(Clone, Debug, Deserialize)]
pub(super) struct ToldRotor {
    pub(super) speed_rev_s: f64,
    #[serde(default)]
    pub(super) combined_std_uncertainty_rev_s: Option<f64>,
}

/// One reading of a tone.
#[derive(Clone, Debug, Deserialize)]
pub(super) struct ToldReading {
    pub(super) speed_rev_s: f64,
    pub(super) plausibility: f64,
}

impl Answer {
    /// The first line of JSON; without one, an error with the last words of stderr.
    pub(super) fn from_output(stdout: &str, stderr: &str) -> Self {
        let parsed = stdout.lines().find_map(|line| serde_json::from_str(line).ok());
        parsed.unwrap_or_else(|| {
            let said = stderr.trim();
            let skipped = said.chars().count().saturating_sub(ERROR_LETTERS);
            Self { reason: Some(said.chars().skip(skipped).collect()), ..Self::default() }
        })
    }

    pub(super) fn timeout() -> Self {
        Self { status: Status::Timeout, ..Self::default() }
    }
}

#[cfg(test)]
mod tests {
    use super::{Answer, Status};

    #[test]
    fn the_first_line_of_json_is_the_answer() {
        let line = r#"{"status":"ambiguous","speed_rev_s":null,"combined_std_uncertainty_rev_s":null,"std_uncertainty_rev_s":null,
            "reason":"several","from_s":0.5,"to_s":9,"alternatives":[{"speed_rev_s":80.5,"plausibility":0.7,"why":""}],"more":[1]}"#;
        let answer = Answer::from_output(&format!("words\n{}\n", line.replace('\n', "")), "");
        assert_eq!((answer.status, answer.to_s), (Status::Ambiguous, Some(9.0)));
        assert_eq!(answer.alternatives[0].plausibility, 0.7);
        assert!(answer.rotors.is_empty() && answer.found.is_none());
    }

    #[test]
    fn without_json_it_is_an_error_with_its_last_words() {
        let answer = Answer::from_output("", &format!("{}\nhint: say less\n", "ä".repeat(300)));
        assert_eq!(answer.status, Status::Error);
        let reason = answer.reason.unwrap();
        assert!(reason.ends_with("hint: say less") && reason.chars().count() == 160);
    }
}
