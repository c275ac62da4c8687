//! Whether the constant of the rows of a table drifts down the table or with the voltage of the battery. At a given speed neither
//! changes the thrust of a rotor, so a drift comes from the stand (a load cell that warms up, a zero that moves), the air, or a bent
//! propeller.

use super::{Drift, DriftKind, FALSE_ALARM_CHANCE};
use crate::square_law::{ForcePoint, gross_points};
use crate::statistics::{mean, two_sided_chance};

/// Terms of the speed beside the drift: constant, slope and curvature of ln(F/ω²) over ln ω. They describe a law with another
/// exponent, which is no drift. *Decision.*
const SPEED_TERMS: usize = 3;
/// A drift is not tested where the speeds explain more than this share of the variance of the row numbers or voltages, as in a
/// single sweep of the speed. *Decision.*
const EXPLAINED_SHARE_MAX: f64 = 0.9;
/// Fewest degrees of freedom: independent rows minus fitted terms. *Decision.*
const FREEDOM_MIN: f64 = 3.0;

/// The significant drifts of the constant over the row number, and over the voltage (V) where every row has one.
///
/// Least squares with ln(F/ω²) = a + b ln ω + c ln² ω + d z, where z is the row number or the voltage. Student's t tests d; its
/// degrees of freedom count the rows that are independent after the correlation of the residuals from row to row. Rows that are off
/// by a factor are left out.
pub fn row_drifts(points: &[ForcePoint], voltages_v: &[Option<f64>]) -> Vec<Drift> {
    let gross = gross_points(points);
    let kept: Vec<usize> = (0..points.len()).filter(|&index| !gross[index]).collect();
    let places: Option<Vec<f64>> = Some(kept.iter().map(|&index| index as f64).collect());
    let voltages = kept.iter().map(|&index| voltages_v.get(index).copied().flatten()).collect();
    let points: Vec<&ForcePoint> = kept.iter().map(|&index| &points[index]).collect();
    [(DriftKind::PerRow, places), (DriftKind::PerVolt, voltages)]
        .into_iter()
        .filter_map(|(kind, along)| drift_along(&points, &along?, kind))
        .filter(|drift| drift.p_value < FALSE_ALARM_CHANCE)
        .collect()
}

fn drift_along(points: &[&ForcePoint], along: &[f64], kind: DriftKind) -> Option<Drift> {
    let log_speeds: Vec<f64> = points.iter().map(|point| point.speed_square_rad2_s2.ln() / 2.0).collect();
    let middle = mean(&log_speeds)?;
    let mut terms: Vec<Vec<f64>> = Vec::with_capacity(SPEED_TERMS);
    for power in 0..SPEED_TERMS as i32 {
        let term: Vec<f64> = log_speeds.iter().map(|log_speed| (log_speed - middle).powi(power)).collect();
        let rest = without(&term, &terms);
        // with equal speeds the higher terms are zero
        if dot(&rest, &rest) > f64::EPSILON * dot(&term, &term) {
            terms.push(rest);
        }
    }
    let constant_term = &terms[..1];
    let rest = without(along, &terms);
    let (varies, unexplained) = (square_sum(&without(along, constant_term)), square_sum(&rest));
    if unexplained <= (1.0 - EXPLAINED_SHARE_MAX) * varies || varies == 0.0 {
        return None;
    }
    let logarithms: Vec<f64> = points.iter().map(|point| point.thrust_constant_n_s2().ln()).collect();
    let logarithms = without(&logarithms, &terms);
    let slope = dot(&logarithms, &rest) / unexplained;
    let residuals: Vec<f64> = logarithms.iter().zip(&rest).map(|(value, along)| value - slope * along).collect();
    let squares = square_sum(&residuals);
    let independent = points.len() as f64 * independent_share(&residuals, squares);
    let freedom = independent - (terms.len() + 1) as f64;
    if freedom < FREEDOM_MIN || squares == 0.0 {
        return None;
    }
    let std_uncertainty_share = (squares / freedom / unexplained).sqrt();
    let p_value = two_sided_chance(slope / std_uncertainty_share, Some(freedom))?;
    Some(Drift { kind, constant_share: slope, std_uncertainty_share, p_value })
}

