//! Levels of the rotors at all microphones, against the distances.

use super::array::{MicrophoneArray, distance_m};
use super::paired_lines::LinePowers;
use super::settings::MicrophonesConfig;
use hovertone_signal::statistics::std;
use nalgebra::{DMatrix, DVector};
use std::f64::consts::LN_10;

/// Decibels of a factor of ten in amplitude, by definition. *Physics.*
const DB_PER_DECADE: f64 = 20.0;
/// Level of a rotor on its axis over that in the plane of its disc, in dB. Steady loading noise of turning blades is zero on the axis
/// (Gutin 1936); unsteady loading fills the gap by an unknown amount, and gears sound alike in all directions. *Decision.*
const AXIS_DB: f64 = -20.0;
/// Standard deviation of a rotor's loudness, in dB: so wide that the loudness is practically unknown. *Numeric.*
const LOUDNESS_STD_DB: f64 = 60.0;
/// Prior weight of the variance from echoes, in lines. *Decision.*
const SCATTER_PRIOR_LINES: f64 = 4.0;

/// Mean levels of the rotors at all microphones, and the levels that follow from the places.
pub(super) struct LevelModel {
    tracks: Vec<TrackLevels>,
    /// `places[rotor][microphone]`, without the loudness.
    places: Vec<Vec<ExpectedLevel>>,
    /// Variance of a single line's level from echoes, in dB².
    scatter_db2: f64,
    /// Variance of levels that have no relation to these places, in dB².
    unrelated_db2: f64,
    gain_db2: f64,
    level_db2: f64,
}

/// Mean levels of the lines of one track.
struct TrackLevels {
    track: usize,
    /// At each microphone.
    levels_db: Vec<f64>,
    /// Number of lines.
    lines: f64,
}

/// The level of a rotor at a microphone, without the loudness, and its variance.
#[derive(Clone, Copy)]
struct ExpectedLevel {
    db: f64,
    variance_db2: f64,
}

impl LevelModel {
    pub(super) fn new(
        lines: &[LinePowers],
        tracks: usize,
        array: &MicrophoneArray,
        config: &MicrophonesConfig,
    ) -> Self {
        let microphones = array.microphones_m.len();
        let mut scatter = Scatter::prior(config.line_level_std_db);
        let mut track_levels = Vec::new();
        for track in 0..tracks {
            let levels = levels_of_track_db(lines, track);
            if levels.is_empty() {
                continue;
            }
            let count = levels.len() as f64;
            let mean: Vec<f64> = (0..microphones)
                .map(|microphone| levels.iter().map(|line| line[microphone]).sum::<f64>() / count)
                .collect();
            scatter.add(&levels, &mean);
            track_levels.push(TrackLevels { track, levels_db: mean, lines: count });
        }
        let places: Vec<Vec<ExpectedLevel>> = array
            .rotors
            .iter()
            .map(|rotor| {
                array.microphones_m.iter().map(|at_m| expected_level(rotor.position_m, *at_m, config)).collect()
            })
            .collect();
        Self {
            tracks: track_levels,
            scatter_db2: scatter.variance_db2(),
            unrelated_db2: config.level_std_db.powi(2).max(variance_over_places_db2(&places)),
            places,
            gain_db2: config.gain_std_db.powi(2),
            level_db2: config.level_std_db.powi(2),
        }
    }

    /// Logarithm of the likelihood ratio of an assignment to levels that have no relation to the places.
    pub(super) fn ln_likelihood_ratio(&self, assignment: &[usize]) -> f64 {
        let placed = |track: usize, microphone: usize| self.places[assignment[track]][microphone];
        let unrelated = |_: usize, _: usize| ExpectedLevel { db: 0.0, variance_db2: self.unrelated_db2 };
        self.ln_density(&placed) - self.ln_density(&unrelated)
    }

    /// Logarithm of the normal density of all levels. The loudness correlates the levels of one rotor; the gain correlates the levels at
    /// one microphone.
    fn ln_density(&self, expected: &dyn Fn(usize, usize) -> ExpectedLevel) -> f64 {
        let microphones = self.places.first().map_or(0, Vec::len);
        let at: Vec<(usize, usize)> = (0..self.tracks.len())
            .flat_map(|index| (0..microphones).map(move |microphone| (index, microphone)))
            .collect();
        let off = at.iter().map(|&(index, microphone)| {
            let TrackLevels { track, levels_db, .. } = &self.tracks[index];
            levels_db[microphone] - expected(*track, microphone).db
        });
        let covariance = |a: &(usize, usize), b: &(usize, usize)| {
            let TrackLevels { track, lines, .. } = &self.tracks[a.0];
            let from_lines_db2 = self.scatter_db2 / lines;
            let loudness_db2 = if a.0 == b.0 { LOUDNESS_STD_DB.powi(2) } else { 0.0 };
            let gain_db2 = if a.1 == b.1 { self.gain_db2 } else { 0.0 };
            let own_db2 =
                if a == b { self.level_db2 + from_lines_db2 + expected(*track, a.1).variance_db2 } else { 0.0 };
            loudness_db2 + gain_db2 + own_db2
        };
        let matrix = DMatrix::from_fn(at.len(), at.len(), |row, column| covariance(&at[row], &at[column]));
        normal_ln_density(DVector::from_iterator(at.len(), off), matrix)
    }
}

