//! From interleaved channels to one channel of finite samples.

use crate::error::MediaError;
use crate::mix_loss::MixLoss;

/// Selects one channel, or averages all.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Mix {
    pub(crate) channel_count: usize,
    /// Index of the channel, counted from 0; `None` for the mean of all.
    pub(crate) channel: Option<usize>,
}

impl Mix {
    /// The channel of this number, counted from 1; the mean of all where absent.
    ///
    /// # Errors
    /// A channel that is not there.
    pub(crate) fn of(channel_count: usize, channel: Option<usize>) -> Result<Self, MediaError> {
        match channel {
            Some(asked) if !(1..=channel_count).contains(&asked) => {
                Err(MediaError::NoSuchChannel { asked, count: channel_count })
            }
            _ => Ok(Self { channel_count, channel: channel.map(|channel| channel - 1) }),
        }
    }

    /// Appends one sample for each frame of `interleaved`. Returns the number of samples that were not finite and became 0. The content
    /// of `interleaved` is undefined afterwards. Where channels are averaged, `loss` counts the power that they lose.
    pub(crate) fn append(&self, interleaved: &mut Vec<f32>, mono: &mut Vec<f32>, loss: &mut MixLoss) -> u64 {
        let first = mono.len();
        match (self.channel, self.channel_count) {
            (_, 0 | 1) if mono.is_empty() => std::mem::swap(mono, interleaved),
            (_, 0 | 1) => mono.extend_from_slice(interleaved),
            (Some(channel), count) => mono.extend(interleaved.iter().skip(channel).step_by(count)),
            (None, 2) => mono.extend(interleaved.as_chunks::<2>().0.iter().map(|[a, b]| 0.5 * a + 0.5 * b)),
            (None, count) => mono.extend(interleaved.chunks_exact(count).map(|frame| {
                let sum: f64 = frame.iter().map(|sample| f64::from(*sample)).sum();
                (sum / count as f64) as f32
            })),
        }
        if self.channel.is_none() && self.channel_count > 1 {
            loss.push(interleaved, self.channel_count, &mono[first..]);
        }
        // almost always zero, so it is counted without a branch for each sample
        let replaced: u32 = mono[first..].iter().map(|sample| u32::from(!sample.is_finite())).sum();
        if replaced > 0 {
            mono[first..].iter_mut().filter(|sample| !sample.is_finite()).for_each(|sample| *sample = 0.0);
        }
        u64::from(replaced)
    }
}
