//! The lines of all audio channels together: power of each line at each microphone, and differences of phase between microphones and
//! between rotors.

use super::line_amplitudes::MicrophoneLines;
use super::line_bank::{C, LineAmplitude, LineBlock, LineBlocks};
use super::settings::MicrophonesConfig;
use hovertone_signal::statistics::mean;

/// Difference of the starts of two channels' blocks, in s, up to which they are the same block. *Numeric.*
const SAME_BLOCK_S: f64 = 1e-6;

/// Powers and phases of the lines at several microphones.
#[derive(Clone, Debug, Default)]
pub(super) struct PairedLines {
    pub(super) powers: Vec<LinePowers>,
    pub(super) phases: Vec<PhaseDifference>,
}

/// One line of one rotor at all microphones.
#[derive(Clone, Debug)]
pub(super) struct LinePowers {
    pub(super) rotor: usize,
    /// Power at each microphone, without that of the noise; none where the line is not audible.
    pub(super) powers: Vec<Option<f64>>,
}

/// The double difference of the phase of a line: between two microphones, and of that between two rotors. Motion of the whole vehicle
/// changes the phases of both rotors alike and cancels.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct PhaseDifference {
    pub(super) rotors: RotorPair,
    pub(super) microphones: [usize; 2],
    pub(super) phase_rad: f64,
    /// Variance of the phase from noise and from scatter over the blocks.
    pub(super) variance_rad2: f64,
}

/// One line of two rotors.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct RotorPair {
    pub(super) rotors: [usize; 2],
    /// Frequency of each rotor's line.
    pub(super) hz: [f64; 2],
}

/// One line in the blocks that all channels have.
struct SharedBlocks<'a> {
    order: f64,
    /// `[block][channel]`.
    blocks: Vec<Vec<&'a LineBlock>>,
    /// Power of the noise in each channel: one value for all rotors, whose lines of one order are close together.
    noise: Vec<f64>,
}

/// Powers and double phase differences of all lines.
pub(super) fn paired_lines_from_channels(channels: &[MicrophoneLines], config: &MicrophonesConfig) -> PairedLines {
    let Some(first) = channels.first() else { return PairedLines::default() };
    let (mut lines, rotors) = (PairedLines::default(), first.speeds_rev_s.len());
    for index in 0..first.lines.len() {
        let Some(shared) = SharedBlocks::of_line(channels, index) else { continue };
        let powers: Vec<Vec<Option<f64>>> = (0..rotors).map(|rotor| shared.powers(rotor, config)).collect();
        for a in 0..rotors {
            for b in a + 1..rotors {
                let hz = [a, b].map(|rotor| shared.order * first.speeds_rev_s[rotor]);
                lines.phases.extend(shared.phases(RotorPair { rotors: [a, b], hz }, [&powers[a], &powers[b]]));
            }
        }
        lines.powers.extend(powers.into_iter().enumerate().map(|(rotor, powers)| LinePowers { rotor, powers }));
    }
    lines
}

impl<'a> SharedBlocks<'a> {
    fn of_line(channels: &'a [MicrophoneLines], index: usize) -> Option<Self> {
        let lines: Vec<&LineBlocks> = channels.iter().map(|channel| channel.lines.get(index)).collect::<Option<_>>()?;
        let count = lines.iter().map(|line| line.blocks.len()).min()?;
        let blocks: Vec<Vec<&LineBlock>> = (0..count)
            .map(|at| lines.iter().map(|line| &line.blocks[at]).collect::<Vec<_>>())
            .filter(|blocks| blocks.iter().all(|block| (block.start_s - blocks[0].start_s).abs() < SAME_BLOCK_S))
            .collect();
        let noise_of = |channel: usize| {
            let noise = blocks.iter().flat_map(|block| block[channel].noise.iter().copied().flatten());
            mean(&noise.collect::<Vec<f64>>())
        };
        let noise = (0..channels.len()).map(noise_of).collect::<Option<_>>()?;
        Some(Self { order: lines.first()?.order, blocks, noise })
    }

    /// Power of a rotor's line at each microphone, without that of the noise; none where it is not audible.
    fn powers(&self, rotor: usize, config: &MicrophonesConfig) -> Vec<Option<f64>> {
        let power_at = |channel: usize| {
            let lines: Vec<LineAmplitude> =
                self.blocks.iter().filter_map(|block| block[channel].amplitudes[rotor]).collect();
            // without blocks the sums are not a number, and the comparison is false
            let count = lines.len() as f64;
            let power = lines.iter().map(|line| line.amplitude.norm_sqr()).sum::<f64>() / count;
            let noise = self.noise[channel] * lines.iter().map(|line| line.inflation).sum::<f64>() / count;
            (power > noise * (1.0 + config.heard_over_noise / count.sqrt())).then_some(power - noise)
        };
        (0..self.noise.len()).map(power_at).collect()
    }

    /// Double phase differences of two rotors, between all microphones at which both are audible. The variance is the larger of that of the
    /// noise, `Σ 1 / (2 SNR)` over the four phases, and that of the scatter over n blocks, `(1 − γ²) / (2 n γ²)` with the coherence γ²
    /// (Bendat and Piersol, Random Data, 2010).
    fn phases(&self, pair: RotorPair, powers: [&[Option<f64>]; 2]) -> Vec<PhaseDifference> {
        let products_of_rotors = self.products_of_rotors(pair.rotors);
        let count = products_of_rotors.len() as f64;
        let noise_share = |channel: usize| {
            let share = |powers: &[Option<f64>]| Some(self.noise[channel] / powers[channel]?);
            Some(share(powers[0])? + share(powers[1])?)
        };
        let mut phases = Vec::new();
        for from in 0..self.noise.len() {
            for to in from + 1..self.noise.len() {
                let (Some(noise_from), Some(noise_to)) = (noise_share(from), noise_share(to)) else { continue };
                let products: Vec<C> = products_of_rotors.iter().map(|block| block[from] * block[to].conj()).collect();
                let (sum, squares) = (products.iter().sum::<C>(), products.iter().map(C::norm_sqr).sum::<f64>());
                if squares <= 0.0 {
                    continue;
                }
                let coherence = (sum.norm_sqr() / (count * squares)).clamp(f64::MIN_POSITIVE, 1.0);
                let from_blocks = (1.0 - coherence) / (2.0 * coherence);
                let variance_rad2 = ((noise_from + noise_to) / 2.0).max(from_blocks) / count;
                let microphones = [from, to];
                phases.push(PhaseDifference { rotors: pair, microphones, phase_rad: sum.arg(), variance_rad2 });
            }
        }
        phases
    }

    /// Amplitude of one rotor's line times the conjugate of another's, `[block][channel]`, in the blocks in which all channels separate both.
    fn products_of_rotors(&self, rotors: [usize; 2]) -> Vec<Vec<C>> {
        let product = |block: &&LineBlock| {
            let (a, b) = (block.amplitudes[rotors[0]]?, block.amplitudes[rotors[1]]?);
            Some(a.amplitude * b.amplitude.conj())
        };
        self.blocks.iter().filter_map(|channels| channels.iter().map(product).collect()).collect()
    }
}
