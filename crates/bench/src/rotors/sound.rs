//! Four rotors that wander together and independently, with all their lines. Made by `hovertone_sim::prescribed`, which
//! shares no code with the core.

use hovertone_sim::Truth;
use hovertone_sim::prescribed::{Echoes, Line, Noise, PhaseWalk, Recording, Rotor, Sampling, Wander};
use rand::seq::SliceRandom;
use rand::{RngExt, SeedableRng};
use rand_distr::StandardNormal;
use rand_pcg::Pcg64;

pub(super) const SAMPLE_RATE_HZ: f64 = 48_000.0;
pub(super) const MEAN_REV_S: f64 = 60.17;
/// Mean speeds of the four rotors, in spacings from the mean of all.
const PLACES: [f64; 4] = [-1.5, -0.5, 0.5, 1.5];
const WANDER_S: f64 = 0.6;
const COMMON_STD_SHARE: f64 = 0.003;
/// The level of every line changes slowly: standard deviation as a share, and time constant.
const LEVEL_STD_SHARE: f64 = 0.1;
const LEVEL_S: f64 = 1.0;
/// Standard deviation of the levels from rotor to rotor.
const LEVEL_SPREAD_DB: f64 = 3.0;
const MESH_ORDER: f64 = 69.0;
/// Levels of the gear mesh and of its harmonics.
const MESH_LEVELS: [f64; 3] = [1.0, 0.5, 0.25];
const SIDEBANDS: [Sideband; 4] = [
    Sideband { shaft_speeds: -2.0, share: 0.15 },
    Sideband { shaft_speeds: -1.0, share: 0.3 },
    Sideband { shaft_speeds: 1.0, share: 0.3 },
    Sideband { shaft_speeds: 2.0, share: 0.15 },
];
const BLADE_PASS_LINES: u32 = 20;
const ROOM_ECHOES: usize = 400;
/// Time between rows of the truth: the nodes at 48 kHz.
const ROW_S: f64 = 0.001;
/// Largest sample.
const PEAK: f64 = 0.5;

/// A line beside a harmonic of the mesh: how far, and its level as a share of the harmonic's.
struct Sideband {
    shaft_speeds: f64,
    share: f64,
}

/// Settings of a sound.
#[derive(Clone, Copy, Debug)]
pub(super) struct Sound {
    /// Between neighbours, as a share of the mean.
    pub(super) spacing_share: f64,
    pub(super) wander_std_share: f64,
    /// Whether gear mesh and blade pass are there.
    pub(super) has_mesh: bool,
    pub(super) has_blade_pass: bool,
    /// Power of the gear mesh over the noise's power in one hertz.
    pub(super) carrier_to_noise_db_hz: f64,
    pub(super) duration_s: f64,
    pub(super) room: Option<Room>,
}

/// A room: reverberation time, and coherence time of the lines in it.
#[derive(Clone, Copy, Debug)]
pub(super) struct Room {
    pub(super) t60_s: f64,
    pub(super) coherence_s: f64,
}

/// The sound and its truth.
pub(super) struct Rendered {
    pub(super) samples: Vec<f32>,
    truth: Truth,
}

impl Rendered {
    /// Speed of each rotor at an instant; at the end, if the instant is beyond it.
    pub(super) fn speeds_at(&self, time_s: f64) -> Vec<f64> {
        let end_s = self.truth.rows().last().map_or(0.0, |row| row.time_s);
        self.truth.speeds_rev_s_at(time_s.clamp(0.0, end_s)).unwrap_or_default()
    }

    /// Mean over the rotors and over the rows of the truth of the squared speed, rev²/s².
    pub(super) fn mean_square(&self, from_s: f64, to_s: f64) -> f64 {
        let rows = self.truth.rows();
        let row = |time_s: f64| ((time_s / ROW_S) as usize).min(rows.len());
        let rows = &rows[row(from_s)..row(to_s)];
        let of = |rotor: usize| rows.iter().map(|row| row.rotors[rotor].speed_rev_s.powi(2)).sum::<f64>();
        (0..PLACES.len()).map(of).sum::<f64>() / (rows.len() * PLACES.len()) as f64
    }
}

/// Draws and renders a sound. The common wander is drawn first, then rotor by rotor its wander and its lines, then the
/// room and the noise.
pub(super) fn rendered(sound: &Sound, seed: u64) -> Rendered {
    let random = &mut Pcg64::seed_from_u64(seed);
    let sampling = Sampling::new(SAMPLE_RATE_HZ, sound.duration_s);
    let wander =
        Wander { std: 1.0, time_constant_s: WANDER_S, step_s: sampling.node_step_s(), count: sampling.node_count() };
    let common = wander.critically_damped(random);
    let mut places = PLACES;
    places.shuffle(random);
    let mut rotors = Vec::new();
    for place in places {
        let own = wander.critically_damped(random);
        let speed = |own: f64, common: f64| {
            MEAN_REV_S * (1.0 + place * sound.spacing_share + COMMON_STD_SHARE * common + sound.wander_std_share * own)
        };
        let speeds_rev_s = own.iter().zip(&common).map(|(own, common)| speed(*own, *common)).collect();
        rotors.push(Rotor::at_nodes(speeds_rev_s, lines(sound, &sampling, random)));
    }
    let mut recording = Recording::of_rotors(&rotors, sampling);
    if let Some(room) = sound.room {
        recording.add_echoes(&Echoes::drawn(ROOM_ECHOES, room.t60_s, &sampling, random));
    }
    let density = 0.5 / 10f64.powf(sound.carrier_to_noise_db_hz / 10.0);
    recording.add_noise(&Noise::pink(density, MESH_ORDER * MEAN_REV_S, SAMPLE_RATE_HZ), random);
    recording.scale_to_peak(PEAK);
    Rendered { samples: recording.samples_f32(), truth: recording.truth().clone() }
}

/// The lines of one rotor, drawn: of each line the changes of its level, its level, its phase, the changes of its phase.
fn lines(sound: &Sound, sampling: &Sampling, random: &mut Pcg64) -> Vec<Line> {
    let mut lines = Vec::new();
    if sound.has_mesh {
        for (order, level) in (1..).map(|harmonic| MESH_ORDER * f64::from(harmonic)).zip(MESH_LEVELS) {
            lines.push(Line::new(order, level));
            lines.extend(SIDEBANDS.iter().map(|side| Line::new(order + side.shaft_speeds, level * side.share)));
        }
    }
    if sound.has_blade_pass {
        lines.extend((1..=BLADE_PASS_LINES).map(f64::from).map(|h| Line::new(2.0 * h, 2.0 * h.powf(-0.7))));
    }
    let (step_s, count) = (sampling.node_step_s(), sampling.node_count());
    let swell = Wander { std: LEVEL_STD_SHARE, time_constant_s: LEVEL_S, step_s, count };
    let coherence_s = sound.room.map_or(f64::INFINITY, |room| room.coherence_s);
    let mut drawn = |line: Line| {
        let shares = swell.critically_damped(random).into_iter().map(|change| 1.0 + change).collect();
        let spread: f64 = random.sample(StandardNormal);
        let line = line.times(10f64.powf(LEVEL_SPREAD_DB * spread / 20.0)).with_random_phase(random);
        let walk = PhaseWalk { start_rad: line.phase_rad, coherence_s, step_s, count };
        line.changing_level(shares).changing_phase(walk.drawn_rad(random))
    };
    lines.into_iter().map(&mut drawn).collect()
}
