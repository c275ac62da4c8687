//! How often each analysis reads the sound, and that the progress it reports says so.

use crate::testkit::{SAMPLE_RATE_HZ, TWO_BLADES, rotor, sound, steady, tone};
use hovertone::rotors::{
    MicrophonesConfig, conditions_from_analysis, microphone_lines_from_source, passes_of_spin_up, speed_after_spin_up,
};
use hovertone::sound::{Passes, Progress, Signal, SignalSource, SourceError};
use hovertone::speed::{Config, Method, Outcome, ToneConfig, passes_of_speed, speed_from_passes, speed_from_source};
use hovertone::tones::{Discovery, tones_from_source};
use hovertone_vehicle::Order;

/// Counts how often a source is read from its start.
struct Counted {
    signal: Signal,
    passes: u32,
}

impl Counted {
    fn new(samples: Vec<f32>) -> Self {
        Self { signal: Signal::new(samples, SAMPLE_RATE_HZ), passes: 0 }
    }
}

impl SignalSource for Counted {
    fn sample_rate_hz(&self) -> f64 {
        self.signal.sample_rate_hz()
    }

    fn start_s(&self) -> f64 {
        self.signal.start_s()
    }

    fn next_block(&mut self) -> Result<Option<&[f32]>, SourceError> {
        self.signal.next_block()
    }

    fn rewind(&mut self) -> Result<(), SourceError> {
        self.passes += 1;
        self.signal.rewind()
    }
}

/// What a progress display saw.
#[derive(Default)]
struct Seen(Vec<(u32, u32)>);

impl Seen {
    fn take(&mut self, progress: Progress) {
        let now = (progress.pass, progress.pass_count);
        if self.0.last() != Some(&now) {
            self.0.push(now);
        }
    }

    /// Every pass shows once, in order, and none as more than there are.
    fn assert_counts(&self, passes: u32) {
        let numbers: Vec<u32> = self.0.iter().map(|(pass, _)| *pass).collect();
        assert_eq!(numbers, (1..=passes).collect::<Vec<u32>>(), "{:?}", self.0);
        assert!(self.0.iter().all(|(pass, of)| pass <= of), "{:?}", self.0);
        assert_eq!(self.0.last().map(|(_, of)| *of), Some(passes), "{:?}", self.0);
    }
}

fn blade_pass() -> Config {
    Config::for_tone(ToneConfig::of_order(Order::from_blades(2).unwrap()))
}

fn four_rotors() -> (Vec<f32>, Config) {
    let speeds: [&dyn Fn(f64) -> f64; 4] = [&|_| 67.3, &|_| 68.5, &|_| 69.8, &|_| 71.2];
    let rotors = speeds.map(|speed_rev_s| rotor(speed_rev_s, &TWO_BLADES));
    let mut config = blade_pass();
    (config.rotors.count, config.method) = (4, Method::Separated);
    (sound(&rotors, 8.0, 0.02, 3), config)
}

fn passes_of(samples: Vec<f32>, config: &Config) -> (u32, Seen) {
    let (mut source, mut seen) = (Counted::new(samples), Seen::default());
    let analysis = speed_from_source(&mut source, config, &mut |progress| seen.take(progress)).unwrap();
    tone(&analysis);
    (source.passes, seen)
}

#[test]
fn one_rotor_takes_two_passes_by_any_method() {
    for method in [Method::Harmonic, Method::MaximumTrace, Method::Gaussian] {
        let config = Config { method, all_methods: true, ..blade_pass() };
        let (passes, seen) = passes_of(steady(67.3, 5.0, 0.01), &config);
        assert_eq!((passes, passes_of_speed(&config)), (2, 2));
        seen.assert_counts(2);
    }
}

#[test]
fn four_rotors_take_four_passes() {
    let (samples, config) = four_rotors();
    let (passes, seen) = passes_of(samples, &config);
    assert_eq!((passes, passes_of_speed(&config)), (4, 4));
    seen.assert_counts(4);
}

