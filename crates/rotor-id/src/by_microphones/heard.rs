//! The lines of all channels put side by side: how loud each is at each microphone, and how phases differ.

use super::lines::{C, LineBlock, LineBlocks, MicrophoneLines};
use crate::by_microphones::MicrophonesConfig;

/// Blocks of two channels are the same where they begin within this time.
const SAME_BLOCK_S: f64 = 1e-6;

/// What several microphones hear of the lines.
#[derive(Clone, Debug, Default)]
pub(super) struct Heard {
    pub(super) levels: Vec<LineLevels>,
    pub(super) phases: Vec<PhaseDifference>,
}

/// One line of one rotor, at all microphones.
#[derive(Clone, Debug)]
pub(super) struct LineLevels {
    pub(super) rotor: usize,
    /// Its power at each microphone that hears it, without that of noise.
    pub(super) powers: Vec<Option<f64>>,
}

/// Phase of a line of one rotor at one microphone over that at another, over the same of another rotor: what the whole vehicle does,
/// be it that it drifts, is in both.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct PhaseDifference {
    pub(super) rotors: (usize, usize),
    pub(super) hz: (f64, f64),
    pub(super) microphones: (usize, usize),
    pub(super) phase_rad: f64,
    /// From noise, and from what is not the same in all blocks.
    pub(super) variance_rad2: f64,
}

/// A line in the blocks that all channels have.
struct SharedLine<'a> {
    order: f64,
    /// `[block][channel]`.
    blocks: Vec<Vec<&'a LineBlock>>,
    /// Power of noise in each channel: the rotors' lines of one order are close together.
    noise: Vec<f64>,
}

/// Levels and phases of all lines that are heard.
pub(super) fn heard_lines(channels: &[MicrophoneLines], config: &MicrophonesConfig) -> Heard {
    let Some(first) = channels.first() else { return Heard::default() };
    let (mut heard, rotors) = (Heard::default(), first.speeds_rev_s.len());
    for index in 0..first.lines.len() {
        let Some(line) = SharedLine::of(channels, index) else { continue };
        let powers: Vec<Vec<Option<f64>>> = (0..rotors).map(|rotor| line.powers(rotor, config)).collect();
        for a in 0..rotors {
            for b in a + 1..rotors {
                let hz = (line.order * first.speeds_rev_s[a], line.order * first.speeds_rev_s[b]);
                heard.phases.extend(line.phases(((a, b), hz), (&powers[a], &powers[b])));
            }
        }
        heard.levels.extend(powers.into_iter().enumerate().map(|(rotor, powers)| LineLevels { rotor, powers }));
    }
    heard
}

impl<'a> SharedLine<'a> {
    fn of(channels: &'a [MicrophoneLines], index: usize) -> Option<Self> {
        let lines: Vec<&LineBlocks> = channels.iter().map(|channel| channel.lines.get(index)).collect::<Option<_>>()?;
        let count = lines.iter().map(|line| line.blocks.len()).min()?;
        let blocks: Vec<Vec<&LineBlock>> = (0..count)
            .map(|at| lines.iter().map(|line| &line.blocks[at]).collect::<Vec<_>>())
            .filter(|of| of.iter().all(|block| (block.start_s - of[0].start_s).abs() < SAME_BLOCK_S))
            .collect();
        let of_channel = |channel: usize| {
            let noise = blocks.iter().flat_map(|block| block[channel].noise.iter().copied().flatten());
            hovertone_signal::statistics::mean(&noise.collect::<Vec<f64>>())
        };
        let noise = (0..channels.len()).map(of_channel).collect::<Option<_>>()?;
        Some(Self { order: lines.first()?.order, blocks, noise })
    }

    /// Power of the line of a rotor at each microphone that hears it.
    fn powers(&self, rotor: usize, config: &MicrophonesConfig) -> Vec<Option<f64>> {
        let of_channel = |channel: usize| {
            let apart: Vec<(C, f64)> =
                self.blocks.iter().filter_map(|block| block[channel].amplitudes[rotor]).collect();
            let count = apart.len() as f64;
            let power = apart.iter().map(|(amplitude, _)| amplitude.norm_sqr()).sum::<f64>() / count;
            let noise = self.noise[channel] * apart.iter().map(|(_, inflation)| inflation).sum::<f64>() / count;
            // of no block: no number, and no line
            (power > noise * (1.0 + config.heard_over_noise / count.sqrt())).then_some(power - noise)
        };
        (0..self.noise.len()).map(of_channel).collect()
    }

    /// Phases of one rotor against another, between all microphones that hear both.
    fn phases(
        &self,
        (rotors, hz): ((usize, usize), (f64, f64)),
        powers: (&[Option<f64>], &[Option<f64>]),
    ) -> Vec<PhaseDifference> {
        // what one channel resolves the others resolve as well
        let apart: Vec<Vec<C>> = self
            .blocks
            .iter()
            .filter_map(|block| {
                let of_channel = |channel: &&LineBlock| {
                    let (a, b) = (channel.amplitudes[rotors.0]?, channel.amplitudes[rotors.1]?);
                    Some(a.0 * b.0.conj())
                };
                block.iter().map(of_channel).collect()
            })
            .collect();
        let count = apart.len() as f64;
        let noise_share = |channel: usize| {
            let share = |powers: &[Option<f64>]| Some(self.noise[channel] / powers[channel]?);
            Some(share(powers.0)? + share(powers.1)?)
        };
        let mut phases = Vec::new();
        for from in 0..self.noise.len() {
            for to in from + 1..self.noise.len() {
                let (Some(noise_from), Some(noise_to)) = (noise_share(from), noise_share(to)) else { continue };
                let products: Vec<C> = apart.iter().map(|block| block[from] * block[to].conj()).collect();
                let (sum, squares) = (products.iter().sum::<C>(), products.iter().map(C::norm_sqr).sum::<f64>());
                if squares <= 0.0 {
                    continue;
                }
                let coherence = (sum.norm_sqr() / (count * squares)).clamp(f64::MIN_POSITIVE, 1.0);
                let from_blocks = (1.0 - coherence) / (2.0 * coherence);
                let variance_rad2 = ((noise_from + noise_to) / 2.0).max(from_blocks) / count;
                phases.push(PhaseDifference {
                    rotors,
                    hz,
                    microphones: (from, to),
                    phase_rad: sum.arg(),
                    variance_rad2,
                });
            }
        }
        phases
    }
}
