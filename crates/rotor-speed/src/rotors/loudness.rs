//! The levels of the lines by which a rotor is known.

use crate::thresholds::NOISE_STDS_MAX;

/// Standard deviation of the level of a line, in nepers. *Decision.*
const LEVEL_STD: f64 = 0.35;
/// Distance of a level from the wanted one beyond which it costs no more, in standard deviations.
const LEVEL_STDS_MAX: f64 = NOISE_STDS_MAX;
/// Levels drift over this time: all frames within it are one observation. *Decision.*
const LEVEL_S: f64 = 1.5;

/// Logarithm of the level of each line of a rotor; `None` where it is not apart from another rotor's.
pub(super) type Levels = [Option<f64>];

/// Weighted mean of the level of a line over some frames.
#[derive(Clone, Copy, Debug, Default)]
struct LevelMean {
    sum: f64,
    /// Sum of the weights of the frames.
    weight: f64,
}

impl LevelMean {
    /// Over these frames and others, which count less.
    fn and(self, keep: f64, others: Self) -> Self {
        Self { sum: self.sum + keep * others.sum, weight: self.weight + keep * others.weight }
    }

    fn of(level: Option<f64>) -> Self {
        level.map_or_else(Self::default, |sum| Self { sum, weight: 1.0 })
    }

    fn level(self) -> Option<f64> {
        (self.weight > 0.0).then(|| self.sum / self.weight)
    }

    /// Variance of the mean.
    fn variance(self, frame_s: f64) -> f64 {
        LEVEL_STD.powi(2) * (LEVEL_S / (self.weight * frame_s)).max(1.0)
    }
}

/// The levels of each rotor up to a frame, and after it: `means[rotor][line]`.
pub(super) struct Sides {
    before: Vec<Vec<LevelMean>>,
    after: Vec<Vec<LevelMean>>,
    /// What a frame counts less than the one before it or after it, towards this frame.
    keep: f64,
    frame_s: f64,
}

/// The sides of each frame, where `levels[frame][rotor]` are those of the frames and `known[rotor]` those from before. The nearest frames count
/// most, or, if the levels do not `drift`, all alike.
pub(super) fn sides_of_frames(
    levels: &[Vec<&Levels>],
    known: &[Vec<Option<f64>>],
    frame_s: f64,
    drift: bool,
) -> Vec<Sides> {
    let keep = if drift { (-frame_s / LEVEL_S).exp() } else { 1.0 };
    let means = |rotors: &[&Levels]| -> Vec<Vec<LevelMean>> {
        rotors.iter().map(|levels| levels.iter().copied().map(LevelMean::of).collect()).collect()
    };
    let and = |now: Vec<Vec<LevelMean>>, others: &[Vec<LevelMean>]| -> Vec<Vec<LevelMean>> {
        let others = others.iter().map(Vec::as_slice).chain(std::iter::repeat(&[] as &[LevelMean]));
        now.into_iter()
            .zip(others)
            .map(|(now, others)| {
                let others = others.iter().copied().chain(std::iter::repeat(LevelMean::default()));
                now.into_iter().zip(others).map(|(now, others)| now.and(keep, others)).collect()
            })
            .collect()
    };
    // what is known stands for all that came before
    let as_long_as_levels_last = LEVEL_S / frame_s;
    let of_before = |level: &Option<f64>| {
        let one = LevelMean::of(*level);
        LevelMean { sum: as_long_as_levels_last * one.sum, weight: as_long_as_levels_last * one.weight }
    };
    let mut before: Vec<Vec<LevelMean>> = known.iter().map(|levels| levels.iter().map(of_before).collect()).collect();
    let mut sides: Vec<Sides> = levels
        .iter()
        .map(|rotors| {
            before = and(means(rotors), &before);
            Sides { before: before.clone(), after: Vec::new(), keep, frame_s }
        })
        .collect();
    let mut after = vec![Vec::new(); levels.last().map_or(0, Vec::len)];
    for (sides, rotors) in sides.iter_mut().zip(levels).rev() {
        sides.after.clone_from(&after);
        after = and(means(rotors), &after);
    }
    sides
}

