//! What a rotor's lines say of its state: shown, not diagnosed.
//!
//! ```text
//! samples ─┬─ along each rotor's turns (turns) ─▶ amplitude of every line of its shaft in blocks, all rotors solved for together
//! tracks ──┘                                      (lines) ─▶ levels against its own blade pass
//! ```

mod lines;

use crate::speed_curve::SpeedCurve;
use hovertone_analysis::{Outcome, RotorCondition, RotorEstimate, ShaftLine, SpeedAnalysis};
use hovertone_rotor_speed::{ToneConfig, blades_known};
use hovertone_signal::SignalError;
use hovertone_signal::passes::{Passes, StretchListener};
use lines::{BlockLines, LineSums};

/// Length of a block: tells lines of the shaft apart of rotors that differ by half a turn per second, and a hover of ten seconds has
/// two of them. What is shorter is left out.
const BLOCK_S: f64 = 4.0;
/// Multiples of the blade pass that are looked at.
const BLADE_PASS_LINES: u32 = 4;
/// Power over that of noise at which a line is heard in one block; in n blocks, by a √n less far above.
const HEARD_OVER_NOISE: f64 = 8.0;

/// The condition of each rotor of a finished analysis, in their order; one pass. `None` for a rotor whose blade pass is not heard, and for
/// all where the number of blades is not known, no rotors were separated, or no block of the hover is long enough.
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
    let mut reader = ConditionReader::new(passes.sample_rate_hz(), &found.rotors, blades);
    passes.listen(&analysis.hover.spans_s(), &mut reader)?;
    Ok(reader.finish())
}

/// Hears the lines of several rotors whose speeds are known.
struct ConditionReader {
    sample_rate_hz: f64,
    blades: u32,
    curves: Vec<SpeedCurve>,
    order_max: u32,
    next_s: f64,
    block: Option<LineSums>,
    blocks: Vec<BlockLines>,
}

impl ConditionReader {
    fn new(sample_rate_hz: f64, rotors: &[RotorEstimate], blades: u32) -> Self {
        let fastest_rev_s = rotors.iter().map(|rotor| rotor.speed.speed.rev_s()).fold(0.0, f64::max);
        // a line and the noise beside it, below half the sample rate
        let below_nyquist = (0.45 * sample_rate_hz / fastest_rev_s.max(f64::MIN_POSITIVE)) as u32;
        Self {
            sample_rate_hz,
            blades,
            curves: rotors.iter().map(|rotor| SpeedCurve::through(&rotor.track)).collect(),
            order_max: (BLADE_PASS_LINES * blades).min(below_nyquist),
            next_s: 0.0,
            block: None,
            blocks: Vec::new(),
        }
    }

    /// The state of each rotor, in their order; nothing where no block is long enough, or the blade pass is not heard.
    fn finish(mut self) -> Vec<Option<RotorCondition>> {
        self.end_block();
        let blades = self.blades;
        let mut conditions: Vec<Option<RotorCondition>> = (0..self.curves.len())
            .map(|rotor| {
                let level = |order: u32| LineLevel::of(&self.blocks, rotor, order);
                let blade_pass = level(blades).filter(LineLevel::is_heard)?;
                let lines = (1..=self.order_max)
                    .map(|order| match level(order) {
                        Some(line) => line.against(&blade_pass, order, blades),
                        None => ShaftLine { order, level_db: None, std_uncertainty_db: None, noise_db: None },
                    })
                    .collect();
                Some(RotorCondition { blades, lines, missing_harmonics: Vec::new() })
            })
            .collect();
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

    fn end_block(&mut self) {
        let Some(block) = self.block.take() else { return };
        // the last digits of a time must not cost a block
        if block.has_lasted_s(self.next_s) >= BLOCK_S * (1.0 - 1e-9) {
            self.blocks.push(block.solved());
        }
    }
}

impl StretchListener for ConditionReader {
    fn restart(&mut self, start_s: f64, _length_s: f64) {
        self.end_block();
        self.next_s = start_s;
    }

    fn push(&mut self, samples: &[f32]) {
        let step_s = 1.0 / self.sample_rate_hz;
        for &sample in samples {
            let time_s = self.next_s;
            self.next_s += step_s;
            if self.block.as_ref().is_some_and(|block| block.has_lasted_s(time_s) >= BLOCK_S) {
                self.end_block();
            }
            // where a rotor is not followed nothing is known of its phase: the block ends
            let turns: Option<Vec<f64>> = self.curves.iter_mut().map(|curve| curve.turns_at(time_s)).collect();
            match turns {
                Some(turns) => {
                    let (rotors, order_max) = (self.curves.len(), self.order_max);
                    let block = self.block.get_or_insert_with(|| LineSums::new(time_s, BLOCK_S, rotors, order_max));
                    block.add(f64::from(sample), time_s, &turns);
                }
                None => self.end_block(),
            }
        }
    }
}

/// The multiples of the blade pass that this one has not, though it would be heard at half the power that others have there.
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
                    .is_some_and(|db| db > noise_db + 10.0 * (2.0 * HEARD_OVER_NOISE).log10())
            };
            2 * others().filter(is_louder).count() > others().count().max(1)
        })
        .collect()
}

/// A line over all blocks in which it is apart from others.
struct LineLevel {
    power: f64,
    std_power: f64,
    noise: f64,
    blocks: f64,
}

impl LineLevel {
    fn of(blocks: &[BlockLines], rotor: usize, order: u32) -> Option<Self> {
        let lines: Vec<(f64, f64)> = blocks.iter().filter_map(|block| block.power(rotor, order)).collect();
        let count = lines.len() as f64;
        if lines.is_empty() {
            return None;
        }
        let powers: Vec<f64> = lines.iter().map(|(power, _)| *power).collect();
        let noise = lines.iter().map(|(_, noise)| noise).sum::<f64>() / count;
        let power = powers.iter().sum::<f64>() / count;
        // of a sine of power p in noise of power n: n² + 2 p n
        let from_noise = ((noise * noise + 2.0 * power * noise) / count).sqrt();
        let from_scatter = hovertone_signal::statistics::std(&powers).map_or(0.0, |std| std / count.sqrt());
        Some(Self { power, std_power: from_noise.max(from_scatter), noise, blocks: count })
    }

    fn is_heard(&self) -> bool {
        self.power > self.noise * (1.0 + HEARD_OVER_NOISE / self.blocks.sqrt())
    }

    fn against(&self, blade_pass: &Self, order: u32, blades: u32) -> ShaftLine {
        let reference = (blade_pass.power - blade_pass.noise).max(f64::MIN_POSITIVE);
        let db = |power: f64| 10.0 * (power / reference).log10();
        let relative_db = |line: &Self| 10.0 / std::f64::consts::LN_10 * line.std_power / (line.power - line.noise);
        let is_heard = self.is_heard();
        let own_db = if order == blades { 0.0 } else { relative_db(self).hypot(relative_db(blade_pass)) };
        ShaftLine {
            order,
            level_db: is_heard.then(|| db(self.power - self.noise)),
            std_uncertainty_db: is_heard.then_some(own_db),
            noise_db: Some(db(self.noise.max(f64::MIN_POSITIVE))),
        }
    }
}
