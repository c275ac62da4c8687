//! How loud each rotor is at each microphone, against how far it is from there.

use super::heard::LineLevels;
use super::{MicrophoneArray, distance_m};
use crate::by_microphones::MicrophonesConfig;

/// Level of a rotor along its axis over that in the plane of its disc: the loading noise of turning blades has a null on the axis,
/// which unsteady loading fills, while gears sound alike everywhere. How much of it there is nobody knows: the model goes half way.
const AXIS_DB: f64 = -20.0;
/// A rotor's own loudness is not known at all.
const LOUDNESS_STD_DB: f64 = 60.0;
/// So many lines' worth the scatter from echoes is believed before it is measured.
const SCATTER_PRIOR_LINES: f64 = 4.0;

/// Mean levels of the rotors at all microphones.
pub(super) struct Levels {
    /// Which track, its level at each microphone, and the variance of each from the scatter of its lines.
    rotors: Vec<(usize, Vec<f64>, f64)>,
    /// `places[rotor][microphone]`: level and variance, but for the loudness.
    places: Vec<Vec<(f64, f64)>>,
    /// Variance of levels that have nothing to do with these places.
    unrelated_db2: f64,
    gain_db2: f64,
    level_db2: f64,
}

impl Levels {
    pub(super) fn new(
        lines: &[LineLevels],
        tracks: usize,
        array: &MicrophoneArray,
        config: &MicrophonesConfig,
    ) -> Self {
        let microphones = array.microphones_m.len() as f64;
        // lines that all microphones hear, in dB
        let of_track = |track: usize| -> Vec<Vec<f64>> {
            let own = lines.iter().filter(|line| line.rotor == track);
            let db = |power: &Option<f64>| power.map(|power| 10.0 * power.log10());
            own.filter_map(|line| line.powers.iter().map(db).collect()).collect()
        };
        let (mut squares, mut degrees) = (SCATTER_PRIOR_LINES * config.line_level_std_db.powi(2), SCATTER_PRIOR_LINES);
        let mut heard = Vec::new();
        for track in 0..tracks {
            let levels = of_track(track);
            if levels.is_empty() {
                continue;
            }
            let count = levels.len() as f64;
            let mean: Vec<f64> = (0..array.microphones_m.len())
                .map(|microphone| levels.iter().map(|line| line[microphone]).sum::<f64>() / count)
                .collect();
            for line in &levels {
                let off: Vec<f64> = line.iter().zip(&mean).map(|(level, mean)| level - mean).collect();
                let loudness = off.iter().sum::<f64>() / microphones;
                squares += off.iter().map(|off| (off - loudness).powi(2)).sum::<f64>();
            }
            degrees += (count - 1.0) * (microphones - 1.0);
            heard.push((track, mean, count));
        }
        let scatter_db2 = squares / degrees;
        let places: Vec<Vec<(f64, f64)>> = array
            .rotors
            .iter()
            .map(|rotor| array.microphones_m.iter().map(|at_m| level_at(rotor.position_m, *at_m, config)).collect())
            .collect();
        Self {
            rotors: heard.into_iter().map(|(track, mean, count)| (track, mean, scatter_db2 / count)).collect(),
            unrelated_db2: config.level_std_db.powi(2).max(variance_over_places(&places)),
            places,
            gain_db2: config.gain_std_db.powi(2),
            level_db2: config.level_std_db.powi(2),
        }
    }

    /// Logarithm of the likelihood ratio of an assignment to levels that have nothing to do with the places.
    pub(super) fn log_ratio(&self, assignment: &[usize]) -> f64 {
        let placed = |track: usize, microphone: usize| self.places[assignment[track]][microphone];
        let unrelated = |_: usize, _: usize| (0.0, self.unrelated_db2);
        self.log_density(&placed) - self.log_density(&unrelated)
    }

