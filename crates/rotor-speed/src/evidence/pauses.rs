//! Pauses of a sound, by the power of its frames: rests of a flight, and the breaths of a voice.

use super::excess::{ExcessFrame, HOP_S};
use std::ops::Range;

/// Share of the power that a quarter or half of the frames exceed, below which no rotor hovers. *Decision.*
const QUIET_SHARE: f64 = 0.01;
/// Shortest rest between two flights, s. *Decision.*
const REST_S_MIN: f64 = 3.0;
/// Share of the frames of a block that are the quieter ones. *Decision.*
const QUIET_FRAMES_SHARE: f64 = 0.33;
/// Length of a block, s: a few words of a voice. *Decision.*
const BLOCK_S: f64 = 2.0;

/// Drops the frames before take-off, after landing, and between flights, by the loudest quarter of the frames. A shorter pause is dropped only
/// where it is quiet by the louder half: a rotor makes none, and a tune of beeps is told by its pauses.
pub(super) fn drop_rests(frames: &mut Vec<ExcessFrame>) {
    let mut powers: Vec<f64> = frames.iter().map(|frame| frame.mean_power).collect();
    powers.sort_by(f64::total_cmp);
    let quiet_under = |quarters: usize| QUIET_SHARE * powers.get(quarters * powers.len() / 4).copied().unwrap_or(0.0);
    let (power_min, rest_power_min) = (quiet_under(2), quiet_under(3));
    let is_quiet = |frame: &ExcessFrame| frame.mean_power <= rest_power_min;
    let ends_s = frames.first().zip(frames.last()).map(|(first, last)| (first.centre_s, last.centre_s));
    let mut rests: Vec<Range<f64>> = Vec::new();
    for run in frames.chunk_by(|a, b| is_quiet(a) == is_quiet(b)).filter(|run| is_quiet(&run[0])) {
        let (from_s, to_s) = (run[0].centre_s, run[run.len() - 1].centre_s);
        let is_at_end = ends_s.is_some_and(|(first_s, last_s)| from_s <= first_s || to_s >= last_s);
        if is_at_end || to_s - from_s >= REST_S_MIN {
            rests.push(from_s..to_s + HOP_S);
        }
    }
    let is_in_rest = |frame: &ExcessFrame| is_quiet(frame) && rests.iter().any(|rest| rest.contains(&frame.centre_s));
    frames.retain(|frame| frame.mean_power > power_min && !is_in_rest(frame));
}

/// Whether each frame is one of the quieter ones of its block. What pauses, as a voice does between its words, is not in these. As each block has
/// the same share of them, a take-off counts no more than it does among all frames.
pub(super) fn quiet_frames(frames: &[ExcessFrame]) -> Vec<bool> {
    let block = |frame: &ExcessFrame| (frame.centre_s / BLOCK_S).floor();
    let of_block = |block: &[ExcessFrame]| {
        let mut powers: Vec<f64> = block.iter().map(|frame| frame.mean_power).collect();
        powers.sort_by(f64::total_cmp);
        let last = ((QUIET_FRAMES_SHARE * powers.len() as f64) as usize).min(powers.len() - 1);
        block.iter().map(|frame| frame.mean_power <= powers[last]).collect::<Vec<bool>>()
    };
    frames.chunk_by(|a, b| block(a) == block(b)).flat_map(of_block).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::evidence::excess::Excess;

    #[test]
    fn each_block_has_the_same_share_of_quieter_frames() {
        // a take-off, a hover, and words with pauses
        let mut frames = Excess::of_levels(2.5, HOP_S, 160, &[100; 8]).frames;
        for (number, frame) in frames.iter_mut().enumerate() {
            let word = if number % 10 < 6 { 3.0 } else { 1.0 };
            frame.mean_power = if number < 40 { number as f64 } else { 100.0 * word + (number * 7 % 5) as f64 };
        }
        let quiet = quiet_frames(&frames);
        let count = |block: usize| quiet[40 * block..40 * (block + 1)].iter().filter(|is_quiet| **is_quiet).count();
        for block in 0..4 {
            assert!((13..=16).contains(&count(block)), "{block}: {}", count(block));
        }
        // in the words none, but in the pauses
        assert!((40..160).all(|number| !quiet[number] || number % 10 >= 6));
    }
}
