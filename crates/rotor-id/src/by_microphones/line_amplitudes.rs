//! Complex amplitudes of every rotor's lines at one microphone, block by block.

use super::line_bank::{CHUNK, Chunk, LineBank, LineBlocks, WANDER_SHARE};
use super::settings::MicrophonesConfig;
use crate::speed_curve::SpeedCurve;
use hovertone_analysis::TrackPoint;
use hovertone_rotor_speed::{ToneConfig, lines_between_speeds};
use hovertone_signal::passes::{Passes, Piece, Progress};
use hovertone_signal::{SignalError, SignalSource};
use hovertone_vehicle::{BLADES_MAX, MESH_SIDEBANDS};

/// Difference of two orders below which they are the same line. *Numeric.*
const SAME_ORDER: f64 = 0.1;

/// Amplitudes of the lines of several rotors at one microphone, relative to the angle of the rotor's shaft, which is the same for all
/// microphones.
#[derive(Clone, Debug)]
pub struct MicrophoneLines {
    /// Mean speed of each rotor.
    pub(super) speeds_rev_s: Vec<f64>,
    pub(super) lines: Vec<LineBlocks>,
}

/// Amplitudes of the lines of rotors with known speeds, in one audio channel; one pass.
///
/// `tracks` holds the tracks of the separated rotors, `tone` gives the orders of their lines. All lines of all rotors, with the sidebands of a gear
/// mesh, are solved together by least squares in blocks of at most [`MicrophonesConfig::block_s`], along the rotors' turns, for at most
/// [`MicrophonesConfig::listen_s_max`]. Analyse all audio channels of a recording with the same tracks.
///
/// # Errors
/// A source that fails, a sample rate outside 1 kHz to 1 MHz.
pub fn microphone_lines_from_source(
    source: &mut dyn SignalSource,
    tracks: &[&[TrackPoint]],
    tone: &ToneConfig,
    config: &MicrophonesConfig,
    on_progress: &mut dyn FnMut(Progress),
) -> Result<MicrophoneLines, SignalError> {
    let mut passes = Passes::planned(source, 1, on_progress)?;
    let mut collector = LineCollector::new(passes.sample_rate_hz(), tracks, tone, config);
    let times = || tracks.iter().copied().flatten().map(|point| point.time_s);
    let from_s = times().fold(f64::INFINITY, f64::min);
    let to_s = times().fold(f64::NEG_INFINITY, f64::max).min(from_s + config.listen_s_max);
    let span_s = from_s..to_s;
    if !span_s.is_empty() {
        passes.pieces(std::slice::from_ref(&span_s), |piece| match piece {
            Piece::Start(start_s) => collector.next_s = start_s,
            Piece::Samples(samples) => collector.push(samples),
            Piece::Heard(_) => {}
        })?;
    }
    let lines = collector.banks.into_iter().flat_map(LineBank::into_lines).collect();
    Ok(MicrophoneLines { speeds_rev_s: collector.speeds_rev_s, lines })
}

/// Cuts the sound into chunks, with the turns of all rotors, for the banks.
struct LineCollector {
    sample_rate_hz: f64,
    speeds_rev_s: Vec<f64>,
    curves: Vec<SpeedCurve>,
    /// Time of the next chunk.
    next_s: f64,
    /// Audio samples that do not fill a chunk yet.
    pending: Vec<f32>,
    banks: Vec<LineBank>,
}

impl LineCollector {
    fn new(sample_rate_hz: f64, tracks: &[&[TrackPoint]], tone: &ToneConfig, config: &MicrophonesConfig) -> Self {
        let mean_rev_s = |track: &&[TrackPoint]| {
            track.iter().map(|point| point.speed_rev_s).sum::<f64>() / (track.len() as f64).max(1.0)
        };
        let speeds_rev_s: Vec<f64> = tracks.iter().map(mean_rev_s).collect();
        let fastest_rev_s = speeds_rev_s.iter().copied().fold(0.0, f64::max);
        let slowest_rev_s = speeds_rev_s.iter().copied().fold(fastest_rev_s, f64::min);
        let bands = lines_between_speeds(&(slowest_rev_s..=fastest_rev_s), tone, sample_rate_hz);
        let orders: Vec<f64> = bands.iter().map(|band| band.order).collect();
        let sounding = with_sidebands(&orders, tone);
        // a block is halved until its length times the order is short enough
        let halvings = |order: f64| (config.block_s * order / config.block_order_s).log2().ceil().max(0.0) as u32;
        let mut lengths: Vec<u32> = orders.iter().map(|order| halvings(*order)).collect();
        lengths.dedup();
        // lines of two rotors can overlap if their orders differ by no more than this factor
        let reach = fastest_rev_s / slowest_rev_s.max(f64::MIN_POSITIVE) * (1.0 + 2.0 * WANDER_SHARE);
        let banks = lengths.into_iter().map(|length| {
            let own: Vec<f64> = orders.iter().copied().filter(|order| halvings(*order) == length).collect();
            let is_other = |order: &f64| own.iter().all(|line| (line - order).abs() > SAME_ORDER);
            let may_overlap =
                |order: &f64| own.iter().any(|line| *order < line * reach + 1.0 && *order > line / reach - 1.0);
            let others = sounding.iter().copied().filter(|order| is_other(order) && may_overlap(order));
            let block_s = config.block_s / f64::from(2u32.saturating_pow(length));
            LineBank::new(sample_rate_hz, block_s, tracks.len(), own.clone(), others.collect())
        });
        Self {
            sample_rate_hz,
            curves: tracks.iter().map(|track| SpeedCurve::through(track)).collect(),
            next_s: 0.0,
            pending: Vec::new(),
            banks: banks.collect(),
            speeds_rev_s,
        }
    }

    fn push(&mut self, samples: &[f32]) {
        let mut pending = std::mem::take(&mut self.pending);
        pending.extend_from_slice(samples);
        let (chunks, rest) = pending.as_chunks::<CHUNK>();
        chunks.iter().for_each(|chunk| self.add(chunk));
        self.pending = rest.to_vec();
    }

    fn add(&mut self, samples: &[f32; CHUNK]) {
        let (start_s, length_s) = (self.next_s, CHUNK as f64 / self.sample_rate_hz);
        self.next_s += length_s;
        let from: Option<Vec<f64>> = self.curves.iter_mut().map(|curve| curve.turns_at(start_s)).collect();
        let to: Option<Vec<f64>> = self.curves.iter_mut().map(|curve| curve.turns_at(start_s + length_s)).collect();
        let (Some(from_turns), Some(to)) = (from, to) else {
            // in a gap of a track the phase of the rotor is lost
            self.banks.iter_mut().for_each(LineBank::drop_block);
            return;
        };
        let made_turns = from_turns.iter().zip(&to).map(|(from, to)| to - from).collect();
        let chunk = Chunk { start_s, length_s, samples, from_turns, made_turns };
        self.banks.iter_mut().for_each(|bank| bank.add(&chunk));
    }
}

/// The orders of the lines, and of the sidebands of the gear mesh and its multiples.
fn with_sidebands(orders: &[f64], tone: &ToneConfig) -> Vec<f64> {
    let mesh_order = Some(tone.order.lines_per_turn()).filter(|order| *order > BLADES_MAX);
    let is_mesh = |order: f64| mesh_order.is_some_and(|mesh| (order / mesh).fract() == 0.0);
    let sidebands =
        orders.iter().filter(|order| is_mesh(**order)).flat_map(|order| MESH_SIDEBANDS.map(|away| order + away));
    orders.iter().copied().chain(sidebands).collect()
}