/// Share of the rows that count as independent, for residuals of a first-order autoregressive process with the correlation r between
/// neighbours: (1 − r)/(1 + r).
fn independent_share(residuals: &[f64], squares: f64) -> f64 {
    let products: f64 = residuals.windows(2).map(|pair| pair[0] * pair[1]).sum();
    let correlation = if squares > 0.0 { (products / squares).clamp(0.0, 1.0) } else { 0.0 };
    (1.0 - correlation) / (1.0 + correlation)
}

/// Remainder of the values after the projection on orthogonal terms.
fn without(values: &[f64], terms: &[Vec<f64>]) -> Vec<f64> {
    let mut rest = values.to_vec();
    for term in terms {
        let share = dot(&rest, term) / square_sum(term);
        rest.iter_mut().zip(term).for_each(|(value, part)| *value -= share * part);
    }
    rest
}

fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

fn square_sum(values: &[f64]) -> f64 {
    dot(values, values)
}

#[cfg(test)]
mod tests {
    use super::*;
    use hovertone_vehicle::RotorSpeed;
    use rand::SeedableRng;
    use rand_distr::{Distribution, Normal};

    /// Steps of speed up and down again, three times, by a law that is not quite the square one; a drift for each row, and
    /// one for each volt of a battery that falls from 16.8 V.
    fn table(seed: u64, noise: f64, per_row: f64, per_volt: f64) -> (Vec<ForcePoint>, Vec<Option<f64>>) {
        let mut random = rand_pcg::Pcg64::seed_from_u64(seed);
        let mut normal = |std: f64| Normal::new(0.0, std).unwrap().sample(&mut random);
        let steps = [3e3, 4e3, 5e3, 6e3, 7e3, 6e3, 5e3, 4e3];
        (0..24)
            .map(|row| {
                let rpm: f64 = steps[row % steps.len()];
                let voltage_v = 16.8 - 0.04 * row as f64 - 1e-4 * rpm + normal(0.02);
                let change = per_row * row as f64 + per_volt * (voltage_v - 16.0) + normal(noise);
                let force_n = 1e-5 * RotorSpeed::from_rpm(rpm).rad_s().powf(2.15) * change.exp();
                let point =
                    ForcePoint::from_speed(format!("line {}", row + 2), RotorSpeed::from_rpm(rpm), 0.0, force_n, 0.0);
                (point, Some(voltage_v))
            })
            .unzip()
    }

    #[test]
    fn a_drift_is_seen_with_its_size() {
        let (points, voltages) = table(1, 0.003, -0.002, 0.0);
        let drifts = row_drifts(&points, &voltages);
        let drift = drifts.iter().find(|drift| drift.kind == DriftKind::PerRow).expect("a drift down the table");
        assert!((drift.constant_share + 0.002).abs() < 4.0 * drift.std_uncertainty_share, "{drift:?}");
        assert!(drift.std_uncertainty_share < 2e-4, "{drift:?}");
        let (points, voltages) = table(2, 0.003, 0.0, 0.05);
        let drifts = row_drifts(&points, &voltages);
        let drift = drifts.iter().find(|drift| drift.kind == DriftKind::PerVolt).expect("a drift with the voltage");
        assert!((drift.constant_share - 0.05).abs() < 4.0 * drift.std_uncertainty_share, "{drift:?}");
    }

    /// Two tests at 1 % each in 500 tables: 10 alarms are expected, and fewer than 25 with a chance of 0.99999.
    #[test]
    fn chance_and_another_law_are_no_drift() {
        let alarms: usize = (0..500)
            .map(|seed| {
                let (points, voltages) = table(seed, 0.01, 0.0, 0.0);
                usize::from(!row_drifts(&points, &voltages).is_empty())
            })
            .sum();
        println!("{alarms} of 500 tables without a drift have one");
        assert!((1..25).contains(&alarms), "{alarms}");
    }

    #[test]
    fn what_cannot_be_told_apart_is_not_said() {
        // swept up once: the place is the speed
        let (points, voltages) = table(3, 0.003, -0.002, 0.0);
        assert!(row_drifts(&points[..5], &voltages[..5]).is_empty());
        // equal rows, and none
        assert!(row_drifts(&vec![points[0].clone(); 12], &[]).is_empty());
        assert!(row_drifts(&[], &[]).is_empty());
        // a voltage that is missing in one row is no column
        let mut gaps = table(2, 0.003, 0.0, 0.05);
        gaps.1[7] = None;
        assert!(row_drifts(&gaps.0, &gaps.1).iter().all(|drift| drift.kind != DriftKind::PerVolt));
    }
}
