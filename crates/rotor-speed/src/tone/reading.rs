//! A tone → the shaft speeds that it can mean, and what is known against each.

use crate::tone::DiscoveryConfig;
use hovertone_analysis::{Meaning, Reading};
use hovertone_vehicle::{
    AIR_KG_M3, Gear, KNOWN_RANGE_MARGIN, KnownRotor, Order, RotorSpeed, SOUND_M_S, THRUST_COEFFICIENT, TIP_MACH_MAX,
};
use std::f64::consts::PI;

/// Numbers of blades that are considered. *Decision.*
pub(crate) const BLADES: [u32; 5] = [2, 3, 4, 5, 6];
/// Slowest and fastest shaft of any multirotor, turns per second, with room on either side. *Decision.*
const SHAFT_REV_S: (f64, f64) = (8.0, 900.0);
/// Readings that together are rarer than this are not all that the sound can be. *Decision.*
const RARE_SHARE: f64 = 0.1;

/// The readings of a tone as a blade pass, most plausible first: as common as propellers with so many blades are, and 0 where a limit excludes
/// it.
pub(crate) fn readings_of_tone(tone_hz: f64, known: &KnownRotor, config: &DiscoveryConfig) -> Vec<Reading> {
    let reading = |(blades, share): (u32, f64)| {
        let order = Order::from_blades(blades).ok()?;
        let share = if known.blade_count == Some(blades) { 1.0 } else { share };
        let why = match known.blade_count {
            Some(_) => format!("{blades} blades are given"),
            None => format!("{} propellers have {blades} blades", how_many(share)),
        };
        let mut reading = Reading {
            plausibility: share,
            why,
            ..reading_at(RotorSpeed::from_tone_hz(tone_hz, order), order, Meaning::BladePass { blades })
        };
        rule_out(&mut reading, known);
        Some(reading)
    };
    let mut readings: Vec<Reading> = BLADES.into_iter().zip(config.blade_shares).filter_map(reading).collect();
    normalise(&mut readings);
    readings
}

/// A reading with a speed, before anything is known for or against it.
pub(crate) fn reading_at(speed: RotorSpeed, order: Order, meaning: Meaning) -> Reading {
    let ratio = meaning.gear().map_or(1.0, Gear::ratio);
    Reading {
        order,
        tone_hz: speed.tone_hz(order),
        meaning,
        speed,
        motor_speed: RotorSpeed::from_rad_s(ratio * speed.rad_s()),
        tip_mach: None,
        thrust_coefficient: None,
        plausibility: 0.0,
        why: String::new(),
    }
}

/// Shares of belief that sum to 1, most first; to less where only what is rare is left, and something else is likelier.
pub(crate) fn normalise(readings: &mut [Reading]) {
    let sum: f64 = readings.iter().map(|reading| reading.plausibility).sum();
    readings.iter_mut().for_each(|reading| reading.plausibility /= sum.max(RARE_SHARE));
    readings.sort_by(|a, b| b.plausibility.total_cmp(&a.plausibility));
}

/// Tip speed, thrust coefficient and known range; what lies outside loses all belief.
pub(crate) fn rule_out(reading: &mut Reading, known: &KnownRotor) {
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
        let range = format!("{low:.0} to {high:.0} rev/s");
        against.push(match known.shaft_speed {
            Some(_) => format!("too {how}: for this vehicle, hovertone searches {range}"),
            None => format!("too {how}: a rotor turns at {range}"),
        });
    }
    if let Some(diameter_m) = known.diameter_m {
        let mach = PI * diameter_m * rev_s / SOUND_M_S;
        reading.tip_mach = Some(mach);
        if mach > TIP_MACH_MAX {
            against.push(format!("too fast (blade tips above Mach {TIP_MACH_MAX})"));
        }
        if let Some(thrust_coefficient) = known.hover_thrust_coefficient(rev_s, AIR_KG_M3) {
            reading.thrust_coefficient = Some(thrust_coefficient);
            if !THRUST_COEFFICIENT.contains(&thrust_coefficient) {
                let (low, high) = (*THRUST_COEFFICIENT.start(), *THRUST_COEFFICIENT.end());
                against.push(format!("its C_T would be outside the range of propellers, {low} to {high}"));
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
