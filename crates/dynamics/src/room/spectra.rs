//! What is heard of a step: power spectra over orders, in frames of whole turns along a path.

/// Places in a frame, in equal parts of its turns, at which the path is given. *Numeric.*
pub const PLACES: usize = 6;

/// Spectra around one step.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct StepSpectra {
    /// Turns of the shaft in a frame: its bins are 1/turns orders apart.
    pub turns: f64,
    /// Order of the first bin, in bins.
    pub first_bin: usize,
    /// Orders of the lines that are heard.
    pub orders: Vec<f64>,
    /// Time between frames.
    pub hop_s: f64,
    /// The frames, in the sequence of time.
    pub frames: Vec<TurnFrame>,
}

/// One Hann frame over angle.
#[derive(Clone, Debug, PartialEq)]
pub struct TurnFrame {
    /// Its middle.
    pub centre_s: f64,
    /// Its length.
    pub length_s: f64,
    /// Times of the places.
    pub place_s: [f64; PLACES],
    /// The path there.
    pub path_rev_s: [f64; PLACES],
    /// Power of each bin.
    pub power: Vec<f64>,
}

impl StepSpectra {
    /// Bins of a frame.
    pub(super) fn bin_count(&self) -> usize {
        self.frames.first().map_or(0, |frame| frame.power.len())
    }
}