/// Scatter of the lines' levels about the mean of their rotor at their microphone, after the loudness of each line. It starts from a prior.
struct Scatter {
    squares_db2: f64,
    degrees: f64,
}

impl Scatter {
    fn prior(std_db: f64) -> Self {
        Self { squares_db2: SCATTER_PRIOR_LINES * std_db.powi(2), degrees: SCATTER_PRIOR_LINES }
    }

    /// Adds the lines of one rotor: `levels_db[line][microphone]` and their mean at each microphone.
    fn add(&mut self, levels_db: &[Vec<f64>], mean_db: &[f64]) {
        let microphones = mean_db.len() as f64;
        for line in levels_db {
            let off: Vec<f64> = line.iter().zip(mean_db).map(|(level, mean)| level - mean).collect();
            let loudness = off.iter().sum::<f64>() / microphones;
            self.squares_db2 += off.iter().map(|off| (off - loudness).powi(2)).sum::<f64>();
        }
        self.degrees += (levels_db.len() as f64 - 1.0) * (microphones - 1.0);
    }

    fn variance_db2(&self) -> f64 {
        self.squares_db2 / self.degrees
    }
}

/// Levels of a track's lines that are audible at all microphones: `[line][microphone]`.
fn levels_of_track_db(lines: &[LinePowers], track: usize) -> Vec<Vec<f64>> {
    let own = lines.iter().filter(|line| line.rotor == track);
    let db = |power: &Option<f64>| power.map(|power| 10.0 * power.log10());
    own.filter_map(|line| line.powers.iter().map(db).collect()).collect()
}

/// Level of a rotor at a microphone: `−20 log₁₀ d + D/2` with the variance `(D/2)²` plus that of the position. The amplitude has the
/// directivity `sin² + 0.1 cos²` of the angle from the axis; D is its level.
fn expected_level(rotor_m: [f64; 3], microphone_m: [f64; 3], config: &MicrophonesConfig) -> ExpectedLevel {
    let far_m = distance_m(rotor_m, microphone_m).hypot(config.position_std_m);
    let axis_share = ((microphone_m[2] - rotor_m[2]) / far_m).powi(2);
    let directivity_db = DB_PER_DECADE * (1.0 - axis_share * (1.0 - 10f64.powf(AXIS_DB / DB_PER_DECADE))).log10();
    let position_db = DB_PER_DECADE / LN_10 * config.position_std_m / far_m;
    ExpectedLevel {
        db: directivity_db / 2.0 - DB_PER_DECADE * far_m.log10(),
        variance_db2: (directivity_db / 2.0).powi(2) + position_db.powi(2),
    }
}

/// Variance over the places of the level at one microphone relative to the mean of all microphones, averaged over the microphones.
fn variance_over_places_db2(places: &[Vec<ExpectedLevel>]) -> f64 {
    let microphones = places.first().map_or(0, Vec::len);
    let relative: Vec<Vec<f64>> = places
        .iter()
        .map(|levels| {
            let mean = levels.iter().map(|level| level.db).sum::<f64>() / microphones as f64;
            levels.iter().map(|level| level.db - mean).collect()
        })
        .collect();
    let of_microphone = |microphone: usize| {
        let levels: Vec<f64> = relative.iter().map(|place| place[microphone]).collect();
        std(&levels).map_or(0.0, |std| std * std)
    };
    (0..microphones).map(of_microphone).sum::<f64>() / (microphones as f64).max(1.0)
}

/// `ln N(off; 0, covariance)` by Cholesky decomposition, without the power of 2π, which is the same for all assignments; 0 if the matrix is
/// not positive definite.
fn normal_ln_density(off: DVector<f64>, covariance: DMatrix<f64>) -> f64 {
    let Some(decomposed) = covariance.cholesky() else { return 0.0 };
    -0.5 * (off.dot(&decomposed.solve(&off)) + decomposed.ln_determinant())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_density_agrees_with_inverse_and_determinant() {
        // [[4, 2], [2, 3]]: determinant 8, inverse [[3, −2], [−2, 4]] / 8
        let found = normal_ln_density(
            DVector::from_row_slice(&[1.0, -2.0]),
            DMatrix::from_row_slice(2, 2, &[4.0, 2.0, 2.0, 3.0]),
        );
        let square = (3.0 + 2.0 * 2.0 * 2.0 + 4.0 * 4.0) / 8.0;
        assert!((found - (-square / 2.0 - 8f64.ln() / 2.0)).abs() < 1e-12, "{found}");
        assert_eq!(normal_ln_density(DVector::zeros(1), DMatrix::zeros(1, 1)), 0.0);
    }
}
