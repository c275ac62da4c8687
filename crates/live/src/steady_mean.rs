//! The speed now, from noisy speeds of frames: the mean of as many of the last frames as agree.

/// Numbers of frames of the means that are compared, each twice the one before. *Numeric.*
const FRAME_COUNTS: [usize; 6] = [1, 2, 4, 8, 16, 32];
/// A longer mean agrees with a shorter one within so many of its standard deviations. *Decision.*
const AGREE_STDS: f64 = 2.5;
/// Frames whose differences tell the noise of a frame. *Numeric.*
const NOISE_FRAMES: usize = 64;
/// Standard deviation of normal values over their median deviation from each other: 1 / (0.6745 √2). *Physics.*
const STD_PER_MEDIAN_DIFFERENCE: f64 = 1.0484;
/// Frames after which the speed at the time of an answer is known better: its middle one is that moment, as a frame tells of its own middle.
/// *Numeric.*
const LATER_FRAMES: usize = 3;
/// Answers whose errors tell how much the speed moves: 4 s. *Decision.*
const MOVING_FRAMES: f64 = 160.0;
/// Smallest noise of a frame, as a share of the speed: the numbers that the frames are in. *Numeric.*
const NOISE_SHARE_MIN: f64 = 1e-5;

/// The last speeds of frames, in memory of a fixed size.
pub(crate) struct SteadyMean {
    /// The newest is last.
    speeds_rev_s: Vec<f64>,
    differences: Vec<f64>,
    /// Frames in the length of a frame: so far apart, two of them share no sound.
    apart: usize,
    /// Answers at the last frames, the oldest first.
    answers: [Option<MeanSpeed>; LATER_FRAMES],
    moving: Moving,
}

/// How far answers are off from the speed that the frames after them show, beyond the noise: the mean of frames lags behind a speed that moves.
#[derive(Default)]
struct Moving {
    /// Mean square of the errors of answers.
    misses: f64,
    /// Mean squares of the differences of frames that share no sound, and of frames twice as far apart.
    near: f64,
    far: f64,
    frame_count: f64,
}

impl Moving {
    fn add(&mut self, miss: f64, near: f64, far: f64) {
        self.frame_count = (self.frame_count + 1.0).min(MOVING_FRAMES);
        for (mean, value) in [(&mut self.misses, miss), (&mut self.near, near), (&mut self.far, far)] {
            *mean += (value * value - *mean) / self.frame_count;
        }
    }

    /// Variance of an answer by the movement of the speed. Movement makes differences grow with their distance, and noise does not: the line through
    /// both at distance 0 is twice the variance of the noise.
    fn variance(&self, independent: f64) -> f64 {
        let of_noise = (2.0 * self.near - self.far).clamp(0.0, self.near) / 2.0;
        (self.misses - of_noise / independent).max(0.0)
    }
}

/// A speed with its uncertainty by the noise of the frames.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct MeanSpeed {
    pub(crate) speed_rev_s: f64,
    pub(crate) std_uncertainty_rev_s: f64,
    /// Frames in the mean.
    pub(crate) frame_count: usize,
}

impl MeanSpeed {
    /// The speed times a factor near 1.
    pub(crate) fn scaled(self, factor: f64) -> Self {
        Self { speed_rev_s: factor * self.speed_rev_s, ..self }
    }
}

impl SteadyMean {
    /// For frames that overlap so that `apart` hops are the length of a frame.
    pub(crate) fn new(apart: usize) -> Self {
        let capacity = NOISE_FRAMES + apart;
        Self {
            speeds_rev_s: Vec::with_capacity(capacity),
            differences: Vec::with_capacity(NOISE_FRAMES),
            apart,
            answers: [None; LATER_FRAMES],
            moving: Moving::default(),
        }
    }

    pub(crate) fn push(&mut self, speed_rev_s: f64) {
        if self.speeds_rev_s.len() == NOISE_FRAMES + self.apart {
            self.speeds_rev_s.copy_within(1.., 0);
            self.speeds_rev_s.pop();
        }
        self.speeds_rev_s.push(speed_rev_s);
        let last = self.speeds_rev_s.len() - 1;
        let before = |frames: usize| Some(speed_rev_s - self.speeds_rev_s.get(last.checked_sub(frames)?)?);
        if let (Some(answer), Some(near), Some(far)) = (self.answers[0], before(self.apart), before(2 * self.apart)) {
            let later = &self.speeds_rev_s[last + 1 - LATER_FRAMES..];
            let miss = answer.speed_rev_s - later.iter().sum::<f64>() / LATER_FRAMES as f64;
            self.moving.add(miss, near, far);
        }
        self.answers.rotate_left(1);
        self.answers[LATER_FRAMES - 1] = self.agreed();
    }

    /// The answer at the last frame, with the uncertainty by the noise alone.
    pub(crate) fn last(&self) -> Option<MeanSpeed> {
        self.answers[LATER_FRAMES - 1]
    }

    /// Frames that share no sound among so many that follow each other.
    fn independent(&self, frame_count: usize) -> f64 {
        (frame_count as f64 / self.apart as f64).max(1.0)
    }

    /// The speed now, with the uncertainty by the noise and by how much the speed moves. `None` before the first frames.
    pub(crate) fn now(&self) -> Option<MeanSpeed> {
        let answer = self.last()?;
        // the errors of answers have their noise too
        let of_moving = self.moving.variance(self.independent(LATER_FRAMES)).sqrt();
        Some(MeanSpeed { std_uncertainty_rev_s: answer.std_uncertainty_rev_s.max(of_moving), ..answer })
    }

