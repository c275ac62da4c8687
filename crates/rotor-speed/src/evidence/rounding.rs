//! The noise of samples that were rounded to whole numbers.

/// Share of the power of rounding that one line of it has: in a pure sine, rounding is no noise but a series of lines. *Numeric.*
const LINE_SHARE: f64 = 0.05;
/// Bits of a number's fraction, and its smallest exponent. *Numeric.*
const FRACTION_BITS: i32 = 23;
const EXPONENT_MIN: i32 = -126;

/// The step of rounded samples: all are whole multiples of it. 2⁻¹⁵ for 16 bits; far below any sound for samples that were not rounded.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Rounding {
    /// Exponent of the step, a power of two.
    exponent: Option<i32>,
}

impl Rounding {
    pub(super) fn take(&mut self, samples: &[f32]) {
        let lowest = samples.iter().filter_map(|sample| lowest_bit(*sample)).min();
        self.exponent = self.exponent.into_iter().chain(lowest).min();
    }

    /// Power of a line of rounding, re a sine of full scale. Rounding to steps q has the variance q²/12.
    pub(super) fn line_power(&self) -> f64 {
        let step = self.exponent.map_or(0.0, |exponent| 2f64.powi(exponent));
        LINE_SHARE * 2.0 * step * step / 12.0
    }
}

/// Exponent of the lowest bit of a number; `None` of zero.
fn lowest_bit(sample: f32) -> Option<i32> {
    let bits = sample.to_bits();
    let (exponent, fraction) = ((bits >> FRACTION_BITS) as i32 & 0xff, bits & ((1 << FRACTION_BITS) - 1));
    let whole = if exponent == 0 { fraction } else { fraction | 1 << FRACTION_BITS };
    let lowest = EXPONENT_MIN - FRACTION_BITS - 1 + exponent.max(1) + whole.trailing_zeros() as i32;
    (sample != 0.0).then_some(lowest)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_step_is_that_of_the_format() {
        for bits in [8, 16, 24] {
            let mut rounding = Rounding::default();
            rounding.take(&[0.0, 0.5, -0.25]);
            rounding.take(&[3.0 / (1 << (bits - 1)) as f32, -1.0]);
            assert_eq!(rounding.exponent, Some(1 - bits), "{bits}");
        }
        assert_eq!(lowest_bit(1.5), Some(-1));
        assert_eq!(lowest_bit(-f32::from_bits(1)), Some(-149));
        // 20 times less than -98 dB re a full-scale sine
        let mut rounding = Rounding::default();
        rounding.take(&[1.0 / 32_768.0]);
        assert!((10.0 * rounding.line_power().log10() + 111.1).abs() < 0.1, "{}", rounding.line_power());
        assert_eq!(Rounding::default().line_power(), 0.0);
    }

    #[test]
    fn sound_that_was_not_rounded_has_no_noise_of_rounding() {
        let mut rounding = Rounding::default();
        let samples: Vec<f32> = (0..1000).map(|n| (n as f32 * 0.1).sin()).collect();
        rounding.take(&samples);
        assert!(rounding.line_power() < 1e-16, "{}", rounding.line_power());
    }
}
