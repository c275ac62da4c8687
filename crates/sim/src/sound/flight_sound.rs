//! The sound of a flight: states in, samples out.

use super::babble::Babble;
use super::interpolator::{Interpolator, REACH};
use super::level::rms_pa;
use super::microphone::Microphone;
use super::noise_colour::ColouredNoise;
use super::path::{Path, Received};
use super::reverberation::Reverberation;
use super::room::Surroundings;
use super::settings::SoundSettings;
use super::source::{Source, Stretch};
use super::state::{RotorState, SoundState, difference, norm};
use crate::seed::{Part, stream};
use hovertone_vehicle::QuantityError;
use std::collections::VecDeque;

/// Largest number of samples finished at once.
const BLOCK: usize = 256;
/// Time for the filters of the microphones to settle; rendered before the first sample and dropped.
const SETTLING_S: f64 = 0.1;
/// Slope of the noise of wind: turbulence has a power of f^(−5/3).
const WIND_SLOPE_DB: f64 = -5.0;
/// Frequency below which the noise of wind is flat: gusts, which no recorder hears.
const WIND_FLAT_BELOW_HZ: f64 = 10.0;
/// Largest distance outdoors; it bounds the memory.
const DISTANCE_M_MAX: f64 = 1000.0;
/// Largest speed of a rotor's hub, as a share of the speed of sound.
const MACH_MAX: f64 = 0.5;

/// The sound of a flight, made state by state. Its memory depends on the largest distance in the scene and on the longest
/// step between two states, not on the length.
///
/// Before the first state, the rotors are assumed to have stayed at their places, turning at the speeds of the first state,
/// so a recording that begins in hover has its full sound from the first sample. The same settings and states give the
/// same samples, for any division of the calls.
///
/// ```
/// use hovertone_sim::{FlightSound, RotorState, SoundSettings, SoundState, SourceSettings};
/// use hovertone_vehicle::{RotorSpeed, find_preset};
///
/// let hover = RotorSpeed::from_rpm(3610.0);
/// let vehicle = find_preset("ardrone").ok_or("no such vehicle")?;
/// let mut sound = FlightSound::new(SoundSettings::laboratory(SourceSettings::for_vehicle(vehicle, hover)))?;
/// let mut channels = Vec::new();
/// let rotor = RotorState { speed_rad_s: hover.rad_s(), position_m: [0.0, 0.0, 1.0], axis: [0.0, 0.0, 1.0] };
/// for millisecond in 0..=100 {
///     sound.push(&SoundState { time_s: f64::from(millisecond) / 1000.0, rotors: vec![rotor; 4] }, &mut channels)?;
/// }
/// sound.finish(&mut channels);
/// assert_eq!(channels[0].len(), 4800);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub struct FlightSound {
    settings: SoundSettings,
    sample_rate_hz: f64,
    interpolator: Interpolator,
    channels: Vec<Channel>,
    babble: Option<Babble>,
    /// Present after the first state.
    flight: Option<Flight>,
}

/// Times count in samples from the first state.
struct Flight {
    origin_s: f64,
    sources: Vec<Source>,
    paths: Vec<Path>,
    /// States whose sound has not yet gone to the microphones, and the last state before them.
    knots: VecDeque<Knot>,
    /// First sample that the sources have not yet made.
    synthesised: i64,
    /// Sound for the diffuse field, from sample `finished` on.
    diffuse: VecDeque<f32>,
    /// First sample that has not yet been handed out.
    finished: i64,
}

struct Knot {
    at: f64,
    rotors: Vec<RotorState>,
}

struct Channel {
    received: Received,
    tail: Option<Reverberation>,
    ambient: Option<ColouredNoise>,
    wind: Option<ColouredNoise>,
    /// The babble at 1 m, before its delay.
    babble: VecDeque<f32>,
    babble_gain: f32,
    microphone: Microphone,
}

impl FlightSound {
    /// Fails on a setting that is out of bounds, naming it.
    pub fn new(settings: SoundSettings) -> Result<Self, QuantityError> {
        settings.check()?;
        let rate = f64::from(settings.sample_rate_hz);
        let channels = (0..settings.microphones.len()).map(|index| Channel::new(&settings, index, rate)).collect();
        let babble = settings.babble.as_ref().map(|babble| Babble::new(babble, rate, settings.seed));
        let interpolator = Interpolator::new();
        Ok(Self { settings, sample_rate_hz: rate, interpolator, channels, babble, flight: None })
    }

