//! From pressure to samples.

use super::automatic_gain::{AutomaticGain, GainControl};
use super::biquad::Biquad;
use super::level::{amplitude_pa, rms_pa};
use super::settings::{Bound, LEVEL, checked};
use crate::seed::{Part, stream};
use hovertone_vehicle::QuantityError;
use rand::RngExt;
use rand_distr::StandardNormal;
use rand_pcg::Pcg64;

/// One microphone: one channel of the sound.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MicrophoneSettings {
    /// Its place in the world. It is equally sensitive in all directions.
    pub position_m: [f64; 3],
    /// Lower -3 dB frequency (second order); `None` for no limit.
    pub high_pass_hz: Option<f64>,
    /// Upper -3 dB frequency (second order); `None` for no limit.
    pub low_pass_hz: Option<f64>,
    /// Its own white noise, as an equivalent sound level; `None` for none.
    pub self_noise_db_spl: Option<f64>,
    /// Noise of the wind over it, before the filters, as a sound level over the whole band; `None` for none. The power of its pressure falls as
    /// f^(−5/3), as in the inertial range of turbulence (5 dB per octave; Strasberg 1988), and is flat below 10 Hz.
    pub wind_noise_db_spl: Option<f64>,
    /// Gain of the recorder that follows the level, after its filters; `None` for a fixed gain.
    pub automatic_gain: Option<AutomaticGain>,
    /// Level of a sine with peaks at full scale, ±1; louder sound is clipped.
    pub full_scale_db_spl: f64,
    /// Bits of a sample, 2 to 24; samples are then whole multiples of `2^(1-bits)`, rounded without dither, at most
    /// `1 - 2^(1-bits)`. `None` for no rounding.
    pub bits: Option<u32>,
}

impl MicrophoneSettings {
    /// A phone's or camera's microphone.
    ///
    /// - 100 Hz and 16 kHz: "defined roll-off below about 100 Hz and above 16 kHz" (forensicspot.com, MEMS microphone).
    /// - Own noise 29 dB: 65 dB under 94 dB, a usual signal-to-noise ratio of such microphones (more than 60 dB: sistc.com).
    ///   Taken as white over the whole band, not A-weighted.
    /// - Full scale 100 dB: a camera with its gain set for a drone in the room (assumed). Fixed digital microphones have 120 dB
    ///   (Analog Devices' application note, at dataweek.co.za).
    /// - 16 bits.
    pub fn at(position_m: [f64; 3]) -> Self {
        Self {
            position_m,
            high_pass_hz: Some(100.0),
            low_pass_hz: Some(16_000.0),
            self_noise_db_spl: Some(29.0),
            wind_noise_db_spl: None,
            automatic_gain: None,
            full_scale_db_spl: 100.0,
            bits: Some(16),
        }
    }

    /// No filters, no noise, no rounding; 1 is the amplitude of a sine of 94 dB SPL: √2 Pa.
    pub fn ideal(position_m: [f64; 3]) -> Self {
        Self {
            position_m,
            high_pass_hz: None,
            low_pass_hz: None,
            self_noise_db_spl: None,
            wind_noise_db_spl: None,
            automatic_gain: None,
            full_scale_db_spl: 94.0,
            bits: None,
        }
    }

    pub(crate) fn check(&self, sample_rate_hz: f64) -> Result<(), QuantityError> {
        for value in self.position_m {
            checked("microphone position_m", value, Bound::Finite)?;
        }
        if let Some(value) = self.high_pass_hz {
            checked("high_pass_hz", value, Bound::Within(1.0, 2000.0, "between 1 and 2000"))?;
        }
        if let Some(value) = self.low_pass_hz {
            checked("low_pass_hz", value, Bound::Within(200.0, f64::MAX, "200 or more"))?;
        }
        if let Some(value) = self.self_noise_db_spl {
            checked("self_noise_db_spl", value, LEVEL)?;
        }
        if let Some(value) = self.wind_noise_db_spl {
            checked("wind_noise_db_spl", value, LEVEL)?;
        }
        if let Some(automatic) = &self.automatic_gain {
            automatic.check()?;
        }
        if let Some(bits) = self.bits {
            checked("bits", f64::from(bits), Bound::Within(2.0, 24.0, "between 2 and 24"))?;
        }
        checked("full_scale_db_spl", self.full_scale_db_spl, LEVEL)?;
        checked("sample_rate_hz", sample_rate_hz, Bound::Positive)
    }
}

pub(crate) struct Microphone {
    /// Full scale per pascal.
    gain: f64,
    high_pass: Option<Biquad>,
    low_pass: Option<Biquad>,
    /// Standard deviation of its own noise, in full scale.
    noise_std: f64,
    random: Pcg64,
    automatic_gain: Option<GainControl>,
    /// Steps per unit.
    steps: Option<f64>,
}

impl Microphone {
    pub(crate) fn new(settings: &MicrophoneSettings, sample_rate_hz: f64, seed: u64, index: u64) -> Self {
        let gain = 1.0 / amplitude_pa(settings.full_scale_db_spl);
        // A corner above half the sample rate has no effect beyond the recorder's own limit.
        let low_pass_hz = settings.low_pass_hz.filter(|hz| *hz < 0.49 * sample_rate_hz);
        Self {
            gain,
            high_pass: settings.high_pass_hz.map(|hz| Biquad::high_pass(hz, sample_rate_hz)),
            low_pass: low_pass_hz.map(|hz| Biquad::low_pass(hz, sample_rate_hz)),
            noise_std: settings.self_noise_db_spl.map_or(0.0, |level| gain * rms_pa(level)),
            random: stream(seed, Part::SelfNoise, index),
            automatic_gain: settings.automatic_gain.map(|automatic| GainControl::new(automatic, sample_rate_hz)),
            steps: settings.bits.map(|bits| 2_f64.powi(bits as i32 - 1)),
        }
    }

    /// From one sample of the pressure, Pa, to one sample of the recording.
    pub(crate) fn sample(&mut self, pressure_pa: f32) -> f32 {
        let mut value = self.gain * f64::from(pressure_pa);
        if let Some(filter) = &mut self.high_pass {
            value = filter.filtered(value);
        }
        if let Some(filter) = &mut self.low_pass {
            value = filter.filtered(value);
        }
        if self.noise_std > 0.0 {
            let normal: f64 = self.random.sample(StandardNormal);
            value += self.noise_std * normal;
        }
        if let Some(automatic) = &mut self.automatic_gain {
            value = automatic.sample(value);
        }
        match self.steps {
            None => value.clamp(-1.0, 1.0) as f32,
            Some(steps) => ((value * steps).round_ties_even().clamp(-steps, steps - 1.0) / steps) as f32,
        }
    }
}
