//! Fine rows → mains hum: lines at multiples of 50 or 60 Hz that do not move.

use crate::survey::Rows;
use hovertone_signal::peak::peak_offset_bins;
use hovertone_signal::spectrogram::whitened_db;

/// Frequencies of the world's mains.
const GRIDS_HZ: [f64; 2] = [50.0, 60.0];
/// Grids keep their frequency within this share nearly always (ENTSO-E: ±0.05 Hz), and a recorder's clock within a tenth.
const GRID_SHARE: f64 = 0.001;
/// Of the frequency that all lines together tell, with the recorder's clock.
const GRID_SHARE_MAX: f64 = 0.0012;
/// Error of an interpolated peak, in bins.
const PEAK_BINS: f64 = 0.08;
/// A multiple of the hum as heard is this near to where it should be: the drift within a recording, and the peak's error.
const OWN_SHARE: f64 = 0.0003;
const OWN_HZ: f64 = 0.15;
/// A series whose fundamental is this near to the hum's is the hum's.
const SERIES_SHARE: f64 = 0.01;
/// Hum stands this far over its surroundings.
const OVER_DB_MIN: f64 = 10.0;
/// Where there is hum, its weaker lines stand this far over theirs.
const WEAK_OVER_DB_MIN: f64 = 5.0;
/// A line is hum when it is in its place in this share of the rows: noise moves the weakest, a wandering rotor leaves soon.
const ROWS_IN_PLACE_MIN: f64 = 0.8;
/// Of the multiples up to the highest that is heard, this share is heard: all, or the odd, or the even.
const HEARD_SHARE_MIN: f64 = 0.65;
/// Hum has its strength in its first multiples: one of the first three is at most this much weaker than the strongest.
const LOW_MULTIPLES_DB: f64 = 15.0;
/// So many multiples are looked at for its pattern.
const PATTERN_MULTIPLES: usize = 8;

/// Mains hum of a recording.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct MainsHum {
    /// Frequency of the mains as heard.
    pub(crate) mains_hz: f64,
    /// Its lines, in order.
    pub(crate) lines_hz: Vec<f64>,
}

impl MainsHum {
    /// Replaces the hum's lines in a power spectrum by what lies beside them.
    pub(crate) fn take_out(&self, power: &mut [f64], bin_hz: f64) {
        for line_hz in &self.lines_hz {
            // the main lobe of a Hann window is two bins either way
            let (first, last) = ((line_hz / bin_hz).floor() as usize - 1, (line_hz / bin_hz).ceil() as usize + 1);
            let beside = |bin: usize| power.get(bin).copied();
            let Some(before) = first.checked_sub(1).and_then(beside) else { continue };
            let floor = beside(last + 1).map_or(before, |after| before.min(after));
            let end = (last + 1).min(power.len());
            power[first..end].iter_mut().for_each(|bin| *bin = bin.min(floor));
        }
    }

    /// Whether a line of that mean and spread over its frames is one of the hum's.
    pub(crate) fn holds(&self, mean_hz: f64, std_hz: f64) -> bool {
        let multiple = (mean_hz / self.mains_hz).round().max(1.0);
        let off_hz = (mean_hz - multiple * self.mains_hz).abs();
        off_hz <= OWN_SHARE * mean_hz + OWN_HZ && std_hz <= GRID_SHARE * mean_hz + OWN_HZ
    }

    /// Whether a series on that fundamental is the hum's, or a fraction of it.
    pub(crate) fn explains(&self, fundamental_hz: f64) -> bool {
        (1..=8).any(|part| {
            let multiple = (f64::from(part) * fundamental_hz / self.mains_hz).round().max(1.0);
            (f64::from(part) * fundamental_hz / (multiple * self.mains_hz) - 1.0).abs() < SERIES_SHARE
        })
    }

    /// The hum's line nearest to the middle of a band, if one is inside.
    pub(crate) fn line_in(&self, low_hz: f64, high_hz: f64) -> Option<f64> {
        self.lines_hz.iter().copied().find(|line_hz| (low_hz..=high_hz).contains(line_hz))
    }
}

/// The mains hum that a recording holds, if any.
///
/// A rotor is not taken for hum unless its lines stand still within 0.1 % of multiples of 50 or 60 Hz, with the first, the
/// second or the third among them, and without leaving out more than a third: a blade pass at 180 Hz, for one, has no lines at
/// 60 and 120 Hz.
pub(crate) fn mains_hum(fine: &Rows, hz_max: f64) -> Option<MainsHum> {
    let power = fine.mean_power(|_| true)?;
    let over_db = whitened_db(&power);
    GRIDS_HZ
        .into_iter()
        .filter_map(|grid_hz| hum_of_grid(fine, &power, &over_db, grid_hz, hz_max))
        .max_by_key(|hum| hum.lines_hz.len())
}

