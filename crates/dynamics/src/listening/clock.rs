//! Where the clock of the log lies on that of the recording: the shift at which the predicted speeds make the sound most likely.

use super::along::{NEAR_SHARE, SoundConfig, WIDE_SHARE, windows_within};
use super::heard_lines::HeardLines;
use super::search::{HoverListener, ORDER_MAX, nats_along, with_same_hover};
use super::window::Window;
use crate::grey_box::{GreyBoxModel, LoopInputs, SpeedPrediction};

/// Largest shift that is tried, s. *Decision*: recording and log are started by hand, one after the other.
const REACH_S: f64 = 10.0;
/// Step of the shifts, s. *Numeric*: the peak is as wide as the fastest change of a speed, 0.1 s.
const STEP_S: f64 = 0.05;
/// Most windows that are heard. *Numeric*: a peak of thousands of nats needs no more.
const WINDOWS_MAX: usize = 60;
/// Shifts that are as near belong to one peak, s. *Physics*: half of a long doublet.
const PEAK_S: f64 = 0.5;
/// The highest of all peaks counts where it is so much higher than the next one, in standard deviations over all shifts. *Decision*: of a hundred
/// peaks by chance, the highest stands out by so much in 1 of 100 cases, exp(−1.5 √(2 ln 100)). Logs of other flights had up to 0.5,
/// the right ones 1.6 and more.
const STANDS_OUT_STDS: f64 = 1.5;

/// What to add to the clock of the log to get that of the recording, s: the most likely of shifts up to 10 s, right to 0.025 s. `None` where no shift
/// stands out: then the sound does not follow the log.
pub fn log_offset_s(
    heard: &HeardLines,
    inputs: &LoopInputs,
    start: &GreyBoxModel,
    config: &SoundConfig,
) -> Option<f64> {
    let windows = windows_within(heard.start_s, heard.end_s, config.window_s);
    let windows: Vec<Window> = windows.iter().step_by(windows.len().div_ceil(WINDOWS_MAX).max(1)).copied().collect();
    let hover = still(heard, start);
    let wide = heard.followed(&hover, WIDE_SHARE);
    let mut listener = HoverListener::new(&wide, ORDER_MAX, start, &hover, &windows);
    let model = with_same_hover(&mut listener, start, config);
    let near = heard.followed(&still(heard, &model), NEAR_SHARE);
    let mut prediction = SpeedPrediction::new(inputs, &model);
    let start_s = prediction.start_s;
    let steps = (REACH_S / STEP_S) as i32;
    let shifts = (-steps..=steps).map(|step| {
        let offset_s = STEP_S * f64::from(step);
        prediction.start_s = start_s + offset_s;
        Shift { offset_s, nats: nats_along(&near, ORDER_MAX, &prediction, &windows) }
    });
    standing_out(&shifts.collect::<Vec<_>>())
}

/// A shift of the log's clock, and how likely the sound is with it.
#[derive(Clone, Copy, Debug)]
struct Shift {
    offset_s: f64,
    nats: f64,
}

/// The shift whose peak is far above all others.
fn standing_out(shifts: &[Shift]) -> Option<f64> {
    let highest = |shifts: &mut dyn Iterator<Item = Shift>| shifts.max_by(|a, b| a.nats.total_cmp(&b.nats));
    let first = highest(&mut shifts.iter().copied())?;
    let is_other = |shift: &Shift| (shift.offset_s - first.offset_s).abs() > PEAK_S;
    let second = highest(&mut shifts.iter().copied().filter(is_other))?;
    let count = shifts.len() as f64;
    let mean = shifts.iter().map(|shift| shift.nats).sum::<f64>() / count;
    let std = (shifts.iter().map(|shift| (shift.nats - mean).powi(2)).sum::<f64>() / count).sqrt();
    (first.nats - second.nats > STANDS_OUT_STDS * std).then_some(first.offset_s)
}

/// Rotors that keep the mean hover speed of a model for the whole recording.
fn still(heard: &HeardLines, model: &GreyBoxModel) -> SpeedPrediction {
    let step_s = (heard.end_s - heard.start_s).max(f64::MIN_POSITIVE);
    SpeedPrediction { start_s: heard.start_s, step_s, speed_rad_s: vec![[model.mean_hover_rad_s(); 4]; 2] }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn one_high_peak_is_the_shift_and_several_alike_are_none() {
        let with_peaks = |peaks: &[(f64, f64)]| -> Vec<Shift> {
            let at = |offset_s: f64| {
                let wave = 100.0 * (3.1 * offset_s).sin();
                peaks.iter().map(|(place, height)| height * (-((offset_s - place) / 0.1).powi(2)).exp()).sum::<f64>()
                    + wave
            };
            (-200..=200)
                .map(|step| 0.05 * f64::from(step))
                .map(|offset_s| Shift { offset_s, nats: at(offset_s) })
                .collect()
        };
        assert!(standing_out(&with_peaks(&[(-3.0, 900.0)])).is_some_and(|offset_s| (offset_s + 3.0).abs() < 0.06));
        assert_eq!(standing_out(&with_peaks(&[(-3.0, 900.0), (4.0, 850.0)])), None);
        assert_eq!(standing_out(&with_peaks(&[])), None);
        assert_eq!(standing_out(&[]), None);
    }
}
