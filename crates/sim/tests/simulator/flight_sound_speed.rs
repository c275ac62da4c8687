//! How fast the sound is made. Run with `cargo test --release -p hovertone-sim --test simulator flight_sound_speed -- --ignored`.

use hovertone_sim::{FlightSound, RotorState, SoundSettings, SoundState, SourceSettings};
use hovertone_vehicle::{RotorSpeed, find_preset};
use std::time::Instant;

/// Seconds that this thread was on a core, where the system tells (Linux); others' work on the machine is not counted.
fn busy_s(begin: Instant) -> f64 {
    let told = std::fs::read_to_string("/proc/thread-self/schedstat").ok();
    let nanoseconds = told.and_then(|line| line.split_whitespace().next()?.parse::<f64>().ok());
    nanoseconds.map_or_else(|| begin.elapsed().as_secs_f64(), |ns| ns * 1e-9)
}

#[test]
#[ignore = "a measurement, of the release build"]
fn a_laboratory_with_four_rotors_is_made_50_times_faster_than_it_sounds() {
    let hover = RotorSpeed::from_rpm(3610.0);
    let settings = SoundSettings::laboratory(SourceSettings::for_vehicle(find_preset("ardrone").unwrap(), hover));
    for (name, settings) in [
        ("laboratory", settings.clone()),
        ("no babble", SoundSettings { babble: None, ..settings.clone() }),
        ("no babble, no ambient noise", SoundSettings { babble: None, ambient: None, ..settings.clone() }),
        ("free field", SoundSettings::free_field(settings.source.clone(), &[[-3.5, 1.0, 2.0]])),
    ] {
        let seconds = 60;
        let begin = Instant::now();
        let busy_before_s = busy_s(begin);
        let mut sound = FlightSound::new(settings).unwrap();
        let mut out = Vec::new();
        let mut energy = 0.0;
        for step in 0..=1000 * seconds {
            let time_s = f64::from(step) * 0.001;
            let rotor = |number: u32| {
                let angle = f64::from(number) * std::f64::consts::FRAC_PI_2;
                RotorState {
                    speed_rad_s: hover.rad_s() * (1.0 + 0.01 * (time_s * 3.0 + angle).sin()),
                    position_m: [0.18 * angle.cos(), 0.18 * angle.sin(), 1.0 + 0.1 * time_s.sin()],
                    axis: [0.02, 0.0, 1.0],
                }
            };
            sound.push(&SoundState { time_s, rotors: (0..4).map(rotor).collect() }, &mut out).unwrap();
            energy += out[0].drain(..).map(f64::from).map(|value| value * value).sum::<f64>();
        }
        sound.finish(&mut out);
        let factor = f64::from(seconds) / (busy_s(begin) - busy_before_s);
        println!("{name}: {factor:.0} times real time, rms {:.4}", (energy / 48_000.0 / f64::from(seconds)).sqrt());
        assert!(factor >= 50.0, "{name}: {factor}");
    }
}
