//! What a row sees of the speed around its time: the speed at an instant, or a weighted mean over a frame of sound.

use hovertone_signal::spectrogram::hann_frequency_weight;

/// Places in a frame. *Numeric*: the mean of a first-order curve over a frame of two time constants is right to 1e-4 of the step.
const PLACES: u32 = 16;

/// Weighted places around the time of a row.
pub(crate) struct FrameResponse {
    places: Vec<Place>,
}

struct Place {
    offset_s: f64,
    weight: f64,
}

impl FrameResponse {
    /// The response of Hann frames of this length; 0 for the speed at an instant.
    pub(crate) fn of_frame(frame_s: f64) -> Self {
        if frame_s <= 0.0 {
            return Self { places: vec![Place { offset_s: 0.0, weight: 1.0 }] };
        }
        let shares = (0..PLACES).map(|at| (f64::from(at) + 0.5) / f64::from(PLACES) - 0.5);
        let mut places: Vec<Place> =
            shares.map(|share| Place { offset_s: share * frame_s, weight: hann_frequency_weight(share) }).collect();
        let sum: f64 = places.iter().map(|place| place.weight).sum();
        places.iter_mut().for_each(|place| place.weight /= sum);
        Self { places }
    }

    /// The weighted mean of a function of the time from the row.
    pub(crate) fn mean(&self, value: impl Fn(f64) -> f64) -> f64 {
        self.places.iter().map(|place| place.weight * value(place.offset_s)).sum()
    }
}
