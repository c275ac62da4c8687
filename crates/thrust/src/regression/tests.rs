//! Published results, to the digits that they are published with.

use super::*;

/// NIST Statistical Reference Datasets, linear regression, Norris (J. Norris, calibration of ozone monitors): y, x.
const NORRIS: [(f64, f64); 36] = [
    (0.1, 0.2),
    (338.8, 337.4),
    (118.1, 118.2),
    (888.0, 884.6),
    (9.2, 10.1),
    (228.1, 226.5),
    (668.5, 666.3),
    (998.5, 996.3),
    (449.1, 448.6),
    (778.9, 777.0),
    (559.2, 558.2),
    (0.3, 0.4),
    (0.1, 0.6),
    (778.1, 775.5),
    (668.8, 666.9),
    (339.3, 338.0),
    (448.9, 447.5),
    (10.8, 11.6),
    (557.7, 556.0),
    (228.3, 228.1),
    (998.0, 995.8),
    (888.8, 887.6),
    (119.6, 120.2),
    (0.3, 0.3),
    (0.6, 0.3),
    (557.6, 556.8),
    (339.3, 339.1),
    (888.0, 887.2),
    (998.5, 999.0),
    (778.9, 779.0),
    (10.2, 11.1),
    (117.6, 118.3),
    (228.9, 229.2),
    (668.4, 669.1),
    (449.2, 448.9),
    (0.2, 0.5),
];

/// Pearson's data with York's weights (York 1966, table II): x, weight of x, y, weight of y.
const PEARSON_YORK: [(f64, f64, f64, f64); 10] = [
    (0.0, 1000.0, 5.9, 1.0),
    (0.9, 1000.0, 5.4, 1.8),
    (1.8, 500.0, 4.4, 4.0),
    (2.6, 800.0, 4.6, 8.0),
    (3.3, 200.0, 3.5, 20.0),
    (4.4, 80.0, 3.7, 20.0),
    (5.2, 60.0, 2.8, 70.0),
    (6.1, 20.0, 2.8, 70.0),
    (6.5, 1.8, 2.4, 100.0),
    (7.4, 1.0, 1.5, 500.0),
];

fn plain(points: impl IntoIterator<Item = (f64, f64)>) -> Vec<FitPoint> {
    points.into_iter().map(|(x, y)| FitPoint::with_y_std(x, y, 1.0)).collect()
}

/// Agreement to nine significant digits.
fn agrees(value: f64, certified: f64) {
    assert!((value / certified - 1.0).abs() < 5e-10, "{value} is not {certified}");
}

#[test]
fn nist_norris_to_nine_digits() {
    let fit = line_fit(&plain(NORRIS.map(|(y, x)| (x, y)))).unwrap();
    let residual_std = fit.agreement.scatter_factor().unwrap();
    agrees(fit.intercept, -0.262323073774029);
    agrees(fit.slope, 1.00211681802045);
    agrees(fit.intercept_std * residual_std, 0.232818234301152);
    agrees(fit.slope_std * residual_std, 0.429796848199937e-3);
    agrees(residual_std, 0.884796396144373);
}

#[test]
fn nist_without_intercept_to_nine_digits() {
    let first = proportional_fit(&plain((0..11).map(|i| (60.0 + f64::from(i), 130.0 + f64::from(i))))).unwrap();
    let residual_std = first.agreement.scatter_factor().unwrap();
    agrees(first.slope, 2.07438016528926);
    agrees(first.slope_std * residual_std, 0.165289256198347e-1);
    agrees(residual_std, 3.56753034006338);
    let second = proportional_fit(&plain([(4.0, 3.0), (5.0, 4.0), (6.0, 4.0)])).unwrap();
    let residual_std = second.agreement.scatter_factor().unwrap();
    agrees(second.slope, 0.727272727272727);
    agrees(second.slope_std * residual_std, 0.420827318078432e-1);
    agrees(residual_std, 0.369274472937998);
}

fn pearson_york() -> Vec<FitPoint> {
    PEARSON_YORK
        .map(|(x, x_weight, y, y_weight)| FitPoint {
            x,
            x_std: f64::sqrt(1.0 / x_weight),
            y,
            y_std: f64::sqrt(1.0 / y_weight),
        })
        .to_vec()
}

#[test]
fn yorks_published_example() {
    let fit = line_fit(&pearson_york()).unwrap();
    assert!((fit.slope - -0.48053).abs() < 5e-6, "{fit:?}");
    assert!((fit.intercept - 5.47991).abs() < 5e-6, "{fit:?}");
    // S/(n - 2), and the standard errors of the 2004 paper
    assert!((fit.agreement.scatter_factor().unwrap().powi(2) - 1.4833).abs() < 5e-4, "{fit:?}");
    assert!((fit.slope_std - 0.0580).abs() < 5e-5 && (fit.intercept_std - 0.2950).abs() < 5e-4, "{fit:?}");
}

