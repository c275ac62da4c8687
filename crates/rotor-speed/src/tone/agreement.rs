//! Gear mesh and blade pass → whether both tell of one shaft, where neither is a clear line by itself.

use super::{CombMap, search_range_rev_s};
use crate::error::Error;
use crate::survey::Survey;
use crate::tone::ToneConfig;
use hovertone_vehicle::{BLADES_MAX, Order};

/// Each family by itself leads to the same speed within this share: four rotors within ±1 % of their mean, now one the
/// loudest, now another. Noise does so once in some hundred recordings.
const LEADS_APART_SHARE: f64 = 0.01;
/// Rows of the survey lead there within this share, …
const ROWS_APART_SHARE: f64 = 0.04;
/// … most of them, and not by chance.
const ROWS_SHARE_MIN: f64 = 0.8;
const ROWS_MIN: usize = 10;

/// Whether gear mesh and blade pass name one shaft speed, in recording and rows: no other sound has lines at both. `false`
/// where only one of them is known.
///
/// Measured: four rotors whose tones are 15 dB below white noise lead within 0.3 %, and 94 % of their rows; recordings of
/// rotors without that gear, of a helicopter and of a street in 50 % of their rows at most.
///
/// # Errors
/// A tone that the recording cannot hold.
pub(crate) fn families_agree(
    survey: &Survey,
    map: &CombMap,
    tone: &ToneConfig,
    sample_rate_hz: f64,
    speed_rev_s: f64,
) -> Result<bool, Error> {
    let is_gear = tone.order.lines_per_turn() > BLADES_MAX;
    let blade_pass = tone.blades.filter(|_| is_gear).and_then(|blades| Order::new(f64::from(blades)).ok());
    let Some(blade_pass) = blade_pass else { return Ok(false) };
    let rows = survey.rows.len();
    let is_near = |speed: f64, share: f64| (speed / speed_rev_s - 1.0).abs() < share;
    let rows_near = (0..rows)
        .filter(|&row| map.best_of_row(row).is_some_and(|(speed, _)| is_near(speed, ROWS_APART_SHARE)))
        .count();
    if rows < ROWS_MIN || (rows_near as f64) < ROWS_SHARE_MIN * rows as f64 {
        return Ok(false);
    }
    let search_rev_s = search_range_rev_s(tone, sample_rate_hz)?;
    let families =
        [ToneConfig { blades: None, ..tone.clone() }, ToneConfig { order: blade_pass, blades: None, ..tone.clone() }];
    let leads = families.map(|family| CombMap::from_survey(survey, &family, search_rev_s).leading_speed_rev_s());
    Ok(leads.into_iter().all(|lead| lead.is_some_and(|speed| is_near(speed, LEADS_APART_SHARE))))
}
