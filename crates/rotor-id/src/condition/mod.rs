//! The condition of rotors: levels of a rotor's shaft lines relative to its blade pass. It is shown, not diagnosed.
//!
//! ```text
//! sound ──┬─▶ products along each rotor's turns, in blocks ─▶ power of every shaft line, all rotors solved together (block_lines)
//! tracks ─┘                                                                  │
//!                     levels relative to the rotor's own blade pass ◀────────┘ mean over the blocks
//! ```

mod block_lines;

use crate::speed_curve::SpeedCurve;
use block_lines::{BlockLines, BlockSums, LinePower};
use hovertone_analysis::{Outcome, RotorCondition, ShaftLine, SpeedAnalysis, TrackPoint};
use hovertone_rotor_speed::{ToneConfig, blades_known};
use hovertone_signal::passes::{Passes, StretchListener};
use hovertone_signal::{RECORDED_RATE_SHARE, SignalError};
use std::f64::consts::{LN_10, TAU};

/// Length of a block, in s: separates the shaft lines of rotors half a turn per second apart, and a hover of ten seconds has two
/// blocks. A shorter stretch is left out. *Decision.*
const BLOCK_S: f64 = 4.0;
/// Rounding error of a block's length, as a share, that costs no block. *Numeric.*
const LENGTH_TOLERANCE: f64 = 1e-9;
/// Highest multiple of the blade pass. *Decision.*
const BLADE_PASS_LINES: u32 = 4;
/// A line is audible if its mean power over n blocks exceeds `1 + AUDIBLE_OVER_NOISE / √n` times the power of the noise. *Decision.*
const AUDIBLE_OVER_NOISE: f64 = 8.0;
/// A line is missing if other rotors' lines of its order have this factor more than the power at which it would be audible. *Decision.*
const MISSED_FACTOR: f64 = 2.0;

/// The condition of each rotor of a finished analysis, in their sequence; one pass. `None` for a rotor whose blade pass is not audible, and
/// for all rotors if the number of blades is unknown, no rotors were separated, or no part of the hover is as long as a block.
///
/// # Errors
/// A source that fails.
pub fn conditions_from_analysis(
    passes: &mut Passes<'_>,
    analysis: &SpeedAnalysis,
    tone: &ToneConfig,
) -> Result<Vec<Option<RotorCondition>>, SignalError> {
    let Outcome::Ok(found) = &analysis.outcome else { return Ok(Vec::new()) };
    let blades = blades_known(tone).filter(|_| !found.rotors.is_empty());
    let Some(blades) = blades else { return Ok(vec![None; found.rotors.len()]) };
    let tracks: Vec<&[TrackPoint]> = found.rotors.iter().map(|rotor| rotor.track.as_slice()).collect();
    conditions_along(passes, analysis, &tracks, blades)
}

/// The condition of the only rotor that turns, along the track of its tone; one pass. `None` if its blade pass is not audible, the number of
/// blades is unknown, or no part of the hover is as long as a block.
///
/// # Errors
/// A source that fails.
pub fn condition_of_one_rotor(
    passes: &mut Passes<'_>,
    analysis: &SpeedAnalysis,
    tone: &ToneConfig,
) -> Result<Option<RotorCondition>, SignalError> {
    let Outcome::Ok(found) = &analysis.outcome else { return Ok(None) };
    let Some(blades) = blades_known(tone) else { return Ok(None) };
    Ok(conditions_along(passes, analysis, &[&found.track], blades)?.into_iter().next().flatten())
}

fn conditions_along(
    passes: &mut Passes<'_>,
    analysis: &SpeedAnalysis,
    tracks: &[&[TrackPoint]],
    blades: u32,
) -> Result<Vec<Option<RotorCondition>>, SignalError> {
    let mut listener = ConditionListener::new(passes.sample_rate_hz(), tracks, blades);
    passes.listen(&analysis.hover.spans_s(), &mut listener)?;
    Ok(listener.finish())
}

/// Collects the shaft lines of rotors with known speeds, block by block.
struct ConditionListener {
    sample_rate_hz: f64,
    blades: u32,
    curves: Vec<SpeedCurve>,
    order_max: u32,
    /// Time of the next audio sample.
    next_s: f64,
    block: Option<BlockSums>,
    blocks: Vec<BlockLines>,
}

impl ConditionListener {
    fn new(sample_rate_hz: f64, tracks: &[&[TrackPoint]], blades: u32) -> Self {
        let curves: Vec<SpeedCurve> = tracks.iter().map(|track| SpeedCurve::through(track)).collect();
        let fastest_rev_s = curves.iter().map(|curve| curve.mean_rad_s / TAU).fold(0.0, f64::max);
        let below_nyquist = (RECORDED_RATE_SHARE * sample_rate_hz / fastest_rev_s.max(f64::MIN_POSITIVE)) as u32;
        Self {
            sample_rate_hz,
            blades,
            curves,
            order_max: (BLADE_PASS_LINES * blades).min(below_nyquist),
            next_s: 0.0,
            block: None,
            blocks: Vec::new(),
        }
    }

    /// The condition of each rotor, in their sequence.
    fn finish(mut self) -> Vec<Option<RotorCondition>> {
        self.end_block();
        let mut conditions: Vec<Option<RotorCondition>> =
            (0..self.curves.len()).map(|rotor| self.condition(rotor)).collect();
        let missing: Vec<Vec<u32>> = conditions
            .iter()
            .map(|condition| condition.as_ref().map_or_else(Vec::new, |own| missing_harmonics(own, &conditions)))
            .collect();
        for (condition, missing) in conditions.iter_mut().zip(missing) {
            if let Some(condition) = condition {
                condition.missing_harmonics = missing;
            }
        }
        conditions
    }

