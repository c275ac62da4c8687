//! The power that channels lose where their mean is used, because they have opposite signs.

/// Sums over the samples of one signal.
#[derive(Clone, Copy, Debug, Default)]
struct Sums {
    sum: f64,
    squares: f64,
}

impl Sums {
    fn of(samples: impl Iterator<Item = f32>) -> Self {
        // single precision suffices for the few thousand samples of a block
        let (sum, squares) = samples.fold((0.0_f32, 0.0_f32), |(sum, squares), x| (sum + x, squares + x * x));
        Self { sum: f64::from(sum), squares: f64::from(squares) }
    }

    fn add(&mut self, other: Self) {
        self.sum += other.sum;
        self.squares += other.squares;
    }

    /// Power without a constant offset.
    fn power(&self, count: f64) -> f64 {
        (self.squares / count - (self.sum / count).powi(2)).max(0.0)
    }
}

/// The power of channels and of their mean. It stays empty where one channel is used.
#[derive(Clone, Debug, Default)]
pub(crate) struct MixLoss {
    channels: Vec<Sums>,
    mean: Sums,
    frame_count: u64,
}

impl MixLoss {
    /// Adds frames of `channel_count` channels and the mean of each frame. Frames with NaN or infinite samples do not count.
    pub(crate) fn push(&mut self, interleaved: &[f32], channel_count: usize, mean: &[f32]) {
        let channels: Vec<Sums> = (0..channel_count)
            .map(|channel| Sums::of(interleaved.iter().skip(channel).step_by(channel_count).copied()))
            .collect();
        let mean = Sums::of(mean.iter().copied());
        if channels.iter().chain([&mean]).any(|sums| !sums.squares.is_finite()) {
            return;
        }
        self.channels.resize(channel_count, Sums::default());
        self.channels.iter_mut().zip(channels).for_each(|(all, block)| all.add(block));
        self.mean.add(mean);
        self.frame_count += (interleaved.len() / channel_count) as u64;
    }

    /// Power of the mean over the mean power of the channels, times the number of channels: 1 for channels that have nothing in common, the
    /// number of channels for equal ones, and less than 1 where they cancel. `None` for silence and for one channel.
    fn share_of_unrelated(&self) -> Option<f64> {
        let count = self.frame_count as f64;
        let power: f64 = self.channels.iter().map(|channel| channel.power(count)).sum();
        (self.channels.len() > 1 && power > 0.0)
            .then(|| self.mean.power(count) * (self.channels.len() as f64).powi(2) / power)
    }

    /// The loss in dB against the mean power of the channels, where the mean has less than `share_max` of the power that unrelated channels
    /// would leave.
    pub(crate) fn lost_db(&self, share_max: f64) -> Option<f64> {
        let share = self.share_of_unrelated().filter(|share| *share < share_max)?;
        Some(10.0 * (self.channels.len() as f64 / share).log10())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn loss_of(frames: &[[f32; 2]]) -> MixLoss {
        let mut loss = MixLoss::default();
        for block in frames.chunks(100) {
            let mean: Vec<f32> = block.iter().map(|[a, b]| 0.5 * a + 0.5 * b).collect();
            loss.push(&block.concat(), 2, &mean);
        }
        loss
    }

    /// Two sines of different frequencies, each over whole periods.
    fn sines(count: usize) -> impl Iterator<Item = [f32; 2]> {
        let turns = |cycles: f64, n: usize| (std::f64::consts::TAU * cycles * n as f64 / 1000.0).sin() as f32;
        (0..count).map(move |n| [turns(50.0, n), turns(70.0, n)])
    }

    #[test]
    fn the_share_is_one_for_unrelated_channels_and_the_number_of_channels_for_equal_ones() {
        let share = |of: fn([f32; 2]) -> [f32; 2]| {
            loss_of(&sines(2000).map(of).collect::<Vec<_>>()).share_of_unrelated().unwrap()
        };
        assert!((share(|frame| frame) - 1.0).abs() < 1e-4);
        assert!((share(|[a, _]| [a, a]) - 2.0).abs() < 1e-4);
        // an offset is no sound, though it cancels
        assert!((share(|[a, _]| [a + 0.5, a - 0.5]) - 2.0).abs() < 1e-4);
    }

    #[test]
    fn the_loss_is_that_of_the_mean_against_the_channels() {
        // the channels have the power 0.5 (1 + 0.01), and their mean has 0.5 · 0.01
        let frames: Vec<[f32; 2]> = sines(2000).map(|[a, b]| [a + 0.1 * b, 0.1 * b - a]).collect();
        let lost_db = loss_of(&frames).lost_db(0.1).unwrap();
        assert!((lost_db - 10.0 * 101.0_f64.log10()).abs() < 0.01, "{lost_db}");
        assert_eq!(loss_of(&frames).lost_db(0.01), None);
        let opposite: Vec<[f32; 2]> = sines(2000).map(|[a, _]| [a, -a]).collect();
        assert_eq!(loss_of(&opposite).lost_db(0.1), Some(f64::INFINITY));
    }

    #[test]
    fn silence_one_channel_and_nan_lose_nothing() {
        assert_eq!(loss_of(&[[0.0; 2]; 10]).lost_db(0.1), None);
        assert_eq!(MixLoss::default().lost_db(0.1), None);
        assert_eq!(loss_of(&[[f32::NAN, 1.0]; 10]).lost_db(0.1), None);
    }
}
