//! Ridges: for each harmonic a curve of frequency over time, with explicit gaps.

use crate::Method;
use hovertone_vehicle::Order;
use serde::Serialize;

/// Where the ridge of one harmonic is looked for: the paper's band-pass (figure 7), as a cut of the spectrum. An ideal
/// band-pass before the transform and a search inside the band after it find the same peak.
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

/// What a frame shows of a tone.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Peak {
    /// Frequency by Maximum Trace.
    pub maximum_hz: f64,
    /// Frequency by the Gaussian approximation.
    pub gaussian_hz: f64,
    /// Width of that Gaussian.
    pub gaussian_std_hz: f64,
    /// Level of the peak, dB re a full-scale sine.
    pub level_db: f64,
    /// Level of the peak over the median of its surroundings.
    pub over_sides_db: f64,
    /// Whether the peak is the band's first or last bin.
    pub is_on_edge: bool,
}

impl Peak {
    /// Frequency by a method.
    pub fn hz(&self, method: Method) -> f64 {
        match method {
            Method::Harmonic | Method::Separated | Method::MaximumTrace => self.maximum_hz,
            Method::Gaussian => self.gaussian_hz,
        }
    }
}

/// One frame of a ridge: a peak, or a gap where nothing stands out of the noise.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct RidgeFrame {
    /// Middle of the frame on the recording's clock.
    pub time_s: f64,
    /// What the frame shows.
    pub peak: Option<Peak>,
}

/// The curve of one harmonic.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Ridge {
    /// Where it was looked for.
    pub band: Band,
    /// Length of its frames.
    pub window_s: f64,
    /// Step between frames.
    pub hop_s: f64,
    /// Distance between bins that are independent in noise.
    pub resolution_hz: f64,
    /// All frames in order of time, gaps included.
    pub frames: Vec<RidgeFrame>,
    /// Share of the frames whose peak is a line beyond doubt.
    pub line_share: f64,
}

impl Ridge {
    /// The frequencies of a method, gaps left out.
    pub fn points_hz(&self, method: Method) -> Vec<f64> {
        self.frames.iter().filter_map(|frame| frame.peak.map(|peak| peak.hz(method))).collect()
    }

    /// Frames that share no sound: how many observations the ridge is worth.
    pub fn independent_frames(&self) -> f64 {
        self.frames.len() as f64 * (self.hop_s / self.window_s).min(1.0)
    }

    /// Share of the frames that have a point.
    pub fn point_share(&self) -> f64 {
        self.frames.iter().filter(|frame| frame.peak.is_some()).count() as f64 / self.frames.len().max(1) as f64
    }
}
