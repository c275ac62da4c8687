//! What masses, forces and the number of recordings tell before anything is heard. A fit says the same of the loads that it has.

use crate::campaign::{EQUAL_FORCES_SHARE, whole_vehicle_factor};
use crate::force::Force;
use crate::settings::ThrustSettings;
use crate::warning::ThrustWarning;

/// A load without its speeds.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LoadOutline<'a> {
    /// Name of the load.
    pub name: &'a str,
    /// Force that the rotors balance.
    pub force: Force,
    /// Number of rotors that balance it.
    pub rotors_running: u32,
    /// Number of its recordings.
    pub recording_count: usize,
}

/// The warnings that a fit of these loads will have if all their recordings have a speed, in the same words: those that no speed can change.
/// A load without a recording is none.
pub fn warnings_of_outline(loads: &[LoadOutline<'_>], settings: &ThrustSettings) -> Vec<ThrustWarning> {
    let rotor_count = settings.rotor_count.max(1);
    let used = loads.iter().filter(|load| load.recording_count > 0);
    let forces = used.map(|load| load.force.newtons() * whole_vehicle_factor(load.rotors_running, rotor_count));
    let mut warnings = warnings_of_recordings(loads);
    warnings.extend(too_alike(&forces.collect::<Vec<_>>()));
    warnings.extend(warnings_of_masses(loads, settings));
    warnings
}

/// One recording of each load; hovers beside bench runs.
pub(crate) fn warnings_of_recordings(loads: &[LoadOutline<'_>]) -> Vec<ThrustWarning> {
    let mut warnings = Vec::new();
    let used = || loads.iter().filter(|load| load.recording_count > 0);
    let load_count = used().count();
    if load_count > 0 && used().all(|load| load.recording_count == 1) {
        warnings.push(ThrustWarning::OneRecordingEach { load_count });
    }
    let kinds = |is_hover: bool| used().any(|load| matches!(load.force, Force::Weight { .. }) == is_hover);
    if kinds(true) && kinds(false) {
        warnings.push(ThrustWarning::MixedBenchAndHover);
    }
    warnings
}

/// One force, or forces that are nearly equal.
pub(crate) fn too_alike(forces_n: &[f64]) -> Option<ThrustWarning> {
    let (least, most) =
        (forces_n.iter().copied().fold(f64::INFINITY, f64::min), forces_n.iter().copied().fold(0.0, f64::max));
    match forces_n.len() {
        0 => None,
        1 => Some(ThrustWarning::SingleLoad),
        count => (most / least - 1.0 < EQUAL_FORCES_SHARE).then_some(ThrustWarning::EqualLoads { count }),
    }
}

/// A mass that is far from the one of the known vehicle, and one that nobody weighed.
pub(crate) fn warnings_of_masses(loads: &[LoadOutline<'_>], settings: &ThrustSettings) -> Vec<ThrustWarning> {
    let forces = loads.iter().map(|load| (load.name, load.force));
    let far = settings.known_mass_kg.and_then(|known_kg| ThrustWarning::of_masses(forces, known_kg));
    let vehicle_kg = loads.iter().filter(|load| load.recording_count > 0).find_map(|load| match load.force {
        Force::Weight { vehicle_mass_kg, .. } => Some(vehicle_mass_kg),
        Force::Thrust { .. } => None,
    });
    let foreign = vehicle_kg.filter(|_| !settings.is_weighed).map(|mass_kg| ThrustWarning::MassNotWeighed { mass_kg });
    far.into_iter().chain(foreign).collect()
}