    /// The settings.
    pub fn settings(&self) -> &SoundSettings {
        &self.settings
    }

    /// Goes on to this state and appends the finished samples, full scale ±1, to `out`, one channel per microphone. Finished
    /// are the samples before the state's time, except the last ones (ten samples more than the longest step).
    ///
    /// Fails and changes nothing if the state is not a number, goes back in time, has another number of rotors, is outside
    /// of the room, or has a rotor that moves faster than half the speed of sound.
    pub fn push(&mut self, state: &SoundState, out: &mut Vec<Vec<f32>>) -> Result<(), QuantityError> {
        let state = state.checked()?;
        self.check_places(&state)?;
        out.resize_with(out.len().max(self.channels.len()), Vec::new);
        match &self.flight {
            None => self.begin(state),
            Some(flight) => {
                let at = (state.time_s - flight.origin_s) * self.sample_rate_hz;
                self.check_motion(flight, &state, at)?;
                self.advance(Knot { at, rotors: state.rotors });
            }
        }
        self.finish_until_known(None, out);
        Ok(())
    }

    /// Appends the remaining samples. In total there are all samples from the first state to before the last state.
    pub fn finish(mut self, out: &mut Vec<Vec<f32>>) {
        out.resize_with(out.len().max(self.channels.len()), Vec::new);
        let Some(knot) = self.flight.as_ref().and_then(|flight| flight.knots.back()) else { return };
        let end = samples_before(knot.at);
        let rotors = knot.rotors.clone();
        let mut at = knot.at;
        // The last state is held until its sound has arrived everywhere.
        for _ in 0..2 {
            at += 4.0 * REACH as f64;
            self.advance(Knot { at, rotors: rotors.clone() });
        }
        self.finish_until_known(Some(end), out);
    }

    /// Number of samples in all buffers; does not grow with the length of the sound.
    pub fn buffered_samples(&self) -> usize {
        let channels: usize = self
            .channels
            .iter()
            .map(|channel| {
                let tail = channel.tail.as_ref().map_or(0, Reverberation::buffered);
                channel.received.buffered() + channel.babble.len() + tail
            })
            .sum();
        let flight = self
            .flight
            .as_ref()
            .map_or(0, |flight| flight.diffuse.len() + flight.sources.iter().map(Source::buffered).sum::<usize>());
        channels + flight
    }

    fn check_places(&self, state: &SoundState) -> Result<(), QuantityError> {
        for rotor in &state.rotors {
            self.settings.surroundings.check_place("rotor position_m", rotor.position_m)?;
            for microphone in &self.settings.microphones {
                let distance_m = norm(difference(rotor.position_m, microphone.position_m));
                if distance_m > DISTANCE_M_MAX {
                    let name = "the distance of a rotor from a microphone in m";
                    return Err(QuantityError { name, value: distance_m.round(), must_be: "at most 1000" });
                }
            }
        }
        Ok(())
    }

    fn check_motion(&self, flight: &Flight, state: &SoundState, at: f64) -> Result<(), QuantityError> {
        let Some(before) = flight.knots.back() else { return Ok(()) };
        let step = at - before.at;
        if step.is_nan() || step <= 0.0 {
            return Err(QuantityError { name: "time_s", value: state.time_s, must_be: "later than the state before" });
        }
        if state.rotors.len() != before.rotors.len() {
            let (name, value) = ("rotors", state.rotors.len() as f64);
            return Err(QuantityError { name, value, must_be: "as many as in the first state" });
        }
        for (before, after) in before.rotors.iter().zip(&state.rotors) {
            let moved_m = norm(difference(after.position_m, before.position_m));
            let mach = moved_m / (step / self.sample_rate_hz) / self.settings.speed_of_sound_m_s;
            if mach > MACH_MAX {
                let name = "the speed of the vehicle as a Mach number";
                return Err(QuantityError { name, value: mach, must_be: "at most 0.5" });
            }
        }
        Ok(())
    }

