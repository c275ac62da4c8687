//! Second-order filters.

use std::f64::consts::{FRAC_1_SQRT_2, TAU};

/// A second-order section, transposed direct form II.
#[derive(Clone, Copy)]
pub(crate) struct Biquad {
    b: [f64; 3],
    a: [f64; 2],
    state: [f64; 2],
}

impl Biquad {
    /// Butterworth high-pass with -3 dB at this frequency, by the bilinear transform.
    pub(crate) fn high_pass(corner_hz: f64, sample_rate_hz: f64) -> Self {
        let (cosine, alpha) = Self::corner(corner_hz, sample_rate_hz);
        let side = (1.0 + cosine) / 2.0;
        Self::new([side, -2.0 * side, side], cosine, alpha)
    }

    /// Butterworth low-pass with -3 dB at this frequency, by the bilinear transform.
    pub(crate) fn low_pass(corner_hz: f64, sample_rate_hz: f64) -> Self {
        let (cosine, alpha) = Self::corner(corner_hz, sample_rate_hz);
        let side = (1.0 - cosine) / 2.0;
        Self::new([side, 2.0 * side, side], cosine, alpha)
    }

    /// A resonance: poles at `e^(-π B/f_s ± 2πi f/f_s)`, gain 1 at 0 Hz (Klatt 1980).
    pub(crate) fn resonance(centre_hz: f64, bandwidth_hz: f64, sample_rate_hz: f64) -> Self {
        let radius = (-TAU / 2.0 * bandwidth_hz / sample_rate_hz).exp();
        let a = [-2.0 * radius * (TAU * centre_hz / sample_rate_hz).cos(), radius * radius];
        Self { b: [1.0 + a[0] + a[1], 0.0, 0.0], a, state: [0.0; 2] }
    }

    fn corner(corner_hz: f64, sample_rate_hz: f64) -> (f64, f64) {
        let (sine, cosine) = (TAU * corner_hz / sample_rate_hz).sin_cos();
        (cosine, sine * FRAC_1_SQRT_2)
    }

    fn new(b: [f64; 3], cosine: f64, alpha: f64) -> Self {
        let scale = 1.0 / (1.0 + alpha);
        let a = [-2.0 * cosine * scale, (1.0 - alpha) * scale];
        Self { b: b.map(|value| value * scale), a, state: [0.0; 2] }
    }

    /// This filter with the state of another filter.
    pub(crate) fn keeping(self, other: &Self) -> Self {
        Self { state: other.state, ..self }
    }

    pub(crate) fn filtered(&mut self, sample: f64) -> f64 {
        let value = self.b[0] * sample + self.state[0];
        self.state[0] = self.b[1] * sample - self.a[0] * value + self.state[1];
        self.state[1] = self.b[2] * sample - self.a[1] * value;
        value
    }

    /// |H|² at a frequency.
    pub(crate) fn power_gain(&self, hz: f64, sample_rate_hz: f64) -> f64 {
        let phase = TAU * hz / sample_rate_hz;
        let ((s1, c1), (s2, c2)) = (phase.sin_cos(), (2.0 * phase).sin_cos());
        let square =
            |zero: f64, one: f64, two: f64| (zero + one * c1 + two * c2).powi(2) + (one * s1 + two * s2).powi(2);
        square(self.b[0], self.b[1], self.b[2]) / square(1.0, self.a[0], self.a[1])
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn corners_are_3_db_down_and_the_response_is_the_formula() {
        let rate = 48_000.0;
        for filter in [Biquad::high_pass(60.0, rate), Biquad::low_pass(60.0, rate)] {
            assert!((filter.power_gain(60.0, rate) - 0.5).abs() < 1e-9);
        }
        let (mut filter, hz) = (Biquad::resonance(700.0, 80.0, rate), 650.0);
        let mut peak = 0.0_f64;
        for n in 0..96_000 {
            let out = filter.filtered((TAU * hz * f64::from(n) / rate).cos());
            if n > 48_000 {
                peak = peak.max(out.abs());
            }
        }
        assert!((peak.powi(2) / filter.power_gain(hz, rate) - 1.0).abs() < 1e-3);
        assert!((filter.power_gain(0.0, rate) - 1.0).abs() < 1e-9);
    }
}
