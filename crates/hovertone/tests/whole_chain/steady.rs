//! Rotors that hold their speed: weak ones in falling noise, and ones whose blade pass is heard beside their gear.
use crate::testkit::{SAMPLE_RATE_HZ, analyse, config, rotor, sound, tone};
use hovertone::speed::{Config, Outcome};
use hovertone_sim::prescribed::{Noise, Recording, Sampling};
use rand::{RngExt, SeedableRng};

const LENGTH_S: f64 = 5.0;
/// Falling noise is flat below 20 Hz.
const CORNER_HZ: f64 = 20.0;

fn blade_pass() -> Vec<(f64, f64)> {
    (1..=20).map(|k| (2.0 * f64::from(k), 0.01 / f64::from(k))).collect()
}

#[test]
fn a_blade_pass_far_below_falling_noise_is_read_at_its_own_speed_or_not_at_all() {
    let lines = blade_pass();
    let config = Config { all_methods: false, ..config(2.0) };
    let noise_std = 10.0 * lines.iter().map(|(_, amplitude)| amplitude * amplitude / 2.0).sum::<f64>().sqrt();
    let noise = Noise::falling(noise_std, CORNER_HZ, SAMPLE_RATE_HZ);
    let mut right = 0;
    for seed in 0..12 {
        let mut random = rand_pcg::Pcg64::seed_from_u64(500 + seed);
        let speed_rev_s = random.random_range(50.0..70.0);
        let rotor = rotor(|_| speed_rev_s, &lines);
        let mut recording = Recording::of_rotors(&[rotor], Sampling::new(SAMPLE_RATE_HZ, LENGTH_S));
        recording.add_noise(&noise, &mut random);
        if let Outcome::Ok(tone) = &analyse(recording.samples_f32(), &config).outcome {
            let got = tone.speeds[0].speed.rev_s();
            assert!((got / speed_rev_s - 1.0).abs() < 1e-4, "{seed}: {got} for {speed_rev_s}");
            right += 1;
        }
    }
    assert!(right >= 5, "{right} of 12 answered");
}

#[test]
fn every_fourth_line_of_a_blade_pass_is_no_other_sound() {
    let mut lines = blade_pass();
    lines.extend([(69.0, 0.01), (138.0, 0.005), (207.0, 0.0025)]);
    let mut config = Config { all_methods: false, ..config(69.0) };
    config.tone.blades = Some(2);
    for speed_rev_s in [50.258, 51.124, 52.121] {
        let rotor = rotor(|_| speed_rev_s, &lines);
        let got = tone(&analyse(sound(&[rotor], LENGTH_S, 0.01, 1), &config)).speeds[0].speed.rev_s();
        assert!((got / speed_rev_s - 1.0).abs() < 1e-5, "{got} for {speed_rev_s}");
    }
}
