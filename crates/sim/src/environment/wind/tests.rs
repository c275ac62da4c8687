use super::*;

fn gusts() -> Gusts {
    Gusts { std_m_s: [0.6, 0.5, 0.3], length_m: [4.0, 3.0, 2.0], airspeed_m_s: 4.0 }
}

/// Autocovariance of the spectra: u σ² e^(-x), v and w σ² e^(-x) (1 - x/2), x = t V/L. Both the variance and its
/// estimate's spread follow from it: the relative spread of a variance over a time D is √(4 ∫ρ² dt / D), ∫ρ² = T/2 for
/// u, 5 T/16 for v.
#[test]
fn variance_and_autocovariance_are_drydens() {
    let (step_s, count, seeds) = (0.01, 200_000_u32, 8_u64);
    let gusts = gusts();
    for axis in 0..3 {
        let time_s = gusts.length_m[axis] / gusts.airspeed_m_s;
        let lag = (time_s / step_s) as usize;
        let (mut square, mut lagged, mut n) = (0.0, 0.0, 0.0);
        for seed in 0..seeds {
            let mut wind = Wind::new([0.0; 3], Some(&gusts), step_s, seed);
            let mut past = std::collections::VecDeque::new();
            for _ in 0..count {
                let value = wind.velocity_m_s()[axis];
                square += value * value;
                past.push_back(value);
                if past.len() > lag {
                    lagged += value * past.pop_front().unwrap_or_default();
                    n += 1.0;
                }
                wind.step();
            }
        }
        let (whole, expected_share) =
            (f64::from(count) * seeds as f64, if axis == 0 { (-1.0_f64).exp() } else { 0.5 * (-1.0_f64).exp() });
        let relative_error = (2.0 * time_s / (step_s * whole)).sqrt();
        let variance = square / whole;
        assert!((variance / gusts.std_m_s[axis].powi(2) - 1.0).abs() < 4.0 * relative_error, "axis {axis}: {variance}");
        let share = lagged / n / variance;
        assert!((share - expected_share).abs() < 4.0 * relative_error, "axis {axis}: {share} at one time constant");
    }
}

#[test]
fn the_gusts_start_stationary() {
    let count = 4000_u64;
    for axis in 0..3 {
        let values = (0..count).map(|seed| Wind::new([0.0; 3], Some(&gusts()), 0.001, seed).velocity_m_s()[axis]);
        let variance = values.map(|value| value * value).sum::<f64>() / count as f64;
        let relative_error = (2.0 / count as f64).sqrt();
        assert!((variance / gusts().std_m_s[axis].powi(2) - 1.0).abs() < 4.0 * relative_error, "axis {axis}");
    }
}

#[test]
fn the_step_does_not_change_the_variance() {
    for step_s in [0.0001, 0.1] {
        let time_s = 0.75;
        let filter = GustFilter::new(1.0, time_s, step_s, true, stream(1, Part::Gust, 1));
        // P = Φ P Φᵀ + Q must give back σ_x² = 1/2.
        let (keep, ratio, [l11, l21, l22]) = (filter.keep, filter.ratio, filter.kick);
        let p11 = keep * keep * 0.5 + l11 * l11;
        let p12 = keep * keep * (0.25 + ratio * 0.5) + l11 * l21;
        let p22 = keep * keep * (0.25 + 2.0 * ratio * 0.25 + ratio * ratio * 0.5) + l21 * l21 + l22 * l22;
        assert!((p11 - 0.5).abs() < 1e-12 && (p12 - 0.25).abs() < 1e-12 && (p22 - 0.25).abs() < 1e-12, "{step_s}");
    }
}

#[test]
fn along_and_across_follow_the_wind_and_no_gust_is_just_the_wind() {
    let only_along = Gusts { std_m_s: [1.0, 0.0, 0.0], ..gusts() };
    let mut wind = Wind::new([0.0, 5.0, 0.0], Some(&only_along), 0.01, 3);
    for _ in 0..100 {
        wind.step();
        let velocity = wind.velocity_m_s();
        assert!(velocity.x == 0.0 && velocity.z == 0.0 && velocity.y != 5.0);
    }
    let mut calm = Wind::new([1.0, 2.0, 0.5], None, 0.01, 3);
    calm.step();
    assert_eq!(calm.velocity_m_s(), Vector3::new(1.0, 2.0, 0.5));
}

#[test]
fn the_low_altitude_numbers_of_the_standard() {
    // At 100 ft with 15 knots at 20 ft: L_w = 100 ft, L_u = 100/(0.2593)^1.2 = 505.2 ft, σ_w = 1.5 kt, σ_u = 2.574 kt.
    let knot = 0.514_444;
    let gusts = Gusts::low_altitude(30.48, 15.0 * knot);
    assert!((gusts.length_m[2] / 30.48 - 1.0).abs() < 1e-12);
    assert!((gusts.length_m[0] / 0.3048 - 505.2).abs() < 0.5, "{}", gusts.length_m[0] / 0.3048);
    assert!((gusts.std_m_s[2] / knot - 1.5).abs() < 1e-9 && (gusts.std_m_s[0] / knot - 2.574).abs() < 0.005);
    assert!(gusts.check().is_ok());
}
