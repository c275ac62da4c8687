//! Four rotors that wander together and each for itself, with all their lines: the sound of PHYSICS 6.2. Shares no code with the
//! core, nor with the simulator.

use rand::seq::SliceRandom;
use rand::{RngExt, SeedableRng};
use rand_distr::StandardNormal;
use rand_pcg::Pcg64;
use std::f64::consts::TAU;

pub(super) const SAMPLE_RATE_HZ: f64 = 48_000.0;
pub(super) const MEAN_REV_S: f64 = 60.17;
const ROTORS: usize = 4;
/// Nodes of all that changes slowly; a whole number of samples.
const NODE_S: f64 = 0.001;
const NODE_SAMPLES: usize = 48;
const WANDER_S: f64 = 0.6;
const COMMON_STD_SHARE: f64 = 0.003;
/// Every line swells and fades by so much, as slowly as that.
const LEVEL_STD_SHARE: f64 = 0.1;
const LEVEL_S: f64 = 1.0;
const LEVEL_SPREAD_DB: f64 = 3.0;
const MESH: [(f64, f64); 3] = [(69.0, 1.0), (138.0, 0.5), (207.0, 0.25)];
const SIDEBANDS: [(f64, f64); 4] = [(-2.0, 0.15), (-1.0, 0.3), (1.0, 0.3), (2.0, 0.15)];
const BLADE_PASS_LINES: u32 = 20;
/// Echoes of a room, and how many.
const ROOM_ECHOES: usize = 400;

/// What sounds.
#[derive(Clone, Copy, Debug)]
pub(super) struct Sound {
    /// Between neighbours, as a share of the mean.
    pub(super) spacing_share: f64,
    pub(super) wander_std_share: f64,
    /// Whether gear mesh and blade pass are there.
    pub(super) has_mesh: bool,
    pub(super) has_blade_pass: bool,
    /// Of the gear mesh, over the noise in a hertz.
    pub(super) carrier_to_noise_db_hz: f64,
    pub(super) duration_s: f64,
    /// Reverberation and coherence times.
    pub(super) room: Option<Room>,
}

#[derive(Clone, Copy, Debug)]
pub(super) struct Room {
    pub(super) t60_s: f64,
    pub(super) coherence_s: f64,
}

/// What is heard, and each rotor's speed at nodes.
pub(super) struct Rendered {
    pub(super) samples: Vec<f32>,
    speeds_rev_s: Vec<Vec<f64>>,
}

impl Rendered {
    pub(super) fn speeds_at(&self, time_s: f64) -> Vec<f64> {
        let place = (time_s / NODE_S).max(0.0);
        let last = self.speeds_rev_s[0].len() - 2;
        let node = (place as usize).min(last);
        let share = (place - node as f64).min(1.0);
        self.speeds_rev_s.iter().map(|rotor| rotor[node] + share * (rotor[node + 1] - rotor[node])).collect()
    }

    /// Mean over the rotors of the mean square.
    pub(super) fn mean_square(&self, from_s: f64, to_s: f64) -> f64 {
        let nodes = (from_s / NODE_S) as usize..(to_s / NODE_S) as usize;
        let of = |rotor: &Vec<f64>| rotor[nodes.clone()].iter().map(|speed| speed * speed).sum::<f64>();
        self.speeds_rev_s.iter().map(of).sum::<f64>() / (nodes.len() * self.speeds_rev_s.len()) as f64
    }
}

/// A stationary process, smooth to the first derivative (critically damped), of standard deviation 1.
fn smooth_wander(nodes: usize, time_constant_s: f64, random: &mut Pcg64) -> Vec<f64> {
    let keep = (-2.0 / time_constant_s * NODE_S).exp();
    let settle = (10.0 * time_constant_s / NODE_S) as usize;
    let (mut a, mut b) = (0.0, 0.0);
    // variance of y[n] = 2k y[n-1] − k² y[n-2] + e
    let k2 = keep * keep;
    let variance = (1.0 + k2) / (1.0 - k2).powi(3);
    let mut values = Vec::with_capacity(nodes);
    for index in 0..settle + nodes {
        let kick: f64 = random.sample(StandardNormal);
        let value = 2.0 * keep * a - k2 * b + kick;
        (b, a) = (a, value);
        if index >= settle {
            values.push(value / variance.sqrt());
        }
    }
    values
}

pub(super) fn rendered(sound: &Sound, seed: u64) -> Rendered {
    let mut random = Pcg64::seed_from_u64(seed);
    let nodes = (sound.duration_s / NODE_S).round() as usize + 1;
    let count = (nodes - 1) * NODE_SAMPLES;
    let common = smooth_wander(nodes, WANDER_S, &mut random);
    let mut places = [-1.5, -0.5, 0.5, 1.5];
    places.shuffle(&mut random);
    let mut samples = vec![0.0; count];
    let mut speeds_rev_s = Vec::new();
    for place in places {
        let own = smooth_wander(nodes, WANDER_S, &mut random);
        let speeds: Vec<f64> = own
            .iter()
            .zip(&common)
            .map(|(own, common)| {
                MEAN_REV_S
                    * (1.0 + place * sound.spacing_share + COMMON_STD_SHARE * common + sound.wander_std_share * own)
            })
            .collect();
        add_rotor(sound, &speeds, &mut samples, &mut random);
        speeds_rev_s.push(speeds);
    }
    debug_assert_eq!(speeds_rev_s.len(), ROTORS);
    if let Some(room) = sound.room {
        samples = in_room(&samples, room, &mut random);
    }
    add_noise(sound, &mut samples, &mut random);
    let peak = samples.iter().fold(0.0f64, |peak, sample| peak.max(sample.abs()));
    Rendered { samples: samples.into_iter().map(|sample| (0.5 * sample / peak) as f32).collect(), speeds_rev_s }
}

