//! Settings in, samples and truth out.

use crate::noise::{Noise, NoiseSettings};
use crate::profile::{ProfileParts, SpeedProfile};
use crate::seed::{Part, stream};
use crate::shaft::{BLOCK, Shaft, hover_mean_sum_of_squares};
use crate::tones::{RotorTones, ToneSettings};
use crate::truth::{Truth, TruthRow};
use crate::wander::OrnsteinUhlenbeck;
use hovertone_vehicle::{QuantityError, RotorSpeed, Vehicle};
use std::f64::consts::TAU;

/// Noise further out than this is not counted in the headroom: one sample in 500 million, and the headroom's other half
/// is above it.
const NOISE_PEAK_STD: f64 = 6.0;
/// Wander further out than this is not counted when lines near half the sample rate are left out.
const WANDER_PEAK_STD: f64 = 6.0;

/// One rotor: how fast, how loud, how steady.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RotorSound {
    /// Mean shaft speed in hover.
    pub mean_speed: RotorSpeed,
    /// Loudness of all its lines against the levels in [`ToneSettings`].
    pub level_db: f64,
    /// Standard deviation of the speed's wander, as a share of the mean speed.
    pub wander_std_share: f64,
    /// Time constant of the wander's autocorrelation, exp(-t/τ).
    pub wander_time_constant_s: f64,
}

impl RotorSound {
    /// A rotor at 0 dB that wanders as the paper's tables have it: 1.2 % (44 to 48 rpm of 3610 to 3820), and 0.3 s
    /// (assumed: the paper has no time constant).
    pub fn at(mean_speed: RotorSpeed) -> Self {
        Self { mean_speed, level_db: 0.0, wander_std_share: 0.012, wander_time_constant_s: 0.3 }
    }

    /// A rotor whose speed does not change.
    pub fn steady(mean_speed: RotorSpeed) -> Self {
        Self { wander_std_share: 0.0, ..Self::at(mean_speed) }
    }
}

/// What to simulate.
#[derive(Clone, Debug, PartialEq)]
pub struct HoverSettings {
    /// Samples per second.
    pub sample_rate_hz: u32,
    /// Length of the sound, rounded to a whole sample.
    pub duration_s: f64,
    /// The rotors.
    pub rotors: Vec<RotorSound>,
    /// The lines that each rotor has.
    pub tones: ToneSettings,
    /// Broadband noise of the rotors; it falls silent with them.
    pub rotor_noise: Option<NoiseSettings>,
    /// Noise of the place, there from first to last sample; measured as the rotors' noise is.
    pub ambient_noise: Option<NoiseSettings>,
    /// Take-off and landing.
    pub profile: SpeedProfile,
    /// Scale all speeds by one factor, so that the mean of Σω² over the hover part is exactly that of the set mean
    /// speeds, as the balance of forces has it: without it the wander's own mean leaves the weight of each trial off by
    /// some 0.3 %. Costs a second run of the speeds, without sound.
    pub hold_hover_balance: bool,
    /// Largest sample that the lines can add up to, with six standard deviations of noise; full scale is 1.
    pub peak: f64,
    /// Time between rows of the truth, rounded to a whole sample.
    pub truth_step_s: f64,
    /// Everything random comes from here.
    pub seed: u64,
}

impl Default for HoverSettings {
    /// Ten seconds (the paper's trial) at 48 kHz, without rotors; peak 0.5 leaves 6 dB for whatever is done next.
    fn default() -> Self {
        Self {
            sample_rate_hz: 48_000,
            duration_s: 10.0,
            rotors: Vec::new(),
            tones: ToneSettings::default(),
            rotor_noise: Some(NoiseSettings::default()),
            ambient_noise: None,
            profile: SpeedProfile::default(),
            hold_hover_balance: false,
            peak: 0.5,
            truth_step_s: 0.01,
            seed: 1,
        }
    }
}

impl HoverSettings {
    /// All rotors of a vehicle at one mean speed, each with a wander of its own, and the lines that its gear and blades
    /// make.
    pub fn for_vehicle(vehicle: &Vehicle, mean_speed: RotorSpeed) -> Self {
        Self {
            rotors: vec![RotorSound::at(mean_speed); vehicle.rotor_count.value as usize],
            tones: ToneSettings::for_vehicle(vehicle),
            ..Self::default()
        }
    }

