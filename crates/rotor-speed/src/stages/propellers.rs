//! For stage 2: the propellers that are possible.

use crate::evidence::{RotorLines, WantedPropeller};
use crate::tone::{BLADES, DiscoveryConfig, ToneConfig, search_range_rev_s};
use hovertone_vehicle::{Gear, Order, presets};

/// The propellers that are possible where nothing is known, without a gear.
pub(crate) fn any_propellers(sample_rate_hz: f64) -> Vec<WantedPropeller> {
    let shares = BLADES.into_iter().zip(DiscoveryConfig::default().blade_shares);
    let propeller = |(blades, share)| {
        let tone = ToneConfig::of_order(Order::from_blades(blades).ok()?);
        let speeds_rev_s = search_range_rev_s(&tone, sample_rate_hz).ok()?;
        Some(WantedPropeller { lines: RotorLines::of_blades(blades), share, speeds_rev_s })
    };
    shares.filter_map(propeller).collect()
}

/// The propellers with each number of blades behind the gear of one whose blades are not known.
pub(super) fn with_any_blades(geared: &WantedPropeller) -> Vec<WantedPropeller> {
    let with_blades = |(blades, share)| {
        let lines = RotorLines { blades: Some(blades), ..geared.lines };
        WantedPropeller { lines, share, speeds_rev_s: geared.speeds_rev_s.clone() }
    };
    BLADES.into_iter().zip(DiscoveryConfig::default().blade_shares).map(with_blades).collect()
}

/// The propellers behind the gears of known vehicles, with these blades, or any where they are not known.
pub(crate) fn geared_propellers(
    sample_rate_hz: f64,
    tone: &ToneConfig,
    blades: Option<u32>,
    share: f64,
) -> Vec<WantedPropeller> {
    let is_possible = |(_, of_gear): &(Gear, u32)| blades.is_none_or(|blades| blades == *of_gear);
    let propeller = |(gear, blades): (Gear, u32)| {
        let lines = RotorLines { blades: Some(blades), mesh_order: Some(f64::from(gear.wheel)) };
        let tone = ToneConfig { order: Order::from_blades(blades).ok()?, ..tone.clone() };
        let (slowest_rev_s, fastest_rev_s) = search_range_rev_s(&tone, sample_rate_hz).ok()?.into_inner();
        // the mesh must be inside the band that is heard
        let inside_rev_s = RotorLines::of_blades(blades).hz_max() / f64::from(gear.wheel);
        let speeds_rev_s = slowest_rev_s..=fastest_rev_s.min(inside_rev_s);
        (speeds_rev_s.start() < speeds_rev_s.end()).then_some(WantedPropeller { lines, share, speeds_rev_s })
    };
    known_gears().into_iter().filter(is_possible).filter_map(propeller).collect()
}

/// Gears of the vehicles that are known, each with the blades behind it.
pub(crate) fn known_gears() -> Vec<(Gear, u32)> {
    let of_vehicles = presets().iter().filter_map(|vehicle| Some((vehicle.gear?.value, vehicle.blade_count?.value)));
    let mut gears: Vec<(Gear, u32)> = of_vehicles.collect();
    gears.sort_by_key(|(gear, blades)| (gear.wheel, gear.pinion, *blades));
    gears.dedup();
    gears
}
