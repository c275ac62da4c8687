//! Sine and cosine of many phases at once.

/// Largest number of samples made at once; a multiple of [`LANES`].
pub(crate) const CHUNK: usize = 64;
/// Samples per vector instruction (two registers of the oldest 64-bit processors).
pub(crate) const LANES: usize = 8;

/// `e^(2πi x)` of a chunk of phases, by components.
#[derive(Clone)]
pub(crate) struct Phasors {
    pub(crate) re: [f32; CHUNK],
    pub(crate) im: [f32; CHUNK],
}

impl Phasors {
    pub(crate) fn new() -> Self {
        Self { re: [1.0; CHUNK], im: [0.0; CHUNK] }
    }

    /// Phasors at `order` times the given turns. The whole turns are removed in double precision, so that no error
    /// grows with time; the rest has an error of 3e-7.
    ///
    /// Sets the first `count` phasors, and the rest of their last tile.
    pub(crate) fn set(&mut self, order: f64, turns: &[f64; CHUNK], count: usize) {
        // Adding and subtracting this rounds to the nearest whole number, as long as the numbers are below 2^51.
        const ROUND: f64 = 6_755_399_441_055_744.0;
        let tiles = count.div_ceil(LANES);
        let (re, im) = (self.re.as_chunks_mut::<LANES>().0, self.im.as_chunks_mut::<LANES>().0);
        for ((re, im), turns) in re.iter_mut().zip(im).zip(turns.as_chunks::<LANES>().0).take(tiles) {
            let mut rest = [0.0_f32; LANES];
            for lane in 0..LANES {
                let phase = order * turns[lane];
                rest[lane] = (phase - ((phase + ROUND) - ROUND)) as f32;
            }
            for lane in 0..LANES {
                re[lane] = sine(0.25 - rest[lane].abs());
                let away = (rest[lane] - 0.25).abs();
                im[lane] = sine(0.25 - if away < 0.5 { away } else { 1.0 - away });
            }
        }
    }
}

/// `sin(2πx)` for |x| ≤ 1/4: Taylor's series to the eleventh power, off by 6e-8 at most.
fn sine(x: f32) -> f32 {
    const C: [f32; 6] = [std::f32::consts::TAU, -41.341_7, 81.605_25, -76.705_86, 42.058_693, -15.094_643];
    let square = x * x;
    let mut sum = C[5];
    for &coefficient in C[..5].iter().rev() {
        sum = sum * square + coefficient;
    }
    sum * x
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::TAU;

    #[test]
    fn phasors_are_sines_and_cosines_after_hours_too() {
        for start in [0.0, 12_345.678, 2.0e6] {
            let turns = std::array::from_fn(|sample| start + sample as f64 * 0.013);
            let mut phasors = Phasors::new();
            for order in [1.0, 8.625, 69.0] {
                phasors.set(order, &turns, CHUNK);
                for (sample, turn) in turns.iter().enumerate() {
                    let (sine, cosine) = (TAU * (order * turn).fract()).sin_cos();
                    assert!((f64::from(phasors.re[sample]) - cosine).abs() < 4e-7, "{order} {turn}");
                    assert!((f64::from(phasors.im[sample]) - sine).abs() < 4e-7, "{order} {turn}");
                }
            }
        }
    }
}
