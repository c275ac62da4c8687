//! A family of lines → the shaft speeds that it can mean, and how plausible each is.

use super::pattern::{BLADES, OVER_NEIGHBOURS_SHARE, Pattern};
use crate::tone::DiscoveryConfig;
use hovertone_analysis::{Meaning, Reading};
use hovertone_vehicle::{Gear, KNOWN_RANGE_MARGIN, KnownRotor, Order, RotorSpeed};
use std::f64::consts::PI;

/// Readings whose shaft speeds differ by less than this share are one speed. *Decision.*
const SAME_SPEED_SHARE: f64 = 0.005;
/// Slowest and fastest shaft of any multirotor, turns per second, with room on either side. *Decision.*
const SHAFT_REV_S: (f64, f64) = (8.0, 900.0);
/// Lines that lie between the harmonics leave the reading as shaft lines at least this likely, however weak the pattern. *Decision.*
const SHAFT_LIKELIHOOD_MIN: f64 = 0.05;
/// Any series leaves it at least this likely: shaft lines as strong as the blade pass are rare, not impossible. *Decision.*
const PLAIN_LIKELIHOOD_MIN: f64 = 0.025;
/// What one line that stands out is worth, or several that mostly do not: it is a loud harmonic far more often. *Decision.*
const WEAK_LIKELIHOOD: f64 = 0.1;
/// What a pattern that is not shown well is worth at most. *Decision.*
const OPEN_LIKELIHOOD: f64 = 0.5;
/// Readings that together are rarer than this are not all that the sound can be. *Decision.*
const RARE_SHARE: f64 = 0.1;
/// How common a gear mesh is as the lowest line of a family, beside blade passes. *Decision.*
const MESH_SHARE: f64 = 0.03;

/// All readings of a family, most plausible first.
///
/// Belief = likelihood of the pattern x how common the number of blades is, 0 where a limit rules it out. The likelihood
/// that lines between are shaft lines is 1 / (1 + exp((c0 − c)/s)) in their contrast c, with `contrast_even_db` and
/// `contrast_scale_db`. Where fewer than `contrast_lines_min` lines show the contrast,
/// fewer than `between_share_min` of those between are heard, or something sounds at halves, thirds, fourths or fifths of the supposed shaft's
/// order, it stays at one half at most.
///
/// The limit of this: a steady echo of relative amplitude a whose delay is half a period of the blade pass makes every second
/// line stand out by 20 log((1 + a)/(1 − a)) dB, as two blades do. It is told apart by the lines of the true shaft, which it
/// leaves at half orders; therefore two blades need lines `range_db_min` over the floor, so that those would be seen.
pub(crate) fn readings_of(
    pattern: &Pattern,
    fundamental_hz: f64,
    known: &KnownRotor,
    config: &DiscoveryConfig,
) -> Vec<Reading> {
    let shaft_likelihood = shaft_likelihood(pattern, config);
    let mut readings = Vec::new();
    if let Some((contrast, likelihood)) = pattern.contrast.zip(shaft_likelihood) {
        let meaning = Meaning::ShaftLines { blades: contrast.blades, contrast_db: contrast.over_db };
        let why = match contrast.line_count {
            _ if likelihood < WEAK_LIKELIHOOD => "its harmonics do not show the shaft".to_owned(),
            1 => format!("one harmonic is {:.0} dB louder than the ones beside it", contrast.over_db),
            _ => format!(
                "every {} harmonic is {:.0} dB louder than the ones between",
                ordinal(contrast.blades),
                contrast.over_db
            ),
        };
        let tone_hz = f64::from(contrast.blades) * fundamental_hz;
        readings.extend(reading(tone_hz, f64::from(contrast.blades), meaning, likelihood, why));
    }
    let left = 1.0 - shaft_likelihood.unwrap_or(0.0);
    for (blades, share) in BLADES.into_iter().zip(config.blade_shares) {
        let share = if known.blade_count == Some(blades) { 1.0 } else { share };
        let why = match known.blade_count {
            Some(_) => format!("{blades} blades are given"),
            None => format!("{} propellers have {blades} blades", how_many(share)),
        };
        readings.extend(reading(fundamental_hz, f64::from(blades), Meaning::BladePass { blades }, left * share, why));
    }
    for gear in known_gears() {
        let why = "a vehicle with this gear is known".to_owned();
        let order = f64::from(gear.wheel);
        readings.extend(reading(fundamental_hz, order, Meaning::Mesh { gear }, left * MESH_SHARE, why));
    }
    readings.iter_mut().for_each(|reading| rule_out(reading, known, config));
    normalise(&mut readings);
    readings
}

/// Gears of the vehicles that are known.
pub(crate) fn known_gears() -> Vec<Gear> {
    let mut gears: Vec<Gear> =
        hovertone_vehicle::presets().iter().filter_map(|vehicle| Some(vehicle.gear?.value)).collect();
    gears.sort_by_key(|gear| (gear.wheel, gear.pinion));
    gears.dedup();
    gears
}