    fn check(&self) -> Result<(), QuantityError> {
        let refused = |name, value, must_be| Err(QuantityError { name, value, must_be });
        if !(8_000..=192_000).contains(&self.sample_rate_hz) {
            return refused("sample_rate_hz", f64::from(self.sample_rate_hz), "between 8000 and 192000");
        }
        if self.rotors.is_empty() {
            return refused("rotors", 0.0, "at least one");
        }
        if !(self.peak > 0.0 && self.peak <= 1.0) {
            return refused("peak", self.peak, "above 0, at most 1");
        }
        if !(self.truth_step_s.is_finite() && self.truth_step_s > 0.0) {
            return refused("truth_step_s", self.truth_step_s, "above 0");
        }
        if !(self.duration_s.is_finite() && self.duration_s * f64::from(self.sample_rate_hz) >= 0.5) {
            return refused("duration_s", self.duration_s, "at least one sample");
        }
        self.tones.check()?;
        for rotor in &self.rotors {
            let speed_rev_s = rotor.mean_speed.rev_s();
            if !(speed_rev_s > 0.0 && speed_rev_s < f64::from(self.sample_rate_hz) / 4.0) {
                return refused("mean_speed", speed_rev_s, "above 0 and below a quarter of the sample rate, in rev/s");
            }
            if !rotor.level_db.is_finite() {
                return refused("level_db", rotor.level_db, "a number");
            }
            // Above this the Gaussian wander would reach a standing rotor.
            if !(0.0..=0.1).contains(&rotor.wander_std_share) {
                return refused("wander_std_share", rotor.wander_std_share, "between 0 and 0.1");
            }
            if !(rotor.wander_time_constant_s.is_finite() && rotor.wander_time_constant_s > 0.0) {
                return refused("wander_time_constant_s", rotor.wander_time_constant_s, "above 0");
            }
        }
        Ok(())
    }
}

/// The sound as it is made: a fixed amount of state, whatever the length.
///
/// The same settings give the same samples on the same machine, whatever the sizes of the blocks they are asked for in;
/// a longer duration gives the same samples and more (unless there is a landing, or the hover balance is held).
pub struct HoverSound {
    settings: HoverSettings,
    parts: ProfileParts,
    gain: f64,
    rotors: Vec<(Shaft, RotorTones)>,
    rotor_noise: Option<Noise>,
    ambient_noise: Option<Noise>,
    sample_count: u64,
    truth_step: u64,
    /// Samples made so far, and those of the last block that were not handed out yet.
    made: u64,
    block: [f64; BLOCK],
    handed_out: usize,
    in_block: usize,
}

impl HoverSound {
    /// Draws all levels and phases and fixes the gain. Fails on a setting that is out of bounds, naming it.
    pub fn new(settings: HoverSettings) -> Result<Self, QuantityError> {
        settings.check()?;
        let parts = settings.profile.parts(settings.duration_s)?;
        let rate_hz = f64::from(settings.sample_rate_hz);
        let sample_count = (settings.duration_s * rate_hz).round() as u64;
        let mut rotors: Vec<_> = (0_u64..)
            .zip(&settings.rotors)
            .map(|(index, rotor)| (shaft(&settings, index, rotor), tones(&settings, index, rotor)))
            .collect();
        if settings.hold_hover_balance {
            let shafts: Vec<_> = rotors.iter().map(|(shaft, _)| shaft.clone()).collect();
            let wanted: f64 = shafts.iter().map(|shaft| (TAU * shaft.mean_rev_s()).powi(2)).sum();
            let found = hover_mean_sum_of_squares(&shafts, &parts, sample_count, rate_hz);
            for (shaft, _) in &mut rotors {
                shaft.scale_mean_speed((wanted / found).sqrt());
            }
        }
        let rotor_noise = noise(&settings, settings.rotor_noise, Part::RotorNoise)?;
        let ambient_noise = noise(&settings, settings.ambient_noise, Part::AmbientNoise)?;
        let noise_std: f64 = [&rotor_noise, &ambient_noise].into_iter().flatten().map(Noise::std).sum();
        let peak = rotors.iter().map(|(_, tones)| tones.peak()).sum::<f64>() + NOISE_PEAK_STD * noise_std;
        let gain = if peak > 0.0 { settings.peak / peak } else { 1.0 };
        let truth_step = ((settings.truth_step_s * rate_hz).round() as u64).max(1);
        Ok(Self {
            settings,
            parts,
            gain,
            rotors,
            rotor_noise,
            ambient_noise,
            sample_count,
            truth_step,
            made: 0,
            block: [0.0; BLOCK],
            handed_out: 0,
            in_block: 0,
        })
    }

    /// What is simulated.
    pub fn settings(&self) -> &HoverSettings {
        &self.settings
    }

    /// When take-off, hover and landing are.
    pub fn parts(&self) -> ProfileParts {
        self.parts
    }

    /// Full scale per unit of level: a line of level 1 comes out with this amplitude.
    pub fn gain(&self) -> f64 {
        self.gain
    }

    /// Samples of the whole sound.
    pub fn sample_count(&self) -> u64 {
        self.sample_count
    }

    /// The next samples, as many as fit, full scale ±1; returns how many, 0 at the end. The rows of the truth that came
    /// due are appended to `truth`, at most 48 samples ahead of the sound; keep them or clear them.
    pub fn render(&mut self, samples: &mut [f32], truth: &mut Vec<TruthRow>) -> usize {
        let mut written = 0;
        while written < samples.len() {
            if self.handed_out == self.in_block {
                self.make_block(truth);
                if self.in_block == 0 {
                    break;
                }
            }
            let count = (self.in_block - self.handed_out).min(samples.len() - written);
            let made = &self.block[self.handed_out..self.handed_out + count];
            for (sample, value) in samples[written..written + count].iter_mut().zip(made) {
                *sample = *value as f32;
            }
            self.handed_out += count;
            written += count;
        }
        written
    }