fn hum_of_grid(fine: &Rows, power: &[f64], over_db: &[f64], grid_hz: f64, hz_max: f64) -> Option<MainsHum> {
    let multiples = (hz_max / grid_hz) as usize;
    let lines: Vec<Option<(f64, f64)>> =
        (1..=multiples).map(|k| still_line(fine, power, over_db, k as f64 * grid_hz)).collect();
    let strongest = |lines: &[Option<(f64, f64)>]| lines.iter().flatten().map(|line| line.1).fold(0.0, f64::max);
    let low = strongest(&lines[..lines.len().min(3)]);
    if low <= 0.0 || low < strongest(&lines) * 10f64.powf(-LOW_MULTIPLES_DB / 10.0) {
        return None;
    }
    let pattern = &lines[..lines.len().min(PATTERN_MULTIPLES)];
    let highest = pattern.iter().rposition(Option::is_some)? + 1;
    let is_heard = |first: usize, step: usize| {
        let expected: Vec<bool> = (first..=highest).step_by(step).map(|k| pattern[k - 1].is_some()).collect();
        let heard = expected.iter().filter(|&&is_heard| is_heard).count();
        // the lowest of them is heard, for else a rotor's own multiples would do
        expected.first() == Some(&true) && heard as f64 >= HEARD_SHARE_MIN * expected.len() as f64
    };
    if !(is_heard(1, 1) || is_heard(1, 2) || is_heard(2, 2)) {
        return None;
    }
    // all lines together know the frequency better than the first alone: a rotor at 60.17 rev/s is none
    let mains_hz = mains_hz_of(&lines).filter(|mains_hz| (mains_hz / grid_hz - 1.0).abs() <= GRID_SHARE_MAX)?;
    // where there is hum, what stands in its place is hum too, however weak
    let in_place = (1..=multiples).filter_map(|k| {
        let hz = k as f64 * mains_hz;
        let (place, bin) = peak_near(power, hz / fine.bin_hz)?;
        let is_line = *over_db.get(bin)? >= WEAK_OVER_DB_MIN && (place - hz / fine.bin_hz).abs() <= 2.0 * PEAK_BINS;
        is_line.then_some(place * fine.bin_hz)
    });
    Some(MainsHum { mains_hz, lines_hz: in_place.collect() })
}

/// The frequency whose multiples fit these lines best, each by its power.
fn mains_hz_of(lines: &[Option<(f64, f64)>]) -> Option<f64> {
    let (weighted, weights) = lines
        .iter()
        .enumerate()
        .filter_map(|(index, line)| Some((index as f64 + 1.0, (*line)?)))
        .fold((0.0, 0.0), |(sum, weights), (k, (hz, power))| (sum + k * hz * power, weights + k * k * power));
    (weights > 0.0).then(|| weighted / weights)
}

/// Frequency and power of a line at `hz`, if there is one and it does not move from row to row.
fn still_line(fine: &Rows, power: &[f64], over_db: &[f64], hz: f64) -> Option<(f64, f64)> {
    let reach_hz = GRID_SHARE * hz + PEAK_BINS * fine.bin_hz;
    let (heard_hz, bin) = peak_near(power, hz / fine.bin_hz)?;
    let heard_hz = heard_hz * fine.bin_hz;
    let is_in_place = |at_hz: f64| (at_hz - hz).abs() <= reach_hz;
    if !is_in_place(heard_hz) || *over_db.get(bin)? < OVER_DB_MIN {
        return None;
    }
    // a row is one or a few frames, so that noise moves a weak line by more
    let in_place = fine
        .rows
        .iter()
        .filter_map(|row| peak_near(&row.power, hz / fine.bin_hz))
        .filter(|(at, _)| (at * fine.bin_hz - heard_hz).abs() <= reach_hz)
        .count();
    (in_place as f64 >= ROWS_IN_PLACE_MIN * fine.rows.len() as f64).then_some((heard_hz, power[bin]))
}

/// The highest bin within two of a place, interpolated.
fn peak_near(power: &[f64], place: f64) -> Option<(f64, usize)> {
    let centre = place.round() as usize;
    let bin = (centre.saturating_sub(2).max(1)..=centre + 2)
        .filter(|&bin| bin + 1 < power.len())
        .max_by(|&a, &b| power[a].total_cmp(&power[b]))?;
    let offset = peak_offset_bins(power[bin - 1], power[bin], power[bin + 1])?;
    Some((bin as f64 + offset, bin))
}
