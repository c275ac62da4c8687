//! The Cramér-Rao bound: how well any unbiased method could know the speed of a steady rotor.

use super::sound::{DURATION_S, Noise};
use hovertone_sim::prescribed::Line;
use std::f64::consts::PI;

/// Smallest standard deviation of the shaft speed, turns per second, from lines of unknown levels and phases at known
/// orders: `var(f) ≥ 3 / (π² T³ Σ A² o² / Φ(o f))` with the noise's one-sided density Φ at each line (Whittle; for
/// white noise the exact bound of N ≫ 1 samples).
pub(super) fn speed_bound_rev_s(lines: &[Line], noise: &Noise, speed_rev_s: f64) -> f64 {
    let information: f64 =
        lines.iter().map(|line| (line.level * line.order).powi(2) / noise.density(line.order * speed_rev_s)).sum();
    (3.0 / (PI * PI * DURATION_S.powi(3) * information)).sqrt()
}

#[cfg(test)]
mod tests {
    use super::super::sound::{Colour, series, tone_power};
    use super::*;

    fn bound_rpm(order: u32, levels: &[f64], snr_db: f64) -> f64 {
        let lines = series(order, levels);
        let noise = Noise { colour: Colour::White, power: tone_power(&lines) / 10_f64.powf(snr_db / 10.0) };
        60.0 * speed_bound_rev_s(&lines, &noise, 60.1724)
    }

    /// 5 s at 48 kHz. Closed form checked against a numerical Fisher matrix by `prototypes/crb.py`, whose table has
    /// three digits.
    #[test]
    fn the_bound_is_that_of_the_table() {
        assert!((bound_rpm(69, &[1.0], 0.0) / 60.0 - 3.262e-6).abs() < 5e-10);
        let over_number: Vec<f64> = (1..=20).map(|number| 1.0 / f64::from(number)).collect();
        for (order, levels, snr_db, rpm) in [
            (2, vec![1.0], 0.0, 6.75e-3),
            (2, vec![1.0; 20], -20.0, 5.64e-3),
            (2, over_number.clone(), 0.0, 1.91e-3),
            (2, over_number, 20.0, 1.91e-4),
            (69, vec![1.0], -10.0, 6.19e-4),
            (69, vec![1.0, 0.5, 0.25], -20.0, 1.40e-3),
            (69, vec![1.0, 0.5, 0.25], 10.0, 4.43e-5),
        ] {
            let found = bound_rpm(order, &levels, snr_db);
            assert!((found / rpm - 1.0).abs() < 5e-3, "order {order}, {snr_db} dB: {found} for {rpm}");
        }
    }

    /// Where the noise falls by 6 dB per octave, a line an octave higher tells as much at a quarter of the level.
    #[test]
    fn in_falling_noise_each_line_counts_against_the_noise_around_it() {
        let noise = Noise { colour: Colour::Falling, power: 1.0 };
        let bound = |order, level| speed_bound_rev_s(&series(order, &[level]), &noise, 60.0);
        assert!((bound(4, 1.0) / bound(8, 0.25) - 1.0).abs() < 0.01, "{}", bound(4, 1.0) / bound(8, 0.25));
    }
}
