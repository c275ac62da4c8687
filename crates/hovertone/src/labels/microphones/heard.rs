//! The lines of all channels put side by side: how loud each is at each microphone, and how phases differ.

use super::lines::{BlockLines, C, MicrophoneLines};
use crate::microphones_config::MicrophonesConfig;

/// Blocks of two channels are the same where they begin within this time.
const SAME_BLOCK_S: f64 = 1e-6;

/// One line of one rotor, at all microphones.
#[derive(Clone, Debug)]
pub(super) struct HeardLine {
    pub(super) rotor: usize,
    pub(super) hz: f64,
    /// Its power at each microphone that hears it, without that of noise.
    pub(super) powers: Vec<Option<f64>>,
    pub(super) phases: Vec<PhaseDifference>,
}

/// Phase at one microphone over that at another; both hear the line.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct PhaseDifference {
    pub(super) microphones: (usize, usize),
    pub(super) phase_rad: f64,
    /// From noise, and from what is not the same in all blocks.
    pub(super) variance_rad2: f64,
}

/// The lines of `rotors` that at least two microphones hear; they differ by nothing but where they stand.
pub(super) fn heard_lines(channels: &[MicrophoneLines], config: &MicrophonesConfig) -> Vec<HeardLine> {
    let Some(first) = channels.first() else { return Vec::new() };
    let is_same = |at: usize| {
        let starts = channels.iter().map(|channel| channel.blocks.get(at).map(|block| block.start_s));
        starts.into_iter().all(|start_s| start_s.is_some_and(|s| (s - first.blocks[at].start_s).abs() < SAME_BLOCK_S))
    };
    let blocks: Vec<Vec<&BlockLines>> = (0..first.blocks.len())
        .filter(|&at| is_same(at))
        .map(|at| channels.iter().map(|channel| &channel.blocks[at]).collect())
        .collect();
    let rotors = first.speeds_rev_s.len();
    let lines = (0..first.orders.len()).flat_map(|line| (0..rotors).map(move |rotor| (rotor, line)));
    lines
        .filter_map(|(rotor, line)| {
            let noise = noise_of(&blocks, line, channels.len())?;
            let hz = first.orders[line] * first.speeds_rev_s[rotor];
            heard_line((rotor, line, hz), &blocks, &noise, config)
        })
        .collect()
}

/// Power of noise about a line in each channel: the rotors' lines of one order are close together.
fn noise_of(blocks: &[Vec<&BlockLines>], line: usize, channels: usize) -> Option<Vec<f64>> {
    let of_channel = |channel: usize| {
        let beside = blocks.iter().flat_map(|block| block[channel].noise.iter().filter_map(|rotor| rotor[line]));
        let powers: Vec<f64> = beside.collect();
        crate::statistics::mean(&powers)
    };
    (0..channels).map(of_channel).collect()
}

fn heard_line(
    (rotor, line, hz): (usize, usize, f64),
    blocks: &[Vec<&BlockLines>],
    noise: &[f64],
    config: &MicrophonesConfig,
) -> Option<HeardLine> {
    // what one channel resolves the others resolve as well
    let apart: Vec<Vec<(C, f64)>> = blocks
        .iter()
        .filter_map(|block| block.iter().map(|channel| channel.lines[rotor][line]).collect())
        .collect();
    let count = apart.len() as f64;
    let inflation = apart.iter().filter_map(|block| block.first()).map(|(_, inflation)| inflation).sum::<f64>() / count;
    let total = |channel: usize| apart.iter().map(|block| block[channel].0.norm_sqr()).sum::<f64>() / count;
    let noise = |channel: usize| inflation * noise[channel];
    let powers: Vec<Option<f64>> = (0..blocks.first()?.len())
        .map(|channel| {
            let is_heard = total(channel) > noise(channel) * (1.0 + config.heard_over_noise / count.sqrt());
            (is_heard && !apart.is_empty()).then(|| total(channel) - noise(channel))
        })
        .collect();
    let mut phases = Vec::new();
    for (a, power_a) in powers.iter().enumerate() {
        for (b, power_b) in powers.iter().enumerate().skip(a + 1) {
            let (Some(power_a), Some(power_b)) = (power_a, power_b) else { continue };
            let product = apart.iter().map(|block| block[a].0 * block[b].0.conj()).sum::<C>() / count;
            let coherence = (product.norm_sqr() / (total(a) * total(b))).clamp(f64::MIN_POSITIVE, 1.0);
            let from_noise = (noise(a) / power_a + noise(b) / power_b) / 2.0;
            let from_blocks = (1.0 - coherence) / (2.0 * coherence);
            let variance_rad2 = from_noise.max(from_blocks) / count;
            phases.push(PhaseDifference { microphones: (a, b), phase_rad: product.arg(), variance_rad2 });
        }
    }
    (!phases.is_empty()).then_some(HeardLine { rotor, hz, powers, phases })
}