    /// The lines of one rotor, without a comparison with the others; `None` if its blade pass is not audible.
    fn condition(&self, rotor: usize) -> Option<RotorCondition> {
        let mean_line = |order: u32| MeanLine::over(&self.blocks, rotor, order);
        let blade_pass = mean_line(self.blades).filter(MeanLine::is_audible)?;
        let lines = (1..=self.order_max)
            .map(|order| match mean_line(order) {
                Some(line) => line.relative_to(&blade_pass, order, self.blades),
                None => ShaftLine { order, level_db: None, std_uncertainty_db: None, noise_db: None },
            })
            .collect();
        Some(RotorCondition { blades: self.blades, lines, missing_harmonics: Vec::new() })
    }

    fn end_block(&mut self) {
        let Some(block) = self.block.take() else { return };
        if block.length_s(self.next_s) >= BLOCK_S * (1.0 - LENGTH_TOLERANCE) {
            self.blocks.push(block.solve());
        }
    }
}

impl StretchListener for ConditionListener {
    fn restart(&mut self, start_s: f64, _length_s: f64) {
        self.end_block();
        self.next_s = start_s;
    }

    fn push(&mut self, samples: &[f32]) {
        let step_s = 1.0 / self.sample_rate_hz;
        for &sample in samples {
            let time_s = self.next_s;
            self.next_s += step_s;
            if self.block.as_ref().is_some_and(|block| block.length_s(time_s) >= BLOCK_S) {
                self.end_block();
            }
            // in a gap of a track the phase of the rotor is lost: the block ends
            let turns: Option<Vec<f64>> = self.curves.iter_mut().map(|curve| curve.turns_at(time_s)).collect();
            match turns {
                Some(turns) => {
                    let (rotors, order_max) = (self.curves.len(), self.order_max);
                    let block = self.block.get_or_insert_with(|| BlockSums::new(time_s, BLOCK_S, rotors, order_max));
                    block.add(f64::from(sample), time_s, &turns);
                }
                None => self.end_block(),
            }
        }
    }
}

/// Multiples of the blade pass that this rotor lacks, although it would be audible at half the power that most other rotors have there.
fn missing_harmonics(own: &RotorCondition, all: &[Option<RotorCondition>]) -> Vec<u32> {
    let others = || all.iter().flatten().filter(|other| !std::ptr::eq(*other, own));
    (1..=own.lines.len() as u32 / own.blades)
        .filter(|multiple| {
            let Some(line) = own.line(multiple * own.blades) else { return false };
            let (None, Some(noise_db)) = (line.level_db, line.noise_db) else { return false };
            let is_louder = |other: &&RotorCondition| {
                other
                    .line(line.order)
                    .and_then(|line| line.level_db)
                    .is_some_and(|db| db > noise_db + 10.0 * (MISSED_FACTOR * AUDIBLE_OVER_NOISE).log10())
            };
            2 * others().filter(is_louder).count() > others().count().max(1)
        })
        .collect()
}

/// Mean power of a line over the blocks in which it can be separated.
struct MeanLine {
    power: f64,
    /// Standard uncertainty of the power.
    std_power: f64,
    noise: f64,
    /// Number of blocks.
    blocks: f64,
}

impl MeanLine {
    /// The uncertainty is the larger of the scatter over the blocks and that of a sine of power p in noise of power n, whose variance per
    /// block is n² + 2 p n.
    fn over(blocks: &[BlockLines], rotor: usize, order: u32) -> Option<Self> {
        let lines: Vec<LinePower> = blocks.iter().filter_map(|block| block.line(rotor, order)).collect();
        let count = lines.len() as f64;
        if lines.is_empty() {
            return None;
        }
        let powers: Vec<f64> = lines.iter().map(|line| line.power).collect();
        let noise = lines.iter().map(|line| line.noise).sum::<f64>() / count;
        let power = powers.iter().sum::<f64>() / count;
        let from_noise = ((noise * noise + 2.0 * power * noise) / count).sqrt();
        let from_scatter = hovertone_signal::statistics::std(&powers).map_or(0.0, |std| std / count.sqrt());
        Some(Self { power, std_power: from_noise.max(from_scatter), noise, blocks: count })
    }

    fn is_audible(&self) -> bool {
        self.power > self.noise * (1.0 + AUDIBLE_OVER_NOISE / self.blocks.sqrt())
    }

    /// Level of the line over that of the blade pass, both without the noise.
    fn relative_to(&self, blade_pass: &Self, order: u32, blades: u32) -> ShaftLine {
        let reference = (blade_pass.power - blade_pass.noise).max(f64::MIN_POSITIVE);
        let db = |power: f64| 10.0 * (power / reference).log10();
        let std_db = |line: &Self| 10.0 / LN_10 * line.std_power / (line.power - line.noise);
        let is_audible = self.is_audible();
        let own_db = if order == blades { 0.0 } else { std_db(self).hypot(std_db(blade_pass)) };
        ShaftLine {
            order,
            level_db: is_audible.then(|| db(self.power - self.noise)),
            std_uncertainty_db: is_audible.then_some(own_db),
            noise_db: Some(db(self.noise.max(f64::MIN_POSITIVE))),
        }
    }
}
