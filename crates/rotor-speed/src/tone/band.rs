//! Shaft speed → one search band for each harmonic of the tone.

use crate::error::Error;
use crate::tone::ToneConfig;
use hovertone_analysis::{Band, Warning};
use hovertone_signal::channels::ChannelBand;
use hovertone_vehicle::BLADES_MAX;
use std::ops::RangeInclusive;

/// Sound above this share of half the sample rate is inside the recorder's own filter. *Physics.*
const USABLE_NYQUIST_SHARE: f64 = 0.98;

/// Shaft speeds to look for, in turns per second: the given band's or the configured ones, as far as a recording of that
/// rate can hold their tone.
pub(crate) fn search_range_rev_s(tone: &ToneConfig, sample_rate_hz: f64) -> Result<RangeInclusive<f64>, Error> {
    let order = tone.order.lines_per_turn();
    let hz_max = USABLE_NYQUIST_SHARE * sample_rate_hz / 2.0;
    if let Some((low_hz, high_hz)) = tone.band_hz {
        if high_hz > hz_max {
            return Err(Error::BandAboveNyquist { low_hz, high_hz, sample_rate_hz });
        }
        return Ok(low_hz / order..=high_hz / order);
    }
    let low = tone.speed_min.rev_s();
    let high = tone.speed_max.rev_s().min(hz_max / (1.0 + tone.band_half_width_share) / order);
    if low < high { Ok(low..=high) } else { Err(Error::ToneAboveNyquist { order: tone.order, sample_rate_hz }) }
}

/// The bands around a shaft speed, as many harmonics as the recording can hold.
pub(crate) fn bands_around(
    speed_rev_s: f64,
    tone: &ToneConfig,
    sample_rate_hz: f64,
    warnings: &mut Vec<Warning>,
) -> Result<Vec<Band>, Error> {
    let (low_hz, high_hz) = followed_hz(speed_rev_s, tone);
    let hz_max = USABLE_NYQUIST_SHARE * sample_rate_hz / 2.0;
    let mut bands = Vec::new();
    for harmonic in 1..=tone.harmonics {
        let times = f64::from(harmonic);
        if times * high_hz <= hz_max {
            bands.push(Band {
                harmonic,
                order: tone.order.harmonic(harmonic),
                band_hz_low: times * low_hz,
                band_hz_high: times * high_hz,
            });
        } else if harmonic == 1 {
            return Err(Error::BandAboveNyquist { low_hz, high_hz, sample_rate_hz });
        } else {
            let reason = format!(
                "its frequency may be as high as {:.0} Hz, and the recording has no sound above {hz_max:.0} Hz",
                times * high_hz
            );
            warnings.push(Warning::HarmonicLeftOut { harmonic, reason });
        }
    }
    Ok(bands)
}

/// Every line that the harmonic likelihood hears: the blade pass and the gear mesh with their harmonics, as far as each is known
/// and the recording can hold them.
pub(crate) fn lines_around(speed_rev_s: f64, tone: &ToneConfig, sample_rate_hz: f64) -> Vec<ChannelBand> {
    let order = tone.order.lines_per_turn();
    let (low_hz, high_hz) = followed_hz(speed_rev_s, tone);
    lines_between_speeds(&(low_hz / order..=high_hz / order), tone, sample_rate_hz)
}

/// The band in which the tone is followed: around the speed that was found, and inside the band that was given. A given band may be so wide
/// that it holds several octaves; which of them is the rotor's was decided before.
fn followed_hz(speed_rev_s: f64, tone: &ToneConfig) -> (f64, f64) {
    let tone_hz = speed_rev_s * tone.order.lines_per_turn();
    let (low_hz, high_hz) =
        (tone_hz * (1.0 - tone.band_half_width_share), tone_hz * (1.0 + tone.band_half_width_share));
    match tone.band_hz {
        None => (low_hz, high_hz),
        Some((given_low_hz, given_high_hz)) => (low_hz.max(given_low_hz), high_hz.min(given_high_hz)),
    }
}

/// The same lines, for shafts in a range of speeds.
pub fn lines_between_speeds(
    speeds_rev_s: &RangeInclusive<f64>,
    tone: &ToneConfig,
    sample_rate_hz: f64,
) -> Vec<ChannelBand> {
    let order = tone.order.lines_per_turn();
    let hz_max = USABLE_NYQUIST_SHARE * sample_rate_hz / 2.0;
    let is_blade_pass = order <= BLADES_MAX;
    let blades = tone.blades.map(f64::from).filter(|_| !is_blade_pass);
    let own = if is_blade_pass { tone.blade_pass_lines } else { tone.gear_mesh_lines };
    let blade_pass =
        blades.into_iter().flat_map(|blades| (1..=tone.blade_pass_lines).map(move |k| f64::from(k) * blades));
    let mut orders: Vec<f64> = (1..=own).map(|k| f64::from(k) * order).chain(blade_pass).collect();
    orders.sort_by(f64::total_cmp);
    orders.dedup();
    orders
        .into_iter()
        .filter(|order| order * speeds_rev_s.end() <= hz_max)
        .map(|order| ChannelBand {
            order,
            is_first: order == tone.order.lines_per_turn() || blades == Some(order),
            band_hz_low: order * speeds_rev_s.start(),
            band_hz_high: order * speeds_rev_s.end(),
            noise_fall_db: 0.0,
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use hovertone_vehicle::Order;

    fn mesh() -> ToneConfig {
        ToneConfig::of_order(Order::new(69.0).unwrap())
    }

    #[test]
    fn three_harmonics_have_three_bands_that_do_not_touch() {
        let bands = bands_around(60.17, &mesh(), 48000.0, &mut Vec::new()).unwrap();
        assert_eq!(bands.len(), 3);
        assert_eq!(bands[2].order.lines_per_turn(), 207.0);
        assert!(bands.windows(2).all(|pair| pair[0].band_hz_high < pair[1].band_hz_low));
        assert!(bands[0].band_hz_low < 4151.7 && bands[0].band_hz_high > 4151.7);
    }

    #[test]
    fn a_given_band_is_followed_where_the_speed_was_found() {
        let with_band = |band_hz: (f64, f64)| {
            let tone = ToneConfig { band_hz: Some(band_hz), ..mesh() };
            let bands = bands_around(60.0, &tone, 48000.0, &mut Vec::new()).unwrap();
            let lines = lines_around(60.0, &tone, 48000.0);
            assert_eq!((lines[0].band_hz_low, lines[0].band_hz_high), (bands[0].band_hz_low, bands[0].band_hz_high));
            (bands[0].band_hz_low.round(), bands[0].band_hz_high.round())
        };
        assert_eq!(with_band((4000.0, 4200.0)), (4000.0, 4200.0));
        // an octave down is in the given band, and not followed
        assert_eq!(with_band((1000.0, 9000.0)), (3809.0, 4471.0));
    }

    #[test]
    fn harmonics_above_the_recording_are_left_out_and_said() {
        let mut warnings = Vec::new();
        assert_eq!(bands_around(60.17, &mesh(), 22050.0, &mut warnings).unwrap().len(), 2);
        assert!(matches!(warnings[..], [Warning::HarmonicLeftOut { harmonic: 3, .. }]));
        assert!(bands_around(60.17, &mesh(), 8000.0, &mut Vec::new()).is_err());
    }
}