    /// The rest of the sound in one piece, for short ones.
    pub fn render_all(mut self) -> (Vec<f32>, Truth) {
        let left = self.sample_count - self.made + (self.in_block - self.handed_out) as u64;
        let (mut samples, mut rows) = (vec![0.0; left as usize], Vec::new());
        self.render(&mut samples, &mut rows);
        (samples, Truth::from_rows(rows))
    }

    fn make_block(&mut self, truth: &mut Vec<TruthRow>) {
        let sample_s = 1.0 / f64::from(self.settings.sample_rate_hz);
        let (start, parts) = (self.made, self.parts);
        let count = (self.sample_count - start).min(BLOCK as u64) as usize;
        self.handed_out = 0;
        self.in_block = count;
        if count == 0 {
            return;
        }
        let time_s = |offset: f64| (start as f64 + offset) * sample_s;
        let share: [f64; BLOCK] = std::array::from_fn(|k| parts.speed_share(time_s(k as f64)));
        let share_between: [f64; BLOCK] = std::array::from_fn(|k| parts.speed_share(time_s(k as f64 + 0.5)));
        let row_offsets: Vec<usize> =
            (0..count).filter(|&k| (start + k as u64).is_multiple_of(self.truth_step)).collect();
        let first_row = truth.len();
        let row = |offset: usize| TruthRow { time_s: time_s(offset as f64), rotors: Vec::new() };
        truth.extend(row_offsets.iter().map(|&offset| row(offset)));
        let at_end = start + count as u64 == self.sample_count;
        if at_end {
            truth.push(row(count));
        }

        let mut lines = [0.0; BLOCK];
        let silent = share.iter().all(|&share| share == 0.0);
        for (shaft, tones) in &mut self.rotors {
            shaft.begin_block();
            let mut turns = [0.0; BLOCK];
            let mut rows = truth[first_row..].iter_mut();
            let mut due = row_offsets.iter().peekable();
            for k in 0..count {
                if due.next_if(|&&offset| offset == k).is_some()
                    && let Some(row) = rows.next()
                {
                    row.rotors.push(shaft.truth(k, share[k]));
                }
                turns[k] = shaft.turn();
                shaft.advance(k, share_between[k], sample_s);
            }
            if let Some(row) = rows.next() {
                row.rotors.push(shaft.truth(count, parts.speed_share(time_s(count as f64))));
            }
            if !silent {
                tones.add(&turns, &mut lines);
            }
        }
        for k in 0..count {
            // Pressure of the lines goes with the square of the speed, power of the noise with its fifth (PHYSICS
            // section 8); the wander is too small for that to be heard and is left out, so that C/N0 is the set one.
            let loudness = share[k] * share[k];
            let mut value = loudness * lines[k];
            if let Some(noise) = &mut self.rotor_noise {
                value += loudness * share[k].sqrt() * noise.next();
            }
            if let Some(noise) = &mut self.ambient_noise {
                value += noise.next();
            }
            self.block[k] = self.gain * value;
        }
        self.made += count as u64;
    }
}

fn shaft(settings: &HoverSettings, index: u64, rotor: &RotorSound) -> Shaft {
    let step_s = BLOCK as f64 / f64::from(settings.sample_rate_hz);
    let random = stream(settings.seed, Part::Wander, index);
    let wander = OrnsteinUhlenbeck::new(rotor.wander_std_share, rotor.wander_time_constant_s, step_s, random);
    Shaft::new(rotor.mean_speed.rev_s(), wander)
}

fn tones(settings: &HoverSettings, index: u64, rotor: &RotorSound) -> RotorTones {
    let fastest_rev_s = rotor.mean_speed.rev_s() * (1.0 + WANDER_PEAK_STD * rotor.wander_std_share);
    let order_max = f64::from(settings.sample_rate_hz) / 2.0 / fastest_rev_s;
    let level = 10_f64.powf(rotor.level_db / 20.0);
    RotorTones::new(&settings.tones, level, order_max, &mut stream(settings.seed, Part::Tones, index))
}

fn noise(settings: &HoverSettings, noise: Option<NoiseSettings>, part: Part) -> Result<Option<Noise>, QuantityError> {
    let Some(noise) = noise else { return Ok(None) };
    noise.check()?;
    let Some((order, level)) = settings.tones.reference() else {
        return Err(QuantityError { name: "lines to measure the noise against", value: 0.0, must_be: "at least one" });
    };
    let speeds_rev_s = settings.rotors.iter().map(|rotor| rotor.mean_speed.rev_s());
    let mean_rev_s = speeds_rev_s.sum::<f64>() / settings.rotors.len() as f64;
    let rate_hz = f64::from(settings.sample_rate_hz);
    let density = noise.density_at_reference(level);
    let random = stream(settings.seed, part, 0);
    Ok(Some(Noise::new(density, order * mean_rev_s, noise.slope_db_per_octave, rate_hz, random)))
}