    /// Holds the first state until its sound has filled the place.
    fn begin(&mut self, state: SoundState) {
        let settings = &self.settings;
        let samples_per_m = self.sample_rate_hz / settings.speed_of_sound_m_s;
        let mut paths = Vec::new();
        for (index, microphone) in settings.microphones.iter().enumerate() {
            for mirror in settings.surroundings.ways() {
                for rotor in 0..state.rotors.len() {
                    paths.push(Path::new(rotor, index, microphone.position_m, mirror, samples_per_m));
                }
            }
        }
        let longest = paths.iter().map(|path| path.arrival(&state.rotors[path.rotor], 0.0).at).fold(0.0, f64::max);
        let settling = (SETTLING_S * self.sample_rate_hz) as i64;
        let tail_s = match settings.surroundings {
            Surroundings::Room(room) => room.reverberation_s.unwrap_or(0.0),
            _ => 0.0,
        };
        let fill = longest.ceil() as i64 + 4 * REACH as i64 + (tail_s * self.sample_rate_hz) as i64;
        let start = -settling - fill;
        for path in &mut paths {
            path.last = path.arrival(&state.rotors[path.rotor], start as f64);
        }
        let source = |(number, rotor): (u64, &RotorState)| {
            Source::new(&settings.source, self.sample_rate_hz, settings.seed, number, start, rotor.speed_rad_s)
        };
        for channel in &mut self.channels {
            channel.received = Received::from(-settling);
        }
        self.flight = Some(Flight {
            origin_s: state.time_s,
            sources: (0..).zip(&state.rotors).map(source).collect(),
            paths,
            knots: VecDeque::from([Knot { at: start as f64, rotors: state.rotors.clone() }]),
            synthesised: start,
            diffuse: VecDeque::new(),
            finished: start,
        });
        self.advance(Knot { at: 0.0, rotors: state.rotors });
        self.fill_tails(-settling);
    }

    /// Makes the radiated sound up to this state, and passes the readable part on to the microphones.
    fn advance(&mut self, knot: Knot) {
        let Some(flight) = &mut self.flight else { return };
        let Some(before) = flight.knots.back() else { return };
        let stretch = Stretch { from: before.at, to: knot.at };
        let (first, end) = (flight.synthesised, samples_before(knot.at));
        let mut diffuse = vec![0.0; (end - first).max(0) as usize];
        for (number, source) in flight.sources.iter_mut().enumerate() {
            let speeds = [before.rotors[number].speed_rad_s, knot.rotors[number].speed_rad_s];
            source.extend(stretch, speeds, first, end, &self.interpolator, &mut diffuse);
        }
        flight.diffuse.extend(diffuse);
        flight.synthesised = end;
        flight.knots.push_back(knot);
        let readable_end = flight.sources.first().map_or(i64::MAX, Source::readable_end);
        while flight.knots.len() >= 2 && flight.knots[1].at + 1.5 <= readable_end as f64 {
            let stretch = Stretch { from: flight.knots[0].at, to: flight.knots[1].at };
            for path in &mut flight.paths {
                let arrival = path.arrival(&flight.knots[1].rotors[path.rotor], stretch.to);
                let emission = flight.sources[path.rotor].emission();
                path.receive(stretch, arrival, emission, &mut self.channels[path.microphone].received);
            }
            flight.knots.pop_front();
        }
        let needed = flight.knots[0].at.floor() as i64 - 2;
        for source in &mut flight.sources {
            source.forget_before(needed);
        }
    }

    /// Runs the tails up to this sample without output.
    fn fill_tails(&mut self, until: i64) {
        let Some(flight) = &mut self.flight else { return };
        let count = (until - flight.finished).clamp(0, flight.diffuse.len() as i64);
        let sent: Vec<f32> = flight.diffuse.drain(..count as usize).collect();
        for tail in self.channels.iter_mut().filter_map(|channel| channel.tail.as_mut()) {
            tail.add(&sent, &mut vec![0.0; sent.len()]);
        }
        flight.finished = until;
    }

