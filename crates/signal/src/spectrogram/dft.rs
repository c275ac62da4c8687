//! The definition of a power spectrum, computed term by term: the tests compare the fast transform with it.

use std::f64::consts::TAU;

/// |Σ x[n] e^(−j2πkn/N)|² for k = 0 … N/2; N values give N/2 + 1 bins, in O(N²) operations.
pub(super) fn dft_power(x: &[f64]) -> Vec<f64> {
    let bin = |k: usize| {
        let (re, im) = x.iter().enumerate().fold((0.0, 0.0), |(re, im), (n, value)| {
            let angle = TAU * ((k * n) % x.len()) as f64 / x.len() as f64;
            (re + value * angle.cos(), im - value * angle.sin())
        });
        re * re + im * im
    };
    (0..=x.len() / 2).map(bin).collect()
}

#[test]
fn known_spectra_come_out_of_the_definition() {
    let close = |got: Vec<f64>, want: &[f64]| got.iter().zip(want).all(|(a, b)| (a - b).abs() < 1e-12);
    assert!(close(dft_power(&[1.0, 0.0, 0.0, 0.0]), &[1.0, 1.0, 1.0]));
    assert!(close(dft_power(&[1.0, 1.0, 1.0, 1.0]), &[16.0, 0.0, 0.0]));
    assert!(close(dft_power(&[0.0, 1.0, 0.0, -1.0]), &[0.0, 4.0, 0.0]));
}