impl Sides {
    /// The levels at which each rotor is expected in the frame: `levels[rotor][line]`.
    pub(super) fn expected(&self) -> Vec<Vec<Option<f64>>> {
        let rotors = self.before.iter().zip(&self.after);
        rotors
            .map(|(before, after)| {
                let after = after.iter().copied().chain(std::iter::repeat(LevelMean::default()));
                before.iter().zip(after).map(|(before, after)| before.and(self.keep, after).level()).collect()
            })
            .collect()
    }

    /// What it costs more that two rotors change places after the frame than that they do not.
    pub(super) fn cost_of_exchange(&self, a: usize, b: usize) -> f64 {
        let cost = |before: LevelMean, after: LevelMean| {
            let difference = before.level()? - after.level()?;
            Some(difference.powi(2) / (before.variance(self.frame_s) + after.variance(self.frame_s)))
        };
        let before = self.before[a].iter().zip(&self.before[b]);
        let after = self.after[a].iter().zip(&self.after[b]);
        before
            .zip(after)
            .filter_map(|((&a, &b), (&c, &d))| Some(cost(a, d)? + cost(b, c)? - cost(a, c)? - cost(b, d)?))
            .sum()
    }
}

/// What it costs that a frame with these levels is of a rotor that is expected at those.
pub(super) fn level_cost(levels: &Levels, expected: &Levels, frame_s: f64) -> f64 {
    let costs = levels
        .iter()
        .zip(expected)
        .filter_map(|(level, wanted)| Some((((*level)? - (*wanted)?) / LEVEL_STD).powi(2).min(LEVEL_STDS_MAX.powi(2))));
    frame_s / LEVEL_S * costs.sum::<f64>()
}

#[cfg(test)]
mod tests {
    use super::*;

    const FRAME_S: f64 = 0.05;

    /// Two rotors with one line, whose levels change from one pair to the other in the middle of 100 frames.
    fn sides(before: [f64; 2], after: [f64; 2]) -> Vec<Sides> {
        let [before, after] = [before, after].map(|levels| levels.map(|level| [Some(level)]));
        let frames: Vec<Vec<&Levels>> = (0..100)
            .map(|frame| (if frame < 50 { &before } else { &after }).iter().map(|level| level.as_slice()).collect())
            .collect();
        sides_of_frames(&frames, &[], FRAME_S, true)
    }

    #[test]
    fn rotors_that_keep_their_levels_have_not_changed_places() {
        let cost = |before, after| sides(before, after)[49].cost_of_exchange(0, 1);
        // twice the squared difference of two means over both variances, which are larger as the frames reach no further than 2.5 s
        let seen_s = LEVEL_S * (1.0 - f64::exp(-2.5 / LEVEL_S));
        let expected = 2.0 * (0.7f64 / LEVEL_STD).powi(2) / (2.0 * LEVEL_S / seen_s);
        assert!(
            (cost([1.0, 0.3], [1.0, 0.3]) / expected - 1.0).abs() < 0.1,
            "{} {expected}",
            cost([1.0, 0.3], [1.0, 0.3])
        );
        assert!((cost([1.0, 0.3], [0.3, 1.0]) / expected + 1.0).abs() < 0.1);
        assert_eq!(cost([1.0, 1.0], [1.0, 1.0]), 0.0);
    }

    #[test]
    fn a_rotor_is_expected_at_the_levels_around_it() {
        let sides = sides([1.0, 0.3], [0.0, 0.0]);
        let expected = |frame: usize| sides[frame].expected()[0][0].unwrap();
        assert!(expected(0) > 0.8 && expected(99) < 0.2, "{} {}", expected(0), expected(99));
        assert!((expected(49) - 0.5).abs() < 0.05, "{}", expected(49));
        assert_eq!(level_cost(&[Some(1.0), None], &[Some(1.0), Some(3.0)], FRAME_S), 0.0);
    }
}