    /// The longest mean that agrees with all shorter ones (Lepskii, Theory Probab. Appl. 35, 1990): long while the speed is steady, and short
    /// after a step. Its uncertainty is that by the noise of the frames.
    fn agreed(&mut self) -> Option<MeanSpeed> {
        let noise_rev_s = self.noise_rev_s()?;
        let mut agreed: Option<MeanSpeed> = None;
        let mut shorter: [Option<MeanSpeed>; FRAME_COUNTS.len()] = [None; FRAME_COUNTS.len()];
        for (place, &frame_count) in FRAME_COUNTS.iter().enumerate() {
            let Some(from) = self.speeds_rev_s.len().checked_sub(frame_count) else { break };
            let independent = self.independent(frame_count);
            let mean = MeanSpeed {
                speed_rev_s: self.speeds_rev_s[from..].iter().sum::<f64>() / frame_count as f64,
                std_uncertainty_rev_s: noise_rev_s / independent.sqrt(),
                frame_count,
            };
            let agrees = |other: &MeanSpeed| {
                (mean.speed_rev_s - other.speed_rev_s).abs() <= AGREE_STDS * other.std_uncertainty_rev_s
            };
            if !shorter.iter().flatten().all(agrees) {
                break;
            }
            shorter[place] = Some(mean);
            agreed = Some(mean);
        }
        agreed
    }

    /// Noise of one frame, from frames that share no sound. A step is one difference among many.
    fn noise_rev_s(&mut self) -> Option<f64> {
        let Self { speeds_rev_s, differences, apart, .. } = self;
        differences.clear();
        let pairs = speeds_rev_s.iter().zip(speeds_rev_s.iter().skip(*apart));
        differences.extend(pairs.map(|(before, after)| (after - before).abs()).take(NOISE_FRAMES));
        let middle = differences.len() / 2;
        let least = NOISE_SHARE_MIN * speeds_rev_s.last()?;
        if differences.is_empty() {
            return None;
        }
        let (_, median, _) = differences.select_nth_unstable_by(middle, f64::total_cmp);
        Some((STD_PER_MEDIAN_DIFFERENCE * *median).max(least))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use rand::SeedableRng;
    use rand_distr::{Distribution, Normal};
    use rand_pcg::Pcg64;

    fn speeds(step_at: usize, count: usize, seed: u64) -> Vec<f64> {
        let normal = Normal::new(0.0, 0.5).unwrap();
        let mut rng = Pcg64::seed_from_u64(seed);
        (0..count).map(|n| if n < step_at { 100.0 } else { 110.0 } + normal.sample(&mut rng)).collect()
    }

    #[test]
    fn a_steady_speed_is_a_long_mean_with_an_honest_uncertainty() {
        let (mut within, mut lengths) = (0, 0);
        for seed in 0..400 {
            let mut mean = SteadyMean::new(1);
            speeds(1000, 100, seed).into_iter().for_each(|speed| mean.push(speed));
            let now = mean.now().unwrap();
            within += usize::from((now.speed_rev_s - 100.0).abs() <= 2.0 * now.std_uncertainty_rev_s);
            lengths += usize::from(now.frame_count == 32);
        }
        // 2 u holds in 95 %; all comparisons agree in 90 %
        assert!((360..=395).contains(&within) && lengths > 340, "{within} {lengths}");
    }

    #[test]
    fn a_step_is_followed_in_one_frame() {
        for seed in 0..50 {
            let mut mean = SteadyMean::new(1);
            speeds(80, 81, seed).into_iter().for_each(|speed| mean.push(speed));
            let now = mean.now().unwrap();
            assert!(now.frame_count == 1 && (now.speed_rev_s - 110.0).abs() < 2.5, "{now:?}");
        }
    }

    /// The uncertainty is that of the speed at the moment, and a mean of many frames lags behind a speed that wanders.
    #[test]
    fn the_uncertainty_of_a_speed_that_wanders_holds_for_the_moment() {
        let normal = Normal::new(0.0, 1.0).unwrap();
        let (mut within, mut count) = (0, 0_u32);
        for seed in 0..40 {
            let mut rng = Pcg64::seed_from_u64(seed);
            let (mut mean, mut wander) = (SteadyMean::new(4), 0.0);
            let mut told: Vec<MeanSpeed> = Vec::new();
            for frame in 0..400 {
                // 1 % with a memory of 20 frames
                wander += -wander / 20.0 + (2.0f64 / 20.0).sqrt() * normal.sample(&mut rng);
                mean.push(100.0 + wander + 0.02 * normal.sample(&mut rng));
                told.extend(mean.now());
                // the frame whose middle is the moment of an answer is the second one after it
                if frame >= 200 {
                    let MeanSpeed { speed_rev_s, std_uncertainty_rev_s, .. } = told[told.len() - 3];
                    within += usize::from((speed_rev_s - 100.0 - wander).abs() <= 2.0 * std_uncertainty_rev_s);
                    count += 1;
                }
            }
        }
        let share = within as f64 / f64::from(count);
        assert!((0.9..0.985).contains(&share), "{share}");
    }

    #[test]
    fn too_few_frames_tell_no_uncertainty() {
        let mut mean = SteadyMean::new(4);
        (0..4).for_each(|_| mean.push(100.0));
        assert_eq!(mean.now(), None);
        mean.push(100.0);
        assert_eq!(mean.now().unwrap().speed_rev_s, 100.0);
    }
}