fn add_rotor(sound: &Sound, speeds: &[f64], samples: &mut [f64], random: &mut Pcg64) {
    let mut lines: Vec<(f64, f64)> = Vec::new();
    if sound.has_mesh {
        for (order, level) in MESH {
            lines.push((order, level));
            lines.extend(SIDEBANDS.iter().map(|(aside, share)| (order + aside, level * share)));
        }
    }
    if sound.has_blade_pass {
        lines.extend((1..=BLADE_PASS_LINES).map(f64::from).map(|h| (2.0 * h, 2.0 * h.powf(-0.7))));
    }
    // turns at each node, the speed being straight in between
    let mut turns = vec![0.0];
    for pair in speeds.windows(2) {
        turns.push(turns[turns.len() - 1] + NODE_S * (pair[0] + pair[1]) / 2.0);
    }
    for (order, level) in lines {
        let swell = smooth_wander(speeds.len(), LEVEL_S, random);
        let drawn: f64 = random.sample(StandardNormal);
        let level = level * 10f64.powf(LEVEL_SPREAD_DB * drawn / 20.0);
        let phase_step = sound.room.map_or(0.0, |room| (2.0 * NODE_S / room.coherence_s).sqrt());
        let mut phase = random.random_range(0.0..TAU);
        let envelope: Vec<(f64, f64)> = swell
            .iter()
            .map(|swell| {
                let kick: f64 = random.sample(StandardNormal);
                phase += phase_step * kick;
                let level = level * (1.0 + LEVEL_STD_SHARE * swell);
                (level * phase.cos(), level * phase.sin())
            })
            .collect();
        for node in 0..speeds.len() - 1 {
            let step_s = NODE_S / NODE_SAMPLES as f64;
            let bend = (speeds[node + 1] - speeds[node]) / NODE_S * step_s * step_s / 2.0;
            let start = order * turns[node];
            let (mut im, mut re) = (TAU * (start - start.round())).sin_cos();
            let (mut step_im, mut step_re) = (TAU * order * (speeds[node] * step_s + bend)).sin_cos();
            let (bend_im, bend_re) = (TAU * order * 2.0 * bend).sin_cos();
            let ((a_re, a_im), (b_re, b_im)) = (envelope[node], envelope[node + 1]);
            for (index, sample) in samples[node * NODE_SAMPLES..(node + 1) * NODE_SAMPLES].iter_mut().enumerate() {
                let share = index as f64 / NODE_SAMPLES as f64;
                *sample += (a_re + share * (b_re - a_re)) * re - (a_im + share * (b_im - a_im)) * im;
                (re, im) = (re * step_re - im * step_im, re * step_im + im * step_re);
                (step_re, step_im) = (step_re * bend_re - step_im * bend_im, step_re * bend_im + step_im * bend_re);
            }
        }
    }
}

/// The sound and its echoes: as much power in them as in the sound itself.
fn in_room(samples: &[f64], room: Room, random: &mut Pcg64) -> Vec<f64> {
    let echoes: Vec<(usize, f64)> = (0..ROOM_ECHOES)
        .map(|_| {
            let late_s: f64 = random.random_range(0.002..room.t60_s);
            let normal: f64 = random.sample(StandardNormal);
            ((late_s * SAMPLE_RATE_HZ) as usize, normal * 10f64.powf(-3.0 * late_s / room.t60_s))
        })
        .collect();
    let power: f64 = echoes.iter().map(|(_, level)| level * level).sum();
    let mut heard = samples.to_vec();
    for (late, level) in echoes {
        let level = level / power.sqrt();
        heard[late..].iter_mut().zip(samples).for_each(|(heard, sample)| *heard += level * sample);
    }
    heard
}

/// Noise that falls by 3 dB per octave above 50 Hz, of the set density at the gear mesh: a sum of first-order processes, three
/// to a decade, keeps within half a decibel.
fn add_noise(sound: &Sound, samples: &mut [f64], random: &mut Pcg64) {
    let density = 0.5 / 10f64.powf(sound.carrier_to_noise_db_hz / 10.0);
    let corners_hz: Vec<f64> = (0..10).map(|index| 50.0 * 10f64.powf(f64::from(index) / 3.0)).collect();
    // each has density p / (1 + (f/c)²); with p = 1 / c they add up to nearly 1 / f
    let shape = |hz: f64| corners_hz.iter().map(|corner| 1.0 / corner / (1.0 + (hz / corner).powi(2))).sum::<f64>();
    let scale = density / shape(69.0 * MEAN_REV_S);
    for corner_hz in &corners_hz {
        let pole = (-TAU * corner_hz / SAMPLE_RATE_HZ).exp();
        // density at 0 is 2 kick² / (fs (1 − pole)²)
        let kick_std = (scale / corner_hz * SAMPLE_RATE_HZ / 2.0).sqrt() * (1.0 - pole);
        let mut value = 0.0;
        for sample in samples.iter_mut() {
            let kick: f64 = random.sample(StandardNormal);
            value = pole * value + kick_std * kick;
            *sample += value;
        }
    }
}
