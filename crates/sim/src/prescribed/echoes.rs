//! A room as a cloud of echoes.

use super::sampling::Sampling;
use rand::{Rng, RngExt};
use rand_distr::StandardNormal;

/// Echoes come no earlier than this after the sound.
const FIRST_ECHO_S: f64 = 0.002;

/// Echoes at random times, with levels of random sign that decay by 60 dB in the reverberation time. Together they have the
/// power of the sound itself.
#[derive(Clone, Debug, PartialEq)]
pub struct Echoes(Vec<Echo>);

#[derive(Clone, Copy, Debug, PartialEq)]
struct Echo {
    late_samples: usize,
    level: f64,
}

impl Echoes {
    /// Draws `count` echoes from 2 ms to the reverberation time after the sound.
    pub fn drawn(count: usize, reverberation_time_s: f64, sampling: &Sampling, random: &mut impl Rng) -> Self {
        let mut echo = || {
            let late_s: f64 = random.random_range(FIRST_ECHO_S..reverberation_time_s);
            let normal: f64 = random.sample(StandardNormal);
            let level = normal * 10_f64.powf(-3.0 * late_s / reverberation_time_s);
            Echo { late_samples: (late_s * sampling.rate_hz()) as usize, level }
        };
        let echoes: Vec<Echo> = (0..count).map(|_| echo()).collect();
        let power: f64 = echoes.iter().map(|echo| echo.level * echo.level).sum();
        Self(echoes.into_iter().map(|echo| Echo { level: echo.level / power.sqrt(), ..echo }).collect())
    }

    /// The sound and its echoes.
    pub(super) fn of(&self, samples: &[f64]) -> Vec<f64> {
        let mut heard = samples.to_vec();
        for echo in &self.0 {
            let late = heard.get_mut(echo.late_samples..).unwrap_or_default();
            late.iter_mut().zip(samples).for_each(|(heard, sample)| *heard += echo.level * sample);
        }
        heard
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use rand::SeedableRng;
    use rand_pcg::Pcg64;

    #[test]
    fn echoes_have_the_power_of_the_sound_and_keep_it_as_it_is() {
        let sampling = Sampling::new(8000.0, 1.0);
        let echoes = Echoes::drawn(400, 0.4, &sampling, &mut Pcg64::seed_from_u64(1));
        let mut click = vec![0.0; sampling.sample_count()];
        click[0] = 1.0;
        let heard = echoes.of(&click);
        assert_eq!(heard[0], 1.0);
        assert!(heard[1..16].iter().all(|sample| *sample == 0.0) && heard[3201..].iter().all(|sample| *sample == 0.0));
        // echoes that fall on one sample add up or cancel
        let power: f64 = heard[1..].iter().map(|sample| sample * sample).sum();
        assert!((power - 1.0).abs() < 0.3, "{power}");
    }
}
