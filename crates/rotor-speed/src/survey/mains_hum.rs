//! Fine rows → mains hum: lines of constant frequency at multiples of 50 or 60 Hz.

use crate::survey::{Row, Rows};
use crate::thresholds::{CLEAR_DB, NEARLY_ALL};
use hovertone_signal::SteadyLines;
use hovertone_signal::peak::peak_offset_bins;
use hovertone_signal::spectrogram::whitened_db;
use hovertone_signal::statistics::median;

/// Frequencies of the electric grids of the world, Hz. *Physics.*
const GRIDS_HZ: [f64; 2] = [50.0, 60.0];
/// Largest deviation of a grid from its frequency, as a share (ENTSO-E: ±0.05 Hz nearly always). The clock of a recorder deviates by a
/// tenth of it. *Decision.*
const GRID_SHARE: f64 = 0.001;
/// Largest deviation of the frequency from all lines together, with the clock of the recorder, as a share. *Decision.*
const GRID_SHARE_MAX: f64 = 0.0012;
/// Error of an interpolated peak, in bins. *Numeric.*
const PEAK_ERROR_BINS: f64 = 0.08;
/// Twice the standard deviation of a peak in one row, in bins, where noise and line are as loud: of a Hann window (Rife and Vincent 1970). *Physics.*
const ROW_ERROR_BINS: f64 = 0.8;
/// Largest deviation of a grid from its mean within a recording, as a share. *Decision.*
const ROW_SHARE: f64 = 0.0005;
/// Smallest height of a line of hum over its surroundings, dB.
const OVER_DB_MIN: f64 = CLEAR_DB;
/// The same for further lines, once there is hum, dB. *Decision.*
const WEAK_OVER_DB_MIN: f64 = 5.0;
/// Smallest power of a line, re a sine of full scale: the rounding of 16 bits, 2⁻³⁰/12, over the power 1/2 of such a sine: −98 dB. The rounding of
/// a pure tone is no noise but lines, at multiples of the common divisor of its frequency and the sample rate, which may be 10 or 20 Hz.
/// *Physics.*
const ROUNDING_POWER: f64 = 1.55e-10;
/// Smallest share of rows in which a line of hum is in its place: noise moves weak lines, and a rotor of varying speed leaves the place
/// soon.
const ROWS_IN_PLACE_MIN: f64 = NEARLY_ALL;
/// Smallest share of lines that are heard, among all multiples up to the highest one heard, or among the odd or the even multiples.
/// *Decision.*
const HEARD_SHARE_MIN: f64 = 0.65;
/// Largest distance of the strongest of the first lines below the strongest line, dB: hum is strong in its first multiples. *Decision.*
const LOW_MULTIPLES_DB: f64 = 15.0;
/// Number of first lines of which one must be strong. *Decision.*
const LOW_MULTIPLES: usize = 3;
/// Number of multiples whose presence is examined. *Decision.*
const PATTERN_MULTIPLES: usize = 8;

/// A line of constant frequency.
#[derive(Clone, Copy, Debug)]
struct StillLine {
    hz: f64,
    power: f64,
}

/// The mean spectrum of the fine rows.
struct FineSpectrum<'a> {
    rows: &'a Rows,
    /// Mean power of each bin.
    power: Vec<f64>,
    /// Level of each bin over the noise floor.
    over_db: Vec<f64>,
}

/// The mains hum of a recording, from its low frequencies up to `hz_max`. `None` where there is none.
///
/// Hum is a series of lines that stay within 0.1 % of multiples of 50 or 60 Hz, with a strong line among the first three, and at most
/// about a third of the lines missing. So a rotor at 180 Hz is no hum, because it has no lines at 60 and 120 Hz. The multiples of a rotor move
/// together, by more than a grid does: the high ones show it.
pub(crate) fn mains_hum(fine: &Rows, hz_max: f64) -> Option<SteadyLines> {
    let power = fine.mean_power()?;
    let spectrum = FineSpectrum { rows: fine, over_db: whitened_db(&power), power };
    GRIDS_HZ
        .into_iter()
        .filter_map(|grid_hz| hum_of_grid(&spectrum, grid_hz, hz_max))
        .max_by_key(|hum| hum.lines_hz.len())
}

