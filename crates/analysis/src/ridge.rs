//! Ridges: the frequency of each harmonic over time, with explicit gaps.

use crate::{Method, Span};
use hovertone_vehicle::Order;
use serde::Serialize;

/// Frequency band of the ridge of one harmonic: the band-pass of the paper (figure 7) as a cut of the spectrum. An ideal band-pass before
/// the transform and a search inside the band after it find the same peak.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Band {
    /// Number of the harmonic: 1 for the tone itself.
    pub harmonic: u32,
    /// Order of this harmonic.
    pub order: Order,
    /// Lower edge.
    pub band_hz_low: f64,
    /// Upper edge.
    pub band_hz_high: f64,
}

impl Band {
    /// Width of the band.
    pub fn width_hz(&self) -> f64 {
        self.band_hz_high - self.band_hz_low
    }
}

/// The peak of a frame.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Peak {
    /// Frequency by Maximum Trace.
    pub maximum_hz: f64,
    /// Frequency by the Gaussian approximation.
    pub gaussian_hz: f64,
    /// Standard deviation of that Gaussian.
    pub gaussian_std_hz: f64,
    /// Level of the peak, dB re a full-scale sine.
    pub level_db: f64,
    /// Level of the peak over the median level of its surroundings.
    pub over_sides_db: f64,
    /// Whether the peak is the first or last bin of the band.
    pub is_on_edge: bool,
}

impl Peak {
    /// Frequency by the given method.
    pub fn hz(&self, method: Method) -> f64 {
        match method {
            Method::Harmonic | Method::Separated | Method::MaximumTrace => self.maximum_hz,
            Method::Gaussian => self.gaussian_hz,
        }
    }
}

/// One frame of a ridge: a peak, or a gap where no peak exceeds the noise.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct RidgeFrame {
    /// Middle of the frame on the recording's clock.
    pub time_s: f64,
    /// The peak, if there is one.
    pub peak: Option<Peak>,
}

/// The ridge of one harmonic.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Ridge {
    /// Its band.
    pub band: Band,
    /// Length of its frames.
    pub window_s: f64,
    /// Step between frames.
    pub hop_s: f64,
    /// Distance between bins with independent noise.
    pub resolution_hz: f64,
    /// All frames in order of time, gaps included.
    pub frames: Vec<RidgeFrame>,
    /// Share of the frames whose peak is clearly a line.
    pub line_share: f64,
}

impl Ridge {
    /// The frequencies by the given method, without gaps.
    pub fn points_hz(&self, method: Method) -> Vec<f64> {
        self.frames.iter().filter_map(|frame| frame.peak.map(|peak| peak.hz(method))).collect()
    }

    /// Number of frames without overlap, which is the number of independent observations.
    pub fn independent_frames(&self) -> f64 {
        self.frames.len() as f64 * (self.hop_s / self.window_s).min(1.0)
    }

    /// Share of the frames with a peak.
    pub fn point_share(&self) -> f64 {
        self.frames.iter().filter(|frame| frame.peak.is_some()).count() as f64 / self.frames.len().max(1) as f64
    }

    /// The longest stretch that is mostly clear: the one with the greatest number of points less its fair share of gaps, so that no more than
    /// `gap_share_max` of its frames are gaps. `None` without a point.
    pub fn clearest_span(&self, gap_share_max: f64) -> Option<Span> {
        let mut best: Option<(f64, &RidgeFrame, &RidgeFrame)> = None;
        let mut now: Option<(f64, &RidgeFrame, f64)> = None;
        for frame in &self.frames {
            let (sum, first) = match now {
                // a pause between two parts of a hover ends a stretch
                Some((sum, first, last_s)) if sum > 0.0 && frame.time_s - last_s < 2.0 * self.hop_s => (sum, first),
                _ => (0.0, frame),
            };
            let sum = sum + gap_share_max - f64::from(u8::from(frame.peak.is_none()));
            if sum > best.map_or(0.0, |(best, ..)| best) {
                best = Some((sum, first, frame));
            }
            now = Some((sum, first, frame.time_s));
        }
        let half_s = self.window_s / 2.0;
        best.map(|(_, first, last)| Span { from_s: (first.time_s - half_s).max(0.0), to_s: last.time_s + half_s })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A ridge with a frame each tenth of a second: `x` is a point, `.` a gap and `|` a pause of a second.
    fn ridge(frames: &str) -> Ridge {
        let peak = Peak {
            maximum_hz: 100.0,
            gaussian_hz: 100.0,
            gaussian_std_hz: 1.0,
            level_db: -20.0,
            over_sides_db: 20.0,
            is_on_edge: false,
        };
        let mut time_s = 0.0;
        let mut all = Vec::new();
        for frame in frames.chars() {
            time_s += if frame == '|' { 1.0 } else { 0.1 };
            if frame != '|' {
                all.push(RidgeFrame { time_s, peak: (frame == 'x').then_some(peak) });
            }
        }
        let order = Order::try_from(2.0).unwrap();
        let band = Band { harmonic: 1, order, band_hz_low: 90.0, band_hz_high: 110.0 };
        Ridge { band, window_s: 0.2, hop_s: 0.1, resolution_hz: 5.0, frames: all, line_share: 0.5 }
    }

    #[test]
    fn the_clearest_stretch_is_long_and_has_few_gaps() {
        let span = |frames: &str| {
            let span = ridge(frames).clearest_span(0.3)?;
            Some([span.from_s, span.to_s].map(|time_s| (10.0 * time_s).round() / 10.0))
        };
        assert_eq!(span("...."), None);
        assert_eq!(span("..xxx.xxx....x.."), Some([0.2, 1.0]));
        assert_eq!(span("xx|xxx"), Some([1.2, 1.6]));
        assert_eq!(span("x.......xxxxxxxx"), Some([0.8, 1.7]));
    }
}