#[test]
fn a_weak_steady_tone_takes_no_pass_more() {
    let lines: Vec<(f64, f64)> = (1..=20).map(|k| (2.0 * f64::from(k), 0.01 / f64::from(k))).collect();
    let rotor = rotor(|_| 67.3, &lines);
    let (mut source, mut seen) = (Counted::new(sound(&[rotor], 12.0, 0.12, 5)), Seen::default());
    let analysis = speed_from_source(&mut source, &blade_pass(), &mut |progress| seen.take(progress)).unwrap();
    tone(&analysis);
    assert_eq!(source.passes, 2);
    assert_eq!(seen.0, [(1, 2), (2, 2)]);
}

#[test]
fn a_tone_that_is_found_takes_no_pass_more() {
    let (mut source, mut seen) = (Counted::new(steady(67.3, 5.0, 0.01)), Seen::default());
    let on_progress = &mut |progress| seen.take(progress);
    let found = tones_from_source(&mut source, &blade_pass(), &Discovery::default(), on_progress).unwrap();
    assert!(matches!(found.analysis.outcome, Outcome::Ok(_)));
    assert_eq!(source.passes, 2);
    seen.assert_counts(2);
}

#[test]
fn condition_takes_one_pass_after_the_speeds() {
    let (samples, config) = four_rotors();
    let (mut source, mut seen) = (Counted::new(samples), Seen::default());
    let mut on_progress = |progress| seen.take(progress);
    let mut passes = Passes::planned(&mut source, passes_of_speed(&config) + 1, &mut on_progress).unwrap();
    let analysis = speed_from_passes(&mut passes, &config).unwrap();
    let conditions = conditions_from_analysis(&mut passes, &analysis, &config.tone).unwrap();
    assert_eq!(conditions.iter().flatten().count(), 4);
    assert_eq!(source.passes, 5);
    seen.assert_counts(5);
}

#[test]
fn starts_of_the_motors_take_eight_passes_in_all() {
    // silent for 1 s, then one motor each second; rotors that do not turn yet have a speed of 0 and sound nothing
    let started: [&dyn Fn(f64) -> f64; 4] = [
        &|t| if t < 1.0 { 0.0 } else { 67.3 },
        &|t| if t < 2.0 { 0.0 } else { 68.8 },
        &|t| if t < 3.0 { 0.0 } else { 70.4 },
        &|t| if t < 4.0 { 0.0 } else { 72.1 },
    ];
    let rotors = started.map(|speed_rev_s| rotor(speed_rev_s, &TWO_BLADES));
    let (_, config) = four_rotors();
    let (mut source, mut seen) = (Counted::new(sound(&rotors, 16.0, 0.02, 7)), Seen::default());
    let mut on_progress = |progress| seen.take(progress);
    let mut passes = Passes::planned(&mut source, passes_of_spin_up(&config), &mut on_progress).unwrap();
    let (_, spin_up) = speed_after_spin_up(&mut passes, &config).unwrap();
    assert_eq!(spin_up.not_told, None);
    assert_eq!(spin_up.starts.len(), 4);
    assert_eq!((source.passes, passes_of_spin_up(&config)), (8, 8));
    seen.assert_counts(8);
}

#[test]
fn each_microphone_takes_one_pass() {
    let (samples, config) = four_rotors();
    let analysis = speed_from_source(&mut Counted::new(samples.clone()), &config, &mut |_| {}).unwrap();
    let tracks: Vec<_> = tone(&analysis).rotors.iter().map(|rotor| rotor.track.as_slice()).collect();
    let (mut source, mut seen) = (Counted::new(samples), Seen::default());
    let microphones = MicrophonesConfig::default();
    let on_progress = &mut |progress| seen.take(progress);
    microphone_lines_from_source(&mut source, &tracks, &config.tone, &microphones, on_progress).unwrap();
    assert_eq!(source.passes, 1);
    seen.assert_counts(1);
}