/// The hum of a grid of 50 or 60 Hz.
fn hum_of_grid(spectrum: &FineSpectrum<'_>, grid_hz: f64, hz_max: f64) -> Option<SteadyLines> {
    let FineSpectrum { rows, power, over_db } = spectrum;
    let bin_hz = rows.bin_hz;
    let multiples = (hz_max / grid_hz) as usize;
    let lines: Vec<Option<StillLine>> = (1..=multiples).map(|k| still_line(spectrum, k as f64 * grid_hz)).collect();
    let strongest = |lines: &[Option<StillLine>]| lines.iter().flatten().map(|line| line.power).fold(0.0, f64::max);
    let low = strongest(&lines[..lines.len().min(LOW_MULTIPLES)]);
    if low <= 0.0 || low < strongest(&lines) * 10f64.powf(-LOW_MULTIPLES_DB / 10.0) {
        return None;
    }
    let pattern = &lines[..lines.len().min(PATTERN_MULTIPLES)];
    let highest = pattern.iter().rposition(Option::is_some)? + 1;
    let is_heard = |first: usize, step: usize| {
        let expected: Vec<bool> = (first..=highest).step_by(step).map(|k| pattern[k - 1].is_some()).collect();
        let heard = expected.iter().filter(|&&is_heard| is_heard).count();
        // the lowest line must be heard; otherwise the multiples of a rotor would qualify
        expected.first() == Some(&true) && heard as f64 >= HEARD_SHARE_MIN * expected.len() as f64
    };
    if !(is_heard(1, 1) || is_heard(1, 2) || is_heard(2, 2)) {
        return None;
    }
    // all lines together give a more precise frequency than one line: a rotor at 60.17 rev/s is no hum
    let mains_hz = mains_hz_of(&lines).filter(|mains_hz| (mains_hz / grid_hz - 1.0).abs() <= GRID_SHARE_MAX)?;
    if !stands_still(rows, mains_hz) {
        return None;
    }
    // where there is hum, weaker lines in its places are hum too, up to the highest that is clear; a line of a rotor beside may draw the peak away
    let is_line = |hz: f64| over_db.get((hz / bin_hz).round() as usize).is_some_and(|db| *db >= WEAK_OVER_DB_MIN);
    let highest = (1..=multiples).rev().find(|k| {
        let place = *k as f64 * mains_hz / bin_hz;
        let is_in_place = |peak: PlacedPeak| (peak.place - place).abs() <= 2.0 * PEAK_ERROR_BINS;
        is_line(*k as f64 * mains_hz) && peak_near(power, place).is_some_and(is_in_place)
    })?;
    let lines_hz = (1..=highest).map(|k| k as f64 * mains_hz).filter(|hz| is_line(*hz)).collect();
    Some(SteadyLines { fundamental_hz: mains_hz, lines_hz })
}

/// Whether the series moves no more than a grid does, from row to row: by the median of where its clear lines are, weighted by their
/// multiple, because the distance of a line from its multiple is measured to the same part of a bin for all.
fn stands_still(fine: &Rows, mains_hz: f64) -> bool {
    let heard: Vec<(f64, f64)> = fine.rows.iter().filter_map(|row| series_in_row(row, fine.bin_hz, mains_hz)).collect();
    let Some(middle) = median(&heard.iter().map(|(ratio, _)| *ratio).collect::<Vec<_>>()) else { return true };
    let still = heard.iter().filter(|(ratio, error)| (ratio - middle).abs() <= ROW_SHARE + error).count();
    still as f64 >= ROWS_IN_PLACE_MIN * heard.len() as f64
}