/// The minimum by search, without any formula of the fit.
#[test]
fn the_slope_through_the_origin_is_the_minimum_of_its_sum() {
    let points: Vec<FitPoint> =
        pearson_york().into_iter().map(|point| FitPoint { y: point.x * 0.7 + point.y * 0.05, ..point }).collect();
    let sum = |slope: f64| -> f64 {
        points.iter().map(|p| (p.y - slope * p.x).powi(2) / (p.y_std.powi(2) + (slope * p.x_std).powi(2))).sum()
    };
    let fit = proportional_fit(&points).unwrap();
    let (mut low, mut high) = (fit.slope * 0.5, fit.slope * 1.5);
    while high - low > 1e-9 * high {
        let (first, second) = (low + (high - low) / 3.0, high - (high - low) / 3.0);
        if sum(first) < sum(second) { high = second } else { low = first }
    }
    assert!((fit.slope / low - 1.0).abs() < 1e-6, "{} {low}", fit.slope);
    assert!((fit.agreement.chi_square - sum(low)).abs() < 1e-9 * sum(low));
    // the uncertainty is the curvature of the sum
    let step = 0.01 * fit.slope_std;
    let curvature = (sum(fit.slope + step) - 2.0 * sum(fit.slope) + sum(fit.slope - step)) / step.powi(2);
    assert!((fit.slope_std / (2.0 / curvature).sqrt() - 1.0).abs() < 0.1, "{} {curvature}", fit.slope_std);
}

/// The rows of the paper's tables 1 and 2: masses in g, speeds and their STD in rpm, 25 samples each, masses known to 0.5 g.
#[test]
fn the_papers_rows() {
    let std_rpm = [44.4916, 48.3813, 47.7473];
    let tables = [[3610.3438, 3742.0275, 3820.1625], [3608.1298, 3740.0479, 3822.284]];
    let points = |masses_g: [f64; 3], rpm: [f64; 3]| -> Vec<FitPoint> {
        (0..3)
            .map(|row| {
                let [rad_s, std_rad_s] = [rpm[row], std_rpm[row] / 5.0].map(|rpm| rpm * std::f64::consts::TAU / 60.0);
                FitPoint {
                    x: rad_s * rad_s,
                    x_std: 2.0 * rad_s * std_rad_s,
                    y: masses_g[row] * 1e-3 * 9.8,
                    y_std: 0.5e-3 * 9.8,
                }
            })
            .collect()
    };
    for (number, rpm) in tables.into_iter().enumerate() {
        let right = proportional_fit(&points([413.0, 444.0, 462.0], rpm)).unwrap();
        assert!((right.slope - [2.8314e-5, 2.8324e-5][number]).abs() < 5e-10, "{right:?}");
        assert!((right.slope_std - 0.0084e-5).abs() < 0.5e-8, "{right:?}");
        assert!((right.agreement.chi_square - [0.05, 0.31][number]).abs() < 0.005, "{right:?}");
        let used = proportional_fit(&points([413.0, 444.0, 472.0], rpm)).unwrap();
        assert!((used.slope - [2.8524e-5, 2.8534e-5][number]).abs() < 5e-10, "{used:?}");
        assert!((used.agreement.p_value().unwrap() - [0.0055, 0.0167][number]).abs() < 5e-4, "{used:?}");
        let line = line_fit(&points([413.0, 444.0, 462.0], rpm)).unwrap();
        assert!((line.intercept - [0.02, 0.10][number]).abs() < 0.005, "{line:?}");
        assert!((line.intercept_std - [0.27, 0.26][number]).abs() < 0.006, "{line:?}");
    }
}

#[test]
fn what_cannot_be_fitted_says_why() {
    assert_eq!(proportional_fit(&[]), Err(FitError::TooFewPoints { given: 0, needed: 1 }));
    assert_eq!(line_fit(&plain([(1.0, 1.0)])), Err(FitError::TooFewPoints { given: 1, needed: 2 }));
    assert_eq!(line_fit(&plain([(1.0, 1.0), (1.0, 2.0)])), Err(FitError::NoSpread));
    assert_eq!(proportional_fit(&plain([(0.0, 1.0)])), Err(FitError::NoSpread));
    for unusable in [(f64::NAN, 1.0, 0.0), (1.0, f64::INFINITY, 0.0), (1.0, 0.0, 0.0), (1.0, -1.0, 0.0)] {
        let point = FitPoint { x: unusable.0, x_std: unusable.2, y: 1.0, y_std: unusable.1 };
        assert_eq!(proportional_fit(&[point]), Err(FitError::UnusablePoint { number: 1 }), "{point:?}");
    }
}

#[test]
fn evidence_is_a_ratio_of_integrals() {
    let prior = ParameterPrior { null: 2.0, std: 0.2 };
    // a precise null result speaks for the smaller law by the width of the prior it rules out
    let ratio = log_evidence_ratio(2.0, 0.002, prior, None);
    assert!((ratio + (1.0f64 + 1e4).ln() / 2.0).abs() < 1e-12);
    // no information, no preference; a clear result, the larger law
    assert!(log_evidence_ratio(2.0, 1e4, prior, None).abs() < 1e-6);
    assert!(log_evidence_ratio(2.19, 0.02, prior, None) > 30.0);
    // residuals of many points are known noise; of few, they convince less
    let known = log_evidence_ratio(2.1, 0.03, prior, None);
    let many = log_evidence_ratio(2.1, 0.03, prior, Some(100_000));
    assert!((known - many).abs() < 1e-2, "{known} {many}");
    let few = log_evidence_ratio(2.1, 0.03, prior, Some(3));
    assert!(few < known && few > 0.0, "{few} {known}");
    // the integral and its limit of a flat prior meet
    let [wide, narrow] = [0.000_801, 0.000_799].map(|std| log_evidence_ratio(2.001, std, prior, Some(5)));
    assert!((wide - narrow).abs() < 0.02, "{wide} {narrow}");
}
