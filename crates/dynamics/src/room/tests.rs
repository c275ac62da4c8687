//! Steps in spectra whose expectation is known.

use super::beliefs::beliefs_of;
use super::expected::Expectation;
use super::parameters::{CURVE, RoomCurve, SHARES};
use super::*;
use rand::{RngExt, SeedableRng};
use rand_pcg::Pcg64;

const TURNS: f64 = 4.0;
const LINES: usize = 8;
const HOP_S: f64 = 0.015;

const TRUTH: RoomCurve = RoomCurve { start_s: 1.0, time_constant_s: 0.06, from_rev_s: 70.0, to_rev_s: 95.0 };

/// Frames along a path, without powers.
fn frames_along(path: &RoomCurve) -> StepSpectra {
    let first_bin = TURNS as usize;
    let bins = 2 * LINES * TURNS as usize;
    let frame = |at: usize| {
        let centre_s = 0.8 + at as f64 * HOP_S;
        let length_s = TURNS / path.at(centre_s);
        let place_s = std::array::from_fn(|place| centre_s + length_s * ((place as f64 + 0.5) / PLACES as f64 - 0.5));
        TurnFrame { centre_s, length_s, place_s, path_rev_s: place_s.map(|at_s| path.at(at_s)), power: vec![1.0; bins] }
    };
    StepSpectra {
        turns: TURNS,
        first_bin,
        orders: (1..=LINES).map(|line| 2.0 * line as f64).collect(),
        hop_s: HOP_S,
        frames: (0..46).map(frame).collect(),
    }
}

/// Spectra of the true step along a path, with echoes of so much power, each cell with the scatter of noise.
fn spectra(path: &RoomCurve, echoes: f64, seed: u64) -> StepSpectra {
    let mut spectra = frames_along(path);
    let expectation = Expectation::new(&spectra, &TRUTH);
    let mut unknowns = beliefs_of(&spectra, &TRUTH, &any_place()).mean;
    unknowns[CURVE] = echoes.ln();
    for line in 0..LINES {
        for share in 0..SHARES.len() {
            unknowns[expectation.layout.power(line, share)] = 3.0 - 0.3 * share as f64;
        }
    }
    let expected = expectation.power(&unknowns);
    let random = &mut Pcg64::seed_from_u64(seed);
    let bins = spectra.frames[0].power.len();
    for (at, frame) in spectra.frames.iter_mut().enumerate() {
        for (bin, power) in frame.power.iter_mut().enumerate() {
            *power = -expected[at * bins + bin] * (1.0 - random.random::<f64>()).ln();
        }
    }
    spectra
}

#[test]
fn the_tail_of_the_old_speed_does_not_move_the_step() {
    for (seed, echoes) in [(1, 0.02), (2, 1.0), (3, 2.0)] {
        let mut curve =
            RoomCurve { start_s: TRUTH.start_s + 0.01, time_constant_s: 1.25 * TRUTH.time_constant_s, ..TRUTH };
        let mut place = any_place();
        let mut told = None;
        for _ in 0..2 {
            let request = RoomRequest { curve, place, other_time_constant_s: None };
            let step = step_in_room(&spectra(&curve, echoes, seed), &request).unwrap();
            (curve, place) = (step.curve, place_of(&[step], &place));
            told = Some(step);
        }
        let step = told.unwrap();
        let error_s = step.curve.time_constant_s - TRUTH.time_constant_s;
        // independent cells scatter less than those of a room, for which the uncertainty is
        assert!(error_s.abs() < 2.0 * step.time_constant_std_s, "{echoes}: {step:?}");
        assert!(step.time_constant_std_s < 0.2 * TRUTH.time_constant_s, "{step:?}");
        assert!((step.curve.start_s - TRUTH.start_s).abs() < 2.0 * step.start_std_s, "{echoes}: {step:?}");
        if echoes >= 1.0 {
            assert!((step.place[0].value.exp() / echoes).ln().abs() < 0.7, "{echoes}: {:?}", step.place);
        }
    }
}

#[test]
fn a_step_is_found_from_a_start_far_behind_it() {
    let late = RoomCurve { start_s: TRUTH.start_s + 0.03, time_constant_s: 0.6 * TRUTH.time_constant_s, ..TRUTH };
    let request = RoomRequest { curve: late, place: any_place(), other_time_constant_s: None };
    let step = step_in_room(&spectra(&late, 1.0, 4), &request).unwrap();
    let error_s = step.curve.time_constant_s - TRUTH.time_constant_s;
    assert!(error_s.abs() < 2.0 * step.time_constant_std_s, "{step:?}");
}

#[test]
fn spectra_without_frames_have_no_step() {
    let request = RoomRequest { curve: TRUTH, place: any_place(), other_time_constant_s: None };
    assert!(step_in_room(&StepSpectra::default(), &request).is_none());
}