/// In one row, the frequency of the series over `mains_hz`, and its error. `None` where no line of it is clear.
fn series_in_row(row: &Row, bin_hz: f64, mains_hz: f64) -> Option<(f64, f64)> {
    let over_db = whitened_db(&row.power);
    let clear = (1..=PATTERN_MULTIPLES).filter_map(|multiple| {
        let place = multiple as f64 * mains_hz / bin_hz;
        let peak = peak_near(&row.power, place)?;
        (*over_db.get(peak.bin)? >= OVER_DB_MIN).then_some((peak.place / place, multiple as f64))
    });
    let mut clear: Vec<(f64, f64)> = clear.collect();
    clear.sort_by(|a, b| a.0.total_cmp(&b.0));
    let half = clear.iter().map(|(_, multiple)| multiple).sum::<f64>() / 2.0;
    let mut sum = 0.0;
    let (ratio, multiple) = clear.into_iter().find(|(_, multiple)| {
        sum += multiple;
        sum >= half
    })?;
    Some((ratio, PEAK_ERROR_BINS * bin_hz / (multiple * mains_hz)))
}

/// The frequency whose multiples k = 1, 2, … fit the lines best: least squares, weighted by their power.
fn mains_hz_of(lines: &[Option<StillLine>]) -> Option<f64> {
    let (weighted, weights) = lines
        .iter()
        .enumerate()
        .filter_map(|(index, line)| Some((index as f64 + 1.0, (*line)?)))
        .fold((0.0, 0.0), |(sum, weights), (k, StillLine { hz, power })| {
            (sum + k * hz * power, weights + k * k * power)
        });
    (weights > 0.0).then(|| weighted / weights)
}

/// The line at `hz`, where there is one and its frequency is constant from row to row.
fn still_line(spectrum: &FineSpectrum<'_>, hz: f64) -> Option<StillLine> {
    let FineSpectrum { rows: fine, power, over_db } = spectrum;
    let reach_hz = GRID_SHARE * hz + PEAK_ERROR_BINS * fine.bin_hz;
    let PlacedPeak { place, bin } = peak_near(power, hz / fine.bin_hz)?;
    let heard_hz = place * fine.bin_hz;
    let is_in_place = |at_hz: f64| (at_hz - hz).abs() <= reach_hz;
    if !is_in_place(heard_hz) || *over_db.get(bin)? < OVER_DB_MIN || power[bin] < ROUNDING_POWER {
        return None;
    }
    // a row has one frame or few, so that noise moves a weak line further; a rotor near the grid moves by more than the grid and noise do
    let error_bins = PEAK_ERROR_BINS + ROW_ERROR_BINS / 10f64.powf(over_db[bin] / 10.0).sqrt();
    let row_reach_hz = ROW_SHARE * hz + error_bins * fine.bin_hz;
    let in_place = fine
        .rows
        .iter()
        .filter_map(|row| peak_near(&row.power, hz / fine.bin_hz))
        .filter(|peak| (peak.place * fine.bin_hz - heard_hz).abs() <= row_reach_hz)
        .count();
    (in_place as f64 >= ROWS_IN_PLACE_MIN * fine.rows.len() as f64)
        .then_some(StillLine { hz: heard_hz, power: power[bin] })
}

/// A peak of a spectrum: its loudest bin, and its place between bins.
struct PlacedPeak {
    place: f64,
    bin: usize,
}

/// The highest bin within two bins of a place, interpolated. `None` where it is no peak.
fn peak_near<P: Copy + Into<f64>>(power: &[P], place: f64) -> Option<PlacedPeak> {
    let centre = place.round() as usize;
    let bin = (centre.saturating_sub(2).max(1)..=centre + 2)
        .filter(|&bin| bin + 1 < power.len())
        .max_by(|&a, &b| power[a].into().total_cmp(&power[b].into()))?;
    let offset = peak_offset_bins(power[bin - 1].into(), power[bin].into(), power[bin + 1].into())?;
    Some(PlacedPeak { place: bin as f64 + offset, bin })
}
