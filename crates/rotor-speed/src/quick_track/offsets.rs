//! Scores of shifts → the shift of each frame: the one at which its scores are most like the mean of all frames.

use hovertone_signal::statistics::median;

/// Share of the shifts that may be the answer, in the middle: the rest is compared. *Numeric.*
const SEARCHED_SHARE: f64 = 0.5;
/// Rounds in which the mean of the scores is made of shifted frames. *Numeric.*
const ROUNDS: usize = 2;

/// Frames over which the curvature is a mean: the length of a frame. *Numeric.*
const CURVATURE_FRAMES: usize = 10;
/// Smallest curvature over its mean: weaker frames count as that. *Numeric.*
const CURVATURE_SHARE_MIN: f64 = 0.1;
/// Share of the height above which the mean of the scores is a line. *Numeric.*
const LINE_SHARE: f64 = 0.5;

/// Shifts of the frames, in steps, and how clearly each is told.
#[derive(Clone, Debug, Default)]
pub(super) struct FrameShifts {
    /// Shift of highest likeness.
    pub(super) steps: Vec<f64>,
    /// Slope of the likeness to the lines at no shift, over its curvature: the shift of highest likeness, if it is near. A frame that is most like
    /// them at a far shift says little.
    pub(super) slopes: Vec<f64>,
    /// Height of the lines over the noise beside them, in nats: that of the mean of all frames, by the likeness of the frame to it.
    pub(super) heights: Vec<f64>,
}

/// The shift of each frame. All rotors move by the same share, so that their lines make a pattern that shifts as a whole: the mean of the scores of
/// all frames. Its centre is at 0.
pub(super) fn frame_shifts(scores: &[Vec<f64>]) -> FrameShifts {
    let Some(count) = scores.first().map(Vec::len) else { return FrameShifts::default() };
    let half = (SEARCHED_SHARE * count as f64 / 2.0) as usize;
    let mut steps = vec![0.0; scores.len()];
    let mut likeness = Vec::new();
    let mut mean = mean_of(scores, &steps);
    for _ in 0..ROUNDS {
        let shape = centred(&mean[half..count - half]);
        let squares: f64 = shape.iter().map(|value| value * value).sum();
        likeness.clear();
        for (step, scores) in steps.iter_mut().zip(scores) {
            let best = best_shift(scores, &shape, half);
            *step = best.step;
            likeness.push(best.product / squares.max(f64::MIN_POSITIVE));
        }
        mean = mean_of(scores, &steps);
        let centre = centre_of(&mean[half..count - half]);
        steps.iter_mut().for_each(|step| *step += centre);
        mean = mean_of(scores, &steps);
    }
    let middle = &mean[half..count - half];
    let highest = middle.iter().copied().fold(f64::NEG_INFINITY, f64::max);
    let height = highest - median(&mean).unwrap_or(highest);
    FrameShifts {
        steps,
        slopes: slopes_of(scores, &lines_of(middle), half),
        heights: likeness.iter().map(|likeness| likeness * height).collect(),
    }
}

/// The slope of each frame's likeness to the lines at no shift, over the curvature around it.
fn slopes_of(scores: &[Vec<f64>], lines: &[f64], half: usize) -> Vec<f64> {
    let products = |scores: &Vec<f64>| [half - 1, half, half + 1].map(|from| product(scores, lines, from));
    let all: Vec<[f64; 3]> = scores.iter().map(products).collect();
    let curvatures: Vec<f64> = all.iter().map(|[before, at, after]| 2.0 * at - before - after).collect();
    let mean_of = |values: &[f64]| values.iter().sum::<f64>() / values.len() as f64;
    let least = CURVATURE_SHARE_MIN * mean_of(&curvatures).max(f64::MIN_POSITIVE);
    let near = |frame: usize| {
        let from = frame.saturating_sub(CURVATURE_FRAMES / 2);
        mean_of(&curvatures[from..(frame + CURVATURE_FRAMES / 2 + 1).min(curvatures.len())]).max(least)
    };
    all.iter().enumerate().map(|(frame, [before, _, after])| 0.5 * (after - before) / near(frame)).collect()
}

/// The lines of the mean scores: what stands above a share of the height.
fn lines_of(mean: &[f64]) -> Vec<f64> {
    let over = centred(mean);
    let least = LINE_SHARE * over.iter().copied().fold(0.0, f64::max);
    let lines: Vec<f64> = over.into_iter().map(|value| (value - least).max(0.0)).collect();
    centred(&lines)
}

/// Likeness of scores to a shape that begins at one of them.
fn product(scores: &[f64], shape: &[f64], from: usize) -> f64 {
    scores[from..].iter().zip(shape).map(|(score, shape)| score * shape).sum()
}

struct BestShift {
    step: f64,
    product: f64,
}

fn best_shift(scores: &[f64], shape: &[f64], half: usize) -> BestShift {
    let products: Vec<f64> = (0..=2 * half).map(|from| product(scores, shape, from)).collect();
    let at = (0..products.len()).max_by(|&a, &b| products[a].total_cmp(&products[b])).unwrap_or(half);
    let beside = |at: usize| products.get(at).copied();
    let fraction = match (at.checked_sub(1).and_then(beside), beside(at + 1)) {
        (Some(before), Some(after)) if 2.0 * products[at] > before + after => {
            0.5 * (after - before) / (2.0 * products[at] - before - after)
        }
        _ => 0.0,
    };
    BestShift { step: at as f64 + fraction - half as f64, product: products[at] }
}

/// The mean of the scores of all frames, each shifted.
fn mean_of(scores: &[Vec<f64>], steps: &[f64]) -> Vec<f64> {
    let count = scores.first().map_or(0, Vec::len);
    let mut mean = vec![0.0; count];
    for (scores, step) in scores.iter().zip(steps) {
        let (whole, share) = (step.floor() as isize, step - step.floor());
        let at = |place: isize| scores[place.clamp(0, count as isize - 1) as usize];
        for (place, into) in (0..).zip(&mut mean) {
            *into += (1.0 - share) * at(place + whole) + share * at(place + whole + 1);
        }
    }
    mean.iter_mut().for_each(|value| *value /= scores.len().max(1) as f64);
    mean
}

fn centred(values: &[f64]) -> Vec<f64> {
    let mean = values.iter().sum::<f64>() / values.len().max(1) as f64;
    values.iter().map(|value| value - mean).collect()
}

/// Centre of the part above the mean, from the middle.
fn centre_of(values: &[f64]) -> f64 {
    let above: Vec<f64> = centred(values).into_iter().map(|value| value.max(0.0).powi(2)).collect();
    let sum: f64 = above.iter().sum();
    let middle = (values.len() as f64 - 1.0) / 2.0;
    let moment: f64 = above.iter().enumerate().map(|(at, value)| (at as f64 - middle) * value).sum();
    if sum > 0.0 { moment / sum } else { 0.0 }
}
