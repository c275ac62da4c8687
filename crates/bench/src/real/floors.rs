//! The subset that continuous integration hears, and how well it must be heard at least.

use super::cases::Truth;
use super::judgement::Verdict;
use super::rows::Row;

/// Recordings with rotors: short ones of every class.
const FILES: [&str; 12] = [
    "small-multirotors/DRONE_001.wav",
    "small-multirotors/DRONE_005.wav",
    "real/DRONE_017.flac",
    "real/DRONE_023.flac",
    "m300-hover/hover_no_payload_mic1.wav",
    "real/das_ex4.flac",
    "real/mambo_Membo_0_037.flac",
    "crazyflie-propeller/44000.wav",
    "real/cf_42000.wav",
    "real/ast_contact.mp4",
    "real/motor_m1_no_prop_60pct_000.flac",
    "motor-step/motor_step.wav",
];

/// The counts of a mode that must be held.
struct Floor {
    mode: &'static str,
    right_min: usize,
    /// Wrong speeds and octaves.
    wrong_max: usize,
}

const FLOORS: [Floor; 0] = [];

/// Is the recording in the subset? All recordings without a rotor are.
pub(super) fn is_in_subset(truth: &Truth) -> bool {
    let is_trusted_negative = truth.whole_range().is_none() && !truth.is_low_confidence();
    is_trusted_negative || FILES.contains(&truth.file.as_str())
}

/// Compares the counts with the floors.
///
/// # Errors
/// Names each floor that is not held.
pub(super) fn check(rows: &[Row]) -> Result<(), String> {
    let faults: Vec<String> = FLOORS.iter().filter_map(|floor| fault(floor, rows)).collect();
    if faults.is_empty() { Ok(()) } else { Err(faults.join("\n")) }
}

fn fault(floor: &Floor, rows: &[Row]) -> Option<String> {
    let of_mode = || rows.iter().filter(|row| row.mode == floor.mode);
    let right = of_mode().filter(|row| row.verdict == Verdict::Right).count();
    let wrong = of_mode().filter(|row| matches!(row.verdict, Verdict::Wrong | Verdict::Octave)).count();
    (right < floor.right_min || wrong > floor.wrong_max).then(|| {
        format!(
            "mode {}: {right} right (at least {}), {wrong} wrong or an octave off (at most {})",
            floor.mode, floor.right_min, floor.wrong_max
        )
    })
}
