use super::*;
use crate::seed::{Part, stream};
use hovertone_vehicle::{RotorSpeed, find_preset};
use std::f64::consts::TAU;

fn bank(sample_rate_hz: f64, unsteadiness: f64) -> LineBank {
    bank_of_unlike_blades(sample_rate_hz, unsteadiness, 0.0)
}

fn bank_of_unlike_blades(sample_rate_hz: f64, unsteadiness: f64, unlike_blades_level: f64) -> LineBank {
    let vehicle = find_preset("ardrone").unwrap();
    let mut settings = SourceSettings::for_vehicle(vehicle, RotorSpeed::from_rev_s(60.0));
    settings.unsteadiness = unsteadiness;
    settings.tones.unlike_blades_level = unlike_blades_level;
    LineBank::new(&settings, sample_rate_hz, stream(5, Part::Tones, 2))
}

/// The slow definition: one cosine per line.
fn slow(bank: &LineBank, turn: f64) -> (f64, f64) {
    let (mut blades, mut other) = (0.0, 0.0);
    for (index, (line, amplitude)) in bank.lines.iter().zip(&bank.amplitudes).enumerate() {
        let (sine, cosine) = (TAU * (line.order * turn).fract()).sin_cos();
        let value = f64::from(amplitude.re) * cosine - f64::from(amplitude.im) * sine;
        let is_of_blades = (1..=bank.blade_lines).contains(&index) || index >= bank.lines.len() - bank.unlike_lines;
        if is_of_blades { blades += value } else { other += value }
    }
    (blades, other)
}

#[test]
fn the_fast_sum_is_the_slow_one() {
    for (unsteadiness, unlike_blades_level, unlike_lines) in
        [(0.0, 0.0, 0), (0.2, 0.0, 0), (0.0, 0.5, 38), (0.2, 0.5, 38)]
    {
        let mut bank = bank_of_unlike_blades(48_000.0, unsteadiness, unlike_blades_level);
        let turns = std::array::from_fn(|sample| 1234.5 + sample as f64 * 60.0 / 48_000.0);
        let (mut blades, mut other) = ([0.0; CHUNK], [0.0; CHUNK]);
        bank.sum(&turns, CHUNK, 0.4, 60.0, &mut blades, &mut other);
        let unit = amplitude_pa(53.0);
        for (sample, &turn) in turns.iter().enumerate() {
            let (slow_blades, slow_other) = slow(&bank, turn);
            // 45 lines of about one unit, each with the phasor's error of 3e-7 times its number in Horner's chain.
            assert!((f64::from(blades[sample]) - slow_blades).abs() < 1e-4 * unit);
            assert!((f64::from(other[sample]) - slow_other).abs() < 1e-4 * unit);
        }
        assert!(blades.iter().any(|value| f64::from(value.abs()) > unit));
        // 1 shaft, 20 blade pass, 3 x (1 + 4 + 2) mesh, 2 motor; unlike blades from order 2 to 39.
        assert_eq!(bank.lines.len(), 44 + unlike_lines);
    }
}

/// Odd orders at 0.5 of the level that the blade pass has there, silent at its own orders; no other line changes.
#[test]
fn unlike_blades_have_lines_at_the_other_orders() {
    let (alike, unlike) = (bank(48_000.0, 0.0), bank_of_unlike_blades(48_000.0, 0.0, 0.5));
    assert!(alike.lines.iter().zip(&unlike.lines).all(|(alike, unlike)| alike.mean == unlike.mean));
    let lines = &unlike.lines[alike.lines.len()..];
    assert_eq!(lines.len(), 38);
    let level = |line: &Line| f64::from(line.mean.re).hypot(f64::from(line.mean.im)) / amplitude_pa(53.0);
    for (order, line) in (2_u32..).zip(lines) {
        assert_eq!(line.order, f64::from(order));
        if order.is_multiple_of(2) {
            assert_eq!(level(line), 0.0);
        } else {
            let ratio_db = 20.0 * (level(line) / (0.5 * 2.0 * (f64::from(order) / 2.0).powf(-0.7))).log10();
            // the spread of 3 dB
            assert!(ratio_db.abs() < 5.0 * 3.0, "{order}: {ratio_db} dB");
        }
    }
}

#[test]
fn lines_near_half_the_sample_rate_fade_and_change_no_other() {
    let (mut all, mut some) = (bank(48_000.0, 0.0), bank(16_000.0, 0.0));
    all.set_amplitudes(0.0, 60.0);
    some.set_amplitudes(0.0, 60.0);
    let mut cut = 0;
    for ((line, all), some) in all.lines.iter().zip(&all.amplitudes).zip(&some.amplitudes) {
        if line.order * 60.0 >= 8000.0 {
            assert_eq!(*some, Complex::default());
            cut += 1;
        } else if line.order * 60.0 <= FADE_FROM * 16_000.0 {
            assert_eq!(some, all);
        }
    }
    assert!(cut > 10);
}

/// N draws with the correlation time 2τ (of y²: ∫(1+t/τ)² e^(-2t/τ) = 2.5 τ, twice) have the variance's relative
/// standard error √(2 · 2.5 τ / T).
#[test]
fn unsteadiness_has_the_set_size_and_is_slow() {
    let mut bank = bank(48_000.0, 0.1);
    let (count, tau_steps) = (20_000, 48_000.0 / UNSTEADY_STEP as f64);
    let (mut square, mut jump) = (0.0, 0.0_f64);
    for _ in 0..count {
        bank.step();
        for line in &bank.lines {
            square += line.re.now.powi(2) + line.im.now.powi(2);
            jump = jump.max((line.re.now - line.re.before).abs());
        }
    }
    let variance = square / f64::from(count) / (2.0 * bank.lines.len() as f64);
    let relative_error = (5.0 * tau_steps / f64::from(count) / (2.0 * bank.lines.len() as f64)).sqrt();
    assert!((variance - 1.0).abs() < 5.0 * relative_error, "{variance} ± {relative_error}");
    // The slope's standard deviation is 1/τ.
    assert!(jump < 7.0 / tau_steps, "{jump}");
}