    /// Hands out the samples that all paths have passed, but none at or after the last state (or `end`).
    fn finish_until_known(&mut self, end: Option<i64>, out: &mut [Vec<f32>]) {
        let Some(flight) = &mut self.flight else { return };
        let arrived = flight.paths.iter().map(|path| path.last.at.ceil() as i64).min().unwrap_or(i64::MAX);
        let newest = end.unwrap_or(flight.synthesised);
        let known = arrived.min(newest);
        while flight.finished < known {
            let count = (known - flight.finished).min(BLOCK as i64) as usize;
            let mut sent = [0.0; BLOCK];
            for (sent, diffuse) in sent.iter_mut().zip(flight.diffuse.drain(..count)) {
                *sent = diffuse;
            }
            let mut talk = [0.0; BLOCK];
            if let Some(babble) = &mut self.babble {
                babble.fill(&mut talk[..count]);
            }
            let unheard = (-flight.finished).clamp(0, count as i64) as usize;
            for (channel, out) in self.channels.iter_mut().zip(out.iter_mut()) {
                channel.finish(&sent[..count], &talk[..count], unheard, out);
            }
            flight.finished += count as i64;
        }
    }
}

/// Number of whole samples before a time in samples. A time computed from seconds may miss a whole number by rounding.
fn samples_before(at: f64) -> i64 {
    (at - 1e-6).ceil() as i64
}

impl Channel {
    fn new(settings: &SoundSettings, index: usize, sample_rate_hz: f64) -> Self {
        let microphone = &settings.microphones[index];
        let ambient = settings.ambient.map(|noise| {
            let random = stream(settings.seed, Part::AmbientNoise, index as u64);
            let (std, slope) = (rms_pa(noise.level_db_spl), noise.slope_db_per_octave);
            ColouredNoise::new(std, slope, noise.flat_below_hz, sample_rate_hz, random)
        });
        let wind = microphone.wind_noise_db_spl.map(|level_db_spl| {
            let random = stream(settings.seed, Part::WindNoise, index as u64);
            ColouredNoise::new(rms_pa(level_db_spl), WIND_SLOPE_DB, WIND_FLAT_BELOW_HZ, sample_rate_hz, random)
        });
        let tail = match settings.surroundings {
            Surroundings::Room(room) => room.reverberation_s.map(|tail_s| {
                Reverberation::new(tail_s, room.tail_power(tail_s), sample_rate_hz, settings.seed, index as u64)
            }),
            _ => None,
        };
        let (mut babble, mut babble_gain) = (VecDeque::new(), 0.0);
        if let Some(talk) = &settings.babble {
            // Whole samples are exact enough for speech.
            let distance_m = norm(difference(talk.position_m, microphone.position_m));
            let delay = distance_m / settings.speed_of_sound_m_s * sample_rate_hz;
            babble.resize(delay.round() as usize, 0.0);
            babble_gain = (1.0 / distance_m.max(0.1)) as f32;
        }
        Self {
            received: Received::from(0),
            tail,
            ambient,
            wind,
            babble,
            babble_gain,
            microphone: Microphone::new(microphone, sample_rate_hz, settings.seed, index as u64),
        }
    }

    /// Finishes one sample for each of `sent` to the diffuse field; drops the first `unheard` ones.
    fn finish(&mut self, sent: &[f32], talk: &[f32], unheard: usize, out: &mut Vec<f32>) {
        let count = sent.len();
        let mut pressure = [0.0; BLOCK];
        let pressure = &mut pressure[..count];
        self.received.take(pressure);
        if let Some(tail) = &mut self.tail {
            tail.add(sent, pressure);
        }
        for source in [&mut self.ambient, &mut self.wind].into_iter().flatten() {
            let mut noise = [0.0; BLOCK];
            source.fill(&mut noise[..count]);
            for (pressure, noise) in pressure.iter_mut().zip(&noise) {
                *pressure += noise;
            }
        }
        if self.babble_gain > 0.0 {
            self.babble.extend(talk);
            for (pressure, talk) in pressure.iter_mut().zip(self.babble.drain(..count)) {
                *pressure += self.babble_gain * talk;
            }
        }
        for (number, &pressure) in pressure.iter().enumerate() {
            let sample = self.microphone.sample(pressure);
            if number >= unheard {
                out.push(sample);
            }
        }
    }
}
