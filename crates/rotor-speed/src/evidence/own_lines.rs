//! Evidence of the lines that a rotor alone has, beside other rotors.

use super::excess::Excess;
use super::level_model::{LevelModel, OrderLevel};
use super::level_table;
use super::levels::{FloorAlong, level_db, noise_level};
use super::votes::HARMONICS;
use crate::thresholds::MANY;
use hovertone_vehicle::LineLevels;

/// Distance at which two lines stand apart, in resolutions of a frame: half the width of the main lobe of each. *Physics.*
const APART_RESOLUTIONS: f64 = 2.0;
/// Smallest share of the frames in which a line stands apart, at which it is compared.
const APART_SHARE_MIN: f64 = MANY;

/// Whether a frequency stands apart, in a frame, from all lines of a shaft.
pub(super) fn is_apart(excess: &Excess, hz: f64, shaft_rev_s: f64) -> bool {
    (hz - (hz / shaft_rev_s).round() * shaft_rev_s).abs() >= APART_RESOLUTIONS * excess.resolution_hz()
}

/// Level of the line of the blade pass of a rotor that stands out most, dB over the mean floor. `None` outside the band.
///
/// - `speeds_rev_s`: speed of the rotor in each frame.
pub(crate) fn loudness_db(excess: &Excess, speeds_rev_s: &[f64], blades: u32) -> Option<f64> {
    let floors = FloorAlong::of(excess, speeds_rev_s);
    let orders = (1..=HARMONICS).map(|harmonic| harmonic * blades);
    let levels = orders.filter_map(|order| Some((order, level_db(excess, speeds_rev_s, f64::from(order))?)));
    let loudest = levels.max_by(|(_, a), (_, b)| a.total_cmp(b));
    loudest.map(|(order, level_db)| level_db + floors.db(f64::from(order)))
}

/// The evidence in nats that a rotor sounds, by those lines of its blade pass which no other rotor's shaft lines meet: negative where they are
/// missing, and `None` where there is no such line. At three quarters of a rotor's speed, for instance, every second line of a blade pass is at a
/// shaft line of that rotor.
///
/// - `speeds_rev_s`: speed of the rotor in each frame.
/// - `others_rev_s`: speeds of each other rotor in each frame.
/// - `loudest_db`: loudness of the loudest rotor, [`loudness_db`]: the rotors of one vehicle are about as loud.
pub(crate) fn own_lines_nats(
    excess: &Excess,
    speeds_rev_s: &[f64],
    others_rev_s: &[&[f64]],
    loudest_db: f64,
    propeller: &OwnPropeller<'_>,
) -> Option<f64> {
    let OwnPropeller { blades, prior } = *propeller;
    let floors = FloorAlong::of(excess, speeds_rev_s);
    let own_level = |harmonic: u32| {
        let order = harmonic * blades;
        let (mut sum, mut count) = (0u32, 0u32);
        for (index, (frame, speed_rev_s)) in excess.frames.iter().zip(speeds_rev_s).enumerate() {
            let hz = f64::from(order) * speed_rev_s;
            if let Some(level) = frame.level_near(hz, excess.bin_hz)
                && others_rev_s.iter().all(|other_rev_s| is_apart(excess, hz, other_rev_s[index]))
            {
                sum += u32::from(level);
                count += 1;
            }
        }
        let is_often_apart = f64::from(count) >= APART_SHARE_MIN * excess.frames.len() as f64;
        let level_db = level_table::level_db(f64::from(sum) / f64::from(count.max(1)));
        is_often_apart.then(|| OrderLevel { order, level_db, floor_db: floors.db(f64::from(order)) })
    };
    let levels: Vec<OrderLevel> = (1..=HARMONICS).filter_map(own_level).collect();
    let noise = noise_level(excess, speeds_rev_s).filter(|_| !levels.is_empty())?;
    let prior = LineLevels { blade_pass_db: loudest_db, blade_pass_std_db: prior.rotors_std_db, ..*prior };
    Some(LevelModel::of_speeds(noise, &prior).shaft_nats(&levels, blades))
}

/// The propeller of the rotors, with the levels of real ones.
#[derive(Clone, Copy)]
pub(crate) struct OwnPropeller<'a> {
    pub(crate) blades: u32,
    pub(crate) prior: &'a LineLevels,
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::evidence::level_table::level_of;

    /// Forty frames of 9 kHz, with lines 20 dB over noise.
    fn lines_at(lines_hz: &[f64]) -> Excess {
        let bin_hz = 2.5;
        let mut levels = vec![level_of(0.8); 3600];
        lines_hz.iter().for_each(|hz| levels[(hz / bin_hz).round() as usize] = level_of(100.0));
        Excess::of_levels(bin_hz, 0.05, 40, &levels)
    }

    fn nats(excess: &Excess, speed_rev_s: f64, others_rev_s: &[f64]) -> Option<f64> {
        let constant = |speed_rev_s: f64| vec![speed_rev_s; excess.frames.len()];
        let others: Vec<Vec<f64>> = others_rev_s.iter().copied().map(constant).collect();
        let others: Vec<&[f64]> = others.iter().map(Vec::as_slice).collect();
        let propeller = OwnPropeller { blades: 2, prior: &LineLevels::default() };
        own_lines_nats(excess, &constant(speed_rev_s), &others, 20.0, &propeller)
    }

    #[test]
    fn a_rotor_that_only_shares_lines_is_refuted_and_one_with_own_lines_is_not() {
        // the blade pass of 300 rev/s, which has lines 8, 16 … of 225 rev/s
        let alone: Vec<f64> = (1..=8).map(|harmonic| 600.0 * f64::from(harmonic)).collect();
        let excess = lines_at(&alone);
        assert!(nats(&excess, 225.0, &[300.0]).unwrap() < -3.0);
        assert!(nats(&excess, 300.0, &[]).unwrap() > 3.0);
        let both: Vec<f64> = alone.into_iter().chain((1..=8).map(|harmonic| 450.0 * f64::from(harmonic))).collect();
        let excess = lines_at(&both);
        assert!(nats(&excess, 225.0, &[300.0]).unwrap() > 3.0);
        assert!(nats(&excess, 300.0, &[225.0]).unwrap() > 3.0);
    }

    #[test]
    fn rotors_whose_lines_frames_do_not_resolve_stay() {
        assert_eq!(nats(&lines_at(&[600.0, 1200.0]), 300.0, &[300.5]), None);
    }
}
