//! A second look at each hypothesis, in long frames: along the best path near that of the short frames, so that both look at one rotor.

use super::excess::{Excess, Looks};
use super::level_model::{LevelModel, RotorLevels};
use super::levels::{NoiseLevel, levels_of_lines, noise_level};
use super::path::best_path;
use super::rotor_lines::RotorLines;
use super::votes::{VotePlaces, VoteTable, votes_of_frame};
use crate::thresholds::BESIDE_SHARE;

/// Largest distance of the paths, as a logarithm of the speed.
const NEAR: f64 = BESIDE_SHARE;
/// Step of the logarithm of the speed: half the width of a line of a long frame at its twentieth harmonic. *Numeric.*
pub(super) const STEP: f64 = 1e-3;
/// The same where a gear mesh is followed: a quarter of that width at its third harmonic. *Numeric.*
const MESH_STEP: f64 = 2e-4;

/// What long frames show along a path.
pub(super) struct SecondLook {
    /// Levels of the lines.
    pub(super) levels: RotorLevels,
    /// Levels between them.
    pub(super) noise: NoiseLevel,
}

impl SecondLook {
    /// Looks along a path. `None` without a band.
    fn along(long: &Excess, speeds_rev_s: &[f64], lines: &RotorLines) -> Option<Self> {
        Some(Self { levels: levels_of_lines(long, speeds_rev_s, lines), noise: noise_level(long, speeds_rev_s)? })
    }

    /// Looks along a path, over the wide and over the near floor. The lines of a gear mesh stay over the wide one, as those of all rotors lie close
    /// there. `None` without a band.
    pub(super) fn over_both_floors(
        [wide, near]: [&Excess; 2],
        speeds_rev_s: &[f64],
        lines: &RotorLines,
    ) -> Option<[Self; 2]> {
        let [wide, near] = [Self::along(wide, speeds_rev_s, lines)?, Self::along(near, speeds_rev_s, lines)?];
        let levels = RotorLevels { mesh: wide.levels.mesh.clone(), ..near.levels };
        Some([wide, Self { levels, ..near }])
    }

    /// Evidence of the levels of the lines, in nats: the mean over both floors. Each errs in its own way: over the wide one waves of the noise stand
    /// as lines, and the near one rises where lines lie close.
    pub(super) fn evidence_nats(floors: &[Self; 2], models: &mut [LevelModel<'_>; 2], lines: &RotorLines) -> f64 {
        let nats = floors.iter().zip(models).map(|(seen, model)| model.evidence_nats(&seen.levels, lines));
        0.5 * nats.sum::<f64>()
    }
}

/// The best path in long frames near a path of the short frames, which has this speed in each. `None` without frames.
pub(super) fn path_in_long_frames(looks: &Looks, speeds_rev_s: &[f64], table: &VoteTable) -> Option<Vec<f64>> {
    path_near(&looks.long, &speeds_at(&looks.short, speeds_rev_s, &looks.long)?, NEAR, table)
}

/// The best path in frames within `reach` of a speed in each, as a logarithm of the speed. `None` without frames.
pub(super) fn path_near(look: &Excess, middles_rev_s: &[f64], reach: f64, table: &VoteTable) -> Option<Vec<f64>> {
    let bins = look.frames.first()?.levels.len();
    let grid_step = if table.has_mesh() { MESH_STEP } else { STEP };
    let steps = (reach / grid_step) as i32;
    let ratios: Vec<f64> = (-steps..=steps).map(|step| (grid_step * f64::from(step)).exp()).collect();
    let votes: Vec<Vec<f32>> = look
        .frames
        .iter()
        .zip(middles_rev_s)
        .map(|(frame, middle_rev_s)| {
            let speeds_rev_s: Vec<f64> = ratios.iter().map(|ratio| ratio * middle_rev_s).collect();
            votes_of_frame(frame, table, &VotePlaces::new(&speeds_rev_s, table, look.bin_hz, bins))
        })
        .collect();
    let path = best_path(&votes, 0..ratios.len(), &look.hops(), grid_step);
    Some(path.iter().zip(middles_rev_s).map(|(&point, middle_rev_s)| ratios[point] * middle_rev_s).collect())
}

/// The speeds of a path of the short frames at the middles of the long frames; constant beyond the ends. `None` without short frames.
fn speeds_at(short: &Excess, speeds_rev_s: &[f64], long: &Excess) -> Option<Vec<f64>> {
    let at = |time_s: f64| {
        let after = short.frames.partition_point(|frame| frame.centre_s < time_s);
        let (before, after) = (after.saturating_sub(1), after.min(short.frames.len().checked_sub(1)?));
        let (from_s, to_s) = (short.frames[before].centre_s, short.frames[after].centre_s);
        let share = if to_s > from_s { ((time_s - from_s) / (to_s - from_s)).clamp(0.0, 1.0) } else { 0.0 };
        Some(speeds_rev_s.get(before)? * (1.0 - share) + speeds_rev_s.get(after)? * share)
    };
    long.frames.iter().map(|frame| at(frame.centre_s)).collect()
}