/// Shares of belief that sum to 1, most first; to less where only what is rare is left, and something else is likelier.
pub(crate) fn normalise(readings: &mut [Reading]) {
    let sum: f64 = readings.iter().map(|reading| reading.plausibility).sum();
    readings.iter_mut().for_each(|reading| reading.plausibility /= sum.max(RARE_SHARE));
    readings.sort_by(|a, b| b.plausibility.total_cmp(&a.plausibility));
}

/// Whether one shaft speed has nearly all belief, and that from the sound or from what is known of the vehicle. How common
/// readings are, and how fast rotors turn in general, is not enough.
pub(crate) fn is_settled(readings: &[Reading], known: &KnownRotor, config: &DiscoveryConfig) -> bool {
    let Some(first) = readings.first() else { return false };
    let is_known = known.diameter_m.is_some() || known.shaft_speed.is_some() || known.blade_count.is_some();
    if !is_known && matches!(first.meaning, Meaning::BladePass { .. } | Meaning::Mesh { .. }) {
        return false;
    }
    let is_same = |reading: &&Reading| (reading.speed.rad_s() / first.speed.rad_s() - 1.0).abs() < SAME_SPEED_SHARE;
    let belief: f64 = readings.iter().filter(is_same).map(|reading| reading.plausibility).sum();
    belief >= config.settled_plausibility_min
}

fn shaft_likelihood(pattern: &Pattern, config: &DiscoveryConfig) -> Option<f64> {
    let contrast = pattern.contrast?;
    let likelihood = 1.0 / (1.0 + ((config.contrast_even_db - contrast.over_db) / config.contrast_scale_db).exp());
    let most = match contrast.line_count {
        1 => WEAK_LIKELIHOOD,
        _ if contrast.over_all_share < OVER_NEIGHBOURS_SHARE / 2.0 => WEAK_LIKELIHOOD,
        _ if contrast.over_all_share < OVER_NEIGHBOURS_SHARE => OPEN_LIKELIHOOD,
        few if few < config.contrast_lines_min => OPEN_LIKELIHOOD,
        _ if contrast.blades == 2 && pattern.range_db() < config.range_db_min => OPEN_LIKELIHOOD,
        _ if pattern.has_fractions || contrast.between_share < config.between_share_min => OPEN_LIKELIHOOD,
        _ => 1.0,
    };
    let has_lines_between = pattern.fundamental_ratio < 1.0;
    let least = if has_lines_between { SHAFT_LIKELIHOOD_MIN } else { PLAIN_LIKELIHOOD_MIN };
    Some(likelihood.clamp(least, most))
}

fn reading(tone_hz: f64, order: f64, meaning: Meaning, plausibility: f64, why: String) -> Option<Reading> {
    let order = Order::new(order).ok()?;
    let speed = RotorSpeed::from_tone_hz(tone_hz, order);
    let ratio = meaning.gear().map_or(1.0, Gear::ratio);
    let motor_speed = RotorSpeed::from_rad_s(ratio * speed.rad_s());
    Some(Reading {
        order,
        tone_hz,
        meaning,
        speed,
        motor_speed,
        tip_mach: None,
        thrust_coefficient: None,
        plausibility,
        why,
    })
}

/// Tip speed, thrust coefficient and known range; what lies outside loses all belief.
pub(crate) fn rule_out(reading: &mut Reading, known: &KnownRotor, config: &DiscoveryConfig) {
    let rev_s = reading.speed.rev_s();
    let (low, high) = known
        .shaft_speed
        .map_or(SHAFT_REV_S, |range| (range.rev_s_low / KNOWN_RANGE_MARGIN, range.rev_s_high * KNOWN_RANGE_MARGIN));
    let mut against = Vec::new();
    if let Some((known, _)) = known.blade_count.zip(reading.meaning.blades()).filter(|(known, read)| known != read) {
        against.push(format!("{known} blades are given"));
    }
    if !(low..=high).contains(&rev_s) {
        let how = if rev_s < low { "slow" } else { "fast" };
        against.push(format!("too {how}: a rotor turns at {low:.0} to {high:.0} rev/s"));
    }
    if let Some(diameter_m) = known.diameter_m {
        let mach = PI * diameter_m * rev_s / config.sound_speed_m_s;
        reading.tip_mach = Some(mach);
        if mach > config.tip_mach_max {
            against.push(format!("too fast: the tips would pass Mach {}", config.tip_mach_max));
        }
        if let Some(thrust_coefficient) = known.hover_thrust_coefficient(rev_s, config.air_density_kg_m3) {
            reading.thrust_coefficient = Some(thrust_coefficient);
            let (low, high) = (config.thrust_coefficient_min, config.thrust_coefficient_max);
            if !(low..=high).contains(&thrust_coefficient) {
                against.push(format!("its thrust does not fit: C_T is not between {low} and {high}"));
            }
        }
    }
    if !against.is_empty() {
        reading.plausibility = 0.0;
        reading.why = against.join("; ");
    }
}

/// "most", "some" or "few" of all propellers.
fn how_many(share: f64) -> &'static str {
    match share {
        most if most >= 0.5 => "most",
        some if some >= 0.1 => "some",
        _ => "few",
    }
}

fn ordinal(number: u32) -> String {
    match number {
        2 => "2nd".to_owned(),
        3 => "3rd".to_owned(),
        _ => format!("{number}th"),
    }
}