    fn log_density(&self, expected: &dyn Fn(usize, usize) -> (f64, f64)) -> f64 {
        let microphones = self.places.first().map_or(0, Vec::len);
        let at: Vec<(usize, usize)> = (0..self.rotors.len())
            .flat_map(|rotor| (0..microphones).map(move |microphone| (rotor, microphone)))
            .collect();
        let off = at.iter().map(|&(rotor, microphone)| {
            let (track, levels, _) = &self.rotors[rotor];
            levels[microphone] - expected(*track, microphone).0
        });
        let covariance = |a: &(usize, usize), b: &(usize, usize)| {
            let (track, _, from_lines_db2) = self.rotors[a.0];
            let loudness_db2 = if a.0 == b.0 { LOUDNESS_STD_DB.powi(2) } else { 0.0 };
            let gain_db2 = if a.1 == b.1 { self.gain_db2 } else { 0.0 };
            let own_db2 = if a == b { self.level_db2 + from_lines_db2 + expected(track, a.1).1 } else { 0.0 };
            loudness_db2 + gain_db2 + own_db2
        };
        let matrix = at.iter().map(|a| at.iter().map(|b| covariance(a, b)).collect()).collect();
        normal_log_density(off.collect(), matrix)
    }
}

/// Level of a rotor at a microphone, but for its loudness, and its variance there from pattern and position.
fn level_at(rotor_m: [f64; 3], microphone_m: [f64; 3], config: &MicrophonesConfig) -> (f64, f64) {
    let far_m = distance_m(rotor_m, microphone_m).hypot(config.position_std_m);
    let axis_share = ((microphone_m[2] - rotor_m[2]) / far_m).powi(2);
    // amplitude ∝ sin² + 0.1 cos² of the angle from the axis
    let pattern_db = 20.0 * (1.0 - axis_share * (1.0 - 10f64.powf(AXIS_DB / 20.0))).log10();
    let position_db = 20.0 / std::f64::consts::LN_10 * config.position_std_m / far_m;
    (pattern_db / 2.0 - 20.0 * far_m.log10(), (pattern_db / 2.0).powi(2) + position_db.powi(2))
}

/// How much the places differ in what they are heard like, as a variance of one microphone against the others.
fn variance_over_places(places: &[Vec<(f64, f64)>]) -> f64 {
    let microphones = places.first().map_or(0, Vec::len);
    let against: Vec<Vec<f64>> = places
        .iter()
        .map(|levels| {
            let mean = levels.iter().map(|(level, _)| level).sum::<f64>() / microphones as f64;
            levels.iter().map(|(level, _)| level - mean).collect()
        })
        .collect();
    let of_microphone = |microphone: usize| {
        let levels: Vec<f64> = against.iter().map(|place| place[microphone]).collect();
        hovertone_signal::statistics::std(&levels).map_or(0.0, |std| std * std)
    };
    (0..microphones).map(of_microphone).sum::<f64>() / (microphones as f64).max(1.0)
}

/// ln N(off; 0, covariance) by Cholesky, without the power of 2π, which is the same for all; 0 where the matrix is none.
fn normal_log_density(mut off: Vec<f64>, mut matrix: Vec<Vec<f64>>) -> f64 {
    let mut log_density = 0.0;
    for row in 0..off.len() {
        for column in 0..=row {
            let known: f64 = (0..column).map(|k| matrix[row][k] * matrix[column][k]).sum();
            let rest = matrix[row][column] - known;
            if column < row {
                matrix[row][column] = rest / matrix[column][column];
            } else if rest > 0.0 {
                matrix[row][row] = rest.sqrt();
            } else {
                return 0.0;
            }
        }
        let known: f64 = (0..row).map(|k| matrix[row][k] * off[k]).sum();
        off[row] = (off[row] - known) / matrix[row][row];
        log_density -= matrix[row][row].ln() + off[row].powi(2) / 2.0;
    }
    log_density
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_density_is_that_of_the_inverse_and_the_determinant() {
        // [[4, 2], [2, 3]]: determinant 8, inverse [[3, −2], [−2, 4]] / 8
        let found = normal_log_density(vec![1.0, -2.0], vec![vec![4.0, 2.0], vec![2.0, 3.0]]);
        let square = (3.0 + 2.0 * 2.0 * 2.0 + 4.0 * 4.0) / 8.0;
        assert!((found - (-square / 2.0 - 8f64.ln() / 2.0)).abs() < 1e-12, "{found}");
        assert_eq!(normal_log_density(vec![0.0], vec![vec![0.0]]), 0.0);
    }
}
