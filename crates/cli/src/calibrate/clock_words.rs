//! The clock of a recorder against a known number, in words.

use super::comparison::{CLOCK_PERCENT_MAX, Comparison, word};
use crate::args::CalibrateArguments;
use hovertone::calibration::Judgement;
use hovertone_report::{fixed, signed, with_uncertainty};
use hovertone_vehicle::CLOCK_CORRECTION_PPM_MAX;

/// What a crystal changes with the warmth of a room, in millionths: a correction is no better.
const WARMTH_PPM: f64 = 5.0;
/// Error that hardly any recorder exceeds, in millionths: quartz crystals are cut to 20 to 100.
const USUAL_PPM_MAX: f64 = 200.0;

/// Decimals of a correction in millionths: to the second digit of its ±, and one at most, which is a hundredth of what the warmth of a room does.
fn correction_decimals(expanded_ppm: f64) -> usize {
    usize::from(expanded_ppm < 10.0)
}

/// "129.4 ± 3.1 ppm".
fn in_ppm(ppm: f64, std_ppm: f64) -> String {
    format!("{} ppm", with_uncertainty(ppm, Some(std_ppm)))
}

/// The check of the clock, and the correction that follows.
pub(super) fn clock_in_words(comparison: &Comparison, arguments: &CalibrateArguments) -> String {
    let (check, what) = (&comparison.check, comparison.reference.quantity());
    let before_ppm = arguments.hearing.clock_correction_ppm.unwrap_or(0.0);
    let judgement = check.clock(arguments.clock_ppm);
    // a direction is told where it is known
    let off = if check.is_significant() {
        let direction = if check.correction_ppm > 0.0 { "fast" } else { "slow" };
        let off = in_ppm(check.correction_ppm.abs(), check.correction_std_ppm);
        format!("it runs {direction} by {off}")
    } else {
        format!("its error is {}", in_ppm(check.correction_ppm, check.correction_std_ppm))
    };
    let advice = match judgement {
        // each of the two alone would leave it open
        Judgement::Undecided if comparison.least_expanded_ppm() >= arguments.clock_ppm => {
            format!(
                ". Neither the known {what} nor the sound is exact enough: measure the {what} more exactly, give half of its ±, in ppm, \
                 with --known-std-ppm, and make a longer recording"
            )
        }
        Judgement::Undecided if comparison.is_known_the_less_exact() => {
            format!(
                ". Most of the ± comes from the known {what}: measure it more exactly, and give half of its ±, in ppm, with \
                 --known-std-ppm"
            )
        }
        Judgement::Undecided => ". Most of the ± comes from the sound: make a longer recording".to_owned(),
        _ => String::new(),
    };
    let off = match before_ppm {
        0.0 => off,
        _ => format!("with the correction of {before_ppm} ppm, {off}"),
    };
    let (verdict, limit_ppm) = (word(judgement), arguments.clock_ppm);
    let why = if judgement == Judgement::Undecided { ", so this ± is too large to decide" } else { "" };
    let mut text = format!(
        "clock: {verdict}, {off} (millionths, k = 2). An error of up to {limit_ppm} ppm passes (--clock-ppm){why}{advice}\n"
    );
    let whole_ppm = comparison.whole_correction_ppm(before_ppm);
    text += &if check.is_significant() && whole_ppm.abs() > CLOCK_CORRECTION_PPM_MAX {
        format!(
            "correction of heard speeds: none, because no clock is off by more than {CLOCK_PERCENT_MAX} %. Check the \
             known speed, and whether the recording was slowed down\n"
        )
    } else if check.is_significant() {
        let decimals = correction_decimals(check.expanded_ppm());
        let ppm = signed(whole_ppm, decimals).replace('−', "-").replace('+', "");
        let is_exact = comparison.reference.std_share() == 0.0;
        let right = match is_exact {
            true => {
                format!(
                    "this correction takes the known {what} as exact; if it has a ±, run this command again with --known-std-ppm and half of this ±, in ppm"
                )
            }
            false => format!("this correction is right if the known {what} is right within its ±"),
        };
        let unusual = format!("few clocks are off by more than {USUAL_PPM_MAX} ppm, so check the known {what} first\n");
        let unusual = if whole_ppm.abs() > USUAL_PPM_MAX { &unusual } else { "" };
        format!(
            "{unusual}correction of heard speeds: {ppm} ppm. Add --clock-correction-ppm {ppm} to later commands with this recorder, or write \
             in an experiment file:\n  [recorder]\n  clock_correction_ppm = {ppm}\n  \
             clock_ppm = {}  # error that may remain; a warmer or colder recorder changes by about {WARMTH_PPM} ppm\n{right}\n",
            fixed(check.expanded_ppm().max(WARMTH_PPM), decimals)
        )
    } else {
        let kept = (before_ppm != 0.0).then(|| format!("keep --clock-correction-ppm {before_ppm}"));
        let what = kept.as_deref().unwrap_or("none");
        format!("correction of heard speeds: {what}, because the error is smaller than its ±\n")
    };
    text
}
