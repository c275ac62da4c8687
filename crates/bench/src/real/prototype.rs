//! The prototype `rotor_evidence.py`, and what it prints.

use crate::workspace::output_of;
use std::path::Path;
use std::process::Command;

/// Flags that it knows, with one value each.
const FLAGS: [&str; 6] = ["--blades", "--from", "--to", "--diameter-m", "--mass-kg", "--rotors"];
/// Endings that it decodes by another program.
const DECODED: [&str; 4] = ["mp4", "mov", "m4a", "3gp"];

/// Does it understand what the flags tell of the tone?
pub(super) fn can_hear(flags: &[String]) -> bool {
    flags.iter().any(|flag| flag == "--blades")
}

pub(super) fn is_decoded(file: &str) -> bool {
    DECODED.iter().any(|ending| file.to_lowercase().ends_with(ending))
}

/// The speed that it hears in a file; `None` where it hears no rotor.
pub(super) fn heard(mut python: Command, script: &Path, file: &Path, flags: &[String]) -> Result<Option<f64>, String> {
    speed_from_text(&output_of(python.arg(script).arg(file).args(its_flags(flags)))?)
}

/// The flags that it knows; it counts channels from 0.
fn its_flags(flags: &[String]) -> Vec<String> {
    let mut known = Vec::new();
    for pair in flags.chunks_exact(2) {
        if FLAGS.contains(&pair[0].as_str()) {
            known.extend_from_slice(pair);
        } else if let (true, Ok(channel)) = (pair[0] == "--channel", pair[1].parse::<usize>()) {
            known.extend([pair[0].clone(), channel.saturating_sub(1).to_string()]);
        }
    }
    known
}

/// Its first line is the rotor with the most evidence: `  80.52 rev/s  wander …`, and `(not heard)` at its end if that is too little.
fn speed_from_text(text: &str) -> Result<Option<f64>, String> {
    let line = text.lines().find(|line| line.contains("rev/s")).ok_or("it prints no rotor")?;
    let speed_rev_s = line.split_whitespace().next().and_then(|word| word.parse().ok()).ok_or("it prints no speed")?;
    Ok(Some(speed_rev_s).filter(|_| !line.contains("(not heard)")))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn its_first_rotor_is_its_answer() {
        let text = "     80.52 rev/s  wander  1.20 %  median evidence    12.3 nats a frame\n     \
                    91.00 rev/s  wander  1.20 %  median evidence    -3.0 nats a frame  (not heard)\n";
        assert_eq!(speed_from_text(text).unwrap(), Some(80.52));
        let unheard = text.lines().nth(1).unwrap();
        assert_eq!(speed_from_text(unheard).unwrap(), None);
        assert!(speed_from_text("").is_err());
    }

    #[test]
    fn its_channels_start_at_zero_and_unknown_flags_are_left_out() {
        let flags: Vec<String> =
            "--blades 2 --radial-speed-m-s-max 5 --channel 1".split(' ').map(str::to_owned).collect();
        assert_eq!(its_flags(&flags).join(" "), "--blades 2 --channel 0");
        assert!(can_hear(&flags) && is_decoded("real/a.M4A") && !is_decoded("a.wav"));
    }
}
