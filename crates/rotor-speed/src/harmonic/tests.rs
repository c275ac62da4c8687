//! Comparison with the Cramér-Rao bound on synthetic sound of known speed. `hovertone-bench accuracy` does the same with many more
//! draws.

use crate::harmonic::HarmonicTracer;
use hovertone_signal::channels::ChannelBand;
use hovertone_signal::passes::StretchListener;
use rand::{RngExt, SeedableRng};
use rand_distr::{Distribution, StandardNormal};
use std::f64::consts::{PI, TAU};

/// Sample rate of the synthetic sound, Hz. *Numeric.*
const RATE_HZ: f64 = 48000.0;

struct Draw {
    error_rev_s: f64,
    std_rev_s: f64,
    bound_rev_s: f64,
    blocks: usize,
}

/// A line of the synthetic rotor.
struct TestLine {
    order: f64,
    amplitude: f64,
}

/// One steady rotor in white noise, analysed with all its lines.
fn draw(seed: u64, lines: &[TestLine], snr_db: f64, length_s: f64) -> Draw {
    let mut rng = rand_pcg::Pcg64::seed_from_u64(seed);
    let speed_rev_s: f64 = rng.random_range(55.0..65.0);
    let power: f64 = lines.iter().map(|line| line.amplitude * line.amplitude / 2.0).sum();
    let noise_std = (power / 10f64.powf(snr_db / 10.0)).sqrt();
    let phases: Vec<f64> = lines.iter().map(|_| rng.random_range(0.0..TAU)).collect();
    let samples: Vec<f32> = (0..(length_s * RATE_HZ) as usize)
        .map(|n| {
            let turns = speed_rev_s * n as f64 / RATE_HZ;
            let noise: f64 = StandardNormal.sample(&mut rng);
            let tones: f64 = lines
                .iter()
                .zip(&phases)
                .map(|(line, phase)| line.amplitude * (TAU * (line.order * turns).fract() + phase).cos())
                .sum();
            (tones + noise_std * noise) as f32
        })
        .collect();
    let reference = speed_rev_s * (1.0 + rng.random_range(-0.01..0.01));
    let bands: Vec<ChannelBand> = lines
        .iter()
        .map(|&TestLine { order, .. }| ChannelBand {
            order,
            is_first: order == lines[0].order,
            band_hz_low: 0.92 * order * reference,
            band_hz_high: 1.08 * order * reference,
            noise_fall_db: 0.0,
        })
        .collect();
    let mut tracer = HarmonicTracer::new(RATE_HZ, &bands);
    tracer.restart(0.0, length_s);
    samples.chunks(10_000).for_each(|samples| tracer.push(samples));
    let track = tracer.finish();
    let total: f64 = track.blocks.iter().map(|block| block.span.length_s()).sum();
    let mean: f64 = track.blocks.iter().map(|b| b.speed_rev_s * b.span.length_s()).sum::<f64>() / total;
    let variance: f64 =
        track.blocks.iter().map(|b| (b.std_uncertainty_rev_s * b.span.length_s() / total).powi(2)).sum();
    let information: f64 = lines.iter().map(|line| (line.order * line.amplitude).powi(2)).sum();
    let n = length_s * RATE_HZ;
    let bound_rev_s = (6.0 * noise_std * noise_std * RATE_HZ * RATE_HZ / (PI * PI * n.powi(3) * information)).sqrt();
    Draw { error_rev_s: mean - speed_rev_s, std_rev_s: variance.sqrt(), bound_rev_s, blocks: track.blocks.len() }
}

fn mesh() -> Vec<TestLine> {
    [(69.0, 1.0), (138.0, 0.5), (207.0, 0.25)].map(|(order, amplitude)| TestLine { order, amplitude }).into()
}

fn blade_pass() -> Vec<TestLine> {
    (1..=12).map(|h| TestLine { order: 2.0 * f64::from(h), amplitude: 1.0 / f64::from(h) }).collect()
}

#[test]
fn a_steady_rotor_reaches_the_bound_and_states_it() {
    for (name, lines) in [("mesh", mesh()), ("blade pass", blade_pass())] {
        for snr_db in [-20.0, 0.0, 20.0] {
            let draws: Vec<Draw> = (0..24).map(|seed| draw(seed, &lines, snr_db, 5.0)).collect();
            let over_bound = |draw: &Draw| draw.error_rev_s / draw.bound_rev_s;
            let rms = (draws.iter().map(|d| over_bound(d).powi(2)).sum::<f64>() / draws.len() as f64).sqrt();
            // the rms of 24 draws is known to 15 %
            assert!(rms < 1.2 * 1.45, "{name} at {snr_db} dB: {rms} bounds");
            assert!(draws.iter().all(|d| over_bound(d).abs() < 6.0), "{name} at {snr_db} dB: an outlier");
            let within = draws.iter().filter(|d| d.error_rev_s.abs() <= 2.0 * d.std_rev_s).count();
            assert!(within >= 20, "{name} at {snr_db} dB: {within} of 24 within 2 u");
            let claimed = draws.iter().map(|d| d.std_rev_s / d.bound_rev_s).sum::<f64>() / draws.len() as f64;
            assert!((0.9..1.3).contains(&claimed), "{name} at {snr_db} dB: claims {claimed} bounds");
            let whole = draws.iter().filter(|d| d.blocks == 1).count();
            assert!(whole >= 23, "{name} at {snr_db} dB: a steady rotor is one block: {whole} of 24");
        }
    }
}
