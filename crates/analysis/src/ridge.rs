//! Ridges: the frequency of each harmonic over time, with explicit gaps.

use crate::Method;
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
}
