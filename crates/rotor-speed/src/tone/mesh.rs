//! Whether the mesh of a known gear sounds at its order of a shaft.

use super::levels::LevelRows;
use super::reading::{known_gears, normalise};
use super::series::Series;
use crate::tone::DiscoveryConfig;
use hovertone_analysis::{Meaning, Reading};
use hovertone_signal::statistics::{mean, std};
use hovertone_vehicle::{Order, RotorSpeed, presets};

/// Harmonics of the mesh that are looked at. *Decision.*
const MESH_HARMONICS: u32 = 3;
/// The mesh lies this near its place, as a share: the shaft speed is known to this. *Decision.*
const HALF_WIDTH_SHARE: f64 = 0.004;
/// Places beside it, as shares of its order, for comparison: off its ±1 and ±2 shaft sidebands at 1.45 and 2.9 %. *Numeric.*
const BESIDE_SHARES: [f64; 8] = [-0.075, -0.055, -0.04, -0.022, 0.022, 0.04, 0.055, 0.075];
/// Belief in a blade pass grows by this when the mesh of its shaft is heard: a chance line there is one in a hundred. *Decision.*
const MESH_GAIN: f64 = 100.0;

/// Level of the mesh over the places beside it, and the scatter of those, in dB; `None` beyond the recording.
fn mesh_over_db(levels: &LevelRows<'_>, series: &Series, order: f64) -> Option<(f64, f64)> {
    let level_db = |share: f64| {
        let mut heard = Vec::new();
        for (row, hz) in levels.rows.iter().zip(&series.row_hz) {
            let Some(hz) = hz else { continue };
            for harmonic in (1..=MESH_HARMONICS).map(f64::from) {
                let place = harmonic * order * (1.0 + share) * hz / levels.bin_hz;
                heard.extend(row.highest_db(place * (1.0 - HALF_WIDTH_SHARE), place * (1.0 + HALF_WIDTH_SHARE)));
            }
        }
        mean(&heard)
    };
    let beside: Vec<f64> = BESIDE_SHARES.into_iter().filter_map(level_db).collect();
    Some((level_db(0.0)? - mean(&beside)?, std(&beside)?))
}

/// Moves belief to the readings whose shaft has the mesh of a known vehicle's gear.
///
/// The AR.Drone's, 69 lines per turn beside 2 of the blade pass, is at 34.5 times the blade pass: no harmonic of it.
/// `series` is that of the family's fundamental.
pub(crate) fn hear_meshes(readings: &mut [Reading], levels: &LevelRows<'_>, series: &Series, config: &DiscoveryConfig) {
    for gear in known_gears() {
        let blades_with_gear = presets().iter().filter(|vehicle| vehicle.gear.is_some_and(|it| it.value == gear));
        let known_blades: Vec<u32> = blades_with_gear.filter_map(|vehicle| Some(vehicle.blade_count?.value)).collect();
        for reading in readings.iter_mut().filter(|reading| reading.plausibility > 0.0) {
            let Meaning::BladePass { blades } = reading.meaning else { continue };
            if !known_blades.contains(&blades) {
                continue;
            }
            let order = f64::from(gear.wheel) / f64::from(blades);
            let Some((over_db, scatter_db)) = mesh_over_db(levels, series, order) else { continue };
            if over_db >= config.mesh_over_db && over_db >= config.mesh_over_stds * scatter_db {
                let Ok(order) = Order::new(f64::from(gear.wheel)) else { continue };
                reading.meaning = Meaning::BladePassAndMesh { blades, gear, mesh_db: over_db };
                reading.tone_hz = reading.speed.tone_hz(order);
                reading.order = order;
                reading.motor_speed = RotorSpeed::from_rad_s(gear.ratio() * reading.speed.rad_s());
                reading.plausibility *= MESH_GAIN;
                reading.why = format!(
                    "the gear is heard: order {} is {over_db:.0} dB louder than the orders beside it",
                    gear.wheel
                );
            }
        }
    }
    normalise(readings);
}
